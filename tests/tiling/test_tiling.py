"""What a tiling offers to scripts: its tiles by number and name, copies in a region, geometry, pictures, files."""

from __future__ import annotations

import importlib
import json
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from helpers import strategies
from helpers.png import chunks_of, decoded
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import voronoi_tiles as vt

ROOT = Path(__file__).parents[2]
ROSETTE = ROOT / "examples" / "p4m-rosette.toml"


@pytest.fixture(scope="module")
def pair() -> vt.Tiling:
    """The tiles of two sites, one of them symmetric."""
    return vt.starter("p4m").tessellate()


def test_a_tiling_is_a_sequence_of_named_tiles(pair: vt.Tiling) -> None:
    """By number, from either end, by name, and one by one."""
    assert len(pair) == 2
    assert list(pair) == [pair[0], pair[1]] == list(pair.tiles)
    assert pair[-1] is pair["leaf"]
    assert [tile.name for tile in pair] == ["star", "leaf"]
    with pytest.raises(IndexError):
        pair[2]
    with pytest.raises(vt.UnknownNameError, match=r'there is no site "tree"\. Sites are star, leaf\.') as caught:
        pair["tree"]
    assert isinstance(caught.value, KeyError)


# --- copies ---------------------------------------------------------------------------------------------------------


def covered(tiling: vt.Tiling, region: shapely.Geometry) -> tuple[float, float]:
    """How much of a region the copies that are given cover, and how much of it they cover twice."""
    parts = [copy.outline.to_shapely(accuracy=1e-6) for copy in tiling.copies(region)]
    inside = [part.intersection(region).area for part in parts]
    return shapely.union_all(parts).intersection(region).area, sum(inside)


@settings(max_examples=25, deadline=None)
@given(
    design=strategies.designs("plain", "wild", "several", "special"),
    corner=st.tuples(st.floats(-500, 500), st.floats(-500, 500)),
    size=st.tuples(st.floats(1, 150), st.floats(1, 150)),
)
def test_copies_cover_a_rectangle_once(
    design: dict[str, object], corner: tuple[float, float], size: tuple[float, float]
) -> None:
    """Whatever the group and the symmetry of sites: nothing is left out, and nothing comes twice."""
    try:
        tiling = vt.Design.from_dict(design).tessellate()
    except vt.TouchingCopiesError:
        assume(False)
    region = shapely.box(*corner, corner[0] + size[0], corner[1] + size[1])
    once, twice = covered(tiling, region)
    slack = 1e-4 * (1 + size[0] + size[1]) * 10
    assert once == pytest.approx(region.area, abs=slack)
    assert twice == pytest.approx(region.area, abs=slack)
    found = tiling.copies(region.bounds)
    assert len({(copy.site, copy.operation) for copy in found}) == len(found)


def test_copies_are_named_as_neighbours_are(pair: vt.Tiling) -> None:
    """The copies about a tile are those that its edges name, and share its edges to the bit."""
    star = pair["star"]
    copies = {(copy.site, copy.operation): copy.outline for copy in pair.copies(star)}
    own = (star.outline.start, star.outline.end)
    for k, neighbour in enumerate(star.outline.neighbours):
        outline = copies[neighbour.site, neighbour.operation]
        chosen = star.outline.neighbour == k
        theirs = set(zip(outline.end.tolist(), outline.start.tolist(), strict=True))
        assert set(zip(own[0][chosen].tolist(), own[1][chosen].tolist(), strict=True)) <= theirs
    assert copies["star", vt.Operation.parse("x,y")].start.tolist() == star.outline.start.tolist()


def test_copies_of_a_site_far_away_are_where_they_are() -> None:
    """A site drawn many cells from the origin: its own tile is the copy under the identity."""
    design = vt.Design("p4", 60, vt.Site([vt.segment(5 + 3j, 25 + 11j, translate=(6000, -1200))], name="far"))
    tiling = design.tessellate()
    (here,) = (copy for copy in tiling.copies(tiling[0]) if copy.operation == vt.Operation.parse("x,y"))
    assert here.outline.start.tolist() == tiling[0].outline.start.tolist()
    assert "x,y" in {str(copy.operation) for copy in tiling.copies((6000, -1200, 6001, -1199))}


def test_regions_of_every_kind(pair: vt.Tiling) -> None:
    """Rectangles, points, polygons with holes, several parts; nothing for an empty one."""
    everything = {(copy.site, copy.operation) for copy in pair.copies((0, 0, 120, 120))}
    assert len(everything) > 16
    holed = shapely.box(0, 0, 120, 120).difference(shapely.box(1, 1, 119, 119))
    border = {(copy.site, copy.operation) for copy in pair.copies(holed)}
    assert border < everything
    parts = shapely.MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(60, 60, 61, 61)])
    assert {copy.site for copy in pair.copies(parts)} == {"star"}
    assert [copy.site for copy in pair.copies((20, 9, 20, 9))] == ["leaf"]
    assert [copy.site for copy in pair.copies(shapely.Point(20, 9))] == ["leaf"]
    assert pair.copies(shapely.Polygon()) == []
    small = type("Box", (), {"__geo_interface__": shapely.box(20, 9, 21, 10).__geo_interface__})()
    assert {copy.site for copy in pair.copies(small)} == {"leaf"}


@pytest.mark.parametrize(
    "region",
    [
        5,
        (0, 0, 1),
        (1, 0, 0, 1),
        (0, 0, float("nan"), 1),
        ("a", 0, 1, 1),
        shapely.Polygon([(0, 0), (1, 1), (1, 0), (0, 1)]),
    ],
    ids=str,
)
def test_what_is_no_region(pair: vt.Tiling, region: object) -> None:
    """One message, with a remedy."""
    with pytest.raises(vt.ArgumentError, match="`region`") as caught:
        pair.copies(region)
    assert caught.value.fields == ("region",)
    assert caught.value.remedy


def test_a_region_of_millions_of_tiles_is_refused(pair: vt.Tiling) -> None:
    """At once, before memory is filled; a strip in a skew cell is no such region."""
    with pytest.raises(vt.ArgumentError, match="more than 100,000 copies of tiles lie in the box"):
        pair.copies((0, 0, 1e6, 1e6))
    skew = vt.Design("p1", (60, 6000, 0.6), vt.Site([vt.segment(5 + 3j, 25 + 11j)])).tessellate()
    assert len(skew.copies((0, 0, 600, 600))) == pytest.approx(100, abs=50)


# --- geometry -------------------------------------------------------------------------------------------------------


def test_tiles_are_geometries_for_others(pair: vt.Tiling) -> None:
    """shapely reads tiles, outlines and their copies; a tiling is a collection of features. Accuracy is as stated."""
    for tile in pair:
        read = shapely.geometry.shape(tile)
        assert read.is_valid
        assert read.equals(shapely.geometry.shape(tile.outline))
        nearly_exact = tile.to_shapely(accuracy=1e-3 * tile.outline.display_accuracy)
        assert shapely.hausdorff_distance(read, nearly_exact, densify=0.01) <= tile.outline.display_accuracy * 1.001
        low_x, low_y, high_x, high_y = tile.outline.bounds
        assert tile.outline.display_accuracy == 1e-4 * max(high_x - low_x, high_y - low_y)
    features = pair.__geo_interface__
    assert features["type"] == "FeatureCollection"
    assert [feature["properties"]["site"] for feature in features["features"]] == ["star", "leaf"]
    assert json.loads(json.dumps(features))["features"][0]["geometry"]["type"] == "Polygon"
    assert len(vt.Site([pair["leaf"]]).strokes) == 1  # and so they can be drawn again


def test_a_tile_in_parts_is_a_multipolygon() -> None:
    """Points of two sites in turn, whose tiles fall into islands; a site in a ring of another."""
    row = vt.Design("p1", (60, 10, 90), [vt.Site([vt.point(0), vt.point(30)]), vt.Site([vt.point(15), vt.point(45)])])
    assert [tile.__geo_interface__["type"] for tile in row.tessellate()] == ["MultiPolygon", "MultiPolygon"]
    holed = vt.Design("p1", (60, 60, 90), [vt.Site([vt.circle(30 + 30j, 20)]), vt.Site([vt.point(30 + 30j)])])
    ring, dot = holed.tessellate()
    assert len(ring.__geo_interface__["coordinates"]) == 2
    assert len(dot.__geo_interface__["coordinates"]) == 1


def test_copy_takes_a_triplet_and_refuses_what_is_no_operation(pair: vt.Tiling) -> None:
    """As text or as an Operation; one of another group is an error of ours."""
    leaf = pair["leaf"]
    assert leaf.copy("-y,x+2").start.tolist() == leaf.copy(vt.Operation.parse("-y,x+2")).start.tolist()
    for wrong in ("x+1/2,y", "x-y,x", "x+1/3,y"):
        with pytest.raises(vt.ArgumentError, match="no operation of the group p4m"):
            leaf.copy(wrong)
    with pytest.raises(vt.ArgumentError, match="not a coordinate triplet"):
        leaf.copy("x")


# --- pictures -------------------------------------------------------------------------------------------------------


def test_notebooks_show_everything(pair: vt.Tiling) -> None:
    """A tile, a tiling with the copies about it, a design, a product, a rendering."""
    assert pair[0]._repr_svg_().count("<path") == 2
    assert pair._repr_svg_().count("<path") > 2 * 2 + 4
    assert pair.design._repr_svg_().count("<path") == 3
    product = pair.make(vt.Job(sheet=(200, 100), kerf=0.2), "dxf")._repr_svg_()
    assert product.count("<path") > 4
    assert 'width="150mm"' in product
    widths = [float(width) for width in re.findall(r'stroke-width="([\d.]+)"', product)]
    assert len(widths) > 1
    assert min(widths) >= 0.25  # a pixel of a screen
    assert pair.render(size=40, renderer="cpu")._repr_png_().startswith(b"\x89PNG")


def test_rendering_to_memory_is_rendering_to_a_file(pair: vt.Tiling, tmp_path: Path) -> None:
    """The same bytes, the same pixels, with the same overlays; from the tiling and from its design."""
    options: vt.RenderOptions = {"size": (60, 40), "renderer": "cpu", "overlay": ["outline", "cell"]}
    path = tmp_path / "a.png"
    provenance = pair.render(path, **options)
    picture = pair.render(**options)
    assert picture.png == path.read_bytes() == vt.render(pair.design, **options).png
    assert (decoded(picture.png) == picture.pixels).all()
    assert picture.pixels.shape == (40, 60, 3)
    assert picture.provenance == provenance
    picture.save(tmp_path / "b.png")
    assert (tmp_path / "b.png").read_bytes() == picture.png
    assert {kind for kind, _ in chunks_of(picture.png)} >= {b"pHYs", b"tEXt"}
    told: list[tuple[int, int]] = []
    pair.render(size=50, renderer="cpu", progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (50, 50)


def test_plots_on_axes(pair: vt.Tiling) -> None:
    """Exact curves, one patch a tile; with a region, one for each copy; on axes that are given or the current ones."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    _, axes = plt.subplots()
    assert pair.plot(axes) is axes
    assert len(axes.patches) == 2
    leaf = pair["leaf"]
    path = axes.patches[1].get_path()
    curves = int((path.codes == path.CURVE3).sum()) // 2
    assert curves == int(leaf.outline.curved.sum())
    x0, y0, x1, y1 = leaf.outline.bounds
    extents = path.get_extents()
    assert (extents.x0, extents.y0, extents.x1, extents.y1) == pytest.approx((x0, y0, x1, y1))
    assert len(axes.collections) == 2
    plt.figure()
    current = plt.gca()
    assert pair.plot(region=(0, 0, 60, 60)) is current
    assert len(current.patches) == 2 + len(pair.copies((0, 0, 60, 60)))
    assert leaf.plot(current) is current
    plt.close("all")


def test_plots_need_matplotlib(pair: vt.Tiling, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where it is missing, the error says what to install."""
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    for draw in (pair.plot, pair[0].plot):
        with pytest.raises(vt.MissingLibraryError, match="pip install matplotlib") as caught:
            draw()
        assert isinstance(caught.value, ImportError)


# --- files ----------------------------------------------------------------------------------------------------------


def test_a_file_for_each_colour(pair: vt.Tiling, tmp_path: Path) -> None:
    """Named by the colour; the products say what is in each."""
    job = vt.Job(sheet=(200, 200), fit="frame", colours="files")
    written = pair.export(tmp_path / "wood.svg", job=job)
    names = [Path(path).name for path, _ in written]
    assert names == sorted(path.name for path in tmp_path.iterdir())
    assert names[-1] == "wood-frame.svg"
    assert len(names) > 2
    assert all(product is not None and product.drawing.layers for _, product in written)
    (single,) = pair.export(tmp_path / "exact.json")
    assert single == (str(tmp_path / "exact.json"), None)
    with pytest.raises(vt.JobError, match="several files need a name"):
        pair.export("-", job=job, file_format="svg")


def test_nothing_is_written_over_what_is_read(pair: vt.Tiling, tmp_path: Path) -> None:
    """The sheet's drawing, the art, the design itself, what a preflight looks at; by whatever is written."""
    sheet = tmp_path / "sheet.svg"
    sheet.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="90mm" height="90mm" viewBox="0 0 90 90">'
        '<path d="M0 0H90V90H0Z"/></svg>'
    )
    before = sheet.read_bytes()
    design = vt.Design("p4", 20, vt.Site([vt.segment(2 + 3j, 8 + 4j)], art="sheet.svg"), folder=tmp_path)
    with pytest.raises(vt.OutputError, match="is read for this, and would be overwritten"):
        design.tessellate().export(sheet, job=vt.Job(sheet=sheet))
    with pytest.raises(vt.OutputError, match="is read for this, and would be overwritten"):
        design.tessellate().export(sheet)
    picture = tmp_path / "art.png"
    picture.write_bytes(before)
    drawn = design.replace(sites=vt.Site([vt.segment(2 + 3j, 8 + 4j)], art="art.png"))
    file, other = tmp_path / "own.json", tmp_path / "own.toml"
    for name in (file, other):
        pair.design.save(name)
    kept = {path: path.read_bytes() for path in (sheet, picture, file, other)}
    for write in (
        lambda: drawn.tessellate().render(picture, size=20, renderer="cpu"),
        lambda: design.save(sheet),
        lambda: vt.Design.load(file).tessellate().export(file),
        lambda: vt.Design.load(other).replace(name="other").tessellate().export(other, file_format="svg"),
        lambda: vt.Design.load(file).scaled(2).tessellate().export(file),
        lambda: vt.Design.load(file).tessellate().make().save(file),
        lambda: drawn.tessellate().make(vt.Job(art="none")).save(picture),
        lambda: drawn.tessellate().render(size=20, renderer="cpu").save(picture),
        lambda: vt.preflight(sheet, marked=sheet),
    ):
        with pytest.raises(vt.OutputError, match="is read for this, and would be overwritten"):
            write()
    assert {path: path.read_bytes() for path in kept} == kept
    vt.Design.load(other).scaled(2).save(other)  # a design may be saved again
    vt.Design.load(other).tessellate().export(tmp_path / "other.json")


def test_a_template_gives_the_art_of_a_site(pair: vt.Tiling, tmp_path: Path) -> None:
    """Drawn on the page and put into the design, it is engraved where it was drawn."""
    design = pair.design.replace(folder=tmp_path)
    tiling = design.tessellate()
    art = tiling.template(tmp_path / "art.svg", "leaf")
    assert art.file == "art.svg"
    page = (tmp_path / "art.svg").read_text()
    assert "guide" in page
    with pytest.raises(vt.OutputError, match="exists already"):
        tiling.template(tmp_path / "art.svg")
    with pytest.raises(vt.UnknownNameError, match="no site"):
        tiling.template(tmp_path / "other.svg", "tree")
    with pytest.raises(vt.OutputError, match=r"suffix \.svg"):
        tiling.template(tmp_path / "art.dxf")
    # A stroke on the template's page, 7 mm right of and 9 mm above its lower left corner.
    drawn = '<path d="M7 {y}h3" stroke="#ff0000" fill="none"/></svg>'.format(
        y=float(page.split('height="')[1].split("mm")[0]) - 9
    )
    (tmp_path / "art.svg").write_text(page.replace("</svg>", drawn))
    star, leaf = design.sites
    with_art = design.replace(sites=[star, vt.Site(leaf.strokes, name="leaf", art=art)])
    product = with_art.tessellate().make()
    (engraved,) = (layer for layer in product.drawing.layers if layer.work == "engrave")
    cut = next(layer for layer in product.drawing.layers if layer.work == "cut")
    corner = min(tile.outline.bounds[0] for tile in pair), min(tile.outline.bounds[1] for tile in pair)
    place = complex(engraved.paths.start[0]) + complex(*corner) - complex(*cut.paths.bounds[:2])
    assert place == pytest.approx(art.placement.translate + 7 + 9j, abs=1e-9)


def test_reports_are_those_of_the_command(pair: vt.Tiling) -> None:
    """Speeds and pierces count; speeds that are none are refused."""
    job = vt.Job(sheet=(200, 200), colours="files")
    report = pair.report(job)
    assert report["speeds"]["cut"] == 10
    slow = pair.report(job, speeds={"cut": 1.0}, pierce_s=0.0)
    assert slow["time"] > report["time"] - 0.3 * report["cut"]["pierces"]
    assert pair.report()["pieces"]["count"] == 2
    for speeds in ({"cut": 0.0}, {"cut": float("nan")}, {"walk": 1.0}):
        with pytest.raises(vt.ArgumentError, match="`speeds`"):
            pair.report(speeds=speeds)
    with pytest.raises(vt.ArgumentError, match="`pierce_s`"):
        pair.report(pierce_s=-1)


def test_coupons_from_python(tmp_path: Path) -> None:
    """To a file and as a drawing; lengths as numbers or texts, kerfs as a range or a list."""
    drawing = vt.coupon(tmp_path / "c.dxf", thickness="3mm", kerfs="0.1:0.3:0.1", preset="lightburn")
    assert (tmp_path / "c.dxf").stat().st_size > 1000
    assert vt.preflight(tmp_path / "c.dxf").passed
    same = vt.coupon(thickness=3, kerfs=[0.1, 0.2, 0.3], preset="lightburn")
    assert (same.width, same.recipe) == (drawing.width, drawing.recipe)
    with pytest.raises(vt.OutputError, match="cannot tell the format"):
        vt.coupon(tmp_path / "c.png", thickness=3)
    for wrong in ({"thickness": "thick"}, {"thickness": 3, "plug": 1}, {"thickness": 3, "kerfs": "a:b:c"}):
        with pytest.raises(vt.ArgumentError):
            vt.coupon(**wrong)


def test_preflight_from_python(pair: vt.Tiling, tmp_path: Path) -> None:
    """A report, a picture with marks, remedies that name arguments; the package itself can be called as well."""
    package: Any = importlib.import_module("voronoi_tiles.preflight")
    path = tmp_path / "pair.svg"
    pair.export(path)
    report = vt.preflight(path, marked=tmp_path / "marked.svg")
    assert not report.passed
    assert repr(report).endswith("failed, duplicate>")
    assert "<circle" in (tmp_path / "marked.svg").read_text()
    assert package(path).document() == package.preflight(path).document() == report.document()
    assert package is vt.preflight
    assert not vt.preflight(path, layers="cut").passed
    with pytest.raises(vt.DrawingError, match="etch"):
        vt.preflight(path, layers="etch")
    for wrong in ({"tolerance": 0.0}, {"neck": -1.0}, {"gap": float("nan")}):
        with pytest.raises(vt.ArgumentError, match="`"):
            vt.Limits(**wrong)


def test_the_difference_picture(pair: vt.Tiling, tmp_path: Path) -> None:
    """White where the outlines and the image agree."""
    report = pair.check(samples=64, renderer="cpu")
    picture = pair.difference(report)
    assert np.unique(picture.pixels).tolist() == [255]
    picture.save(tmp_path / "diff.png")
    assert (decoded((tmp_path / "diff.png").read_bytes()) == 255).all()
    assert repr(report).startswith("<CheckReport: passed; exact on cpu")
    with pytest.raises(vt.UnknownNameError, match="no figure 'labls'"):
        report.figure("labls")


# --- what is proved stays so --------------------------------------------------------------------------------------


def test_what_was_proved_cannot_be_changed(pair: vt.Tiling) -> None:
    """Neither the outlines, nor the geometry that they were computed from."""
    outline, noded = pair[0].outline, pair.design.noded[0]
    names = ("start", "control", "end", "curved", "focus", "directrix", "neighbour", "ring_offsets", "lengths")
    for array in (*(getattr(outline, name) for name in names), noded.nodes, noded.segments, noded.elements):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = array[-1]
    copy = pair[0].copy("-y,x")
    with pytest.raises(ValueError, match="read-only"):
        copy.start[0] = 0


def test_a_check_is_evidence_for_its_own_design_alone(pair: vt.Tiling, tmp_path: Path) -> None:
    """Neither a file nor a picture takes that of another; reports are compared by what they are."""
    check = pair.check(samples=32, renderer="cpu")
    again = pair.design.tessellate()
    again.export(tmp_path / "good.svg", check=check)
    assert check != again.check(samples=32, renderer="cpu")
    assert {check: 1}[check] == 1
    vt.Design.loads(pair.design.to_toml(), name="equal").tessellate().json(check)
    other = vt.starter("p6m").tessellate()
    for use in (
        lambda: other.export(tmp_path / "bad.svg", check=check),
        lambda: other.export(tmp_path / "bad.dxf", job=vt.Job(), check=check),
        lambda: other.json(check),
        lambda: other.difference(check),
    ):
        with pytest.raises(vt.ArgumentError, match="of another design"):
            use()
    assert [path.name for path in tmp_path.iterdir()] == ["good.svg"]


def test_tilings_hold_names_and_slices(pair: vt.Tiling) -> None:
    """As they are indexed by them."""
    assert "leaf" in pair
    assert pair[1] in pair
    assert "tree" not in pair
    assert pair[0:2] == pair.tiles
    assert pair[0].bounds == pair[0].outline.bounds
    assert shapely.geometry.shape(pair.copies((0, 0, 1, 1))[0]).area > 0


def test_regions_of_all_kinds(pair: vt.Tiling) -> None:
    """The geometry of other libraries, and our own; what is too far, or none, is refused by name."""
    tile = pair[0]
    assert {copy.site for copy in pair.copies(tile)} == {"star", "leaf"}
    assert len(pair.copies(pair)) >= len(pair)
    for wrong in (
        (0, 0, 1e308, 1e308),
        (0, 0, 10**400, 1),
        shapely.Point(1e300, 1e300),
        np.zeros((4, 2)),
        Geometry({"type": "Polygon"}),
        Geometry({"type": "Blob", "coordinates": []}),
    ):
        with pytest.raises(vt.ArgumentError, match="`region`") as caught:
            pair.copies(wrong)
        assert "\n" not in str(caught.value)
    with pytest.raises(vt.ArgumentError, match="lose their digits"):
        tile.copy("x+10000000000000,y")


class Geometry:
    """What another library may hand over."""

    def __init__(self, geometry: dict[str, Any]) -> None:
        self.__geo_interface__ = geometry


def test_products_are_saved_and_notes_can_be_followed(pair: vt.Tiling, tmp_path: Path) -> None:
    """The bytes of `export`; a note never advises what is refused."""
    job = vt.Job(sheet=(200, 100), colours="layers")
    product = pair.make(job, "dxf")
    product.save(tmp_path / "a.dxf")
    pair.export(tmp_path / "b.dxf", job=job)
    assert (tmp_path / "a.dxf").read_bytes() == (tmp_path / "b.dxf").read_bytes()
    (note,) = product.notes
    assert "gap='1mm'" in note
    assert "once" not in note
    assert not pair.make(vt.Job(sheet=(200, 100), colours="layers", gap="1mm")).notes


def test_labels_that_the_font_lacks_are_told() -> None:
    """What is engraved instead."""
    design = vt.Design("p4", 60, vt.Site([vt.segment(5 + 3j, 25 + 11j)], name="été ☃"))
    assert design.tessellate().make(vt.Job(labels="site")).notes == (
        'the label of "été ☃" is engraved as "ete ?": the font has no more',
    )
    assert not design.tessellate().make(vt.Job(labels="number")).notes


def test_pictures_have_bounds(pair: vt.Tiling, tmp_path: Path) -> None:
    """Refused before memory and time are spent; words may come in any iterable."""
    with pytest.raises(vt.ArgumentError, match="too much memory"):
        pair.render(size=100_000, renderer="cpu")
    with pytest.raises(vt.ArgumentError, match="drawn as a blot"):
        pair.render(size=50, region=(0, 0, 300_000, 300_000), overlay="symmetry", renderer="cpu")
    with pytest.raises(vt.ArgumentError, match="too many copies to draw"):
        pair.render(size=30, region=(0, 0, 6e5, 6e5), overlay="outline", renderer="cpu")
    with pytest.raises(vt.OutputError, match=r"Give it the suffix \.png"):
        pair.render(tmp_path / "a.jpg", size=20, renderer="cpu")
    with pytest.raises(vt.JobError, match="64 times the cell"):
        pair.make(vt.Job(sheet=(300, 200), gap=99_999))
    one = pair.render(size=40, renderer="cpu", overlay=iter(["symmetry"]))  # type: ignore[call-overload]
    assert (one.pixels == pair.render(size=40, renderer="cpu", overlay="symmetry").pixels).all()
    assert (one.pixels != pair.render(size=40, renderer="cpu").pixels).any()


def test_a_name_that_is_not_utf_8_goes_into_pictures() -> None:
    """Escaped, as messages show it."""
    design = vt.starter("p4").replace(name="\udcff")
    picture = vt.render(design, size=20, renderer="cpu")
    assert (b"tEXt", b"Title\0\\xff (p4)") in chunks_of(picture.png)

"""Pictures: a proper colouring, borders and sites where they belong, overlays in their places, bands without seams."""

from __future__ import annotations

import itertools
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from helpers.examples import each_example, tiling
from helpers.png import chunks_of, decoded
from helpers.strategies import Dice, make_design
from numpy.typing import NDArray
from scipy import ndimage

import voronoi_tiles as vt
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.starters import starter_text
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.pictures.rendering import render
from voronoi_tiles.raster import image_colouring
from voronoi_tiles.raster import picture as raster_picture
from voronoi_tiles.raster.frame import Frame, cell_frame, rectangle_frame
from voronoi_tiles.raster.image_colouring import colour, neighbours
from voronoi_tiles.raster.line_coverage import coverage, dashed
from voronoi_tiles.raster.picture import INK, Picture, PictureStyle, default_region
from voronoi_tiles.raster.renderer import LabelImage, Renderer
from voronoi_tiles.raster.scene import Pattern

PLAIN = PictureStyle(border=1.0, site=0.0, supersampling=1)


def pattern_of(design: vt.Design) -> Pattern:
    """The sites of a design with their copies."""
    return Pattern(design.noded, design.group, design.lattice)


def pixels_of(picture: Picture) -> NDArray[np.uint8]:
    """All bands of a picture."""
    return np.concatenate(list(picture.bands()))


def segment_design(group: str = "p4") -> vt.Design:
    """One segment, in a cell of 60 mm."""
    site = {"name": "bird", "strokes": [{"segment": [[5, 3], [25, 11]]}]}
    return vt.Design.from_dict({"schema": 1, "group": group, "cell": {"a": 60.0}, "site": [site]})


@each_example
def test_neighbours_have_different_colours(name: str) -> None:
    """Every edge of the exact outlines parts two colours: the vector stage's neighbours are the judge."""
    tiles = tiling(name)
    pattern = pattern_of(tiles.design)
    colouring = colour(pattern)
    found = {tuple(row) for row in neighbours(pattern)[0].tolist()}
    for number, (placement, site) in enumerate((row, row.site) for row in pattern.placements):
        for beyond, operation in tiles.tiles[site].outline.neighbours:
            there = next(k for k, other in enumerate(pattern.sites) if other.name == beyond)
            k, i, j = pattern.locate(there, placement.operation @ operation)
            own = np.array([[number, 0, 0]])
            assert colouring.of(own) != colouring.of(np.array([[k, i, j]]))
            assert {(number, k, i, j), (k, number, -i, -j)} & found
    assert colouring.count <= 7


def sound_design(number: int) -> vt.Design:
    """A random design whose copies keep apart, without so many of them that samples could not tell."""
    for attempt in itertools.count():
        kind, document = make_design(Dice(np.random.default_rng([17, number, attempt])))
        if kind in {"long", "dense"}:
            continue
        design = vt.Design.from_dict(document)
        try:
            design.tessellate()
        except vt.TouchingCopiesError:
            continue
        return design
    raise AssertionError


@pytest.mark.parametrize("number", range(40))
def test_random_designs_are_coloured_properly(number: int) -> None:
    """No two samples of different copies side by side have one colour, in an image finer than the colouring's."""
    pattern = pattern_of(sound_design(number))
    image = Renderer("cpu").render(pattern, cell_frame(pattern.lattice, 150, centre=1.7 + 0.3j))
    shown = colour(pattern).of(image.copies)[image.first]
    for a, b, p, q in (
        (image.first[1:], image.first[:-1], shown[1:], shown[:-1]),
        (image.first[:, 1:], image.first[:, :-1], shown[:, 1:], shown[:, :-1]),
    ):
        assert not ((a != b) & (p == q)).any()


@pytest.mark.parametrize(
    ("group", "cell", "segment"),
    [
        ("pm", {"a": 60.0, "b": 1.0}, [[2.0, 0.1], [10.0, 0.4]]),
        ("p1", {"a": 10.0, "b": 10.0, "angle": 90.0}, [[0, 0], [300, 9.5]]),
        ("p2", {"a": 40.0, "b": 9.0, "angle": 90.0}, [[1, 0.5], [200, 3.5]]),
    ],
    ids=["narrow", "long", "both"],
)
def test_tiles_that_meet_their_own_translates(group: str, cell: dict[str, float], segment: list[list[float]]) -> None:
    """Narrow cells and long sites need larger periods: no tile meets its like in any of them."""
    site = {"strokes": [{"segment": segment}]}
    pattern = pattern_of(vt.Design.from_dict({"schema": 1, "group": group, "cell": cell, "site": [site]}))
    colouring = colour(pattern)
    pairs, _ = neighbours(pattern)
    here = np.insert(np.zeros((len(pairs), 2), np.intp), 0, pairs[:, 0], axis=1)
    there = pairs[:, 1:]
    assert (colouring.of(here) != colouring.of(there)).all()
    assert len(np.unique(palette(colouring.count), axis=0)) == colouring.count


@pytest.mark.parametrize("table", [1 << 26, 0], ids=["table", "sorted"])
@pytest.mark.parametrize("number", range(8))
def test_pairs_of_a_block_are_all_of_its_pairs(number: int, table: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever copies come together in blocks, of an oblique lattice too: each pair once, and no other."""
    monkeypatch.setattr(image_colouring, "_TABLE", table)
    rng = np.random.default_rng([31, number])
    cell = {"a": 30.0, "b": 50.0, "angle": 2.0 if number % 2 else 80.0}
    sites = [{"name": str(k), "strokes": [{"point": [9 * k, 0.1]}]} for k in range(3)]
    pattern = pattern_of(vt.Design.from_dict({"schema": 1, "group": "p2", "cell": cell, "site": sites}))
    assert len(pattern.placements) == 6
    copies = np.unique(rng.integers((0, -40, -7), (6, 3, 9), (60, 3)), axis=0)
    rows, expected = [], set()
    for block in range(20):
        inside = copies[np.sort(rng.choice(len(copies), rng.integers(1, 12), replace=False))]
        rows.append(np.insert(inside, 0, block, axis=1))
        for first, second in itertools.combinations(inside.tolist(), 2):
            expected.add((first[0], second[0], second[1] - first[1], second[2] - first[2]))
    found = image_colouring._pairs_in_blocks(np.concatenate(rows)[:, 1:], np.concatenate(rows)[:, 0], pattern)
    assert found.tolist() == sorted(map(list, expected))


def test_a_wrong_colouring_is_seen() -> None:
    """The judge of colourings is no rubber stamp: two colours do not do for four tiles about a point."""
    pattern = pattern_of(segment_design())
    colouring = colour(pattern)
    pairs, crowd = neighbours(pattern)
    assert colouring.count >= crowd > 2
    colours = colouring.colour[:, 0, 0] % 2
    assert (colours[pairs[:, 0]] == colours[pairs[:, 1]]).any()


def test_the_palette_has_different_colours() -> None:
    """Beyond the chosen ones as well."""
    rows = palette(40).tolist()
    assert len({tuple(row) for row in rows}) == 40
    distances = [np.abs(np.subtract(p, q)).max() for p, q in itertools.combinations(rows[:8], 2)]
    assert min(distances) > 30


def test_borders_are_where_owners_change() -> None:
    """With nothing else drawn a pixel is ink if and only if one of its eight neighbours has another owner's colour."""
    pattern = pattern_of(segment_design())
    region = (0.0, 0.0, 60.0, 60.0)
    picture = Picture(pattern, region, 90, 90, renderer=Renderer("cpu"), style=PLAIN)
    shown = pixels_of(picture)
    frame = rectangle_frame(region, 90, 90).window(-1, -1, 92, 92)
    image = Renderer("cpu").render(pattern, frame)
    owner = colour(pattern).of(image.copies)[image.first]
    around = [owner[1 + dy : 91 + dy, 1 + dx : 91 + dx] for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    uniform = np.all([part == around[4] for part in around], axis=0)
    ink = (shown == INK).all(axis=-1)
    assert not ink[uniform].any()
    # Sobel sees nothing where opposite sides are alike, as at the end of a spike.
    assert ink[~uniform].mean() > 0.97
    assert (shown[~ink] == palette(8)[owner[1:91, 1:91][~ink]]).all()


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (7, 2), (40, 50)])
def test_changes_are_those_of_the_sobel_operator(shape: tuple[int, int]) -> None:
    """Scipy's operator is the judge, with values of 24 bits."""
    rng = np.random.default_rng(shape)
    values = np.array([0, 1, (1 << 24) - 1], np.int32)[rng.integers(0, 3, shape) * (rng.random(shape) < 0.4)]
    for axis, found in enumerate((raster_picture._sobel(values.T).T, raster_picture._sobel(values))):
        expected = ndimage.sobel(values, axis=axis, mode="nearest") != 0
        assert (found == expected).all()
        assert expected.any() == (shape[axis] > 1)


def test_sites_are_drawn_on_top() -> None:
    """Pixels on the stroke are ink, pixels away from strokes and borders are a flat colour."""
    design = segment_design()
    style = PictureStyle(border=1.0, site=3.0, supersampling=2)
    picture = Picture(pattern_of(design), (0.0, 0.0, 30.0, 30.0), 300, 300, renderer=Renderer("cpu"), style=style)
    shown = pixels_of(picture)
    for t in np.linspace(0.02, 0.98, 30):
        x, y = 5 + 20 * t, 3 + 8 * t
        assert tuple(shown[int((30 - y) * 10), int(x * 10)]) == INK
    assert tuple(shown[300 - 100, 50]) in {tuple(row) for row in palette(4).tolist()}


def test_bands_have_no_seams(monkeypatch: pytest.MonkeyPatch) -> None:
    """A picture in many bands is the picture in one, to the bit."""
    design = segment_design("p6")
    whole = pixels_of(Picture(pattern_of(design), (0, 0, 50, 40), 125, 100, renderer=Renderer("cpu")))
    monkeypatch.setattr(raster_picture, "_BAND", 3000)
    bands = list(Picture(pattern_of(design), (0, 0, 50, 40), 125, 100, renderer=Renderer("cpu")).bands())
    assert len(bands) > 5
    assert np.array_equal(np.concatenate(bands), whole)


@pytest.mark.parametrize("group", ["p1", "pm", "p4", "p6m", "cmm"])
def test_the_default_region_repeats_seamlessly(group: str) -> None:
    """Its right side continues its left side, and its top its bottom, unless the cell is oblique."""
    design = vt.Design.loads(starter_text(group, None))
    pattern = pattern_of(design)
    x0, y0, x1, y1 = default_region(pattern)
    x, y = pattern.lattice.fractional(np.array([complex(x1 - x0, 0.0), complex(0.0, y1 - y0)]))
    whole = np.abs(np.concatenate((x, y)) - np.round(np.concatenate((x, y)))).max() < 1e-12
    assert whole == (group != "p1")


def test_lines_are_antialiased_by_area() -> None:
    """The coverage of lines, added up, is their area; shapely knows it. Nothing is drawn far from them."""
    frame = rectangle_frame((0.0, 0.0, 40.0, 30.0), 400, 300)
    segments = np.array([[3 + 4j, 31 + 22j], [35 + 5j, 35 + 5j], [-10 + 20j, 12 + 20.35j]])
    drawn = coverage(segments, 6.0, frame)
    pens = [shapely.LineString([(p.real, p.imag), (q.real, q.imag)]).buffer(0.3) for p, q in segments.tolist()]
    area = shapely.union_all(pens).intersection(shapely.box(0, 0, 40, 30)).area
    assert drawn.sum() * 0.01 == pytest.approx(area, rel=5e-3)
    y, x = np.nonzero(drawn)
    points = shapely.points((x + 0.5) / 10, 30 - (y + 0.5) / 10)
    assert shapely.distance(points, shapely.union_all(pens)).max() < 0.11
    assert drawn.max() == 1.0


def test_dashes() -> None:
    """Dashes cover about dash / (dash + gap) of a line, begin and end with it, and leave points alone."""
    pieces = dashed(np.array([[0j, 100 + 0j], [5 + 5j, 5 + 5j]]), 6.0, 4.0)
    assert pieces[0, 0] == 0
    long = pieces[pieces.imag[:, 0] == 0]
    assert np.abs(long[-1, 1] - 100) < 1e-9
    assert np.abs(long[:, 1] - long[:, 0]).sum() == pytest.approx(64, abs=2)
    assert np.isfinite(pieces).all()


def test_the_overlay_of_symmetry_elements(tmp_path: Path) -> None:
    """In p4g a mirror runs through (0, 1/2) and (1/2, 0): its pixels are red; the fourfold centre carries a symbol."""
    site = {"strokes": [{"segment": [[8, 6], [16, 9]]}]}
    design = vt.Design.from_dict({"schema": 1, "group": "p4g", "cell": {"a": 60.0}, "site": [site]})
    plain, marked = tmp_path / "plain.png", tmp_path / "marked.png"
    options: dict[str, Any] = {"size": 300, "region": (-30.0, -30.0, 30.0, 30.0), "renderer": "cpu"}
    render(design, plain, **options)
    render(design, marked, overlay=["symmetry"], **options)
    before, after = decoded(plain.read_bytes()), decoded(marked.read_bytes())
    changed = (before != after).any(axis=-1)
    for x, y in ((10.0, 20.0), (-10.0, 20.0), (20.0, 10.0), (-17.0, -13.0)):
        red, green, blue = after[int((30 - y) * 5), int((x + 30) * 5)].astype(int)
        assert red > green + 60
        assert red > blue + 60
    assert changed[150 - 8 : 150 + 8, 150 - 8 : 150 + 8].any()
    assert 0.02 < changed.mean() < 0.3


def test_the_overlay_of_outlines_lies_on_the_borders(tmp_path: Path) -> None:
    """Where the exact outline is drawn the picture without it has ink, or nearly."""
    path = tmp_path / "outline.png"
    design = segment_design()
    render(design, path, size=400, region=(0.0, 0.0, 60.0, 60.0), overlay=["outline"], renderer="cpu")
    marked = decoded(path.read_bytes()).astype(int)
    pink = (marked[..., 0] - marked[..., 1] > 130) & (marked[..., 2] > 80)
    style = PictureStyle(border=5.0, site=0.0, supersampling=2)
    bare = Picture(pattern_of(design), (0.0, 0.0, 60.0, 60.0), 400, 400, renderer=Renderer("cpu"), style=style)
    ink = (pixels_of(bare) == INK).all(axis=-1)
    assert pink.sum() > 1000
    assert ink[pink].mean() > 0.995


def test_art_is_drawn_on_every_copy_in_the_place_of_the_strokes(tmp_path: Path) -> None:
    """In pg a line of art is dark on the glided and the translated copies, mirrored; the strokes are not there."""
    svg = '<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="40mm" viewBox="0 0 40 40">{}</svg>'
    (tmp_path / "face.svg").write_text(svg.format('<path d="M10 30 L16 22" stroke="#000" fill="none"/>'))
    site = {"strokes": [{"segment": [[5, 4], [20, 12]]}], "art": "face.svg"}
    design = {"schema": 1, "group": "pg", "cell": {"a": 50.0, "b": 40.0}, "site": [site]}
    (tmp_path / "bird.json").write_text(json.dumps(design))
    options: dict[str, Any] = {"size": 1000, "region": (0.0, 0.0, 50.0, 50.0), "renderer": "cpu"}
    render(vt.Design.load(tmp_path / "bird.json"), tmp_path / "art.png", overlay=["art"], **options)
    pixels = decoded((tmp_path / "art.png").read_bytes())

    def dark(x: float, y: float) -> bool:
        return int(pixels[int((50 - y) * 20), int(x * 20)].sum()) < 200

    drawn = np.linspace(10 + 10j, 16 + 18j, 9)  # the page's y runs down
    for x, y in zip(drawn.real, drawn.imag, strict=True):
        assert dark(x, y)
        assert dark(50 - x, y + 20)  # the glide's image: -x, y + b/2
        assert not dark(x, y + 20)
    assert dark(10.0, 10.0)
    assert not dark(12.5, 8.0)  # the middle of the stroke


def test_a_point_is_seen(tmp_path: Path) -> None:
    """An isolated point, and its image by a half turn, is a dot three strokes wide; the end of a segment is not."""
    site = {"strokes": [{"point": [10, 10]}, {"segment": [[20, 30], [26, 30]]}]}
    design = vt.Design.from_dict({"schema": 1, "group": "p2", "cell": {"a": 60, "b": 60, "angle": 90}, "site": [site]})
    render(design, tmp_path / "x.png", size=660, region=(0.0, 0.0, 60.0, 60.0), renderer="cpu")
    ink = (decoded((tmp_path / "x.png").read_bytes()) == INK).all(axis=-1)  # eleven pixels a millimetre
    for x, y in ((110, 660 - 110), (550, 110)):
        assert ink[y, x - 4 : x + 4].all()
        assert ink[y - 4 : y + 4, x].all()
        assert not ink[y, x + 6]
    assert not ink[330 + 4, 220]


def test_art_that_is_not_there(tmp_path: Path) -> None:
    """A picture with the art of a design that has none is refused, and no file is written."""
    with pytest.raises(DesignError, match=r"site\[0\]\.art.*no art to draw"):
        render(segment_design(), tmp_path / "x.png", overlay=["art"])
    assert not list(tmp_path.iterdir())


def test_what_a_picture_says_of_itself(tmp_path: Path) -> None:
    """Its texts name the program, the design and who rendered it; its resolution is the design's true size."""
    path = tmp_path / "bird.png"
    design = segment_design()
    provenance = render(design, path, size=(240, 120), region=(0.0, 0.0, 120.0, 60.0), renderer="cpu")
    chunks = chunks_of(path.read_bytes())
    texts = dict(body.split(b"\0", 1) for kind, body in chunks if kind == b"tEXt")
    assert texts[b"Software"].startswith(b"voronoi-tiles ")
    assert json.loads(texts[b"Source"])["group"] == "p4"
    assert texts[b"Renderer"].decode() == str(provenance)
    assert "float64" in str(provenance)
    (density,) = (body for kind, body in chunks if kind == b"pHYs")
    assert int.from_bytes(density[:4], "big") == 2000  # 240 pixels for 120 mm


def test_a_picture_names_all_who_rendered_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where OpenGL fails between two bands, the picture says so, whoever began it."""
    path = tmp_path / "bird.png"
    seen: list[int] = []

    def rendered(renderer: Renderer, pattern: Pattern, frame: Frame) -> LabelImage:
        image = genuine(renderer, pattern, frame)
        seen.append(frame.height)
        return image if len(seen) > 1 else replace(image, provenance=replace(image.provenance, renderer="gl"))

    genuine = Renderer.render
    monkeypatch.setattr(Renderer, "render", rendered)
    monkeypatch.setattr(raster_picture, "_BAND", 3000)
    render(segment_design(), path, size=60, renderer="cpu")
    texts = dict(body.split(b"\0", 1) for kind, body in chunks_of(path.read_bytes()) if kind == b"tEXt")
    first, second = texts[b"Renderer"].decode().split(", then ")
    assert first.startswith("exact on gl")
    assert second.startswith("exact on cpu")
    assert len(seen) > 2


def test_the_region_grows_to_the_shape_of_the_picture(tmp_path: Path) -> None:
    """Pixels are squares: a square region in a wide picture shows more to both sides."""
    path = tmp_path / "wide.png"
    design = segment_design()
    render(design, path, size=(200, 100), region=(0.0, 0.0, 30.0, 30.0), renderer="cpu")
    picture = Picture(pattern_of(design), (-15.0, 0.0, 45.0, 30.0), 200, 100, renderer=Renderer("cpu"))
    assert np.array_equal(decoded(path.read_bytes()), pixels_of(picture))


@pytest.mark.parametrize(
    "options",
    [
        {"size": 0},
        {"size": 200_000},
        {"size": (10, 0)},
        {"region": (0, 0, 0, 5)},
        {"region": (0, 0, float("nan"), 5)},
        {"region": (0, 0, 1e9, 1e9)},
        {"region": (0, 0, 1e12, 1e12)},
        {"region": (0, 0, 1e300, 1e300)},
        {"region": (1e9, 1e9, 1e9 + 1e-6, 1e9 + 1e-6)},
    ],
)
def test_impossible_pictures_are_refused(options: dict[str, Any], tmp_path: Path) -> None:
    """One message, and no file."""
    with pytest.raises((vt.ArgumentError, vt.DesignError)):
        render(segment_design(), tmp_path / "x.png", renderer="cpu", **options)
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_overlay(tmp_path: Path) -> None:
    """Is named."""
    with pytest.raises(ValueError, match="tea"):
        render(segment_design(), tmp_path / "x.png", overlay=["tea"])


def test_the_memory_of_a_large_picture_is_that_of_a_band() -> None:
    """20,000 x 20,000 pixels are rendered in bands of at most some 4 million samples."""
    picture = Picture(pattern_of(segment_design()), (0, 0, 60, 60), 20_000, 20_000, renderer=Renderer("cpu"))
    assert picture.fine == 1
    rows = max(1, raster_picture._BAND // picture.frame.width)
    assert rows * picture.frame.width <= 1 << 22


def test_the_picture_of_no_differences_is_white() -> None:
    """And that of a broken outline is not, near the place."""
    tiling = segment_design().tessellate()
    report = tiling.check(samples=64, renderer="cpu")
    picture = tiling.difference(report)
    assert (picture.pixels == 255).all()
    assert (decoded(picture.png) == 255).all()


def test_the_picture_of_differences() -> None:
    """Marks lie where the report says, modulo the lattice; the report goes with the picture."""
    tiling = segment_design().tessellate()
    outline = tiling.tiles[0].outline
    for points in (outline.start, outline.end):
        points.setflags(write=True)  # nobody else can break an outline
    outline.start[0] += 0.5
    outline.end[-1] += 0.5
    report = tiling.check(samples=64, renderer="cpu")
    assert not report.passed
    picture = tiling.difference(report)
    shown = decoded(picture.png).astype(int)
    assert (shown == picture.pixels).all()
    marked = (shown.max(axis=-1) - shown.min(axis=-1) > 60) | (shown.max(axis=-1) < 40)
    assert marked.any()
    (text,) = (body for kind, body in chunks_of(picture.png) if kind == b"tEXt" and body.startswith(b"Report"))
    assert json.loads(text.split(b"\0", 1)[1])["passed"] is False
    x0, y1 = report.frame.origin.real, report.frame.origin.imag + 60
    scale = shown.shape[1] / 60
    place = report.figure("equidistance").marks.place[0]
    column = int((place.real - x0) % 60 * scale)
    row = int((y1 - place.imag) % 60 * scale)
    assert marked[max(row - 3, 0) : row + 4, max(column - 3, 0) : column + 4].any()


@pytest.mark.parametrize("cells", [10**3, 10**9])
def test_sites_far_from_the_origin_have_as_many_neighbours(cells: int) -> None:
    """Their images lie far from each other, as numbers; which are neighbours is the same."""
    here, far = (
        vt.Design.from_dict(
            {"schema": 1, "group": "p4", "cell": {"a": 64.0}, "site": [{"strokes": [{"point": [8.0 + shift, 4.0]}]}]}
        )
        for shift in (0.0, 64.0 * cells)
    )
    found = [neighbours(pattern_of(design)) for design in (here, far)]
    assert len(found[0][0]) == len(found[1][0]) > 0
    assert found[0][1] == found[1][1]

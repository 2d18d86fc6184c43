"""Nested pieces: all that belong, none changed, too near or off the sheet, and the same again from the file."""

from __future__ import annotations

import html
import json
import os
import re
from collections import Counter
from dataclasses import replace
from functools import cache
from io import BytesIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import shapely
from helpers.cutting import contour_shapes, cuts, squares
from helpers.examples import tiling
from helpers.sheets import flattened, xy

from voronoi_tiles import Design, Tiling
from voronoi_tiles.fabrication import nested_sheets, nesting, packed_sheets
from voronoi_tiles.fabrication.exporting import Exported
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.layout import Layout, Piece
from voronoi_tiles.fabrication.nest_growth import most_laid
from voronoi_tiles.fabrication.nest_kinds import kinds_of
from voronoi_tiles.fabrication.nest_patterns import piece_patterns
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces, most_pieces
from voronoi_tiles.fabrication.nested_pieces import as_laid, misplaced, placed
from voronoi_tiles.fabrication.nested_sheets import Nesting, counted_sheets
from voronoi_tiles.fabrication.no_fit import no_fit
from voronoi_tiles.fabrication.product import _Plan, make_several
from voronoi_tiles.formats.recipe import recipe_of

HOOKS = """schema = 1
group = "pg"
cell = { a = 40, b = 50 }
[[site]]
strokes = [{ segment = [[5, 4], [16, 20]] }]
"""
"""Tiles of which a sheet holds more where they are nested: every other one is turned over."""

JOB: dict[str, Any] = {"sheet": (160.0, 110.0), "margin": 5.0, "kerf": 0.2}
NESTED: dict[str, Any] = {**JOB, "layout": "nested", "effort": 1}


OFFCUT = [[(2, 2), (118, 2), (118, 50), (70, 50), (70, 88), (2, 88)], [(40, 30), (52, 30), (52, 42), (40, 42)]]
"""An angle of a sheet, and a hole in it: x and y up; millimetres."""


def offcut(folder: Path) -> Path:
    """A drawing of it."""
    path = folder / "offcut.svg"
    data = " ".join("M" + "L".join(f"{x} {90 - y}" for x, y in ring) + "Z" for ring in OFFCUT)
    page = 'width="120mm" height="90mm" viewBox="0 0 120 90"'
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {page}><path d="{data}"/></svg>')
    return path


@cache
def hooks() -> Tiling:
    """The tiling of HOOKS."""
    return Design.loads(HOOKS).tessellate()


@cache
def nested() -> str:
    """An SVG file of nested pieces, made once for all tests."""
    file = BytesIO()
    hooks().make(Job(**JOB, layout="auto")).write(file)
    return file.getvalue().decode()


def saved(folder: Path) -> Path:
    """The same in a file."""
    path = folder / "nested.svg"
    path.write_text(nested(), encoding="utf-8")
    return path


def layout_of(tiles: Tiling, **job: Any) -> Layout:
    """How a job lays pieces."""
    return _Plan.of(tiles.design, tiles.tessellation, Job(**job), "svg").layout


def test_a_nested_sheet_holds_more_pieces_all_apart_and_on_it(tmp_path: Path) -> None:
    """More than the tessellation holds; by shapely all keep gap and margin, and have one area; some are turned over."""
    made = hooks().make(Job(**JOB, layout=saved(tmp_path)))
    shapes = contour_shapes(cuts(made))
    assert len(shapes) > hooks().make(Job(**JOB)).pieces.count
    assert shapely.total_bounds(shapes)[:2].min() >= 5 - 1e-6
    assert (shapely.total_bounds(shapes)[2:] <= np.array([155.0, 105.0]) + 1e-6).all()
    one, two = np.triu_indices(len(shapes), 1)
    assert shapely.distance(np.array(shapes)[one], np.array(shapes)[two]).min() >= 1 - 1e-4
    assert np.ptp(shapely.area(shapes)) < 1e-2
    assert 0 < made.pieces.turned_over.sum() < made.pieces.count


def test_a_file_lays_its_pieces_again_byte_for_byte(tmp_path: Path) -> None:
    """Whatever the format: places are in the recipe, and a search that the clock ends is not made again."""
    path = saved(tmp_path)
    for form in ("svg", "dxf", "pdf", "lbrn2"):
        first, again = tmp_path / f"first.{form}", tmp_path / f"again.{form}"
        hooks().export(first, job=Job(**JOB, layout=path))
        hooks().export(again, job=Job(**JOB, layout=first))
        assert again.read_bytes() == first.read_bytes()
    assert (tmp_path / "first.svg").read_bytes() == path.read_bytes()
    recipe = recipe_of(path.read_bytes())
    assert json.loads(recipe["job"])["layout"] == "nested"


def test_with_a_grain_pieces_lie_as_in_the_picture_or_upside_down() -> None:
    """Each piece is turned against one of the picture by 0 or 180 degrees, and is so of each orientation there is."""
    tiles = tiling("p4-hook")
    picture = layout_of(tiles, **JOB)
    laid, _ = Nesting.of(picture, Job(**NESTED, grain=True)).sheet(search=False)
    turns = Counter(round(piece.turn) % 180 for piece in laid.pieces)
    own = {round(np.degrees(np.angle(picture.tiles.page.after(motion)[0]))) % 180 for motion in picture.period.motion}
    assert set(turns) == own == {0, 90}
    assert all(abs(piece.turn - round(piece.turn)) < 1e-6 for piece in laid.pieces)
    assert min(turns.values()) > 0


@pytest.mark.parametrize("name", ["p4-hook", "p31m-gem"])
def test_a_search_begins_with_the_tessellation_where_it_lies(name: str) -> None:
    """What stands for its pieces is around them, turned over or not."""
    layout = layout_of(tiling(name), **JOB)
    kinds = kinds_of(layout.tiles, 1.0, layout.budget.measured, grain=False)
    places = as_laid(layout, layout.tiles, kinds, 0j, grain=False)
    rings = [kinds[k].item.ring * np.exp(1j * np.radians(turn)) + shift for k, turn, shift in places.rows()]
    around = [shapely.Polygon(np.column_stack((z.real, z.imag))) for z in rings]
    for shape, contour in zip(around, contour_shapes(layout.contours.paths), strict=True):
        assert shape.buffer(0.02).contains(contour)
    assert len(around) == len(layout.copies.tile) > 4


BIRD = """schema = 1
group = "p4"
cell = { a = 60 }
[[site]]
strokes = [{ catmull_rom = [[6, 9], [22, 5], [27, 17], [13, 25]] }]
"""
"""Tiles that nearly fill a sheet as they lie: the polygons around them reach beyond it."""


@pytest.mark.parametrize("search", [{"layout": "auto"}, {"layout": "nested", "effort": 1}])
def test_no_fewer_are_nested_than_lie_as_in_the_tessellation(
    search: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A search begins with its places, exactly where they are; so many are also laid where they are counted."""
    monkeypatch.setattr(nested_sheets, "has_search", lambda: False)
    tiles = Design.loads(BIRD).tessellate()
    job: dict[str, Any] = {"sheet": (130.0, 110.0), "margin": 4.0, "kerf": 0.15}
    count = tiles.make(Job(**job)).pieces.count
    assert [note for note in tiles.make(Job(**job, **search)).notes if f"would be {count} pieces" in note]
    assert tiles.make(Job(**job, **search, count=count)).pieces.count == count


def moved(layout: Layout, k: int, by: complex) -> Layout:
    """A layout of which one piece lies elsewhere."""
    pieces = list(layout.pieces)
    pieces[k] = pieces[k]._replace(shift=pieces[k].shift + by)
    return placed(layout, pieces)


def test_a_piece_that_is_too_near_or_off_the_sheet_is_seen(tmp_path: Path) -> None:
    """The check that the search is not trusted without: by as little as a hundredth of a millimetre."""
    laid = layout_of(hooks(), **JOB, layout=saved(tmp_path))
    assert len(misplaced(laid)) == 0
    wide = replace(laid, job=replace(laid.job, margin=0.0))
    shapes = contour_shapes(laid.contours.paths)
    least = min(shapes[0].distance(other) for other in shapes[1:])
    nearest = min(range(1, len(shapes)), key=lambda k: shapes[0].distance(shapes[k]))
    start, end = (complex(*point) for point in shapely.shortest_line(shapes[0], shapes[nearest]).coords)
    way = (end - start) / abs(end - start)
    assert misplaced(moved(wide, 0, way * (least - 1 + 0.01))).tolist() == [[0, nearest]]
    assert len(misplaced(moved(wide, 0, way * (least - 1 - 0.001)))) == 0
    here, there = shapes[0].centroid, shapes[nearest].centroid
    assert [0, nearest] in misplaced(moved(wide, 0, complex(there.x - here.x, there.y - here.y))).tolist()
    left = laid.contours.paths.bounds[0]
    first = int(np.argmin([shape.bounds[0] for shape in shapes]))
    assert [first, first] in misplaced(moved(laid, first, 5 - 0.01 - left)).tolist()


def test_places_that_do_not_fit_a_job_are_refused(tmp_path: Path) -> None:
    """Whoever lays a file's pieces with a wider kerf, or on a smaller sheet, hears of it; files without places too."""
    path, tiles = saved(tmp_path), hooks()
    for other in ({"kerf": 1.2}, {"sheet": (120.0, 110.0)}, {"gap": 4.0}):
        with pytest.raises(JobError, match=r"pieces in .*nested.svg.* would leave this job's sheet, or be nearer"):
            tiles.make(Job(**{**JOB, **other}, layout=path))
    with pytest.raises(JobError, match="of another design"):
        squares().make(Job(**JOB, layout=path))
    plain = tmp_path / "plain.svg"
    plain.write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    with pytest.raises(JobError, match="no file of tiles of ours"):
        tiles.make(Job(**JOB, layout=plain))
    with pytest.raises(JobError, match="cannot be read: No such file"):
        tiles.make(Job(**JOB, layout=tmp_path / "none.svg"))
    broken = tmp_path / "broken.svg"
    for wrong in ('places="[[nan, ', 'numbered_from="0" places="[[', 'numbered_from="one" places="[['):
        broken.write_text(nested().replace('places="[[', wrong))
        with pytest.raises(JobError, match="damaged"):
            tiles.make(Job(**JOB, layout=broken))
    with pytest.raises(OSError, match=r"nested\.svg"):
        tiles.export(path, job=Job(**JOB, layout=path))


@pytest.mark.parametrize(
    ("places", "message"),
    [
        ("[]", "damaged"),
        ("{}", "damaged"),
        ("[" * 60 + "]" * 60, "damaged"),
        ("[[0, 0, 0, 1e300, 5]]", "damaged"),
        (f"[[0, 0, 0, 1{'0' * 400}, 5]]", "damaged"),
        ("[[0, 0, 400, 50, 50]]", "damaged"),
        ("[[0, 0, 0, 50, NaN]]", "damaged"),
        ("[[0.5, 0, 0, 50, 50]]", "damaged"),
        ("[[0, 9, 0, 50, 50]]", "damaged"),
        ("[[0, 0, 0, 50]]", "damaged"),
        ("[[3, 0, 0, 50, 50]]", "another design"),
        ("[[0, 0, 0, 0, 0]]", "1 piece in"),
        (json.dumps([[0, 0, 0, 50, 50]] * 1001), "1,001 places, and 1,000 are the most"),
        (None, "damaged"),
    ],
)
def test_places_that_cannot_be_are_refused(places: str | None, message: str, tmp_path: Path) -> None:
    """Whatever stands there; also where a file that was nested has lost them."""
    text = re.sub(' places="[^"]*"', "" if places is None else f' places="{html.escape(places)}"', nested())
    path = tmp_path / "broken.svg"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(JobError, match=message):
        hooks().make(Job(**JOB, layout=path))


def test_pieces_are_not_laid_across_the_grain(tmp_path: Path) -> None:
    """A file that was nested without a grain has turns that one forbids; what was nested with it fits."""
    turned = re.sub(' places="[^"]*"', ' places="[[0, 0, 30.0, 80, 55]]"', nested())
    path = tmp_path / "turned.svg"
    path.write_text(turned, encoding="utf-8")
    assert hooks().make(Job(**JOB, layout=path)).pieces.count == 1
    with pytest.raises(JobError, match=r"1 piece in .* would lie across the grain"):
        hooks().make(Job(**JOB, layout=path, grain=True))
    path.write_text(turned.replace("30.0", "180.0"), encoding="utf-8")
    assert hooks().make(Job(**JOB, layout=path, grain=True)).pieces.count == 1


def test_it_is_said_where_a_file_was_made_of_another_design(tmp_path: Path) -> None:
    """Its places may fit all the same, as after a small change."""
    changed = Design.loads(HOOKS.replace("20]", "20.01]")).tessellate()
    made = changed.make(Job(**JOB, layout=saved(tmp_path)))
    assert [note for note in made.notes if "was made of another design" in note]
    assert not [note for note in hooks().make(Job(**JOB, layout=saved(tmp_path))).notes if "another design" in note]


def test_a_file_as_the_tessellation_lies_is_laid_so_again(tmp_path: Path) -> None:
    """`layout` takes any file of tiles of ours."""
    for name, job in (("one.svg", Job(**JOB)), ("two.svg", Job(**JOB, layout=tmp_path / "one.svg"))):
        tiling("p4-hook").export(tmp_path / name, job=job)
    assert (tmp_path / "two.svg").read_bytes() == (tmp_path / "one.svg").read_bytes()


def test_labels_and_art_turn_with_their_pieces(tmp_path: Path) -> None:
    """A label lies within its piece, wherever that is nested."""
    made = hooks().make(Job(**JOB, layout=saved(tmp_path), labels="number", label_height=2))
    shapes = shapely.union_all(contour_shapes(cuts(made)))
    (engraved,) = (layer.paths for layer in made.drawing.layers if layer.work != "cut")
    points = shapely.points(engraved.start.real, engraved.start.imag)
    assert len(points) > made.pieces.count
    assert shapely.contains(shapes, points).all()


@pytest.mark.parametrize(
    ("job", "message"),
    [
        ({"sheet": None}, "needs a sheet"),
        ({"fit": "clip"}, "nests whole tiles"),
        ({"gap": 0.0}, "would cut where pieces touch twice"),
        ({"pieces": 9}, "nests in full size, and `pieces` scales the tessellation .* Use `count=9`"),
        ({"pack": True, "layout": "a.svg"}, "of a file, .* Leave out `pack`, .* give the size of the stock as `sheet`"),
        ({"offset": 3j}, "by an `offset`"),
        ({"colours": 3}, "parts neighbours"),
        ({"edges": "once", "kerf": 0.0}, "`layout` needs `edges='pieces'`"),
        ({"layout": "nestled"}, "is unknown"),
        ({"effort": 0}, "Give seconds, from 1 to 86,400"),
        ({"effort": "soon"}, "Give seconds, from 1 to 86,400"),
        ({"seed": -1}, "whole number"),
    ],
)
def test_jobs_that_cannot_be_nested_are_refused(job: dict[str, Any], message: str) -> None:
    """In one message, with a remedy, before anything is computed."""
    with pytest.raises(JobError, match=message):
        Job(**{**NESTED, **job})


def test_too_many_pieces_are_not_nested() -> None:
    """They would take for ever: `nested` says so, `auto` leaves them as they are."""
    job: dict[str, Any] = {"sheet": (800.0, 800.0), "gap": 1.0}
    with pytest.raises(JobError, match=r"about 1,600 pieces, and 1,000 are the most"):
        squares().make(Job(**job, layout="nested"))
    assert not layout_of(squares(), **job, layout="auto").pieces


def test_a_piece_larger_than_the_sheet_is_refused_with_its_size() -> None:
    """The search itself would only give up."""
    with pytest.raises(JobError, match=r"one piece takes 20\.\d+ x 20\.\d+ mm, and the sheet has room for 9 x 50 mm"):
        squares().make(Job(sheet=(9, 50), layout="nested"))


def test_without_spyrrow_pieces_are_nested_in_patterns_and_a_note_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is missing costs pieces, and not the sheet; what to install is said."""
    monkeypatch.setattr(nesting, "has_search", lambda: False)
    made = hooks().make(Job(**NESTED))
    assert made.pieces.count > 1
    assert any("pip install spyrrow" in note for note in made.notes)


def test_auto_is_repeatable_and_leaves_pieces_that_nothing_pulls_apart() -> None:
    """It takes no search, so the same job gives the same bytes."""
    file = BytesIO()
    hooks().make(Job(**JOB, layout="auto")).write(file)
    assert file.getvalue().decode() == nested()
    plain = {"sheet": (160.0, 110.0), "margin": 5.0}
    for job in (plain, {**plain, "colours": 3, "gap": 1}, {**plain, "fit": "clip"}):
        assert not layout_of(hooks(), **job, layout="auto").pieces


@pytest.mark.slow
@pytest.mark.parametrize(("name", "least"), [("cmm-scroll", 55), ("pgg-crane", 31)])
def test_tiles_that_hook_into_each_other_gain_much(name: str, least: int) -> None:
    """Three times as many scrolls as the tessellation pulled apart, 1.3 times as many cranes, without a search."""
    made = tiling(name).make(Job(sheet=(300, 200), margin=5, kerf=0.15, layout="auto"))
    assert made.pieces.count >= least


def test_a_search_finds_places_for_more_than_are_known() -> None:
    """A dozen bars, each turned as it may be, where no pattern is known; by shapely none overlaps another."""
    bar = np.array([-10 - 5j, 10 - 5j, 10 + 5j, -10 + 5j])
    none = NestPlaces(np.zeros(0, np.intp), np.zeros(0), np.zeros(0, np.complex128))
    found = most_pieces([NestItem(bar, 1.0, (0.0, 90.0))], (80.0, 50.0), none, 1, 0)
    assert len(found.item) >= 12
    shapes = []
    for turn, shift in zip(found.turn.tolist(), found.shift.tolist(), strict=True):
        z = np.exp(1j * np.radians(turn)) * bar + shift
        shapes.append(shapely.Polygon(np.column_stack((z.real, z.imag))))
    assert shapely.total_bounds(shapes).min() > -1e-4
    assert (shapely.total_bounds(shapes)[2:] < np.array([80.0, 50.0]) + 2e-3).all()
    one, two = np.triu_indices(len(shapes), 1)
    assert shapely.area(shapely.intersection(np.array(shapes)[one], np.array(shapes)[two])).max() < 1e-2


@pytest.mark.parametrize(
    "shape", [[0, 6, 6 + 2j, 2 + 2j, 2 + 6j, 6j], [0, 6, 3 + 5j], [0, 8, 8 + 4j, 5 + 1j, 3 + 1j, 4j]]
)
def test_pieces_of_a_pattern_overlap_nowhere(shape: list[complex]) -> None:
    """By shapely, for all pieces near one: neither the pattern's neighbours nor its half turns."""
    ring = np.array(shape) - np.mean(shape)
    polygon = shapely.Polygon(np.column_stack((ring.real, ring.imag)))
    patterns = piece_patterns(ring)
    assert patterns[0].density > 0.6
    for one in patterns[:10]:
        cells = [i * one.u + j * one.v for i in range(-4, 5) for j in range(-4, 5)]
        moved = [shapely.affinity.translate(polygon, z.real, z.imag) for z in cells if z]
        if one.half is not None:
            turned = shapely.affinity.rotate(polygon, 180, origin=(0, 0))
            moved += [shapely.affinity.translate(turned, z.real, z.imag) for z in (c + one.half for c in cells)]
        assert max(polygon.intersection(other).area for other in moved) < 1e-4


def test_a_no_fit_polygon_is_where_pieces_overlap_bays_and_all() -> None:
    """Places drawn at random overlap by shapely if they lie in it; one in a bay that is entered nowhere does not."""
    bay = np.array([0, 10, 10 + 10j, 6 + 10j, 6 + 8j, 8 + 8j, 8 + 2j, 2 + 2j, 2 + 8j, 5 + 8j, 5 + 10j, 10j])
    small = np.array([0, 3, 3 + 3j, 3j])
    region = no_fit(bay, small)
    stays, other = (shapely.Polygon(np.column_stack((ring.real, ring.imag))) for ring in (bay, small))
    assert len(region.interiors) == 1
    for x, y in np.random.default_rng(5).uniform(-5, 12, (200, 2)).tolist():
        overlap = stays.intersection(shapely.affinity.translate(other, x, y)).area
        assert region.contains(shapely.Point(x, y)) == (overlap > 0), (x, y)


def test_a_place_is_that_of_the_tile_as_it_is_drawn() -> None:
    """A piece that is not turned lies where the design has its tile, in millimetres, moved by its shift."""
    tiles = tiling("p4-hook")
    laid = placed(layout_of(tiles, **JOB), [Piece(0, False, 0.0, 50 + 60j), Piece(0, False, 90.0, 50 + 60j)])
    drawn = tiles[0].outline.to_shapely(accuracy=1e-3)
    upright = shapely.affinity.translate(drawn, 50, 60)
    turned = shapely.affinity.translate(shapely.affinity.rotate(drawn, 90, origin=(0, 0)), 50, 60)
    for shape, wanted in zip(contour_shapes(laid.contours.paths), (upright, turned), strict=True):
        assert shape.buffer(-0.1).hausdorff_distance(wanted) < 0.03  # half the kerf of 0.2


@pytest.mark.parametrize(
    ("job", "said"),
    [
        ({"grain": True}, "`grain` changes nothing without a `layout`"),
        ({"effort": 5}, "`effort` changes nothing without `layout='nested'`"),
        ({"seed": 5, "layout": "auto", "fit": "clip"}, "`seed` changes nothing without `layout='nested'`"),
        ({"layout": "auto", "offset": 3j}, "pieces are not nested: `layout='auto'` moves every piece anew"),
        ({"layout": "auto", "pack": True, "colours": 3}, "nests no woods, as `layout='nested'` does with `pack`"),
        (
            {"layout": "auto", "pieces": 9},
            "`pieces` scales the tessellation until so many fit as it lies. Use `count=9`",
        ),
        ({"layout": "nested", "seed": 5, "sheet": OFFCUT, "count": 1}, "without a search: `effort` and `seed` change"),
        ({"layout": "auto", "kerf": 0}, "is for those that a `kerf` or a `gap` pulls apart"),
    ],
)
def test_what_changes_nothing_about_nesting_is_said(job: dict[str, Any], said: str, tmp_path: Path) -> None:
    """Options of a search that is not made, and `auto` where it has nothing to do."""
    if "sheet" in job:
        job = {**job, "sheet": offcut(tmp_path)}
    made = make_several(hooks().design, hooks().tessellation, Job(**{**JOB, **job}))[0][1]
    assert [note for note in made.notes if said in note]
    assert not [note for note in hooks().make(Job(**JOB)).notes if "nest" in note or "changes nothing" in note]


PAIR = """schema = 1
group = "p1"
cell = { a = 40, b = 30, angle = 80 }
[[site]]
name = "bird"
strokes = [{ segment = [[5, 4], [16, 20]] }]
[[site]]
name = "moth"
strokes = [{ point = [32, 20] }]
"""
"""Two sites, of which different numbers are wanted."""


@cache
def pair() -> Tiling:
    """The tiling of PAIR."""
    return Design.loads(PAIR).tessellate()


def test_so_many_pieces_of_each_site_go_on_as_many_sheets_as_they_take(tmp_path: Path) -> None:
    """Files are numbered, hold what was asked for, each apart and on its sheet, and are made again by `layout`."""
    job: dict[str, Any] = {**JOB, "layout": "auto", "count": {"bird": 8, "moth": 20}, "sheets": 4}
    written = pair().export(tmp_path / "all.svg", job=Job(**job))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["all-1.svg", "all-2.svg"]
    products = [product for _, product in written if product is not None]
    sites = np.concatenate([product.pieces.site for product in products])
    assert np.bincount(sites).tolist() == [8, 20]
    for path, product in written:
        assert product is not None
        shapes = contour_shapes(cuts(product))
        one, two = np.triu_indices(len(shapes), 1)
        assert shapely.distance(np.array(shapes)[one], np.array(shapes)[two]).min() >= 1 - 1e-4
        assert shapely.total_bounds(shapes).min() >= 5 - 1e-6
        again = tmp_path / "again.svg"
        pair().export(again, job=Job(**JOB, layout=path))
        assert again.read_bytes() == Path(path).read_bytes()


def test_a_count_that_does_not_fit_is_refused_with_what_does(tmp_path: Path) -> None:
    """How many fit, and how many sheets all would take, which then do; nothing is left of it."""
    job: dict[str, Any] = {**JOB, "layout": "auto", "count": "bird=8,moth=20"}
    with pytest.raises(JobError, match=r"\d+ of 28 pieces fit on 1 sheet, and all would take 2\. Use `sheets=2`"):
        pair().export(tmp_path / "all.svg", job=Job(**job))
    assert not list(tmp_path.iterdir())
    with pytest.raises(JobError, match=r"no site is called 'owl'. Its sites are bird, moth"):
        pair().make(Job(**{**job, "count": "owl=8"}))


def test_as_many_as_asked_for_and_no_more_are_nested() -> None:
    """On one sheet, which is one drawing; those that are turned over have their share; none of another site."""
    made = hooks().make(Job(**JOB, layout="auto", count=6))
    assert (made.pieces.count, int(made.pieces.turned_over.sum())) == (6, 3)
    assert pair().make(Job(**JOB, layout="auto", count="moth=3")).pieces.site.tolist() == [1, 1, 1]


def test_each_wood_is_nested_on_sheets_of_its_own(tmp_path: Path) -> None:
    """As many pieces of each colour and kind as rows have of it, on fewer sheets; each file lays its pieces again."""
    job: dict[str, Any] = {"sheet": (200, 200), "stock": (160.0, 110.0), "margin": 5, "kerf": 0.2, "pack": True}
    searched: list[bool] = []

    def unsearched(*given: Any, search: bool) -> list[Layout]:
        """The sheets without the search that was asked for."""
        searched.append(search)
        return counted_sheets(*given, search=False)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(packed_sheets, "counted_sheets", unsearched)
        patch.setattr(nesting, "has_search", lambda: False)  # ours is made all the same
        rows, nested = (
            hooks().export(tmp_path / f"{name}.svg", job=Job(**{**job, "colours": "handedness", **more}))
            for name, more in (("rows", {}), ("wood", {"layout": "nested"}))
        )
        with pytest.raises(JobError, match=r"of 12 pieces fit on 1 sheet, and all would take 2"):
            hooks().export(tmp_path / "one.svg", job=Job(**job, colours="handedness", layout="nested", sheets=1))

    def of_wood(written: tuple[Exported, ...]) -> Counter[tuple[str, bool]]:
        """How many pieces of each colour, turned over or not, there are."""
        names = [(re.findall(r"colour(\d)", path)[0], one.pieces) for path, one in written if one is not None]
        return Counter((colour, bool(over)) for colour, pieces in names for over in pieces.turned_over)

    assert searched == [True] * 3
    assert all(one is not None and any("pip install spyrrow" in note for note in one.notes) for _, one in nested)
    assert of_wood(rows) == of_wood(nested)
    assert len(nested) <= len(rows)
    path = nested[0].path
    hooks().export(tmp_path / "again.svg", job=Job(sheet=(160.0, 110.0), margin=5, kerf=0.2, layout=path))
    assert (tmp_path / "again.svg").read_bytes() == Path(path).read_bytes()


class Slow:
    """Stands for a Nesting of two kinds: at most so many pieces go on a sheet; `asked` is how many it was to hold."""

    def __init__(self, holds: int, most: int) -> None:
        self.layout = SimpleNamespace(sheet=SimpleNamespace(width=100.0, height=100.0), tile_areas=np.array([90.0, 9]))
        self.kinds = [SimpleNamespace(tile=0), SimpleNamespace(tile=1)]
        self.holds, self.most = holds, most
        self.asked: list[int] = []

    def sheet(self, demand: Any, *_: Any, **__: Any) -> tuple[Any, Any]:
        """A sheet with the first of what is asked for."""
        self.asked.append(int(demand.sum()))
        first = np.minimum(demand, self.holds)
        return first, np.array([first[0], min(demand[1], self.holds - first[0])])


def sheets_of(nest: Slow, *demand: int) -> list[Any]:
    """So many pieces of each kind on sheets."""
    return counted_sheets(cast("Nesting", nest), np.array(demand), search=False)


def test_what_does_not_fit_on_the_most_sheets_is_refused() -> None:
    """Also where as many sheets may be used as are ever nested on: no piece is left out."""
    assert len(sheets_of(Slow(1, most=1_000), 1_000, 0)) == 1_000
    with pytest.raises(JobError, match=r"1,000 of 1,001 pieces .* more than 1,000. Use a larger sheet"):
        sheets_of(Slow(1, most=1_000), 1_001, 0)
    with pytest.raises(JobError, match=r"1,000 of 2,000 pieces .* would take 2\. Use `sheets=2`"):
        sheets_of(Slow(1_000, most=1), 2_000, 0)
    with pytest.raises(JobError, match=r"`sheets=1001` are more than pieces are nested on, 1,000"):
        Job(**JOB, layout="nested", count=1, sheets=1_001)


def test_a_sheet_is_not_asked_for_more_pieces_than_are_nested() -> None:
    """What is counted is what is wanted: a sheet for a hundred large pieces would hold a thousand small ones."""
    nest = Slow(100, most=99)
    assert len(sheets_of(nest, 4_000, 100)) == 41
    assert max(nest.asked) <= 1_000
    with pytest.raises(JobError, match="about 1,111 pieces, and 1,000 are the most"):
        sheets_of(nest, 0, 50)


@pytest.mark.parametrize(
    ("given", "kept"),
    [
        ("a=b=2", (("a=b", 2),)),
        ("x,y=3, z = 0", (("x,y", 3), ("z", 0))),
        ({"x,y": 3, "=": "4"}, (("x,y", 3), ("=", 4))),
        (" 40", 40),
    ],
)
def test_counts_are_read_once_whatever_sites_are_called(given: Any, kept: Any) -> None:
    """Names may hold the signs that part them; what was read is read again, also from a recipe."""
    job = Job(**JOB, layout="nested", count=given)
    assert job.count == kept
    assert Job(**json.loads(json.dumps(job.recipe()))) == replace(job) == job


def test_a_site_with_an_equals_sign_is_counted() -> None:
    """By its name, and refused by another that begins like it."""
    tiles = Design.loads(PAIR.replace('"moth"', '"a=b"')).tessellate()
    assert tiles.make(Job(**JOB, layout="auto", count="a=b=2")).pieces.site.tolist() == [1, 1]
    with pytest.raises(JobError, match="no site is called 'a'"):
        tiles.make(Job(**JOB, layout="auto", count="a=2"))


@pytest.mark.parametrize(
    "count",
    [
        *("x", "", "bird=-1", "bird=0", "bird=1,bird=2", "bird=10001", "1_000", "bird=1_0", "bird=1,moth", "=3", 0),
        *(True, {"bird": 1.5}, {}, ["bird"], 2.0),
    ],
)
def test_counts_that_cannot_be_are_refused(count: Any) -> None:
    """With what can be given instead."""
    with pytest.raises(JobError, match=r"Give a number for every site, 40, or for some, bird=40,moth=12"):
        Job(**JOB, layout="nested", count=count)


@pytest.mark.parametrize(
    ("job", "message"),
    [
        ({"sheets": 3}, "`sheets` are for a `count` of pieces"),
        ({"count": 3}, "`layout='tessellated'` lays others"),
        ({"count": 3, "layout": "all-1.svg"}, "`layout='all-1.svg'` lays others"),
        ({"count": 3, "layout": "nested", "pack": True, "colours": "site"}, "`pack` packs those of a picture"),
        ({"pieces": 3, "layout": "nested", "pack": True, "colours": "site"}, "Leave `pieces` out"),
        ({"count": 3, "layout": "auto", "fit": "clip"}, "nests whole tiles"),
    ],
)
def test_counts_of_what_is_not_nested_are_refused(job: dict[str, Any], message: str) -> None:
    """Whatever is asked for is not passed over."""
    with pytest.raises(JobError, match=message):
        Job(**{**JOB, **job})


def test_several_sheets_are_no_single_drawing() -> None:
    """They need a file's name to begin with."""
    job = Job(**JOB, layout="auto", count="bird=8,moth=20", sheets=2)
    for one in (job, replace(job, only_colour=0)):
        with pytest.raises(JobError, match="a file for each sheet is several drawings"):
            pair().make(one)
    with pytest.raises(JobError, match="`sheets`: several files need a name"):
        pair().export("-", job=job, file_format="svg")


def test_pieces_are_nested_on_an_offcut_with_a_hole(tmp_path: Path) -> None:
    """By shapely all keep the margin from its contour and its hole, and the gap."""
    job: dict[str, Any] = {"sheet": offcut(tmp_path), "margin": 3, "kerf": 0.2}
    made = squares().make(Job(**job, layout="auto", count=7))
    edge = shapely.Polygon(OFFCUT[0], OFFCUT[1:])
    shapes = np.array(contour_shapes(cuts(made)))
    assert len(shapes) == 7
    assert f"{7 * 400 / edge.area:.1%} of the sheet drawn on 120 x 90 mm" in made.summary()
    assert edge.contains(shapes).all()
    assert shapely.distance(edge.boundary, shapes).min() >= 3 - 1e-6
    one, two = np.triu_indices(len(shapes), 1)
    assert shapely.distance(shapes[one], shapes[two]).min() >= 1 - 1e-4
    made.save(tmp_path / "first.svg")
    squares().make(Job(**job, layout=tmp_path / "first.svg")).save(tmp_path / "again.svg")
    assert (tmp_path / "again.svg").read_bytes() == (tmp_path / "first.svg").read_bytes()
    with pytest.raises(JobError, match="would leave this job's sheet"):
        squares().make(Job(**{**job, "margin": 9}, layout=tmp_path / "first.svg"))


def test_a_piece_too_near_to_a_drawn_edge_is_seen(tmp_path: Path) -> None:
    """By a hundredth of a millimetre at its contour, at a notch, or at the hole; or where it lies beyond the sheet."""
    laid = layout_of(squares(), sheet=offcut(tmp_path), margin=3, kerf=0.2)
    x, y, right, top = placed(laid, [Piece(0, False, 0.0, 0j)]).contours.paths.bounds
    corner, other = complex(x, y), complex(right, top)
    free = [5 + 5j - corner, 49 + 85j - complex(right, top), 37 + 25j - complex(right, y), 55 + 5j - corner]
    near = [z + away for z, away in zip(free, (-0.01, 0.01j, 0.01, 27j + 15), strict=True)]
    for place in (*free, 67 + 85j - other):
        assert len(misplaced(placed(laid, [Piece(0, False, 0.0, place)]))) == 0, place
    for place in (*near, 67.01 + 85j - other, 95 + 70j - corner, 46 + 36j - (corner + other) / 2, 300 + 300j):
        assert misplaced(placed(laid, [Piece(0, False, 0.0, place)])).tolist() == [[0, 0]], place


RING = """schema = 1
group = "p1"
cell = { a = 60, b = 60, angle = 90 }
[[site]]
name = "ring"
strokes = [{ polyline = [[10, 10], [50, 10], [50, 50], [10, 50]], closed = true }]
[[site]]
name = "bit"
strokes = [{ point = [24, 30] }]
[[site]]
name = "other"
strokes = [{ point = [36, 30] }]
[[site]]
name = "rest"
strokes = [{ point = [0, 0] }]
"""
"""A tile with a hole that holds two others."""


def test_a_tile_is_nested_in_the_hole_of_another_and_cut_before_that_falls_out() -> None:
    """On a sheet with no other room for it, a gap from all sides of the hole; without a hole it would not fit."""
    tiles = Design.loads(RING).tessellate()
    job: dict[str, Any] = {"sheet": (70.0, 70.0), "margin": 2.0, "kerf": 0.2, "layout": "auto"}
    made = tiles.make(Job(**job, count="ring=1,bit=1"))
    (inner,) = (layer.paths for layer in made.drawing.layers if layer.name == "inner")
    bit, hole = (shapely.Polygon(xy(line)) for line in flattened(inner, 1e-4))
    assert hole.contains(bit)
    assert hole.exterior.distance(bit) >= 1 - 1e-4
    with pytest.raises(JobError, match="2 of 3 pieces fit on 1 sheet"):
        tiles.make(Job(**job, count="ring=1,bit=1,other=1"))


def test_numbers_run_kind_by_kind(tmp_path: Path) -> None:
    """Pieces that are turned over come after the others: within a kind they can change places."""
    laid = layout_of(hooks(), **JOB, layout=saved(tmp_path), labels="number")
    assert laid.numbers is not None
    assert sorted(laid.numbers) == list(range(1, len(laid.pieces) + 1))
    over = [laid.pieces[k].over for k in np.argsort(laid.numbers).tolist()]
    assert over == sorted(over)
    assert 0 < sum(over) < len(over)


@pytest.mark.parametrize(
    "more",
    [
        {"layout": "auto", "count": 9, "sheets": 2},
        {"layout": "nested", "pack": True, "colours": 2, "sheet": (90, 90), "stock": (70, 50)},
    ],
    ids=["sheets", "woods"],
)
def test_numbers_run_through_all_sheets_and_woods(more: dict[str, Any], tmp_path: Path) -> None:
    """Each number once; a sheet that its file lays again has the same."""
    job: dict[str, Any] = {"sheet": (70, 50), "margin": 2, "kerf": 0.2, "labels": "number"}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Nesting, "_searched", lambda self, items, known, _: most_laid(items, self.room, known))
        written = squares().export(tmp_path / "all.svg", job=Job(**{**job, **more}))
    assert len(written) > 1
    count = 0
    for path, product in written:
        assert product is not None
        laid = layout_of(squares(), **job, layout=path)
        assert laid.numbers is not None
        assert sorted(laid.numbers.tolist()) == list(range(count + 1, count + product.pieces.count + 1))
        count += product.pieces.count
        squares().export(tmp_path / "again.svg", job=Job(**job, layout=path))
        assert (tmp_path / "again.svg").read_bytes() == Path(path).read_bytes()


def test_a_pipe_is_no_file_with_places(tmp_path: Path) -> None:
    """It may never end: that is said at once."""
    os.mkfifo(tmp_path / "pipe.svg")
    with pytest.raises(JobError, match=r"pipe.svg' is a pipe or a device"):
        hooks().make(Job(**JOB, layout=tmp_path / "pipe.svg"))

"""Kerf and fillets: contours against dense buffers of the exact outlines, and pieces cut by a beam from them."""

from __future__ import annotations

import io
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely
from helpers.cutting import contour_shapes, cuts, dense, exact_shape, farthest, made, rings, squares, true_lengths
from helpers.examples import each_example, tiling

from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.arc_fitting import curve_fit
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.kerf import SHORTEST_MM
from voronoi_tiles.fabrication.layout import lay_out
from voronoi_tiles.fabrication.sheets import read_sheet
from voronoi_tiles.formats.svg.reader import svg_drawing
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.paths.offset import offset
from voronoi_tiles.paths.paths import ARC, Paths
from voronoi_tiles.paths.segments import Circles, point_at, tangent_at
from voronoi_tiles.paths.short_segments import without_short_segments
from voronoi_tiles.preflight import judge
from voronoi_tiles.preflight.findings import DEFAULT_LIMITS
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.vector.outline import Outline

ACCURACY = 0.005


def contours(tiles: Tiling, job: Job) -> list[tuple[int, Paths]]:
    """Each piece's site and rings where its tile lies in the plane, the pulling undone."""
    budget = AccuracyBudget.of(job, "exact")
    fit = curve_fit(job, "exact", budget, tiles.design.unit_mm)
    layout = lay_out(tiles.design, tiles.tessellation, job, read_sheet(job, budget), budget, fit)
    found = layout.contours
    result = []
    for k, copy in enumerate(found.copy.tolist()):
        piece = found.paths.take(np.arange(found.items[k], found.items[k + 1]))
        result.append((int(layout.site[copy]), piece.moved(1.0, -complex(layout.copies.moved_by[copy]))))
    return result


def check_kerf(tile: Any, contour: Any, kerf: float, accuracy: float) -> None:
    """The contour is half a kerf from the tile everywhere, and what a beam leaves of it is the tile.

    A round beam leaves a radius of half the kerf where the tile has a reflex corner: there, and only there, is more
    left, no more than what growing and shrinking the tile by half the kerf (and the accuracy) adds.
    """
    off = accuracy + 1e-3 * kerf
    shapely.prepare(tile.boundary)
    apart = shapely.distance(tile.boundary, dense(contour.boundary, 0.1))
    worst = float(np.abs(apart - kerf / 2).max())
    assert worst <= off, f"the contour is {worst:.4f} mm off"
    # Buffers of fewer points, half a micrometre off, take a quarter of the time.
    tile, contour, off = tile.simplify(5e-4), contour.simplify(5e-4), off + 1e-3
    true = tile.buffer(kerf / 2, quad_segs=16)
    missed = farthest(dense(true.boundary, 0.1), contour.boundary)
    assert missed <= off, f"{missed:.4f} mm of the true offset are missing"
    left = contour.buffer(-kerf / 2, quad_segs=16)
    lost = tile.difference(left.buffer(off)).area
    assert lost <= 1e-9, f"the beam takes {lost:.1e} mm^2 of the tile"
    closed = tile.buffer(kerf / 2 + off, quad_segs=16).buffer(-kerf / 2 - off, quad_segs=16)
    more = left.difference(closed.buffer(off)).area
    assert more <= 1e-9, f"the beam leaves {more:.1e} mm^2 too much"


def steiner(outline: Outline, unit: float, distance: float) -> float:
    """The area of a grown tile by Steiner's formula: A + P d + d^2 (turning / 2 - what reflex corners lack)."""
    square = 0.0
    for first, stop in zip(outline.ring_offsets[:-1], outline.ring_offsets[1:], strict=True):
        for k in range(first, stop):
            a, m, b = outline.start[k], outline.control[k], outline.end[k]
            after = k + 1 if k + 1 < stop else first
            n = outline.control[after] if outline.curved[after] else outline.end[after]
            leaving = b - (m if outline.curved[k] else a)
            turn = float(np.angle((n - outline.start[after]) / leaving))
            if outline.curved[k]:
                square += float(np.angle((b - m) / (m - a))) / 2
            square += turn / 2 if turn > 0 else np.tan(turn / 2)
    return outline.area * unit**2 + outline.perimeter * unit * distance + square * distance**2


@each_example
@pytest.mark.parametrize(
    "kerf", [pytest.param(0.05, marks=pytest.mark.slow), 0.2, pytest.param(1.0, marks=pytest.mark.slow)]
)
def test_kerf_is_kept_on_every_example(name: str, kerf: float) -> None:
    """Every point of every contour is half a kerf off the exact outline, none is missing, and pieces are the tiles."""
    tiles = tiling(name)
    unit = tiles.design.unit_mm
    for site, piece in contours(tiles, Job(kerf=kerf)):
        outline = tiles.tiles[site].outline
        (contour,) = contour_shapes(piece)
        check_kerf(exact_shape(outline, unit), contour, kerf, ACCURACY)
        wanted = steiner(outline, unit, kerf / 2)
        assert abs(contour.area - wanted) <= 0.2 * ACCURACY * outline.perimeter * unit


@pytest.mark.parametrize(
    "job",
    [
        pytest.param({"kerf": 0.05}, marks=pytest.mark.slow, id="a fine kerf"),
        pytest.param({"kerf": 0.15}, id="kerf"),
        pytest.param({"kerf": 0.2, "fillet": 0.4}, marks=pytest.mark.slow, id="kerf and fillets"),
        pytest.param(
            {"kerf": 0.15, "sheet": (90.0, 70.0), "fit": "clip"}, marks=pytest.mark.slow, id="cut by the sheet"
        ),
    ],
)
@each_example
def test_no_segment_is_too_short_for_preflight(name: str, job: dict[str, Any]) -> None:
    """Arcs about corners would be, at a turn of 0.4 and less where the kerf is 0.05 mm.

    Their tips are half a micrometre off: less than the budget has for them.
    """
    assert cuts(made(name, **job)).lengths.min() >= DEFAULT_LIMITS.shortest


def test_preflight_finds_no_short_segment() -> None:
    """In the file of the example whose kerf had most of them."""
    file = io.BytesIO()
    made("pgg-crane", kerf=0.15, sheet=(300.0, 200.0)).write(file)
    report = judge(svg_drawing(file.getvalue(), "cut.svg"), "cut.svg")
    assert [finding.message for finding in report.findings if finding.kind == "short"] == []


@pytest.mark.parametrize("accuracy", [0.001, 0.02, 0.1])
def test_the_accuracy_is_the_callers(accuracy: float) -> None:
    """Finer and coarser ones are kept too, and coarser ones need fewer arcs."""
    tiles = tiling("p1-leaf")
    ((_, piece),) = contours(tiles, Job(kerf=0.3, accuracy=accuracy))
    (contour,) = contour_shapes(piece)
    check_kerf(exact_shape(tiles.tiles[0].outline, tiles.design.unit_mm), contour, 0.3, accuracy)
    ((_, coarser),) = contours(tiles, Job(kerf=0.3, accuracy=4 * accuracy))
    assert len(coarser.start) < len(piece.start)


def test_a_wrong_contour_is_seen() -> None:
    """One of another kerf, one moved by a hundredth, one with a bump: each fails."""
    tiles = tiling("p1-leaf")
    tile = exact_shape(tiles.tiles[0].outline, tiles.design.unit_mm)
    ((_, piece),) = contours(tiles, Job(kerf=0.2))
    (contour,) = contour_shapes(piece)
    check_kerf(tile, contour, 0.2, ACCURACY)
    bump = shapely.Point(contour.exterior.coords[0]).buffer(0.02)
    for wrong in (
        contour.buffer(0.01),
        shapely.affinity.translate(contour, 0.01, 0.0),
        contour.union(bump),
        contour.difference(bump),
    ):
        with pytest.raises(AssertionError, match=r"off|missing|beam"):
            check_kerf(tile, wrong, 0.2, ACCURACY)
    outline = tiles.tiles[0].outline
    assert abs(steiner(outline, 1.0, 0.2) - tile.buffer(0.2, quad_segs=64).area) < 1e-3
    assert abs(steiner(outline, 1.0, 0.21) - tile.buffer(0.2, quad_segs=64).area) > 0.1


def test_a_square_is_exact() -> None:
    """Four lines and four quarters of circles."""
    ((_, piece),) = contours(squares(), Job(kerf=1.0))
    (contour,) = contour_shapes(piece, 1e-7)
    assert contour.area == pytest.approx(400 + 80 * 0.5 + np.pi * 0.25, abs=1e-5)
    arcs = np.flatnonzero(piece.kind == ARC)
    radius, turn = piece.arc_radius_and_turn(arcs)
    assert len(arcs) == 4
    assert radius == pytest.approx([0.5] * 4, abs=1e-9)
    assert turn == pytest.approx([np.pi / 2] * 4, abs=1e-9)


@pytest.mark.parametrize("apart", [1e-8, 1e-7, 1e-6])
def test_tiles_of_sites_that_nearly_touch(apart: float) -> None:
    """Two equal lines so many cells apart: rounding leaves their outlines segments of no length."""
    lines = [[[10, y], [40, y]] for y in (10, 10 + 60 * apart)]
    sites = [{"name": name, "strokes": [{"polyline": line}]} for name, line in zip("ab", lines, strict=True)]
    cell = {"a": 60, "b": 60, "angle": 90}
    tiles = Design.from_dict({"schema": 1, "group": "p2", "cell": cell, "site": sites}).tessellate()
    for site, piece in contours(tiles, Job(kerf=0.3)):
        (contour,) = contour_shapes(piece)
        check_kerf(exact_shape(tiles.tiles[site].outline, 1.0), contour, 0.3, ACCURACY)


@pytest.mark.parametrize("name", ["pg-wave", "p4g-fan", "cmm-scroll", "p4-mill"])
def test_copies_are_congruent(name: str) -> None:
    """Contours of all copies of a tile, mirrored ones too, have the same pieces in the same or opposite order."""
    width = 6 * abs(tiling(name).design.lattice.a) * tiling(name).design.unit_mm
    product = made(name, sheet=(width, width), kerf=0.2)
    paths = cuts(product)
    kinds: dict[tuple[int, ...], set[bool]] = {}
    for k in range(len(paths)):
        ring = paths.take(np.array([k]))
        lengths = np.round(true_lengths(ring) * 1e6).astype(int).tolist()
        turns = [lengths[i:] + lengths[:i] for i in range(len(lengths))]
        back = [turn[::-1] for turn in turns]
        forms = sorted(tuple(form) for form in (*turns, *back))
        kinds.setdefault(_rounded(forms[0]), set()).add(min(turns) < min(back))
    sites = len(tiling(name).tiles)
    assert len(kinds) <= 3 * sites, "contours differ by more than the last digit's rounding"
    if product.pieces.turned_over.any():
        assert any(len(senses) == 2 for senses in kinds.values())


@pytest.mark.parametrize(
    "group", [pytest.param(group, marks=() if group in ("pg", "p4g", "p31m") else pytest.mark.slow) for group in GROUPS]
)
def test_pieces_have_the_offsets_of_their_own_places(group: str) -> None:
    """One offset a site is made and moved: every tile's is that of the tile where it stands, to rounding."""
    tiles = starter(group).tessellate()
    job = Job(kerf=0.2, sheet=(4 * abs(tiles.design.lattice.a), 3 * abs(tiles.design.lattice.a)))
    budget = AccuracyBudget.of(job, "exact")
    fit = curve_fit(job, "exact", budget, tiles.design.unit_mm)
    layout = lay_out(tiles.design, tiles.tessellation, job, read_sheet(job, budget), budget, fit)
    tile, first = np.unique(layout.copies.tile, return_index=True)
    assert len(tile) == len(layout.period.site)
    outlines, items = layout.period.outlines(tile, layout.copies.step[first])
    for k, copy in enumerate(first.tolist()):
        here = outlines.take(np.arange(items[k], items[k + 1])).moved(1.0, complex(layout.copies.moved_by[copy]))
        direct = without_short_segments(offset(here, 0.1).paths, SHORTEST_MM, budget.short)
        placed = layout.contours.paths.take(np.array([copy]))
        assert len(placed.start) == len(direct.start)
        assert max(away(placed, direct), away(direct, placed)) <= 1e-12 * layout.sheet.width


def away(paths: Paths, others: Paths) -> float:
    """How far the ends and middles of segments are from other lines and arcs, at most."""
    every = np.arange(len(paths.start))
    points = np.concatenate([point_at(paths, every, np.full(len(every), t)) for t in (0.0, 0.5)])
    point, segment = (k.ravel() for k in np.indices((len(points), len(others.start))))
    near = Circles.of(others, segment).distance(points[point]).reshape(len(points), -1)
    return float(near.min(axis=1).max())


def _rounded(lengths: tuple[int, ...]) -> tuple[int, ...]:
    """Lengths to a tenth of a micrometre."""
    return tuple(round(length / 100) for length in lengths)


def test_holes_shrink() -> None:
    """The contour of a hole lies inside it by half the kerf; holes come before outlines."""
    tiles = rings()
    found = contours(tiles, Job(kerf=0.4))
    for site, piece in found:
        (contour,) = contour_shapes(piece)
        check_kerf(exact_shape(tiles.tiles[site].outline, 1.0), contour, 0.4, ACCURACY)
    assert [len(piece) for _, piece in found] == [2, 1]
    areas = contour_shapes(cuts(tiles.make(Job(kerf=0.4))))
    assert areas[0].distance(areas[1]) == pytest.approx(1.0, abs=ACCURACY)
    with pytest.raises(JobError, match="a tile lies within another"):
        tiles.make(Job(kerf=0.4, sheet=(200.0, 200.0)))
    product = tiles.make(Job(kerf=0.4))
    assert [layer.name for layer in product.drawing.layers] == ["inner", "cut"]
    assert [len(layer.paths) for layer in product.drawing.layers] == [1, 2]


@pytest.mark.parametrize(("sheet", "hole"), [(None, 20 + 20j), ((200.0, 200.0), 120 + 120j)])
def test_a_kerf_that_closes_a_hole_is_refused_with_its_place(sheet: tuple[float, float] | None, hole: complex) -> None:
    """The place is in the hole, and the message says what to do; on a sheet, too, where tiles are pulled apart."""
    with pytest.raises(JobError, match=r"`kerf='13mm'` is too much: .* at \(([\d.]+), ([\d.]+)\) mm") as caught:
        rings().make(Job(kerf=13.0, sheet=sheet))
    x, y = (float(part) for part in str(caught.value).split("(")[1].split(")")[0].split(","))
    assert abs(complex(x, y) - hole) < 6.5
    assert caught.value.remedy == "Use a smaller `kerf`, or a larger design."


# --- fillets ----------------------------------------------------------------------------------------------------


def test_fillets_of_a_square() -> None:
    """Quarters of circles of the radius, tangent to both sides."""
    ((_, piece),) = contours(squares(), Job(fillet=3.0))
    arcs = np.flatnonzero(piece.kind == ARC)
    radius, turn = piece.arc_radius_and_turn(arcs)
    assert radius == pytest.approx([3.0] * 4, abs=1e-9)
    assert turn == pytest.approx([np.pi / 2] * 4, abs=1e-9)
    assert contour_shapes(piece, 1e-7)[0].area == pytest.approx(400 - (4 - np.pi) * 9, abs=1e-5)


def kinks(paths: Paths) -> Any:
    """The angles between successive pieces of closed paths; radians."""
    count = len(paths.start)
    following = np.arange(1, count + 1)
    following[paths.offsets[1:] - 1] = paths.offsets[:-1]
    ahead = tangent_at(paths, np.arange(count), np.ones(count))
    return np.abs(np.angle(tangent_at(paths, following, np.zeros(count)) / ahead))


@pytest.mark.parametrize("name", ["p1-leaf", "p4-hook", "pg-wave", "p3-puzzle", "p4-mill"])
def test_rounded_tiles_fit_at_every_vertex(name: str) -> None:
    """Side by side, without kerf, they overlap nowhere; no corner is sharper than the radius."""
    tiles = tiling(name)
    side = 3.5 * abs(tiles.design.lattice.a) * tiles.design.unit_mm
    radius = 0.4
    paths = cuts(made(name, sheet=(side, side), fillet=radius, edges="pieces"))
    pieces = contour_shapes(paths, 1e-3)
    assert len(pieces) > 2
    for one, two in zip(*shapely.STRtree(pieces).query(pieces), strict=True):
        if one < two:
            overlap = pieces[one].intersection(pieces[two]).buffer(-2 * ACCURACY)
            assert overlap.is_empty, f"two tiles overlap by {overlap.area:.1e} mm^2"
    assert kinks(paths).max() < 0.15
    for ring in pieces[:1]:
        for grown in (
            ring.buffer(-0.95 * radius).buffer(0.95 * radius),
            ring.buffer(0.95 * radius).buffer(-0.95 * radius),
        ):
            assert ring.symmetric_difference(grown).buffer(-3 * ACCURACY).is_empty


def test_sharp_corners_are_seen() -> None:
    """The measures of the test above see a tile without fillets."""
    paths = cuts(made("p4-hook", edges="pieces"))
    assert kinks(paths).max() > 0.3
    (ring,) = contour_shapes(paths)
    grown = ring.buffer(-0.38).buffer(0.38)
    assert not ring.symmetric_difference(grown).buffer(-3 * ACCURACY).is_empty


def test_a_fillet_that_is_too_large_is_refused() -> None:
    """With a place on the tile."""
    with pytest.raises(JobError, match=r"`fillet='11mm'` is too much: a piece vanishes at \((\S+), (\S+)\) mm"):
        squares().make(Job(fillet=11.0))
    with pytest.raises(JobError, match="`fillet="):
        made("p4-hook", fillet=20.0)


def test_slivers_at_the_edge_that_fillets_take_are_told() -> None:
    """A whole tile must keep all of itself; of what a sheet's edge cuts off, what is too thin is left out."""
    product = squares().make(Job(sheet=(41.0, 41.0), fit="clip", fillet=1.0, edges="pieces"))
    assert any("vanishes" in note for note in product.notes)
    plain = squares().make(Job(sheet=(41.0, 41.0), fit="clip", edges="pieces"))
    assert len(plain.pieces.site) == 16
    assert len(product.pieces.site) == 4
    assert len(contour_shapes(cuts(product))) == len(product.pieces.site)


def test_kerf_after_fillets() -> None:
    """The contour is half a kerf off the rounded tile."""
    job = Job(kerf=0.6, fillet=2.0)
    ((_, piece),) = contours(squares(), job)
    ((_, bare),) = contours(squares(), replace(job, kerf=0.0))
    (contour,), (tile,) = contour_shapes(piece), contour_shapes(bare)
    check_kerf(tile, contour, 0.6, 1e-3)


def test_a_piece_at_the_edge_that_breaks_in_two_is_two() -> None:
    """Each part has its own contour and number, and its share of the area."""
    job: dict[str, Any] = {
        "sheet": (172.07674328799897, 220.5660638091932),
        "fit": "clip",
        "offset": 9.290764003561844 + 17.189404303288313j,
    }
    product = made("p4-mill", **job, edges="pieces", fillet=1.0, labels="number", accuracy=0.05)
    plain = made("p4-mill", **job, edges="pieces", accuracy=0.05)
    assert any("a neck breaks" in note for note in product.notes)
    pieces = contour_shapes(cuts(product))
    assert len(pieces) == len(product.pieces.site)
    assert all(piece.is_valid for piece in pieces)
    vanished = plain.pieces.area.sum() - product.pieces.area.sum()
    assert -1e-6 <= vanished < 0.01 * plain.pieces.area.sum()

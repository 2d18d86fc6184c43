"""Sheets: which tiles lie on a region, its lines, each once, and what its border leaves of tiles, against shapely."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import shapely
from helpers.examples import EXAMPLES, NAMES, each_design
from helpers.sheets import (
    Sheet,
    candidates,
    check_apart,
    check_areas,
    check_ends,
    check_lengths,
    check_placement,
    check_shapes,
    check_sheet,
    circle,
    period,
    polygon,
    region_area,
    rounded,
    shape,
)

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.fabrication.clipping import OUTSIDE, clipped_strands
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.tile_placement import TilePlacement
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths
from voronoi_tiles.paths.segments import item_boxes
from voronoi_tiles.paths.winding import winding
from voronoi_tiles.vector.complex.period import Period

DEGENERATE = 1e-10
"""Areas where tiles touch the border: what lies within a millionth of a millimetre of it is left to the border."""


def size(name: str) -> float:
    """The side of a square as large as the cell."""
    a, b = period(name).basis.tolist()
    return float(np.sqrt(abs((a.conjugate() * b).imag)))


def a_hole_or_two(centre: complex, radius: float) -> Region:
    """A disc with two round holes, a large one and one that may well lie inside a single tile."""
    holes = [
        circle(centre + 0.2 * radius, 0.4 * radius, hole=True),
        circle(centre - 0.6 * radius, 0.04 * radius, hole=True),
    ]
    return Region(Paths.concatenate([circle(centre, radius, parts=3, turn=0.3), *holes]))


@each_design
def test_everything_that_is_promised_holds_on_a_turned_sheet(name: str) -> None:
    """Placement, areas, lengths, pieces, the frame: half of the designs on a rectangle, half on a round region."""
    turned = period(name).placed(np.exp(0.4j), 3.0 + 2.0j)
    side = 0.9 * size(name)
    if NAMES.index(name) % 2:
        check_sheet(Sheet(turned, Region.rectangle(-side, -0.6 * side, 0.7 * side, side)), 1.7 * 1.6 * side**2)
    else:
        region = a_hole_or_two(0.3 + 0.1j, side)
        check_sheet(Sheet(turned, region), np.pi * side**2 * (1 - 0.4**2 - 0.04**2))


@pytest.mark.parametrize("name", ["p1-leaf", "p4-hook", "p6-rosette", "cm-moth", "p3m1"])
def test_regions_smaller_than_a_tile(name: str) -> None:
    """A region inside one tile is its only piece; regions across a side, or about a vertex, are cut."""
    unit = size(name)
    here = period(name)
    vertex, side = complex(here.vertex[0]), complex(here.edges.end[here.edges.counts[0] // 2])
    for centre in (vertex, side, 0.3 * unit + 0.2j * unit):
        for region in (
            Region.rectangle(
                centre.real, centre.imag - 0.01 * unit, centre.real + 0.02 * unit, centre.imag + 0.02 * unit
            ),
            Region(circle(centre + 0.001, 0.03 * unit)),
            a_hole_or_two(centre, 0.1 * unit),
        ):
            check_sheet(Sheet(here, region), region_area(region), DEGENERATE)


def test_a_region_inside_a_tile_is_that_tiles_only_piece() -> None:
    """Nothing of the tile's outline is left, and its hole is the region's."""
    name = "p4-hook"
    tile = shape(period(name).outlines(np.zeros(1, np.intp), np.zeros((1, 2), np.intp))[0], 1e-3)
    place = shapely.maximum_inscribed_circle(tile, tolerance=1e-2)
    centre, radius = complex(*place.coords[0]), place.length
    rings = [circle(centre, 0.9 * radius), circle(centre, 0.5 * radius, hole=True)]
    sheet = Sheet(period(name), Region(Paths.concatenate(rings)))
    check_sheet(sheet, np.pi * radius**2 * (0.9**2 - 0.5**2))
    assert len(sheet.pieces.tile) == 1
    assert len(sheet.pieces.paths) == 2
    assert (sheet.pieces.paths.kind == ARC).all()
    assert sheet.strands.border.all()


@pytest.mark.parametrize("factor", [1, 1j, np.exp(0.3j)])
@pytest.mark.parametrize("name", ["pmm", "pm", "p4m", "cmm", "p6m", "p3m1"])
def test_a_sheet_along_the_mirrors(name: str, factor: complex) -> None:
    """Tiles' edges run along the sheet's exactly: what is whole is whole, and nothing is double."""
    turned = period(name).placed(complex(factor), 0.7 - 0.2j)
    a, b = turned.basis.tolist()
    corner = 0.7 - 0.2j
    sheet = Sheet(turned, polygon(corner, corner + 2 * a, corner + 2 * a + b, corner + b))
    check_sheet(sheet, float(2 * (a.conjugate() * b).imag))
    if name in {"pmm", "p4m"}:
        assert sheet.placement.whole.all() or len(turned.site) > len(np.unique(turned.site))
    if not len(sheet.cut):
        assert not len(sheet.frame.paths)


@pytest.mark.parametrize("name", ["p4m", "p6m", "cmm", "p31m"])
def test_a_region_that_is_a_tile_and_one_with_a_hole_that_is_a_tile(name: str) -> None:
    """Such a tile is whole, and there is no frame; or it has nothing of the region."""
    here = period(name)
    outlines, items = here.outlines(np.arange(len(here.site)), np.zeros((len(here.site), 2), np.intp))
    straight = [k for k in range(len(here.site)) if (outlines.kind[outlines.owner == items[k]] == LINE).all()]
    straight = [k for k in straight if items[k + 1] - items[k] == 1]
    for tile in straight[:2]:
        ring = outlines.take(items[tile : tile + 1])
        alone = Sheet(here, Region(ring))
        check_sheet(alone, float(ring_areas(ring)[0]), DEGENERATE)
        assert alone.placement.tile.tolist() == [tile]
        assert alone.placement.whole.all()
        assert not len(alone.frame.paths)
        around = ring.moved(3, -2 * complex(ring.start.mean()))
        hollow = Sheet(here, Region(Paths.concatenate([around, ring.reversed()])))
        check_sheet(hollow, 8 * float(ring_areas(ring)[0]), DEGENERATE)
        assert (tile, 0, 0) not in {(k, *s) for k, s in zip(hollow.placement.tile, hollow.placement.step, strict=True)}


def box_of_a_tile(here: Period) -> Region:
    """A sheet whose edges touch a tile."""
    outlines, items = here.outlines(np.zeros(1, np.intp), np.zeros((1, 2), np.intp))
    return Region.rectangle(*item_boxes(outlines, items)[0].tolist())


def corners_on_vertices(here: Period) -> Region:
    """A triangle whose corners are vertices of tiles."""
    places = np.concatenate((here.vertex, here.vertex + here.basis[0], here.vertex + here.basis[1]))
    far = max(places, key=lambda z: abs(z - places[0]))
    third = max(places, key=lambda z: abs(((far - places[0]).conjugate() * (z - places[0])).imag))
    corners = [complex(places[0]), complex(far), complex(third)]
    turn = ((corners[1] - corners[0]).conjugate() * (corners[2] - corners[0])).imag
    return polygon(*(corners if turn > 0 else corners[::-1]))


def circle_through_a_vertex(here: Period) -> Region:
    """A disc about one vertex, the end of whose first arc is another one."""
    centre, through = complex(here.vertex[0]), complex(here.vertex[0] + here.basis[0])
    return Region(circle(centre, abs(through - centre), parts=3, turn=float(np.angle(through - centre))))


@pytest.mark.parametrize("make", [box_of_a_tile, corners_on_vertices, circle_through_a_vertex])
@pytest.mark.parametrize("name", ["p2-lizard", "p4-key", "p6-manta", "p4g", "p3m1", "pgg-crane"])
def test_borders_that_touch_tiles_or_run_through_vertices(name: str, make: Callable[[Period], Region]) -> None:
    """Single points on the border decide nothing."""
    turned = period(name).placed(np.exp(0.2j), 1j)
    region = make(turned)
    check_sheet(Sheet(turned, region), region_area(region), DEGENERATE)


def test_rings_that_touch() -> None:
    """A hole that touches the outer ring, at a corner of it, is cut like any other."""
    here, unit = period("p6-triskele"), size("p6-triskele")
    outer = Region.rectangle(0, 0, unit, unit).border
    hole = Paths.polylines([[0j, complex(0.3 * unit, 0.5 * unit), complex(0.5 * unit, 0.3 * unit)]], closed=True)
    region = Region(Paths.concatenate([outer, hole]))
    check_sheet(Sheet(here, region), region_area(region))


def test_a_frame_is_all_where_no_tile_is_whole() -> None:
    """The strands of no tile, and a frame that is the region."""
    region = Region(rounded(0, 0, 4, 3, 0.5))
    sheet = Sheet(period("p2-drop"), region)
    assert not sheet.placement.whole.any()
    assert sheet.frame.paths.start.tolist() == region.border.start.tolist()
    assert sheet.frame.tile.tolist() == [OUTSIDE]
    assert ring_areas(sheet.frame.paths)[0] == pytest.approx(12 - (4 - np.pi) / 4, abs=1e-12)


@pytest.mark.parametrize("name", ["pmm", "p4m", "p1-leaf", "p6-rosette"])
def test_whole_tiles_and_the_border_have_no_line_twice(name: str) -> None:
    """Strands that are clipped to a region in which whole tiles alone are placed: the lines of a frame, each once."""
    here = period(name)
    a, b = here.basis.tolist()
    sheet = Sheet(here, polygon(0j, 2 * a, 2 * a + 2 * b, 2 * b))
    strands = clipped_strands(here, sheet.inner, sheet.region)
    check_ends(strands.paths, strands.node, strands.first, strands.last)
    check_apart(strands.paths)
    lines = float(strands.paths.lengths.sum())
    wanted = shapely.union_all([shape(sheet.region.border).boundary, *(tile.boundary for tile in whole_shapes(sheet))])
    assert lines == pytest.approx(shapely.union_all(shapely.set_precision(wanted, 1e-5)).length, rel=1e-5)


def whole_shapes(sheet: Sheet) -> list[shapely.Geometry]:
    """The whole tiles, as shapely sees them."""
    return [sheet.tiles[k] for k in np.flatnonzero(sheet.placement.whole).tolist()]


def test_strands_know_the_tiles_beside_them() -> None:
    """A place just to the left of a strand lies in the tile on its left, one to the right in that on its right."""
    here, unit = period("p31m"), size("p31m")
    sheet = Sheet(here, Region.rectangle(-unit, -unit, unit, 0.7 * unit))
    strands = sheet.strands
    seen = 0
    for k in np.flatnonzero(~strands.border).tolist():
        piece = int(strands.paths.offsets[k])
        chord = strands.paths.take(np.array([k]))
        a, b = complex(strands.paths.start[piece]), complex(strands.paths.end[piece])
        if strands.paths.kind[piece] != LINE or abs(b - a) < 1e-2:
            continue
        seen += len(chord)
        for tile, aside in ((strands.left[k], 1e-4j), (strands.right[k], -1e-4j)):
            place = (a + b) / 2 + aside * (b - a) / abs(b - a)
            inside = [n for n, t in enumerate(sheet.tiles) if t.contains(shapely.Point(place.real, place.imag))]
            assert inside == [tile]
    assert seen > 10


def test_tiles_come_row_by_row() -> None:
    """The order on the sheet: from below, then from the left."""
    sheet = Sheet(period("pmm"), Region.rectangle(-100, -100, 100, 100))
    middles = np.array([complex(*tile.envelope.centroid.coords[0]) for tile in sheet.tiles])
    order = np.lexsort((np.round(middles.real, 3), np.round(middles.imag, 3)))
    assert order.tolist() == list(range(len(middles)))


# --- regions and winding numbers -----------------------------------------------------------------------------------


def test_a_rectangle_needs_a_width_and_a_height() -> None:
    """And tells what it is."""
    region = Region.rectangle(1, 2, 4, 6)
    assert region.bounds == (1.0, 2.0, 4.0, 6.0)
    assert region_area(region) == 12.0
    assert region.is_rectangle
    for other in (polygon(0j, 1 + 0j, 1j), polygon(0j, 2 + 1j, 1 + 3j, -1 + 2j), Region(rounded(0, 0, 4, 3, 1))):
        assert not other.is_rectangle
    for corners in ((1, 2, 1, 6), (1, 2, 4, 2), (4, 2, 1, 6), (1, float("nan"), 4, 6)):
        with pytest.raises(ValueError, match="a width and a height"):
            Region.rectangle(*corners)


def test_region_predicates_against_shapely() -> None:
    """Inside or outside, the distance from the border, and the nearest place on it."""
    rings = [rounded(0, 0, 8, 6, 1.5), circle(4 + 3j, 1.2, hole=True, parts=3, turn=0.5)]
    region = Region(Paths.concatenate(rings))
    rng = np.random.default_rng(5)
    places = rng.uniform(-1, 9, 400) + 1j * rng.uniform(-1, 7, 400)
    seen, points = shape(region.border, 1e-8), shapely.points(places.real, places.imag)
    assert region.contains(places).tolist() == shapely.contains(seen, points).tolist()
    away = shapely.distance(seen.boundary, points)
    assert np.abs(region.distance(places) - away).max() < 1e-6
    piece, share, foot = region.on_border(places)
    assert np.abs(np.abs(foot - places) - away).max() < 1e-6
    assert shapely.distance(seen.boundary, shapely.points(foot.real, foot.imag)).max() < 1e-6
    assert ((share >= 0) & (share <= 1)).all()
    lines = region.border.kind[piece] == LINE
    start, end = region.border.start[piece], region.border.end[piece]
    assert np.abs(start + share * (end - start) - foot)[lines].max() < 1e-12
    _, share, place = region.on_border(region.border.start)
    assert (place == region.border.start).all()
    assert np.minimum(share, 1 - share).max() < 1e-12


def test_winding_numbers_against_angles() -> None:
    """Random closed paths that cross themselves: small steps turn by angles that add up to the winding number."""
    rng = np.random.default_rng(11)
    t = np.linspace(0, 1, 4001)[:, None]
    for _ in range(20):
        count = int(rng.integers(2, 8))
        corners: Complexes = rng.integers(-4, 5, count) + 1j * rng.integers(-4, 5, count)
        corners += 0.01 * rng.standard_normal(count)
        control = rng.uniform(-5, 5, count) + 1j * rng.uniform(-5, 5, count)
        kind = rng.choice([LINE, QUAD], count).astype(np.uint8)
        control[kind == LINE] = 0
        paths = replace(
            Paths.polylines([corners], closed=True), control=np.column_stack((control, 0 * control)), kind=kind
        )
        a, b, c = paths.start, paths.control[:, 0], paths.end
        curve = np.where(kind == LINE, a + (c - a) * t, a * (1 - t) ** 2 + 2 * b * t * (1 - t) + c * t**2)
        line = np.append(curve[:-1].T.ravel(), curve[0, 0])
        places: Complexes = rng.uniform(-5, 5, 40) + 1j * rng.uniform(-5, 5, 40)
        places = places[np.abs(line[:, None] - places).min(axis=0) > 0.02]
        turns = np.angle((line[1:, None] - places) / (line[:-1, None] - places)).sum(axis=0) / (2 * np.pi)
        assert winding(paths, places).tolist() == np.rint(turns).astype(int).tolist()


def test_winding_numbers_of_points_on_the_lines_of_chords() -> None:
    """Level with corners, and beyond them, on a grid."""
    places = np.array([complex(x, y) for x in range(-1, 6) for y in range(-1, 6)])
    ring = Paths.polylines([[0j, 4 + 0j, 4 + 4j, 2 + 2j, 4j]], closed=True)
    seen = shape(ring)
    away = shapely.distance(seen.boundary, shapely.points(places.real, places.imag)) > 0
    inside = shapely.contains(seen, shapely.points(places.real, places.imag))
    assert (winding(ring, places) > 0)[away].tolist() == inside[away].tolist()


def test_winding_numbers_refuse_cubic_curves() -> None:
    """They have to be replaced before."""
    ring = Paths.polylines([[0j, 1 + 0j, 1j]], closed=True)
    with pytest.raises(ValueError, match="cubic"):
        winding(replace(ring, kind=np.full(3, CUBIC, np.uint8)), np.zeros(1, np.complex128))


# --- the oracles can fail ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def sound() -> Sheet:
    """A sheet of a few tiles that passes everything."""
    unit = size("p6-propeller")
    sheet = Sheet(period("p6-propeller"), Region(circle(3 + 1j, 0.8 * unit)))
    check_sheet(sheet, np.pi * 0.64 * unit**2)
    assert sheet.placement.whole.any()
    return sheet


def with_answer(sheet: Sheet, **answers: object) -> Sheet:
    """The same sheet with other answers in the place of its own."""
    changed = Sheet(sheet.period, sheet.region)
    changed.__dict__.update(sheet.__dict__ | answers)
    return changed


def test_the_placement_oracle_sees_what_is_wrong(sound: Sheet) -> None:
    """A tile left out, one too many, one that is not whole, one that is."""
    placed = sound.placement
    cut, whole = int(np.flatnonzero(~placed.whole)[0]), int(np.flatnonzero(placed.whole)[0])
    rest = np.delete(np.arange(len(placed.tile)), cut)
    left_out = TilePlacement(placed.tile[rest], placed.step[rest], placed.whole[rest])
    with pytest.raises(AssertionError, match="is missing"):
        check_placement(with_answer(sound, placement=left_out))
    tile, step = candidates(sound)
    there = {(k, *s) for k, s in zip(placed.tile.tolist(), placed.step.tolist(), strict=True)}
    more = next(n for n in range(len(tile)) if (int(tile[n]), *step[n].tolist()) not in there)
    added = TilePlacement(
        np.append(placed.tile, tile[more]), np.vstack((placed.step, step[more])), np.append(placed.whole, False)
    )
    with pytest.raises(AssertionError, match="is not on the region"):
        check_placement(with_answer(sound, placement=added))
    for k, message in ((cut, "is not whole"), (whole, "is whole")):
        flags = placed.whole.copy()
        flags[k] ^= True
        with pytest.raises(AssertionError, match=message):
            check_placement(with_answer(sound, placement=replace(placed, whole=flags)))


def test_the_area_and_shape_oracles_see_what_is_wrong(sound: Sheet) -> None:
    """A piece moved by a hundredth of a millimetre, and one that belongs to another tile."""
    paths = sound.pieces.paths
    end = paths.control.copy()
    bent = int(np.flatnonzero(paths.kind == QUAD)[0])
    end[bent, 0] += 1e-2
    moved = with_answer(sound, pieces=replace(sound.pieces, paths=replace(paths, control=end)))
    area = np.pi * 0.64 * size("p6-propeller") ** 2
    with pytest.raises(AssertionError, match="area off"):
        check_areas(moved, area)
    with pytest.raises(AssertionError, match="pieces are off"):
        check_shapes(moved)
    swapped = with_answer(sound, pieces=replace(sound.pieces, tile=np.roll(sound.pieces.tile, 1)))
    with pytest.raises(AssertionError, match="pieces are off"):
        check_shapes(swapped)
    frame = replace(sound.frame, paths=sound.frame.paths.moved(1, 1e-2))
    with pytest.raises(AssertionError, match="frame is off"):
        check_shapes(with_answer(sound, frame=frame))


def test_the_length_and_overlap_oracles_see_what_is_wrong(sound: Sheet) -> None:
    """A strand that is missing, one that is there twice, and one that is there again a little aside."""
    strands = sound.strands
    count = len(strands.paths)
    fewer = np.arange(count - 1)
    without = replace(strands, paths=strands.paths.take(fewer), border=strands.border[fewer])
    with pytest.raises(AssertionError, match="inner strands"):
        check_lengths(with_answer(sound, strands=without))
    last = strands.paths.take(np.array([count - 1]))
    with pytest.raises(AssertionError, match="lies on other strands"):
        check_apart(Paths.concatenate([strands.paths, last]))
    with pytest.raises(AssertionError, match="lies near other strands"):
        check_apart(Paths.concatenate([strands.paths, last.moved(1, 1e-7)]))


def test_the_oracle_of_ends_sees_a_bit(sound: Sheet) -> None:
    """One ulp off is not the same point."""
    strands = sound.strands
    node = strands.node.copy()
    node[strands.first[0]] = np.nextafter(node[strands.first[0]].real, np.inf) + 1j * node[strands.first[0]].imag
    with pytest.raises(AssertionError):
        check_ends(strands.paths, node, strands.first, strands.last)


def test_all_designs_are_there() -> None:
    """The examples and the 17 groups."""
    assert len(NAMES) == len(EXAMPLES) + len(GROUPS) >= 17 + 20

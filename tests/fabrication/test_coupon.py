"""The kerf coupon, judged by a simulated cut: material minus all cut lines, as wide as the kerf, gives the pieces."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.fabrication.coupon import KERFS_MAX, STRIP_MM, STRIPS, coupon_drawing, kerf_range
from voronoi_tiles.formats.page import Drawing
from voronoi_tiles.paths.paths import ARC, Paths

KERFS = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4)
ROUND = 1024
"""Chords to a quarter of a circle in the simulation: they are r / 3,400,000 off."""


def rings(paths: Paths, chords: int = ROUND) -> list[shapely.LinearRing | shapely.LineString]:
    """The paths as shapely lines; an arc's points are on the circle through its three points."""
    found = []
    for closed, (first, stop) in zip(paths.closed.tolist(), pairwise(paths.offsets.tolist()), strict=True):
        points = [complex(paths.start[first])]
        for k in range(first, stop):
            a, b = complex(paths.start[k]), complex(paths.end[k])
            if paths.kind[k] == ARC:
                points += arc_points(a, complex(paths.control[k, 0]), b, chords)
            points.append(b)
        corners = [(z.real, z.imag) for z in points]
        found.append(shapely.LinearRing(corners) if closed else shapely.LineString(corners))
    return found


def arc_points(a: complex, m: complex, b: complex, chords: int) -> list[complex]:
    """Points of the circle through three points, between the first and the last of them."""
    u, v = m - a, b - a
    centre = a + (abs(u) ** 2 * v - abs(v) ** 2 * u) / (u.conjugate() * v - u * v.conjugate())
    turn = np.angle((m - centre) / (a - centre)) + np.angle((b - centre) / (m - centre))
    points = centre + (a - centre) * np.exp(1j * turn * np.arange(1, chords) / chords)
    return [complex(z) for z in points]


def cut_lines(drawing: Drawing, chords: int = ROUND) -> list[shapely.LinearRing]:
    """All that is cut."""
    return [ring for layer in drawing.layers if layer.work == "cut" for ring in rings(layer.paths, chords)]


def pieces(drawing: Drawing, kerf: float) -> list[shapely.Polygon]:
    """What lies on the bed after the cut, the largest first."""
    sheet = shapely.box(0, 0, drawing.width, drawing.height)
    beams = [shapely.buffer(ring, kerf / 2, quad_segs=ROUND) for ring in cut_lines(drawing)]
    left = sheet.difference(shapely.union_all(beams))
    return sorted(left.geoms, key=lambda piece: -piece.area)


def at(found: list[shapely.Polygon], place: complex) -> shapely.Polygon:
    """The piece that covers a place."""
    (piece,) = [piece for piece in found if piece.covers(shapely.Point(place.real, place.imag))]
    return piece


def middles(paths: Paths) -> list[complex]:
    """The middles of the paths' bounds."""
    found = []
    for k in range(len(paths)):
        x0, y0, x1, y1 = paths.take(np.array([k])).bounds
        found.append(complex(x0 + x1, y0 + y1) / 2)
    return found


def sides(polygon: shapely.Geometry) -> tuple[float, float]:
    """Width and height."""
    x0, y0, x1, y1 = polygon.bounds
    return x1 - x0, y1 - y0


def holes_and_plugs(drawing: Drawing) -> tuple[list[complex], list[complex]]:
    """The middles of the holes and of the plugs, in one order: squares by kerf, circles by kerf."""
    _, inside, outside = drawing.layers
    holes = middles(inside.paths)
    return holes, middles(outside.paths)[STRIPS : STRIPS + len(holes)]


def open_hole(plate: shapely.Polygon, place: complex) -> shapely.Polygon:
    """The opening of the plate about a place."""
    return at([shapely.Polygon(ring) for ring in plate.interiors], place)


def fits(plug: shapely.Polygon, hole: shapely.Polygon, from_: complex, to: complex) -> tuple[float, float]:
    """The areas of the plug beside the hole, and of the hole that stays open, once the plug is in it."""
    shift = to - from_
    placed = shapely.transform(plug, lambda xy: xy + np.array([shift.real, shift.imag]))
    return placed.difference(hole).area, hole.difference(placed).area


@pytest.mark.parametrize("true", [0.2, *(pytest.param(kerf, marks=pytest.mark.slow) for kerf in (0.05, 0.4))])
def test_the_plug_for_the_true_kerf_fits_exactly(true: float) -> None:
    """Cut with kerf K, plug and hole for K have the nominal size and one outline; the others differ by 2 (K - k)."""
    drawing = coupon_drawing(KERFS, thickness=3.0, plug=12.0)
    found = pieces(drawing, true)
    holes, plugs = holes_and_plugs(drawing)
    assert len(holes) == 2 * len(KERFS)
    plate = at(found, holes[0] - 1j * 8)
    for k, (to, from_) in enumerate(zip(holes, plugs, strict=True)):
        kerf = KERFS[k % len(KERFS)]
        plug, hole = at(found, from_), open_hole(plate, to)
        assert sides(plug) == pytest.approx((12 + kerf - true,) * 2, abs=1e-6)
        assert sides(hole) == pytest.approx((12 - kerf + true,) * 2, abs=1e-6)
        over, free = fits(plug, hole, from_, to)
        if kerf == true:
            # The circles of the simulation are polygons, and their beams are as much off again.
            assert over + free < 1e-4
            assert (
                plug.hausdorff_distance(
                    shapely.transform(hole, lambda xy, d=from_ - to: xy + np.array([d.real, d.imag]))
                )
                < 5e-6
            )
        elif kerf < true:
            assert over < 1e-9
            assert free > 12 * (true - kerf) * 2
        else:
            assert free < 1e-9
            assert over > 12 * (kerf - true) * 2


def test_the_fit_is_sensitive() -> None:
    """A kerf that is 1 micrometre off shows in the same figures."""
    drawing = coupon_drawing((0.2,), thickness=3.0)
    holes, plugs = holes_and_plugs(drawing)
    found = pieces(drawing, 0.201)
    plate = at(found, holes[0] - 1j * 7)
    assert sides(at(found, plugs[0])) != pytest.approx((10, 10), abs=1e-6)
    over, free = fits(at(found, plugs[0]), open_hole(plate, holes[0]), plugs[0], holes[0])
    assert over + free > 0.03


def test_slots_take_the_sheet() -> None:
    """The slot for the true kerf is as wide as the sheet is thick, the others differ by K - k."""
    drawing = coupon_drawing(KERFS, thickness=4.0)
    true = 0.15
    found = pieces(drawing, true)
    holes, _ = holes_and_plugs(drawing)
    plate = at(found, holes[0] - 1j * 6.2)
    low = plate.bounds[1]
    level = shapely.LineString([(0, low + 2), (drawing.width, low + 2)])
    teeth = list(plate.intersection(level).geoms)
    assert len(teeth) == len(KERFS) + 1
    widths = [right.bounds[0] - left.bounds[2] for left, right in pairwise(teeth)]
    assert widths == pytest.approx([4 - kerf + true for kerf in KERFS], abs=1e-6)
    centres = [(left.bounds[2] + right.bounds[0]) / 2 for left, right in pairwise(teeth)]
    assert centres == pytest.approx([hole.real for hole in holes[: len(KERFS)]])


@pytest.mark.parametrize("true", [0.08, pytest.param(0.31, marks=pytest.mark.slow)])
def test_strips_measure_the_kerf(true: float) -> None:
    """The kerf is what is missing from the strips side by side, divided by their number."""
    drawing = coupon_drawing(KERFS, thickness=3.0)
    found = pieces(drawing, true)
    strips = [at(found, place) for place in middles(drawing.layers[2].paths)[:STRIPS]]
    total = sum(sides(strip)[0] for strip in strips)
    assert (STRIPS * STRIP_MM - total) / STRIPS == pytest.approx(true, abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.integers(0, 200), min_size=1, max_size=KERFS_MAX, unique=True),
    st.floats(0.25, 30),
    st.floats(8, 40),
)
def test_every_coupon_is_sound(steps: list[int], thickness: float, plug: float) -> None:
    """Closed cuts that neither meet nor leave the page, gaps of half the thickness, letters on their pieces."""
    kerfs = [step / 1000 for step in steps]
    drawing = coupon_drawing(kerfs, thickness=thickness, plug=plug)
    engrave, inside, outside = drawing.layers
    assert [layer.work for layer in drawing.layers] == ["engrave", "cut", "cut"]
    assert inside.paths.closed.all()
    assert outside.paths.closed.all()
    assert not engrave.paths.closed.any()
    for layer in drawing.layers:
        x0, y0, x1, y1 = layer.paths.bounds
        assert min(x0, y0, drawing.width - x1, drawing.height - y1) > 4

    lines = cut_lines(drawing, chords=32)
    assert all(line.is_simple for line in lines)
    polygons = [shapely.Polygon(line) for line in lines]
    tree = shapely.STRtree(lines)
    reach = max(3.0, thickness / 2) - 0.02
    pairs = tree.query(lines, predicate="dwithin", distance=reach).T
    assert not [pair for pair in pairs.tolist() if pair[0] != pair[1]]
    plate = polygons[-1]
    assert all(plate.contains(hole) for hole in polygons[: len(inside.paths)])
    plugs = polygons[len(inside.paths) + STRIPS : -1]
    assert len(plugs) == 2 * len(kerfs)

    # Each stroke lies on a plug or on the plate away from its holes, and at least a kerf from their edges.
    solid = shapely.union_all([plate.difference(shapely.union_all(polygons[: len(inside.paths)])), *plugs])
    strokes = shapely.multilinestrings(rings(engrave.paths))
    assert solid.buffer(-0.4).covers(strokes)


def bands(intervals: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """The intervals, those that overlap or touch joined."""
    joined: list[tuple[float, float]] = []
    for low, high in sorted(intervals):
        if joined and low <= joined[-1][1] + 1e-9:
            joined[-1] = (joined[-1][0], max(high, joined[-1][1]))
        else:
            joined.append((low, high))
    return joined


@pytest.mark.parametrize("plug", [8.0, 10.0, 25.0])
def test_the_lines_of_text_keep_apart(plug: float) -> None:
    """On the plate are numbers, the bar and three captions, and between any two neighbours there is room."""
    drawing = coupon_drawing([0.101 + 0.011 * k for k in range(KERFS_MAX)], thickness=1.0, plug=plug)
    engraved = [line.bounds for line in rings(drawing.layers[0].paths)]
    holes, _ = holes_and_plugs(drawing)
    above = [bounds for bounds in engraved if bounds[1] > holes[0].imag]
    rows = bands([(low, high) for _, low, _, high in above])
    assert len(rows) == 5
    assert min(after[0] - before[1] for before, after in pairwise(rows)) > 0.5
    # Within a number the digits are apart, too: what is joined here is what lies over one column.
    numbers = [bounds for bounds in above if bounds[3] <= rows[0][1]]
    columns = np.array([hole.real for hole in holes[:KERFS_MAX]])
    nearest = [int(np.argmin(np.abs(columns - (x0 + x1) / 2))) for x0, _, x1, _ in numbers]
    spans = [
        (min(x0 for (x0, *_), k in own), max(x1 for (_, _, x1, _), k in own))
        for own in ([(b, k) for b, k in zip(numbers, nearest, strict=True) if k == n] for n in range(KERFS_MAX))
    ]
    assert [(x0 + x1) / 2 for x0, x1 in spans] == pytest.approx(columns, abs=1e-9)
    assert min(after[0] - before[1] for before, after in pairwise(spans)) > 1


def test_any_order_gives_the_same_coupon() -> None:
    """Kerfs are sorted, and the same ones give the same arrays and recipe."""
    first, second = coupon_drawing((0.1, 0.3, 0.2), thickness=3), coupon_drawing((0.3, 0.2, 0.1), thickness=3)
    assert first.recipe == second.recipe
    for a, b in zip(first.layers, second.layers, strict=True):
        assert np.array_equal(a.paths.start, b.paths.start)
    assert first.recipe["kerfs"] == "0.1,0.2,0.3"


def test_no_cut_is_made_twice() -> None:
    """No two cut pieces share a stretch."""
    lines = cut_lines(coupon_drawing(KERFS, thickness=3))
    assert all(a.disjoint(b) for a, b in combinations(lines, 2))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.05:0.4:0.05", KERFS),
        ("0.05:0.4:0.05mm", KERFS),
        ("0.05mm:0.4mm:0.05mm", KERFS),
        (" 0.1 : 0.2 : 0.04 mm ", (0.1, 0.14, 0.18)),
        ("0.1:0.1:1", (0.1,)),
        ("0:.1:.05", (0.0, 0.05, 0.1)),
        ("0.01cm:0.02cm:0.005cm", (0.1, 0.15, 0.2)),
        ("0.1mm:0.02cm:0.05mm", (0.1, 0.15, 0.2)),
        ("0.002:0.006:0.002in", (0.0508, 0.1016, 0.1524)),
        ("0.15", (0.15,)),
        ("0.1,0.2,0.15mm", (0.1, 0.2, 0.15)),
    ],
)
def test_kerf_ranges(text: str, expected: tuple[float, ...]) -> None:
    """Ranges and lists in any unit, exact decimals, the last kerf included."""
    assert kerf_range(text) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is no range"),
        ("a:b:c", "is no range"),
        ("0.1:0.2", "is no range"),
        ("0.1:0.2:0.1:0.1", "is no range"),
        ("0.1:0.2:1e-9", "is no range"),
        ("nan", "is no range"),
        ("0.1,,0.2", "is no range"),
        ("0.1:0.2:0.1px", "is no range"),
        ("0.4:0.1:0.1", "is empty"),
        ("0.1:0.2:0", "is empty"),
        ("0.1:0.2:-0.1", "is empty"),
        ("0:1:0.00000000001", "too many"),
        ("0:" + "9" * 2000 + ":0.1", "too"),
        ("0:0.2:0.01", "more than 20 kerfs"),
        ("0:0.21:0.01", "more than 20 kerfs"),
    ],
)
def test_ranges_that_are_none(text: str, message: str) -> None:
    """One message with a remedy, in no time."""
    with pytest.raises(ValueError, match=message) as caught:
        kerf_range(text)
    assert str(caught.value).endswith(".")
    assert ". " in str(caught.value)
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize(
    ("kerfs", "thickness", "plug", "message"),
    [
        ((), 3, 10, "no kerf to test"),
        ((-0.1, 0.1), 3, 10, "kerf of -0.1 mm"),
        ((float("nan"),), 3, 10, "a kerf of nan"),
        ((float("inf"),), 3, 10, "a kerf of inf"),
        ((0.1, 0.1), 3, 10, "alike"),
        ((0.1, 0.1001), 3, 10, "alike"),
        (tuple(k / 100 for k in range(21)), 3, 10, "more than 20 kerfs"),
        ((3.0,), 5, 10, "too much"),
        ((0.3,), 0.3, 10, "too much"),
        ((0.1,), 0, 10, "sheet of 0 mm"),
        ((0.1,), -3, 10, "sheet of -3 mm"),
        ((0.1,), float("nan"), 10, "sheet of nan"),
        ((0.1,), 300, 10, "sheet of 300 mm"),
        ((0.1,), 3, 2, "plugs of 2 mm"),
        ((0.1,), 3, float("nan"), "plugs of nan"),
    ],
)
def test_coupons_that_cannot_be(kerfs: tuple[float, ...], thickness: float, plug: float, message: str) -> None:
    """Each is refused with what is wrong and a remedy."""
    with pytest.raises(ValueError, match=message) as caught:
        coupon_drawing(kerfs, thickness=thickness, plug=plug)
    assert ". " in str(caught.value)
    assert str(caught.value).endswith(".")

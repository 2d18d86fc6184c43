"""What is drawn in Blender becomes strokes that are the same curves."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.blender.drawn_splines import DrawnSpline, nurbs_knots, strokes_of

CURVE = np.array([1 + 1j, 4 + 2j, 6 + 7j])
LEFT, RIGHT = CURVE - (1 - 0.5j), CURVE + (1 - 0.5j)

ROWS = st.lists(st.complex_numbers(max_magnitude=50.0, allow_nan=False), min_size=1, max_size=60)


def table(spline: DrawnSpline, smoothing: float = 0.1) -> dict[str, Any]:
    """The only stroke of a spline, as in a design file."""
    (stroke,) = strokes_of([spline], smoothing)
    return stroke.table


def points_of(value: Any) -> list[complex]:
    """Points of a table."""
    return [complex(*pair) for pair in value]


@pytest.mark.parametrize("closed", [False, True])
def test_a_bezier_spline_keeps_its_control_points(closed: bool) -> None:
    """All of them, in their order; a closed one comes back to its start."""
    found = points_of(table(DrawnSpline("bezier", CURVE, closed, LEFT, RIGHT))["bezier"])
    expected = [CURVE[0], RIGHT[0], LEFT[1], CURVE[1], RIGHT[1], LEFT[2], CURVE[2]]
    assert found == expected + ([RIGHT[2], LEFT[0], CURVE[0]] if closed else [])


def test_points_that_are_drawn_twice_count_once() -> None:
    """While one extrudes a spline its new point lies on the last: that is no error, and a spline of one is a point."""
    twice = np.repeat(CURVE, 2)
    assert points_of(table(DrawnSpline("poly", twice))["polyline"]) == CURVE.tolist()
    assert table(DrawnSpline("poly", np.append(CURVE, CURVE[:1]), True))["closed"] is True
    assert points_of([table(DrawnSpline("poly", CURVE[:1].repeat(3)))["point"]]) == [1 + 1j]
    assert table(DrawnSpline("poly", CURVE[:2], True)).get("closed", False) is False
    same = DrawnSpline("bezier", CURVE[:1].repeat(2), False, CURVE[:1].repeat(2), CURVE[:1].repeat(2))
    assert points_of([table(same)["point"]]) == [1 + 1j]
    ends = CURVE[[0, 0, 1]]
    half = table(
        DrawnSpline("bezier", ends, False, np.array([1 + 1j, 1 + 1j, 3 + 2j]), np.array([1 + 1j, 2 + 2j, 5 + 2j]))
    )
    assert points_of(half["bezier"]) == [1 + 1j, 2 + 2j, 3 + 2j, 4 + 2j]


def test_nothing_is_no_stroke() -> None:
    """A spline without points, and a NURBS that is too short for its order, of which Blender draws nothing."""
    none = np.zeros(0, np.complex128)
    short = DrawnSpline("nurbs", CURVE, order=4, weights=np.ones(3), knots=np.arange(7.0))
    assert (
        strokes_of(
            [DrawnSpline("poly", none), DrawnSpline("freehand", none, True), DrawnSpline("bezier", none), short], 1.0
        )
        == []
    )


@given(ROWS, st.booleans(), st.floats(1e-3, 5.0))
def test_what_is_drawn_by_hand_stays_near(points: list[complex], closed: bool, smoothing: float) -> None:
    """Every point is within the smoothing of the chords between those that are kept, in their order."""
    row = np.array(points)
    (stroke,) = strokes_of([DrawnSpline("freehand", row, closed)], smoothing)
    kept = next(points_of(value if isinstance(value[0], tuple | list) else [value]) for value in stroke.table.values())
    line = shapely.LineString(plane(np.array(kept if len(kept) > 1 else kept * 2)))
    away = shapely.distance(shapely.points(plane(row)), line)
    assert away.max() <= smoothing * (1 + 1e-9)
    places = iter(points)
    assert all(any(place == one for place in places) for one in kept)


def test_smoothing_leaves_out_what_it_may() -> None:
    """A straight row is its two ends, and a wave of less than the smoothing is straight."""
    row = np.linspace(0, 10, 101) + 0.04j * np.sin(np.arange(101))
    assert points_of(table(DrawnSpline("freehand", row))["polyline"]) == [row[0], row[-1]]
    assert len(points_of(table(DrawnSpline("freehand", row), 0.004)["catmull_rom"])) > 20


def along(spline: DrawnSpline, count: int) -> Complexes:
    """Points along a NURBS by scipy: the quotient of two splines."""
    degree = spline.order - 1
    points, weights = spline.points, spline.weights
    if spline.closed:
        points, weights = np.append(points, points[:degree]), np.append(weights, weights[:degree])
    t = np.linspace(spline.knots[degree], spline.knots[len(points)], count)
    top = [BSpline(spline.knots, part * weights, degree)(t) for part in (points.real, points.imag)]
    return np.asarray((top[0] + 1j * top[1]) / BSpline(spline.knots, weights, degree)(t))


@pytest.mark.parametrize("order", [2, 3, 4, 5])
@pytest.mark.parametrize(("closed", "clamped"), [(False, False), (False, True), (True, False)])
def test_nurbs_are_followed(order: int, closed: bool, clamped: bool) -> None:
    """What is drawn goes through points of the curve, weights minded, and is never farther from it than it may be."""
    rng = np.random.default_rng(order)
    points = rng.normal(size=8) + 1j * rng.normal(size=8)
    knots = nurbs_knots(8, order, closed=closed, clamped=clamped, bezier=False)
    spline = DrawnSpline("nurbs", points, closed, order=order, weights=rng.uniform(0.5, 2, 8), knots=knots)
    found = table(spline, 1e-9)
    kept = np.array(points_of(found["catmull_rom"]))
    exact = along(spline, 16 * 8 + 1)
    assert np.abs(kept[:, None] - exact).min(axis=1).max() < 1e-12
    assert np.abs(exact[:, None] - kept).min(axis=1).max() < (1e-12 if order > 2 else np.inf)
    assert found.get("closed", False) is closed
    if not closed and clamped:
        assert abs(kept[0] - points[0]) < 1e-12
        assert abs(kept[-1] - points[-1]) < 1e-12

"""What is drawn in Blender becomes strokes that are the same curves."""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.blender.drawn_splines import DrawnSpline, nurbs, strokes_of

CURVE = np.array([1 + 1j, 4 + 2j, 6 + 7j])
LEFT, RIGHT = CURVE - (1 - 0.5j), CURVE + (1 - 0.5j)

PLACES = st.complex_numbers(max_magnitude=50.0, allow_nan=False).map(
    lambda place: complex(round(place.real, 12), round(place.imag, 12))
)
"""Shapely, which judges them, warns of segments whose length has a square of 0."""

ROWS = st.lists(PLACES, min_size=1, max_size=60)


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


@pytest.mark.parametrize("tiny", [5e-324, 1e-302, 1e-170])
def test_rows_whose_ends_all_but_meet_keep_what_is_between(tiny: float) -> None:
    """Also where the square of the distance of the ends is 0."""
    found = table(DrawnSpline("freehand", np.array([tiny + 0j, 1j, 0j])))
    assert points_of(found["catmull_rom"]) == [tiny, 1j, 0j]


def test_smoothing_leaves_out_what_it_may() -> None:
    """A straight row is its two ends, and a wave of less than the smoothing is straight."""
    row = np.linspace(0, 10, 101) + 0.04j * np.sin(np.arange(101))
    assert points_of(table(DrawnSpline("freehand", row))["polyline"]) == [row[0], row[-1]]
    assert len(points_of(table(DrawnSpline("freehand", row), 0.004)["catmull_rom"])) > 20


def along(spline: DrawnSpline) -> Complexes:
    """Points along a NURBS by scipy, as many from each knot to the next: the quotient of two splines."""
    degree = spline.order - 1
    points, weights = spline.points, spline.weights
    if spline.closed:
        points, weights = np.append(points, points[:degree]), np.append(weights, weights[:degree])
    breaks = sorted({*spline.knots[degree : len(points) + 1]})
    steps = math.ceil(16 * len(spline.points) / (len(breaks) - 1))
    t = np.unique([low + (high - low) * k / steps for low, high in pairwise(breaks) for k in range(steps + 1)])
    t[-1] = np.nextafter(t[-1], 0.0)  # where more knots are the same than the degree, scipy is beyond them
    top = [BSpline(spline.knots, part * weights, degree)(t) for part in (points.real, points.imag)]
    return np.asarray((top[0] + 1j * top[1]) / BSpline(spline.knots, weights, degree)(t))


def random_nurbs(order: int, closed: bool, clamped: bool, bezier: bool = False) -> DrawnSpline:
    """A NURBS curve of random points and weights, with Blender's knots."""
    rng = np.random.default_rng(order)
    points = rng.normal(size=12) + 1j * rng.normal(size=12)
    return nurbs(points, rng.uniform(0.5, 2, 12), order, closed=closed, clamped=clamped, bezier=bezier)


KINDS = [(False, False), (False, True), (True, False)]
"""Of NURBS: closed, and clamped."""


@pytest.mark.parametrize("order", [3, 4, 5])
@pytest.mark.parametrize(("closed", "clamped"), KINDS)
def test_nurbs_are_followed(order: int, closed: bool, clamped: bool) -> None:
    """What is drawn goes through points of the curve, weights minded, and is never farther from it than it may be."""
    spline = random_nurbs(order, closed, clamped)
    found = table(spline, 1e-9)
    kept, exact = np.array(points_of(found["catmull_rom"])), along(spline)
    assert np.abs(kept[:, None] - exact).min(axis=1).max() < 1e-12
    assert np.abs(exact[:, None] - kept).min(axis=1).max() < 1e-12
    assert found.get("closed", False) is closed
    if not closed and clamped:
        assert abs(kept[0] - spline.points[0]) < 1e-12
        assert abs(kept[-1] - spline.points[-1]) < 1e-12


@pytest.mark.parametrize(("closed", "clamped"), KINDS)
def test_nurbs_of_order_2_are_polylines(closed: bool, clamped: bool) -> None:
    """With all of their corners, whatever the weights; Blender before 5.0 draws them without."""
    spline = random_nurbs(2, closed, clamped)
    found = table(spline, 0.5)
    assert points_of(found["polyline"]) == spline.points.tolist()
    assert found.get("closed", False) is closed


@pytest.mark.parametrize(("closed", "clamped"), KINDS)
def test_nurbs_of_one_point_are_that_point(closed: bool, clamped: bool) -> None:
    """Whatever their knots; their order is as many as there are points."""
    one = nurbs(np.array([3 + 4j]), np.ones(1), 1, closed=closed, clamped=clamped, bezier=True)
    assert table(one)["point"] == (3.0, 4.0)


@pytest.mark.parametrize("order", [3, 4])
@pytest.mark.parametrize(("closed", "clamped"), KINDS)
def test_nurbs_keep_their_corners(order: int, closed: bool, clamped: bool) -> None:
    """Those of Bezier knots: pieces end there, one where the next begins, each as smooth as it is drawn."""
    spline = random_nurbs(order, closed, clamped, bezier=True)
    pieces = [np.array(points_of(next(iter(one.table.values())))) for one in strokes_of([spline], 1e-9)]
    exact, drawn = along(spline), np.concatenate(pieces)
    assert len(pieces) > 1
    assert all(abs(one[-1] - other[0]) < 1e-12 for one, other in pairwise(pieces))
    assert not closed or abs(pieces[-1][-1] - pieces[0][0]) < 1e-12
    assert np.abs(drawn[:, None] - exact).min(axis=1).max() < 1e-12
    assert np.abs(exact[:, None] - drawn).min(axis=1).max() < 1e-12

    end = len(spline.points) + (order - 1) * closed
    (first, *inner, last), count = sorted({*spline.knots[order - 1 : end + 1]}), Counter(spline.knots)
    corners = [exact[round((t - first) / (last - first) * (len(exact) - 1))] for t in inner if count[t] >= order - 1]
    ends = np.array([piece[-1] for piece in pieces])
    assert len(corners) > 1
    assert all(np.abs(ends - corner).min() < 1e-12 for corner in corners)


@pytest.mark.parametrize(
    ("count", "order", "closed", "clamped"), [(7, 3, True, False), (8, 4, True, True), (5, 5, False, False)]
)
def test_what_blender_cannot_draw_is_the_row_of_its_points(count: int, order: int, closed: bool, clamped: bool) -> None:
    """Closed Bezier curves whose points are no multiple of the degree, and those of less than one piece."""
    points = np.exp(1j * np.arange(count)) * np.arange(1, count + 1)
    found = table(nurbs(points, np.ones(count), order, closed=closed, clamped=clamped, bezier=True))
    assert points_of(found["polyline"]) == points.tolist()
    assert found.get("closed", False) is closed

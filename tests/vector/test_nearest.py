"""Distances of points from arcs, against a reference with 50 digits and against dense samples."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import mpmath
import numpy as np
import numpy.typing as npt
import pytest
from helpers.outlines import RIGHT

from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.vector.arcs import Arc, LineArc, ParabolaArc
from voronoi_tiles.vector.nearest import distance_to_arcs
from voronoi_tiles.vector.outline import Outline

Ends = tuple[complex, complex, complex]
"""Start, control and end of a curve."""

NEAR = (0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1)
"""How far beside an arc points are taken; radii of curvature. All are within a twentieth of its length, too."""

BULGE: Ends = (0j, 3 + 5j, 7 + 1j)


def line(start: complex, end: complex) -> LineArc:
    """A straight arc."""
    return LineArc(start, end, RIGHT)


def curve(ends: Ends) -> ParabolaArc:
    """A curved arc; nothing here reads its focus and directrix."""
    return ParabolaArc(*ends, 0j, (0j, 1j), RIGHT)


def distances(arcs: Sequence[Arc], points: Sequence[complex]) -> npt.NDArray[np.float64]:
    """The distance of each point from the arc of the same number."""
    return np.asarray(distance_to_arcs(Outline.from_rings([arcs]), np.arange(len(arcs)), np.array(points, complex)))


def reference(ends: Ends, point: complex) -> float:
    """The distance of a point from a quadratic Bezier curve, correct to the last digit.

    Feet of perpendiculars are zeros of a cubic; between its turning points and the curve's ends it is monotone, and
    halving finds them.
    """
    with mpmath.workdps(50):
        start, control, end = (mpmath.mpmathify(z) for z in ends)
        bend, side, away = start - 2 * control + end, control - start, start - mpmath.mpmathify(point)

        def dot(u: mpmath.mpc, v: mpmath.mpc) -> mpmath.mpf:
            return u.real * v.real + u.imag * v.imag

        a, b, c, d = dot(bend, bend), 3 * dot(bend, side), 2 * dot(side, side) + dot(bend, away), dot(side, away)
        cuts = [mpmath.mpf(0), mpmath.mpf(1)]
        if a and b * b > 3 * a * c:
            w = -b - mpmath.sign(b) * mpmath.sqrt(b * b - 3 * a * c) if b else mpmath.sqrt(-3 * a * c)
            cuts += [t for t in (w / (3 * a), c / w) if 0 < t < 1]
        cuts.sort()
        feet = list(cuts)
        for before, after in pairwise(cuts):
            low, high = before, after
            while high - low > mpmath.mpf(10) ** -40:
                middle = (low + high) / 2
                low, high = (middle, high) if ((a * middle + b) * middle + c) * middle + d < 0 else (low, middle)
            feet.append(low)
        return float(min(abs(away + t * (2 * side + t * bend)) for t in feet))


def sampled(ends: Ends, point: complex) -> float:
    """The least distance of a point from 200,001 points of a curve: a little too large."""
    start, control, end = ends
    t = np.linspace(0.0, 1.0, 200_001)
    return float(np.abs((1 - t) ** 2 * start + 2 * t * (1 - t) * control + t * t * end - point).min())


def parabola(focal: float, rng: np.random.Generator) -> tuple[Ends, complex, complex, float]:
    """A turned arc of y = x^2 / 4 focal, about 1 long, and on it a point, its unit normal and radius of curvature."""
    scale = 2.0 * min(focal**0.5, 1.0)
    one, two = rng.uniform(-1.0, 1.0, 2) if rng.random() < 0.7 else np.array([-1.0, 1.0])
    share = rng.uniform(0.0, 1.0) if rng.random() < 0.7 else np.clip(one / (one - two), 0.0, 1.0)
    x0, x1, x = (scale * v for v in (one, two, one + share * (two - one)))
    unit = np.exp(1j * rng.uniform(0.0, 2 * np.pi))
    slope = x / (2 * focal)
    low, high, point = (unit * complex(v, v * v / (4 * focal)) for v in (x0, x1, x))
    control = unit * complex((x0 + x1) / 2, x0 * x1 / (4 * focal))
    normal = unit * complex(-slope, 1.0) / np.hypot(slope, 1.0)
    return (low, control, high), point, normal, 2 * focal * float(np.hypot(slope, 1.0)) ** 3


@pytest.mark.parametrize("seed", range(5))
def test_the_reference_agrees_with_samples(seed: int) -> None:
    """The oracle itself, on curves that are no more than generally bent."""
    rng = np.random.default_rng(seed)
    z = rng.uniform(-1, 1, (8, 4)) + 1j * rng.uniform(-1, 1, (8, 4))
    for start, control, end, point in z.tolist():
        true = reference((start, control, end), point)
        assert -1e-15 < sampled((start, control, end), point) - true < 1e-5


def test_lines() -> None:
    """Beside a segment the height above it, beyond its ends the distance from the end."""
    rng = np.random.default_rng(3)
    z = rng.uniform(-9, 9, (200, 3)) + 1j * rng.uniform(-9, 9, (200, 3))
    got = distances([line(start, end) for start, end, _ in z.tolist()], z[:, 2].tolist())
    true = [reference((start, (start + end) / 2, end), point) for start, end, point in z.tolist()]
    assert np.abs(got - true).max() < 1e-14


@pytest.mark.parametrize(
    ("point", "distance"), [(3 + 2j, 2), (7 - 1j, 1), (-3 + 4j, 5), (13 - 4j, 5), (0, 0), (10, 0), (4, 0), (12, 2)]
)
def test_points_about_a_segment(point: complex, distance: float) -> None:
    """Both sides, both ends, on it and in line with it: whole numbers, exactly."""
    assert distances([line(0j, 10 + 0j)], [point]) == distance


@pytest.mark.parametrize("focal", [1e-6, 1e-4, 1e-2, 1.0, 1e3, 1e6, 1e12])
def test_points_near_a_parabola(focal: float) -> None:
    """To rounding, from needles a millionth of their length wide up to curves that are all but straight."""
    rng = np.random.default_rng(11)
    for _ in range(12):
        ends, on, normal, radius = parabola(focal, rng)
        beside = np.array([share * radius for share in NEAR if share * radius < 0.05]) * rng.choice([-1.0, 1.0])
        points = (on + beside * normal).tolist()
        got = distances([curve(ends)] * len(points), points)
        true = np.array([reference(ends, point) for point in points])
        assert np.abs(got - true).max() <= 8 * EPSILON


@pytest.mark.parametrize("focal", [1e-6, 1e-2, 1.0, 1e3])
def test_points_anywhere(focal: float) -> None:
    """Far from a curve the distance is never too small, nor larger than that of an end or of the curve's quarters."""
    rng = np.random.default_rng(5)
    for _ in range(25):
        ends, on, *_ = parabola(focal, rng)
        start, control, end = ends
        point = on + complex(rng.normal(), rng.normal()) * 10.0 ** rng.uniform(-3.0, 1.0)
        (got,) = distances([curve(ends)], [point]).tolist()
        t = np.linspace(0.0, 1.0, 5)
        quarters = np.abs((1 - t) ** 2 * start + 2 * t * (1 - t) * control + t * t * end - point)
        slack = 16 * EPSILON * max(1.0, got)
        assert reference(ends, point) - slack <= got <= quarters.min() + slack


@pytest.mark.parametrize("t", [0.0, 1e-9, 0.3, 0.5, 0.999, 1.0])
def test_points_on_a_curve(t: float) -> None:
    """Nothing but rounding."""
    start, control, end = BULGE
    point = (1 - t) ** 2 * start + 2 * t * (1 - t) * control + t * t * end
    assert distances([curve(BULGE)], [point]).item() < 8 * EPSILON * 7


@pytest.mark.parametrize("beyond", [1e-9, 1e-3, 0.1, 1.0])
def test_points_beyond_the_ends(beyond: float) -> None:
    """On the tangents, and on the parabola's own continuation: the end is nearest."""
    start, control, end = BULGE
    before, after = (start - control) / abs(start - control), (end - control) / abs(end - control)
    bend = start - 2 * control + end
    on = end + 2 * beyond * (end - control) + beyond**2 * bend
    back = start - 2 * beyond * (control - start) + beyond**2 * bend
    points = [start + beyond * before, end + beyond * after, back, on]
    true = [beyond, beyond, abs(back - start), abs(on - end)]
    assert distances([curve(BULGE)] * 4, points) == pytest.approx(true, rel=1e-12, abs=1e-15)


def test_a_curve_that_does_not_bend() -> None:
    """The control point in the middle, exactly and up to rounding: a segment."""
    rng = np.random.default_rng(2)
    z = rng.uniform(-5, 5, (50, 3)) + 1j * rng.uniform(-5, 5, (50, 3))
    for off in (0.0, 1e-16, 1e-15, 1e-13):
        arcs = [curve((start, (start + end) / 2 + off * (end - start) * 1j, end)) for start, end, _ in z.tolist()]
        straight = [line(start, end) for start, end, _ in z.tolist()]
        points = z[:, 2].tolist()
        assert np.abs(distances(arcs, points) - distances(straight, points)).max() < 1e-14 + 10 * off


@pytest.mark.parametrize(
    ("ends", "point"),
    [
        ((0j, 0j, 4 + 2j), 1 + 3j),
        ((0j, 4 + 2j, 4 + 2j), 1 + 3j),
        ((0j, 6 + 3j, 4 + 2j), 8 + 4j),
        ((0j, 6 + 3j, 4 + 2j), 3 + 4j),
        ((0j, -2 - 1j, 4 + 2j), -2 + 0j),
        ((1j, 5 + 1j, 1j), 2 + 2j),
        ((1j, 5 + 1j, 1j), 9 + 1j),
    ],
    ids=["rest at the start", "rest at the end", "behind a fold", "a fold", "a fold before", "there and back", "tip"],
)
def test_degenerate_curves(ends: Ends, point: complex) -> None:
    """Control points on an end, and curves that fold back upon themselves."""
    assert distances([curve(ends)], [point]).item() == pytest.approx(reference(ends, point), rel=1e-12)


@pytest.mark.parametrize("point", [0j, 3 + 4j, 1e-200 + 0j])
def test_arcs_without_length(point: complex) -> None:
    """A point: of a line, and of a curve."""
    place = 2 - 1j
    got = distances([line(place, place), curve((place, place, place))], [place + point] * 2)
    assert (got == abs(point)).all() or (abs(point) < 1e-100 and (got == 0.0).all())


def test_an_arc_and_its_reverse_are_equally_far() -> None:
    """Up to rounding: the crossing is looked for from both tiles."""
    rng = np.random.default_rng(8)
    z = rng.uniform(-5, 5, (100, 4)) + 1j * rng.uniform(-5, 5, (100, 4))
    t, size = rng.uniform(0, 1, 100), 1e-3
    points = (1 - t) ** 2 * z[:, 0] + 2 * t * (1 - t) * z[:, 1] + t * t * z[:, 2] + size * (z[:, 3] / 5)
    there = distances([curve((a, b, c)) for a, b, c, _ in z.tolist()], points.tolist())
    back = distances([curve((c, b, a)) for a, b, c, _ in z.tolist()], points.tolist())
    assert np.abs(there - back).max() < 1e-14
    assert there.max() < 2 * size


@pytest.mark.parametrize("power", [-80, -20, 20, 80])
def test_units_do_not_matter(power: int) -> None:
    """A change of unit by a power of two changes no digit."""
    rng = np.random.default_rng(4)
    z = rng.uniform(-5, 5, (40, 4)) + 1j * rng.uniform(-5, 5, (40, 4))
    found = []
    for factor in (1.0, 2.0**power):
        rows = (z * factor).tolist()
        arcs: list[Arc] = [curve((a, b, c)) for a, b, c, _ in rows]
        arcs += [line(a, c) for a, _, c, _ in rows]
        found.append(distances(arcs, [row[3] for row in rows] * 2) / factor)
    assert (found[0] == found[1]).all()


def test_arcs_are_chosen_by_number() -> None:
    """In any order, more than once, lines among curves; and no points at all."""
    outline = Outline.from_rings([[line(0j, 10 + 0j), curve(BULGE), line(10 + 0j, 10 + 10j)]])
    arc, points = np.array([2, 0, 1, 0, 1]), np.array([12 + 5j, 5 + 1j, 0j, -3 + 4j, 7 + 1j])
    assert distance_to_arcs(outline, arc, points).tolist() == [2, 1, 0, 5, 0]
    assert distance_to_arcs(outline, arc[:0], points[:0]).shape == (0,)

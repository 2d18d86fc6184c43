"""Curves: their conversion to cubic Bezier pieces, and the bound of the flattening."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import UNITS, Placement
from voronoi_tiles.designs import strokes

Complexes = NDArray[np.complex128]

coordinates = st.floats(-100.0, 100.0, allow_subnormal=False)
complexes = st.builds(complex, coordinates, coordinates)
whole = st.builds(complex, st.integers(-5, 5), st.integers(-5, 5))


def bezier(piece: Complexes, t: NDArray[np.float64]) -> Complexes:
    """The Bernstein form of a cubic: another formula than the subdivision under test."""
    p0, p1, p2, p3 = piece
    s = 1.0 - t
    return np.asarray(s**3 * p0 + 3 * s * s * t * p1 + 3 * s * t * t * p2 + t**3 * p3)


def exact(piece: Complexes, t: Fraction) -> tuple[Fraction, Fraction]:
    """The point of a cubic in rational arithmetic."""
    s = 1 - t
    weights = (s**3, 3 * s * s * t, 3 * s * t * t, t**3)
    x = sum((w * Fraction(float(p.real)) for w, p in zip(weights, piece, strict=True)), Fraction(0))
    y = sum((w * Fraction(float(p.imag)) for w, p in zip(weights, piece, strict=True)), Fraction(0))
    return x, y


def distances(points: Complexes, line: Complexes) -> NDArray[np.float64]:
    """The distance of each point to a polyline, by brute force."""
    a, b = line[:-1], line[1:]
    w = b - a
    t = ((points[:, None] - a) * w.conjugate()).real / np.maximum(np.abs(w) ** 2, 1e-300)
    feet = a + np.clip(t, 0.0, 1.0) * w
    return np.asarray(np.abs(points[:, None] - feet).min(axis=1))


def chained(pieces: Complexes, accuracy: float) -> Complexes:
    """Flatten one connected chain to one polyline."""
    lines = strokes.polylines(pieces, accuracy)
    assert len(lines) == 1
    return lines[0]


@settings(deadline=None)
@given(st.lists(complexes, min_size=4, max_size=4, unique=True), st.sampled_from([10.0, 1.0, 0.1, 0.01]))
def test_flattening_keeps_its_bound(points: list[complex], accuracy: float) -> None:
    """Densely sampled, curve and polyline are within the accuracy of each other."""
    piece = np.array(points)
    line = chained(piece[None, :], accuracy)
    t = np.linspace(0.0, 1.0, 2001)
    curve = bezier(piece, t)
    assert distances(curve, line).max() <= accuracy + 1e-12
    samples = np.concatenate([np.linspace(a, b, 7) for a, b in pairwise(line)])
    # The sampled curve is itself a polyline: within an eighth of its second difference of the curve.
    slack = np.abs(np.diff(curve, 2)).max() / 4.0
    assert distances(samples, curve).max() <= accuracy + slack + 1e-12


@settings(deadline=None)
@given(st.lists(whole, min_size=4, max_size=4).filter(lambda p: len(set(p)) > 1), st.sampled_from([1.0, 0.01]))
def test_vertices_are_on_the_curve_exactly(points: list[complex], accuracy: float) -> None:
    """De Casteljau at 1/2 is exact for small whole points: each vertex is a rational value of the polynomial."""
    piece = np.array(points)
    chords, counts, _ = strokes.flatten(piece[None, :], accuracy)
    assert counts.tolist() == [len(chords)]
    assert chords[0, 0] == piece[0]
    assert chords[-1, 1] == piece[3]
    assert (chords[1:, 0] == chords[:-1, 1]).all()
    finest = 1 << 8
    values = {exact(piece, Fraction(k, finest)) for k in range(finest + 1)}
    assert {(Fraction(z.real), Fraction(z.imag)) for z in chords[:, 0].tolist()} <= values


def test_a_broken_flattening_is_noticed() -> None:
    """The oracle sees a polyline that misses its bound: every other vertex left out."""
    piece = np.array([0, 10j, 10 + 10j, 10 + 0j])
    line = chained(piece[None, :], 0.01)
    t = np.linspace(0.0, 1.0, 2001)
    assert distances(bezier(piece, t), line).max() <= 0.01
    assert distances(bezier(piece, t), line[::2]).max() > 0.01
    assert distances(bezier(piece, t), line[:-1]).max() > 0.01


@given(st.lists(complexes, min_size=4, max_size=4, unique=True), st.floats(0.01, 10.0))
def test_a_reversed_curve_gives_the_reversed_points(points: list[complex], accuracy: float) -> None:
    """Bit for bit: bisection at 1/2 rounds alike from both ends."""
    piece = np.array(points)
    forward = chained(piece[None, :], accuracy)
    backward = chained(piece[None, ::-1], accuracy)
    assert forward.tolist() == backward[::-1].tolist()


def test_many_pieces_at_once_give_what_each_gives_alone() -> None:
    """Flattening all pieces together changes no bit and no order."""
    rng = np.random.default_rng(3)
    pieces = rng.normal(size=(40, 4)) + 1j * rng.normal(size=(40, 4))
    chords, counts, _ = strokes.flatten(pieces, 1e-3)
    ends = np.cumsum(counts)
    for k, piece in enumerate(pieces):
        alone, _, _ = strokes.flatten(piece[None, :], 1e-3)
        assert chords[ends[k] - counts[k] : ends[k]].tolist() == alone.tolist()


def test_straight_pieces_stay_whole() -> None:
    """Lines are one chord, also where the curve runs unevenly along them."""
    even = strokes.path_pieces("M0 0L3 1L7 2", 1.0)
    assert chained(even, 1e-9).tolist() == [0, 3 + 1j, 7 + 2j]
    uneven = np.array([[0, 1, 2, 16]], dtype=complex)
    assert chained(uneven, 1e-9).tolist() == [0, 16]
    # There and back again is no straight piece, although all is on one line.
    turning = np.array([[0, 4, 4, 0]], dtype=complex)
    assert chained(turning, 1e-3).tolist() == [0, 3, 0]
    beyond = np.array([[0, -3, 1, 4]], dtype=complex)
    line = chained(beyond, 1e-6)
    assert line.real.min() == pytest.approx(bezier(beyond[0], np.linspace(0, 1, 100001)).real.min(), abs=1e-6)


def test_the_count_grows_with_the_square_root() -> None:
    """A hundred times finer takes ten times the segments: the subdivision adapts, and does not waste."""
    piece = np.array([[0, 10j, 10 + 10j, 10 + 0j]])
    coarse, fine = (len(chained(piece, accuracy)) - 1 for accuracy in (1e-3, 1e-5))
    assert 5 <= fine / coarse <= 20
    # A parabola of sagitta 7.5 needs at least sqrt(7.5 / accuracy) chords.
    assert fine <= 4 * (7.5 / 1e-5) ** 0.5


def test_impossible_accuracy_is_refused() -> None:
    """Too many segments are an error that names the tolerance, not a full memory."""
    with pytest.raises(DesignError, match="1,000,000 segments"):
        strokes.flatten(np.array([[0, 1e9j, 1e9 + 1e9j, 1e9]]), 1e-9)
    with pytest.raises(DesignError, match="1,000,000 segments"):
        strokes.circle_polyline(0j, 1e12, 1e-2)
    with pytest.raises(DesignError, match="1,000,000 segments"):
        strokes.circle_polyline(0j, 1e12, 1e-300)


# --- kinds ------------------------------------------------------------------------------------------------------


def test_bezier_chain() -> None:
    """3n + 1 points are n pieces that share their ends; other counts are refused."""
    points = np.arange(7) + 1j * np.array([0, 2, 2, 0, -2, -2, 0])
    pieces = strokes.bezier_pieces(points)
    assert pieces.shape == (2, 4)
    assert pieces[0, 3] == pieces[1, 0] == points[3]
    for count in (1, 2, 3, 5, 6):
        with pytest.raises(DesignError, match="4, 7, 10") as caught:
            strokes.bezier_pieces(points[:count])
        assert caught.value.key == "bezier"
    with pytest.raises(DesignError, match="zero length") as caught:
        strokes.bezier_pieces(np.array([0, 1, 1, 2, 2, 2, 2], dtype=complex))
    assert caught.value.key == "bezier[3]"


def test_hermite_has_its_tangents() -> None:
    """The derivative at each point is the tangent; a quarter of the difference bulges a single piece."""
    points, tangents = np.array([0, 4 + 0j, 5 + 5j]), np.array([3 + 6j, 3 - 6j, 1j])
    pieces = strokes.hermite_pieces(points, tangents)
    assert np.allclose(3 * (pieces[:, 1] - pieces[:, 0]), tangents[:-1])
    assert np.allclose(3 * (pieces[:, 3] - pieces[:, 2]), tangents[1:])
    # Closed form at the middle: (p0 + p1) / 2 + (m0 - m1) / 8.
    assert bezier(pieces[0], np.array([0.5]))[0] == pytest.approx(2 + 12j / 8)
    with pytest.raises(DesignError, match="3 points but 2 tangents"):
        strokes.hermite_pieces(points, tangents[:2])


def barry_goldman(p: Complexes, alpha: float, u: float) -> complex:
    """The pyramid of Barry and Goldman: the segment from p[1] to p[2] at the share u of its knots."""
    knots = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(p)) ** alpha)])
    t = knots[1] + u * (knots[2] - knots[1])

    def mix(a: complex, b: complex, i: int, j: int) -> complex:
        return complex(((knots[j] - t) * a + (t - knots[i]) * b) / (knots[j] - knots[i]))

    a = [mix(p[k], p[k + 1], k, k + 1) for k in range(3)]
    b = [mix(a[k], a[k + 1], k, k + 2) for k in range(2)]
    return mix(b[0], b[1], 1, 2)


@pytest.mark.parametrize("alpha", [0.0, 0.5, 1.0, 0.3])
@pytest.mark.parametrize("closed", [False, True])
def test_catmull_rom_is_barry_goldman(alpha: float, closed: bool) -> None:
    """The Bezier pieces are the pyramid's curve, interpolate the points, and are smooth."""
    points = np.array([0, 4 + 1j, 6 + 5j, 5 + 9j, -3 + 8j])
    pieces = strokes.catmull_rom_pieces(points, alpha, closed)
    assert pieces[:, 0].tolist() == points.tolist()[: len(pieces)]
    assert pieces[:, 3].tolist() == np.roll(points, -1).tolist()[: len(pieces)]
    if closed:
        ring = np.concatenate([points[-1:], points, points[:2]])
    else:
        ring = np.concatenate([[2 * points[0] - points[1]], points, [2 * points[-1] - points[-2]]])
    for k, piece in enumerate(pieces):
        for u in (0.0, 0.2, 0.5, 0.9, 1.0):
            value = bezier(piece, np.array([u]))[0]
            assert value == pytest.approx(barry_goldman(ring[k : k + 4], alpha, u), abs=1e-13)
    directions = [(pieces[k, 3] - pieces[k, 2], pieces[k + 1, 1] - pieces[k + 1, 0]) for k in range(len(pieces) - 1)]
    for before, after in directions:
        assert (before / after).imag == pytest.approx(0.0, abs=1e-14)


@given(st.lists(whole, min_size=2, max_size=7, unique=True), st.sampled_from([0.0, 0.5, 1.0]), st.booleans())
def test_catmull_rom_reversed(points: list[complex], alpha: float, closed: bool) -> None:
    """The reversed points give the reversed curve, bit for bit."""
    if closed and len(points) < 3:
        return
    forward = strokes.catmull_rom_pieces(np.array(points), alpha, closed)
    backward = strokes.catmull_rom_pieces(np.array(points[::-1]), alpha, closed)[::-1, ::-1]
    if closed:
        backward = np.roll(backward, -1, axis=0)
    assert forward.tolist() == backward.tolist()


def test_two_points_are_a_straight_line() -> None:
    """An open Catmull-Rom curve through two points is their segment."""
    assert chained(strokes.catmull_rom_pieces(np.array([1 + 1j, 4 + 2j])), 1e-9).tolist() == [1 + 1j, 4 + 2j]


def test_bspline_is_the_uniform_cubic() -> None:
    """Closed form of the basis, and two continuous derivatives, also across the joint of a closed one."""
    points = np.array([0, 4 + 1j, 6 + 5j, 8 + 2j, 3 - 4j])
    pieces = strokes.bspline_pieces(points)
    assert len(pieces) == 2
    t = np.linspace(0.0, 1.0, 11)
    basis = [(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]
    for k, piece in enumerate(pieces):
        wanted = sum(b * p for b, p in zip(basis, points[k : k + 4], strict=True)) / 6.0
        assert np.allclose(bezier(piece, t), wanted, atol=1e-14)
    ring = strokes.bspline_pieces(points, closed=True)
    assert len(ring) == 5
    for before, after in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        assert before[3] == after[0]
        assert before[3] - before[2] == pytest.approx(after[1] - after[0])
        assert before[3] - 2 * before[2] + before[1] == pytest.approx(after[2] - 2 * after[1] + after[0])
    for few, closed in ((points[:3], False), (points[:2], True)):
        with pytest.raises(DesignError, match="at least"):
            strokes.bspline_pieces(few, closed)


@given(st.floats(1e-3, 1e3), st.floats(1e-4, 1.0))
def test_circle_sides(radius: float, accuracy: float) -> None:
    """The smallest multiple of 12 whose sagitta is within the accuracy; vertices on the circle; closed."""
    polygon = strokes.circle_polyline(0j, radius, accuracy)
    sides = len(polygon) - 1
    assert sides % 12 == 0
    assert polygon[0] == polygon[-1] == radius
    assert np.abs(np.abs(polygon) - radius).max() <= 4e-16 * radius
    middles = (polygon[1:] + polygon[:-1]) / 2.0
    assert radius - np.abs(middles).min() <= accuracy + 1e-15 * radius
    if sides > 12:
        assert radius * (1.0 - np.cos(np.pi / (sides - 12))) > accuracy * (1.0 - 1e-9)


@pytest.mark.parametrize("accuracy", [1.0, 0.02, 0.01, 0.001])
def test_circle_is_symmetric(accuracy: float) -> None:
    """Multiples of 30 degrees and mirrors keep the vertices: quarter turns, axes and diagonals exactly."""
    polygon = strokes.circle_polyline(0j, 1.0, accuracy)[:-1]
    vertices = set(polygon.tolist())
    assert {complex(-z.imag, z.real) for z in vertices} == vertices
    assert {z.conjugate() for z in vertices} == vertices
    assert {complex(z.imag, z.real) for z in vertices} == vertices
    for unit in UNITS:
        turned = polygon * unit
        assert np.abs(turned[:, None] - polygon).min(axis=1).max() < 5e-16
    assert set(UNITS) <= vertices


def test_repeated_points_are_refused() -> None:
    """The key counts to the point that repeats."""
    with pytest.raises(DesignError) as caught:
        strokes.refuse_repeats(np.array([0, 1, 1, 2], dtype=complex), closed=False, key="polyline")
    assert caught.value.key == "polyline[2]"
    with pytest.raises(DesignError, match="first point"):
        strokes.refuse_repeats(np.array([0, 1, 2, 0], dtype=complex), closed=True, key="polyline")


def test_placement() -> None:
    """Scale, then rotation, then translation; quarter turns are exact."""
    z = np.array([1 + 2j, -3 + 0.1j])
    assert Placement()(z) is z
    assert Placement(2.0, 90.0, 10 + 1j)(z).tolist() == [10 - 4 + 1j + 2j, 10 - 0.2 + 1j - 6j]
    assert Placement(-1.0)(z).tolist() == (-z).tolist()
    turned = Placement(rotate=37.0)(z)
    assert np.abs(turned - z * np.exp(1j * np.radians(37.0))).max() < 1e-15

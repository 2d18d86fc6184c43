"""Areas, lengths, bounds and flattening of outlines, against high-precision quadrature and closed forms."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
import shapely
from helpers.outlines import ABOVE, RIGHT, polygon

from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.paths.quadratics import quadratic_lengths
from voronoi_tiles.vector.arcs import Arc, LineArc, ParabolaArc
from voronoi_tiles.vector.outline import Outline


def blob(seed: int, corners: int = 7, shift: complex = 0j, stretch: float = 1.0) -> Outline:
    """A star-shaped ring of lines and parabolas with random corners."""
    rng = np.random.default_rng(seed)
    turn = np.exp(2j * np.pi * (np.arange(corners) + rng.uniform(0, 0.5, corners)) / corners)
    points = rng.uniform(1, 2, corners) * turn
    points = points.real * stretch + 1j * points.imag + shift
    arcs: list[Arc] = []
    for k, (a, b) in enumerate(zip(points.tolist(), np.roll(points, -1).tolist(), strict=True)):
        control = (a + b) / 2 + complex(*rng.uniform(-0.3, 0.3, 2))
        arcs.append(ParabolaArc(a, control, b, 0j, (0j, 1j), RIGHT) if k % 3 else LineArc(a, b, ABOVE))
    return Outline.from_rings([arcs])


def reference_area(outline: Outline) -> mpmath.mpf:
    """The area by Green's theorem with 60 digits, from the arcs' parametrisation."""
    total = mpmath.mpf(0)
    for ring in outline.rings:
        for arc in ring:
            control = arc.control if isinstance(arc, ParabolaArc) else None
            a, c = mpmath.mpmathify(arc.start), mpmath.mpmathify(arc.end)
            b = (a + c) / 2 if control is None else mpmath.mpmathify(control)
            # x dy of a quadratic is a cubic in t: Simpson's rule is exact for it.
            values = [
                ((1 - t) ** 2 * a + 2 * t * (1 - t) * b + t * t * c).real * (2 * ((1 - t) * (b - a) + t * (c - b))).imag
                for t in (mpmath.mpf(0), mpmath.mpf("0.5"), mpmath.mpf(1))
            ]
            total += (values[0] + 4 * values[1] + values[2]) / 6
    return total


def reference_length(a: complex, b: complex, c: complex) -> mpmath.mpf:
    """The length of a quadratic Bezier curve by adaptive quadrature with 40 digits, cut where it turns."""
    p, q = mpmath.mpmathify(b) - a, mpmath.mpmathify(c) - b
    bend = q - p
    size = abs(bend) ** 2
    turn = -(p * mpmath.conj(bend)).real / size if size else mpmath.mpf(0)
    cuts = [mpmath.mpf(0), *([turn] if 0 < turn < 1 else []), mpmath.mpf(1)]
    return 2 * mpmath.quad(lambda t: abs(p + t * bend), cuts)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(("shift", "stretch"), [(0j, 1.0), (1e6 - 3e7j, 1.0), (5 + 1j, 1e5), (0j, 1e-7)])
def test_area_is_correct_to_the_last_places(seed: int, shift: complex, stretch: float) -> None:
    """Far from the origin and for thin tiles too, the area is that of the stored control points."""
    outline = blob(seed, shift=shift, stretch=stretch)
    with mpmath.workdps(60):
        exact = reference_area(outline)
        assert abs(outline.area - exact) <= abs(exact) * 4e-16


def test_closed_form_areas(square: Outline, ring: Outline, lens: Outline, mixed: Outline) -> None:
    """Shapes whose area is known: holes count negative, a parabola encloses two thirds of its triangle."""
    assert square.area == 100.0
    assert ring.area == 96.0
    assert ring.ring_areas == (100.0, -4.0)
    assert lens.area == pytest.approx(16 / 3, rel=4e-16)
    assert mixed.area == pytest.approx(100 + 2 / 3 * 10 * 2, rel=4e-16)


def test_an_error_in_one_control_point_shows_in_the_area() -> None:
    """The reference catches a wrong answer: a control point moved by 1e-12 changes the area beyond the bound."""
    outline = blob(1)
    moved = outline.control.copy()
    moved[1] += 1e-12
    broken = Outline(
        outline.start, moved, outline.end, outline.curved, outline.focus, outline.directrix,
        outline.neighbour, outline.neighbours, outline.ring_offsets,
    )  # fmt: skip
    with mpmath.workdps(60):
        exact = reference_area(outline)
        assert abs(broken.area - exact) > abs(exact) * 4e-16


@pytest.mark.parametrize(
    ("a", "b", "c"),
    [
        (0j, 1 + 2j, 3 + 0j),  # plain
        (0j, 5 + 1e-3j, 10 + 0j),  # nearly straight
        (0j, 5 + 1e-9j, 10 + 0j),
        (0j, 5 + 1e-15j, 10 + 0j),
        (0j, 1 + 1e-9j, 10 + 0j),  # nearly straight, uneven speed
        (0j, 1 + 0j, 10 + 0j),  # straight, uneven speed
        (0j, 5 + 0j, 10 + 0j),  # straight, even speed
        (0j, 10 + 1e-8j, 1 + 0j),  # a hairpin: runs out and comes back
        (0j, 10 + 0j, 1 + 0j),  # folded upon itself
        (0j, 1e9 + 1j, 1 + 1j),  # a needle
        (0j, 0j, 1 + 1j),  # no first leg
        (0j, 1 + 1j, 1 + 1j),  # no last leg
        (1e-9 + 1e-9j, 2e-9 + 3e-9j, 4e-9 + 1e-9j),  # tiny
        (1e9 + 0j, 2e9 + 3e9j, 4e9 + 1e9j),  # huge
        (0j, 3 + 4j, 6 + 7.99999999j),  # almost no bend
        (-1 + 1j, -1j, 1 + 1j),  # symmetric about its tip
    ],
)
def test_lengths_match_quadrature(a: complex, b: complex, c: complex) -> None:
    """Every kind of quadratic, in both directions, has its length to a few units in the last place."""
    with mpmath.workdps(40):
        exact = float(reference_length(a, b, c))
    got = quadratic_lengths(np.array([a, c]), np.array([b, b]), np.array([c, a]))
    assert got[0] == pytest.approx(exact, rel=4e-15)
    assert got[1] == pytest.approx(exact, rel=4e-15)


def test_random_lengths_match_quadrature() -> None:
    """Random quadratics over twelve orders of magnitude of bend."""
    rng = np.random.default_rng(7)
    ends = rng.normal(size=(2, 60)) + 1j * rng.normal(size=(2, 60))
    bend = (rng.normal(size=60) + 1j * rng.normal(size=60)) * 10.0 ** rng.uniform(-12, 2, 60)
    along = rng.uniform(-0.5, 1.5, 60)
    control = ends[0] + along * (ends[1] - ends[0]) + bend
    got = quadratic_lengths(ends[0], control, ends[1])
    with mpmath.workdps(40):
        for k in range(60):
            exact = float(reference_length(complex(ends[0, k]), complex(control[k]), complex(ends[1, k])))
            assert got[k] == pytest.approx(exact, rel=2e-14)


def test_a_point_has_no_length() -> None:
    """A curve whose three points coincide has length zero, not NaN."""
    assert quadratic_lengths(np.array([1 + 1j]), np.array([1 + 1j]), np.array([1 + 1j])).tolist() == [0.0]


def test_perimeter_and_curved_length(ring: Outline, mixed: Outline, lens: Outline) -> None:
    """Straight and curved parts add up to the perimeter; holes count."""
    assert ring.perimeter == 48.0
    assert ring.curved_length == 0.0
    assert mixed.perimeter == pytest.approx(30.0 + mixed.curved_length, rel=1e-15)
    arch = math.sqrt(2) + math.asinh(1)  # of y = x^2/4 from x = 0 to x = 2
    assert lens.curved_length == pytest.approx(4 * arch, rel=1e-15)


def test_bounds_reach_the_tips_of_the_parabolas(square: Outline, lens: Outline, mixed: Outline) -> None:
    """The box holds the curves, not only their end points, and not their control points."""
    assert square.bounds == (0.0, 0.0, 10.0, 10.0)
    assert lens.bounds == (-2.0, -1.0, 2.0, 1.0)
    assert mixed.bounds == (0.0, 0.0, 12.0, 10.0)
    with pytest.raises(ValueError, match="no bounds"):
        _ = Outline.from_rings([]).bounds


@pytest.mark.parametrize("accuracy", [1.0, 1e-2, 1e-5])
@pytest.mark.parametrize("seed", range(3))
def test_flattening_keeps_its_accuracy(seed: int, accuracy: float) -> None:
    """Every point of every parabola lies within the accuracy of the chords, and the bound is not wasted."""
    outline = blob(seed)
    corners = outline.flatten(accuracy=accuracy)[0]
    ring = shapely.LinearRing(np.column_stack((corners.real, corners.imag)))
    t = np.linspace(0, 1, 501)[:, None]
    curve = outline.start * (1 - t) ** 2 + 2 * outline.control * t * (1 - t) + outline.end * t**2
    curve = np.where(outline.curved, curve, outline.start)
    worst = shapely.distance(shapely.points(curve.real, curve.imag), ring).max()
    assert worst <= accuracy * (1 + 1e-9)
    assert worst > accuracy / 20 or len(corners) == len(outline)


def test_flattening_an_arc_and_its_reverse_gives_the_same_bits() -> None:
    """Neighbours that share an edge flatten it alike."""
    outline = blob(4)
    mirror = Isometry(1 + 0j, 0j, conj=True)
    there = outline.flatten(accuracy=1e-4)[0]
    back = outline.transformed(mirror).flatten(accuracy=1e-4)[0].conj()
    assert set(there.tolist()) == set(back.tolist())


@pytest.mark.parametrize("accuracy", [0.0, -1.0, math.nan, 1e-18])
def test_an_accuracy_that_cannot_be_met_is_refused(lens: Outline, accuracy: float) -> None:
    """Zero, negative, NaN and finer than the coordinates' resolution."""
    with pytest.raises(ValueError, match="accuracy"):
        lens.flatten(accuracy=accuracy)


def test_shapely_polygons(square: Outline, ring: Outline, lens: Outline) -> None:
    """One part is a Polygon with its holes, several are a MultiPolygon, none is an empty Polygon."""
    assert square.to_shapely(accuracy=0.1).equals(shapely.box(0, 0, 10, 10))
    assert ring.to_shapely(accuracy=0.1).area == 96.0
    assert lens.to_shapely(accuracy=1e-6).area == pytest.approx(lens.area, abs=1e-5)
    assert Outline.from_rings([]).to_shapely(accuracy=1.0).is_empty
    island = polygon(4.5 + 4.5j, 5.5 + 4.5j, 5.5 + 5.5j, 4.5 + 5.5j)
    outer, hole = ring.rings
    parts = Outline.from_rings([outer, island, hole]).to_shapely(accuracy=0.1)
    assert isinstance(parts, shapely.MultiPolygon)
    assert parts.is_valid
    assert parts.area == 97.0


def test_rings_are_the_arrays_as_objects(mixed: Outline) -> None:
    """Objects and arrays say the same, and making an outline of the objects gives the arrays back."""
    again = Outline.from_rings(mixed.rings)
    assert again.rings == mixed.rings
    for name in ("start", "control", "end", "curved", "focus", "directrix", "ring_offsets"):
        assert np.array_equal(getattr(again, name), getattr(mixed, name))
    assert [type(arc) for arc in mixed.rings[0]] == [ParabolaArc, LineArc, LineArc, LineArc]


@pytest.mark.parametrize("triplet", ["x+2,y-1", "-y,x-y", "-x,-y", "y,x", "-x+y,y+1"])
def test_transforming_keeps_area_orientation_and_closure(triplet: str, mixed: Outline, ring: Outline) -> None:
    """A mapped outline is closed bit for bit and runs the right way round, reflections too."""
    operation = Operation.parse(triplet)
    isometry = GROUPS["p6m"].lattice(7.0).isometry(operation)
    for outline in (mixed, ring):
        image = outline.transformed(isometry, operation)
        assert image.area == pytest.approx(outline.area, rel=1e-14)
        assert image.perimeter == pytest.approx(outline.perimeter, rel=1e-14)
        assert [area > 0 for area in image.ring_areas] == [area > 0 for area in outline.ring_areas]
        for arcs in image.rings:
            assert [arc.end for arc in arcs] == [arc.start for arc in (*arcs[1:], arcs[0])]
        assert image.neighbours[0].operation == operation @ outline.neighbours[0].operation
        assert outline.transformed(isometry).neighbours == outline.neighbours

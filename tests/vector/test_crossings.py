"""Outlines that cross themselves, beside brute force with exact numbers and beside shapely."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
import shapely
from helpers.outlines import RIGHT, polygon

from voronoi_tiles.vector import crossings
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.arcs import Arc, LineArc, ParabolaArc
from voronoi_tiles.vector.crossings import areas, candidate_pairs, count_crossings
from voronoi_tiles.vector.outline import Outline

SIZE = 100.0


@pytest.fixture(autouse=True, params=["compiled", "swept", "in groups"])
def _search(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Arcs are looked at as they are, compiled and by numpy, and as if many were above each other."""
    if request.param == "compiled":
        request.getfixturevalue("compiled")
    elif request.param == "swept":
        monkeypatch.setenv("VORONOI_TILES_KERNELS", "numpy")
    else:
        monkeypatch.setattr(crossings, "_FEW", -1)


def count(*rings: list[Arc], others: tuple[Outline, ...] = ()) -> int:
    """How often the outline of rings crosses itself; other outlines may be there as well."""
    return count_crossings(AllArcs.of([Outline.from_rings(rings), *others]), SIZE)


def curve(start: complex, control: complex, end: complex) -> ParabolaArc:
    """A curved arc; nothing here reads its focus and directrix."""
    return ParabolaArc(start, control, end, 0j, (0j, 1j), RIGHT)


def properly_crossing(corners: list[complex]) -> int:
    """The pairs of sides of a closed polygon that cross, by fractions."""

    def side(a: complex, b: complex, c: complex) -> int:
        (ax, ay), (bx, by), (cx, cy) = ((Fraction(z.real), Fraction(z.imag)) for z in (a, b, c))
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        return (area > 0) - (area < 0)

    sides = list(zip(corners, [*corners[1:], corners[0]], strict=True))
    return sum(
        side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0
        for (a, b), (c, d) in combinations(sides, 2)
    )


@pytest.mark.parametrize("number", [4, 7, 40])
def test_polygons_at_random(number: int) -> None:
    """Each crossing of two sides is counted once; on a grid many sides lie in line, or touch."""
    for seed in range(3):
        random = np.random.default_rng(seed)
        corners = (random.uniform(-9, 9, number) + 1j * random.uniform(-9, 9, number)).tolist()
        assert count(polygon(*corners)) == properly_crossing(corners)


@pytest.mark.parametrize("seed", range(8))
def test_stars_with_two_corners_exchanged(seed: int) -> None:
    """Outlines that run to and fro are as simple as shapely finds them, before and after."""
    random = np.random.default_rng(seed)
    corners = random.uniform(5, 9, 2000) * np.exp(2j * np.pi * np.arange(2000) / 2000)
    assert count(polygon(*corners.tolist())) == 0
    k = int(random.integers(2, 1900))
    corners[[k, k + 3]] = corners[[k + 3, k]]
    simple = shapely.LinearRing(np.stack((corners.real, corners.imag), axis=1)).is_simple
    assert not simple
    assert count(polygon(*corners.tolist())) == properly_crossing([0j, *corners[k - 2 : k + 6].tolist()])


@pytest.mark.parametrize("tip", [6 + 0j, 6 + 8j, 3 + 1j, 7 - 2j])
@pytest.mark.parametrize("share", [0.5, 1.0])
def test_a_spike_that_turns_back_upon_itself(tip: complex, share: float) -> None:
    """Neighbours that lie upon each other, whole or in part, in any direction; exact coordinates."""
    ring = polygon(0j, tip, tip * (1 - share), -5 + 9j)
    assert count(ring) >= 1
    assert count(polygon(0j, tip, tip * (1 - share) + 0.5j, -5 + 9j)) in {0, 1}
    assert count(polygon(-1 - 9j, tip, tip * 1.5 + 3j, -5 + 9j)) == 0


def test_a_spike_of_almost_no_width_is_none_that_turns_back() -> None:
    """A tile may have a corner as sharp as this."""
    assert count(polygon(0j, 10 + 0j, 1e-9j)) == 0
    assert count(polygon(0j, 10 + 0j, 0j, 5j)) == 2


def test_what_touches_does_not_cross() -> None:
    """A corner on a side, two corners at one place, and sides in line one after the other."""
    assert count(polygon(0j, 10 + 0j, 10 + 10j, 5 + 0j, 10j)) == 0
    assert count(polygon(0j, 4 + 4j, 8 + 0j, 8 + 8j, 4 + 4j, 8j)) == 0
    assert count(polygon(0j, 5 + 0j, 10 + 0j, 10 + 10j, 5 + 10j, 10j)) == 0


def test_sides_that_lie_upon_each_other_cross() -> None:
    """A corridor without width, of equal and of overlapping sides."""
    assert (
        count(polygon(0j, 10 + 0j, 10 + 5j, 20 + 5j, 20 + 0j, 30 + 0j, 30 + 9j, 20 + 9j, 20 + 5j, 10 + 5j, 0 + 9j)) > 0
    )
    assert count(polygon(0j, 10 + 0j, 10 + 5j, 20 + 5j, 20 + 0j, 30 + 0j, 30 + 9j, 18 + 5j, 12 + 5j, 0 + 9j)) > 0


@pytest.mark.parametrize(("by", "found"), [(1e-13, 0), (1e-9, 2), (0.1, 2)])
def test_crossings_at_the_ends_are_rounding(by: float, found: int) -> None:
    """A corner that comes through a side by less than the limit has not crossed it."""
    assert count(polygon(0j, 10 + 0j, 10 + 10j, 5 - by * 1j, 10j)) == found


def test_rings_of_one_outline_cross_and_those_of_two_do_not() -> None:
    """A hole that leaves its outer ring; a neighbour's outline lies where it likes."""
    square = polygon(0j, 10 + 0j, 10 + 10j, 10j)
    hole = polygon(5 + 5j, 5 + 8j, 12 + 8j, 12 + 5j)
    assert count(square, hole) == 2
    assert count(square, others=(Outline.from_rings([hole]), Outline.from_rings([square]))) == 0
    crossing = Outline.from_rings([polygon(0j, 10 + 0j, 0 + 10j, 10 + 10j)])
    assert count(square, others=tuple([Outline.from_rings([square])] * 20 + [crossing])) == 1


def test_curves_whose_chords_cross() -> None:
    """Two curves one above the other, whose chords cross, do not; bent the other way they do."""
    low: list[Arc] = [curve(0j, 5 + 1j, 10 + 0j)]
    assert count([*low, LineArc(10 + 0j, 10 - 3j, RIGHT), LineArc(10 - 3j, 0j, RIGHT)]) == 0
    assert count([*low, *polygon(10 + 0j, 5 + 9j, 0j)[:2]]) == 0
    # A tooth between the chord, at 0, and the curve, which is at 1/2 in the middle.
    tooth = [LineArc(a, b, RIGHT) for a, b in ((10 + 0j, 9 - 4j), (9 - 4j, 5 + 0.3j), (5 + 0.3j, 1 - 4j), (1 - 4j, 0j))]
    assert count([*low, *tooth]) == 0
    tooth[1:3] = [LineArc(9 - 4j, 5 + 0.7j, RIGHT), LineArc(5 + 0.7j, 1 - 4j, RIGHT)]
    assert count([*low, *tooth]) == 2


def test_curves_that_cross_twice_and_a_fold() -> None:
    """Parabolas that meet in two points of their insides are one pair of arcs; a curve that runs back upon itself."""
    ring: list[Arc] = [curve(0j, 5 + 6j, 10 + 0j), LineArc(10 + 0j, 10 + 2j, RIGHT), curve(10 + 2j, 5 - 4j, 2j)]
    assert count([*ring, LineArc(2j, 0j, RIGHT)]) == 1
    assert count([*ring[:2], curve(10 + 2j, 5 + 4j, 2j), LineArc(2j, 0j, RIGHT)]) == 0
    assert count([curve(0j, 12 + 0j, 6 + 0j), LineArc(6 + 0j, 3 + 5j, RIGHT), LineArc(3 + 5j, 0j, RIGHT)]) == 1


@pytest.mark.parametrize("lean", [0, 7 + 0j, 300 - 20j])
def test_long_teeth_side_by_side_are_few_pairs(lean: complex) -> None:
    """Of 500 teeth all boxes with upright sides overlap where they lean; only neighbours are looked at more closely."""
    teeth = [k + (300j + lean) * (k % 2) for k in range(1001)]
    arcs = AllArcs.of([Outline.from_rings([polygon(*teeth, 3000 + 0j, 3000 + 900j, -900 + 900j)])])
    i, j = candidate_pairs(arcs)
    assert len(i) < 4 * len(arcs)
    assert (i < j).all()
    assert count_crossings(arcs, SIZE) == 0


@pytest.mark.parametrize("seed", range(3))
def test_signs_of_areas_are_exact(seed: int) -> None:
    """Of triangles that are all but flat, as near to flat as floating point comes; those of fractions."""
    random = np.random.default_rng(seed)
    a, b = random.uniform(-1, 1, (2, 200)) + 1j * random.uniform(-1, 1, (2, 200))
    share = random.integers(0, 9, 200) / 8
    c = a + share * (b - a)
    c.real += random.integers(-1, 2, 200) * 2.0**-54
    got = np.sign(areas(a, b, c))
    for k in range(200):
        (ax, ay), (bx, by), (cx, cy) = ((Fraction(z[k].real), Fraction(z[k].imag)) for z in (a, b, c))
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        assert got[k] == (area > 0) - (area < 0)
    assert (got == 0).any()
    assert (got != 0).any()


@pytest.mark.parametrize("number", [3, 20, 100])
@pytest.mark.usefixtures("compiled")
def test_kernel_finds_the_pairs_of_numpy(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """In their order, of several outlines, on a grid as well, where boxes have sides in common or no width."""
    random = np.random.default_rng(number)
    for digits in (0, 9):
        walks = np.cumsum(random.uniform(-9, 9, (4, number)) + 1j * random.uniform(-3, 3, (4, number)), axis=1)
        arcs = AllArcs.of([Outline.from_rings([polygon(*walk)]) for walk in np.round(walks, digits)])
        found = []
        for chosen in ("", "numpy"):
            monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
            found.append([(array.dtype, array.tolist()) for array in candidate_pairs(arcs)])
        assert found[0] == found[1]
        assert len(found[0][0][1])

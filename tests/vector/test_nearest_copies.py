"""The search of all copies: it finds what brute force finds, on all groups, cells and sites, and nothing less."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup
from voronoi_tiles.vector.box_tree import BoxTree
from voronoi_tiles.vector.nearest_copies import NearestCopies, cell_reach, distances, inverses, nearest_copies

Complexes = NDArray[np.complex128]

SLACK = 1e-9


def lattice_of(group: WallpaperGroup, shape: str) -> Lattice:
    """A cell of a group: ordinary, or as thin or skew as the group allows."""
    match shape:
        case "thin":
            return group.lattice(30.0, 1.0, 83.0)
        case "skew":
            return group.lattice(9.0, 31.0, 3.0)
        case _:
            return group.lattice(8.0, 7.0, 77.0)


def elements_of(kind: str, lattice: Lattice, number: int, random: np.random.Generator) -> tuple[Complexes, Complexes]:
    """The ends of elements somewhere in a few cells: points, short and long ones, a chain, or a fan."""
    x, y = random.uniform(-1.5, 1.5, (2, number))
    start = x * lattice.a + y * lattice.b
    size = abs(lattice.reduced_basis[0])
    turn = np.exp(2j * np.pi * random.random(number))
    match kind:
        case "points":
            return start, start.copy()
        case "short":
            return start, start + turn * size * random.uniform(0.0, 0.1, number)
        case "long":
            return start, start + turn * size * random.uniform(0.0, 4.0, number)
        case "chain":
            nodes = start[0] + np.cumsum(turn) * size / number
            return nodes[:-1], nodes[1:]
        case _:
            return np.full(number, start[0]), start[0] + turn * size * 0.4


def brute_force(
    group: WallpaperGroup, lattice: Lattice, start: Complexes, end: Complexes, points: Complexes
) -> NDArray[np.float64]:
    """The distance of each point (rows) from the nearest image of each element (columns).

    Of all translations that come as near to an element as the nearest lattice vector of a point is, at most.
    """
    reach = float(np.abs(np.concatenate((start, end))).max() + np.abs(points).max())
    reach += abs(lattice.a) + abs(lattice.b) + abs(lattice.reduced_basis[1])
    p, q = lattice.reduced_basis
    m, n = (int(np.ceil(reach * abs(v) / lattice.reduced.det)) for v in (q, p))
    i, j = np.indices((2 * m + 1, 2 * n + 1)).reshape(2, -1) - np.array([[m], [n]])
    vectors = i * p + j * q
    vectors = vectors[np.abs(vectors) <= reach]
    least = np.full((len(points), len(start)), np.inf)
    for operation in group.operations:
        isometry = lattice.isometry(operation)
        one, two = isometry(start), isometry(end)
        for vector in vectors.tolist():
            np.minimum(least, distances(points[:, None] - vector, one, two - one), out=least)
    return least


def search(
    group: WallpaperGroup, lattice: Lattice, start: Complexes, end: Complexes, points: Complexes
) -> NearestCopies:
    """What the proof's search finds."""
    motions = inverses([lattice.isometry(operation) for operation in group.operations])
    return nearest_copies(lattice, motions, BoxTree.of(lattice, start, end), points, SLACK)


def check(found: NearestCopies, wanted: NDArray[np.float64], tolerance: float) -> None:
    """The distances are right, and the pairs are those that they should be."""
    nearest = wanted.min(axis=1)
    assert np.abs(found.distance - nearest).max() <= tolerance
    pairs = np.zeros(wanted.shape, bool)
    pairs[found.point, found.element] = True
    assert pairs[wanted <= nearest[:, None] + SLACK - 2 * tolerance].all()
    assert not pairs[wanted > nearest[:, None] + SLACK + 2 * tolerance].any()


@pytest.mark.parametrize("name", list(GROUPS))
@pytest.mark.parametrize("kind", ["points", "long", "chain"])
def test_all_groups(name: str, kind: str) -> None:
    """Of every element the nearest copy, for points in several cells."""
    random = np.random.default_rng(len(name) + len(kind))
    lattice = lattice_of(GROUPS[name], "ordinary")
    start, end = elements_of(kind, lattice, 9, random)
    x, y = random.uniform(-2.0, 2.0, (2, 20))
    points = x * lattice.a + y * lattice.b
    found = search(GROUPS[name], lattice, start, end, points)
    check(found, brute_force(GROUPS[name], lattice, start, end, points), 1e-13)


@pytest.mark.parametrize("name", ["p1", "cmm"])
@pytest.mark.parametrize("shape", ["thin", "skew"])
@pytest.mark.parametrize("kind", ["points", "long", "fan"])
def test_thin_and_skew_cells(name: str, shape: str, kind: str) -> None:
    """Where a cell is thin its nearest copies are many translations away from where one would look first."""
    random = np.random.default_rng(3)
    lattice = lattice_of(GROUPS[name], shape)
    start, end = elements_of(kind, lattice, 5, random)
    x, y = random.uniform(-1.0, 1.0, (2, 12))
    points = x * lattice.a + y * lattice.b
    found = search(GROUPS[name], lattice, start, end, points)
    check(found, brute_force(GROUPS[name], lattice, start, end, points), 2e-13)


@pytest.mark.parametrize("kind", ["points", "chain", "fan"])
def test_many_points_and_elements(kind: str) -> None:
    """Deep trees, large bundles and more than one portion; shapely finds the same."""
    random = np.random.default_rng(11)
    lattice = Lattice(20 + 0j, 6 + 17j)
    start, end = elements_of(kind, lattice, 700, random)
    # In an order as edges have it, with jumps.
    steps: Complexes = 0.05 * np.exp(2j * np.pi * random.random(16_500))
    steps[::2050] += 40
    walk: Complexes = steps.cumsum()
    points = walk[: len(walk) - 3]
    found = search(GROUPS["p1"], lattice, start, end, points)
    x, y = lattice.fractional(points)
    inner = points - np.floor(x) * lattice.a - np.floor(y) * lattice.b
    x, y = lattice.fractional((start + end) / 2)
    moved = np.floor(x) * lattice.a + np.floor(y) * lattice.b
    copies = [
        (np.stack((start, end)) - moved + m * lattice.a + n * lattice.b) for m in range(-4, 5) for n in range(-4, 5)
    ]
    ends = np.concatenate(copies, axis=1).T
    tree = shapely.STRtree(shapely.linestrings(np.stack((ends.real, ends.imag), axis=-1)))
    _, distance = tree.query_nearest(shapely.points(inner.real, inner.imag), return_distance=True, all_matches=False)
    assert np.abs(found.distance - distance).max() < 1e-12
    assert (np.bincount(found.point, minlength=len(points)) > 0).all()
    # The points are far apart where the walk jumps: bundles across a jump hold what both sides need.
    assert np.abs(np.diff(points)).max() > 30


@pytest.mark.parametrize("offset", [0.0, 1e-10, 5e-10, 2e-9, 1e-3])
def test_all_that_are_within_the_slack_are_found(offset: float) -> None:
    """A ring of elements about a point, of which one is a hair farther than the nearest."""
    lattice = Lattice(10 + 0j, 10j)
    directions = np.exp(2j * np.pi * np.arange(100) / 100)
    radius = np.full(100, 3.0)
    radius[37] += offset
    start = 1 + 1j + radius * directions
    found = search(GROUPS["p1"], lattice, start, start + directions, np.array([1 + 1j, 1 + 1.5j]))
    element = found.element[found.point == 0]
    assert (37 in element.tolist()) == (offset <= SLACK)
    assert len(set(element.tolist())) == 99 + (offset <= SLACK)


def test_a_copy_far_away_that_is_a_hair_too_near() -> None:
    """One more element, nearer by 1e-9 to one point alone: only there the distance changes."""
    random = np.random.default_rng(5)
    group, lattice = GROUPS["p6"], GROUPS["p6"].lattice(10.0)
    start, end = elements_of("chain", lattice, 80, random)
    points = elements_of("points", lattice, 60, random)[0]
    before = search(group, lattice, start, end, points)
    k = int(before.distance.argmax())
    # At the other side of a copy that lies five cells away.
    spike = lattice.isometry(group.operations[4])(points[k] + (before.distance[k] - 1e-9) * 1j) + 5 * lattice.a
    after = search(group, lattice, np.append(start, spike), np.append(end, spike), points)
    assert before.distance[k] - after.distance[k] == pytest.approx(1e-9, rel=1e-3)
    assert set(after.element[after.point == k].tolist()) >= {79}


@pytest.mark.parametrize("length", [0.4, 1.2, 7.0, 60.0])
def test_an_element_longer_than_the_cell(length: float) -> None:
    """It runs through many cells; every part of it is found."""
    lattice = Lattice(3 + 0j, 1 + 2j)
    start = np.array([0.3 + 0.2j])
    end = start + length * np.exp(0.3j)
    points = elements_of("points", lattice, 40, np.random.default_rng(1))[0]
    found = search(GROUPS["p2"], lattice, start, end, points)
    check(found, brute_force(GROUPS["p2"], lattice, start, end, points), 1e-13)


def test_how_far_the_voronoi_cell_reaches() -> None:
    """No vector to a point from its nearest lattice point reaches farther, and some all but as far."""
    random = np.random.default_rng(9)
    block = np.indices((5, 5)).reshape(2, -1) - 2
    for _ in range(60):
        b = complex(random.uniform(-9, 9), random.uniform(0.05, 9))
        lattice = Lattice(complex(random.uniform(0.1, 9.0)), b)
        p, q = lattice.reduced_basis
        x, y = random.random((2, 4000))
        away = (x * p + y * q)[:, None] - (block[0] * p + block[1] * q)
        nearest = away[np.arange(len(away)), np.abs(away).argmin(axis=1)]
        for share, reach in zip(lattice.reduced.fractional(nearest), cell_reach(lattice), strict=True):
            assert 0.9 * reach < np.abs(share).max() <= reach + 1e-9

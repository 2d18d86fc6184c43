"""Trails and tours: every strand once, in the fewest trails, with short ways between them."""

from __future__ import annotations

import itertools
from itertools import pairwise

import numpy as np
import pytest
from helpers.sheets import Sheet, check_joints, circle, period
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.fabrication import tour
from voronoi_tiles.fabrication.clipping import Strands
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.tour import short_tour
from voronoi_tiles.fabrication.trails import Trails, find_trails, joined, travel
from voronoi_tiles.paths.paths import Paths

SETTINGS = settings(max_examples=150, deadline=None, derandomize=True)


def fewest(first: Ints, last: Ints) -> int:
    """How many trails are needed: half of the odd vertices of each connected part, at least one (union and find)."""
    parent = list(range(int(max(first.max(), last.max())) + 1)) if len(first) else []

    def root(k: int) -> int:
        while parent[k] != k:
            k = parent[k]
        return k

    for a, b in zip(first.tolist(), last.tolist(), strict=True):
        parent[root(a)] = root(b)
    odd = np.bincount(np.concatenate((first, last)), minlength=len(parent)) % 2
    parts = {root(a) for a in first.tolist()}
    return sum(max(1, sum(int(odd[k]) for k in range(len(parent)) if root(k) == part) // 2) for part in parts)


def check_trails(trails: Trails, first: Ints, last: Ints) -> None:
    """Every strand is there once, each starts where the one before ends, and there are no more trails than needed."""
    assert sorted(trails.strand.tolist()) == list(range(len(first))), "every strand once"
    start = np.where(trails.forward, first[trails.strand], last[trails.strand])
    end = np.where(trails.forward, last[trails.strand], first[trails.strand])
    assert (np.diff(trails.offsets) > 0).all()
    for a, b in pairwise(trails.offsets.tolist()):
        assert (start[a + 1 : b] == end[a : b - 1]).all(), "a trail is connected"
    assert len(trails.offsets) - 1 == fewest(first, last), "the fewest trails"


@st.composite
def graphs(draw: st.DrawFn) -> tuple[Ints, Ints, Complexes]:
    """Graphs with loops, parallel strands, several parts, vertices in one place and vertices without strands."""
    count = draw(st.integers(1, 12))
    strands = draw(st.lists(st.tuples(st.integers(0, count - 1), st.integers(0, count - 1)), max_size=30))
    places = draw(st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=count, max_size=count))
    ends = np.array(strands, np.intp).reshape(-1, 2)
    return ends[:, 0], ends[:, 1], np.array([complex(x, y) for x, y in places])


@SETTINGS
@given(graphs())
def test_trails_take_every_strand_once_and_are_the_fewest(graph: tuple[Ints, Ints, Complexes]) -> None:
    """On any graph."""
    first, last, place = graph
    check_trails(find_trails(first, last, place), first, last)


@pytest.fixture(scope="module")
def strands() -> Strands:
    """The lines of a sheet of some twenty tiles."""
    here = period("p6-propeller")
    rings = [circle(3j, 110), circle(20 + 10j, 30, hole=True), circle(-60 + 1j, 0.5, hole=True)]
    return Sheet(here, Region(Paths.concatenate(rings))).strands


def test_the_trails_of_a_sheet(strands: Strands) -> None:
    """Joined to paths, piece after piece with the same bits; all lines are there, closed trails are closed paths."""
    trails = find_trails(strands.first, strands.last, strands.node)
    check_trails(trails, strands.first, strands.last)
    paths = joined(strands.paths, trails)
    check_joints(paths)
    assert len(paths) == len(trails.offsets) - 1
    assert paths.lengths.sum() == pytest.approx(strands.paths.lengths.sum(), rel=1e-13)
    ends = paths.start[paths.offsets[:-1]] == paths.end[paths.offsets[1:] - 1]
    assert paths.closed.tolist() == ends.tolist()


def test_ways_between_trails_are_short(strands: Strands) -> None:
    """Shorter than where strands are cut as they come, and than where trails come in a random order."""
    paths = joined(strands.paths, find_trails(strands.first, strands.last, strands.node))
    assert travel(paths) < travel(strands.paths) / 3
    rng = np.random.default_rng(2)
    for _ in range(5):
        assert travel(paths) < travel(paths.take(rng.permutation(len(paths))))


def test_travel_is_the_way_from_end_to_start() -> None:
    """In a straight line; one path needs none."""
    paths = Paths.polylines([[0j, 1 + 0j], [1 + 3j, 2 + 3j, 5 + 3j], [5 + 4j, 9j]])
    assert travel(paths) == 4.0
    assert travel(paths.take(np.array([1]))) == 0.0
    assert travel(Paths.empty()) == 0.0


def test_many_loose_ends_in_one_place() -> None:
    """More than are looked at in one round."""
    count = 60
    first, last = np.arange(count), np.arange(count, 2 * count)
    place = np.concatenate((np.zeros(count), np.arange(count))).astype(np.complex128)
    check_trails(find_trails(first, last, place), first, last)


def test_no_strand_has_no_trail() -> None:
    """Nothing in, nothing out."""
    none = np.zeros(0, np.intp)
    trails = find_trails(none, none, np.zeros(0, np.complex128))
    assert not len(joined(Paths.empty(), trails))


def test_the_oracle_of_trails_sees_what_is_wrong() -> None:
    """A strand twice, a trail that jumps, and one cut in two."""
    first, last = np.array([0, 1, 2]), np.array([1, 2, 3])
    forward, offsets = np.ones(3, np.bool_), np.array([0, 3])
    good = Trails(np.arange(3), forward, offsets)
    check_trails(good, first, last)
    for strand, ends, message in (
        ([0, 1, 1], [0, 3], "every strand once"),
        ([0, 2, 1], [0, 3], "connected"),
        ([0, 1, 2], [0, 1, 3], "fewest"),
    ):
        with pytest.raises(AssertionError, match=message):
            check_trails(Trails(np.array(strand), forward, np.array(ends)), first, last)


# --- tours -----------------------------------------------------------------------------------------------------------


def nearest_first(start: Complexes, end: Complexes) -> tuple[list[int], list[bool]]:
    """The stated rule word for word: from the lower left corner, always to the nearest end that is left."""
    ends = np.concatenate((start, end))
    corner = ends.real - ends.real.min() + ends.imag - ends.imag.min()
    choice = int(corner.argmin())
    order, turned, left = [], [], set(range(len(start)))
    while True:
        stroke, back = choice % len(start), choice >= len(start)
        order.append(stroke)
        turned.append(back)
        left.remove(stroke)
        if not left:
            return order, turned
        here = start[stroke] if back else end[stroke]
        choice = min((k for s in left for k in (s, s + len(start))), key=lambda k: abs(ends[k] - here))


def way(start: Complexes, end: Complexes, order: Ints, turned: list[bool]) -> float:
    """The length of the ways between strokes."""
    back = np.asarray(turned)
    first, last = np.where(back, end[order], start[order]), np.where(back, start[order], end[order])
    return float(np.abs(first[1:] - last[:-1]).sum())


@pytest.mark.parametrize("count", [1, 2, 3, 17, 200])
def test_a_tour_begins_as_one_that_goes_to_the_nearest_end(count: int) -> None:
    """As a plain search over all ends does; strokes that are long and short, open and closed."""
    rng = np.random.default_rng(count)
    for spread in (0.01, 0.1, 1.0):
        start: Complexes = rng.uniform(0, 1, count) + 1j * rng.uniform(0, 1, count)
        end: Complexes = start + spread * (rng.standard_normal(count) + 1j * rng.standard_normal(count))
        end = np.where(rng.uniform(0, 1, count) < 0.3, start, end)
        order, turned = tour.nearest_first(start, end)
        wanted, _ = nearest_first(start, end)
        assert order.tolist() == wanted
        assert not turned[start[order] == end[order]].any()
        if count > 10:
            assert way(start, end, order, turned.tolist()) < way(start, end, np.arange(count), [False] * count)


@SETTINGS
@given(st.lists(st.tuples(*[st.integers(0, 3)] * 4), max_size=40))
def test_a_tour_takes_every_stroke_once(strokes: list[tuple[int, int, int, int]]) -> None:
    """On a small grid, where many ends coincide; to each next one by a nearest end."""
    start = np.array([complex(a, b) for a, b, _, _ in strokes])
    end = np.array([complex(c, d) for _, _, c, d in strokes])
    order, turned = tour.nearest_first(start.astype(np.complex128), end.astype(np.complex128))
    assert sorted(order.tolist()) == list(range(len(strokes)))
    first, last = np.where(turned, end[order], start[order]), np.where(turned, start[order], end[order])
    for k in range(len(strokes) - 1):
        rest = np.concatenate((start[order[k + 1 :]], end[order[k + 1 :]]))
        assert abs(first[k + 1] - last[k]) <= np.abs(rest - last[k]).min() + 1e-12


@SETTINGS
@given(st.lists(st.tuples(*[st.integers(0, 5)] * 4), max_size=40))
def test_a_tour_is_never_longer_than_by_nearest_ends(strokes: list[tuple[int, int, int, int]]) -> None:
    """Every stroke once, closed ones forwards, and no way longer than without the reversals."""
    start = np.array([complex(a, b) for a, b, _, _ in strokes], np.complex128)
    end = np.array([complex(c, d) for _, _, c, d in strokes], np.complex128)
    order, turned = short_tour(start, end)
    assert sorted(order.tolist()) == list(range(len(strokes)))
    assert not turned[start[order] == end[order]].any()
    first, back = tour.nearest_first(start, end)
    assert way(start, end, order, turned.tolist()) <= way(start, end, first, back.tolist()) + 1e-9


@pytest.mark.parametrize("seed", range(6))
def test_a_tour_is_nearly_the_shortest(seed: int) -> None:
    """Seven closed strokes in all orders that begin alike: the tour is within a fifth of the shortest of them."""
    place = np.random.default_rng(seed).uniform(0, 1, 14).view(np.complex128)
    order, _ = short_tour(place, place)
    forwards = [False] * len(place)
    rest = order[1:].tolist()
    least = min(way(place, place, np.array([order[0], *turn]), forwards) for turn in itertools.permutations(rest))
    assert way(place, place, order, forwards) <= 1.2 * least


def test_reversals_shorten_a_large_tour() -> None:
    """Among a thousand random places the tour is within 15 percent of what the shortest one is expected to be."""
    place = np.random.default_rng(5).uniform(0, 1, 2000).view(np.complex128)
    order, _ = short_tour(place, place)
    expected = 0.7124 * np.sqrt(len(place))  # Beardwood, Halton, Hammersley 1959; Johnson, McGeoch 1996
    assert way(place, place, order, [False] * len(place)) < 1.15 * expected

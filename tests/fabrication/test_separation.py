"""Pieces laid and moved apart: nothing overlaps, nothing leaves, all is found again, by numpy as by the kernels."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.fabrication import nest_growth, nest_patterns
from voronoi_tiles.fabrication.nest_growth import Growth, most_found, most_laid
from voronoi_tiles.fabrication.nest_patterns import pattern_layouts
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces
from voronoi_tiles.fabrication.no_fit import NoFits, no_fit

HOOK = np.array([0, 20, 20 + 4j, 5 + 4j, 5 + 12j, 12j]) - (8 + 5j)
ITEMS = [NestItem(HOOK, 0.5, None), NestItem(HOOK.conj(), 0.5, None, 0, 1 + 0j, True)]
"""A hook and its mirror image, half of all pieces each."""

ROOM = (90.0, 60.0)


@pytest.fixture(autouse=True)
def _nothing_is_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each test search by itself."""
    monkeypatch.setattr(nest_growth, "_REMEMBERED", {})


def polygon(ring: Complexes) -> shapely.Polygon:
    """A ring as shapely has it."""
    return shapely.Polygon(np.column_stack((ring.real, ring.imag)))


def shapes(items: list[NestItem], places: NestPlaces) -> np.ndarray:
    """The pieces where they lie."""
    return np.array([polygon(items[k].ring * unit_at(turn) + shift) for k, turn, shift in places.rows()])


def check(items: list[NestItem], places: NestPlaces) -> None:
    """By shapely no piece overlaps another, or leaves the sheet."""
    pieces = shapes(items, places)
    one, two = np.triu_indices(len(pieces), 1)
    # GEOS 3.14 may take the intersection of two that touch along a side for one of them.
    smaller = shapely.buffer(pieces, -1e-4)
    assert not shapely.intersects(smaller[one], smaller[two]).any()
    assert shapely.total_bounds(pieces).min() > -1e-6
    assert (shapely.total_bounds(pieces)[2:] < np.array(ROOM) + 1e-6).all()


@pytest.mark.parametrize("turn", [0.0, 90.0, 180.0, 37.5])
def test_a_no_fit_polygon_is_where_pieces_overlap(turn: float) -> None:
    """Places drawn at random overlap by shapely if they lie in it, also where all sides are parallel to others."""
    region, stays, other = no_fit(HOOK, HOOK * unit_at(turn)), polygon(HOOK), polygon(HOOK * unit_at(turn))
    shapely.prepare(region)
    assert region.is_valid
    assert region.exterior.is_ccw
    for x, y in np.random.default_rng(3).uniform(-40, 40, (300, 2)).tolist():
        overlap = stays.intersection(shapely.affinity.translate(other, x, y)).area
        assert shapely.contains_xy(region, x, y) == (overlap > 0), (x, y)


def test_a_known_no_fit_polygon_is_turned_and_reversed() -> None:
    """What two pieces have to each other is asked for once, and holds wherever both are turned."""
    other = np.array([0, 8, 3 + 6j]) - (4 + 2j)
    known = NoFits([HOOK, other])
    for turn, other_turn, stays, moves in ((20.0, 75.0, 0, 1), (75.0, 20.0, 1, 0), (110.0, 165.0, 0, 1)):
        rings = [HOOK, other]
        edges = known.edges(stays, turn, moves, other_turn)
        ring = edges[:, 0] + 1j * edges[:, 1]
        direct = no_fit(rings[stays] * unit_at(turn), rings[moves] * unit_at(other_turn))
        assert polygon(ring).symmetric_difference(direct).area < 1e-4


def test_more_pieces_grow_than_are_laid_and_none_overlaps() -> None:
    """What is put in finds its place, half of it mirrored; the same search gives the same places again."""
    two = NestPlaces(np.array([0, 1]), np.zeros(2), np.array([20 + 20j, 60 + 40j]))
    found = []
    for _ in range(2):
        growth = Growth(ITEMS, ROOM, two, NoFits([item.ring for item in ITEMS]))
        growth.grow(1, 4000)
        found.append(growth.places)
    check(ITEMS, found[0])
    counts = np.bincount(found[0].item)
    assert counts.sum() >= 20
    assert abs(int(counts[0]) - int(counts[1])) <= 1
    assert all(np.array_equal(one, other) for one, other in zip(*found, strict=True))


def test_patterns_and_what_grows_of_them_overlap_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of no fewer pieces than the patterns have."""
    monkeypatch.setattr(nest_growth, "_ROUNDS", ((3, 1000),))
    start = pattern_layouts(ITEMS, ROOM, NoFits([item.ring for item in ITEMS]), 1)[0]
    found = most_laid(ITEMS, ROOM)
    check(ITEMS, start)
    check(ITEMS, found)
    assert len(found.item) >= len(start.item) >= 28


def test_what_was_laid_is_remembered_until_something_differs(monkeypatch: pytest.MonkeyPatch) -> None:
    """The second time nothing is searched for; on another sheet, in other turns, or of another ring it is."""
    searched: list[tuple[float, float]] = []

    def grown(*asked: Any) -> list[Growth]:
        """Find nothing, and say so."""
        searched.append(asked[1])
        return []

    monkeypatch.setattr(nest_growth, "_grown", grown)
    one, other = ITEMS[:1], [ITEMS[0]._replace(turns=(0.0, 180.0))]
    for items, size in ((one, ROOM), (one, ROOM), (one, (80.0, 60.0)), (other, ROOM), (ITEMS[1:], ROOM), (one, ROOM)):
        most_laid(items, size)
    assert searched == [ROOM, (80.0, 60.0), ROOM, ROOM]


def test_pieces_that_overlap_are_moved_apart_or_it_is_said_that_they_are_not() -> None:
    """Twelve hooks heaped in a corner of a sheet for more; and as many on one for half of them."""
    many = np.zeros(12, np.int64)
    for room, apart in ((ROOM, True), ((40.0, 40.0), False)):
        heap = NestPlaces(many, np.where(np.arange(12) % 2, 180.0, 0.0), np.full(12, 12 + 9j) + 0.5 * np.arange(12))
        growth = Growth(ITEMS[:1], room, heap, NoFits([HOOK]))
        found = growth._separation.separated(growth._kind, growth._way, growth._place, seed=1, effort=3000)
        assert found.apart is apart
        if apart:
            turn = np.array([turn for _, turn in growth._ways])[found.way]
            check(ITEMS, NestPlaces(many, turn, found.place))
        else:
            assert found.tried >= 3000


@pytest.mark.parametrize("kernels", ["", "numpy"])
def test_without_a_search_it_is_said_whether_pieces_overlap(kernels: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """No line is tried, and none is moved."""
    monkeypatch.setenv("VORONOI_TILES_KERNELS", kernels)
    for shift, apart in ((30j, True), (5 + 1j, False)):
        two = NestPlaces(np.zeros(2, np.intp), np.zeros(2), np.array([10 + 8j, 10 + 8j + shift]))
        growth = Growth(ITEMS[:1], ROOM, two, NoFits([HOOK]))
        found = growth._separation.separated(growth._kind, growth._way, growth._place, seed=1, effort=0)
        assert (found.apart, found.tried) == (apart, 0)
        assert found.place.tolist() == two.shift.tolist()


def test_on_a_sheet_that_is_lower_by_a_little_the_kernels_find_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces of a tessellation may fit though their polygons do not: there is less than no room for these."""
    five = NestPlaces(np.zeros(5, np.intp), np.zeros(5), np.array([20 + 3 * k + 5j for k in range(5)]))
    found = []
    for kernels in ("", "numpy"):
        monkeypatch.setenv("VORONOI_TILES_KERNELS", kernels)
        growth = Growth(ITEMS[:1], (140.0, 11.9), five, NoFits([HOOK]))
        found.append(growth._separation.separated(growth._kind, growth._way, growth._place, seed=1, effort=400))
    assert found[0].tried == found[1].tried > 0
    assert found[0].apart is found[1].apart is True
    assert found[0].place.tobytes() == found[1].place.tobytes()


def test_pieces_that_no_way_to_lie_has_room_for_are_left_out() -> None:
    """The mirrored one is too long for this sheet where nothing else turns it; and of none nothing grows."""
    bar = np.array([0, 50, 50 + 4j, 4j]) - (25 + 2j)
    items = [NestItem(HOOK, 0.5, None), NestItem(bar, 0.5, None)]
    one = NestPlaces(np.zeros(1, np.intp), np.zeros(1), np.array([10 + 8j]))
    growth = Growth(items, (40.0, 30.0), one, NoFits([HOOK, bar]))
    growth.grow(1, 300)
    assert growth.count > 1
    assert not growth.places.item.any()


def test_a_search_goes_on_for_as_long_as_it_may(monkeypatch: pytest.MonkeyPatch) -> None:
    """It tells of the time that passes, and finds no fewer."""
    monkeypatch.setattr(nest_growth, "_ROUNDS", ((3, 1000),))
    monkeypatch.setattr(nest_growth, "_AGAIN", 1000)
    told: list[float] = []
    found = most_found(ITEMS, ROOM, [], 0.6, 0, told.append)
    check(ITEMS, found)
    assert len(found.item) >= len(most_laid(ITEMS, ROOM).item)
    assert told == sorted(told)
    assert told[-1] >= 0.6


def test_the_kernels_find_what_numpy_finds(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same bits: of patterns, and of a search in them."""
    for name, few in (("_PAIRS", 8), ("_BEST", 1), ("_ROWS", (24, 8)), ("_LINES", (12, 24))):
        monkeypatch.setattr(nest_patterns, name, few)
    monkeypatch.setattr(nest_growth, "_ROUNDS", ((2, 150),))
    monkeypatch.setattr(nest_growth, "_REMEMBERED_MAX", 0)  # neither of the one for the other
    found = []
    for kernels in ("", "numpy"):
        monkeypatch.setenv("VORONOI_TILES_KERNELS", kernels)
        no_fits = NoFits([item.ring for item in ITEMS])
        found.append((*pattern_layouts(ITEMS, ROOM, no_fits, 2), most_laid(ITEMS, ROOM)))
    for compiled, by_numpy in zip(*found, strict=True):
        assert all(np.array_equal(one, other) for one, other in zip(compiled, by_numpy, strict=True))

"""Places that are found beside pieces: convex parts of polygons, where they overlap, and what room is filled."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.fabrication import nested_regions
from voronoi_tiles.fabrication.convex_parts import convex_parts, overlaps
from voronoi_tiles.fabrication.nest_filling import fill
from voronoi_tiles.fabrication.nest_kinds import NestKind
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces
from voronoi_tiles.fabrication.nested_regions import lay_in_holes, lay_in_region

BAY = np.array([0, 10, 10 + 10j, 6 + 10j, 6 + 8j, 8 + 8j, 8 + 2j, 2 + 2j, 2 + 8j, 5 + 8j, 5 + 10j, 10j])
"""A room with a door that is narrower than it; corners of it lie on one line."""

EVERYWHERE = (-1e9, -1e9, 1e9, 1e9)


def star(seed: int, count: int) -> Complexes:
    """A polygon of corners at random distances around 0, deeply notched."""
    random = np.random.default_rng(seed)
    return np.asarray(random.uniform(2, 10, count) * np.exp(2j * np.pi * np.arange(count) / count))


def polygon(ring: Complexes) -> shapely.Polygon:
    """A ring of points as a polygon."""
    return shapely.Polygon(plane(np.asarray(ring)))


@pytest.mark.parametrize("ring", [BAY, BAY[::-1], *(star(seed, 5 + seed) for seed in range(0, 60, 6))])
def test_convex_parts_make_up_a_polygon(ring: Complexes) -> None:
    """By shapely: each is convex, they overlap nowhere, leave nothing out, and are fewer than triangles would be."""
    parts = [polygon(part) for part in convex_parts(ring)]
    whole = polygon(ring)
    assert shapely.union_all(parts).symmetric_difference(whole).area < 1e-9
    assert sum(part.area for part in parts) == pytest.approx(whole.area, abs=1e-9)
    assert all(part.convex_hull.area == pytest.approx(part.area, abs=1e-9) for part in parts)
    assert len(parts) < len(ring) - 2


@pytest.mark.parametrize("moving", [np.array([0, 3, 3 + 3j, 3j]), star(3, 9)])
def test_places_overlap_where_the_sums_of_parts_say_so(moving: Complexes) -> None:
    """Places drawn at random overlap by shapely if and only if they lie in the union, bays and all."""
    region = shapely.union_all(overlaps(convex_parts(BAY), convex_parts(moving), EVERYWHERE))
    stays, other = polygon(BAY), polygon(moving)
    for x, y in np.random.default_rng(5).uniform(-15, 25, (300, 2)).tolist():
        overlap = stays.intersection(shapely.affinity.translate(other, x, y)).area
        assert region.contains(shapely.Point(x, y)) == (overlap > 0), (x, y)


def test_lines_that_stay_are_overlapped_as_well() -> None:
    """A side of a hole is a polygon of two corners: a square of 2 overlaps one of 10 in a rectangle of 12 x 2."""
    line, square = np.array([[0, 10]]), np.array([[0, 2, 2 + 2j, 2j]])
    (region,) = overlaps(line, square, EVERYWHERE)
    assert region.symmetric_difference(shapely.box(-2, -2, 10, 0)).area < 1e-6
    assert not overlaps(line, square, (20.0, 20.0, 30.0, 30.0))


SQUARE = np.array([-5 - 5j, 5 - 5j, 5 + 5j, -5 + 5j])
ELL = np.array([0, 12, 12 + 4j, 4 + 4j, 4 + 12j, 12j]) - (4 + 4j)
OFFCUT = shapely.union_all(
    [
        shapely.Point(30, 30).buffer(29).difference(shapely.Point(36, 33).buffer(7)),
        shapely.box(70, 0, 84, 13),
        shapely.box(70, 40, 75, 90),
    ]
)
"""What is left of a sheet: a disc with a hole in it, a rest with room for one, and one with room for none."""


def shapes(items: list[NestItem], places: NestPlaces) -> list[shapely.Polygon]:
    """Pieces where they lie, by shapely."""
    found = []
    for k, turn, shift in places.rows():
        turned = shapely.affinity.rotate(polygon(items[k].ring), turn, origin=(0, 0))
        found.append(shapely.affinity.translate(turned, shift.real, shift.imag))
    return found


def overlap(pieces: list[shapely.Polygon]) -> float:
    """The largest area that two pieces have in common."""
    one, two = np.triu_indices(len(pieces), 1)
    return float(shapely.area(shapely.intersection(np.array(pieces)[one], np.array(pieces)[two])).max())


def test_a_region_with_holes_and_parts_is_filled_until_nothing_fits() -> None:
    """By shapely all pieces lie in it and none on another; of 2,000 places drawn at random none is free."""
    items = [NestItem(SQUARE, 0.5, (0.0, 30.0)), NestItem(ELL, 0.5, (0.0, 90.0, 180.0, 270.0))]
    places = fill(items, OFFCUT, NestPlaces.none())
    pieces = shapes(items, places)
    assert overlap(pieces) < 1e-6
    assert max(piece.difference(OFFCUT).area for piece in pieces) < 1e-6
    counts = np.bincount(places.item)
    assert abs(counts[0] - counts[1]) <= 2
    assert sum(piece.bounds[0] > 60 for piece in pieces) == 1
    free = OFFCUT.difference(shapely.union_all(pieces)).buffer(1e-6)
    random = np.random.default_rng(7)
    for k in range(2):
        count = 1000
        turn, z = random.choice(items[k].turns or (), count), random.uniform(0, 90, (2 * count, 2)).view(complex)[:, 0]
        tried = NestPlaces(np.full(count, k), turn, z[:count])
        assert not any(free.contains(piece) for piece in shapes(items, tried))


def test_items_that_lack_are_laid_though_others_lack_as_well() -> None:
    """Two items are missing beside one of which there are many: all three have their part of their share at last."""
    items = [NestItem(ring, 1 / 3, (0.0,)) for ring in (SQUARE, ELL, np.asarray(SQUARE / 2, np.complex128))]
    laid = NestPlaces(np.full(9, 2), np.zeros(9), np.array([6 * k + 3 + 3j for k in range(9)]))
    places = fill(items, shapely.box(0, 0, 60, 34), laid, even=True)
    counts = np.bincount(np.append(laid.item, places.item), minlength=3)
    assert overlap(shapes(items, laid) + shapes(items, places)) < 1e-6
    assert (counts >= np.floor(0.8 * counts.sum() / 3)).all(), counts


def test_a_drawn_region_holds_each_kind_by_its_share() -> None:
    """Also where the band of one lies beyond it, in the pattern that is moved over it."""
    rings = [np.asarray(SQUARE / 2, np.complex128), np.asarray(ELL / 2, np.complex128), ELL]
    kinds = [NestKind(0, 0j, NestItem(ring, 1 / 3, (0.0, 90.0)), ring, ()) for ring in rings]
    region = shapely.box(0, 0, 60, 45)
    places = lay_in_region(kinds, region, np.full(3, 99), even=True)
    pieces = shapes([kind.item for kind in kinds], places)
    counts = np.bincount(places.item, minlength=3)
    assert overlap(pieces) < 1e-4
    assert region.buffer(1e-4).contains(shapely.union_all(pieces))
    assert (counts >= np.floor(0.8 * counts.sum() / 3)).all(), counts
    assert sum(piece.area for piece in pieces) > 0.6 * region.area


def test_holes_are_filled_once_for_all_pieces_of_a_kind(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 24 frames each has one of two others in its hole, and not one more than is asked for; few holes are filled."""
    rings = [np.asarray(SQUARE * 2, np.complex128), SQUARE, np.asarray(ELL * 0.9, np.complex128)]
    kinds = [NestKind(0, 0j, NestItem(ring, 1 / 3, None), ring, ()) for ring in rings]
    kinds[0] = kinds[0]._replace(holes=(np.asarray(SQUARE * 1.1, np.complex128),))
    numbers = np.arange(24.0)
    places = NestPlaces(np.zeros(24, np.intp), numbers * 15, np.asarray(numbers * (50 + 7j), np.complex128))
    filled: list[int] = []

    def counted(*args: Any, **named: Any) -> NestPlaces:
        """Fill, and say how many holes."""
        filled.append(shapely.get_num_geometries(args[1]))
        return fill(*args, **named)

    monkeypatch.setattr(nested_regions, "fill", counted)
    for demand, wanted in (([99, 99, 99], 24), ([0, 3, 2], 5), ([0, 0, 0], 0)):
        inner = lay_in_holes(kinds, places, np.array(demand))
        counts = np.bincount(inner.item, minlength=3)
        assert counts.sum() == wanted
        assert (counts <= demand).all()
        assert abs(counts[1] - counts[2]) <= 1
        pieces = shapes([kind.item for kind in kinds], inner)
        holes = shapes([NestItem(kinds[0].holes[0], 1.0, None)], places)
        within = shapely.contains(shapely.buffer(holes, 1e-6)[:, None], np.array(pieces, object))
        assert within.any(axis=0).all()
        assert within.sum(axis=1).max(initial=0) <= 1
    assert sum(filled) <= 8


def test_pieces_are_laid_beside_those_that_lie_there_the_lowest_place_first() -> None:
    """Squares of 10 beside one on a strip of 45 x 10: two to its right; then a row above them."""
    items = [NestItem(SQUARE, 1.0, (0.0,))]
    laid = NestPlaces(np.array([0]), np.zeros(1), np.array([12 + 5.005j]))
    places = fill(items, shapely.box(0, 0, 45, 10.01), laid)
    assert np.round(places.shift, 3).tolist() == [22 + 5j, 32 + 5j]
    places = fill(items, shapely.box(0, 0, 45, 21), laid)
    assert np.round(places.shift[:2].imag, 3).tolist() == [5, 5]
    assert len(places.item) == 2 + 3
    assert not len(fill(items, shapely.box(0, 0, 45, 9.9), NestPlaces.none()).item)


def test_no_more_are_laid_than_asked_for_and_the_same_ones_again() -> None:
    """So many of each item at most; a search that no clock ends is repeatable."""
    items = [NestItem(SQUARE, 0.3, None), NestItem(ELL, 0.7, None)]
    places, again = (
        fill(items, shapely.box(0, 0, 40, 40), NestPlaces.none(), demand=np.array([2, 1])) for _ in range(2)
    )
    assert np.bincount(places.item).tolist() == [2, 1]
    for one, other in zip(places, again, strict=True):
        assert one.tobytes() == other.tobytes()


def test_outlines_may_come_nearer_to_the_edge_than_polygons_to_each_other() -> None:
    """Squares of 10 that keep 2 from each other, and nothing from the edge: two in a strip of 22, and none too many."""
    items = [NestItem(np.asarray(SQUARE * 1.2, np.complex128), 1.0, (0.0,))]
    places = fill(items, shapely.box(0, 0, 22.01, 10.01), NestPlaces.none(), outlines=[SQUARE])
    assert len(places.item) == 2
    assert abs(places.shift[1] - places.shift[0]) >= 12
    assert len(fill(items, shapely.box(0, 0, 21.9, 10.01), NestPlaces.none(), outlines=[SQUARE]).item) == 1

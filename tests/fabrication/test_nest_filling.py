"""Places that are found beside pieces: convex parts of polygons, where they overlap, and what room is filled."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.fabrication.convex_parts import convex_parts, overlaps

BAY = np.array([0, 10, 10 + 10j, 6 + 10j, 6 + 8j, 8 + 8j, 8 + 2j, 2 + 2j, 2 + 8j, 5 + 8j, 5 + 10j, 10j])
"""A room with a door that is narrower than it; corners of it lie on one line."""

EVERYWHERE = (-1e9, -1e9, 1e9, 1e9)


def star(seed: int, count: int) -> Complexes:
    """A polygon of corners at random distances around 0, deeply notched."""
    random = np.random.default_rng(seed)
    return random.uniform(2, 10, count) * np.exp(2j * np.pi * np.arange(count) / count)


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
    assert region.equals(shapely.box(-2, -2, 10, 0))
    assert not overlaps(line, square, (20.0, 20.0, 30.0, 30.0))

"""Items that come nearer than a distance are found, and no others: by shapely, from finely flattened outlines."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from helpers.sheets import shape
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.paths.near_items import near_items
from voronoi_tiles.paths.paths import ARC, LINE, QUAD, Paths

FLAT = 1e-4
"""How far the oracle's chords are from the curves, in the unit of the blobs, about 10 across."""


def blob(corners: int, bends: list[tuple[int, float]], centre: complex, turn: float) -> Paths:
    """A closed path about a centre; `bends` says which sides are lines, arcs and parabolas, and how bent each is."""
    points = centre + 5 * np.exp(1j * (turn + 2 * np.pi * np.arange(corners) / corners))
    end = np.roll(points, -1)
    kind = np.array([[LINE, ARC, QUAD][bends[k % len(bends)][0]] for k in range(corners)], np.uint8)
    bend = np.array([bends[k % len(bends)][1] for k in range(corners)])
    control = np.zeros((corners, 2), np.complex128)
    control[:, 0] = np.where(kind == LINE, 0, (points + end) / 2 - 1j * (end - points) * bend)
    return Paths(points, end, control, kind, np.array([0, corners]), np.ones(1, np.bool_))


BENDS = st.lists(
    st.tuples(st.integers(0, 2), st.floats(-0.12, 0.12).filter(lambda bend: abs(bend) > 0.01)), min_size=1, max_size=4
)
"""Arcs that turn in by more would cross each other beside the corners of a triangle."""
BLOBS = st.builds(blob, st.integers(3, 7), BENDS, st.builds(complex, *[st.floats(0, 30)] * 2), st.floats(0, 6))


def pairs(shapes: list[Any], distance: float) -> set[tuple[int, int]]:
    """The pairs of shapes that are nearer than a distance."""
    count = range(len(shapes))
    return {(i, j) for i in count for j in count if i < j and shapes[i].distance(shapes[j]) < distance}


@settings(deadline=None, max_examples=25)
@given(st.lists(BLOBS, min_size=2, max_size=8), st.floats(0.01, 6.0))
def test_what_is_near_is_what_shapely_finds_near(blobs: list[Paths], distance: float) -> None:
    """A little less than the distance is near in both, a little more in neither; what overlaps is near."""
    found = set(map(tuple, near_items(Paths.concatenate(blobs), np.arange(len(blobs) + 1), distance).tolist()))
    shapes = [shape(one, FLAT) for one in blobs]
    assert pairs(shapes, distance - 3 * FLAT) <= found <= pairs(shapes, distance + 3 * FLAT)


@pytest.mark.parametrize("kind", [LINE, ARC, QUAD])
def test_the_distance_is_decided_to_some_nanometres(kind: int) -> None:
    """Two bodies whose middles face each other are found when they are ten nanometres too near, not when farther."""
    apart = 1.0 if kind == LINE else 1.0 - 2 * (0.4 if kind == ARC else 0.2)
    for change, near in ((-1e-5, True), (1e-5, False)):
        pair = [faced(kind, 0j, -1), faced(kind, 1j + 1j * change, 1)]
        found = near_items(Paths.concatenate(pair), np.arange(3), apart)
        assert len(found) == near, (kind, change)


def faced(kind: int, corner: complex, way: int) -> Paths:
    """A body whose side from a corner to the right faces what is below it (way 1) or above, and bulges there."""
    start = np.array([corner, corner + 2, corner + 2 + 4j * way, corner + 4j * way])
    control = np.zeros((4, 2), np.complex128)
    control[0, 0] = 0 if kind == LINE else corner + 1 - 0.4j * way
    kinds = np.array([kind, LINE, LINE, LINE], np.uint8)
    path = Paths(start, np.roll(start, -1), control, kinds, np.array([0, 4]), np.ones(1, np.bool_))
    return path if way > 0 else path.reversed()


def test_a_piece_within_another_overlaps_it_and_one_in_its_hole_does_not() -> None:
    """Contours that are far apart can still be those of regions that overlap."""
    square = Paths.polylines([[-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j]], closed=True)
    large, small = square.moved(20, 0j), square.moved(2, 0j)
    hole = square.moved(10, 0j).reversed()
    assert near_items(Paths.concatenate([large, small]), np.array([0, 1, 2]), 1.0).tolist() == [[0, 1]]
    ring = near_items(Paths.concatenate([large, hole, small]), np.array([0, 2, 3]), 1.0)
    assert len(ring) == 0


def test_bars_that_cross_overlap_at_any_distance() -> None:
    """Neither holds a corner of the other, and nothing is nearer than nothing."""
    bar = Paths.polylines([[-10 - 1j, 10 - 1j, 10 + 1j, -10 + 1j]], closed=True)
    crossed = Paths.concatenate([bar, bar.moved(1j, 0j)])
    for distance in (0.0, 1e-10, 1e-6, 1.0):
        assert near_items(crossed, np.array([0, 1, 2]), distance).tolist() == [[0, 1]], distance

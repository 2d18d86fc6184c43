"""Drawings as points of a grid: the bridges between their parts, and distances, against those of scipy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy import ndimage, spatial
from scipy.sparse.csgraph import minimum_spanning_tree

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.designs.silhouette import distances_to, long_bridges

places = st.tuples(st.integers(-96, 96), st.integers(-96, 96)).map(lambda place: complex(*place))


def tree_lengths(points: Complexes) -> list[float]:
    """The lengths of the sides of a shortest tree that are no steps to a neighbour: every such tree has the same."""
    apart = spatial.distance.squareform(spatial.distance.pdist(np.stack((points.real, points.imag), axis=1)))
    lengths = minimum_spanning_tree(apart).data
    return sorted(lengths[lengths > 1.5].tolist())


@settings(max_examples=100, deadline=None)
@given(st.lists(places, min_size=1, max_size=12), st.integers(0, 5), st.integers(0, 2**32 - 1))
@example([0j], 0, 0)
@example([0j, 5 + 5j, 9 + 9j], 0, 0)
def test_bridges_are_the_long_sides_of_a_shortest_tree(seeds: list[complex], spread: int, seed: int) -> None:
    """For points alone, on a line, in clouds: each bridge joins two of them, and all have the tree's lengths."""
    random = np.random.default_rng(seed)
    cloud = spread * (random.normal(size=(len(seeds), 20)) + 1j * random.normal(size=(len(seeds), 20)))
    points = (np.array(seeds)[:, None] + cloud).ravel()
    points = np.unique(np.rint(points.real) + 1j * np.rint(points.imag))
    bridges = long_bridges(points)
    assert np.isin(bridges, points).all()
    assert sorted(np.abs(bridges[:, 1] - bridges[:, 0]).tolist()) == pytest.approx(tree_lengths(points))


def test_a_bridge_that_is_missing_is_seen() -> None:
    """The tree's lengths are of all its long sides."""
    points = np.array([0j, 1 + 0j, 10 + 0j, 10 + 20j])
    assert tree_lengths(points) == [9.0, 20.0]


@settings(max_examples=50, deadline=None)
@given(st.integers(1, 60), st.integers(1, 60), st.integers(0, 40), st.integers(0, 2**32 - 1))
def test_distances_are_known_up_to_their_reach(rows: int, columns: int, count: int, seed: int) -> None:
    """Bit for bit, around the picture too, for 0.3 of 96 pixels; beyond it they are no less."""
    marked = np.zeros((rows, columns), np.bool_)
    random = np.random.default_rng(seed)
    marked[random.integers(0, rows, count), random.integers(0, columns, count)] = True
    found = distances_to(marked)
    rim = (len(found) - rows) // 2
    assert found.shape == (rows + 2 * rim, columns + 2 * rim)
    assert rim > 0.3 * 96
    if not count:
        assert found.min() > 0.3 * 96
        return
    expected = ndimage.distance_transform_edt(~np.pad(marked, rim))
    assert np.array_equal(np.minimum(found, 0.3 * 96), np.minimum(expected, 0.3 * 96))

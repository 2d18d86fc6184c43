"""Nodes and elements of several sites in one set of arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.vector.all_nodes import AllNodes


@dataclass(frozen=True)
class _Site:
    """What is read of a tile here."""

    nodes: NDArray[np.complex128]
    segments: NDArray[np.intp]


def test_elements_stand_tile_after_tile() -> None:
    """Segments have the numbers of nodes among all; nodes in no segment are elements whose ends are the same."""
    first = _Site(np.array([1j, 2j, 3j, 4j]), np.array([[3, 1], [1, 0]]))
    point = _Site(np.array([5j]), np.zeros((0, 2), np.intp))
    last = _Site(np.array([6j, 7j, 8j]), np.array([[2, 0]]))
    sites: Any = [first, point, last]
    nodes = AllNodes.of(sites)
    assert nodes.position.tolist() == [1j, 2j, 3j, 4j, 5j, 6j, 7j, 8j]
    assert nodes.tile.tolist() == [0, 0, 0, 0, 1, 2, 2, 2]
    assert nodes.segments.tolist() == [[3, 1], [1, 0], [7, 5]]
    tile, start, end = nodes.elements()
    assert tile.tolist() == [0, 0, 0, 1, 2, 2]
    assert start.tolist() == [4j, 2j, 3j, 5j, 8j, 7j]
    assert end.tolist() == [2j, 1j, 3j, 5j, 6j, 7j]

"""The parts of a graph that hang together."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Ints


def components(count: int, first: Ints, last: Ints) -> Ints:
    """The least node of the part that each of the nodes 0 ... count - 1 belongs to, intp (count,).

    Edge k joins the nodes `first[k]` and `last[k]`, whichever way.

    Every node points at a lower one of its part, or at itself. Where an edge joins two trees, the root of the one with
    the higher number is hung on the other's, and all paths are cut short, until no edge joins two trees: Shiloach,
    Vishkin, An O(log n) parallel connectivity algorithm, J. Algorithms 3 (1982).
    """
    least = np.arange(count)
    while True:
        one, two = least[first], least[last]
        if (one == two).all():
            return least
        np.minimum.at(least, np.maximum(one, two), np.minimum(one, two))
        further = least[least]
        while (further != least).any():
            least, further = further, further[further]

"""The nearest of some points to others."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, plane

_FEW: Final = 1000
"""Up to this many points all distances are taken; a count. It is quicker than a tree, whose import takes 0.3 s."""


_AT_ONCE: Final = 4_000_000
"""Distances that are held at once; a count."""


class Neighbours:
    """Points among which the nearest are looked for: by all distances where they are few, else in a tree.

    Without scipy, as within Blender, all distances are taken of many as well.
    """

    def __init__(self, among: Complexes) -> None:
        self._among = among
        self._tree: Any = None
        if len(among) > _FEW:
            try:
                from scipy.spatial import cKDTree
            except ImportError:
                return
            self._tree = cKDTree(plane(among))

    def nearest(self, points: Complexes, count: int = 1) -> tuple[Floats, Ints]:
        """The distances of the `count` nearest to each of n points, nearest first, and which they are: both (n, count).

        There must be as many to choose from.
        """
        if self._tree is not None:
            distance, index = self._tree.query(plane(points), k=np.arange(1, count + 1))
            return np.asarray(distance), np.asarray(index, np.intp)
        parts = np.array_split(points, 1 + len(points) * len(self._among) // _AT_ONCE)
        found = [self._by_all(part, count) for part in parts]
        return np.concatenate([one for one, _ in found]), np.concatenate([one for _, one in found])

    def _by_all(self, points: Complexes, count: int) -> tuple[Floats, Ints]:
        """The same by all distances."""
        away = np.abs(points[:, None] - self._among)
        if count == 1:
            index = away.argmin(axis=1)[:, None]
        else:
            near = np.argpartition(away, count - 1, axis=1)[:, :count]
            order = np.take_along_axis(away, near, axis=1).argsort(axis=1, kind="stable")
            index = np.take_along_axis(near, order, axis=1)
        return np.take_along_axis(away, index, axis=1), index

"""Upright boxes in a tree, and which of them meet others."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, offsets_of, plane
from voronoi_tiles.base.box_join import z_order
from voronoi_tiles.base.kernels import FLOATS, INT, INTS, kernel

_WIDTH: Final = 8
"""How many boxes of one level a box of the next holds, as in box_index.c."""

_PAIRS: Final = 8
"""For how many pairs a box there is room at first."""

_COMPILED = kernel("base_boxes_meeting", INT, FLOATS, INT, INTS, FLOATS, INTS, INT, INTS, INTS)


class BoxIndex:
    """Boxes, with lower left and upper right corners `low` and `high`, complex128 (n,), among which to look."""

    def __init__(self, low: Complexes, high: Complexes) -> None:
        self._low, self._high = low, high
        self._tree: Any = None

    def meeting(self, low: Complexes, high: Complexes) -> tuple[Ints, Ints]:
        """The pairs of a box with these corners, complex128 (m,), and one of the index that meets it, or touches it.

        In the order of the first, then of the second. A compiled kernel finds them; without, shapely does.
        """
        if not len(self._low):
            return np.zeros(0, np.intp), np.zeros(0, np.intp)
        compiled = _COMPILED()
        if compiled is None:
            return self._by_shapely(low, high)
        if self._tree is None:
            self._tree = _levels(self._low, self._high)
        boxes, room = _rows(low, high), _PAIRS * len(low)
        while True:
            i, j = np.empty((2, room), np.intp)
            found = compiled(len(low), boxes, len(self._tree[0]) - 1, *self._tree, room, i, j)
            if found <= room:
                return i[:found], j[:found]
            room = found

    def _by_shapely(self, low: Complexes, high: Complexes) -> tuple[Ints, Ints]:
        """The same pairs by shapely's tree."""
        import shapely

        tree = shapely.STRtree(shapely.box(*_rows(self._low, self._high).T))
        i, j = tree.query(shapely.box(*_rows(low, high).T))
        order = np.lexsort((j, i))
        return i[order].astype(np.intp), j[order].astype(np.intp)


def _rows(low: Complexes, high: Complexes) -> Floats:
    """Boxes as rows of least x, least y, greatest x, greatest y."""
    return np.concatenate((plane(low), plane(high)), axis=1)


def _levels(low: Complexes, high: Complexes) -> tuple[Ints, Floats, Ints]:
    """Where the levels begin in the rows of boxes, these rows, and the order of the smallest ones."""
    order = z_order((low + high) / 2)
    levels = [_rows(low[order], high[order])]
    while len(levels[-1]) > _WIDTH:
        first = np.arange(0, len(levels[-1]), _WIDTH)
        least, most = np.minimum.reduceat(levels[-1][:, :2], first), np.maximum.reduceat(levels[-1][:, 2:], first)
        levels.append(np.concatenate((least, most), axis=1))
    return offsets_of([len(level) for level in levels]), np.concatenate(levels), order

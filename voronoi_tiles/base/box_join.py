"""Segments in the order of their places, the pairs whose bounding boxes meet, and the points that lie in boxes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Ints, owned_ranges
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.tolerance import PAIRS_MAX


def overlapping_boxes(ends: Complexes, margin: float) -> tuple[Ints, Ints]:
    """Index pairs i < j of segments whose bounding boxes come within `margin` of each other.

    `ends` is complex128 of shape (n, 2). A tree of boxes over the segments in Z-order is joined with
    itself, level by level, eight children to a box. Raises DesignError beyond PAIRS_MAX pairs.
    """
    n = len(ends)
    x, y = ends.real, ends.imag
    boxes = np.stack([x.min(axis=1), y.min(axis=1), x.max(axis=1) + margin, y.max(axis=1) + margin])
    order = np.arange(n)
    if n > 64:
        order = z_order(ends.mean(axis=1))
        boxes = boxes[:, order]
    levels = [boxes]
    while levels[-1].shape[1] > 8:
        lower = levels[-1]
        starts = np.arange(0, lower.shape[1], 8)
        levels.append(
            np.concatenate(
                [np.minimum.reduceat(lower[:2], starts, axis=1), np.maximum.reduceat(lower[2:], starts, axis=1)]
            )
        )
    top = levels[-1].shape[1]
    i, j = (index.astype(np.intp) for index in np.triu_indices(top))
    i, j = _meeting(levels[-1], i, j)
    for level in reversed(levels[:-1]):
        if len(i) > PAIRS_MAX:
            raise _too_many()
        # In portions, so that the 64 pairs of children of each pair never fill the memory.
        portions = [
            _meeting(level, *_children(i[k : k + 32768], j[k : k + 32768], level.shape[1]))
            for k in range(0, len(i), 32768)
        ]
        i, j = (np.concatenate(part) for part in zip(*portions, strict=True))
    apart = i != j
    i, j = order[i[apart]], order[j[apart]]
    if len(i) > PAIRS_MAX:
        raise _too_many()
    return np.minimum(i, j), np.maximum(i, j)


def _children(i: Ints, j: Ints, count: int) -> tuple[Ints, Ints]:
    """The pairs p <= q of children of boxes i and j, eight to a box, `count` in all."""
    shape = (len(i), 8, 8)
    steps = np.arange(8)
    p = np.broadcast_to((8 * i[:, None] + steps)[:, :, None], shape).ravel()
    q = np.broadcast_to((8 * j[:, None] + steps)[:, None, :], shape).ravel()
    inside = (p <= q) & (q < count)
    return p[inside], q[inside]


def _meeting(boxes: NDArray[np.float64], i: Ints, j: Ints) -> tuple[Ints, Ints]:
    x0, y0, x1, y1 = boxes
    meet = (x0[i] <= x1[j]) & (x0[j] <= x1[i]) & (y0[i] <= y1[j]) & (y0[j] <= y1[i])
    return i[meet], j[meet]


def points_in_boxes(points: Complexes, low: Complexes, high: Complexes) -> tuple[Ints, Ints]:
    """Index pairs of a point and a box that holds it, box after box; boxes are closed, with `low` and `high` corners.

    `points` is complex128 (n,), the corners complex128 (m,), m > 0. The points are sorted into a grid of about as many
    squares as there are boxes.
    """
    side = math.isqrt(len(low)) + 1
    x0, y0, x1, y1 = low.real.min(), low.imag.min(), high.real.max(), high.imag.max()
    near = (points.real >= x0) & (points.real <= x1) & (points.imag >= y0) & (points.imag <= y1)
    index = np.flatnonzero(near)
    # Larger coordinates have larger numbers, even where rounding decides on them.
    column, left, right = (_numbers(z.real, x0, x1, side) for z in (points[index], low, high))
    row, bottom, top = (_numbers(z.imag, y0, y1, side) for z in (points[index], low, high))
    square = row * side + column
    order = np.argsort(square, kind="stable")
    row, box = owned_ranges(bottom, top + 1)
    first = np.searchsorted(square[order], row * side + left[box], "left")
    last = np.searchsorted(square[order], row * side + right[box], "right")
    place, run = owned_ranges(first, last)
    point, box = index[order[place]], box[run]
    x, y = points.real[point], points.imag[point]
    inside = (x >= low.real[box]) & (x <= high.real[box]) & (y >= low.imag[box]) & (y <= high.imag[box])
    return point[inside], box[inside]


def _numbers(values: NDArray[np.float64], least: float, most: float, count: int) -> Ints:
    """The numbers 0 ... count - 1 of the parts of an interval in which values lie."""
    return np.minimum((values - least) * (count / ((most - least) or 1.0)), count - 1).astype(np.intp)


def z_order(points: Complexes) -> Ints:
    """The order of points along the Z-order curve (Morton code of 2 x 16 bits): neighbours in the plane stay near.

    `points` is complex128 of shape (n,), n > 0; returns intp of shape (n,).
    """
    grid = np.stack((points.real, points.imag))
    grid -= grid.min(axis=1, keepdims=True)
    bits = (grid * (65535 / (grid.max() or 1.0))).astype(np.int64)
    for mask, step in ((0x00FF00FF, 8), (0x0F0F0F0F, 4), (0x33333333, 2), (0x55555555, 1)):
        bits = (bits | (bits << step)) & mask
    return np.argsort(bits[0] | bits[1] << 1, kind="stable")


def _too_many() -> DesignError:
    return DesignError(
        "the strokes cross or overlap each other too often",
        key="strokes",
        remedy="Draw fewer strokes, or raise the site's tolerance.",
    )

"""Outlines of lines that are moved: the first of some pairs of them that come within a reach of each other."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, offsets_of, owned_ranges, plane
from voronoi_tiles.base.kernels import COMPLEXES, FLOAT, FLOATS, INT, INTS, kernel

_GROUP: Final = 8
"""How many segments one box holds, as in clearance.c."""

_AT_ONCE: Final = 1 << 18
"""About how many pairs of boxes numpy compares at once; a count."""

_COMPILED = kernel("outlines_near", INT, INTS, INTS, COMPLEXES, FLOAT, INTS, INTS, *4 * [FLOATS])


class NearPair(NamedTuple):
    """The number of a pair of outlines, and the way from the second's nearest point to the first's; 0 if they cross."""

    pair: int
    way: complex


class Outlines:
    """Outlines, each of some segments from `start` to `end`, complex128 (n,): outline k has first[k] ... first[k + 1].

    What they enclose does not count: one within another is as far from it as from its border.
    """

    def __init__(self, start: Complexes, end: Complexes, first: Ints) -> None:
        self._segments = np.concatenate((plane(start), plane(end)), axis=1)
        self._first = first
        counts = -(-np.diff(first) // _GROUP)
        self._group = offsets_of(counts)
        # Where the groups begin; and the end of the last.
        begin = np.repeat(first[:-1] - _GROUP * self._group[:-1], counts) + _GROUP * np.arange(self._group[-1])
        self._begin = np.append(begin, len(start))
        self._segment_boxes = boxes = _boxes_of(self._segments)
        self._boxes, self.boxes = (
            np.concatenate((np.minimum.reduceat(boxes[:, :2], rows), np.maximum.reduceat(boxes[:, 2:], rows)), axis=1)
            for rows in (begin, first[:-1])
        )

    def first_near(self, one: Ints, two: Ints, shift: Complexes, reach: float) -> NearPair | None:
        """The first pair, (m,) each, that comes within a reach, the second outline moved; None where none does.

        The same bits come from a compiled kernel and from numpy.
        """
        compiled = _COMPILED()
        if compiled is None:
            return self._by_numpy(one, two, shift, reach)
        way = np.empty(2)
        arrays = self._first, self._group, self.boxes, self._boxes, self._segments, way
        found = compiled(len(one), one, two, shift, reach, *arrays)
        return NearPair(found, complex(*way)) if found >= 0 else None

    def _by_numpy(self, one: Ints, two: Ints, shift: Complexes, reach: float) -> NearPair | None:
        """What `outlines_near` does."""
        moved = np.tile(plane(shift), 2)
        near = np.flatnonzero(_together(self.boxes[one], self.boxes[two] + moved, reach))
        groups = np.diff(self._group)
        portion = np.cumsum(groups[one[near]] * groups[two[near]]) // _AT_ONCE
        for pairs in np.split(near, np.flatnonzero(np.diff(portion)) + 1):
            row, i, j, above = pairs, one[pairs], two[pairs], self.boxes
            for offsets, boxes in ((self._group, self._boxes), (self._begin, self._segment_boxes)):
                i, of = owned_ranges(offsets[i], offsets[i + 1])
                row, j = row[of], j[of]
                close = _together(boxes[i], above[j] + moved[row], reach)
                row, i, j = row[close], i[close], j[close]
                j, of = owned_ranges(offsets[j], offsets[j + 1])
                row, i = row[of], i[of]
                close = _together(boxes[i], boxes[j] + moved[row], reach)
                row, i, j, above = row[close], i[close], j[close], boxes
            square, way = squared_distances(self._segments[i], self._segments[j] + moved[row])
            near_ones = np.flatnonzero(square <= reach * reach)
            if len(near_ones):
                first = near_ones[row[near_ones] == row[near_ones[0]]]
                best = first[np.argmin(square[first])]
                return NearPair(int(row[best]), complex(*way[best]))
        return None


def _boxes_of(segments: Floats) -> Floats:
    """The boxes of segments, (n, 4)."""
    start, end = segments[:, :2], segments[:, 2:]
    return np.concatenate((np.minimum(start, end), np.maximum(start, end)), axis=1)


def _together(one: Floats, two: Floats, reach: float) -> Bools:
    """Whether boxes, (..., 4) each, come within a reach of each other, in x and in y."""
    free = np.maximum(two[..., :2] - one[..., 2:], one[..., :2] - two[..., 2:])
    return np.asarray(~(free > reach).any(axis=-1))


def squared_distances(one: Floats, two: Floats) -> tuple[Floats, Floats]:
    """The squares of the distances of segments, (n, 4) each: x and y of the start, then of the end; 0 where they cross.

    And the ways from the second ones' nearest points to the first ones', float64 (n, 2).
    """
    a, b, c, d = one[:, :2], one[:, 2:], two[:, :2], two[:, 2:]
    ways = np.stack((_from(a, c, d), _from(b, c, d), -_from(c, a, b), -_from(d, a, b)))
    squares = ways[..., 0] * ways[..., 0] + ways[..., 1] * ways[..., 1]
    best = np.argmin(squares, axis=0), np.arange(len(one))
    u, v = b - a, d - c
    crossed = (_area(u, c - a) * _area(u, d - a) < 0.0) & (_area(v, a - c) * _area(v, b - c) < 0.0)
    return np.where(crossed, 0.0, squares[best]), np.where(crossed[:, None], 0.0, ways[best])


def _from(point: Floats, start: Floats, end: Floats) -> Floats:
    """From the nearest points of segments to points, (n, 2)."""
    way = end - start
    length = way[:, 0] * way[:, 0] + way[:, 1] * way[:, 1]
    off = point - start
    t = (off[:, 0] * way[:, 0] + off[:, 1] * way[:, 1]) / np.where(length > 0.0, length, 1.0)
    return point - (start + np.clip(t, 0.0, 1.0)[:, None] * way)


def _area(u: Floats, v: Floats) -> Floats:
    """The areas of parallelograms of vectors, (n, 2) each; > 0 where the second lies to the left of the first."""
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]

"""Which items of paths come nearer to each other than a distance: decided by bounds, on lines, arcs and parabolas.

Two segments are as far apart as their chords, to within how far each leaves its chord. Where that does not decide,
both are halved, which leaves a quarter of it: no point is sampled, and nothing is flattened.
"""

from __future__ import annotations

from typing import Final, NamedTuple, Self

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints, plane
from voronoi_tiles.paths.clearance import squared_distances
from voronoi_tiles.paths.paths import ARC, QUAD, Paths
from voronoi_tiles.paths.segments import candidate_pairs, split
from voronoi_tiles.paths.winding import item_winding

ROUNDING: Final = 1e-6
"""What is nearer by less than this is as far apart as it has to be; millimetres. It is the last digit of files. What
touches or crosses is near whatever the distance."""

_AT_ONCE: Final = 1 << 18
"""Pairs of segments that are measured at once; a count. Bounds the memory."""


def near_items(paths: Paths, items: Ints, distance: float) -> Ints:
    """The pairs (one, two) of items that come nearer than a distance, or overlap: intp (k, 2), one < two, sorted.

    Item k are the closed paths from items[k] up to, not including, items[k + 1], as regions: one in a hole of another
    does not overlap it. What lies within ROUNDING of the distance is far enough. Raises ValueError for CUBIC.
    """
    owner = np.repeat(np.repeat(np.arange(len(items) - 1), np.diff(items)), paths.counts)
    one, two = candidate_pairs(paths, paths, distance)
    once = owner[one] < owner[two]
    one, two = one[once], two[once]
    found = [_near(paths, one[k : k + _AT_ONCE], two[k : k + _AT_ONCE], owner, distance) for k in _chunks(len(one))]
    pairs = np.concatenate([np.zeros((0, 2), np.intp), *found, _overlapping(paths, items)])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def _chunks(count: int) -> range:
    """Where the portions of so many pairs begin."""
    return range(0, count, _AT_ONCE)


def _overlapping(paths: Paths, items: Ints) -> Ints:
    """The pairs of items of which one holds a point of the other."""
    first = paths.offsets[items]
    inside = item_winding(paths, first, paths.start[first[:-1]]) > 0
    np.fill_diagonal(inside, val=False)
    return np.argwhere(inside)


class _ChordedSegments(NamedTuple):
    """Segments by themselves, and how far each leaves its chord, either way: float64 (n,)."""

    paths: Paths
    off: Floats

    @classmethod
    def of(cls, paths: Paths) -> Self:
        """Segments, each a path of its own."""
        off = np.zeros(len(paths.start))
        middle = (paths.start + paths.end) / 2
        bent, arcs = np.flatnonzero(paths.kind == QUAD), np.flatnonzero(paths.kind == ARC)
        # A parabola is at equal parameters a quarter of its second difference off, an arc by its height.
        off[bent] = np.abs(paths.control[bent, 0] - middle[bent]) / 2
        off[arcs] = np.abs(paths.control[arcs, 0] - middle[arcs])
        return cls(paths, off)

    def take(self, which: Ints) -> _ChordedSegments:
        """Some of them."""
        return _ChordedSegments(self.paths.take(which), self.off[which])

    def halves(self) -> _ChordedSegments:
        """The first halves of all, then the second ones."""
        every, none = np.arange(len(self.off)), np.zeros(len(self.off))
        first = split(self.paths, every, none, none + 0.5, start=self.paths.start)
        second = split(self.paths, every, none + 0.5, none + 1.0, start=first.end, end=self.paths.end)
        return _ChordedSegments.of(Paths.concatenate([first, second]))


def _rows(segments: Paths) -> Floats:
    """The ends of segments, float64 (n, 4)."""
    return np.concatenate((plane(segments.start), plane(segments.end)), axis=1)


def _near(paths: Paths, one: Ints, two: Ints, owner: Ints, distance: float) -> Ints:
    """The pairs of owners of segments, of pairs of these, that are nearer than a distance; some of them repeated."""
    whole = np.zeros(len(paths.start))
    first, second = (_ChordedSegments.of(split(paths, of, whole[of], whole[of] + 1.0)) for of in (one, two))
    of = np.column_stack((owner[one], owner[two]))
    limit = max(distance - ROUNDING, np.finfo(np.float64).tiny)
    found = [of[:0]]
    while len(of):
        apart = np.sqrt(squared_distances(*(_rows(one.paths) for one in (first, second)))[0])
        off = first.off + second.off
        near = (apart + off < limit) | ((off < ROUNDING / 4) & (apart < limit))
        found.append(of[near])
        unclear = (off >= ROUNDING / 4) & (apart - off < limit)
        # One pair of segments is enough for their owners.
        known = np.isin(of @ (len(owner), 1), of[near] @ (len(owner), 1))
        open_ = np.flatnonzero(unclear & ~known)
        if not len(open_):
            break
        of = of[open_]
        first, second = first.take(open_).halves(), second.take(open_).halves()
        count = len(of)
        # The halves of a pair make four.
        mine = np.tile(np.arange(2 * count), 2)
        other = np.tile(np.arange(count), 4) + np.repeat([0, count, count, 0], count)
        first, second, of = first.take(mine), second.take(other), np.tile(of, (4, 1))
    return np.concatenate(found)

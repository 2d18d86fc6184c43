"""Where paths end: at other lines, short of them, or nowhere."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, starts
from voronoi_tiles.preflight import chord_search
from voronoi_tiles.preflight.chord_distance import foot_share
from voronoi_tiles.preflight.chords import Chords


class PathEnds(NamedTuple):
    """The ends of the paths that are no rings, beginnings and ends in turn.

    `point` is complex128 (n,), `path` (intp, n) whose end it is; `distance` (float64, n) is how far the nearest other
    line is, inf where none is within the gap, `near` (complex128, n) the point there and `chord` (intp, n) the chord,
    -1 for none; `free` (bool, n) says whether it is further than the tolerance.
    """

    point: Complexes
    path: Ints
    distance: Floats
    near: Complexes
    chord: Ints
    free: Bools


def find_ends(chords: Chords, tolerance: float, gap: float) -> PathEnds:
    """The ends of paths, and what is near to them.

    An end's own path counts only where it comes back: further along it than three gaps, or half of its length. Raises
    DrawingError where too many lines are near to ends.
    """
    open_ = np.flatnonzero(~chords.ring)
    path = np.repeat(open_, 2)
    first, last = chords.first[open_], chords.first[open_ + 1] - 1
    point = np.stack((chords.start[first], chords.end[last]), axis=1).ravel()
    at = np.stack((np.zeros(len(open_)), chords.total[open_]), axis=1).ravel()
    nearest = np.full(len(point), np.inf)
    near, which = point.copy(), np.full(len(point), -1, np.intp)
    margin = complex(gap, gap)
    count = 0
    for end, chord in chord_search.chords_in(chords, point - margin, point + margin):
        count += len(end)
        if count > chord_search.CANDIDATES_MAX:
            raise chord_search.too_dense()
        start, way = chords.start[chord], chords.end[chord] - chords.start[chord]
        share = foot_share(point[end], start, chords.end[chord])
        foot = start + share * way
        distance = np.abs(foot - point[end])
        own = chords.path[chord] == path[end]
        along = np.abs(chords.before[chord] + share * chords.lengths[chord] - at[end])
        far = np.minimum(3 * gap, chords.total[path[end]] / 2)
        usable = np.flatnonzero((distance <= gap) & (~own | (along > far)))
        order = usable[np.lexsort((distance[usable], end[usable]))]
        ends = end[order]
        firsts = order[starts(ends)] if len(order) else order
        nearest[end[firsts]], near[end[firsts]], which[end[firsts]] = distance[firsts], foot[firsts], chord[firsts]
    return PathEnds(point, path, nearest, near, which, nearest > tolerance)

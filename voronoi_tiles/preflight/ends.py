"""Where paths end: at other lines, short of them or past them, or nowhere."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, starts
from voronoi_tiles.preflight import chord_search
from voronoi_tiles.preflight.chord_distance import foot_share
from voronoi_tiles.preflight.chords import Chords
from voronoi_tiles.preflight.contacts import Contacts

BESIDE: Final = 4.0
"""How far a path runs along another one from its end, for both to be side by side; in gaps, or half of its length."""

PAST: Final = 2.0
"""How far an end may run past the line that it meets, along its path; in gaps. It is within one gap of the line."""

_LOOKS: Final = 4  # places at which two paths are looked at for being side by side


class PathEnds(NamedTuple):
    """The ends of the paths that are no rings, beginnings and ends in turn.

    `point` is complex128 (n,), `path` (intp, n) whose end it is; `distance` (float64, n) is how far the nearest line
    is that it might have met, inf where none is within the gap, `near` (complex128, n) the point there and `chord`
    (intp, n) the chord, -1 for none. `free` (bool, n) says whether it is further than the tolerance, and `past`
    (float64, n) by how much it runs past a line that it meets, nan where it does not, at `met` (complex128, n).
    """

    point: Complexes
    path: Ints
    distance: Floats
    near: Complexes
    chord: Ints
    free: Bools
    past: Floats
    met: Complexes


class _NearEnds(NamedTuple):
    """Ends and chords that are near to them: how far, and the points of the chords."""

    end: Ints
    chord: Ints
    distance: Floats
    foot: Complexes

    def take(self, which: Ints | Bools) -> _NearEnds:
        """Some of the pairs."""
        return _NearEnds._make(column[which] for column in self)


def find_ends(chords: Chords, contacts: Contacts, tolerance: float, gap: float) -> PathEnds:
    """The ends of paths, and what is near to them.

    An end's own path counts only where it comes back: further along it than three gaps, or half of its length. A line
    beside which the path runs is none that its end should have met. Raises DrawingError where too many lines are near
    to ends.
    """
    open_ = np.flatnonzero(~chords.ring)
    path = np.repeat(open_, 2)
    first, last = chords.first[open_], chords.first[open_ + 1] - 1
    point = np.stack((chords.start[first], chords.end[last]), axis=1).ravel()
    at = np.stack((np.zeros(len(open_)), chords.total[open_]), axis=1).ravel()
    facing = _facing(chords, point, path, at, gap, gap)
    # The nearest chord of each path.
    order = np.lexsort((facing.distance, chords.path[facing.chord], facing.end))
    facing = facing.take(order)
    key = facing.end * len(chords.total) + chords.path[facing.chord]
    facing = facing.take(starts(key) if len(key) else order)
    facing = facing.take(~_beside(chords, facing, path, at, tolerance, gap))
    facing = facing.take(np.lexsort((facing.distance, facing.end)))
    facing = facing.take(starts(facing.end) if len(facing.end) else facing.end)
    nearest, near, which = np.full(len(point), np.inf), point.copy(), np.full(len(point), -1, np.intp)
    nearest[facing.end], near[facing.end], which[facing.end] = facing.distance, facing.foot, facing.chord
    past, met = _past(chords, contacts, path, which, gap)
    return PathEnds(point, path, nearest, near, which, nearest > tolerance, past, met)


def _facing(chords: Chords, point: Complexes, path: Ints, at: Floats, reach: float, gap: float) -> _NearEnds:
    """The chords within reach of points on paths; of their own path only where it comes back."""
    found = []
    margin = complex(reach, reach)
    count = 0
    for end, chord in chord_search.chords_in(chords, point - margin, point + margin):
        count += len(end)
        if count > chord_search.CANDIDATES_MAX:
            raise chord_search.too_dense()
        start, way = chords.start[chord], chords.end[chord] - chords.start[chord]
        share = foot_share(point[end], start, chords.end[chord])
        foot = start + share * way
        distance = np.abs(foot - point[end])
        along = np.abs(chords.before[chord] + share * chords.lengths[chord] - at[end])
        far = np.minimum(3 * gap, chords.total[path[end]] / 2)
        usable = (distance <= reach) & ((chords.path[chord] != path[end]) | (along > far))
        found.append(_NearEnds(end, chord, distance, foot).take(usable))
    if not found:
        none = np.zeros(0, np.intp)
        return _NearEnds(none, none, np.zeros(0), np.zeros(0, np.complex128))
    return _NearEnds(*(np.concatenate(column) for column in zip(*found, strict=True)))


def _beside(chords: Chords, facing: _NearEnds, path: Ints, at: Floats, tolerance: float, gap: float) -> Bools:
    """Whether the paths of ends run beside those that they face: no further away further along."""
    result = facing.distance > tolerance
    some = np.flatnonzero(result)
    of, other = path[facing.end[some]], chords.path[facing.chord[some]]
    limit = 1.5 * facing.distance[some] + tolerance
    length = np.minimum(BESIDE * gap, chords.total[of] / 2)
    inwards = np.where(at[facing.end[some]] == 0.0, 1.0, -1.0)
    for look in range(1, _LOOKS + 1):
        place = at[facing.end[some]] + inwards * length * (look / _LOOKS)
        point, _ = chords.along(of, place)
        around = _facing(chords, point, of, place, 1.5 * gap + tolerance, gap)
        least = np.full(len(some), np.inf)
        same = chords.path[around.chord] == other[around.end]
        np.minimum.at(least, around.end[same], around.distance[same])
        result[some] &= least <= limit
    return result


def _past(chords: Chords, contacts: Contacts, path: Ints, nearest: Ints, gap: float) -> tuple[Floats, Complexes]:
    """How far ends run past the line with the chord that is nearest to them, and where their paths meet it last."""
    past, met = np.full(len(path), np.nan), np.zeros(len(path), np.complex128)
    first_end = np.searchsorted(path, np.arange(len(chords.total)))
    for one, other, here, there in (
        (contacts.one, contacts.two, contacts.at_one, contacts.at_two),
        (contacts.two, contacts.one, contacts.at_two, contacts.at_one),
    ):
        own = chords.path[one]
        tail = np.minimum(PAST * gap, chords.total[own] / 2)
        back = np.abs(here - there) > np.minimum(3 * gap, chords.total[own] / 2)
        for last in (0, 1):
            far = np.abs(here - np.where(last, chords.total[own], 0.0))
            some = np.flatnonzero(~chords.ring[own] & (far <= tail) & ((own != chords.path[other]) | back))
            some = some[np.argsort(-far[some], kind="stable")]
            end = first_end[own[some]] + last
            # What the path meets before, another line than the one that its end is near to, leaves the gap open.
            last_met = (nearest[end] >= 0) & (chords.path[nearest[end]] == chords.path[other[some]])
            last_met &= ~(past[end] <= far[some])
            past[end[last_met]], met[end[last_met]] = far[some][last_met], contacts.point[some][last_met]
    return past, met

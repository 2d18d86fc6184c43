"""Necks: places where two cut lines face each other across less than a limit."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, plane, ranges
from voronoi_tiles.preflight.chord_distance import Nearest, distinct, divisor, dot, nearest, runs
from voronoi_tiles.preflight.chord_search import FOUND_MAX, pairs, too_dense, too_many
from voronoi_tiles.preflight.chords import Chords, lines, polygons
from voronoi_tiles.preflight.contacts import run_beside

_APPROACH: Final = 1e-6
"""By how much of its length a line may come nearer to be still parallel; no unit. Rounding leaves 1e-10."""

_ASIDE: Final = 0.1
"""The cosine of the angle at which a line ends beside another one, from which on it is not parallel."""

_REMEDY: Final = "Split the drawing, or look for narrower necks, or for none: `neck=0`."

_WAYS: Final = 4_000_000  # lines that leave points, looked at at once
_WAYS_MAX: Final = 200_000_000  # and altogether


class Neck(NamedTuple):
    """A narrow place: its middle, its width, the paths on both sides, and whether material is between.

    With `loose` it is beside the loose end of a line.
    """

    place: complex
    width: float
    paths: tuple[int, int]
    material: bool
    loose: bool


class _Facing(NamedTuple):
    """Pairs of chords, and where they are nearest."""

    one: Ints
    two: Ints
    near: Nearest

    def take(self, which: Bools) -> _Facing:
        """Some of the pairs."""
        return _Facing(self.one[which], self.two[which], self.near.take(which))


def find_necks(chords: Chords, touching: float, limit: float) -> list[Neck]:
    """Where lines face each other across less than `limit` and more than `touching`, each narrow place once.

    A place is narrow where the distance between two lines is at its least, or stays the same: no line that leaves
    either point comes nearer to the other one. So a corner, however sharp, is none. Between lines there is material
    inside a piece; where lines share points, as in files that cut every edge once, and beside open ones, everywhere.
    Raises DrawingError where too many chords are so near.
    """
    joints = _Joints(chords)
    found = []
    count = 0
    for one, two in pairs(chords, limit, _REMEDY):
        near = nearest(chords, one, two)
        some = _Facing(one, two, near).take((near.distance < limit) & (near.distance > touching))
        some = some.take(joints.is_least(some.one, some.near.share_one, some.near.one, some.near.two))
        some = some.take(joints.is_least(some.two, some.near.share_two, some.near.two, some.near.one))
        some = some.take(_overlap_at_ends(chords, joints, some, limit))
        some = some.take(_see_each_other(chords, some.near))
        count += len(some.one)
        if count > FOUND_MAX:
            raise too_many("face each other across a neck", _REMEDY)
        found.append(some)
    if not count:
        return []
    one, two = (np.concatenate([part[k] for part in found]) for k in (0, 1))
    near = Nearest.concatenate([part.near for part in found])
    return _narrowest(chords, one, two, near, limit, joints)


def _narrowest(chords: Chords, one: Ints, two: Ints, near: Nearest, limit: float, joints: _Joints) -> list[Neck]:
    """The least of each run of narrow places."""
    at = chords.before[one] + near.share_one * chords.lengths[one]
    low, high = run_beside(chords, one, two, limit)
    beside = high > low
    low, high = (np.where(beside, chords.before[one] + bound, at) for bound in (low, high))
    order, begins = runs(chords.path[one], chords.path[two], low, high, limit)
    group = np.repeat(np.arange(len(begins)), np.diff(np.append(begins, len(order))))
    best = order[np.lexsort((near.distance[order], group))[begins]]
    middle = (near.one[best] + near.two[best]) / 2
    material = np.ones(len(middle), np.bool_) if joints.shared else _is_material(chords, middle)
    loose = (joints.is_loose(one, near.share_one) | joints.is_loose(two, near.share_two))[best]
    necks = [
        Neck(
            complex(place),
            float(near.distance[k]),
            (int(chords.path[one[k]]), int(chords.path[two[k]])),
            bool(solid),
            bool(end),
        )
        for k, place, solid, end in zip(best.tolist(), middle, material, loose, strict=True)
    ]
    necks.sort(key=lambda neck: neck.width)
    places = np.array([neck.place for neck in necks])
    return [necks[k] for k in sorted(distinct([neck.paths for neck in necks], places, limit))]


class _Joints:
    """The chords that leave each point where chords meet, whatever paths they are of."""

    def __init__(self, chords: Chords) -> None:
        points = np.concatenate((chords.start, chords.end))
        # Points that are equal to a nanometre are one; lines that are joined have the same bits, or a writer's digits.
        grid = np.round(plane(points) / 1e-6).view(np.complex128)[:, 0]
        _, joint = np.unique(grid, return_inverse=True)
        self._of_start, self._of_end = joint[: len(chords.start)], joint[len(chords.start) :]
        way = chords.end - chords.start
        unit = way / divisor(chords.lengths)
        leaving = np.concatenate((unit, -unit))
        path = np.tile(chords.path, 2)
        order = np.argsort(joint, kind="stable")
        same = joint[order][1:] == joint[order][:-1]
        self.shared = bool((same & (path[order][1:] != path[order][:-1])).any())
        """Whether different paths share a point."""
        self._ways = leaving[order]
        self._counts = np.bincount(joint)
        self._first = np.cumsum(self._counts) - self._counts
        self._looked = 0

    def is_least(self, chord: Ints, share: Floats, point: Complexes, other: Complexes) -> Bools:
        """Whether no line that leaves a point comes nearer to the other one."""
        result = np.ones(len(chord), np.bool_)
        ends = np.flatnonzero((share == 0.0) | (share == 1.0))
        if not len(ends):
            return result
        joint = np.where(share[ends] == 0.0, self._of_start[chord[ends]], self._of_end[chord[ends]])
        so_far = np.cumsum(self._counts[joint])
        self._looked += int(so_far[-1])
        if self._looked > _WAYS_MAX:
            raise too_dense(_REMEDY)
        portions = np.flatnonzero(np.diff(so_far // _WAYS)) + 1
        for some, at in zip(np.split(ends, portions), np.split(joint, portions), strict=True):
            result[some] = self._is_nearest(at, other[some] - point[some])
        return result

    def is_loose(self, chord: Ints, share: Floats) -> Bools:
        """Whether points on chords are ends at which nothing else begins."""
        joint = np.where(share == 0.0, self._of_start[chord], self._of_end[chord])
        return np.asarray(((share == 0.0) | (share == 1.0)) & (self._counts[joint] == 1), np.bool_)

    def _is_nearest(self, joint: Ints, towards: Complexes) -> Bools:
        """Whether no line that leaves a joint goes that way."""
        counts = self._counts[joint]
        ways = self._ways[ranges(self._first[joint], counts)]
        along = dot(ways, np.repeat(towards / np.abs(towards), counts))
        first = np.cumsum(counts) - counts
        # A loose end is no neck, but an end that should have met something; unless it lies beside the other line.
        meant = (counts > 1) | (np.abs(along[first]) < _ASIDE)
        return np.asarray(~np.logical_or.reduceat(along > _APPROACH, first) & meant, np.bool_)


def _overlap_at_ends(chords: Chords, joints: _Joints, some: _Facing, limit: float) -> Bools:
    """Whether lines run beside each other further than they are apart, where one of them ends there."""
    loose = joints.is_loose(some.one, some.near.share_one) | joints.is_loose(some.two, some.near.share_two)
    low, high = run_beside(chords, some.one, some.two, limit)
    return ~loose | (high - low > some.near.distance)


def _see_each_other(chords: Chords, near: Nearest) -> Bools:
    """Whether no other line is between the two points."""
    seen = np.ones(len(near.one), np.bool_)
    if not len(seen):
        return seen
    inner = 1e-3 * (near.two - near.one)
    between = lines(near.one + inner, near.two - inner)
    # The nearest line alone: all that are between may be thousands for each.
    (view, _), distance = chords.tree.query_nearest(between, return_distance=True, all_matches=False)
    seen[view[distance == 0.0]] = False
    return seen


def _is_material(chords: Chords, place: Complexes) -> Bools:
    """Whether places are inside a piece, within an odd number of the rings; beside lines that are no rings all is."""
    rings = np.flatnonzero(np.diff(chords.first) >= 3)
    if not chords.ring.all() or not len(rings):
        return np.ones(len(place), np.bool_)
    tree = shapely.STRtree(polygons(chords, rings))
    inside, _ = tree.query(shapely.points(place.real, place.imag), predicate="within")
    return np.asarray(np.bincount(inside, minlength=len(place)) % 2 == 1, np.bool_)

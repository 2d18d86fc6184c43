"""The raw offset of rings: every segment moved sideways and corners joined, before self-overlaps are removed.

Along a curve z with the unit tangent t and the curvature k (> 0 where it turns left) the offset by d to the right is
z - i d t. As t' = i k t, its derivative is (1 + d k) t: it has the curve's own tangents, and is 1 + d k times as long.
So the offset of a line is a line, that of an arc an arc of the same turn about the same centre. Where 1 + d k < 0 the
centre is nearer than d on the right, and the offset runs backwards.

Sources: Farouki, Neff, Analytic properties of plane offset curves, Comput. Aided Geom. Des. 7 (1990). Liu, Yong, Zheng,
Sun, An offset algorithm for polyline curves, Comput. Ind. 58 (2007), make the offsets of lines and arcs in these steps;
they trim neighbours where they cross, here all that cross are cut together afterwards (arrangement.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, next_in_ring
from voronoi_tiles.base.components import components
from voronoi_tiles.paths.paths import ARC, Kinds, Paths
from voronoi_tiles.paths.segments import Circles, point_at, tangent_at
from voronoi_tiles.paths.short_segments import straightened

_CUSP: Final = 1e-6
"""A corner that turns by less than this short of half a circle is a cusp, whose side its curvatures tell; radians."""

_ENDS: Final = 1 / 16
"""How far the ends of segments are known, a part of the tolerance: some 16 ulps of the coordinates."""


@dataclass(frozen=True, eq=False)
class RawOffset:
    """Segments at a distance from rings, in no order; overlaps and dead ends among them.

    `paths` has every segment as a path of its own. Segment k runs from the node `tail[k]` to the node `head[k]` (intp),
    whose places are `nodes` (complex128), with the bits of the segment's ends. It comes from the region's segment
    `source[k]`, or where `joins[k]`, from the corner at that segment's end.
    """

    paths: Paths
    tail: Ints
    head: Ints
    nodes: Complexes
    source: Ints
    joins: Bools


def raw_offset(region: Paths, distance: float, tolerance: float) -> RawOffset:
    """The raw offset of closed rings of LINEs and ARCs by `distance`, > 0 to the right.

    A segment that would run backwards is left out: none of its points is at the distance from the whole region. What
    the rounding of coordinates cannot tell from a point, or from no corner, is taken for one, where that moves nothing
    sideways by more than `tolerance`. Corners that open become arcs about the corner.
    """
    moved = _Moved.of(region, distance)
    following = next_in_ring(region.offsets)
    points = moved.points(distance, tolerance)
    angle = _corner_angles(moved, following)
    smooth = _smooth(moved, following, angle, distance, tolerance)
    # The nodes are the moved ends, first and last of each segment; those that are one stand in the middle of all.
    first, last = 2 * np.arange(len(points)), 2 * np.arange(len(points)) + 1
    one, other = np.concatenate((first[points], last[smooth])), np.concatenate((last[points], first[following[smooth]]))
    ends = np.column_stack((moved.start, moved.end)).ravel()
    name = components(len(ends), one, other)
    nodes = _means(ends, name)[name]

    kept = np.flatnonzero(~points & (moved.stretch >= 0))
    opening = np.flatnonzero((angle * distance > 0) & ~smooth)
    halfway = region.end[opening] - 1j * distance * moved.arriving[opening] * np.exp(0.5j * angle[opening])
    tail = np.concatenate((first[kept], last[opening]))
    head = np.concatenate((last[kept], first[following[opening]]))
    middle = np.concatenate((moved.middle[kept], halfway))
    kind = np.concatenate((region.kind[kept], np.full(len(opening), ARC, np.uint8)))
    return RawOffset(
        paths=straightened(_open(nodes[tail], nodes[head], middle, kind), tolerance / 64),
        tail=name[tail],
        head=name[head],
        nodes=nodes,
        source=np.concatenate((kept, opening)),
        joins=np.repeat([False, True], [len(kept), len(opening)]),
    )


@dataclass(frozen=True, eq=False)
class _Moved:
    """The n segments of rings after each was moved sideways.

    `start`, `middle` and `end` (complex128, n) are where they lie; the tangents at the ends, `leaving` and `arriving`,
    are those before. `chord` and `curvature` are from before, `turn` is the angle by which each turns left, before and
    after; `stretch` is how many times as long each has become, < 0 where it runs backwards.
    """

    start: Complexes
    middle: Complexes
    end: Complexes
    leaving: Complexes
    arriving: Complexes
    chord: Floats
    curvature: Floats
    turn: Floats
    stretch: Floats

    @classmethod
    def of(cls, region: Paths, distance: float) -> _Moved:
        """Move all segments of a region."""
        n = len(region.start)
        everything = np.arange(n)
        circles = Circles.of(region, everything)
        leaving, along, arriving = (tangent_at(region, everything, np.full(n, t)) for t in (0.0, 0.5, 1.0))
        return cls(
            start=region.start - 1j * distance * leaving,
            middle=point_at(region, everything, np.full(n, 0.5)) - 1j * distance * along,
            end=region.end - 1j * distance * arriving,
            leaving=leaving,
            arriving=arriving,
            chord=np.abs(circles.chord),
            curvature=circles.curvature,
            turn=np.abs(2 * circles.half),
            stretch=1 + distance * circles.curvature,
        )

    @property
    def bend(self) -> Floats:
        """The curvature of each moved segment, without its sign."""
        return np.abs(self.curvature / np.where(self.stretch == 0, 1.0, self.stretch))

    def points(self, distance: float, tolerance: float) -> Bools:
        """Which segments cannot be told from points.

        The ends of a segment are known to _ENDS of the tolerance, and so its direction to that over its chord: the ends
        of its offset are as uncertain as this makes them, at a radius of the distance. One that is no longer is a
        point. So is one that runs backwards by a length L while it turns by a: its neighbours go on along its tangents,
        past each other, and cross at the angle a. Taken to end in the middle between its ends, they are moved sideways
        by less than L a.
        """
        length = np.abs(self.stretch) * self.chord
        none = length <= tolerance * (1 + abs(distance) / np.maximum(self.chord, tolerance) * _ENDS)
        return none | ((self.stretch < 0) & (length * self.turn <= tolerance))


def _corner_angles(moved: _Moved, following: Ints) -> Floats:
    """How far the corner after each segment turns to the left; in (-pi, pi], radians.

    At a cusp the inside is between the two curves where the one that arrives is on the left of the one that leaves.
    """
    angle = np.angle(moved.leaving[following] * moved.arriving.conj())
    cusp = np.abs(angle) > np.pi - _CUSP
    left = moved.curvature + moved.curvature[following] <= 0
    return np.where(cusp, np.where(left, np.abs(angle), -np.abs(angle)), angle)


def _smooth(moved: _Moved, following: Ints, angle: Floats, distance: float, tolerance: float) -> Bools:
    """Which corners, the one after each segment, cannot be told from none.

    At a corner that turns by a the moved ends are d a apart, along the tangents of both. Where they are taken to meet
    in the middle, they slide along by half of it, and leave their curves: one tangent leaves the other by d a^2 at
    most, and a curve of the curvature k its tangent by k (d a)^2 / 2.
    """
    apart = np.abs(distance * angle)
    bend = np.maximum(moved.bend, moved.bend[following])
    return (apart <= tolerance) | ((apart * np.abs(angle) <= tolerance) & (apart**2 * bend / 2 <= tolerance))


def _open(start: Complexes, end: Complexes, middle: Complexes, kind: Kinds) -> Paths:
    """Segments, each a path of its own; those that are ARCs have these middles."""
    n = len(start)
    control = np.column_stack((np.where(kind == ARC, middle, 0), np.zeros(n)))
    return Paths(start, end, control, kind, np.arange(n + 1), np.zeros(n, np.bool_))


def _means(values: Complexes, name: Ints) -> Complexes:
    """The mean of the values of one name, at the place of the name."""
    total = np.bincount(name, values.real, len(values)) + 1j * np.bincount(name, values.imag, len(values))
    return np.asarray(total / np.maximum(np.bincount(name, minlength=len(values)), 1), np.complex128)

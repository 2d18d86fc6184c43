"""Offsets of regions with lines and arcs for edges: kerf compensation, and rounded corners; exact but for rounding.

The offset of a line is a line, that of an arc an arc about the same centre. All segments are moved, corners joined, and
everything cut where it crosses; what is nearer to the region's edge than the distance goes, the rest is chained.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, next_in_ring, ranges
from voronoi_tiles.base.box_index import BoxIndex
from voronoi_tiles.base.errors import VoronoiTilesError
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.arrangement import arrangement, without_doubles
from voronoi_tiles.paths.chaining import built, chained, without_dead_ends
from voronoi_tiles.paths.offset_events import Lost, losses
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.paths.raw_offset import raw_offset
from voronoi_tiles.paths.segments import Circles, boxes, corners, point_at
from voronoi_tiles.paths.short_segments import straightened, without_points

OFFSET_ULPS: Final = 256.0
"""How far an offset may be from its distance; ulps of the largest coordinate: some ten rounded operations, and
corners that are left out because they would move no point by more."""

_RETRIES: Final = (0.0, 1e-9, 3e-9, -1e-9, -3e-9)
"""Changes of the distance that are tried in turn, relative to it. Longer ones first: of walls exactly twice the
distance apart they leave nothing, shorter ones a sliver."""

_CHUNK: Final = 16384
"""Points whose distances are measured at once; a count. Bounds the memory."""


class OffsetError(VoronoiTilesError, ArithmeticError):
    """An offset that failed its own check: `message`, without a full stop, and the place, in the region's units."""

    exit_code: ClassVar[int] = 1

    def __init__(self, message: str, place: complex) -> None:
        super().__init__(message, place)
        self.message = message
        self.place = complex(place)

    def __str__(self) -> str:
        return f"{self.message} at ({self.place.real:.6g}, {self.place.imag:.6g})."


class OffsetFeet(NamedTuple):
    """Of each segment of an offset where on the region's edge what it is the offset of lies.

    That is the region's segment `segment` (intp, n), between the shares `share` (float64, n x 2) of it: from 0 to 1,
    and from 1 to 2 of the turn in the corner at its end.
    """

    segment: Ints
    share: Floats


@dataclass(frozen=True, eq=False)
class Offset:
    """A region's offset: closed rings of LINEs and ARCs, and what of the region was lost on the way.

    Outer rings run counter-clockwise, holes clockwise. `feet` is None where more was done than a single offset.
    """

    paths: Paths
    lost: tuple[Lost, ...]
    feet: OffsetFeet | None = None


def offset(region: Paths, distance: float) -> Offset:
    """The region grown by `distance` > 0, or shrunk by -`distance` where it is < 0.

    `region` has closed rings of LINEs and ARCs that neither cross nor touch, the material on their left: outer ones
    counter-clockwise, holes clockwise; those of no length do not count. Corners on the growing side become arcs about
    the corner. Self-overlaps are removed between all parts and rings. The edge of the result is at the distance from
    the region's to OFFSET_ULPS, checked at the end; where the check fails, the distance is changed by up to 3e-9 of
    itself. Raises ValueError for other segments or open paths, OffsetError where no change helps.
    """
    _check_region(region, distance)
    long, region = np.flatnonzero(region.start != region.end), without_points(region)
    if distance == 0 or not len(region):
        return Offset(region, (), OffsetFeet(long, np.tile([0.0, 1.0], (len(long), 1))))
    failure: OffsetError | None = None
    for change in _RETRIES:
        try:
            result, feet = _Attempt(region, distance * (1 + change)).result()
            return replace(result, feet=OffsetFeet(long[feet.segment], feet.share))
        except OffsetError as error:
            failure = failure or error
    assert failure is not None
    raise failure


def round_corners(region: Paths, radius: float) -> Offset:
    """The region with all corners rounded by arcs of the radius that touch both sides.

    What sticks out is rounded by shrinking and growing, then what goes in by growing and shrinking. Parts that are too
    thin for the radius vanish, gaps that are too narrow close: they are listed. Raises as `offset`.
    """
    if radius < 0:
        raise ValueError("a radius cannot be negative")
    lost: tuple[Lost, ...] = ()
    for distance in (-radius, radius, radius, -radius):
        step = offset(region, distance)
        region, lost = step.paths, lost + step.lost
    return Offset(region, lost)


def _check_region(region: Paths, distance: float) -> None:
    if not np.isin(region.kind, (LINE, ARC)).all():
        raise ValueError("only rings of lines and arcs can be offset")
    if not region.closed.all():
        raise ValueError("only closed rings can be offset")
    if not np.isfinite(distance):
        raise ValueError("a distance must be a finite number")


class _Attempt:
    """One offset by one distance, unless it fails its check."""

    def __init__(self, region: Paths, distance: float) -> None:
        self.distance = distance
        size = max(float(np.abs([region.start, region.end]).max()), abs(distance))
        self.tolerance = OFFSET_ULPS * EPSILON * size
        self.region = region = straightened(region, self.tolerance / 64)
        self.circles = Circles.of(region, np.arange(len(region.start)))
        self.index = BoxIndex(*corners(boxes(region)))
        # Curves that touch or cross at small angles are apart by the tolerance over this length.
        self.blurred = 16 * float(np.sqrt(self.tolerance * size))

    def result(self) -> tuple[Offset, OffsetFeet]:
        """The offset, and its feet; raises OffsetError."""
        raw = raw_offset(self.region, self.distance, self.tolerance)
        parts = arrangement(raw.paths, raw.tail, raw.head, raw.nodes, self.tolerance)
        middle = point_at(raw.paths, parts.segment, (parts.t0 + parts.t1) / 2)
        far = self._nearest(middle) >= abs(self.distance) - self.tolerance
        single = without_doubles(parts, raw.paths, far, self.tolerance)
        used = without_dead_ends(parts, single)
        length = raw.paths.lengths[parts.segment] * (parts.t1 - parts.t0)
        astray = np.flatnonzero(single & ~used & (length > self.blurred))
        if len(astray):
            raise OffsetError("the offset has an open end", middle[astray[0]])
        try:
            rings = chained(parts, raw.paths, used)
        except LookupError as error:
            raise OffsetError("the offset has a ring that does not close", middle[error.args[0]]) from None
        paths, first, last = built(parts, raw.paths, rings, self.tolerance / 64)
        solid = np.flatnonzero(np.abs(ring_areas(paths)) > 4 * self.tolerance * paths.path_lengths)
        here = ranges(paths.offsets[solid], paths.counts[solid])
        first, last = first[here], last[here]
        paths, rings = paths.take(solid), [rings[k] for k in solid.tolist()]
        self._verify(paths)
        moved = parts.segment[first]
        share = np.column_stack((parts.t0[first], parts.t1[last])) + raw.joins[moved][:, None]
        lost = losses(self.region, self.distance, raw, parts, rings)
        return Offset(paths, lost), OffsetFeet(raw.source[moved], share)

    def _nearest(self, points: Complexes, beyond: float = 0.0) -> Floats:
        """The distance of each point from the region's edge; infinite where it is more than the offset's + `beyond`."""
        nearest = np.full(len(points), np.inf)
        reach = complex(1, 1) * (abs(self.distance) + beyond)
        for k in range(0, len(points), _CHUNK):
            chunk = points[k : k + _CHUNK]
            i, j = self.index.meeting(chunk - reach, chunk + reach)
            np.minimum.at(nearest, k + i, self.circles.take(j).distance(chunk[i]))
        return nearest

    def _verify(self, paths: Paths) -> None:
        """Raise OffsetError where a ring is open or a point of it is not at the distance."""
        if not len(paths):
            return
        gaps = np.flatnonzero(paths.end != paths.start[next_in_ring(paths.offsets)])
        if len(gaps):
            raise OffsetError("the offset has a ring that does not close", paths.end[gaps[0]])
        n = len(paths.start)
        for t in (0.0, 0.25, 0.5, 0.75):
            points = point_at(paths, np.arange(n), np.full(n, t))
            off = np.abs(self._nearest(points, 8 * self.tolerance) - abs(self.distance))
            wrong = np.flatnonzero(off > 4 * self.tolerance)
            if len(wrong):
                raise OffsetError("the offset is not at its distance", points[wrong[0]])

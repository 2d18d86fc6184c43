"""Outlines that are their own mirror images: about which axes they nearly are, and what is one exactly."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from itertools import islice
from typing import Final, NamedTuple

import numpy as np
import shapely
from scipy import optimize
from shapely.geometry import LineString, Polygon, box

from voronoi_tiles.base.arrays import Complexes, from_plane, plane
from voronoi_tiles.escherization.goal_outline import GoalOutline, largest_part, ring_corners
from voronoi_tiles.escherization.group_placement import GroupPlacement
from voronoi_tiles.escherization.outline_distance import overlap

MIRRORED: Final = 0.96
"""The least overlap of an outline with its mirror image at which it is taken for its own: an area over an area.
Corners that are off by a hundredth of the size leave about so much."""

_DIRECTIONS: Final = 90
"""How many axes through the centroid are looked at first, every 2 degrees; a count."""

_ROUGH: Final = 0.02
"""How far corners that are left out lie from the outline there; relative to its size."""

_ROUGH_LOSS: Final = 0.1
"""How much less like its image an outline may be of fewer corners, about the nearest of these axes; an overlap."""

_ON_AXIS: Final = 1e-9
"""Corners so near to the axis are on it; relative to how far corners lie from its point."""


@dataclass(frozen=True)
class MirrorAxis:
    """A line in the plane, through a point in a direction, a complex number of absolute value 1."""

    through: complex
    direction: complex

    @property
    def angle(self) -> float:
        """The direction in radians."""
        return cmath.phase(self.direction)

    def placed(self, placement: GroupPlacement) -> MirrorAxis:
        """The axis of an outline, which goes through its centroid, where that lies in a cell."""
        return MirrorAxis(placement.centre, self.direction * cmath.exp(1j * placement.turn))

    def seen(self, points: Complexes) -> Complexes:
        """Points as they are seen from the axis: along it, and to its left."""
        return np.asarray((points - self.through) * self.direction.conjugate())

    def mirrored(self, points: Complexes) -> Complexes:
        """The mirror images of points."""
        return np.asarray(self.seen(points).conj() * self.direction + self.through)

    def left_half(self, outline: Polygon) -> Complexes | None:
        """The corners that an outline has left of the axis, as seen from it, the first and the last on the axis.

        A closed line that is its own mirror image crosses the axis twice. None of what lies on one side, or is empty.
        """
        seen = self.seen(ring_corners(outline.exterior))
        far = 2.0 * float(np.abs(seen).max(initial=0.0))
        ring = ring_corners(largest_part(Polygon(plane(seen)).intersection(box(-far, 0.0, far, far))).exterior)
        on = np.abs(ring.imag) <= _ON_AXIS * far
        # The longest side on the axis is the cut.
        cut = np.where(on & np.roll(on, -1), np.abs(np.roll(ring, -1) - ring), 0.0)
        if not cut.any():
            return None
        chain = np.roll(ring, -1 - int(np.argmax(cut)))
        chain[[0, -1]] = chain[[0, -1]].real
        return chain

    def completed(self, half: Complexes, tolerance: float = 0.0) -> Complexes:
        """The corners of the outline whose left half is given: n corners, the k-th the mirror image of the (n - k)-th.

        Corners of the half that lie within a tolerance of it without them are left out.
        """
        half = from_plane(shapely.get_coordinates(LineString(plane(half)).simplify(tolerance)))
        return np.asarray(np.concatenate((half, half[-2:0:-1].conj())) * self.direction + self.through)


class MirroredOutline(NamedTuple):
    """An outline that is its own mirror image about an axis, and nearly a given one."""

    silhouette: GoalOutline
    axis: MirrorAxis

    @classmethod
    def of(cls, given: GoalOutline, axis: MirrorAxis) -> MirroredOutline | None:
        """Of one half of a given outline and its mirror image: of that half with which it overlaps more.

        None where that crosses itself.
        """
        found: list[GoalOutline] = []
        for each in (axis, MirrorAxis(axis.through, -axis.direction)):
            half = each.left_half(given.polygon)
            if half is None:
                continue
            whole = GoalOutline(each.completed(half, _ON_AXIS * given.size))
            if whole.polygon.is_valid:
                ccw = whole.polygon.exterior.is_ccw
                found.append(whole if ccw else GoalOutline(whole.points[::-1]))
        if not found:
            return None
        return cls(max(found, key=lambda each: overlap(each.polygon, given.polygon)), axis)


def mirrored_outlines(given: GoalOutline) -> list[MirroredOutline]:
    """What an outline is nearly, that is its own mirror image: one for each kind of its axes.

    Of several axes every second one is of the same kind, as those of a star: there are two at most.
    """
    led = (_led_axis(given, angle) for angle, like in _rough_axes(given) if like >= MIRRORED - _ROUGH_LOSS)
    axes = islice((axis for axis, like in led if like >= MIRRORED), 2)
    return [outline for axis in axes if (outline := MirroredOutline.of(given, axis)) is not None]


def likeness(given: GoalOutline) -> float:
    """The largest overlap of an outline with one of its mirror images; at most 1."""
    rough = _rough_axes(given)
    least = min(MIRRORED - _ROUGH_LOSS, max(like for _, like in rough))
    return max(_led_axis(given, angle)[1] for angle, like in rough if like >= least)


def _rough_axes(given: GoalOutline) -> list[tuple[float, float]]:
    """The angles of axes about which an outline is more like its mirror image than about those beside, and how much."""
    rough = GoalOutline(ring_corners(given.polygon.simplify(_ROUGH * given.size).exterior))
    angles = np.arange(_DIRECTIONS) * math.pi / _DIRECTIONS
    seen = np.array([_likeness(rough, _axis(rough, angle, 0.0)) for angle in angles.tolist()])
    peaks = np.flatnonzero((seen >= np.roll(seen, 1)) & (seen > np.roll(seen, -1)))
    chosen = peaks if len(peaks) else [int(np.argmax(seen))]
    return [(float(angles[k]), float(seen[k])) for k in chosen]


def _axis(outline: GoalOutline, angle: float, offset: float) -> MirrorAxis:
    """The axis at an angle, so far left of the centroid."""
    direction = cmath.exp(1j * angle)
    return MirrorAxis(outline.centroid + 1j * direction * offset, direction)


def _likeness(outline: GoalOutline, axis: MirrorAxis) -> float:
    """The overlap of an outline and its mirror image; at most 1."""
    return overlap(outline.polygon, Polygon(plane(axis.mirrored(outline.points))))


def _led_axis(outline: GoalOutline, angle: float) -> tuple[MirrorAxis, float]:
    """The axis near to an angle about which an outline is most like its mirror image, and how much."""
    size = outline.size
    led = optimize.minimize(
        lambda row: -_likeness(outline, _axis(outline, row[0], row[1] * size)),
        [angle, 0.0],
        method="Nelder-Mead",
        options={"initial_simplex": [[angle, 0.0], [angle + 0.02, 0.0], [angle, 0.01]], "xatol": 1e-7, "fatol": 1e-7},
    )
    return _axis(outline, float(led.x[0]), float(led.x[1]) * size), -float(led.fun)

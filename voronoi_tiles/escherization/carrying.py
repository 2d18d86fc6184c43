"""A displacement that an outline's points are given, carried to whatever lies about the outline.

A drawing's outline becomes a tile that is a little different; its eyes and feathers have to go with it. On the outline
the displacement is the given one, within it is interpolated by mean value coordinates, and it fades with the distance
from the outline.

Sources: Hormann and Floater, Mean value coordinates for arbitrary planar polygons, ACM Trans. Graph. 25 (2006). The sum
of their weights is the mean over all directions of the reciprocal distance of the outline, so that its reciprocal is a
distance that is smooth where the nearest point of the outline jumps: Dyken and Floater, Transfinite mean value
interpolation, Comput. Aided Geom. Des. 26 (2009); Belyaev, Fayolle and Pasko, Signed Lp-distance fields, Comput.-Aided
Des. 45 (2013).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, Self

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats
from voronoi_tiles.base.errors import ArgumentError

_PAIRS: Final = 1 << 17
"""Pairs of a point and an outline's point that are worked on at once; a count. The processor's cache holds them."""

_ON_EDGE: Final = 1e-13
"""A point lies on an edge where the sine of the angle that it sees it at is smaller; rounding leaves 1e-16."""

STEP: Final = 1e-5
"""The step of differences, relative to the reach: their error, of second order, and the rounding's are both 1e-10."""


@dataclass(frozen=True, eq=False)
class Carrying:
    """A map of the plane that moves an outline's points as given, and leaves alone what is far from it.

    `outline` are the corners of a simple polygon (complex128, n), `displacement` is how each of them moves; on the
    edges between it is linear. Beside a straight edge what is moved ends at the distance `reach`; where the outline is
    near on several sides, as in a leg or a beak, it goes with all of them, and nothing farther off than pi times
    `reach` is moved. The map is continuous, and smooth but on the outline. It keeps the orientation where
    displacements that change slowly along the outline are a quarter of `reach` at most; `keeps_orientation` tells of
    others.
    """

    outline: Complexes
    displacement: Complexes
    reach: float

    @classmethod
    def of(cls, outline: Complexes, displacement: Complexes, reach: float) -> Self:
        """The map of an outline's points and their displacements.

        Raises ArgumentError where there are less than three points or not as many displacements, numbers are not
        finite, or the reach is not positive.
        """
        outline, displacement = np.asarray(outline, np.complex128), np.asarray(displacement, np.complex128)
        if outline.ndim != 1 or outline.shape != displacement.shape or len(outline) < 3:
            raise ArgumentError(
                f"an outline of the shape {outline.shape} with displacements of the shape {displacement.shape}",
                remedy="Give at least three points, and one displacement for each.",
            )
        if not (np.isfinite(outline).all() and np.isfinite(displacement).all()):
            raise ArgumentError("a point or a displacement is not finite")
        if not (math.isfinite(reach) and reach > 0.0):
            raise ArgumentError(f"a reach of {reach!r}", remedy="Give a length above 0.")
        return cls(outline, displacement, float(reach))

    def __call__(self, points: Complexes) -> Complexes:
        """Where points are carried, complex128 of any shape."""
        return points + self.shift(points)

    def shift(self, points: Complexes) -> Complexes:
        """How points are displaced, complex128 of any shape; exactly 0 where nothing moves."""
        points = np.asarray(points, np.complex128)
        flat = points.ravel()
        result = np.zeros(len(flat), np.complex128)
        near = np.flatnonzero(self._may_move(flat))
        for some in self._portions(len(near)):
            rows = near[some]
            result[rows] = self._portion(flat[rows])
        return result.reshape(points.shape)

    def derivative(self, points: Complexes, direction: Complexes) -> Complexes:
        """The image of directions at points under the map's derivative, by differences over STEP; any shape."""
        length = np.abs(direction)
        with np.errstate(invalid="ignore", divide="ignore"):
            unit = np.where(length > 0.0, direction / length, 0.0)
        step = STEP * self.reach * unit
        change = (self.shift(points + step) - self.shift(points - step)) / (2 * STEP * self.reach)
        return np.asarray(direction + change * length)

    def keeps_orientation(self, points: Complexes) -> Bools:
        """Whether the map keeps the orientation at points: where it does not, a drawing would be folded."""
        along, across = (self.derivative(points, np.full(np.shape(points), unit)) for unit in (1.0 + 0j, 1j))
        return np.asarray((along.conj() * across).imag > 0.0)

    def _may_move(self, points: Complexes) -> Bools:
        """Points that are within pi times the reach of the outline's bounding box."""
        x, y, margin = self.outline.real, self.outline.imag, math.pi * self.reach
        across = (points.real >= x.min() - margin) & (points.real <= x.max() + margin)
        return np.asarray(across & (points.imag >= y.min() - margin) & (points.imag <= y.max() + margin))

    def _portions(self, count: int) -> Iterator[slice]:
        """Parts of so many points that are worked on at once."""
        size = max(1, _PAIRS // len(self.outline))
        return (slice(first, first + size) for first in range(0, count, size))

    def _portion(self, points: Complexes) -> Complexes:
        """The displacements of a few points."""
        seen = self.outline - points[:, None]
        ahead = np.roll(seen, -1, axis=1)
        distance = np.abs(seen)
        both = distance * np.roll(distance, -1, axis=1)
        product = seen.conj() * ahead
        cosine, sine = product.real, product.imag
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            # The tangent of half the angle of an edge, without cancellation.
            tangent = np.where(cosine >= 0.0, sine / (both + cosine), (both - cosine) / sine)
            weight = (tangent + np.roll(tangent, 1, axis=1)) / distance
            total = weight.sum(axis=1)
            moved = (weight * self.displacement).sum(axis=1) / total
            shift = moved * _fading(2.0 / (np.abs(total) * self.reach))
        row, edge = np.nonzero((np.abs(sine) <= _ON_EDGE * both) & (cosine <= 0.0))
        beyond = (edge + 1) % len(self.outline)
        span = distance[row, edge] + distance[row, beyond]
        share = np.divide(distance[row, edge], span, out=np.zeros(len(row)), where=span > 0.0)
        shift[row] = self.displacement[edge] * (1.0 - share) + self.displacement[beyond] * share
        return np.asarray(shift)


def _fading(distance: Floats) -> Floats:
    """The share of the displacement that is left at a distance, in reaches: from 1 to 0, flat at both ends."""
    s = np.clip(distance, 0.0, 1.0)
    return np.asarray(1.0 - s * s * (3.0 - 2.0 * s))

"""Walls between rings that are not cut alike: the sides of both, in the order in which they lie along the tile."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NamedTuple, Self

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.solid.correspondence import Correspondence
from voronoi_tiles.solid.inset_rings import InsetRing
from voronoi_tiles.solid.layers import ExactLayer

_SAMPLES: Final = 256
"""At so many places around rings without corners it is seen how they lie to each other; a count."""


class UsePlaces(NamedTuple):
    """Where the edge uses of a layer lie along walls to the next level: `ring` (intp) numbers the wall around the tile.

    A use runs from `place` (float64) along by `span`, 1, or 0 where it is a point; the corner behind it by another 1.
    """

    ring: Ints
    place: Floats
    span: Floats

    @classmethod
    def of(cls, layer: ExactLayer) -> Self:
        """Those of a layer by itself: ring by ring."""
        count = len(layer.names)
        place = np.arange(count) - layer.ring_offsets[layer.ring]
        return cls(layer.ring, np.asarray(2.0 * place, np.float64), np.ones(count))

    def carried(self, same: Correspondence, layer: ExactLayer) -> UsePlaces:
        """The places of another layer's uses `same.high`, which are uses `same.low` here; its others are points."""
        count = len(layer.names)
        ring, place, span = np.full(count, -1), np.zeros(count), np.zeros(count)
        ring[same.high], place[same.high], span[same.high] = (row[same.low] for row in self)
        for first, last in pairwise(layer.ring_offsets.tolist()):
            known = [use for use in range(first, last) if ring[use] >= 0]
            for use in range(first, last):
                if ring[use] < 0 and known:
                    before = max((other for other in known if other < use), default=known[-1])
                    ring[use], place[use] = ring[before], place[before] + 1.5
        return UsePlaces(ring, place, span)

    def along(self, ring: InsetRing) -> Floats:
        """Where the sides of a ring lie along the wall, float64 (n,): ascending, but for where it begins anew."""
        share = np.where(ring.share > 1.0, 1.0, self.span[ring.use]) * ring.share
        return np.asarray(self.place[ring.use] + share)


@dataclass(frozen=True, eq=False)
class InsetWall:
    """The wall between a ring and the one above it: where one has sides that the other has not, these are fans.

    In the order in which sides lie along the wall, `low` and `high` (intp, n) are the points at which they begin, and
    `rises` (bool, n) says which side comes next: of the upper ring, or of the lower one.
    """

    below: Complexes
    above: Complexes
    low: Ints
    high: Ints
    rises: Bools

    @classmethod
    def between(cls, low: InsetRing, low_along: Floats, high: InsetRing, high_along: Floats, *, loop: bool) -> Self:
        """The wall between rings whose sides lie along it as `UsePlaces.along` has them.

        Of a `loop`, which faces one copy all round, nothing is known but how it lies.
        """
        if loop:
            high_along = np.mod(high_along - _turn(low, low_along, high, high_along), 1.0)
            low_along = np.mod(low_along, 1.0)
        first, one = _unrolled(low_along)
        second, two = _unrolled(high_along)
        order = np.argsort(np.concatenate((one, two)), kind="stable")
        rises = order >= len(one)
        upper = np.cumsum(rises)
        lower = np.arange(1, len(order) + 1) - upper
        return cls(
            low.points,
            high.points,
            first[(lower - ~rises) % len(first)],
            second[(upper - rises) % len(second)],
            rises,
        )

    @property
    def triangles(self) -> Ints:
        """The triangles, intp (n, 3), counter-clockwise as seen from outside; upper points count after lower ones."""
        n = len(self.below)
        apex = np.where(self.rises, np.roll(self.high, -1), np.roll(self.low, -1))
        return np.column_stack((self.low, np.where(self.rises, n + apex, apex), n + self.high))

    def at(self, share: float) -> Complexes:
        """The ring at a share of the way up, complex128 (n,)."""
        return np.asarray(self.below[self.low] * (1.0 - share) + self.above[self.high] * share)


def _unrolled(along: Floats) -> tuple[Ints, Floats]:
    """The sides of a ring from where the wall begins, and where they lie, ascending."""
    first = int(np.argmin(along - np.roll(along, 1)))
    order = np.roll(np.arange(len(along)), -first)
    return order, np.maximum.accumulate(along[order])


def _turn(low: InsetRing, low_along: Floats, high: InsetRing, high_along: Floats) -> float:
    """By how much the upper ring's places, from 0 to 1, must be turned back for it to lie over the lower one."""
    seen = np.arange(_SAMPLES) / _SAMPLES
    shapes = []
    for ring, along in ((low, low_along), (high, high_along)):
        order, place = _unrolled(np.mod(along, 1.0))
        middle = ((ring.points + np.roll(ring.points, -1)) / 2)[order]
        x, y = (np.interp(seen, place, row, period=1.0) for row in (middle.real, middle.imag))
        shapes.append(x + 1j * y)
    one, two = (np.fft.fft(shape - shape.mean()) for shape in shapes)
    return float(np.argmax(np.fft.ifft(two * one.conj()).real) / _SAMPLES)

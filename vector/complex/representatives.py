"""Points of outlines as images of representatives: the same point has the same bits from wherever it is reached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, offsets_of, ranges
from voronoi_tiles.vector.motion_codes import Codes, composed, encode, images
from voronoi_tiles.vector.motions import Action, Motion, reverses_orientation


@dataclass(frozen=True, slots=True)
class Points:
    """Images of representatives: of number `index[k]` (intp, n) under the motion `motion[k]` (int64, n).

    The index is -1 where there is no point.
    """

    index: Ints
    motion: Codes

    def __len__(self) -> int:
        """The number of points."""
        return len(self.index)

    def moved(self, outer: Codes | int) -> Points:
        """The images under one more motion, or one more of each."""
        return Points(self.index, composed(outer, self.motion))

    def and_then(self, others: Points) -> Points:
        """These points, and others behind them."""
        return Points(np.concatenate((self.index, others.index)), np.concatenate((self.motion, others.motion)))

    def take(self, places: Ints | slice) -> Points:
        """The points at these places."""
        return Points(self.index[places], self.motion[places])


@dataclass(frozen=True)
class Representatives:
    """The points that all others are images of: their positions, complex128 (m,), in the plane on which a group acts.

    `stabilizer` has for those that motions of the group fix, by their number, these motions.
    """

    action: Action
    position: Complexes
    stabilizer: dict[int, tuple[Motion, ...]]

    @cached_property
    def _order(self) -> Ints:
        """How many motions fix each representative, 0 where none but the identity does, intp (m,)."""
        order = np.zeros(len(self.position), np.intp)
        order[list(self.stabilizer)] = [len(motions) for motions in self.stabilizer.values()]
        return order

    @cached_property
    def _fixing(self) -> tuple[Codes, Ints]:
        """The motions of all stabilizers, and where those of each representative begin."""
        first = np.zeros(len(self.position), np.intp)
        first[list(self.stabilizer)] = offsets_of([len(motions) for motions in self.stabilizer.values()])[:-1]
        return encode([motion for motions in self.stabilizer.values() for motion in motions]), first

    def locate(self, points: Points, further: tuple[int, int] = (0, 0)) -> Complexes:
        """The positions of points, complex128 (n,); 0 where there is none.

        `further` is twice a translation that comes after all motions, of any length.
        """
        result = images(self.action, self.canonical(points), self.position[points.index], further)
        result[points.index < 0] = 0.0
        return result

    def canonical(self, points: Points) -> Codes:
        """The motions of points; where several lead to one point, that which stands for all."""
        if not self.stabilizer:
            return points.motion
        order = self._order[points.index]
        special = np.flatnonzero((order > 0) & (points.index >= 0))
        if not len(special):
            return points.motion
        (fixing, first), counts = self._fixing, order[special]
        motion = composed(
            np.repeat(points.motion[special], counts), fixing[ranges(first[points.index[special]], counts)]
        )
        result = points.motion.copy()
        result[special] = np.minimum.reduceat(motion, offsets_of(counts)[:-1])
        return result


class Builder:
    """Representatives that are being collected."""

    def __init__(self, action: Action) -> None:
        self.action = action
        self._positions: list[Complexes] = []
        self._count = 0
        self._stabilizer: dict[int, tuple[Motion, ...]] = {}

    def add(self, positions: Complexes) -> Ints:
        """Add representatives; the result are their indices."""
        self._positions.append(positions)
        self._count += len(positions)
        return np.arange(self._count - len(positions), self._count)

    def fix(self, number: int, stabilizer: Sequence[Motion]) -> None:
        """Say that these motions fix a representative."""
        if len(stabilizer) > 1:
            self._stabilizer[number] = tuple(stabilizer)

    def snapshot(self) -> Representatives:
        """The representatives so far."""
        return Representatives(self.action, np.concatenate(self._positions), dict(self._stabilizer))


def fixed(action: Action, position: complex, stabilizer: Sequence[Motion], tangent: complex | None = None) -> complex:
    """A point that motions fix, put exactly where they do: the mean of its images.

    Onto a mirror it is moved along `tangent`, if one is given.
    """
    place = _centred(action, position, stabilizer)
    if tangent is not None and any(map(reverses_orientation, stabilizer)) and len(stabilizer) == 2:
        # A vertex on a mirror from which the site keeps little distance is known badly across the mirror, but is
        # exactly on the other edge that ends there.
        off = place - position
        square = (tangent.conjugate() * off).real
        if square != 0.0:
            along = tangent * (abs(off) ** 2 / square)
            if abs(along) <= 1e3 * abs(off):
                return _centred(action, position + along, stabilizer)
    return place


def _centred(action: Action, position: complex, stabilizer: Sequence[Motion]) -> complex:
    """The mean of a point's images, which all the motions fix."""
    return sum(action.apply_to_point(motion, position) for motion in stabilizer) / len(stabilizer)

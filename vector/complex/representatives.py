"""Points of outlines as images of representatives: the same point has the same bits from wherever it is reached."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints
from voronoi_tiles.vector.motions import Action, Motion, compose, reverses_orientation


@dataclass(frozen=True, slots=True)
class Points:
    """Images of representatives: of number `index[k]` (intp, n) under the motion `motions[motion[k]]` (intp, n).

    The index is -1 where there is no point.
    """

    index: Ints
    motion: Ints
    motions: tuple[Motion, ...]

    @classmethod
    def under(cls, motion: Motion, index: Ints) -> Points:
        """The images of some representatives under one motion."""
        return cls(index, np.zeros(len(index), np.intp), (motion,))

    def __len__(self) -> int:
        """The number of points."""
        return len(self.index)

    def moved(self, outer: Motion) -> Points:
        """The images under one more motion."""
        return Points(self.index, self.motion, tuple(compose(outer, motion) for motion in self.motions))

    def take(self, places: Ints) -> Points:
        """The points at these places."""
        return Points(self.index[places], self.motion[places], self.motions)

    @classmethod
    def concatenate(cls, parts: Sequence[Points]) -> Points:
        """All points of several, in their order."""
        numbers: dict[Motion, int] = {}
        motion = [np.zeros(0, np.intp)]
        for part in parts:
            table = np.array([numbers.setdefault(motion, len(numbers)) for motion in part.motions], np.intp)
            motion.append(table[part.motion])
        index = np.concatenate([np.zeros(0, np.intp), *(part.index for part in parts)])
        return cls(index, np.concatenate(motion), tuple(numbers))


@dataclass(frozen=True)
class Representatives:
    """The points that all others are images of: their positions, complex128 (m,), in the plane on which a group acts.

    `stabilizer` has for those that motions of the group fix, by their number, these motions.
    """

    action: Action
    position: Complexes
    stabilizer: dict[int, tuple[Motion, ...]]

    @cached_property
    def _special(self) -> Bools:
        """Whether a representative has a stabilizer, bool (m,)."""
        special = np.zeros(len(self.position), bool)
        special[list(self.stabilizer)] = True
        return special

    def locate(self, points: Points) -> Complexes:
        """The positions of points, complex128 (n,); 0 where there is none."""
        result = np.zeros(len(points), complex)
        for number, motion in enumerate(points.motions):
            chosen = (points.motion == number) & (points.index >= 0)
            result[chosen] = self.action.apply(motion, self.position[points.index[chosen]])
        for k, motion in self.canonical(points):
            result[k] = self.action.apply_to_point(motion, complex(self.position[points.index[k]]))
        return result

    def canonical(self, points: Points) -> Iterator[tuple[int, Motion]]:
        """Those points to which several motions lead, with the one of these that stands for all."""
        for k in np.flatnonzero((points.index >= 0) & self._special[points.index]).tolist():
            point = int(points.index[k])
            yield k, min(compose(points.motions[points.motion[k]], s) for s in self.stabilizer[point])


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

    def add_fixed(self, position: complex, stabilizer: tuple[Motion, ...], tangent: complex | None = None) -> int:
        """Add a representative that these motions fix, put exactly where they do; the result is its index.

        Onto a mirror it is moved along `tangent`, if one is given.
        """
        place = self._centred(position, stabilizer)
        if tangent is not None and any(map(reverses_orientation, stabilizer)) and len(stabilizer) == 2:
            # A vertex on a mirror from which the site keeps little distance is known badly across the mirror, but is
            # exactly on the other edge that ends there.
            off = place - position
            square = (tangent.conjugate() * off).real
            if square != 0.0:
                along = tangent * (abs(off) ** 2 / square)
                if abs(along) <= 1e3 * abs(off):
                    place = self._centred(position + along, stabilizer)
        number = int(self.add(np.array([place]))[0])
        if len(stabilizer) > 1:
            self._stabilizer[number] = stabilizer
        return number

    def _centred(self, position: complex, stabilizer: tuple[Motion, ...]) -> complex:
        """The mean of a point's images, which all the motions fix."""
        return sum(self.action.apply_to_point(motion, position) for motion in stabilizer) / len(stabilizer)

    def last(self) -> complex:
        """The position of the representative added last."""
        return complex(self._positions[-1][-1])

    def snapshot(self) -> Representatives:
        """The representatives so far."""
        return Representatives(self.action, np.concatenate(self._positions), self._stabilizer)

"""Points of outlines as images of representatives: the same point has the same bits from wherever it is reached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.base.kernels import COMPLEXES, INT, INTS, kernel
from voronoi_tiles.vector.motion_codes import (
    IDENTITY_CODE,
    OF_PLANE,
    OF_TABLES,
    TABLES,
    Codes,
    code_of,
    composed,
    images,
    least_products,
    plane_of,
)
from voronoi_tiles.vector.motions import Action, Motion

OF_REPRESENTATIVES = (COMPLEXES, INTS, INT, INTS, *OF_TABLES, *OF_PLANE)
"""The kinds of what compiled kernels take of representatives."""
_LOCATED = kernel("representatives_located", INT, INTS, INTS, *OF_REPRESENTATIVES, INT, INT, INT, COMPLEXES)


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

    @classmethod
    def joined(cls, parts: Sequence[Points]) -> Points:
        """Several arrays of points as one."""
        return cls(np.concatenate([part.index for part in parts]), np.concatenate([part.motion for part in parts]))

    def and_then(self, others: Points) -> Points:
        """These points, and others behind them."""
        return self.joined((self, others))

    def take(self, places: Ints | slice) -> Points:
        """The points at these places."""
        return Points(self.index[places], self.motion[places])


@dataclass(frozen=True)
class Representatives:
    """The points that all others are images of: their positions, complex128 (m,), in the plane on which a group acts.

    `stabilizer` has for those that motions of the group fix, by their number, the codes of these motions.
    """

    action: Action
    position: Complexes
    stabilizer: dict[int, tuple[int, ...]]

    @cached_property
    def given(self) -> tuple[Any, ...]:
        """What compiled kernels take to locate points, as in boundary.c; see `OF_REPRESENTATIVES`."""
        row, fixing = self._fixing
        return self.position, row, fixing.shape[1], fixing, *TABLES, *plane_of(self.action)

    @cached_property
    def _fixing(self) -> tuple[Ints, Codes]:
        """For each representative its row of stabilizers, -1 where it has none, behind them -1 for no point; the rows.

        Rows are filled up with the identity.
        """
        row = np.full(len(self.position) + 1, -1)
        for k, number in enumerate(self.stabilizer):
            row[number] = k
        width = max(map(len, self.stabilizer.values()), default=0)
        fixing = [codes + (IDENTITY_CODE,) * (width - len(codes)) for codes in self.stabilizer.values()]
        return row, np.array(fixing, np.int64).reshape(len(fixing), width)

    def locate(self, points: Points, further: tuple[int, int] = (0, 0)) -> Complexes:
        """The positions of points, complex128 (n,); 0 where there is none.

        `further` is twice a translation that comes after all motions, of any length. A compiled kernel gives the same
        bits.
        """
        compiled = _LOCATED()
        if compiled is not None:
            result = np.empty(len(points), complex)
            compiled(len(points), points.index, points.motion, *self.given, IDENTITY_CODE, *further, result)
            return result
        result = images(self.action, self.canonical(points), self.position[points.index], further)
        result[points.index < 0] = 0.0
        return result

    def canonical(self, points: Points) -> Codes:
        """The motions of points; where several lead to one point, that which stands for all."""
        if not self.stabilizer:
            return points.motion
        row, fixing = self._fixing
        return least_products(points.motion, row[points.index], fixing)


class Builder:
    """Representatives that are being collected."""

    def __init__(self, action: Action) -> None:
        self.action = action
        self._positions: list[Complexes] = []
        self._count = 0
        self._stabilizer: dict[int, tuple[int, ...]] = {}

    def add(self, positions: Complexes) -> Ints:
        """Add representatives; the result are their indices."""
        self._positions.append(positions)
        self._count += len(positions)
        return np.arange(self._count - len(positions), self._count)

    def fix(self, number: int, stabilizer: Sequence[Motion]) -> None:
        """Say that these motions fix a representative."""
        if len(stabilizer) > 1:
            self._stabilizer[number] = tuple(map(code_of, stabilizer))

    def snapshot(self) -> Representatives:
        """The representatives so far."""
        return Representatives(self.action, np.concatenate(self._positions), dict(self._stabilizer))


def fixed(action: Action, position: complex, stabilizer: Sequence[Motion]) -> complex:
    """A point that motions fix, put exactly where they do: the mean of its images."""
    return sum(action.apply_to_point(motion, position) for motion in stabilizer) / len(stabilizer)


def on_mirror(action: Action, position: complex, stabilizer: Sequence[Motion], tangent: complex) -> complex:
    """A point put onto a mirror along a tangent of an edge that ends there; `stabilizer` is its reflection's group.

    A vertex on a mirror from which the site keeps little distance is known badly across the mirror, but is exactly on
    the other edge that ends there. Where that is nearly at right angles to the way there, it is put onto the mirror
    straight.
    """
    off = fixed(action, position, stabilizer) - position
    square = (tangent.conjugate() * off).real
    if square != 0.0:
        along = tangent * (abs(off) ** 2 / square)
        if abs(along) <= 1e3 * abs(off):
            position += along
    return fixed(action, position, stabilizer)

"""The group acting on the plane: exact motions, and what they are in coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.maps import Isometry, move
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup

Motion = tuple[int, int, int, int, int, int]
"""An operation held in integers: the linear part, row by row, and twice the translation (fractional coordinates)."""

IDENTITY: Motion = (1, 0, 0, 1, 0, 0)

_SQUARE = {(a, 0, 0, b) for a in (-1, 1) for b in (-1, 1)} | {(0, a, b, 0) for a in (-1, 1) for b in (-1, 1)}
_HEXAGONAL = {
    (sign * a, sign * b, sign * c, sign * d)
    for a, b, c, d in ((1, 0, 0, 1), (0, -1, 1, -1), (-1, 1, -1, 0), (0, 1, 1, 0), (-1, 1, 0, 1), (1, 0, 1, -1))
    for sign in (-1, 1)
}
LINEAR_PARTS: Final = tuple(sorted(_SQUARE | _HEXAGONAL))
"""The linear parts of all motions, of those that keep a square lattice or a hexagonal one, in the order of motions."""


def compose(outer: Motion, inner: Motion) -> Motion:
    """The motion that applies `inner` first and `outer` to its result."""
    a, b, c, d, s, t = outer
    e, f, g, h, u, v = inner
    return (a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h, a * u + b * v + s, c * u + d * v + t)


def inverse(motion: Motion) -> Motion:
    """The motion that undoes `motion`."""
    a, b, c, d, s, t = motion
    det = a * d - b * c  # 1 or -1
    a, b, c, d = det * d, -det * b, -det * c, det * a
    return (a, b, c, d, -(a * s + b * t), -(c * s + d * t))


def reverses_orientation(motion: Motion) -> bool:
    """Whether a motion turns the plane over."""
    return motion[0] * motion[3] - motion[1] * motion[2] < 0


def to_motion(operation: Operation) -> Motion:
    """An operation as a motion.

    Raises ValueError where its translation does not consist of halves, as in all plane groups it does.
    """
    x, y = operation.translation
    if x.denominator > 2 or y.denominator > 2:
        raise ValueError(f"{operation} is an operation of no wallpaper group")
    return (*operation.linear, x.numerator * (2 // x.denominator), y.numerator * (2 // y.denominator))


@lru_cache(maxsize=4096)
def to_operation(motion: Motion) -> Operation:
    """A motion as an operation."""
    return Operation((motion[0], motion[1], motion[2], motion[3]), (Fraction(motion[4], 2), Fraction(motion[5], 2)))


@dataclass(frozen=True)
class Action:
    """A wallpaper group acting on the plane over a given lattice."""

    group: WallpaperGroup
    lattice: Lattice

    @cached_property
    def motions(self) -> tuple[Motion, ...]:
        """The general positions, the identity first."""
        return tuple(to_motion(operation) for operation in self.group.operations)

    @cached_property
    def fractional_maps(self) -> tuple[Floats, Floats]:
        """What the motions do to fractional coordinates: matrices (n, 2, 2), and vectors (n, 2, 1) added afterwards."""
        rows = np.array(self.motions, float)
        return rows[:, :4].reshape(-1, 2, 2), rows[:, 4:, None] / 2

    @cached_property
    def linear(self) -> dict[tuple[int, ...], tuple[complex, bool]]:
        """The linear part of each motion as (unit complex number, whether it conjugates)."""
        isometries = (self.lattice.isometry(operation) for operation in self.group.operations)
        return {m[:4]: (i.a, i.conj) for m, i in zip(self.motions, isometries, strict=True)}

    @cached_property
    def isometries(self) -> tuple[Complexes, Floats]:
        """For each of `LINEAR_PARTS` its unit complex number, and -1 where it conjugates, else 1.

        The unit complex number is NaN where the linear part is none of the group's.
        """
        unit, sign = np.full(len(LINEAR_PARTS), complex("nan")), np.ones(len(LINEAR_PARTS))
        for linear, (number, conj) in self.linear.items():
            k = LINEAR_PARTS.index(linear)
            unit[k], sign[k] = number, -1.0 if conj else 1.0
        return unit, sign

    @cached_property
    def reduced(self) -> tuple[tuple[int, int], tuple[int, int]]:
        """The shortest basis of the lattice, in integer coordinates over (a, b)."""
        (m, n), (i, j) = (self.fractional(vector) for vector in self.lattice.reduced_basis)
        return (round(m), round(n)), (round(i), round(j))

    def cartesian(self, x: npt.ArrayLike, y: npt.ArrayLike) -> Complexes:
        """Fractional coordinates as points."""
        x, y = np.asarray(x, float), np.asarray(y, float)
        a, b = self.lattice.a, self.lattice.b
        result = np.empty(x.shape, complex)
        result.real = x * a.real + y * b.real
        result.imag = x * a.imag + y * b.imag
        return result

    def fractional(self, z: complex) -> tuple[float, float]:
        """A point in fractional coordinates."""
        return self.lattice.fractional(z)

    @cached_property
    def covering_radius(self) -> float:
        """The largest distance of any point from a lattice: no tile reaches farther from its site."""
        p, q = (self.lattice.cartesian(*v) for v in self.reduced)
        if (p.conjugate() * q).real < 0:
            q = -q
        area = abs((p.conjugate() * q).imag)
        return abs(p) * abs(q) * abs(p - q) / (2 * area)

    @cached_property
    def size(self) -> float:
        """The length of the longer vector of the cell: the scale that accuracies are relative to."""
        return max(abs(self.lattice.a), abs(self.lattice.b))

    def isometry(self, motion: Motion) -> Isometry:
        """The isometry of the plane that a motion is."""
        unit, conj = self.linear[motion[:4]]
        return Isometry(unit, self._shift(motion), conj)

    def apply(self, motion: Motion, z: Complexes) -> Complexes:
        """The images of points under one motion."""
        unit, conj = self.linear[motion[:4]]
        return move(z, unit, self._shift(motion), conj)

    def apply_to_point(self, motion: Motion, z: complex) -> complex:
        """The image of one point: the same bits as `apply` gives, without an array's overhead."""
        unit, conj = self.linear[motion[:4]]
        shift = self._shift(motion)
        x, y = z.real, (-z.imag if conj else z.imag)
        return complex(unit.real * x - unit.imag * y + shift.real, unit.imag * x + unit.real * y + shift.imag)

    def _shift(self, motion: Motion) -> complex:
        """The translation of a motion."""
        s, t, a, b = motion[4] / 2, motion[5] / 2, self.lattice.a, self.lattice.b
        return complex(s * a.real + t * b.real, s * a.imag + t * b.imag)


def modulo_lattice(motion: Motion) -> Motion:
    """The one of a motion's lattice translates that stands for all."""
    return (*motion[:4], motion[4] % 2, motion[5] % 2)


def split(motion: Motion) -> tuple[Motion, int, int]:
    """What stands for a motion modulo the lattice, and the lattice vector that comes after it."""
    return modulo_lattice(motion), motion[4] // 2, motion[5] // 2


def translated(motion: Motion, i: int, j: int) -> Motion:
    """A motion followed by a lattice translation."""
    return (*motion[:4], motion[4] + 2 * i, motion[5] + 2 * j)

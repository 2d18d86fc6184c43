"""Maps of the plane: isometries, similarities and affine maps, for points and for arrays of points."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import Final, NamedTuple, overload

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes

_HALF_SQRT3 = math.sqrt(3.0) / 2.0

UNITS: tuple[complex, ...] = (
    complex(1.0, 0.0),
    complex(_HALF_SQRT3, 0.5),
    complex(0.5, _HALF_SQRT3),
    complex(0.0, 1.0),
    complex(-0.5, _HALF_SQRT3),
    complex(-_HALF_SQRT3, 0.5),
    complex(-1.0, 0.0),
    complex(-_HALF_SQRT3, -0.5),
    complex(-0.5, -_HALF_SQRT3),
    complex(0.0, -1.0),
    complex(0.5, -_HALF_SQRT3),
    complex(_HALF_SQRT3, -0.5),
)
"""The unit complex numbers at the multiples of 30 degrees: every linear part of a wallpaper isometry is one of them."""


def unit_at(degrees: float) -> complex:
    """The unit complex number at an angle in degrees: exact (as in `UNITS`) at multiples of 30, else to an ulp."""
    turn = math.fmod(degrees, 360.0)  # exact, unlike a reduction in radians
    steps = turn / 30.0
    if steps == round(steps) and round(steps) * 30.0 == turn:
        return UNITS[round(steps) % 12]
    return cmath.rect(1.0, math.radians(turn))


def move(z: Complexes, unit: complex | Complexes, shift: complex | Complexes, conj: bool | Bools = False) -> Complexes:
    """The image unit * z + shift, or unit * conj(z) + shift where `conj`; all arguments broadcast.

    The arithmetic is spelt out in real numbers: numpy's complex product may round an element differently with
    its place in the array, and the same point must have the same bits from wherever it is reached.
    """
    x, y = z.real, np.where(conj, -z.imag, z.imag)
    real = unit.real * x - unit.imag * y + shift.real
    result = np.empty(real.shape, complex)
    result.real = real
    result.imag = unit.imag * x + unit.real * y + shift.imag
    return result


class Isometry(NamedTuple):
    """A Cartesian isometry: z -> a z + b, or z -> a conj(z) + b where `conj`; |a| = 1."""

    a: complex
    b: complex
    conj: bool

    @overload
    def __call__(self, z: complex) -> complex: ...
    @overload
    def __call__(self, z: Complexes) -> Complexes: ...
    def __call__(self, z: complex | Complexes) -> complex | Complexes:
        """The image of a point or of an array of points, of the same shape.

        Real and imaginary parts are multiplied and added one by one (no complex product, which may round
        differently in vector code): a point has the same bits whether it comes alone or in an array.
        """
        if isinstance(z, np.ndarray):
            return move(z, *self)
        x, y = float(z.real), float(-z.imag if self.conj else z.imag)
        unit, shift = self.a, self.b
        return complex(unit.real * x - unit.imag * y + shift.real, unit.imag * x + unit.real * y + shift.imag)


@dataclass(frozen=True, slots=True)
class Placement:
    """The similarity z -> translate + rotate(scale m(z)), as strokes, sites and art carry it.

    m mirrors, x -> -x, where `mirror` is set. `scale` is any number but 0 (-1 is a half turn), `rotate` is in degrees,
    counterclockwise; quarter turns are exact.
    """

    scale: float = 1.0
    rotate: float = 0.0
    translate: complex = 0j
    mirror: bool = False

    @property
    def is_identity(self) -> bool:
        """Whether nothing moves."""
        return self.scale == 1.0 and self.rotate == 0.0 and self.translate == 0j and not self.mirror

    @property
    def similarity(self) -> tuple[complex, complex, bool]:
        """The numbers (a, b, conj) of the map z -> a z + b, or a conj(z) + b where `conj`, that this is."""
        factor = self.scale * unit_at(self.rotate)
        return -factor if self.mirror else factor, self.translate, self.mirror

    @property
    def inverse(self) -> Placement:
        """The placement that undoes this one, but for rounding."""
        back = Placement(1.0 / self.scale, self.rotate if self.mirror else -self.rotate, mirror=self.mirror)
        return back @ Placement(translate=-self.translate)

    @overload
    def __call__(self, z: complex) -> complex: ...
    @overload
    def __call__(self, z: Complexes) -> Complexes: ...
    def __call__(self, z: complex | Complexes) -> complex | Complexes:
        """The image of a point or of an array of points, of the same shape."""
        if self.is_identity:
            return z
        start = -z.conjugate() if self.mirror else z
        return Isometry(unit_at(self.rotate), self.translate, conj=False)(start * self.scale)

    def __matmul__(self, inner: Placement) -> Placement:
        """First `inner`, then this one."""
        return Placement(
            self.scale * inner.scale,
            self.rotate + (-inner.rotate if self.mirror else inner.rotate),
            self(inner.translate),
            self.mirror != inner.mirror,
        )


SIMILAR: Final = 1e-9
"""A map takes circles to circles when its singular values differ by less; relative. Rounding leaves 1e-15, and the
circle that is taken instead is nearer than a picometre."""


class Affine(NamedTuple):
    """The map z -> a z + b conj(z) + c."""

    a: complex
    b: complex
    c: complex

    def __matmul__(self, inner: Affine) -> Affine:
        """First `inner`, then this map."""
        return Affine(
            self.a * inner.a + self.b * inner.b.conjugate(),
            self.a * inner.b + self.b * inner.a.conjugate(),
            self.a * inner.c + self.b * inner.c.conjugate() + self.c,
        )

    def __call__(self, z: complex) -> complex:
        """The image of a point."""
        return self.a * z + self.b * z.conjugate() + self.c

    @property
    def inverse(self) -> Affine:
        """The map that undoes this one, but for rounding. Raises ZeroDivisionError where all goes to a line."""
        area = (abs(self.a) - abs(self.b)) * (abs(self.a) + abs(self.b))
        a, b = self.a.conjugate() / area, -self.b / area
        return Affine(a, b, -(a * self.c + b * self.c.conjugate()))

    @property
    def is_similar(self) -> bool:
        """Whether circles stay circles."""
        a, b = abs(self.a), abs(self.b)
        return min(a, b) <= SIMILAR * max(a, b)

    @property
    def largest(self) -> float:
        """The factor by which the longest growing direction grows."""
        return abs(self.a) + abs(self.b)

    @property
    def scale(self) -> float:
        """The square root of the factor by which areas grow."""
        a, b = abs(self.a), abs(self.b)
        return math.sqrt(abs(a - b)) * math.sqrt(a + b)  # squares of large numbers are beyond all bounds


IDENTITY_MAP: Final = Affine(1 + 0j, 0j, 0j)


def from_matrix(a: float, b: float, c: float, d: float, e: float, f: float) -> Affine:
    """The map of SVG's matrix(a b c d e f): x' = a x + c y + e, y' = b x + d y + f."""
    x, y = complex(a, b), complex(c, d)
    return Affine((x - 1j * y) / 2, (x + 1j * y) / 2, complex(e, f))

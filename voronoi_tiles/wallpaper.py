"""The 17 wallpaper groups as one exact table, their operations, lattices and isometries.

Operations are held exactly, in fractional coordinates (integers and fractions); only `Lattice.isometry`
steps to Cartesian floating point. Source: International Tables for Crystallography, vol. A, plane groups,
general positions.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from types import MappingProxyType
from typing import Literal, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.tolerance import UNIT_SNAP

Complexes = NDArray[np.complex128]
Floats = NDArray[np.float64]
System = Literal["oblique", "rectangular", "square", "hexagonal"]

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

_TERM = re.compile(r"([+-])(?:(\d*)([xy])|(\d+)(?:/(\d+))?)")


@dataclass(frozen=True, slots=True)
class Operation:
    """A symmetry operation in fractional coordinates: x' = W0 x + W1 y + t0, y' = W2 x + W3 y + t1.

    `linear` is the integer matrix W, row by row, of determinant 1 (rotation, translation) or -1
    (reflection, glide); `translation` is exact. Operations compare and hash by value.
    """

    linear: tuple[int, int, int, int]
    translation: tuple[Fraction, Fraction]

    @classmethod
    def parse(cls, text: str) -> Operation:
        """Read a coordinate triplet such as "-y,x-y", "-x+1/2,y+1" or "x-y+3/2,-y".

        Raises ValueError where the text is no triplet, or where the determinant is neither 1 nor -1.
        """
        return _parse(text)

    def __str__(self) -> str:
        a, b, c, d = self.linear
        return f"{_print_row(a, b, self.translation[0])},{_print_row(c, d, self.translation[1])}"

    def __matmul__(self, other: Operation) -> Operation:
        """The product `self @ other`: `other` is applied first."""
        a, b, c, d = self.linear
        e, f, g, h = other.linear
        x, y = other.translation
        t0, t1 = self.translation
        return Operation(
            (a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h),
            (a * x + b * y + t0, c * x + d * y + t1),
        )

    def inverse(self) -> Operation:
        """The operation that undoes this one."""
        a, b, c, d = self.linear
        det = self.determinant
        e, f, g, h = det * d, -det * b, -det * c, det * a
        x, y = self.translation
        return Operation((e, f, g, h), (-(e * x + f * y), -(g * x + h * y)))

    @property
    def determinant(self) -> int:
        """1 for rotations and translations, -1 for reflections and glides."""
        a, b, c, d = self.linear
        return a * d - b * c

    @property
    def is_identity(self) -> bool:
        """Whether this operation leaves every point where it is."""
        return self.linear == (1, 0, 0, 1) and not any(self.translation)

    def translated(self, i: int, j: int) -> Operation:
        """This operation followed by the lattice translation i a + j b."""
        return Operation(self.linear, (self.translation[0] + i, self.translation[1] + j))

    def reduced(self) -> Operation:
        """The same operation up to lattice translations, with its translation in [0, 1)."""
        return Operation(self.linear, (self.translation[0] % 1, self.translation[1] % 1))


@lru_cache(maxsize=4096)
def _parse(text: str) -> Operation:
    rows = text.split(",")
    if len(rows) != 2:
        raise ValueError(f"not a coordinate triplet: {text!r}")
    (a, b, t0), (c, d, t1) = (_parse_row(row, text) for row in rows)
    operation = Operation((a, b, c, d), (t0, t1))
    if operation.determinant not in (1, -1):
        raise ValueError(f"not an operation of a lattice (its determinant is not 1 or -1): {text!r}")
    return operation


def _parse_row(row: str, text: str) -> tuple[int, int, Fraction]:
    row = "".join(row.split())
    if row and row[0] not in "+-":
        row = "+" + row
    coefficients = {"x": 0, "y": 0}
    shift = Fraction(0)
    position = 0
    while position < len(row):
        match = _TERM.match(row, position)
        if match is None:
            break
        sign = -1 if match[1] == "-" else 1
        if match[3]:
            coefficients[match[3]] += sign * int(match[2] or 1)
        else:
            if int(match[5] or 1) == 0:
                break
            shift += Fraction(sign * int(match[4]), int(match[5] or 1))
        position = match.end()
    if not row or position < len(row):
        raise ValueError(f"not a coordinate triplet: {text!r}")
    return coefficients["x"], coefficients["y"], shift


def _print_row(x: int, y: int, shift: Fraction) -> str:
    parts = []
    for coefficient, variable in ((x, "x"), (y, "y")):
        if coefficient:
            size = "" if abs(coefficient) == 1 else str(abs(coefficient))
            parts.append(f"{'-' if coefficient < 0 else '+'}{size}{variable}")
    if shift or not parts:
        parts.append(f"{'-' if shift < 0 else '+'}{abs(shift)}")
    return "".join(parts).removeprefix("+")


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
        c, s = self.a.real, self.a.imag
        u, v = self.b.real, self.b.imag
        if isinstance(z, np.ndarray):
            x, y = z.real, (-z.imag if self.conj else z.imag)
            image = np.empty(z.shape, dtype=np.complex128)
            image.real = (c * x - s * y) + u
            image.imag = (s * x + c * y) + v
            return image
        x0, y0 = float(z.real), float(-z.imag if self.conj else z.imag)
        return complex((c * x0 - s * y0) + u, (s * x0 + c * y0) + v)


@dataclass(frozen=True)
class Lattice:
    """The lattice of a wallpaper group: all i a + j b with integers i, j.

    `a` and `b` are Cartesian vectors in the units of the design, b to the left of a (positive `det`); the
    lattices of designs have a along +x. Raises ValueError where the basis is not finite or not positively
    oriented.
    """

    a: complex
    b: complex

    def __post_init__(self) -> None:
        if not (cmath.isfinite(self.a) and cmath.isfinite(self.b) and self.det > 0.0):
            raise ValueError(f"not a positively oriented lattice basis: {self.a}, {self.b}")

    @property
    def det(self) -> float:
        """The area of the cell, positive; exact up to one rounding where a lies along +x."""
        return self.a.real * self.b.imag - self.a.imag * self.b.real

    @cached_property
    def reduced_basis(self) -> tuple[complex, complex]:
        """The shortest basis of the same lattice (Lagrange, Gauss): |first| <= |second|, positively oriented."""
        u, v = self.a, self.b
        if abs(u) > abs(v):
            u, v = v, -u
        # Each step shortens v by a factor, or is the last; 2000 is beyond what float64 exponents allow.
        for _ in range(2000):
            v -= round((u.real * v.real + u.imag * v.imag) / abs(u) ** 2) * u
            if abs(u) <= abs(v):
                break
            u, v = v, -u
        return u, v

    def cartesian(self, x: float | Fraction, y: float | Fraction) -> complex:
        """The Cartesian point of the fractional coordinates (x, y)."""
        s, t = float(x), float(y)
        return complex(s * self.a.real + t * self.b.real, s * self.a.imag + t * self.b.imag)

    @overload
    def fractional(self, z: complex) -> tuple[float, float]: ...
    @overload
    def fractional(self, z: Complexes) -> tuple[Floats, Floats]: ...
    def fractional(self, z: complex | Complexes) -> tuple[float | Floats, float | Floats]:
        """The fractional coordinates (x, y) of a point, or of an array of points: the inverse of `cartesian`."""
        a, b, det = self.a, self.b, self.det
        return (z.real * b.imag - z.imag * b.real) / det, (a.real * z.imag - a.imag * z.real) / det

    @cached_property
    def reduced(self) -> Lattice:
        """The same lattice over its shortest basis."""
        return Lattice(*self.reduced_basis)

    def isometry(self, operation: Operation) -> Isometry:
        """The Cartesian isometry of `operation`.

        Its linear part is one of `UNITS` to the bit (where a lies along +x), chosen by what the operation
        does to a. Raises ValueError where the operation is no isometry of this lattice.
        """
        a, conj = self._linear(operation.linear)
        return Isometry(a, self.cartesian(*operation.translation), conj)

    @cached_property
    def _linear_parts(self) -> dict[tuple[int, int, int, int], tuple[complex, bool]]:
        return {}

    def _linear(self, w: tuple[int, int, int, int]) -> tuple[complex, bool]:
        known = self._linear_parts.get(w)
        if known is not None:
            return known
        conj = w[0] * w[3] - w[1] * w[2] < 0
        a, b = (self.a.conjugate(), self.b.conjugate()) if conj else (self.a, self.b)
        unit = (w[0] * self.a + w[2] * self.b) / a
        nearest = UNITS[round(math.degrees(cmath.phase(unit)) / 30.0) % 12]
        # A basis that is not along +x turns the mirrors to other angles; then the quotient itself is the best there is.
        unit = nearest if abs(unit - nearest) <= UNIT_SNAP else unit / abs(unit)
        error_a = abs(unit * a - (w[0] * self.a + w[2] * self.b)) / abs(a)
        error_b = abs(unit * b - (w[1] * self.a + w[3] * self.b)) / abs(b)
        if max(error_a, error_b) > UNIT_SNAP:
            raise ValueError(f"the linear part {w} is no isometry of the lattice {self.a}, {self.b}")
        self._linear_parts[w] = unit, conj
        return unit, conj


@dataclass(frozen=True)
class WallpaperGroup:
    """A wallpaper group: its name, its crystal system, and its operations up to lattice translations.

    `operations` are the general positions of the conventional cell, the identity first; cm has 4 and cmm 8
    of them, because the centring translation counts.
    """

    name: str
    system: System
    operations: tuple[Operation, ...]

    @property
    def order(self) -> int:
        """How many copies of a general site one conventional cell holds."""
        return len(self.operations)

    @property
    def fixed_angle(self) -> float | None:
        """The angle from a to b that the system fixes, in degrees; None for oblique cells."""
        return {"oblique": None, "rectangular": 90.0, "square": 90.0, "hexagonal": 120.0}[self.system]

    @property
    def fixes_b(self) -> bool:
        """Whether the system makes b as long as a."""
        return self.system in ("square", "hexagonal")

    def lattice(self, a: float, b: float | None = None, angle: float | None = None) -> Lattice:
        """The lattice of a conventional cell: a along +x, b at `angle` degrees from it.

        What the system fixes may be left out, and is not read. Raises ValueError where b or the angle is
        missing, or the cell has no area.
        """
        if b is None:
            if not self.fixes_b:
                raise ValueError(f"{self.name} needs b")
            b = a
        match self.system:
            case "hexagonal":
                return Lattice(complex(a), complex(a * UNITS[4].real, a * UNITS[4].imag))
            case "rectangular" | "square":
                return Lattice(complex(a), complex(0.0, b))
            case "oblique":
                if angle is None:
                    raise ValueError(f"{self.name} needs an angle")
                unit = unit_at(angle)
                return Lattice(complex(a), complex(b * unit.real, b * unit.imag))


def unit_at(degrees: float) -> complex:
    """The unit complex number at an angle in degrees: exact (as in `UNITS`) at multiples of 30, else to an ulp."""
    turn = math.fmod(degrees, 360.0)  # exact, unlike a reduction in radians
    steps = turn / 30.0
    if steps == round(steps) and round(steps) * 30.0 == turn:
        return UNITS[round(steps) % 12]
    return cmath.rect(1.0, math.radians(turn))


_CENTRED = "x+1/2,y+1/2"
_P4 = "x,y; -x,-y; -y,x; y,-x"
_P3 = "x,y; -y,x-y; -x+y,-x"
_P6 = f"{_P3}; -x,-y; y,-x+y; x-y,x"

_TABLE: tuple[tuple[str, System, str, bool], ...] = (
    # name, system, general positions, centred
    ("p1", "oblique", "x,y", False),
    ("p2", "oblique", "x,y; -x,-y", False),
    ("pm", "rectangular", "x,y; -x,y", False),
    ("pg", "rectangular", "x,y; -x,y+1/2", False),
    ("cm", "rectangular", "x,y; -x,y", True),
    ("pmm", "rectangular", "x,y; -x,-y; -x,y; x,-y", False),
    ("pmg", "rectangular", "x,y; -x,-y; -x+1/2,y; x+1/2,-y", False),
    ("pgg", "rectangular", "x,y; -x,-y; -x+1/2,y+1/2; x+1/2,-y+1/2", False),
    ("cmm", "rectangular", "x,y; -x,-y; -x,y; x,-y", True),
    ("p4", "square", _P4, False),
    ("p4m", "square", f"{_P4}; -x,y; x,-y; y,x; -y,-x", False),
    ("p4g", "square", f"{_P4}; -x+1/2,y+1/2; x+1/2,-y+1/2; y+1/2,x+1/2; -y+1/2,-x+1/2", False),
    ("p3", "hexagonal", _P3, False),
    ("p3m1", "hexagonal", f"{_P3}; -y,-x; -x+y,y; x,x-y", False),
    ("p31m", "hexagonal", f"{_P3}; y,x; x-y,-y; -x,-x+y", False),
    ("p6", "hexagonal", _P6, False),
    ("p6m", "hexagonal", f"{_P6}; -y,-x; -x+y,y; x,x-y; y,x; x-y,-y; -x,-x+y", False),
)


def _group(name: str, system: System, positions: str, centred: bool) -> WallpaperGroup:
    operations = [Operation.parse(triplet) for triplet in positions.split(";")]
    if centred:
        centring = Operation.parse(_CENTRED)
        operations += [centring @ operation for operation in operations]
    return WallpaperGroup(name, system, tuple(operations))


GROUPS: Mapping[str, WallpaperGroup] = MappingProxyType({row[0]: _group(*row) for row in _TABLE})
"""The 17 wallpaper groups by name, in the order of the table."""

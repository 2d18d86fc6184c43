"""The 17 wallpaper groups as one exact table, their operations, lattices and isometries.

Operations are held exactly, in fractional coordinates (integers and fractions); only `Lattice.isometry`
steps to Cartesian floating point. Source: International Tables for Crystallography, vol. A, plane groups,
general positions.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import Literal, overload

from voronoi_tiles.base.arguments import number
from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.maps import UNITS, Isometry, unit_at
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.tolerance import UNIT_SNAP

System = Literal["oblique", "rectangular", "square", "hexagonal"]


@dataclass(frozen=True)
class Lattice:
    """The lattice of a wallpaper group: all i a + j b with integers i, j.

    `a` and `b` are Cartesian vectors in the units of the design, b to the left of a (positive `det`); the
    lattices of designs have a along +x. Raises ArgumentError where the basis is not finite or not positively
    oriented.
    """

    a: complex
    b: complex

    def __post_init__(self) -> None:
        if not (cmath.isfinite(self.a) and cmath.isfinite(self.b) and self.det > 0.0):
            raise ArgumentError(
                f"not a positively oriented lattice basis: {self.a}, {self.b}", remedy="Take b to the left of a."
            )

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
        does to a. Raises ArgumentError where the operation is no isometry of this lattice.
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
            raise ArgumentError(f"the linear part {w} is no isometry of the lattice {self.a}, {self.b}")
        self._linear_parts[w] = unit, conj
        return unit, conj


@dataclass(frozen=True, repr=False)
class WallpaperGroup:
    """A wallpaper group: its name, its crystal system, and its operations up to lattice translations.

    `operations` are the general positions of the conventional cell, the identity first; cm has 4 and cmm 8
    of them, because the centring translation counts.
    """

    name: str
    system: System
    operations: tuple[Operation, ...] = field(hash=False)  # dozens of fractions: the name tells groups apart

    def __repr__(self) -> str:
        return f"<WallpaperGroup {self.name}: {self.system}, of order {self.order}>"

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

        What the system fixes may be left out, and is not read. Raises ArgumentError where b or the angle is
        missing, or the cell has no area.
        """
        remedy = "Give a number."
        a = number("a", a, remedy)
        if self.fixes_b:
            b = a
        elif b is None:
            raise ArgumentError(f"{self.name} needs `b`", remedy="Give the cell's second side.")
        b = number("b", b, remedy)
        match self.system:
            case "hexagonal":
                return Lattice(complex(a), complex(a * UNITS[4].real, a * UNITS[4].imag))
            case "rectangular" | "square":
                return Lattice(complex(a), complex(0.0, b))
            case "oblique":
                if angle is None:
                    raise ArgumentError(f"{self.name} needs an `angle`", remedy="Give that from a to b in degrees.")
                unit = unit_at(number("angle", angle, remedy))
                return Lattice(complex(a), complex(b * unit.real, b * unit.imag))


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

"""Symmetry operations of lattices, held exactly: integers and fractions, in fractional coordinates."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.values import shown

_REMEDY = "Write one such as -y,x+1/2."

_TERM = re.compile(r"([+-])(?:(\d*)([xy])|(\d+)(?:/(\d+))?)")


@dataclass(frozen=True, slots=True, repr=False)
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

        Raises ArgumentError where the text is no triplet, or where the determinant is neither 1 nor -1.
        """
        given: Any = text
        if not (isinstance(given, str) and given.isascii() and len(given) <= _LONGEST):
            raise ArgumentError(f"not a coordinate triplet: {shown(given)}", remedy=_REMEDY)
        return _parse(text)

    def __repr__(self) -> str:
        return f"Operation.parse({str(self)!r})"

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


_LONGEST = 200
"""Most characters of a triplet; more are none that anybody wrote."""


@lru_cache(maxsize=4096)
def _parse(text: str) -> Operation:
    rows = text.split(",")
    if len(rows) != 2:
        raise ArgumentError(f"not a coordinate triplet: {text!r}", remedy=_REMEDY)
    (a, b, t0), (c, d, t1) = (_parse_row(row, text) for row in rows)
    operation = Operation((a, b, c, d), (t0, t1))
    if operation.determinant not in (1, -1):
        raise ArgumentError(f"not an operation of a lattice (its determinant is not 1 or -1): {text!r}", remedy=_REMEDY)
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
        raise ArgumentError(f"not a coordinate triplet: {text!r}", remedy=_REMEDY)
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

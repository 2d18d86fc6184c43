"""Affine maps of the plane as three complex numbers, z -> a z + b conj(z) + c, and SVG's transform lists."""

from __future__ import annotations

import cmath
import math
import re
from typing import Final, NamedTuple

from voronoi_tiles.drawings.model import DrawingError
from voronoi_tiles.tolerance import COORDINATE_MAX

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
        return math.sqrt(abs(abs(self.a) ** 2 - abs(self.b) ** 2))


IDENTITY: Final = Affine(1 + 0j, 0j, 0j)


def from_matrix(a: float, b: float, c: float, d: float, e: float, f: float) -> Affine:
    """The map of SVG's matrix(a b c d e f): x' = a x + c y + e, y' = b x + d y + f."""
    x, y = complex(a, b), complex(c, d)
    return Affine((x - 1j * y) / 2, (x + 1j * y) / 2, complex(e, f))


def rotation(degrees: float) -> complex:
    """The factor that turns by an angle; exact for quarters."""
    quarters = math.fmod(degrees, 360.0) / 90.0
    if quarters.is_integer():
        return (1 + 0j, 1j, -1 + 0j, -1j)[int(quarters) % 4]
    return cmath.rect(1.0, math.radians(90.0 * quarters))


_FUNCTION = re.compile(r"[\s,]*([A-Za-z]+)\s*\(([^()]*)\)[\s,]*")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_COUNTS = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}


def parse_transform(text: str) -> Affine:
    """Read a transform list, "translate(3 4) rotate(30)".

    Raises DrawingError for anything else, and where a number is beyond COORDINATE_MAX.
    """
    result = IDENTITY
    position = 0
    while position < len(text):
        match = _FUNCTION.match(text, position)
        if match is None:
            if not text[position:].strip(" \t\r\n,"):
                break
            raise _broken(text)
        position = match.end()
        result = result @ _function(match[1], match[2], text)
    if not max(abs(result.a), abs(result.b), abs(result.c)) <= COORDINATE_MAX:
        raise DrawingError(f"transform beyond {COORDINATE_MAX:g}", remedy="Draw in units that keep numbers small.")
    return result


def numbers(text: str) -> list[float] | None:
    """The numbers of a list that is separated by spaces or commas; None where anything else is in it."""
    rest = _NUMBER.sub(" ", text)
    if rest.strip(" \t\r\n\f,"):
        return None
    return [float(number) for number in _NUMBER.findall(text)]


def _function(name: str, arguments: str, text: str) -> Affine:
    """One function of a transform list."""
    v = numbers(arguments)
    if v is None or len(v) not in _COUNTS.get(name, ()) or not all(abs(value) <= COORDINATE_MAX for value in v):
        raise _broken(text)
    match name:
        case "matrix":
            return from_matrix(v[0], v[1], v[2], v[3], v[4], v[5])
        case "translate":
            return Affine(1 + 0j, 0j, complex(v[0], v[1] if len(v) > 1 else 0.0))
        case "scale":
            return from_matrix(v[0], 0.0, 0.0, v[-1], 0.0, 0.0)
        case "rotate":
            turn = rotation(v[0])
            centre = complex(v[1], v[2]) if len(v) > 1 else 0j
            return Affine(turn, 0j, centre - turn * centre)
        case "skewX":
            return from_matrix(1.0, 0.0, math.tan(math.radians(v[0])), 1.0, 0.0, 0.0)
        case _:
            return from_matrix(1.0, math.tan(math.radians(v[0])), 0.0, 1.0, 0.0, 0.0)


def _broken(text: str) -> DrawingError:
    shown = text if len(text) <= 60 else f"{text[:57]}..."
    return DrawingError(f"broken transform {shown!r}", remedy='Transforms read "translate(3 4) rotate(30)".')

"""SVG's transform lists as affine maps."""

from __future__ import annotations

import math
import re

from voronoi_tiles.base.maps import IDENTITY_MAP, Affine, from_matrix, unit_at
from voronoi_tiles.base.text import NUMBER
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.formats.shapes import DrawingError

_FUNCTION = re.compile(r"[\s,]*([A-Za-z]+)\s*\(([^()]*)\)[\s,]*")
_NUMBER = re.compile(NUMBER)
_COUNTS = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}


def parse_transform(text: str) -> Affine:
    """Read a transform list, "translate(3 4) rotate(30)".

    Raises DrawingError for anything else, and where a number is beyond COORDINATE_MAX.
    """
    result = IDENTITY_MAP
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
            turn = unit_at(v[0])
            centre = complex(v[1], v[2]) if len(v) > 1 else 0j
            return Affine(turn, 0j, centre - turn * centre)
        case "skewX":
            return from_matrix(1.0, 0.0, math.tan(math.radians(v[0])), 1.0, 0.0, 0.0)
        case _:
            return from_matrix(1.0, math.tan(math.radians(v[0])), 0.0, 1.0, 0.0, 0.0)


def _broken(text: str) -> DrawingError:
    shown = text if len(text) <= 60 else f"{text[:57]}..."
    return DrawingError(f"broken transform {shown!r}", remedy='Transforms read "translate(3 4) rotate(30)".')

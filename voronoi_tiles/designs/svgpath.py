"""SVG path data as cubic Bezier pieces: all commands, relative and absolute, compact numbers and flags.

Source: the path grammar and the implementation notes of SVG 1.1 and 2. Coordinates are taken as they are: y
runs up, as everywhere in a design file, so data copied from an SVG file shows its mirror image. Readers of
path data usually stop in silence at the first broken character, as SVG asks of viewers; a design must not
lose half a stroke, so here every character has to fit the grammar.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Iterator

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.tolerance import COORDINATE_MAX

_Piece = tuple[complex, complex, complex, complex]

_SPACE = re.compile(r"[ \t\n\r\f]*")
_SEPARATOR = re.compile(r"[ \t\n\r\f]*,?[ \t\n\r\f]*")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_FLAG = re.compile(r"[01]")

# What each command takes: n a number, f a flag; what a repetition of the arguments means where no letter precedes it.
_ARGUMENTS = {"M": "nn", "L": "nn", "H": "n", "V": "n", "C": "nnnnnn", "S": "nnnn", "Q": "nnnn", "T": "nn"}
_ARGUMENTS |= {"A": "nnnffnn", "Z": ""}
_REPEATED = {"M": "L", "m": "l"}

ARC_SHARE = 1e-3
"""The share of the accuracy that the step from an elliptical arc to cubics may use."""

_REMEDY = 'Write SVG path data such as "M 1 1 C 2 3 4 3 5 1"'


def path_pieces(data: str, accuracy: float) -> Complexes:
    """The drawn pieces of SVG path data as cubic Bezier control points, in drawing order.

    The result is complex128 of shape (k, 4). Straight pieces have their inner control points on their ends
    (p, p, q, q); quadratic curves are raised exactly; elliptical arcs are replaced by cubics that are
    within ARC_SHARE * `accuracy` of them. Pieces of zero length are left out; a piece that starts where the
    one before ends continues it, bit for bit. Raises DesignError, naming the position of the character
    (from 1), where the data breaks the grammar, or where nothing is drawn.
    """
    pieces = [piece for piece in _draw(data, accuracy) if not piece[0] == piece[1] == piece[2] == piece[3]]
    if not pieces:
        raise DesignError(
            "the path draws nothing", remedy=f"{_REMEDY}; an isolated point is a stroke {{ point = [x, y] }}."
        )
    return np.array(pieces, dtype=np.complex128)


def _broken(data: str, position: int, expected: str) -> DesignError:
    if position < len(data):
        return DesignError(
            f"broken SVG path data: {expected} expected at character {position + 1}, found {data[position]!r}",
            remedy=f"{_REMEDY}.",
        )
    return DesignError(
        f"broken SVG path data: {expected} expected at character {position + 1}, where the data ends",
        remedy=f"{_REMEDY}.",
    )


def _commands(data: str) -> Iterator[tuple[str, list[float]]]:
    """Every command with its arguments; implicit repetitions get their letter."""
    position = _skip(_SPACE, data, 0)
    first = True
    while position < len(data):
        letter = data[position]
        if letter.upper() not in _ARGUMENTS or (first and letter not in "Mm"):
            raise _broken(data, position, "M or m" if first else "a command letter")
        first = False
        position = _skip(_SPACE, data, position + 1)
        kinds = _ARGUMENTS[letter.upper()]
        while True:
            arguments = []
            for index, kind in enumerate(kinds):
                if index:
                    position = _skip(_SEPARATOR, data, position)
                match = (_NUMBER if kind == "n" else _FLAG).match(data, position)
                if match is None:
                    what = "a number" if kind == "n" else "a flag 0 or 1"
                    raise _broken(data, position, f"{what} for {letter}")
                value = float(match[0])
                if not abs(value) <= COORDINATE_MAX:
                    raise DesignError(
                        f"number beyond {COORDINATE_MAX:g} in SVG path data at character {position + 1}",
                        remedy="Draw in units that keep the numbers small.",
                    )
                arguments.append(value)
                position = match.end()
            yield letter, arguments
            following = _skip(_SEPARATOR if kinds else _SPACE, data, position)
            if not kinds or not _NUMBER.match(data, following):
                # A comma may only stand between numbers, not before a command or the end.
                position = _skip(_SPACE, data, position)
                break
            position = following
            letter = _REPEATED.get(letter, letter)
    if first:
        raise _broken(data, position, "M or m")


def _skip(pattern: re.Pattern[str], data: str, position: int) -> int:
    match = pattern.match(data, position)
    return match.end() if match else position


def _draw(data: str, accuracy: float) -> Iterator[_Piece]:
    here = start = 0j
    cubic: complex | None = None  # the last inner control point, where the last command was C or S
    quadratic: complex | None = None  # the same for Q or T
    for letter, v in _commands(data):
        origin = here if letter.islower() else 0j
        points = [complex(*pair) + origin for pair in zip(v[0::2], v[1::2], strict=False)]
        last_cubic, last_quadratic = cubic, quadratic
        cubic = quadratic = None
        match letter.upper():
            case "M":
                here = start = points[0]
                continue
            case "Z":
                yield here, here, start, start
                here = start
                continue
            case "L":
                end = points[0]
                piece = (here, here, end, end)
            case "H":
                end = complex(v[0] + origin.real, here.imag)
                piece = (here, here, end, end)
            case "V":
                end = complex(here.real, v[0] + origin.imag)
                piece = (here, here, end, end)
            case "C":
                first, cubic, end = points
                piece = (here, first, cubic, end)
            case "S":
                first = here if last_cubic is None else here + (here - last_cubic)
                cubic, end = points
                piece = (here, first, cubic, end)
            case "Q":
                quadratic, end = points
                piece = _raised(here, quadratic, end)
            case "T":
                quadratic = here if last_quadratic is None else here + (here - last_quadratic)
                end = points[0]
                piece = _raised(here, quadratic, end)
            case _:
                end = complex(v[5], v[6]) + origin
                yield from _arc(here, end, abs(v[0]), abs(v[1]), v[2], v[3] == 1.0, v[4] == 1.0, accuracy)
                here = end
                continue
        yield piece
        here = end


def _raised(start: complex, control: complex, end: complex) -> _Piece:
    return start, (start + 2.0 * control) / 3.0, (end + 2.0 * control) / 3.0, end


def _arc(
    start: complex, end: complex, rx: float, ry: float, degrees: float, large: bool, sweep: bool, accuracy: float
) -> Iterator[_Piece]:
    """Cubics for an elliptical arc given by its end points.

    In coordinates where the ellipse is a unit circle, the chord has half length h and the arc half angle
    asin(h), or pi - asin(h) for the large one; everything is measured from the middle of the chord, which
    stays exact for radii that are huge beside the chord, where the usual formulas by the centre cancel.
    Radii that are too small are enlarged, and no radius means a line, as SVG says. A cubic with handles 4/3
    tan(t/4) is within 4/27 sin(t/4)^6 / cos(t/4)^2 of a unit arc of angle t (Goldapp, "Approximation of
    circular arcs by cubic polynomials", 1991).
    """
    if start == end:
        return
    if rx == 0.0 or ry == 0.0:
        yield start, start, end, end
        return
    turn = cmath.rect(1.0, math.radians(math.fmod(degrees, 360.0)))
    half = (end - start) / 2.0 * turn.conjugate()
    half = complex(half.real / rx, half.imag / ry)
    h = abs(half)
    if h >= 1.0:
        rx, ry, h, phi = rx * h, ry * h, 1.0, math.pi / 2.0
        along = half / abs(half)
    else:
        phi = math.pi - math.asin(h) if large else math.asin(h)
        along = half / h
    bulge = along * (-1j if sweep else 1j)
    middle = (start + end) / 2.0

    # The share as an error of the unit circle; below 1e-18 it is under the rounding of the coordinates anyway.
    share = max(ARC_SHARE * accuracy / max(rx, ry), 1e-18)
    step = min(math.pi / 2.0, 4.0 * (share * math.cos(math.pi / 8.0) ** 2 * 27.0 / 4.0) ** (1.0 / 6.0))
    count = math.ceil(2.0 * phi / step)
    handle = 4.0 / 3.0 * math.tan(phi / (2.0 * count))

    def placed(unit: complex) -> complex:
        return complex(unit.real * rx, unit.imag * ry) * turn

    def point(psi: float) -> complex:
        # cos(psi) - cos(phi) as a product, free of cancellation
        height = 2.0 * math.sin((phi - psi) / 2.0) * math.sin((phi + psi) / 2.0)
        return middle + placed(math.sin(psi) * along + height * bulge)

    def tangent(psi: float) -> complex:
        return placed(handle * (math.cos(psi) * along - math.sin(psi) * bulge))

    angles = [phi * (2 * k - count) / count for k in range(count + 1)]
    knots = [start, *(point(psi) for psi in angles[1:-1]), end]
    for k in range(count):
        yield knots[k], knots[k] + tangent(angles[k]), knots[k + 1] - tangent(angles[k + 1]), knots[k + 1]

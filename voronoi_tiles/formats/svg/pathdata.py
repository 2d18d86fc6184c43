"""SVG path data, read strictly: every character fits the grammar, and curves stay what they are.

Viewers stop in silence at the first broken character; what is to be cut must not lose half an outline.
"""

from __future__ import annotations

import cmath
import math
import re
from typing import Final

from voronoi_tiles.base.maps import Affine, unit_at
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.formats.pen import Pen
from voronoi_tiles.formats.shapes import DrawingError

_NUMBER: Final = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_FIND: Final = re.compile(_NUMBER)
_COMMA: Final = r"(?:[ \t\n\r\f]++,?[ \t\n\r\f]*+|,[ \t\n\r\f]*+)?"
_LIST: Final = re.compile(rf"[ \t\n\r\f]*(?:{_NUMBER}(?:{_COMMA}{_NUMBER})*+)?[ \t\n\r\f]*")
_ARC: Final = re.compile(
    rf"({_NUMBER}){_COMMA}({_NUMBER}){_COMMA}({_NUMBER}){_COMMA}([01]){_COMMA}([01]){_COMMA}({_NUMBER}){_COMMA}({_NUMBER})"
)
_SEPARATOR: Final = re.compile(_COMMA)
_END: Final = re.compile(r"[ \t\n\r\f]*\Z")
_SPACE: Final = " \t\n\r\f"
_COMMANDS: Final = re.compile(r"([MmZzLlHhVvCcSsQqTtAa])")
_COUNTS: Final = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2}
_REMEDY: Final = "Save the drawing again in the program that made it."


def draw_path(pen: Pen, data: str) -> None:
    """Draw SVG path data.

    Raises DrawingError, naming the position of the character (from 1), where the data breaks the grammar, and for
    numbers beyond COORDINATE_MAX.
    """
    parts = _COMMANDS.split(data)
    if parts[0].strip(_SPACE):
        raise _broken(0, "M or m expected")
    if len(parts) > 1 and parts[1] not in "Mm":
        raise _broken(len(parts[0]), "M or m expected")
    reader = _Commands(pen)
    position = len(parts[0])
    for letter, text in zip(parts[1::2], parts[2::2], strict=True):
        if letter in "Zz":
            if text.strip(_SPACE):
                raise _broken(position + 1, "a command expected")
            reader.close()
        elif letter in "Aa":
            reader.arcs(_arc_arguments(text, position + 1), letter == "a")
        else:
            values = _values(text, position + 1, _COUNTS[letter.upper()], letter)
            reader.draw(letter, values)
        position += 1 + len(text)


def _values(text: str, position: int, count: int, letter: str) -> list[float]:
    """The arguments of a command."""
    if _LIST.fullmatch(text) is None:
        matched = _LIST.match(text)
        raise _broken(position + (matched.end() if matched else 0), f"a number for {letter} expected")
    values = [float(number) for number in _FIND.findall(text)]
    if not values or len(values) % count:
        raise _broken(position + len(text), f"{letter} takes numbers by {count}")
    if not (max(values) <= COORDINATE_MAX and min(values) >= -COORDINATE_MAX):
        raise _too_large(position)
    return values


def _arc_arguments(text: str, position: int) -> list[tuple[float, ...]]:
    """The arguments of arcs, seven each; flags need no separator after them."""
    result = []
    at = len(text) - len(text.lstrip(_SPACE))
    while True:
        match = _ARC.match(text, at)
        if match is None:
            raise _broken(position + at, "radii, rotation, two flags and a point for A expected")
        values = tuple(float(number) for number in match.groups())
        if not max(abs(value) for value in values) <= COORDINATE_MAX:
            raise _too_large(position + at)
        result.append(values)
        at = match.end()
        if _END.match(text, at):
            return result
        between = _SEPARATOR.match(text, at)
        assert between is not None  # it matches nothing, too
        at = between.end()


class _Commands:
    """Draws commands one after the other: relative ones, and those that continue the curve before."""

    def __init__(self, pen: Pen) -> None:
        self._pen = pen
        self._cubic: complex | None = None
        self._quad: complex | None = None

    def close(self) -> None:
        self._pen.close()
        self._cubic = self._quad = None

    def draw(self, letter: str, values: list[float]) -> None:
        """One command with all its repetitions."""
        relative = letter.islower()
        command = letter.upper()
        if command in "HV":
            self._straight(values, relative, command == "H")
        else:
            points = [complex(x, y) for x, y in zip(values[0::2], values[1::2], strict=True)]
            self._through(command, points, relative)

    def _straight(self, values: list[float], relative: bool, level: bool) -> None:
        """H and V."""
        self._cubic = self._quad = None
        for value in values:
            here = self._pen.here
            if level:
                self._pen.line(complex(value + (here.real if relative else 0.0), here.imag))
            else:
                self._pen.line(complex(here.real, value + (here.imag if relative else 0.0)))

    def _through(self, command: str, points: list[complex], relative: bool) -> None:
        """The commands that take points."""
        pen = self._pen
        match command:
            case "M":
                pen.move(points[0] + pen.here if relative else points[0])
                self._lines(points[1:], relative)
            case "L":
                self._lines(points, relative)
            case "C":
                for k in range(0, len(points), 3):
                    base = pen.here if relative else 0j
                    self._cubic = points[k + 1] + base
                    pen.cubic(points[k] + base, self._cubic, points[k + 2] + base)
                self._quad = None
            case "S":
                for k in range(0, len(points), 2):
                    base = pen.here if relative else 0j
                    first = pen.here if self._cubic is None else 2 * pen.here - self._cubic
                    self._cubic = points[k] + base
                    pen.cubic(first, self._cubic, points[k + 1] + base)
                self._quad = None
            case "Q":
                for k in range(0, len(points), 2):
                    base = pen.here if relative else 0j
                    self._quad = points[k] + base
                    pen.quad(self._quad, points[k + 1] + base)
                self._cubic = None
            case _:
                for point in points:
                    base = pen.here if relative else 0j
                    self._quad = pen.here if self._quad is None else 2 * pen.here - self._quad
                    pen.quad(self._quad, point + base)
                self._cubic = None

    def arcs(self, arguments: list[tuple[float, ...]], relative: bool) -> None:
        """Elliptical arcs by their end points."""
        self._cubic = self._quad = None
        for rx, ry, degrees, large, sweep, x, y in arguments:
            end = complex(x, y) + (self._pen.here if relative else 0j)
            draw_arc(self._pen, abs(rx), abs(ry), degrees, large == 1.0, sweep == 1.0, end)

    def _lines(self, points: list[complex], relative: bool) -> None:
        self._cubic = self._quad = None
        for point in points:
            self._pen.line(point + self._pen.here if relative else point)


def draw_arc(pen: Pen, rx: float, ry: float, degrees: float, large: bool, sweep: bool, end: complex) -> None:
    """Draw an elliptical arc from the pen's place to `end`.

    Radii that are too small are enlarged, and no radius means a line, as SVG says.
    """
    start = pen.here
    if start == end:
        return
    if min(rx, ry) < 1e-100:  # or so near to none that the chord, divided by it, is no number
        pen.line(end)
        return
    turn = unit_at(degrees)
    half = (end - start) / 2 * turn.conjugate()
    half = complex(half.real / rx, half.imag / ry)
    h = abs(half)
    if not h > 1e-12:  # the circle is so large beside the chord that the arc is a line, or the whole circle
        pen.line(end)
        return
    if h >= 1.0:
        rx, ry, half, h = rx * h, ry * h, half / h, 1.0
    # On the unit circle: the chord runs from -half to half about its middle, the centre lies beside that.
    beside = half / h * math.sqrt(max(0.0, 1.0 - h * h)) * 1j
    centre = beside if large != sweep else -beside
    begin = cmath.phase(-half - centre)
    angle = cmath.phase((half - centre) / (-half - centre)) % math.tau
    if not sweep:
        angle -= math.tau
    to_ellipse = Affine(turn * (rx + ry) / 2, turn * (rx - ry) / 2, 0j)
    middle = (start + end) / 2 + to_ellipse(centre)
    pen.ellipse(middle, to_ellipse, begin, angle, end)


def _broken(position: int, expected: str) -> DrawingError:
    return DrawingError(f"broken path data: {expected} at character {position + 1}", remedy=_REMEDY)


def _too_large(position: int) -> DrawingError:
    return DrawingError(
        f"number beyond {COORDINATE_MAX:g} in path data after character {position}",
        remedy="Draw in units that keep the numbers small.",
    )

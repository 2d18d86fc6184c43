"""G-code of lasers, read strictly: what burns, as lines and arcs, in the order in which it is burnt.

Read is what GRBL 1.1 takes of a file for a laser: moves in the plane, in millimetres or inches, absolute or relative,
arcs by their centres, M3 to M5, F and S. Whatever else would move the head ends the reading, with line and word.
"""

from __future__ import annotations

import re
from cmath import exp, phase
from io import BytesIO, TextIOWrapper
from math import pi
from typing import Final

import numpy as np

from voronoi_tiles.base.text import printable
from voronoi_tiles.formats.decimals import LARGEST
from voronoi_tiles.formats.gcode.writer import LAYER
from voronoi_tiles.formats.shapes import GCODE_BYTES_MAX, LINES_MAX, SEGMENTS_MAX, DrawingError, ReadDrawing, Shape
from voronoi_tiles.paths.paths import ARC, LINE, Paths

_WORD: Final = re.compile(r"([A-Za-z])([+-]?(?:\d+\.?\d*|\.\d+))", re.ASCII)
_COMMENT: Final = re.compile(r"\([^)]*\)?|;.*")
_INCH: Final = 25.4
_LINE_MAX: Final = 1_000
"""Most characters of a line's words; a count. GRBL takes 79, other controllers some 250."""
_LAYER: Final = f"; {LAYER}"

_MOTIONS: Final = (0, 1, 2, 3)
_LASER: Final = (3, 4, 5)
_IDLE: Final = {"G": (4, 17, 40, 49, 80, 91.1, 94), "M": (0, 1, 7, 8, 9)}
"""Words that move nothing."""

_ORIGINS: Final = (54, 55, 56, 57, 58, 59)

_ENDS: Final = (2, 30)

_MODES: Final[dict[tuple[str, float], str]] = {
    **{("G", value): "move" for value in (*_MOTIONS, 80)},
    **{("G", value): "unit" for value in (20, 21)},
    **{("G", value): "origin" for value in _ORIGINS},
    **{("G", value): "way to count" for value in (90, 91)},
    **{("M", value): "state of the laser" for value in _LASER},
}
"""What a word sets; of the words that set one thing a line has one, or GRBL refuses it (error 21)."""
_ABSENT: Final = {
    "R": "arcs are read by their centres, I and J",
    "Z": "a laser's moves are in the plane, X and Y",
}
"""Words that other files have, and why they are not read."""

_REMEDY: Final = "Leave it out, or write the file for GRBL's lasers."


def gcode_drawing(data: bytes, name: str) -> ReadDrawing:
    """What a G-code file burns, in millimetres, y up; `name` is that of the file.

    A shape is what is burnt without a change of layer, which comments "; layer NAME" name as ours do, and else feed and
    power; its paths are what the laser goes along without a break. Moves with S0, or after M5, burn nothing. Raises
    DrawingError, which names line and word, for what is not understood, for arcs that GRBL refuses, and where the
    laser burns from a place that the file does not say.
    """
    if len(data) > GCODE_BYTES_MAX:
        raise DrawingError(f"larger than {GCODE_BYTES_MAX >> 20} MiB", file=name, remedy="Split it.")
    # A line ends with either, or both.
    if max(data.count(b"\n"), data.count(b"\r")) > LINES_MAX:
        raise DrawingError(f"has more than {LINES_MAX:,} lines", file=name, remedy="Split it.")
    tool = _LaserHead(name)
    for number, line in enumerate(TextIOWrapper(BytesIO(data), "utf-8-sig", errors="replace"), 1):
        if not line.isspace() and not tool.step(number, line):
            break
    return ReadDrawing(
        format="gcode",
        width=None,
        height=None,
        unit="mm" if tool.scale == 1.0 else "in",
        unit_known=True,
        shapes=tuple(tool.shapes()),
    )


class _LaserHead:
    """The head of a laser: where it is and in what modes, and what it has burnt."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._line, self._text = 0, ""
        self._place: tuple[float | None, float | None] = (None, None)
        self._motion: float | None = None
        self._origin = 54.0
        self.scale = 1.0
        self._relative = self._on = False
        self._feed = self._power = 0.0
        self._layer = ""
        self._burning = False  # whether the last move burnt, so that the next one goes on from it
        self._named: list[tuple[str, int]] = []  # each shape's layer, and the number of its first path
        self._firsts: list[int] = []  # the first segment of each path
        self._start: list[complex] = []
        self._middle: list[complex | None] = []
        self._end: list[complex] = []

    def step(self, number: int, line: str) -> bool:
        """Go through a line of the file; whether there are more."""
        self._line, self._text = number, line.strip()
        if line.startswith(_LAYER):
            self._layer, self._burning = line[len(_LAYER) :].strip(), False
        text = "".join(_COMMENT.sub("", line).split())
        if not text or text == "%":
            return True
        words = self._words(text)
        motion: float | None = None
        for letter, value, word in words:
            if letter == "G":
                motion = self._mode(value, word, motion)
            elif letter == "M":
                if value in _ENDS:
                    return False
                self._laser(value, word)
            elif letter == "F":
                self._feed = value
            elif letter == "S":
                self._power = value
            elif letter in _ABSENT:
                raise self._error(f"{word} is not understood: {_ABSENT[letter]}")
            elif letter not in "XYIJNPT":
                raise self._error(f"{word} is not understood")
        self._motion = self._motion if motion is None else motion
        given = {letter: value * self.scale for letter, value, _ in words if letter in "XYIJ"}
        if given:
            self._move(given)
        return True

    def shapes(self) -> list[Shape]:
        """What was burnt."""
        if not self._start:
            return []
        middle = np.array([0j if point is None else point for point in self._middle])
        offsets = np.array([*self._firsts, len(self._start)], np.intp)
        start, end = np.array(self._start), np.array(self._end)
        paths = Paths(
            start=start,
            end=end,
            control=np.column_stack((middle, np.zeros_like(middle))),
            kind=np.array([LINE if point is None else ARC for point in self._middle], np.uint8),
            offsets=offsets,
            closed=start[offsets[:-1]] == end[offsets[1:] - 1],
        )
        firsts = [first for _, first in self._named]
        return [
            Shape(paths.part(low, high), layer, "#000000", None, None, layer)
            for (layer, low), high in zip(self._named, [*firsts[1:], len(paths)], strict=True)
        ]

    def _error(self, message: str, remedy: str = _REMEDY) -> DrawingError:
        shown = printable(self._text[:60])[:60]
        return DrawingError(f"{shown!r}: {message}", file=self._name, line=self._line, remedy=remedy)

    def _words(self, text: str) -> list[tuple[str, float, str]]:
        """The words of a line without spaces: letter, number, and both as they are written."""
        if len(text) > _LINE_MAX:
            raise self._error(f"more than {_LINE_MAX:,} characters", "Write one move in a line.")
        found = [(match[1].upper(), float(match[2]), match[0]) for match in _WORD.finditer(text)]
        if sum(len(word) for _, _, word in found) != len(text):
            rest = next(part for part in _WORD.sub(" ", text).split(" ") if part)
            raise self._error(f"{printable(rest)[:20]} is no word", "Words are a letter and a number, such as X12.5.")
        seen: set[str] = set()
        for letter, value, word in found:
            mode = _MODES.get((letter, value), "")
            if mode in seen or letter in seen:
                what = f"{word} is a second {mode}" if mode else f"{letter} stands twice"
                raise self._error(f"{what} in a line", "Write one move in a line.")
            seen.update(part for part in (mode, "" if letter in "GM" else letter) if part)
        return found

    def _mode(self, value: float, word: str, motion: float | None) -> float | None:
        """Take a G word; the motion of the line."""
        if value in _MOTIONS:
            return value
        if value in (20, 21):
            scale = _INCH if value == 20 else 1.0
            if self._start and scale != self.scale:
                raise self._error(f"{word} changes the unit within the drawing")
            self.scale = scale
        elif value in _ORIGINS:
            if self._place != (None, None) and value != self._origin:
                raise self._error(f"{word} changes the origin within the drawing")
            self._origin = value
        elif value in (90, 91):
            self._relative = value == 91
        elif value not in _IDLE["G"]:
            raise self._error(f"{word} is not understood")
        return motion

    def _laser(self, value: float, word: str) -> None:
        """Take an M word."""
        if value in _LASER:
            self._on = value != 5
        elif value not in _IDLE["M"]:
            raise self._error(f"{word} is not understood")

    def _move(self, given: dict[str, float]) -> None:
        """Go where a line says."""
        if self._motion is None:
            raise self._error("this goes somewhere, and no line says how", "Write G0 or G1 in front of it.")
        x, y = self._place
        if self._relative:
            x, y = x or 0.0, y or 0.0  # the drawing is where the head is
            self._place = x + given.get("X", 0.0), y + given.get("Y", 0.0)
        else:
            self._place = given.get("X", x), given.get("Y", y)
        if any(abs(value) > LARGEST for value in (*given.values(), *self._place) if value is not None):
            raise self._error(f"this goes beyond {LARGEST:,.0f} mm", "Check its unit.")
        round_ = self._motion in (2, 3)
        if self._place == (x, y) and not round_:
            return
        burns = self._on and self._power > 0.0 and self._motion != 0
        if not burns:
            self._burning = False
            return
        to_x, to_y = self._place
        if x is None or y is None or to_x is None or to_y is None:
            raise self._error("this burns from a place that no line says", "Write G0 with X and Y before it.")
        here, there = complex(x, y), complex(to_x, to_y)
        self._burn(here, self._arc(here, there, given) if round_ else [(None, there)])

    def _burn(self, here: complex, parts: list[tuple[complex | None, complex]]) -> None:
        """Go along lines and arcs with the laser on."""
        if self._feed <= 0.0:
            raise self._error("this burns, and no line says how fast", "Write a feed, such as F600.")
        layer = self._layer or f"F{self._feed:g} S{self._power:g}"
        if not self._named or self._named[-1][0] != layer:
            self._named.append((layer, len(self._firsts)))
            self._burning = False
        if not self._burning:
            self._firsts.append(len(self._start))
        for middle, there in parts:
            self._start.append(here)
            self._middle.append(middle)
            self._end.append(there)
            here = there
        self._burning = True
        if len(self._start) > SEGMENTS_MAX:
            raise self._error(f"more than {SEGMENTS_MAX:,} moves", "Split the file.")

    def _arc(self, here: complex, there: complex, given: dict[str, float]) -> list[tuple[complex | None, complex]]:
        """The arc that a line says, in halves where it is a whole circle: for each part its middle and its end."""
        if "I" not in given and "J" not in given:
            raise self._error("this is an arc without a centre", "Write I and J.")
        centre = here + complex(given.get("I", 0.0), given.get("J", 0.0))
        one, two = abs(here - centre), abs(there - centre)
        # GRBL's error 33, see the writer.
        if one == 0.0 or abs(one - two) > min(max(0.005, 0.001 * one), 0.5):
            raise self._error(
                f"this arc begins {one:.6g} mm from its centre, and ends {two:.6g} mm from it",
                "Write I and J from where it begins to its centre.",
            )
        turn = phase((there - centre) / (here - centre)) if here != there else 0.0
        if self._motion == 3 and turn <= 0.0:
            turn += 2 * pi
        elif self._motion == 2 and turn >= 0.0:
            turn -= 2 * pi
        ray = (here - centre) * (0.5 + 0.5 * two / one)

        def point(share: float) -> complex:
            return centre + ray * exp(1j * turn * share)

        if here != there:
            return [(point(0.5), there)]
        return [(point(0.25), point(0.5)), (point(0.75), there)]

"""SVG path data, read strictly: every character fits the grammar, and curves stay what they are.

Viewers stop in silence at the first broken character; what is to be cut must not lose half an outline. A message names
the first character that does not continue the grammar, counted from 1; where the data end too early, it is the one
after the last. Source: SVG 1.1, 8.3.
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from voronoi_tiles.base.text import NUMBER
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.formats.pen import CLOSE, MOVE, POINTS, PathPen
from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.paths.ellipses import EllipticalArc
from voronoi_tiles.paths.paths import CUBIC, LINE, QUAD

# What each command takes: n a number, f a flag.
_ARGUMENTS: Final = {"M": "nn", "L": "nn", "H": "n", "V": "n", "C": "nnnnnn", "S": "nnnn", "Q": "nnnn", "T": "nn"}
_ARGUMENTS.update(A="nnnffnn", Z="")
_KINDS: Final = {"C": CUBIC, "S": CUBIC, "Q": QUAD, "T": QUAD}
_LETTERS: Final = "MmLlHhVvCcSsQqTtAaZz"
_NUMERALS: Final = b"0123456789+-.eE"
_BLANKS: Final = b" \t\n\r\f"
_CHARACTERS: Final = _LETTERS.encode() + _NUMERALS + b"," + _BLANKS

_SPACE: Final = re.compile(r"[ \t\n\r\f]*")
_SEPARATOR: Final = re.compile(r"[ \t\n\r\f]*,?[ \t\n\r\f]*")
_NUMBER: Final = re.compile(NUMBER)
_FLAG: Final = re.compile(r"[01]")
_COMMAND: Final = re.compile(rf"([{_LETTERS}])")
# A comma that is not between two numbers.
_STRAY_COMMA: Final = re.compile(rf"(?:\A|[{_LETTERS},])[ \t\n\r\f]*+,|,[ \t\n\r\f]*+(?:[{_LETTERS}]|\Z)")
_ARC: Final = re.compile(r"[ \t\n\r\f]*".join({"n": f"({NUMBER})", "f": "([01])"}[kind] for kind in _ARGUMENTS["A"]))

_LONG: Final = 1000
"""From so many characters on, data are drawn at once, where they can be."""

_BLANK, _NUMERAL = -1, -2
_SIGNS: Final = np.full(256, _BLANK, np.int8)  # what a character is: the kind that its letter stands for, or these
_SIGNS[np.frombuffer(_NUMERALS, np.uint8)] = _NUMERAL
_SIGNS[np.frombuffer(b"MLQCZz", np.uint8)] = [MOVE, LINE, QUAD, CUBIC, CLOSE, CLOSE]
_AT_ONCE: Final = b"MLQCZz" + _NUMERALS + _BLANKS
_LETTERS_TO_BLANKS: Final = bytes.maketrans(b"MLQCZz", b"      ")

_REMEDY: Final = "Save the drawing again in the program that made it."


def draw_path(pen: PathPen, data: str, *, remedy: str = _REMEDY) -> None:
    """Draw SVG path data, in its own coordinates; none at all draw nothing.

    Raises DrawingError, naming the position of the character, where the data break the grammar, with `remedy`, and for
    numbers beyond COORDINATE_MAX.
    """
    plain = _without_commas(data)
    if plain is None:
        raise _first_error(data, remedy)
    if len(plain) > _LONG and _drawn_at_once(pen, plain):
        return
    parts = _COMMAND.split(plain)
    if parts[0].strip() or (len(parts) > 1 and parts[1] not in "Mm"):
        raise _first_error(data, remedy)
    here = start = 0j
    bent, control = LINE, 0j  # the kind of the curve before, and the control point next to its end
    for letter, text in zip(parts[1::2], parts[2::2], strict=True):
        values = _numbers(letter, text)
        if values is None:
            raise _first_error(data, remedy)
        command, relative = letter.upper(), letter.islower()
        kind = _KINDS.get(command, LINE)
        values = _absolute(values, command, here, relative)
        match command:
            case "M":
                here = start = complex(values[0], values[1])
                pen.move(here)
                values = values[2:]
            case "Z":
                here = start
                pen.close()
            case "A":
                here = _draw_arcs(pen, values, here, relative)
                values = []
            case "S" | "T":
                values = _smooth(values, len(_ARGUMENTS[command]), here, control if bent == kind else None)
        bent = kind
        if values:
            pen.draw(kind, values)
            here = complex(values[-2], values[-1])
        if bent != LINE:
            control = complex(values[-4], values[-3])


def _without_commas(data: str) -> str | None:
    """The data with spaces in the place of commas; None where a comma or another character is out of place."""
    if not data.isascii() or data.encode().translate(None, _CHARACTERS):
        return None
    if "," in data:
        return None if _STRAY_COMMA.search(data) else data.replace(",", " ")
    return data


def _drawn_at_once(pen: PathPen, data: str) -> bool:
    """Draw data of absolute M, L, Q, C and Z, with spaces between their numbers; False, and nothing, for all others.

    That is what programs write for cutters, by the ten thousand; command by command a file of them takes twice as long.
    """
    text = data.encode()
    if text.translate(None, _AT_ONCE):
        return False
    try:
        values = np.array([*map(float, text.translate(_LETTERS_TO_BLANKS).split())])
    except ValueError:
        return False
    signs = _SIGNS[np.frombuffer(text, np.uint8)]
    numeral, letters = signs == _NUMERAL, np.flatnonzero(signs >= 0)
    begins = np.flatnonzero(np.diff(numeral, prepend=False) & numeral)  # of numbers: each ends at a blank or a letter
    kind = signs[letters].astype(np.uint8)
    counts = np.diff(np.append(np.searchsorted(begins, letters), len(values)))
    size = 2 * POINTS[kind]
    times = np.where(kind == CLOSE, 1, counts // np.maximum(size, 1))
    if (
        not len(kind)
        or kind[0] != MOVE
        or len(values) != counts.sum()
        or (times * size != counts).any()
        or (times == 0).any()
        or not np.abs(values).max() <= COORDINATE_MAX
    ):
        return False
    kinds = np.repeat(kind, times)
    # What follows the first point of a move are lines.
    repeated = np.ones(len(kinds), np.bool_)
    repeated[np.cumsum(times) - times] = False
    kinds[repeated & (kinds == MOVE)] = LINE
    pen.draw_paths(kinds, values)
    return True


def _numbers(letter: str, text: str) -> list[float] | None:
    """The arguments of a command, once or more often; None where they are broken."""
    if letter in "Aa":
        rows = _ARC.findall(text)
        return _floats([token for row in rows for token in row], text, 7)
    kinds = _ARGUMENTS[letter.upper()]
    if not kinds:
        return None if text.strip() else []
    try:
        # Python's own numbers are the grammar's, without letters and underscores.
        values = [*map(float, text.split())]
    except ValueError:
        return _floats(_NUMBER.findall(text), text, len(kinds))  # numbers without spaces between them
    return values if values and not len(values) % len(kinds) and _are_small(values) else None


def _floats(tokens: list[str], text: str, count: int) -> list[float] | None:
    """Numbers by `count` from their tokens; None where these leave something of the text over."""
    if not tokens or len(tokens) % count or "".join(tokens) != "".join(text.split()):
        return None
    values = [*map(float, tokens)]
    return values if _are_small(values) else None


def _are_small(values: list[float]) -> bool:
    return max(values) <= COORDINATE_MAX and min(values) >= -COORDINATE_MAX


def _absolute(values: list[float], command: str, here: complex, relative: bool) -> list[float]:
    """The coordinates of a command measured from the origin, H and V made points; not those of A."""
    x, y = here.real, here.imag
    if command in "HV":
        ends = []
        for value in values:
            if command == "H":
                x = value + x if relative else value
            else:
                y = value + y if relative else value
            ends += [x, y]
        return ends
    if relative and command in "MLCSQT":
        size = len(_ARGUMENTS[command])
        for first in range(0, len(values), size):
            for k in range(first, first + size, 2):
                values[k] += x
                values[k + 1] += y
            x, y = values[first + size - 2], values[first + size - 1]
    return values


def _smooth(values: list[float], size: int, here: complex, control: complex | None) -> list[float]:
    """Curves with their first control points, which mirror the last ones of the curves before; `size` numbers each."""
    whole: list[float] = []
    for first in range(0, len(values), size):
        mirrored = here if control is None else here + (here - control)
        whole += (mirrored.real, mirrored.imag, *values[first : first + size])
        control, here = complex(whole[-4], whole[-3]), complex(whole[-2], whole[-1])
    return whole


def _draw_arcs(pen: PathPen, values: list[float], here: complex, relative: bool) -> complex:
    """Draw elliptical arcs; gives the end."""
    for k in range(0, len(values), 7):
        rx, ry, degrees, large, sweep, x, y = values[k : k + 7]
        end = complex(x, y) + (here if relative else 0j)
        radii = abs(rx), abs(ry)
        arc = None if end == here else EllipticalArc.between(here, end, radii, degrees, large == 1.0, sweep == 1.0)
        if arc is None:
            pen.draw(LINE, [end.real, end.imag])
        else:
            pen.elliptical(arc)
        here = end
    return here


def _first_error(data: str, remedy: str) -> DrawingError:
    """The error at the first character of broken data that does not continue the grammar."""

    def broken(expected: str) -> DrawingError:
        found = f"found {data[at]!r}" if at < len(data) else "where the data end"
        return DrawingError(f"broken SVG path data: {expected} expected at character {at + 1}, {found}", remedy=remedy)

    at = _skip(_SPACE, data, 0)
    letters, expected = "Mm", "M or m"
    while at < len(data) and data[at] in letters:
        letter = data[at]
        letters, expected = _LETTERS, "a command letter"
        at = following = _skip(_SPACE, data, at + 1)
        kinds = _ARGUMENTS[letter.upper()]
        while kinds:
            for index, kind in enumerate(kinds):
                if index:
                    at = _skip(_SEPARATOR, data, at)
                match = (_NUMBER if kind == "n" else _FLAG).match(data, at)
                if match is None:
                    return broken(f"{'a number' if kind == 'n' else 'a flag 0 or 1'} for {letter}")
                if not abs(float(match[0])) <= COORDINATE_MAX:
                    return DrawingError(
                        f"number beyond {COORDINATE_MAX:g} in SVG path data at character {at + 1}",
                        remedy="Draw in units that keep the numbers small.",
                    )
                at = match.end()
            following = _skip(_SEPARATOR, data, at)
            if not _NUMBER.match(data, following):
                break
            at = following
        # A comma may only stand between numbers, not before a command or the end.
        at = _skip(_SPACE, data, at)
    return broken(expected)


def _skip(pattern: re.Pattern[str], data: str, position: int) -> int:
    """The position after what a pattern matches; it may match nothing."""
    match = pattern.match(data, position)
    return match.end() if match else position

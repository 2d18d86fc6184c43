"""G-code for GRBL 1.1 in laser mode: straight lines and circular arcs, millimetres, absolute, y up.

What GRBL does with a file, from its source (1.1, github.com/gnea/grbl):

- gcode.c: the radii from an arc's centre to its two ends may differ by 0.005 mm, or by 0.1 % where that is more, and by
  0.5 mm at most; else error 33. An arc that ends where it begins is a full circle.
- motion_control.c: so is one whose angle is below 5e-7 by single-precision numbers. Its arcs are computed in these.
- protocol.c: a line has 79 characters at most, spaces and comments not counted; other controllers count them.
- serial.c: the characters ? ! ~ and all beyond ASCII are commands as soon as they arrive, also within comments.
- gcode.c and stepper.c: in laser mode, $32=1, the beam is off in G0 moves, and with M4 its power follows the speed.

Other programs want more: a G word on every line, no number that ends with a point, arcs of less than half a circle with
X, Y, I and J.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import BinaryIO, Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints
from voronoi_tiles.formats.burns import Burn
from voronoi_tiles.formats.decimals import decimal_texts
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.formats.path_blocks import path_blocks
from voronoi_tiles.paths.conversion import chords
from voronoi_tiles.paths.paths import ARC, LINE, Paths

GRID_MM: Final = 1e-4
"""The last decimal that is written; millimetres. Single-precision numbers hold no finer ones beyond a metre."""

FLAT_MM: Final = 2 * GRID_MM
"""Arcs that rise less over their chords are lines; millimetres. The rounding might turn them round."""

ROUNDING_MM: Final = 3e-4
"""How far what is written may lie from the drawing; millimetres: half the diagonal of the grid, and FLAT_MM."""

RADIUS_MAX_MM: Final = 1_000.0
"""Arcs of larger circles become lines within FLAT_MM; millimetres. GRBL's numbers are coarser than the grid there."""

TURN_MAX: Final = np.deg2rad(170.0)
"""The largest angle of an arc; radians. From half a circle on readers disagree on its side."""

LINE_MAX: Final = 79
"""Most characters of a line, comments too."""

_STRAIGHT_MM: Final = 1e9
"""Arcs of circles as large are straight; millimetres."""

LAYER: Final = "layer "
"""How the comment begins that names a layer."""

_RECIPE: Final = "; recipe "

_COMMANDS: Final = re.compile("[?!~();%]")
"""What a controller, or a program that sends to it, may not take as part of a comment."""

_BRACKETS: Final = str.maketrans("()", "[]")


def write_gcode(drawing: Drawing, file: BinaryIO) -> None:
    """Write a drawing as G-code, layers and paths in the order of the drawing, each burnt as its layer says.

    Paths are of LINE and ARC. The origin is the page's lower left corner, in whatever work coordinates the machine has.
    Between paths the head moves by G0, with S0; at the end the laser is off, and the head stays. Coordinates are
    rounded to GRID_MM; all that is written lies within ROUNDING_MM. The recipe stands as JSON in comments at the top.
    The same drawing gives the same bytes.

    Raises ValueError for segments of another kind, filled layers, and layers without `burn`.
    """
    for layer in drawing.layers:
        _refuse(layer)
    file.write("".join(f"{line}\n" for line in _head(drawing)).encode("ascii"))
    for layer in drawing.layers:
        assert layer.burn is not None
        file.write(f"{_comment(LAYER + layer.name)}\n".encode("ascii"))
        for block in path_blocks(layer.paths):
            paths = block.moved(1.0, complex(0.0, -drawing.bottom))
            file.write("".join(_moves(paths, layer.burn)).encode("ascii"))
    file.write(b"M5 S0\n")


def _refuse(layer: Layer) -> None:
    """Raise ValueError for a layer that cannot be written."""
    if layer.burn is None:
        raise ValueError(f'G-code needs feed and power, and layer "{layer.name}" has none')
    if layer.filled:
        raise ValueError(f'G-code goes along lines, and layer "{layer.name}" is filled')
    if not np.isin(layer.paths.kind, (LINE, ARC)).all():
        raise ValueError(f'G-code has lines and arcs; layer "{layer.name}" has other curves')


# --- comments ---------------------------------------------------------------------------------------------------


def _head(drawing: Drawing) -> Iterator[str]:
    """The lines before the first layer."""
    yield _comment(f"title {drawing.title}")
    yield f"; {drawing.width:.6g} x {drawing.height:.6g} mm, X0 Y0 is the lower left corner"
    full = sorted({layer.burn.power_max for layer in drawing.layers if layer.burn is not None})
    yield f"; for GRBL 1.1 in laser mode: $32=1, $30={' or '.join(map(_plain, full))}"
    text = json.dumps({"title": drawing.title, **drawing.recipe})
    # Such characters stand in strings only, where JSON has them as \uXXXX too.
    text = _COMMANDS.sub(lambda sign: f"\\u{ord(sign[0]):04x}", text)
    room = LINE_MAX - len(_RECIPE)
    yield from (_RECIPE + text[k : k + room] for k in range(0, len(text), room))
    yield from ("G21", "G90", "G17", "G94", "M4 S0")


def _comment(text: str) -> str:
    """A comment that every controller passes over: one line of plain signs."""
    plain = _COMMANDS.sub("_", text.translate(_BRACKETS))
    return "; " + re.sub("[^ -~]", "_", plain)[: LINE_MAX - 2]


# --- moves ------------------------------------------------------------------------------------------------------


def _moves(paths: Paths, burn: Burn) -> Iterator[str]:
    """The lines of some paths; of those that are smaller than the grid there are none."""
    parts, round_, centre, left = _parts(paths)
    start, end = _rounded(parts.start), _rounded(parts.end)
    kept = np.flatnonzero(start != end)
    if not len(kept):
        return
    start, end, round_, owner = start[kept], end[kept], round_[kept], parts.owner[kept]
    target = _words("X", "Y", end)
    moves = np.array([f"G1 {place}" for place in target], object)
    arcs = np.flatnonzero(round_)
    middles = _words("I", "J", centre[kept[arcs]] - start[arcs])
    for k, middle, turn in zip(arcs.tolist(), middles, left[kept[arcs]].tolist(), strict=True):
        moves[k] = f"G{3 if turn else 2} {target[k]} {middle}"
    first = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    how = f" F{_plain(burn.feed)} S{_plain(burn.power)}"
    for k, place in zip(first.tolist(), _words("X", "Y", start[first]), strict=True):
        moves[k] = f"G0 {place} S0\n{moves[k]}{how}"
    yield from (f"{move}\n" for move in moves)


def _parts(paths: Paths) -> tuple[Paths, Bools, Complexes, Bools]:
    """The chords of what each move goes along, and of those that are arcs the centre and whether they turn left."""
    arcs = np.flatnonzero(paths.kind == ARC)
    radius, turn = paths.arc_radius_and_turn(arcs)
    # Of the larger circles as many chords as FLAT_MM asks for, of the others as many arcs as TURN_MAX.
    flat = radius > RADIUS_MAX_MM
    angle = np.where(flat, np.sqrt(8 * FLAT_MM / np.clip(radius, RADIUS_MAX_MM, _STRAIGHT_MM)), TURN_MAX)
    number = np.maximum(np.ceil(np.abs(turn) / angle), 1.0)
    rise = np.where(flat, 0.0, radius) * (1 - np.cos(turn / number / 2))
    counts = np.ones(len(paths.start), np.intp)
    counts[arcs] = number
    segment: Ints = np.repeat(np.arange(len(paths.start)), counts)
    round_, left = np.zeros(len(paths.start), np.bool_), np.zeros(len(paths.start), np.bool_)
    round_[arcs], left[arcs] = rise > FLAT_MM, turn > 0
    centre = np.zeros(len(paths.start), np.complex128)
    curved = np.flatnonzero(round_)
    centre[curved] = paths.circles(curved)[0]
    return chords(paths, counts), round_[segment], centre[segment], left[segment]


def _rounded(points: Complexes) -> Complexes:
    """The points of the grid that are next to some points."""
    return np.asarray((np.rint(points.real / GRID_MM) + 1j * np.rint(points.imag / GRID_MM)) * GRID_MM)


def _words(first: str, second: str, points: Complexes) -> list[str]:
    """Points as two words, without exponent, needless zeros, or a point at the end of a number."""
    points = _rounded(points)
    pairs = zip(decimal_texts(points.real), decimal_texts(points.imag), strict=True)
    return [f"{first}{x} {second}{y}" for x, y in pairs]


def _plain(value: float) -> str:
    """A positive number with three decimals at most, and no needless ones."""
    return f"{value:.3f}".rstrip("0").rstrip(".")

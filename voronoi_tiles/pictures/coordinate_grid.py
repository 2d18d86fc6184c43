"""A grid of coordinates over a picture: where in the design a point of it lies, to read off and to write down."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.fabrication.lettering import lettering, place_labels, text_width
from voronoi_tiles.raster.picture import Overlay, Region

_LINE, _PAPER = (24, 52, 140), (255, 255, 255)

_LETTER, _LETTER_SHARE = 9.0, 1 / 72
"""The least height of capitals, and what they are of the picture's size where that is more; pixels, a share."""

_APART = 5.0
"""Least distance of lines that have a number, and least gap between two numbers; heights of capitals."""

_ROOM = 5.0
"""The least height of a picture that is written on; heights of capitals."""

_FINE = 8.0
"""Least distance of the lines between; pixels."""


@dataclass(frozen=True, slots=True)
class GridStep:
    """The step of a grid: numbers are at the multiples of `mantissa` 10^`exponent`, the mantissa being 1, 2 or 5."""

    mantissa: int
    exponent: int

    @property
    def length(self) -> float:
        """The step in the design's units: the double next to the decimal number."""
        return float(f"{self.mantissa}e{self.exponent}")

    @property
    def parts(self) -> int:
        """In how many parts finer lines divide a step, so that they are at round numbers as well."""
        return 4 if self.mantissa == 2 else 5

    def multiples(self, low: float, high: float, *, parts: int = 1) -> Floats:
        """The multiples of a part of the step from `low` to `high`, ascending; each rounded once."""
        part = Fraction(self.mantissa, parts) * Fraction(10) ** self.exponent
        first, last = math.ceil(Fraction(low) / part), math.floor(Fraction(high) / part)
        return np.array([float(k * part) for k in range(first, last + 1)], float)

    def text(self, value: float) -> str:
        """A multiple as it is written: all its digits, and no more."""
        return f"{value + 0.0:.{max(0, -self.exponent)}f}"


def grid_step(region: Region, scale: float, letter: float) -> GridStep:
    """The smallest of the steps 1, 2, 5, 10, ... whose numbers keep apart; `scale` in pixels a unit, `letter` high."""
    x0, y0, x1, y1 = region
    exponent = math.floor(math.log10(letter / scale))
    while True:
        for mantissa in (1, 2, 5):
            step = GridStep(mantissa, exponent)
            room = step.length * scale
            if room < _APART * letter:
                continue
            ends = [math.floor(end / step.length) * step.length for end in (x0, x1, y0, y1)]
            if room >= max(text_width(step.text(end), height=letter) for end in ends) + letter:
                return step
        exponent += 1


def coordinate_grid(region: Region, width: int, height: int, units: str) -> list[Overlay]:
    """Lines at round coordinates with their numbers along the lower and the left edge, over a picture of a region.

    The lines through the origin are thicker, and a ring marks it; the units stand in the upper left corner. `width` and
    `height` are the picture's, pixels.
    """
    x0, y0, x1, y1 = region
    scale = width / (x1 - x0)
    side = math.sqrt(width * height)
    letter = max(_LETTER, side * _LETTER_SHARE)
    line = max(1.0, side / 900)
    step = grid_step(region, scale, letter)
    found = []
    if step.length * scale / step.parts >= _FINE:
        fine = _lines(step.multiples(x0, x1, parts=step.parts), step.multiples(y0, y1, parts=step.parts), region)
        found += _haloed(fine, 0.7 * line, line, 0.25)
    x, y = step.multiples(x0, x1), step.multiples(y0, y1)
    found += _haloed(_lines(x, y, region), line, 1.5 * line, 0.75)
    found += _haloed(_lines(x[x == 0.0], y[y == 0.0], region), 2.5 * line, 1.5 * line, 1.0)
    unit = letter / scale
    if x0 < 0.0 < x1 and y0 < 0.0 < y1:
        turn = 0.6 * unit * np.exp(2j * np.pi * np.arange(33) / 32)
        found += _haloed(np.stack((turn[:-1], turn[1:]), axis=1), 2.5 * line, 1.5 * line, 1.0)
    strokes = _strokes(labels(x, y, region, step, unit), region, unit, units)
    return found + _haloed(strokes, letter / 8, 0.16 * letter + 1.0, 1.0)


def _lines(x: Floats, y: Floats, region: Region) -> Complexes:
    """Lines across a region: upright ones at `x`, level ones at `y`; complex128 (n, 2)."""
    x0, y0, x1, y1 = region
    upright = np.stack((x + 1j * y0, x + 1j * y1), axis=1)
    level = np.stack((x0 + 1j * y, x1 + 1j * y), axis=1)
    return np.concatenate((upright, level))


def _haloed(segments: Complexes, width: float, halo: float, strength: float) -> list[Overlay]:
    """Segments on a lighter ground that is `halo` pixels wider on either side, so that they show on any colour."""
    ground = Overlay(segments, width + 2 * halo, _PAPER, 0.7 * strength)
    return [ground, Overlay(segments, width, _LINE, strength)]


def labels(x: Floats, y: Floats, region: Region, step: GridStep, unit: float) -> list[tuple[str, complex]]:
    """The numbers along the lower and the left edge, and where the middle of each stands.

    `unit` is the height of capitals in the design's units. Numbers that would reach beyond the picture, or into another
    text, are left out.
    """
    x0, y0, x1, y1 = region
    foot, margin = y0 + 1.2 * unit, 0.7 * unit
    found: list[tuple[str, complex]] = []
    if y1 - y0 < _ROOM * unit:
        return found
    for value in x.tolist():
        half = text_width(step.text(value), height=unit) / 2
        if x0 + margin + half <= value <= x1 - margin - half:
            found.append((step.text(value), complex(value, foot)))
    for value in y.tolist():
        half = text_width(step.text(value), height=unit) / 2
        if foot + 2 * unit <= value <= y1 - 3.2 * unit and x0 + 2 * (margin + half) <= x1:
            found.append((step.text(value), complex(x0 + margin + half, value)))
    return found


def _strokes(numbers: list[tuple[str, complex]], region: Region, unit: float, units: str) -> Complexes:
    """The strokes of the numbers and, in the upper left corner, of the units' name; complex128 (n, 2)."""
    # About the corner, and not the origin, where the letters' strokes might be lost in the rounding.
    corner = complex(region[0], region[1])
    places = np.array([place for _, place in numbers], complex) - corner
    letters = place_labels([text for text, _ in numbers], places, height=unit)
    name = lettering(units if numbers else "", height=unit)
    name = name.moved(1.0, complex(0.7 * unit, region[3] - region[1] - 1.7 * unit))
    return np.concatenate([corner + np.stack((paths.start, paths.end), axis=1) for paths in (letters, name)])

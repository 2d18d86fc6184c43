"""The arcs of the outlines of all tiles as one set of arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import fsum, isnan

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.vector.outline import Outline


@dataclass(frozen=True, slots=True)
class AllArcs:
    """n arcs in r rings, those of the first outline, then those of the second, and so on.

    `start`, `control`, `end` (complex128, n) and `curved` (bool, n) are those of the outlines, `ring_offsets` (intp,
    r + 1) as well; `tile` (intp, n) is the outline's number.
    """

    start: Complexes
    control: Complexes
    end: Complexes
    curved: Bools
    tile: Ints
    ring_offsets: Ints

    def __len__(self) -> int:
        return len(self.start)

    @classmethod
    def of(cls, outlines: Sequence[Outline]) -> AllArcs:
        """The arcs of outlines."""
        counts = np.array([len(outline) for outline in outlines])
        before = counts.cumsum() - counts
        offsets = [outline.ring_offsets[:-1] + k for outline, k in zip(outlines, before.tolist(), strict=True)]
        return cls(
            start=np.concatenate([outline.start for outline in outlines]),
            control=np.concatenate([outline.control for outline in outlines]),
            end=np.concatenate([outline.end for outline in outlines]),
            curved=np.concatenate([outline.curved for outline in outlines]),
            tile=np.arange(len(outlines)).repeat(counts),
            ring_offsets=np.concatenate((*offsets, counts.sum(keepdims=True))),
        )

    def area(self, copies: Ints) -> float:
        """The areas of all tiles, each times its number of `copies` (intp, one a tile), in square units.

        Six times the integral of x dy is an integer combination of cross products of the control points. Products and
        sums are taken in twice the precision, so that neither thin tiles nor such far from the origin lose digits.
        """
        return fsum(
            times * self._six_areas(np.flatnonzero(copies[self.tile] == times)) / 6 for times in set(copies.tolist())
        )

    def _six_areas(self, arc: Ints) -> float:
        """Six times the area that some of the rings enclose."""
        start, control, end, bent = self.start[arc], self.control[arc], self.end[arc], self.curved[arc]
        # Three times a line's product; of a curve that of its chord, and twice those of its legs.
        u = np.concatenate((start, 2 * start, 2 * control[bent]))
        v = np.concatenate((end, np.where(bent, control, end), end[bent]))
        product, error = _product(np.concatenate((u.real, -u.imag)), np.concatenate((v.imag, v.real)))
        return _sum(product, float(error.sum()))

    def sample(self, t: Floats) -> Complexes:
        """The points of all arcs at parameters t (k,) from 0 to less than 1, the start exactly: complex128 (n, k).

        A line is a curve whose control point is its middle.
        """
        start, control, end = self.start[:, None], self.control[:, None], self.end[:, None]
        return start * (1 - t) ** 2 + control * (2 * t * (1 - t)) + end * t**2

    def at(self, arc: Ints, t: Floats) -> Complexes:
        """Points of arcs at their parameter 0 ... 1, the ends exactly; arc and t are (m,)."""
        start, control, end = self.start[arc], self.control[arc], self.end[arc]
        point = np.where(
            self.curved[arc],
            (1 - t) ** 2 * start + 2 * t * (1 - t) * control + t * t * end,
            (1 - t) * start + t * end,
        )
        return np.where(t == 0.0, start, np.where(t == 1.0, end, point))


_FEW = 512  # numbers that are summed one by one
_SPLITTER = 134217729.0  # 2**27 + 1 cuts a float64 into two halves of 26 bits


def _product(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Products and their rounding errors; Dekker, A floating-point technique for extending the precision, 1971."""
    product = a * b
    wide_a, wide_b = _SPLITTER * a, _SPLITTER * b
    high_a, high_b = wide_a - (wide_a - a), wide_b - (wide_b - b)
    low_a, low_b = a - high_a, b - high_b
    return product, low_a * low_b - (((product - high_a * high_b) - low_a * high_b) - high_a * low_b)


def _sum(values: Floats, error: float) -> float:
    """The sum of numbers and of what was lost before, in twice the precision.

    Many are added pair by pair, what is lost beside it: the error of a sum is that of Knuth's TwoSum.
    """
    while len(values) > _FEW:
        half = len(values) // 2
        a, b, rest = values[:half], values[half : 2 * half], values[2 * half :]
        total = a + b
        part = total - a
        error += float(((a - (total - part)) + (b - part)).sum())
        values = np.append(total, rest)
    # The error of a product that is no number is none.
    return error if isnan(error) else fsum([*values.tolist(), error])

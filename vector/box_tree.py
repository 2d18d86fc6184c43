"""Elements of all sites, modulo the lattice, in a tree of oriented boxes: what the proof searches.

It is the proof's own: the engine finds its candidates in another way.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting
from voronoi_tiles.base.box_join import z_order
from voronoi_tiles.groups.wallpaper import Lattice

WIDTH = 8
"""How many boxes of one level a box of the next holds; the last of a level may hold fewer."""

_LONGEST = 0.5  # of a part, in coordinates of the reduced basis
_FEW = 64  # elements up to so many are kept in the order in which they were drawn


@dataclass(frozen=True, slots=True)
class Boxes:
    """One level of the tree: n boxes, box k holds the boxes WIDTH k ... WIDTH k + WIDTH - 1 of the level below.

    Box k is all centre + x axis + y i axis with |x| <= half_length and |y| <= half_width (complex128 and float64, n;
    |axis| = 1). `inside` (complex128, n) is a point of one of its elements.
    """

    centre: Complexes
    axis: Complexes
    half_length: Floats
    half_width: Floats
    inside: Complexes

    def __len__(self) -> int:
        return len(self.centre)


@dataclass(frozen=True)
class BoxTree:
    """Elements, each moved by a lattice vector so that its middle lies in one cell about 0, and boxes around them.

    What is longer than half a cell is cut into parts. `start` and `chord` (complex128, n) are the elements or parts in
    these places; `element` (intp, n) says of which of those given. None reaches beyond `reach` from 0 in coordinates of
    the reduced basis.
    """

    start: Complexes
    chord: Complexes
    element: Ints
    reach: float

    @classmethod
    def of(cls, lattice: Lattice, start: Complexes, end: Complexes) -> BoxTree:
        """The tree of elements from `start` to `end`, complex128 (m,), m > 0; equal ends are a point."""
        low, high, element = start, end, np.arange(len(start))
        share = np.maximum(*map(np.abs, lattice.reduced.fractional(end - start)))
        if share.max() > _LONGEST:
            count = np.maximum(np.ceil(share / _LONGEST), 1.0).astype(np.intp)
            part, element = counting(count)
            step = ((end - start) / count)[element]
            low, share = start[element] + part * step, share / count
            high = low + step
        middle = (low + high) / 2
        vector = towards_zero(lattice, middle)
        low, high = low - vector, high - vector
        if len(low) > _FEW:
            order = z_order(middle - vector)
            low, high, element = low[order], high[order], element[order]
        return cls(low, high - low, element, reach=0.5 + float(share.max()) / 2)

    @cached_property
    def levels(self) -> tuple[Boxes, ...]:
        """The elements or parts as boxes without width, and boxes around them, up to a level of at most WIDTH."""
        ends = np.array((self.start, self.start + self.chord))
        levels, width = [_segments(*ends)], WIDTH
        while len(levels[-1]) > WIDTH:
            levels.append(boxes_around(ends, width))
            width *= WIDTH
        return tuple(levels)


def towards_zero(lattice: Lattice, points: Complexes) -> Complexes:
    """The lattice vectors that are to be taken from points so that they lie in one cell about 0, complex128 (n,)."""
    return combination(*lattice.reduced_basis, *map(np.rint, lattice.reduced.fractional(points)))


def combination(p: complex, q: complex, x: Floats, y: Floats) -> Complexes:
    """The vectors x p + y q, in real arithmetic: the same bits in an array of any length."""
    result = np.empty(x.shape, complex)
    result.real = x * p.real + y * q.real
    result.imag = x * p.imag + y * q.imag
    return result


def _segments(low: Complexes, high: Complexes) -> Boxes:
    """Segments as boxes without width."""
    chord, middle = high - low, (low + high) / 2
    length = np.abs(chord)
    axis = np.where(length > 0.0, chord / np.where(length > 0.0, length, 1.0), 1.0)
    return Boxes(middle, axis, length / 2, np.zeros(len(low)), middle)


def boxes_around(points: Complexes, width: int) -> Boxes:
    """Boxes around every `width` consecutive columns of points, complex128 (k, n), along their principal axes."""
    first = np.arange(0, points.shape[1], width)
    count = np.diff(np.append(first, points.shape[1]))
    of = np.repeat(np.arange(len(first)), count)
    mean = np.add.reduceat(points.sum(axis=0), first) / (len(points) * count)
    away = points - mean[of]
    # The square of a direction does not know its sign: that of the principal axis is the sum of all squares.
    axis = np.sqrt(np.add.reduceat((away * away).sum(axis=0), first))
    length = np.abs(axis)
    axis = np.where(length > 0.0, axis / np.where(length > 0.0, length, 1.0), 1.0)
    away *= axis.conj()[of]
    left = np.minimum.reduceat(away.real.min(axis=0), first)
    right = np.maximum.reduceat(away.real.max(axis=0), first)
    below = np.minimum.reduceat(away.imag.min(axis=0), first)
    above = np.maximum.reduceat(away.imag.max(axis=0), first)
    centre = mean + axis * ((left + right) / 2 + 1j * (below + above) / 2)
    inside = points[0, np.minimum(first + width // 2, points.shape[1] - 1)]
    return Boxes(centre, axis, (right - left) / 2, (above - below) / 2, inside)

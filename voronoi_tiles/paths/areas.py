"""The areas that closed paths enclose."""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints
from voronoi_tiles.paths.paths import ARC, CUBIC, QUAD, Paths

_SMALL: Final = 0.2
"""Below this half angle the sines cancel, and their series is exact to rounding; radians."""

_SERIES: Final = (1.0, 2 / 15, 2 / 105, 4 / 1575, 2 / 6237, 2764 / 70945875, 4 / 868725, 28936 / 54273594375)


def ring_areas(paths: Paths) -> Floats:
    """The area that each closed path of LINEs, QUADs and ARCs encloses: > 0 counter-clockwise, < 0 clockwise.

    Raises ValueError for CUBIC.
    """
    if (paths.kind == CUBIC).any():
        raise ValueError("the area of cubic curves is not known here")
    # About a point of each path, so that far coordinates cost no digits.
    origin = paths.start[paths.offsets[:-1]][paths.owner]
    start, end = paths.start - origin, paths.end - origin
    area = (start.conj() * end).imag / 2
    bent = np.flatnonzero(paths.kind == QUAD)
    arm = paths.control[bent, 0] - paths.start[bent]
    area[bent] += (arm.conj() * (end[bent] - start[bent])).imag / 3
    arcs = np.flatnonzero(paths.kind == ARC)
    if len(arcs):
        # r^2 is chord^2 / (4 sin^2), so that a flat arc, whose radius is huge, keeps its digits.
        half = 2.0 * np.arctan(paths.bulges()[arcs])
        chord = np.abs(end[arcs] - start[arcs])
        area[arcs] += chord**2 * _segment(half)
    return np.asarray(np.bincount(paths.owner, area, len(paths)), np.float64)


def item_areas(paths: Paths, items: Ints) -> Floats:
    """The area of each item, its holes taken off: item k are the closed paths from items[k] up to items[k + 1].

    Raises ValueError for CUBIC.
    """
    return np.asarray(np.add.reduceat(ring_areas(paths), items[:-1]))


def _segment(half: Floats) -> Floats:
    """The area between a chord of length 1 and its arc of the angle 2 `half`: (2 h - sin 2 h) / (8 sin^2 h)."""
    small = np.abs(half) < _SMALL
    h = np.where(small, _SMALL, half)
    series = half / 6 * np.polynomial.polynomial.polyval(half * half, _SERIES)
    return np.where(small, series, (2 * h - np.sin(2 * h)) / (8 * np.sin(h) ** 2))

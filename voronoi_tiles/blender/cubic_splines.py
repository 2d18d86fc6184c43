"""Outlines as Blender's Bezier splines: a parabola's arc is one cubic curve, exactly but for single precision."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.vector.outline import Outline


class CubicSpline(NamedTuple):
    """A closed Bezier spline: its points with the handles before and behind them, complex128 (n,)."""

    points: Complexes
    left: Complexes
    right: Complexes


def cubic_splines(outline: Outline) -> list[CubicSpline]:
    """A spline for each ring of an outline; the handles of a line are at its thirds."""
    # The cubic curve that a quadratic one is (degree elevation): two thirds of the way to its control point.
    right = outline.start + (outline.control - outline.start) * (2 / 3)
    left = outline.end + (outline.control - outline.end) * (2 / 3)
    return [
        CubicSpline(outline.start[a:b], np.roll(left[a:b], 1), right[a:b])
        for a, b in pairwise(outline.ring_offsets.tolist())
    ]


def coordinates(points: Complexes, z: float = 0.0) -> NDArray[np.float32]:
    """Points as Blender takes them: x, y, z of one after the other, float32 (3 n,)."""
    flat = np.empty((len(points), 3), np.float32)
    flat[:, 0], flat[:, 1], flat[:, 2] = points.real, points.imag, z
    return flat.ravel()

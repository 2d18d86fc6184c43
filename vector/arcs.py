"""The arcs of an outline: line segments and arcs of parabolas, each with the copy on its other side.

Source: the bisector of two points or of two lines is a line, that of a point and a line is a parabola, and an arc of a
parabola is exactly one quadratic Bezier curve.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.operations import Operation


class Neighbour(NamedTuple):
    """The copy on the other side of an arc: apply the operation to the base site of that name."""

    site: str
    operation: Operation


@dataclass(frozen=True, slots=True)
class LineArc:
    """A straight arc from start to end, in the design's units; the tile lies on its left."""

    start: complex
    end: complex
    neighbour: Neighbour


@dataclass(frozen=True, slots=True)
class ParabolaArc:
    """A parabolic arc: the quadratic Bezier curve of start, control and end; the tile lies on its left.

    The control point is where the tangents at the two ends meet. `focus` is the point and `directrix` two points
    of the line from which the arc is equally far; one belongs to the tile's site, the other to the neighbour.
    """

    start: complex
    control: complex
    end: complex
    focus: complex
    directrix: tuple[complex, complex]
    neighbour: Neighbour


Arc = LineArc | ParabolaArc


def parabola_controls(start: Complexes, end: Complexes, focus: Complexes, directrix: Complexes) -> Complexes:
    """The control points of parabolic arcs as quadratic Bezier curves, complex128 (n,).

    `start`, `end` and `focus` are complex128 (n,), `directrix` two points of each, complex128 (n, 2). In the frame of
    its directrix a parabola is h(s) = ((s - p)^2 + q^2) / 2q, and the control point between s0 and s1 is at their mean,
    at the height of the polar form h(s0, s1).
    """
    axis = directrix[:, 1] - directrix[:, 0]
    axis = axis / np.abs(axis)
    q = ((focus - directrix[:, 0]) * axis.conj()).imag
    s0, s1 = ((start - focus) * axis.conj()).real, ((end - focus) * axis.conj()).real
    above = (s0 * s1 / q - q) / 2.0
    return np.asarray(focus + axis * ((s0 + s1) / 2 + 1j * above))

"""Points where copies that nearly touch meet others: put exactly onto the bisector between those two.

Seen from a distance R, a node and another node or line that are d apart, d far below R, leave a point of their bisector
uncertain across it by eps R^2 / d: their distance is lost in the rounding of coordinates that are so far away. Along
the other arc that ends in the point it may be moved freely; onto the bisector it is put by that distance itself.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.vector.arcs import parabola_controls
from voronoi_tiles.vector.complex.traced import NEARLY_TOUCHING, Traced


def sharpened(boundary: Traced, arc: int, here: complex, tangents: Iterable[complex]) -> complex:
    """A point of an arc, moved along one of some tangents, where what the arc is the bisector of nearly touches."""
    gap, away = _gap(boundary, arc, here)
    if not gap < NEARLY_TOUCHING * away:
        return here
    off, normal = (off_parabola if boundary.curved[arc] else off_bisector)(boundary, arc, here)
    best = max((t for t in tangents if t), key=lambda t: abs((normal.conjugate() * t).real) / abs(t), default=0j)
    across = (normal.conjugate() * best).real
    return here + best * (off / across) if abs(across) > 1e-3 * abs(best) else here


def sharpen_within(boundary: Traced, arcs: Ints, vertex: Complexes) -> None:
    """Sharpen the points between the arcs of an edge, `vertex[1:-1]`, in place."""
    if not boundary.nearly_touching:
        return
    for k, (before, after) in enumerate(pairwise(arcs.tolist())):
        if boundary.nearly_touching.isdisjoint((before, after)):
            continue
        leaving = tangent(boundary, after, *vertex[k + 1 : k + 3].tolist(), at_start=True)
        arriving = tangent(boundary, before, *vertex[k : k + 2].tolist(), at_start=False)
        for arc, along in ((before, leaving), (after, arriving)):
            vertex[k + 1] = sharpened(boundary, arc, complex(vertex[k + 1]), [along])


def tangent(boundary: Traced, arc: int, start: complex, end: complex, *, at_start: bool) -> complex:
    """The direction of an arc from start to end, at one of these."""
    if not boundary.curved[arc]:
        return end - start
    this = [arc]
    control = parabola_controls(np.array([start]), np.array([end]), boundary.focus[this], boundary.directrix[this])[0]
    return complex(control - start if at_start else end - control)


def _gap(boundary: Traced, arc: int, here: complex) -> tuple[float, float]:
    """How far apart the two are that an arc is the bisector of, NaN where one is no node, and how far away they are."""
    if not boundary.curved[arc]:
        one, two = boundary.nodes[arc].tolist()
        return abs(two - one), abs(here - one)
    focus, (first, last) = complex(boundary.focus[arc]), boundary.directrix[arc].tolist()
    axis = (last - first) / abs(last - first)
    return abs(((focus - first) * axis.conjugate()).imag), abs(here - focus)


def off_arc(boundary: Traced, arc: int, here: complex) -> tuple[float, complex]:
    """How far an arc's curve is from a point near its ends, and its unit normal there; 0 for an arc of no length."""
    if boundary.curved[arc]:
        return off_parabola(boundary, arc, here)
    start, end = boundary.vertex[[arc, boundary.following[arc]]].tolist()
    if arc in boundary.nearly_touching:
        return off_bisector(boundary, arc, here)
    length = abs(end - start)
    if length == 0.0:
        return 0.0, 0j
    normal = 1j * (end - start) / length
    return (normal.conjugate() * (start - here)).real, normal


def off_bisector(boundary: Traced, arc: int, here: complex) -> tuple[float, complex]:
    """How far the bisector of two nodes is from a point, and its normal."""
    one, two = boundary.nodes[arc].tolist()
    gap = abs(two - one)
    normal: complex = (two - one) / gap
    return gap / 2 - (normal.conjugate() * (here - one)).real, normal


def off_parabola(boundary: Traced, arc: int, here: complex) -> tuple[float, complex]:
    """How far a parabola is from a point, and its normal there.

    In the frame of the directrix g(s, h) = s^2 + q^2 - 2 q h is 0 on it (see `parabola_controls`), and its gradient
    2 (s, -q) the normal: one step of Newton's method.
    """
    focus, (first, last) = complex(boundary.focus[arc]), boundary.directrix[arc].tolist()
    axis = (last - first) / abs(last - first)
    q = ((focus - first) * axis.conjugate()).imag
    apart = (here - focus) * axis.conjugate()
    s, h = apart.real, apart.imag + q
    gradient = 2 * complex(s, -q)
    return -(s * s + q * q - 2 * q * h) / abs(gradient), axis * gradient / abs(gradient)

"""How often closed paths wind round points: exactly, for lines, circular arcs and quadratic curves.

The chords of a path wind round a point as those of any polygon. Between a chord and its curve lies a region that the
curve adds, or takes away: it is known in closed form.
"""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints
from voronoi_tiles.paths.paths import ARC, CUBIC, QUAD, Paths

_AT_ONCE = 1 << 20
"""Pairs of a segment and a point that are looked at in one go: tens of megabytes."""


def winding(paths: Paths, points: Complexes) -> Ints:
    """The winding number of closed paths about points, > 0 counter-clockwise: intp, one for each point.

    On a path it is that of one side or the other. Raises ValueError for CUBIC segments.
    """
    return np.asarray(item_winding(paths, np.array([0, len(paths.start)]), points)[0], np.intp)


def item_winding(paths: Paths, offsets: Ints, points: Complexes) -> Ints:
    """The winding numbers (k, n) of parts of paths about points: part k is the segments from offsets[k] on."""
    result = np.zeros((len(offsets) - 1, len(points)), np.intp)
    if not len(paths.start):
        return result
    size = max(1, _AT_ONCE // max(1, len(paths.start)))
    for first in range(0, len(points), size):
        turns = _turns(paths, points[first : first + size])
        result[:, first : first + size] = np.add.reduceat(turns, offsets[:-1], axis=0)
    return result


def _turns(paths: Paths, points: Complexes) -> Ints:
    """What each segment adds to the winding number about each point."""
    if (paths.kind == CUBIC).any():
        raise ValueError("cubic curves have to be replaced before points are looked for inside them")
    a, b = paths.start[:, None], paths.end[:, None]
    left = _left(paths.start, paths.end, points)
    rising = (a.imag <= points.imag) & (points.imag < b.imag) & left
    falling = (b.imag <= points.imag) & (points.imag < a.imag) & ~left
    turns = rising.astype(np.intp) - falling
    arcs = np.flatnonzero(paths.kind == ARC)
    if len(arcs):
        centre, radius, _, turn = paths.circles(arcs)
        within = np.abs(points - centre[:, None]) < radius[:, None]
        # A left turn bulges to the right of its chord, and takes in what lies between.
        to_left = turn[:, None] > 0
        turns[arcs] += (within & ~left[arcs] & to_left).astype(np.intp) - (within & left[arcs] & ~to_left)
    quads = np.flatnonzero(paths.kind == QUAD)
    if len(quads):
        p, q, r = a[quads], paths.control[quads, :1], b[quads]
        # In barycentric coordinates of the control triangle the curve is v^2 = 4 u w.
        det = ((q - p).conj() * (r - p)).imag
        safe = np.where(det == 0.0, 1.0, det)
        v = ((points - p).conj() * (r - p)).imag / safe
        w = ((q - p).conj() * (points - p)).imag / safe
        u = 1.0 - v - w
        within = (u > 0) & (w > 0) & (v * v < 4 * u * w)
        turns[quads] += (within & ~left[quads] & (det > 0)).astype(np.intp) - (within & left[quads] & (det < 0))
    return turns


def _left(start: Complexes, end: Complexes, points: Complexes) -> Bools:
    """Which points lie to the left of chords, as seen from these; to the right of the reverse of a chord.

    A point on the line counts as one slightly above it, or to the right of it, as it does for rays.
    """
    swapped = (start.real > end.real) | ((start.real == end.real) & (start.imag > end.imag))
    a, b = np.where(swapped, end, start)[:, None], np.where(swapped, start, end)[:, None]
    across = (b.real - a.real) * (points.imag - a.imag) - (b.imag - a.imag) * (points.real - a.real)
    return np.asarray(((across > 0) | ((across == 0) & (b.real > a.real))) != swapped[:, None])

"""How far points are from arcs of an outline."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.vector.outline import Outline

_SAMPLES = np.linspace(0.0, 1.0, 9)
_NEWTON_STEPS = 8


def distance_to_arcs(outline: Outline, arc: Ints, points: Complexes) -> Floats:
    """The distance of each point from one arc: float64 (n,) in units, for `arc` and `points` of shape (n,).

    On a line it is a closed form. On a parabolic arc Newton's method finds the foot of the perpendicular, from the best
    of nine samples and of the arc's points beside and above the given one (across the axis a parabola runs linearly in
    its parameter, along the axis quadratically). The result is a distance from a point of the arc in any case, so never
    too small, and for points much nearer than the arc's radius of curvature it is the distance to rounding.
    """
    start = outline.start[arc]
    away = points - start
    chord = outline.end[arc] - start
    square = np.maximum(chord.real**2 + chord.imag**2, 1e-300)
    share = np.clip((away.real * chord.real + away.imag * chord.imag) / square, 0.0, 1.0)
    distance = np.abs(away - share * chord)
    bent = np.flatnonzero(outline.curved[arc])
    if len(bent):
        distance[bent] = _from_parabolas(outline.control[arc[bent]] - start[bent], chord[bent], away[bent])
    return distance


def _from_parabolas(control: Complexes, end: Complexes, away: Complexes) -> Floats:
    """The distances of points from quadratic curves that start at 0."""
    bend = end - 2 * control
    size = np.abs(bend)
    axis = bend / np.where(size > 0.0, size, 1.0)
    leg, rise = control * axis.conj(), away * axis.conj()
    with np.errstate(divide="ignore", invalid="ignore"):
        beside = rise.imag / (2 * leg.imag)
        root = np.sqrt(np.maximum(leg.real**2 + size * rise.real, 0.0))
        above, below = (root - leg.real) / size, (-root - leg.real) / size
    first = np.clip(np.nan_to_num(np.stack((beside, above, below))), 0.0, 1.0)
    t = np.concatenate((np.broadcast_to(_SAMPLES[:, None], (len(_SAMPLES), len(bend))), first))
    best = np.abs(t * (2 * control + t * bend) - away).argmin(axis=0)
    foot = np.take_along_axis(t, best[None], axis=0)[0]
    for _ in range(_NEWTON_STEPS):
        to_curve = foot * (2 * control + foot * bend) - away
        slope = 2 * (control + foot * bend)
        value = to_curve.real * slope.real + to_curve.imag * slope.imag
        change = np.abs(slope) ** 2 + 2 * (to_curve.real * bend.real + to_curve.imag * bend.imag)
        foot = np.clip(foot - value / np.where(change > 0.0, change, np.inf), 0.0, 1.0)
    ends = np.minimum(np.abs(away), np.abs(away - end))
    return np.asarray(np.minimum(np.abs(foot * (2 * control + foot * bend) - away), ends))

"""How the control points of cubic pieces move with the points that a curve is drawn by.

The rate of each of a piece's four control points is a sum over four points p of the stroke (its stencil) of
direct * dp + conjugate * conj(dp): for all curves but Catmull-Rom's, whose knots depend on distances, the second is 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints


class ControlWeights(NamedTuple):
    """The weights of k pieces: `stencil` (intp, k x 4) are points of the stroke, tangents after the points.

    `direct` and `conjugate` are complex128 (k, 4, 4): of each control point, of each point of the stencil.
    """

    stencil: Ints
    direct: Complexes
    conjugate: Complexes


def _linear(stencil: Ints, weights: Floats) -> ControlWeights:
    """The weights of curves that depend on their points alike all along, float64 (4, 4)."""
    direct = np.broadcast_to(weights.astype(complex), (len(stencil), 4, 4))
    return ControlWeights(stencil, direct, np.zeros_like(direct))


def bezier_weights(count: int) -> ControlWeights:
    """A Bezier chain of so many points."""
    return _linear(3 * np.arange(count // 3)[:, None] + np.arange(4), np.eye(4))


_HERMITE = np.array([[1, 0, 0, 0], [1, 0, 1 / 3, 0], [0, 1, 0, -1 / 3], [0, 1, 0, 0]])
"""By the two points and the two tangents of a piece."""


def hermite_weights(count: int) -> ControlWeights:
    """A Hermite curve through so many points."""
    return _linear(np.arange(count - 1)[:, None] + np.array([0, 1, count, count + 1]), _HERMITE)


_BSPLINE = np.array([[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]]) / 6


def bspline_weights(count: int, *, closed: bool) -> ControlWeights:
    """A uniform cubic B-spline of so many points."""
    pieces = count if closed else count - 3
    return _linear((np.arange(pieces)[:, None] + np.arange(4)) % count, _BSPLINE)


def catmull_rom_weights(points: Complexes, alpha: float, *, closed: bool) -> ControlWeights:
    """A Catmull-Rom curve through points, complex128 (n,), as `strokes.catmull_rom_pieces` has it.

    With legs l0, l1, l2 about a piece and s = |l|^alpha its inner control points are p1 + q(l0, l1) / 3 and
    p2 - q(l2, l1) / 3, where q(l, m) = l s(m) / s(l) + m - (l + m) s(m) / (s(l) + s(m)).
    """
    count = len(points)
    pieces = count if closed else count - 1
    stencil = (np.arange(pieces)[:, None] + np.arange(-1, 3)) % count
    if closed:
        around = points[stencil]
    else:
        ring = np.concatenate([[2.0 * points[0] - points[1]], points, [2.0 * points[-1] - points[-2]]])
        around = ring[np.arange(pieces)[:, None] + np.arange(4)]
    legs = np.diff(around, axis=1)
    # By the start of the middle leg and the three legs, (k, 4 controls, 4), direct and conjugate.
    rates = np.zeros((2, pieces, 4, 4), complex)
    rates[0, :, :, 0] = 1.0
    rates[0, :, 2:, 2] = 1.0
    for control, side, sign in ((1, 0, 1 / 3), (2, 2, -1 / 3)):
        by_side, by_middle = _tangent_rates(legs[:, side], legs[:, 1], alpha)
        rates[:, :, control, side + 1] += sign * by_side
        rates[:, :, control, 2] += sign * by_middle
    # p1, l0 = p1 - p0, l1 = p2 - p1, l2 = p3 - p2 by the four points.
    legs_of = np.array([[0, 1, 0, 0], [-1, 1, 0, 0], [0, -1, 1, 0], [0, 0, -1, 1]])
    direct, conjugate = rates @ legs_of
    if not closed:
        for weights in (direct, conjugate):
            # The points before the first and after the last are reflections: 2 p1 - p2, 2 p2 - p1.
            for piece, outer, near, far in ((0, 0, 1, 2), (-1, 3, 2, 1)):
                beyond = weights[piece, :, outer].copy()
                weights[piece, :, near] += 2.0 * beyond
                weights[piece, :, far] -= beyond
                weights[piece, :, outer] = 0.0
    return ControlWeights(stencil, direct, conjugate)


def _tangent_rates(side: Complexes, middle: Complexes, alpha: float) -> tuple[Complexes, Complexes]:
    """The rates of q(l, m) by l and by m, each direct and conjugate: complex128 (2, k)."""
    s, t = np.abs(side) ** alpha, np.abs(middle) ** alpha
    both = s + t
    by_s = (side + middle) * t / both**2 - side * t / s**2
    by_t = side / s - (side + middle) * s / both**2
    # d|l|^alpha = alpha / 2 |l|^(alpha - 2) (conj(l) dl + l conj(dl))
    step_s, step_t = (alpha / 2 * np.abs(leg) ** (alpha - 2) for leg in (side, middle))
    of_side = np.stack([t / s - t / both + by_s * step_s * side.conj(), by_s * step_s * side])
    of_middle = np.stack([s / both + by_t * step_t * middle.conj(), by_t * step_t * middle])
    return of_side, of_middle

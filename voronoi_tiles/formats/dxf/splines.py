"""B-splines as Bezier curves: exact up to the third degree, else cubics within an accuracy."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.formats.shapes import DrawingError

_HALVINGS_MAX = 14  # a span that needs more is no curve, but a jump
_BLOCK = 1_024  # spans that are fitted at once
_HALVED_MAX = 128 * _BLOCK  # parts of them that are halved at once; a span takes some ten


def bezier_spans(points: Complexes, knots: Floats, degree: int) -> Complexes:
    """The Bezier control points of each span of a B-spline; complex128 (spans, degree + 1).

    `points` is complex128 (n,), `knots` float64 (n + degree + 1,), which never fall; ends need not be clamped. Control
    point j of a span from u to v is the blossom of the spline at u (degree - j times) and v (j times). Source: Ramshaw,
    "Blossoming: a connect-the-dots approach to splines", 1987.
    """
    spans = np.flatnonzero(knots[degree + 1 : len(points) + 1] > knots[degree : len(points)]) + degree
    low, high = knots[spans], knots[spans + 1]
    result = np.empty((len(spans), degree + 1), np.complex128)
    for j in range(degree + 1):
        d = points[spans[:, None] + np.arange(-degree, 1)]
        for r in range(1, degree + 1):
            at = (high if r <= j else low)[:, None]
            first = spans[:, None] + np.arange(r - degree, 1)
            left, right = knots[first], knots[first + degree - r + 1]
            share = (at - left) / (right - left)
            d = (1 - share) * d[:, :-1] + share * d[:, 1:]
        result[:, j] = d[:, 0]
    # Neighbouring spans share their point, bit for bit, but where a knot is there more than `degree` times: a break.
    joined = np.flatnonzero(np.diff(spans) <= degree)
    result[joined + 1, 0] = result[joined, -1]
    return result


def smooth_runs(spans: Complexes, tolerance: float) -> list[Complexes]:
    """Bezier curves (n, k) parted where the next one begins further than `tolerance` from the end of the last."""
    breaks = np.flatnonzero(np.abs(spans[1:, 0] - spans[:-1, -1]) > tolerance) + 1
    return np.split(spans, breaks) if len(spans) else []


def fitted_cubics(points: Complexes, weights: Complexes, accuracy: float) -> Complexes:
    """Cubic Bezier curves within `accuracy` of rational Bezier curves of any degree, by halving; complex128 (k, 4).

    `points` and `weights` are complex128 (spans, degree + 1), points times their weights, and the weights. The distance
    is taken at seven parameters of each cubic, against half the accuracy. Raises DrawingError where halving does not
    end.
    """
    # Some spans at a time, for the sake of memory: all that are not fitted yet are halved in one step.
    parts = [
        _fitted(points[first : first + _BLOCK], weights[first : first + _BLOCK], accuracy)
        for first in range(0, len(points), _BLOCK)
    ]
    return np.concatenate(parts) if parts else np.empty((0, 4), np.complex128)


def _fitted(points: Complexes, weights: Complexes, accuracy: float) -> Complexes:
    """The cubics for some spans, one after the other; complex128 (k, 4)."""
    span, u, v = np.arange(len(points)), np.zeros(len(points)), np.ones(len(points))
    found: list[tuple[Ints, Floats, Complexes]] = []
    for _ in range(_HALVINGS_MAX + 1):
        curve, weight = points[span], weights[span]
        p, dp = _evaluated(curve, weight, u)
        q, dq = _evaluated(curve, weight, v)
        first, second = p + dp * (v - u) / 3, q - dq * (v - u) / 3
        off = np.zeros(len(span))
        for k in range(1, 8):
            t = k / 8
            s = 1 - t
            on = p * s**3 + 3 * first * s * s * t + 3 * second * s * t * t + q * t**3
            off = np.maximum(off, np.abs(on - _evaluated(curve, weight, u + t * (v - u))[0]))
        near = off <= accuracy / 2
        found.append((span[near], u[near], np.stack((p, first, second, q), axis=1)[near]))
        span, u, v = span[~near], u[~near], v[~near]
        if not len(span):
            spans, begins, cubics = (np.concatenate(column) for column in zip(*found, strict=True))
            ordered: Complexes = cubics[np.lexsort((begins, spans))]
            return ordered
        if len(span) > _HALVED_MAX:
            break
        middle = (u + v) / 2
        span, u, v = np.tile(span, 2), np.concatenate((u, middle)), np.concatenate((middle, v))
    raise DrawingError("the curve cannot be followed", remedy="Draw it again, or convert it to arcs.")


def _evaluated(points: Complexes, weights: Complexes, at: Floats) -> tuple[Complexes, Complexes]:
    """The points of rational Bezier curves (n, k), at a parameter of each, and the derivatives there: de Casteljau."""
    both = np.stack((points, weights))
    degree = both.shape[2] - 1
    at = at[:, None]
    for _ in range(degree - 1):
        both = (1 - at) * both[:, :, :-1] + at * both[:, :, 1:]
    slope, weight_slope = degree * (both[:, :, 1] - both[:, :, 0])
    point, weight = ((1 - at) * both[:, :, :1] + at * both[:, :, 1:])[:, :, 0]
    place: Complexes = point / weight
    return place, (slope - place * weight_slope) / weight

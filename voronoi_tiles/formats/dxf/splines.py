"""B-splines as Bezier curves: exact up to the third degree, else cubics within an accuracy."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.formats.shapes import DrawingError

_HALVINGS_MAX = 14  # a span that needs more is no curve, but a jump


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
    found = [cubic for span, weight in zip(points, weights, strict=True) for cubic in _fitted(span, weight, accuracy)]
    return np.array(found, np.complex128).reshape(-1, 4)


def _fitted(points: Complexes, weights: Complexes, accuracy: float) -> Iterator[tuple[complex, ...]]:
    """The cubics for one span."""
    todo = [(0.0, 1.0, 0)]
    while todo:
        u, v, depth = todo.pop()
        p, dp, q, dq = *_evaluated(points, weights, u), *_evaluated(points, weights, v)
        first, second = p + dp * (v - u) / 3, q - dq * (v - u) / 3
        t = np.arange(1, 8) / 8
        s = 1 - t
        on = p * s**3 + 3 * first * s * s * t + 3 * second * s * t * t + q * t**3
        true = np.array([_evaluated(points, weights, u + k * (v - u))[0] for k in t.tolist()])
        if np.abs(on - true).max() <= accuracy / 2:
            yield p, first, second, q
        elif depth >= _HALVINGS_MAX:
            raise DrawingError("the curve cannot be followed", remedy="Draw it again, or convert it to arcs.")
        else:
            middle = (u + v) / 2
            todo += [(middle, v, depth + 1), (u, middle, depth + 1)]


def _evaluated(points: Complexes, weights: Complexes, at: float) -> tuple[complex, complex]:
    """The point of a rational Bezier curve at a parameter, and its derivative there, by de Casteljau."""
    both = np.stack((points, weights))
    degree = both.shape[1] - 1
    for _ in range(degree - 1):
        both = (1 - at) * both[:, :-1] + at * both[:, 1:]
    slope, weight_slope = degree * (both[:, 1] - both[:, 0])
    point, weight = (1 - at) * both[:, 0] + at * both[:, 1]
    place = complex(point / weight)
    return place, complex((slope - place * weight_slope) / weight)

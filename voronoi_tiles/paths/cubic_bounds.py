"""How far cubic Bezier curves are from stretches of smooth runs: bounds, not samples.

A curve is given by one coordinate of its control points, (4, n), for x and for y.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import comb
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints
from voronoi_tiles.paths.stretch_parts import StretchParts

_FEET: Final = 3
"""Newton's steps by which feet are found; a count. A foot that is not exact makes a bound larger, and never wrong."""

_CUBIC, _SIXTH, _NINTH = ([float(comb(degree, k)) for k in range(degree + 1)] for degree in (3, 6, 9))
"""Binomial coefficients: with them as factors Bernstein coefficients multiply as those of powers do."""


class FittedCubics(NamedTuple):
    """Cubic Bezier curves, one for each stretch: their control points from its beginning, x and y, (4, n)."""

    x: Floats
    y: Floats

    def of(self, rows: Ints) -> FittedCubics:
        """The curves of these rows."""
        return FittedCubics(self.x[:, rows], self.y[:, rows])


def bounds(parts: StretchParts, curves: FittedCubics, near: Floats) -> Floats:
    """The bounds on the Hausdorff distance of curves from their stretches; both have the same ends.

    `near` are parameters of the curves near where parts begin, (m,).

    On a part P(t) of a stretch, t from 0 to 1, the curve B is taken at g(t), a cubic from the foot of the part's
    beginning on B to that of its end, with the slopes that feet have there. B(g(t)) - P(t) is a polynomial of degree
    9, and the largest of its Bernstein coefficients bounds it. As the values of g lie between the two feet, and the
    next part goes on where one ends, g runs continuously from 0 to 1 over the whole stretch: every point of the
    stretch has a partner on the curve, and every point of the curve is the partner of some point of the stretch. So
    the bound holds both ways.
    """
    curve = curves.of(parts.stretch)
    (x0, x1, x2, x3), (y0, y1, y2, y3) = parts.x, parts.y
    begin = near
    for _ in range(_FEET):
        begin = nearer_foot(curve, x0, y0, begin)
    begin[parts.first[:-1]] = 0.0
    end = np.append(begin[1:], 1.0)
    end[parts.first[1:] - 1] = 1.0
    span = end - begin
    forward = span > 0.0
    span = np.where(forward, span, 1.0)
    low = np.clip(_foot_speed(curve, x0, y0, x1 - x0, y1 - y0, begin) / span, 0.0, 1.0)
    high = 1.0 - np.clip(_foot_speed(curve, x3, y3, x3 - x2, y3 - y2, end) / span, 0.0, 1.0)
    # g and 1 - g, and the products of three of them, with the binomial coefficients as factors.
    g, h = (0.0, 3.0 * low, 3.0 * high, 1.0), (1.0, 3.0 * (1.0 - low), 3.0 * (1.0 - high), 0.0)
    gg, gh, hh = _product(g, g), _product(g, h), _product(h, h)
    basis = _product(hh, h), _product(gh, h), _product(gg, h), _product(gg, g)
    x, y = (
        _difference(control, points, basis, begin, end) for control, points in ((curve.x, parts.x), (curve.y, parts.y))
    )
    return parts.most(np.sqrt(np.max(x * x + y * y, axis=0)))


def _difference(control: Floats, points: Floats, basis: tuple[list[Floats], ...], begin: Floats, end: Floats) -> Floats:
    """The Bernstein coefficients of one coordinate of B(g(t)) - P(t), (10, m)."""
    origin = points[0]
    b0, b1, b2, b3 = (values - origin for values in _between(control, begin, end))
    raised = _product([factor * (value - origin) for factor, value in zip(_CUBIC, points, strict=True)], _SIXTH)
    return np.stack(
        [
            (b0 * p + 3.0 * (b1 * q + b2 * r) + b3 * s - raised[k]) / _NINTH[k]
            for k, (p, q, r, s) in enumerate(zip(*basis, strict=True))
        ]
    )


def _product(one: Sequence[Floats | float], other: Sequence[Floats | float]) -> list[Floats]:
    """The product of polynomials by their coefficients."""
    count = len(one) + len(other) - 1
    terms = [[one[i] * other[k - i] for i in range(len(one)) if 0 <= k - i < len(other)] for k in range(count)]
    return [np.asarray(sum(row[1:], start=row[0])) for row in terms]


def _between(c: Floats, a: Floats, b: Floats) -> tuple[Floats, ...]:
    """One coordinate of the control points of curves between two parameters: their polar forms."""

    def polar(u: Floats, v: Floats, w: Floats) -> Floats:
        """The polar form at three parameters."""
        p, q, r = (c[k] + u * (c[k + 1] - c[k]) for k in range(3))
        p, q = p + v * (q - p), q + v * (r - q)
        return np.asarray(p + w * (q - p))

    return polar(a, a, a), polar(a, a, b), polar(a, b, b), polar(b, b, b)


def nearer_foot(curve: FittedCubics, x: Floats, y: Floats, t: Floats) -> Floats:
    """Parameters nearer to the feet of points on curves, by one of Newton's steps from `t`; within 0 and 1."""
    (px, ux, ax), (py, uy, ay) = derivatives(curve.x, t), derivatives(curve.y, t)
    ex, ey = px - x, py - y
    square = ux * ux + uy * uy
    slope = square + (ex * ax + ey * ay)
    # Near a centre of curvature the slope is no guide.
    slope = np.where(slope > 0.25 * square, slope, square)
    return np.clip(t - (ex * ux + ey * uy) / np.where(slope > 0.0, slope, 1.0), 0.0, 1.0)


def _foot_speed(curve: FittedCubics, x: Floats, y: Floats, vx: Floats, vy: Floats, t: Floats) -> Floats:
    """How fast the parameter t of the foot of a point changes when the point moves with a speed v."""
    (px, ux, ax), (py, uy, ay) = derivatives(curve.x, t), derivatives(curve.y, t)
    slope = ux * ux + uy * uy + ((px - x) * ax + (py - y) * ay)
    return np.asarray((vx * ux + vy * uy) / np.where(slope > 0.0, slope, np.inf))


def derivatives(c: Floats, t: Floats) -> tuple[Floats, Floats, Floats]:
    """One coordinate of curves at parameters, and its first and second derivatives."""
    a, b, d = c[1] - c[0], c[2] - c[1], c[3] - c[2]
    bend, last = b - a, d - b
    twist = last - bend
    return (
        c[0] + t * (3.0 * a + t * (3.0 * bend + t * twist)),
        3.0 * (a + t * (2.0 * bend + t * twist)),
        6.0 * (bend + t * twist),
    )

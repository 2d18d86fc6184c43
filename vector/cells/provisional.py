"""Provisional lower envelopes: bounds of the rows' cells by the bisectors with a few single points.

A point z bounds a row's cell by their bisector, and so do any three, each on its part of the row. The discs about the
points of a cell that just reach the row's element hold all that can matter. Those about the points of a bisector with
z all pass through z. Of a corner's row they make a pencil of circles: each lies in the union of those at the two ends
of its part. Of a half-edge's row, by the powers of points, each lies in the union of those at the two ends, a distance
w apart, their radii enlarged to sqrt(h^2 + w^2 / 4). So four discs hold all that matters, whatever the points, and
wherever the row is cut; the better these are, the smaller the discs.

Along a row t is its variable x, but for a half-edge measured from the middle of the row.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, starts
from voronoi_tiles.vector.cells.pencils import Rows

# Relative slack of the pruning tests, far above their rounding errors.
_SLACK = 1e-9


@dataclass(frozen=True, slots=True)
class Bounds:
    """What bounds each row's cell; tightened in place.

    No point of a row's cell is farther from the row's element than `height` (float64, n). Its provisional envelope
    are the bisectors with the points `point` (complex128, 3 x n), NaN where there is none, from the row's low to its
    high with the cuts `cut` (float64, 2 x n) between. All that can matter meets one of the four discs about `centre`
    (complex128, 4 x n) with the radii `reach` (float64, 4 x n), infinite where there is no bound; these lie in the disc
    about `middle` (complex128, n) with the radius `around` (float64, n). `rounding` is by how
    much coordinates, and their differences, may be off. All are in the design's units.
    """

    rounding: float
    height: Floats
    point: Complexes
    cut: Floats
    centre: Complexes
    reach: Floats
    middle: Complexes
    around: Floats

    @classmethod
    def none(cls, rows: Rows, height: float, rounding: float) -> Bounds:
        """No bounds but the height."""
        count = len(rows)
        return cls(
            rounding,
            np.full(count, height),
            np.full((3, count), np.nan, complex),
            np.stack((rows.low, rows.high)),
            np.zeros((4, count), complex),
            np.full((4, count), np.inf),
            np.zeros(count, complex),
            np.full(count, np.inf),
        )

    def wide(self, rows: Rows) -> Bools:
        """Which rows are long beside their height: points bound them badly."""
        return rows.spread > self.height / 8.0


class Provisional:
    """The points known so far that bound rows, and the bounds that follow."""

    def __init__(self, rows: Rows, covering_radius: float, rounding: float) -> None:
        """Begin without any points."""
        self.bounds = Bounds.none(rows, covering_radius, rounding)
        self._rows = rows
        self._straight = rows.straight
        self._middle = np.where(self._straight, (rows.low + rows.high) / 2.0, 0.0)
        self._low, self._high = rows.low - self._middle, rows.high - self._middle
        self._ends = (rows.base0, rows.ray0), (rows.base1, rows.ray1)
        # The points with the lowest bisectors at the low end, at the high end, and at the higher of both; between.
        self._lowest = np.full((3, len(rows)), np.inf)
        self._points = np.full((3, len(rows)), np.nan, complex)
        self._inner = np.full(len(rows), np.nan, complex)

    def lower(self, row: Ints, points: Complexes) -> None:
        """Take note of points, complex128 (k,), of the rows `row` (intp, k, ascending, not empty)."""
        rounding = self.bounds.rounding
        first = starts(row)
        low, high = (bisector(base[row], ray[row], points, rounding) for base, ray in self._ends)
        values = np.array((low, high, np.maximum(low, high)))
        _take_lowest(self._lowest, self._points, row, first, values, points)
        ends = self._quadratic(self._points[:2])
        between = self._crossing(ends[:, 0] - ends[:, 1], self._low, self._high)
        base, ray = self._ray(between)
        heights = bisector(base, ray, np.array((self._inner, self._points[2])), rounding)
        least = heights.min(axis=0, keepdims=True)
        self._inner = np.where(heights[1] <= heights[0], self._points[2], self._inner)
        found = bisector(base[row], ray[row], points, rounding)
        _take_lowest(least, self._inner[None], row, first, found[None], points)
        self._bound(ends, between)

    def _bound(self, ends: Floats, between: Floats) -> None:
        """The bounds by the points: the outer ones' bisectors are `ends`, the inner one is lowest at t = `between`."""
        bounds, rows = self.bounds, self._rows
        inner = self._quadratic(self._inner)
        difference = np.array((ends[:, 0] - inner, inner - ends[:, 1])).swapaxes(0, 1)
        cut = self._crossing(difference, np.array((self._low, between)), np.array((between, self._high)))
        bounds.point[0], bounds.point[1], bounds.point[2] = self._points[0], self._inner, self._points[1]
        base, ray = self._ray(cut)
        base, ray = np.array((rows.base0, *base, rows.base1)), np.array((rows.ray0, *ray, rows.ray1))
        heights = self._heights(base, ray)
        highest = heights.max(axis=0)
        unbounded = (highest == np.inf).nonzero()[0]
        if len(unbounded):
            # Two points may miss each other, while a single one bounds the whole row.
            bounds.point[:, unbounded] = self._points[2, unbounded]
            heights = self._heights(base, ray)
            highest = heights.max(axis=0)
        np.minimum(bounds.height, highest, out=bounds.height)
        np.add(cut, self._middle, out=bounds.cut)
        t = np.array((self._low, *cut, self._high))
        width = t[1:] - t[:-1]
        half = np.concatenate((width[:1], np.maximum(width[:-1], width[1:]), width[-1:]))
        half *= np.where(self._straight, 0.5, 0.0)
        np.multiply(np.sqrt(heights * heights + half * half), 1.0 + _SLACK, out=bounds.reach)
        heights[heights == np.inf] = 0.0
        place = np.array((base.real + heights * ray.real, base.imag + heights * ray.imag))
        bounds.centre.real, bounds.centre.imag = place
        reach = bounds.reach
        with np.errstate(invalid="ignore"):
            middle = ((place - reach).min(axis=1) + (place + reach).max(axis=1)) / 2.0
        middle = np.where(highest < np.inf, middle, 0.0)
        bounds.middle.real, bounds.middle.imag = middle
        x, y = place - middle[:, None]
        np.multiply((np.sqrt(x * x + y * y) + reach).max(axis=0), 1.0 + _SLACK, out=bounds.around)

    def _heights(self, base: Complexes, ray: Complexes) -> Floats:
        """The heights of the three points' envelope on its first and last ray and, on two between, of the higher."""
        ends = np.array((base[:-1], base[1:])), np.array((ray[:-1], ray[1:]))
        before, behind = bisector(*ends, self.bounds.point, self.bounds.rounding)
        return np.concatenate((before[:1], np.maximum(behind[:-1], before[1:]), behind[-1:]))

    def _ray(self, t: Floats) -> tuple[Complexes, Complexes]:
        """Where the rays at t start, and their unit directions, complex128 of the shape of t."""
        axis, base = self._rows.axis, self._rows.base
        # A half-edge's rays start beside each other, a corner's are turned.
        step = np.where(self._straight, t, 0.0)
        turn = np.where(self._straight, 1.0, t)
        square = turn * turn
        along, across = (1.0 - square) / (1.0 + square), 2.0 * turn / (1.0 + square)
        start, ray = np.empty(t.shape, complex), np.empty(t.shape, complex)
        start.real, start.imag = base.real + step * axis.real, base.imag + step * axis.imag
        ray.real, ray.imag = along * axis.real - across * axis.imag, along * axis.imag + across * axis.real
        return start, ray

    @staticmethod
    def _crossing(difference: Floats, low: Floats, high: Floats) -> Floats:
        """About where, between low and high, bisectors cross, by the quadratic that is their rising difference."""
        a, b, c = difference
        with np.errstate(divide="ignore", invalid="ignore"):
            root = np.sqrt(b * b - 4.0 * a * c)
            t = np.where(b >= 0.0, -2.0 * c / (b + root), (root - b) / (2.0 * a))
        t = np.where(np.isnan(t), (low + high) / 2.0, t)
        return np.minimum(np.maximum(t, low), high)

    def _quadratic(self, point: Complexes) -> Floats:
        """The coefficients of t^2, t and 1 of the rows' bisectors with points, float64 (3, *shape of point)."""
        axis, away = self._rows.axis, point - self._rows.base
        p = axis.real * away.real + axis.imag * away.imag
        q = axis.real * away.imag - axis.imag * away.real
        square = p * p + q * q
        result = np.empty((3, *p.shape))
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = np.where(self._straight, 0.5 / q, 2.0 / square)
            result[0] = np.where(self._straight, scale, scale * p)
            result[1] = -2.0 * scale * np.where(self._straight, p, q)
            result[2] = scale * np.where(self._straight, square, -p)
        return result


def _take_lowest(lowest: Floats, points: Complexes, row: Ints, first: Ints, values: Floats, found: Complexes) -> None:
    """Replace rows' points by those with the lowest values, in place.

    `lowest` (float64, k x rows) are the values of `points`, `values` (float64, k x n) those of the points `found` (n,).
    """
    # To take along an axis is many times as quick as an index behind a slice.
    which = row[first]
    lowest[:, which] = np.minimum(lowest.take(which, axis=1), np.minimum.reduceat(values, first, axis=1))
    hits = (values == lowest.take(row, axis=1)) & (values < np.inf)
    kind, at = np.divmod(np.flatnonzero(hits), len(found))
    points[kind, row[at]] = found[at]


def bisector(base: Complexes, ray: Complexes, points: Complexes, rounding: float) -> Floats:
    """Bounds on the heights at which rays meet the bisectors of their base and points; infinite if they do not.

    Coordinates are uncertain by `rounding`, which counts where a point is near the base or square to the ray.
    """
    away = points - base
    along = away.real * ray.real + away.imag * ray.imag - rounding
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(along > 0.0, (away.real * away.real + away.imag * away.imag) / (2.0 * along), np.inf)

"""Cubic Bezier curves that follow stretches of smooth runs, with the tangents at both ends given."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Floats, Ints
from voronoi_tiles.base.kernels import FLOATS, INT, INTS, kernel
from voronoi_tiles.paths.cubic_bounds import FittedCubics, bounds, derivatives, nearer_foot
from voronoi_tiles.paths.smooth_runs import SmoothRuns, tangents
from voronoi_tiles.paths.stretch_parts import StretchEnds, StretchParts, cut

_STEPS: Final = 5
"""Steps of Gauss and Newton in which handles are found; a count."""

_TIE: Final = 1e-8
"""The weight that ties handles to a third of the length, relative to that of the distances: where the curve is straight
these say nothing of handles."""

_SHORTEST, _LONGEST = 0.02, 2.0
"""What handles may be; relative to the stretch's length. Positive handles keep the tangents' sense."""

_FARTHEST: Final = 0.3
"""What a handle may change by in a step; relative to the stretch's length."""

_SIDE: Final = 8
"""Points on either side of a place by which a tangent is found; a count."""

_AROUND: Final = np.linspace(-1.0, 1.0, 2 * _SIDE + 1)
"""These points and the place; relative to the window."""

_LEAST: Final = 0.02
"""The weight of the outermost points; that of the place is 1."""

_UNITS: Final = 2.0**44
"""Shares of a stretch's length are whole numbers of parts as small as this."""


# What the compiled kernel takes, as in cubic_fit.c.
_FITS = kernel("cubic_fits", INT, INTS, FLOATS, FLOATS, INTS, INT, *10 * [FLOATS])


class CubicFit(NamedTuple):
    """Cubic curves in the place of stretches, and bounds on their Hausdorff distances from these."""

    curves: FittedCubics
    bound: Floats


class _Hermite(NamedTuple):
    """What is given of curves that begin at 0: their ends and unit tangents, and the length of each."""

    ends: StretchEnds
    length: Floats

    def curves(self, near: Floats, far: Floats) -> FittedCubics:
        """The curves whose handles have these lengths."""
        x, y, ax, ay, bx, by = self.ends
        zero = np.zeros(len(x))
        return FittedCubics(np.stack((zero, near * ax, x - far * bx, x)), np.stack((zero, near * ay, y - far * by, y)))


class PlacedStretches(NamedTuple):
    """Stretches of runs from one place to another, and the windows by which tangents are found at these two.

    Those that are `even` are their own images backwards.
    """

    run: Ints
    low: Floats
    high: Floats
    low_window: Floats
    high_window: Floats
    even: Bools


def fit_cubics(runs: SmoothRuns, stretches: PlacedStretches) -> CubicFit:
    """Replace each stretch by one cubic curve.

    It has the ends of the stretch and the tangents of `tangents_at` there, so that curves of neighbouring stretches
    go on smoothly. The lengths of the two handles are such that the squares of the distances from the stretch, along
    the curve's normals, come to the least: steps of Gauss and Newton, with the feet of points found along the way.
    Stretches that are even get a curve that is. A compiled kernel and numpy give the same bits.
    """
    run, low, high, low_window, high_window, even = stretches
    parts, ends = cut(runs, run, low, high)
    stretch, first = parts.stretch, parts.first[:-1]
    lengths = _lengths(parts)
    total = np.add.reduceat(lengths, first)
    bx, by = tangents_at(runs, run, high, high_window)
    ax, ay = _evened(ends.x, ends.y, *tangents_at(runs, run, low, low_window), bx, by, even)
    given = _Hermite(StretchEnds(ends.x, ends.y, ax, ay, bx, by), total)
    share = np.ceil(lengths / total[stretch] * _UNITS).astype(np.int64)  # they add up without rounding
    sums = np.cumsum(share) - share
    before = (sums - sums[first][stretch]) / _UNITS
    # The samples are where parts begin and their middles.
    x, y = (np.stack((c[0], (c[0] + 3.0 * (c[1] + c[2]) + c[3]) / 8.0)) for c in (parts.x, parts.y))
    samples = _Samples(x, y, np.stack((before, before + share / (2 * _UNITS))), share / _UNITS)
    return _fitted_compiled(given, parts, samples, even) or _fitted(given, parts, samples, even)


class _Samples(NamedTuple):
    """Points of the parts of stretches, two each, and parameters near their feet: all (2, m); their weight, (m,)."""

    x: Floats
    y: Floats
    t: Floats
    weight: Floats


def _fitted_compiled(given: _Hermite, parts: StretchParts, samples: _Samples, even: Bools) -> CubicFit | None:
    """What `_fitted` gives, with the same bits; None without the compiled kernels."""
    compiled = _FITS()
    if compiled is None:
        return None
    count = len(given.length)
    near, far, bound = np.empty((3, count))
    rules = np.array([_STEPS, _TIE, _SHORTEST, _LONGEST, _FARTHEST])
    points = parts.x, parts.y, samples.weight, samples.x, samples.y, samples.t
    ends = np.stack(given.ends)
    shape = count, parts.first, ends, given.length, even.astype(np.int64), len(parts.stretch)
    compiled(*shape, *points, rules, near, far, bound)
    return CubicFit(given.curves(near, far), bound)


def _fitted(given: _Hermite, parts: StretchParts, samples: _Samples, even: Bools) -> CubicFit:
    """The curves with the best handles, and the bounds."""
    t = samples.t
    near = far = given.length / 3.0
    for step in range(_STEPS):
        here = given.curves(near, far).of(parts.stretch)
        for _ in range(2 if step == 0 else 1):
            t = nearer_foot(here, samples.x, samples.y, t)
        near, far = _better_handles(given, parts.stretch, samples._replace(t=t), here, near, far)
    both = (near + far) / 2
    near, far = np.where(even, both, near), np.where(even, both, far)
    curves = given.curves(near, far)
    return CubicFit(curves, bounds(parts, curves, t[0]))


def tangents_at(runs: SmoothRuns, run: Ints, place: Floats, window: Floats) -> tuple[Floats, Floats]:
    """The unit tangents at places of runs, x and y; at a small joint, halfway between those beside it.

    Where the `window` is not 0, they are those of a cubic polynomial of the length that comes nearest to the run as far
    as the window reaches to both sides: flattened strokes leave small joints and waves along a run, whose own tangents
    lead astray.
    """
    x, y = np.empty((2, len(run)))
    own, wide = np.flatnonzero(window == 0.0), np.flatnonzero(window > 0.0)
    if len(own):
        x[own], y[own] = _own_tangents(runs, run[own], place[own])
    if len(wide):
        x[wide], y[wide] = _mean_tangents(runs, run[wide], place[wide], window[wide])
    return x, y


def _mean_tangents(runs: SmoothRuns, run: Ints, place: Floats, window: Floats) -> tuple[Floats, Floats]:
    """The unit tangents of the polynomials of `tangents_at`."""
    around = np.clip(place + window * _AROUND[:, None], 0.0, runs.total[run])
    segment, t = runs.locate(np.tile(run, len(_AROUND)), around.ravel(), before=False)
    x, y = (values.reshape(around.shape) for values in runs.points(segment, t))
    x, y = x - x[_SIDE], y - y[_SIDE]
    dx, dy = np.diff(x, axis=0), np.diff(y, axis=0)
    length = np.concatenate((np.zeros((1, len(run))), np.cumsum(np.sqrt(dx * dx + dy * dy), axis=0)))
    length -= length[_SIDE]
    length /= np.maximum(length[-1], -length[0])
    terms = [np.maximum(1.0 - length * length, 0.0) + _LEAST]
    for _ in range(6):
        terms.append(terms[-1] * length)
    sums = [_sum(term) for term in terms]
    rows = [[*sums[i : i + 4], _sum(terms[i] * x), _sum(terms[i] * y)] for i in range(4)]
    tx, ty = _solved(rows)
    size = np.sqrt(tx * tx + ty * ty)
    return tx / size, ty / size


def _sum(values: Floats) -> Floats:
    """The sums of columns, added one row after the other, which `np.sum` does for some shapes only."""
    return np.asarray(np.cumsum(values, axis=0)[-1])


def _solved(rows: list[list[Floats]]) -> list[Floats]:
    """The second unknowns of systems of four equations, positive definite; `rows` are those, right-hand sides last.

    By elimination in a fixed order, of which every processor makes the same bits.
    """
    order = (0, 2, 3, 1)  # the one that is wanted last
    rows = [[rows[i][j] for j in (*order, *range(4, len(rows[i])))] for i in order]
    for k in range(3):
        for i in range(k + 1, 4):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    return [value / rows[3][3] for value in rows[3][4:]]


def _evened(x: Floats, y: Floats, ax: Floats, ay: Floats, bx: Floats, by: Floats, even: Bools) -> tuple[Floats, Floats]:
    """The tangents a, of stretches that are even to the bit as the tangents b at the end (x, y) ask for it."""
    # A mirror stands across the chord: b is reflected in the chord's direction. A half turn leaves b as it is.
    size = np.where((x == 0.0) & (y == 0.0), 1.0, x * x + y * y)
    along = 2.0 * (bx * x + by * y) / size
    mx, my = along * x - bx, along * y - by
    mirrored = (mx - ax) ** 2 + (my - ay) ** 2 < (bx - ax) ** 2 + (by - ay) ** 2
    return (
        np.where(even, np.where(mirrored, mx, bx), ax),
        np.where(even, np.where(mirrored, my, by), ay),
    )


def _own_tangents(runs: SmoothRuns, run: Ints, place: Floats) -> tuple[Floats, Floats]:
    """The tangents of the runs themselves."""
    before, after = (runs.locate(run, place, before=flag) for flag in (True, False))
    (px, py), (qx, qy) = (
        tangents(runs.x[:, segment], runs.y[:, segment], t, ahead=ahead)
        for (segment, t), ahead in ((before, False), (after, True))
    )
    # Where a run begins or ends there is but one.
    x = np.where(place <= 0.0, qx, np.where(place >= runs.total[run], px, px + qx))
    y = np.where(place <= 0.0, qy, np.where(place >= runs.total[run], py, py + qy))
    size = np.sqrt(x * x + y * y)
    return x / size, y / size


def _lengths(parts: StretchParts) -> Floats:
    """The lengths of parts' control polygons."""
    dx, dy = np.diff(parts.x, axis=0), np.diff(parts.y, axis=0)
    a, b, c = np.sqrt(dx * dx + dy * dy)
    return np.asarray(a + b + c)


def _better_handles(
    given: _Hermite, stretch: Ints, samples: _Samples, curve: FittedCubics, near: Floats, far: Floats
) -> tuple[Floats, Floats]:
    """Handles after one step of Gauss and Newton: `curve` is that of each part, with the feet of `samples` on it."""
    t, weight = samples.t, samples.weight
    (px, ux, _), (py, uy, _) = derivatives(curve.x, t), derivatives(curve.y, t)
    speed = np.sqrt(ux * ux + uy * uy)
    speed = np.where(speed > 0.0, speed, 1.0)
    nx, ny = -uy / speed, ux / speed
    off = (samples.x - px) * nx + (samples.y - py) * ny
    s, ends = 1.0 - t, given.ends
    by_near = 3.0 * s * s * t * (ends.ax[stretch] * nx + ends.ay[stretch] * ny)
    by_far = -3.0 * s * t * t * (ends.bx[stretch] * nx + ends.by[stretch] * ny)

    def over_all(values: Floats) -> Floats:
        """The weighted sums over the samples of stretches, added in their order."""
        return np.asarray(np.bincount(stretch, weight * (values[0] + values[1])), np.float64)

    third = given.length / 3.0
    a, b = over_all(by_near * by_near) + _TIE, over_all(by_far * by_far) + _TIE
    mixed = over_all(by_near * by_far)
    u, v = over_all(by_near * off) + _TIE * (third - near), over_all(by_far * off) + _TIE * (third - far)
    det = a * b - mixed * mixed  # positive, by the ties
    most, low, high = (share * given.length for share in (_FARTHEST, _SHORTEST, _LONGEST))
    return (
        np.clip(near + np.clip((b * u - mixed * v) / det, -most, most), low, high),
        np.clip(far + np.clip((a * v - mixed * u) / det, -most, most), low, high),
    )

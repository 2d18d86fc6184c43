"""Stretches of smooth runs of curves cut into parts, over which bounds are good."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints, ranges
from voronoi_tiles.base.kernels import FLOAT, FLOATS, INT, INTS, kernel
from voronoi_tiles.paths.smooth_runs import SNAP, SmoothRuns, tangents

PARTS = 12
"""A stretch is bounded in about this many parts, which makes the bounds at most a few percent too large."""

# What the compiled kernels take, as in biarc_bounds.c.
_PLACES = kernel("biarc_places", INT, INTS, FLOATS, FLOATS, INTS, FLOATS, FLOATS, FLOAT, FLOAT, INTS, FLOATS, INTS)
_PARTS = kernel("biarc_parts", INT, INT, *5 * [FLOATS], FLOAT, INTS, FLOATS, INT, *3 * [FLOATS], INTS)


class StretchParts(NamedTuple):
    """The parts of all stretches, m in order.

    Their control points from the stretch's beginning, `x` and `y` (4, m), the Bernstein coefficients of half the
    squares of their distances from there, (7, m), the `stretch` of each (m,), and where those of each stretch begin,
    `first` (stretches + 1,): the last number is m.
    """

    x: Floats
    y: Floats
    squares: Floats
    stretch: Ints
    first: Ints

    def most(self, values: Floats) -> Floats:
        """The largest of the parts' values (m,) in each stretch."""
        return np.maximum.reduceat(values, self.first[:-1])


class StretchEnds(NamedTuple):
    """Where stretches end, from their beginnings, and their unit tangents a and b at the two ends."""

    x: Floats
    y: Floats
    ax: Floats
    ay: Floats
    bx: Floats
    by: Floats


_Places = tuple[Ints, Floats]
"""Where stretches begin and end: the segments and the parameters, (2, stretches) each."""


def cut(runs: SmoothRuns, run: Ints, low: Floats, high: Floats) -> tuple[StretchParts, StretchEnds]:
    """Cut stretches at the joints of segments and into about PARTS parts; also the ends of the stretches."""
    (segment, t), parts = _cut_compiled(runs, run, low, high) or _cut_by_numpy(runs, run, low, high)
    (begin, last), (at, until) = segment, t
    final = parts.first[1:] - 1
    a = tangents(runs.x[:, begin], runs.y[:, begin], at, ahead=True)
    b = tangents(runs.x[:, last], runs.y[:, last], until, ahead=False)
    return parts, StretchEnds(parts.x[3, final], parts.y[3, final], *a, *b)


def _cut_compiled(runs: SmoothRuns, run: Ints, low: Floats, high: Floats) -> tuple[_Places, StretchParts] | None:
    """What `_cut_by_numpy` gives, with the same bits; None without the compiled kernels."""
    find, fill = _PLACES(), _PARTS()
    if find is None or fill is None:
        return None
    count = len(run)
    segment, t, first = np.empty((2, count), np.intp), np.empty((2, count)), np.empty(count + 1, np.intp)
    m = find(count, runs.first, runs.begin, runs.size, run, low, high, SNAP, PARTS, segment, t, first)
    x, y, squares, stretch = np.empty((4, m)), np.empty((4, m)), np.empty((7, m)), np.empty(m, np.intp)
    n = runs.x.shape[1]
    fill(count, n, runs.x, runs.y, runs.size, low, high, PARTS, segment, t, m, x, y, squares, stretch)
    return (segment, t), StretchParts(x, y, squares, stretch, first)


def _cut_by_numpy(runs: SmoothRuns, run: Ints, low: Floats, high: Floats) -> tuple[_Places, StretchParts]:
    """Where stretches begin and end, and their parts."""
    begin, at = runs.locate(run, low, before=False)
    last, until = runs.locate(run, high, before=True)
    last = np.maximum(last, begin)
    count = last - begin + 1
    owner = np.repeat(np.arange(len(run)), count)
    segment = ranges(begin, count)
    t0 = np.where(segment == begin[owner], at[owner], 0.0)
    t1 = np.where(segment == last[owner], until[owner], 1.0)
    part_of_all = runs.size[segment] * (t1 - t0) / (high - low)[owner]
    parts = np.maximum(np.ceil(PARTS * part_of_all - 1e-9), 1.0).astype(np.intp)
    row = np.repeat(np.arange(len(segment)), parts)
    number = ranges(np.zeros(len(segment), np.intp), parts)
    step = ((t1 - t0) / parts)[row]
    from_, to = t0[row] + number * step, t0[row] + (number + 1) * step
    segment, owner = segment[row], owner[row]
    start = np.stack(runs.points(begin, at))
    x, y = (
        _between(coefficients[:, segment], origin[owner], from_, to)
        for coefficients, origin in zip((runs.x, runs.y), start, strict=True)
    )
    first = np.searchsorted(owner, np.arange(len(run) + 1))
    return (np.stack((begin, last)), np.stack((at, until))), StretchParts(x, y, squares_of(x, y), owner, first)


def _between(c: Floats, origin: Floats, t0: Floats, t1: Floats) -> Floats:
    """One coordinate of the control points of cubics between two parameters, (4, m): their polar forms."""
    base = c[0] - origin
    sum_, product = t0 + t1, t0 * t1
    return np.stack(
        (
            base + t0 * (3 * c[1] + t0 * (3 * c[2] + t0 * c[3])),
            base + c[1] * (sum_ + t0) + c[2] * (t0 * t0 + 2 * product) + c[3] * (t0 * product),
            base + c[1] * (sum_ + t1) + c[2] * (t1 * t1 + 2 * product) + c[3] * (t1 * product),
            base + t1 * (3 * c[1] + t1 * (3 * c[2] + t1 * c[3])),
        )
    )


def squares_of(x: Floats, y: Floats) -> Floats:
    """The Bernstein coefficients of degree 6 of |d|^2 / 2 along cubics with control points (4, m): (7, m)."""
    (x0, x1, x2, x3), (y0, y1, y2, y3) = x, y
    return np.stack(
        (
            (x0 * x0 + y0 * y0) / 2,
            (x0 * x1 + y0 * y1) / 2,
            ((x0 * x2 + y0 * y2) * 2 + (x1 * x1 + y1 * y1) * 3) / 10,
            ((x0 * x3 + y0 * y3) + (x1 * x2 + y1 * y2) * 9) / 20,
            ((x1 * x3 + y1 * y3) * 2 + (x2 * x2 + y2 * y2) * 3) / 10,
            (x2 * x3 + y2 * y3) / 2,
            (x3 * x3 + y3 * y3) / 2,
        )
    )

"""The lower envelope of partial quadratics, for many rows at once."""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints, counting
from voronoi_tiles.vector.cells.partial_quadratics import PartialQuadratics

NOTHING: Final = -1
"""The index of no function."""
# A longer step, relative to the distance of the next root, is not a correction of rounding.
_NEAR = 1e-3
_BOTH = np.array([[0], [1]])


def lower_envelope(functions: PartialQuadratics, low: Floats, high: Floats) -> tuple[Ints, Floats, Floats, Ints]:
    """The lower envelope of each row's functions on its interval from `low` to `high`, float64 (rows,).

    The result are the envelopes' parts (row, start, end, lowest): intp, float64, float64 and intp (k,), by row and
    start, without gaps from low to high. `lowest` is an index into `functions`, or NOTHING where none is defined.
    `functions` are sorted by row.

    By divide and conquer: each function is an envelope of its own, and neighbouring envelopes are merged in pairs, all
    rows at once, until each row has one. In a merge every interval between break points has one function from either
    envelope; their crossings cut it into at most three parts, and the middle of each part decides. No tolerance takes
    part; equal functions count as their first.
    """
    rows = len(low)
    count = np.bincount(functions.row, minlength=rows)
    index, _ = counting(count)
    stride = int(count.max(initial=0)) or 1
    group = functions.row * stride + index
    # Every envelope starts at its row's low, with nothing where its function is not defined.
    late = (functions.low > low[functions.row]).nonzero()[0]
    early = (functions.high < high[functions.row]).nonzero()[0]
    group = np.concatenate((group, group[late], group[early]))
    start = np.concatenate((functions.low, low[functions.row[late]], functions.high[early]))
    lowest = np.concatenate((np.arange(len(functions.row)), np.full(len(late) + len(early), NOTHING)))
    if stride == 1:
        order = np.lexsort((start, group))
        group, start, lowest = group[order], start[order], lowest[order]
    while stride > 1:
        row, index = np.divmod(group, stride)
        stride = (stride + 1) // 2
        group, start, lowest = _merge(functions, row * stride + (index >> 1), index & 1, start, lowest, high, stride)
    end = np.append(start[1:], 0.0)
    last = np.append(group[1:] != group[:-1], True)
    end[last] = high[group[last]]
    return group, start, end, lowest


def _merge(
    functions: PartialQuadratics, group: Ints, which: Ints, start: Floats, lowest: Ints, high: Floats, stride: int
) -> tuple[Ints, Floats, Ints]:
    """The lower envelopes of each group's two, that of which 0 and that of which 1: (group, start, lowest), sorted."""
    order = np.lexsort((start, group))
    group, which, start, lowest = group[order], which[order], start[order], lowest[order]
    place = np.arange(len(group))
    fresh = np.empty(len(group), bool)
    fresh[0] = True
    np.not_equal(group[1:], group[:-1], out=fresh[1:])
    opening = np.maximum.accumulate(np.where(fresh, place, 0))
    # The function of either envelope that rules from here on: the one that started last.
    last = np.maximum.accumulate(np.where(which == _BOTH, place, -1), axis=1)
    first, second = np.where(last >= opening, lowest[last], NOTHING)
    end = _ends(group, start, high[group // stride])
    winner = np.maximum(first, second)
    wide = end > start
    contested = (wide & (np.minimum(first, second) >= 0)).nonzero()[0]
    if len(contested):
        extra = _contest(functions, contested, first, second, start, end, winner)
        if extra is not None:
            where, at, who = extra
            group, start = np.concatenate((group, group[where])), np.concatenate((start, at))
            winner = np.concatenate((winner, who))
            order = np.argsort(np.concatenate((place, where)), kind="stable")
            group, start, winner = group[order], start[order], winner[order]
            wide = _ends(group, start, high[group // stride]) > start
    kept = wide.nonzero()[0]
    group, start, winner = group[kept], start[kept], winner[kept]
    new = np.empty(len(group), bool)
    new[0] = True
    np.not_equal(group[1:], group[:-1], out=new[1:])
    new[1:] |= winner[1:] != winner[:-1]
    kept = new.nonzero()[0]
    return group[kept], start[kept], winner[kept]


def _ends(group: Ints, start: Floats, high: Floats) -> Floats:
    """Where the parts end that start there: where their group's next one starts, or at the group's high."""
    end = np.empty(len(start))
    end[:-1] = start[1:]
    final = np.append(group[1:] != group[:-1], True)
    end[final] = high[final]
    return end


def _contest(
    functions: PartialQuadratics, index: Ints, first: Ints, second: Ints, start: Floats, end: Floats, winner: Ints
) -> tuple[Ints, Floats, Ints] | None:
    """Decide intervals on which both envelopes have a function.

    Sets `winner` in place for each interval's first part; the result are the further parts as (interval, start,
    lowest), in order, or None.
    """
    one, other = first[index], second[index]
    pair = np.array((np.minimum(one, other), np.maximum(one, other)))
    x0, x1 = start[index], end[index]
    middle, half = (x0 + x1) / 2, (x1 - x0) / 2
    # The difference about the interval's middle: v + b t + a t^2 for |t| < half.
    v, b, a = functions.differences(pair, middle)
    winner[index] = np.where(v <= 0.0, *pair)
    # Without a root in reach the sign at the middle decides; this spares most intervals the formula.
    reach = np.abs(b) * half + np.abs(a) * half * half
    near = (np.abs(v) <= reach).nonzero()[0]
    if not len(near):
        return None
    v, b, a, half = v[near], b[near], a[near], half[near]
    discriminant = b * b - 4.0 * a * v
    with np.errstate(divide="ignore", invalid="ignore"):
        q = -0.5 * (b + np.copysign(np.sqrt(discriminant), b))
        roots = np.array((q / a, v / q))
    roots = np.where(np.abs(roots) < half, roots, np.nan)
    low, high = np.fmin(*roots), np.fmax(*roots)
    cut = (~np.isnan(low)).nonzero()[0]
    if not len(cut):
        return None
    v, b, a, half, low, high = v[cut], b[cut], a[cut], half[cut], low[cut], high[cut]
    near = near[cut]
    index, pair = index[near], pair.take(near, axis=1)
    # Before, between and behind both roots.
    t = np.array((low - half, low + high, high + half)) / 2
    lowest = np.where(v + t * (b + t * a) <= 0.0, *pair)
    winner[index] = lowest[0]
    at = middle[near] + np.array((low, high))
    # About the middle of its interval a steep lowest is large, and its roots have that many digits fewer: one step of
    # Newton's method from where the functions themselves are small gives them back.
    value, slope, _ = functions.differences(pair[:, None], at)
    with np.errstate(divide="ignore", invalid="ignore"):
        step = value / slope
    two = high > low
    reach = _NEAR * np.where(two, np.minimum(high - low, half), half)
    at = np.where(np.abs(step) <= reach, at - step, at)
    # Rounding must not carry a cut over the interval's end: the order of starts is what the next merge relies on.
    at = np.minimum(np.maximum(at, x0[near]), x1[near])
    # A single root has come twice: nothing is between.
    further = np.concatenate((two.nonzero()[0], np.arange(len(two), 2 * len(two))))
    where, at, who = np.concatenate((index, index))[further], at.ravel()[further], lowest[1:].ravel()[further]
    order = np.lexsort((at, where))
    return where[order], at[order], who[order]

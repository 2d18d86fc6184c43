"""The order in which separate strokes are taken, so that the way between them is short."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.neighbours import Neighbours

_NEAR = 10
"""Neighbours of each end that are looked up at once."""

_CLOSE = 7
"""The same for reversals."""

_ROUNDS = 60
"""Most rounds of reversals."""

_MOVES = 400
"""Most reversals of one round, the best ones."""

_ENOUGH = 1e-3
"""A round that gains less, relative to the way, is the last."""


def short_tour(start: Complexes, end: Complexes) -> tuple[Ints, Bools]:
    """Order strokes from `start[k]` to `end[k]`, so that the ways from each one's end to the next are short.

    Returns the order and, for each in it, whether it is to be run backwards. It begins with the stroke that reaches
    nearest to the lower left corner, and always takes the nearest end of those that are left; then stretches of the
    tour are reversed while that shortens it (2-opt among near neighbours). A closed stroke starts where it ends.

    Source: G. A. Croes, A method for solving traveling-salesman problems, Oper. Res. 6 (1958).
    """
    order, turned = _untangled(start, end, *nearest_first(start, end))
    # A closed stroke keeps its direction: it starts where it ends, whichever way it is run.
    return order, turned & (start != end)[order]


def nearest_first(start: Complexes, end: Complexes) -> tuple[Ints, Bools]:
    """Always take the nearest end of the strokes that are left."""
    count = len(start)
    if not count:
        return np.zeros(0, np.intp), np.zeros(0, np.bool_)
    ends = np.concatenate((start, end))
    closed = start == end
    corner = ends.real + ends.imag
    left = np.ones(count, np.bool_)
    order = np.empty(count, np.intp)
    turned = np.zeros(count, np.bool_)
    choice = int(corner.argmin())
    members = np.flatnonzero(np.concatenate((left, left & ~closed)))
    tree = Neighbours(ends[members])
    near = members[tree.nearest(ends, min(_NEAR, len(members)))[1]]
    for step in range(count):
        stroke = choice % count
        order[step], turned[step] = stroke, choice >= count
        left[stroke] = False
        if step == count - 1:
            break
        here = stroke if turned[step] else stroke + count
        choice = next((k for k in near[here].tolist() if left[k % count]), -1)
        if choice < 0:
            # All near ones are taken: look farther, in a tree that is made anew when half of it is gone.
            if 2 * (count - step) < len(members) // 2:
                members = np.flatnonzero(np.concatenate((left, left & ~closed)))
                tree = Neighbours(ends[members])
            choice = _nearest_left(tree, members, ends[here], left)
    return order, turned


def _nearest_left(tree: Neighbours, members: Ints, place: complex, left: Bools) -> int:
    """The nearest end of a stroke that is left."""
    number = 4 * _NEAR
    while True:
        number = min(number, len(members))
        _, near = tree.nearest(np.array([place]), number)
        for k in members[near[0]].tolist():
            if left[k % len(left)]:
                return int(k)
        number *= 4


def _untangled(start: Complexes, end: Complexes, order: Ints, turned: Bools) -> tuple[Ints, Bools]:
    """Reverse stretches of a tour while that shortens it."""
    for _ in range(_ROUNDS):
        entry = np.where(turned, end[order], start[order])
        leave = np.where(turned, start[order], end[order])
        way = np.append(np.abs(entry[1:] - leave[:-1]), 0.0)
        first, last, gain = _shorter(entry, leave, way)
        chosen = _compatible(first, last)
        if not len(chosen) or float(gain[chosen].sum()) <= _ENOUGH * float(way.sum()):
            break
        # Stretches within stretches come first: they are still where they were.
        for k in chosen[np.argsort(last[chosen] - first[chosen], kind="stable")].tolist():
            stretch = slice(int(first[k]) + 1, int(last[k]) + 1)
            order[stretch] = order[stretch][::-1]
            turned[stretch] = ~turned[stretch][::-1]
    return order, turned


def _shorter(entry: Complexes, leave: Complexes, way: Floats) -> tuple[Ints, Ints, Floats]:
    """The stretches whose reversal shortens the tour, the best first: those after the stroke i, up to the stroke j."""
    count = len(entry)
    if count < 3:
        none = np.zeros(0, np.intp)
        return none, none, np.zeros(0)
    pairs = []
    # Reversed, the stretch is reached from i at the end of j, and left for j + 1 at the beginning of i + 1.
    for points, back in ((leave, 0), (entry, 1)):
        near = Neighbours(points).nearest(points, min(_CLOSE, count))[1]
        one = np.repeat(np.arange(count), near.shape[1]) - back
        two = near.ravel() - back
        low, high = np.minimum(one, two), np.maximum(one, two)
        kept = (low >= 0) & (low + 1 < high)
        pairs.append(low[kept] * count + high[kept])
    i, j = np.divmod(np.unique(np.concatenate(pairs)), count)
    after = np.minimum(j + 1, count - 1)
    back_way = np.where(j + 1 < count, np.abs(entry[i + 1] - entry[after]), 0.0)
    gain = way[i] + way[j] - np.abs(leave[i] - leave[j]) - back_way
    better = np.flatnonzero(gain > 1e-9)
    better = better[np.argsort(-gain[better], kind="stable")][:_MOVES]
    return i[better], j[better], gain[better]


def _compatible(first: Ints, last: Ints) -> Ints:
    """Of stretches, best first, those that do not cut better ones: they are apart, or one lies in the other."""
    chosen: list[int] = []
    for k in range(len(first)):
        i, j = first[k], last[k]
        a, b = first[chosen], last[chosen]
        apart = (b < i) | (j < a)
        within = ((a < i) & (j < b)) | ((i < a) & (b < j))
        if (apart | within).all():
            chosen.append(k)
    return np.array(chosen, np.intp)

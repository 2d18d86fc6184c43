"""A proper colouring of copies with a chosen number of colours, each on as many copies as the others if that can be."""

from __future__ import annotations

from collections import deque
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.components import components
from voronoi_tiles.groups.periodic_colouring import (
    SEARCHED,
    SQUARES,
    PeriodicColouring,
    Repeat,
    colour_graph,
    quotient_graph,
)

_SWAPS = 1_000
"""Most changes of one colouring on its way to a balance; a count. Each brings two colours nearer to each other."""


def balance_colours(pairs: Ints, fewest: PeriodicColouring, colours: int) -> PeriodicColouring | None:
    """Colour copies so that no pair is alike, with so many colours, each on nearly as many copies as any other.

    `pairs` are those of `colour_pairs`, `fewest` is its answer, which has as many colours or fewer. Of the repeats of
    up to 4 x 4 cells, those of 2 to 4 times as many cells as colours, and that of `fewest`, the smallest is taken in
    which all counts are equal, as far as a search finds it; else the one whose counts differ by the least share.
    None where no repeat holds so many copies.
    """
    placements = len(fewest.colour)
    sizes = {*SQUARES, *((k, colours) for k in range(1, 5)), *((colours, k) for k in range(1, 5))}
    repeats = [Repeat(((1, 0), (0, 1)), m, n) for m, n in sorted(sizes, key=lambda size: (size[0] * size[1], size))]
    best: tuple[float, PeriodicColouring] | None = None
    for repeat in [*repeats, fewest.repeat]:
        count = placements * repeat.m * repeat.n
        if count < colours or count > SEARCHED:
            continue
        beside = quotient_graph(pairs, placements, repeat)
        first = fewest.colour.ravel() if repeat == fewest.repeat else None
        if first is None and beside is not None:
            first = colour_graph(beside, colours)
        if beside is None or first is None:
            continue
        found = _balanced(beside, first, colours)
        counts = np.bincount(found, minlength=colours)
        uneven = int(counts.max() - counts.min()) / count
        if counts.min() > 0 and (best is None or uneven < best[0]):
            best = uneven, PeriodicColouring(repeat, found.reshape(placements, repeat.m, repeat.n))
        if best is not None and best[0] == 0.0:
            break
    return None if best is None else best[1]


def _balanced(beside: NDArray[np.bool_], colour: Ints, colours: int) -> Ints:
    """A colouring of a graph with counts that are as equal as steps make them that bring two of them together.

    A step hands nodes on from colour to colour, one to each, or exchanges two colours in one part of their graph
    (Kempe 1879).
    """
    colour = colour.copy()
    for _ in range(_SWAPS):
        counts = np.bincount(colour, minlength=colours)
        order = np.argsort(-counts, kind="stable").tolist()
        uneven = sorted(
            ((b, a) for a, b in combinations(order[::-1], 2) if counts[b] - counts[a] > 1),
            key=lambda pair: int(counts[pair[1]] - counts[pair[0]]),
        )
        if not any(_hand_on(beside, colour, *pair) or _exchange(beside, colour, *pair) for pair in uneven):
            break
    return colour


def _hand_on(beside: NDArray[np.bool_], colour: Ints, many: int, few: int) -> bool:
    """Make one node less of one colour and one more of another, by way of others; whether that could be."""
    colours = max(int(colour.max()), many, few) + 1
    # How many neighbours of each colour each node has.
    near = np.stack([beside[:, colour == c].sum(axis=1) for c in range(colours)], axis=1)
    came: dict[int, tuple[int, int]] = {}
    queue = deque([many])
    while queue and few not in came:
        here = queue.popleft()
        nodes = np.flatnonzero(colour == here)
        for there in range(colours):
            if there != many and there not in came:
                free = nodes[near[nodes, there] == 0]
                if len(free):
                    came[there] = (here, int(free[0]))
                    queue.append(there)
    if few not in came:
        return False
    at = few
    while at != many:
        before, node = came[at]
        colour[node] = at
        at = before
    return True


def _exchange(beside: NDArray[np.bool_], colour: Ints, many: int, few: int) -> bool:
    """Exchange two colours in a connected part of the nodes that have them, so that counts come nearer; whether any."""
    nodes = np.flatnonzero((colour == many) | (colour == few))
    part = components(len(nodes), *np.nonzero(beside[np.ix_(nodes, nodes)]))
    sign = np.where(colour[nodes] == many, 1, -1)
    surplus = np.bincount(part, sign).astype(np.intp)
    gap = int(sign.sum())
    # Two counts that differ by g differ by |g - 2 s| when a part with the surplus s is exchanged.
    best = int(np.argmin(np.abs(gap - 2 * surplus)))
    if abs(gap - 2 * int(surplus[best])) >= gap:
        return False
    chosen = nodes[part == best]
    colour[chosen] = many + few - colour[chosen]
    return True

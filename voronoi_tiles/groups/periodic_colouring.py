"""A proper colouring of copies that repeat for ever, the same in every translate of some larger cell.

No two neighbours are alike. Who is whose neighbour is found by the caller: by distances, or from exact edges.
"""

from __future__ import annotations

import colorsys
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Ints

SQUARES = tuple(sorted(((m, n) for m in range(1, 5) for n in range(1, 5)), key=lambda p: (p[0] * p[1], p)))
"""The repeats that are tried, in cells along both vectors."""

ENOUGH = 4
"""Colours that need no larger period where a picture is to be told apart; what four do not suffice for takes more."""

_STEPS = 3_000
"""Most decisions of one search for a colouring; a count."""

SEARCHED = 500
"""Most copies in a period for which the fewest colours are searched; a count. Larger ones are coloured in one go."""


class Repeat(NamedTuple):
    """A lattice of translations: copies (i, j) and (k, l) are the same where rows (i - k, j - l)^T is 0 modulo m, n."""

    rows: tuple[tuple[int, int], tuple[int, int]]
    m: int
    n: int

    def place(self, i: Ints, j: Ints) -> tuple[Ints, Ints]:
        """The place of copies in the repeat."""
        (a, b), (c, d) = self.rows
        return (a * i + b * j) % self.m, (c * i + d * j) % self.n


@dataclass(frozen=True, eq=False)
class PeriodicColouring:
    """`colour` intp (placements, m, n): copy (placement, i, j) has the colour at its place in the repeat."""

    repeat: Repeat
    colour: Ints

    @property
    def count(self) -> int:
        """How many colours there are."""
        return int(self.colour.max()) + 1

    def of(self, copies: Ints) -> Ints:
        """The colours of copies, rows (placement, i, j)."""
        return np.asarray(self.colour[(copies[:, 0], *self.repeat.place(copies[:, 1], copies[:, 2]))])


def colour_pairs(pairs: Ints, placements: int, *, least: int, enough: int = ENOUGH) -> PeriodicColouring:
    """Colour copies so that no pair is alike.

    Pairs are rows (p, q, i, j): placement p beside placement q moved by i a + j b; `least` colours are needed in any
    case, as where so many copies meet. Of repeats of up to 4 x 4 cells the smallest is taken in which `enough` colours
    suffice, else the one with the fewest; where a tile meets its own translates in all of them, as long sites and
    narrow cells make it, a larger one.
    """
    best: PeriodicColouring | None = None
    for m, n in SQUARES:
        repeat = Repeat(((1, 0), (0, 1)), m, n)
        found = _colour_quotient(pairs, placements, repeat, least)
        if found is not None and (best is None or found.max() < best.colour.max()):
            best = PeriodicColouring(repeat, found)
        if best is not None and best.colour.max() < max(enough, least):
            break
    if best is None:
        repeat = _large_repeat(pairs)
        found = _colour_quotient(pairs, placements, repeat, least)
        assert found is not None
        best = PeriodicColouring(repeat, found)
    return best


def _large_repeat(pairs: Ints) -> Repeat:
    """The smallest cyclic repeat i + b j (or b i + j) modulo m in which no tile meets its own translate."""
    own = pairs[pairs[:, 0] == pairs[:, 1], 2:]
    for m in range(2, 2 * len(own) + 3):
        for number, swapped in enumerate((own, own[:, ::-1])):
            meets = (swapped[:, 0] + np.arange(m)[:, None] * swapped[:, 1]) % m == 0
            free = np.flatnonzero(~meets.any(axis=1))
            if len(free):
                b = int(free[0])
                return Repeat(((1, b) if number == 0 else (b, 1), (0, 0)), m, 1)
    # One copy of each in a box that is wider than any step: always right, if large.
    across, up = np.abs(own).max(axis=0).tolist()
    return Repeat(((1, 0), (0, 1)), across + 1, up + 1)


def _colour_quotient(pairs: Ints, placements: int, repeat: Repeat, least: int) -> Ints | None:
    """Colour the copies in a period that goes on for ever; None where a tile meets its own translate."""
    m, n = repeat.m, repeat.n
    count = placements * m * n
    if count > SEARCHED:
        here, there = _quotient_pairs(pairs, repeat)
        met = (here == there).any()
        return None if met else _colour_greedily(here, there, count).reshape(placements, m, n)
    beside = quotient_graph(pairs, placements, repeat)
    if beside is None:
        return None
    for colours in range(min(least, count), count + 1):
        found = colour_graph(beside, colours)
        if found is not None:
            return found.reshape(placements, m, n)
    return None


def quotient_graph(pairs: Ints, placements: int, repeat: Repeat) -> NDArray[np.bool_] | None:
    """Which of the copies in a repeat are beside each other, symmetric; None where a tile meets its own translate."""
    here, there = _quotient_pairs(pairs, repeat)
    if (here == there).any():
        return None
    count = placements * repeat.m * repeat.n
    beside = np.zeros((count, count), bool)
    beside[here, there] = beside[there, here] = True
    return beside


def _quotient_pairs(pairs: Ints, repeat: Repeat) -> tuple[Ints, Ints]:
    """The copies in a repeat that are beside each other, both of each pair."""
    m, n = repeat.m, repeat.n
    s, t = (part.ravel() for part in np.meshgrid(np.arange(m), np.arange(n), indexing="ij"))
    step_s, step_t = repeat.place(pairs[:, 2], pairs[:, 3])
    here = ((pairs[:, 0] * m + s[:, None]) * n + t[:, None]).ravel()
    there = ((pairs[:, 1] * m + (s[:, None] + step_s) % m) * n + (t[:, None] + step_t) % n).ravel()
    return here, there


def _colour_greedily(here: Ints, there: Ints, count: int) -> Ints:
    """The colour of each node: in turn, the first that none of its neighbours has."""
    order = np.argsort(np.concatenate((here, there)), kind="stable")
    other = np.concatenate((there, here))[order]
    start = np.searchsorted(np.concatenate((here, there))[order], np.arange(count + 1))
    colour = np.full(count, -1, np.intp)
    for node in range(count):
        taken = set(colour[other[start[node] : start[node + 1]]].tolist())
        colour[node] = next(c for c in range(count) if c not in taken)
    return colour


def colour_graph(beside: NDArray[np.bool_], colours: int) -> Ints | None:
    """Colour a graph with at most so many colours; None where there is no such colouring, or it takes too long.

    Depth first, the node with the fewest colours left next, of these the one with the most neighbours (Brelaz 1979).
    """
    count = len(beside)
    degree = beside.sum(axis=1)
    colour = np.full(count, -1, np.intp)
    blocked = np.zeros((count, colours), np.intp)  # how many coloured neighbours have each colour
    order: list[tuple[int, int]] = []
    steps = 0
    start = 0
    while len(order) < count:
        open_nodes = np.flatnonzero(colour < 0)
        taken = (blocked[open_nodes] > 0).sum(axis=1)
        node = int(open_nodes[np.lexsort((-degree[open_nodes], -taken))[0]])
        used = int(colour.max()) + 1
        free = [c for c in range(start, min(used + 1, colours)) if not blocked[node, c]]
        steps += 1
        if steps > _STEPS:
            return None
        if free:
            colour[node] = free[0]
            blocked[beside[node], free[0]] += 1
            order.append((node, free[0]))
            start = 0
            continue
        if not order:
            return None
        node, last = order.pop()
        colour[node] = -1
        blocked[beside[node], last] -= 1
        start = last + 1
    return colour


# Hue, saturation, value: told apart at a glance, next to each other in any order, and in print.
_PALETTE = (
    (0.55, 0.42, 0.86),
    (0.11, 0.38, 0.98),
    (0.02, 0.52, 0.90),
    (0.40, 0.32, 0.80),
    (0.76, 0.30, 0.86),
    (0.15, 0.62, 0.95),
    (0.63, 0.52, 0.66),
    (0.93, 0.30, 0.95),
)


def palette(count: int) -> NDArray[np.uint8]:
    """So many colours, different from each other: uint8 (count, 3), red, green, blue."""
    # By the golden ratio no two hues are alike, whatever their number.
    more = [(k * 0.6180339887 % 1.0, 0.35 + 0.15 * (k % 3), 0.75 + 0.2 * (k % 2)) for k in range(len(_PALETTE), count)]
    rows = [*_PALETTE[:count], *more]
    return np.array([[round(255 * part) for part in colorsys.hsv_to_rgb(*row)] for row in rows], np.uint8)

"""A proper colouring of all copies, the same in every translate of some larger cell: no two neighbours are alike."""

from __future__ import annotations

import colorsys
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.raster.candidates import find_candidates
from voronoi_tiles.raster.copies import Ints, Pattern, distances, gather
from voronoi_tiles.raster.frame import BLOCK, cell_frame

_SAMPLES = 64 * BLOCK
"""Samples along the cell in whose blocks neighbours are looked for."""

_PERIODS = tuple(sorted(((m, n) for m in range(1, 5) for n in range(1, 5)), key=lambda p: (p[0] * p[1], p)))
_ENOUGH = 4
"""Colours that are worth a larger period; what four colours do not suffice for takes more."""

_STEPS = 3_000
"""Most decisions of one search for a colouring; a count."""


@dataclass(frozen=True, eq=False)
class Colouring:
    """`colour` intp (placements, m, n): copy (placement, i, j) has the colour of i modulo m and j modulo n."""

    colour: Ints

    @property
    def count(self) -> int:
        """How many colours there are."""
        return int(self.colour.max()) + 1

    def of(self, copies: Ints) -> Ints:
        """The colours of copies, rows (placement, i, j)."""
        _, m, n = self.colour.shape
        return np.asarray(self.colour[copies[:, 0], copies[:, 1] % m, copies[:, 2] % n])


def colour(pattern: Pattern) -> Colouring:
    """Colour the tiles: those that share an edge, or nearly meet, differ.

    Of the larger cells with up to 4 x 4 cells the smallest is taken in which four colours suffice, or else the one with
    the fewest.
    """
    pairs, crowd = neighbours(pattern)
    best: Ints | None = None
    for period in _PERIODS:
        found = _colour_quotient(pairs, len(pattern.placements), period, crowd)
        if found is not None and (best is None or found.max() < best.max()):
            best = found
        if best is not None and best.max() < max(_ENOUGH, crowd):
            break
    assert best is not None  # 4 x 4 cells: a tile's neighbours are nearer than that, see `neighbours`
    return Colouring(best)


def neighbours(pattern: Pattern) -> tuple[Ints, int]:
    """All pairs of copies that may share an edge, and how many copies meet, all with all, in one place at most.

    Pairs are rows (p, q, i, j): placement p beside placement q moved by i a + j b.

    Two tiles meet in a point of some block of the image of a cell; at the block's centre both their distances are then
    within twice the block's radius of the smallest. So no pair is missed; a few pairs that almost meet are found as
    well.
    """
    frame = cell_frame(pattern.lattice, _SAMPLES)
    scene = gather(pattern, frame.origin, frame.middle, frame.radius)
    lists = find_candidates(scene, frame)
    of_block = np.repeat(np.arange(len(lists)), np.diff(lists.run_start))
    block = np.repeat(of_block, np.diff(lists.element_start))
    far = distances(lists.centre[block], scene.middle[lists.element], scene.half[lists.element])
    nearest = np.minimum.reduceat(far, lists.element_start[:-1])
    least = np.minimum.reduceat(nearest, lists.run_start[:-1])
    owning = np.flatnonzero(nearest <= least[of_block] + 2 * lists.radius)
    label, block = lists.run_label[owning], of_block[owning]
    crowd = int(np.bincount(block).max())
    found = []
    for step in range(1, len(owning)):
        together = np.flatnonzero(block[step:] == block[:-step])
        if not len(together):
            break
        found.append(np.unique(np.stack((label[together], label[together + step]), axis=1), axis=0))
    pairs = np.unique(np.concatenate(found), axis=0) if found else np.zeros((0, 2), np.intp)
    first, second = scene.copies[pairs[:, 0]], scene.copies[pairs[:, 1]]
    rows = np.concatenate((first[:, :1], second[:, :1], second[:, 1:] - first[:, 1:]), axis=1)
    return np.unique(rows, axis=0), crowd


def _colour_quotient(pairs: Ints, placements: int, period: tuple[int, int], least: int) -> Ints | None:
    """Colour the copies in m x n cells that go on periodically; None where a tile meets its own translate."""
    m, n = period
    cells = np.stack(np.meshgrid(np.arange(m), np.arange(n), indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = cells[:, 0, None], cells[:, 1, None]
    here = (pairs[:, 0] * m + i) * n + j
    there = (pairs[:, 1] * m + (i + pairs[:, 2]) % m) * n + (j + pairs[:, 3]) % n
    if (here == there).any():
        return None
    count = placements * m * n
    beside = np.zeros((count, count), bool)
    beside[here, there] = beside[there, here] = True
    for colours in range(min(least, count), count + 1):
        found = _colour_graph(beside, colours)
        if found is not None:
            return found.reshape(placements, m, n)
    return None


def _colour_graph(beside: NDArray[np.bool_], colours: int) -> Ints | None:
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

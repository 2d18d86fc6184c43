"""Which edges of one layer become which of another: those that face the same copies, in the same cyclic order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints
from voronoi_tiles.solid.layers import ExactLayer, Name


@dataclass(frozen=True, eq=False)
class Correspondence:
    """Use `low[k]` of one layer is use `high[k]` (both intp, n) of another; those that are left out are in neither."""

    low: Ints
    high: Ints

    @property
    def reversed(self) -> Correspondence:
        """The same, seen from the other layer."""
        return Correspondence(self.high, self.low)


def corresponding(low: ExactLayer, high: ExactLayer, short: tuple[Bools, Bools] | None = None) -> Correspondence | None:
    """The uses of two layers that correspond, None where their tiles' boundaries face others, or in another order.

    `short` says of the edges of both layers which are taken for points, and left out. Where sequences agree in several
    ways, as where a tile has few neighbours, corners that are nearest to each other correspond.
    """
    one, two = [], []
    for below, above in zip(_tiles(low, short and short[0]), _tiles(high, short and short[1]), strict=True):
        if len(below) != len(above):
            return None
        free = list(above)
        for ring in below:
            best = min(
                ((gap, k, turn) for k, other in enumerate(free) for gap, turn in _turns(low, ring, high, other)),
                default=None,
            )
            if best is None:
                return None
            other = free.pop(best[1])
            one += ring
            two += other[best[2] :] + other[: best[2]]
    return Correspondence(np.array(one, np.intp), np.array(two, np.intp))


def _tiles(layer: ExactLayer, short: Bools | None) -> Iterator[list[list[int]]]:
    """For each tile its rings, as the numbers of the uses that are left."""
    gone = None if short is None else short[layer.edge].tolist()
    bounds, tiles = layer.ring_offsets.tolist(), layer.tile_offsets.tolist()
    for first, last in pairwise(tiles):
        yield [
            [use for use in range(bounds[ring], bounds[ring + 1]) if gone is None or not gone[use]]
            for ring in range(first, last)
        ]


def _turns(low: ExactLayer, ring: list[int], high: ExactLayer, other: list[int]) -> Iterator[tuple[float, int]]:
    """By how many uses a ring can be turned to face what another faces, each with how far corners are then apart."""
    if len(ring) != len(other):
        return
    wanted: list[Name] = [low.names[use] for use in ring]
    names: list[Name] = [high.names[use] for use in other]
    if not wanted:
        yield 0.0, 0
        return
    for turn, name in enumerate(names):
        if name == wanted[0] and names[turn:] + names[:turn] == wanted:
            gap = 0.0
            if names.count(name) > 1:
                there = high.starts[other[turn:] + other[:turn]]
                gap = float(np.abs(low.starts[ring] - there).sum())
            yield gap, turn

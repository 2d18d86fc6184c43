"""Colours of tiles: as few as their edges allow, so that no two that share one are alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.fabrication.layout import FRAME, PlacedTiles
from voronoi_tiles.groups.periodic_colouring import PeriodicColouring, colour_pairs
from voronoi_tiles.vector.complex.period import Period


@dataclass(frozen=True, eq=False)
class TileColouring:
    """A colouring of the tiles on a page, the same for every piece of a tile."""

    repeating: PeriodicColouring
    copies: PlacedTiles

    @property
    def count(self) -> int:
        """How many colours the whole tessellation takes."""
        return self.repeating.count

    def of_copies(self, copies: Ints) -> Ints:
        """The colours of tiles on the page, by their index; FRAME for the frame."""
        inside = copies >= 0
        known = np.where(inside, copies, 0)
        rows = np.column_stack((self.copies.tile[known], self.copies.step[known]))
        return np.where(inside, self.repeating.of(rows), FRAME)


def colour_period(period: Period) -> PeriodicColouring:
    """Colour the tiles of a period, and all their translates: those that share an edge differ.

    The colours are the fewest that repeat within four by four cells.
    """
    pairs = neighbour_pairs(period)
    # Two tiles that share an edge with each other and with a third need three colours.
    here = {(p, q, i, j) for p, q, i, j in pairs.tolist()} | {(q, p, -i, -j) for p, q, i, j in pairs.tolist()}
    beside: dict[int, list[tuple[int, int, int]]] = {}
    for p, q, i, j in here:
        beside.setdefault(p, []).append((q, i, j))
    triangle = any((q, r, k - i, m - j) in here for p in beside for q, i, j in beside[p] for r, k, m in beside[p])
    least = 3 if triangle else 2
    return colour_pairs(pairs, len(period.site), least=least, enough=least)


def neighbour_pairs(period: Period) -> Ints:
    """The pairs of tiles that share an edge: rows (p, q, i, j), tile p beside tile q moved by a lattice vector."""
    everything = np.arange(len(period.site))
    tile, edge, step, forward = period.borders(everything, np.zeros((len(everything), 2), np.intp))
    left, right = np.flatnonzero(forward), np.flatnonzero(~forward)
    left, right = left[np.argsort(edge[left])], right[np.argsort(edge[right])]
    rows = np.column_stack((tile[left], tile[right], step[left] - step[right]))
    return np.asarray(np.unique(rows, axis=0), np.intp)

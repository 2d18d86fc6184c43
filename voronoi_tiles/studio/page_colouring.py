"""Colours of the page's copies: no two that share an edge are alike, and they stay as they are while they can."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.fabrication.tile_colouring import colour_tiles, neighbour_pairs
from voronoi_tiles.groups.periodic_colouring import PeriodicColouring
from voronoi_tiles.vector.copies import translation
from voronoi_tiles.vector.motions import Motion, compose, modulo_lattice, to_motion
from voronoi_tiles.vector.tessellation import Tessellation


class Colourist:
    """Colours one tessellation after the other, and a new one as the `last` where that will do."""

    def __init__(self) -> None:
        self._tiles: object = None
        self.last: PeriodicColouring | None = None

    def colour(self, tessellation: Tessellation, operations: Sequence[Sequence[int]]) -> dict[str, Any]:
        """The colours of all copies, by the `operations` that take each site to its copies in a cell.

        Placement k is a site under one of its operations, site by site; its copy that is moved by i a + j b has the
        colour at [k][(p i + q j) % m][(r i + s j) % n] of "colour", where "rows" are [[p, q], [r, s]].
        """
        period = tessellation.period
        tiles = tessellation.action.group.name, tuple(zip(period.site.tolist(), period.motion, strict=True))
        if self.last is None or tiles != self._tiles or not is_proper(self.last, neighbour_pairs(period)):
            self._tiles, self.last = tiles, colour_tiles(tessellation, "fewest")
        return document(self.last, tessellation, operations)


def is_proper(colouring: PeriodicColouring, pairs: Ints) -> bool:
    """Whether no two tiles are alike that share an edge: pairs are rows (p, q, i, j)."""
    m, n = colouring.repeat.m, colouring.repeat.n
    (a, b), (c, d) = colouring.repeat.rows
    for p, q, i, j in pairs.tolist():
        beside = np.roll(colouring.colour[q], (-(a * i + b * j) % m, -(c * i + d * j) % n), axis=(0, 1))
        if (colouring.colour[p] == beside).any():
            return False
    return True


def document(
    colouring: PeriodicColouring, tessellation: Tessellation, operations: Sequence[Sequence[int]]
) -> dict[str, Any]:
    """A colouring by the page's placements, in the types of JSON."""
    period, group = tessellation.period, tessellation.action.group
    (a, b), (c, d) = colouring.repeat.rows
    at = {
        (site, modulo_lattice(motion)): (tile, motion)
        for tile, (site, motion) in enumerate(zip(period.site.tolist(), period.motion, strict=True))
    }
    tables = []
    for site, of in enumerate(operations):
        placed = tessellation.placed[site]
        for number in of:
            # The page moves sites as they are drawn, the period as they are placed near the origin.
            motion = placed.canonical(compose(to_motion(group.operations[number]), translation(placed, 1)))
            tile, stands = at[site, modulo_lattice(motion)]
            i, j = _step(motion, stands)
            tables.append(np.roll(colouring.colour[tile], (-(a * i + b * j), -(c * i + d * j)), axis=(0, 1)).tolist())
    return {
        "count": colouring.count,
        "rows": [[a, b], [c, d]],
        "m": colouring.repeat.m,
        "n": colouring.repeat.n,
        "colour": tables,
    }


def _step(motion: Motion, stands: Motion) -> tuple[int, int]:
    """The lattice vector from one motion to another that is the same but for it."""
    return (motion[4] - stands[4]) // 2, (motion[5] - stands[5]) // 2

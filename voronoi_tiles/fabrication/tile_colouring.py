"""Colours of tiles: so that no two that share an edge are alike, or by what the tiles are."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.layout import FRAME, PlacedTiles
from voronoi_tiles.groups.balanced_colouring import balance_colours
from voronoi_tiles.groups.periodic_colouring import PeriodicColouring, Repeat, colour_pairs
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.motions import Motion, compose, reverses_orientation
from voronoi_tiles.vector.tessellation import Tessellation

_ONE_CELL: Final = Repeat(((1, 0), (0, 1)), 1, 1)
"""What repeats in every cell."""


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


def colour_tiles(tessellation: Tessellation, scheme: str | int, period: Period | None = None) -> PeriodicColouring:
    """Colour the tiles of a period, and all their translates, by a scheme; `period` is another than its own.

    - "fewest": tiles that share an edge differ, by the fewest colours that repeat within four by four cells;
    - a number: so do they by so many colours, each on as many tiles as any other, as far as that can be;
    - "site": each site has a colour;
    - "handedness": tiles that are turned over have another colour than those as drawn. A tile that is its own mirror
      image is not turned over;
    - "none": all are alike;
    - "orientation": tiles that are turned differently, or turned over, have different colours.

    Raises JobError for a number of colours that is too small, or too large.
    """
    period = tessellation.period if period is None else period
    match scheme:
        case "fewest" | int():
            pairs = neighbour_pairs(period)
            fewest = _fewest(tuple(map(tuple, pairs.tolist())), len(period.site))
            return fewest if isinstance(scheme, str) else _so_many(pairs, fewest, scheme)
        case "none":
            kinds = [0] * len(period.site)
        case "site":
            kinds = period.site.tolist()
        case "handedness":
            kinds = [min(map(reverses_orientation, motions)) for motions in _motions(tessellation, period)]
        case _:
            linear = list(dict.fromkeys(motion[:4] for motion in tessellation.action.motions))
            kinds = [min(linear.index(motion[:4]) for motion in motions) for motions in _motions(tessellation, period)]
    colour = np.unique(kinds, return_inverse=True)[1]
    return PeriodicColouring(_ONE_CELL, np.asarray(colour, np.intp).reshape(-1, 1, 1))


def _motions(tessellation: Tessellation, period: Period) -> list[list[Motion]]:
    """All motions that take a site there, for each tile of a period: more than one for a symmetric site."""
    stabilizers = [tessellation.placed[site].stabilizer for site in period.site.tolist()]
    return [
        [compose(motion, own) for own in stabilizer]
        for motion, stabilizer in zip(period.motion, stabilizers, strict=True)
    ]


def _so_many(pairs: Ints, fewest: PeriodicColouring, colours: int) -> PeriodicColouring:
    """A balanced colouring with so many colours. Raises JobError."""
    found = None if colours < fewest.count else balance_colours(pairs, fewest, colours)
    if found is None:
        few = colours < fewest.count
        raise JobError(
            f"with `colours={colours}` "
            + ("neighbours would be alike" if few else "some would be on no tile: the pattern does not repeat so late"),
            remedy=f"Give {fewest.count} {'or more' if few else 'or a few more'}, "
            "or colour by site, handedness or orientation.",
        )
    return found


@lru_cache(maxsize=8)
def _fewest(pairs: tuple[tuple[int, ...], ...], tiles: int) -> PeriodicColouring:
    """The colouring with the fewest colours that repeat within four by four cells.

    The last ones are kept: neighbours mostly stay neighbours when a design is changed a little. Pairs are rows
    (p, q, i, j).
    """
    # Two tiles that share an edge with each other and with a third need three colours.
    here = {(p, q, i, j) for p, q, i, j in pairs} | {(q, p, -i, -j) for p, q, i, j in pairs}
    beside: dict[int, list[tuple[int, int, int]]] = {}
    for p, q, i, j in here:
        beside.setdefault(p, []).append((q, i, j))
    triangle = any((q, r, k - i, m - j) in here for p in beside for q, i, j in beside[p] for r, k, m in beside[p])
    least = 3 if triangle else 2
    found = colour_pairs(np.array(pairs, np.intp).reshape(-1, 4), tiles, least=least, enough=least)
    found.colour.setflags(write=False)
    return found


def neighbour_pairs(period: Period) -> Ints:
    """The pairs of tiles that share an edge: rows (p, q, i, j), tile p beside tile q moved by a lattice vector."""
    everything = np.arange(len(period.site))
    tile, edge, step, forward = period.borders(everything, np.zeros((len(everything), 2), np.intp))
    left, right = np.flatnonzero(forward), np.flatnonzero(~forward)
    left, right = left[np.argsort(edge[left])], right[np.argsort(edge[right])]
    rows = np.column_stack((tile[left], tile[right], step[left] - step[right]))
    return np.asarray(np.unique(rows, axis=0), np.intp)

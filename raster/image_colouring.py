"""A proper colouring of all copies; neighbours are those whose tiles share an edge, or nearly meet, by distances."""

from __future__ import annotations

import math

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.groups.periodic_colouring import PeriodicColouring, colour_pairs
from voronoi_tiles.raster.block_lists import find_candidates
from voronoi_tiles.raster.frame import BLOCK, cell_frame
from voronoi_tiles.raster.scene import Pattern, gather

_SAMPLES = 64 * BLOCK
"""Samples along the cell in whose blocks neighbours are looked for."""

_TABLE = 1 << 26
"""Most pairs that can be, of which a table is made; a count, a byte each."""


def colour(pattern: Pattern) -> PeriodicColouring:
    """Colour the tiles: those that share an edge, or nearly meet, differ."""
    pairs, crowd = neighbours(pattern)
    return colour_pairs(pairs, len(pattern.placements), least=crowd)


def neighbours(pattern: Pattern) -> tuple[Ints, int]:
    """All pairs of copies that may share an edge, and how many copies meet, all with all, in one place at most.

    Pairs are rows (p, q, i, j): placement p beside placement q moved by i a + j b.

    Two tiles meet in a point of some block of the image of a cell; at the block's centre both their distances are then
    within twice the block's radius of the smallest. So no pair is missed; a few pairs that almost meet are found as
    well.
    """
    frame = cell_frame(pattern.lattice, _SAMPLES)
    scene = gather(pattern, frame.origin, frame.middle, frame.radius)
    lists = find_candidates(scene, frame, spare=math.inf)
    nearest = np.minimum.reduceat(lists.from_centres(), lists.element_start[:-1])
    least = np.minimum.reduceat(nearest, lists.run_start[:-1])
    owning = np.flatnonzero(nearest <= least[lists.run_block] + 2 * lists.radius)
    block = lists.run_block[owning]
    crowd = int(np.bincount(block).max())
    return _pairs_in_blocks(scene.copies[lists.run_label[owning]], block, pattern), crowd


def _pairs_in_blocks(copies: Ints, block: Ints, pattern: Pattern) -> Ints:
    """The different pairs of copies that are in one block, rows as of `neighbours`, sorted; blocks ascend.

    A block of a narrow cell holds hundreds of copies, all of them translates: so the pairs are marked in a table of
    those that can be, and nothing is sorted until they are few.
    """
    count = len(pattern.placements)
    placement = copies[:, 0]
    # In the reduced basis, where what is near has near coordinates: the table is as small as can be.
    steps = copies[:, 1:] @ np.round(np.linalg.inv(pattern.basis)).astype(np.intp)
    # Of each placement from its own least: images of a site far from the origin are as far from each other.
    least = np.full((count, 2), np.iinfo(np.intp).max)
    np.minimum.at(least, placement, steps)
    x, y = (steps - least[placement]).T
    width = 2 * int(y.max()) + 1
    place = x * width + y  # the differences of two tell (x, y) apart
    most = int(place.max())
    size = 2 * most + 1
    first = placement * (count * size) - place + most
    second = placement * size + place
    table = np.zeros(count * count * size, bool) if count * count * size <= _TABLE else None
    found = [np.zeros(0, np.intp)]
    for step in range(1, len(block)):
        together = block[step:] == block[:-step]
        if not together.any():
            break
        pairs = first[:-step][together] + second[step:][together]
        if table is None:
            found.append(np.unique(pairs))
        else:
            table[pairs] = True
    number, moved = np.divmod(np.unique(np.concatenate(found)) if table is None else np.flatnonzero(table), size)
    moved -= most
    x = (moved + width // 2) // width
    one, other = np.divmod(number, count)
    between = (np.stack((x, moved - x * width), axis=1) + least[other] - least[one]) @ pattern.basis
    return np.unique(np.column_stack((one, other, between)), axis=0)

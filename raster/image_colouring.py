"""A proper colouring of all copies; neighbours are those whose tiles share an edge, or nearly meet, by distances."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.groups.periodic_colouring import PeriodicColouring, colour_pairs
from voronoi_tiles.raster.block_lists import find_candidates
from voronoi_tiles.raster.frame import BLOCK, cell_frame
from voronoi_tiles.raster.scene import Pattern, gather

_SAMPLES = 64 * BLOCK
"""Samples along the cell in whose blocks neighbours are looked for."""


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
    lists = find_candidates(scene, frame)
    nearest = np.minimum.reduceat(lists.from_centres(), lists.element_start[:-1])
    least = np.minimum.reduceat(nearest, lists.run_start[:-1])
    owning = np.flatnonzero(nearest <= least[lists.run_block] + 2 * lists.radius)
    label, block = lists.run_label[owning], lists.run_block[owning]
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

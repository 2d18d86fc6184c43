"""Which elements can matter in each block of an image: exact candidate lists, by a quadtree.

At a block's centre let D_X be the distance of copy X and m2 the second smallest of them. Distances are 1-Lipschitz, and
so is the second smallest: within a disc of radius r about the centre c, copy X can be nearest, or nearest of another
copy than the nearest, only if D_X <= m2 + 2r. Of its elements those can be left out that are everywhere in the disc
farther than the one, e, that is nearest at c. The distance of an element is a convex function of the point, so it is
at least d + g.(p - c) with its gradient g at c; and e is at most as far as its foot, |p - foot|, which is at most
D + G.(p - c) + r^2 / 2D. So an element can be left out where d - D > |g - G| r + r^2 / 2D, and also where d - D > 2r.
A block's list is a subset of the list of the block that it is a quarter of.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, offsets_of, owned_ranges, starts
from voronoi_tiles.raster.frame import BLOCK, Frame
from voronoi_tiles.raster.scene import Scene, distances, from_feet, lengths

_SLACK = 1.0 + 1e-9
"""Keeps what rounding would drop: relative to the bounds, far above float64 and far below what costs time."""


@dataclass(frozen=True, eq=False)
class BlockLists:
    """The elements that can matter in each block, in runs of one copy each.

    Blocks number row by row, `columns` to a row; block b covers BLOCK x BLOCK samples, and the lists hold in the disc
    of radius `radius` about `centre[b]` (from the scene's origin), which covers the next column and row as well.
    Its runs are those from `run_start[b]` up to run_start[b + 1]; run k is copy `run_label[k]`, elements
    `element[element_start[k]:element_start[k + 1]]` of the scene. Every block has at least two runs.
    """

    scene: Scene
    columns: int
    radius: float
    centre: Complexes
    run_start: Ints
    run_label: NDArray[np.int32]
    element_start: Ints
    element: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.centre)

    @cached_property
    def run_block(self) -> Ints:
        """The block of each run."""
        return np.repeat(np.arange(len(self)), np.diff(self.run_start))

    @cached_property
    def element_block(self) -> Ints:
        """The block of each entry of `element`."""
        return np.repeat(self.run_block, np.diff(self.element_start))

    def from_centres(self) -> Floats:
        """The distance of each entry of `element` from its block's centre."""
        scene = self.scene
        return distances(self.centre[self.element_block], scene.middle[self.element], scene.half[self.element])


def find_candidates(scene: Scene, frame: Frame, *, looseness: float = 0.0) -> BlockLists:
    """The candidate lists of a frame's blocks; the scene must hold all that may be nearest in the frame.

    With `looseness` e the lists hold for any distance functions that are within a factor of 1 +- e of the true ones.
    """
    across, down = -(-frame.width // BLOCK), -(-frame.height // BLOCK)
    level = 0
    while (-(-across >> level) * -(-down >> level)) > _ROOTS and level < 30:
        level += 1
    columns, rows = -(-across // 2**level), -(-down // 2**level)
    number = np.arange(columns * rows)
    loose = _SLACK + 4.0 * looseness
    lists = _roots(scene, frame, number % columns, number // columns, level, loose)
    while level:
        level -= 1
        lists = _children(scene, frame, lists, level, across, down, loose)
    order = np.lexsort((lists.column, lists.row))
    return _in_order(scene, lists, order, across, _radius(frame, 0))


_ROOTS = 16
"""Blocks that the quadtree starts with, at most; a count."""


@dataclass(frozen=True, eq=False)
class _Lists:
    """Blocks of one level with their lists: `element` in segments from `start` on (one more than blocks)."""

    column: Ints
    row: Ints
    centre: Complexes
    start: Ints
    element: NDArray[np.int32]


def _radius(frame: Frame, level: int) -> float:
    """The half diagonal of a block, whose far sides are the samples where the next block begins."""
    return frame.half_diagonal(BLOCK * 2**level)


def _centres(frame: Frame, column: Ints, row: Ints, level: int) -> Complexes:
    side = BLOCK * 2**level
    return frame.offsets((column + 0.5) * side, (row + 0.5) * side)


def _roots(scene: Scene, frame: Frame, column: Ints, row: Ints, level: int, loose: float) -> _Lists:
    """The lists of the first blocks, from all elements, block by block."""
    centre = _centres(frame, column, row, level)
    radius = _radius(frame, level)
    everything = np.arange(len(scene), dtype=np.int32)
    kept = [
        everything[_keep(scene.label, from_feet(z, scene.middle, scene.half), np.zeros(1, np.intp), radius, loose)]
        for z in centre.tolist()
    ]
    start = offsets_of([len(part) for part in kept])
    return _Lists(column, row, centre, start, np.concatenate(kept))


def _children(scene: Scene, frame: Frame, parents: _Lists, level: int, across: int, down: int, loose: float) -> _Lists:
    """The lists of the quarters of blocks, as far as these lie in the image of across x down blocks."""
    shape = (len(parents.column), 2, 2)
    column = np.broadcast_to(2 * parents.column[:, None, None] + np.array([0, 1]), shape).ravel()
    row = np.broadcast_to(2 * parents.row[:, None, None] + np.array([[0], [1]]), shape).ravel()
    parent = np.repeat(np.arange(len(parents.column)), 4)
    side = 2**level
    inside = (column * side < across) & (row * side < down)
    column, row, parent = column[inside], row[inside], parent[inside]
    centre = _centres(frame, column, row, level)
    radius = _radius(frame, level)
    size = np.diff(parents.start)[parent]
    # In portions, so that the work arrays do not fill the memory.
    bounds = np.searchsorted(np.cumsum(size), np.arange(_PORTION, int(size.sum()) + _PORTION, _PORTION))
    elements, counts = [], []
    for first, last in zip(np.append(0, bounds), np.append(bounds, len(parent)), strict=True):
        if first == last:
            continue
        n = size[first:last]
        start = np.cumsum(n) - n
        index, _ = owned_ranges(parents.start[parent[first:last]], parents.start[parent[first:last]] + n)
        element = parents.element[index]
        away = from_feet(np.repeat(centre[first:last], n), scene.middle[element], scene.half[element])
        keep = _keep(scene.label[element], away, start, radius, loose)
        elements.append(element[keep])
        counts.append(np.add.reduceat(keep, start, dtype=np.intp))
    return _Lists(column, row, centre, offsets_of(np.concatenate(counts)), np.concatenate(elements))


_PORTION = 2_000_000
"""Pairs of blocks and elements that are handled at once; a count."""


def _keep(label: NDArray[np.int32], away: Complexes, start: Ints, radius: float, loose: float) -> NDArray[np.bool_]:
    """Which elements of each block's list can matter within `radius` of the block's centre.

    `away` (n,) leads from each element's nearest point to the centre, `start` says where a block's list begins.
    """
    distance = lengths(away)
    fresh = np.empty(len(label), bool)
    fresh[0] = True
    np.not_equal(label[1:], label[:-1], out=fresh[1:])
    fresh[start] = True
    run_start = np.flatnonzero(fresh)
    size = np.diff(run_start, append=len(label))
    nearest = np.minimum.reduceat(distance, run_start)
    second = _second_smallest(nearest, start, run_start)
    limit = np.where(nearest <= (second + 2 * radius) * loose, 2 * radius, -np.inf)
    # Of each copy, what is farther everywhere than the element that is nearest at the centre.
    winner = _first_of_each(np.flatnonzero(distance == np.repeat(nearest, size)), run_start)
    gradient = away / np.where(distance > 0.0, distance, 1.0)
    with np.errstate(divide="ignore"):
        bend = radius * radius / (2.0 * nearest)
    turn = lengths(gradient - np.repeat(gradient[winner], size)) * radius
    excess = distance - np.repeat(nearest, size)
    slack = (loose - 1.0) * (distance + radius)
    return np.asarray(excess <= np.minimum(np.repeat(limit, size), turn + np.repeat(bend, size)) + slack)


def _second_smallest(nearest: Floats, start: Ints, run_start: Ints) -> Floats:
    """For each run the second smallest of the runs' distances in its block."""
    block_runs = np.searchsorted(run_start, start)
    size = np.diff(block_runs, append=len(run_start))
    smallest = np.repeat(np.minimum.reduceat(nearest, block_runs), size)
    # The smallest of what is left when one of the smallest is taken away.
    rest = nearest.copy()
    rest[_first_of_each(np.flatnonzero(nearest == smallest), block_runs)] = np.inf
    return np.asarray(np.repeat(np.minimum.reduceat(rest, block_runs), size))


def _first_of_each(index: Ints, start: Ints) -> Ints:
    """Of ascending indices the first in each of the segments that begin at `start`."""
    return np.asarray(index[starts(np.searchsorted(start, index, side="right"))])


def _in_order(scene: Scene, lists: _Lists, order: Ints, columns: int, radius: float) -> BlockLists:
    """The finished lists, block after block, in runs."""
    n = np.diff(lists.start)[order]
    start = np.cumsum(n) - n
    element = lists.element[owned_ranges(lists.start[order], lists.start[order] + n)[0]]
    label = scene.label[element]
    fresh = np.append(True, label[1:] != label[:-1])
    fresh[start] = True
    first = np.flatnonzero(fresh)
    return BlockLists(
        scene,
        columns,
        radius,
        lists.centre[order],
        np.append(np.searchsorted(first, start), len(first)),
        label[first],
        np.append(first, len(element)),
        element,
    )

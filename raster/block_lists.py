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
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, offsets_of, owned_ranges, starts
from voronoi_tiles.base.kernels import COMPLEXES, FLOAT, FLOATS, INT, INTS, LABELS, kernel
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
    loose = _SLACK + 4.0 * looseness
    grid = _grid(frame, level)
    lists = _kept(scene, _near(scene, grid, loose), np.arange(len(grid.centre)), grid, loose)
    while level:
        level -= 1
        finer = _grid(frame, level)
        lists = _kept(scene, lists, (finer.row // 2) * grid.columns + finer.column // 2, finer, loose)
        grid = finer
    return _in_runs(scene, lists, grid)


_ROOTS = 16
"""Blocks that the quadtree starts with, at most; a count."""


class _BlockGrid(NamedTuple):
    """The blocks of one level, row by row: their columns and rows, centres, and the half diagonal of one."""

    columns: int
    column: Ints
    row: Ints
    centre: Complexes
    radius: float


def _grid(frame: Frame, level: int) -> _BlockGrid:
    """The blocks that cover a frame, of BLOCK 2^level samples a side."""
    side = BLOCK * 2**level
    columns, rows = -(-frame.width // side), -(-frame.height // side)
    row, column = np.divmod(np.arange(columns * rows), columns)
    centre = frame.offsets((column + 0.5) * side, (row + 0.5) * side)
    # The far sides of a block are the samples where the next one begins.
    return _BlockGrid(columns, column, row, centre, frame.half_diagonal(side))


class _Lists(NamedTuple):
    """The lists of the blocks of one level: that of block b is element[start[b]:start[b + 1]], ascending."""

    start: Ints
    element: NDArray[np.int32]


def _near(scene: Scene, grid: _BlockGrid, loose: float) -> _Lists:
    """All elements of the copies that can matter in each block, judged by circles about copies."""
    first = scene.copy_start
    x, y = scene.middle.real, scene.middle.imag
    low = np.minimum.reduceat(x, first) + 1j * np.minimum.reduceat(y, first)
    high = np.maximum.reduceat(x, first) + 1j * np.maximum.reduceat(y, first)
    centre = (low + high) / 2
    last = np.append(first[1:], len(scene))
    away = lengths(scene.middle - np.repeat(centre, last - first)) + scene.length
    radius = np.maximum.reduceat(away, first)
    parts = []
    for z in grid.centre.tolist():
        distance = lengths(z - centre)
        second = np.partition(distance + radius, 1)[1]
        near = distance - radius <= (second + 2 * grid.radius) * loose * _SLACK
        parts.append(owned_ranges(first[near], last[near])[0].astype(np.int32))
    return _Lists(offsets_of([len(part) for part in parts]), np.concatenate(parts))


def _kept(scene: Scene, parents: _Lists, parent: Ints, grid: _BlockGrid, loose: float) -> _Lists:
    """The lists of the blocks of a level, made of those of their parents."""
    first, last = parents.start[parent], parents.start[parent + 1]
    ends = np.cumsum(last - first)
    # In portions, so that the work arrays do not fill the memory.
    bounds = np.searchsorted(ends, np.arange(_PORTION, int(ends[-1]) + _PORTION, _PORTION))
    elements, counts = [], []
    for i, j in zip(np.append(0, bounds), np.append(bounds, len(parent)), strict=True):
        if i < j:
            element, count = _kept_portion(
                scene, parents.element, first[i:j], last[i:j], grid.centre[i:j], grid.radius, loose
            )
            elements.append(element)
            counts.append(count)
    element = elements[0] if len(elements) == 1 else np.concatenate(elements)
    return _Lists(offsets_of(np.concatenate(counts)), element)


_PORTION = 2_000_000
"""Pairs of blocks and elements that are handled at once; a count."""


def _kept_portion(
    scene: Scene,
    element: NDArray[np.int32],
    first: Ints,
    last: Ints,
    centre: Complexes,
    radius: float,
    loose: float,
) -> tuple[NDArray[np.int32], Ints]:
    """Of the elements from first[b] up to last[b], what can matter near centre[b]: all of them, and how many of each b.

    By the compiled kernel where there is one; otherwise by `_keep`, with the same result.
    """
    size = last - first
    keep = kernel("raster_keep", *_BLOCKS, *_ELEMENTS, *_WORK, *_KEPT)
    if keep is not None:
        blocks = len(size), first, last, centre, radius, loose
        elements = element, scene.label, scene.middle, scene.half
        longest = int(size.max())
        work = np.empty(4 * longest), np.empty(longest, np.int64)
        kept, count = np.empty(int(size.sum()), np.int32), np.empty(len(size), np.int64)
        total = keep(*blocks, *elements, *work, kept, count)
        return kept[:total], count
    start = np.cumsum(size) - size
    element = element[owned_ranges(first, last)[0]]
    away = from_feet(np.repeat(centre, size), scene.middle[element], scene.half[element])
    chosen = _keep(scene.label[element], away, start, radius, loose)
    return element[chosen], np.add.reduceat(chosen, start, dtype=np.intp)


# The arguments of raster_keep in block_lists.c.
_BLOCKS = INT, INTS, INTS, COMPLEXES, FLOAT, FLOAT
_ELEMENTS = LABELS, LABELS, COMPLEXES, COMPLEXES
_WORK = FLOATS, INTS
_KEPT = LABELS, INTS


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
    gradient = away[winner] * (1.0 / np.where(nearest > 0.0, nearest, 1.0))
    with np.errstate(divide="ignore"):
        bend = radius * radius / (2.0 * nearest)
    excess = distance - np.repeat(nearest, size)
    slack = (loose - 1.0) * (distance + radius)
    # Squared, and times the distance: |g - G| r >= d - D - r^2 / 2D, where the right side is positive.
    turn = away - np.repeat(gradient, size) * distance
    beyond = np.maximum(excess - np.repeat(bend, size) - slack, 0.0) * distance
    turned = (turn.real * turn.real + turn.imag * turn.imag) * (radius * radius) - beyond * beyond
    return np.asarray((excess - slack <= np.repeat(limit, size)) & (turned >= 0.0))


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


def _in_runs(scene: Scene, lists: _Lists, grid: _BlockGrid) -> BlockLists:
    """The finished lists, in runs."""
    start = lists.start[:-1]
    label = scene.label[lists.element]
    fresh = np.append(True, label[1:] != label[:-1])
    fresh[start] = True
    first = np.flatnonzero(fresh)
    run_start = np.append(np.searchsorted(first, start), len(first))
    element_start = np.append(first, len(label))
    return BlockLists(
        scene, grid.columns, grid.radius, grid.centre, run_start, label[first], element_start, lists.element
    )

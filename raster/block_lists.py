"""Which elements can matter in each block of an image: exact candidate lists, by a quadtree.

At a block's centre let D_X be the distance of copy X and m2 the second smallest of them. Distances are 1-Lipschitz, and
so is the second smallest: within a disc of radius r about the centre c, copy X can be nearest, or nearest of another
copy than the nearest, only if D_X <= m2 + 2r. Of its elements those can be left out that are everywhere in the disc
farther than the one, e, that is nearest at c. The distance of an element is a convex function of the point, so it is
at least d + g.(p - c) with its gradient g at c; and e is at most as far as its foot, |p - foot|, which is at most
D + G.(p - c) + r^2 / 2D. So an element can be left out where d - D > |g - G| r + r^2 / 2D, and also where d - D > 2r.
Of a third copy also those can be left out that are everywhere farther than both those elements of other copies that
are nearest at c: far from a row of copies that lie close to each other, that leaves a few of hundreds. A block's list
is a subset of the list of the block that it is a quarter of.
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
from voronoi_tiles.raster.scene import Scene, distances, lengths

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


_SPARE = 1e-3
"""By how much an element of a third copy is farther where it is left out, for those who ask whether one is just as far
but for rounding: in radii of a block, far more than rounding and far less than what costs time."""


def find_candidates(scene: Scene, frame: Frame, *, looseness: float = 0.0, spare: float = _SPARE) -> BlockLists:
    """The candidate lists of a frame's blocks; the scene must hold all that may be nearest in the frame.

    With `looseness` e the lists hold for any distance functions that are within a factor of 1 +- e of the true ones.
    What is no farther than the two nearest copies plus `spare` radii of a block, somewhere in a block's disc, is in its
    list; with inf all copies that are at its centre within two radii of the second nearest.
    """
    margins = _Margins(_SLACK + 4.0 * looseness, spare)
    across, down = -(-frame.width // BLOCK), -(-frame.height // BLOCK)
    level = 0
    while (-(-across >> level) * -(-down >> level)) > _ROOTS and level < 30:
        level += 1
    grid = _grid(frame, level)
    lists = _kept(scene, _near(scene, grid, margins.loose), np.arange(len(grid.centre)), grid, margins)
    while level:
        level -= 1
        finer = _grid(frame, level)
        lists = _kept(scene, lists, (finer.row // 2) * grid.columns + finer.column // 2, finer, margins)
        grid = finer
    element_start = np.append(lists.first, len(lists.element))
    return BlockLists(
        scene, grid.columns, grid.radius, grid.centre, lists.run_start, lists.label, element_start, lists.element
    )


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


class _Margins(NamedTuple):
    """What keeps more than must be: a factor of distances, and radii of the block for third copies."""

    loose: float
    spare: float


class _Lists(NamedTuple):
    """The lists of the blocks of one level, in runs of one copy each.

    The runs of block b are those from run_start[b] up to run_start[b + 1], with ascending labels; run k is copy
    `label[k]`, elements `element[first[k]:last[k]]` of the scene, ascending.
    """

    run_start: Ints
    label: NDArray[np.int32]
    first: Ints
    last: Ints
    element: NDArray[np.int32]


def _near(scene: Scene, grid: _BlockGrid, loose: float) -> _Lists:
    """All elements of the copies that can matter in each block, judged by circles about copies."""
    first = scene.copy_start
    last = np.append(first[1:], len(scene))
    x, y = scene.middle.real, scene.middle.imag
    low = np.minimum.reduceat(x, first) + 1j * np.minimum.reduceat(y, first)
    high = np.maximum.reduceat(x, first) + 1j * np.maximum.reduceat(y, first)
    centre = (low + high) / 2
    away = lengths(scene.middle - np.repeat(centre, last - first)) + scene.length
    radius = np.maximum.reduceat(away, first)
    copies = []
    for z in grid.centre.tolist():
        distance = lengths(z - centre)
        second = np.partition(distance + radius, 1)[1]
        copies.append(np.flatnonzero(distance - radius <= (second + 2 * grid.radius) * loose * _SLACK))
    copy = np.concatenate(copies)
    everything = np.arange(len(scene), dtype=np.int32)
    return _Lists(
        offsets_of([len(near) for near in copies]), copy.astype(np.int32), first[copy], last[copy], everything
    )


def _kept(scene: Scene, parents: _Lists, parent: Ints, grid: _BlockGrid, margins: _Margins) -> _Lists:
    """The lists of the blocks of a level, made of those of their parents."""
    size = np.add.reduceat(parents.last - parents.first, parents.run_start[:-1])[parent]
    ends = np.cumsum(size)
    # In portions, so that the work arrays do not fill the memory.
    bounds = np.searchsorted(ends, np.arange(_PORTION, int(ends[-1]) + _PORTION, _PORTION))
    portions = [
        _kept_portion(scene, parents, parent[i:j], size[i:j], grid.centre[i:j], grid.radius, margins)
        for i, j in zip(np.append(0, bounds), np.append(bounds, len(parent)), strict=True)
        if i < j
    ]
    joined = portions[0] if len(portions) == 1 else _Kept(*map(np.concatenate, zip(*portions, strict=True)))
    start = offsets_of(joined.size)
    return _Lists(offsets_of(joined.runs), joined.label, start[:-1], start[1:], joined.element)


_PORTION = 2_000_000
"""Pairs of blocks and elements that are handled at once; a count."""


class _Kept(NamedTuple):
    """What is kept of some blocks' lists: the runs of each block, the copy and the size of each run; the elements."""

    runs: Ints
    label: NDArray[np.int32]
    size: Ints
    element: NDArray[np.int32]


def _kept_portion(
    scene: Scene, parents: _Lists, parent: Ints, size: Ints, centre: Complexes, radius: float, margins: _Margins
) -> _Kept:
    """What can matter near centre[b], of the list of parent[b], which has size[b] elements.

    By the compiled kernel where there is one; otherwise by `_keep`, with the same result.
    """
    start = parents.run_start
    keep = _COMPILED()
    if keep is not None:
        blocks = len(parent), parent, centre, radius, *margins
        elements = scene.middle, scene.unit, scene.length
        most = int((start[parent + 1] - start[parent]).sum())
        kept = _Kept(
            np.empty(len(parent), np.intp),
            np.empty(most, np.int32),
            np.empty(most, np.intp),
            np.empty(int(size.sum()), np.int32),
        )
        total = keep(*blocks, *parents, *elements, np.empty(10 * int(size.max())), *kept)
        runs = int(kept.runs.sum())
        return _Kept(kept.runs, kept.label[:runs], kept.size[:runs], kept.element[:total])
    run, block = owned_ranges(start[parent], start[parent + 1])
    index, owner = owned_ranges(parents.first[run], parents.last[run])
    element, place = parents.element[index], centre[block][owner]
    run_start, block_start = np.searchsorted(owner, np.arange(len(run))), np.searchsorted(block, np.arange(len(parent)))
    away = _from_feet(place, scene.middle[element], scene.unit[element], scene.length[element])
    chosen = _keep(away, owner, run_start, block_start, radius, margins)
    count = np.add.reduceat(chosen, run_start, dtype=np.intp)
    left = count > 0
    runs_left = np.add.reduceat(left, block_start, dtype=np.intp)
    return _Kept(runs_left, parents.label[run[left]], count[left], element[chosen])


# The arguments of raster_keep in block_lists.c.
_BLOCKS = INT, INTS, COMPLEXES, FLOAT, FLOAT, FLOAT
_LISTS = INTS, LABELS, INTS, INTS, LABELS
_ELEMENTS = COMPLEXES, COMPLEXES, FLOATS
_KEPT = INTS, LABELS, INTS, LABELS
_COMPILED = kernel("raster_keep", *_BLOCKS, *_LISTS, *_ELEMENTS, FLOATS, *_KEPT)


def _from_feet(z: Complexes, middle: Complexes, unit: Complexes, length: Floats) -> Complexes:
    """The vectors that lead to points from the nearest points of elements middle +- length unit, without a division."""
    away = z - middle
    along = away.real * unit.real
    along += away.imag * unit.imag
    np.clip(along, -length, length, out=along)
    away.real -= along * unit.real
    away.imag -= along * unit.imag
    return away


def _keep(
    away: Complexes, run: Ints, run_start: Ints, block_start: Ints, radius: float, margins: _Margins
) -> NDArray[np.bool_]:
    """Which elements of each block's list can matter within `radius` of the block's centre.

    `away` (n,) leads from each element's nearest point to the centre, `run` (n,) says in which run it is, `run_start`
    where the elements of a run begin, `block_start` where the runs of a block.
    """
    square = away.real * away.real + away.imag * away.imag
    least = np.minimum.reduceat(square, run_start)
    distance, nearest = np.sqrt(square), np.sqrt(least)
    rivals = _two_nearest(nearest, block_start)
    within_reach = nearest <= (nearest[rivals[1]] + 2 * radius) * margins.loose
    winner = _first_of_each(np.flatnonzero(square == least[run]), run_start)
    gradient = away[winner] * (1.0 / np.where(nearest > 0.0, nearest, 1.0))
    with np.errstate(divide="ignore"):
        bend = radius * radius / (2.0 * nearest)
    slack = (margins.loose - 1.0) * (distance + radius)

    def nearer(some: Ints | slice, of: Ints, spare: float) -> NDArray[np.bool_]:
        """Whether some elements are nearer somewhere than the nearest at the centre of these runs and spare radii."""
        d = distance[some]
        excess = d - (nearest[of] + spare * radius)
        turn = away[some] - gradient[of] * d
        # Squared, and times the distance: |g - G| r >= d - D - r^2 / 2D, where the right side is positive.
        beyond = np.maximum(excess - bend[of] - slack[some], 0.0) * d
        turned = (turn.real * turn.real + turn.imag * turn.imag) * (radius * radius) - beyond * beyond
        return np.asarray((excess - slack[some] <= 2 * radius) & (turned >= 0.0))

    kept = within_reach[run] & nearer(slice(None), run, 0.0)
    third_run = np.ones(len(run_start), np.bool_)
    third_run[rivals[0]] = third_run[rivals[1]] = False
    third = np.flatnonzero(kept & third_run[run])
    one, other = (nearer(third, rival[run[third]], margins.spare) for rival in rivals)
    kept[third] = one | other
    return kept


def _two_nearest(nearest: Floats, block_start: Ints) -> tuple[Ints, Ints]:
    """For each run the two runs in its block with the smallest distances."""
    size = np.diff(block_start, append=len(nearest))
    rest, found = nearest.copy(), []
    for _ in range(2):
        smallest = np.repeat(np.minimum.reduceat(rest, block_start), size)
        first = _first_of_each(np.flatnonzero(rest == smallest), block_start)
        rest[first] = np.inf
        found.append(np.repeat(first, size))
    return found[0], found[1]


def _first_of_each(index: Ints, start: Ints) -> Ints:
    """Of ascending indices the first in each of the segments that begin at `start`."""
    return np.asarray(index[starts(np.searchsorted(start, index, side="right"))])

"""The nearest points of strokes, and of copies of them, at many heights at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isqrt
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.vector.motion_codes import images, inverted
from voronoi_tiles.vector.motions import Action

_BLOCK: Final = 8
"""How many elements are looked at together, at least; a count."""

_AT_ONCE: Final = 400_000
"""How many distances from discs about elements are held at once; a count."""


@dataclass(frozen=True, eq=False)
class StrokesInHeight:
    """The elements of a site at several heights, in blocks: their ends, complex128 (heights, blocks, size, 2).

    All of a block are within `radius` of `centre`, both (heights, blocks).
    """

    ends: Complexes
    centre: Complexes
    radius: Floats

    @classmethod
    def of(cls, points: Complexes, sizes: Sequence[int]) -> StrokesInHeight:
        """The elements of polylines, whose points are the rows of `points`, complex128 (heights, points).

        They have so many points each; one point is an element by itself.
        """
        first: list[int] = []
        at = 0
        for size in sizes:
            first += range(at, at + max(size - 1, 1))
            at += size
        start = np.array(first)
        end = np.where(np.isin(start, np.cumsum(sizes) - 1), start, start + 1)
        block = max(_BLOCK, isqrt(len(start)))
        count = -(-len(start) // block)
        filled = np.minimum(np.arange(count * block), len(start) - 1)  # the last one again
        ends = np.stack((points[:, start[filled]], points[:, end[filled]]), axis=-1).reshape(-1, count, block, 2)
        centre = ends.mean(axis=(2, 3))
        return cls(ends, centre, np.abs(ends - centre[:, :, None, None]).max(axis=(2, 3)))


def nearest_feet(
    place: Complexes,
    height: Ints,
    strokes: Sequence[StrokesInHeight],
    action: Action,
    copies: Sequence[tuple[int, int]],
) -> tuple[Complexes, Ints]:
    """For each place the nearest point of some copies of sites at its height, complex128 (n,), and which copy has it.

    `height` (intp, n) are numbers of the heights of `strokes`, `copies` pairs of a site's number and a motion's code.
    """
    blocks = sum(strokes[site].centre.shape[1] for site, _ in copies)
    parts = np.array_split(np.arange(len(place)), len(place) * blocks // _AT_ONCE + 1)
    found = [_feet(place[part], height[part], strokes, action, copies) for part in parts]
    return np.concatenate([feet for feet, _ in found]), np.concatenate([copy for _, copy in found])


def _feet(
    place: Complexes,
    height: Ints,
    strokes: Sequence[StrokesInHeight],
    action: Action,
    copies: Sequence[tuple[int, int]],
) -> tuple[Complexes, Ints]:
    """The same for few places: where discs about blocks are nearest first, then where they are no farther than that."""
    every = np.arange(len(place))
    back, low, of = [], [], []
    for number, (site, code) in enumerate(copies):
        # In the frame of the copy the strokes are where they are drawn.
        back.append(images(action, np.repeat(inverted(np.array([code])), len(place)), place))
        own = strokes[site]
        low.append(np.abs(back[-1][:, None] - own.centre[height]) - own.radius[height])
        of += [(number, block) for block in range(own.centre.shape[1])]
    bound, item = np.concatenate(low, axis=1), np.array(of)

    def feet(point: Ints, which: Ints) -> Complexes:
        found = np.empty(len(point), np.complex128)
        for number in np.unique(item[which, 0]).tolist():
            site, code = copies[number]
            at = np.flatnonzero(item[which, 0] == number)
            ends = strokes[site].ends[height[point[at]], item[which[at], 1]]
            found[at] = images(action, np.full(len(at), code), _foot(back[number][point[at]], ends))
        return found

    first = bound.argmin(axis=1)
    best = feet(every, first)
    away = np.abs(place - best)
    bound[every, first] = np.inf
    point, which = np.nonzero(bound < away[:, None])
    others = feet(point, which)
    distance = np.abs(place[point] - others)
    order = np.lexsort((distance, point))
    order = order[np.unique(point[order], return_index=True)[1]]
    nearer = order[distance[order] < away[point[order]]]
    best[point[nearer]] = others[nearer]
    first[point[nearer]] = which[nearer]
    return best, item[first, 0]


def _foot(place: Complexes, ends: Complexes) -> Complexes:
    """The point of the nearest of a row of elements, complex128 (n, size, 2), for each place."""
    start, along = ends[:, :, 0], ends[:, :, 1] - ends[:, :, 0]
    square = along.real * along.real + along.imag * along.imag
    away = place[:, None] - start
    share = (away.real * along.real + away.imag * along.imag) / np.where(square > 0.0, square, 1.0)
    foot = start + np.clip(share, 0.0, 1.0) * along
    nearest = np.abs(place[:, None] - foot).argmin(axis=1)
    return np.asarray(foot[np.arange(len(place)), nearest])

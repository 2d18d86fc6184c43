"""Closed contours from strands: the pieces that a region's border leaves of tiles, and the frame around whole tiles."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np

from voronoi_tiles.base.arrays import Ints, offsets_of
from voronoi_tiles.fabrication.clipping import OUTSIDE, Strands, outer_strands
from voronoi_tiles.fabrication.region import Region, beside_border
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import point_at, tangent_at
from voronoi_tiles.paths.winding import item_winding, winding

_LEVEL = 1e-7
"""Directions that differ by less are told apart by where they lead; radians."""


@dataclass(frozen=True, eq=False)
class ClosedPieces:
    """Closed pieces: piece k are the rings items[k] up to items[k + 1] of `paths`, the outer one first, holes after it.

    Outer rings run counter-clockwise, holes clockwise. `tile` is the tile, as an index of the placement, that each is
    part of, or OUTSIDE for a part of a frame.
    """

    paths: Paths
    items: Ints
    tile: Ints


def clipped_pieces(strands: Strands, tiles: Ints, outlines: Paths, items: Ints) -> ClosedPieces:
    """What the border leaves of tiles that it cuts: of each, one piece or several.

    `strands` are those of the region, with its border; `tiles` the indices of the tiles in the placement, and
    `outlines` their uncut rings, those of tile k from items[k] up to items[k + 1].
    """
    walks, owners = _Tracer(strands).rings_around(set(tiles.tolist()), hug=False)
    # A ring of the border that meets no side lies inside one tile.
    lonely = _lonely(strands)
    if len(lonely):
        inside = item_winding(outlines, outlines.offsets[items], strands.node[strands.first[lonely]]) > 0
        for k, holders in zip(lonely.tolist(), inside.T, strict=True):
            for holder in np.flatnonzero(holders).tolist():
                walks.append([2 * k])
                owners.append(int(tiles[holder]))
    return _grouped(_joined(strands, walks), np.array(owners, np.intp))


def frame_pieces(strands: Strands, region: Region) -> ClosedPieces:
    """What is left of a region around the tiles that lie in it: `strands` are the sides around these."""
    bounds = outer_strands(strands, region)
    walks, _ = _Tracer(bounds).rings_around({OUTSIDE}, hug=True)
    # A ring of the border at which nothing ends is the frame's, unless tiles line all of it.
    lonely = _lonely(bounds)
    beside, _ = beside_border(bounds.paths, bounds.paths.offsets[lonely], region.close)
    lone = np.flatnonzero((strands.left == OUTSIDE) ^ (strands.right == OUTSIDE))
    tiles = strands.paths.take(lone).reversed(strands.left[lone] == OUTSIDE)
    walks += [[2 * k] for k in lonely[winding(tiles, beside) <= 0].tolist()]
    return _grouped(_joined(bounds, walks), np.full(len(walks), OUTSIDE))


def _lonely(strands: Strands) -> Ints:
    """The strands of the border that are whole rings at which no other strand ends."""
    degree = np.bincount(np.concatenate((strands.first, strands.last)), minlength=len(strands.node))
    return np.flatnonzero(strands.border & (strands.first == strands.last) & (degree[strands.first] == 2))


def _joined(strands: Strands, walks: list[list[int]]) -> Paths:
    """Join the halves of each walk to a closed path."""
    halves = np.array([half for walk in walks for half in walk], np.intp)
    parts = strands.paths.take(halves // 2).reversed(halves % 2 == 1)
    bounds = offsets_of([len(walk) for walk in walks])
    return replace(parts, offsets=parts.offsets[bounds], closed=np.ones(len(walks), np.bool_))


def _grouped(paths: Paths, owner: Ints) -> ClosedPieces:
    """Put every hole behind the smallest outer ring of the same tile that it lies in."""
    area = ring_areas(paths)
    outer = np.flatnonzero(area > 0)
    holes: dict[int, list[int]] = {k: [] for k in outer.tolist()}
    for k in np.flatnonzero(area <= 0).tolist():
        rivals = outer[owner[outer] == owner[k]]
        candidates = paths.take(rivals)
        # Where rings touch, single places mislead.
        pieces = np.arange(paths.offsets[k], paths.offsets[k + 1])
        places = np.concatenate([point_at(paths, pieces, np.full(len(pieces), t)) for t in (0.37, 0.61)])
        around = rivals[(item_winding(candidates, candidates.offsets, places) > 0).mean(axis=1) > 0.5]
        holes[int(around[np.argmin(area[around])])].append(k)
    order = [ring for k in outer.tolist() for ring in (k, *holes[k])]
    items = offsets_of([1 + len(holes[k]) for k in outer.tolist()])
    return ClosedPieces(paths.take(np.array(order, np.intp)), items, owner[outer])


class _Tracer:
    """Walks along strands with one tile, or the outside, on the left: half 2k runs along strand k, 2k + 1 back."""

    def __init__(self, strands: Strands) -> None:
        self.strands = strands
        paths = strands.paths
        begin, stop = paths.offsets[:-1], paths.offsets[1:] - 1
        zero, one = np.zeros(len(paths)), np.ones(len(paths))
        ahead, back = tangent_at(paths, begin, zero), -tangent_at(paths, stop, one)
        near, far = point_at(paths, begin, zero + 0.5), point_at(paths, stop, one - 0.5)
        origin = np.column_stack((strands.first, strands.last)).ravel()
        self.origin: list[int] = origin.tolist()
        self.target: list[int] = np.column_stack((strands.last, strands.first)).ravel().tolist()
        self.tile: list[int] = np.column_stack((strands.left, strands.right)).ravel().tolist()
        self.leaving = np.column_stack((ahead, back)).ravel()
        self.toward = np.column_stack((near, far)).ravel() - strands.node[origin]
        self.border: list[bool] = np.repeat(strands.border, 2).tolist()
        self.out: defaultdict[int, list[int]] = defaultdict(list)
        for half, node in enumerate(self.origin):
            self.out[node].append(half)

    def rings_around(self, tiles: set[int], *, hug: bool) -> tuple[list[list[int]], list[int]]:
        """The rings around what there is of tiles, with these on the left; and the tile of each ring.

        `hug` what is on the right where the rings touch inside the region.
        """
        walks, owners = [], []
        done: set[int] = set()
        for half, tile in enumerate(self.tile):
            if tile in tiles and half not in done and not self.border[half]:
                walks.append(self._walk(half, hug=hug))
                owners.append(tile)
                done.update(walks[-1])
        return walks, owners

    def _walk(self, half: int, *, hug: bool) -> list[int]:
        """Follow the boundary on the left of a half; `hug` what is on its right where boundaries touch."""
        walk = [half]
        while True:
            half = self._following(half, hug=hug)
            if half == walk[0]:
                return walk
            walk.append(half)
            assert len(walk) <= len(self.origin), "a boundary closes"

    def _following(self, half: int, *, hug: bool) -> int:
        """The next half along the boundary on the left: the first one clockwise from the way back.

        Where this tile, or the outside, meets the node more than once, `hug` takes the last one instead.
        """
        node, back = self.target[half], half ^ 1
        inner = node >= self.strands.on_border
        leaving = [k for k in self.out[node] if k != back and not (self.border[k] and k % 2)]
        own = [k for k in leaving if self.tile[k] == self.tile[half]] if inner else leaving
        if len(own) < 2:
            return own[0] if own else back
        others = np.array(own)
        turn = np.mod(np.angle(self.leaving[back] / self.leaving[others]), 2 * np.pi)
        bend = np.angle(self.toward[back] / self.toward[others])
        # What leaves along the way back, to within rounding, lies on the side to which it goes from there.
        level = (turn < _LEVEL) | (turn > 2 * np.pi - _LEVEL)
        turn = np.where(level, np.where(bend > 0, 0.0, 2 * np.pi), turn)
        order = np.lexsort((np.mod(bend, 2 * np.pi), np.round(turn / _LEVEL)))
        return int(others[order[-1 if hug and inner else 0]])

"""Which tiles lie on a sheet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.fabrication.region import Region, beside_border
from voronoi_tiles.paths.intersections import candidate_pairs, crossings
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import point_at
from voronoi_tiles.paths.winding import item_winding
from voronoi_tiles.vector.complex.period import Period


@dataclass(frozen=True, eq=False)
class TilePlacement:
    """Tiles that have something of a region: tile of the period, its lattice vector (n x 2), and whether it has all."""

    tile: Ints
    step: Ints
    whole: Bools

    def take(self, which: Bools) -> TilePlacement:
        """Some of the tiles."""
        return TilePlacement(self.tile[which], self.step[which], self.whole[which])


def group_box(period: Period, tile: Ints, place: Complexes) -> tuple[float, float, float, float]:
    """The box around tiles of a period, each moved by its place (complex128): x0, y0, x1, y1."""
    box = period.own_boxes[tile]
    return (
        float((box[:, 0] + place.real).min()),
        float((box[:, 1] + place.imag).min()),
        float((box[:, 2] + place.real).max()),
        float((box[:, 3] + place.imag).max()),
    )


def place_tiles(period: Period, region: Region) -> TilePlacement:
    """Find the tiles that lie in a region, and those that its border cuts; row by row from below, then from the left.

    Tiles that only touch the border, within `region.close`, are whole, or have nothing of the region.
    """
    tile, step, here = _near(period, period.own_boxes, region)
    kept = region.contains(here[:, 0] + 1j * here[:, 1])
    whole = kept.copy()
    unclear = np.flatnonzero(region.meets_border(here, region.close))
    if len(unclear):
        paths, parts = period.outlines(tile[unclear], step[unclear])
        inner, outer = _against(region, paths, parts)
        kept[unclear] = inner
        whole[unclear] = inner & ~outer
    return TilePlacement(tile, step, whole).take(kept)


def whole_tiles(period: Period, region: Region, shift: complex = 0j) -> TilePlacement:
    """Those that `place_tiles` finds whole after a shift of the period; in a rectangle their boxes tell."""
    if not region.is_rectangle:
        placement = place_tiles(period.placed(1.0, shift) if shift else period, region)
        return placement.take(placement.whole)
    moved = np.array([shift.real, shift.imag, shift.real, shift.imag])
    tile, step, here = _near(period, period.own_boxes + moved, region)
    left, bottom, right, top = region.bounds
    low, high = np.array([left, bottom]) - region.close, np.array([right, top]) + region.close
    whole: Bools = np.all((here[:, :2] >= low) & (here[:, 2:] <= high), axis=1)
    return TilePlacement(tile, step, whole).take(whole)


def _near(period: Period, box: Floats, region: Region) -> tuple[Ints, Ints, Floats]:
    """The tiles whose boxes meet that of the region by more than touching, in order: tile, lattice vector, and box.

    `box` are those of the period's tiles.
    """
    left, bottom, right, top = region.bounds
    close = region.close
    tiles, steps = [], []
    for number, (x0, y0, x1, y1) in enumerate(box.tolist()):
        step = period.steps_in(left - x1, bottom - y1, right - x0, top - y0)
        shift = period.shifts(step)
        meets = (x0 + shift.real < right - close) & (x1 + shift.real > left + close)
        meets &= (y0 + shift.imag < top - close) & (y1 + shift.imag > bottom + close)
        tiles.append(np.full(int(meets.sum()), number))
        steps.append(step[meets])
    tile, step = np.concatenate(tiles), np.concatenate(steps)
    shift = period.shifts(step)
    here = box[tile] + np.column_stack((shift.real, shift.imag, shift.real, shift.imag))
    # Order by the middle of the box: the sheet's rows, whatever the tile.
    order = np.lexsort((here[:, 0] + here[:, 2], np.round(here[:, 1] + here[:, 3], 6)))
    return tile[order], step[order], here[order]


def _against(region: Region, paths: Paths, items: Ints) -> tuple[Bools, Bools]:
    """Which items have something of the region, and which have something beyond it.

    What is near the border is decided by the parts between the points where the two meet.
    """
    count = len(items) - 1
    owner = np.repeat(np.repeat(np.arange(count), np.diff(items)), paths.counts)
    i, j = candidate_pairs(paths, region.border, region.close)
    met = crossings(paths, i, region.border, j)
    # The middles of the parts of every piece: between its ends and the points where it meets the border.
    piece = np.concatenate((np.arange(len(paths.start)), np.arange(len(paths.start)), i[met.pair]))
    at = np.concatenate((np.zeros(len(paths.start)), np.ones(len(paths.start)), met.t))
    order = np.lexsort((at, piece))
    piece, at = piece[order], at[order]
    same = np.flatnonzero(piece[1:] == piece[:-1])
    middle = point_at(paths, piece[same], (at[same] + at[same + 1]) / 2)
    off = region.distance(middle) > region.close
    within = region.contains(middle)
    of = owner[piece[same]]
    inner = np.bincount(of[off & within], minlength=count) > 0
    outer = np.bincount(of[off & ~within], minlength=count) > 0
    # An outline with no part on one side of the border has all of a ring's places on that side, or none of them.
    beside_in, beside_out = beside_border(region.border, _longest(region.border), region.close)
    inner |= (item_winding(paths, paths.offsets[items], beside_in) > 0).any(axis=1)
    outer |= (item_winding(paths, paths.offsets[items], beside_out) > 0).any(axis=1)
    return inner, outer


def _longest(paths: Paths) -> Ints:
    """The longest piece of each path."""
    first, lengths = paths.offsets[:-1].tolist(), paths.lengths
    return np.array([a + int(lengths[a:b].argmax()) for a, b in zip(first, paths.offsets[1:].tolist(), strict=True)])

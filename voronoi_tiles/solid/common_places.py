"""The sheets of a stack laid out together: in each of them the same copies of tiles, in the same places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from voronoi_tiles.base.arrays import Ints, ranges
from voronoi_tiles.fabrication.best_offset import best_shift
from voronoi_tiles.fabrication.dressed_tiles import DressedTiles
from voronoi_tiles.fabrication.engraving import reading_order
from voronoi_tiles.fabrication.job import JobError
from voronoi_tiles.fabrication.layout import Layout, pulled, refuse_crowd, spaced_period
from voronoi_tiles.fabrication.region import Region, inset
from voronoi_tiles.fabrication.spacing import UNSTRETCHED, Stretch, common_stretch
from voronoi_tiles.fabrication.tile_placement import TilePlacement, place_tiles, whole_tiles
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.vector.complex.period import Period, Rings
from voronoi_tiles.vector.motions import IDENTITY, Motion


def laid_together(layouts: Sequence[Layout]) -> list[Layout]:
    """Layouts of one job, each of a sheet of a stack, with the same copies in the same places.

    They are given with one of each tile, as `unplaced` gives them, and without a sheet stay so.

    On sheets that are clipped a copy is where it has something of the sheet; else copies are those that are whole in
    all sheets. They are numbered as one reads, by the same numbers in all sheets. Raises JobError where no copy is
    whole in all of them, or where they have not the same copies.
    """
    first = layouts[0]
    job, sheet, region = first.job, first.sheet, first.region
    if region is None:
        return list(layouts)
    _refuse_others(layouts)
    homes = [_homes(layout) for layout in layouts]
    tiles = [layout.tiles.moved(sheet.centre + (job.offset or 0j)) for layout in layouts]
    refuse_crowd(tiles[0].period, region)
    middles = [own.centres() + own.period.shifts(home) for own, home in zip(tiles, homes, strict=True)]
    middle = np.mean(middles, axis=0)
    tiles = [own.pulled(middle - own.period.shifts(home)) for own, home in zip(tiles, homes, strict=True)]
    stretch = _stretch(tiles, first)
    field = inset(region, job.frame_width) if job.frame_width > 0.0 else region
    if job.fit == "clip":
        there = [place_tiles(spaced_period(own, sheet, stretch), field) for own in tiles]
    else:
        # What the copies of all sheets take together is one tile: so it decides where they are whole in all of them.
        period = _swept([own.period for own in tiles], homes)
        swept = replace(tiles[0].pulled(middle), period=period, _rings={})
        if job.offset is None:
            shift = stretch.inverse(best_shift(spaced_period(swept, sheet, stretch), field))
            swept, tiles = swept.moved(shift), [own.moved(shift) for own in tiles]
        whole = _whole(spaced_period(swept, sheet, stretch), field)
        there = [replace(whole, step=whole.step + home[whole.tile]) for home in homes]
    numbers = _numbers(there, homes, tiles[0], first)
    return [
        replace(
            layout,
            tiles=own,
            spaced=spaced_period(own, sheet, stretch),
            placement=placement,
            copies=pulled(own, placement, sheet, stretch),
            stretch=stretch,
            numbers=number,
        )
        for layout, own, placement, number in zip(layouts, tiles, there, numbers, strict=True)
    ]


def _refuse_others(layouts: Sequence[Layout]) -> None:
    """Refuse sheets that have not the same copies, since a site is symmetric in some of them."""
    for k, layout in enumerate(layouts):
        for site, own, base in zip(
            layout.design.noded, layout.tessellation.placed, layouts[0].tessellation.placed, strict=True
        ):
            if own.representatives != base.representatives:
                raise JobError(
                    f'copies of "{site.name}" coincide in a sheet, and not in both sheet 1 and sheet {k + 1}: '
                    "they are no stacks",
                    remedy="Move its strokes off the axes and centres of the group, or leave `sheet` out.",
                )


def _homes(layout: Layout) -> Ints:
    """For each tile of the period the lattice vector at which it is the copy that it would be as its site is drawn."""
    placed = layout.tessellation.placed
    steps: list[tuple[int, int]] = []
    for site, (a, b, c, d, _, _) in zip(layout.period.site.tolist(), layout.period.motion, strict=True):
        i, j = placed[site].shift
        steps.append((a * i + b * j, c * i + d * j))
    return np.array(steps, np.intp)


def _stretch(tiles: Sequence[DressedTiles], layout: Layout) -> Stretch:
    """The stretch that pulls the tiles of all sheets apart. Raises JobError where none does."""
    apart, accuracy = layout.job.apart, layout.budget.measured
    if apart is None:
        return UNSTRETCHED
    try:
        return common_stretch([own.spacing(accuracy) for own in tiles], apart + 2 * accuracy)
    except ValueError as error:
        raise JobError(str(error), remedy="Leave `kerf` and `gap` out, or `sheet`.") from error


def _swept(periods: Sequence[Period], homes: Sequence[Ints]) -> Period:
    """A period whose tiles are all that the tiles of some others have together: their rings, each an edge of its own.

    Tile c of period k counts moved by the lattice vector homes[k][c].
    """
    count = len(periods[0].site)
    parts: list[Paths] = []
    tiles = [0]
    for tile in range(count):
        for period, home in zip(periods, homes, strict=True):
            rings, items = period.own_outlines
            own = rings.take(ranges(items[tile : tile + 1], np.diff(items)[tile : tile + 1]))
            parts.append(own.moved(1.0, complex(period.shifts(home[tile : tile + 1])[0])))
        tiles.append(sum(map(len, parts)))
    paths = Paths.concatenate(parts)
    every = np.arange(len(paths))
    still = np.zeros((len(paths), 2), np.intp)
    motion: tuple[Motion, ...] = (IDENTITY,) * len(paths)
    return replace(
        periods[0],
        vertex=paths.start[paths.offsets[:-1]],
        start=every,
        end=every,
        reach=still,
        edges=replace(paths, closed=np.zeros(len(paths), np.bool_)),
        orbit=every,
        edge_motion=motion,
        rings=Rings(every, still, np.ones(len(paths), np.bool_), np.arange(len(paths) + 1), np.array(tiles)),
    )


def _whole(spaced: Period, field: Region) -> TilePlacement:
    """The copies that are whole in all sheets. Raises JobError where there is none."""
    placement = whole_tiles(spaced, field)
    if not len(placement.tile):
        x0, y0, x1, y1 = spaced.own_boxes[0].tolist()
        raise JobError(
            f"no stack fits on the sheet as a whole: one takes {x1 - x0:.4g} x {y1 - y0:.4g} mm",
            remedy="Take a larger sheet, a smaller margin, another `offset` or `rotate`, or `fit='clip'`.",
        )
    return placement


def _numbers(there: Sequence[TilePlacement], homes: Sequence[Ints], tiles: DressedTiles, layout: Layout) -> list[Ints]:
    """The numbers of the copies in each sheet, from 1, as one reads all that there are: one copy has one number.

    `tiles` and `layout` are those of the first sheet.
    """
    names = [
        np.column_stack((placement.tile, placement.step - home[placement.tile]))
        for placement, home in zip(there, homes, strict=True)
    ]
    known, which = np.unique(np.concatenate(names), axis=0, return_inverse=True)
    tile, step = known[:, 0], known[:, 1:] + homes[0][known[:, 0]]
    number = np.empty(len(known), np.intp)
    number[reading_order(tiles.period.at(tiles.centres()[tile], step), layout)] = np.arange(len(known)) + 1
    return np.split(number[which.reshape(-1)], np.cumsum([len(own) for own in names])[:-1])

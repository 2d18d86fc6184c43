"""The tiles of each colour on sheets of their own: as they stand in the picture, but packed, or nested anew."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import fsum
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, plane
from voronoi_tiles.base.text import counted
from voronoi_tiles.fabrication.engraving import piece_numbers
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.layout import Layout, PlacedTiles, Sheet
from voronoi_tiles.fabrication.nest_kinds import kind_keys
from voronoi_tiles.fabrication.nest_search import Progress
from voronoi_tiles.fabrication.nested_pieces import numbered_on
from voronoi_tiles.fabrication.nested_sheets import Nesting, counted_sheets
from voronoi_tiles.fabrication.packing import pack_pieces
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.tile_colouring import TileColouring
from voronoi_tiles.fabrication.tile_placement import TilePlacement
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths

_COARSE: Final = 0.02
"""How far the chords by which pieces are packed may lie from their contours; a share of the gap, which grows by two."""


@dataclass(frozen=True, eq=False)
class PackedColour:
    """The sheets of a colour, and how much of them its tiles take, from 0 to 1."""

    colour: int
    sheets: tuple[Layout, ...]
    share: float
    named: bool = True

    def name(self, number: int) -> str:
        """What the file of a sheet is called after: its number, from 0, and that of the colour, if there are any."""
        return f"colour{self.colour + 1}-{number + 1}" if self.named else str(number + 1)

    def said(self) -> str:
        """What there is to say of it, a sentence."""
        tiles, sheets = sum(len(sheet.copies.tile) for sheet in self.sheets), len(self.sheets)
        return (
            (f"colour {self.colour + 1}: " if self.named else "")
            + f"{counted(tiles, 'piece')} on {counted(sheets, 'sheet')}, "
            f"{self.share:.1%} of {'it' if sheets == 1 else 'them'}"
        )


def pack_colours(layout: Layout, colouring: TileColouring) -> list[PackedColour]:
    """Pack the whole tiles of each colour. Raises JobError where a piece is larger than a sheet."""
    job = layout.job
    page = stock(job)
    room = (page.width - 2 * job.margin, page.height - 2 * job.margin)
    slack = _COARSE * job.side_by_side
    shapes = [_polygon(to_lines(rings, accuracy=slack)) for rings in layout.tiles.all_rings()]
    colour = colouring.of_copies(np.arange(len(layout.copies.tile)))
    numbers = layout.numbers
    if job.labels == "number" and numbers is None:
        numbers = piece_numbers(layout, layout.contours)
    found = []
    for number in np.unique(colour[layout.copies.whole]).tolist():
        copies = np.flatnonzero((colour == number) & layout.copies.whole)
        tile = layout.copies.tile[copies]
        try:
            # Chords are within the slack of the contours, on either side.
            packed = pack_pieces(shapes, tile, (room[0] - 2 * slack, room[1] - 2 * slack), job.side_by_side + 2 * slack)
        except ValueError as error:
            raise JobError(
                f"{error}, and a sheet has room for {room[0]:.4g} x {room[1]:.4g} mm", remedy="Take a larger `stock`."
            ) from error
        place = packed.shift[:, 0] + 1j * packed.shift[:, 1] + (1 + 1j) * (job.margin + slack)
        sheets = tuple(
            _on_sheet(layout, copies[packed.sheet == k], place[packed.sheet == k], page, numbers)
            for k in range(int(packed.sheet.max()) + 1)
        )
        area = fsum(layout.tile_areas[tile].tolist())
        found.append(
            PackedColour(number, sheets, area / (len(sheets) * page.width * page.height), job.colours != "none")
        )
    return found


def nest_colours(
    layout: Layout, colouring: TileColouring, nesting: Nesting, progress: Progress | None = None
) -> list[PackedColour]:
    """Nest the whole tiles of each colour. Raises JobError where a piece is larger than a sheet, or there are too few.

    A piece may lie as any of its kind: those of a site that are all turned over, or none. They are numbered through.
    """
    keys = kind_keys(layout.period, grain=nesting.job.grain)
    kind = np.array([list(dict.fromkeys(keys)).index(key) for key in keys])
    colour = colouring.of_copies(np.arange(len(layout.copies.tile)))
    found, first = [], 1
    for number in np.unique(colour[layout.copies.whole]).tolist():
        tile = layout.copies.tile[(colour == number) & layout.copies.whole]
        demand = np.bincount(kind[tile], minlength=len(nesting.kinds))
        sheets = numbered_on(counted_sheets(nesting, demand, progress, search=True), first)
        first += len(tile)
        page, area = nesting.layout.sheet, fsum(layout.tile_areas[tile].tolist())
        share = area / (len(sheets) * page.width * page.height)
        found.append(PackedColour(number, tuple(sheets), share, layout.job.colours != "none"))
    return found


def stock(job: Job) -> Sheet:
    """The sheet that pieces are packed on."""
    size = job.stock or job.sheet
    assert isinstance(size, tuple), "a job that packs says on what"
    m = job.margin
    if 2 * m >= min(size):
        raise JobError(
            f"a `margin` of {m:g} mm leaves nothing of a `stock` of {size[0]:g} x {size[1]:g} mm",
            remedy="Make the margin smaller, or the stock larger.",
        )
    region = Region.rectangle(m, m, size[0] - m, size[1] - m)
    return Sheet(*size, region, complex(*size) / 2)


def _on_sheet(layout: Layout, copies: Ints, shift: Complexes, page: Sheet, numbers: Ints | None) -> Layout:
    """Some tiles of a layout on a page, each `shift` from where its tile stands in the period."""
    tile, step = layout.copies.tile[copies], layout.copies.step[copies]
    whole = np.ones(len(copies), np.bool_)
    return replace(
        layout,
        job=replace(layout.job, fit="whole", frame=None),
        sheet=page,
        placement=TilePlacement(tile, step, whole),
        copies=PlacedTiles(tile, step, whole, shift - layout.period.shifts(step)),
        numbers=None if numbers is None else numbers[copies],
    )


def _polygon(rings: Paths) -> object:
    """A tile's rings of lines, the outer one first, as a polygon."""
    import shapely

    outer, *holes = (plane(rings.start[a:b]) for a, b in pairwise(rings.offsets.tolist()))
    return shapely.Polygon(outer, holes)

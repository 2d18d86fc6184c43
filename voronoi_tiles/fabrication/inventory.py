"""What a report counts: the pieces that a job gives."""

from __future__ import annotations

from dataclasses import dataclass
from math import fsum

import numpy as np

from voronoi_tiles.base.arrays import Bools, Floats, Ints
from voronoi_tiles.fabrication.layout import FRAME, Layout, piece_areas
from voronoi_tiles.fabrication.tile_colouring import TileColouring


@dataclass(frozen=True, eq=False)
class Inventory:
    """What a report counts: `site` is the index of its site, FRAME for a part of a frame."""

    site: Ints
    turned_over: Bools
    whole: Bools
    colour: Ints
    area: Floats

    def __repr__(self) -> str:
        return f"<Inventory: {len(self.site)} pieces, {int(self.whole.sum())} of them whole tiles>"

    @property
    def tile_area(self) -> float:
        """The area of all pieces but those of a frame; square millimetres."""
        return fsum(self.area[self.site != FRAME].tolist())


def cut_free(layout: Layout, colouring: TileColouring) -> Inventory:
    """What the pieces are that are cut free when every line is cut once."""
    whole = np.flatnonzero(layout.copies.whole)
    copy, area = whole, layout.tile_areas[layout.copies.tile[whole]]
    rest = layout.rest()
    if rest is not None:
        copy, area = np.append(copy, rest.tile), np.append(area, piece_areas(rest))
    return inventory(layout, colouring, copy, area)


def inventory(layout: Layout, colouring: TileColouring, copy: Ints, area: Floats) -> Inventory:
    """What is to be said of pieces of copies on the page, negative for those of a frame, that have these areas."""
    inside = copy >= 0
    known = np.where(inside, copy, 0)
    return Inventory(
        site=np.where(inside, layout.site[known], FRAME),
        turned_over=inside & layout.turned_over[known],
        whole=inside & layout.copies.whole[known],
        colour=colouring.of_copies(copy),
        area=area,
    )

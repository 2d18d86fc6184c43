"""What a report counts: the pieces that a job gives."""

from __future__ import annotations

from dataclasses import dataclass
from math import fsum

import numpy as np

from voronoi_tiles.base.arrays import Bools, Floats, Ints
from voronoi_tiles.base.text import counted
from voronoi_tiles.fabrication.layout import FRAME, Layout
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
        return f"<Inventory: {self.counted}, {int(self.whole.sum())} of them whole tiles>"

    @property
    def count(self) -> int:
        """How many pieces there are of tiles: all but those of a frame."""
        return int(np.count_nonzero(self.site != FRAME))

    @property
    def frame(self) -> int:
        """How many pieces a frame has; 0 where there is none."""
        return len(self.site) - self.count

    @property
    def counted(self) -> str:
        """The count in words: "54 pieces", "40 tiles and a frame", "a frame of 2 pieces"."""
        count, parts = self.count, self.frame
        what = "tile" if parts else "piece"
        pieces = [counted(count, what)] if count or not parts else []
        return " and ".join([*pieces, *(["a frame" if parts == 1 else f"a frame of {parts} pieces"] if parts else [])])

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
        copy, area = np.append(copy, rest.tile), np.append(area, layout.rest_areas(rest))
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

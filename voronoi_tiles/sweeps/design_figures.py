"""What a sweep measures of a design: figures of each tile, and what a job comes to. Lengths are millimetres."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import next_in_ring
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.sweeps.tile_neck import narrowest
from voronoi_tiles.tile import Tile
from voronoi_tiles.tiling import Tiling

TILE_FIGURES: Final = (
    "area",
    "perimeter",
    "width",
    "height",
    "edges",
    "vertices",
    "curved_share",
    "neck",
    "neighbours",
)
"""The figures of a tile. `vertices` are points of the outline beyond which another copy is the neighbour; `neck` is the
narrowest place; `neighbours` are different copies that share an edge."""

JOB_FIGURES: Final = ("pieces", "cut")
"""What a job comes to: pieces on the sheet, a count, and the length of all cuts."""


def figure_names(sites: int, *, job: bool) -> tuple[str, ...]:
    """The names of the figures of a design of so many sites: with several, each tile's begin with its site's place."""
    tiles = TILE_FIGURES if sites == 1 else tuple(f"site[{k}].{name}" for k in range(sites) for name in TILE_FIGURES)
    return (*tiles, *JOB_FIGURES) if job else tiles


def design_figures(tiling: Tiling, job: Job | None) -> list[float]:
    """The figures of a tiling, as `figure_names` has them. Raises JobError where the job cannot be done."""
    unit = tiling.design.unit_mm
    found = [figure for tile in tiling for figure in _tile_figures(tile, unit)]
    if job is not None:
        report = tiling.report(job)
        found += [report["pieces"]["count"], report["cut"]["length"]]
    return found


def _tile_figures(tile: Tile, unit: float) -> Iterator[float]:
    """The figures of a tile, in the order of TILE_FIGURES; `unit` is a unit of its design in millimetres."""
    outline = tile.outline
    low_x, low_y, high_x, high_y = outline.bounds
    changes = outline.neighbour != outline.neighbour[next_in_ring(outline.ring_offsets)]
    yield tile.area * unit**2
    yield tile.perimeter * unit
    yield (high_x - low_x) * unit
    yield (high_y - low_y) * unit
    yield len(outline)
    yield int(np.count_nonzero(changes))
    yield outline.curved_length / tile.perimeter
    yield narrowest(outline) * unit
    yield len(outline.neighbours)

"""The colours that tiles have when they are cut, for the copies of a picture."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.fabrication.tile_colouring import colour_tiles
from voronoi_tiles.groups.periodic_colouring import PeriodicColouring
from voronoi_tiles.raster.scene import Pattern
from voronoi_tiles.vector.copies import translation
from voronoi_tiles.vector.motions import compose, split, to_motion
from voronoi_tiles.vector.tessellation import Tessellation


def wood_colouring(tessellation: Tessellation, pattern: Pattern, scheme: str | int) -> PeriodicColouring:
    """The colouring of a pattern's copies by what `--colours` takes; "layers" and "files" are "fewest".

    Raises JobError for too few colours, or too many.
    """
    found = colour_tiles(tessellation, "fewest" if scheme in {"layers", "files"} else scheme)
    period, repeat = tessellation.period, found.repeat
    number = {
        (site, motion): k for k, (site, motion) in enumerate(zip(period.site.tolist(), period.motion, strict=True))
    }
    places = np.indices((repeat.m, repeat.n)).reshape(2, -1)
    colour = np.empty((len(pattern.placements), repeat.m, repeat.n), np.intp)
    for k, (site, operation, _) in enumerate(pattern.placements):
        placed = tessellation.placed[site]
        here, i, j = split(placed.canonical(compose(to_motion(operation), translation(placed, 1))))
        s, t = repeat.place(np.array([i]), np.array([j]))
        rows = found.colour[number[site, here]]
        colour[k] = rows[(places[0] + s) % repeat.m, (places[1] + t) % repeat.n].reshape(repeat.m, repeat.n)
    return PeriodicColouring(repeat, colour)

"""Designs of one closed stroke."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, from_plane, plane
from voronoi_tiles.base.errors import ProofError, TouchingCopiesError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.drawn_site import Site
from voronoi_tiles.designs.drawn_strokes import polyline
from voronoi_tiles.groups.wallpaper import WallpaperGroup
from voronoi_tiles.tiling import Tiling, tessellate

DIGITS: Final = 5
"""Coordinates are written to so many digits of the size, and angles of a degree: a tile of 60 mm to a micrometre."""

MIRRORED_DIGITS: Final = 7
"""The same for strokes that are their own mirror images. Corners of tiles, where edges meet at a small angle, may move
hundreds of times as far as the stroke's."""


def closed_design(
    group: WallpaperGroup, cell: dict[str, float], corners: Complexes, name: str, size: float, digits: int = DIGITS
) -> Design:
    """The design of a closed stroke by its corners, its numbers rounded for people; `size` is that of the tile."""
    places = digits - math.floor(math.log10(size)) - 1
    numbers = {key: round(value, digits if key == "angle" else places + 1) for key, value in cell.items()}
    rounded = np.round(plane(corners), places) + 0.0
    return Design(group, numbers, Site([polyline(rounded, closed=True)], name=name), name=name)


def corners_of(design: Design) -> Complexes:
    """The corners of its stroke: complex128 (n,)."""
    return from_plane(np.array(design.sites[0].strokes[0].table["polyline"], float))


def tiled(design: Design) -> Tiling | None:
    """The tiling of a design whose tile is one piece without holes; None where it is not, or copies touch."""
    try:
        tiling = tessellate(design)
    except (TouchingCopiesError, ProofError):
        return None
    return tiling if len(tiling[0].outline.ring_offsets) == 2 else None

"""Closed paths of drawings as the edges of areas: turned so that the material is on their left, and simple."""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.winding import item_winding

_FLAT: Final = 1e-6
"""How far chords are from the paths when these are judged, relative to their extent."""


def oriented(rings: Paths) -> Paths:
    """Turn rings so that those inside an even number of others run counter-clockwise, and come first, others clockwise.

    Rings without area are left out.
    """
    rings = rings.take(np.flatnonzero(ring_areas(rings)))
    if not len(rings):
        return rings
    points = rings.start[rings.offsets[:-1]]
    inside = np.abs(item_winding(rings, rings.offsets, points)) % 2
    np.fill_diagonal(inside, 0)
    depth: Ints = inside.sum(axis=0)
    turn = (ring_areas(rings) > 0) != (depth % 2 == 0)
    return rings.reversed(turn).take(np.argsort(depth % 2, kind="stable"))


def simple(rings: Paths) -> bool:
    """Whether no ring crosses or touches itself or another one, as far as chords tell."""
    import shapely

    if not len(rings):
        return True
    x0, y0, x1, y1 = rings.bounds
    lines = to_lines(rings, accuracy=_FLAT * max(x1 - x0, y1 - y0))
    loops = np.array(
        [
            shapely.LinearRing(np.column_stack((points.real, points.imag)))
            for points in np.split(lines.start, lines.offsets[1:-1])
        ],
        dtype=np.object_,
    )
    if not shapely.is_simple(loops).all():
        return False
    one, two = shapely.STRtree(loops).query(loops, predicate="intersects")
    return bool((one == two).all())

"""The narrowest place of a tile."""

from __future__ import annotations

from typing import Final

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.preflight.chords import chords_of, counts_of
from voronoi_tiles.preflight.necks import find_necks
from voronoi_tiles.vector.outline import Outline

ACCURACY: Final = 2.5e-4
"""How far the chords between which necks are measured lie from the outline; relative to the tile's diagonal."""


def narrowest(outline: Outline) -> float:
    """The width of a tile where it is narrowest, in the outline's units: that of its smallest neck.

    A neck is a place where two parts of the outline face each other across the tile, and are nowhere near it closer. At
    corners, however sharp, there is none; a tile without a neck is as wide as the narrowest strip that holds it, and
    none is wider. Within twice ACCURACY of the tile's diagonal, below which no neck is told from a corner.
    """
    low_x, low_y, high_x, high_y = outline.bounds
    size = float(np.hypot(high_x - low_x, high_y - low_y))
    accuracy = ACCURACY * size
    chords = chords_of(outline.paths, counts_of(outline.paths, accuracy), 1e-9 * size)
    necks = find_necks(chords, 2 * accuracy, size)
    return min([_width(chords.start), *(neck.width for neck in necks if neck.material)])


def _width(points: Complexes) -> float:
    """The width of the narrowest strip that holds points: one of its sides lies along a side of their hull."""
    hull = shapely.get_coordinates(shapely.convex_hull(shapely.multipoints(plane(points))))
    corners = hull[:-1] @ (1, 1j)
    sides = np.roll(corners, -1) - corners
    across = ((corners[:, None] - corners) * (sides / np.abs(sides)).conj()).imag
    return float(np.ptp(across, axis=0).min())

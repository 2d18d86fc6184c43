"""A silhouette drawn apart from its copies: a stroke whose Voronoi tile is as near to it as tiles can be."""

from __future__ import annotations

from typing import Final

import numpy as np
import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.escherization.covering import laid_out
from voronoi_tiles.escherization.goal_outline import GoalOutline
from voronoi_tiles.escherization.group_placement import GroupPlacement

APART: Final = 5e-3
"""How far the stroke keeps from the silhouette's outline, and from copies; relative to the size. Less makes tiles of
more and smaller edges, and brings them nearer by less than a thousandth."""

_CORNERS: Final = 0.3
"""How far corners that are left out of the stroke may lie from it; relative to APART."""


def drawn_apart(silhouette: GoalOutline, placement: GroupPlacement) -> Complexes:
    """The corners of a closed stroke inside the placed silhouette, and outside of all copies: complex128 (n,).

    What the silhouette has in common with copies is taken from both, so that the edge between their tiles is the middle
    line of it, as it is that of what lies between them: all share alike. Where that divides the silhouette, the largest
    part is left.
    """
    apart = APART * silhouette.size
    own, copies = laid_out(silhouette, placement, further=2.0 * apart)
    near = [copy for copy in copies if copy.distance(own) <= 2.0 * apart]
    inside: BaseGeometry = own.buffer(-apart).difference(shapely.union_all(near).buffer(apart))
    parts = [part for part in shapely.get_parts(inside) if part.geom_type == "Polygon"]
    if not parts:
        return np.zeros(0, complex)
    largest: Polygon = max(parts, key=lambda part: part.area)
    exterior = Polygon(largest.exterior).simplify(_CORNERS * apart).exterior
    return np.asarray(shapely.get_coordinates(exterior)[:-1] @ np.array([1.0, 1j]))

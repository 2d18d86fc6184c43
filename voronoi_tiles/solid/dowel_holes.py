"""Holes for dowels: where they lie within a tile at all heights."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.fabrication.job import JobError
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.solid.face_triangles import polygons

WALL_MM: Final = 1.0
"""What stays around a hole at least, millimetres, where half of its diameter is less."""

_CHORDS: Final = 1e-4
"""How far chords of outlines are from these; a share of the hole's diameter."""

_QUARTER: Final = 16
"""The chords of a quarter of a circle by which a tile is drawn in."""

_TRIES: Final = 40
"""How often the thickest dowel that has room is halved in on; a count."""


def wall_of(diameter: float) -> float:
    """What stays around a hole at least; millimetres."""
    return max(WALL_MM, diameter / 2)


def place_holes(name: str, outlines: Sequence[Paths], diameter: float) -> Complexes:
    """The centres of two holes, complex128 (2,), that lie within all outlines of a tile, as far apart as they can.

    Outlines are its rings in each sheet, in millimetres. Around a hole stays half of its diameter, or WALL_MM. Raises
    JobError, which names the tile, where there is no room, or it is in parts.
    """
    import shapely

    if any((ring_areas(rings) > 0.0).sum() > 1 for rings in outlines):
        raise JobError(
            f"the tile of \"{name}\" is in parts, and two holes with `dowel='{diameter:g}mm'` hold one of them",
            remedy="Leave it out, or join the strokes.",
        )
    common = shapely.intersection_all([_filled(rings, _CHORDS * diameter) for rings in outlines])
    found = _farthest(common, diameter)
    if found is not None:
        return found
    low, high = 0.0, diameter
    for _ in range(_TRIES):
        middle = (low + high) / 2
        low, high = (low, middle) if _farthest(common, middle) is None else (middle, high)
    sheets = f"in all {len(outlines)} sheets" if len(outlines) > 1 else "in the sheet"
    thickest = np.floor(low * 100) / 100
    raise JobError(
        f"two holes with `dowel='{diameter:g}mm'` have no room that lies within the tile of \"{name}\" {sheets}",
        remedy=f"Use {thickest:g} mm at most, or a larger design."
        if thickest > 0.0
        else "Use more height, a smaller motion, a larger design, or leave it out.",
    )


def _filled(rings: Paths, accuracy: float) -> Any:
    """What rings bound, as chords, drawn in by as much as these may be off."""
    import shapely

    lines = to_lines(rings, accuracy=accuracy)
    points = plane(lines.start)
    parts = polygons(lines.start, lines.offsets)
    shape = shapely.MultiPolygon([(points[loops[0]], [points[hole] for hole in loops[1:]]) for loops in parts])
    return shape.buffer(-accuracy)


def _farthest(common: Any, diameter: float) -> Complexes | None:
    """The centres of two holes that are farthest from each other; None where two have no room."""
    import shapely

    # The circles that a tile is drawn in by are polygons within the true ones.
    inset = (diameter / 2 + wall_of(diameter)) / cos(pi / (4 * _QUARTER))
    room = common.buffer(-inset, quad_segs=_QUARTER)
    if room.is_empty:
        return None
    x, y = shapely.get_coordinates(room.convex_hull).T
    corners = x + 1j * y
    apart = np.abs(corners[:, None] - corners)
    one, other = np.unravel_index(int(apart.argmax()), apart.shape)
    if apart[one, other] < diameter + wall_of(diameter):
        return None
    return np.asarray(corners[[one, other]])

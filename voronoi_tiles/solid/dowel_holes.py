"""Holes for dowels: where they lie within a tile at all heights, and sheets that have them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from math import cos, pi
from typing import Any, Final, Self

import numpy as np

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.fabrication.job import JobError
from voronoi_tiles.fabrication.layout import Contours, Layout
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import ARC, Paths
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


@dataclass(frozen=True, eq=False)
class BoredLayout(Layout):
    """A layout of one of each tile whose pieces have holes: `holes` are the centres in each site, where it is drawn.

    Each is complex128 (n,), in millimetres; `diameter` is what holes have when they are cut.
    """

    holes: tuple[Complexes, ...] = ()
    diameter: float = 0.0

    @classmethod
    def of(cls, layout: Layout, holes: Sequence[Complexes], diameter: float) -> Self:
        """A layout with holes."""
        own = {field.name: getattr(layout, field.name) for field in fields(Layout)}
        return cls(**own, holes=tuple(holes), diameter=diameter)

    @cached_property
    def contours(self) -> Contours:
        """The closed contours of all pieces, the holes among them, which lose what the kerf adds."""
        plain = super().contours
        radius = (self.diameter - self.job.kerf) / 2
        turn = self.tiles.page.factor / abs(self.tiles.page.factor)
        parts, counts, left = [], [], plain.area.copy()
        for k, copy in enumerate(plain.copy.tolist()):
            rings = plain.paths.take(np.arange(plain.items[k], plain.items[k + 1]))
            own = self.holes[int(self.site[copy])]
            centres = own * turn + self.tiles.page.shift + self.copies.moved_by[copy]
            parts += [rings, circles(centres, radius)]
            counts.append(len(rings) + len(own))
            left[k] -= len(own) * pi * self.diameter**2 / 4
        items = np.append(0, np.cumsum(counts)).astype(np.intp)
        return Contours(Paths.concatenate(parts), items, plain.copy, left)


def circles(centres: Complexes, radius: float) -> Paths:
    """Circles as holes are: clockwise, of two arcs each."""
    start = np.column_stack((centres + radius, centres - radius)).ravel()
    end = np.column_stack((centres - radius, centres + radius)).ravel()
    control = np.zeros((len(start), 2), np.complex128)
    control[:, 0] = np.column_stack((centres - 1j * radius, centres + 1j * radius)).ravel()
    return Paths(
        start,
        end,
        control,
        np.full(len(start), ARC, np.uint8),
        2 * np.arange(len(centres) + 1),
        np.ones(len(centres), np.bool_),
    )

"""The outline that a tile is to come near to: one closed line that does not cross itself."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
import shapely
from shapely.geometry import LinearRing, Polygon
from shapely.geometry.base import BaseGeometry

from voronoi_tiles.base.arrays import Complexes, from_plane, plane
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.base.values import shown

DETAIL: Final = 5e-4
"""How far the corners that are left out of an outline may lie from it; relative to the square root of its area. A tenth
of the width of a laser's cut in a tile of 60 mm, and what no placement depends on."""

_THIN_MAX: Final = 12.0
"""How far an outline may reach from its centre; relative to the square root of its area. A strip 300 times as long as
it is wide; transforms of longer ones need gigabytes."""

_REMEDY: Final = "Give a shapely Polygon, a tile, or the corners of a closed outline."


@dataclass(frozen=True, eq=False)
class GoalOutline:
    """A closed outline, in millimetres: its corners (complex128, n), counter-clockwise, the first one not repeated."""

    points: Complexes

    @classmethod
    def of(cls, outline: Any) -> GoalOutline:
        """The silhouette of a shapely polygon, of anything with its interface, such as a Tile, or of corners.

        Corners that lie on the outline without them, within DETAIL, are left out. Raises ArgumentError for an outline
        that crosses itself, has holes or several parts, no area, or is a line.
        """
        polygon = _polygon(outline)
        if polygon.geom_type == "MultiPolygon" and len(polygon.geoms) == 1:
            polygon = polygon.geoms[0]
        if polygon.geom_type != "Polygon":
            what = "several outlines" if polygon.geom_type == "MultiPolygon" else f"a {polygon.geom_type}"
            raise ArgumentError(f"`outline` is {what}, not one closed outline", remedy="Give one at a time.")
        coordinates = shapely.get_coordinates(polygon)
        if not len(coordinates):
            raise ArgumentError("`outline` is empty", remedy=_REMEDY)
        if not (np.abs(coordinates) <= COORDINATE_MAX).all():
            raise ArgumentError(f"`outline` has coordinates beyond {COORDINATE_MAX:g}", remedy="Give millimetres.")
        if len(polygon.interiors):
            raise ArgumentError("`outline` has holes, which no tile of one stroke has", remedy="Give its exterior.")
        if not polygon.is_valid:
            raise ArgumentError(
                f"`outline` cannot be: {_why(polygon)}",
                remedy="Draw one line around the shape that does not cross itself.",
            )
        size = float(np.sqrt(polygon.area))
        if not size > 1e-9 * float(np.ptp(coordinates, axis=0).max()):
            raise ArgumentError("`outline` encloses no area", remedy="Draw one line around the shape.")
        exterior = shapely.orient_polygons(_simplified(polygon, DETAIL * size)).exterior
        made = cls(ring_corners(exterior))
        if not made.reach <= _THIN_MAX * size:
            raise ArgumentError("`outline` is too thin: a line rather than a shape", remedy="Draw around its area.")
        return made

    @cached_property
    def polygon(self) -> Polygon:
        """The outline as a shapely polygon."""
        polygon = Polygon(plane(self.points))
        shapely.prepare(polygon)
        return polygon

    @property
    def area(self) -> float:
        """The area that it encloses, in square millimetres."""
        return float(self.polygon.area)

    @property
    def size(self) -> float:
        """The side of a square of its area, in millimetres: what lengths are relative to."""
        return float(np.sqrt(self.area))

    @property
    def centroid(self) -> complex:
        """The centre of its area."""
        return complex(self.polygon.centroid.x, self.polygon.centroid.y)

    @cached_property
    def reach(self) -> float:
        """How far its corners lie from its centroid, at most; in millimetres."""
        return float(np.abs(self.points - self.centroid).max())

    @property
    def width(self) -> float:
        """The shorter side of the smallest rectangle around it, in millimetres."""
        corners = from_plane(shapely.get_coordinates(shapely.minimum_rotated_rectangle(self.polygon)))
        return float(np.abs(np.diff(corners[:3])).min())

    @property
    def longer_side(self) -> float:
        """The longer side of the upright rectangle around it, in millimetres."""
        return float(max(np.ptp(self.points.real), np.ptp(self.points.imag)))

    def scaled(self, factor: float) -> GoalOutline:
        """The outline so many times as large, about the origin."""
        return GoalOutline(self.points * factor)

    @cached_property
    def unit(self) -> GoalOutline:
        """The same outline with its centroid in the origin and an area of 1."""
        return GoalOutline((self.points - self.centroid) / self.size)


def ring_corners(ring: LinearRing) -> Complexes:
    """The corners of a ring, the first not repeated: complex128 (n,)."""
    return from_plane(shapely.get_coordinates(ring)[:-1])


def largest_part(geometry: BaseGeometry) -> Polygon:
    """The largest of the polygons of a geometry; an empty one where there is none."""
    parts = [part for part in shapely.get_parts(geometry) if part.geom_type == "Polygon"]
    return max(parts, key=lambda part: part.area, default=Polygon())


def _polygon(outline: Any) -> Any:
    """What was given, as geometry of shapely. Raises ArgumentError."""
    if isinstance(outline, shapely.Geometry):
        return outline
    try:
        if hasattr(outline, "__geo_interface__"):
            return shapely.geometry.shape(outline)
        if isinstance(outline, Iterable) and not isinstance(outline, str | bytes):
            corners = np.asarray(list(outline))
            corners = plane(corners) if np.iscomplexobj(corners) else corners.astype(float)
            if np.isfinite(corners).all():
                return Polygon(corners)
    except (TypeError, ValueError, KeyError, AttributeError):
        pass
    raise ArgumentError(f"`outline` {shown(outline)} cannot be", remedy=_REMEDY)


def _simplified(polygon: Polygon, distance: float) -> Polygon:
    """A valid polygon with fewer corners, within a distance, or a part of it where it would cross itself.

    What keeps to that from the start takes minutes for 100,000 corners.
    """
    for _ in range(6):
        simple = shapely.simplify(polygon, distance, preserve_topology=False)
        if simple.geom_type == "Polygon" and simple.is_valid and not simple.is_empty:
            return simple
        distance /= 4.0
    return polygon


def _why(polygon: Polygon) -> str:
    """What is wrong with a polygon, in our words: "it crosses itself at 12, 7.5"."""
    reason, _, place = str(shapely.is_valid_reason(polygon)).partition("[")
    where = ", ".join(f"{float(number):.6g}" for number in place.rstrip("]").split()[:2])
    return {"Self-intersection": "it crosses itself", "Ring Self-intersection": "it meets itself"}.get(
        reason, reason[:1].lower() + reason[1:]
    ) + (f" at {where}" if where else "")

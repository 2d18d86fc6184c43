"""How far two outlines are from each other."""

from __future__ import annotations

import numpy as np
import shapely
from shapely.geometry import LinearRing, Polygon

from voronoi_tiles.base.arrays import Complexes, Floats, from_plane, plane


def overlap(one: Polygon, other: Polygon) -> float:
    """The area that two polygons have in common over that of their union."""
    return float(one.intersection(other).area / one.union(other).area)


def largest_distance(one: LinearRing, other: LinearRing, step: float) -> float:
    """How far a point of one outline may be from the other (Hausdorff's distance), sampled every `step`.

    It is at most half a step more than what is found.
    """
    return max(_furthest(one, other, step), _furthest(other, one, step))


def _furthest(one: LinearRing, other: LinearRing, step: float) -> float:
    """How far the points of an outline are from another at most."""
    shapely.prepare(other)
    points = shapely.points(shapely.get_coordinates(shapely.segmentize(one, step)))
    return float(np.max(shapely.distance(points, other)))


def nearest_on(ring: LinearRing, points: Complexes) -> Complexes:
    """The points of an outline that are nearest to given points: complex128 (n,)."""
    places = shapely.points(plane(points))
    return from_plane(
        shapely.get_coordinates(shapely.line_interpolate_point(ring, shapely.line_locate_point(ring, places)))
    )


def towards(points: Complexes, normals: Complexes, ring: LinearRing) -> Floats:
    """How far the nearest points of an outline are from given points, along their normals: float64 (n,)."""
    return np.asarray(((nearest_on(ring, points) - points) * normals.conj()).real)

"""Bottoms and tops of solids: outlines of vertices, filled with triangles that have no other vertices."""

from __future__ import annotations

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Complexes, Ints, counting, plane
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.levels import VertexChains
from voronoi_tiles.vector.complex.representatives import Points


def outline_of(layer: ExactLayer, chains: VertexChains, tile: int) -> list[Points]:
    """The rings of a base tile as vertices, each once."""
    found = []
    for ring in range(*layer.tile_offsets[tile : tile + 2].tolist()):
        uses = np.arange(*layer.ring_offsets[ring : ring + 2])
        edge = layer.edge[uses]
        counts = chains.counts[edge] - 1
        step, owner = counting(counts)
        at = np.where(layer.backwards[uses][owner], counts[owner] - step, step)
        found.append(chains.points.take(chains.offsets[edge][owner] + at).moved(layer.motion[uses][owner]))
    return found


def cap(rings: list[Complexes]) -> Ints:
    """Triangles that fill rings of points, intp (n, 3): numbers of points, ring after ring, counter-clockwise.

    Rings that run counter-clockwise are outer ones, others are holes. Each part is filled by itself: where parts touch,
    points are told apart by their numbers.
    """
    polygons = [shapely.Polygon(plane(ring)) for ring in rings]
    outer = [k for k, polygon in enumerate(polygons) if polygon.exterior.is_ccw]
    first, found = np.cumsum([0, *map(len, rings)]), []
    for k in outer:
        inside = [h for h in range(len(rings)) if h not in outer and _is_within(polygons[h], polygons[k])]
        numbers = np.concatenate([np.arange(first[ring], first[ring + 1]) for ring in (k, *inside)])
        points = np.concatenate([rings[ring] for ring in (k, *inside)])
        found.append(numbers[_filled(shapely.Polygon(plane(rings[k]), [plane(rings[h]) for h in inside]), points)])
    return np.concatenate(found)


def _is_within(hole: shapely.Polygon, outer: shapely.Polygon) -> bool:
    return bool(outer.contains(hole.representative_point()))


def _filled(polygon: shapely.Polygon, points: Complexes) -> Ints:
    """Triangles that fill a polygon of these points, counter-clockwise."""
    number = {at: k for k, at in enumerate(points.tolist())}
    corners = shapely.get_coordinates(shapely.constrained_delaunay_triangles(polygon)).reshape(-1, 4, 2)[:, :3]
    at = corners[..., 0] + 1j * corners[..., 1]
    triangles = np.array([number[z] for z in at.ravel().tolist()], np.intp).reshape(-1, 3)
    a, b, c = points[triangles].T
    clockwise = ((b - a).conj() * (c - a)).imag < 0
    triangles[clockwise] = triangles[clockwise][:, [0, 2, 1]]
    return triangles

"""Tiles as closed meshes of polygons, for a picture: each face one polygon where the tile has no hole."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Ints, next_in_ring, offsets_of, plane
from voronoi_tiles.solid.prism import Face, Prism
from voronoi_tiles.vector.outline import Outline


class PolygonMesh(NamedTuple):
    """A mesh: `vertices` float32 (n, 3) in units, and polygons, counter-clockwise from outside.

    Polygon k has the vertices `corners[starts[k] : starts[k + 1]]`, intp; the last start is the number of corners.
    """

    vertices: NDArray[np.float32]
    corners: NDArray[np.int32]
    starts: NDArray[np.int32]


def polygon_prism(outline: Outline, pivot: complex, height: float, accuracy: float, *, mirrored: bool) -> PolygonMesh:
    """The prism over a tile, about a `pivot`, whose walls are within `accuracy` of it; `mirrored` turned over in y.

    Lengths are in the outline's units. Without holes it needs numpy alone.
    """
    rings = [ring - pivot for ring in outline.flatten(accuracy=accuracy)]
    if mirrored:  # so that the tile stays on the left
        rings = [ring.conj()[::-1] for ring in rings]
    points, offsets = np.concatenate(rings), offsets_of([len(ring) for ring in rings])
    count = len(points)
    vertices = np.zeros((2 * count, 3), np.float32)
    vertices[:, :2] = np.tile(plane(points), (2, 1))
    vertices[count:, 2] = height
    if min(outline.ring_areas) < 0.0:
        triangles = Prism.over(Face(points, offsets, outline.area), height).triangles
        return triangle_polygons(vertices, triangles)
    after = next_in_ring(offsets)
    here = np.arange(count)
    walls = np.column_stack((here, after, after + count, here + count)).ravel()
    below = [np.arange(a, b)[::-1] for a, b in zip(offsets[:-1].tolist(), offsets[1:].tolist(), strict=True)]
    faces = [*below, *(ring[::-1] + count for ring in below)]
    corners = np.concatenate([walls, *faces])
    sizes = np.concatenate([np.full(count, 4), [len(face) for face in faces]])
    return PolygonMesh(vertices, corners.astype(np.int32), offsets_of(sizes).astype(np.int32))


def triangle_polygons(vertices: NDArray[np.floating[Any]], triangles: Ints) -> PolygonMesh:
    """Triangles, intp (m, 3), as polygons; their vertices in single precision."""
    starts = np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int32)
    return PolygonMesh(vertices.astype(np.float32), triangles.astype(np.int32).ravel(), starts)

"""Sections of solids by level planes: rings of points, with the material on their left, and the region they bound."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.solid.face_triangles import filled
from voronoi_tiles.solid.mesh import TriangleMesh

if TYPE_CHECKING:
    import shapely


def section(mesh: TriangleMesh, z: float) -> Paths:
    """What a level plane cuts out of a closed mesh: closed paths of LINEs in millimetres.

    The level is that of no vertex. Raises ProofError where the mesh is open there.
    """
    above = mesh.vertices[:, 2] > z
    over = above[mesh.triangles]
    crossed = over.any(axis=1) & ~over.all(axis=1)
    triangles, over = mesh.triangles[crossed], over[crossed]
    if not len(triangles):
        return Paths.empty()
    ahead = np.roll(over, -1, axis=1)
    # Seen from outside a triangle is crossed to the left of the side that rises, which the next one has falling.
    count = len(mesh.vertices)
    every = np.arange(len(triangles))
    up, down = (~over & ahead).argmax(axis=1), (over & ~ahead).argmax(axis=1)
    rising = triangles[every, up] * count + triangles[every, (up + 1) % 3]
    falling = triangles[every, (down + 1) % 3] * count + triangles[every, down]
    order = np.argsort(falling)
    if (np.sort(rising) != falling[order]).any():
        raise ProofError(f"a solid is open at a height of {z:.6g} mm")
    after = order[np.searchsorted(falling[order], rising)]
    low, high = mesh.vertices[falling // count], mesh.vertices[falling % count]
    share = (z - low[:, 2]) / (high[:, 2] - low[:, 2])
    point = (low + share[:, None] * (high - low))[:, :2].copy().view(np.complex128)[:, 0]
    rings, left, following = [], set(every.tolist()), after.tolist()
    while left:
        start = triangle = min(left)
        ring = []
        while triangle in left:
            left.remove(triangle)
            ring.append(triangle)
            triangle = following[triangle]
        if triangle != start:
            raise ProofError(f"a solid is open at a height of {z:.6g} mm")
        rings.append(point[ring])
    return Paths.polylines([ring.tolist() for ring in rings], closed=True)


def filled_section(mesh: TriangleMesh, z: float) -> shapely.MultiPolygon:
    """What `section` cuts out as a region, in millimetres; raises as that does."""
    rings = section(mesh, z)
    return filled(rings.start, rings.offsets)

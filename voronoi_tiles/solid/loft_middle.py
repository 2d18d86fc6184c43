"""What lies between two levels of a loft: its walls there, and the rings in which they begin and end."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.solid.mesh import TriangleMesh


class LoftMiddle(NamedTuple):
    """The walls of a solid between two levels, an open mesh, and their rings as numbers of its vertices.

    The rings at the `bottom` and at the `top` have the material on their left.
    """

    mesh: TriangleMesh
    bottom: tuple[Ints, ...]
    top: tuple[Ints, ...]

    @classmethod
    def of(cls, mesh: TriangleMesh, low: float, high: float) -> Self:
        """The walls of a solid between two heights at which it has vertices; no triangle crosses these."""
        corners = mesh.vertices[:, 2][mesh.triangles]
        lowest, highest = corners.min(axis=1), corners.max(axis=1)
        triangles = mesh.triangles[(lowest >= low) & (highest <= high) & (lowest < highest)]
        kept, number = np.unique(triangles, return_inverse=True)
        part = TriangleMesh(mesh.vertices[kept], number.reshape(-1, 3))
        sides = np.concatenate([part.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
        count = len(kept)
        lone = ~np.isin(sides[:, 0] * count + sides[:, 1], sides[:, 1] * count + sides[:, 0])
        after = dict(sides[lone].tolist())
        at_bottom = part.vertices[:, 2] == low
        rings: tuple[list[Ints], list[Ints]] = ([], [])
        while after:
            ring = [first := next(iter(after))]
            while (following := after.pop(ring[-1])) != first:
                ring.append(following)
            # Seen from outside the upper rings run the other way.
            rings[0 if at_bottom[first] else 1].append(np.array(ring if at_bottom[first] else ring[::-1], np.intp))
        return cls(part, tuple(rings[0]), tuple(rings[1]))

    def points(self, ring: Ints) -> Complexes:
        """The points of a ring, complex128 (n,)."""
        return np.asarray(self.mesh.vertices[ring, :2].copy().view(np.complex128)[:, 0])

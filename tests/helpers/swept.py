"""Whether a solid that moves meets those that stand, by manifold3d: what both have in common at some distances."""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import Any

import manifold3d
import numpy as np

from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.solid.loft import Loft
from voronoi_tiles.solid.mesh import TriangleMesh

Box = tuple[Floats, Floats]


def solid_of(mesh: TriangleMesh) -> Any:
    """The solid as manifold3d takes it: with 64 bits, and nothing merged."""
    return manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices, mesh.triangles.astype(np.uint64)))


def centre_of(mesh: TriangleMesh) -> complex:
    """Where the centre of a solid's volume is as seen from above: of the tetrahedra that its triangles span."""
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    volumes = np.linalg.det(np.stack((a, b, c), axis=1))
    return complex(*(((a + b + c) * volumes[:, None]).sum(axis=0) / (4 * volumes.sum()))[:2])


@dataclass(frozen=True)
class Crowd:
    """A tile of a loft, as drawn, and copies in all cells around: their solids, boxes and places, by brute force."""

    own: Any
    size: float
    box: Box
    others: tuple[tuple[Any, Box, complex], ...]

    @classmethod
    def about(cls, loft: Loft, site: int, cells: int = 3) -> Crowd:
        """All copies within so many cells."""
        meshes, seen, others = loft.meshes, set(), []
        lattice, unit = loft.design.lattice, loft.design.unit_mm
        middle = centre_of(meshes[site])
        seen.add(tuple(np.sort(np.round(meshes[site].vertices, 6), axis=0).ravel().tolist()))
        for other in range(len(meshes)):
            for operation in loft.design.group.operations:
                image = loft.image(other, operation)
                solid = solid_of(image)
                for i in range(-cells, cells + 1):
                    for j in range(-cells, cells + 1):
                        shift = (i * lattice.a + j * lattice.b) * unit
                        moved = TriangleMesh(image.vertices + np.array([shift.real, shift.imag, 0.0]), image.triangles)
                        key = tuple(np.sort(np.round(moved.vertices, 6), axis=0).ravel().tolist())
                        if key not in seen:
                            seen.add(key)
                            box = (moved.vertices.min(axis=0), moved.vertices.max(axis=0))
                            others.append(
                                (solid.translate((shift.real, shift.imag, 0.0)), box, centre_of(moved) - middle)
                            )
        mesh = meshes[site]
        box = (mesh.vertices.min(axis=0), mesh.vertices.max(axis=0))
        # What is met is mostly one of the nearest.
        nearest = tuple(sorted(others, key=lambda other: abs(other[2])))
        return cls(solid_of(mesh), float(np.ptp(mesh.vertices, axis=0).max()), box, nearest)

    def behind(self, degrees: float | None) -> list[tuple[Any, Box]]:
        """The copies that stand when the tile goes in, where rows follow each other in a direction; all with None."""
        if degrees is None:
            return [(solid, box) for solid, box, _ in self.others]
        back = cmath.rect(1, -np.radians(degrees))
        return [(solid, box) for solid, box, away in self.others if (away * back).real <= 1e-7 * self.size]

    def meets(self, standing: list[tuple[Any, Box]], shift: Floats, more_than: float) -> bool:
        """Whether the tile, moved, has more than so much of its volume in common with one of those that stand."""
        low, high = self.box[0] + shift, self.box[1] + shift
        own, limit = self.own.translate(tuple(shift)), more_than * float(self.own.volume())
        near = (solid for solid, box in standing if (box[0] < high).all() and (box[1] > low).all())
        return any(float((own ^ solid).volume()) > limit for solid in near)

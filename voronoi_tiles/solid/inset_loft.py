"""Lofts that are drawn in: their levels, the walls between, and their meshes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Ints, plane
from voronoi_tiles.base.maps import move
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.solid.assembly import LoftLevel
from voronoi_tiles.solid.inset_depth import InsetDepth
from voronoi_tiles.solid.inset_rings import InsetRing
from voronoi_tiles.solid.inset_walls import InsetWall
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.loft import Loft
from voronoi_tiles.solid.loft_caps import cap
from voronoi_tiles.solid.loft_middle import LoftMiddle
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.vector.motions import to_motion


@dataclass(frozen=True, eq=False)
class InsetLevel:
    """A level of a loft at `z` millimetres with the `rings` of its tiles, drawn in, each in the order of the loft's."""

    level: LoftLevel
    z: float
    rings: tuple[tuple[InsetRing, ...], ...]


@dataclass(frozen=True, eq=False)
class InsetSlab:
    """What lies between two levels: for each tile its walls, from ring k of the lower level to ring `above[k]`.

    `middle` is the exact layer half way up, None where there are no walls but the loft's own.
    """

    walls: tuple[tuple[InsetWall, ...], ...]
    above: tuple[tuple[int, ...], ...]
    middle: ExactLayer | None


@dataclass(frozen=True, eq=False)
class InsetLoft:
    """The solids of a loft's sites, drawn in by a `depth`; they have levels of their own besides the loft's.

    Without a clearance what lies between the rims is `kept` as it is: a part for each site. `notes` are sentences on
    what tiles lose.
    """

    loft: Loft
    depth: InsetDepth
    kept: tuple[LoftMiddle, ...]
    levels: tuple[InsetLevel, ...]
    slabs: tuple[InsetSlab, ...]
    notes: tuple[str, ...]

    @cached_property
    def meshes(self) -> tuple[TriangleMesh, ...]:
        """The mesh of each site, in millimetres."""
        return tuple(self._mesh(tile) for tile in range(len(self.loft.tiles)))

    def image(self, site: int, operation: Operation | str) -> TriangleMesh:
        """The mesh of the copy of a site's solid under an operation of the group, in millimetres."""
        parsed = Operation.parse(operation) if isinstance(operation, str) else operation
        turn, shift, conj = self.loft.levels[0].core.action.isometry(to_motion(parsed))
        own = self.meshes[site]
        places = move(own.vertices[:, 0] + 1j * own.vertices[:, 1], turn, shift * self.loft.design.unit_mm, conj)
        triangles = own.triangles[:, ::-1] if conj else own.triangles
        return TriangleMesh(np.column_stack((plane(places), own.vertices[:, 2])), triangles)

    def _mesh(self, tile: int) -> TriangleMesh:
        """The mesh of a site: rings, walls between them, what is kept of the loft, and a bottom and a top."""
        kept = self.kept[tile].mesh if self.kept else TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp))
        points, triangles, count = [kept.vertices], [kept.triangles], len(kept.vertices)
        numbers: list[list[Ints]] = []
        for level in self.levels:
            numbers.append([])
            for ring in level.rings[tile]:
                if ring.number is None:
                    points.append(np.column_stack((plane(ring.points), np.full(len(ring.points), level.z))))
                numbers[-1].append(count + np.arange(len(ring.points)) if ring.number is None else ring.number)
                count += len(ring.points) if ring.number is None else 0
        for slab, low, high in zip(self.slabs, numbers, numbers[1:], strict=False):
            for wall, one, two in zip(slab.walls[tile], low, slab.above[tile], strict=False):  # kept ones have none
                triangles.append(np.concatenate((one, high[two]))[wall.triangles])
        for k, sense in ((0, -1), (-1, 1)):
            own = cap([ring.points for ring in self.levels[k].rings[tile]])
            triangles.append(np.concatenate(numbers[k])[own[:, ::sense]])
        return TriangleMesh(np.concatenate(points), np.concatenate(triangles))

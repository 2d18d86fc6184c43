"""Solids of a drawn tiling as meshes, each where its tile is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from voronoi_tiles.blender.drawn_tiling import DrawnTiling
from voronoi_tiles.blender.polygon_mesh import PolygonMesh, triangle_polygons
from voronoi_tiles.designs.drawn_solid import Solid
from voronoi_tiles.solid.extrusion import extrude
from voronoi_tiles.solid.slab import Slab
from voronoi_tiles.solid.solid_job import SolidJob
from voronoi_tiles.solid.solid_model import SolidModel
from voronoi_tiles.solid.standing import stand
from voronoi_tiles.tiling import tessellate


class PlacedSolids(NamedTuple):
    """One solid of each site: the names of the sites, and the meshes, in units; and what was proved, in a line."""

    names: tuple[str, ...]
    meshes: tuple[PolygonMesh, ...]
    proved: str


def solid_model(drawn: DrawnTiling, unit_mm: float, job: SolidJob | None, solid: Solid | None) -> SolidModel:
    """The solids of a drawn tiling in millimetres, prisms by a job or the loft of `solid` (in units).

    Raises VoronoiTilesError where they cannot be made.
    """
    design = drawn.design(unit_mm, solid)
    return extrude(tessellate(design), job) if solid is None else stand(design)


def placed_solids(drawn: DrawnTiling, unit_mm: float, job: SolidJob, solid: Solid | None) -> PlacedSolids:
    """The same, each where its tile is."""
    model = solid_model(drawn, unit_mm, job, solid)
    corner = _prism_corner(drawn, unit_mm, job) if solid is None else _loft_corner(drawn, unit_mm, model)
    meshes = []
    for piece in model.pieces:
        vertices = (piece.mesh.vertices - [corner.real, corner.imag, 0.0]) / unit_mm
        meshes.append(triangle_polygons(vertices, piece.mesh.triangles))
    return PlacedSolids(tuple(piece.site for piece in model.pieces), tuple(meshes), model.proved)


def _prism_corner(drawn: DrawnTiling, unit_mm: float, job: SolidJob) -> complex:
    """By what prisms are moved in their model, which lies where no coordinates are negative; millimetres."""
    tiling = tessellate(drawn.design(unit_mm))
    slab = Slab.of(tiling.design, tiling.tessellation, job)
    return slab.corner(slab.prisms()) + slab.layout.tiles.page.shift


def _loft_corner(drawn: DrawnTiling, unit_mm: float, model: SolidModel) -> complex:
    """The same for lofts: by the boxes of their bottoms and of the tiles there; within the loft's accuracy."""
    design = drawn.design(unit_mm)
    bounds = np.array([tile.outline.bounds for tile in tessellate(design)])
    bottoms = np.concatenate([piece.mesh.vertices[piece.mesh.vertices[:, 2] == 0.0] for piece in model.pieces])
    left, bottom = bottoms[:, :2].min(axis=0) - bounds[:, :2].min(axis=0)
    return complex(left, bottom)

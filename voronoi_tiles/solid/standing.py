"""Designs that stand: their lofts as models, alone or with the copies around one, pulled apart for a picture."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arguments import instance
from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.exact import design_recipe
from voronoi_tiles.fabrication.job import JobError
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.solid.cross_sections import filled_section
from voronoi_tiles.solid.inset_depth import InsetDepth
from voronoi_tiles.solid.inset_loft import InsetLoft
from voronoi_tiles.solid.inset_proof import proved_inset
from voronoi_tiles.solid.laying_orders import assembly
from voronoi_tiles.solid.loft import ACCURACY_MM, Loft
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.pieces import SolidPiece
from voronoi_tiles.solid.solid_job import SolidJob
from voronoi_tiles.solid.solid_model import AROUND, SolidModel
from voronoi_tiles.solid.solid_proof import SolidProof, proved_loft
from voronoi_tiles.vector.motion_codes import operation_of

_SHARES: Final = (0.013, 0.257, 0.493, 0.751, 0.987)
"""At these shares of the height it is seen which pieces touch, and whether they are apart: at no layer."""

_APART: Final = 0.16
"""How far pieces are pulled apart at least; a share of the longer side of one."""

_PULLS: Final = tuple(0.1 * k for k in range(2, 11))
"""By these shares of the distance between them it is tried, in turn. Small ones beside a large one may stay nearer."""

_TOUCHING: Final = 1e-6
"""Pieces that are nearer touch; a share of the longer side of one."""

_BESIDE: Final = 2.0
"""Pieces with a clearance are beside each other where they are within so many of it, and of the accuracy; a factor."""


def stand(design: Design, job: SolidJob | None = None, *, around: bool = False, apart: bool = True) -> SolidModel:
    """The solids of a design that stands, proved: one of each site, or one and the copies `around` it.

    Those around it are pulled `apart`, or stand where they do, and are in its coordinates.

    Raises ArgumentError for a design that is flat, JobError where a job asks for what only prisms have, or a clearance
    or chamfer eats a tile, LoftError where copies meet at some height, ProofError where the result fails its proof.
    """
    design = instance("design", design, Design)
    job = SolidJob() if job is None else instance("job", job, SolidJob)
    _refuse_prisms(job)
    names = [site.name for site in design.noded]
    made: Loft | InsetLoft
    losses: tuple[str, ...] = ()
    if job.insets:
        depth = InsetDepth.of(design, job)
        made, drawn = proved_inset(design, depth)
        loft, near, losses = made.loft, _BESIDE * (job.clearance + depth.accuracy), made.notes
        figures, proved = drawn.document(), str(drawn)
    else:
        loft, proof = proved_loft(design, accuracy=ACCURACY_MM if job.accuracy is None else job.accuracy)
        made, near, figures, proved = loft, 0.0, proof.document(), _said(loft, proof)
    if around:
        found = _around(loft, made)
        meshes, colours = _pulled([mesh for _, mesh in found], near, apart=apart)
        sites = [names[site] for site, _ in found]
        notes: tuple[str, ...] = (AROUND,) if apart else ()
    else:
        low = np.min([mesh.vertices.min(axis=0) for mesh in made.meshes], axis=0)
        meshes = [TriangleMesh(mesh.vertices - low, mesh.triangles) for mesh in made.meshes]
        sites, colours, notes = names, list(range(len(names))), ()
    return SolidModel(
        title=f"{design.name} ({design.group.name})",
        pieces=tuple(
            SolidPiece(site, site, colour, mesh) for site, colour, mesh in zip(sites, colours, meshes, strict=True)
        ),
        colours=tuple(f"#{bytes(shade).hex()}" for shade in palette(max(colours) + 1)),
        recipe={**design_recipe(design), "solid": json.dumps(job.recipe(), sort_keys=True)},
        proof={"figures": figures},
        proved=proved,
        notes=(*notes, *losses),
        files=tuple(design.files),
        assembly=partial(assembly, loft),
    )


def _refuse_prisms(job: SolidJob) -> None:
    """Refuse what a loft does not have."""
    for name in job.recipe():
        if name == "height":
            raise JobError("`height` is that of [solid], which the design has", remedy="Change it there.")
        if name not in ("accuracy", "clearance", "chamfer"):
            raise JobError(f"`{name}` is for prisms, and the design has a [solid]", remedy="Leave it out.")


def _said(loft: Loft, proof: SolidProof) -> str:
    """The proof in a line."""
    return (
        f"closed; volume = cell area x height (relative error {proof.volume:.1g}); walls are neighbours', bit for bit; "
        f"{len(loft.levels)} levels within {proof.distance:.1g} of the exact tiles, walls between them within "
        f"{proof.deviation:.2g} mm; copies keep apart at all heights"
    )


def _around(loft: Loft, made: Loft | InsetLoft) -> list[tuple[int, TriangleMesh]]:
    """The solid of the first site and all that touch it at some level: the number of the site, and the mesh."""
    beside = {name for level in loft.levels for ring in level.core.rings[0] for name in ring}
    copies = [(site, made.image(site, operation_of(code))) for site, code in sorted(beside)]
    return [(0, made.meshes[0]), *copies]


def _pulled(meshes: Sequence[TriangleMesh], near: float, *, apart: bool) -> tuple[list[TriangleMesh], list[int]]:
    """Meshes pulled away from the first of them, as little as parts them, and colours that differ where they touch.

    What is nearer than `near` millimetres touches as well. Where they are not to be `apart` they stay.
    """
    import shapely

    low, high = float(meshes[0].vertices[:, 2].min()), float(meshes[0].vertices[:, 2].max())
    levels = [low + share * (high - low) for share in _SHARES]
    shapes = np.array([[filled_section(mesh, z) for z in levels] for mesh in meshes], object)
    centres = np.array([(mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0))[:2] / 2 for mesh in meshes])
    size = float(np.ptp(meshes[0].vertices[:, :2], axis=0).max())
    one, other = np.triu_indices(len(meshes), 1)
    touching = (shapely.distance(shapes[one], shapes[other]) < max(near, _TOUCHING * size)).any(axis=1)
    away = centres - centres[0]
    pull = 0.0
    for pull in _PULLS if apart else ():
        moved = np.array([_moved(row, pull * by) for row, by in zip(shapes, away, strict=True)], object)
        if (shapely.distance(moved[one], moved[other]) > _APART * size).all():
            break
    colours: list[int] = []
    pairs = {pair for pair, meet in zip(zip(one.tolist(), other.tolist(), strict=True), touching, strict=True) if meet}
    for k in range(len(meshes)):
        taken = {colours[j] for j in range(k) if (j, k) in pairs}
        colours.append(next(colour for colour in range(k + 1) if colour not in taken))
    if not apart:
        return list(meshes), colours
    shifts = np.column_stack((pull * away, np.zeros(len(meshes))))
    return [
        TriangleMesh(mesh.vertices + shift, mesh.triangles) for mesh, shift in zip(meshes, shifts, strict=True)
    ], colours


def _moved(shapes: Any, by: Floats) -> list[Any]:
    """Shapes moved."""
    import shapely

    return [shapely.transform(shape, lambda z: z + by) for shape in shapes]

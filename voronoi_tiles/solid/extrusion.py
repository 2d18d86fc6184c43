"""Tiles of a design as prisms: drawn in by half a clearance, with chamfers, one of each or a sheet of them."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arguments import instance
from voronoi_tiles.fabrication.exact import design_recipe
from voronoi_tiles.fabrication.hints import ROOM
from voronoi_tiles.fabrication.job import JobError
from voronoi_tiles.fabrication.layout import Layout
from voronoi_tiles.fabrication.tile_colouring import TileColouring, colour_tiles
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.solid.extrusion_proof import prove_copies, prove_prisms
from voronoi_tiles.solid.pieces import SolidPiece
from voronoi_tiles.solid.prism import Prism
from voronoi_tiles.solid.slab import Slab
from voronoi_tiles.solid.solid_job import SolidJob
from voronoi_tiles.solid.solid_model import AROUND, SolidModel
from voronoi_tiles.tiling import Tiling

TRIANGLES_MAX: Final = 4_000_000
"""Most triangles of a solid; a count. They take about a gigabyte, and no slicer takes more gladly."""


def extrude(tiling: Tiling, job: SolidJob | None = None) -> SolidModel:
    """The tiles of a tiling as prisms, proved: drawn in by half a clearance, with chamfers; one of each, or a sheet.

    Raises JobError where the job cannot be done, or a clearance or chamfer eats a tile; ProofError where what was made
    is not what was asked.

    >>> import voronoi_tiles as vt
    >>> vt.extrude(vt.starter("p4").tessellate(), vt.SolidJob(height="5mm", clearance=0.2))
    <SolidModel: 1 solid, 34.193 x 35.005 x 5 mm, 4.436 cm³, 928 triangles>
    """
    job = SolidJob() if job is None else instance("job", job, SolidJob)
    design = instance("tiling", tiling, Tiling).design
    return _model(Slab.of(design, tiling.tessellation, job), "site" if job.colours == "none" else job.flat.scheme)


def surrounded(tiling: Tiling, job: SolidJob, *, apart: bool = True) -> SolidModel:
    """What shows how solids go together: one and its neighbours, pulled `apart` or where they are; as `extrude`."""
    slab = Slab.of(tiling.design, tiling.tessellation, replace(job, sheet=None, gap=None)).around(apart=apart)
    made = _model(slab, job.flat.scheme)
    return replace(made, notes=(*made.notes, AROUND)) if apart else made


def _model(slab: Slab, scheme: str | int) -> SolidModel:
    """The solids of a slab, in colours by a scheme."""
    layout, job, design = slab.layout, slab.job, slab.layout.design
    colours = colour_tiles(layout.tessellation, scheme, layout.period)
    colour = TileColouring(colours, layout.copies).of_copies(np.arange(len(layout.copies.tile)))
    used, index = np.unique(colour, return_inverse=True)
    shades = palette(int(colour.max()) + 1)
    prisms = slab.prisms()
    _refuse_crowd(prisms, layout)
    meshes = list(slab.meshes(prisms))
    proof = replace(prove_prisms(prisms, slab.lines, job), pulled=bool(layout.copies.moved_by.any()))
    prove_copies(meshes, layout.copies.tile, prisms, job)
    pieces = [
        SolidPiece(name, site, shade, mesh)
        for (name, site), shade, mesh in zip(_named(layout), index.tolist(), meshes, strict=True)
    ]
    losses = [note for shape in (slab.outer, slab.inner) if shape for note in shape.compensation.losses]
    return SolidModel(
        title=f"{design.name} ({design.group.name})",
        pieces=tuple(pieces),
        colours=tuple(f"#{bytes(shades[k]).hex()}" for k in used.tolist()),
        recipe={**design_recipe(design), "solid": json.dumps(job.recipe(), sort_keys=True)},
        proof=proof.document(),
        proved=str(proof),
        grouped=job.colours != "none",
        notes=tuple(dict.fromkeys((*layout.sheet.notes, *losses, *_missing(layout)))),
        files=(*design.files, *job.files),
    )


def _refuse_crowd(prisms: Sequence[Prism], layout: Layout) -> None:
    """Refuse more triangles than memory, and slicers, hold."""
    count = sum(len(prisms[tile].triangles) for tile in layout.copies.tile.tolist())
    if count > TRIANGLES_MAX:
        raise JobError(
            f"the solids would have {count:,} triangles",
            remedy=f"Take a smaller sheet, or a coarser `accuracy`: {TRIANGLES_MAX:,} are the most.",
        )


def _missing(layout: Layout) -> list[str]:
    """What the sheet lacks, in words: sites without a tile on it, and much of its room where tiles are pulled apart."""
    there = set(layout.site.tolist())
    names = [f"'{site.name}'" for k, site in enumerate(layout.design.noded) if k not in there]
    found = [f"no whole tile of {', '.join(names)} is on the sheet"] if names else []
    if layout.stretch.area >= ROOM:
        found.append(
            f"tiles are pulled apart to {layout.stretch.area:.1f} times their room: hooked ones, and those in holes of "
            "others, take less without a `gap`, with a `clearance`"
        )
    return found


def _named(layout: Layout) -> list[tuple[str, str]]:
    """The name of each piece and that of its site; where a site has several, they have numbers."""
    names = [site.name for site in layout.design.noded]
    sites = [names[site] for site in layout.site.tolist()]
    total, number = Counter(sites), Counter[str]()
    found = []
    for site in sites:
        number[site] += 1
        found.append((f"{site} {number[site]}" if total[site] > 1 else site, site))
    return found

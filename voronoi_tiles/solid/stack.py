"""Stacks: a solid as sheets, each the exact tiles at the middle of its height, as files to cut or as prisms."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import fsum, pi
from typing import Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arguments import instance, number, path_name
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.exact import design_recipe
from voronoi_tiles.fabrication.exporting import Exported, format_of, numbered, refuse_stream, write_all
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.layout import Layout
from voronoi_tiles.fabrication.nest_search import Progress
from voronoi_tiles.fabrication.product import Product, make_together
from voronoi_tiles.formats.presets import FORMATS, Format, load_preset
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.solid.bores import bored
from voronoi_tiles.solid.common_places import laid_together
from voronoi_tiles.solid.dowel_holes import place_holes
from voronoi_tiles.solid.events import LoftError
from voronoi_tiles.solid.extrusion_proof import prove_copies, prove_prisms
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.motion import Motion
from voronoi_tiles.solid.pieces import SolidPiece
from voronoi_tiles.solid.slab import Slab
from voronoi_tiles.solid.solid_job import HEIGHT_MIN, SolidJob
from voronoi_tiles.solid.solid_model import SolidModel
from voronoi_tiles.solid.solid_report import PLYWOOD
from voronoi_tiles.solid.stack_job import StackJob
from voronoi_tiles.solid.stack_layout import StackLayout, hole_centres
from voronoi_tiles.vector.proof import proved_tiles
from voronoi_tiles.vector.tessellation import Tessellation

_OF_SOLIDS: Final = ("sheets", "dowel", "margin", "rotate", "accuracy")
"""The options that are for solids, too."""


@dataclass(frozen=True, eq=False)
class StackSheet:
    """A sheet of a stack: its number, from 1, the lowest; the height of its middle; the exact tiles there.

    `outlines` are those of each site's tile, where it is drawn. Millimetres.
    """

    number: int
    middle: float
    tessellation: Tessellation
    outlines: tuple[Paths, ...]


class _Made(NamedTuple):
    """The drawings of all sheets, and how many stacks there are of each site by its name."""

    products: tuple[Product, ...]
    stacks: dict[str, int]


@dataclass(frozen=True, eq=False, repr=False)
class Stack:
    """A design that stands as sheets, proved: each has the exact tiles of the strokes at the middle of its height.

    `thickness` is that of a sheet. `holes` are the centres of each site's dowels, complex128 (2,), where its tile is
    drawn; none without dowels. Millimetres.
    """

    design: Design
    job: StackJob
    thickness: float
    sheets: tuple[StackSheet, ...]
    holes: tuple[Complexes, ...]
    _files: dict[Format, _Made] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<Stack: {counted(len(self.sheets), 'sheet')} of {self.thickness:.5g} mm>"

    def summary(self, file_format: Format | None = None) -> str:
        """Say in a line what a maker needs to know of the sheets, in files of a format, None for the preset's first."""
        text = f"{counted(len(self.sheets), 'sheet')}, 1 the lowest, each {self.thickness:.5g} mm thick"
        if self.job.sheet is not None:
            stacks = self.stacks(file_format)
            each = f" ({', '.join(f'{n} {name}' for name, n in stacks.items())})" if len(stacks) > 1 else ""
            clipped = ", whole and clipped ones" if self.job.fit == "clip" else ""
            text += f": {counted(sum(stacks.values()), 'stack')}{each}{clipped}, pieces are numbered sheet.stack"
        if self.holes:
            apart = min(float(abs(own[1] - own[0])) for own in self.holes)
            more = " or more" if len(self.holes) > 1 else ""
            text += (
                f"; 2 holes in a {'whole ' if self.job.fit == 'clip' else ''}tile, {apart:.4g} mm{more} apart, "
                f"for dowels of {self.job.dowel:g} mm, {self.thickness * len(self.sheets):.5g} mm long"
            )
        return text

    def stacks(self, file_format: Format | None = None) -> dict[str, int]:
        """How many stacks there are of each site, by its name, in files of a format, None for the preset's first."""
        return dict(self._made(file_format).stacks)

    def products(self, file_format: Format = "svg", progress: Progress | None = None) -> list[Product]:
        """The drawing of each sheet, with its number engraved, on full sheets also that of the stack.

        All sheets have the same stacks in the same places. `progress` is told how many sheets are drawn. Raises
        JobError where the job cannot be done.
        """
        return list(self._made(file_format, progress).products)

    def export(
        self,
        path: str | os.PathLike[str],
        file_format: Format | None = None,
        progress: Progress | None = None,
    ) -> tuple[Exported, ...]:
        """Write a file for each sheet, with its number before the suffix: all of them, whole, or none.

        The format is that of the suffix, or `file_format`; `progress` is told how many sheets are drawn. Raises
        OutputError, and JobError where the job cannot be done.
        """
        name = path_name("path", path)
        form = format_of(name, FORMATS) if file_format is None else file_format
        refuse_stream(name, "sheets")
        products = self.products(form, progress)
        return write_all(numbered(name, [(str(k + 1), product) for k, product in enumerate(products)]))

    def _made(self, file_format: Format | None, progress: Progress | None = None) -> _Made:
        """The sheets in a format, made once."""
        form = load_preset(self.job.preset).first_format if file_format is None else file_format
        if form not in self._files:
            self._files[form] = self._make(form, progress)
        return self._files[form]

    def _make(self, form: Format, progress: Progress | None) -> _Made:
        """The sheets in a format."""
        drawn = any(art is not None for art in self.design.art)
        notes = ("art is left out of sheets: it is drawn for the lowest tile",) if drawn else ()
        layouts: list[StackLayout] = []

        def finish(apart: Sequence[Layout]) -> list[StackLayout]:
            """The layouts of all sheets with the same stacks, and with numbers and holes."""
            for sheet, layout in zip(self.sheets, laid_together(apart), strict=True):
                layouts.append(StackLayout.of(layout, sheet.number, self.holes, self.job.dowel))
            return layouts

        tiles = [sheet.tessellation for sheet in self.sheets]
        made = make_together(self.design, tiles, self.job.cut, form, finish, progress)
        products = []
        for sheet, product in zip(self.sheets, made, strict=True):
            own = json.dumps({**self.job.recipe(), "number": sheet.number}, sort_keys=True)
            drawing = replace(product.drawing, recipe={**product.drawing.recipe, "stack": own})
            products.append(replace(product, drawing=drawing, notes=(*product.notes, *notes)))
        names = [site.name for site in self.design.noded]
        pairs = {pair for layout in layouts for pair in layout.stacks}
        return _Made(tuple(products), {name: sum(site == k for site, _ in pairs) for k, name in enumerate(names)})

    @cached_property
    def model(self) -> SolidModel:
        """The stack as a solid for each sheet of each tile, one upon the other, proved.

        Raises JobError where the job asks for what is cut alone.
        """
        for name in self.job.recipe():
            if name not in _OF_SOLIDS:
                raise JobError(
                    f"`{name}` is for sheets that are cut, and this is a solid", remedy="Leave it out, or write svg."
                )
        flat = SolidJob(
            height=self.thickness, margin=self.job.margin, rotate=self.job.rotate, accuracy=self.job.accuracy
        )
        slabs = [Slab.of(self.design, sheet.tessellation, flat) for sheet in self.sheets]
        prisms = [slab.prisms() for slab in slabs]
        proofs = [prove_prisms(own, slab.lines, flat) for own, slab in zip(prisms, slabs, strict=True)]
        # They stand upon each other: all are moved alike.
        corners = np.array([slab.corner(own) for own, slab in zip(prisms, slabs, strict=True)])
        corner = complex(corners.real.max(), corners.imag.max())
        names = [site.name for site in self.design.noded]
        pieces = []
        for sheet, slab, own in zip(self.sheets, slabs, prisms, strict=True):
            up = np.array([0.0, 0.0, (sheet.number - 1) * self.thickness])
            meshes = list(slab.meshes(own, corner))
            tiles = slab.layout.copies.tile
            prove_copies(meshes, tiles, own, flat)
            if self.job.dowel is not None:
                radius, centres = self.job.dowel / 2, hole_centres(slab.layout, self.holes)
                meshes = [
                    bored(mesh, own[tile], places + corner, radius, flat.chords)
                    for mesh, tile, places in zip(meshes, tiles.tolist(), centres, strict=True)
                ]
            for site, mesh in zip(slab.layout.site.tolist(), meshes, strict=True):
                raised = TriangleMesh(mesh.vertices + up, mesh.triangles)
                pieces.append(SolidPiece(f"{names[site]} {sheet.number}", names[site], site, raised))
        error = max(proof.volume_error or 0.0 for proof in proofs)
        holes = "" if self.job.dowel is None else f"; holes of {self.job.dowel:g} mm or a little more taken off"
        return SolidModel(
            title=f"{self.design.name} ({self.design.group.name})",
            pieces=tuple(pieces),
            colours=tuple(f"#{bytes(shade).hex()}" for shade in palette(len(names))),
            recipe={**design_recipe(self.design), "stack": json.dumps(self.job.recipe(), sort_keys=True)},
            proof={"sheets": [proof.document() for proof in proofs]},
            proved=f"each sheet: closed; volume = cell area x thickness (relative error {error:.1g}); "
            f"all points of outlines are neighbours', bit for bit{holes}",
            files=tuple(self.design.files),
        )

    def report(self, density: float = PLYWOOD, file_format: Format | None = None) -> dict[str, Any]:
        """What the sheets come to, in the types of JSON; millimetres, square and cubic ones, grams.

        "sheets" has the area of one tile of each site in each sheet, "stacks" how many stacks there are of each; volume
        and mass are those of all pieces of tiles. "holes" are the centres of the dowels' holes of each site, in the
        plane of the design. `density` is in grams per cubic centimetre, the format of files as in `stacks`. Raises
        ArgumentError for a density that is no positive number, JobError where the job cannot be done.
        """
        density = number("density", density, "Give grams per cubic centimetre, such as 0.7.", least=1e-6)
        names = [site.name for site in self.design.noded]
        bores = 0.0 if self.job.dowel is None else 2 * pi * self.job.dowel**2 / 4
        rows: list[dict[str, Any]] = [
            {
                "sheet": sheet.number,
                "middle": sheet.middle,
                "site": name,
                "area": float(ring_areas(rings).sum()) - bores,
            }
            for sheet in self.sheets
            for name, rings in zip(names, sheet.outlines, strict=True)
        ]
        made = self._made(file_format)
        volume = fsum(product.pieces.tile_area for product in made.products) * self.thickness
        return {
            "thickness": self.thickness,
            "height": self.thickness * len(self.sheets),
            "dowel": self.job.dowel,
            "holes": {
                name: [[point.real, point.imag] for point in own.tolist()]
                for name, own in zip(names, self.holes, strict=False)
            },
            "density": density,
            "volume": volume,
            "mass": volume / 1000 * density,
            "stacks": dict(made.stacks),
            "sheets": rows,
        }


def stack(design: Design, job: StackJob, progress: Progress | None = None) -> Stack:
    """A design that stands as a stack of sheets, all tiles proved; `progress` is told how many sheets are.

    Raises ArgumentError for a design that is flat, LoftError with the height where copies meet in a sheet, JobError
    where sheets are too thin or dowels have no room, ProofError where tiles fail their proof.
    """
    design, job = instance("design", design, Design), instance("job", job, StackJob)
    motion = Motion.of(design)
    unit = design.unit_mm
    thickness = motion.height * unit / job.sheets
    if thickness < HEIGHT_MIN:
        raise JobError(
            f"with `sheets={job.sheets}` each of them is {thickness:.3g} mm thick",
            remedy=f"Make fewer, or a higher [solid]: {HEIGHT_MIN:g} mm is the least.",
        )
    sheets = []
    for k in range(job.sheets):
        z = (k + 0.5) / job.sheets * motion.height
        try:
            records, _ = proved_tiles(motion.at(z), design.group, design.lattice)
        except TouchingCopiesError as error:
            raise LoftError(
                f"{str(error).partition('. ')[0]} in sheet {k + 1}", z, remedy="Copies must keep apart in all sheets."
            ) from None
        outlines = tuple(record.outline.paths.moved(unit, 0j) for record in records)
        sheets.append(StackSheet(k + 1, z * unit, records[0].tessellation, outlines))
        if progress is not None:
            progress(k + 1, job.sheets)
    holes: list[Complexes] = []
    if job.dowel is not None:
        each = zip(*(sheet.outlines for sheet in sheets), strict=True)
        holes = [place_holes(site.name, own, job.dowel) for site, own in zip(design.noded, each, strict=True)]
    return Stack(design, job, thickness, tuple(sheets), tuple(holes))

"""Tiles of a design as prisms: drawn in by half a clearance, with chamfers, one of each or a sheet of them."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arguments import instance
from voronoi_tiles.base.arrays import Bools
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.arc_fitting import ABSORBED, EdgeArcs, EdgeLines
from voronoi_tiles.fabrication.dressed_tiles import DressedTiles
from voronoi_tiles.fabrication.exact import design_recipe
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.kerf import SHORTEST_MM, Compensation, changed
from voronoi_tiles.fabrication.layout import Layout, lay_out
from voronoi_tiles.fabrication.sheets import read_sheet
from voronoi_tiles.fabrication.tile_colouring import TileColouring, colour_tiles
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.offset import offset
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.short_segments import without_short_segments
from voronoi_tiles.solid.extrusion_proof import prove_prisms
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.pieces import SolidPiece
from voronoi_tiles.solid.prism import Face, Prism
from voronoi_tiles.solid.solid_job import SolidJob
from voronoi_tiles.solid.solid_model import SolidModel
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.tessellation import Tessellation

TRIANGLES_MAX: Final = 4_000_000
"""Most triangles of a solid; a count. They take about a gigabyte, and no slicer takes more gladly."""

_ARCS: Final = 0.25
_SHORT: Final = 0.05
_CHORDS: Final = 0.7
"""Parts of the accuracy that arcs, short segments that are left out, and chords take; they come to the whole."""


def extrude(tiling: Tiling, job: SolidJob | None = None) -> SolidModel:
    """The tiles of a tiling as prisms, proved: drawn in by half a clearance, with chamfers; one of each, or a sheet.

    Raises JobError where the job cannot be done, or a clearance or chamfer eats a tile; ProofError where what was made
    is not what was asked.

    >>> import voronoi_tiles as vt
    >>> vt.extrude(vt.starter("p4").tessellate(), vt.SolidJob(height="5mm", clearance=0.2))
    <SolidModel: 1 solid, 34.204 x 35.016 x 5 mm, 4.439 cm³, 572 triangles>
    """
    job = SolidJob() if job is None else instance("job", job, SolidJob)
    design = instance("tiling", tiling, Tiling).design
    slab = Slab.of(design, tiling.tessellation, job)
    layout = slab.layout
    scheme = "site" if job.colours == "none" else job.flat.scheme
    colours = colour_tiles(layout.tessellation, scheme, layout.period)
    colour = TileColouring(colours, layout.copies).of_copies(np.arange(len(layout.copies.tile)))
    used, index = np.unique(colour, return_inverse=True)
    shades = palette(int(colour.max()) + 1)
    prisms = slab.prisms()
    _refuse_crowd(prisms, layout)
    proof = prove_prisms(prisms, slab.lines, job)
    pieces = [
        SolidPiece(name, site, shade, mesh)
        for (name, site), shade, mesh in zip(_named(layout), index.tolist(), slab.meshes(prisms), strict=True)
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
        notes=tuple(dict.fromkeys((*layout.sheet.notes, *losses))),
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


class _Inset(Compensation):
    """Draws tiles in by some millimetres, which an option asks for."""

    def __init__(self, job: Job, budget: AccuracyBudget, width: float, asked: tuple[str, float]) -> None:
        super().__init__(job, budget)
        self.width = width
        self.asked = asked

    def tile(self, rings: Paths) -> Paths:
        """Draw in a tile, which must keep all its rings. Raises JobError where it does not."""
        inner = changed(offset, rings, -self.width, self.asked, self.losses, whole=True)
        return without_short_segments(inner, SHORTEST_MM, self.budget.short)


@dataclass(frozen=True, eq=False)
class Slab:
    """Where tiles lie, and their outlines: `lines` is the period as chords where it is laid.

    `outer` are the tiles drawn in by half the clearance, None without one; `inner` those within the chamfer.
    """

    job: SolidJob
    layout: Layout
    lines: Period
    outer: DressedTiles | None
    inner: DressedTiles | None

    @classmethod
    def of(cls, design: Design, tessellation: Tessellation, job: SolidJob) -> Slab:
        """Lay out the tiles."""
        budget = _budget(job)
        unit = design.unit_mm
        arcs = EdgeArcs(budget.arcs / unit, ABSORBED * budget.whole / unit)
        fit = arcs if job.insets else EdgeLines(budget.chords / unit)
        layout = lay_out(design, tessellation, job.flat, read_sheet(job.flat, budget), budget, fit)
        lines = layout.period
        if job.insets:
            # Of edges that a motion maps onto each other one is cut into chords, and moved.
            def chords(paths: Paths) -> Paths:
                """Chords of the arcs."""
                return to_lines(arcs(paths), accuracy=budget.chords / unit)

            page = layout.tiles.page
            lines = tessellation.approximated(chords).placed(page.factor, page.shift)

        def inset(name: str, width: float) -> DressedTiles | None:
            """The tiles drawn in by a width, where an option asks for it."""
            given = float(getattr(job, name))
            asked = _Inset(job.flat, budget, width, (name, given))
            return replace(layout.tiles, compensation=asked, _rings={}) if given > 0.0 else None

        half = job.clearance / 2
        return cls(job, layout, lines, inset("clearance", half), inset("chamfer", half + job.chamfer))

    def prisms(self) -> list[Prism]:
        """The prisms over the period's tiles, where these stand in the period."""
        rings, items = self.lines.own_outlines
        areas = self.layout.tile_areas
        forward = np.repeat(self.lines.rings.forward, self.lines.edges.counts[self.lines.rings.edge])
        height, chamfer = self.job.height, self.job.chamfer
        found = []
        for tile in range(len(self.lines.site)):
            own = np.arange(items[tile], items[tile + 1])
            plain = _face(rings.take(own), float(areas[tile]), forward[slice(*rings.offsets[items[tile : tile + 2]])])
            outer = plain if self.outer is None else self._chords(self.outer.rings(tile))
            found.append(
                Prism.over(outer, height)
                if self.inner is None
                else Prism.chamfered(outer, self._chords(self.inner.rings(tile)), height, chamfer)
            )
        return found

    def _chords(self, rings: Paths) -> Face:
        """The face that rings of arcs bound, as chords of them."""
        lines = to_lines(rings, accuracy=self.layout.budget.chords)
        return _face(lines, float(ring_areas(rings).sum()))

    def meshes(self, prisms: Sequence[Prism]) -> Iterator[TriangleMesh]:
        """The solids of all copies; where nothing is drawn in, what neighbours share has the same bits in both."""
        copies = self.layout.copies
        assert copies.unit is None, "pieces that are laid anew are turned"
        rings, items = self.lines.outlines(copies.tile, copies.step)
        shifts = self.layout.copy_shifts
        corner = self._corner(prisms)
        for k, tile in enumerate(copies.tile.tolist()):
            prism, shift = prisms[tile], shifts[k] + corner
            if self.outer is None:
                ring = rings.take(np.arange(items[k], items[k + 1]))
                outer = ring.start + (copies.moved_by[k] + corner)
            else:
                outer = prism.outer.points + shift
            yield prism.mesh(outer, None if prism.inner is None else prism.inner.points + shift)

    def _corner(self, prisms: Sequence[Prism]) -> complex:
        """What takes the solids to where they have no negative coordinates; on a sheet they are there."""
        if self.layout.region is not None:
            return 0j
        places = zip(self.layout.copies.tile.tolist(), self.layout.copy_shifts.tolist(), strict=True)
        low = [(points.real.min(), points.imag.min()) for k, z in places for points in [prisms[k].outer.points + z]]
        x, y = np.array(low).min(axis=0).tolist()
        return complex(self.job.margin - x, self.job.margin - y)


def _face(lines: Paths, area: float, forward: Bools | None = None) -> Face:
    """The face that rings of lines bound."""
    return Face(lines.start, lines.offsets, area, forward)


def _budget(job: SolidJob) -> AccuracyBudget:
    """How the accuracy is spent: chords only, or arcs that are drawn in exactly, without short segments, as chords."""
    whole = job.accuracy
    if not job.insets:
        return AccuracyBudget(whole, arcs=0.0, short=0.0, chords=whole, cubics=0.0)
    return AccuracyBudget(whole, arcs=_ARCS * whole, short=_SHORT * whole, chords=_CHORDS * whole, cubics=0.0)


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

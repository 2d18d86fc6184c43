"""The tiles of a job where they lie in a slab, and the prisms over them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.arc_fitting import ABSORBED, EdgeArcs, EdgeLines
from voronoi_tiles.fabrication.dressed_tiles import DressedTiles
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.kerf import SHORTEST_MM, Compensation, changed
from voronoi_tiles.fabrication.layout import Layout, PlacedTiles, lay_out
from voronoi_tiles.fabrication.sheets import read_sheet
from voronoi_tiles.fabrication.spacing import Spacing, Stretch
from voronoi_tiles.fabrication.tile_colouring import neighbour_pairs
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.offset import offset
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.short_segments import without_short_segments
from voronoi_tiles.solid.face_triangles import filled
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.prism import Face, Prism
from voronoi_tiles.solid.solid_job import SolidJob
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.tessellation import Tessellation

_PULL: Final = 0.07
"""How far tiles are pulled apart for a picture; a share of a tile's longer side."""

_APART: Final = 1.3
"""By how much their places are spread where that does not part them; a factor."""

_ARCS: Final = 0.25
_SHORT: Final = 0.05
_CHORDS: Final = 0.7
"""Parts of the accuracy that arcs, short segments that are left out, and chords take; they come to the whole."""


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
        job.refuse_rims(job.thickness)
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
            return layout.tiles.compensated(asked) if given > 0.0 else None

        half = job.clearance / 2 + (budget.whole if job.clearance > 0.0 else 0.0)
        return cls(job, layout, lines, inset("clearance", half), inset("chamfer", half + job.chamfer))

    def around(self, *, apart: bool = True) -> Slab:
        """The first tile and all that share an edge with it, in the place of those of the job.

        They are pulled `apart`, or lie where they do.

        What lies in a hole of one of them stays there, and is shown as well; of a tile in a hole, that which has it
        counts for the first.
        """
        tiles, period = self.layout.tiles, self.layout.period
        contours = [to_lines(rings, accuracy=self.layout.budget.whole) for rings in tiles.all_rings()]
        pairs = neighbour_pairs(period)
        holder = _holders(contours, period, pairs)
        free = np.flatnonzero(holder[:, 0] == np.arange(len(holder)))
        middle = int(holder[0, 0])
        first, second = pairs[pairs[:, 0] == middle, 1:], pairs[pairs[:, 1] == middle]
        beside = np.concatenate([[[middle, 0, 0]], first, np.column_stack((second[:, 0], -second[:, 2:]))])
        beside = np.unique(beside[np.isin(beside[:, 0], free)], axis=0)
        # Each with what it holds, and that with where its holder is.
        held = [np.flatnonzero(holder[:, 0] == tile) for tile in beside[:, 0].tolist()]
        of = np.repeat(np.arange(len(beside)), [len(some) for some in held])
        tile = np.concatenate(held)
        step = beside[of, 1:] - holder[tile, 1:]
        if not apart:
            copies = PlacedTiles(tile, step, np.ones(len(tile), np.bool_), np.zeros(len(tile), np.complex128))
            return replace(self, layout=replace(self.layout, copies=copies))
        box = period.own_boxes[middle]
        gap = _PULL * float((box[2:] - box[:2]).max())
        outer = [contours[k].take(np.flatnonzero(ring_areas(contours[k]) > 0.0)) for k in free.tolist()]
        try:
            stretch = Spacing(outer, tiles.centres()[free], period.basis).stretch(gap)
        except ValueError:
            stretch = Stretch(_APART, 0j)
        centre = period.at(tiles.centres()[beside[:, 0]], beside[:, 1:])[of]
        away = centre - tiles.centres()[middle]
        copies = PlacedTiles(tile, step, np.ones(len(tile), np.bool_), stretch(away) - away)
        return replace(self, layout=replace(self.layout, copies=copies))

    def prisms(self) -> list[Prism]:
        """The prisms over the period's tiles, where these stand in the period."""
        rings, items = self.lines.own_outlines
        areas = self.layout.tile_areas
        forward = np.repeat(self.lines.rings.forward, self.lines.edges.counts[self.lines.rings.edge])
        height, chamfer = self.job.thickness, self.job.chamfer
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

    def meshes(self, prisms: Sequence[Prism], corner: complex | None = None) -> Iterator[TriangleMesh]:
        """The solids of all copies, moved by `corner`, or so that no coordinates are negative.

        Where nothing is drawn in, what neighbours share has the same bits in both.
        """
        copies = self.layout.copies
        assert copies.unit is None, "pieces that are laid anew are turned"
        rings, items = self.lines.outlines(copies.tile, copies.step)
        shifts = self.layout.copy_shifts
        corner = self.corner(prisms) if corner is None else corner
        for k, tile in enumerate(copies.tile.tolist()):
            prism, shift = prisms[tile], shifts[k] + corner
            if self.outer is None:
                ring = rings.take(np.arange(items[k], items[k + 1]))
                outer = ring.start + (copies.moved_by[k] + corner)
            else:
                outer = prism.outer.points + shift
            yield prism.mesh(outer, None if prism.inner is None else prism.inner.points + shift)

    def corner(self, prisms: Sequence[Prism]) -> complex:
        """What takes the solids to where they have no negative coordinates; on a sheet they are there."""
        if self.layout.region is not None:
            return 0j
        places = zip(self.layout.copies.tile.tolist(), self.layout.copy_shifts.tolist(), strict=True)
        low = [(points.real.min(), points.imag.min()) for k, z in places for points in [prisms[k].outer.points + z]]
        x, y = np.array(low).min(axis=0).tolist()
        return complex(self.job.margin - x, self.job.margin - y)


def _holders(contours: Sequence[Paths], period: Period, pairs: Ints) -> Ints:
    """In which outermost tile's hole each tile lies, itself where in none: intp (n, 3), tile and lattice vector.

    `contours` are those of the tiles, as lines, `pairs` of the period's tiles share an edge, as of `neighbour_pairs`.
    """
    import shapely

    shapes = [filled(part.start, part.offsets) for part in contours]
    places = shapely.point_on_surface(shapes)
    holder = np.column_stack((np.arange(len(shapes)), np.zeros((len(shapes), 2), np.intp)))
    both = np.concatenate((pairs, np.column_stack((pairs[:, [1, 0]], -pairs[:, 2:]))))
    for p, q, *step in both.tolist():
        shift = period.shifts(np.array([step]))[0]
        within = shapely.Point(places[q].x + shift.real, places[q].y + shift.imag)
        if any(part.interiors and shapely.Polygon(part.exterior).contains(within) for part in shapes[p].geoms):
            holder[q] = (p, *(-k for k in step))
    for _ in shapes:  # what holds may be held
        holder = np.column_stack((holder[holder[:, 0], 0], holder[:, 1:] + holder[holder[:, 0], 1:]))
    return holder


def _face(lines: Paths, area: float, forward: Bools | None = None) -> Face:
    """The face that rings of lines bound."""
    return Face(lines.start, lines.offsets, area, forward)


def _budget(job: SolidJob) -> AccuracyBudget:
    """How the accuracy is spent: chords only, or arcs that are drawn in exactly, without short segments, as chords.

    Of what is drawn in for a clearance, half of it is drawn in as well: so nothing is left that is nearer.
    """
    whole = job.chords / 2 if job.clearance > 0.0 else job.chords
    if not job.insets:
        return AccuracyBudget(whole, arcs=0.0, short=0.0, chords=whole, cubics=0.0)
    return AccuracyBudget(whole, arcs=_ARCS * whole, short=_SHORT * whole, chords=_CHORDS * whole, cubics=0.0)

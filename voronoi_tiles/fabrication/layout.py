"""Where the tiles of a job lie, and their lines: strands that are cut once, or closed contours of pieces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.best_offset import best_shift
from voronoi_tiles.fabrication.clipping import Strands, clipped_strands, whole_strands
from voronoi_tiles.fabrication.contours import ClosedPieces, clipped_pieces, frame_pieces
from voronoi_tiles.fabrication.dressed_tiles import DressedTiles, PageMap
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.job_options import SHEET_MAX
from voronoi_tiles.fabrication.kerf import Compensation
from voronoi_tiles.fabrication.region import Region, inset
from voronoi_tiles.fabrication.spacing import FARTHEST, UNSTRETCHED, Stretch, pulled_apart
from voronoi_tiles.fabrication.tile_placement import TilePlacement, place_tiles, whole_tiles
from voronoi_tiles.paths.areas import item_areas
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import item_boxes
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.copies import Placed
from voronoi_tiles.vector.motions import IDENTITY, reverses_orientation
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import Tessellation

FRAME = -1
"""The site of a piece of a frame."""

TILES_MAX: Final = 100_000
"""Most tiles of a sheet; a count. They take about ten seconds."""

PIECES_MAX: Final = 4_000_000
"""Most edges of all tiles of a sheet, and most lines of art; counts. They take about 1.5 GB."""


@dataclass(frozen=True, eq=False)
class Sheet:
    """The page and what of it is filled: `region` is None where one of each tile is made, and the page fits them.

    `outline` is what a drawing bounds, without a margin; `notes` say in sentences what is to be known of it.
    """

    width: float
    height: float
    region: Region | None
    centre: complex
    notes: tuple[str, ...] = ()
    outline: Paths | None = None


@dataclass(frozen=True, eq=False)
class PlacedTiles:
    """The tiles on the page, n of them: tile of the period, lattice vector, whether it is there as a whole.

    `moved_by` is how far each was pulled from its place, millimetres; before that it was turned about 0 by `unit`, None
    where none was.
    """

    tile: Ints
    step: Ints
    whole: Bools
    moved_by: Complexes
    unit: Complexes | None = None


class Piece(NamedTuple):
    """A place of a piece: the index of its site, whether its tile is turned over, its turn in degrees, and its shift.

    It is the site's tile as it is drawn, or its image in the x axis, turned about the origin and moved; millimetres.
    """

    site: int
    over: bool
    turn: float
    shift: complex


@dataclass(frozen=True, eq=False)
class Contours:
    """Closed pieces: piece k are the rings items[k] up to items[k + 1], outer ones first.

    `copy` is the tile on the page that each is, or is part of; FRAME for parts of a frame. `area` is what each has
    without fillet and kerf, square millimetres. What `loose` rings (bool) enclose falls out, whatever tabs there are;
    None where there are no such.
    """

    paths: Paths
    items: Ints
    copy: Ints
    area: Floats
    loose: Bools | None = None


@dataclass(frozen=True, eq=False)
class Layout:
    """A tessellation on the page of a job, in millimetres, y up.

    `tiles` are those of one period where it is laid, `spaced` is the period where it is cut: pulled apart, where pieces
    are, by `stretch`. `placement` says which tiles lie on the page, `copies` how far each was pulled; `numbers` are
    what these are labelled by, None where they are numbered as they lie. `pieces` are their places where they are
    nested, and do not lie as the tessellation does.
    """

    design: Design
    tessellation: Tessellation
    job: Job
    sheet: Sheet
    budget: AccuracyBudget
    tiles: DressedTiles
    spaced: Period
    placement: TilePlacement
    copies: PlacedTiles
    stretch: Stretch = UNSTRETCHED
    numbers: Ints | None = None
    pieces: tuple[Piece, ...] = ()

    @property
    def region(self) -> Region | None:
        """What of the sheet is filled; None where one of each tile is made."""
        return self.sheet.region

    @property
    def period(self) -> Period:
        """The period where it is laid, before tiles are pulled apart."""
        return self.tiles.period

    def outline(self, site: int) -> Outline:
        """The exact outline of a site's tile, in the design's units."""
        return self.tessellation.outline(site, IDENTITY)

    @property
    def site(self) -> Ints:
        """The site of each copy."""
        return self.period.site[self.copies.tile]

    @cached_property
    def copy_shifts(self) -> Complexes:
        """How far each copy is from where its tile stands in the period."""
        return self.period.shifts(self.copies.step) + self.copies.moved_by

    @property
    def turned_over(self) -> Bools:
        """Whether each copy is its site's tile turned over."""
        over = np.array([reverses_orientation(motion) for motion in self.period.motion])
        return over[self.copies.tile]

    @cached_property
    def strands(self) -> Strands:
        """The lines of the sheet, each once; those of tiles that are pulled apart, two for a side."""
        if self.region is not None and self.job.fit == "clip":
            return clipped_strands(self.spaced, self.placement, self.region)
        return whole_strands(self.spaced, self.placement)

    def lines(self) -> Strands:
        """The lines of the sheet and its border, each once: where tiles lie along the border, it is the border's."""
        if self.region is not None and self.job.fit == "frame":
            return clipped_strands(self.spaced, self.placement, self.region)
        return self.strands

    @cached_property
    def contours(self) -> Contours:
        """The closed contours of all pieces, kerf, fillets and gaps applied."""
        whole = np.flatnonzero(self.copies.whole)
        paths, items = self._whole(whole)
        copy, area = whole, self.tile_areas[self.copies.tile[whole]]
        rest = self.rest()
        if rest is not None:
            done, of = self.tiles.compensation.pieces(rest)
            # What fillets cut in two shares the area that it had.
            left = piece_areas(done) if len(of) else np.zeros(0)
            share = left / np.bincount(of, left, len(rest.tile))[of]
            paths = Paths.concatenate([paths, done.paths])
            items = np.concatenate((items, items[-1] + done.items[1:]))
            copy = np.concatenate((copy, done.tile))
            area = np.append(area, self.rest_areas(rest)[of] * share)
        return Contours(paths, items, copy, area)

    def rest(self) -> ClosedPieces | None:
        """What there is beside the whole tiles: what the border leaves of those that it cuts, or the frame."""
        if self.region is None or self.job.fit == "whole":
            return None
        if self.job.fit == "frame":
            rest = frame_pieces(self.strands, self.region)
        else:
            cut = np.flatnonzero(~self.copies.whole)
            outlines, items = self.spaced.outlines(self.copies.tile[cut], self.copies.step[cut])
            rest = clipped_pieces(self.strands, cut, outlines, items)
        return rest if len(rest.tile) else None

    def rest_areas(self, rest: ClosedPieces) -> Floats:
        """The areas of the pieces of `rest`, square millimetres."""
        return piece_areas(rest)

    @property
    def bores(self) -> Paths:
        """Holes that are cut into pieces, and are no tile's: closed paths, clockwise."""
        return Paths.empty()

    def numbered(self, number: int) -> str:
        """The text by which a piece with a number is labelled."""
        return str(number)

    @cached_property
    def tile_areas(self) -> Floats:
        """The areas of the period's tiles, square millimetres."""
        return item_areas(*self.period.own_outlines)

    def _whole(self, copies: Ints) -> tuple[Paths, Ints]:
        """The rings of whole tiles, and where each one's begin."""
        tile = self.copies.tile[copies]
        if not self.job.moves_contours and not self.copies.moved_by.any():
            return self.period.outlines(tile, self.copies.step[copies])
        bases = self.tiles.all_rings()
        rings = Paths.concatenate(bases)
        starts = np.append(0, np.cumsum([len(base) for base in bases])).astype(np.intp)
        counts = np.diff(starts)[tile]
        stamped = rings.take(ranges(starts[:-1][tile], counts))
        items = np.append(0, np.cumsum(counts)).astype(np.intp)
        shift = np.repeat(self.copy_shifts[copies], counts)[stamped.owner]
        if self.copies.unit is None:
            return stamped.shifted(shift), items
        return stamped.turned(np.repeat(self.copies.unit[copies], counts)[stamped.owner], shift), items


def lay_out(
    design: Design,
    tessellation: Tessellation,
    job: Job,
    sheet: Sheet,
    budget: AccuracyBudget,
    fit: Callable[[Paths], Paths] | None,
    *,
    scale: float = 1.0,
    rough: bool = False,
) -> Layout:
    """Place the tiles of a job, scaled; `fit` replaces the exact curves (in the design's units).

    A `rough` layout only tells how many tiles there are, or a few less.

    Raises JobError where the sheet holds no tile, or too many, or a tile does not survive kerf or fillet.
    """
    region = sheet.region
    if region is None:
        _refuse_size(tessellation.period, scale * design.unit_mm)
    shift = 0j if region is None else sheet.centre + (job.offset or 0j)
    page = PageMap(tessellation.action, scale * design.unit_mm * unit_at(job.rotate), shift)
    period = tessellation.period if fit is None else tessellation.approximated(fit)
    tiles = DressedTiles(period.placed(page.factor, page.shift), page, Compensation(job, budget))
    if region is None:
        placement = _one_of_each(tiles.period, tessellation.placed)
        return Layout(
            design, tessellation, job, sheet, budget, tiles, tiles.period, placement, _in_a_row(tiles, placement, job)
        )
    refuse_crowd(tiles.period, region)
    stretch = UNSTRETCHED if job.apart is None else _stretch(tiles, job.apart, budget.measured)
    return _filled(design, tessellation, job, sheet, budget, tiles, stretch, rough)


def _refuse_size(period: Period, unit_mm: float) -> None:
    """Refuse tiles that are larger than sheets can be; files hold no such coordinates."""
    box = item_boxes(*period.own_outlines)
    side = float((box[:, 2:] - box[:, :2]).max()) * unit_mm
    if side > SHEET_MAX:
        raise JobError(
            f"a tile of {side:,.0f} mm is larger than {SHEET_MAX:,.0f} mm, the most that files hold",
            remedy="Give a smaller `scale`, or another unit.",
        )


def refilled(layout: Layout, *, sheet: Sheet | None = None, gap: float | None = None) -> Layout:
    """A layout's tiles on another sheet, or apart by another gap, roughly. Raises what `lay_out` does."""
    sheet = layout.sheet if sheet is None else sheet
    job, tiles, stretch = layout.job, layout.tiles, layout.stretch
    if gap is not None:
        job = replace(job, gap=gap)
        stretch = UNSTRETCHED if job.apart is None else _stretch(tiles, job.apart, layout.budget.measured)
    tiles = tiles.moved(sheet.centre + (job.offset or 0j) - tiles.page.shift)
    assert sheet.region is not None
    refuse_crowd(tiles.period, sheet.region)
    return _filled(layout.design, layout.tessellation, job, sheet, layout.budget, tiles, stretch, rough=True)


def _filled(
    design: Design,
    tessellation: Tessellation,
    job: Job,
    sheet: Sheet,
    budget: AccuracyBudget,
    tiles: DressedTiles,
    stretch: Stretch,
    rough: bool,
) -> Layout:
    """Fill a sheet with tiles that are spread by a stretch."""
    region = sheet.region
    assert region is not None
    field = inset(region, job.frame_width) if job.frame_width > 0.0 else region
    spaced = spaced_period(tiles, sheet, stretch)
    if job.offset is None and job.fit != "clip":
        tiles = tiles.moved(stretch.inverse(best_shift(spaced, field, rough=rough)))
        spaced = spaced_period(tiles, sheet, stretch)
    placement = _placement(spaced, field, job)
    copies = pulled(tiles, placement, sheet, stretch)
    return Layout(design, tessellation, job, sheet, budget, tiles, spaced, placement, copies, stretch)


def refuse_crowd(period: Period, region: Region) -> None:
    """Refuse a sheet that would hold more than memory does."""
    left, bottom, right, top = region.bounds
    cells = (right - left) * (top - bottom) / period.lattice.det
    tiles, edges = cells * len(period.site), cells * 2 * len(period.edges.start)
    if tiles > TILES_MAX or edges > PIECES_MAX:
        raise JobError(
            f"the sheet would hold about {tiles:,.0f} tiles of {edges / tiles:,.0f} edges each",
            remedy=f"Take a smaller sheet or a larger design: {TILES_MAX:,} tiles, and {PIECES_MAX:,} edges of "
            "tiles, are the most.",
        )


def spaced_period(tiles: DressedTiles, sheet: Sheet, stretch: Stretch) -> Period:
    """The period where it is cut."""
    period = tiles.period
    return period if stretch.is_identity else pulled_apart(period, tiles.centres(), sheet.centre, stretch)


def _stretch(tiles: DressedTiles, apart: float, accuracy: float) -> Stretch:
    """How far the layout is spread for a gap, measured by chords within an accuracy."""
    largest = FARTHEST * float(np.abs(tiles.period.basis).max())
    if apart > largest:
        raise JobError(
            f"a `gap` of {apart:g} mm is more than {FARTHEST:.0f} times the cell",
            remedy=f"Give at most {largest:g} mm.",
        )
    spacing = tiles.spacing(accuracy)
    try:
        return spacing.stretch(apart + 2 * accuracy)
    except ValueError as error:
        raise JobError(str(error), remedy="Use `edges='once'`, or leave `sheet` out: pieces lie in a row.") from error


def _one_of_each(period: Period, placed: Sequence[Placed]) -> TilePlacement:
    """One tile of each site, where it was drawn."""
    sites, first = np.unique(period.site, return_index=True)
    shifts = np.array([placed[site].shift for site in sites.tolist()], np.intp)
    return TilePlacement(first, shifts, np.ones(len(first), np.bool_))


def _placement(period: Period, field: Region, job: Job) -> TilePlacement:
    """Find the tiles on the page."""
    placement = (place_tiles if job.fit == "clip" else whole_tiles)(period, field)
    if not len(placement.tile):
        x0, y0, x1, y1 = period.own_boxes[0].tolist()
        other = ", or `fit='clip'`" if job.fit != "clip" else ""
        raise JobError(
            f"no {'whole ' if other else ''}tile fits on the sheet: one takes {x1 - x0:.4g} x {y1 - y0:.4g} mm",
            remedy=f"Take a larger sheet, a smaller margin, another `offset` or `rotate`{other}.",
        )
    return placement


def _in_a_row(tiles: DressedTiles, placement: TilePlacement, job: Job) -> PlacedTiles:
    """Tiles as they lie or, where pieces are apart, moved so that their boxes stand beside each other."""
    moves = np.zeros(len(placement.tile), np.complex128)
    right = None
    for k, (tile, step) in enumerate(zip(placement.tile.tolist(), placement.step, strict=True)):
        if job.apart is None:
            break
        low_x, _, high_x, _ = tiles.rings(tile).bounds
        here = float(tiles.period.shifts(step[None])[0].real)
        moves[k] = 0.0 if right is None else right + job.apart - (low_x + here)
        right = high_x + here + float(moves[k].real)
    return PlacedTiles(placement.tile, placement.step, placement.whole, moves)


def pulled(tiles: DressedTiles, placement: TilePlacement, sheet: Sheet, stretch: Stretch) -> PlacedTiles:
    """Tiles on a sheet, and how far each is pulled."""
    moves = np.zeros(len(placement.tile), np.complex128)
    if not stretch.is_identity:
        away = tiles.period.at(tiles.centres()[placement.tile], placement.step) - sheet.centre
        moves = stretch(away) - away
    return PlacedTiles(placement.tile, placement.step, placement.whole, moves)


def piece_areas(pieces: ClosedPieces) -> Floats:
    """The area of each piece, its holes taken off."""
    return item_areas(pieces.paths, pieces.items)

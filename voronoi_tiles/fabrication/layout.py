"""Where the tiles of a job lie, and their lines: strands that are cut once, or closed contours of pieces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges
from voronoi_tiles.base.maps import Isometry, unit_at
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.best_offset import best_shift
from voronoi_tiles.fabrication.clipping import Strands, clipped_strands, whole_strands
from voronoi_tiles.fabrication.contours import ClosedPieces, clipped_pieces, frame_pieces
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.kerf import Dressing
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.spacing import UNSTRETCHED, Stretch, pulled_apart, spread
from voronoi_tiles.fabrication.tile_placement import TilePlacement, place_tiles
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.offset import OffsetError, offset
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import item_boxes
from voronoi_tiles.paths.symmetric_fit import moved
from voronoi_tiles.vector.complex.approximation import approximated
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.copies import Placed
from voronoi_tiles.vector.motions import IDENTITY, Motion, compose, inverse, reverses_orientation
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import Tessellation

FRAME = -1
"""The site of a piece of a frame."""

FRAME_MM: Final = 2.0
"""Least width of a frame around tiles; millimetres. A narrower one breaks, or is cut twice."""

TILES_MAX: Final = 100_000
"""Most tiles of a sheet; a count. They take about ten seconds."""

PIECES_MAX: Final = 4_000_000
"""Most edges of all tiles of a sheet, and most lines of art; counts. They take about 1.5 GB."""


@dataclass(frozen=True, eq=False)
class Sheet:
    """The page and what of it is filled: `region` is None where one of each tile is made, and the page fits them."""

    width: float
    height: float
    region: Region | None
    centre: complex


@dataclass(frozen=True, eq=False)
class PlacedTiles:
    """The tiles on the page, n of them: tile of the period, lattice vector, whether it is there as a whole.

    `moved_by` is how far each was pulled from its place, millimetres.
    """

    tile: Ints
    step: Ints
    whole: Bools
    moved_by: Complexes


@dataclass(frozen=True, eq=False)
class Contours:
    """Closed pieces: piece k are the rings items[k] up to items[k + 1], outer ones first.

    `copy` is the tile on the page that each is, or is part of; FRAME for parts of a frame. `area` is what each has
    without fillet and kerf, square millimetres.
    """

    paths: Paths
    items: Ints
    copy: Ints
    area: Floats


class Layout:
    """A tiling on the page of a job, in millimetres, y up."""

    def __init__(
        self,
        design: Design,
        tessellation: Tessellation,
        job: Job,
        sheet: Sheet,
        fit: Callable[[Paths], Paths] | None,
        *,
        refit: bool = True,
    ) -> None:
        """Place tiles; `fit` replaces the exact curves (in the design's units), `refit` what kerf and fillet leave."""
        self.design = design
        self._tessellation = tessellation
        self.job = job
        self.sheet = sheet
        self.action = tessellation.action
        self.design_units = design.unit_mm
        period = tessellation.period
        if fit is not None:
            period = approximated(period, tessellation.quotient, fit)
        self.factor = self.design_units * unit_at(job.rotate)
        self.shift = sheet.centre + (job.offset or 0j) if sheet.region is not None else 0j
        self.period: Period = period.placed(self.factor, self.shift)
        if sheet.region is not None:
            self._refuse_crowd(sheet.region)
        self.dressing = Dressing(job, refit=refit)
        self.spread = UNSTRETCHED
        self._dressed: dict[int, Paths] = {}
        if job.apart is not None and sheet.region is not None:
            self.spread = self._spread(job.apart)
        self.region = sheet.region
        # The tiles where they are cut: as in the period, unless they are pulled apart.
        self.spaced = self._spaced()
        self._field = sheet.region if sheet.region is None or job.fit != "frame" else _inset(sheet.region, FRAME_MM)
        if self._field is not None and job.offset is None and job.fit != "clip":
            self._move(self.spread.inverse(best_shift(self.spaced, self._field)))
        self.placement = self._place(tessellation.placed)
        self.copies = PlacedTiles(
            self.placement.tile, self.placement.step, self.placement.whole, self._pull(self.placement)
        )

    def outline(self, site: int) -> Outline:
        """The exact outline of a site's tile, in the design's units."""
        return self._tessellation.outline(site, IDENTITY)

    def _refuse_crowd(self, region: Region) -> None:
        """Refuse a sheet that would hold more than memory does."""
        left, bottom, right, top = region.bounds
        cells = (right - left) * (top - bottom) / self.period.lattice.det
        tiles, pieces = cells * len(self.period.site), cells * 2 * len(self.period.edges.start)
        if tiles > TILES_MAX or pieces > PIECES_MAX:
            raise JobError(
                f"the sheet would hold about {tiles:,.0f} tiles of {pieces / tiles:,.0f} edges each",
                remedy=f"Take a smaller sheet or a larger design: {TILES_MAX:,} tiles, and {PIECES_MAX:,} edges of "
                "tiles, are the most.",
            )

    def _spaced(self) -> Period:
        """The period where it is cut."""
        if self.spread.is_identity:
            return self.period
        return pulled_apart(self.period, self._centres(), self.sheet.centre, self.spread)

    def _move(self, shift: complex) -> None:
        """Move all tiles on the page."""
        self.shift += shift
        self.period = self.period.placed(1.0, shift)
        self._dressed = {tile: rings.moved(1.0, shift) for tile, rings in self._dressed.items()}
        self.spaced = self._spaced()

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

    def motion_to_page(self, tile: int) -> tuple[complex, complex, bool]:
        """What takes points of the drawn site, in the design's units, to a tile of the period: factor, shift, conj."""
        motion = self.period.motion[tile]
        unit, conj = self.action.linear[motion[:4]]
        place = complex(self.action.cartesian(motion[4] / 2, motion[5] / 2))
        return self.factor * unit, self.factor * place + self.shift, conj

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
            done, of = self.dressing.pieces(rest)
            # What fillets cut in two shares the area that it had.
            left = piece_areas(done) if len(of) else np.zeros(0)
            share = left / np.bincount(of, left, len(rest.tile))[of]
            paths = Paths.concatenate([paths, done.paths])
            items = np.concatenate((items, items[-1] + done.items[1:]))
            copy = np.concatenate((copy, done.tile))
            area = np.append(area, piece_areas(rest)[of] * share)
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

    @cached_property
    def tile_areas(self) -> Floats:
        """The areas of the period's tiles, square millimetres."""
        outlines, items = self.period.own_outlines
        return np.asarray(np.add.reduceat(ring_areas(outlines), items[:-1]))

    def _place(self, placed: list[Placed]) -> TilePlacement:
        """Find the tiles on the page."""
        if self.region is None:
            sites, first = np.unique(self.period.site, return_index=True)
            shifts = np.array([placed[site].shift for site in sites.tolist()], np.intp)
            return TilePlacement(first, shifts, np.ones(len(first), np.bool_))
        assert self._field is not None
        placement = place_tiles(self.spaced, self._field)
        if self.job.fit != "clip":
            kept = np.flatnonzero(placement.whole)
            placement = TilePlacement(placement.tile[kept], placement.step[kept], placement.whole[kept])
        if not len(placement.tile):
            x0, y0, x1, y1 = item_boxes(*self.period.own_outlines)[0].tolist()
            other = ", or --fit clip" if self.job.fit != "clip" else ""
            raise JobError(
                f"no {'whole ' if other else ''}tile fits on the sheet: one takes {x1 - x0:.4g} x {y1 - y0:.4g} mm",
                remedy=f"Take a larger sheet, a smaller margin, another --offset or --rotate{other}.",
            )
        return placement

    def _base(self, tile: int) -> Paths:
        """The rings of a tile of the period where it stands, kerf and fillet applied."""
        known = self._dressed.get(tile)
        if known is not None:
            return known
        site = int(self.period.site[tile])
        first = int(np.flatnonzero(self.period.site == site)[0])
        if tile == first:
            rings, items = self.period.own_outlines
            own = rings.take(np.arange(items[tile], items[tile + 1]))
            result = self.dressing.tile(own, self._symmetry(tile))
        else:
            # The same shape as the first one of its site, not one that is computed anew.
            result = self._image(
                self._base(first), compose(self.period.motion[tile], inverse(self.period.motion[first]))
            )
        self._dressed[tile] = result
        return result

    def _image(self, paths: Paths, motion: Motion) -> Paths:
        """The image of rings on the page under a motion of the design's plane; the material stays on the left."""
        page = self._on_page(motion)
        image = moved(paths, page)
        return image.reversed() if page.conj else image

    def _on_page(self, motion: Motion) -> Isometry:
        """What a motion of the design's plane is on the page."""
        unit, place, conj = self.action.isometry(motion)
        factor = unit * (self.factor / self.factor.conjugate()) if conj else unit
        base = self.shift.conjugate() if conj else self.shift
        return Isometry(factor, self.factor * place + self.shift - factor * base, conj)

    def _symmetry(self, tile: int) -> list[Isometry]:
        """What maps a tile of the period onto itself, the identity left out."""
        here = self.period.motion[tile]
        stabilizer = self._tessellation.placed[int(self.period.site[tile])].stabilizer
        return [self._on_page(compose(compose(here, element), inverse(here))) for element in stabilizer[1:]]

    def _whole(self, copies: Ints) -> tuple[Paths, Ints]:
        """The rings of whole tiles, and where each one's begin."""
        tile = self.copies.tile[copies]
        if not self.job.dressed and not self.copies.moved_by.any():
            return self.period.outlines(tile, self.copies.step[copies])
        bases = [self._base(k) for k in range(len(self.period.site))]
        rings = Paths.concatenate(bases)
        starts = np.append(0, np.cumsum([len(base) for base in bases])).astype(np.intp)
        counts = np.diff(starts)[tile]
        stamped = rings.take(ranges(starts[:-1][tile], counts))
        items = np.append(0, np.cumsum(counts)).astype(np.intp)
        return stamped.shifted(np.repeat(self.copy_shifts[copies], counts)[stamped.owner]), items

    def _centres(self) -> Complexes:
        """The points of the period's tiles that are spread: the middles of their boxes."""
        result = []
        for tile in range(len(self.period.site)):
            low_x, low_y, high_x, high_y = self._base(tile).bounds
            result.append(complex((low_x + high_x) / 2, (low_y + high_y) / 2))
        return np.array(result)

    def _spread(self, apart: float) -> Stretch:
        """How far the layout is spread for the gap."""
        fine = self.job.accuracy / 8
        contours = [to_lines(self._base(tile), accuracy=fine) for tile in range(len(self.period.site))]
        try:
            return spread(contours, self._centres(), self.period.basis, apart + 2 * fine)
        except ValueError as error:
            raise JobError(str(error), remedy="Use --edges once, or leave --sheet out: pieces lie in a row.") from error

    def _row(self, placement: TilePlacement, apart: float) -> Complexes:
        """How far tiles are moved so that their boxes stand beside each other, from where the first one is."""
        right, moves = None, []
        for tile, step in zip(placement.tile.tolist(), placement.step, strict=True):
            low_x, _, high_x, _ = self._base(tile).bounds
            here = float(self.period.shifts(step[None])[0].real)
            moves.append(0.0 if right is None else right + apart - (low_x + here))
            right = high_x + here + moves[-1]
        return np.array(moves, np.complex128)

    def _pull(self, placement: TilePlacement) -> Complexes:
        """How far each tile is pulled; without a sheet, into a row."""
        if self.region is None and self.job.apart is not None:
            return self._row(placement, self.job.apart)
        if self.spread.is_identity:
            return np.zeros(len(placement.tile), np.complex128)
        place = self.period.at(self._centres()[placement.tile], placement.step)
        away = place - self.sheet.centre
        return self.spread(away) - away


def piece_areas(pieces: ClosedPieces) -> Floats:
    """The area of each piece, its holes taken off."""
    return np.asarray(np.add.reduceat(ring_areas(pieces.paths), pieces.items[:-1]))


def _inset(region: Region, width: float) -> Region:
    """What is left of a region inside a frame of this width. Raises JobError where nothing is."""
    try:
        border = offset(region.border, -width).paths
    except OffsetError as error:
        raise JobError(
            f"the sheet's outline leaves no frame of {width:g} mm: {error}", remedy="Use --fit whole or clip."
        ) from error
    if not len(border):
        raise JobError(
            f"the sheet is too small for a frame of {width:g} mm", remedy="Take a larger sheet, or --fit whole."
        )
    return Region(border)

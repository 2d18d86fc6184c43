"""Sheets of nested pieces: as many pieces as there are places for, or so many of each site, on as many sheets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.text import counted
from voronoi_tiles.base.values import shown
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import SHEETS_MOST, JobError
from voronoi_tiles.fabrication.layout import Layout, Piece, Sheet
from voronoi_tiles.fabrication.nest_filling import fill
from voronoi_tiles.fabrication.nest_growth import most_found, most_laid
from voronoi_tiles.fabrication.nest_kinds import NestKind, kinds_of, refuse_large
from voronoi_tiles.fabrication.nest_places import NESTED_MAX
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces, Progress, counts_of, has_search, most_pieces
from voronoi_tiles.fabrication.nested_pieces import as_laid, misplaced, piece_at, placed
from voronoi_tiles.fabrication.nested_regions import capped, lay_in_holes, lay_in_region, region_within


@dataclass(frozen=True, eq=False)
class Nesting:
    """The kinds of pieces that are nested, a layout whose sheet they are laid on, and how many sheets at most.

    `unnested` is the same sheet as the tessellation lies on it: a search begins with its places as well.
    """

    layout: Layout
    job: Job
    kinds: list[NestKind]
    most: int
    unnested: Layout | None = None

    @classmethod
    def of(cls, layout: Layout, job: Job, most: int = 1, unnested: Layout | None = None) -> Nesting:
        """The kinds of pieces of a layout."""
        kinds = kinds_of(layout.tiles, job.side_by_side, layout.budget.measured, grain=job.grain)
        return cls(layout, job, kinds, most, unnested)

    @cached_property
    def region(self) -> Any:
        """Where pieces may lie on a sheet that is drawn, a shapely polygon; None on a rectangle."""
        job, outline = self.job, self.layout.sheet.outline
        return None if outline is None else region_within(outline, job.margin, self.layout.budget.measured)

    @property
    def room(self) -> tuple[float, float]:
        """The rectangle for polygons, which reach half a gap beyond pieces, and may do so beyond the margin."""
        gap, sheet = self.job.side_by_side, self.layout.sheet
        if self.region is not None:
            x0, y0, x1, y1 = self.region.bounds
            return x1 - x0 + gap, y1 - y0 + gap
        return sheet.width - 2 * self.job.margin + gap, sheet.height - 2 * self.job.margin + gap

    @property
    def corner(self) -> complex:
        """Where that rectangle begins on the page; on a sheet that is drawn, places are those on the page."""
        return 0j if self.region is not None else (self.job.margin - self.job.side_by_side / 2) * (1 + 1j)

    def sheet(
        self, demand: Ints | None = None, progress: Progress | None = None, *, search: bool
    ) -> tuple[Layout, Ints]:
        """A sheet with as many pieces as places are found for, and how many of each kind (intp).

        With `search` they are looked for as long as the job says. Not more than `demand` of each kind (intp), where
        that says how many. Sheets that are drawn are not searched. Raises JobError where a piece is larger than the
        sheet.
        """
        which = np.arange(len(self.kinds)) if demand is None else np.flatnonzero(demand)
        some = replace(self, kinds=self._wanted(which, demand))
        most = None if demand is None else demand[which]
        found = some.places(self._tessellated(which), most, progress, search=search)
        found = found._replace(item=which[found.item])
        return self._laid(found), np.bincount(found.item, minlength=len(self.kinds))

    def places(
        self, known: Sequence[NestPlaces], demand: Ints | None, progress: Progress | None, *, search: bool
    ) -> NestPlaces:
        """Places for all kinds in their proportions, `known` ones or better; not more of each than a demand says."""
        refuse_large([kind.item for kind in self.kinds], self.room, self.job.side_by_side)
        left = np.full(len(self.kinds), NESTED_MAX) if demand is None else demand
        if self.region is not None:
            found = lay_in_region(self.kinds, self.region, left, even=demand is None)
        else:
            found = self._on_rectangle(known, demand, progress, search=search)
        found = self._kept(found)
        left = left - np.bincount(found.item, minlength=len(self.kinds))
        more = self._kept(NestPlaces.joined(found, lay_in_holes(self.kinds, found, left)))
        return max(found, more, key=lambda places: len(places.item))

    def _wanted(self, which: Ints, demand: Ints | None) -> list[NestKind]:
        """Some of the kinds, with the shares that a demand gives them."""
        kinds = []
        for k in which.tolist():
            item = self.kinds[k].item
            at = np.flatnonzero(which == item.like)
            share = item.share if demand is None else int(demand[k]) / int(demand.sum())
            item = item._replace(share=share, like=int(at[0]) if len(at) else None)
            kinds.append(self.kinds[k]._replace(item=item))
        return kinds

    def _tessellated(self, which: Ints) -> list[NestPlaces]:
        """The places of some kinds in the tessellation, where there is one."""
        if self.unnested is None:
            return []
        laid = as_laid(self.unnested, self.layout.tiles, self.kinds, self.corner, grain=self.job.grain)
        laid = laid.take(np.flatnonzero(np.isin(laid.item, which)))
        return [laid._replace(item=np.searchsorted(which, laid.item))]

    def _on_rectangle(
        self, known: Sequence[NestPlaces], demand: Ints | None, progress: Progress | None, *, search: bool
    ) -> NestPlaces:
        """Places on a rectangle, in the kinds' proportions; for not more of each than a demand says."""
        import shapely

        items = [kind.item for kind in self.kinds]
        if demand is None and search:
            return self._searched(items, known, progress)
        found = most_laid(items, self.room, known, self._kept)
        if demand is None:
            return found

        def filled(places: NestPlaces) -> NestPlaces:
            """Not more of each than there shall be; and more where there is room."""
            some = capped(places, demand)
            left = demand - np.bincount(some.item, minlength=len(items))
            return NestPlaces.joined(some, fill(items, shapely.box(0.0, 0.0, *self.room), some, left))

        found = filled(found)
        if search and len(found.item) < demand.sum():
            more = self._searched(items, [*known, found], progress)
            found = max(found, filled(more), key=lambda places: len(places.item))
        return found

    def _searched(
        self, items: Sequence[NestItem], known: Sequence[NestPlaces], progress: Progress | None
    ) -> NestPlaces:
        """Places that are found in the effort of the job, half of which is spyrrow's where that is installed."""
        effort, seed = self.job.effort, self.job.seed
        own = effort / 2 if has_search() else effort

        def tell(now: float) -> None:
            """Tell of the time that has passed."""
            if progress is not None:
                progress(min(now, effort), effort)

        found = most_found(items, self.room, known, own, seed, tell, self._kept)
        if own < effort:
            found = most_pieces(items, self.room, found, effort - own, seed, lambda now: tell(own + now))
        return found

    def _laid(self, places: NestPlaces) -> Layout:
        """The layout with pieces at places."""
        return placed(self.layout, [self._piece(*row) for row in places.rows()])

    def _piece(self, kind: int, turn: float, shift: complex) -> Piece:
        """What a recipe says of a place."""
        one = self.kinds[kind]
        return piece_at(self.layout.tiles, one.tile, one.middle, turn, shift + self.corner)

    def _kept(self, places: NestPlaces) -> NestPlaces:
        """The places that are as far apart as pieces have to be, from the left to the right.

        What is found is not trusted: of pieces that are too near, those with the most such neighbours go.
        """
        places = places.take(np.lexsort((places.shift.imag, places.shift.real)))
        wrong = misplaced(self._laid(places))
        kept = np.ones(len(places.item), np.bool_)
        while len(wrong):
            worst = int(np.argmax(np.bincount(wrong.ravel())))
            kept[worst] = False
            wrong = wrong[(wrong != worst).all(axis=1)]
        return places.take(np.flatnonzero(kept))


def counted_sheets(nesting: Nesting, demand: Ints, progress: Progress | None = None, *, search: bool) -> list[Layout]:
    """So many pieces of each kind (intp), on as few sheets as are found. Raises JobError where these are too many.

    Sheets are alike as long as so many pieces are left.
    """
    areas = nesting.layout.tile_areas[[kind.tile for kind in nesting.kinds]]
    many = crowd(nesting.layout.sheet, float(np.average(areas, weights=demand)))
    if many is not None:
        raise many
    left, most = demand, nesting.most
    sheets: list[Layout] = []
    fitted, count = 0, np.zeros(len(left), np.intp)
    while left.any() and len(sheets) < SHEETS_MOST:
        if not sheets or (count > left).any():
            few = left if left.sum() <= NESTED_MAX else left * NESTED_MAX // left.sum()
            layout, count = nesting.sheet(few, progress, search=search and len(sheets) < most)
        if not count.any():
            raise JobError("no places were found for any piece", remedy="Give a longer `effort`, or a larger sheet.")
        sheets.append(layout)
        left = left - count
        fitted += int(count.sum()) if len(sheets) <= most else 0
    if left.any() or len(sheets) > most:
        take = f"more than {SHEETS_MOST:,}" if left.any() else f"{len(sheets):,}"
        use = "" if left.any() else f"`sheets={len(sheets)}`, "
        raise JobError(
            f"{fitted:,} of {counted(int(demand.sum()), 'piece')} fit on {counted(most, 'sheet')}, and all would "
            f"take {take}",
            remedy=f"Use {use}a larger sheet, or a smaller margin or gap.",
        )
    return sheets


def crowd(sheet: Sheet, area: float) -> JobError | None:
    """What is wrong with a sheet that would hold too many pieces, of a mean area in square millimetres, if anything."""
    about = sheet.width * sheet.height / area
    if about <= NESTED_MAX:
        return None
    return JobError(
        f"the sheet would hold about {about:,.0f} pieces, and {NESTED_MAX:,} are the most that are nested",
        remedy="Take a smaller sheet or a larger design, or `layout='tessellated'`.",
    )


def demand_of_sites(nesting: Nesting, wanted: Sequence[int]) -> Ints:
    """How many of each kind make so many of each site: of a site, each kind has its share."""
    kinds, of = nesting.kinds, nesting.layout.period.site
    site = np.array([int(of[kind.tile]) for kind in kinds])
    demand = np.zeros(len(kinds), np.intp)
    for k, count in enumerate(wanted):
        own = np.flatnonzero(site == k)
        whole = sum(kinds[n].item.share for n in own)
        demand[own] = counts_of([kinds[n].item._replace(share=kinds[n].item.share / whole) for n in own], count)
    return demand


def wanted_of(job: Job, names: Sequence[str]) -> list[int] | None:
    """How many pieces of each site a job asks for; None where it does not say. Raises JobError for unknown names."""
    if job.count is None:
        return None
    if isinstance(job.count, int):
        return [job.count] * len(names)
    asked = dict(job.count)
    for name in asked:
        if name not in names:
            raise JobError(f"`count`: no site is called {shown(name)}", remedy=f"Its sites are {', '.join(names)}.")
    return [asked.get(name, 0) for name in names]

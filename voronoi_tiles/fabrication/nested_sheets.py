"""Sheets of nested pieces: as many pieces as there are places for, or so many of each site, on as many sheets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.text import counted
from voronoi_tiles.base.values import shown
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.layout import Layout, Piece
from voronoi_tiles.fabrication.nest_filling import fill
from voronoi_tiles.fabrication.nest_kinds import NestKind, kinds_of, refuse_large
from voronoi_tiles.fabrication.nest_patterns import lay_patterns
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces, Progress, counts_of, most_pieces
from voronoi_tiles.fabrication.nested_pieces import misplaced, piece_at, placed

_SHEETS_MOST: Final = 1_000
"""Sheets after which it is not found out how many more a count needs."""


@dataclass(frozen=True, eq=False)
class Nesting:
    """The kinds of pieces that are nested, and a layout whose sheet they are laid on."""

    layout: Layout
    job: Job
    kinds: list[NestKind]

    @classmethod
    def of(cls, layout: Layout, job: Job) -> Nesting:
        """The kinds of pieces of a layout. Raises JobError where one is larger than the sheet."""
        kinds = kinds_of(layout.tiles, job.side_by_side, layout.budget.measured, grain=job.grain)
        nesting = cls(layout, job, kinds)
        refuse_large([kind.item for kind in kinds], nesting.room, job.side_by_side)
        return nesting

    @property
    def room(self) -> tuple[float, float]:
        """The rectangle for polygons, which reach half a gap beyond pieces, and may do so beyond the margin."""
        job, sheet = self.job, self.layout.sheet
        more = job.side_by_side - 2 * job.margin
        return sheet.width + more, sheet.height + more

    @property
    def corner(self) -> complex:
        """Where that rectangle begins on the page."""
        return (self.job.margin - self.job.side_by_side / 2) * (1 + 1j)

    def sheet(
        self, demand: Ints | None = None, progress: Progress | None = None, *, search: bool
    ) -> tuple[Layout, Ints]:
        """A sheet with as many pieces as patterns, or with `search` that, find places for, and how many of each kind.

        Not more than `demand` of each kind (intp), where that says how many.
        """
        items = [kind.item for kind in self.kinds]
        if demand is None:
            found = lay_patterns(items, self.room)
            if search:
                found = most_pieces(items, self.room, found, self.job.effort, self.job.seed, progress)
        else:
            found = self._demanded(demand, progress, search=search)
        found = self._kept(found)
        return self._laid(found), np.bincount(found.item, minlength=len(items))

    def _demanded(self, demand: Ints, progress: Progress | None, *, search: bool) -> NestPlaces:
        """Places for at most so many of each kind, in these proportions."""
        import shapely

        which = np.flatnonzero(demand)
        items = [_alone(self.kinds[k].item, which, int(demand[k]) / int(demand.sum())) for k in which.tolist()]

        def capped(places: NestPlaces) -> NestPlaces:
            """Not more of each than there shall be; and more where there is room."""
            own = [np.flatnonzero(places.item == k) for k in range(len(items))]
            first = [one[np.argsort(places.shift.real[one], kind="stable")] for one in own]
            some = places.take(np.concatenate([one[: demand[k]] for one, k in zip(first, which, strict=True)]))
            left = demand[which] - np.bincount(some.item, minlength=len(items))
            return joined(some, fill(items, shapely.box(0.0, 0.0, *self.room), some, left))

        found = capped(lay_patterns(items, self.room))
        if search and len(found.item) < demand.sum():
            more = most_pieces(items, self.room, found, self.job.effort, self.job.seed, progress)
            found = max(found, capped(more), key=lambda places: len(places.item))
        return found._replace(item=which[found.item])

    def _laid(self, places: NestPlaces) -> Layout:
        """The layout with pieces at places."""
        return placed(self.layout, [self._piece(*row) for row in _rows(places)])

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


def counted_sheets(
    nesting: Nesting, wanted: Sequence[int], most: int, progress: Progress | None = None, *, search: bool
) -> list[Layout]:
    """So many pieces of each site, on as few sheets as are found, `most` at most. Raises JobError for more.

    Of a site, each kind has its share. Sheets are alike as long as so many pieces are left.
    """
    left = _of_kinds(nesting, wanted)
    sheets: list[Layout] = []
    fitted, count = 0, np.zeros(len(left), np.intp)
    while left.any() and len(sheets) < _SHEETS_MOST:
        if not sheets or (count > left).any():
            layout, count = nesting.sheet(left, progress, search=search and len(sheets) < most)
        if not count.any():
            raise JobError("no places were found for any piece", remedy="Give a longer `effort`, or a larger sheet.")
        sheets.append(layout)
        left = left - count
        fitted += int(count.sum()) if len(sheets) <= most else 0
    if len(sheets) > most:
        many = f"{len(sheets):,}" if not left.any() else f"more than {_SHEETS_MOST:,}"
        raise JobError(
            f"`count`: {fitted:,} of {counted(sum(wanted), 'piece')} fit on {counted(most, 'sheet')}, and all would "
            f"take {many}",
            remedy=f"Use `sheets={len(sheets)}`, a larger sheet, or a smaller margin or gap.",
        )
    return sheets


def _of_kinds(nesting: Nesting, wanted: Sequence[int]) -> Ints:
    """How many of each kind make so many of each site."""
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
    if "=" not in job.count:
        return [int(job.count)] * len(names)
    asked = dict(part.split("=") for part in job.count.split(","))
    for name in asked:
        if name not in names:
            raise JobError(f"`count`: no site is called {shown(name)}", remedy=f"Its sites are {', '.join(names)}.")
    return [int(asked.get(name, 0)) for name in names]


def _alone(item: NestItem, which: Ints, share: float) -> NestItem:
    """An item with another share among some of all items."""
    at = np.flatnonzero(which == item.like)
    return item._replace(share=share, like=int(at[0]) if len(at) else None)


def joined(one: NestPlaces, other: NestPlaces) -> NestPlaces:
    """Places, and others."""
    return NestPlaces(*(np.concatenate(parts) for parts in zip(one, other, strict=True)))


def _rows(places: NestPlaces) -> list[tuple[int, float, complex]]:
    """Item, turn and shift of each."""
    return list(zip(*(part.tolist() for part in places), strict=True))

"""Pieces nested on a sheet: as many as a search finds room for, turned as they may be, or where a file has them.

The places go into the file's recipe, by which the same file is made again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.text import counted
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import EFFORT_S, LAYOUTS, SHEETS_MOST, JobError
from voronoi_tiles.fabrication.layout import Layout, Sheet
from voronoi_tiles.fabrication.nest_places import read_places
from voronoi_tiles.fabrication.nest_search import Progress, has_search, least_counts
from voronoi_tiles.fabrication.nested_pieces import laid_again, numbered_on
from voronoi_tiles.fabrication.nested_sheets import Nesting, counted_sheets, crowd, demand_of_sites, wanted_of
from voronoi_tiles.fabrication.packed_sheets import stock

_UNSEARCHED: Final = (
    "spyrrow is not installed, so only our own search was made: with `pip install spyrrow` another may find places for "
    "more"
)


class Arranged(NamedTuple):
    """The tiles of a job on its sheets, one in most cases, and what is to be said of them.

    By `nesting` the tiles of each colour are nested on sheets of their own.
    """

    sheets: tuple[Layout, ...]
    said: tuple[str, ...] = ()
    nesting: Nesting | None = None


def arranged(lay: Callable[..., Layout], job: Job, sheet: Sheet, progress: Progress | None) -> Arranged:
    """The tiles of a job on its sheets; `lay`, given job and sheet, does as `lay_out`.

    The job of the layout says how they lie, and not how that was found. Raises what `lay_out` does, and JobError where
    pieces cannot be nested.
    """
    plain = replace(job, layout="tessellated", grain=False, effort=EFFORT_S, seed=0, count=None, sheets=None)
    pulled = job.layout == "auto" and job.apart and job.not_nestable is None
    if not (job.nests or job.count is not None or pulled):
        return Arranged((lay(job=plain, sheet=sheet),))
    if job.pack:
        said = () if has_search() else (_UNSEARCHED,)
        return Arranged((lay(job=plain, sheet=sheet),), said, _of_stock(lay, job))
    if job.gap is None and not job.kerf:
        plain = replace(plain, gap=job.side_by_side)
    saved = None if job.layout in LAYOUTS else read_places(job.layout)
    if saved is not None and not saved.pieces:
        tessellated = lay(job=plain, sheet=sheet)
        return Arranged((tessellated,), saved.doubts(tessellated.design, job.layout))
    base = _base(lay, plain, sheet)
    if saved is not None:
        again = laid_again(base, saved.pieces, job.layout, grain=job.grain)
        return Arranged(tuple(numbered_on([again], saved.first)), saved.doubts(base.design, job.layout))
    nest = _densest if job.count is None else _counted
    return nest(base, partial(lay, job=plain, sheet=sheet), job, progress)


def _base(lay: Callable[..., Layout], plain: Job, sheet: Sheet) -> Layout:
    """A layout of pieces to be nested on a sheet: nothing is to be filled, one tile stands for all of its kind."""
    return replace(lay(job=replace(plain, layout="nested"), sheet=Sheet(0.0, 0.0, None, 0j)), sheet=sheet)


def _of_stock(lay: Callable[..., Layout], job: Job) -> Nesting:
    """The pieces of a job as they are nested on sheets of the stock."""
    page = stock(job)
    one_sheet = replace(
        job,
        frame=None,
        offset=None,
        into=None,
        stock=None,
        only_colour=None,
        sheets=None,
        sheet=(page.width, page.height),
        fit="whole",
        colours="none",
        pack=False,
        gap=job.side_by_side if job.gap is None and not job.kerf else job.gap,
    )
    base = _base(lay, replace(one_sheet, grain=False, effort=EFFORT_S, seed=0), page)
    return Nesting.of(base, one_sheet, job.sheets or SHEETS_MOST)


def _counted(base: Layout, lay: Callable[[], Layout], job: Job, progress: Progress | None) -> Arranged:
    """So many pieces of each site as a job asks for, on its sheets."""
    wanted = wanted_of(job, [site.name for site in base.design.noded])
    assert wanted is not None, "there is a count"
    search = job.layout == "nested"
    unnested, _ = _tried(lay)
    nesting = Nesting.of(base, job, job.sheets or 1, unnested)
    sheets = numbered_on(counted_sheets(nesting, demand_of_sites(nesting, wanted), progress, search=search), 1)
    said = [_UNSEARCHED] if search and not has_search() and not isinstance(job.sheet, str) else []
    said += [f"{counted(len(sheets), 'sheet')}: {'; '.join(map(_counts, sheets))}"] if len(sheets) > 1 else []
    return Arranged(tuple(sheets), tuple(said))


def _densest(base: Layout, lay: Callable[[], Layout], job: Job, progress: Progress | None) -> Arranged:
    """The pieces of `base` nested on its sheet, or as `lay` lays them where that is as good; and what is to be said."""
    many = crowd(base.sheet, float(base.tile_areas.mean()))
    if many is not None:
        if job.layout == "auto":
            return Arranged((lay(),))
        raise many
    unnested, refusal = _tried(lay)
    fewer = 0 if unnested is None else len(unnested.copies.tile)
    search = job.layout == "nested"
    nested, _ = Nesting.of(base, job, unnested=unnested).sheet(progress=progress, search=search)
    count = len(nested.pieces)
    said = [_UNSEARCHED] if search and not has_search() else []
    if unnested is not None and count <= fewer:
        said.append(f"nested there would be {_counts(nested)}: they lie as in the tessellation")
        return Arranged((unnested,), tuple(said))
    if not count and job.layout == "auto" and refusal is not None:
        raise refusal
    if not count:
        raise JobError("no places were found for any piece", remedy="Give a longer `effort`, or a larger sheet.")
    said += _uneven(nested)
    as_drawn = counted(0, "piece") if unnested is None else _counts(unnested)
    said.append(f"nested are {_counts(nested)}: as in the tessellation there would be {as_drawn}")
    return Arranged((nested,), tuple(said))


def _tried(lay: Callable[[], Layout]) -> tuple[Layout, None] | tuple[None, JobError]:
    """What `lay` lays, or its refusal: what is hooked, or does not fit as it lies, may fit by itself."""
    try:
        return lay(), None
    except JobError as error:
        return None, error


def _uneven(layout: Layout) -> list[str]:
    """That a site has too few pieces for its share of the tessellation, which a search may bring about, in words."""
    names = [site.name for site in layout.design.noded]
    count, share = (
        np.bincount(layout.period.site[which], minlength=len(names)) for which in (layout.copies.tile, slice(None))
    )
    few = count < least_counts(share / share.sum(), int(count.sum()))
    return [
        f"of {names[k]} there are {count[k]:,}, fewer than its share of the tessellation: `count` says how many of each"
        for k in np.flatnonzero(few).tolist()
    ]


def _counts(layout: Layout) -> str:
    """How many pieces a layout has; of several sites, each site's."""
    names = [site.name for site in layout.design.noded]
    of_site = np.bincount(layout.period.site[layout.copies.tile], minlength=len(names)).tolist()
    each = [f"{count:,} {name}" for count, name in zip(of_site, names, strict=True)]
    return counted(sum(of_site), "piece") + (f" ({', '.join(each)})" if len(each) > 1 else "")

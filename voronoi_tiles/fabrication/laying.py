"""The tiles of a job on its sheets: as they come, at a scale that is found, or where the picture has them."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.arc_fitting import curve_fit
from voronoi_tiles.fabrication.dressed_tiles import DressedTiles
from voronoi_tiles.fabrication.engraving import piece_numbers
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.kerf import Compensation
from voronoi_tiles.fabrication.layout import Layout, Sheet, lay_out
from voronoi_tiles.fabrication.nest_search import Progress
from voronoi_tiles.fabrication.nesting import Arranged, arranged
from voronoi_tiles.fabrication.sheets import read_sheet
from voronoi_tiles.fabrication.sizing import sized
from voronoi_tiles.formats.presets import Format
from voronoi_tiles.vector.tessellation import Tessellation


def laid(
    design: Design, tessellation: Tessellation, job: Job, curves: str, form: Format, progress: Progress | None
) -> Arranged:
    """The tiles of a job, of a design or on a sheet that is found for a number of pieces; and what is to be said.

    `curves` are those of the file, `form` is its format. Raises what `lay_out`, `sized` and `arranged` do.
    """
    if job.pieces is None:
        lay = partial(_lay, design, tessellation, curves, form)
        return arranged(lay, job, read_sheet(job, AccuracyBudget.of(job, curves, form)), progress)
    layout, found = sized(design, tessellation, _picture(job), curves, form)
    return Arranged((_cut(layout, job.kerf, curves, form),), (found,))


def unplaced(
    design: Design, tessellation: Tessellation, job: Job, curves: str, form: Format, _: Progress | None
) -> Arranged:
    """The tiles of a job one of each, with the sheet on which somebody else places them. Raises what `lay_out` does."""
    sheet = read_sheet(job, AccuracyBudget.of(job, curves, form))
    layout = _lay(design, tessellation, curves, form, job=job, sheet=Sheet(0.0, 0.0, None, 0j))
    return Arranged((replace(layout, sheet=sheet),))


def _picture(job: Job) -> Job:
    """The job that draws where tiles lie: in the picture, packed tiles touch, and have no kerf between them."""
    return replace(job, kerf=0.0) if job.pack else job


def _lay(design: Design, tessellation: Tessellation, curves: str, form: Format, *, job: Job, sheet: Sheet) -> Layout:
    """Lay the tiles of a job on a sheet, those that are packed as in their picture."""
    picture = _picture(job)
    budget = AccuracyBudget.of(picture, curves, form)
    if picture.kerf != job.kerf:
        sheet = read_sheet(picture, budget)
    fit = curve_fit(picture, curves, budget, design.unit_mm)
    return _cut(lay_out(design, tessellation, picture, sheet, budget, fit), job.kerf, curves, form)


def _cut(picture: Layout, kerf: float, curves: str, form: Format) -> Layout:
    """The tiles of a picture where they lie there, by the same numbers, with a kerf; millimetres."""
    if picture.job.kerf == kerf:
        return picture
    job, page, tessellation = replace(picture.job, kerf=kerf), picture.tiles.page, picture.tessellation
    budget = AccuracyBudget.of(job, curves, form)
    fit = curve_fit(job, curves, budget, picture.design.unit_mm)
    period = tessellation.period if fit is None else tessellation.approximated(fit)
    tiles = DressedTiles(period.placed(page.factor, page.shift), page, Compensation(job, budget))
    return replace(
        picture,
        job=job,
        sheet=read_sheet(job, budget),  # of which a frame leaves half the kerf
        budget=budget,
        tiles=tiles,
        spaced=tiles.period,
        numbers=piece_numbers(picture, picture.contours) if job.labels == "number" else None,
    )

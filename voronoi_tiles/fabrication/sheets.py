"""Sheets: a rectangle, or the closed paths of a drawing."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.job import SHEET_MAX, SHEET_MIN, Job, JobError
from voronoi_tiles.fabrication.layout import Sheet
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.paths.biarcs import to_arcs
from voronoi_tiles.paths.offset import OffsetError, offset
from voronoi_tiles.paths.orientation import oriented, simple
from voronoi_tiles.paths.paths import Paths

_CLOSED = 1e-3
"""How far apart the ends of a path may be that is meant to be closed; millimetres."""

_PIECES_MAX = 50_000
"""Most lines and curves that bound a sheet; a count."""

_RINGS_MAX = 1000
"""Most closed paths that bound a sheet; a count. More are a drawing, and no sheet."""


def read_sheet(job: Job, budget: AccuracyBudget) -> Sheet:
    """The page of a job and the region that is filled, its margin taken off.

    Raises JobError where nothing is left of it, DrawingError where a drawing cannot be read.
    """
    if job.sheet is None:
        return Sheet(0.0, 0.0, None, 0j)
    if not isinstance(job.sheet, str):
        width, height = job.sheet
        m = job.margin + job.kerf / 2
        if 2 * m >= min(width, height):
            raise JobError(
                f"a kerf of {job.kerf:g} mm leaves nothing of a sheet of {width:g} x {height:g} mm",
                remedy="Take a larger sheet, or a smaller margin or kerf.",
            )
        region = Region.rectangle(m, m, width - m, height - m)
        return Sheet(width, height, region, complex(width, height) / 2)
    return _drawn_sheet(job.sheet, job, budget)


def _drawn_sheet(name: str, job: Job, budget: AccuracyBudget) -> Sheet:
    """Read the closed paths of a drawing as a sheet."""
    from voronoi_tiles.formats.reading import read_drawing

    drawing = read_drawing(name)
    rings = Paths.concatenate([shape.paths for shape in drawing.shapes])
    closed = _closed_rings(rings)
    if not len(closed):
        raise JobError(
            f"{name} has no closed path",
            remedy="Draw the sheet's outline as a closed path, or give its size: 600x300mm.",
        )
    _refuse_size(name, closed)
    if len(closed) > _RINGS_MAX:
        raise JobError(f"{name} has {len(closed)} closed paths", remedy=f"Bound a sheet by {_RINGS_MAX} at most.")
    border = oriented(to_arcs(closed, accuracy=budget.arcs))
    if not len(border):
        raise JobError(f"the closed paths of {name} enclose nothing, or cross themselves", remedy="Draw one outline.")
    if not simple(border):
        raise JobError(
            f"the closed paths of {name} cross or touch themselves or each other",
            remedy="Leave only the sheet's outline and its holes (Path > Union in Inkscape).",
        )
    low_x, low_y, high_x, high_y = border.bounds
    page = drawing.width is not None and drawing.height is not None
    if not page:
        border = border.moved(1.0, -complex(low_x, low_y))
    width = float(drawing.width) if drawing.width is not None else high_x - low_x
    height = float(drawing.height) if drawing.height is not None else high_y - low_y
    margin = job.margin + job.kerf / 2
    if margin > 0.0:
        try:
            border = offset(border, -margin).paths
        except OffsetError as error:
            raise JobError(
                f"the margin cannot be applied to {name}: {error}", remedy="Use another `margin`."
            ) from error
        if not len(border):
            raise JobError(f"a margin of {margin:g} mm leaves nothing of {name}", remedy="Use a smaller `margin`.")
    left, bottom, right, top = border.bounds
    return Sheet(width, height, Region(border), complex(left + right, bottom + top) / 2)


def _refuse_size(name: str, closed: Paths) -> None:
    """Refuse outlines that are no sheet's by their size, or their number of lines."""
    left, bottom, right, top = closed.bounds
    size = max(right - left, top - bottom, abs(left), abs(bottom), abs(right), abs(top))
    if size > SHEET_MAX or min(right - left, top - bottom) < SHEET_MIN:
        raise JobError(
            f"the closed paths of {name} are {right - left:.4g} x {top - bottom:.4g} mm, "
            f"from ({left:.4g}, {bottom:.4g})",
            remedy=f"Draw a sheet of {SHEET_MIN:g} to {SHEET_MAX:,.0f} mm, on its page; is its unit right?",
        )
    if len(closed.start) > _PIECES_MAX:
        raise JobError(
            f"the closed paths of {name} have {len(closed.start):,} lines and curves",
            remedy=f"Simplify them: {_PIECES_MAX:,} are the most.",
        )


def _closed_rings(paths: Paths) -> Paths:
    """The paths that are closed, or whose ends meet."""
    start, end = paths.start[paths.offsets[:-1]], paths.end[paths.offsets[1:] - 1]
    meets = np.flatnonzero(paths.closed | (np.abs(start - end) <= _CLOSED))
    chosen = paths.take(meets)
    # The last piece ends where the first one starts, to the bit.
    chosen.end[chosen.offsets[1:] - 1] = chosen.start[chosen.offsets[:-1]]
    chosen.closed[:] = True
    return chosen

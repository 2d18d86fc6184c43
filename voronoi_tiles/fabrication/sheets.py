"""Sheets: a rectangle, or what the paths of a drawing bound."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.job_options import SHEET_MAX, SHEET_MIN
from voronoi_tiles.fabrication.layout import Sheet
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.sheet_outline import SheetOutline, reason_open, sheet_outline
from voronoi_tiles.formats.caveats import caveats, unit_caveat
from voronoi_tiles.formats.page import fitting_page
from voronoi_tiles.paths.biarcs import to_arcs
from voronoi_tiles.paths.offset import OffsetError, offset
from voronoi_tiles.paths.orientation import oriented, simple
from voronoi_tiles.paths.paths import Paths

if TYPE_CHECKING:
    from voronoi_tiles.formats.reading import ReadDrawing

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
    """Read what the paths of a drawing bound as a sheet."""
    from voronoi_tiles.formats.reading import read_drawing

    drawing = read_drawing(name)
    outline = sheet_outline(Paths.concatenate([shape.paths for shape in drawing.shapes]))
    _refuse_forks(name, drawing, outline)
    closed = outline.rings
    _refuse_size(name, drawing, closed)
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
    if drawing.width is None or drawing.height is None:
        width, height, corner = fitting_page(*border.bounds)
        border = border.moved(1.0, -corner)
    else:
        width, height = drawing.width, drawing.height
    whole = border
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
    notes = (*caveats(drawing, name), *_left_out(name, drawing, outline))
    return Sheet(width, height, Region(border), complex(left + right, bottom + top) / 2, notes, whole)


def _shown(drawing: ReadDrawing, place: complex) -> str:
    """A place as the file's own program shows it: SVG from the page's upper left corner, y down; DXF y up."""
    y = (drawing.height or 0.0) - place.imag if drawing.format == "svg" else place.imag
    return f"({place.real:.6g}, {y:.6g})"


def _refuse_forks(name: str, drawing: ReadDrawing, outline: SheetOutline) -> None:
    """Refuse drawings without a ring, and loose lines that may bound the sheet in more than one way."""
    rings, left = outline.rings, outline.left
    reason, place = reason_open(outline) if not len(rings) or len(outline.forks) else ("", None)
    at = "" if place is None else f" at {_shown(drawing, place)} mm"
    if not len(rings):
        raise JobError(
            f"{name} has no closed path{': ' if reason else ''}{reason}{at}",
            remedy="Draw the sheet's outline as a closed path, or of lines whose ends meet two by two, or give its "
            "size: 600x300mm.",
        )
    if not len(outline.forks):
        return
    low_x, low_y, high_x, high_y = rings.bounds
    x0, y0, x1, y1 = left.bounds
    # What lies within is a drawing on the sheet, and is left out.
    if x0 < low_x or y0 < low_y or x1 > high_x or y1 > high_y:
        raise JobError(
            f"{name} bounds no sheet: {reason}{at}",
            remedy="Leave only the sheet's outline and its holes, each of lines whose ends meet two by two.",
        )


def _left_out(name: str, drawing: ReadDrawing, outline: SheetOutline) -> list[str]:
    """Say which lines bound nothing."""
    count = len(outline.left)
    if not count:
        return []
    place = _shown(drawing, complex(outline.left.start[0]))
    what = f"{count:,} loose lines bound nothing and were" if count > 1 else "a loose line bounds nothing and was"
    return [f"{name}: {what} left out, the first from {place} mm"]


def _refuse_size(name: str, drawing: ReadDrawing, closed: Paths) -> None:
    """Refuse outlines that are no sheet's by their size, or their number of lines."""
    left, bottom, right, top = closed.bounds
    size = max(right - left, top - bottom, abs(left), abs(bottom), abs(right), abs(top))
    if size > SHEET_MAX or min(right - left, top - bottom) < SHEET_MIN:
        raise JobError(
            f"the closed paths of {name} are {right - left:.4g} x {top - bottom:.4g} mm, "
            f"from ({left:.4g}, {bottom:.4g})",
            remedy=f"Draw a sheet of {SHEET_MIN:g} to {SHEET_MAX:,.0f} mm, on its page"
            + ("; is its unit right?" if drawing.unit_known else f": {unit_caveat(drawing)}."),
        )
    if len(closed.start) > _PIECES_MAX:
        raise JobError(
            f"the closed paths of {name} have {len(closed.start):,} lines and curves",
            remedy=f"Simplify them: {_PIECES_MAX:,} are the most.",
        )

"""Sheets: a rectangle, or the closed paths of a drawing."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.layout import Sheet
from voronoi_tiles.vector.curves.biarcs import to_arcs
from voronoi_tiles.vector.curves.offset import OffsetError, offset
from voronoi_tiles.vector.curves.paths import Ints, Paths
from voronoi_tiles.vector.curves.winding import item_winding
from voronoi_tiles.vector.sheet.faces import ring_areas
from voronoi_tiles.vector.sheet.region import Region

_CLOSED = 1e-3
"""How far apart the ends of a path may be that is meant to be closed; millimetres."""


def read_sheet(job: Job) -> Sheet:
    """Give the page of a job and the region that is filled, its margin taken off.

    Raises JobError where nothing is left of it, DrawingError where a drawing cannot be read.
    """
    if job.sheet is None:
        return Sheet(0.0, 0.0, None, 0j)
    if not isinstance(job.sheet, str):
        width, height = job.sheet
        m = job.margin + job.kerf / 2
        if 2 * m >= min(width, height):
            raise JobError("the margin and the kerf leave nothing of the sheet", remedy="Make the margin smaller.")
        region = Region.rectangle(m, m, width - m, height - m)
        return Sheet(width, height, region, complex(width, height) / 2)
    return _drawn_sheet(job.sheet, job)


def _drawn_sheet(name: str, job: Job) -> Sheet:
    """Read the closed paths of a drawing as a sheet."""
    from voronoi_tiles.drawings import read_drawing

    drawing = read_drawing(name)
    rings = Paths.concatenate([shape.paths for shape in drawing.shapes])
    closed = _closed_rings(rings)
    if not len(closed):
        raise JobError(
            f"{name} has no closed path",
            remedy="Draw the sheet's outline as a closed path, or give its size: 600x300mm.",
        )
    border = _oriented(to_arcs(closed, accuracy=job.accuracy / 2))
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
                f"the margin cannot be applied to {name}: {error}", remedy="Use another --margin."
            ) from error
        if not len(border):
            raise JobError(f"a margin of {margin:g} mm leaves nothing of {name}", remedy="Use a smaller --margin.")
    left, bottom, right, top = border.bounds
    return Sheet(width, height, Region(border), complex(left + right, bottom + top) / 2)


def _closed_rings(paths: Paths) -> Paths:
    """The paths that are closed, or whose ends meet."""
    start, end = paths.start[paths.offsets[:-1]], paths.end[paths.offsets[1:] - 1]
    meets = np.flatnonzero(paths.closed | (np.abs(start - end) <= _CLOSED))
    chosen = paths.take(meets)
    # The last piece ends where the first one starts, to the bit.
    chosen.end[chosen.offsets[1:] - 1] = chosen.start[chosen.offsets[:-1]]
    chosen.closed[:] = True
    return chosen


def _oriented(rings: Paths) -> Paths:
    """Turn rings so that those inside an even number of others run counter-clockwise, all others clockwise."""
    areas = ring_areas(rings)
    rings = rings.take(np.flatnonzero(areas != 0))
    areas = areas[areas != 0]
    points = rings.start[rings.offsets[:-1]]
    inside = np.abs(item_winding(rings, rings.offsets, points)) % 2
    np.fill_diagonal(inside, 0)
    depth: Ints = inside.sum(axis=0)
    turn = (areas > 0) != (depth % 2 == 0)
    turned = rings.reversed(turn)
    order = np.argsort(depth % 2, kind="stable")
    return turned.take(order)

"""The size for a number of pieces: the scale of a design at which a sheet holds them, or the sheet that does.

How many whole tiles a sheet holds is counted by laying them out. The count does not fall evenly with the scale, since
tiles come and go by rows: sizes are tried in steps of some percent, from the side where pieces are too large or the
sheet is too small, until so many fit; then the last step is halved. A size between two that were tried may do as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.arc_fitting import curve_fit
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.job_options import SHEET_MAX
from voronoi_tiles.fabrication.layout import Layout, lay_out, refilled
from voronoi_tiles.fabrication.sheets import read_sheet
from voronoi_tiles.fabrication.tile_placement import group_box
from voronoi_tiles.formats.presets import Format
from voronoi_tiles.paths.areas import item_areas, ring_areas
from voronoi_tiles.paths.segments import item_boxes
from voronoi_tiles.vector.proof import proved_tiles
from voronoi_tiles.vector.tessellation import Tessellation

_STEP: Final = 0.97
"""From one scale that is tried to the next; a factor."""

_STEPS: Final = 100
"""Most scales that are tried: down to a twentieth of the largest that could be."""

_HALVINGS: Final = 8
"""Of the last step: a ten thousandth is left."""

_DIGITS: Final = 4
"""Significant digits of a scale; it is rounded down."""

_LOWER: Final = 20
"""How often a scale is lowered by a unit of its last digit, or a sheet grows by a millimetre, where what was counted
roughly is not what is laid out: the scaled design has other curves than it had."""

_SHAPES: Final = (1.0, 1.4, 1 / 1.4, 2.0, 0.5)
"""Widths of the sheets that are tried, in heights."""

_GROWTH: Final = 1.04
"""From one sheet that is tried to the next; a factor of its sides."""

_GROWN: Final = 120
"""Most sizes of a sheet that are tried for each shape."""

_HALVED: Final = 5
"""Halvings of the last step of a sheet."""


def sized(design: Design, tessellation: Tessellation, job: Job, curves: str, form: Format) -> tuple[Layout, str]:
    """The layout of a job with a number of pieces, of the scaled design or on the sheet that is found; a line on it.

    Its job has no number of pieces. `curves` are those of the file: exact, arc, spline or polyline; `form` is its
    format. Raises JobError where no size that is tried will do.
    """
    assert job.pieces is not None
    look = _with_sheet if job.sheet is None else _scaled
    return look(design, tessellation, job, curves, form, job.pieces)


def _scaled(
    design: Design, tessellation: Tessellation, job: Job, curves: str, form: Format, pieces: int
) -> tuple[Layout, str]:
    """The layout at the largest scale of those tried at which a sheet holds so many tiles."""
    job = replace(job, pieces=None)
    budget = AccuracyBudget.of(job, curves, form)
    sheet = read_sheet(job, budget)
    assert sheet.region is not None
    areas = item_areas(*tessellation.period.own_outlines) * design.unit_mm**2
    # So many of the smallest tile have the area of the region.
    largest = math.sqrt(float(ring_areas(sheet.region.border).sum()) / (pieces * float(areas.min())))

    def fits(scale: float) -> bool:
        fit = curve_fit(job, curves, budget, design.unit_mm * scale)
        return (
            _count(partial(lay_out, design, tessellation, job, sheet, budget, fit, scale=scale, rough=True)) >= pieces
        )

    scale = _rounded(largest)
    left, bottom, right, top = sheet.region.bounds
    apart = job.apart or 0.0
    # Discs of the gap about the pieces do not overlap, even where pieces are points.
    crowded = pieces * math.pi * (apart / 2) ** 2 > (right - left + apart) * (top - bottom + apart)
    for _ in range(0 if crowded else _STEPS):
        if fits(scale):
            break
        scale = _rounded(scale * _STEP)
    else:
        raise JobError(
            f"the sheet holds {pieces:,} `pieces` at no scale that was tried",
            remedy="Take fewer, a larger sheet, or a smaller kerf, gap or margin.",
        )
    low, high = scale, min(scale / _STEP, largest)
    for _ in range(_HALVINGS):
        middle = _rounded((low + high) / 2)
        if middle == low:
            middle = _rounded(low + _unit(low))  # what lies between is rounded down to what was tried
        low, high = (middle, high) if middle < high and fits(middle) else (low, middle)
    scale = low
    for _ in range(_LOWER):
        made = design.scaled(scale)
        own = proved_tiles(made.noded, made.group, made.lattice)[0][0].tessellation
        layout = _laid(partial(lay_out, made, own, job, sheet, budget, curve_fit(job, curves, budget, made.unit_mm)))
        if layout is not None and len(layout.copies.tile) >= pieces:
            return layout, f"scale {scale:.{_DIGITS}g}: {_tile_size(layout)}"
        scale = _rounded(scale * (1 - 10.0 ** (1 - _DIGITS)))
    raise JobError(
        f"{pieces:,} `pieces` fit on the sheet at a scale of {low:.{_DIGITS}g} by the design's curves alone",
        remedy="Ask for one piece more or less.",
    )


def _with_sheet(
    design: Design, tessellation: Tessellation, job: Job, curves: str, form: Format, pieces: int
) -> tuple[Layout, str]:
    """The layout on the smallest sheet, of those tried, that holds so many tiles; whole millimetres."""
    job = replace(job, pieces=None, sheet=(SHEET_MAX, SHEET_MAX))  # until it is found
    budget = AccuracyBudget.of(job, curves, form)
    areas = item_areas(*tessellation.period.own_outlines) * design.unit_mm**2
    border = job.margin + job.kerf / 2 + job.frame_width
    least = math.sqrt(pieces * float(areas.min()))
    box = item_boxes(*tessellation.period.own_outlines)
    extent = float(
        np.hypot(box[:, 2] - box[:, 0], box[:, 3] - box[:, 1]).max() + np.abs(tessellation.period.basis).sum()
    )
    side = 4 * (border + extent * design.unit_mm)  # some tiles fit, however they are turned
    start = replace(job, sheet=(side, side), margin=0.0)
    fit = curve_fit(job, curves, budget, design.unit_mm)
    base = lay_out(design, tessellation, start, read_sheet(start, budget), budget, fit, rough=True)

    def filled(size: tuple[float, float]) -> Layout | None:
        """The tiles on a sheet of a size; None where too few fit."""
        wanted = replace(job, sheet=size)
        layout = _laid(lambda: refilled(replace(base, job=wanted), sheet=read_sheet(wanted, budget)))
        return layout if layout is not None and len(layout.copies.tile) >= pieces else None

    found: list[tuple[float, tuple[float, float]]] = []
    for shape in _SHAPES:
        best = _grown(shape, least, border, filled)
        if best is not None:
            found.append((best[0] * best[1], best))
    if not found:
        raise JobError(
            f"no sheet that was tried holds {pieces:,} `pieces`", remedy="Take fewer, or a smaller kerf, gap or margin."
        )
    size = min(found)[1]
    for _ in range(_LOWER):
        done = replace(job, sheet=size)
        layout = _laid(partial(lay_out, design, tessellation, done, read_sheet(done, budget), budget, fit))
        if layout is not None and len(layout.copies.tile) >= pieces:
            return layout, f"sheet {size[0]:g} x {size[1]:g} mm: {_tile_size(layout)}"
        size = (size[0] + 1.0, size[1] + 1.0)
    raise JobError(f"no sheet was found for {pieces:,} `pieces`", remedy="Ask for one piece more or less.")


def _grown(
    shape: float, least: float, border: float, filled: Callable[[tuple[float, float]], Layout | None]
) -> tuple[float, float] | None:
    """The smallest sheet of a shape that will do, what its tiles leave free taken off; None where none will."""

    def size(side: float) -> tuple[float, float]:
        return _whole_mm(side * math.sqrt(shape) + 2 * border), _whole_mm(side / math.sqrt(shape) + 2 * border)

    side = least
    for _ in range(_GROWN):
        if max(size(side)) > SHEET_MAX:
            return None
        layout = filled(size(side))
        if layout is not None:
            break
        side *= _GROWTH
    else:
        return None
    low, high = side / _GROWTH, side
    for _ in range(_HALVED):
        middle = (low + high) / 2
        smaller = filled(size(middle))
        if smaller is not None:
            high, layout = middle, smaller
        else:
            low = middle
    x0, y0, x1, y1 = group_box(layout.spaced, layout.placement.tile, layout.spaced.shifts(layout.placement.step))
    trimmed = _whole_mm(x1 - x0 + 2 * border), _whole_mm(y1 - y0 + 2 * border)
    return trimmed if filled(trimmed) is not None else size(high)


def _count(lay: Callable[[], Layout]) -> int:
    """How many whole tiles a layout has; 0 where there is none."""
    layout = _laid(lay)
    return 0 if layout is None else len(layout.copies.tile)


def _laid(lay: Callable[[], Layout]) -> Layout | None:
    """A layout; None where no tile fits, or none survives kerf and fillet."""
    try:
        return lay()
    except JobError:
        return None


def _tile_size(layout: Layout) -> str:
    """How large the largest tile is, as the design has it: copies that are turned against it have other boxes."""
    own = np.unique(layout.period.site, return_index=True)[1]  # the first of each site
    box = item_boxes(*layout.period.own_outlines)[own]
    width, height = box[:, 2] - box[:, 0], box[:, 3] - box[:, 1]
    k = int(np.argmax(width * height))
    return f"a tile is {width[k]:.1f} x {height[k]:.1f} mm"


def _rounded(scale: float) -> float:
    """A scale rounded down to some digits."""
    unit = _unit(scale)
    return float(f"{math.floor(scale / unit * (1 + 1e-12)) * unit:.{_DIGITS}g}")


def _unit(scale: float) -> float:
    """One of a scale's last digit."""
    return 10.0 ** (math.floor(math.log10(scale)) + 1 - _DIGITS)


def _whole_mm(length: float) -> float:
    """A length rounded up to whole millimetres; a nanometre more is none."""
    return float(math.ceil(length - 1e-6))

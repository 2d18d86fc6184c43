"""A picture of where the stages differ, and by how much: white where they agree."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.crosscheck.check_report import CheckReport, Figure
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.raster.frame import rectangle_frame
from voronoi_tiles.raster.line_coverage import coverage

_SIDE = 1024
"""The longer side of the picture; pixels."""

_RADIUS = 4.0
"""The radius of a mark; pixels."""

_MOST = 20_000
"""Most marks of a figure that are drawn, the worst ones; a count."""

_MILDEST, _WORST = -9.0, 0.0
"""The deviations where the colours begin and end; decimal logarithm, in samples."""


def difference_pixels(report: CheckReport, lattice: Lattice, outlines: Complexes) -> NDArray[np.uint8]:
    """The failures of a report as a picture of one cell, (rows, columns, 3): white, where there is none.

    Marks run from yellow (1e-9 of a sample off, or less) over red to black (a sample or more, or no measure at all),
    over the outlines in grey: segments (n, 2) for all copies in the cell's surroundings (see `region`).
    """
    x0, y0, x1, y1 = region(report, lattice)
    scale = _SIDE / max(x1 - x0, y1 - y0)
    width, height = max(1, math.ceil((x1 - x0) * scale)), max(1, math.ceil((y1 - y0) * scale))
    frame = rectangle_frame((x0, y1 - height / scale, x0 + width / scale, y1), width, height)
    pixels = np.full((height, width, 3), 255.0, np.float32)
    if not report.passed:
        strength = 0.35 * coverage(outlines, 1.0, frame)[..., None]
        pixels -= strength * pixels
    for figure in report.figures:
        place, colour = _marks(figure, report, lattice)
        # The mildest first, so that the worst are on top.
        for step in np.unique(colour, axis=0)[::-1]:
            chosen = place[(colour == step).all(axis=1)]
            strength = coverage(np.stack((chosen, chosen), axis=1), 2 * _RADIUS, frame)[..., None]
            pixels += strength * (step.astype(np.float32) - pixels)
    return np.asarray(np.rint(pixels), np.uint8)


def region(report: CheckReport, lattice: Lattice) -> tuple[float, float, float, float]:
    """The rectangle about the image's cell: x0, y0, x1, y1."""
    a, b = lattice.reduced_basis
    corners = report.frame.origin + np.array([0, a, a + b, b])
    return float(corners.real.min()), float(corners.imag.min()), float(corners.real.max()), float(corners.imag.max())


def _marks(figure: Figure, report: CheckReport, lattice: Lattice) -> tuple[Complexes, NDArray[np.uint8]]:
    """The places of a figure's failures, moved into the cell, and their colours: uint8 (n, 3)."""
    order = np.argsort(-figure.marks.excess, kind="stable")[:_MOST]
    place, excess = figure.marks.place[order], figure.marks.excess[order]
    a, b = lattice.reduced_basis
    s, t = lattice.reduced.fractional(place - report.frame.origin)
    place = place - np.floor(s) * a - np.floor(t) * b
    with np.errstate(divide="ignore"):
        size = np.log10(excess / report.frame.pixel)
    share = np.clip((size - _MILDEST) / (_WORST - _MILDEST), 0.0, 1.0)
    share = np.round(np.nan_to_num(share, nan=1.0) * 8) / 8
    colour = np.empty((len(place), 3))
    colour[:, 0] = 255 * np.clip(2.0 - 1.5 * share, 0.0, 1.0) * (share < 1.0)
    colour[:, 1] = 200 * np.clip(1.0 - 1.6 * share, 0.0, 1.0)
    colour[:, 2] = 0.0
    return place, colour.astype(np.uint8)

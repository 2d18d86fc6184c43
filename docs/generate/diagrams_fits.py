"""From an outline to a tile: the outline of docs/fit.md among its copies, drawn apart from them, and its tile."""

from __future__ import annotations

import numpy as np
from diagrams_style import INK, LINE, PARABOLA, TILE, bare, drawing, edges, fill
from matplotlib.axes import Axes
from shapely.geometry import Polygon

import voronoi_tiles as vt
from voronoi_tiles.escherization.covering import laid_out

_POINTS = [0j, 16 - 5j, 34 + 1j, 52 - 6j, 55 + 12j, 40 + 22j, 43 + 40j, 26 + 34j, 12 + 43j, 7 + 22j, -7 + 14j]


def write() -> None:
    """Write the picture: copies that overlap and leave gaps, the stroke that is left, and its tile."""
    (whole,) = vt.fit(_POINTS, groups="p2", keep=1, strokes="outline")
    (few,) = vt.fit(_POINTS, groups="p2", keep=1)
    own, copies = laid_out(whole.silhouette, whole.placement)
    left, bottom, right, top = own.bounds
    corners = np.array([complex(left - 12, bottom - 12), complex(right + 12, top + 12)])
    with drawing("fits.svg", (7.4, 2.6), 3) as (_, panels):
        for axes in panels:
            bare(axes, corners)
        first, second, third = panels
        for copy in copies:
            _ring(first, copy, INK, 0.7)
            _ring(second, copy, "#c0c8d0", 0.6)
            common = own.intersection(copy)
            for part in getattr(common, "geoms", [common]):
                if part.geom_type == "Polygon":
                    first.fill(*part.exterior.xy, color=PARABOLA, alpha=0.7, lw=0)
        _ring(first, own, LINE, 1.6)
        _ring(second, own, LINE, 0.8)
        for axes, fit in ((second, whole), (third, few)):
            fill(axes, fit.tiling[0].outline, fc=TILE, ec="none")
            edges(axes, fit.tiling[0].outline, 1.0)
            for ends in fit.tiling[0].site.ends:
                axes.plot(ends.real, ends.imag, "-", color=INK, lw=1.4, zorder=5)


def _ring(axes: Axes, polygon: Polygon, colour: str, width: float) -> None:
    """Draw the boundary of a polygon."""
    axes.plot(*polygon.exterior.xy, "-", color=colour, lw=width, zorder=4)

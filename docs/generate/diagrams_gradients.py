"""How a tile moves with a point of its stroke: the arrows of docs/gradients.md, and the design with the point moved."""

from __future__ import annotations

import numpy as np
from diagrams_style import GREY, INK, LINE, PALE, TILE, bare, drawing, edges, fill, strokes

import voronoi_tiles as vt

_DESIGN = vt.Design("p4", 60, vt.Site(vt.catmull_rom([6 + 9j, 22 + 5j, 27 + 17j, 13 + 25j]), tolerance=0.03))
_POINT = "site[0].strokes[0].catmull_rom[3]"
_STEP = -5 + 2j


def write() -> None:
    """Write the picture: the tile, the velocities of its points, and the tile when the point has moved."""
    tiling = _DESIGN.tessellate()
    gradient = tiling.shape_gradient(_POINT)
    points = gradient[0].along(120)
    arrows = points.normal * (points.velocity @ [_STEP.real, _STEP.imag])
    after = gradient.stepped([_STEP.real, _STEP.imag]).tessellate()
    with drawing("gradients.svg", (7.0, 3.6), 2) as (_, (left, right)):
        for axes in (left, right):
            fill(axes, tiling[0].outline, fc=TILE if axes is left else PALE, ec="none")
        edges(left, tiling[0].outline, 1.4)
        strokes(left, tiling[0].site.elements, INK, 2.0, 5.0)
        left.quiver(
            *(part for z in (points.place, arrows) for part in (z.real, z.imag)),
            angles="xy",
            scale_units="xy",
            scale=1.0,
            color=INK,
            width=0.004,
            zorder=5,
        )
        fill(right, after[0].outline, fc=TILE, ec="none")
        edges(right, after[0].outline, 1.4)
        strokes(right, tiling[0].site.elements, GREY, 1.2, 3.0)
        strokes(right, after[0].site.elements, INK, 2.0, 5.0)
        for axes in (left, right):
            control = complex(*_DESIGN.sites[0].strokes[0].table["catmull_rom"][3])
            place = np.array([control, control + _STEP])
            axes.plot(place.real, place.imag, "-", color=LINE, lw=1.6, zorder=6)
            axes.plot(place[1:].real, place[1:].imag, "o", color=LINE, ms=5, zorder=6)
            both = np.array([tiling[0].outline.bounds, after[0].outline.bounds])
            low, high = both[:, :2].min(axis=0) - 2, both[:, 2:].max(axis=0) + 2
            bare(axes, np.array([complex(*low), complex(*high)]))

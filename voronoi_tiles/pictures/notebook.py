"""Pictures for notebooks, as SVG texts: designs, tiles and tilings."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.designs.design import Design
from voronoi_tiles.formats.page import fitting_page
from voronoi_tiles.formats.svg.path_text import decimal_text, path_data
from voronoi_tiles.formats.svg.writer import document_text, new_document
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.vector.outline import Outline

Region = tuple[float, float, float, float]

_SIZE = 300
"""The longer side of what is shown; pixels."""

_TILE, _PAPER, _INK, _SITE, _COPY, _CLASH = "#f3ead8", "#ffffff", "#000000", "#b03020", "#c8c8c8", "#e6008c"


class _Canvas:
    """An SVG picture of a rectangle of the plane, with a margin of a fiftieth; y is turned to run down."""

    def __init__(self, region: Region) -> None:
        low_x, low_y, high_x, high_y = region
        size = max(high_x - low_x, high_y - low_y)
        margin = size / 50
        self._scale = _SIZE / size
        self._corner = complex(low_x - margin, high_y + margin)
        sides = ((side + 2 * margin) * self._scale for side in (high_x - low_x, high_y - low_y))
        width, height = map(decimal_text, fitting_page(0.0, 0.0, *sides)[:2])
        self._drawing = new_document(width, height, f"0 0 {width} {height}")

    def outline(self, outline: Outline, fill: str) -> None:
        """Draw a tile."""
        data = path_data(outline.paths.moved(1.0, -self._corner).moved(self._scale, 0j))
        self._add(data, fill=fill, stroke=_INK, stroke_width=1)

    def segments(self, segments: Complexes, colour: str, width: float) -> None:
        """Draw segments (n, 2), a point as one of no length, which a round cap shows as a dot."""
        ends = [
            [f"{decimal_text(z.real)} {decimal_text(-z.imag)}" for z in row]
            for row in ((segments - self._corner) * self._scale).tolist()
        ]
        data = " ".join(f"M {a} L {b}" for a, b in ends)
        if data:
            self._add(data, fill="none", stroke=colour, stroke_width=width, stroke_linecap="round")

    def text(self) -> str:
        """The picture."""
        return document_text(self._drawing)

    def _add(self, data: str, **style: Any) -> None:
        self._drawing.add(self._drawing.path(d=data, **style))


def tiling_picture(tiles: Sequence[tuple[Outline, Complexes]], copies: Iterable[Outline] = ()) -> str:
    """Draw the tiles, filled, each with the ends of its site's elements (k, 2), over copies that lie about them."""
    bounds = np.array([outline.bounds for outline, _ in tiles])
    low, high = bounds[:, :2].min(axis=0).tolist(), bounds[:, 2:].max(axis=0).tolist()
    canvas = _Canvas((*low, *high))
    for outline in copies:
        canvas.outline(outline, _PAPER)
    fills = [_TILE] if len(tiles) == 1 else [f"#{bytes(row).hex()}" for row in palette(len(tiles))]
    for (outline, ends), fill in zip(tiles, fills, strict=True):
        canvas.outline(outline, fill)
        canvas.segments(ends, _SITE, 3)
    return canvas.text()


def design_picture(design: Design) -> str:
    """Draw the cell, the sites, and the copies of them about it; where copies touch, one that does and a ring."""
    from voronoi_tiles.pictures.clash import find_clash, rings_about, touching_pair
    from voronoi_tiles.pictures.rendering import on_all_copies
    from voronoi_tiles.raster.scene import Pattern

    a, b = design.lattice.a, design.lattice.b
    corners = np.array([0, a, a + b, b, 0])
    own = [site.ends for site in design.noded]
    clash = find_clash(design)
    touching = np.zeros((0, 2), complex) if clash is None else touching_pair(clash, design)[1]
    shown = np.concatenate([corners, touching.ravel(), *(segments.ravel() for segments in own)])
    low, high = complex(shown.real.min(), shown.imag.min()), complex(shown.real.max(), shown.imag.max())
    region = (low.real, low.imag, high.real, high.imag)
    canvas = _Canvas(region)
    pattern = Pattern(design.noded, design.group, design.lattice)
    canvas.segments(on_all_copies(own, pattern, region), _COPY, 2)
    canvas.segments(np.stack((corners[:-1], corners[1:]), axis=1), _INK, 1)
    canvas.segments(touching, _CLASH, 3)
    canvas.segments(np.concatenate(own), _SITE, 3)
    if clash is not None:
        canvas.segments(rings_about(np.array([clash.place]), abs(high - low) / 30), _CLASH, 3)
    return canvas.text()

"""Small pictures for notebooks, as SVG texts."""

from __future__ import annotations

from collections.abc import Iterable

from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.formats.page import page_length
from voronoi_tiles.formats.svg.path_text import decimal_text, path_data
from voronoi_tiles.formats.svg.writer import document_text, new_document
from voronoi_tiles.vector.outline import Outline


def tile_picture(outline: Outline, elements: Floats) -> str:
    """Draw one tile with its site for a notebook: the tile filled, the site's elements (k, 4) in it."""
    low_x, low_y, high_x, high_y = outline.bounds
    size = max(high_x - low_x, high_y - low_y)
    margin, scale = size / 50, 300 / size
    corner = complex(low_x - margin, high_y + margin)
    width, height = (
        decimal_text(page_length((length + 2 * margin) * scale)) for length in (high_x - low_x, high_y - low_y)
    )
    drawing = new_document(width, height, f"0 0 {width} {height}")
    tile = path_data(outline.paths.moved(1.0, -corner).moved(scale, 0j))
    drawing.add(drawing.path(d=tile, fill="#f3ead8", stroke="#000000", stroke_width=1))
    site = " ".join(_strokes(elements, corner, scale))
    drawing.add(drawing.path(d=site, fill="none", stroke="#b03020", stroke_width=3, stroke_linecap="round"))
    return document_text(drawing)


def _strokes(elements: Floats, origin: complex, scale: float) -> Iterable[str]:
    """Write every element as a line; a point is a line of no length, which a round cap shows as a dot."""
    for x0, y0, x1, y1 in elements.tolist():
        a, b = (
            f"{decimal_text((x - origin.real) * scale)} {decimal_text((origin.imag - y) * scale)}"
            for x, y in ((x0, y0), (x1, y1))
        )
        yield f"M {a} L {b}"

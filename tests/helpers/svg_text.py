"""SVG drawings in a line of text: a page of 100 x 50 mm whose user units are millimetres."""

from __future__ import annotations

from voronoi_tiles.formats.reading import ReadDrawing
from voronoi_tiles.formats.svg.reader import svg_drawing

NS = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
INKSCAPE = 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
PAGE = 'width="100mm" height="50mm" viewBox="0 0 100 50"'


def svg(body: str, page: str = PAGE) -> ReadDrawing:
    """Read a drawing with this body."""
    return svg_drawing(f"<svg {NS} {INKSCAPE} {page}>{body}</svg>".encode(), "t.svg")

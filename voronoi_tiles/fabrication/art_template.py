"""A page to draw a site's art on: the tile and its strokes as a guide, and an empty layer for the art."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

import numpy as np

from voronoi_tiles.base.arguments import path_name
from voronoi_tiles.base.files import refuse_existing
from voronoi_tiles.designs.art import GUIDE, Art
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.fabrication.exporting import format_of, save_drawing
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.vector.outline import Outline

MARGIN_MM: Final = 5.0
"""Room around the tile; millimetres."""

_ENGRAVE: Final = "engrave"


def write_template(path: str | os.PathLike[str], folder: str, site: NodedSite, outline: Outline, unit_mm: float) -> Art:
    """Write the page of `art_template` as an SVG file; give the art, as a design in `folder` names it.

    Raises OutputError where there is such a file already, or it cannot be written.
    """
    path = path_name("path", path)
    if Path(path).suffix:
        format_of(path, ("svg",))
    refuse_existing(path)
    drawing, corner = art_template(site, outline, unit_mm)
    save_drawing(drawing, path)
    return Art(os.path.relpath(path, folder or os.curdir), translate=corner)


def art_template(site: NodedSite, outline: Outline, unit_mm: float) -> tuple[Drawing, complex]:
    """A page with a site's tile and strokes on the layer "guide", which is no art, and an empty layer "engrave".

    Also gives what `translate` the art needs in the design, in its units, to lie where it was drawn.
    """
    paths = outline.paths.moved(unit_mm, 0j)
    strokes = Paths.polylines([line for line in site.ends * unit_mm if line[0] != line[1]])
    low_x, low_y, high_x, high_y = Paths.concatenate([paths, strokes]).bounds
    # A whole millimetre, so that what is to be written into the design is short.
    corner = complex(np.floor(low_x - MARGIN_MM), np.floor(low_y - MARGIN_MM))
    width, height = np.ceil(high_x + MARGIN_MM) - corner.real, np.ceil(high_y + MARGIN_MM) - corner.imag
    layers = (
        Layer.of_paths(GUIDE, "score", "#c0c0c0", 0.1, Paths.concatenate([paths, strokes]).moved(1.0, -corner)),
        Layer.of_paths(_ENGRAVE, "engrave", "#ff0000", 0.1, Paths.empty()),
    )
    return Drawing(float(width), float(height), layers, f"art of {site.name}"), corner / unit_mm

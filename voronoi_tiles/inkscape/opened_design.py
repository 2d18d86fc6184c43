"""A design as a drawing for Inkscape: its strokes to change, its cell, and its tiles."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.documents import read_bytes
from voronoi_tiles.base.errors import DesignError, why_not_opened
from voronoi_tiles.base.maps import Affine, Placement
from voronoi_tiles.designs import schema
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.exact import design_recipe
from voronoi_tiles.formats.page import fitting_page
from voronoi_tiles.formats.recipe import recipe_of
from voronoi_tiles.formats.shapes import BYTES_MAX
from voronoi_tiles.formats.svg.path_text import decimal_text, path_data
from voronoi_tiles.inkscape.cell_drawing import cell_layer
from voronoi_tiles.inkscape.cell_frame import CellFrame, corners_of
from voronoi_tiles.inkscape.effects import outlines
from voronoi_tiles.inkscape.own_layers import OwnGroup, drawn_style, layer_text
from voronoi_tiles.paths.paths import CUBIC, LINE, Paths

_MARGIN_MM: Final = 10.0
"""What is free about the cell and the tiles; millimetres."""

_LINE_MM: Final = 0.25
"""The width of lines; millimetres."""

_COLOUR: Final = "#d35400"

_HEAD: Final = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
    'xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd" width="{0}mm" height="{1}mm" '
    'viewBox="0 0 {0} {1}">\n<sodipodi:namedview inkscape:document-units="mm"/>\n'
)


def opened(file: str) -> bytes:
    """The drawing of a design file, or of the design that a file of ours was made from: SVG, in millimetres.

    Its strokes are in a group for each site, what a selection is made of, with the curves that they have; its cell is
    the rectangle with that label. Raises VoronoiTilesError.
    """
    design = _design_in(file)
    tiling = design.tessellate()
    unit = design.unit_mm
    sides = {name: side * (1.0 if name == "angle" else design.scale * unit) for name, side in design.cell.items()}
    strokes = {site.name: list(_strokes(design, k)) for k, site in enumerate(design.noded)}
    cell = CellFrame(sides, 0j, 1 + 0j)
    boxes = np.array([tile.bounds for tile in tiling]) * unit
    a, b = (corner - cell.origin for corner in corners_of(cell, design.group)[1:])
    drawn = np.concatenate([points.ravel() for listed in strokes.values() for points in listed]) * unit
    x = np.concatenate([boxes[:, ::2].ravel(), [0.0, a.real, b.real, (a + b).real], drawn.real])
    y = np.concatenate([boxes[:, 1::2].ravel(), [0.0, b.imag], drawn.imag])
    low, high = complex(x.min(), y.min()), complex(x.max(), y.max())
    margin = _MARGIN_MM * (1 + 1j)
    width, height, corner = fitting_page(
        (low - margin).real, (low - margin).imag, (high + margin).real, (high + margin).imag
    )
    frame = cell._replace(origin=-corner)
    to_page = Affine(0j, 1 + 0j, complex(0.0, height))
    groups = [
        OwnGroup(
            name,
            drawn_style(_COLOUR, _LINE_MM, to_page) + ";stroke-linecap:round",
            [(_data(points * unit + frame.origin, to_page), "") for points in listed],
        )
        for name, listed in strokes.items()
    ]
    layers = (
        layer_text(
            "tiles",
            "tiles",
            "voronoi-tiles",
            [outlines(tiling, frame, to_page, _LINE_MM)],
            recipe=design_recipe(design),
            notes=tuple(_notes(design)),
        ),
        cell_layer(frame, design.group, to_page, "voronoi-cell"),
        layer_text(None, "strokes", "voronoi-strokes", groups),
    )
    head = _HEAD.format(decimal_text(width), decimal_text(height))
    return head.encode() + b"\n".join(layers) + b"\n</svg>\n"


def _design_in(file: str) -> Design:
    """The design of a file, or that of the recipe in a drawing."""
    try:
        data = read_bytes(file, BYTES_MAX + 1)
    except (OSError, ValueError) as error:
        reason = why_not_opened(file, error)
        raise DesignError(f"cannot be read: {reason}", file=file, remedy="Check the name.") from None
    recipe = recipe_of(data)
    if "design" in recipe:
        return Design.loads(recipe["design"], format="json", file=file, name=file)
    if data.lstrip()[:1] == b"<":
        raise DesignError(
            "no file of ours: it does not say which design it was made from",
            file=file,
            remedy="Open it as SVG, and use Extensions > Voronoi tiles.",
        )
    return Design.load(file)


def _strokes(design: Design, site: int) -> Iterator[Complexes]:
    """The strokes of a site, where they are placed: each a polyline, (n,), or cubic pieces, (k, 4), in units."""
    table: Mapping[str, Any] = json.loads(design.source)["site"][site]
    by = Placement(design.scale) @ schema.placement(table)
    accuracy = table.get("tolerance", 0.01 / design.unit_mm)
    for stroke in table["strokes"]:
        yield schema.stroke(stroke, accuracy, by)[0]


def _data(points: Complexes, to_page: Affine) -> bytes:
    """A polyline or cubic pieces in millimetres as path data in user units; a point as a line of no length."""
    if points.ndim == 1:
        paths = Paths.polylines([points if len(points) > 1 else points.repeat(2)])
    else:
        start, end = points[:, 0], points[:, 3]
        straight = (points[:, 1] == start) & (points[:, 2] == end)
        begins = np.append(True, start[1:] != end[:-1])
        paths = Paths(
            start=start,
            end=end,
            control=np.where(straight[:, None], 0j, points[:, 1:3]),
            kind=np.where(straight, LINE, CUBIC).astype(np.uint8),
            offsets=np.append(np.flatnonzero(begins), len(points)),
            closed=np.zeros(int(begins.sum()), np.bool_),
        )
    return path_data(paths.mapped(to_page.inverse), top=None).encode()


def _notes(design: Design) -> Iterator[str]:
    """Sentences on what a drawing does not show."""
    yield from design.notes
    if any(art is not None for art in design.art):
        yield "the sites' art is left out"
    if design.standing is not None:
        yield "how the design stands, its [solid], is left out"

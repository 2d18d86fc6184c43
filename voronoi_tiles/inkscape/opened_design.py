"""A design as a drawing for Inkscape: its strokes to change, its cell, and its tiles."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Affine, Placement
from voronoi_tiles.designs import schema
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.exact import design_recipe
from voronoi_tiles.formats.page import fitting_page
from voronoi_tiles.formats.recipe import recipe_of
from voronoi_tiles.formats.svg.path_text import decimal_text, path_data
from voronoi_tiles.formats.svg.reader import drawing_of_tree, svg_tree
from voronoi_tiles.inkscape.cell_drawing import cell_layer
from voronoi_tiles.inkscape.cell_frame import CellFrame, corners_of
from voronoi_tiles.inkscape.effects import DRAWING, outlines
from voronoi_tiles.inkscape.own_layers import OwnGroup, drawn_style, free_id, layer_text, with_layers
from voronoi_tiles.inkscape.selected_strokes import known_elements
from voronoi_tiles.paths.paths import CUBIC, LINE, Paths

if TYPE_CHECKING:
    from voronoi_tiles.tiling import Tiling

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
    """The drawing of a design file: SVG, in millimetres.

    Its strokes are in a group for each site, what a selection is made of, with the curves that they have; its cell is
    the rectangle with that label. Raises VoronoiTilesError.
    """
    parts = _DesignParts.of(Design.load(file))
    width, height, corner = fitting_page(*parts.bounds)
    to_page = Affine(0j, 1 + 0j, complex(0.0, height))
    head = _HEAD.format(decimal_text(width), decimal_text(height))
    return head.encode() + parts.layers(-corner, to_page, frozenset()) + b"\n</svg>\n"


def beside(data: bytes) -> bytes:
    """A drawing with what `opened` gives of the design that it was made from, to the right of its page.

    Raises VoronoiTilesError.
    """
    root, _ = svg_tree(data, DRAWING)
    drawing, to_page = drawing_of_tree(root, DRAWING, ())
    text = recipe_of(data).get("design")
    if text is None:
        raise DesignError(
            "the drawing does not say which design it was made from",
            remedy="Open a file that voronoi-tiles has written, or one with a layer of tiles.",
        )
    parts = _DesignParts.of(Design.loads(text, format="json", file=DRAWING))
    left, bottom, _, _ = parts.bounds
    origin = complex((drawing.width or 0.0) - left, -bottom)
    names = frozenset(known_elements(root)[1])
    return with_layers(data, "tiles", parts.layers(origin, to_page, names))


class _DesignParts(NamedTuple):
    """What there is to draw of a design, in millimetres about its origin.

    `strokes` are those of each site by its name, polylines, (n,), and cubic pieces, (k, 4); `bounds` are those of all,
    with a margin.
    """

    tiling: Tiling
    cell: CellFrame
    strokes: dict[str, list[Complexes]]
    bounds: tuple[float, float, float, float]

    @classmethod
    def of(cls, design: Design) -> _DesignParts:
        """The parts of a design."""
        tiling, unit = design.tessellate(), design.unit_mm
        sides = {name: side * (1.0 if name == "angle" else design.scale * unit) for name, side in design.cell.items()}
        cell = CellFrame(sides, 0j, 1 + 0j)
        strokes = {site.name: [unit * one for one in _strokes(design, k)] for k, site in enumerate(design.noded)}
        boxes = np.array([tile.bounds for tile in tiling]) * unit
        _, a, b = corners_of(cell, design.group)
        points = np.concatenate(
            [
                (boxes[:, ::2] + 1j * boxes[:, 1::2]).ravel(),
                np.array([0j, a, b, a + b]),
                *(one.ravel() for listed in strokes.values() for one in listed),
            ]
        )
        low, high = complex(points.real.min(), points.imag.min()), complex(points.real.max(), points.imag.max())
        margin = _MARGIN_MM
        return cls(
            tiling, cell, strokes, (low.real - margin, low.imag - margin, high.real + margin, high.imag + margin)
        )

    def layers(self, origin: complex, to_page: Affine, names: frozenset[str]) -> bytes:
        """The layers of tiles, cell and strokes, the design's origin at a place of the page; `names` are ids taken."""
        frame = self.cell._replace(origin=origin)
        style = drawn_style(_COLOUR, _LINE_MM, to_page) + ";stroke-linecap:round"
        groups = [
            OwnGroup(name, style, [(_data(points + origin, to_page), "") for points in listed])
            for name, listed in self.strokes.items()
        ]
        design = self.tiling.design
        layers = (
            layer_text(
                "tiles",
                "tiles",
                free_id("voronoi-tiles", names),
                [outlines(self.tiling, frame, to_page, _LINE_MM)],
                recipe=design_recipe(design),
                notes=tuple(_notes(design)),
            ),
            cell_layer(frame, design.group, to_page, free_id("voronoi-cell", names)),
            layer_text(None, "strokes", free_id("voronoi-strokes", names), groups),
        )
        return b"\n".join(layers)


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

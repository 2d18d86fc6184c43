"""The rest of a drawing, carried from its outline to the tile: an SVG file that is the art of a design."""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

from voronoi_tiles.base.text import counted, xml_text
from voronoi_tiles.designs.art import GUIDE
from voronoi_tiles.escherization.carried_paths import carried_paths
from voronoi_tiles.escherization.carrying import Carrying
from voronoi_tiles.formats.caveats import caveats
from voronoi_tiles.formats.decimals import PLACES
from voronoi_tiles.formats.reading import ReadDrawing, Shape
from voronoi_tiles.formats.svg.path_text import decimal_text, path_data
from voronoi_tiles.formats.svg.writer import INKSCAPE_NAMESPACE, document_text, new_document
from voronoi_tiles.paths.paths import Paths

_ACCURACY: Final = 0.01
"""How far a carried curve may lie from where the map has it; millimetres. A tenth of what a laser's beam is wide."""

_LINE_MM: Final = 0.1
"""The width of lines that have none, and of the guide's, as in the template of a design's art; millimetres."""


class CarriedArt(NamedTuple):
    """A drawing's art as it is carried.

    `svg` is a file whose page's lower left corner lies at `corner` (millimetres) in the drawing that was read, whose
    own corner is 0: an `Art` of the file is moved by `corner`, and then placed as the drawing is. `shapes` counts what
    was carried, and `notes` are sentences on what was not, and on what came out folded.
    """

    svg: bytes
    corner: complex
    shapes: int
    notes: tuple[str, ...]


def carried_art(
    drawing: ReadDrawing, file: str, outline: Shape | None, carrying: Carrying, *, guide: Paths | None = None
) -> CarriedArt:
    """Carry all that a drawing shows but its outline; `file` is its name for the notes.

    Colours, widths of strokes, layers and the order of shapes are kept. `outline` is one of the drawing's shapes,
    `carrying` is in the drawing's millimetres. What lies on a layer that is a guide is left out, and `guide`, the tile,
    is put on one. The same drawing gives the same bytes.
    """
    shapes = [
        shape
        for shape in drawing.shapes
        if shape is not outline and GUIDE not in shape.layer.casefold() and len(shape.paths)
    ]
    images = [carried_paths(shape.paths, carrying, accuracy=_ACCURACY) for shape in shapes]
    folded = [shape for shape in shapes if not carrying.keeps_orientation(shape.paths.start).all()]
    notes = list(caveats(drawing, file))
    if folded:
        notes.append(
            f"{file}: where the tile differs much from the outline {counted(len(folded), 'shape')} of the art came out "
            f"folded, the first of them {folded[0].source}; look at it, and draw it anew if need be"
        )
    corner, width, height = _page(drawing, images if guide is None else [*images, guide])
    document = new_document(f"{width}mm", f"{height}mm", f"0 0 {width} {height}")
    document.attribs["xmlns:inkscape"] = INKSCAPE_NAMESPACE
    document.set_desc(title=xml_text(f"art of {file}"))
    if guide is not None:
        group = _layer(document, GUIDE)
        group.add(_element(document, guide, corner, height, None, "#c0c0c0", _LINE_MM))
    layer, group = "", document
    for shape, image in zip(shapes, images, strict=True):
        if shape.layer != layer:
            layer = shape.layer
            group = _layer(document, layer) if layer else document
        group.add(_element(document, image, corner, height, shape.fill, shape.stroke, shape.stroke_width))
    return CarriedArt(document_text(document).encode(), corner, len(shapes), tuple(notes))


def _page(drawing: ReadDrawing, images: list[Paths]) -> tuple[complex, int, int]:
    """The lower left corner, the width and the height of the drawing's page, larger where what is carried leaves it."""
    boxes = [image.bounds for image in images]
    if drawing.width is not None and drawing.height is not None:
        boxes.append((0.0, 0.0, drawing.width, drawing.height))
    if not boxes:
        return 0j, 1, 1
    low = [math.floor(min(box[k] for box in boxes)) for k in (0, 1)]
    high = [math.ceil(max(box[k] for box in boxes)) for k in (2, 3)]
    return complex(*low), max(1, high[0] - low[0]), max(1, high[1] - low[1])


def _layer(document: Any, name: str) -> Any:
    """A new layer of a document, as Inkscape knows them."""
    group = document.add(document.g())
    group.attribs["inkscape:groupmode"] = "layer"
    group.attribs["inkscape:label"] = xml_text(name)
    return group


def _element(
    document: Any,
    paths: Paths,
    corner: complex,
    height: float,
    fill: str | None,
    stroke: str | None,
    width: float | None,
) -> Any:
    """One shape as a path."""
    drawn = {"stroke": stroke, "stroke_width": _number(_LINE_MM if width is None else width)} if stroke else {}
    data = path_data(paths.moved(1.0, -corner), top=height, number=_number)
    return document.path(d=data, fill=fill or "none", **drawn)


def _number(value: float) -> str:
    """A number of millimetres, to the nanometre."""
    return decimal_text(round(value, PLACES))

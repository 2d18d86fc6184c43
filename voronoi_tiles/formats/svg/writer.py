"""SVG files of drawings: a page in millimetres, a layer for each kind of work, one path for each object.

The document is svgwrite's. The paths' data are put in as they are written: with svgwrite's own elements
a sheet of 8,000 tiles takes half as long again.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any, BinaryIO
from xml.etree import ElementTree as ET

import numpy as np

from voronoi_tiles.base.text import xml_attribute, xml_text
from voronoi_tiles.formats.decimals import PLACES
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.formats.svg.path_text import decimal_text, path_data, path_texts

if TYPE_CHECKING:
    import svgwrite

RECIPE_NAMESPACE = "urn:voronoi-tiles:recipe"
INKSCAPE_NAMESPACE = "http://www.inkscape.org/namespaces/inkscape"

_ODD = re.compile("[^0-9A-Za-z_-]+")
_MARK = "paths-of-layer-"


def write_svg(drawing: Drawing, file: BinaryIO, *, exact: bool = False) -> None:
    """Write a drawing as SVG: one user unit is one millimetre, y is turned to run down.

    Every object is one `<path>` of absolute M, L, Q, C and Z, with nanometres as the last digit, or where `exact`, with
    as many digits as give the same floats; there are no clones, transforms or texts. Layers are Inkscape's. The same
    drawing gives the same bytes. Raises ValueError for circular arcs.
    """
    width, height = (
        decimal_text(length if exact else round(length, PLACES)) for length in (drawing.width, drawing.height)
    )
    document = new_document(f"{width}mm", f"{height}mm", f"0 0 {width} {height}")
    document.attribs["xmlns:inkscape"] = INKSCAPE_NAMESPACE
    document.attribs["xmlns:vt"] = RECIPE_NAMESPACE
    if drawing.title:
        document.set_desc(title=xml_text(drawing.title))
    facts = {key: xml_text(text) for key, text in drawing.recipe.items()}
    bodies = {"vt:recipe": facts.pop("design", ""), "vt:evidence": facts.pop("evidence", "")}
    for name, text in bodies.items():
        if name == "vt:recipe" or text:
            element = ET.Element(name, facts if name == "vt:recipe" else {})
            element.text = text
            document.set_metadata(element)
    for number, layer in enumerate(drawing.layers):
        group = document.add(document.g(id=_identifier(layer.name), **_style(layer)))
        group.attribs["inkscape:groupmode"] = "layer"
        group.attribs["inkscape:label"] = layer.name
        group.add(document.g(id=f"{_MARK}{number}"))
    rest = document_text(document)
    for number, layer in enumerate(drawing.layers):
        before, mark, rest = rest.partition(f'<g id="{_MARK}{number}" />')
        assert mark, "every layer has its mark"
        file.write(before.rstrip(" ").encode())
        file.writelines(_paths(layer, drawing, exact=exact))
        file.write(b"  ")
    file.write(rest.lstrip("\n").lstrip(" ").encode())


def _style(layer: Layer) -> dict[str, Any]:
    """The attributes of a layer's group."""
    if layer.filled:
        return {"fill": layer.colour, "stroke": "none"}
    return {"fill": "none", "stroke": layer.colour, "stroke_width": decimal_text(layer.stroke)}


def _identifier(name: str) -> str:
    """An XML name."""
    return _ODD.sub("-", name) or "layer"


def _paths(layer: Layer, drawing: Drawing, *, exact: bool) -> Iterator[bytes]:
    """Write the elements of a layer, one a line, many at a time."""
    prefix = _identifier(layer.name)
    lines = []
    for number, data in enumerate(_texts(layer, drawing, exact=exact)):
        label = f" inkscape:label={xml_attribute(layer.labels[number])}" if layer.labels else ""
        lines.append(b'    <path id="%s%d" d="%s"%s />\n' % (prefix.encode(), number + 1, data, label.encode()))
        if len(lines) == 1000:
            yield b"".join(lines)
            lines = []
    yield b"".join(lines)


def _texts(layer: Layer, drawing: Drawing, *, exact: bool) -> Iterator[bytes]:
    """Write the path data of each item."""
    top = drawing.height + drawing.bottom
    if not exact:
        return path_texts(layer.paths, layer.items, top)
    return (
        path_data(layer.paths.take(np.arange(first, stop)), top=top).encode()
        for first, stop in pairwise(layer.items.tolist())
    )


def new_document(width: str, height: str, view_box: str) -> svgwrite.Drawing:
    """Start an SVG document."""
    from svgwrite import Drawing as Document

    # debug=True would parse every path's data again, and refuses the attributes of layers.
    return Document(size=(width, height), viewBox=view_box, debug=False)


def document_text(document: svgwrite.Drawing) -> str:
    """Write a document, one element per line."""
    root: Any = document.get_xml()
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"

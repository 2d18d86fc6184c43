"""SVG files of drawings: a page in millimetres, a layer for each kind of work, one path for each object.

The document is svgwrite's; the paths' data are too many for it, and are put in as they are written.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, BinaryIO
from xml.etree import ElementTree as ET
from xml.sax.saxutils import quoteattr

from voronoi_tiles.vector.writers.decimals import PLACES
from voronoi_tiles.vector.writers.drawing import Drawing, Layer
from voronoi_tiles.vector.writers.pathtext import path_texts
from voronoi_tiles.vector.writers.svg import INKSCAPE_NAMESPACE, RECIPE_NAMESPACE, decimal_text, new_document, xml_text

_ODD = re.compile("[^0-9A-Za-z_-]+")
_MARK = "paths-of-layer-"


def write_svg(drawing: Drawing, file: BinaryIO) -> None:
    """Write a drawing as SVG: one user unit is one millimetre, y is turned to run down.

    Every object is one `<path>` of absolute M, L, Q, C, A and Z, with nanometres as the last digit; there are no
    clones, transforms or texts. Layers are Inkscape's. The same drawing gives the same bytes.
    """
    width, height = (decimal_text(round(length, PLACES)) for length in (drawing.width, drawing.height))
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
    root: Any = document.get_xml()
    ET.indent(root)
    text = '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"
    rest = text
    for number, layer in enumerate(drawing.layers):
        before, mark, rest = rest.partition(f'<g id="{_MARK}{number}" />')
        assert mark, "every layer has its mark"
        file.write(before.rstrip(" ").encode())
        file.writelines(_paths(layer, drawing.height))
        file.write(b"  ")
    file.write(rest.lstrip("\n").lstrip(" ").encode())


def _style(layer: Layer) -> dict[str, Any]:
    """Give the attributes of a layer's group."""
    if layer.filled:
        return {"fill": layer.colour, "stroke": "none"}
    return {"fill": "none", "stroke": layer.colour, "stroke_width": decimal_text(layer.stroke)}


def _identifier(name: str) -> str:
    """Give an XML name."""
    return _ODD.sub("-", name) or "layer"


def _paths(layer: Layer, height: float) -> Iterator[bytes]:
    """Write the elements of a layer, one a line, many at a time."""
    prefix = _identifier(layer.name)
    lines = []
    for number, data in enumerate(path_texts(layer.paths, layer.items, height)):
        label = f" inkscape:label={quoteattr(xml_text(layer.labels[number]))}" if layer.labels else ""
        lines.append(b'    <path id="%s%d" d="%s"%s />\n' % (prefix.encode(), number + 1, data, label.encode()))
        if len(lines) == 1000:
            yield b"".join(lines)
            lines = []
    yield b"".join(lines)

"""SVG: outlines as path data, the file that a cutter takes, and a small picture for notebooks.

SVG's y runs down, ours up: every writer turns y, so that the picture looks the same. A number is written as the
shortest decimal that reads back as the same float, never with an exponent, which some cutters' readers do not know.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from decimal import ROUND_CEILING, Decimal
from itertools import pairwise
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.vector.outline import Outline

if TYPE_CHECKING:
    from svgwrite import Drawing

CUT_LAYER = "cut"
CUT_COLOUR = "#000000"
HAIRLINE_MM = 0.025

RECIPE_NAMESPACE = "urn:voronoi-tiles:recipe"
INKSCAPE_NAMESPACE = "http://www.inkscape.org/namespaces/inkscape"

_NOT_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def path_data(outline: Outline, *, origin: complex = 0j, scale: float = 1.0) -> str:
    """Write an outline as SVG path data: M, L, exact Q and Z, one closed subpath per ring.

    `origin` is the point that becomes SVG's (0, 0), and y is turned; `scale` is in user units per unit.
    """
    points = np.stack((outline.start, outline.control, outline.end))
    x = ((points.real - origin.real) * scale).tolist()
    y = ((origin.imag - points.imag) * scale).tolist()
    start, control, end = (
        [f"{decimal_text(u)} {decimal_text(v)}" for u, v in zip(us, vs, strict=True)]
        for us, vs in zip(x, y, strict=True)
    )
    curved = outline.curved.tolist()
    parts = []
    for first, stop in pairwise(outline.ring_offsets.tolist()):
        parts.append(f"M {start[first]}")
        for k in range(first, stop):
            if curved[k]:
                parts.append(f"Q {control[k]} {end[k]}")
            elif k < stop - 1:  # Z draws a last straight edge itself
                parts.append(f"L {end[k]}")
        parts.append("Z")
    return " ".join(parts)


def decimal_text(value: float) -> str:
    """Write a float as the shortest decimal that reads back as the same float, without exponent or sign of zero."""
    text = repr(value + 0.0)  # adding zero makes -0.0 a 0
    if "e" in text:
        text = format(Decimal(text), "f")
    return text.removesuffix(".0")


def cut_file(
    tiles: Sequence[tuple[str, Outline]],
    *,
    unit_mm: float,
    version: str,
    design: str,
    evidence: Mapping[str, Any] | None = None,
) -> str:
    """Write the SVG file of named tiles where they lie in the plane: millimetres, a layer "cut", one path per tile.

    One user unit is one millimetre; `unit_mm` is a design unit in millimetres. The page is the tiles' bounding box,
    rounded up to six digits. `version` and `design` (its canonical text) are the recipe in the metadata, `evidence`, if
    given, what was proved and checked; nothing else goes into the file, so the same recipe gives the same bytes.
    Raises ValueError when there is no tile.
    """
    bounds = [outline.bounds for _, outline in tiles]
    left, bottom = min(box[0] for box in bounds), min(box[1] for box in bounds)
    right, top = max(box[2] for box in bounds), max(box[3] for box in bounds)
    width, height = page_length((right - left) * unit_mm), page_length((top - bottom) * unit_mm)
    drawing = new_document(f"{width}mm", f"{height}mm", f"0 0 {width} {height}")
    drawing.attribs["xmlns:inkscape"] = INKSCAPE_NAMESPACE
    drawing.attribs["xmlns:vt"] = RECIPE_NAMESPACE
    recipe = ET.Element("vt:recipe", {"program": "voronoi-tiles", "version": version})
    recipe.text = xml_text(design)
    drawing.set_metadata(recipe)
    if evidence is not None:
        drawing.set_metadata(_evidence(evidence))
    layer = drawing.add(drawing.g(id=CUT_LAYER, fill="none", stroke=CUT_COLOUR, stroke_width=HAIRLINE_MM))
    layer.attribs["inkscape:groupmode"] = "layer"
    layer.attribs["inkscape:label"] = CUT_LAYER
    for number, (name, outline) in enumerate(tiles, start=1):
        data = path_data(outline, origin=complex(left, top), scale=unit_mm)
        path = layer.add(drawing.path(d=data, id=f"tile{number}"))
        path.attribs["inkscape:label"] = xml_text(name)
    return _xml(drawing)


def preview(outline: Outline, elements: NDArray[np.float64]) -> str:
    """Draw one tile with its site for a notebook: the tile filled, the site's elements (k, 4) in it."""
    low_x, low_y, high_x, high_y = outline.bounds
    size = max(high_x - low_x, high_y - low_y)
    margin, scale = size / 50, 300 / size
    corner = complex(low_x - margin, high_y + margin)
    width = page_length((high_x - low_x + 2 * margin) * scale)
    height = page_length((high_y - low_y + 2 * margin) * scale)
    drawing = new_document(width, height, f"0 0 {width} {height}")
    tile = path_data(outline, origin=corner, scale=scale)
    drawing.add(drawing.path(d=tile, fill="#f3ead8", stroke="#000000", stroke_width=1))
    site = " ".join(_strokes(elements, corner, scale))
    drawing.add(drawing.path(d=site, fill="none", stroke="#b03020", stroke_width=3, stroke_linecap="round"))
    return _xml(drawing)


def page_length(length: float) -> str:
    """Write a positive length as a decimal of at most six digits, rounded up; an excess under 1e-12 of it is noise."""
    step = Decimal(10) ** (math.floor(math.log10(length)) - 5)
    steps = (Decimal(length) / step - Decimal("1e-6")).to_integral_value(ROUND_CEILING)
    text = format(steps * step, "f")
    return text.rstrip("0").rstrip(".") if "." in text else text


def _evidence(evidence: Mapping[str, Any]) -> ET.Element:
    """Write what was proved and checked (Tiling.evidence): an element for each, one below it for each figure."""
    element = ET.Element("vt:evidence")
    check = evidence["check"]
    parts = {
        "vt:proof": ({}, evidence["proof"]),
        "vt:check": ({key: value for key, value in check.items() if key != "figures"}, check["figures"]),
    }
    for name, (facts, figures) in parts.items():
        part = ET.SubElement(element, name, _attributes(facts))
        for figure in figures:
            ET.SubElement(part, "vt:figure", _attributes({k: v for k, v in figure.items() if k != "places"}))
    return element


def _attributes(facts: Mapping[str, Any]) -> dict[str, str]:
    """Write facts as XML attributes; what is unknown is left out."""
    texts = {
        key: " ".join(map(str, value)) if isinstance(value, list) else json.dumps(value).strip('"')
        for key, value in facts.items()
        if value is not None
    }
    return {key: xml_text(text) for key, text in texts.items()}


def _strokes(elements: NDArray[np.float64], origin: complex, scale: float) -> Iterable[str]:
    """Write every element as a line; a point is a line of no length, which a round cap shows as a dot."""
    for x0, y0, x1, y1 in elements.tolist():
        a, b = (
            f"{decimal_text((x - origin.real) * scale)} {decimal_text((origin.imag - y) * scale)}"
            for x, y in ((x0, y0), (x1, y1))
        )
        yield f"M {a} L {b}"


def new_document(width: str, height: str, view_box: str) -> Drawing:
    """Start an SVG document."""
    from svgwrite import Drawing

    # debug=True would parse every path's data again, and refuses the attributes of layers.
    return Drawing(size=(width, height), viewBox=view_box, debug=False)


def _xml(drawing: Drawing) -> str:
    """Write the document, one element per line."""
    root: Any = drawing.get_xml()
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def xml_text(text: str) -> str:
    """Replace the characters that XML 1.0 cannot carry."""
    return _NOT_XML.sub("\ufffd", text)

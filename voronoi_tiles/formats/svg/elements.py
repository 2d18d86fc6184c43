"""SVG's elements: their names, and which of them are drawn, hold what is drawn, or draw nothing where they stand."""

from __future__ import annotations

from typing import Final

from voronoi_tiles.formats.svg.properties import GEOMETRY
from voronoi_tiles.formats.svg.xml_tree import Node

SVG: Final = "http://www.w3.org/2000/svg "
XLINK: Final = "http://www.w3.org/1999/xlink "
INKSCAPE: Final = "http://www.inkscape.org/namespaces/inkscape "

GROUPS: Final = frozenset({"g", "a", "switch"})
# What SVG itself does not draw where it stands.
_NOT_HERE: Final = """
    defs symbol clipPath mask marker pattern linearGradient radialGradient filter metadata title desc style view
    cursor color-profile font font-face solidcolor meshgradient hatch
"""
SILENT: Final = frozenset(_NOT_HERE.split())
"""What draws nothing where it stands."""

SERVERS: Final = frozenset({"pattern", "linearGradient", "radialGradient", "solidcolor", "meshgradient", "hatch"})
"""What paints others."""

ANIMATIONS: Final = frozenset({"animate", "animateMotion", "animateTransform", "set"})

SIZED: Final = GEOMETRY - {"d"} | {"x1", "y1", "x2", "y2"}
"""The attributes that are lengths."""

MARKED: Final = frozenset({"path", "line", "polyline", "polygon"})
"""What markers stand on."""


def tag_of(node: Node) -> str:
    """The name of an SVG element, "" for those of other namespaces; files without a namespace are taken as SVG."""
    if node.tag.startswith(SVG):
        return node.tag[len(SVG) :]
    return "" if " " in node.tag else node.tag


def source_of(node: Node, tag: str) -> str:
    """What messages call an object."""
    name = node.attributes.get("id")
    return f"{tag} {name[:80]!r}, line {node.line}" if name else f"{tag}, line {node.line}"


def is_svg(node: Node) -> bool:
    """Whether it is an element of SVG."""
    return tag_of(node) != ""

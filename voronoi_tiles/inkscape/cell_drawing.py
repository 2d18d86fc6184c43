"""The cell as a rectangle in a drawing: what the next run takes it from, and people move.

One that was fitted says where: as long as nobody has moved it, it is fitted anew to other strokes or for another group.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from voronoi_tiles.base.maps import Affine
from voronoi_tiles.formats.svg.path_text import decimal_text
from voronoi_tiles.formats.svg.writer import RECIPE_NAMESPACE
from voronoi_tiles.formats.svg.xml_tree import Node
from voronoi_tiles.groups.wallpaper import WallpaperGroup
from voronoi_tiles.inkscape.cell_frame import CellFrame, corners_of
from voronoi_tiles.inkscape.dialog_fields import CELL_LABEL
from voronoi_tiles.inkscape.own_layers import ROLE, drawn_style, layer_text

_COLOUR: Final = "#3c8dbc"
_LINE_MM: Final = 0.25


_FITTED: Final = "fitted"
"""The attribute of ours that says where a rectangle was put."""


def is_as_fitted(layer: Node) -> bool:
    """Whether a layer is one that `cell_layer` made for a cell that was fitted, as it was then."""
    if layer.attributes.get(ROLE) != "cell" or "transform" in layer.attributes or len(layer.children) != 1:
        return False
    (rectangle,) = layer.children
    return rectangle.attributes.get(f"{RECIPE_NAMESPACE} {_FITTED}") == _place(rectangle.attributes)


def _place(attributes: Mapping[str, str]) -> str:
    """Where a rectangle lies, as its attributes say it."""
    return "; ".join(attributes.get(name, "") for name in ("x", "y", "width", "height", "transform"))


def cell_layer(frame: CellFrame, group: WallpaperGroup, to_page: Affine, name: str, *, fitted: bool = False) -> bytes:
    """A layer with the cell of a frame, in user units that `to_page` maps to the page; `name` begins its ids.

    Where the cell is no upright rectangle in user units, its rectangle carries a matrix.
    """
    back = to_page.inverse
    lower_left, lower_right, upper_left = (back(corner) for corner in corners_of(frame, group))
    across, down = lower_right - lower_left, lower_left - upper_left
    style = drawn_style(_COLOUR, _LINE_MM, to_page)
    if across.imag == 0.0 == down.real and min(across.real, down.imag) > 0.0:
        numbers = {"x": upper_left.real, "y": upper_left.imag, "width": across.real, "height": down.imag}
        matrix = ""
    else:
        # A rectangle in millimetres; its line too, but for how far the matrix stretches it.
        width, height = (abs(to_page.a * side + to_page.b * side.conjugate()) for side in (across, down))
        numbers = {"x": 0.0, "y": 0.0, "width": width, "height": height}
        parts = (across / width, down / height, upper_left)
        matrix = ",".join(decimal_text(number) for part in parts for number in (part.real, part.imag))
        style = drawn_style(_COLOUR, _LINE_MM, Affine(1 + 0j, 0j, 0j))
    attributes = {key: decimal_text(value) for key, value in numbers.items()}
    if matrix:
        attributes["transform"] = f"matrix({matrix})"
    if fitted:
        attributes[f"vt:{_FITTED}"] = _place(attributes)
    said = " ".join(f'{key}="{value}"' for key, value in attributes.items())
    rectangle = f'<rect id="{name}-0" inkscape:label="{CELL_LABEL}" {said} style="{style}"/>\n'
    return layer_text("cell" if fitted else None, CELL_LABEL, name, more=rectangle)

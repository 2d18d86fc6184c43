"""The cell as a rectangle in a drawing: what the next run takes it from, and people move."""

from __future__ import annotations

from typing import Final

from voronoi_tiles.base.maps import Affine
from voronoi_tiles.formats.svg.path_text import decimal_text
from voronoi_tiles.groups.wallpaper import WallpaperGroup
from voronoi_tiles.inkscape.cell_frame import CellFrame, corners_of
from voronoi_tiles.inkscape.dialog_fields import CELL_LABEL
from voronoi_tiles.inkscape.own_layers import drawn_style, layer_text

_COLOUR: Final = "#3c8dbc"
_LINE_MM: Final = 0.25


def cell_layer(frame: CellFrame, group: WallpaperGroup, to_page: Affine, name: str) -> bytes:
    """A layer with the cell of a frame, in user units that `to_page` maps to the page; `name` begins its ids.

    Where the cell is no upright rectangle in user units, its rectangle carries a matrix.
    """
    back = to_page.inverse
    lower_left, lower_right, upper_left = (back(corner) for corner in corners_of(frame, group))
    across, down = lower_right - lower_left, lower_left - upper_left
    style = drawn_style(_COLOUR, _LINE_MM, to_page)
    if across.imag == 0.0 == down.real and min(across.real, down.imag) > 0.0:
        numbers = {"x": upper_left.real, "y": upper_left.imag, "width": across.real, "height": down.imag}
        where = ""
    else:
        # A rectangle in millimetres; its line too, but for how far the matrix stretches it.
        width, height = (abs(to_page.a * side + to_page.b * side.conjugate()) for side in (across, down))
        numbers = {"x": 0.0, "y": 0.0, "width": width, "height": height}
        parts = (across / width, down / height, upper_left)
        matrix = ",".join(decimal_text(number) for part in parts for number in (part.real, part.imag))
        where, style = f' transform="matrix({matrix})"', drawn_style(_COLOUR, _LINE_MM, Affine(1 + 0j, 0j, 0j))
    said = " ".join(f'{key}="{decimal_text(value)}"' for key, value in numbers.items())
    rectangle = f'<rect id="{name}-0" inkscape:label="{CELL_LABEL}" {said}{where} style="{style}"/>\n'
    return layer_text(None, CELL_LABEL, name, more=rectangle)

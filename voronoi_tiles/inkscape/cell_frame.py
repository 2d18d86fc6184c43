"""The cell of a selection and where it lies on the page: by a rectangle, by numbers, or fitted to the strokes."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Final, NamedTuple

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.groups.wallpaper import GROUPS, WallpaperGroup
from voronoi_tiles.inkscape.dialog_fields import CELL_LABEL, DesignFields

_DRAWN_ALIKE: Final = 1e-6
"""Sides that differ by less are meant to be alike, and a right angle that is off by less is one; relative, and radians.
Inkscape writes eight digits."""


class CellFrame(NamedTuple):
    """A cell as a design has it, and its place: the point z of the cell is at `origin` + `turn` z, millimetres.

    `turn` has the length 1.
    """

    cell: dict[str, float]
    origin: complex
    turn: complex

    def on_page(self, place: complex) -> complex:
        """Where a point of the cell is on the page."""
        return self.origin + self.turn * place


def frame_of_numbers(fields: DesignFields) -> CellFrame:
    """The cell of a dialog's numbers, upright."""
    cell = {"a": fields.side_a, "b": fields.side_b, "angle": fields.angle}
    return CellFrame(_free(cell, GROUPS[fields.group]), complex(fields.origin_x, fields.origin_y), 1 + 0j)


def frame_of_rectangle(corners: Sequence[complex], group: WallpaperGroup) -> CellFrame:
    """The cell of a rectangle's four corners, the upper left one first, then clockwise, as it was before transforms.

    The group's origin is in its lower left corner, x along its lower side; of a cell of 120 degrees it is the side
    alone. Raises DesignError where the sides do not go with the group.
    """
    upper_left, upper_right, lower_right, lower_left = corners
    origin, across, up = lower_left, lower_right - lower_left, upper_left - lower_left
    if (across.conjugate() * up).imag < 0.0:  # it is mirrored
        origin, across, up = lower_right, -across, upper_right - lower_right
    a, b, corner = abs(across), abs(up), cmath.phase(up / across)
    square = abs(corner - math.pi / 2) <= _DRAWN_ALIKE
    angle = 90.0 if square else math.degrees(corner)
    what, remedy = (
        f'the rectangle "{CELL_LABEL}" is {a:.6g} x {b:.6g} mm',
        "Change it, or delete it to have one fitted.",
    )
    alike = abs(a - b) <= _DRAWN_ALIKE * a
    fixed = group.fixed_angle
    if fixed == 90.0:
        if not square:
            raise DesignError(f"{what} with {angle:.6g} degrees, and {group.name} needs a right angle", remedy=remedy)
        if group.fixes_b and not alike:
            raise DesignError(f"{what}, and the cell of {group.name} is a square", remedy=remedy)
    elif fixed is not None and not square and not (alike and abs(corner - math.radians(fixed)) <= _DRAWN_ALIKE):
        raise DesignError(
            f"{what} with {angle:.6g} degrees, and {group.name} needs {fixed:g} degrees between equal sides",
            remedy=f"{remedy} An upright one is taken for its width.",
        )
    return CellFrame(_free({"a": a, "b": b, "angle": angle}, group), origin, across / a)


def frame_of_place(cell: dict[str, float], translate: complex) -> CellFrame:
    """The cell that was found for strokes, which come into it when they are moved by a vector."""
    return CellFrame(cell, -translate, 1 + 0j)


def corners_of(frame: CellFrame, group: WallpaperGroup) -> tuple[complex, complex, complex]:
    """The corners of a frame's cell on the page: the origin, the end of a, and the end of b."""
    a, b, angle = (frame.cell.get(name) for name in ("a", "b", "angle"))
    assert a is not None
    side = a if group.fixes_b or b is None else b
    corner = group.fixed_angle if angle is None else angle
    assert corner is not None
    return frame.origin, frame.on_page(complex(a)), frame.on_page(side * unit_at(corner))


def _free(cell: dict[str, float], group: WallpaperGroup) -> dict[str, float]:
    """What of a cell a group leaves free."""
    fixed = {"b"} if group.fixes_b else set()
    fixed |= {"angle"} if group.fixed_angle is not None else set()
    return {name: value for name, value in cell.items() if name not in fixed}

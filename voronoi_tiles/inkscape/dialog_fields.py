"""What the dialogs in Inkscape ask for beside a job: the group, the cell and where it lies. Lengths are millimetres."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Literal

from voronoi_tiles.base.tolerance import ANGLE_MIN, CELL_MIN
from voronoi_tiles.base.values import shown
from voronoi_tiles.fabrication.job_limits import STROKE_MIN
from voronoi_tiles.fabrication.job_options import (
    SHEET_MAX,
    Choice,
    JobError,
    Length,
    Option,
    OptionTable,
    choice,
    length,
    read_angle,
)
from voronoi_tiles.groups.wallpaper import GROUPS

CellFrom = Literal["fitted", "numbers"]

CELL_LABEL: Final = "cell"
"""The label of the rectangle that is the cell, in small letters."""

_FINE_MM: Final = 1e-6
"""Finest tolerance of curves; millimetres. What a spin button of six digits can say."""


def _group(name: str, value: Any) -> str:
    """Read the name of a group. Raises JobError."""
    if value not in GROUPS:
        raise JobError(f"`{name}` {shown(value)} is unknown", remedy=f"Use one of {', '.join(GROUPS)}.")
    return str(value)


def _angle(name: str, value: Any) -> float:
    """Read the angle of a cell; degrees. Raises JobError."""
    degrees = read_angle(name, value)
    if not ANGLE_MIN <= degrees <= 180.0 - ANGLE_MIN:
        raise JobError(f"`{name}` {degrees:g} cannot be", remedy="Give degrees between 0 and 180.")
    return degrees


@dataclass(frozen=True, kw_only=True, repr=False)
class DesignFields(OptionTable):
    """The group and the cell of what is selected."""

    group: Option[str, str] = Option(
        "p4", _group, "The wallpaper group that repeats the strokes.", kind="word", words=tuple(GROUPS)
    )
    cell: Choice[CellFrom] = choice(
        "fitted",
        CellFrom,
        "The rectangle with this label in its Object Properties; where there is none, one is fitted to the strokes and "
        "drawn, or the numbers below are taken.",
    )
    side_a: Length = length(60.0, "The side of the cell along x.", least=CELL_MIN)
    side_b: Length = length(60.0, "The other side, where the group leaves it free.", least=CELL_MIN)
    angle: Option[float, float] = Option(
        90.0, _angle, "The angle from a to b, in p1 and p2.", kind="angle", limits=(ANGLE_MIN, 180.0 - ANGLE_MIN)
    )
    origin_x: Length = length(0.0, "The group's origin, to the right of the page's left edge.", least=-SHEET_MAX)
    origin_y: Length = length(0.0, "The group's origin, up from the page's lower edge.", least=-SHEET_MAX)
    tolerance: Length = length(0.01, "Curves are flattened to within this distance.", least=_FINE_MM, most=10.0)


@dataclass(frozen=True, kw_only=True, repr=False)
class TilesFields(DesignFields):
    """What is asked for tiles."""

    line_width: Length = length(
        0.25, "The width of the lines that outlines are drawn with.", least=STROKE_MIN, most=10.0
    )

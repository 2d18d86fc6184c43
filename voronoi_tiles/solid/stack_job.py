"""What is to be made of a stack: how many sheets, their dowels, and how they are cut."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from voronoi_tiles.base.values import shown
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_fields import Curves, Edges, Fit
from voronoi_tiles.fabrication.job_options import (
    SHEET_MIN,
    Choice,
    Flag,
    JobError,
    Length,
    Offset,
    Option,
    OptionTable,
    Rates,
    SheetSize,
    explained,
    length,
)
from voronoi_tiles.formats.presets import DxfVersion

SHEETS_MAX: Final = 200
"""Most sheets of a stack; a count. All their files are open at once."""

_CUT: Final = Job.options()


def read_sheets(name: str, value: object) -> int:
    """Read the number of sheets. Raises JobError."""
    if isinstance(value, str) and value.isascii() and value.isdigit() and len(value) < 9:
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= SHEETS_MAX:
        raise JobError(f"`{name}` {shown(value)} cannot be", remedy=f"Give a whole number from 1 to {SHEETS_MAX}.")
    return value


@dataclass(frozen=True, kw_only=True, repr=False)
class StackJob(OptionTable):
    """What is to be made of a stack; lengths are numbers of millimetres or texts with a unit, "3mm".

    Without a `sheet` there is one stack of each tile; a `sheet` is filled with stacks. All but `sheets` and `dowel` are
    options of a Job, which cuts each sheet.

    Raises JobError for values that cannot be, and that contradict each other.

    >>> import voronoi_tiles as vt
    >>> vt.StackJob(sheets=7, dowel="3mm")
    StackJob(sheets=7, dowel=3.0)
    """

    sheets: Option[int | str, int] = Option(
        1,
        read_sheets,
        "Make a stack of so many sheets, each as thick as that part of the [solid]'s height: a numbered file to cut "
        "for each, as `export` writes it, or all of them as a solid.",
        kind="number",
        shown="N",
    )
    dowel: Option[float | str | None, float | None] = length(
        None,
        "Cut two holes of this diameter into every sheet of each tile, in the same places, for dowels.",
        least=SHEET_MIN,
        shown="DIAMETER",
    )
    sheet: Option[SheetSize, tuple[float, float] | str | None] = _CUT["sheet"]
    margin: Length = _CUT["margin"]
    fit: Choice[Fit] = _CUT["fit"]
    frame: Option[float | str | None, float | None] = _CUT["frame"]
    rotate: Option[float, float] = _CUT["rotate"]
    offset: Option[Offset, complex | None] = _CUT["offset"]
    edges: Choice[Edges | None] = _CUT["edges"]
    gap: Option[float | str | None, float | None] = _CUT["gap"]
    kerf: Length = _CUT["kerf"]
    fillet: Length = _CUT["fillet"]
    tabs: Length = _CUT["tabs"]
    accuracy: Length = _CUT["accuracy"]
    curves: Choice[Curves | None] = _CUT["curves"]
    dxf_version: Choice[DxfVersion] = _CUT["dxf_version"]
    preset: Option[Any, str] = _CUT["preset"]
    stroke: Option[float | str | None, float | None] = _CUT["stroke"]
    feed: Option[Rates, str | None] = _CUT["feed"]
    power: Option[Rates, str | None] = _CUT["power"]
    label_height: Length = _CUT["label_height"]
    marks: Flag = _CUT["marks"]
    bar: Flag = _CUT["bar"]

    def __post_init__(self) -> None:
        if self.dowel is not None and self.kerf >= self.dowel:
            raise JobError(
                f"a `kerf` of {self.kerf:g} mm leaves nothing to cut of holes with `dowel='{self.dowel:g}mm'`",
                remedy="Use a thicker `dowel`.",
            )
        self.cut  # noqa: B018 - what cannot be cut is refused here

    @property
    def cut(self) -> Job:
        """The job of each sheet, with numbers."""
        own = {name: value for name, value in self._said() if name not in ("sheets", "dowel")}
        return Job(**own, labels="number", art="none")


StackJob.__doc__ = explained(StackJob)

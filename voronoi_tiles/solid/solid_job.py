"""What is to be made of a tiling in three dimensions: how high, how far apart, and where."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import partial
from typing import Final

from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_limits import ACCURACY_MIN
from voronoi_tiles.fabrication.job_options import (
    JobError,
    Length,
    Option,
    OptionTable,
    SheetSize,
    explained,
    length,
    read_angle,
    read_colours,
    read_sheet,
)

HEIGHT_MM: Final = 3.0
"""How high solids are where nobody says; millimetres: a board as they are sold."""

HEIGHT_MIN: Final = 0.01
"""Least height; millimetres. A tenth of the thinnest layer that is printed."""

CHORDS_MM: Final = 0.01
"""How far the walls of prisms may be from the exact ones, where nobody says; millimetres: a fortieth of a nozzle."""

_STEEP: Final = 4.0
"""A chamfer has so many accuracies at least: else chords within the accuracy could cross."""


@dataclass(frozen=True, kw_only=True, repr=False)
class SolidJob(OptionTable):
    """What is to be made of a tiling as solids; lengths are numbers of millimetres or texts with a unit, "3mm".

    Without a `sheet` one of each tile is made. Raises JobError for values that cannot be, and that contradict each
    other.

    >>> import voronoi_tiles as vt
    >>> vt.SolidJob(height="5mm", clearance=0.2)
    SolidJob(height=5.0, clearance=0.2)
    """

    height: Option[float | str | None, float | None] = length(
        None,
        "How high the solids are [default: 3mm; a design with a [solid] says it].",
        least=HEIGHT_MIN,
        shown="HEIGHT",
    )
    clearance: Length = length(
        0.0, "Leave this much between neighbours: each tile is drawn in by half of it, so that printed ones fit."
    )
    chamfer: Length = length(0.0, "Break the upper and the lower rim by so much, at 45 degrees.")
    sheet: Option[SheetSize, tuple[float, float] | str | None] = Option(
        None,
        read_sheet,
        "Fill a print bed, or with `sheets` boards to cut: 200x200mm, or what the paths of an SVG or DXF file bound "
        "[default: one of each tile].",
        kind="text",
        shown="WxH|FILE",
    )
    margin: Length = length(0.0, "Keep this distance from the edge of the sheet.")
    rotate: Option[float, float] = Option(
        0.0, read_angle, "Turn the tiles counter-clockwise.", kind="angle", shown="DEGREES"
    )
    gap: Option[float | str | None, float | None] = length(None, "Pull tiles apart until they keep this distance.")
    colours: Option[str | int, str | int] = Option(
        "none",
        partial(read_colours, schemes=("none", "fewest", "site", "handedness", "orientation")),
        "Colour the tiles, a filament each: by N colours or the fewest, so that no neighbours are alike; by site, "
        "handedness or orientation. Each colour is one object of a 3MF file.",
        kind="text",
        shown="N|fewest|site|handedness|orientation",
    )
    accuracy: Option[float | str | None, float | None] = length(
        None,
        "How far walls may be from the exact ones [default: 0.01mm; for a design with a [solid] 0.05mm, or an eighth "
        "of the clearance or chamfer].",
        least=ACCURACY_MIN,
        most=1.0,
    )

    def __post_init__(self) -> None:
        if self.height is not None:
            self.refuse_rims(self.height)
        for name in ("chamfer", "clearance"):
            if 0.0 < getattr(self, name) < _STEEP * self.chords:
                raise JobError(
                    f"`{name}='{getattr(self, name):g}mm'` is hardly more than the `accuracy` of {self.chords:g} mm",
                    remedy=f"Give a finer `accuracy`, or leave `{name}` out.",
                )
        self.flat  # noqa: B018 - what cannot be laid out is refused here

    def refuse_rims(self, height: float) -> None:
        """Raise JobError where chamfers leave nothing of a solid of this height, in millimetres."""
        if 2 * self.chamfer >= height:
            raise JobError(
                f"two rims with `chamfer='{self.chamfer:g}mm'` leave nothing of a `height` of {height:g} mm",
                remedy="Use a smaller `chamfer`, or make it higher.",
            )

    @property
    def flat(self) -> Job:
        """The job that lays the tiles out; what drawing them in makes room for needs no pulling apart."""
        gap = None if self.gap is None else max(self.gap - self.clearance, 0.0)
        return Job(
            sheet=self.sheet, margin=self.margin, rotate=self.rotate, gap=gap, colours=self.colours, edges="pieces"
        )

    @property
    def thickness(self) -> float:
        """How high prisms are; millimetres."""
        return HEIGHT_MM if self.height is None else self.height

    @property
    def chords(self) -> float:
        """How far the walls of prisms may be from the exact ones; millimetres."""
        return CHORDS_MM if self.accuracy is None else self.accuracy

    @property
    def insets(self) -> bool:
        """Whether anything lies within the tiles' outlines: by half a clearance, or by a chamfer."""
        return self.clearance > 0.0 or self.chamfer > 0.0

    @property
    def files(self) -> tuple[str, ...]:
        """The files that it reads: the sheet's drawing."""
        return (os.fspath(self.sheet),) if isinstance(self.sheet, str) else ()


SolidJob.__doc__ = explained(SolidJob)

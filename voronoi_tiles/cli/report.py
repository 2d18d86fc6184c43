"""The command `report`: what a job comes to."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import click

from voronoi_tiles.cli.common import PATH, print_figures, reporting, tessellate
from voronoi_tiles.cli.options import with_job, with_scale

if TYPE_CHECKING:
    from voronoi_tiles.fabrication.job import Job


class _NumberType(click.FloatRange):
    """A number in a range, and no other."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Read a number; what is none is refused as one that is out of range."""
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{value!r} is no number in the range {self._describe_range()}.", param, ctx)
        return float(number)


_SPEED = _NumberType(min=0.001, max=1e6)
_TIME = _NumberType(min=0.0, max=3600.0)


@click.command()
@click.argument("design", type=PATH)
@with_scale
@with_job
@click.option("--json", "as_json", is_flag=True, help="Print the figures as JSON.")
@click.option("--cut-speed", type=_SPEED, metavar="MM/S", help="Speed of cutting [default: 10].")
@click.option("--engrave-speed", type=_SPEED, metavar="MM/S", help="Speed of engraving and scoring [default: 60].")
@click.option("--travel-speed", type=_SPEED, metavar="MM/S", help="Speed between two cuts [default: 200].")
@click.option(
    "--pierce-time",
    type=_TIME,
    metavar="S",
    help="Time for each pierce, in seconds [default: 0.3].",
)
def report(
    design: str,
    job: Job | None,
    as_json: bool,
    cut_speed: float | None,
    engrave_speed: float | None,
    travel_speed: float | None,
    pierce_time: float | None,
) -> None:
    """Print what a job comes to: pieces, sheet use, cut length, pierces, travel, time.

    It takes the options of export; nothing is written.
    """
    from voronoi_tiles.cli.tables import report_text

    given = {"cut": cut_speed, "score": engrave_speed, "engrave": engrave_speed, "travel": travel_speed}
    speeds = {work: speed for work, speed in given.items() if speed is not None}
    with reporting(design):
        figures = tessellate(design).report(job, speeds=speeds, pierce_s=pierce_time)
    print_figures(figures, report_text, as_json=as_json)

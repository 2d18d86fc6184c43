"""Commands around fabrication: `report`, `coupon` and `template`."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.cli.common import PATH, refuse_existing, refuse_output, report_error, say, tessellate
from voronoi_tiles.cli.options import LENGTH, with_job

if TYPE_CHECKING:
    from voronoi_tiles.fabrication.job import Job
    from voronoi_tiles.formats.page import Drawing
    from voronoi_tiles.tiling import Tile, Tiling

_DRAWINGS = (".svg", ".dxf", ".pdf", ".lbrn2")


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
    import json

    from voronoi_tiles.base.files import STDOUT, write_whole
    from voronoi_tiles.cli.tables import report_text
    from voronoi_tiles.fabrication import Job
    from voronoi_tiles.fabrication.job_report import PIERCE_S, report_figures

    given = {"cut": cut_speed, "score": engrave_speed, "engrave": engrave_speed, "travel": travel_speed}
    speeds = {work: speed for work, speed in given.items() if speed is not None}
    try:
        tiling = tessellate(design)
        product = tiling.make(_on_layers(job or Job()))
        figures = report_figures(
            tiling.design, product, speeds=speeds, pierce_s=PIERCE_S if pierce_time is None else pierce_time
        )
    except Exception as error:
        raise click.exceptions.Exit(report_error(design, error)) from error
    text = json.dumps(figures, indent=2) + "\n" if as_json else report_text(figures)
    write_whole(STDOUT, text.encode())


@click.command()
@click.option(
    "-o", "--output", required=True, metavar="FILE", type=PATH, help="The file to write; its suffix says how."
)
@click.option(
    "--kerfs",
    default="0.05:0.4:0.05",
    metavar="RANGE",
    help="First, last and step, or a list [default: 0.05:0.4:0.05].",
)
@click.option("--thickness", type=LENGTH, required=True, metavar="LENGTH", help="How thick the sheet is.")
@click.option("--plug", type=LENGTH, metavar="LENGTH", help="The size of the plugs [default: 10mm].")
@click.option("--preset", default="plain", metavar="NAME|FILE", help="Colours and layers [default: plain].")
def coupon(output: str, kerfs: str, thickness: float, plug: float | None, preset: str) -> None:
    """Write a test piece that shows the kerf: numbered plugs and holes for each of a range of kerfs, and strips.

    Cut it, and try which plug just holds in its hole: its number is the kerf.
    """
    from voronoi_tiles.fabrication.coupon import PLUG_MM, kerf_range
    from voronoi_tiles.fabrication.coupon import coupon as draw
    from voronoi_tiles.formats.writing import recoloured

    refuse_output("-", output, _DRAWINGS)
    try:
        try:
            drawing = draw(kerf_range(kerfs), thickness=thickness, plug=PLUG_MM if plug is None else plug)
        except ValueError as error:
            raise click.UsageError(str(error)) from None
        form = Path(output).suffix.lower().removeprefix(".") or "svg"
        _write(recoloured(drawing, preset, form), output, form)
    except DesignError as error:
        raise click.exceptions.Exit(report_error(preset, error)) from error


@click.command()
@click.argument("design", type=PATH)
@click.option("-o", "--output", required=True, metavar="FILE", type=PATH, help="The file to write (.svg).")
@click.option("--site", metavar="NAME", help="The site to draw for [default: the first].")
def template(design: str, output: str, site: str | None) -> None:
    """Write a page to draw a site's art on, and say what to write into the design.

    The tile and the site's strokes are on a layer "guide"; draw in the layer "engrave", or in one called "score". An
    existing file is not overwritten.
    """
    from voronoi_tiles.fabrication.art_template import art_template

    refuse_output(design, output, (".svg",))
    refuse_existing(output)
    try:
        tiling = tessellate(design)
        tile = _tile_of(tiling, site)
        drawing, corner = art_template(tile.site, tile.outline, tiling.design.unit_mm)
        _write(drawing, output, "svg")
    except Exception as error:
        raise click.exceptions.Exit(report_error(design, error)) from error
    place = f"[{corner.real:g}, {corner.imag:g}]"
    say(f'for [[site]] "{tile.site.name}": art = {{ file = "{Path(output).name}", translate = {place} }}')


def _on_layers(job: Job) -> Job:
    """The job in one drawing: what goes into a file of its own is on a layer of its own."""
    return replace(job, colours="layers") if job.colours == "files" else job


def _tile_of(tiling: Tiling, site: str | None) -> Tile:
    """The tile of a site by its name, without one the first."""
    names = [tile.site.name for tile in tiling.tiles]
    if site is not None and site not in names:
        raise DesignError(f'there is no site "{site}"', remedy=f"Sites are {', '.join(names)}.")
    return tiling.tiles[0 if site is None else names.index(site)]


def _write(drawing: Drawing, output: str, form: str) -> None:
    """Write a drawing that is no tiling's."""
    from voronoi_tiles.base.files import STDOUT, writing
    from voronoi_tiles.fabrication.job import ACCURACY_MM
    from voronoi_tiles.formats.writing import write_drawing

    with writing(output) as file:
        write_drawing(drawing, file, form, accuracy=ACCURACY_MM)
    if output != STDOUT:
        say(f"wrote {output}")

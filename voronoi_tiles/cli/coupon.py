"""The command `coupon`: a test piece that shows the kerf."""

from __future__ import annotations

import click

from voronoi_tiles.base.errors import ArgumentError, DesignError
from voronoi_tiles.cli.common import PATH, as_options, refuse_output, report_error, say_written
from voronoi_tiles.cli.options import LENGTH
from voronoi_tiles.fabrication.job import Job


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
@click.option("--plug", default="10mm", type=LENGTH, metavar="LENGTH", help="The size of the plugs [default: 10mm].")
@click.option("--preset", default="plain", metavar="NAME|FILE", help="Colours and layers [default: plain].")
@click.option("--feed", metavar="MM/MIN", help=as_options(Job.options()["feed"].help))
@click.option("--power", metavar="S", help=as_options(Job.options()["power"].help))
def coupon(
    output: str, kerfs: str, thickness: float, plug: float, preset: str, feed: str | None, power: str | None
) -> None:
    """Write a test piece that shows the kerf: numbered plugs and holes for each of a range of kerfs, and strips.

    Cut it, and try which plug just holds in its hole: its number is the kerf.
    """
    from voronoi_tiles.fabrication.coupon import coupon as write_coupon

    refuse_output("-", output, (".svg", ".dxf", ".pdf", ".lbrn2", ".gcode", ".nc"))
    try:
        write_coupon(output, thickness=thickness, kerfs=kerfs, plug=plug, preset=preset, feed=feed, power=power)
    except ArgumentError as error:
        raise click.UsageError(as_options(str(error))) from None
    except DesignError as error:
        raise click.exceptions.Exit(report_error(preset, error)) from error
    say_written(output)

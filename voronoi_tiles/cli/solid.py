"""The command `solid`: tiles as solids, to print, and pictures and figures of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from voronoi_tiles.cli.common import (
    PATH,
    as_options,
    load,
    print_figures,
    refuse_output,
    reporting,
    say,
    say_written,
)
from voronoi_tiles.cli.options import with_scale, with_solid_job

if TYPE_CHECKING:
    from voronoi_tiles.solid.solid_job import SolidJob
    from voronoi_tiles.solid.solid_model import SolidFormat

_SUFFIXES = (".3mf", ".stl", ".png")


@click.command()
@click.argument("design", type=PATH)
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="FILE",
    type=PATH,
    help="The file to write, its format by its suffix: .3mf, .stl, or .png for a picture; - for standard output.",
)
@click.option(
    "--format", "file_format", type=click.Choice(("3mf", "stl", "png")), help="The format on standard output."
)
@with_scale
@with_solid_job
@click.option(
    "--size", type=click.IntRange(1, 4000), metavar="N", help="The longer side of a picture in pixels [default: 1200]."
)
@click.option("--report", is_flag=True, help="Print volume, mass, the narrowest neck, overhangs, which way up.")
@click.option("--json", "as_json", is_flag=True, help="Print these as JSON, with the proof's figures.")
@click.option(
    "--density", type=click.FloatRange(0.001, 100.0), metavar="G/CM3", help="For the mass [default: 1.24, PLA]."
)
@click.option("-q", "--quiet", is_flag=True, help="Report only what fails.")
def solid(
    design: str,
    output: str,
    file_format: SolidFormat | None,
    job: SolidJob,
    size: int | None,
    report: bool,
    as_json: bool,
    density: float | None,
    quiet: bool,
) -> None:
    """Write the tiles of a design as solids, proved: one of each, or a sheet of them.

    3MF holds an object for each piece, with its colour, and what it was made from; STL all of them in one, without
    colours. Neighbours share every point of their walls: printed pieces need a clearance, 0.2mm, to go together. A
    picture shows a tile and its neighbours, pulled apart, or the sheet. A design with a [solid] is lofted.
    """
    from voronoi_tiles.cli.tables import solid_text
    from voronoi_tiles.solid.extrusion import extrude, surrounded
    from voronoi_tiles.solid.solid_report import DENSITY, solid_report

    if output == "-" and file_format is None:
        raise click.UsageError("On standard output the format is not clear: add --format 3mf, stl or png.")
    reports = report or as_json
    if density is not None and not reports:
        raise click.UsageError("--density is for the mass: add --report, or --json.")
    if reports and output == "-":
        raise click.UsageError("The report goes to standard output: give the solids a file.")
    refuse_output(design, output, (f".{file_format}",) if file_format else _SUFFIXES)
    with reporting(design):
        loaded = load(design, quiet=quiet)
        around = (output.lower().endswith(".png") or file_format == "png") and job.sheet is None
        if loaded.standing is not None:
            from voronoi_tiles.solid.standing import stand

            made = stand(loaded, job, around=around)
        else:
            made = (surrounded if around else extrude)(loaded.tessellate(), job)
        figures = solid_report(made, DENSITY if density is None else density) if reports else {}
        made.save(output, file_format, size=size)
    if not quiet:
        for note in made.notes:
            say(as_options(note))
        say_written(output, made.summary())
        say(f"proved: {made.proved}")
    if reports:
        print_figures(figures, solid_text, as_json=as_json)

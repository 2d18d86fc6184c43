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
from voronoi_tiles.cli.progress_bar import progress_bar, waiting

if TYPE_CHECKING:
    from voronoi_tiles.designs.design import Design
    from voronoi_tiles.formats.presets import Format
    from voronoi_tiles.solid.solid_job import SolidJob
    from voronoi_tiles.solid.solid_model import SolidFormat, SolidModel
    from voronoi_tiles.solid.stack import Stack
    from voronoi_tiles.solid.stack_job import StackJob

_SUFFIXES = (".3mf", ".stl", ".png")
_CUT_SUFFIXES = (".svg", ".dxf", ".pdf", ".lbrn2", ".gcode", ".nc")


@click.command()
@click.argument("design", type=PATH)
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="FILE",
    type=PATH,
    help="The file to write, its format by its suffix: .3mf, .stl, or .png for a picture; with --sheets also .svg, "
    ".dxf, .pdf, .lbrn2, .gcode or .nc, to cut; - for standard output.",
)
@click.option(
    "--format", "file_format", type=click.Choice(("3mf", "stl", "png")), help="The format on standard output."
)
@with_scale
@with_solid_job
@click.option(
    "--size", type=click.IntRange(1, 4000), metavar="N", help="The longer side of a picture in pixels [default: 1200]."
)
@click.option(
    "--report",
    is_flag=True,
    help="Print volume, mass, the narrowest neck, overhangs, which way up, how tiles are laid; of a stack its sheets "
    "and where dowels go.",
)
@click.option("--json", "as_json", is_flag=True, help="Print these as JSON, with the proof's figures.")
@click.option(
    "--density",
    type=click.FloatRange(0.001, 100.0),
    metavar="G/CM3",
    help="For the mass [default: 1.24, PLA; 0.68, plywood, for what is cut].",
)
@click.option("-q", "--quiet", is_flag=True, help="Report only what fails.")
def solid(
    design: str,
    output: str,
    file_format: SolidFormat | None,
    job: SolidJob | StackJob,
    size: int | None,
    report: bool,
    as_json: bool,
    density: float | None,
    quiet: bool,
) -> None:
    """Write the tiles of a design as solids, proved: one of each, or a sheet of them.

    3MF holds an object for each piece, with its colour, and what it was made from; STL all of them in one, without
    colours. Neighbours share every point of their walls: printed pieces need a clearance, 0.2mm, to go together. A
    picture shows a tile and its neighbours, pulled apart, or the sheet. A design with a [solid] is lofted, or with
    --sheets cut in sheets that are stacked.
    """
    from voronoi_tiles.cli.tables import solid_text, stack_text
    from voronoi_tiles.solid.solid_report import DENSITY, PLYWOOD, solid_report
    from voronoi_tiles.solid.stack_job import StackJob

    if output == "-" and file_format is None:
        raise click.UsageError("On standard output the format is not clear: add --format 3mf, stl or png.")
    reports, picture = report or as_json, (f".{file_format}" if file_format else output.lower()).endswith(".png")
    if size is not None and not picture:
        raise click.UsageError("--size is for a picture: write a .png, or leave it out.")
    if density is not None and not reports:
        raise click.UsageError("--density is for the mass: add --report, or --json.")
    if reports and output == "-":
        raise click.UsageError("The report goes to standard output: give the solids a file.")
    stacked = isinstance(job, StackJob)
    if not stacked and file_format is None and output.lower().endswith(_CUT_SUFFIXES):
        raise click.UsageError(
            "Files to cut are of sheets: add --sheets 7, for a design with a [solid]; flat tiles are cut by export."
        )
    suffixes = (*_SUFFIXES, *_CUT_SUFFIXES) if stacked else _SUFFIXES
    refuse_output(design, output, (f".{file_format}",) if file_format else suffixes)
    with reporting(design):
        loaded = load(design, quiet=quiet)
        if isinstance(job, StackJob):
            cut, form = _stack(loaded, job, output, file_format, size, quiet=quiet)
            figures = cut.report(density or (DENSITY if form is None else PLYWOOD), form) if reports else {}
        else:
            around = picture and job.sheet is None
            with waiting("solids", quiet=quiet):
                made = _model(loaded, job, around=around)
                # What is there for the picture alone is not counted.
                reported = _model(loaded, job, around=False) if around and reports else made
                figures = solid_report(reported, density or DENSITY) if reports else {}
            _save(made, output, file_format, size, quiet=quiet)
    if reports:
        print_figures(figures, stack_text if stacked else solid_text, as_json=as_json)


def _model(design: Design, job: SolidJob, *, around: bool) -> SolidModel:
    """The solids of a design, or what a picture shows of them."""
    if design.standing is not None:
        from voronoi_tiles.solid.standing import stand

        return stand(design, job, around=around)
    from voronoi_tiles.solid.extrusion import extrude, surrounded

    return (surrounded if around else extrude)(design.tessellate(), job)


def _save(made: SolidModel, output: str, file_format: SolidFormat | None, size: int | None, *, quiet: bool) -> None:
    """Write solids, and say what was written."""
    with waiting("writing", quiet=quiet):
        made.save(output, file_format, size=size)
    if not quiet:
        for note in made.notes:
            say(as_options(note))
        say_written(output, made.summary())
        say(f"proved: {made.proved}")


def _stack(
    design: Design,
    job: StackJob,
    output: str,
    file_format: SolidFormat | None,
    size: int | None,
    *,
    quiet: bool,
) -> tuple[Stack, Format | None]:
    """Write a stack, as files to cut or as a solid, and say what was written; the format of what is cut."""
    from voronoi_tiles.fabrication.exporting import format_of
    from voronoi_tiles.formats.presets import FORMATS
    from voronoi_tiles.solid.stack import stack

    with progress_bar("tiles of sheets", quiet=quiet) as progress:
        made = stack(design, job, progress)
    form = None
    if file_format is not None or output.lower().endswith(_SUFFIXES):
        with waiting("solids", quiet=quiet):
            model = made.model
        _save(model, output, file_format, size, quiet=quiet)
    else:
        form = format_of(output, FORMATS)
        with progress_bar("drawing sheets", quiet=quiet) as progress:
            written = made.export(output, form, progress)
        if not quiet:
            for note in dict.fromkeys(note for _, product in written if product for note in product.notes):
                say(as_options(note))
            for path, product in written:
                say_written(path, product and as_options(product.summary()))
    if not quiet:
        say(made.summary(form))
    return made, form

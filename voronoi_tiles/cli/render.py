"""The command `render`: a picture of the tessellation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from voronoi_tiles.cli.common import EXIT_FAILED, PATH, load, refuse_output, report_error, reporting, say, say_written
from voronoi_tiles.cli.options import Command, with_method, with_renderer, with_scale
from voronoi_tiles.cli.progress_bar import progress_bar
from voronoi_tiles.fabrication.job import Job

if TYPE_CHECKING:
    from voronoi_tiles.raster.renderer import Choice, Method


def _read_size(_context: click.Context, _parameter: click.Parameter, text: str | None) -> int | tuple[int, int] | None:
    """Read the size of a picture: "1600" or "1920x1080"."""
    if text is None:
        return None
    sides = text.lower().split("x")
    if len(sides) > 2 or not all(side.isascii() and side.isdigit() and len(side) < 10 for side in sides):
        raise click.BadParameter(f"{text!r} is no size. Write 1600, or 1920x1080.")
    numbers = [int(side) for side in sides]
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])


def _read_region(
    _context: click.Context, _parameter: click.Parameter, text: str | None
) -> tuple[float, float, float, float] | None:
    """Read a rectangle: "0,0,120,60"."""
    if text is None:
        return None
    try:
        x0, y0, x1, y1 = (float(part) for part in text.split(","))
    except ValueError:
        raise click.BadParameter(f"{text!r} is no rectangle. Write X0,Y0,X1,Y1, such as 0,0,120,60.") from None
    return x0, y0, x1, y1


def with_picture(command: Command) -> Command:
    """Add the options that say what a picture shows: `size`, `region`, `overlay` and `method`."""
    for add in (
        with_method,
        click.option(
            "--overlay",
            multiple=True,
            type=click.Choice(("symmetry", "cell", "outline", "art", "grid")),
            help="Draw on top: mirrors, glides and rotation centres; the cell; the exact outlines; the sites' art in "
            "the place of their strokes; a grid of coordinates. May be repeated.",
        ),
        click.option(
            "--region",
            metavar="X0,Y0,X1,Y1",
            callback=_read_region,
            help="The rectangle to show, in the design's units [default: two cells each way, which repeat seamlessly].",
        ),
        click.option(
            "--size",
            metavar="N|WxH",
            callback=_read_size,
            help="The longer side in pixels, or both: then the region grows to the picture's shape [default: 1600].",
        ),
    ):
        command = add(command)
    return command


@click.command()
@click.argument("design", type=PATH)
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="PICTURE",
    type=PATH,
    help="The file to write (.png); - for standard output.",
)
@with_picture
@click.option(
    "--colours",
    "--colors",
    metavar=Job.options()["colours"].shown,
    help="The colours that export gives the tiles, a wood each [default: no neighbours are alike].",
)
@with_scale
@with_renderer
@click.option("-q", "--quiet", is_flag=True, help="Report only what fails.")
def render(
    design: str,
    output: str,
    size: int | tuple[int, int] | None,
    region: tuple[float, float, float, float] | None,
    overlay: tuple[str, ...],
    colours: str | None,
    method: Method,
    renderer: Choice,
    device: int | None,
    quiet: bool,
) -> None:
    """Write a picture (PNG) of the tessellation: coloured tiles, their borders, and the strokes that made them.

    Where copies touch or cross there are no tiles: the picture shows the two copies and the place, a message says it,
    and the exit code is 1.
    """
    from voronoi_tiles.pictures.picture_size import DEFAULT_SIZE
    from voronoi_tiles.pictures.rendering import render as render_picture

    refuse_output(design, output, (".png",))
    with reporting(design), progress_bar("rendering", quiet=quiet) as progress:
        provenance = render_picture(
            load(design, quiet=quiet),
            output,
            size=DEFAULT_SIZE if size is None else size,
            region=region,
            overlay=overlay,
            colours="none" if colours is None else colours,
            method=method,
            renderer=renderer,
            device=device,
            notice=say,
            progress=progress,
        )
    if not quiet:
        say_written(output, provenance)
    if provenance.touching is not None:
        report_error(design, provenance.touching)
        raise click.exceptions.Exit(EXIT_FAILED)

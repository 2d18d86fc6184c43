"""The command `export`: files of tiles, exact or ready for a cutter."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from voronoi_tiles.cli.common import PATH, as_options, report_error, say, say_written, tessellate
from voronoi_tiles.cli.options import with_job, with_renderer, with_scale
from voronoi_tiles.cli.progress_bar import progress_bar

if TYPE_CHECKING:
    from voronoi_tiles.fabrication.job import Job
    from voronoi_tiles.raster.renderer import Choice
    from voronoi_tiles.tiling import FileFormat


@click.command()
@click.argument("designs", metavar="DESIGN...", nargs=-1, required=True, type=PATH)
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="OUT",
    type=PATH,
    help="The file to write, its format by its suffix (.svg, .dxf, .pdf, .lbrn2, .gcode or .nc, .json); a folder for "
    "several designs; - for standard output.",
)
@click.option(
    "--format",
    "file_format",
    type=click.Choice(("svg", "json", "dxf", "pdf", "lbrn2", "gcode")),
    help="The format where OUT names none: a folder or standard output.",
)
@with_scale
@with_job
@click.option("-q", "--quiet", is_flag=True, help="Report only what fails.")
@click.option("--check", is_flag=True, help="Cross-check the outlines first, and record it in the file's metadata.")
@with_renderer
def export(
    designs: tuple[str, ...],
    output: str,
    file_format: FileFormat | None,
    job: Job | None,
    quiet: bool,
    check: bool,
    renderer: Choice,
    device: int | None,
) -> None:
    """Write the tiles of designs: SVG, DXF, PDF, LightBurn files or G-code, ready to cut, or a JSON outline document.

    DESIGN is a TOML or JSON file, or - for standard input. Lengths are millimetres unless they say cm or in. With
    several designs the good ones are written, the bad ones named, and the exit code is the worst.
    """
    if not check and (renderer != "auto" or device is not None):
        raise click.UsageError("--renderer and --device say how to check: add --check.")
    worst = 0
    for design, (target, target_format) in zip(designs, _targets(designs, output, file_format), strict=True):
        try:
            tiling = tessellate(design, quiet=quiet)
            report = tiling.check(renderer=renderer, device=device, notice=say) if check else None
            if report is None or report.passed:  # else nothing is to be left, and export says so
                _make_folder(target, output)
            with progress_bar("nesting", quiet=quiet) as progress:
                written = tiling.export(target, job=job, check=report, file_format=target_format, progress=progress)
        except Exception as error:  # noqa: BLE001 - whatever one design does, the others are still to be written
            worst = max(worst, report_error(design, error))
        else:
            said: set[str] = set()  # the files of colours have much to say in common
            for path, product in () if quiet or target == "-" else written:
                for note in () if product is None else product.notes:
                    if note not in said:
                        say(as_options(note))
                    said.add(note)
                say_written(path, None if product is None else as_options(product.summary()))
    if worst:
        raise click.exceptions.Exit(worst)


def _targets(designs: Sequence[str], output: str, file_format: FileFormat | None) -> list[tuple[str, FileFormat]]:
    """For each design the file to write and its format; refuse what cannot be meant.

    That is: one place for several results, or a result that would overwrite a design.
    """
    from voronoi_tiles.formats.presets import SUFFIXES
    from voronoi_tiles.tiling import FORMATS

    if not output:
        raise click.UsageError("The name of the file to write is empty: -o FILE.")
    if designs.count("-") > 1:
        raise click.UsageError("Standard input can be read once only.")
    path = Path(output)
    several = len(designs) > 1
    if output == "-":
        if several:
            raise click.UsageError("Several designs need a folder: -o DIR.")
        return [("-", file_format or FORMATS[0])]
    folder = os.path.isdir(output)  # noqa: PTH112 - a name that the system refuses is no folder, and no error here
    suffix = path.suffix.lower().removeprefix(".")
    named = next((name for name in FORMATS if name == SUFFIXES.get(suffix, suffix)), None)
    if not several and not output.endswith("/") and not folder:
        form = file_format or named
        if form is None:
            suffixes = " or ".join(f".{name}" for name in FORMATS)
            raise click.UsageError(f"The format of {output} is not clear: give it the suffix {suffixes}, or --format.")
        if named not in {None, form}:
            raise click.UsageError(f"{output} and --format {file_format} contradict each other: leave out --format.")
        targets = [(output, form)]
    elif not folder and (os.path.exists(output) or named is not None):  # noqa: PTH110 - same
        raise click.UsageError(f"Several designs need a folder: -o DIR, and {output} is a file.")
    else:
        form = file_format or FORMATS[0]
        stems = ["design" if design == "-" else Path(design).stem for design in designs]
        twice = [stem for stem, count in Counter(stems).items() if count > 1]
        if twice:
            raise click.UsageError(f"Two designs would be written to {twice[0]}.{form}: rename one.")
        targets = [(str(path / f"{stem}.{form}"), form) for stem in stems]
    sources = {os.path.realpath(design) for design in designs if design != "-"}
    for target, _ in targets:
        if os.path.realpath(target) in sources:
            raise click.UsageError(f"{target} is a design, and would be overwritten.")
    return targets


def _make_folder(target: str, output: str) -> None:
    """Make the folder OUT when results go into one."""
    from voronoi_tiles.base.files import output_error

    if target in {output, "-"}:
        return
    try:
        Path(output).mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise output_error(output, error) from error

"""The command `export`: files of tiles, exact or ready for a cutter."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import click

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.cli.common import PATH, report_error, say, tessellate
from voronoi_tiles.cli.options import with_job, with_renderer

if TYPE_CHECKING:
    from voronoi_tiles.crosscheck import CheckReport
    from voronoi_tiles.fabrication.job import Job
    from voronoi_tiles.raster.renderer import Choice
    from voronoi_tiles.tiling import Tiling


@click.command()
@click.argument("designs", metavar="DESIGN...", nargs=-1, required=True, type=PATH)
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="OUT",
    type=PATH,
    help="The file to write, its format by its suffix (.svg, .dxf, .pdf, .lbrn2, .json); a folder for several designs; "
    "- for standard output.",
)
@click.option(
    "--format",
    "file_format",
    type=click.Choice(("svg", "json", "dxf", "pdf", "lbrn2")),
    help="The format where OUT names none: a folder or standard output.",
)
@with_job
@click.option("-q", "--quiet", is_flag=True, help="Report only what fails.")
@click.option("--check", is_flag=True, help="Cross-check the outlines first, and record it in the file's metadata.")
@with_renderer
def export(
    designs: tuple[str, ...],
    output: str,
    file_format: str | None,
    job: Job | None,
    quiet: bool,
    check: bool,
    renderer: Choice,
    device: int | None,
) -> None:
    """Write the tiles of designs: SVG, DXF, PDF or LightBurn files, ready to cut, or a JSON outline document.

    DESIGN is a TOML or JSON file, or - for standard input. Lengths are millimetres unless they say cm or in. With
    several designs the good ones are written, the bad ones named, and the exit code is the worst.
    """
    from voronoi_tiles.base.files import STDOUT, is_special
    from voronoi_tiles.tiling import require

    if not check and (renderer != "auto" or device is not None):
        raise click.UsageError("--renderer and --device say how to check: add --check.")
    targets = _targets(designs, output, file_format)
    if job is not None and job.colours == "files" and (output == STDOUT or is_special(output)):
        raise click.UsageError("Several files need a name that they can begin with: -o sheet.svg.")
    worst = 0
    for design, (target, target_format) in zip(designs, targets, strict=True):
        try:
            tiling = tessellate(design)
            report = tiling.check(renderer=renderer, device=device, notice=say) if check else None
            if report is not None:
                require(report)
            _make_folder(target, output)
            written = _write(tiling, target, target_format, job, report)
        except Exception as error:  # noqa: BLE001 - whatever one design does, the others are still to be written
            worst = max(worst, report_error(design, error))
        else:
            if not quiet and target != STDOUT:
                for line in written:
                    say(line)
    if worst:
        raise click.exceptions.Exit(worst)


def _write(tiling: Tiling, target: str, form: str, job: Job | None, check: CheckReport | None) -> list[str]:
    """Write one design, or its files, one for each colour; say what there is to say."""
    if job is None or job.colours != "files" or form == "json":
        _refuse_inputs(tiling, job, [target])
        product = tiling.write(target, form, job=job, check=check)
        return [f"wrote {target}"] if product is None else [*product.notes, f"wrote {target}: {product.summary()}"]
    from voronoi_tiles.base.files import writing
    from voronoi_tiles.fabrication import make_colours

    path = Path(target)
    # All of them before the first is written: a job that cannot be done leaves nothing.
    products = {
        str(path.with_name(f"{path.stem}-{name}{path.suffix}")): product
        for name, product in make_colours(tiling.design, tiling.tessellation, job, form)
    }
    _refuse_inputs(tiling, job, list(products))
    lines = []
    # No file takes its place before all are written.
    with ExitStack() as stack:
        for part, product in products.items():
            file = stack.enter_context(writing(part))
            (product if check is None else product.with_evidence(tiling.evidence(check))).write(file)
            lines += [*product.notes, f"wrote {part}: {product.summary()}"]
    return lines


def _refuse_inputs(tiling: Tiling, job: Job | None, targets: Sequence[str]) -> None:
    """Refuse to overwrite what a job is made from: the sheet's drawing, the preset, the art."""
    design = tiling.design
    read = [os.path.join(design.folder, art.file) for art in design.art if art is not None]  # noqa: PTH118 - any name
    if job is not None:
        read += [name for name in (job.sheet, job.preset) if isinstance(name, str)]
    known = {os.path.realpath(name) for name in read}
    for target in targets:
        if os.path.realpath(target) in known:
            raise OutputError(
                f"{target} is read for this job, and would be overwritten", path=target, remedy="Choose another name."
            )


def _targets(designs: Sequence[str], output: str, file_format: str | None) -> list[tuple[str, str]]:
    """Give for each design the file to write and its format; refuse what cannot be meant.

    That is: one place for several results, or a result that would overwrite a design.
    """
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
    if not several and not output.endswith("/") and not folder:
        if suffix not in FORMATS and not file_format:
            suffixes = " or ".join(f".{name}" for name in FORMATS)
            raise click.UsageError(f"The format of {output} is not clear: give it the suffix {suffixes}, or --format.")
        if suffix in FORMATS and file_format not in {None, suffix}:
            raise click.UsageError(f"{output} and --format {file_format} contradict each other: leave out --format.")
        targets = [(output, file_format or suffix)]
    elif not folder and (os.path.exists(output) or suffix in FORMATS):  # noqa: PTH110 - same
        raise click.UsageError(f"Several designs need a folder: -o DIR, and {output} is a file.")
    else:
        suffix = file_format or FORMATS[0]
        stems = ["design" if design == "-" else Path(design).stem for design in designs]
        twice = [stem for stem, count in Counter(stems).items() if count > 1]
        if twice:
            raise click.UsageError(f"Two designs would be written to {twice[0]}.{suffix}: rename one.")
        targets = [(str(path / f"{stem}.{suffix}"), suffix) for stem in stems]
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

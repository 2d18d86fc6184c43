"""The command `preflight`: whether a drawing can be cut as it is, and where it cannot."""

from __future__ import annotations

import os

import click

from voronoi_tiles.commands.common import EXIT_USAGE, report_error, say, shown
from voronoi_tiles.errors import DesignError


def _read_length(_context: click.Context, _parameter: click.Parameter, text: str) -> float:
    """Read a length that is not negative: "1mm"."""
    from voronoi_tiles.lengths import parse_length

    try:
        length = parse_length(text)
    except DesignError as error:
        raise click.BadParameter(str(error)) from None
    if length < 0.0:
        raise click.BadParameter(f"{text!r} is negative. Write 0 or more.")
    return length


def _read_optional(context: click.Context, parameter: click.Parameter, text: str | None) -> float | None:
    """Read a length that may be left out."""
    return None if text is None else _read_length(context, parameter, text)


def _read_tolerance(context: click.Context, parameter: click.Parameter, text: str) -> float:
    """Read a length that is greater than a nanometre."""
    length = _read_length(context, parameter, text)
    if length < 1e-6:
        raise click.BadParameter(f"{text!r} is too small. Write 0.000001mm or more.")
    return length


@click.command()
@click.argument("file", type=click.Path(allow_dash=True, readable=False))
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@click.option(
    "-o",
    "--output",
    metavar="MARKED",
    type=click.Path(allow_dash=True, readable=False),
    help="Write a picture (.svg) of the drawing with a numbered mark at every finding.",
)
@click.option(
    "--neck",
    default="1mm",
    metavar="LENGTH",
    callback=_read_length,
    help="Warn of material that is narrower; 0 for never [default: 1mm].",
)
@click.option(
    "--feature",
    default="1mm",
    metavar="LENGTH",
    callback=_read_length,
    help="Warn of contours that are smaller [default: 1mm].",
)
@click.option(
    "--tolerance",
    default="0.005mm",
    metavar="LENGTH",
    callback=_read_tolerance,
    help="Lines and ends that are nearer are one [default: 0.005mm].",
)
@click.option(
    "--tabs",
    metavar="LENGTH",
    callback=_read_optional,
    help="Gaps up to this width are tabs [default: what a file of our own says].",
)
@click.option(
    "--layer",
    "layers",
    multiple=True,
    metavar="NAME",
    help="Judge this layer, or colour (#ff0000), as cut, and no other; may be repeated "
    "[default: all but those named engrave, score, ...].",
)
def preflight(
    file: str,
    as_json: bool,
    output: str | None,
    neck: float,
    feature: float,
    tolerance: float,
    tabs: float | None,
    layers: tuple[str, ...],
) -> None:
    """Find what would spoil the cut of an SVG or DXF file: open, doubled and crossing lines, wrong size, thin necks.

    Places are in millimetres as the file's own program shows them: SVG from the upper left corner, y down; DXF y up.
    The exit code is 1 where something would spoil the cut, 2 where the file cannot be read.
    """
    from voronoi_tiles.files import STDOUT, write_whole
    from voronoi_tiles.preflight import Limits, report_text
    from voronoi_tiles.preflight import preflight as find

    _refuse_output(file, output)
    try:
        limits = Limits(tolerance=tolerance, neck=neck, feature=feature, tabs=tabs)
        report = find(file, limits=limits, layers=layers)
        if output is not None:
            from voronoi_tiles.preflight.marked import marked_svg

            write_whole(output, marked_svg(report).encode())
            say(f"wrote {output}")
    except MemoryError as error:
        say(f"Error: {shown(file)}: there is not enough memory for this drawing. Split it, or simplify its curves.")
        raise click.exceptions.Exit(EXIT_USAGE) from error
    except Exception as error:
        raise click.exceptions.Exit(report_error(file, error)) from error
    write_whole(STDOUT, (report.json() if as_json else report_text(report)).encode())
    if not report.passed:
        errors = sum(finding.severity == "error" for finding in report.findings)
        findings = "1 finding" if errors == 1 else f"{errors:,} findings"
        say(f"Error: {shown(file)}: {findings} would spoil the cut.")
        raise click.exceptions.Exit(1)


def _refuse_output(file: str, output: str | None) -> None:
    """Refuse a picture that is none by its name, or that would overwrite the drawing."""
    from voronoi_tiles.files import STDOUT, is_special

    if output is None:
        return
    if not output:
        raise click.UsageError("The name of the file to write is empty: -o FILE.")
    if output == STDOUT:
        raise click.UsageError("The report goes to standard output: give the picture a file, -o marked.svg.")
    if not output.lower().endswith(".svg") and not is_special(output):
        raise click.UsageError(f"{output} is no name of an SVG file: give it the suffix .svg.")
    if file != "-" and os.path.realpath(output) == os.path.realpath(file):
        raise click.UsageError(f"{output} is the drawing, and would be overwritten.")

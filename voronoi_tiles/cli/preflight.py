"""The command `preflight`: whether a drawing can be cut as it is, and where it cannot."""

from __future__ import annotations

from dataclasses import replace

import click

from voronoi_tiles.base.text import counted
from voronoi_tiles.cli.common import (
    EXIT_USAGE,
    PATH,
    as_options,
    print_figures,
    refuse_output,
    report_error,
    say,
    say_written,
    shown,
)
from voronoi_tiles.cli.options import LENGTH, Length

_APART = Length(least=1e-6)
"""A length from a nanometre on: preflight's LENGTH_MIN, without importing it."""


@click.command()
@click.argument("file", type=PATH)
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@click.option(
    "-o",
    "--output",
    metavar="MARKED",
    type=PATH,
    help="Write a picture (.svg) of the drawing with a numbered mark at every finding.",
)
@click.option(
    "--neck",
    default="1mm",
    metavar="LENGTH",
    type=LENGTH,
    help="Warn of material that is narrower; 0 for never [default: 1mm].",
)
@click.option(
    "--feature",
    default="1mm",
    metavar="LENGTH",
    type=LENGTH,
    help="Warn of contours that are smaller [default: 1mm].",
)
@click.option(
    "--tolerance",
    default="0.005mm",
    metavar="LENGTH",
    type=_APART,
    help="Lines and ends that are nearer are one [default: 0.005mm].",
)
@click.option(
    "--tabs",
    metavar="LENGTH",
    type=LENGTH,
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
    """Find what would spoil the cut of an SVG, DXF or G-code file: open, doubled, crossing lines, size, thin necks.

    Places are in millimetres as the file's own program shows them: SVG from the upper left corner, y down; others y up.
    The exit code is 1 where something would spoil the cut, 2 where the file cannot be read.
    """
    from voronoi_tiles.base.files import write_whole
    from voronoi_tiles.preflight import Limits, report_text
    from voronoi_tiles.preflight import preflight as find

    refuse_output(file, output, (".svg",), stream=False)
    try:
        limits = Limits(tolerance=tolerance, neck=neck, feature=feature, tabs=tabs)
        report = find(file, limits=limits, layers=layers)
        report = replace(report, findings=tuple(replace(one, remedy=as_options(one.remedy)) for one in report.findings))
        if output is not None:
            from voronoi_tiles.preflight.annotated import marked_svg

            write_whole(output, marked_svg(report).encode())
            say_written(output)
    except MemoryError as error:
        say(f"Error: {shown(file)}: there is not enough memory for this drawing. Split it, or simplify its curves.")
        raise click.exceptions.Exit(EXIT_USAGE) from error
    except Exception as error:
        raise click.exceptions.Exit(report_error(file, error)) from error
    print_figures(report.document(), lambda _: report_text(report), as_json=as_json)
    if not report.passed:
        errors = sum(finding.severity == "error" for finding in report.findings)
        say(f"Error: {shown(file)}: {counted(errors, 'finding')} would spoil the cut.")
        raise click.exceptions.Exit(1)

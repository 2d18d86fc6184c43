"""The command `check`: the exact outlines against an image."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import click

from voronoi_tiles.cli.common import PATH, print_figures, refuse_output, reporting, say, say_written, tessellate
from voronoi_tiles.cli.options import with_method, with_renderer, with_scale
from voronoi_tiles.cli.progress_bar import waiting

if TYPE_CHECKING:
    from voronoi_tiles.raster.renderer import Choice, Method
    from voronoi_tiles.tiling import Tiling


@click.command()
@click.argument("design", type=PATH)
@click.option(
    "--size",
    type=click.IntRange(16, 8192),
    metavar="N",
    help="Samples along the side of the cell [16 to 8192, which takes 4 GB; default: 1024].",
)
@click.option(
    "--accuracy",
    metavar="LENGTH",
    help="Of a design with a [solid], as for `solid`: how far walls may be from the exact ones [default: 0.05mm].",
)
@click.option(
    "--slices",
    type=click.IntRange(1, 1000),
    metavar="N",
    help="Of a design with a [solid], at how many heights between layers it is checked [default: 8].",
)
@with_scale
@with_method
@with_renderer
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@click.option(
    "-o", "--output", metavar="DIFF", type=PATH, help="Write a picture (.png) of where, and by how much, they differ."
)
def check(
    design: str,
    size: int | None,
    accuracy: str | None,
    slices: int | None,
    method: Method,
    renderer: Choice,
    device: int | None,
    as_json: bool,
    output: str | None,
) -> None:
    """Check the exact outlines of a design against an image that is rendered by another method.

    Every figure is printed with its limit and what that follows from. The exit code is 1 where they differ. Of a design
    with a [solid], the drawing at the height 0 is checked, and slices of the solid at heights between its layers.
    """
    from voronoi_tiles.cli.tables import check_text
    from voronoi_tiles.crosscheck.check_report import require_passed

    refuse_output(design, output, (".png",), stream=False)
    with reporting(design), waiting("checking", quiet=False):
        tiling = tessellate(design)
        _refuse_flat(tiling, accuracy=accuracy, slices=slices)
        report = tiling.check(samples=size, renderer=renderer, device=device, method=method, notice=say)
        if output is not None:
            tiling.difference(report).save(output)
            say_written(output)
        if tiling.design.standing is not None:
            from voronoi_tiles.solid.loft import ACCURACY_MM
            from voronoi_tiles.solid.slice_check import SLICES, check_slices
            from voronoi_tiles.solid.solid_job import SolidJob
            from voronoi_tiles.solid.solid_proof import proved_loft

            within = SolidJob(accuracy=accuracy).accuracy or ACCURACY_MM
            loft, _ = proved_loft(tiling.design, accuracy=within)
            figures = check_slices(loft, slices=slices or SLICES, renderer=renderer, device=device, method=method)
            report = replace(report, figures=(*report.figures, *figures))
    print_figures(tiling.evidence(report), check_text, as_json=as_json)
    with reporting(design):
        require_passed(report)


def _refuse_flat(tiling: Tiling, **options: object) -> None:
    """Refuse options of solids for a design that is flat. Raises JobError."""
    from voronoi_tiles.fabrication.job_options import JobError

    for name, value in options.items():
        if value is not None and tiling.design.standing is None:
            raise JobError(f"`{name}` is for designs with a [solid], and this one is flat", remedy="Leave it out.")

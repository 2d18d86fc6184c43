"""The command `info`: what a design gives, in numbers."""

from __future__ import annotations

import click

from voronoi_tiles.cli.common import PATH, print_figures, reporting, tessellate
from voronoi_tiles.cli.options import with_scale


@click.command()
@click.argument("design", type=PATH)
@with_scale
@click.option("--json", "as_json", is_flag=True, help="Print the figures as JSON.")
def info(design: str, as_json: bool) -> None:
    """Print what a design gives: its cell, its tiles with their edges and neighbours, and the proof's figures."""
    from voronoi_tiles.cli.tables import info_text

    with reporting(design):
        figures = tessellate(design).figures()
    print_figures(figures, info_text, as_json=as_json)

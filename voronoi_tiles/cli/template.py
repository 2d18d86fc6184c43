"""The command `template`: a page to draw a site's art on."""

from __future__ import annotations

import click

from voronoi_tiles.cli.common import PATH, refuse_output, reporting, say, say_written, tessellate
from voronoi_tiles.cli.options import with_scale


@click.command()
@click.argument("design", type=PATH)
@click.option("-o", "--output", required=True, metavar="FILE", type=PATH, help="The file to write (.svg).")
@with_scale
@click.option("--site", metavar="NAME", help="The site to draw for [default: the first].")
def template(design: str, output: str, site: str | None) -> None:
    """Write a page to draw a site's art on, and say what to write into the design.

    The tile and the site's strokes are on a layer "guide"; draw in the layer "engrave", or in one called "score". An
    existing file is not overwritten.
    """
    from voronoi_tiles.base.files import refuse_existing
    from voronoi_tiles.designs.toml_text import toml_value

    refuse_output(design, output, (".svg",))
    refuse_existing(output)
    with reporting(design):
        tiling = tessellate(design)
        art = tiling.template(output, site)
        say_written(output)
        name = tiling[0 if site is None else site].name
        say(f'for [[site]] "{name}": art = {toml_value(art.table)}')

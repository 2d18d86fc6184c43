"""The command `new`: a design to start from."""

from __future__ import annotations

import errno
import os

import click

from voronoi_tiles.cli.common import PATH, say


def _complete_group(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete the name of a group."""
    from voronoi_tiles.designs.starters import GROUP_NAMES

    return [name for name in GROUP_NAMES if name.startswith(incomplete)]


@click.command()
@click.argument("group", shell_complete=_complete_group)
@click.option(
    "-o",
    "--output",
    default="-",
    metavar="FILE",
    type=PATH,
    help="The file to write; default: standard output. An existing file is not overwritten.",
)
@click.option(
    "--from",
    "drawing",
    metavar="DRAWING",
    type=PATH,
    help="An SVG or DXF file that becomes the site, in its real size, in a cell that is made for it.",
)
@click.option("--layer", metavar="NAME", help="With --from: only what is on this layer, or has this colour #rrggbb.")
@click.option("--id", "element", metavar="ID", help="With --from: only the object of this id, or DXF handle.")
@click.option(
    "--fill",
    "design",
    metavar="DESIGN",
    type=PATH,
    help="A design whose strokes are placed in a cell of GROUP so that their copies do not touch.",
)
def new(
    group: str, output: str, drawing: str | None, layer: str | None, element: str | None, design: str | None
) -> None:
    """Write a commented starter design for a wallpaper GROUP (p1 p2 pm pg cm pmm ...), or one of given strokes.

    What is written exports as it is.
    """
    from voronoi_tiles.base.files import STDOUT, is_special, output_error, refuse_existing, write_whole
    from voronoi_tiles.designs.starters import GROUP_NAMES, starter_text

    if group not in GROUP_NAMES:
        raise click.BadParameter(f"unknown group {group!r}. Use one of {' '.join(GROUP_NAMES)}.", param_hint="GROUP")
    if drawing is not None and design is not None:
        raise click.UsageError("--from takes a drawing, --fill a design: give one of them.")
    if drawing is None and (layer is not None or element is not None):
        raise click.UsageError("--layer and --id choose a part of a drawing: add --from DRAWING.")
    if drawing is not None and (drawing == "-" or is_special(drawing)):
        raise click.UsageError("The design names the drawing: --from needs a file.")
    stream = output == STDOUT or is_special(output)
    refuse_existing(output)
    folder = os.path.dirname(output) or os.curdir  # noqa: PTH120 - any name
    if not stream and not os.path.isdir(folder):  # noqa: PTH112 - same
        raise output_error(output, FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT)))
    name = None if stream else output
    if drawing is not None:
        from voronoi_tiles.designs.proposals import drawing_text

        text, notes = drawing_text(group, drawing, name, layer=layer, id=element)
    elif design is not None:
        from voronoi_tiles.designs.proposals import placed_text

        text, notes = placed_text(group, design, name)
    else:
        text, notes = starter_text(group, name), ()
    write_whole(output, text.encode())
    for note in notes:
        say(note)

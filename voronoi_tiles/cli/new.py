"""The command `new`: a design to start from."""

from __future__ import annotations

import click

from voronoi_tiles.cli.common import PATH


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
def new(group: str, output: str) -> None:
    """Write a commented starter design for a wallpaper GROUP (p1 p2 pm pg cm pmm ...)."""
    from voronoi_tiles.base.files import STDOUT, is_special, refuse_existing, write_whole
    from voronoi_tiles.designs.starters import GROUP_NAMES, starter_text

    if group not in GROUP_NAMES:
        raise click.BadParameter(f"unknown group {group!r}. Use one of {' '.join(GROUP_NAMES)}.", param_hint="GROUP")
    stream = output == STDOUT or is_special(output)
    refuse_existing(output)
    write_whole(output, starter_text(group, None if stream else output).encode())

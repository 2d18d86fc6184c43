"""The command `completion`: what a shell needs to complete commands."""

from __future__ import annotations

import click

from voronoi_tiles.cli.common import PROGRAM


@click.command()
@click.argument("shell", type=click.Choice(("bash", "zsh", "fish")))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    """Print the completion script for a SHELL: put `eval "$(voronoi-tiles completion bash)"` into ~/.bashrc."""
    from click.shell_completion import get_completion_class

    from voronoi_tiles.base.files import STDOUT, write_whole

    script = get_completion_class(shell)
    assert script is not None
    source = script(context.find_root().command, {}, PROGRAM, "_VORONOI_TILES_COMPLETE").source()
    write_whole(STDOUT, source.encode())

"""The command `inkscape`: our entries in Inkscape's menus, installed, looked after and removed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from voronoi_tiles.cli.common import EXIT_FAILED, say, say_written

if TYPE_CHECKING:
    from voronoi_tiles.inkscape.found_inkscape import FoundInkscape


@click.group()
def inkscape() -> None:
    """Tiles and sheets from within Inkscape, 1.2 or later: Extensions > Voronoi tiles."""


def _with_folder(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option that names the folder of extensions."""
    return click.option(
        "--into",
        metavar="DIR",
        type=click.Path(path_type=Path),
        help="Inkscape's folder of extensions [default: what Inkscape says].",
    )(command)


def _found(into: Path | None) -> FoundInkscape:
    """The folder of extensions, as it is given or found; notes what is there and cannot be used."""
    from voronoi_tiles.inkscape.found_inkscape import FoundInkscape, found_inkscape, sandbox_of, sandboxed

    if into is not None:
        name = sandbox_of(into)
        if name is not None:
            say(f"{into} is that of {name}, which cannot use this: it runs in a sandbox")
        return FoundInkscape(None, into)
    found = found_inkscape()
    for name in sandboxed():
        say(f"{name} is here as well, and cannot use this: it runs in a sandbox")
    return found


@inkscape.command()
@_with_folder
def install(into: Path | None) -> None:
    """Write the entries into Inkscape's folder, for this very Python; once more after either has moved."""
    from voronoi_tiles.inkscape.installation import install as write

    found = _found(into)
    for path in write(found.extensions):
        say_written(str(path))
    say("Start Inkscape anew: the entries are in Extensions > Voronoi tiles, and among the types of File > Open.")


@inkscape.command()
@_with_folder
def status(into: Path | None) -> None:
    """Say whether the entries are there, and as this version writes them; the exit code is 1 where they are not."""
    from voronoi_tiles.inkscape.installation import state

    found = _found(into)
    files, wrong = state(found.extensions)
    if found.version:
        click.echo(found.version)
    if not files:
        click.echo(f'Not installed in {found.extensions}. Run "voronoi-tiles inkscape install".')
    elif wrong:
        click.echo("\n".join(f"{fault}." for fault in wrong) + '\nRun "voronoi-tiles inkscape install" once more.')
    else:
        click.echo(f"Installed in {files[0].parent}, for this Python.")
    if wrong or not files:
        raise click.exceptions.Exit(EXIT_FAILED)


@inkscape.command()
@_with_folder
def remove(into: Path | None) -> None:
    """Remove the entries again."""
    from voronoi_tiles.inkscape.installation import remove as take_away

    found = _found(into)
    gone = take_away(found.extensions)
    for path in gone:
        say(f"removed {path}")
    if not gone:
        say(f"nothing of voronoi-tiles is in {found.extensions}")

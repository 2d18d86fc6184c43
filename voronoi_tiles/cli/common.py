"""What commands have in common: what they say on standard error, their exit codes, and what they refuse."""

from __future__ import annotations

import os
from contextlib import suppress
from typing import TYPE_CHECKING

import click

from voronoi_tiles.base.errors import OutputError, VoronoiTilesError

if TYPE_CHECKING:
    from voronoi_tiles.tiling import Tiling

PROGRAM = "voronoi-tiles"

EXIT_USAGE = 2
EXIT_BUG = 70  # EX_SOFTWARE of sysexits.h
EXIT_INTERRUPTED = 130  # as shells report SIGINT
EXIT_SIGNAL = 128  # shells add the number of the signal: 143 for SIGTERM

DEBUG_VARIABLE = "VORONOI_TILES_DEBUG"

# Whether a file can be read shows when it is read: click's own check would lose a whole batch for one of them.
PATH = click.Path(allow_dash=True, readable=False)


def tessellate(design: str) -> Tiling:
    """Load a design and compute its tiles."""
    from voronoi_tiles.designs.design import Design

    return Design.load(design).tessellate()


def explain(error: BaseException, design: str | None = None) -> tuple[int, str]:
    """Give the exit code and the message for an error, which begins with the name of the design if there is one."""
    start = f"Error: {design}: " if design is not None else "Error: "
    match error:
        case VoronoiTilesError():
            code, message = error.exit_code, f"{'Error: ' if error.file is not None else start}{error}"
        case click.UsageError():
            text = error.format_message().rstrip()
            if isinstance(error, click.MissingParameter):
                text = " ".join(text.split())  # click lists choices one to a line
            stop = "" if text.endswith((".", "?", "!")) else "."
            hint = f" See '{error.ctx.command_path} --help'." if error.ctx else ""
            code, message = EXIT_USAGE, f"Error: {text}{stop}{hint}"
        case click.Abort() | KeyboardInterrupt():
            code, message = EXIT_INTERRUPTED, "Interrupted."
        case MemoryError():
            remedy = "Allow larger tolerances, or draw less."
            code, message = EXIT_USAGE, f"{start}there is not enough memory for this design. {remedy}"
        case OSError():
            from voronoi_tiles.base.files import output_error

            code, message = EXIT_USAGE, f"{start}{output_error(error.filename or 'standard output', error)}"
        case _:
            remedy = f"please report it, with the design. {DEBUG_VARIABLE}=1 shows where it is."
            code, message = EXIT_BUG, f"{start}{type(error).__name__}: {error}. This is a bug in {PROGRAM}: {remedy}"
    return code, message


def report_error(design: str, error: Exception) -> int:
    """Say what is wrong with one of the designs, by its name; give the exit code."""
    code, message = explain(error, shown(design))
    if code == EXIT_BUG and os.environ.get(DEBUG_VARIABLE):
        raise error
    say(message)
    return code


def refuse_output(source: str, output: str | None, suffixes: tuple[str, ...]) -> None:
    """Refuse a file whose name has none of the suffixes, or that would overwrite the source."""
    from voronoi_tiles.base.files import is_special

    if output is None or output == "-":
        return
    if not output:
        raise click.UsageError("The name of the file to write is empty: -o FILE.")
    if not output.lower().endswith(suffixes) and not is_special(output):
        raise click.UsageError(f"{output} is no name of such a file: give it the suffix {' or '.join(suffixes)}.")
    if source != "-" and os.path.realpath(output) == os.path.realpath(source):
        raise click.UsageError(f"{output} is what is read, and would be overwritten.")


def refuse_existing(output: str) -> None:
    """Refuse to overwrite a file that people work on."""
    from voronoi_tiles.base.files import STDOUT, is_special

    if output != STDOUT and not is_special(output) and os.path.lexists(output):
        raise OutputError(f"{output} exists already", path=output, remedy="Choose another name, or remove it first.")


def shown(design: str) -> str:
    """Give what messages call a design."""
    return "standard input" if design == "-" else design


def say(message: str, *, lines: bool = False) -> None:
    """Print a message (one line, unless `lines`) to standard error; that nobody can read it is no reason to fail."""
    from voronoi_tiles.base.text import printable

    with suppress(OSError):
        click.echo(message if lines else printable(message), err=True)

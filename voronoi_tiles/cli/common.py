"""What commands have in common: what they say on standard error, their exit codes, and what they refuse."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

import click

from voronoi_tiles.base.errors import TouchingCopiesError, VoronoiTilesError

if TYPE_CHECKING:
    from voronoi_tiles.designs.design import Design
    from voronoi_tiles.tiling import Tiling

PROGRAM = "voronoi-tiles"

EXIT_FAILED = 1  # the result failed a check
EXIT_USAGE = 2
EXIT_BUG = 70  # EX_SOFTWARE of sysexits.h
EXIT_INTERRUPTED = 130  # as shells report SIGINT
EXIT_SIGNAL = 128  # shells add the number of the signal: 143 for SIGTERM

DEBUG_VARIABLE = "VORONOI_TILES_DEBUG"

# Whether a file can be read shows when it is read: click's own check would lose a whole batch for one of them.
PATH = click.Path(allow_dash=True, readable=False)

SCALE = "voronoi_tiles.scale"
"""Where the options of `with_scale` are in the meta of click's context; lengths in millimetres."""

_ARGUMENT = re.compile(r"`(\w+)(?:=([^`]*))?`")

# Arguments that are options of another name.
_OPTIONS = {"layers": "layer"}


def load(design: str, *, quiet: bool = False) -> Design:
    """Load a design, say what of its drawings is left out, and scale it by the options of `with_scale`."""
    from voronoi_tiles.designs.design import Design

    loaded = Design.load(design)
    for note in () if quiet else loaded.notes:
        say(note)
    scale: dict[str, float] = click.get_current_context().meta.get(SCALE, {})
    if not scale:
        return loaded
    lengths = {name: value / loaded.unit_mm for name, value in scale.items() if name != "factor"}
    return loaded.scaled(**lengths) if lengths else loaded.scaled(scale["factor"])


def tessellate(design: str, *, quiet: bool = False) -> Tiling:
    """Load a design, as `load`, and compute its tiles."""
    return load(design, quiet=quiet).tessellate()


def as_options(text: str) -> str:
    """A message with options in the place of the arguments of Python that it names in backquotes."""

    def option(found: re.Match[str]) -> str:
        name, value = found.groups()
        flag = f"--{_OPTIONS.get(name, name).replace('_', '-')}"
        return flag if value in {None, "True"} else f"{flag} {value.strip(chr(39) + '[]')}"

    return _ARGUMENT.sub(option, text)


def explain(error: BaseException, design: str | None = None) -> tuple[int, str]:
    """The exit code and the message for an error, which begins with the name of the design if there is one."""
    start = f"Error: {design}: " if design is not None else "Error: "
    match error:
        case VoronoiTilesError():
            name = error.file or ""  # which may hold anything
            text = name + as_options(str(error).removeprefix(name))
            if isinstance(error, TouchingCopiesError):
                text += ' "voronoi-tiles new GROUP --fill DESIGN" finds a place.'
            code, message = error.exit_code, f"{'Error: ' if error.file is not None else start}{text}"
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


@contextmanager
def reporting(design: str) -> Iterator[None]:
    """Exit with one message that names the design where the block raises an error."""
    try:
        yield
    except (click.exceptions.Exit, click.ClickException):
        raise
    except Exception as error:
        raise click.exceptions.Exit(report_error(design, error)) from error


def print_figures(figures: Mapping[str, Any], as_text: Callable[[Any], str], *, as_json: bool) -> None:
    """Print figures on standard output, as JSON or as a text for people."""
    from voronoi_tiles.base.files import STDOUT, write_whole

    write_whole(STDOUT, (json.dumps(figures, indent=2) + "\n" if as_json else as_text(figures)).encode())


def refuse_output(source: str, output: str | None, suffixes: tuple[str, ...], *, stream: bool = True) -> None:
    """Refuse a file whose name has none of the suffixes, or that would overwrite the source.

    Without `stream` standard output is refused too, to which the report goes.
    """
    from voronoi_tiles.base.files import STDOUT, is_special

    if output is None:
        return
    if output == STDOUT:
        if not stream:
            raise click.UsageError(
                f"The report goes to standard output: give the picture a file, -o FILE{suffixes[0]}."
            )
        return
    if not output:
        raise click.UsageError("The name of the file to write is empty: -o FILE.")
    if not output.lower().endswith(suffixes) and not is_special(output):
        raise click.UsageError(f"{output} is no name of such a file: give it the suffix {' or '.join(suffixes)}.")
    if source != "-" and os.path.realpath(output) == os.path.realpath(source):
        raise click.UsageError(f"{output} is what is read, and would be overwritten.")


def shown(design: str) -> str:
    """What messages call a design."""
    return "standard input" if design == "-" else design


def say(message: str, *, lines: bool = False) -> None:
    """Print a message (one line, unless `lines`) to standard error; that nobody can read it is no reason to fail."""
    from voronoi_tiles.base.text import printable

    with suppress(OSError):
        click.echo(message if lines else printable(message), err=True)


def say_written(path: str, what: object = None) -> None:
    """Say that a file was written, and what is in it, unless it is standard output."""
    if path != "-":
        say(f"wrote {path}" if what is None else f"wrote {path}: {what}")

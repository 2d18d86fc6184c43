"""The command line: parse, call the library, print.

Results go to standard output or to files, messages to standard error. Exit codes: 0 done; 1 the result failed a
check; 2 bad input or usage; 130 interrupted; 70 a bug of ours. Whatever happens, it is one message and no traceback
(but with VORONOI_TILES_DEBUG=1). What a command needs is imported by the command, when it runs.
"""

from __future__ import annotations

import errno
import io
import os
import signal
import sys
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Never

import click

from voronoi_tiles import __version__
from voronoi_tiles.errors import OutputError, VoronoiTilesError

if TYPE_CHECKING:
    from voronoi_tiles.tiling import Tiling

PROGRAM = "voronoi-tiles"

EXIT_USAGE = 2
EXIT_BUG = 70  # EX_SOFTWARE of sysexits.h
EXIT_INTERRUPTED = 130  # as shells report SIGINT

DEBUG_VARIABLE = "VORONOI_TILES_DEBUG"

# Whether a file can be read shows when it is read: click's own check would lose a whole batch for one of them.
_PATH = click.Path(allow_dash=True, readable=False)


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name=PROGRAM)
def cli() -> None:
    """Exact tiles that fill the plane: Voronoi cells of strokes, repeated by a wallpaper group."""


@cli.command()
@click.argument("designs", metavar="DESIGN...", nargs=-1, required=True, type=_PATH)
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="OUT",
    type=_PATH,
    help="The file to write, its format by its suffix (.svg, .json); a folder for several designs; "
    "- for standard output.",
)
@click.option(
    "--format",
    "file_format",
    type=click.Choice(("svg", "json")),
    help="The format where OUT names none: a folder or standard output.",
)
@click.option("-q", "--quiet", is_flag=True, help="Report only what fails.")
def export(designs: tuple[str, ...], output: str, file_format: str | None, quiet: bool) -> None:
    """Write the tiles of designs as SVG (millimetres, ready to cut) or as a JSON outline document.

    DESIGN is a TOML or JSON file, or - for standard input. With several designs the good ones are written, the bad
    ones named, and the exit code is the worst.
    """
    from voronoi_tiles.files import STDOUT, write_whole

    targets = _targets(designs, output, file_format)
    worst = 0
    for design, (target, target_format) in zip(designs, targets, strict=True):
        try:
            text = _tessellate(design).text(target_format)
            _make_folder(target, output)
            write_whole(target, text.encode())
        except Exception as error:  # noqa: BLE001 - whatever one design does, the others are still to be written
            worst = max(worst, _report(design, error))
        else:
            if not quiet and target != STDOUT:
                _say(f"wrote {target}")
    if worst:
        raise click.exceptions.Exit(worst)


@cli.command()
@click.argument("design", type=_PATH)
@click.option("--json", "as_json", is_flag=True, help="Print the figures as JSON.")
def info(design: str, as_json: bool) -> None:
    """Print what a design gives: its cell, its tiles with their edges and neighbours, and the proof's figures."""
    import json

    from voronoi_tiles.files import STDOUT, write_whole
    from voronoi_tiles.tables import info_text

    try:
        figures = _tessellate(design).figures()
    except Exception as error:
        raise click.exceptions.Exit(_report(design, error)) from error
    text = json.dumps(figures, indent=2) + "\n" if as_json else info_text(figures)
    write_whole(STDOUT, text.encode())


def _complete_group(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete the name of a group."""
    from voronoi_tiles.starters import GROUP_NAMES

    return [name for name in GROUP_NAMES if name.startswith(incomplete)]


@cli.command()
@click.argument("group", shell_complete=_complete_group)
@click.option(
    "-o",
    "--output",
    default="-",
    metavar="FILE",
    type=_PATH,
    help="The file to write; default: standard output. An existing file is not overwritten.",
)
def new(group: str, output: str) -> None:
    """Write a commented starter design for a wallpaper GROUP (p1 p2 pm pg cm pmm ...)."""
    from voronoi_tiles.files import STDOUT, is_special, write_whole
    from voronoi_tiles.starters import GROUP_NAMES, starter_text

    if group not in GROUP_NAMES:
        raise click.BadParameter(f"unknown group {group!r}. Use one of {' '.join(GROUP_NAMES)}.", param_hint="GROUP")
    stream = output == STDOUT or is_special(output)
    if not stream and os.path.lexists(output):
        raise OutputError(f"{output} exists already", path=output, remedy="Choose another name, or remove it first.")
    write_whole(output, starter_text(group, None if stream else output).encode())


@cli.command()
@click.argument("shell", type=click.Choice(("bash", "zsh", "fish")))
def completion(shell: str) -> None:
    """Print the completion script for a SHELL: put `eval "$(voronoi-tiles completion bash)"` into ~/.bashrc."""
    from click.shell_completion import get_completion_class

    from voronoi_tiles.files import STDOUT, write_whole

    script = get_completion_class(shell)
    assert script is not None
    source = script(cli, {}, PROGRAM, "_VORONOI_TILES_COMPLETE").source()
    write_whole(STDOUT, source.encode())


def run() -> Never:
    """Run the command line and exit: the console script."""
    if hasattr(signal, "SIGPIPE"):
        # A reader that has seen enough ends us silently, as it ends other commands in a pipe.
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    if sys.stdout is None:
        sys.stdout = _ClosedStdout()
    code = _run()
    if code:
        _drop_stdout()
    sys.exit(code)


class _ClosedStdout(io.StringIO):
    """What stands for a standard output that was closed before we began: it refuses what is written."""

    def write(self, _text: str, /) -> int:
        raise OSError(errno.EBADF, "it is closed")


def _run() -> int:
    """Run a command; give its exit code, and say what went wrong."""
    try:
        result = cli.main(prog_name=PROGRAM, standalone_mode=False)
        sys.stdout.flush()
    except (Exception, KeyboardInterrupt) as error:
        if os.environ.get(DEBUG_VARIABLE):
            raise
        if isinstance(error, click.exceptions.NoArgsIsHelpError):
            _say(error.format_message(), lines=True)
            return EXIT_USAGE
        code, message = _explain(error)
        _say(message)
        return code
    return result if isinstance(result, int) else 0


def _explain(error: BaseException, design: str | None = None) -> tuple[int, str]:
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
            remedy = "Allow larger tolerances, or use fewer strokes."
            code, message = EXIT_USAGE, f"{start}there is not enough memory for this design. {remedy}"
        case OSError():
            from voronoi_tiles.files import output_error

            code, message = EXIT_USAGE, f"{start}{output_error(error.filename or 'standard output', error)}"
        case _:
            remedy = f"please report it, with the design. {DEBUG_VARIABLE}=1 shows where it is."
            code, message = EXIT_BUG, f"{start}{type(error).__name__}: {error}. This is a bug in {PROGRAM}: {remedy}"
    return code, message


def _tessellate(design: str) -> Tiling:
    """Load a design and compute its tiles."""
    from voronoi_tiles.design import Design

    return Design.load(design).tessellate()


def _report(design: str, error: Exception) -> int:
    """Say what is wrong with one of the designs, by its name; give the exit code."""
    code, message = _explain(error, "standard input" if design == "-" else design)
    if code == EXIT_BUG and os.environ.get(DEBUG_VARIABLE):
        raise error
    _say(message)
    return code


def _targets(designs: Sequence[str], output: str, file_format: str | None) -> list[tuple[str, str]]:
    """Give for each design the file to write and its format; refuse what cannot be meant.

    That is: one place for several results, or a result that would overwrite a design.
    """
    from voronoi_tiles.tiling import FORMATS

    if not output:
        raise click.UsageError("The name of the file to write is empty: -o FILE.")
    if designs.count("-") > 1:
        raise click.UsageError("Standard input can be read once only.")
    path = Path(output)
    several = len(designs) > 1
    if output == "-":
        if several:
            raise click.UsageError("Several designs need a folder: -o DIR.")
        return [("-", file_format or FORMATS[0])]
    folder = os.path.isdir(output)  # noqa: PTH112 - a name that the system refuses is no folder, and no error here
    suffix = path.suffix.lower().removeprefix(".")
    if not several and not output.endswith("/") and not folder:
        if suffix not in FORMATS and not file_format:
            suffixes = " or ".join(f".{name}" for name in FORMATS)
            raise click.UsageError(f"The format of {output} is not clear: give it the suffix {suffixes}, or --format.")
        if suffix in FORMATS and file_format not in {None, suffix}:
            raise click.UsageError(f"{output} and --format {file_format} contradict each other: leave out --format.")
        targets = [(output, file_format or suffix)]
    elif not folder and (os.path.exists(output) or suffix in FORMATS):  # noqa: PTH110 - same
        raise click.UsageError(f"Several designs need a folder: -o DIR, and {output} is a file.")
    else:
        suffix = file_format or FORMATS[0]
        stems = ["design" if design == "-" else Path(design).stem for design in designs]
        twice = [stem for stem, count in Counter(stems).items() if count > 1]
        if twice:
            raise click.UsageError(f"Two designs would be written to {twice[0]}.{suffix}: rename one.")
        targets = [(str(path / f"{stem}.{suffix}"), suffix) for stem in stems]
    sources = {os.path.realpath(design) for design in designs if design != "-"}
    for target, _ in targets:
        if os.path.realpath(target) in sources:
            raise click.UsageError(f"{target} is a design, and would be overwritten.")
    return targets


def _make_folder(target: str, output: str) -> None:
    """Make the folder OUT when results go into one."""
    from voronoi_tiles.files import output_error

    if target in {output, "-"}:
        return
    try:
        Path(output).mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise output_error(output, error) from error


def _say(message: str, *, lines: bool = False) -> None:
    """Print a message (one line, unless `lines`) to standard error; that nobody can read it is no reason to fail."""
    from voronoi_tiles.tables import printable

    with suppress(OSError):
        click.echo(message if lines else printable(message), err=True)


def _drop_stdout() -> None:
    """Keep the interpreter from failing once more, at exit, on what standard output has refused."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

"""The command line: parse, call the library, print.

Results go to standard output or to files, messages to standard error. Exit codes: 0 done; 1 the result failed a
check; 2 bad input or usage; 130 interrupted, 143 terminated; 70 a bug of ours. Whatever happens, it is one message and
no traceback (but with VORONOI_TILES_DEBUG=1). What a command needs is imported by the command, when it runs.
"""

from __future__ import annotations

import errno
import io
import os
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Never, TypeVar

import click

from voronoi_tiles import __version__
from voronoi_tiles.errors import OutputError, VoronoiTilesError

if TYPE_CHECKING:
    from voronoi_tiles.raster.render import Choice, Method
    from voronoi_tiles.tiling import Tiling

PROGRAM = "voronoi-tiles"

_PATIENCE = 1.0
"""After how long a progress bar appears; seconds."""

EXIT_USAGE = 2
EXIT_BUG = 70  # EX_SOFTWARE of sysexits.h
EXIT_INTERRUPTED = 130  # as shells report SIGINT
EXIT_SIGNAL = 128  # shells add the number of the signal: 143 for SIGTERM

DEBUG_VARIABLE = "VORONOI_TILES_DEBUG"

# Whether a file can be read shows when it is read: click's own check would lose a whole batch for one of them.
_PATH = click.Path(allow_dash=True, readable=False)


_Command = TypeVar("_Command", bound=Callable[..., Any])


def _with_renderer(command: _Command) -> _Command:
    """Add the options that choose the renderer."""
    command = click.option(
        "--device", type=click.IntRange(min=0), metavar="N", help="The number of OpenGL's device [default: the first]."
    )(command)
    return click.option(
        "--renderer",
        type=click.Choice(("auto", "gl", "cpu")),
        default="auto",
        help="OpenGL or the processor; auto takes OpenGL where there is any [default: auto].",
    )(command)


def _with_method(command: _Command) -> _Command:
    """Add the option that chooses the method."""
    return click.option(
        "--method",
        type=click.Choice(("exact", "hoff")),
        default="exact",
        help="Exact distances, or the cones and tents of Hoff et al. with a depth test [default: exact].",
    )(command)


def _read_size(_context: click.Context, _parameter: click.Parameter, text: str | None) -> int | tuple[int, int] | None:
    """Read the size of a picture: "1600" or "1920x1080"."""
    if text is None:
        return None
    sides = text.lower().split("x")
    if len(sides) > 2 or not all(side.isascii() and side.isdigit() and len(side) < 10 for side in sides):
        raise click.BadParameter(f"{text!r} is no size. Write 1600, or 1920x1080.")
    numbers = [int(side) for side in sides]
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])


def _read_region(
    _context: click.Context, _parameter: click.Parameter, text: str | None
) -> tuple[float, float, float, float] | None:
    """Read a rectangle: "0,0,120,60"."""
    if text is None:
        return None
    try:
        x0, y0, x1, y1 = (float(part) for part in text.split(","))
    except ValueError:
        raise click.BadParameter(f"{text!r} is no rectangle. Write X0,Y0,X1,Y1, such as 0,0,120,60.") from None
    return x0, y0, x1, y1


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
@click.option("--check", is_flag=True, help="Cross-check the outlines first, and record it in the file's metadata.")
@_with_renderer
def export(
    designs: tuple[str, ...],
    output: str,
    file_format: str | None,
    quiet: bool,
    check: bool,
    renderer: Choice,
    device: int | None,
) -> None:
    """Write the tiles of designs as SVG (millimetres, ready to cut) or as a JSON outline document.

    DESIGN is a TOML or JSON file, or - for standard input. With several designs the good ones are written, the bad
    ones named, and the exit code is the worst.
    """
    from voronoi_tiles.files import STDOUT, write_whole
    from voronoi_tiles.tiling import require

    if not check and (renderer != "auto" or device is not None):
        raise click.UsageError("--renderer and --device say how to check: add --check.")

    targets = _targets(designs, output, file_format)
    worst = 0
    for design, (target, target_format) in zip(designs, targets, strict=True):
        try:
            tiling = _tessellate(design)
            report = tiling.check(renderer=renderer, device=device, notice=_say) if check else None
            if report is not None:
                require(report)
            text = tiling.text(target_format, report)
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


@cli.command()
@click.argument("design", type=_PATH)
@click.option(
    "--size",
    type=click.IntRange(16, 8192),
    metavar="N",
    help="Samples along the side of the cell [16 to 8192, which takes 4 GB; default: 1024].",
)
@_with_method
@_with_renderer
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@click.option(
    "-o", "--output", metavar="DIFF", type=_PATH, help="Write a picture (.png) of where, and by how much, they differ."
)
def check(
    design: str,
    size: int | None,
    method: Method,
    renderer: Choice,
    device: int | None,
    as_json: bool,
    output: str | None,
) -> None:
    """Check the exact outlines of a design against an image that is rendered by another method.

    Every figure is printed with its limit and what that follows from. The exit code is 1 where they differ.
    """
    import json

    from voronoi_tiles.files import STDOUT, write_whole, writing
    from voronoi_tiles.tables import check_text

    _refuse_other_output(design, output)
    if output == STDOUT:
        raise click.UsageError("The report goes to standard output: give the picture a file, -o diff.png.")
    try:
        tiling = _tessellate(design)
        report = tiling.check(samples=size, renderer=renderer, device=device, method=method, notice=_say)
        if output is not None:
            from voronoi_tiles.picture import write_diff

            with writing(output) as file:
                write_diff(tiling, report, file)
            _say(f"wrote {output}")
    except Exception as error:
        raise click.exceptions.Exit(_report(design, error)) from error
    document = tiling.evidence(report)
    text = json.dumps(document, indent=2) + "\n" if as_json else check_text(document)
    write_whole(STDOUT, text.encode())
    if not report.passed:
        _say(f"Error: {_shown(design)}: the outlines failed the cross-check: {', '.join(report.failures)}.")
        raise click.exceptions.Exit(1)


@cli.command()
@click.argument("design", type=_PATH)
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="PICTURE",
    type=_PATH,
    help="The file to write (.png); - for standard output.",
)
@click.option(
    "--size",
    metavar="N|WxH",
    callback=_read_size,
    help="The longer side in pixels, or both: then the region grows to the picture's shape [default: 1600].",
)
@click.option(
    "--region",
    metavar="X0,Y0,X1,Y1",
    callback=_read_region,
    help="The rectangle to show, in the design's units [default: two cells each way, which repeat seamlessly].",
)
@click.option(
    "--overlay",
    multiple=True,
    type=click.Choice(("symmetry", "cell", "outline")),
    help="Draw on top: mirrors, glides and rotation centres; the cell; the exact outlines. May be repeated.",
)
@_with_method
@_with_renderer
@click.option("-q", "--quiet", is_flag=True, help="Report only what fails.")
def render(
    design: str,
    output: str,
    size: int | tuple[int, int] | None,
    region: tuple[float, float, float, float] | None,
    overlay: tuple[str, ...],
    method: Method,
    renderer: Choice,
    device: int | None,
    quiet: bool,
) -> None:
    """Write a picture (PNG) of the tessellation: coloured tiles, their borders, and the strokes that made them."""
    from voronoi_tiles.design import Design
    from voronoi_tiles.files import STDOUT
    from voronoi_tiles.picture import DEFAULT_SIZE
    from voronoi_tiles.picture import render as render_picture

    _refuse_other_output(design, output)
    try:
        with _progress(quiet) as progress:
            provenance = render_picture(
                Design.load(design),
                output,
                size=DEFAULT_SIZE if size is None else size,
                region=region,
                overlay=overlay,
                method=method,
                renderer=renderer,
                device=device,
                notice=_say,
                progress=progress,
            )
    except Exception as error:
        raise click.exceptions.Exit(_report(design, error)) from error
    if not quiet and output != STDOUT:
        _say(f"wrote {output}: {provenance}")


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
    # To be ended is no reason to leave half a file behind: what is begun is removed, as it is after Ctrl-C.
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), lambda number, _: sys.exit(EXIT_SIGNAL + number))
    if sys.stdout is None:
        sys.stdout = _ClosedStdout()
    code = _run()
    if code:
        _drop_stdout()
    sys.exit(code)


class _ClosedStdout(io.StringIO):
    """What stands for a standard output that was closed before we began: it refuses what is written."""

    @property
    def buffer(self) -> Never:
        """Refuse bytes as well."""
        raise OSError(errno.EBADF, "it is closed")

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
    code, message = _explain(error, _shown(design))
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


def _refuse_other_output(design: str, output: str | None) -> None:
    """Refuse a picture that is none by its name, or that would overwrite the design."""
    from voronoi_tiles.files import is_special

    if output is None or output == "-":
        return
    if not output:
        raise click.UsageError("The name of the file to write is empty: -o FILE.")
    if not output.lower().endswith(".png") and not is_special(output):
        raise click.UsageError(f"{output} is no name of a picture: give it the suffix .png.")
    if design != "-" and os.path.realpath(output) == os.path.realpath(design):
        raise click.UsageError(f"{output} is a design, and would be overwritten.")


def _shown(design: str) -> str:
    """Give what messages call a design."""
    return "standard input" if design == "-" else design


@contextmanager
def _progress(quiet: bool) -> Iterator[Callable[[int, int], None]]:
    """Show a bar on a terminal for what takes longer than a second."""
    begun = time.monotonic()
    bar: Any = None

    def step(done: int, total: int) -> None:
        nonlocal bar
        if bar is None and not quiet and done < total and time.monotonic() - begun > _PATIENCE and sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import Progress

            bar = Progress(console=Console(stderr=True), transient=True)
            bar.add_task("rendering", total=total)
            bar.start()
        if bar is not None:
            bar.update(bar.task_ids[0], completed=done)

    try:
        yield step
    finally:
        if bar is not None:
            bar.stop()


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

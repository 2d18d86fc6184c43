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
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Never

import click

from voronoi_tiles.base.version import __version__
from voronoi_tiles.cli.common import (
    DEBUG_VARIABLE,
    EXIT_SIGNAL,
    EXIT_USAGE,
    PATH,
    PROGRAM,
    explain,
    refuse_existing,
    refuse_output,
    report_error,
    say,
    shown,
    tessellate,
)
from voronoi_tiles.cli.export import export
from voronoi_tiles.cli.fabrication import coupon, report, template
from voronoi_tiles.cli.options import Command, with_renderer
from voronoi_tiles.cli.preflight import preflight

if TYPE_CHECKING:
    from voronoi_tiles.raster.renderer import Choice, Method

_PATIENCE = 1.0
"""After how long a progress bar appears; seconds."""


def _with_method(command: Command) -> Command:
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
@click.argument("design", type=PATH)
@click.option("--json", "as_json", is_flag=True, help="Print the figures as JSON.")
def info(design: str, as_json: bool) -> None:
    """Print what a design gives: its cell, its tiles with their edges and neighbours, and the proof's figures."""
    import json

    from voronoi_tiles.base.files import STDOUT, write_whole
    from voronoi_tiles.cli.tables import info_text

    try:
        figures = tessellate(design).figures()
    except Exception as error:
        raise click.exceptions.Exit(report_error(design, error)) from error
    text = json.dumps(figures, indent=2) + "\n" if as_json else info_text(figures)
    write_whole(STDOUT, text.encode())


@cli.command()
@click.argument("design", type=PATH)
@click.option(
    "--size",
    type=click.IntRange(16, 8192),
    metavar="N",
    help="Samples along the side of the cell [16 to 8192, which takes 4 GB; default: 1024].",
)
@_with_method
@with_renderer
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@click.option(
    "-o", "--output", metavar="DIFF", type=PATH, help="Write a picture (.png) of where, and by how much, they differ."
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

    from voronoi_tiles.base.files import STDOUT, write_whole, writing
    from voronoi_tiles.cli.tables import check_text

    refuse_output(design, output, (".png",))
    if output == STDOUT:
        raise click.UsageError("The report goes to standard output: give the picture a file, -o diff.png.")
    try:
        tiling = tessellate(design)
        report = tiling.check(samples=size, renderer=renderer, device=device, method=method, notice=say)
        if output is not None:
            from voronoi_tiles.pictures.rendering import write_diff

            with writing(output) as file:
                write_diff(tiling.design, [tile.outline for tile in tiling.tiles], report, file)
            say(f"wrote {output}")
    except Exception as error:
        raise click.exceptions.Exit(report_error(design, error)) from error
    document = tiling.evidence(report)
    text = json.dumps(document, indent=2) + "\n" if as_json else check_text(document)
    write_whole(STDOUT, text.encode())
    if not report.passed:
        say(f"Error: {shown(design)}: the outlines failed the cross-check: {', '.join(report.failures)}.")
        raise click.exceptions.Exit(1)


@cli.command()
@click.argument("design", type=PATH)
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="PICTURE",
    type=PATH,
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
    type=click.Choice(("symmetry", "cell", "outline", "art")),
    help="Draw on top: mirrors, glides and rotation centres; the cell; the exact outlines; the sites' art in the place "
    "of their strokes. May be repeated.",
)
@_with_method
@with_renderer
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
    from voronoi_tiles.base.files import STDOUT
    from voronoi_tiles.designs.design import Design
    from voronoi_tiles.pictures.rendering import DEFAULT_SIZE
    from voronoi_tiles.pictures.rendering import render as render_picture

    refuse_output(design, output, (".png",))
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
                notice=say,
                progress=progress,
            )
    except Exception as error:
        raise click.exceptions.Exit(report_error(design, error)) from error
    if not quiet and output != STDOUT:
        say(f"wrote {output}: {provenance}")


def _complete_group(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete the name of a group."""
    from voronoi_tiles.designs.starters import GROUP_NAMES

    return [name for name in GROUP_NAMES if name.startswith(incomplete)]


@cli.command()
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
    from voronoi_tiles.base.files import STDOUT, is_special, write_whole
    from voronoi_tiles.designs.starters import GROUP_NAMES, starter_text

    if group not in GROUP_NAMES:
        raise click.BadParameter(f"unknown group {group!r}. Use one of {' '.join(GROUP_NAMES)}.", param_hint="GROUP")
    stream = output == STDOUT or is_special(output)
    refuse_existing(output)
    write_whole(output, starter_text(group, None if stream else output).encode())


@cli.command()
@click.argument("shell", type=click.Choice(("bash", "zsh", "fish")))
def completion(shell: str) -> None:
    """Print the completion script for a SHELL: put `eval "$(voronoi-tiles completion bash)"` into ~/.bashrc."""
    from click.shell_completion import get_completion_class

    from voronoi_tiles.base.files import STDOUT, write_whole

    script = get_completion_class(shell)
    assert script is not None
    source = script(cli, {}, PROGRAM, "_VORONOI_TILES_COMPLETE").source()
    write_whole(STDOUT, source.encode())


for _command in (export, report, preflight, coupon, template):
    cli.add_command(_command)


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
            say(error.format_message(), lines=True)
            return EXIT_USAGE
        code, message = explain(error)
        say(message)
        return code
    return result if isinstance(result, int) else 0


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


def _drop_stdout() -> None:
    """Keep the interpreter from failing once more, at exit, on what standard output has refused."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

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
from importlib import import_module
from typing import Final, Never

import click

from voronoi_tiles.base.version import __version__
from voronoi_tiles.cli.common import DEBUG_VARIABLE, EXIT_SIGNAL, EXIT_USAGE, PROGRAM, explain, say

COMMANDS: Final = (
    "check",
    "completion",
    "coupon",
    "export",
    "fit",
    "info",
    "inkscape",
    "new",
    "preflight",
    "render",
    "report",
    "solid",
    "studio",
    "sweep",
    "template",
    "watch",
)
"""The commands, each of the module of its name, which is imported when the command is asked for."""


class _Commands(click.Group):
    """The commands of COMMANDS."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - what click calls
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002 - same
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = getattr(import_module(f"voronoi_tiles.cli.{cmd_name}"), cmd_name)
        return command


_VERBOSE = "voronoi_tiles.verbose"
"""Whether --verbose was given, in the meta of click's context."""


def _note_verbose(context: click.Context, _: click.Parameter, verbose: bool) -> None:
    context.meta[_VERBOSE] = verbose


def _say_version(context: click.Context, _: click.Parameter, asked: bool) -> None:
    """Print the version and exit, where it was asked for."""
    verbose = context.meta[_VERBOSE]
    if context.resilient_parsing or not (asked or verbose):
        return
    if not asked:
        raise click.UsageError("--verbose goes with --version.")
    click.echo(f"{PROGRAM}, version {__version__}")
    if verbose:
        from voronoi_tiles.cli.environment import environment

        click.echo(environment())
    context.exit()


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.option(
    "--version",
    is_flag=True,
    expose_value=False,
    callback=_say_version,
    help="Show the version and exit; with --verbose also what it runs on.",
)
@click.option("--verbose", is_flag=True, is_eager=True, expose_value=False, callback=_note_verbose, hidden=True)
def cli() -> None:
    """Exact tiles that fill the plane: Voronoi cells of strokes, repeated by a wallpaper group."""


def run() -> Never:
    """Run the command line and exit: the console script."""
    # Nothing of ours is work for the threads that OpenBLAS starts when numpy is imported: half of that import's time.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if hasattr(signal, "SIGPIPE"):
        # A reader that has seen enough ends us silently, as it ends other commands in a pipe.
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    # To be ended is no reason to leave half a file behind: what is begun is removed, as it is after Ctrl-C. Signals
    # that we were started to ignore, as nohup does, stay ignored.
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name) and signal.getsignal(getattr(signal, name)) is not signal.SIG_IGN:
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
    """Run a command, and say what went wrong; the exit code."""
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


def _drop_stdout() -> None:
    """Keep the interpreter from failing once more, at exit, on what standard output has refused."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

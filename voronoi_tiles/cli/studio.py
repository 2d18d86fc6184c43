"""The command `studio`: draw in the browser, and see the exact tile follow."""

from __future__ import annotations

import signal
import sys

import click

from voronoi_tiles.cli.common import EXIT_SIGNAL, PATH, reporting, say


@click.command()
@click.argument("design", type=PATH, required=False)
@click.option(
    "--port", type=click.IntRange(0, 65535), metavar="N", help="The port to serve at [default: 8317, or a free one]."
)
@click.option("--no-browser", is_flag=True, help="Print the address to open, and open no browser.")
def studio(design: str | None, port: int | None, no_browser: bool) -> None:
    """Draw strokes in the browser, see the exact tile follow, and download the files to cut.

    DESIGN is a TOML or JSON file, which is made when it is saved if there is none. Only this machine can reach the
    page. Ctrl-C ends it.
    """
    from voronoi_tiles.base.errors import ArgumentError
    from voronoi_tiles.cli.common import as_options
    from voronoi_tiles.studio.browser import Browser
    from voronoi_tiles.studio.design_document import Document
    from voronoi_tiles.studio.server import bind, serve

    if design == "-":
        raise click.UsageError("The studio saves what is drawn: give it a file, or nothing for a new design.")
    try:
        listener = bind(port)
    except ArgumentError as error:
        raise click.UsageError(as_options(str(error))) from None
    with listener, reporting(design or "design.toml"):
        document = Document.open(design)
        with Browser(say) as browser:
            number = serve(document, listener, ready=click.echo if no_browser else browser.open, say=say)
    if number == signal.SIGINT:
        say("studio ended")
    else:
        sys.exit(EXIT_SIGNAL + number)

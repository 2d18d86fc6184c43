"""The command `fit`: designs whose tiles come near to an outline."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import click

from voronoi_tiles.cli.common import PATH, as_options, reporting, say
from voronoi_tiles.cli.options import LENGTH
from voronoi_tiles.cli.progress_bar import progress_bar

if TYPE_CHECKING:
    from voronoi_tiles.escherization.fits import Fit, Strokes


@click.command()
@click.argument("outline", type=PATH)
@click.option(
    "-o", "--output", "folder", required=True, metavar="DIR", type=click.Path(readable=False),
    help="The folder for the designs, new or empty.",
)  # fmt: skip
@click.option(
    "--groups", metavar="GROUPS", help="The wallpaper groups to look in: p3,p4; or all [default: all but those whose "
    "tile is the same polygon whatever is drawn: pmm, p4m, p3m1, p6m].",
)  # fmt: skip
@click.option(
    "--keep", type=click.IntRange(1, 200), metavar="N", default=8, show_default=True, help="How many designs to keep."
)
@click.option(
    "--mirrored", type=click.Choice(("yes", "no")), default="yes",
    help="no: only groups whose copies are never mirror images, for material with a good side.",
)  # fmt: skip
@click.option("--symmetric", is_flag=True, help="Only tiles that are their own mirror images, as the outline is.")
@click.option(
    "--strokes", type=click.Choice(("few", "outline")), default="few", show_default=True,
    help="Few corners, easy to change; or the whole outline, drawn a little smaller.",
)  # fmt: skip
@click.option(
    "--within", type=LENGTH, metavar="LENGTH",
    help="How far the tile of few strokes may be from that of the whole outline [default: 1/200 of the size].",
)  # fmt: skip
@click.option("--size", type=LENGTH, metavar="LENGTH", help="Scale the outline until its longer side is so long: 80mm.")
@click.option("--element", metavar="ID", help="The element of the drawing that is the outline [default: the largest].")
@click.option("--seed", type=click.IntRange(0, 2**31), default=0, show_default=True, help="Where the search begins.")
@click.option(
    "--workers", type=int, metavar="N", help="Processes on this machine [default: as many as processors; 1: this one]."
)
@click.option("--scheduler", metavar="ADDRESS", help="A scheduler of Dask's whose workers do it, tcp://host:8786.")
@click.option("-q", "--quiet", is_flag=True, help="Report only what fails.")
def fit(
    outline: str,
    folder: str,
    groups: str | None,
    keep: int,
    mirrored: Literal["yes", "no"],
    symmetric: bool,
    strokes: Strokes,
    within: float | None,
    size: float | None,
    element: str | None,
    seed: int,
    workers: int | None,
    scheduler: str | None,
    quiet: bool,
) -> None:
    """Find designs whose exact tiles come nearest to an outline, a closed line in an SVG or DXF file.

    What else is drawn, eyes and feathers, becomes their art, moved so that it fits the tile's edge. DIR gets a design
    file and a picture of each, the nearest first, a table (fits.csv, index.json) and a contact sheet (sheet.html).
    """
    from voronoi_tiles.base.errors import ArgumentError
    from voronoi_tiles.base.folders import refuse_filled
    from voronoi_tiles.base.text import counted
    from voronoi_tiles.escherization.drawn_outline import read_outline
    from voronoi_tiles.escherization.fit_folder import write_fits
    from voronoi_tiles.escherization.fits import fit as fit_outline

    if size == 0.0:
        raise click.UsageError("--size is 0: give the length of the longer side, 80mm.")
    with reporting(outline):
        refuse_filled(folder)
        drawn = read_outline(outline, element=element)
        for note in () if quiet else drawn.notes:
            say(as_options(note))
        scale = 1.0 if size is None else size / drawn.silhouette.longer_side
        names = None if groups is None else [name.strip() for name in groups.split(",")]
        with progress_bar("looking for tiles", quiet=quiet) as progress:
            found = fit_outline(
                drawn.silhouette.scaled(scale).polygon,
                groups="all" if names == ["all"] else names,
                keep=keep,
                mirrored=mirrored == "yes",
                symmetric=symmetric,
                strokes=strokes,
                within=within,
                name=drawn.name,
                seed=seed,
                workers=workers,
                scheduler=scheduler,
                progress=progress,
            )
        if not found:
            raise ArgumentError("no group of `groups` has a tile near to this outline", remedy="Look in more groups.")
        with progress_bar("drawing designs", quiet=quiet) as progress:
            notes = write_fits(folder, found, outline, drawn, scale, progress)
    if quiet:
        return
    for note in (note for note in notes if note not in drawn.notes):
        say(as_options(note))
    for number, each in enumerate(found, 1):
        say(_line(number, each))
    say(f"wrote {folder}: {counted(len(found), 'design')} with pictures, fits.csv, sheet.html")


def _line(number: int, fit: Fit) -> str:
    """What there is to say of a fit."""
    return (
        f"{number:3}. {fit.group:5} overlap {fit.overlap:.4f}, within {fit.distance:.3g} mm, {fit.corners} corners, "
        f"{fit.neighbours} neighbours{', symmetric' if fit.symmetric else ''}"
    )

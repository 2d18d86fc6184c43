"""The command `sweep`: thousands of variants of a design, measured, and the best of them."""

from __future__ import annotations

import click

from voronoi_tiles.cli.common import PATH, reporting, say
from voronoi_tiles.cli.progress_bar import progress_bar


@click.command()
@click.argument("sweep_file", metavar="SWEEP", type=PATH)
@click.option(
    "-o",
    "--output",
    "folder",
    required=True,
    metavar="DIR",
    type=click.Path(readable=False),
    help="The folder of the sweep. What it holds of the same one is not made again.",
)
@click.option("--count", type=int, metavar="N", help="How many designs at random [default: the file's].")
@click.option(
    "--filter",
    "condition",
    metavar="CONDITION",
    help="Which designs are kept, such as 'neck > 3 and neighbours == 6' [default: the file's].",
)
@click.option(
    "--sort",
    multiple=True,
    metavar="EXPRESSION",
    help="What comes first: the least, or with a minus, -curved_share, the greatest. May be repeated.",
)
@click.option("--keep", type=int, metavar="N", help="How many are kept, as designs and on the contact sheet.")
@click.option(
    "--workers", type=int, metavar="N", help="Processes on this machine [default: as many as processors; 1: this one]."
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="A scheduler of Dask's whose workers do it, tcp://host:8786; local: a cluster of Dask's on this machine.",
)
@click.option("--parquet", is_flag=True, help="Write the table as table.parquet, too (needs pyarrow).")
@click.option("-q", "--quiet", is_flag=True, help="Report only what fails.")
def sweep(
    sweep_file: str,
    folder: str,
    count: int | None,
    condition: str | None,
    sort: tuple[str, ...],
    keep: int | None,
    workers: int | None,
    scheduler: str | None,
    parquet: bool,
    quiet: bool,
) -> None:
    """Make, prove and measure the designs of a sweep: a design whose numbers vary. DIR gets a table and the best.

    table.csv has a row for each design, in which what went wrong stands under "error"; kept/ the designs that were
    kept, sheet.html their pictures. Ended, the same command goes on where it was.
    """
    from voronoi_tiles.sweeps.sweep import Sweep
    from voronoi_tiles.sweeps.sweep_run import sweep as run_sweep

    with reporting(sweep_file), progress_bar("making designs", quiet=quiet) as progress:
        read = Sweep.load(sweep_file)
        chosen = read.replaced(count=count, filter=condition, sort=sort or None, keep=keep)
        result = run_sweep(chosen, folder, workers=workers, scheduler=scheduler, parquet=parquet, progress=progress)
    if quiet:
        return
    failed = result.failed
    rest = f", {failed:,} of them failed" if failed else ""
    say(f"wrote {folder}: {len(result.table):,} designs{rest}, {len(result.kept):,} kept")

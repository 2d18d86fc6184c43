"""Sweeps that are run: on all processors or on others' machines, begun where an earlier run was ended."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final

from voronoi_tiles.base.arguments import function, path_name
from voronoi_tiles.designs.design import Design
from voronoi_tiles.parallel.block_runner import LostBlock
from voronoi_tiles.parallel.blocks import processors, run_blocks
from voronoi_tiles.pictures.contact_sheet import ContactSheet, SheetPicture, square_about
from voronoi_tiles.sweeps.design_figures import design_figures
from voronoi_tiles.sweeps.design_rows import DesignBlock, Row, block_rows, failed_row
from voronoi_tiles.sweeps.expression import without_sign
from voronoi_tiles.sweeps.sweep import Sweep
from voronoi_tiles.sweeps.sweep_folder import KEPT, KEPT_TABLE, PARQUET, SHEETS, TABLE, SweepFolder
from voronoi_tiles.sweeps.sweep_table import SweepTable, pyarrow

BLOCK_S: Final = 0.5
"""How long a block of designs should take; seconds. Handing out a task takes milliseconds, on Dask too."""

BLOCK_MAX: Final = 500
"""Most designs of a block; a count."""

BLOCKS_EACH: Final = 8
"""How many blocks each worker should have at least, so that none waits long for the last; a count."""


@dataclass(frozen=True, eq=False, repr=False)
class SweepResult:
    """What came of a sweep: its table, and the rows that were kept, the best first."""

    sweep: Sweep
    table: SweepTable
    kept: tuple[int, ...]

    def __repr__(self) -> str:
        return f"<SweepResult: {len(self.table):,} designs, {self.failed:,} of them failed, {len(self.kept):,} kept>"

    @property
    def failed(self) -> int:
        """How many designs came to nothing."""
        return len(self.table) - self.table["error"].count("")

    def designs(self) -> Iterator[Design]:
        """The designs that were kept, the best first."""
        return (self.sweep.variant(number) for number in self.kept)

    def save_sheet(self, path: str | os.PathLike[str]) -> None:
        """Write pictures of the designs that were kept, with what they were sorted by: .svg, .png or .html.

        Raises OutputError.
        """
        contact_sheet(self).save(path)

    def _repr_svg_(self) -> str:
        """Draw the designs that were kept: notebooks show this."""
        return contact_sheet(self).svg


def contact_sheet(result: SweepResult, links: Mapping[int, str] | None = None) -> ContactSheet:
    """Pictures of the designs that were kept, with what they were sorted by; `links` leads to files of theirs."""
    sweep, table = result.sweep, result.table
    shown = dict.fromkeys(map(without_sign, ("group", *sweep.sort)))
    facts = {each: table.values(each) for each in shown}
    pictures = []
    for number in result.kept:
        tiling = sweep.variant(number).tessellate()
        copies = tiling.copies(square_about(tile.outline for tile in tiling))
        pictures.append(
            SheetPicture.of_tiles(
                [(tile.outline, tile.site.ends) for tile in tiling],
                [copy.outline for copy in copies],
                caption=(f"no. {number}", *(f"{name} {_short(found[number])}" for name, found in facts.items())),
                link="" if links is None else links[number],
            )
        )
    title = f"{sweep.design.name}: {len(result.kept):,} of {len(table):,} designs"
    return ContactSheet(tuple(pictures), f"{title}, {result.failed:,} of which failed" if result.failed else title)


def sweep(
    sweep: Sweep | str | os.PathLike[str] | Mapping[str, Any],
    folder: str | os.PathLike[str] | None = None,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    parquet: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> SweepResult:
    """Make, prove and measure all designs of a sweep, and keep the best.

    `sweep` is one, or its file, or the same as a mapping. What goes wrong with a design is in its row of the table, in
    the column "error". With a `folder` rows are kept there as they are made: a run that was ended goes on where it was,
    also with another `filter`, `sort`, `keep` or `count`. The folder gets table.csv, kept.csv and kept/, the designs
    that were kept, and sheet.html, sheet.svg and sheet.png; with `parquet` table.parquet too.

    Results do not depend on how many `workers` there are, processes of our own (None: one for each processor; 1: this
    one), or on the `scheduler` of Dask's: "tcp://host:8786", or "local" for its own cluster of `workers`. `progress` is
    told how many designs of how many there are.

    Raises DesignError for a sweep that cannot be, OutputError for a folder that is another sweep's or cannot be
    written, MissingLibraryError, and SchedulerError.
    """
    if isinstance(sweep, Mapping):
        sweep = Sweep.from_dict(sweep)
    elif not isinstance(sweep, Sweep):
        sweep = Sweep.load(sweep)
    function("progress", progress)
    if parquet:
        pyarrow()
    place = None if folder is None else SweepFolder(path_name("folder", folder), sweep)
    rows = {} if place is None else place.rows(len(sweep.columns))
    rows = {number: row for number, row in rows.items() if number < len(sweep)}
    for block in _made(sweep, rows, workers, scheduler):
        if place is not None:
            place.keep_rows(block)
        rows |= {row[0]: row for row in block}
        if progress is not None:
            progress(len(rows), len(sweep))
    table = SweepTable(sweep.columns, [rows[number] for number in range(len(sweep))])
    kept = tuple(table.chosen(sweep.filter, sweep.sort, sweep.keep))
    result = SweepResult(sweep, table, kept)
    if place is not None:
        _write(result, place, parquet=parquet)
    return result


def _made(sweep: Sweep, known: Mapping[int, Row], workers: int | None, scheduler: str | None) -> Iterator[list[Row]]:
    """The rows that are not known yet, block by block as they finish."""
    missing = [number for number in range(len(sweep)) if number not in known]
    size = 1
    if missing:
        most = max(1, len(missing) // (BLOCKS_EACH * (workers or processors())))
        size = min(int(BLOCK_S / _seconds(sweep)) + 1, most, BLOCK_MAX)
    blocks = _blocks(sweep, missing, size)
    lost: list[int] = []
    for number, result in run_blocks(block_rows, blocks, workers=workers, scheduler=scheduler):
        if isinstance(result, LostBlock):
            lost.append(number)
        else:
            yield result
    # One of its designs has ended the process: which one shows when each has its own.
    single = [number for each in lost for number in range(blocks[each].first, blocks[each].stop)]
    alone = _blocks(sweep, single, 1)
    for number, result in run_blocks(block_rows, alone, workers=workers, scheduler=scheduler):
        if isinstance(result, LostBlock):
            yield [failed_row(sweep, alone[number].first, f"{result.reason[:1].upper()}{result.reason[1:]}.")]
        else:
            yield result


def _seconds(sweep: Sweep) -> float:
    """About how long a design takes: that which varies, once all is imported."""
    seconds = BLOCK_S
    for _ in range(2):
        begun = time.perf_counter()
        with suppress(Exception):  # the rows say what is wrong
            design_figures(sweep.design.tessellate(), sweep.made_job)
        seconds = max(time.perf_counter() - begun, 1e-4)
        if seconds > BLOCK_S:
            break
    return seconds


def _blocks(sweep: Sweep, numbers: Sequence[int], size: int) -> list[DesignBlock]:
    """Blocks of numbers that follow each other, `size` of them at most."""
    identity, count = json.dumps(sweep.identity), len(sweep)
    blocks: list[DesignBlock] = []
    for number in numbers:
        if blocks and blocks[-1].stop == number and number - blocks[-1].first < size:
            blocks[-1] = blocks[-1]._replace(stop=number + 1)
        else:
            blocks.append(DesignBlock(identity, count, number, number + 1))
    return blocks


def _write(result: SweepResult, place: SweepFolder, *, parquet: bool) -> None:
    """Write the tables, the designs that were kept, and pictures of them."""
    sweep, table = result.sweep, result.table
    place.write(TABLE, table.csv.encode())
    if parquet:
        place.write(PARQUET, table.parquet)
    place.write(KEPT_TABLE, SweepTable(table.names, [table.rows[number] for number in result.kept]).csv.encode())
    names = {f"{number:06d}.toml": number for number in result.kept}
    there = {name: int(name[:-5]) for name in place.kept if name[:-5].isdecimal() and name not in names}
    before = ((name, _text(sweep, number, place)) for name, number in there.items() if number < len(sweep))
    place.keep_designs({name: _text(sweep, number, place) for name, number in names.items()}, before)
    sheet = contact_sheet(result, {number: f"{KEPT}/{name}" for name, number in names.items()})
    for name in SHEETS:
        sheet.save(place.path / name)


def _text(sweep: Sweep, number: int, place: SweepFolder) -> str:
    """The file of a design."""
    return sweep.variant(number).text_for(place.path / KEPT / f"{number:06d}.toml")


def _short(value: Any) -> str:
    """A value as a caption has it."""
    if not isinstance(value, float):
        return str(value)
    return f"{value:,.0f}" if 1e4 <= abs(value) < 1e9 else f"{value:.4g}"

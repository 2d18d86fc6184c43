"""The rows of a sweep's table: what is made of blocks of its designs, wherever that is."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from voronoi_tiles.base.errors import VoronoiTilesError
from voronoi_tiles.sweeps.design_figures import design_figures
from voronoi_tiles.sweeps.sweep import Sweep

Row = list[Any]
"""The cells of a design, in the order of the sweep's columns: numbers and texts, None where there is nothing."""


class DesignBlock(NamedTuple):
    """The designs from `first` up to, not including, `stop` of the sweep of an identity, as JSON, and a size."""

    identity: str
    size: int
    first: int
    stop: int


def block_rows(block: DesignBlock) -> list[Row]:
    """Make, prove and measure the designs of a block; what goes wrong with one is in its row."""
    sweep = _sweep(block.identity, block.size)
    return [design_row(sweep, number) for number in range(block.first, block.stop)]


def design_row(sweep: Sweep, number: int) -> Row:
    """The row of a design."""
    error = ""
    try:
        figures: Sequence[float | None] = design_figures(sweep.variant(number).tessellate(), sweep.made_job)
    except VoronoiTilesError as failure:
        error = str(failure)
    except MemoryError:
        error = "There is not enough memory for this design."
    except Exception as failure:  # noqa: BLE001 - whatever one design does, the others have their rows
        error = f"{type(failure).__name__}: {failure}. This is a bug in voronoi-tiles: please report it."
    return failed_row(sweep, number, error) if error else _row(sweep, number, figures, "")


def failed_row(sweep: Sweep, number: int, error: str) -> Row:
    """The row of a design that has come to nothing, with the reason."""
    figures = len(sweep.columns) - len(sweep.varied) - 3
    return _row(sweep, number, [None] * figures, error)


def _row(sweep: Sweep, number: int, figures: Sequence[float | None], error: str) -> Row:
    group, values = sweep.values(number)
    return [number, group.name, *values, *figures, error]


@lru_cache(maxsize=4)
def _sweep(identity: str, count: int) -> Sweep:
    """The sweep of a block, read once for all blocks that a process does."""
    return Sweep.of_identity(json.loads(identity), count)

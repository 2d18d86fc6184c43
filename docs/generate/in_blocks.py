"""Measurements on all processors, or on a scheduler of Dask's: a script's function, block by block."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import TypeVar

from voronoi_tiles.parallel.block_runner import LostBlock
from voronoi_tiles.parallel.blocks import run_blocks

Block = TypeVar("Block")
Result = TypeVar("Result")


def in_blocks(
    function: Callable[[Block], Result],
    blocks: Sequence[Block],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
) -> list[Result]:
    """What a function gives for each block, in their order; `workers` and `scheduler` are those of `run_blocks`.

    A function of the script that runs is that of the module of its name, which other processes find. Raises
    RuntimeError where a process dies of a block.
    """
    if function.__module__ == "__main__":
        function = getattr(import_module(Path(sys.argv[0]).stem), function.__name__)
    results = dict(run_blocks(function, blocks, workers=workers, scheduler=scheduler))
    found = [
        result for _, result in sorted(results.items(), key=lambda item: item[0]) if not isinstance(result, LostBlock)
    ]
    if len(found) < len(blocks):
        lost = [(blocks[number], result) for number, result in results.items() if isinstance(result, LostBlock)]
        raise RuntimeError(f"{function.__name__} comes to nothing: {lost}")
    return found


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that say where blocks are done."""
    parser.add_argument("--workers", type=int, help="processes (default: as many as processors)")
    parser.add_argument(
        "--scheduler", help="a scheduler of Dask's, tcp://host:8786, whose workers have this folder in PYTHONPATH"
    )

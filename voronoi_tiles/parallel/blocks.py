"""Blocks of work on several processors, in processes of our own or on Dask: results as they finish.

A block should take half a second or more, and all that it depends on, a seed for example, should be in it: then neither
the number of workers nor their order shows in its result.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from typing import Final, Generic

from voronoi_tiles.base.arguments import instance
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.values import shown
from voronoi_tiles.parallel.block_runner import Block, BlockRunner, LostBlock, Result

LOCAL: Final = "local"
"""The name of the scheduler that is Dask's own cluster of processes on this machine."""

WORKERS_MAX: Final = 1024
"""Most processes on a machine; a count. More is a slip of the finger."""


def processors() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def run_blocks(
    function: Callable[[Block], Result],
    blocks: Sequence[Block],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
) -> Generator[tuple[int, Result | LostBlock], None, None]:
    """Call a function with every block: the blocks' numbers with what it gives, as they finish.

    Without a `scheduler` there are so many processes of our own, `workers`, None as many as processors; one is this
    very process. "local" is Dask's own cluster of as many processes, "tcp://host:8786" a scheduler of Dask's that runs
    already, which has workers of its own. The function has to be one of a module, and what it takes and gives has to be
    pickled.

    A block whose process dies is tried once more when all others are done, with nothing beside it, and is a LostBlock
    if it dies again; in this very process there is nothing to catch it. What the function raises ends all. No process
    is left when the iterator is done, closed or interrupted.

    Raises ArgumentError for workers and schedulers that cannot be, or be started, MissingLibraryError where Dask is
    asked for and not installed, and SchedulerError for a scheduler that cannot be reached, has no worker of our
    version, or goes away.
    """
    return _results(_opened(function, blocks, workers, scheduler), len(blocks))


def _results(
    opened: AbstractContextManager[BlockRunner[Result]], count: int
) -> Generator[tuple[int, Result | LostBlock], None, None]:
    """The results of so many blocks; those that are lost are tried again at the end, each alone."""
    if not count:
        return
    with opened as runner:
        lost = []
        for number, result in runner.finished(range(count)):
            if isinstance(result, LostBlock):
                lost.append(number)
            else:
                yield number, result
        for number in lost:
            yield from runner.finished([number])


def _opened(
    function: Callable[[Block], Result], blocks: Sequence[Block], workers: int | None, scheduler: str | None
) -> AbstractContextManager[BlockRunner[Result]]:
    """What the arguments ask for."""
    if workers is not None and not (type(workers) is int and 1 <= workers <= WORKERS_MAX):
        raise ArgumentError(f"`workers` {shown(workers)} cannot be", remedy=f"Give a number from 1 to {WORKERS_MAX}.")
    if scheduler is not None and not instance("scheduler", scheduler, str):
        raise ArgumentError(f"`scheduler` {shown(scheduler)} cannot be", remedy='Give "local", or "tcp://host:8786".')
    if scheduler is not None:
        from voronoi_tiles.parallel.dask_blocks import dask_blocks

        if scheduler != LOCAL and workers is not None:
            raise ArgumentError("a `scheduler` has `workers` of its own", remedy="Leave one of the two out.")
        count = None if scheduler != LOCAL else workers or processors()
        return dask_blocks(function, blocks, workers=count, address=scheduler)
    count = processors() if workers is None else workers
    if count == 1:
        return nullcontext(_InThisProcess(function, blocks))
    from voronoi_tiles.parallel.child_processes import ChildProcesses

    return ChildProcesses(function, blocks, min(count, max(len(blocks), 1)))


@dataclass(frozen=True)
class _InThisProcess(BlockRunner[Result], Generic[Block, Result]):
    """One block after the other."""

    function: Callable[[Block], Result]
    blocks: Sequence[Block]

    def finished(self, numbers: Sequence[int]) -> Iterator[tuple[int, Result]]:
        for number in numbers:
            yield number, self.function(self.blocks[number])

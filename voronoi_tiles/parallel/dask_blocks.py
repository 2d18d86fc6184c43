"""Blocks of work on Dask: its own cluster on this machine, or a scheduler that runs already.

What was measured of dask.distributed 2026.8 and is heeded here: a task whose process dies condemns what is queued with
it, unless every worker has one thread and no queue; a task costs a millisecond or two, and the scheduler does not give
its memory back; the same argument is computed once unless tasks are called impure.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from itertools import islice
from typing import Any, Final, Generic

from voronoi_tiles.base.errors import MissingLibraryError, SchedulerError
from voronoi_tiles.base.version import __version__
from voronoi_tiles.parallel.block_runner import Block, BlockRunner, LostBlock, Result

PATIENCE_S: Final = 10.0
"""How long a scheduler may take to answer, and its first worker to come; seconds."""

_AHEAD: Final = 4
"""How many blocks a worker the scheduler knows at a time; a count."""

_SETTINGS: Final = {
    # Of a worker that dies the scheduler blames all that is on it: that is the culprit, and nothing beside it.
    "distributed.scheduler.worker-saturation": 1.0,
    "distributed.scheduler.allowed-failures": 0,
    "distributed.comm.retry.count": 0,
}


@contextmanager
def dask_blocks(
    function: Callable[[Block], Result], blocks: Sequence[Block], *, workers: int | None, address: str
) -> Iterator[DaskBlocks[Block, Result]]:
    """A runner of blocks on a scheduler, or on so many processes of a cluster of our own, which ends with the context.

    Raises MissingLibraryError and SchedulerError.
    """
    try:
        import dask
        from distributed import Client, LocalCluster
    except ImportError as error:
        raise MissingLibraryError(
            "blocks are shared out by Dask, which is not installed",
            remedy="Install it: pip install 'voronoi-tiles[sweep]'. Without a scheduler no Dask is needed.",
        ) from error
    with ExitStack() as stack:
        stack.enter_context(dask.config.set({**_SETTINGS, "distributed.comm.timeouts.connect": PATIENCE_S}))
        stack.enter_context(_silenced("distributed", "tornado"))
        target: Any = address
        if workers is not None:
            target = stack.enter_context(
                LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    processes=True,
                    dashboard_address=None,
                    scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},  # else it warns where 8787 is taken
                    silence_logs=logging.CRITICAL,
                )
            )

        else:
            _require_scheduler(address)
        client = stack.enter_context(Client(target, timeout=PATIENCE_S, set_as_default=False))
        _require_workers(client, address)
        yield DaskBlocks(function, blocks, client, address)


class DaskBlocks(BlockRunner[Result], Generic[Block, Result]):
    """Blocks as tasks of a client; see `dask_blocks`."""

    def __init__(self, function: Callable[[Block], Result], blocks: Sequence[Block], client: Any, address: str) -> None:
        self._function, self._blocks = function, blocks
        self._client, self._address = client, address

    def finished(self, numbers: Sequence[int]) -> Iterator[tuple[int, Result | LostBlock]]:
        """The numbers with their results, as they finish."""
        from distributed import CancelledError, KilledWorker, as_completed

        rest = iter(numbers)
        ahead = _AHEAD * max(1, len(self._client.scheduler_info(n_workers=-1)["workers"]))
        doing = {self._submitted(number): number for number in islice(rest, ahead)}
        completed: Any = as_completed(doing, loop=self._client.loop)
        try:
            for future in completed:
                number = doing.pop(future)
                for following in islice(rest, 1):
                    new = self._submitted(following)
                    doing[new] = following
                    completed.add(new)
                try:
                    yield number, future.result()
                except KilledWorker:
                    yield number, LostBlock("its worker died")
        except (CancelledError, asyncio.CancelledError, OSError) as error:
            raise SchedulerError(
                f"the scheduler at {self._address} went away",
                remedy="Start it again, and run the same once more.",
            ) from error
        finally:
            self._client.cancel(list(doing))

    def _submitted(self, number: int) -> Any:
        # A name of its own, as a lost block is asked for again.
        return self._client.submit(self._function, self._blocks[number], pure=False)


def _require_scheduler(address: str) -> None:
    """Raise SchedulerError where no scheduler answers: Dask's client waits for ever where somebody else listens."""
    from distributed.core import rpc

    async def ask() -> None:
        async with rpc(address) as scheduler:
            await asyncio.wait_for(scheduler.identity(), PATIENCE_S)

    try:
        with ThreadPoolExecutor(1) as thread:  # where this thread has a loop of its own, as in notebooks
            thread.submit(asyncio.run, ask()).result()
    except Exception as error:  # whatever somebody else's answer does to Dask's reader
        raise SchedulerError(
            f"cannot reach a scheduler at {address}: {str(error) or f'no answer in {PATIENCE_S:g} s'}",
            remedy="Start one there with `dask scheduler`, and workers with `dask worker`, or leave it out.",
        ) from error


def _require_workers(client: Any, address: str) -> None:
    """Raise SchedulerError where there is no worker, or one that would not give our results."""
    try:
        client.wait_for_workers(1, timeout=PATIENCE_S)
        versions = client.run(_version)
    except TimeoutError as error:
        raise SchedulerError(
            f"the scheduler at {address} has no workers", remedy=f"Start some: `dask worker {address}`."
        ) from error
    except ImportError as error:
        raise SchedulerError(f"workers of {address} lack voronoi_tiles", remedy="Install it where they run.") from error
    other = sorted(set(versions.values()) - {__version__})
    if other:
        raise SchedulerError(
            f"workers of {address} have voronoi_tiles {other[0]}, not {__version__}",
            remedy="Install the same version where they run.",
        )


def _version() -> str:
    """The version of voronoi_tiles that a worker has."""
    return __version__


@contextmanager
def _silenced(*names: str) -> Iterator[None]:
    """Keep Dask from telling of what we tell."""
    loggers = [logging.getLogger(name) for name in names]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)

"""Processes of our own that do blocks of work.

Why not those of concurrent.futures: one that dies takes all other blocks with it, and does not say which it died of;
and started in a script that is not guarded by `if __name__ == "__main__"` they run that script again.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import suppress
from queue import SimpleQueue
from subprocess import PIPE, Popen
from types import TracebackType
from typing import Any, Final, Generic, Self

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.parallel.block_runner import Block, BlockRunner, LostBlock, Result

_START: Final = "import sys; sys.path[:] = {path!r}; from voronoi_tiles.parallel.block_worker import main; main()"
"""What a process runs: it finds the modules that we find."""

_THREADS: Final = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""What keeps the libraries below numpy to one processor a process."""


class ChildProcesses(BlockRunner[Result], Generic[Block, Result]):
    """So many processes, each with one block at a time; they are ended with the context."""

    def __init__(self, function: Callable[[Block], Result], blocks: Sequence[Block], count: int) -> None:
        if b"__main__" in pickle.dumps(function):
            raise ValueError(f"{function} is one of a script: other processes find those of modules")
        self._function, self._blocks = function, blocks
        self._children = [_ChildProcess() for _ in range(count)]
        self._idle: SimpleQueue[_ChildProcess] = SimpleQueue()
        for child in self._children:
            self._idle.put(child)
        self._threads = ThreadPoolExecutor(count)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for child in self._children:
            child.kill()
        self._threads.shutdown(cancel_futures=True)
        for child in self._children:
            child.close()

    def finished(self, numbers: Sequence[int]) -> Iterator[tuple[int, Result | LostBlock]]:
        """The numbers with their results, as they finish."""
        futures = {self._threads.submit(self._ask, number): number for number in numbers}
        for future in as_completed(futures):
            yield futures.pop(future), future.result()

    def _ask(self, number: int) -> Any:
        """Have a block done by a process that is free."""
        child = self._idle.get()
        try:
            return child.ask(pickle.dumps((self._function, self._blocks[number])))
        finally:
            self._idle.put(child)


class _ChildProcess:
    """A process, which is started when it is needed; it ends when we do, however that is."""

    def __init__(self) -> None:
        self._process: Popen[bytes] | None = None
        self._ended = False
        self._lock = threading.Lock()

    def ask(self, request: bytes) -> Any:
        """What the process gives for a request, a LostBlock where it dies; raises what is raised there."""
        process = self._started()
        if process is None:
            return LostBlock("all was ended")
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            pickle.dump(request, process.stdin)
            process.stdin.flush()
            well, answer = pickle.load(process.stdout)  # noqa: S301 - of our own process
        except (EOFError, OSError, pickle.UnpicklingError):
            return LostBlock(_how_it_ended(process.wait()))
        if not well:
            raise answer
        return answer

    def kill(self) -> None:
        """End the process, whatever it does, for good."""
        with self._lock:
            self._ended = True
            if self._process is not None:
                self._process.kill()

    def close(self) -> None:
        """Wait for the end of a process that was killed, when nobody asks it any more."""
        if self._process is not None:
            for pipe in (self._process.stdin, self._process.stdout):
                with suppress(OSError):  # what nobody has read
                    assert pipe is not None
                    pipe.close()
            self._process.wait()

    def _started(self) -> Popen[bytes] | None:
        """The process, a new one where that has died; None where all is ended."""
        with self._lock:
            if self._ended:
                return None
            if self._process is not None and self._process.poll() is not None:
                self.close()
                self._process = None
            if self._process is None:
                self._process = _begun()
            return self._process


def _begun() -> Popen[bytes]:
    """A new process. Raises ArgumentError where the system gives none."""
    try:
        return Popen(  # noqa: S603 - our own interpreter
            [sys.executable, "-P", "-c", _START.format(path=sys.path)],
            stdin=PIPE,
            stdout=PIPE,
            env={**dict.fromkeys(_THREADS, "1"), **os.environ},
            start_new_session=True,  # Ctrl-C is for us, who end it
        )
    except OSError as error:
        raise ArgumentError(
            f"a process cannot be started: {error.strerror}", remedy="Give fewer `workers`; one is this very process."
        ) from error


def _how_it_ended(status: int) -> str:
    """A clause for the end of a process: of memory that ran out the system says no more than SIGKILL."""
    if status >= 0:
        return f"its process ended with status {status}"
    name = signal.Signals(-status).name if -status in set(signal.Signals) else f"signal {-status}"
    memory = ", as where there is no memory left" if name == "SIGKILL" else ""
    return f"its process was ended by {name}{memory}"

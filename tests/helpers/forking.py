"""The command line in a process of its own, without the imports: a server that has made them all forks for each call.

A test that calls the command line wants its exit code, its messages and its files; the half second in which a new
interpreter imports numpy and shapely tells it nothing. What depends on the start itself (imports, closed streams,
signals, hash seeds) runs the installed script instead: the fixture `command`.
"""

from __future__ import annotations

import gc
import importlib
import io
import json
import os
import pkgutil
import signal
import socket
import subprocess
import sys
import traceback
import warnings
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import NoReturn, Self

import voronoi_tiles

LARGEST_CALL = 1 << 20
"""Bytes that one call may take, its environment included."""


class ForkServer:
    """Runs `voronoi-tiles` in forks of one process; a context manager. One call at a time."""

    def __enter__(self) -> Self:
        """Start the server."""
        self._socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        call = [sys.executable, __file__, str(theirs.fileno())]
        strict = os.environ | {"PYTHONWARNINGS": "error"}
        self._process = subprocess.Popen(call, pass_fds=[theirs.fileno()], start_new_session=True, env=strict)
        theirs.close()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """End it: it reads the end of the calls."""
        self._socket.close()
        self._process.wait(timeout=30)

    def call(
        self,
        *arguments: object,
        stdin: str = "",
        cwd: Path | None = None,
        environment: Mapping[str, str] | None = None,
        merged: bool = False,
        timeout: float = 120.0,
    ) -> subprocess.CompletedProcess[str]:
        """Run `voronoi-tiles` with these arguments; `merged` puts what it says on standard error into its output.

        Raises TimeoutError after so many seconds, and ends all of it.
        """
        words = [str(word) for word in arguments]
        message = {"words": words, "cwd": str(cwd or Path.cwd()), "environment": dict(environment or os.environ)}
        pipes = [os.pipe() for _ in range(3)]
        theirs = [pipes[0][0], pipes[1][1], pipes[2][1]]
        handed = [*theirs[:2], theirs[1 if merged else 2]]
        socket.send_fds(self._socket, [json.dumps(message).encode()], handed)
        for end in theirs:
            os.close(end)
        with (
            os.fdopen(pipes[0][1], "w", encoding="utf-8") as into,
            os.fdopen(pipes[1][0], encoding="utf-8") as out,
            os.fdopen(pipes[2][0], encoding="utf-8") as err,
            ThreadPoolExecutor(2) as readers,
        ):
            printed, said = readers.submit(out.read), readers.submit(err.read)
            _feed(into, stdin)
            self._socket.settimeout(timeout)
            try:
                code = int(self._socket.recv(LARGEST_CALL))
            except TimeoutError:
                os.killpg(self._process.pid, signal.SIGKILL)
                raise
            return subprocess.CompletedProcess(["voronoi-tiles", *words], code, printed.result(), said.result())


def _feed(stream: io.TextIOBase, text: str) -> None:
    """Write what the command may read, and may not care to."""
    try:
        stream.write(text)
        stream.close()
    except BrokenPipeError:
        pass


def _serve(calls: socket.socket) -> None:
    """Fork for each call until there are no more; answer with the exit code, negative for a signal."""
    for module in pkgutil.walk_packages(voronoi_tiles.__path__, "voronoi_tiles."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    gc.freeze()
    while True:
        message, fds, _, _ = socket.recv_fds(calls, LARGEST_CALL, 3)
        if not message:
            return
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # numpy's idle threads are no reason not to fork
            process = os.fork()
        if process == 0:
            calls.close()
            _run(fds, **json.loads(message))
        for fd in fds:
            os.close(fd)
        calls.send(str(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])).encode())


def _run(fds: list[int], words: list[str], cwd: str, environment: dict[str, str]) -> NoReturn:
    """Be the command."""
    from voronoi_tiles.cli.main import run

    for number, fd in enumerate(fds):
        os.dup2(fd, number)
        os.close(fd)
    os.chdir(cwd)
    os.environ.clear()
    os.environ.update(environment)
    sys.stdin, sys.stdout, sys.stderr = (os.fdopen(k, "w" if k else "r", encoding="utf-8") for k in range(3))
    sys.argv[:] = ["voronoi-tiles", *words]
    code: object = 1
    try:
        run()
    except SystemExit as end:
        code = end.code
    except BaseException:  # noqa: BLE001 - what Python itself would do
        traceback.print_exc()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError):  # the command has said so
            stream.flush()
    # To take a copy of everything apart takes longer than most commands.
    os._exit(code if isinstance(code, int) else int(code is not None))


if __name__ == "__main__":
    with socket.socket(fileno=int(sys.argv[1])) as listening:
        _serve(listening)

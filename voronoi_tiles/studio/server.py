"""The studio's life: its port, its workers, and what ends it."""

from __future__ import annotations

import asyncio
import errno
import logging
import os
import signal
import socket
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from typing import Any, Final

import uvicorn

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.studio.design_document import Document
from voronoi_tiles.studio.fit_searches import FitSearches
from voronoi_tiles.studio.guard import NAMES, Guard
from voronoi_tiles.studio.lanes import Lane, Worker
from voronoi_tiles.studio.messages import FIT_SECONDS_MAX, MESSAGE_MAX
from voronoi_tiles.studio.routes import application
from voronoi_tiles.studio.sessions import Desk

_ENDING: Final = ("SIGINT", "SIGTERM", "SIGHUP")
"""The signals that end the studio in good order."""

_GRACE_S: Final = 1
"""How long open connections are waited for at the end; seconds."""

_REPLACED_S: Final = 1.0
"""How long a report may take that a newer one replaces; seconds. A worker takes half as long to start."""

_LOGGERS: Final = ("uvicorn.error", "websockets", "asyncio")
"""What would print lines that are for programmers."""


USUAL: Final = 8317
"""The port where nobody names one, if it is free: what browsers keep for a page, they keep by its port."""


def bind(port: int | None) -> socket.socket:
    """A socket of the loopback interface; port 0 takes a free one, None the usual one or, where it is in use, that.

    Raises ArgumentError.
    """
    if port is None:
        with suppress(ArgumentError):
            return bind(USUAL)
        port = 0
    # Of a protocol that is named: asyncio sends what is short at once on connections of such alone, and others wait for
    # 40 ms until what was sent before has been acknowledged.
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        if os.name == "posix":  # elsewhere it would let two programs have the port
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((NAMES[0], port))
        listener.listen()
    except OSError as error:
        listener.close()
        why = "is in use" if error.errno == errno.EADDRINUSE else f"cannot be had: {error.strerror}"
        remedy = "Leave it out, and a free one is taken, or give another."
        raise ArgumentError(f"the `port` {port} {why}", remedy=remedy) from None
    return listener


def serve(
    document: Document, listener: socket.socket, *, ready: Callable[[str], object], say: Callable[[str], object]
) -> int:
    """Serve the studio of a document until a signal ends it, and give the signal's number.

    `ready` is told the address to open, which holds the secret, as soon as something answers there; `say` takes what
    goes wrong, a line each.
    """
    return asyncio.run(_serve(document, listener, ready, say))


async def _serve(
    document: Document, listener: socket.socket, ready: Callable[[str], object], say: Callable[[str], object]
) -> int:
    loop = asyncio.get_running_loop()
    loop.set_exception_handler(lambda _, context: say(f"Error: {context.get('exception') or context['message']}"))
    for name in _LOGGERS:
        logging.getLogger(name).disabled = True
    outlines = Lane(Worker(document.folder), early=True)
    jobs = Lane(Worker(document.folder), replaced_s=_REPLACED_S)
    fits = Lane(Worker(document.folder), limit_s=FIT_SECONDS_MAX)
    desk = Desk(document, outlines, jobs, FitSearches(fits))
    guard = Guard(application(desk), listener.getsockname()[1])
    server = _Server(
        uvicorn.Config(
            guard,
            log_config=None,
            access_log=False,
            lifespan="off",
            http="h11",
            ws="websockets-sansio",
            ws_max_size=MESSAGE_MAX,
            ws_per_message_deflate=False,
            server_header=False,
            timeout_graceful_shutdown=_GRACE_S,
        )
    )
    caught: list[int] = []

    def end(number: int) -> None:
        caught.append(number)
        server.should_exit = True

    _catch(loop, end)
    tasks = [asyncio.create_task(work) for work in (outlines.run(), jobs.run(), fits.run(), desk.watch())]
    try:
        ready(guard.address)
        await server.serve(sockets=[listener])
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await desk.keeper(desk.document.close)
    return caught[0] if caught else 0


class _Server(uvicorn.Server):
    """A server that leaves signals to us: there are workers to be ended, too."""

    @contextmanager
    def capture_signals(self) -> Generator[None, None, None]:
        """Capture none."""
        yield


def _catch(loop: asyncio.AbstractEventLoop, end: Callable[[int], None]) -> None:
    """Have signals end the studio, but those that it was started to ignore, as nohup does.

    SIGPIPE, which ends a command whose reader has seen enough, would end the studio where a browser hangs up while
    something is written to it: that is an error of one connection alone.
    """
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)

    def caught(number: int, _frame: Any = None) -> None:
        with suppress(RuntimeError):  # it has ended already
            loop.call_soon_threadsafe(end, number)

    for name in _ENDING:
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, caught)

"""A bar on a terminal for what takes a while: how much of it is done or, where nobody knows, that it goes on."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Final

_PATIENCE: Final = 1.0
"""After how long a progress bar appears; seconds."""


@contextmanager
def progress_bar(what: str, *, quiet: bool) -> Iterator[Callable[[float, float], None]]:
    """Show a bar on a terminal for what takes longer than a second; it is told how much of how much is done."""
    begun = time.monotonic()
    bar: Any = None

    def step(done: float, total: float) -> None:
        nonlocal bar
        if bar is None and not quiet and done < total and time.monotonic() - begun > _PATIENCE and sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import Progress

            bar = Progress(console=Console(stderr=True), transient=True)
            bar.add_task(what, total=total)
            bar.start()
        if bar is not None:
            bar.update(bar.task_ids[0], completed=done)

    try:
        yield step
    finally:
        if bar is not None:
            bar.stop()


@contextmanager
def waiting(what: str, *, quiet: bool) -> Iterator[None]:
    """Show on a terminal that something goes on that takes longer than a second, and since when."""
    if quiet or not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    bar = Progress(*columns, console=Console(stderr=True), transient=True)
    bar.add_task(what, total=None)
    begin = threading.Timer(_PATIENCE, bar.start)
    begin.daemon = True
    begin.start()
    try:
        yield
    finally:
        begin.cancel()
        begin.join()
        bar.stop()

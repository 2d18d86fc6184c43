"""A bar on a terminal for what takes a while."""

from __future__ import annotations

import sys
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

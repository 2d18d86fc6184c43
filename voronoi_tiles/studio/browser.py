"""The browser, opened by a file that leads to the studio: an address with a secret is nothing for a command line."""

from __future__ import annotations

import os
import tempfile
import threading
import webbrowser
from collections.abc import Callable
from contextlib import suppress
from html import escape
from pathlib import Path
from types import TracebackType
from typing import Final, Self

_CONSOLE: Final = ("links", "elinks", "lynx", "w3m", "www-browser")
"""Browsers that would take over the terminal, and cannot draw."""


class Browser:
    """Opens the browser, in the thread `opening`.

    On a machine with others their list of processes shows command lines, and no files of ours.
    """

    def __init__(self, say: Callable[[str], object]) -> None:
        """Tell `say` what the user should know."""
        self._say = say
        self._file: Path | None = None
        self.opening: threading.Thread | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._file is not None:
            with suppress(OSError):
                self._file.unlink()

    def open(self, address: str) -> None:
        """Open an address, without waiting for it; say how to open it otherwise."""
        self._say(f"studio at {address} - Ctrl-C ends it")
        try:
            descriptor, name = tempfile.mkstemp(prefix="voronoi-tiles-", suffix=".html")  # only we may read it
            self._file = Path(name)
            with os.fdopen(descriptor, "w", encoding="utf-8") as file:
                target = escape(address, quote=True)
                file.write(
                    f'<!doctype html><meta http-equiv="refresh" content="0;url={target}"><title>Studio</title>\n'
                )
        except OSError:
            self._say("No file could be made that opens the browser: open the address yourself.")
            return
        self.opening = threading.Thread(target=self._open, args=(self._file.as_uri(),), daemon=True)
        self.opening.start()

    def _open(self, file: str) -> None:
        """Open a file in the browser that can draw, where there is one."""
        opened = False
        with suppress(webbrowser.Error, OSError):
            controller = webbrowser.get()
            opened = Path(getattr(controller, "name", "")).name not in _CONSOLE and controller.open(file)
        if not opened:
            self._say("No browser could be opened: open the address yourself.")

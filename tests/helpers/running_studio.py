"""The installed command `studio`, running, with its page's end of the connection."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection

from helpers.loopback import Site


@dataclass(frozen=True)
class RunningStudio(Site):
    """A studio that runs as a process in a session of its own, and its folder."""

    process: subprocess.Popen[str]
    folder: Path

    @property
    def said(self) -> Path:
        """The file of what it says on its standard error."""
        return self.folder / "said.txt"

    def workers(self) -> list[int]:
        """Its processes, by what the system says of parents; Linux alone tells."""
        found = []
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                parent = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
            except (OSError, ValueError):
                continue
            if parent == self.process.pid:
                found.append(int(folder.name))
        return sorted(found)

    def end(self, number: signal.Signals) -> tuple[int, str]:
        """Send a signal; the exit code, and all that was said."""
        self.process.send_signal(number)
        return self.process.wait(timeout=60), self.said.read_text()


@contextmanager
def running(folder: Path, *arguments: str, environment: Mapping[str, str] | None = None) -> Iterator[RunningStudio]:
    """A studio without a browser, in a folder, for the block; what it keeps of its own is in the folder's `state`."""
    said = folder / "said.txt"
    own = {**os.environ, "XDG_STATE_HOME": str(folder / "state"), **(environment or {})}
    call = [sys.executable, "-m", "voronoi_tiles", "studio", *arguments, "--no-browser"]
    with said.open("w") as errors:
        process = subprocess.Popen(
            call, stdout=subprocess.PIPE, stderr=errors, text=True, cwd=folder, env=own, start_new_session=True
        )
    with process:
        assert process.stdout is not None
        try:
            address = process.stdout.readline().strip()
            assert address.startswith("http://127.0.0.1:"), (address, said.read_text())
            yield RunningStudio(address, process, folder)
        finally:
            process.kill()


def told(page: ClientConnection, kind: str | None = None) -> dict[str, Any]:
    """The next message that the page is told, or the next of a kind."""
    while True:
        message: dict[str, Any] = json.loads(page.recv(timeout=60))
        if kind in (None, message["type"]):
            return message


def tell(page: ClientConnection, kind: str, **message: Any) -> None:
    """Send what the page would."""
    page.send(json.dumps({"type": kind, **message}))

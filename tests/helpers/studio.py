"""A studio for tests: the command as a process of its own, and its page in a browser."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass
class Studio:
    """A running studio: its process, the address with its token, and the folder that it was started in."""

    process: subprocess.Popen[str]
    url: str
    folder: Path

    @property
    def port(self) -> int:
        """The port that it listens to."""
        return int(self.url.split(":")[2].split("/")[0])


@contextmanager
def running(folder: Path, *arguments: str) -> Iterator[Studio]:
    """A studio whose recovery copies lie in the folder too; it is stopped in the end."""
    environment = os.environ | {"XDG_STATE_HOME": str(folder / ".state")}
    command = [sys.executable, "-m", "voronoi_tiles", "studio", *arguments, "--no-browser"]
    with subprocess.Popen(
        command,
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        assert process.stdout is not None
        url = process.stdout.readline().strip()
        try:
            assert url.startswith("http://127.0.0.1:"), url + (process.stderr.read() if process.stderr else "")
            yield Studio(process, url, folder)
        finally:
            process.terminate()
            process.communicate(timeout=20)


@dataclass
class Window:
    """A page of the studio: what tests do with it, in the drawing's coordinates."""

    page: Any

    def wait(self, state: str = "proved") -> None:
        """Wait until what is drawn has its exact outline, or has none: "refused"."""
        self.page.wait_for_function(
            "([state]) => { const [now, rev, revision] = document.documentElement.dataset.exact.split(' ');"
            " return now === state && (state !== 'proved' || rev === revision); }",
            arg=[state],
            timeout=20_000,
        )

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Where a point of the drawing is on the page."""
        place = self.page.evaluate("at => window.studio.toPage(at)", [x, y])
        return place[0], place[1]

    def click(self, x: float, y: float, **options: Any) -> None:
        """Click at a point of the drawing."""
        self.page.mouse.click(*self.at(x, y), **options)

    def drag(self, start: tuple[float, float], end: tuple[float, float], steps: int = 8) -> None:
        """Drag from a point of the drawing to another."""
        self.page.mouse.move(*self.at(*start))
        self.page.mouse.down()
        self.page.mouse.move(*self.at(*end), steps=steps)
        self.page.mouse.up()

    @property
    def design(self) -> dict[str, Any]:
        """The design as the page holds it."""
        found: dict[str, Any] = self.page.evaluate("() => window.studio.design()")
        return found


@contextmanager
def opened(chromium: Any, studio: Studio, **options: Any) -> Iterator[Window]:
    """The studio's page in a window of its own; what the page complains of is a failure."""
    context = chromium.new_context(**{"viewport": {"width": 1200, "height": 800}, "accept_downloads": True, **options})
    page = context.new_page()
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
    try:
        page.goto(studio.url)
        window = Window(page)
        page.wait_for_function("() => window.studio")
        yield window
        assert complaints == [], complaints
    finally:
        context.close()

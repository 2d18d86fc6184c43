"""The studio's page in a browser: what tests do with it."""

from __future__ import annotations

import base64
import json
import signal
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from helpers import running_studio

Studio = running_studio.RunningStudio


@contextmanager
def running(folder: Path, *arguments: str) -> Iterator[Studio]:
    """A studio that runs on until the block's end, unless the test kills it."""
    with running_studio.running(folder, *arguments) as studio:
        yield studio
        ended = studio.process.poll()
        assert ended in (None, -signal.SIGKILL), f"it has ended by itself, {ended}: {studio.said.read_text()}"


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

    @property
    def text(self) -> str:
        """The same as JSON text, to the byte."""
        found: str = self.page.evaluate("() => JSON.stringify(window.studio.design())")
        return found

    @property
    def strokes(self) -> list[dict[str, Any]]:
        """The strokes of the first site."""
        found: list[dict[str, Any]] = self.design["site"][0]["strokes"]
        return found

    def load(self) -> None:
        """Wait until a page that was opened or reloaded has the server's design; the gallery is open then, too."""
        self.page.wait_for_function(
            "() => window.studio && document.getElementById('file').textContent !== 'no design'"
        )

    def close_gallery(self) -> None:
        """Close the gallery, with which a new design begins, where it is open."""
        self.page.evaluate("() => document.querySelector('dialog:has(.gallery)')?.close()")

    def begin(self, design: Mapping[str, Any], state: str = "proved") -> None:
        """Open another design as a link, with the select tool in hand and the whole cell in the window."""
        self.close_gallery()
        self.page.evaluate("link => { location.hash = link; }", link_of(design))
        self.page.wait_for_function(
            "text => JSON.stringify(window.studio.design()) === JSON.stringify(JSON.parse(text))", arg=compact(design)
        )
        self.page.get_by_role("tab", name="Drawing").click()
        self.page.locator("#overlay").focus()
        self.page.keyboard.press("v")
        self.wait(state)

    def choose(self, name: str) -> None:
        """Take a stroke in the list, as "Line 1"."""
        self.page.locator("#panel-drawing").get_by_role("button", name=name, exact=True).click()

    def save(self) -> None:
        """Save, and wait until it is."""
        self.page.keyboard.press("Control+s")
        self.page.locator("#saved[data-state=saved]").wait_for()


def compact(design: Mapping[str, Any]) -> str:
    """A design as JSON text without blanks."""
    return json.dumps(design, separators=(",", ":"), ensure_ascii=False)


def link_of(design: Mapping[str, Any]) -> str:
    """What stands behind the address of a studio in a link that holds a design."""
    return "#design=" + base64.urlsafe_b64encode(compact(design).encode()).decode().rstrip("=")


@contextmanager
def opened(
    chromium: Any,
    studio: Studio,
    *,
    fragment: str = "",
    script: str = "",
    complaints: bool = True,
    gallery: bool = False,
    **options: Any,
) -> Iterator[Window]:
    """The studio's page in a window of its own, `fragment` behind its address, `script` run before it.

    What the page complains of is a failure, unless `complaints` is false: of a server that is gone browsers complain.
    The gallery, with which a new design begins, is closed, unless the test is about it.
    """
    context = chromium.new_context(**{"viewport": {"width": 1200, "height": 800}, "accept_downloads": True, **options})
    page = context.new_page()
    found: list[str] = []
    page.on("pageerror", lambda error: found.append(str(error)))
    # What the server refuses, 422, the page tells its user; the browser notes it by itself.
    page.on("console", lambda one: found.append(one.text) if one.type == "error" and " 422 " not in one.text else None)
    try:
        page.set_default_timeout(20_000)
        page.add_init_script(script)
        page.goto(studio.address + fragment)
        window = Window(page)
        window.load()
        if not gallery:
            window.close_gallery()
        yield window
        assert not complaints or found == [], found
    finally:
        context.close()

"""The pictures of docs/studio.md, photographed in the browser that the tests use: `make screenshots`."""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from PIL import Image

DOCS = Path(__file__).parents[1]
sys.path.append(str(DOCS.parent / "tests"))

from helpers.page import SOFTWARE_GL  # noqa: E402 - from the tests
from helpers.studio import Window, opened, running  # noqa: E402 - from the tests

COLOURS = 24
"""How many colours the pictures have."""

SHADES = 96
"""How many that of a shaded solid has."""

INKS = 40
"""How many that of drawings in their own colours has."""

SIZE = {"width": 960, "height": 560}

DESIGN = DOCS.parent / "examples" / "p4-hook.toml"
OUTLINE = DOCS.parent / "examples" / "fit" / "fish.svg"
SOLID = DOCS.parent / "examples" / "solid" / "pgg-scutoid.toml"


def shoot(window: Window, name: str, colours: int = COLOURS) -> None:
    """Photograph the window, in so few colours that the file is small."""
    window.page.mouse.move(700, 30)
    window.page.wait_for_timeout(800)
    picture = Image.open(io.BytesIO(window.page.screenshot())).convert("RGB")
    picture.quantize(colours).save(DOCS / "pictures" / f"studio-{name}.png", optimize=True)


@contextmanager
def shown(chromium: Any, folder: Path, design: Path) -> Iterator[Window]:
    """The studio's window with a copy of a design, proved."""
    shutil.copy(design, folder)
    with (
        running(folder, design.name) as studio,
        opened(chromium, studio, viewport=SIZE, color_scheme="light") as window,
    ):
        window.wait()
        yield window


def shoot_drawing(chromium: Any, folder: Path) -> None:
    """Go through the panels of a design, and photograph them."""
    with shown(chromium, folder, DESIGN) as window:
        page = window.page
        page.locator(".stroke").first.click()
        shoot(window, "drawing")
        page.get_by_role("tab", name="Symmetry").click()
        page.wait_for_timeout(8000)
        shoot(window, "symmetry")
        page.get_by_role("tab", name="Job").click()
        page.get_by_label("Sheet", exact=True).fill("300x200mm")
        page.keyboard.press("Enter")
        page.get_by_label("Kerf, mm").fill("0.15")
        page.keyboard.press("Enter")
        page.get_by_role("tab", name="Report").click()
        page.wait_for_timeout(8000)
        shoot(window, "report")


def shoot_solid(chromium: Any, folder: Path) -> None:
    """Photograph the solid of a design that stands."""
    with shown(chromium, folder, SOLID) as window:
        window.page.get_by_role("tab", name="Solid").click()
        window.page.locator(".proof[data-state=proved]").wait_for()
        shoot(window, "solid", colours=SHADES)


def shoot_fits(chromium: Any, folder: Path) -> None:
    """Photograph the designs that are found for an outline."""
    with shown(chromium, folder, DESIGN) as window:
        page = window.page
        page.locator("[data-command=fit-outline]").click()
        page.get_by_label("File of the outline").set_input_files(OUTLINE)
        page.get_by_text("the nearest first").wait_for(timeout=300_000)
        page.locator("dialog").evaluate("dialog => dialog.scrollTo(0, dialog.querySelector('details').offsetTop - 12)")
        shoot(window, "fits", colours=INKS)


SHOTS = {"drawing": shoot_drawing, "fits": shoot_fits, "solid": shoot_solid}
"""What is photographed: all of it, or what the command line names."""


def main(names: Collection[str]) -> None:
    """Photograph the studio."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=SOFTWARE_GL)
        for name in names or SHOTS:
            SHOTS[name](chromium, Path(folder))


if __name__ == "__main__":
    main(sys.argv[1:])

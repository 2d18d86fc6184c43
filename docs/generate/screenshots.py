"""The pictures of docs/studio.md, photographed in the browser that the tests use: `make screenshots`."""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from pathlib import Path

from PIL import Image

DOCS = Path(__file__).parents[1]
sys.path.append(str(DOCS.parent / "tests"))

from helpers.page import SOFTWARE_GL  # noqa: E402 - from the tests
from helpers.studio import Window, opened, running  # noqa: E402 - from the tests

COLOURS = 24
"""How many colours the pictures have."""

DESIGN = DOCS.parent / "examples" / "p4-hook.toml"


def shoot(window: Window, name: str) -> None:
    """Photograph the window, in so few colours that the file is small."""
    window.page.mouse.move(700, 30)
    window.page.wait_for_timeout(800)
    picture = Image.open(io.BytesIO(window.page.screenshot())).convert("RGB")
    picture.quantize(COLOURS).save(DOCS / "pictures" / f"studio-{name}.png", optimize=True)


def main() -> None:
    """Open the studio and go through its panels."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=SOFTWARE_GL)
        shutil.copy(DESIGN, folder)
        size = {"width": 960, "height": 560}
        with (
            running(Path(folder), DESIGN.name) as studio,
            opened(chromium, studio, viewport=size, color_scheme="light") as window,
        ):
            page = window.page
            window.wait()
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


if __name__ == "__main__":
    main()

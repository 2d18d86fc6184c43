"""The page by WCAG 2.2 AA, as far as axe-core finds what is against it, in both looks and all panels and dialogs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from helpers.outline_drawings import FISH, SEARCH_MS
from helpers.page import tool
from helpers.studio import Window, opened, running

RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]


@pytest.fixture(params=["light", pytest.param("dark", marks=pytest.mark.slow)])
def window(chromium: Any, request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Window]:
    """The page of a new design, with the gallery that it begins with."""
    looks = {"color_scheme": request.param, "bypass_csp": True, "gallery": True}
    with running(tmp_path) as studio, opened(chromium, studio, **looks) as found:
        found.wait()
        found.page.add_script_tag(path=tool("axe-core/axe.min.js"))
        yield found


def violations(window: Window) -> list[str]:
    """What axe-core finds: the rule, and where."""
    found = window.page.evaluate("rules => axe.run(document, { runOnly: { type: 'tag', values: rules } })", RULES)
    return [
        f"{one['id']}: {node['target']} {node['failureSummary']}"
        for one in found["violations"]
        for node in one["nodes"]
    ]


@pytest.mark.slow
def test_panels_and_dialogs_are_accessible(window: Window) -> None:
    """No violation, whatever is open."""
    page = window.page
    page.keyboard.press("Escape")
    page.locator(".stroke").first.click()
    assert violations(window) == []
    for tab in ("Symmetry", "Job", "Report", "Solid"):
        page.get_by_role("tab", name=tab).click()
        page.wait_for_timeout(300)
        assert violations(window) == [], tab
    for command in ("help", "gallery", "export", "download-solid", "new", "open", "fit-outline", "share"):
        page.locator(f"[data-command={command}]").first.click()
        page.locator("dialog[open]").wait_for()
        assert violations(window) == [], command
        page.keyboard.press("Escape")
    page.locator("[data-command=fit-outline]").click()
    page.get_by_text("Where to look").click()
    page.get_by_label("Groups", exact=True).fill("p3")
    file = {"name": "fish.svg", "mimeType": "image/svg+xml", "buffer": FISH.encode()}
    page.get_by_label("File of the outline").set_input_files(file)
    assert violations(window) == []
    page.locator(".fits button").first.wait_for(timeout=SEARCH_MS)
    assert violations(window) == []


def test_the_page_is_accessible(window: Window) -> None:
    """No violation as it opens, with the gallery and a stroke's points; and axe-core sees a button without a name."""
    window.page.locator(".gallery button").nth(16).wait_for()
    assert violations(window) == []
    window.page.keyboard.press("Escape")
    window.page.locator("dialog").wait_for(state="detached")
    window.page.locator(".stroke").first.click()
    assert violations(window) == []
    window.page.evaluate("document.querySelector('.bar').append(document.createElement('button'))")
    assert any(violation.startswith("button-name") for violation in violations(window))

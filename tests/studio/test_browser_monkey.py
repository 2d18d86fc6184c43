"""A monkey at the page: whatever it does there is no error, and undo leads back to the byte."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from helpers.studio import Window, opened, running

DESIGN = {
    "schema": 1,
    "group": "p4",
    "cell": {"a": 60},
    "site": [{"name": "bird", "strokes": [{"polyline": [[6.0, 9.0], [20.0, 4.0], [25.0, 18.0]]}]}],
}
KEYS = [
    *"vpcslodb.hegkj+-",
    *("Enter", "Escape", "Backspace", "Delete", "Shift+Delete", "Tab", "Shift+Tab", "ArrowLeft", "Shift+ArrowUp"),
    *(
        "Control+z",
        "Control+y",
        "Control+Shift+z",
        "Control+a",
        "Control+d",
        "Control+0",
        "Shift+Digit1",
        "Shift+Digit2",
    ),
]
BUTTONS = [
    "#panel-drawing .stroke",
    "#panel-drawing button",
    "[data-group]",
    "[role=tab]",
    "[data-tool]",
    "#panel-solid button",
]


def step(window: Window, chance: random.Random) -> None:
    """Do something."""
    page = window.page

    def place() -> tuple[float, float]:
        return window.at(chance.uniform(-10, 70), chance.uniform(-10, 70))

    match chance.choices(["key", "click", "double", "drag", "button", "number"], [6, 6, 1, 4, 3, 1])[0]:
        case "key":
            page.keyboard.press(chance.choice(KEYS))
        case "click":
            page.mouse.click(*place())
        case "double":
            page.mouse.dblclick(*place())
        case "drag":
            held = chance.choice(["", "", "Shift", "Alt", "Control"])
            page.mouse.move(*place())
            if held:
                page.keyboard.down(held)
            page.mouse.down()
            page.mouse.move(*place(), steps=3)
            if chance.random() < 0.2:
                page.keyboard.press(chance.choice(["Escape", "Control+z", "Delete", "p", "v"]))
                page.mouse.move(*place(), steps=2)
            page.mouse.up()
            if held:
                page.keyboard.up(held)
        case "button":
            found = page.locator(chance.choice(BUTTONS)).and_(page.locator(":visible:enabled"))
            count = found.count()
            if count:
                found.nth(chance.randrange(count)).click()
        case _:
            found = page.locator("#panel-drawing .point input:visible")
            count = found.count()
            if count:
                field = found.nth(chance.randrange(count))
                field.fill(f"{chance.uniform(-40, 80):.2f} + 1/8in")
                field.press("Enter")


def play(chromium: Any, folder: Path, seed: int, steps: int) -> None:
    """Let the monkey play; undo everything, and redo it."""
    chance = random.Random(seed)  # noqa: S311 - not for secrets
    with running(folder) as studio, opened(chromium, studio, viewport={"width": 800, "height": 600}) as window:
        window.wait()
        first = window.text
        window.begin(DESIGN)
        page = window.page
        before = window.text
        for _ in range(steps):
            step(window, chance)
            if page.locator("dialog[open]").count():
                page.keyboard.press("Escape")
        page.keyboard.press("Escape")
        page.get_by_role("tab", name="Drawing").click()
        page.locator("#overlay").focus()
        page.keyboard.press("v")
        after = window.text
        undo, redo = (page.get_by_role("button", name=name, exact=True) for name in ("Undo", "Redo"))
        seen = [after]
        while before not in seen and undo.is_enabled() and len(seen) < 4 * steps:
            undo.click()
            seen.append(window.text)
        # Who takes back more than was done ends at what the page began with, and draws on from there.
        assert seen[-1] in (before, first), seed
        for text in reversed(seen[:-1]):
            redo.click()
            assert window.text == text, seed
        window.begin(DESIGN)


def test_a_monkey(chromium: Any, tmp_path: Path) -> None:
    """Some steps."""
    play(chromium, tmp_path, seed=1, steps=25)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 3])
def test_monkeys(chromium: Any, tmp_path: Path, seed: int) -> None:
    """Many steps."""
    play(chromium, tmp_path, seed=seed, steps=60)

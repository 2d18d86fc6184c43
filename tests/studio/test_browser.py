"""The studio in a real browser: what a user does from the first stroke to the file for the cutter."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from helpers.studio import Studio, Window, opened, running

import voronoi_tiles as vt

DESIGN = """\
# A design with a comment that has to survive.
schema = 1
group = "p4"
cell = { a = 60.0 }

[[site]]
name = "bird"  # my tile
strokes = [
  { polyline = [[6.0, 9.0], [20.0, 4.0], [25.0, 18.0]] },  # the wing
]
"""

LOG = """\
window.log = [];
const { send, addEventListener } = WebSocket.prototype;
WebSocket.prototype.send = function (text) {
    const { type, rev, rest } = JSON.parse(text);
    if (type === "design" && !rest) window.log.push(rev);
    return send.call(this, text);
};
WebSocket.prototype.addEventListener = function (kind, tell) {
    return addEventListener.call(this, kind, (event) => {
        const { type, rev } = kind === "message" ? JSON.parse(event.data) : {};
        if (type === "outline") window.log.push(-rev);
        tell(event);
    });
};
"""
"""What the page writes down of its connection: revisions that it sends while it is dragged, minus those of answers."""


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """A studio on a small design."""
    folder = tmp_path_factory.mktemp("bird")
    (folder / "bird.toml").write_text(DESIGN, encoding="utf-8")
    with running(folder, "bird.toml") as found:
        yield found


@pytest.fixture(scope="module")
def page(chromium: Any, studio: Studio) -> Iterator[Window]:
    """Its page, for all tests."""
    with opened(chromium, studio, script=LOG) as found:
        found.wait()
        yield found


@pytest.fixture
def window(page: Window) -> Window:
    """The page with the design as it was."""
    page.begin(tomllib.loads(DESIGN))
    return page


def test_from_a_stroke_to_a_file(window: Window, studio: Studio) -> None:
    """A curve drawn with the mouse, a point dragged, another group, undo, save: the file says it, and exports alike."""
    page = window.page
    page.keyboard.press("c")
    for x, y in ((8, 22), (14, 26), (22, 24)):
        window.click(x, y)
    page.keyboard.press("Enter")
    window.wait()
    drawn = window.design["site"][0]["strokes"]
    assert [round(value) for point in drawn[1]["catmull_rom"] for value in point] == [8, 22, 14, 26, 22, 24]

    page.keyboard.press("v")
    window.click(14, 26)
    window.drag((22, 24), (20, 27))
    window.wait()
    moved = window.design["site"][0]["strokes"][1]["catmull_rom"]
    assert moved[2] == pytest.approx([20, 27], abs=0.2)
    assert moved[:2] == drawn[1]["catmull_rom"][:2]

    page.get_by_role("tab", name="Symmetry").click()
    page.locator("[data-group=p2]").click()
    page.wait_for_function("() => window.studio.design().group === 'p2'")
    page.get_by_role("button", name="Undo").click()
    assert window.design["group"] == "p4"
    window.wait()

    page.keyboard.press("Control+s")
    page.wait_for_function("() => document.getElementById('saved').dataset.state === 'saved'")
    text = (studio.folder / "bird.toml").read_text(encoding="utf-8")
    assert text.startswith("# A design with a comment that has to survive.")
    assert "# my tile" in text
    assert "{ polyline = [[6.0, 9.0], [20.0, 4.0], [25.0, 18.0]] },  # the wing" in text
    assert tomllib.loads(text) == window.design

    tiling = vt.Design.load(studio.folder / "bird.toml").tessellate()
    for form in ("svg", "json", "dxf"):
        page.keyboard.press("Control+e")
        page.get_by_label("Format").select_option(form)
        with page.expect_download() as download:
            page.get_by_role("button", name="Download").click()
        page.locator("dialog").wait_for(state="detached")
        tiling.export(studio.folder / f"ours.{form}")
        assert download.value.suggested_filename == f"bird.{form}"
        assert Path(download.value.path()).read_bytes() == (studio.folder / f"ours.{form}").read_bytes()


def test_undo_goes_point_by_point(window: Window) -> None:
    """While the pen draws and after: each point is a step, and redo brings it back."""
    page = window.page
    before = json.dumps(window.design)
    page.keyboard.press("l")
    for x, y in ((8, 22), (14, 26), (22, 24), (24, 28)):
        window.click(x, y)
    page.keyboard.press("Control+z")
    page.keyboard.press("Enter")
    assert len(window.design["site"][0]["strokes"][1]["polyline"]) == 3
    after = json.dumps(window.design)
    page.keyboard.press("Control+z")
    assert len(window.design["site"][0]["strokes"][1]["segment"]) == 2
    page.keyboard.press("Control+z")
    assert json.dumps(window.design) == before
    page.keyboard.press("Control+Shift+z")
    page.keyboard.press("Control+y")
    assert json.dumps(window.design) == after


def test_one_design_is_on_its_way_at_a_time(window: Window) -> None:
    """While a point is dragged, the next design goes out with the answer to the last, and the last one is proved."""
    page = window.page
    window.choose("Line 1")
    page.evaluate("() => { window.log.length = 0; }")
    window.drag((20, 4), (24, 9), steps=40)
    window.wait()
    log = page.evaluate("() => window.log")
    waiting: int | None = None
    asked = 0
    for rev in log:
        if rev > 0:
            assert waiting is None, log
            waiting, asked = rev, asked + 1
        elif waiting is not None and -rev >= waiting:
            waiting = None
    assert asked > 5, log
    assert window.strokes[0]["polyline"][1] == pytest.approx([24, 9], abs=0.3)


def test_touching_copies_are_shown_where_they_touch(window: Window) -> None:
    """The last good outline stays, greyed, over the live picture; the message says what to do.

    Otherwise outlines that come as quickly as here are the picture, where the processor would draw the live one.
    """
    page = window.page
    assert page.locator("#picture").is_hidden()
    page.keyboard.press("l")
    window.click(8, 22)
    window.click(-8, 22.5)
    page.keyboard.press("Enter")
    page.keyboard.press("l")
    window.click(20, 20)
    window.click(-20, -20)
    page.keyboard.press("Enter")
    window.wait("refused")
    assert "touches" in page.get_by_role("alert").first.inner_text()
    assert page.locator("#measure").inner_text() == ""
    page.locator("#picture").wait_for(state="visible")
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    window.wait()
    assert page.locator("#banner").is_hidden()
    assert " x " in page.locator("#measure").inner_text()


def test_everything_by_the_keyboard(window: Window) -> None:
    """A line is drawn, moved and taken out without a pointer."""
    page = window.page
    count = len(window.design["site"][0]["strokes"])
    page.locator("#overlay").focus()
    page.keyboard.press("l")
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Enter")
    for _ in range(4):
        page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Enter")
    assert "Enter places a point, Ctrl+Enter ends it" in page.locator("#hint").inner_text()
    page.keyboard.press("Control+Enter")
    page.get_by_role("button", name=f"Line {count + 1}", expanded=True).wait_for()
    page.keyboard.press("Enter")
    page.keyboard.press("Shift+ArrowUp")
    page.keyboard.press("Enter")
    page.keyboard.press("Control+Enter")
    assert len(window.design["site"][0]["strokes"]) == count + 2
    page.keyboard.press("Delete")
    assert len(window.design["site"][0]["strokes"]) == count + 1
    segment = window.design["site"][0]["strokes"][-1]["segment"]
    window.choose(f"Line {count + 1}")
    page.locator("#overlay").focus()
    page.keyboard.press("v")
    assert "place" not in page.locator("#hint").inner_text()
    page.keyboard.press("Shift+ArrowRight")
    moved = window.design["site"][0]["strokes"][-1]["segment"]
    assert [[x - 1, y] for x, y in moved] == [pytest.approx(point) for point in segment]
    page.keyboard.press("Delete")
    assert len(window.design["site"][0]["strokes"]) == count


def test_the_point_in_hand_is_said(window: Window) -> None:
    """Its number and its place, once after a key that was held; of a drawing tool the cross hair's place."""
    page = window.page
    said = page.locator("#in-hand[role=status]")
    window.choose("Line 1")
    page.locator("#overlay").focus()
    for text in ("Point 1 of 3, x 6 mm, y 9 mm", "Point 2 of 3, x 20 mm, y 4 mm"):
        page.keyboard.press("Tab")
        said.get_by_text(text, exact=True).wait_for(state="attached")
    page.evaluate("""() => {
        window.told = [];
        const said = document.getElementById("in-hand");
        new MutationObserver(() => window.told.push(said.textContent)).observe(said, { childList: true });
        for (let k = 0; k < 20; k++) {
            const key = { key: "ArrowRight", shiftKey: true, bubbles: true };
            document.getElementById("overlay").dispatchEvent(new KeyboardEvent("keydown", key));
        }
    }""")
    page.wait_for_function("() => window.told.length")
    assert page.evaluate("() => window.told") == ["Point 2 of 3, x 40 mm, y 4 mm"]
    page.keyboard.press("l")
    page.keyboard.press("Shift+ArrowRight")
    page.wait_for_function("() => /^Cross hair, x -?[0-9.]+ mm, y -?[0-9.]+ mm$/.test(window.told.at(-1))")


def test_points_are_numbers_with_units(window: Window) -> None:
    """A coordinate takes arithmetic and inches."""
    page = window.page
    page.get_by_role("button", name="Line 1").click()
    field = page.get_by_label("Line 1, Point 2, x")
    field.fill("1in - 5.4mm")
    field.press("Enter")
    window.wait()
    assert window.design["site"][0]["strokes"][0]["polyline"][1] == pytest.approx([20.0, 4.0])
    field = page.get_by_label("Line 1, Point 2, x")
    field.fill("a lot")
    field.press("Enter")
    assert window.design["site"][0]["strokes"][0]["polyline"][1] == pytest.approx([20.0, 4.0])
    error = page.locator("#panel-drawing").get_by_role("alert")
    assert "Write a length" in error.inner_text()
    field.press("Escape")
    error.wait_for(state="detached")
    assert field.input_value() == "20"

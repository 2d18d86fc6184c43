"""An outline that is dropped onto the page becomes a choice of designs, and the one that is taken can be undone."""

from __future__ import annotations

import base64
import re
import tomllib
from collections.abc import Iterator
from typing import Any

import pytest
from helpers.outline_drawings import CROSSING, FISH, KITE, OPEN, PIXELS, SEARCH_MS, TWO
from helpers.studio import Studio, Window, opened, running

import voronoi_tiles as vt

SMALL = {"width": 900, "height": 640}
DRAG = """([name, data, kind, id]) => {
    const files = new DataTransfer();
    files.items.add(new File([Uint8Array.from(atob(data), letter => letter.charCodeAt(0))], name));
    document.getElementById(id).dispatchEvent(
        new DragEvent(kind, { dataTransfer: files, bubbles: true, cancelable: true }));
}"""


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """A studio on a design."""
    folder = tmp_path_factory.mktemp("fits")
    vt.starter("p4").save(folder / "bird.toml")
    with running(folder, "bird.toml") as found:
        yield found


@pytest.fixture
def window(chromium: Any, studio: Studio) -> Iterator[Window]:
    """Its page."""
    with opened(chromium, studio, viewport=SMALL) as found:
        found.wait()
        yield found


def drag(window: Window, name: str, data: bytes, kind: str = "drop", place: str = "outline-place") -> None:
    """Drag a file over a part of the page, or drop it there."""
    window.page.evaluate(DRAG, [name, base64.b64encode(data).decode(), kind, place])


def test_an_outline_is_dropped_and_a_design_taken(window: Window, studio: Studio) -> None:
    """By the keyboard alone from there on; its art is a file beside the design, and undo leads back in one step."""
    page, before = window.page, window.text
    place = page.locator("#outline-place")
    assert place.is_hidden()
    drag(window, "fish.svg", FISH.encode(), "dragover", "overlay")
    assert "tiles that come near" in place.inner_text()
    drag(window, "fish.svg", FISH.encode())
    assert place.is_hidden()
    dialog = page.get_by_role("dialog", name="Tiles near to an outline")
    assert dialog.get_by_role("progressbar", name="The search").is_visible()
    dialog.get_by_text("Where to look").click()
    groups = dialog.get_by_label("Groups", exact=True)
    groups.fill("p1, p3")
    page.keyboard.press("Enter")  # looks anew, in these alone
    dialog.get_by_text(re.compile(r"\d designs, the nearest first")).wait_for(timeout=SEARCH_MS)
    assert dialog.get_by_role("progressbar").count() == 0
    found = dialog.locator(".fits button")
    overlaps = [float(text.split("overlap ")[1].split(",")[0]) for text in found.all_inner_texts()]
    assert overlaps == sorted(overlaps, reverse=True)
    assert page.evaluate("() => [...document.querySelectorAll('.fits img')].every(image => image.naturalWidth > 0)")
    groups_found = [text.split(":")[0] for text in found.all_inner_texts()]
    other = next(k for k, group in enumerate(groups_found) if group != groups_found[0])
    name = groups_found[other]
    found.nth(other).focus()
    page.keyboard.press("Enter")
    dialog.wait_for(state="detached")
    window.wait()
    assert window.design["group"] == name
    assert page.locator("#saved").inner_text() == "not saved"
    page.locator("#banner").get_by_text("bird-art.svg").wait_for()
    assert (studio.folder / "bird-art.svg").read_text(encoding="utf-8").rstrip().endswith("</svg>")
    page.keyboard.press("Control+z")
    assert window.text == before
    page.keyboard.press("Control+y")
    window.save()
    saved = tomllib.loads((studio.folder / "bird.toml").read_text(encoding="utf-8"))
    assert saved["site"][0]["art"]["file"] == "bird-art.svg"
    assert vt.Design.load(studio.folder / "bird.toml").tessellate().proof.passed

    # What was found is still there, and can be taken in its place; the same art is the same file.
    page.get_by_role("button", name="Fit", exact=True).click()
    assert dialog.get_by_text(f"{len(groups_found)} designs").is_visible()
    dialog.locator(".fits button").first.dblclick()
    dialog.wait_for(state="detached")
    assert window.design["group"] != name
    page.keyboard.press("Control+z")
    assert window.design["group"] == name
    window.wait()  # the server has it, too, and offers no other to the next page
    assert page.locator("#saved").inner_text() == "saved"


def test_symmetric_tiles_alone_are_looked_for(window: Window) -> None:
    """Of a kite; and what is not its own mirror image is refused, with how much it is like it."""
    page = window.page
    page.get_by_role("button", name="Fit", exact=True).click()
    dialog = page.get_by_role("dialog", name="Tiles near to an outline")
    dialog.get_by_text("Where to look").click()
    dialog.get_by_label("Groups", exact=True).fill("p1")
    dialog.get_by_label("Symmetric tiles alone").check()
    drag(window, "kite.svg", KITE.encode())
    dialog.get_by_text(re.compile(r"\d designs?, the nearest first")).wait_for(timeout=SEARCH_MS)
    assert all(text.endswith("symmetric") for text in dialog.locator(".fits button").all_inner_texts())
    drag(window, "fish.svg", FISH.encode())
    dialog.get_by_text("not its own mirror image").wait_for()
    assert dialog.locator(".fits button").count() == 0


def test_a_search_is_stopped_and_replaced(window: Window) -> None:
    """Stop ends it, a file that is dropped takes its place, and drawings beside the box are strokes as ever."""
    page, before = window.page, window.text
    page.get_by_role("button", name="Fit", exact=True).click()
    dialog = page.get_by_role("dialog", name="Tiles near to an outline")
    dialog.get_by_label("File of the outline").set_input_files(
        {"name": "first.svg", "mimeType": "image/svg+xml", "buffer": FISH.encode()}
    )
    dialog.get_by_text("Looking for tiles near to first.svg").wait_for()
    dialog.get_by_role("button", name="Stop").click()
    dialog.get_by_text("Stopped: no designs found").wait_for()
    dialog.get_by_role("button", name="Look again").click()
    dialog.get_by_text("Looking for tiles near to first.svg").wait_for()
    drag(window, "second.svg", FISH.encode(), place="overlay")
    dialog.get_by_text("Looking for tiles near to second.svg").wait_for()
    page.keyboard.press("Escape")
    dialog.wait_for(state="detached")
    assert window.text == before
    drag(window, "third.svg", FISH.encode(), place="overlay")
    page.wait_for_function(
        "count => window.studio.design().site[0].strokes.length === count", arg=len(window.strokes) + 2
    )
    page.get_by_role("button", name="Undo").click()
    assert window.text == before


def test_what_has_no_outline_is_said(window: Window) -> None:
    """A sentence each in the dialog that the drop opens, and nothing that is drawn changes."""
    page, before = window.page, window.text
    for name, data, message in (
        ("bird.png", PIXELS, "bird.png: a picture of pixels has no outline. Trace it first"),
        ("open.svg", OPEN.encode(), "open.svg: the outline is open"),
        ("cross.svg", CROSSING.encode(), "crosses itself"),
        ("two.svg", TWO.encode(), "two outlines beside each other"),
        ("large.svg", bytes((16 << 20) + 1), "larger than 16 MiB"),
    ):
        drag(window, name, data)
        page.get_by_role("dialog").get_by_role("alert").get_by_text(message).wait_for()
        assert page.locator(".fits button").count() == 0
    page.get_by_text("Where to look").click()
    page.get_by_label("Groups", exact=True).fill("p5")
    page.keyboard.press("Tab")
    drag(window, "fish.svg", FISH.encode())
    page.get_by_role("dialog").get_by_role("alert").get_by_text(
        "Groups has 'p5', which is no wallpaper group"
    ).wait_for()
    assert window.text == before

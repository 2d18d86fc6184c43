"""Nothing is lost, and nothing is written over in silence: crashes, other programs, drops, links, and undo of each."""

from __future__ import annotations

import json
import os
import signal
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from helpers.studio import Studio, Window, link_of, opened, running

import voronoi_tiles as vt

WING = [[6.0, 9.0], [20.0, 4.0], [25.0, 18.0]]
DESIGN = {"schema": 1, "group": "p4", "cell": {"a": 60}, "site": [{"name": "bird", "strokes": [{"polyline": WING}]}]}
TEXT = """\
# By hand.
schema = 1
group = "p4"
cell = { a = 60 }

[[site]]
name = "bird"
strokes = [{ polyline = [[6.0, 9.0], [20.0, 4.0], [25.0, 18.0]] }]
"""
LEAF = """\
<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="10mm" viewBox="0 0 20 10">
<path d="M 0 5 C 5 0 15 0 20 5" fill="none" stroke="black"/><path d="M 2 8 L 12 9" fill="none" stroke="black"/></svg>
"""
SMALL = {"width": 900, "height": 640}


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """A studio on a design."""
    folder = tmp_path_factory.mktemp("files")
    (folder / "work").mkdir()
    (folder / "work/bird.toml").write_text(TEXT, encoding="utf-8")
    with running(folder, "work/bird.toml") as found:
        yield found


@pytest.fixture(scope="module")
def page(chromium: Any, studio: Studio) -> Iterator[Window]:
    """Its page, for all tests."""
    with opened(chromium, studio, viewport=SMALL) as found:
        found.wait()
        yield found


@pytest.fixture
def window(page: Window) -> Window:
    """The page, with the design saved as it is on disk."""
    page.begin(DESIGN)
    page.save()
    return page


def draw_a_line(window: Window) -> None:
    """Draw a short line, which makes the design another one: the page says so and the window stays where it is."""
    window.page.locator("#overlay").focus()
    window.page.keyboard.press("l")
    window.click(8, 24)
    window.click(22, 26)
    window.page.keyboard.press("Enter")
    window.page.keyboard.press("v")
    assert len(window.strokes) == 2
    assert "segment" in window.strokes[1]


def saved_state(window: Window) -> str:
    """What the page says of the file."""
    found: str = window.page.locator("#saved").inner_text()
    return found


# Crashes


def test_a_drawing_that_its_keys_no_longer_fit(window: Window) -> None:
    """The outline goes on, and the page says that commands will refuse the file; undo makes it fit again."""
    key = {"z": 20, "strokes": [{"segment": [[8, 12], [22, 14]]}]}
    line = {"strokes": [{"segment": [[8, 10], [22, 17]]}]}
    window.begin({**DESIGN, "site": [line], "solid": {"height": 40}, "key": [key]})
    draw_a_line(window)
    window.wait("refused")
    banner = window.page.locator("#banner")
    assert "Commands will refuse this drawing with its key[0]" in banner.inner_text()
    assert window.page.locator("#exact").inner_text() == "proved, but it cannot stand"
    window.page.keyboard.press("Control+z")
    window.wait()
    assert banner.is_hidden()


def test_a_killed_server(chromium: Any, tmp_path: Path) -> None:
    """The page says it, and keeps what is drawn; a new studio offers the copy, which is at most a second old."""
    path = tmp_path / "bird.toml"
    path.write_text(TEXT, encoding="utf-8")
    with running(tmp_path, "bird.toml") as studio, opened(chromium, studio, complaints=False, viewport=SMALL) as window:
        window.wait()
        draw_a_line(window)
        window.wait()
        copies = tmp_path / "state/voronoi-tiles/studio"
        window.page.wait_for_timeout(1000)  # what the promise allows
        drawn = window.text
        os.kill(studio.process.pid, signal.SIGKILL)
        alert = window.page.get_by_role("alert")
        alert.get_by_text("The connection to the studio's server is lost.").wait_for()
        assert window.text == drawn
        assert list(copies.glob("*.json"))
        # What is drawn on has no outlines any more: the live picture shows it.
        assert window.page.locator("#picture").is_hidden()
        window.page.locator("#overlay").focus()
        window.page.keyboard.press("ArrowRight")
        window.page.locator("#picture").wait_for(state="visible")
    assert path.read_text(encoding="utf-8") == TEXT

    with running(tmp_path, "bird.toml") as studio, opened(chromium, studio, viewport=SMALL) as window:
        assert json.loads(drawn)["site"] != window.design["site"]
        window.page.get_by_role("dialog").get_by_text("was drawn last").wait_for()
        window.page.get_by_role("button", name="Take the copy").click()
        assert window.text == drawn
        assert saved_state(window) == "not saved"
        window.page.get_by_role("button", name="Undo").click()
        assert json.loads(window.text) == DESIGN
        window.page.get_by_role("button", name="Redo").click()
        window.save()
        assert len(vt.Design.load(path).sites[0].strokes) == 2
        assert path.read_text(encoding="utf-8").startswith("# By hand.\n")
        window.page.reload()
        window.page.wait_for_function("() => window.studio")
        window.wait()
        assert window.page.locator("dialog").count() == 0


# Other programs


def test_a_change_outside_is_taken_where_nothing_is_lost(window: Window, studio: Studio) -> None:
    """The page follows an editor; undo leads back to what was there."""
    path = studio.folder / "work/bird.toml"
    path.write_text(TEXT.replace("20.0, 4.0", "20.0, 5.5"), encoding="utf-8")
    window.page.wait_for_function("() => window.studio.design().site[0].strokes[0].polyline[1][1] === 5.5")
    assert saved_state(window) == "saved"
    window.page.keyboard.press("Control+z")
    assert json.loads(window.text) == DESIGN
    assert saved_state(window) == "not saved"
    window.page.keyboard.press("Control+y")
    assert saved_state(window) == "saved"
    assert window.page.locator("dialog").count() == 0


def test_a_change_outside_while_something_is_not_saved(window: Window, studio: Studio) -> None:
    """It is asked; a save over it is asked again, and what is written over is kept; theirs can be taken, and undone."""
    page, path = window.page, studio.folder / "work/bird.toml"
    draw_a_line(window)
    mine = window.text
    theirs = TEXT.replace("20.0, 4.0", "20.0, 6.5")
    path.write_text(theirs, encoding="utf-8")
    dialog = page.get_by_role("dialog")
    dialog.get_by_text("changed by another program").wait_for()
    page.keyboard.press("Escape")
    assert window.text == mine
    page.keyboard.press("Control+s")
    dialog.get_by_text("takes its place").wait_for()
    assert path.read_text(encoding="utf-8") == theirs
    dialog.get_by_role("button", name="Keep mine").click()
    page.locator("#saved[data-state=saved]").wait_for()
    assert len(vt.Design.load(path).sites[0].strokes) == 2
    assert (studio.folder / "work/bird-backup.toml").read_text(encoding="utf-8") == theirs
    page.get_by_text("bird-backup.toml").wait_for()
    page.locator("#banner").get_by_role("button", name="Close").click()

    window.choose("Line 1")
    page.locator("#overlay").focus()
    page.keyboard.press("Shift+ArrowUp")
    mine = window.text
    path.write_text(theirs, encoding="utf-8")
    dialog.get_by_text("changed by another program").wait_for()
    dialog.get_by_role("button", name="Take theirs").click()
    page.wait_for_function("() => window.studio.design().site[0].strokes.length === 1")
    assert saved_state(window) == "saved"
    page.keyboard.press("Control+z")
    assert window.text == mine
    window.save()
    assert len(vt.Design.load(path).sites[0].strokes) == 2


def test_a_deleted_and_a_broken_file(window: Window, studio: Studio) -> None:
    """One clear message each, and a save makes it whole again."""
    page, path = window.page, studio.folder / "work/bird.toml"
    before = window.text
    path.unlink()
    dialog = page.get_by_role("dialog")
    dialog.get_by_text("removed, or renamed, by another program").wait_for()
    dialog.get_by_role("button", name="Keep mine").click()
    assert saved_state(window) == "not saved"
    window.save()
    assert vt.Design.load(path).to_dict()["site"][0]["name"] == "bird"

    broken = path.read_text(encoding="utf-8").replace("[[site]]", "[[site")
    path.write_text(broken, encoding="utf-8")
    dialog.get_by_text("is no design").wait_for()
    assert "line" in dialog.inner_text()
    dialog.get_by_role("button", name="Keep mine").click()
    assert window.text == before
    window.save()
    assert vt.Design.load(path).to_dict()["site"][0]["name"] == "bird"


def test_a_folder_that_cannot_be_written(window: Window, studio: Studio) -> None:
    """The message names the file; when the folder is there again a save does it."""
    page = window.page
    draw_a_line(window)
    work = studio.folder / "work"
    away = work.rename(studio.folder / "away")
    try:
        dialog = page.get_by_role("dialog")
        dialog.get_by_role("button", name="Keep mine").click()
        page.keyboard.press("Control+s")
        page.get_by_role("alert").get_by_text("bird.toml").wait_for()
        assert saved_state(window) == "not saved"
    finally:
        away.rename(work)
    window.save()
    assert page.locator("#banner").is_hidden()


# Drawings of others


def test_a_drawing_is_dropped_and_opened(window: Window, tmp_path: Path) -> None:
    """Its paths are strokes, in true size; undo takes all of them back."""
    page = window.page
    before = window.text
    page.evaluate(
        """text => {
            const data = new DataTransfer();
            data.items.add(new File([text], "leaf.svg", { type: "image/svg+xml" }));
            document.getElementById("overlay").dispatchEvent(
                new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
        }""",
        LEAF,
    )
    page.wait_for_function("() => window.studio.design().site[0].strokes.length === 3")
    dropped = window.strokes[1:]
    page.keyboard.press("Control+z")
    assert window.text == before

    (tmp_path / "leaf.svg").write_text(LEAF, encoding="utf-8")
    page.get_by_role("button", name="Open").click()
    page.get_by_label("File", exact=True).set_input_files(tmp_path / "leaf.svg")
    page.wait_for_function("() => window.studio.design().site[0].strokes.length === 3")
    assert window.strokes[1:] == dropped
    page.get_by_role("button", name="Undo").click()
    assert window.text == before

    (tmp_path / "cat.svg").write_text("<svg", encoding="utf-8")
    page.get_by_role("button", name="Open").click()
    page.get_by_role("dialog").get_by_role("button", name="Open").click()
    page.get_by_role("alert").get_by_text("Choose a file").wait_for()
    page.get_by_label("File", exact=True).set_input_files(tmp_path / "cat.svg")
    page.get_by_role("alert").get_by_text("cat.svg").wait_for()
    page.keyboard.press("Escape")
    assert window.text == before


def test_a_design_is_opened(window: Window, studio: Studio, tmp_path: Path) -> None:
    """In the place of what is drawn, the file from Share, too; undo leads back, and the file stays the same one."""
    page = window.page
    before = window.text
    page.get_by_role("button", name="Share").click()
    with page.expect_download() as found:
        page.get_by_role("button", name="Download the file").click()
    page.locator("dialog").wait_for(state="detached")
    text = Path(found.value.path()).read_text(encoding="utf-8")
    (tmp_path / "other.toml").write_text(
        text.replace("{ polyline", '{ file = "eye.svg" }, { polyline'), encoding="utf-8"
    )
    page.get_by_role("button", name="Open").click()
    page.get_by_label("File", exact=True).set_input_files(tmp_path / "other.toml")
    page.wait_for_function("() => window.studio.design().site[0].strokes.length === 2")
    page.locator("#banner").get_by_text(
        f"other.toml names 'eye.svg', not to be found from {studio.folder}/work"
    ).wait_for()
    assert page.locator("#file").inner_text() == "work/bird.toml"
    page.get_by_role("button", name="Undo").click()
    assert window.text == before
    assert saved_state(window) == "saved"
    page.locator("#banner").wait_for(state="hidden")  # what was said of the one that was opened


def test_copy_cut_and_paste(window: Window) -> None:
    """Strokes come back as they are; other programs get SVG, and theirs is taken."""
    page = window.page
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    before = window.text
    window.click(13, 6.5)
    page.keyboard.press("Control+c")
    copied = page.evaluate("() => navigator.clipboard.readText()")
    assert copied.startswith("<svg")
    assert 'd="M 6 -9 C' in copied
    page.keyboard.press("Control+v")
    page.wait_for_function("() => window.studio.design().site[0].strokes.length === 2")
    old, new = (stroke["polyline"] for stroke in window.strokes)
    [shift] = {tuple(round(b - a, 6) for a, b in zip(*pair, strict=True)) for pair in zip(old, new, strict=True)}
    assert shift[0] > 0
    page.keyboard.press("Control+x")
    assert len(window.strokes) == 1
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    assert window.text == before
    page.evaluate("text => navigator.clipboard.writeText(text)", LEAF)
    page.keyboard.press("Control+v")
    page.wait_for_function("() => window.studio.design().site[0].strokes.length === 3")
    page.keyboard.press("Control+z")
    assert window.text == before


def test_links(chromium: Any, window: Window, tmp_path: Path) -> None:
    """A link gives the same design in another studio: as its address, pasted, and under Open; one cut off is said."""
    page = window.page
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    draw_a_line(window)
    shared = window.text
    page.get_by_role("button", name="Share").click()
    link = page.get_by_label("Link", exact=True).input_value()
    page.get_by_role("button", name="Copy the link").click()
    assert page.evaluate("() => navigator.clipboard.readText()") == link
    fragment = link[link.index("#") :]
    with running(tmp_path) as other, opened(chromium, other, viewport=SMALL, fragment=fragment) as second:
        assert second.text == shared
        assert "#" not in second.page.url
        assert saved_state(second) == "not saved"
        second.page.get_by_role("button", name="Undo").click()
        assert second.text != shared
        second.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        second.page.evaluate("text => navigator.clipboard.writeText(text)", link)
        second.page.locator("#overlay").focus()
        second.page.keyboard.press("Control+v")
        second.page.wait_for_function("text => JSON.stringify(window.studio.design()) === text", arg=shared)
        second.page.get_by_role("button", name="Undo").click()
        second.page.get_by_role("button", name="Open").click()
        second.page.get_by_label("Or a link").fill(link)
        second.page.get_by_role("dialog").get_by_role("button", name="Open").click()
        second.page.wait_for_function("text => JSON.stringify(window.studio.design()) === text", arg=shared)
        for cut in (fragment[:40], link_of({"site": 3})):
            second.page.evaluate("link => { location.hash = link; }", cut)
            second.page.get_by_role("alert").get_by_text("It may have been cut off").wait_for()
            assert second.text == shared
            second.page.get_by_role("button", name="Close").click()


def test_gallery(window: Window) -> None:
    """Every example has a picture and a name, and one takes the place of what is drawn; undo brings that back."""
    page = window.page
    before = window.text
    page.get_by_role("button", name="Gallery").click()
    example = page.get_by_role("dialog").get_by_role("button", name="p6m: sixths of a turn and mirrors")
    example.wait_for()
    pictures = page.evaluate("""() => [...document.querySelectorAll(".gallery canvas")].map((canvas) => {
        const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
        const full = new Uint32Array(pixels.buffer).filter((pixel) => pixel >>> 24 === 255);
        return { colours: new Set(full).size, address: canvas.toDataURL() };
    })""")
    assert len({picture["address"] for picture in pictures}) == 17
    assert min(picture["colours"] for picture in pictures) > 10  # tiles of several, and the shades of their edges
    example.focus()
    page.keyboard.press("Enter")
    page.locator("dialog").wait_for(state="detached")
    assert window.design["group"] == "p6m"
    window.wait()
    page.get_by_role("button", name="Undo").click()
    assert window.text == before
    assert saved_state(window) == "saved"


def test_a_new_design_in_a_file_of_its_own(window: Window, studio: Studio) -> None:
    """Nothing is written over, and what was not saved of the old one can be found again."""
    page = window.page  # which ends with the new one: this test is the last
    draw_a_line(window)
    drawn = window.strokes
    page.get_by_role("tab", name="Report").click()
    page.get_by_role("button", name="New", exact=True).click()
    page.get_by_text("What is not saved of work/bird.toml is kept as a copy").wait_for()
    page.get_by_label("Name", exact=True).fill("leaf")
    page.get_by_role("button", name="Begin").click()
    page.keyboard.press("Control+s")  # what is drawn is still the old one, for a moment
    page.locator("#file").get_by_text("work/leaf.toml").wait_for()
    page.get_by_role("dialog", name="Begin with an example").wait_for()
    page.keyboard.press("Escape")
    window.wait()
    assert window.strokes != drawn
    assert page.get_by_role("button", name="Undo").is_disabled()
    leaf = studio.folder / "work/leaf.toml"
    assert not leaf.exists()
    assert page.get_by_role("tab", name="Drawing").get_attribute("aria-selected") == "true"
    page.get_by_role("tab", name="Symmetry").click()
    page.locator("[data-group=p2]").click()
    page.reload()
    window.load()
    recovery = page.get_by_role("dialog", name="Something was not saved")
    recovery.get_by_text("It was never saved.").wait_for()
    assert recovery.get_by_role("button", name="Begin anew").is_visible()
    recovery.get_by_role("button", name="Take the copy").click()
    assert window.design["group"] == "p2"
    window.save()
    assert tomllib.loads(leaf.read_text(encoding="utf-8")) == window.design
    assert tomllib.loads((studio.folder / "work/bird.toml").read_text(encoding="utf-8")) == DESIGN
    copies = [json.loads(path.read_bytes()) for path in studio.folder.glob("state/**/bird-*.json")]
    assert drawn in [copy["design"]["site"][0]["strokes"] for copy in copies]

    before = window.text
    page.get_by_role("button", name="New", exact=True).click()
    page.get_by_label("Name", exact=True).fill("bird")
    page.get_by_role("button", name="Begin").click()
    page.get_by_role("dialog").get_by_text("work/bird.toml: is there already").wait_for()
    assert (window.text, page.locator("#file").inner_text()) == (before, "work/leaf.toml")

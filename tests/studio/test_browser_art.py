"""Art is drawn on every copy of its tile, can be hidden, and what is wrong with it is said."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from helpers.studio import Studio, Window, opened, running

import voronoi_tiles as vt

BAR = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="3mm" viewBox="0 0 9 3">'
    '<path d="M 0 1.5 H 9" stroke="black"/></svg>'
)
PLACE = 12 + 12j
"""Where the middle of the bar is laid, off the strokes and off the cell's lines."""

IS_DRAWN = """([x, y, drawn]) => {
    const found = ["outlines", "tiles"].map(id => document.getElementById(id)).find(canvas => !canvas.hidden);
    const box = found.getBoundingClientRect();
    const pixels = found.getContext("2d").getImageData(x - box.left - 2, y - box.top - 2, 5, 5).data;
    const dark = [];
    for (let k = 0; k < pixels.length; k += 4)
        dark.push(pixels[k + 3] / 255 * (255 - Math.max(...pixels.slice(k, k + 3))));
    return (Math.max(...dark) > 80) === drawn;
}"""


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """A studio on a design whose art is a bar."""
    folder = tmp_path_factory.mktemp("art")
    (folder / "bar.svg").write_text(BAR, encoding="utf-8")
    design = vt.starter("p4")
    site = design.sites[0]
    art = vt.Art("bar.svg", translate=PLACE - complex(4.5, 1.5))
    design.replace(sites=vt.Site(site.strokes, name=site.name, art=art), folder=folder).save(folder / "bird.toml")
    with running(folder, "bird.toml") as found:
        yield found


@pytest.fixture
def window(chromium: Any, studio: Studio) -> Iterator[Window]:
    """Its page."""
    with opened(chromium, studio, viewport={"width": 1000, "height": 700}) as found:
        found.wait()
        yield found


def see(window: Window, place: complex, *, drawn: bool = True) -> None:
    """Wait until a line is drawn at a place of the drawing, or none, on the canvas of exact outlines."""
    window.page.wait_for_function(IS_DRAWN, arg=[*window.at(place.real, place.imag), drawn], timeout=20_000)


def test_art_is_on_every_copy_and_can_be_hidden(window: Window) -> None:
    """Where the group takes it: a quarter turn about the origin, and a cell further; beside it nothing is."""
    lines = [PLACE, PLACE * 1j, PLACE + window.design["cell"]["a"]]
    for place in lines:
        see(window, place)
    see(window, PLACE + 1.2j, drawn=False)
    window.page.get_by_role("tab", name="Symmetry").click()
    window.page.get_by_role("checkbox", name="Art", exact=True).uncheck()
    for place in lines:
        see(window, place, drawn=False)
    window.page.reload()  # a habit, as all that is shown
    window.load()
    window.wait()
    window.page.wait_for_timeout(500)
    see(window, PLACE, drawn=False)
    window.page.get_by_role("tab", name="Symmetry").click()
    window.page.get_by_role("checkbox", name="Art", exact=True).check()
    see(window, PLACE)


def test_what_was_kept_before_there_was_art_shows_it(window: Window) -> None:
    """Habits of an older page, which know nothing of art, do not hide it."""
    window.page.evaluate(
        "() => localStorage.setItem('voronoi_tiles studio', JSON.stringify({ shown: { colours: true, edges: false } }))"
    )
    window.page.reload()
    window.load()
    window.wait()
    see(window, PLACE)


def test_art_that_is_gone_is_said(window: Window, studio: Studio) -> None:
    """With its file; the tile is there, and the art again with the file, after the next change."""
    file = Path(studio.folder / "bar.svg")
    text = file.read_text(encoding="utf-8")
    file.unlink()
    window.page.reload()
    window.load()
    window.wait()
    state = window.page.locator("#exact")
    state.get_by_text("proved, but without its art").wait_for()
    assert "bar.svg" in window.page.locator("#banner").inner_text()
    see(window, PLACE, drawn=False)
    file.write_text(text, encoding="utf-8")
    window.page.reload()
    window.load()
    window.wait()
    see(window, PLACE)
    assert state.inner_text() == "proved"

"""Sheets of what is selected: those of the command line, from the page's lower left corner."""

from __future__ import annotations

import json
import re
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from helpers.inkscape_drawings import LINE, PAGES, Page, run
from helpers.outlines import CommandLine

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import VoronoiTilesError
from voronoi_tiles.formats.recipe import recipe_of

SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"

CURVE = f'<path id="p" d="M 2 3 C 8 -4 15 14 24 6" {LINE}/>'

NANOMETRE = 2e-6
"""How near points are to the command line's, whose files hold nanometres; millimetres."""


def points(data: str) -> Complexes:
    """The numbers of path data as points."""
    numbers = np.array(re.findall(r"-?[\d.]+(?:e-?\d+)?", data), np.float64)
    return np.asarray(numbers[::2] + 1j * numbers[1::2])


def layers(root: ET.Element) -> dict[str, list[Complexes]]:
    """The points of the paths in each group that has paths, by its label."""
    return {
        group.get(LABEL, ""): [points(path.get("d", "")) for path in group.iterfind(f"{SVG}path")]
        for group in root.iter(f"{SVG}g")
        if group.find(f"{SVG}path") is not None
    }


@pytest.mark.parametrize("page", [PAGES[0], PAGES[2], PAGES[5]], ids=lambda page: page.name)
@pytest.mark.parametrize(
    "words",
    [("--sheet=190x150mm", "--kerf=0.2", "--fillet=0.5mm", "--labels=number"), ("--fit=frame", "--colours=fewest")],
    ids=["pieces", "the page"],
)
def test_a_sheet_is_that_of_the_command_line(
    page: Page, words: tuple[str, ...], tmp_path: Path, voronoi_tiles: CommandLine
) -> None:
    """The same design and the same options give the same paths; without a size the sheet is the page."""
    cell = ("--group=p1", "--cell=numbers", "--side_a=75", "--side_b=65", "--origin_x=11", "--origin_y=9")
    made = run(page.svg(CURVE), "--id=p", *cell, *words, entry="sheet", folder=tmp_path)
    (layer,) = ET.fromstring(made).iterfind("./*[@{urn:voronoi-tiles:recipe}role='sheet']")
    found = layers(layer)
    recipe = recipe_of(made)
    (tmp_path / "d.json").write_text(recipe["design"], encoding="utf-8")
    size = () if words[0].startswith("--sheet") else (f"--sheet={page_size(page)}",)
    done = voronoi_tiles("export", "d.json", "-o", "d.svg", *words, *size, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    root = ET.parse(tmp_path / "d.svg").getroot()
    expected, height = layers(root), float(root.get("height", "").removesuffix("mm"))
    assert [name.removeprefix("cut") for name in found] == [name.removeprefix("cut") for name in expected]
    for name, paths in expected.items():
        assert len(found[name]) == len(paths) > 0
        for one, other in zip(found[name], paths, strict=True):
            assert np.abs(page.user_mm(one) - (other.conj() + 1j * height)).max() < NANOMETRE
    assert layer.get(LABEL, "").startswith("sheet: ")
    assert {name.replace("_", "-") for name in json.loads(recipe["job"])} == {
        word[2:].partition("=")[0] for word in (*words, *size, *(("--sheet=",) if size else ()))
    }


def page_size(page: Page) -> str:
    """The size of a page as the command line takes it."""
    found = re.match(r'width="([\d.]+)mm" height="([\d.]+)mm"', page.root)
    assert found is not None
    return f"{found[1]}x{found[2]}mm"


def test_the_next_run_replaces_the_sheet_and_leaves_the_tiles(tmp_path: Path) -> None:
    """Each entry has a layer of its own."""
    cell = ("--group=p1", "--cell=numbers", "--side_a=75")
    made = run(PAGES[0].svg(CURVE), "--id=p", *cell, folder=tmp_path)
    sheet = run(made, "--id=p", *cell, "--sheet=190x150mm", entry="sheet", folder=tmp_path)
    assert sheet.startswith(made[: made.rindex(b"</svg>")])
    other = run(sheet, "--id=p", *cell, "--sheet=190x150mm", "--kerf=0.1mm", entry="sheet", folder=tmp_path)
    assert run(other, "--id=p", *cell, "--sheet=190x150mm", entry="sheet", folder=tmp_path) == sheet


def test_what_a_sheet_comes_to_is_said_in_the_dialogs_words(tmp_path: Path) -> None:
    """In the layer's description: hints name what the dialog calls them, as messages do."""
    words = ("--sheet=190x150mm", "--colours=layers", "--group=p1", "--cell=numbers", "--side_a=40")
    made = run(PAGES[0].svg(CURVE), "--id=p", *words, entry="sheet", folder=tmp_path)
    note = ET.fromstring(made).find(f".//{SVG}desc")
    assert note is not None
    assert note.text is not None
    assert '"gap: ' in note.text
    assert "`" not in note.text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--sheet=20x20mm",), "no whole tile fits on the sheet"),
        (("--kerf=wide",), "\"kerf\" 'wide' cannot be. Give a number of millimetres"),
        (("--frame=5", "--fit=clip"), '"fit: clip"'),
        (("--nonsense=5",), 'the dialog has "nonsense", which is not known here. Run "voronoi-tiles inkscape install"'),
        (("--layout=none.svg",), "none.svg"),
    ],
)
def test_what_cannot_be_is_said_in_the_dialogs_words(words: tuple[str, ...], message: str, tmp_path: Path) -> None:
    """No word of Python's arguments."""
    from voronoi_tiles.inkscape.extension import explained_error

    with pytest.raises(VoronoiTilesError) as refused:
        run(PAGES[0].svg(CURVE), "--id=p", "--group=p1", "--cell=numbers", *words, entry="sheet", folder=tmp_path)
    code, text = explained_error(refused.value)
    assert code == 2
    assert message in text
    assert "`" not in text


def test_a_page_without_a_size_needs_a_sheet(tmp_path: Path) -> None:
    """The message says what to write."""
    drawing = f'<svg xmlns="http://www.w3.org/2000/svg">{CURVE}</svg>'.encode()
    with pytest.raises(VoronoiTilesError, match="the page has no size"):
        run(drawing, "--id=p", entry="sheet", folder=tmp_path)

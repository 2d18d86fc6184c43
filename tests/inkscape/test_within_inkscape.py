"""The entries within the real Inkscape: the file that it writes is looked at, since its exit code says nothing."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from helpers.cad import missing
from helpers.cad import run as run_program
from helpers.inkscape_drawings import LINE, OBJECTS, PAGES, edges_of_path, paths_of, run

from voronoi_tiles.designs.starters import starter_text
from voronoi_tiles.inkscape.installation import FOLDER, own_files

PREFERENCES = """<inkscape version="1"><group id="extensions" {}/></inkscape>"""
"""What dialogs were left with: Inkscape hands it over, also where none is shown."""


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """The home of somebody who has installed the entries."""
    folder = tmp_path / ".config" / "inkscape" / "extensions" / FOLDER
    folder.mkdir(parents=True)
    for name, data in own_files(sys.executable, {}).items():
        (folder / name).write_bytes(data)
    return tmp_path


def test_tiles_come_into_the_drawing(home: Path) -> None:
    """The exact ones, digit for digit; the values of the dialog are taken, and what Inkscape leaks is not."""
    for program in ("xvfb-run", "xauth", "inkscape"):
        if shutil.which(program, path="/usr/bin:/bin") is None:
            missing(f"{program} is not installed")
    values = {
        "group": "p1",
        "cell": "numbers",
        "side_a": "121.5",
        "side_b": "110",
        "angle": "80",
        "origin_x": "13",
        "origin_y": "7.5",
    }
    said = " ".join(f'voronoi-tiles.tiles.{name}="{value}"' for name, value in values.items())
    (home / ".config" / "inkscape" / "preferences.xml").write_text(PREFERENCES.format(said), encoding="utf-8")
    page = PAGES[2]
    other = f'<path id="other" OWN {LINE} d="M 3 60 L 20 66"/>'
    drawing = page.svg(f'<g id="two">{other}</g>' + OBJECTS["cubics"].element)
    (home / "in.svg").write_bytes(drawing)
    actions = "select-by-id:cubics,two;voronoi-tiles.tiles.noprefs;export-filename:out.svg;export-do"
    words = ("timeout", "50", "xvfb-run", "-a", "inkscape", "--batch-process", f"--actions={actions}", "in.svg")
    done = run_program(*words, cwd=home, home=home)
    made = (home / "out.svg").read_bytes()
    assert b"vt:role" in made, done.stderr
    expected = run(
        drawing, "--id=cubics", "--id=two", *[f"--{name}={value}" for name, value in values.items()], folder=home
    )
    assert paths_of(made) == paths_of(expected)
    assert len(paths_of(made)) == 2
    kept = ET.fromstring(made).find(".//*[@id='cubics']")
    assert kept is not None
    assert kept.get("d", "none") in OBJECTS["cubics"].element


def test_designs_are_opened(home: Path) -> None:
    """A design file is a drawing, with its strokes, cell and tiles; SVG files are what they were."""
    (home / "design.toml").write_text(starter_text("p4"), encoding="utf-8")
    (home / "plain.svg").write_bytes(PAGES[0].svg(OBJECTS["line"].element))
    for name in ("design.toml", "plain.svg"):
        run_program("inkscape", "--export-type=svg", f"--export-filename={name}.svg", name, cwd=home, home=home)
    made = ET.parse(home / "design.toml.svg").getroot()
    assert made.find(".//*[@id='voronoi-strokes']") is not None
    (tile,) = paths_of((home / "design.toml.svg").read_bytes()).values()
    assert len(edges_of_path(tile)) > 100
    again = (home / "plain.svg.svg").read_bytes()
    assert b"voronoi" not in again
    assert b'id="line"' in again

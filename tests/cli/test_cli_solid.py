"""The command `solid`: files, what is said of them, and what is refused with one message and nothing written."""

from __future__ import annotations

import io
import json
import re
import zipfile
from pathlib import Path

import pytest
from helpers.outlines import CommandLine

from voronoi_tiles.designs.starters import starter_text
from voronoi_tiles.formats.recipe import recipe_of


@pytest.fixture
def here(tmp_path: Path) -> Path:
    """A folder with a design."""
    (tmp_path / "bird.toml").write_text(starter_text("p4"), encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("name", ["a.3mf", "a.stl", "a.png"])
def test_a_file_is_written_and_said(name: str, here: Path, voronoi_tiles: CommandLine) -> None:
    """What there is in it, and what was proved; the same bytes again, and nothing is said, with --quiet."""
    size = ("--size", "90") if name == "a.png" else ()
    call = ("solid", "bird.toml", "--height", "4mm", "--clearance", "0.2mm", *size)
    done = voronoi_tiles(*call, "-o", name, cwd=here)
    assert (done.returncode, done.stdout) == (0, "")
    *notes, written, proved = done.stderr.splitlines()
    assert notes == (["neighbours and the room between them are for the picture alone"] if name == "a.png" else [])
    assert written.startswith(f"wrote {name}: ")
    assert "x 4 mm" in written
    assert proved.startswith("proved: closed; volumes within ")
    assert proved.endswith("mm apart, before they are pulled apart" if name == "a.png" else "mm apart")
    again = voronoi_tiles(*call, "-o", f"b{Path(name).suffix}", "--quiet", cwd=here)
    assert (again.returncode, again.stderr) == (0, "")
    assert (here / f"b{Path(name).suffix}").read_bytes() == (here / name).read_bytes()


def test_the_recipe_says_what_was_asked(here: Path, voronoi_tiles: CommandLine) -> None:
    """Scaled as well: the design is that which was made."""
    call = ("solid", "bird.toml", "-o", "a.3mf", "--tile-width", "50mm", "--chamfer", "0.5", "--sheet", "200x200mm")
    assert voronoi_tiles(*call, "--colors", "fewest", cwd=here).returncode == 0
    data = (here / "a.3mf").read_bytes()
    assert json.loads(recipe_of(data)["solid"]) == {"chamfer": 0.5, "sheet": [200.0, 200.0], "colours": "fewest"}
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        assert package.namelist() == ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("-o", "a.step"), "Error: a.step is no name of such a file: give it the suffix .3mf or .stl or .png."),
        (("-o", "a.3mf", "--height", "0"), "Error: --height 0 mm cannot be. Give a length from 0.01 to 100,000 mm."),
        (("-o", "a.3mf", "--clearance", "80mm"), "Error: bird.toml: --clearance 80mm is too much: a piece vanishes at"),
        (("-o", "a.3mf", "--chamfer", "2mm"), "Error: bird.toml: two rims with --chamfer 2mm leave nothing of a"),
        (("-o", "a.3mf", "--sheet", "5x5mm"), "Error: bird.toml: no whole tile fits on the sheet"),
        (("-o", "a.3mf", "--size", "90"), "Error: --size is for a picture: write a .png, or leave it out."),
        (("-o", "a.3mf", "--colours", "layers"), "Error: --colours 'layers' is unknown. Use a number up to"),
        (("-o", "none/a.3mf"), "Error: bird.toml: cannot write none/a.3mf: "),
        (("-o", "-"), "Error: On standard output the format is not clear: add --format 3mf, stl or png."),
        (("-o", "bird.toml", "--format", "stl"), "Error: bird.toml is no name of such a file"),
        (("-o", "/dev/full", "--format", "stl"), "Error: bird.toml: cannot write /dev/full: No space left on device."),
    ],
)
def test_what_cannot_be_is_refused(
    options: tuple[str, ...], message: str, here: Path, voronoi_tiles: CommandLine
) -> None:
    """One message, exit code 2, nothing written."""
    done = voronoi_tiles("solid", "bird.toml", *options, cwd=here)
    assert done.returncode == 2
    assert done.stderr.startswith(message)
    assert done.stderr.count("\n") == 1
    assert [path.name for path in here.iterdir()] == ["bird.toml"]


def test_a_report_is_printed(here: Path, voronoi_tiles: CommandLine) -> None:
    """As a table, and as JSON, with the density that is given."""
    call = ("solid", "bird.toml", "-o", "a.stl", "--height", "10mm")
    table = voronoi_tiles(*call, "--report", cwd=here)
    assert table.returncode == 0
    assert "9 cm³" in table.stdout
    assert "11.16 g, solid, at 1.24 g/cm³" in table.stdout
    figures = json.loads(voronoi_tiles(*call, "--json", "--density", "2", "--quiet", cwd=here).stdout)
    assert figures["volume"] == pytest.approx(9000.0)
    assert figures["mass"] == pytest.approx(18.0)
    assert figures["proof"]["closed"] is True
    # What a picture shows beside it is not counted.
    pictured = voronoi_tiles("solid", "bird.toml", "-o", "a.png", "--size", "60", *call[4:], "--json", cwd=here)
    counted = json.loads(pictured.stdout)
    assert [row["count"] for row in counted["solids"]] == [1]
    assert counted["volume"] == pytest.approx(9000.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("-o", "a.stl", "--density", "2"), "--density is for the mass"),
        (("-o", "-", "--format", "stl", "--json"), "The report goes to standard output"),
    ],
)
def test_a_report_that_has_no_place_is_refused(
    options: tuple[str, ...], message: str, here: Path, voronoi_tiles: CommandLine
) -> None:
    """Exit code 2, nothing written."""
    done = voronoi_tiles("solid", "bird.toml", *options, cwd=here)
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr
    assert [path.name for path in here.iterdir()] == ["bird.toml"]


def test_a_design_that_stands_is_lofted(here: Path, voronoi_tiles: CommandLine) -> None:
    """Its height is its own; what only prisms have is refused."""
    standing = starter_text("p4") + "\n[solid]\nheight = 12\nlayers = 3\nshift = [2, 1]\n"
    (here / "standing.toml").write_text(standing, encoding="utf-8")
    done = voronoi_tiles("solid", "standing.toml", "-o", "a.3mf", cwd=here)
    assert done.returncode == 0, done.stderr
    assert "x 12 mm, 10.8 cm³" in done.stderr
    assert " levels within" in done.stderr
    refused = voronoi_tiles("solid", "standing.toml", "-o", "b.3mf", "--sheet", "90x90mm", cwd=here)
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: standing.toml: --sheet is for prisms")
    assert not (here / "b.3mf").exists()


def test_a_design_that_stands_has_clearances(here: Path, voronoi_tiles: CommandLine) -> None:
    """The proof says how far neighbours are apart; one that eats the tile is refused, and nothing is written."""
    standing = starter_text("p4") + "\n[solid]\nheight = 12\nlayers = 3\nshift = [2, 1]\n"
    (here / "standing.toml").write_text(standing, encoding="utf-8")
    done = voronoi_tiles("solid", "standing.toml", "-o", "a.3mf", "--clearance", "0.2mm", "--chamfer", "2mm", cwd=here)
    assert done.returncode == 0, done.stderr
    assert "proved: closed; neighbours at least 0.2" in done.stderr
    assert json.loads(recipe_of((here / "a.3mf").read_bytes())["solid"]) == {"chamfer": 2.0, "clearance": 0.2}
    refused = voronoi_tiles("solid", "standing.toml", "-o", "b.3mf", "--clearance", "60mm", cwd=here)
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: standing.toml: --clearance 60mm is too much: nothing is left at")
    assert not (here / "b.3mf").exists()


STANDING = starter_text("p4") + "\n[solid]\nheight = 12\nlayers = 3\nshift = [2, 1]\n"


def test_a_stack_is_cut(here: Path, voronoi_tiles: CommandLine) -> None:
    """A file for each sheet, with its recipe; how thick they are and where dowels go is said, and reported."""
    (here / "standing.toml").write_text(STANDING, encoding="utf-8")
    call = ("solid", "standing.toml", "--sheets", "3", "-o", "a.svg", "--dowel", "2mm", "--kerf", "0.1mm")
    done = voronoi_tiles(*call, "--json", "--density", "0.5", cwd=here)
    assert done.returncode == 0, done.stderr
    *written, said = done.stderr.splitlines()
    assert [line.partition(":")[0] for line in written] == [f"wrote a-{k}.svg" for k in (1, 2, 3)]
    assert said.startswith("3 sheets, 1 the lowest, each 4 mm thick; 2 holes in a tile, ")
    assert said.endswith(" mm apart, for dowels of 2 mm, 12 mm long")
    figures = json.loads(done.stdout)
    assert [row["middle"] for row in figures["sheets"]] == [2.0, 6.0, 10.0]
    assert figures["mass"] == pytest.approx((900 - 2 * 3.14159265) * 12 / 1000 * 0.5)
    again = voronoi_tiles(*call, "--json", cwd=here)
    assert json.loads(again.stdout)["density"] == 0.68
    recipe = recipe_of((here / "a-2.svg").read_bytes())
    assert json.loads(recipe["stack"]) == {"sheets": 3, "dowel": 2.0, "kerf": 0.1, "number": 2}


def test_a_stack_is_a_solid(here: Path, voronoi_tiles: CommandLine) -> None:
    """An object for each sheet, and a table of them."""
    (here / "standing.toml").write_text(STANDING, encoding="utf-8")
    done = voronoi_tiles("solid", "standing.toml", "--sheets", "3", "-o", "a.3mf", "--report", cwd=here)
    assert done.returncode == 0, done.stderr
    assert "wrote a.3mf: 3 solids, " in done.stderr
    assert "x 12 mm, 10.8 cm³" in done.stderr
    assert "12 mm high, of sheets of 4 mm" in done.stdout


def test_stacks_fill_boards(here: Path, voronoi_tiles: CommandLine) -> None:
    """How many there are is said and reported, in volume as well; the recipe has all that was asked."""
    (here / "standing.toml").write_text(STANDING, encoding="utf-8")
    call = ("solid", "standing.toml", "--sheets", "3", "-o", "a.dxf", "--sheet", "200x150mm", "--kerf", "0.1mm")
    done = voronoi_tiles(*call, "--fillet", "0.5mm", "--marks", "--margin", "8mm", "--report", cwd=here)
    assert done.returncode == 0, done.stderr
    *written, said = done.stderr.splitlines()
    counts = [re.match(r"wrote a-(\d)\.dxf: (\d+) pieces, ", line) for line in written]
    assert [found and found[1] for found in counts] == ["1", "2", "3"]
    (stacks,) = {found and found[2] for found in counts}
    assert said == f"3 sheets, 1 the lowest, each 4 mm thick: {stacks} stacks, pieces are numbered sheet.stack"
    assert f"{stacks} bird" in done.stdout
    assert f"{int(stacks or 0) * 900 * 12 / 1000:.4g} cm³" in done.stdout
    asked = json.loads(recipe_of((here / "a-3.dxf").read_bytes())["stack"])
    assert asked == {
        "sheets": 3,
        "sheet": [200.0, 150.0],
        "kerf": 0.1,
        "fillet": 0.5,
        "marks": True,
        "margin": 8.0,
        "number": 3,
    }


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("-o", "a.svg", "--sheets", "3", "--frame", "5mm"), "Error: --frame is about a sheet, and there is none."),
        (("-o", "a.svg", "--sheets", "0"), "Error: --sheets 0 cannot be."),
        (("-o", "a.svg", "--sheets", "3", "--clearance", "1mm"), "Error: --clearance is for printing, and --sheets"),
        (("-o", "a.3mf", "--dowel", "1mm"), "Error: --dowel is for sheets that are cut, and there are none."),
        (("-o", "a.svg", "--sheets", "3"), "Error: bird.toml: the design is flat. Write [solid] and, below it,"),
        (("-o", "a.svg"), "Error: Files to cut are of sheets: add --sheets 7"),
    ],
)
def test_a_stack_that_cannot_be_is_refused(
    options: tuple[str, ...], message: str, here: Path, voronoi_tiles: CommandLine
) -> None:
    """One message, exit code 2, nothing written."""
    test_what_cannot_be_is_refused(options, message, here, voronoi_tiles)

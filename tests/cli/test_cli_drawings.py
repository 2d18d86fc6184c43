"""Drawings as designs, and the size of designs, as a user meets them on the command line."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
from pathlib import Path

import ezdxf
import pytest
from helpers.outlines import CommandLine

import voronoi_tiles as vt

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="80mm" height="70mm" viewBox="0 0 80 70">'
DRAWINGS = {
    "leaf.svg": '<path d="M10 50 C 10 20 40 5 70 8 C 72 35 45 55 10 50 Z" fill="none" stroke="black"/>',
    "squiggle.svg": '<path d="M5 30 C 15 0 25 60 35 25 S 50 5 55 40" fill="none" stroke="black"/>',
    "letter.svg": '<path fill-rule="evenodd" d="M5 65L20 5H30L45 65H36L33 50H17L14 65ZM19 42H31L25 18Z"/>',
    "cat.svg": '<g fill="none" stroke="black"><circle cx="30" cy="34" r="20"/><path d="M13 24 L10 5 L24 15"/>'
    '<path d="M47 24L50 5L36 15"/><circle id="eye" cx="23" cy="30" r="3"/><circle cx="37" cy="30" r="3"/>'
    '<path d="M22 42 Q 30 50 38 42"/></g>',
}


def write(folder: Path) -> None:
    """Some drawings of different kinds."""
    for name, content in DRAWINGS.items():
        (folder / name).write_text(f"{HEAD}{content}</svg>")
    document = ezdxf.new(units=ezdxf.units.MM)
    points = [(0, 0, 0, 0, 0), (40, 0, 0, 0, 1), (40, 20, 0, 0, 0), (0, 20, 0, 0, 0.3)]
    document.modelspace().add_lwpolyline(points, close=True, format="xyseb")
    document.modelspace().add_circle((40, 10), 4)
    document.saveas(folder / "part.dxf")


def fails(result: subprocess.CompletedProcess[str]) -> str:
    """The message of a run that was refused."""
    assert (result.returncode, result.stdout) == (2, "")
    (line,) = result.stderr.splitlines()
    return line


def test_a_drawing_becomes_a_design(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """Commented, beside the drawing or elsewhere; what its first lines show exports it; nothing is overwritten."""
    write(tmp_path)
    (tmp_path / "designs").mkdir()
    for output in ("leaf.toml", "designs/leaf.toml"):
        result = voronoi_tiles("new", "p3", "--from", "leaf.svg", "-o", output, cwd=tmp_path)
        assert (result.returncode, result.stdout) == (0, "")
        assert re.fullmatch(r"leaf\.svg is 60\.1 x 43\.14 mm, in a cell of a = [\d.]+\n", result.stderr)
        design = vt.Design.load(tmp_path / output)
        assert [site.name for site in design.sites] == ["leaf"]
        assert Path(design.files[1]).resolve() == tmp_path / "leaf.svg"
        command = shlex.split((tmp_path / output).read_text().splitlines()[1].split("voronoi-tiles ")[1])
        assert voronoi_tiles(*command, cwd=(tmp_path / output).parent).returncode == 0
    assert vt.Design.load(tmp_path / "leaf.toml") == vt.Design.load(tmp_path / "designs/leaf.toml")
    assert "exists already" in fails(voronoi_tiles("new", "p3", "--from", "leaf.svg", "-o", "leaf.toml", cwd=tmp_path))
    eye = voronoi_tiles("new", "p4m", "--from", "cat.svg", "--id", "eye", cwd=tmp_path)
    assert 'id = "eye"' in eye.stdout
    assert "polygon between the mirrors" in eye.stderr


def test_what_is_no_drawing_is_refused(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """By its name as it was given, and nothing is written."""
    write(tmp_path)
    (tmp_path / "d.toml").write_text("schema = 1\n")
    new = ("new", "p4", "-o", "new.toml")
    for options, message in (
        (("--from", "none.svg"), "none.svg: cannot be read"),
        (("--from", "d.toml"), "d.toml: neither an SVG nor a DXF file"),
        (("--from", "leaf.svg", "--layer", "rim"), "no layer or colour 'rim'"),
        (("--from", "leaf.svg", "--id", "rim"), "no element with the id 'rim'"),
        (("--from", "-"), "needs a file"),
        (("--from", "/dev/stdin"), "needs a file"),
        (("--from", "leaf.svg", "--layer", ""), "layer: is empty"),
        (("--from", "leaf.svg", "--id", ""), "id: is empty"),
        (("--id", "rim"), "add --from"),
        (("--from", "leaf.svg", "--fill", "d.toml"), "give one"),
        (("--fill", "d.toml"), "d.toml, group: is missing"),
        (("--fill", "leaf.svg"), "leaf.svg: is a drawing, not a design"),
    ):
        assert message in fails(voronoi_tiles(*new, *options, cwd=tmp_path)), options
    assert not (tmp_path / "new.toml").exists()


def test_a_drawing_given_as_a_design_says_what_to_do(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """By its suffix or its content, and the command that the message shows does it."""
    write(tmp_path)
    (tmp_path / "my leaf").write_bytes((tmp_path / "leaf.svg").read_bytes())
    for name in ("part.dxf", "my leaf"):
        message = fails(voronoi_tiles("export", name, "-o", "tile.svg", cwd=tmp_path))
        shown = re.search(r"is a drawing, not a design\. Make a design of it: voronoi-tiles (.*)$", message)
        assert shown
        assert voronoi_tiles(*shlex.split(shown[1]), cwd=tmp_path).returncode == 0
    assert "is a drawing" in fails(voronoi_tiles("info", "-", stdin=(tmp_path / "leaf.svg").read_text()))


def test_strokes_that_touch_are_placed(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """The error names the command that finds a place."""
    (tmp_path / "d.toml").write_text(
        'schema = 1\ngroup = "p4"\ncell = { a = 60 }\n[[site]]\nstrokes = [{ segment = [[-9, 1], [25, 4]] }]\n'
    )
    assert "new GROUP --fill DESIGN" in fails(voronoi_tiles("info", "d.toml", cwd=tmp_path))
    assert voronoi_tiles("new", "p4", "--fill", "d.toml", "-o", "e.toml", cwd=tmp_path).returncode == 0
    assert voronoi_tiles("info", "e.toml", cwd=tmp_path).returncode == 0
    placed = voronoi_tiles("new", "pgg", "--fill", "-", stdin=(tmp_path / "d.toml").read_text()).stdout
    assert vt.Design.loads(placed).tessellate().proof.passed


def test_notes_of_drawings_are_said(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """By every command that uses the design, but in a quiet one."""
    (tmp_path / "leaf.svg").write_text(f"{HEAD}{DRAWINGS['leaf.svg']}<text>leaf</text></svg>")
    assert "text (1)" in voronoi_tiles("new", "p4", "--from", "leaf.svg", "-o", "leaf.toml", cwd=tmp_path).stderr
    for command in ("info leaf.toml", "export leaf.toml -o tile.svg", "render leaf.toml -o tile.png --size 64"):
        assert "leaf.svg: left out what is no path: text (1)" in voronoi_tiles(*command.split(), cwd=tmp_path).stderr
    assert voronoi_tiles("export", "leaf.toml", "-o", "tile.svg", "--quiet", cwd=tmp_path).stderr == ""


def test_the_size_of_a_design(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """A factor, or the size of the tile, for every command that reads a design."""
    vt.starter("p4").replace(units="cm").save(tmp_path / "bird.toml")

    def cell(*options: str) -> float:
        result = voronoi_tiles("info", "bird.toml", "--json", *options, cwd=tmp_path)
        return float(json.loads(result.stdout)["cell"]["a"][0])

    assert cell("--scale", "1.5") == 90
    result = voronoi_tiles("export", "bird.toml", "-o", "-", "--format", "json", "--tile-width", "95mm", cwd=tmp_path)
    points = [point for arc in json.loads(result.stdout)["tiles"][0]["rings"][0] for point in arc["points"]]
    lines = [x for x, _ in points]
    assert 9.5 <= max(lines) - min(lines) < 9.6  # control points are a little outside
    assert cell("--tile-height", "10in") > 30
    for command in ("check bird.toml", "render bird.toml -o a.png", "report bird.toml", "template bird.toml -o a.svg"):
        assert "Give one of" in fails(
            voronoi_tiles(*command.split(), "--scale", "2", "--tile-width", "5", cwd=tmp_path)
        )
    for options in (
        ("--scale", "0"),
        ("--scale", "nan"),
        ("--scale", "-2"),
        ("--tile-width", "0"),
        ("--tile-width", "x"),
    ):
        fails(voronoi_tiles("info", "bird.toml", *options, cwd=tmp_path))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("drawing", "group"),
    [("leaf.svg", "p2"), ("squiggle.svg", "pg"), ("letter.svg", "p4"), ("cat.svg", "p3"), ("part.dxf", "p2")],
)
def test_three_commands_from_a_drawing_to_a_sheet(
    drawing: str, group: str, voronoi_tiles: CommandLine, tmp_path: Path
) -> None:
    """From a drawing to tiles that can be cut, without a number edited, in groups without mirrors."""
    write(tmp_path)
    for command in (
        f"new {group} --from {drawing} -o tile.toml",
        "export tile.toml -o sheet.svg --sheet 600x300mm --kerf 0.15mm",
        "preflight sheet.svg",
    ):
        result = voronoi_tiles(*command.split(), cwd=tmp_path)
        assert result.returncode == 0, (command, result.stderr)
    assert vt.preflight(tmp_path / "sheet.svg").passed
    pieces = len(re.findall("<path", (tmp_path / "sheet.svg").read_text()))
    assert pieces > 10

"""The command `fit`: a folder of designs, their art on the tile, and nothing half written."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import shapely
from click.testing import CliRunner, Result

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import plane
from voronoi_tiles.cli.main import cli
from voronoi_tiles.escherization import fits
from voronoi_tiles.formats.reading import read_drawing
from voronoi_tiles.pictures.contact_sheet import ContactSheet

BIRD = Path(__file__).parents[2] / "examples" / "fit" / "bird.svg"
FEW = ("--groups", "p2", "--keep", "2", "--workers", "1")


def run(*arguments: str | Path) -> Result:
    """Run `voronoi-tiles fit` in this process."""
    return CliRunner().invoke(cli, ["fit", *map(str, arguments)])


@pytest.fixture(scope="module")
def birds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two designs of the bird, 80 mm long."""
    folder = tmp_path_factory.mktemp("fits") / "birds"
    result = run(BIRD, "-o", folder, "--size", "80mm", *FEW)
    assert result.exit_code == 0, result.output
    assert "1. p2" in result.output
    return folder


def test_a_folder_has_designs_pictures_a_table_and_a_sheet(birds: Path) -> None:
    """And nothing else; the table says of each what its design is, the best first."""
    names = {"1-p2", "2-p2"}
    files = {f"{name}{suffix}" for name in names for suffix in (".toml", ".png", "-art.svg")}
    assert {path.name for path in birds.iterdir()} == files | {"fits.csv", "index.json", "sheet.html", "sheet.png"}
    with (birds / "fits.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    index = json.loads((birds / "index.json").read_text(encoding="utf-8"))
    assert [{key: str(value) for key, value in row.items()} for row in index] == rows
    assert {"design", "group", "overlap", "distance_mm", "strokes"} <= set(index[0])
    assert [row["design"] for row in rows] == ["1-p2.toml", "2-p2.toml"]
    for row in rows:
        tile = vt.Design.load(birds / row["design"]).tessellate()[0]
        left, bottom, right, top = tile.bounds
        assert (float(row["width_mm"]), float(row["height_mm"])) == pytest.approx(
            (right - left, top - bottom), abs=1e-3
        )
        assert int(row["neighbours"]) == len(tile.outline.neighbours)
        assert row["design"] in (birds / "sheet.html").read_text(encoding="utf-8")
    assert float(rows[0]["overlap"]) >= float(rows[1]["overlap"]) > 0.8


def test_art_goes_with_the_outline_onto_the_tile(birds: Path) -> None:
    """The bird's eye lies within its tile, and as far from the others as they are drawn; the size is that asked for."""
    design = vt.Design.load(birds / "1-p2.toml")
    tile = design.tessellate()[0].to_shapely(accuracy=0.01)
    (art,) = [each for each in design.art if each is not None]
    unit, shift, conj = art.placement.similarity
    assert not conj
    drawing = read_drawing(birds / art.file)
    points = [shape.paths.moved(unit, shift).start for shape in drawing.shapes if shape.layer != "guide"]
    assert len(points) > 3
    for each in points:
        assert shapely.contains_xy(tile.buffer(1.0), *plane(each).T).all()
    given = read_drawing(BIRD).shapes[0].paths.bounds
    scale = 80.0 / max(given[2] - given[0], given[3] - given[1])
    assert abs(unit) == pytest.approx(scale, rel=1e-3)
    sheet = ("-o", str(birds.parent / "sheet.svg"), "--sheet", "300x200mm", "--kerf", "0.15mm")
    exported = CliRunner().invoke(cli, ["export", str(birds / "1-p2.toml"), *sheet])
    assert exported.exit_code == 0, exported.output


def test_a_folder_that_holds_anything_is_left_alone(birds: Path, tmp_path: Path) -> None:
    """Before anything is computed; an empty one is filled."""
    before = {path.name: path.read_bytes() for path in birds.iterdir()}
    result = run(BIRD, "-o", birds, *FEW)
    assert (result.exit_code, "exists already" in result.output) == (2, True)
    assert {path.name: path.read_bytes() for path in birds.iterdir()} == before
    assert run(BIRD, "-o", tmp_path, *FEW, "--strokes", "outline", "-q").output == ""
    assert len(list(tmp_path.glob("*.toml"))) == 2


def test_nothing_is_left_of_what_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A full disk at the last picture leaves no folder, and nothing beside it."""

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(ContactSheet, "save", full)
    result = run(BIRD, "-o", tmp_path / "birds", *FEW, "--strokes", "outline")
    assert (result.exit_code, "No space left" in result.output) == (2, True)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--groups", "p9"), "p9"),
        (("--groups", "pg", "--mirrored", "no"), "--groups"),
        (("--symmetric",), "leave out --symmetric"),
        (("--within", "-1mm"), "--within"),
        (("--keep", "0"), "--keep"),
        (("--workers", "0"), "--workers"),
        (("--size", "0mm"), "--size"),
        (("--element", "wing"), "'wing'"),
    ],
)
def test_what_cannot_be_asked_for_is_said(tmp_path: Path, arguments: tuple[str, ...], said: str) -> None:
    """By the option's name, and no folder is made."""
    result = run(BIRD, "-o", tmp_path / "birds", *arguments)
    assert (result.exit_code, said in result.output) == (2, True), result.output
    assert list(tmp_path.iterdir()) == []


def test_no_folder_is_made_where_nothing_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As where all tiles of a group are of several pieces; the option that helps is named."""
    monkeypatch.setattr(fits, "tiled", lambda _: None)
    result = run(BIRD, "-o", tmp_path / "birds", "--groups", "p1", "--workers", "1")
    assert (result.exit_code, "--groups" in result.output) == (2, True), result.output
    assert list(tmp_path.iterdir()) == []


def test_what_is_no_drawing_is_said(tmp_path: Path) -> None:
    """A missing file, and a picture of pixels."""
    assert "No such file" in run(tmp_path / "owl.svg", "-o", tmp_path / "owls").output
    (tmp_path / "owl.png").write_bytes(b"\xff\xd8\xff" + bytes(60))
    assert "Trace" in run(tmp_path / "owl.png", "-o", tmp_path / "owls").output
    assert np.all([path.suffix == ".png" for path in tmp_path.iterdir()])

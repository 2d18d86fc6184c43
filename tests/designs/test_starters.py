"""The starter designs: one for each group, readable, and ready to export."""

from __future__ import annotations

import tomllib
from itertools import pairwise
from pathlib import Path

import pytest

import voronoi_tiles as vt
from voronoi_tiles import Design, DesignError, Operation, OutputError
from voronoi_tiles.designs.starters import GROUP_NAMES, starter, starter_text
from voronoi_tiles.groups.wallpaper import GROUPS


def test_every_group_has_a_starter() -> None:
    """The same groups, in the same order, as the table of groups."""
    assert tuple(GROUPS) == GROUP_NAMES


@pytest.mark.parametrize("group", GROUP_NAMES)
def test_a_starter_explains_itself(group: str) -> None:
    """Every key and every stroke has its comment; no line needs scrolling."""
    text = starter_text(group)
    data = tomllib.loads(text)
    assert data["group"] == group
    assert data["schema"] == 1
    lines = text.splitlines()
    assert max(map(len, lines)) <= 110
    for before, line in pairwise(lines):
        if line.startswith("  {"):
            assert before.startswith("  #")
        elif "=" in line and not line.startswith(("#", "group", "schema", "name")):
            assert "#" in line, line


@pytest.mark.parametrize("group", GROUP_NAMES)
def test_a_starter_exports_as_it_is(group: str, tmp_path: Path) -> None:
    """It loads, passes its proof, and its tiles are curved: worth cutting."""
    tiling = Design.loads(starter_text(group)).tessellate()
    assert tiling.proof.passed
    covered = sum(tile.area * tile.copies_per_cell for tile in tiling.tiles)
    assert covered == pytest.approx(tiling.design.lattice.det, rel=1e-12)
    assert any(tile.outline.curved.any() for tile in tiling.tiles)
    tiling.export(tmp_path / f"{group}.svg")
    tiling.export(tmp_path / f"{group}.json")


def test_a_tile_has_the_interfaces_of_scripts(tmp_path: Path) -> None:
    """Path data, a polygon, a picture, a copy; and files only of the formats that there are."""
    tiling = Design.loads(starter_text("p4"), name="p4").tessellate()
    (tile,) = tiling.tiles
    assert tile.svg_path().count("Q") == tile.outline.curved.sum()
    polygon = tile.to_shapely(accuracy=0.001)
    assert polygon.is_valid
    assert polygon.area == pytest.approx(tile.area, rel=1e-3)
    assert polygon.length == pytest.approx(tile.perimeter, rel=1e-3)
    assert tile._repr_svg_().startswith("<?xml")
    turned = tile.copy(Operation.parse("-y,x"))
    assert turned.area == pytest.approx(tile.area, rel=1e-12)
    assert tiling.document()["tiles"][0]["site"] == tiling.figures()["tiles"][0]["site"] == "bird"
    with pytest.raises(OutputError, match=r"\.svg or \.json"):
        tiling.export(tmp_path / "bird.png")
    with pytest.raises(ValueError, match="no text can be made as 'png'"):
        tiling.text("png")
    assert list(tmp_path.iterdir()) == []


def test_tiles_show_themselves_in_a_line() -> None:
    """No arrays: repr() is for a terminal."""
    tiling = Design.loads(starter_text("p4"), name="p4").tessellate()
    (tile,) = tiling.tiles
    assert repr(tile) == f"<Tile 'bird': {len(tile.outline)} edges, 4 copies per cell>"
    assert repr(tiling) == "<Tiling 'p4': p4, 1 tile>"


@pytest.mark.parametrize(
    ("file", "command"),
    [
        (None, "export p4.toml -o p4.svg"),
        ("designs/bird.toml", "export bird.toml -o bird.svg"),
        ("my bird.toml", "export 'my bird.toml' -o 'my bird.svg'"),
        ("a\nb.toml", "export p4.toml -o p4.svg"),
    ],
)
def test_a_starter_names_its_own_file(file: str | None, command: str) -> None:
    """The command in its head works where the file lies."""
    text = starter_text("p4", file)
    assert text.splitlines()[1] == f"# Export it:  voronoi-tiles {command}"
    assert tomllib.loads(text)["group"] == "p4"


def test_the_public_names_are_loaded_on_first_use() -> None:
    """Each of them exists, and no other."""
    for name in vt.__all__:
        assert getattr(vt, name) is not None
        assert name in dir(vt)
    with pytest.raises(AttributeError, match="no attribute 'Tilng'"):
        _ = vt.Tilng


def test_unknown_groups_have_none() -> None:
    """The error names the group, and those that there are."""
    for make in (starter, starter_text):
        with pytest.raises(DesignError, match=r"unknown wallpaper group 'p5'.*p1, p2"):
            make("p5")
        with pytest.raises(DesignError, match='Did you mean "p4m"'):
            make("p4mm")


@pytest.mark.parametrize("group", GROUP_NAMES)
def test_a_starter_is_the_design_of_its_text(group: str) -> None:
    """By the name of its group."""
    assert starter(group) == Design.loads(starter_text(group))
    assert (starter(group).name, starter(group).group) == (group, GROUPS[group])

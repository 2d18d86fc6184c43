"""A drawing in all other groups: it stays where it is if it can, and is always one that exports."""

from __future__ import annotations

import json

import pytest

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.studio.grouping import group_message

START = starter("p4").to_dict()


@pytest.mark.parametrize(
    "group", [name if name in ("p1", "pmm", "p3") else pytest.param(name, marks=pytest.mark.slow) for name in GROUPS]
)
def test_a_drawing_goes_into_every_group(group: str) -> None:
    """As a design of that group whose tiles fill its cell, with a path and all its copies for the thumbnail."""
    message = json.loads(json.dumps(group_message(5, START, group), allow_nan=False))
    assert (message["type"], message["rev"], message["group"]) == ("group", 5, group)
    design = Design.from_dict(message["design"])
    assert design.group.name == group
    assert message["lattice"] == {
        "a": [design.lattice.a.real, design.lattice.a.imag],
        "b": [design.lattice.b.real, design.lattice.b.imag],
    }
    tiles = design.tessellate()
    for sent, tile in zip(message["tiles"], tiles, strict=True):
        assert len(sent["operations"]) == tile.copies_per_cell
        assert sent["path"].count("Z") == len(tile.outline.ring_areas)
    strokes = [site["strokes"] for site in message["design"]["site"]]
    assert strokes == json.loads(json.dumps([site["strokes"] for site in START["site"]]))  # placed, not redrawn


def test_what_keeps_apart_stays() -> None:
    """In a group where the copies do not touch, strokes and sides of the cell are the same, and angles are the old."""
    for group, cell in (("p2", {"a": 60, "b": 60, "angle": 90}), ("pgg", {"a": 60, "b": 60}), ("p4g", None)):
        found = group_message(1, START, group)["design"]
        assert ("translate" in found["site"][0]) is (cell is None)
        assert cell in (None, found["cell"])
    hexagonal = group_message(1, starter("p3").to_dict(), "p1")["design"]
    assert hexagonal["cell"] == {"a": 60, "b": 60, "angle": 120}
    oblique = group_message(1, starter("p1").to_dict(), "p2")["design"]
    assert oblique["cell"] == {"a": 60, "b": 50, "angle": 75}


def test_the_scale_stays() -> None:
    """A design that is scaled has the same strokes, and twice the lattice."""
    small, large = (group_message(1, {**START, "scale": scale}, "p2") for scale in (1.0, 2.0))
    assert (large["scale"], large["design"]["scale"]) == (2.0, 2.0)
    assert large["design"]["site"] == small["design"]["site"]
    assert large["lattice"]["a"] == [2 * part for part in small["lattice"]["a"]]


def test_a_broken_design_is_refused() -> None:
    """By the key that is wrong."""
    with pytest.raises(DesignError) as caught:
        group_message(1, {**START, "cell": {}}, "p1")
    assert caught.value.key == "cell.a"

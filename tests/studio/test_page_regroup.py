"""Another group for the same drawing, as the page has it: what it makes is a design that the engine tiles."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest
from helpers.page import TESTS, node

import voronoi_tiles as vt
from voronoi_tiles.designs.starters import GROUP_NAMES
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.studio.tables import group_document

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))


@pytest.fixture(scope="module")
def tables() -> dict[str, Any]:
    """The groups as the page knows them."""
    return {"groups": [group_document(group) for group in GROUPS.values()]}


def call(module: str, name: str, calls: list[list[Any]]) -> list[Any]:
    """What a function of the model gives for each list of arguments."""
    asked = json.dumps({"module": module, "name": name, "calls": calls})
    command = [node(), str(TESTS / "page" / "call.js")]
    done = subprocess.run(command, input=asked, capture_output=True, encoding="utf-8", timeout=600, check=True)
    found: list[Any] = json.loads(done.stdout)
    return found


def regrouped(designs: list[dict[str, Any]], names: list[str], tables: dict[str, Any]) -> list[dict[str, Any]]:
    """The designs in other groups, with the notes."""
    return call("regroup.js", "setGroup", [[design, name, tables] for design, name in zip(designs, names, strict=True)])


def plain(design: vt.Design) -> dict[str, Any]:
    """A design as the page has it: lists in the place of tuples."""
    found: dict[str, Any] = json.loads(json.dumps(design.to_dict()))
    return found


def check(before: dict[str, Any], group: str, made: dict[str, Any]) -> bool:
    """Check one design in another group; whether the drawing has stayed where it was."""
    design, note = made["design"], made["note"]
    assert design["group"] == group
    assert design["cell"]["a"] == before["cell"]["a"]
    stays = [site["strokes"] for site in design["site"]] == [site["strokes"] for site in before["site"]]
    assert stays, "strokes are as they were written: only sites are placed"
    vt.Design.from_dict(design).tessellate()  # raises where copies touch
    moved = bool(design["site"] != before["site"])
    assert ("moved" in note) == moved
    return not moved


def test_starters_in_other_groups(tables: dict[str, Any]) -> None:
    """Every starter goes into three others of the groups, and the engine tiles it there."""
    pairs = [(name, GROUP_NAMES[(k + step) % 17]) for k, name in enumerate(GROUP_NAMES) for step in (1, 6, 12)]
    designs = [plain(vt.starter(name)) for name, _ in pairs]
    results = regrouped(designs, [group for _, group in pairs], tables)
    stayed = [check(design, group, made) for design, (_, group), made in zip(designs, pairs, results, strict=True)]
    assert 10 < sum(stayed) < len(stayed)


@pytest.mark.slow
def test_all_designs_in_all_groups(tables: dict[str, Any]) -> None:
    """The starters and the examples go into all groups."""
    designs = [plain(vt.starter(name)) for name in GROUP_NAMES] + [plain(vt.Design.load(file)) for file in EXAMPLES]
    pairs = [(design, group) for design in designs for group in GROUP_NAMES if group != design["group"]]
    results = regrouped([design for design, _ in pairs], [group for _, group in pairs], tables)
    stayed = [check(design, group, made) for (design, group), made in zip(pairs, results, strict=True)]
    assert sum(stayed) > 100


def test_cells_keep_what_they_can(tables: dict[str, Any]) -> None:
    """What the group frees is as it was, and what it fixes is gone."""
    strokes = [{"segment": [[11, 12], [13, 14]]}]

    def cell(before: dict[str, float], group: str, after: str) -> object:
        design = {"schema": 1, "group": group, "cell": before, "site": [{"strokes": strokes}], "kept": 1}
        (made,) = regrouped([design], [after], tables)
        assert made["design"]["kept"] == 1
        assert made["design"]["site"] == design["site"]
        return made["design"]["cell"], made["note"]

    assert cell({"a": 60, "b": 50, "angle": 75}, "p1", "p2") == ({"a": 60, "b": 50, "angle": 75}, "")
    assert cell({"a": 60, "b": 50, "angle": 75}, "p1", "pgg") == ({"a": 60, "b": 50}, "Fixed now: angle.")
    assert cell({"a": 60, "b": 50}, "pmm", "p4") == ({"a": 60}, "Fixed now: b.")
    assert cell({"a": 60}, "p4", "p1") == ({"a": 60, "b": 60, "angle": 90}, "Free now: b = 60, angle = 90.")
    assert cell({"a": 60}, "p6", "p2") == ({"a": 60, "b": 60, "angle": 120}, "Free now: b = 60, angle = 120.")


def test_touching_copies_are_seen(tables: dict[str, Any]) -> None:
    """The page's quick look and the engine agree, but for copies that are near."""
    lines = {
        "farther than the centre": ([[-3, -1], [6, 2]], True),
        "through the centre": ([[-3, -1], [3, 1]], False),  # the half turn maps it onto itself
        "out of the cell": ([[5, 5], [72, 5]], True),
        "clear": ([[5, 5], [20, 9]], False),
    }
    designs = [
        {
            "schema": 1,
            "group": "p2",
            "cell": {"a": 60, "b": 50, "angle": 80},
            "site": [{"strokes": [{"segment": line}]}],
        }
        for line, _ in lines.values()
    ]
    wanted = [touches for _, touches in lines.values()]
    assert call("touching.js", "copiesTouch", [[design, tables] for design in designs]) == wanted
    for design, touches in zip(designs, wanted, strict=True):
        if touches:
            with pytest.raises(vt.TouchingCopiesError):
                vt.Design.from_dict(design).tessellate()
        else:
            vt.Design.from_dict(design).tessellate()

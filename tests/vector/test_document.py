"""The outline document: its shape, its 17 digits, its determinism."""

from __future__ import annotations

import json
import math

import numpy as np

from voronoi_tiles.base.operations import Operation
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.vector.document import document_text, outline_document, tile_record
from voronoi_tiles.vector.outline import Outline

ELEMENTS = np.array([[1.0, 2.0, 3.0, 4.5], [5.0, 5.0, 5.0, 5.0]])


def make(*outlines: Outline) -> str:
    """Write the document of some tiles in p4."""
    symmetry = (Operation.parse("x,y"), Operation.parse("-x,-y"))
    tiles = [tile_record(f"tile{k}", ELEMENTS, outline, 2, symmetry) for k, outline in enumerate(outlines)]
    return document_text(outline_document("mm", "p4", GROUPS["p4"].lattice(60.0), tiles))


def test_the_document_has_the_agreed_shape(mixed: Outline) -> None:
    """Key for key what readers outside the project rely on."""
    document = json.loads(make(mixed))
    assert list(document) == ["schema", "units", "group", "cell", "tiles"]
    assert document["schema"] == 1
    assert document["cell"] == [[60, 0], [0, 60]]
    (tile,) = document["tiles"]
    assert list(tile) == ["site", "area", "copies_per_cell", "symmetry", "elements", "rings"]
    assert tile["symmetry"] == ["x,y", "-x,-y"]
    assert tile["elements"] == ELEMENTS.tolist()
    assert tile["area"] == mixed.area
    parabola, line, *_ = tile["rings"][0]
    assert parabola == {
        "kind": "parabola",
        "points": [[10, 0], [14, 5], [10, 10]],
        "focus": [8.875, 5],
        "directrix": [[15.125, 0], [15.125, 10]],
        "neighbour": {"site": "bird", "operation": "x+1,y"},
    }
    assert line == {
        "kind": "line",
        "points": [[10, 10], [0, 10]],
        "neighbour": {"site": "bird", "operation": "-x,-y+1"},
    }


def test_rings_close_bit_for_bit_after_reading(mixed: Outline, ring: Outline, lens: Outline) -> None:
    """Each edge's end is the next one's start, and every float comes back as it was."""
    outlines = (mixed, ring, lens)
    for outline, tile in zip(outlines, json.loads(make(*outlines))["tiles"], strict=True):
        assert len(tile["rings"]) == len(outline.ring_offsets) - 1
        for edges in tile["rings"]:
            for edge, following in zip(edges, [*edges[1:], edges[0]], strict=True):
                assert edge["points"][-1] == following["points"][0]
        starts = [complex(*edge["points"][0]) for edges in tile["rings"] for edge in edges]
        assert starts == outline.start.tolist()


def test_floats_have_seventeen_digits_and_no_negative_zero() -> None:
    """All 17 significant digits are there, so that any reader gets the same bits."""
    text = document_text({"a": 0.1, "b": -0.0, "c": [1 / 3, 1e-300, 60.0], "d": 5})
    assert text == '{\n  "a": 0.10000000000000001,\n  "b": 0,\n  "c": [0.33333333333333331, 1e-300, 60],\n  "d": 5\n}\n'
    rng = np.random.default_rng(5)
    values = (rng.normal(size=300) * 10.0 ** rng.integers(-200, 200, 300)).tolist()
    assert json.loads(document_text({"v": values}))["v"] == values


def test_names_are_escaped() -> None:
    """A name is JSON text, whatever it holds."""
    name = 'a"b\\c\n\u0001\ud800é'
    assert json.loads(document_text({name: name})) == {name: name}


def test_one_edge_per_line_and_the_same_text_every_time(mixed: Outline) -> None:
    """A change of one edge is a change of one line."""
    text = make(mixed)
    assert text == make(mixed)
    assert sum('"kind"' in line for line in text.splitlines()) == 4
    assert all(line.count('"kind"') <= 1 for line in text.splitlines())
    assert not math.isnan(json.loads(text)["tiles"][0]["area"])

"""LightBurn's projects, read back by what is known of the format."""

from __future__ import annotations

import io
import re
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from helpers import cad

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.formats.lbrn2 import layer_numbers, write_lbrn2
from voronoi_tiles.formats.page import Drawing, Layer, Work
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

NUMBER = r"(-?\d+(?:\.\d+)?)"
VERTEX = re.compile(rf"V{NUMBER} {NUMBER}c0x{NUMBER}(?:c0y{NUMBER})?c1x{NUMBER}(?:c1y{NUMBER})?")


def written(drawing: Drawing) -> bytes:
    """Write a drawing."""
    file = io.BytesIO()
    write_lbrn2(drawing, file)
    return file.getvalue()


def read_path(shape: ET.Element) -> tuple[Complexes, bool]:
    """The points of a path, and whether its last piece comes back to its first vertex."""
    vertices = shape.findtext("VertList", "")
    found = list(VERTEX.finditer(vertices))
    assert "".join(match[0] for match in found) == vertices
    pieces = re.findall(r"([LB])(\d+) (\d+)", shape.findtext("PrimList", ""))
    assert "".join(f"{kind}{a} {b}" for kind, a, b in pieces) == shape.findtext("PrimList")
    t = np.linspace(0, 1, 65)
    points = []
    for kind, first, last in pieces:
        a, b = found[int(first)], found[int(last)]
        start, end = complex(float(a[1]), float(a[2])), complex(float(b[1]), float(b[2]))
        if kind == "L":
            points += [start, end]
            continue
        # A vertex without a y of its control point has no control point.
        assert a[4]
        assert b[6]
        c, d = complex(float(a[3]), float(a[4])), complex(float(b[5]), float(b[6]))
        points += (start * (1 - t) ** 3 + 3 * c * t * (1 - t) ** 2 + 3 * d * t * t * (1 - t) + end * t**3).tolist()
    assert [int(b) for _, _, b in pieces[:-1]] == [int(a) for _, a, _ in pieces[1:]]
    return np.array(points), pieces[-1][2] == pieces[0][1]


@pytest.mark.parametrize("kind", [LINE, QUAD, CUBIC, ARC])
def test_the_curves_are_those_of_the_drawing(kind: int) -> None:
    """Same paths on the same layers in the same order, within 2 nm; closed paths end where they begin."""
    drawing = cad.drawing(kind)
    root = ET.fromstring(written(drawing))
    settings = {setting.find("name").get("Value"): setting for setting in root.findall("CutSetting")}  # type: ignore[union-attr]
    assert list(settings) == ["engrave", "score", "cut"]
    shapes = list(root.iter("Shape"))
    paths = [shape for shape in shapes if shape.get("Type") == "Path"]
    at = 0
    for layer in drawing.layers:
        index = settings[layer.name].find("index").get("Value")  # type: ignore[union-attr]
        for points, closed in zip(cad.sampled(layer.paths), layer.paths.closed.tolist(), strict=True):
            assert paths[at].get("CutIndex") == index
            found, is_closed = read_path(paths[at])
            assert is_closed == closed
            limit = 2e-6 if kind != ARC else 1e-3
            assert cad.deviation([found], [points]) < limit
            assert abs(found[0] - points[0]) < 2e-6
            at += 1
    assert at == len(paths)
    ids = [shape.get("VertID") for shape in paths]
    assert len(set(ids)) == len(ids)


def test_arcs_are_within_a_nanometre() -> None:
    """Points of the cubic curves lie on the circle."""
    ring = cad.ring(ARC, radius=100.0, count=3)
    (shape,) = ET.fromstring(written(Drawing(9, 9, (Layer.of_paths("c", "cut", "#000000", 1, ring),)))).findall("Shape")
    points, _ = read_path(shape)
    centre, radius, _, _ = ring.circles(np.arange(3))
    off = np.abs(np.abs(points[:, None] - centre) - radius).min(axis=1)
    assert off.max() < 3e-6


def test_items_are_groups() -> None:
    """A tile with a hole is one group of two paths; nothing else is in a group."""
    root = ET.fromstring(written(cad.drawing(QUAD)))
    groups = [shape for shape in root.findall("Shape") if shape.get("Type") == "Group"]
    assert [len(group.findall("Children/Shape")) for group in groups] == [2]


def layer(work: Work, colour: str, *, filled: bool = False) -> Layer:
    """A layer with a ring."""
    ring = cad.ring(LINE)
    return Layer(work, work, colour, 0.1, ring, np.array([0, 1]), filled=filled)


@pytest.mark.parametrize(
    ("layers", "numbers"),
    [
        ([("engrave", "#ff0000"), ("score", "#00e000"), ("cut", "#000000")], [2, 3, 0]),
        ([("engrave", "#000000"), ("score", "#000000"), ("cut", "#000000")], [2, 3, 0]),
        ([("engrave", "#000000"), ("cut", "#0000FF"), ("cut", "#ff0000")], [0, 1, 2]),
        ([("cut", "#123456"), ("cut", "#123457"), ("cut", "#000000")], [1, 2, 0]),
        ([("engrave", "#123456"), ("cut", "#ff0000")], [3, 2]),
    ],
)
def test_layers_take_the_numbers_of_their_colours(layers: list[tuple[Work, str]], numbers: list[int]) -> None:
    """LightBurn's colours lead, cuts first; what it has no colour for takes the next free number."""
    assert layer_numbers([layer(*each) for each in layers]) == numbers


def test_more_layers_than_there_are() -> None:
    """Thirty fit, each with a number of its own; more are refused."""
    assert sorted(layer_numbers([layer("cut", "#010203")] * 30)) == list(range(30))
    with pytest.raises(ValueError, match="30 layers"):
        layer_numbers([layer("cut", "#010203")] * 31)


def test_filled_layers_are_scanned_and_nothing_burns() -> None:
    """Fill is Scan, lines are Cut; the power is 0."""
    layers = (layer("engrave", "#ff0000", filled=True), layer("cut", "#000000"))
    root = ET.fromstring(written(Drawing(9, 9, layers)))
    assert [setting.get("type") for setting in root.findall("CutSetting")] == ["Scan", "Cut"]
    assert {power.get("Value") for power in root.iter("maxPower")} == {"0"}


def test_names_and_recipe_survive() -> None:
    """Any text is well-formed; the recipe is in the notes; the same drawing gives the same bytes."""
    odd = '<&"\x00\ud800\n鳥'
    drawing = Drawing(9, 9, (Layer.of_paths(odd, "cut", "#000000", 1, cad.ring(LINE)),), odd, {"design": odd})
    root = ET.fromstring(written(drawing))
    name = root.find("CutSetting/name")
    assert name is not None
    assert name.get("Value") == '<&"\ufffd\ufffd\n鳥'
    assert 'design: <&"\ufffd\ufffd\n鳥' in root.find("Notes").get("Notes", "")  # type: ignore[union-attr]
    assert written(drawing) == written(drawing)


def test_many_paths_are_all_there() -> None:
    """Blocks lose nothing, nor do paths without pieces."""
    ring = Paths.concatenate([cad.ring(QUAD, count=40), cad.ring(LINE, closed=False)])
    paths = Paths.concatenate([ring] * 2500)
    drawing = Drawing(9, 9, (Layer("cut", "cut", "#000000", 1, paths, np.arange(0, 5001, 2)),))
    root = ET.fromstring(written(drawing))
    assert [len(group.findall("Children/Shape")) for group in root.findall("Shape")] == [2] * 2500
    last = root.findall("Shape")[-1].findall("Children/Shape")
    assert cad.deviation([read_path(last[0])[0]], cad.sampled(cad.ring(QUAD, count=40))) < 2e-6


def test_the_reader_sees_a_wrong_file() -> None:
    """A lost control point, a piece that leads elsewhere."""
    ring = cad.ring(QUAD)
    text = written(Drawing(9, 9, (Layer.of_paths("c", "cut", "#000000", 1, ring),))).decode()
    (shape,) = ET.fromstring(re.sub(r"c0x[\d.]+c0y[\d.]+", "c0x1", text, count=1)).findall("Shape")
    with pytest.raises(AssertionError):
        read_path(shape)
    (shape,) = ET.fromstring(text.replace("B1 2", "B1 3")).findall("Shape")
    with pytest.raises(AssertionError):
        read_path(shape)

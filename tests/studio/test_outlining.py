"""What the page is shown of a design: its proved outlines, what takes them to their copies, and their colours."""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest
import shapely
from helpers.examples import EXAMPLES, tiling

from voronoi_tiles.base.errors import ProofError, TouchingCopiesError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.groups.periodic_colouring import PeriodicColouring
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.studio import outlining
from voronoi_tiles.studio.frames import FRAME_START, sizes_of
from voronoi_tiles.studio.outlining import Outliner, coarser
from voronoi_tiles.studio.work import do
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.vector.tessellation import tessellate

COLOURED = ("p2-anchor", "p4-mill", "p6m-flower")
"""The examples whose colours the quick tests look at."""

QUICK = 0.0
SLOW = 1.0
"""What proofs take for each edge, in seconds."""


def shown(design: Mapping[str, Any], *, rest: bool = True, tolerance: float | None = None) -> dict[str, Any]:
    """What the page is told of a design."""
    return next(Outliner().outlines(7, design, rest=rest, tolerance=tolerance)).message


def rings(path: str) -> list[list[complex]]:
    """The corners and control points of path data, a list a ring: enough for the area between a quadratic's points."""
    found: list[list[complex]] = []
    for command, numbers in re.findall(r"([MLQZ])([^MLQZ]*)", path):
        values = [float(number) for number in numbers.split()]
        points = [complex(*pair) for pair in zip(values[::2], values[1::2], strict=True)]
        if command == "M":
            found.append([])
        elif command == "L":  # as a quadratic
            points = [(found[-1][-1] + points[0]) / 2, *points]
        found[-1] += points
    for ring in found:
        if ring[0] != ring[-1]:
            ring += [(ring[0] + ring[-1]) / 2, ring[0]]
    return found


def area(path: str) -> float:
    """The area within path data, y up: twice that of the triangle of a quadratic's points, by Green, is 3 (area)."""
    total = 0.0
    for ring in rings(path):
        for start, control, end in zip(ring[:-2:2], ring[1:-1:2], ring[2::2], strict=True):
            crosses = [(p.conjugate() * q).imag for p, q in ((start, control), (control, end), (start, end))]
            total += (2 * crosses[0] + 2 * crosses[1] + crosses[2]) / 6
    return total


@pytest.mark.parametrize("group", GROUPS)
def test_the_copies_fill_the_cell(group: str) -> None:
    """The areas of the paths, y up, times the copies, are that of the cell; each copy is another one."""
    design = starter(group)
    answer = shown(design.to_dict())
    assert (answer["type"], answer["rev"], answer["proved"], answer["scale"]) == ("outline", 7, True, 1.0)
    total = 0.0
    for tile, expected in zip(answer["tiles"], tiling(group), strict=True):
        measured = area(tile["path"])
        assert measured == pytest.approx(expected.area, rel=1e-9)
        assert (tile["site"], tile["edges"]) == (expected.name, len(expected.outline))
        assert tile["copies"] == len(tile["operations"]) == expected.copies_per_cell
        assert tile["operations"][0] == 0
        total += measured * tile["copies"]
        images = {image_of(design, expected.site.nodes, number) for number in tile["operations"]}
        assert len(images) == len(tile["operations"])
    assert total == pytest.approx(design.lattice.det, rel=1e-12)


def image_of(design: Design, nodes: Any, number: int) -> frozenset[tuple[int, int]]:
    """The nodes of a copy modulo the lattice, as whole numbers: what tells two copies apart."""
    moved = design.lattice.isometry(design.group.operations[number])(nodes)
    x, y = design.lattice.fractional(moved)
    return frozenset(zip(*(np.round(part * 1e6).astype(int) % 1_000_000 for part in (x, y)), strict=True))


@pytest.fixture
def unhurried(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give engines and proofs a second, which they have on the busiest machine."""
    monkeypatch.setattr(outlining, "PROOF_S", 1.0)


@pytest.mark.usefixtures("unhurried")
def test_at_rest_all_is_proved_and_while_the_pointer_moves_what_is_quick() -> None:
    """An outline says whether it is proved; one that is not is the same outline, and its proof comes after it."""
    design = starter("p4").to_dict()
    for proof_s, rest, proofs in ((QUICK, True, 0), (SLOW, True, 0), (SLOW, False, 0), (QUICK, False, 1)):
        said = list(Outliner(proof_s).outlines(1, design, rest=rest, tolerance=None))
        answer = said[0].message
        assert answer["proved"] is rest
        assert answer["tiles"] == shown(design)["tiles"]
        assert ("colouring" in answer) is rest
        assert [one.more for one in said] == [True] * proofs + [False]
        assert [one.message for one in said[1:]] == [{"type": "proof", "rev": 1}] * proofs
    outliner = Outliner(SLOW)
    assert list(outliner.outlines(1, design, rest=True, tolerance=None))
    assert 0.0 < outliner.proof_s < SLOW  # it has seen how quick a proof is here
    outliner.proof_s = SLOW
    for _ in range(20):  # one that was slow is tried again some time
        assert list(outliner.outlines(1, design, rest=False, tolerance=None))
    assert outliner.proof_s < SLOW / 4


@pytest.mark.usefixtures("unhurried")
def test_a_worker_tells_an_outline_before_its_proof() -> None:
    """The frames of an answer: all but the last say that there is more."""
    asked = {"task": "outline", "rev": 3, "design": starter("p4").to_dict(), "rest": False, "tolerance": None}
    said = []
    for frame in do(asked, b""):
        head, _ = sizes_of(frame[:FRAME_START])
        texts = frame[FRAME_START : FRAME_START + head], frame[FRAME_START + head :]
        said.append(tuple(json.loads(text) for text in texts))
    assert [(head["more"], message["type"], message["rev"]) for head, message in said] == [
        (True, "outline", 3),
        (False, "proof", 3),
    ]


@pytest.mark.usefixtures("unhurried")
def test_an_outline_that_fails_its_proof_is_made_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """What was shown before its proof is replaced by one that passes, or refused where there is none."""
    design = starter("p4").to_dict()
    right = shown(design)["tiles"]
    larger = Design.from_dict({**design, "cell": {"a": design["cell"]["a"] * 1.001}})
    wrong = tessellate(larger.noded, larger.group, larger.lattice)
    monkeypatch.setattr(outlining, "tessellate", lambda *_: wrong)
    first, second = (said.message for said in Outliner().outlines(1, design, rest=False, tolerance=None))
    assert (first["proved"], first["tiles"] == right) == (False, False)
    assert (second["proved"], second["tiles"] == right) == (True, True)
    assert shown(design)["tiles"] == right  # at rest it is proved before it is shown
    monkeypatch.setattr(outlining, "proved_tiles", Mock(side_effect=ProofError("there is a gap")))
    answers = Outliner().outlines(1, design, rest=False, tolerance=None)
    assert next(answers).more
    with pytest.raises(ProofError):
        next(answers)


@pytest.mark.parametrize("scale", [1.0, 3.0])
def test_strokes_are_coarse_while_the_pointer_moves_alone(scale: float) -> None:
    """A tolerance is in the coordinates of the drawing: the design's scale does not change what it leaves."""
    design = {**starter("p4").to_dict(), "scale": scale}
    design["site"][0]["tolerance"] = 0.001 * scale
    fine, coarse = (shown(design, rest=rest, tolerance=1.0)["tiles"][0] for rest in (True, False))
    assert coarse["edges"] < fine["edges"] / 4
    assert fine["edges"] == shown(design)["tiles"][0]["edges"]
    assert coarse["edges"] == shown({**design, "scale": 1.0}, rest=False, tolerance=1.0)["tiles"][0]["edges"]
    assert shown(design, rest=False, tolerance=1e-9)["tiles"] == [fine]  # never finer than the design says


def test_a_design_is_made_coarser_where_it_can_be() -> None:
    """What is no design is left as it is, for those who say what is wrong with it."""
    assert coarser({"units": "cm", "site": [{}]}, 0.5)["site"] == [{"tolerance": 0.5}]
    assert coarser({"units": "cm", "site": [{}]}, 1e-9)["site"] == [{"tolerance": 0.001}]
    for site in (None, 3, [3], [{"tolerance": "x"}], [{"tolerance": -1}], [{"tolerance": True}]):
        assert coarser({"site": site}, 0.5) == {"site": site}
    assert coarser({"site": [{}], "scale": "x"}, 0.5) == {"site": [{}], "scale": "x"}


def test_what_touches_as_it_is_flattened_alone_is_shown() -> None:
    """A chord runs through the point in a bow: the bow does not, and the page is shown the bow."""
    bow = {"bezier": [[0, 0], [0, -8], [8, -8], [8, 0]]}
    design = {
        "schema": 1,
        "group": "p1",
        "cell": {"a": 40, "b": 40, "angle": 90},
        "site": [{"name": "bow", "strokes": [bow]}, {"name": "dot", "strokes": [{"point": [4, 0]}]}],
    }
    with pytest.raises(TouchingCopiesError):
        Design.from_dict(coarser(design, 10.0)).tessellate()
    answer = shown(design, rest=False, tolerance=10.0)
    assert answer["tiles"] == shown(design)["tiles"]


def test_drawings_are_sent_as_paths(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A stroke that names a drawing comes with its lines, in the units of the design, before it is placed."""
    (tmp_path / "leaf.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm" viewBox="0 0 9 9">'
        '<path d="M1 1 L5 4" fill="none" stroke="black"/></svg>'
    )
    monkeypatch.chdir(tmp_path)
    strokes = [{"point": [1, 1]}, {"file": "leaf.svg", "translate": [9, 9]}]
    design = {"schema": 1, "group": "p1", "cell": {"a": 40, "b": 40, "angle": 90}, "site": [{"strokes": strokes}]}
    resolved = shown(design)["resolved"]
    path = resolved.pop("0.1")
    assert not resolved
    assert [float(number) for number in re.findall(r"[\d.]+", path)] == pytest.approx([0, 3, 4, 0], abs=1e-9)
    assert shown(starter("p4").to_dict())["resolved"] == {}


@pytest.mark.parametrize(
    "name", [name if name in COLOURED else pytest.param(name, marks=pytest.mark.slow) for name in EXAMPLES]
)
def test_neighbours_have_different_colours(name: str) -> None:
    """Of the copies about the tile no two that share an edge are alike."""
    refuse_alike(tiling(name))


@pytest.mark.parametrize("name", ["p2-anchor", pytest.param("p6-manta", marks=pytest.mark.slow)])
def test_neighbours_have_different_colours_far_away(name: str) -> None:
    """Also where a site is drawn many cells from the origin, where nothing is computed."""
    design = tiling(name).design
    refuse_alike(design.moved(translate=design.lattice.cartesian(7, -4)).tessellate())


def refuse_alike(tiles: Tiling) -> None:
    """Assert that neighbours have different colours; the oracle looks at polygons."""
    design = tiles.design
    answer = shown(design.to_dict())
    colouring = answer["colouring"]
    (p, q), (r, s) = colouring["rows"]
    polygons, colours = [], []
    placements = itertools.count()
    for tile, sent in zip(tiles, answer["tiles"], strict=True):
        corners = shapely.get_coordinates(tile.outline.to_shapely(accuracy=0.01)) @ [1, 1j]
        for number in sent["operations"]:
            table = colouring["colour"][next(placements)]
            image = design.lattice.isometry(design.group.operations[number])(corners)
            home = [int(part) for part in np.floor(design.lattice.fractional(complex(image.mean())))]
            for i, j in itertools.product(range(-home[0] - 1, 3 - home[0]), range(-home[1] - 1, 3 - home[1])):
                copy = image + i * design.lattice.a + j * design.lattice.b
                polygons.append(shapely.Polygon(np.column_stack((copy.real, copy.imag))).buffer(0.05))
                colours.append(table[(p * i + q * j) % colouring["m"]][(r * i + s * j) % colouring["n"]])
    assert next(placements) == len(colouring["colour"])
    assert set(colours) == set(range(colouring["count"]))
    one, other = shapely.STRtree(polygons).query(polygons, predicate="intersects")
    pairs = [(a, b) for a, b in zip(one.tolist(), other.tolist(), strict=True) if a < b]
    # Where they share an edge, the margins of both lie on each other along it.
    shared = [(a, b) for a, b in pairs if polygons[a].intersection(polygons[b]).area > 0.1]
    assert len(shared) > len(polygons)
    assert not [(a, b) for a, b in shared if colours[a] == colours[b]]


def test_colours_stay_while_they_can() -> None:
    """What was sent last is sent again while no neighbours are alike in it, also where other colours would do."""
    outliner, design = Outliner(), starter("p4").to_dict()

    def colouring(design: Mapping[str, Any]) -> Any:
        return next(outliner.outlines(1, design, rest=True, tolerance=None)).message["colouring"]

    first = colouring(design)
    last = outliner.colourist.last
    assert last is not None
    for colour, kept in ((last.count - 1 - last.colour, True), (np.zeros_like(last.colour), False)):
        outliner.colourist.last = PeriodicColouring(last.repeat, colour)
        again = colouring(design)
        assert (again != first) is kept
        assert again["count"] == first["count"]
    other = starter("p6").to_dict()
    assert colouring(other) == shown(other)["colouring"]

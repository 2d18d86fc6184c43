"""The example designs: each exports, is proved and can be cut, and the kinds that a gallery has to show are there."""

from __future__ import annotations

import json
import re
import time
import tomllib
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest
import shapely
from helpers.examples import EXAMPLES, path_of, tiling
from helpers.outlines import CommandLine

from voronoi_tiles import Design

KINDS = {"point", "segment", "polyline", "bezier", "hermite", "catmull_rom", "bspline", "circle", "path"}
MIRRORED = {"pm", "cm", "pmm", "pmg", "cmm", "p4m", "p4g", "p3m1", "p31m", "p6m"}
# Seconds of processor time for one tessellation with its proof: they take 0.02 to 0.1.
TIME_LIMIT = 3.0
# In millimetres: what is narrower than this breaks when it is cut from plywood.
NARROWEST = 2.0

# All of them in the quick run too: what is asked here is quickly answered.
each_example = pytest.mark.parametrize("name", EXAMPLES)


def source(name: str) -> dict[str, Any]:
    """Read an example as the table that it is."""
    return tomllib.loads(path_of(name).read_text(encoding="utf-8"))


def strokes(name: str) -> list[list[str]]:
    """Name the kinds of an example's strokes, by site."""
    return [[(KINDS & set(stroke)).pop() for stroke in site["strokes"]] for site in source(name)["site"]]


@cache
def designs_by_kind() -> set[tuple[str, tuple[str, ...]]]:
    """The group and the strokes of every design of one site."""
    return {(source(name)["group"], tuple(sites[0])) for name in EXAMPLES if len(sites := strokes(name)) == 1}


@pytest.mark.parametrize("group", ["p1", "p2", "pg", "p4", "p3", "p6"])
def test_there_is_a_single_segment(group: str) -> None:
    """The first figures of Panchal, Akleman and others."""
    assert (group, ("segment",)) in designs_by_kind()


@pytest.mark.parametrize("group", ["p2", "p4", "p3"])
def test_there_is_a_union_of_segments(group: str) -> None:
    """Several segments make one site."""
    assert any(g == group and len(kinds) > 1 and set(kinds) == {"segment"} for g, kinds in designs_by_kind())


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("group", ["p1", "pg", "p3", "p6"])
def test_there_are_cubic_curves(group: str, count: int) -> None:
    """One curve, and two curves that make one site."""
    assert (group, ("bezier",) * count) in designs_by_kind()


def test_there_are_the_special_ones() -> None:
    """Path data, two tile shapes, a circle about a centre of rotation, a mirror group, and most kinds of stroke."""
    by_name = {name: strokes(name) for name in EXAMPLES}
    kinds = {kind for sites in by_name.values() for site in sites for kind in site}
    assert kinds >= KINDS - {"polyline"}
    assert any(len(sites) == 2 for sites in by_name.values())
    assert {source(name)["group"] for name in EXAMPLES} & MIRRORED
    circles = [name for name, sites in by_name.items() if ["circle"] in sites]
    assert any(len(tile.symmetry) > 1 for name in circles for tile in tiling(name).tiles)
    assert len(EXAMPLES) >= 16


@each_example
def test_it_is_proved_in_time(name: str) -> None:
    """Every figure of the proof holds, and nobody waits for it."""
    design = Design.load(path_of(name))
    begin = time.process_time()
    result = design.tessellate()
    assert time.process_time() - begin < TIME_LIMIT
    assert result.proof.passed, result.proof.failures


@each_example
def test_its_svg_is_one_closed_path_per_tile(name: str) -> None:
    """The file parses and holds lines and exact quadratic curves, nothing else."""
    root = ET.fromstring(tiling(name).svg())
    paths = list(root.iter("{http://www.w3.org/2000/svg}path"))
    assert len(paths) == len(tiling(name).tiles)
    for path in paths:
        assert re.fullmatch(r"(M[^MLQZ]+([LQ][^MLQZ]+)+Z\s*)+", path.attrib["d"])
    width, height = (float(root.attrib[key].removesuffix("mm")) for key in ("width", "height"))
    assert 10.0 < width < 150.0
    assert 10.0 < height < 150.0


@each_example
def test_its_document_tiles_the_cell(name: str) -> None:
    """What a program reads back closes bit for bit, and the areas add up to the cell's."""
    document = json.loads(tiling(name).json())
    (ax, ay), (bx, by) = document["cell"]
    covered = sum(tile["area"] * tile["copies_per_cell"] for tile in document["tiles"])
    assert covered == pytest.approx(ax * by - ay * bx, rel=1e-12)
    for tile in document["tiles"]:
        for ring in tile["rings"]:
            assert all(edge["points"][-1] == ring[k + 1 - len(ring)]["points"][0] for k, edge in enumerate(ring))


@each_example
def test_its_tiles_can_be_cut(name: str) -> None:
    """One piece without holes, no narrow neck, and visibly curved.

    A disc of the least width's diameter passes through the whole tile: shrunk by its radius the tile stays in one
    piece, but for crumbs in sharp corners.
    """
    for tile in tiling(name).tiles:
        shape = tile.to_shapely(accuracy=0.01)
        assert isinstance(shape, shapely.Polygon)
        assert not shape.interiors
        core = shapely.get_parts(shape.buffer(-NARROWEST / 2))
        assert [part.area > 0.5 for part in core].count(True) == 1
        assert tile.outline.curved_length > 0.2 * tile.perimeter


@each_example
def test_it_says_what_it_is(name: str) -> None:
    """A comment comes first, with the command that exports it, and the file's name begins with the group's."""
    text = path_of(name).read_text(encoding="utf-8")
    assert text.startswith("# ")
    assert f"\n# Export it:  voronoi-tiles export examples/{name}.toml -o {name}.svg\n" in text
    assert name.partition("-")[0] == source(name)["group"]


@pytest.mark.parametrize("file_format", ["svg", "json"])
def test_all_export_with_one_command(voronoi_tiles: CommandLine, tmp_path: Path, file_format: str) -> None:
    """As `make demo` does it; the files are those that Python gives."""
    files = [path_of(name) for name in EXAMPLES]
    result = voronoi_tiles("export", *files, "-o", tmp_path, "--format", file_format)
    assert result.returncode == 0, result.stderr
    assert sorted(path.stem for path in tmp_path.iterdir()) == EXAMPLES
    for name in EXAMPLES:
        assert (tmp_path / f"{name}.{file_format}").read_text(encoding="utf-8") == tiling(name).text(file_format)

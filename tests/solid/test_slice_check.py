"""The cross-check of lofts: slices between levels against images of the strokes there, and that damage is seen."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
import shapely
from helpers.outlines import CommandLine
from helpers.random_solids import KINDS, random_solid

from voronoi_tiles import Design
from voronoi_tiles.solid.cross_sections import filled_section
from voronoi_tiles.solid.events import LoftError
from voronoi_tiles.solid.loft import Loft, lofted
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.slice_check import between_levels, check_slices

BIRD = """
schema = 1
group = "p4"
cell = { a = 60 }
site = [{ name = "bird", strokes = [{ segment = [[8, 10], [22, 17]] }] }]
solid = { height = 20, layers = 31, turn = 40, about = [15, 14] }
"""


@pytest.fixture(scope="module")
def loft() -> Loft:
    """A segment that turns."""
    return lofted(Design.loads(BIRD))


def damaged(loft: Loft, vertices: np.ndarray) -> Loft:
    """The loft with other vertices of its mesh."""
    copy = dataclasses.replace(loft)
    copy.__dict__["meshes"] = (TriangleMesh(vertices, loft.meshes[0].triangles),)
    return copy


def test_slices_are_the_tiles_of_the_strokes_there(loft: Loft) -> None:
    """At heights that are no level's, within the accuracy of chords; the areas are right to rounding."""
    heights = between_levels(loft, 5)
    assert len(heights) == 5
    assert np.abs(heights[:, None] - loft.meshes[0].vertices[:, 2]).min() > 0.1
    assert len(between_levels(loft, 200)) > 2 * len(loft.levels)
    labels, areas = check_slices(loft, renderer="cpu", slices=5, samples=128)
    assert labels.passed
    assert labels.checked > 5 * 100 * 100
    assert 0 < (labels.worst or 0.0) <= 0.05
    assert areas.passed


def test_damage_is_seen(loft: Loft) -> None:
    """A layer that is pushed aside, and a bulge that stays a wall of nobody: too little room, or too much."""
    vertices = loft.meshes[0].vertices.copy()
    inner = (vertices[:, 2] > 8) & (vertices[:, 2] < 12)
    aside = vertices + np.where(inner, 0.4, 0.0)[:, None] * np.array([1.0, 0.0, 0.0])
    labels, _ = check_slices(damaged(loft, aside), renderer="cpu", slices=5, samples=128)
    assert not labels.passed
    assert 0.2 < (labels.worst or 0.0) < 0.5
    middle = vertices[:, :2].mean(axis=0)
    grown = vertices.copy()
    grown[inner, :2] = middle + 1.01 * (grown[inner, :2] - middle)
    _, areas = check_slices(damaged(loft, grown), renderer="cpu", slices=5, samples=128)
    assert not areas.passed


def test_the_command_checks_slices(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """A design that asks for two layers has as many as it needs: the slices between them are right."""
    path = tmp_path / "bird.toml"
    path.write_text(BIRD.replace("layers = 31", "layers = 2"), encoding="utf-8")
    result = voronoi_tiles("check", path, "--size", 64, "--renderer", "cpu")
    assert result.returncode == 0
    assert "slice areas" in result.stdout
    assert "The outlines and the image agree.\n" in result.stdout


@pytest.mark.slow
@pytest.mark.parametrize("kind", range(len(KINDS)))
def test_random_lofts_agree_with_images(kind: int) -> None:
    """What the proof says of walls between levels, images of the strokes there say too, in any group."""
    checked = 0
    for seed in range(40, 52):
        try:
            loft = lofted(random_solid(seed, kind))
        except LoftError:
            continue
        labels, areas = check_slices(loft, renderer="cpu", samples=128)
        assert labels.passed
        assert areas.passed
        checked += 1
    assert checked > 2


def test_the_command_checks_what_solid_makes(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """Within the same accuracy, and at as many heights as it is told; a flat design has none of both."""
    path = tmp_path / "bird.toml"
    path.write_text(BIRD, encoding="utf-8")
    asked = ("--accuracy", "0.2mm", "--slices", 3)
    result = voronoi_tiles("check", path, "--size", 64, "--renderer", "cpu", *asked, "--json")
    assert result.returncode == 0, result.stderr
    figures = {figure["name"]: figure for figure in json.loads(result.stdout)["check"]["figures"]}
    assert figures["slices"]["limit"] == 0.2
    assert figures["slice areas"]["checked"] == 3
    path.write_text(BIRD.partition("solid =")[0], encoding="utf-8")
    for option in (asked[:2], asked[2:]):
        refused = voronoi_tiles("check", path, *option)
        assert refused.returncode == 2
        assert f": {option[0]} is for designs with a [solid], and this one is flat" in refused.stderr


def test_chords_of_layers_are_within_their_accuracy() -> None:
    """Also beside corners of edges, to which vertices are moved: the section at a layer is the tile of the strokes."""
    curve = "[{ catmull_rom = [[2, 10], [7, 6], [13, 14], [18, 10]] }]"
    flat = BIRD.partition("solid =")[0].replace('"p4"', '"p2"').replace("a = 60", "a = 40, b = 40, angle = 90")
    flat = flat.replace("[{ segment = [[8, 10], [22, 17]] }]", curve)
    made = lofted(Design.loads(flat + "solid = { height = 2, layers = 5, turn = 56, about = [10, 10] }"))
    for z in (0.5, 1.0):
        points = [[point.real, point.imag] for point in made.motion.points(z)[0].tolist()]
        tile = Design.loads(flat.replace(curve, f"[{{ polyline = {points} }}]")).tessellate()[0]
        off = shapely.hausdorff_distance(tile.to_shapely(accuracy=1e-4), filled_section(made.meshes[0], z + 1e-9), 0.01)
        assert off <= 0.051

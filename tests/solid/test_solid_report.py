"""What solids come to: sections, overhangs, necks, masses."""

from __future__ import annotations

import json

import numpy as np
import pytest
from helpers.examples import tiling
from helpers.programs import PIECES

from voronoi_tiles import (
    ArgumentError,
    Design,
    ProofError,
    Site,
    Solid,
    SolidJob,
    TriangleMesh,
    extrude,
    segment,
    stand,
)
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.solid.cross_sections import section
from voronoi_tiles.solid.laying_orders import assembly, prism_assembly
from voronoi_tiles.solid.loft import lofted
from voronoi_tiles.solid.prism import Face, Prism
from voronoi_tiles.solid.solid_report import narrowest_neck, overhang, solid_report

PYRAMID = TriangleMesh(
    np.array([[0.0, 0, 0], [6, 0, 0], [6, 6, 0], [0, 6, 0], [3, 3, 4]]),
    np.array([[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]),
)


def test_a_section_of_a_pyramid_is_a_square() -> None:
    """Counter-clockwise, and smaller the higher."""
    assert PYRAMID.is_closed
    for z in (0.1, 2.0, 3.9):
        rings = section(PYRAMID, z)
        assert ring_areas(rings) == pytest.approx([(6 * (1 - z / 4)) ** 2])
    assert len(section(PYRAMID, 5.0)) == 0


def test_a_section_of_tiles_is_what_they_stand_on() -> None:
    """Holes too."""
    ring, _ = extrude(Design.loads(PIECES).tessellate(), SolidJob(height=2.0, chamfer=0.4)).pieces
    areas = sorted(ring_areas(section(ring.mesh, 0.9)).tolist())
    assert (len(areas), areas[0] < 0.0) == (2, True)
    lower = ring_areas(section(ring.mesh, 0.2)).sum()
    assert lower < sum(areas)
    assert ring.mesh.volume == pytest.approx(1.2 * sum(areas) + 2 * 0.4 * lower, rel=1e-3)


def test_a_section_of_an_open_mesh_is_refused() -> None:
    """It has no inside."""
    with pytest.raises(ProofError, match="open at a height of 2 mm"):
        section(TriangleMesh(PYRAMID.vertices, PYRAMID.triangles[:-1]), 2.0)


def test_overhangs_are_what_leans_out() -> None:
    """A pyramid has none; on its tip it leans by the angle of its sides, 36.9 degrees, and its base hangs over."""
    assert overhang(PYRAMID, 1.0) == pytest.approx((0.0, 0.0))
    assert overhang(PYRAMID, -1.0)[1] == pytest.approx(np.degrees(np.arctan2(3, 4)))
    flat = TriangleMesh(PYRAMID.vertices * [1, 1, 0.25], PYRAMID.triangles)
    share, steepest = overhang(flat, -1.0)
    sides = 4 * 0.5 * 6 * np.hypot(3, 1)
    assert share == pytest.approx(sides / (sides + 36))
    assert steepest == pytest.approx(np.degrees(np.arctan2(3, 1)))


def test_a_speck_is_no_overhang() -> None:
    """A triangle of some ten thousandths of a square millimetre that hangs out level; a larger one is."""
    for side, steepest in ((0.03, 0.0), (0.3, 90.0)):
        level = np.array([[0.0, 0, 2], [0, side, 2], [side, 0, 2]])
        mesh = TriangleMesh(np.concatenate((PYRAMID.vertices, level)), np.vstack((PYRAMID.triangles, [[5, 6, 7]])))
        assert overhang(mesh, 1.0)[1] == pytest.approx(steepest, abs=1e-9)


def test_a_report_says_which_way_up() -> None:
    """A solid that leans out is turned over where that is better; a chamfer of 45 degrees is no overhang."""
    model = extrude(tiling("p4m"), SolidJob(height=3, chamfer=0.5, sheet="150x150mm"))
    figures = solid_report(model, 2.0)
    assert {row["site"] for row in figures["solids"]} == {tile.name for tile in tiling("p4m")}
    assert sum(row["count"] for row in figures["solids"]) == len(model.pieces)
    assert sum(row["mass"] * row["count"] for row in figures["solids"]) == pytest.approx(figures["mass"])
    assert figures["mass"] == pytest.approx(model.volume / 1000 * 2.0)
    assert all(row["overhang"] < 2e-3 and row["up"] == "as it lies" for row in figures["solids"])
    assert figures["assembly"] == prism_assembly([row["site"] for row in figures["solids"]])
    upside_down = TriangleMesh(PYRAMID.vertices * [1, 1, -0.25] + [0, 0, 1], PYRAMID.triangles[:, ::-1])
    assert upside_down.volume > 0
    assert overhang(upside_down, 1.0)[0] > overhang(upside_down, -1.0)[0] == 0.0


def test_a_report_of_a_loft_says_how_it_is_laid() -> None:
    """As its tiles are where they are drawn, whatever lies in the file; in the types of JSON."""
    site = Site(segment(5 + 3j, 14 + 8j), name="bird")
    design = Design("p4", 40, site, solid=Solid(20, layers=6, turn=90, about=9.5 + 5.5j))
    found = solid_report(stand(design))["assembly"]
    assert found == assembly(lofted(design))
    assert json.loads(json.dumps(found)) == found
    assert solid_report(stand(design, around=True))["assembly"] == found


def test_the_narrowest_neck_is_found() -> None:
    """A bar of three millimetres between two heads, at whichever level."""
    x, y = [0, 8, 8, 20, 20, 28, 28, 20, 20, 8, 8, 0], [0, 0, 5, 5, 0, 0, 13, 13, 8, 8, 13, 13]
    points = np.array(x) + 1j * np.array(y)
    assert narrowest_neck(Prism.over(Face(points, np.array([0, 12]), 0.0), 5.0).mesh()) == pytest.approx(3.0)
    assert narrowest_neck(PYRAMID) is None


@pytest.mark.parametrize("density", [0, -1, float("nan"), "heavy"])
def test_a_density_that_cannot_be_is_refused(density: float) -> None:
    """With what to give."""
    with pytest.raises(ArgumentError, match="grams per cubic centimetre"):
        solid_report(extrude(tiling("p4m")), density)

"""The deviation of walls between levels: against the exact tiles there, and that damage is seen."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from helpers.random_solids import random_solid

import voronoi_tiles as vt
from voronoi_tiles.solid.cross_sections import filled_section
from voronoi_tiles.solid.deviation import deviation, equidistance
from voronoi_tiles.solid.loft import Loft, lofted
from voronoi_tiles.solid.mesh import TriangleMesh

BIRD = """
schema = 1
group = "p4"
cell = { a = 60 }
site = [{ name = "bird", strokes = [{ segment = [[8, 10], [22, 17]] }] }]
solid = { height = 20, turn = 90, about = [15, 14] }
"""

ALONG = """
schema = 1
group = "cmm"
units = "mm"
cell = { a = 44, b = 36 }
site = [ { name = "s", strokes = [{ segment = [[17.04, 11.88], [4.54, 6.11]] }] } ]
solid = { height = 30, shift = [2.74, 1.175] }
"""
"""A stroke that comes to lie along the copy beyond a centre of rotation, a hundredth of a millimetre from it."""

NEARLY = """
schema = 1
group = "p31m"
cell = { a = 60 }
site = [
  { name = "claw", strokes = [{ segment = [[12, 7], [26, 5]] }] },
  { name = "peg", strokes = [{ point = [30, %s] }] },
]
solid = { height = 30, shift = [0, %s] }
"""


def exact(loft: Loft, z: float, site: int) -> shapely.Geometry:
    """The tile of the strokes at a height, from a design that is flat."""
    sites = []
    for moving, points in zip(loft.motion.moving, loft.motion.points(z), strict=True):
        ends = np.cumsum([line.shape[1] for line in moving.lines])
        lines = np.split(points, ends[:-1])
        sites.append(vt.Site([vt.polyline(line) if len(line) > 1 else vt.point(line[0]) for line in lines]))
    named = [vt.Site(one.strokes, name=moving.name) for one, moving in zip(sites, loft.motion.moving, strict=True)]
    return vt.Design(loft.design.group, loft.design.cell, named).tessellate()[site].to_shapely(accuracy=1e-3)


def apart(one: shapely.Geometry, two: shapely.Geometry) -> float:
    """How far boundaries are from each other, both ways, seen at points a tenth of a millimetre apart."""
    lines = [shapely.segmentize(shape.boundary, 0.1) for shape in (one, two)]
    points = [shapely.points(shapely.get_coordinates(line)) for line in lines]
    return max(float(shapely.distance(at, line).max()) for at, line in zip(points, reversed(lines), strict=True))


@pytest.mark.parametrize(("seed", "kind"), [(3, 0), (4, 1), (15, 0), (34, 4)])
def test_it_is_how_far_sections_are_from_exact_tiles(seed: int, kind: int) -> None:
    """Between any two levels, both ways: what is measured, nearly always, and the accuracy at most."""
    loft = lofted(random_solid(seed, kind))
    found = loft.deviation
    assert found.worst <= loft.accuracy
    shares = []
    for k, (low, high) in enumerate(pairwise(found.heights.tolist())):
        if high - low < 1e-3:
            continue
        heights = [low + share * (high - low) for share in (0.25, 0.5, 0.75)]
        off = max(
            apart(exact(loft, z, site), filled_section(mesh, z))
            for z in heights
            for site, mesh in enumerate(loft.meshes)
        )
        assert off <= loft.accuracy + 0.002
        shares.append(off / found.off[k])
    assert np.median(shares) == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize(("y", "shift"), [(17.1, 0.0), (17.3, 0.0), (17.32, 0.0), (17.1, 0.1)])
def test_copies_that_nearly_meet_are_no_farther_off(y: float, shift: float) -> None:
    """Three points about a centre of rotation, beside which hardly anything moves, make no more layers than asked."""
    loft = lofted(vt.Design.loads(NEARLY % (y, shift)))
    assert len(loft.deviation.heights) == 5
    for low, high in zip(loft.deviation.heights[:-1], loft.deviation.heights[1:], strict=True):
        z = float(low + high) / 2
        off = max(apart(exact(loft, z, site), filled_section(mesh, z)) for site, mesh in enumerate(loft.meshes))
        assert off <= loft.accuracy + 0.002


def test_walls_between_strokes_that_nearly_touch_are_no_farther_off_than_these() -> None:
    """A chord that crosses a copy's stroke, which lies along its own, is off by less than they are apart."""
    loft = lofted(vt.Design.loads(ALONG), heights=[29.6])
    assert len(loft.deviation.heights) < 100
    for low, high in zip(loft.deviation.heights[:-1], loft.deviation.heights[1:], strict=True):
        z = float(low + high) / 2
        assert apart(exact(loft, z, 0), filled_section(loft.meshes[0], z)) <= loft.accuracy + 0.002


def test_damage_is_seen() -> None:
    """A vertex that is moved is off in the slabs beside it, by half of that or less, and at its level, nowhere else."""
    loft = lofted(vt.Design.loads(BIRD))
    (mesh,) = loft.meshes
    heights = loft.deviation.heights
    vertices = mesh.vertices.copy()
    level = len(heights) // 2
    at = int(np.flatnonzero(vertices[:, 2] == heights[level])[0])
    vertices[at, :2] += 1.0
    core = loft.levels[0].core
    about = loft.motion, core.action, core.stabilizers, 1.0
    levels = [level.core.z for level in loft.levels]
    damage = (TriangleMesh(vertices, mesh.triangles),)
    damaged = deviation(damage, *about)
    assert (damaged.off[level - 1 : level + 1] > 0.2).all()
    others = np.delete(np.arange(len(heights) - 1), [level - 1, level])
    assert damaged.off[others] == pytest.approx(loft.deviation.off[others])
    assert equidistance(loft.meshes, *about, levels) < 1e-12
    assert equidistance(damage, *about, levels) > 0.2
    del levels[level]
    assert equidistance(damage, *about, levels) < 1e-12

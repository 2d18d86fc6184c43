"""The narrowest place of a tile, of outlines whose necks are known."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from helpers.outlines import polygon

import voronoi_tiles as vt
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.sweeps.tile_neck import ACCURACY, narrowest
from voronoi_tiles.vector.arcs import LineArc, ParabolaArc
from voronoi_tiles.vector.outline import Outline

DUMBBELL = (0, 10, 10 + 4j, 20 + 4j, 20, 30, 30 + 10j, 20 + 10j, 20 + 5.5j, 10 + 5.5j, 10 + 10j, 10j)
"""Two squares of 10, joined by a bridge of a width of 1.5."""


@pytest.mark.parametrize("turn", [0.0, 0.3, 2.0])
@pytest.mark.parametrize(
    ("corners", "width"),
    [
        ((0, 7, 7 + 3j, 3j), 3.0),
        (DUMBBELL, 1.5),
        ((0, 4, 4 + 1j, 1 + 1j, 1 + 4j, 4j), 1.0),
        ((0, 6, 3 + 4j), 4.0),
        ((0, 10, 10 + 10j, 5 + 2j, 10j), 2.0),
    ],
)
def test_necks_of_polygons(corners: tuple[complex, ...], width: float, turn: float) -> None:
    """A bridge is as wide as it is, however it lies; a polygon without one as its narrowest strip."""
    outline = Outline.from_rings([polygon(*map(complex, corners))]).transformed(
        Isometry(cmath.exp(1j * turn), 5 - 2j, conj=False)
    )
    size = math.hypot(outline.bounds[2] - outline.bounds[0], outline.bounds[3] - outline.bounds[1])
    assert narrowest(outline) == pytest.approx(width, abs=2 * ACCURACY * size)


def test_a_hole_leaves_the_walls_beside_it() -> None:
    """Where a hole comes near the edge, the wall between them is the neck."""
    shell = polygon(0j, 20 + 0j, 20 + 20j, 20j)
    hole = polygon(1 + 5j, 1 + 15j, 11 + 15j, 11 + 5j)
    assert narrowest(Outline.from_rings([shell, hole])) == pytest.approx(1.0, abs=0.02)


def test_a_waist_between_two_parabolas() -> None:
    """Curved sides are followed: the waist of a tile is at the tops of its parabolas."""
    template = polygon(0j, 1 + 0j, 1j)[0]
    neighbour = template.neighbour
    line = (0j, 1 + 0j)  # of no matter here
    outline = Outline.from_rings(
        [
            [
                ParabolaArc(0j, 10 + 8j, 20 + 0j, 10 + 3j, line, neighbour),
                LineArc(20 + 0j, 20 + 10j, neighbour),
                ParabolaArc(20 + 10j, 10 + 2j, 10j, 10 + 7j, line, neighbour),
                LineArc(10j, 0j, neighbour),
            ]
        ]
    )
    assert narrowest(outline) == pytest.approx(2.0, abs=2 * ACCURACY * 25)


def test_the_neck_of_a_tile_is_the_least_distance_of_points_that_see_each_other_across_it() -> None:
    """No two sampled points of the outline far apart along it are nearer than the neck, and some are as near."""
    corners = np.random.default_rng(22).normal(scale=14, size=(4, 2)) + 20
    outline = vt.Design("p2", (60, 60, 90), vt.Site([vt.bezier(corners)])).tessellate()[0].outline
    neck = narrowest(outline)
    ring = outline.flatten(accuracy=0.001)[0]
    parts = np.maximum(np.ceil(np.abs(np.roll(ring, -1) - ring) / 0.05), 1).astype(int)
    points = np.concatenate(
        [a + (b - a) * np.arange(n) / n for a, b, n in zip(ring, np.roll(ring, -1), parts, strict=True)]
    )
    along = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(points)))))
    total = along[-1] + abs(points[0] - points[-1])
    apart = np.abs(along[:, None] - along)
    apart = np.minimum(apart, total - apart)
    far = apart > 2.5 * neck
    least = np.abs(points[:, None] - points)[far].min()
    assert neck == pytest.approx(least, abs=0.05)

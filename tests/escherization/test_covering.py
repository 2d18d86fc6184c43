"""What copies of an outline leave uncovered, and that no tile does better."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from helpers.silhouettes import random_polygon, random_tiling

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import plane
from voronoi_tiles.escherization.covering import covered_area, laid_out, overlap_bound
from voronoi_tiles.escherization.drawn_apart import APART, drawn_apart
from voronoi_tiles.escherization.goal_outline import GoalOutline
from voronoi_tiles.escherization.group_placement import GroupPlacement
from voronoi_tiles.escherization.outline_distance import overlap

CELLS = {"oblique": (1.0, 1.1, 75.0), "rectangular": (1.0, 1.3, 90.0), "square": (1.0,), "hexagonal": (1.0,)}


def placed(silhouette: GoalOutline, group: str, seed: int) -> GroupPlacement:
    """A random placement whose cell has the area of the copies in it."""
    dice, found = np.random.default_rng(seed), vt.GROUPS[group]
    shape = found.lattice(*CELLS[found.system])
    size = math.sqrt(found.order * silhouette.area / shape.det)
    lattice = vt.Lattice(shape.a * size, shape.b * size)
    return GroupPlacement(found, lattice, dice.uniform(0, 6.28), lattice.cartesian(*dice.uniform(-1, 2, 2)))


def counted(silhouette: GoalOutline, placement: GroupPlacement, count: int) -> float:
    """The share of points of a grid over the cell that no copy covers, by all copies that reach into it."""
    lattice, own = placement.lattice, placement.laid(silhouette.points, silhouette.centroid)
    share = (np.arange(count) + 0.5) / count
    s, t = (grid.ravel() for grid in np.meshgrid(share, share))
    points = s * lattice.a + t * lattice.b
    covered = np.zeros(len(points), bool)
    for operation in placement.group.operations:
        for i in range(-6, 7):
            for j in range(-6, 7):
                copy = shapely.Polygon(plane(lattice.isometry(operation.translated(i, j))(own)))
                covered |= shapely.contains_xy(copy, points.real, points.imag)
    return float(1.0 - covered.mean())


def gap(silhouette: GoalOutline, placement: GroupPlacement) -> float:
    """The share of the plane that nothing covers."""
    return 1.0 - covered_area(silhouette, placement) * placement.group.order / placement.lattice.det


@pytest.mark.parametrize("size", [0.9, 1.0, 1.1])
@pytest.mark.parametrize("group", list(vt.GROUPS))
def test_the_gap_is_the_share_of_points_that_nothing_covers(group: str, size: float) -> None:
    """Counted over a grid, for a random outline in each group, of whichever depth its overlaps are, in any cell."""
    silhouette = GoalOutline.of(random_polygon(list(vt.GROUPS).index(group)))
    placement = placed(silhouette, group, 1).scaled(size)
    assert gap(silhouette, placement) == pytest.approx(counted(silhouette, placement, 90), abs=0.02)


def test_what_tiles_leaves_nothing() -> None:
    """A square on its own lattice, also where it lies askew to it; and what lies on another leaves what it must."""
    square = GoalOutline.of([0j, 1 + 0j, 1 + 1j, 1j])
    group = vt.GROUPS["p1"]
    for a, b in ((1 + 0j, 1j), (1 + 0j, 0.3 + 1j)):
        assert gap(square, GroupPlacement(group, vt.Lattice(a, b), 0.0, 5 + 2j)) == pytest.approx(0.0, abs=1e-12)
    wide = GroupPlacement(group, vt.Lattice(0.5 + 0j, 2j), 0.0, 0j)
    assert gap(square, wide) == pytest.approx(0.5)
    assert overlap_bound(square, wide) == pytest.approx(1 / 3)
    assert overlap_bound(square, wide.scaled(2.0)) == pytest.approx(1 / 4)  # of a tile that is four times as large


@pytest.mark.parametrize("seed", range(40))
def test_no_tile_has_more_in_common_with_an_outline_than_the_bound(seed: int) -> None:
    """Tiles of random curves beside random placements, in all groups."""
    tiling = random_tiling(seed, list(vt.GROUPS)[seed % 17])
    tile = tiling[0].to_shapely(accuracy=1e-3)
    silhouette = GoalOutline.of(random_polygon(seed))
    dice = np.random.default_rng(seed)
    silhouette = silhouette.scaled(math.sqrt(tile.area / silhouette.area) * dice.uniform(0.8, 1.2))
    centre = complex(tile.centroid.x, tile.centroid.y) + silhouette.size * 0.1 * complex(*dice.normal(size=2))
    placement = GroupPlacement(tiling.design.group, tiling.design.lattice, dice.uniform(0, 6.28), centre)
    own, _ = laid_out(silhouette, placement)
    bound = overlap_bound(silhouette, placement)
    assert overlap(own, tile) <= bound + 1e-5
    itself = GoalOutline.of(tile)
    place = GroupPlacement(placement.group, placement.lattice, 0.0, itself.centroid)
    assert overlap_bound(itself, place) > 0.997


@pytest.mark.parametrize("group", ["p1", "p2", "p3", "p4", "p6", "pg", "pgg", "cm", "pmg"])
def test_a_stroke_drawn_apart_lies_inside_and_its_copies_keep_apart(group: str) -> None:
    """By APART of the size, but for the corners that are left out; whether lenses are halved or kept as a whole."""
    for seed in range(3):
        silhouette = GoalOutline.of(random_polygon(seed)).unit
        placement = placed(silhouette, group, 2)
        own, _ = laid_out(silhouette, placement)
        corners = drawn_apart(silhouette, placement)
        stroke = shapely.Polygon(plane(corners))
        assert stroke.is_valid
        assert own.buffer(-0.6 * APART).contains(stroke)
        copies = [shapely.Polygon(plane(copy(corners))) for copy in placement.copies(2.0 * silhouette.reach)]
        assert all(copy.distance(stroke) >= 0.3 * APART for copy in copies)


def test_a_limb_that_a_copy_crosses_stays_whole() -> None:
    """A long leg across the foot of a copy: halves would leave the body alone, 0.27 of the area."""
    figure = GoalOutline.of([0j, 10 + 0j, 10 + 4j, 22 + 4j, 22 + 10j, 18 + 10j, 18 + 6j, 10 + 6j, 10 + 10j, 10j])
    group = vt.GROUPS["p1"]
    area = figure.area
    lattice = vt.Lattice(11.6 + 0j, complex(0.0, area / 11.6))
    stroke = shapely.Polygon(plane(drawn_apart(figure, GroupPlacement(group, lattice, 0.0, figure.centroid))))
    assert stroke.area > 0.6 * area

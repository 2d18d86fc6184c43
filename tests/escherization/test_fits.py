"""Designs whose tiles come near to an outline: what is given back, what is known in closed form, what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import shapely
import shapely.affinity
from helpers.silhouettes import lost, random_polygon, random_tiling

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import plane

FREE = ("p1", "p2", "p3", "p4", "p6", "pg", "pgg")


def judged(fit: vt.Fit) -> float:
    """The overlap of a fit, anew: the share of points in the tile's and the outline's box that are in both."""
    tile = shapely.union_all(fit.design.tessellate()[0].to_shapely(accuracy=1e-3))
    left, bottom, right, top = shapely.union(tile, fit.outline).bounds
    share = (np.arange(500) + 0.5) / 500
    x, y = (grid.ravel() for grid in np.meshgrid(left + share * (right - left), bottom + share * (top - bottom)))
    one, other = shapely.contains_xy(tile, x, y), shapely.contains_xy(fit.outline, x, y)
    return float((one & other).sum() / (one | other).sum())


@pytest.mark.parametrize("group", FREE)
def test_a_tile_is_given_back(group: str) -> None:
    """Turned and moved, a random tile finds the group that it is of: overlap 0.995 and more, as points count it."""
    (found,) = vt.fit(lost(random_tiling(5, group), 5), groups=group, keep=1, strokes="outline")
    assert found.group == group
    assert found.overlap >= 0.995
    assert judged(found) == pytest.approx(found.overlap, abs=2e-3)
    assert found.overlap <= found.bound + 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(14))
def test_a_tile_is_given_back_among_all_groups(seed: int) -> None:
    """The best of all is its group's, or one that its tile is of as well."""
    group = FREE[seed % 7]
    best = vt.fit(lost(random_tiling(seed, group), seed), keep=3, strokes="outline")
    assert best[0].overlap >= 0.995
    assert [each.overlap for each in best] == sorted((each.overlap for each in best), reverse=True)


@pytest.mark.parametrize("group", ["pm", "cm", "pmg", "p4g", "p31m"])
def test_groups_with_mirrors_have_straight_edges_and_are_found(group: str) -> None:
    """Where the tile has them, too."""
    (found,) = vt.fit(lost(random_tiling(2, group), 2), groups=group, keep=1, strokes="outline")
    assert found.overlap >= 0.99


def test_discs_are_packed_as_is_best() -> None:
    """What a regular hexagon of the best size has in common with a disc, in closed form: nothing has more."""
    radius = math.sqrt(1 / math.pi)
    area = np.linspace(0.9, 1.1, 2001)
    inner = np.minimum(np.sqrt(area / (2 * math.sqrt(3))), radius)
    common = 1 - 6 * (radius**2 * np.arccos(inner / radius) - inner * np.sqrt(radius**2 - inner**2))
    best = (common / (1 + area - common)).max()
    assert best > (common / (1 + area - common))[1000] + 1e-3  # as large as the disc is not the best
    disc = 20 * radius * np.exp(2j * np.pi * np.arange(240) / 240)
    (found,) = vt.fit(disc, groups="p1", keep=1, strokes="outline")
    assert found.bound == pytest.approx(best, abs=3e-4)
    assert found.overlap == pytest.approx(found.bound, abs=1e-3)
    assert found.neighbours == 6


@pytest.mark.parametrize("seed", range(4))
def test_what_a_fit_says_is_so(seed: int) -> None:
    """Overlap and distance, measured anew; few corners whose tile is as near as asked for; a design to save."""
    outline = random_polygon(seed)
    size = math.sqrt(outline.area)
    (whole,) = vt.fit(outline, groups="p2", keep=1, strokes="outline", name="bird")
    (few,) = vt.fit(outline, groups="p2", keep=1, within=0.01 * size, name="bird")
    assert few.corners < 0.8 * whole.corners
    assert few.overlap >= whole.overlap - 0.05
    for found in (whole, few):
        assert judged(found) == pytest.approx(found.overlap, abs=2e-3)
        assert found.outline.area == pytest.approx(outline.area, rel=2e-3)
        assert found.overlap <= found.bound + 1e-3
        tile = found.tiling[0].to_shapely(accuracy=1e-3)
        reached = shapely.hausdorff_distance(tile.exterior, found.outline.exterior, 0.002)
        assert found.distance == pytest.approx(reached, abs=0.01 * size)
        assert vt.Design.loads(found.design.to_toml()) == found.design
        assert found.design.noded[0].name == "bird"
    apart = shapely.hausdorff_distance(
        few.tiling[0].to_shapely(accuracy=1e-3).exterior, whole.tiling[0].to_shapely(accuracy=1e-3).exterior, 0.002
    )
    assert apart <= 0.01 * size + 0.003 * size


@pytest.mark.parametrize("group", ["pmm", "p6m"])
def test_corners_that_the_tile_does_not_follow_stay_where_they_are(group: str) -> None:
    """Where mirrors enclose it; what is left out is all that changes."""
    (whole,) = vt.fit(random_polygon(3), groups=group, keep=1, strokes="outline")
    few = whole.with_fewer_corners(0.01 * math.sqrt(random_polygon(3).area))
    assert few.corners < whole.corners
    ends = [np.concatenate(each.tiling[0].site.ends) for each in (whole, few)]
    assert set(ends[1].tolist()) < set(ends[0].tolist())


def test_the_search_is_the_same_again_and_on_other_processors() -> None:
    """The same seed, the same designs, digit for digit, by two processes as by one; the size does not matter."""
    outline = random_polygon(9)
    told: list[float] = []
    once = vt.fit(outline, groups=["p1", "p3"], keep=3, strokes="outline", progress=lambda done, _: told.append(done))
    made: list[vt.Fit] = []
    again = vt.fit(outline, groups=["p1", "p3"], keep=3, strokes="outline", workers=2, found=made.append)
    assert [each.design.source for each in once] == [each.design.source for each in again]
    assert sorted(map(id, made)) == sorted(map(id, again))  # each was told, as it was made
    assert told == sorted(told)
    assert told[-1] == 1.0
    large = vt.fit(shapely.affinity.scale(outline, 10, 10), groups=["p1", "p3"], keep=1, strokes="outline")
    assert large[0].overlap == pytest.approx(once[0].overlap, abs=2e-3)


@pytest.mark.parametrize("scale", [1e-4, 1e3, 1e8])
def test_the_unit_does_not_matter(scale: float) -> None:
    """A triangle of micrometres and one of a town have the same tile: also the cell's angle, which has no size."""
    triangle = np.array([0j, 4 + 0j, 3j])
    (one,), (other,) = (vt.fit(triangle * size, groups="p2", keep=1) for size in (1.0, scale))
    assert other.overlap == pytest.approx(one.overlap, abs=1e-4)
    assert other.distance == pytest.approx(one.distance * scale, rel=0.02)
    assert other.design.cell["angle"] == pytest.approx(one.design.cell["angle"], abs=1e-4)


def test_without_mirror_images_there_are_none() -> None:
    """Only groups of rotations and translations are looked in."""
    found = vt.fit(random_polygon(4), groups=["pg", "p3", "pgg"], keep=4, mirrored=False, strokes="outline")
    assert {each.group for each in found} == {"p3"}
    assert not any(neighbour.operation.determinant < 0 for neighbour in found[0].tiling[0].outline.neighbours)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"groups": "p5"}, "`groups` has 'p5'"),
        ({"groups": []}, "`groups`"),
        ({"groups": ["pg"], "mirrored": False}, "none without mirror images"),
        ({"keep": 0}, "`keep`"),
        ({"keep": 2.5}, "`keep` 2.5"),
        ({"within": -1.0}, "`within`"),
        ({"strokes": "many"}, "`strokes`"),
        ({"seed": -1}, "`seed`"),
        ({"seed": 1.5}, "`seed` 1.5"),
        ({"workers": 0}, "`workers`"),
        ({"symmetric": "yes"}, "`symmetric` 'yes' cannot be"),
        ({"mirrored": "no"}, "`mirrored` 'no' cannot be"),
    ],
)
def test_what_cannot_be_asked_for(arguments: dict[str, Any], said: str) -> None:
    """Is refused by its name, before anything is computed."""
    with pytest.raises(vt.ArgumentError, match=said.replace("`", "`")):
        vt.fit(random_polygon(0), **arguments)


def test_a_tile_of_another_outline_is_seen() -> None:
    """The oracle of overlap, and that of distance, tell a wrong design."""
    (found,) = vt.fit(random_polygon(1), groups="p1", keep=1, strokes="outline")
    moved = shapely.Polygon(plane(shapely.get_coordinates(found.outline.exterior)[:-1] @ np.array([1.0, 1j]) + 3.0))
    tile = found.tiling[0].to_shapely(accuracy=1e-3)
    assert tile.intersection(moved).area / tile.union(moved).area < found.overlap - 0.02

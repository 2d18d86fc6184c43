"""What an outline to be fitted may be, and what of it is kept."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.escherization.goal_outline import DETAIL, GoalOutline

SQUARE = [0j, 30 + 0j, 30 + 30j, 30j]


def star(count: int) -> Complexes:
    """A flower of many corners, 40 mm wide."""
    angle = np.arange(count) / count * 2.0 * np.pi
    return np.asarray((15.0 + 5.0 * np.cos(5.0 * angle)) * np.exp(1j * angle))


@pytest.mark.parametrize(
    "outline",
    [
        SQUARE,
        SQUARE[::-1],
        [*SQUARE, 0j],
        [(0, 0), (30, 0), (30, 30), (0, 30)],
        np.array(SQUARE),
        shapely.box(0, 0, 30, 30),
        shapely.MultiPolygon([shapely.box(0, 0, 30, 30)]),
        {"type": "Polygon"} | {"coordinates": [[(0, 0), (30, 0), (30, 30), (0, 30), (0, 0)]]},
    ],
    ids=["complex", "clockwise", "repeated", "pairs", "array", "polygon", "multipolygon", "mapping"],
)
def test_all_ways_to_give_an_outline_are_the_same(outline: Any) -> None:
    """Complex numbers, pairs, polygons: counter-clockwise corners, the first not repeated."""
    if isinstance(outline, dict):
        outline = type("Geo", (), {"__geo_interface__": outline})()
    silhouette = GoalOutline.of(outline)
    assert len(silhouette.points) == 4
    assert set(silhouette.points.tolist()) == set(SQUARE)
    assert (silhouette.area, silhouette.size, silhouette.centroid) == (900.0, 30.0, 15 + 15j)
    assert shapely.LinearRing(shapely.get_coordinates(silhouette.polygon)).is_ccw


def test_a_tile_is_an_outline() -> None:
    """Anything with shapely's interface is."""
    tile = vt.starter("p4").tessellate()[0]
    assert GoalOutline.of(tile).area == pytest.approx(tile.area, rel=1e-3)


def test_many_corners_become_as_many_as_matter() -> None:
    """100,000 of them within DETAIL of the size: a hundred or so."""
    silhouette = GoalOutline.of(star(100_000))
    assert 40 < len(silhouette.points) < 400
    given = shapely.points(plane(star(100_000)[::17]))
    assert shapely.distance(given, silhouette.polygon.exterior).max() < 1.01 * DETAIL * silhouette.size


@pytest.mark.parametrize(
    ("outline", "said"),
    [
        ([0j, 30 + 30j, 30 + 0j, 30j], "it crosses itself at 15, 15"),
        ([0j, 30 + 0j, 10 + 0j, 40 + 0j], "`outline`"),
        ([0j, 30 + 0j], "`outline`"),
        ([0j, 3 + 1j, 6 + 2j, 9 + 3j], "`outline`"),
        ([], "`outline`"),
        ("bird.svg", "`outline` 'bird.svg' cannot be"),
        (7, "`outline` 7 cannot be"),
        ([0j, float("nan"), 1j], "`outline`"),
        ([0j, 1e300, 1e300j], "coordinates beyond"),
        (shapely.LineString([(0, 0), (30, 0), (30, 30)]), "is a LineString"),
        (shapely.box(0, 0, 9, 9).difference(shapely.box(3, 3, 4, 4)), "has holes"),
        (shapely.MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(2, 2, 3, 3)]), "several outlines"),
        (shapely.box(0, 0, 1000, 1), "too thin"),
    ],
)
def test_what_is_no_outline_is_refused(outline: Any, said: str) -> None:
    """In words that say what is wrong, and where."""
    with pytest.raises(vt.ArgumentError) as error:
        GoalOutline.of(outline)
    assert said in str(error.value)
    assert error.value.remedy

"""The transform of an area, against closed forms and sums over points."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from helpers.silhouettes import random_polygon

from voronoi_tiles.escherization.area_transform import FREQUENCY_MAX, AreaTransform, transform
from voronoi_tiles.escherization.goal_outline import GoalOutline


def frequencies(count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Random frequencies up to the highest."""
    dice = np.random.default_rng(seed)
    radius, angle = FREQUENCY_MAX * np.sqrt(dice.random(count)), 2.0 * np.pi * dice.random(count)
    return radius * np.cos(angle), radius * np.sin(angle)


def test_the_transform_of_a_rectangle_is_a_product() -> None:
    """Of sines over their arguments, also along the axes, where the formula's terms vanish."""
    box = GoalOutline(np.array([-1 - 0.5j, 1 - 0.5j, 1 + 0.5j, -1 + 0.5j]))
    x, y = frequencies(200)
    x[:20], y[20:40] = 0.0, 0.0
    assert np.abs(transform(box, x, y) - 2.0 * np.sinc(2.0 * x) * np.sinc(y)).max() < 1e-14


@pytest.mark.parametrize("seed", range(5))
def test_the_table_is_the_integral(seed: int) -> None:
    """Over points of a fine grid that lie inside, for random polygons of area 1 about their centroid."""
    unit = GoalOutline.of(random_polygon(seed)).unit
    assert unit.area == pytest.approx(1.0)
    assert abs(unit.centroid) < 1e-12
    step = 2.0 * unit.reach / 400
    place = (np.arange(400) + 0.5) * step - unit.reach
    u, v = (grid.ravel() for grid in np.meshgrid(place, place))
    inside = shapely.contains_xy(unit.polygon, u, v)
    x, y = frequencies(40, seed)
    sums = np.exp(-2j * np.pi * (x[:, None] * u[inside] + y[:, None] * v[inside])).sum(axis=1) * step**2
    found = AreaTransform.of(unit)(x, y)
    assert np.abs(found - sums).max() < 5e-3
    assert np.abs(found - transform(unit, x, y)).max() < 1e-4


def test_it_vanishes_at_the_reciprocal_lattice_of_a_tile() -> None:
    """Of any that tiles by translations alone, here a hexagon of three pairs of equal sides."""
    half = [1.0 - 0.4j, 0.9 + 0.6j, -0.1 + 1.0j]
    silhouette = GoalOutline(np.array([*half, *(-point for point in half)]))
    a, b = half[2] - half[0], -half[0] - half[1]
    det = a.real * b.imag - a.imag * b.real
    assert abs(det) == pytest.approx(silhouette.area)
    i, j = (grid.ravel().astype(float) for grid in np.meshgrid(np.arange(-3, 4), np.arange(-3, 4)))
    x, y = (i * b.imag - j * a.imag) / det, (-i * b.real + j * a.real) / det
    other = (i != 0) | (j != 0)
    assert np.abs(transform(silhouette, x[other], y[other])).max() < 1e-13

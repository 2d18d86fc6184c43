"""How much of each pixel lies within outlines: beside shapely's intersections of polygons."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.pictures.area_coverage import Floats32, area_coverage

WIDTH, HEIGHT = 9, 7


def sides(*rings: Complexes) -> tuple[Complexes, Complexes]:
    """The sides of closed polygons."""
    return np.concatenate(rings), np.concatenate([np.roll(ring, -1) for ring in rings])


def by_shapely(*rings: Complexes) -> Floats32:
    """The coverage of a polygon, the first ring, with holes, by clipping it with each pixel."""
    shell, *holes = ([(z.real, z.imag) for z in ring.tolist()] for ring in rings)
    polygon = shapely.Polygon(shell, holes)
    boxes = [[shapely.box(j, i, j + 1, i + 1) for j in range(WIDTH)] for i in range(HEIGHT)]
    return np.array(shapely.area(shapely.intersection(polygon, boxes)), np.float32)


def star(rng: np.random.Generator, middle: complex, size: float) -> Complexes:
    """A star-shaped polygon about a point."""
    count = int(rng.integers(3, 12))
    angles = np.sort(rng.random(count) + np.arange(count)) / count * 2 * np.pi
    corners: Complexes = middle + size * rng.uniform(0.3, 1.0, count) * np.exp(1j * angles)
    return corners


@pytest.mark.parametrize("seed", range(20))
def test_coverage_is_the_area_of_each_pixel_within(seed: int) -> None:
    """Every pixel of random polygons has the area that clipping gives, also of those that reach beyond the image."""
    rng = np.random.default_rng(seed)
    ring = star(rng, complex(rng.uniform(0, WIDTH), rng.uniform(0, HEIGHT)), rng.uniform(0.2, 8.0))
    found = area_coverage(*sides(ring), WIDTH, HEIGHT)
    np.testing.assert_allclose(found, by_shapely(ring), atol=1e-6)
    backwards = area_coverage(*sides(ring[::-1]), WIDTH, HEIGHT)
    np.testing.assert_allclose(backwards, found, atol=1e-6)


def test_holes_are_left_out_and_sides_may_lie_on_pixels_borders() -> None:
    """A square with a hole, on the grid of pixels and beside it, covers what it covers."""
    square = np.array([0, 1, 1 + 1j, 1j])
    for shift in (0j, 0.25 + 0.5j):
        shell, hole = 1 + 1j + shift + 5 * square, 2 + 2j + shift + 2 * square[::-1]
        found = area_coverage(*sides(shell, hole), WIDTH, HEIGHT)
        np.testing.assert_allclose(found, by_shapely(shell, hole), atol=1e-6)
        assert found.sum() == pytest.approx(21)


def test_the_oracle_sees_a_pixel_that_is_off() -> None:
    """The comparison can fail."""
    ring = star(np.random.default_rng(1), 4 + 3j, 3.0)
    wrong = by_shapely(ring)
    wrong[3, 4] -= 0.01
    with pytest.raises(AssertionError):
        np.testing.assert_allclose(area_coverage(*sides(ring), WIDTH, HEIGHT), wrong, atol=1e-6)


def test_nothing_covers_nothing() -> None:
    """Without sides, and where all lie beyond the image, no pixel is covered."""
    none = np.zeros(0, complex)
    assert not area_coverage(none, none, WIDTH, HEIGHT).any()
    far = 100 + 100j + np.array([0, 1, 1j])
    assert not area_coverage(*sides(far), WIDTH, HEIGHT).any()

"""What the search of placements makes small: the Fourier coefficients of all copies together."""

from __future__ import annotations

import math

import numpy as np
import pytest
from helpers.silhouettes import random_polygon

import voronoi_tiles as vt
from voronoi_tiles.escherization.area_transform import AreaTransform, transform
from voronoi_tiles.escherization.covering import overlap_bound
from voronoi_tiles.escherization.goal_outline import GoalOutline
from voronoi_tiles.escherization.placement_rows import PlacementRows
from voronoi_tiles.escherization.placement_search import PlacementSearch
from voronoi_tiles.escherization.polishing import found_placements, polished

HIGHEST = 2.3


def search_of(group: str, seed: int) -> tuple[GoalOutline, PlacementSearch, np.ndarray]:
    """The search of a random outline in a group, and some rows within its bounds."""
    unit = GoalOutline.of(random_polygon(seed)).unit
    search = PlacementSearch(PlacementRows.everywhere(vt.GROUPS[group], unit.width), AreaTransform.of(unit))
    low, high = search.among.low, search.among.high
    return unit, search, low + (high - low) * np.random.default_rng(seed).random((6, len(low)))


def summed(unit: GoalOutline, among: PlacementRows, row: np.ndarray) -> float:
    """The sum of squares over all reciprocal vectors below HIGHEST but 0, from each copy's own polygon, in full.

    It fades out as the search says: by a quarter of a cosine.
    """
    placement = among.placement(row)
    lattice, own = placement.lattice, placement.laid(unit.points, unit.centroid)
    reach = 2 * math.ceil(HIGHEST * max(abs(lattice.a), abs(lattice.b)))
    i, j = (grid.ravel() for grid in np.meshgrid(*[np.arange(-reach, reach + 1)] * 2))
    x = (i * lattice.b.imag - j * lattice.a.imag) / lattice.det
    y = (j * lattice.a.real - i * lattice.b.real) / lattice.det
    length = np.hypot(x, y)
    x, y, length = (each[(length > 0) & (length < HIGHEST)] for each in (x, y, length))
    total = np.zeros(len(x), complex)
    for operation in placement.group.operations:
        image = lattice.isometry(operation)(own)
        total += transform(GoalOutline(image[::-1] if operation.determinant < 0 else image), x, y)
    return float(((np.abs(total) / placement.group.order * np.cos(0.5 * np.pi * length / HIGHEST)) ** 2).sum())


@pytest.mark.parametrize("group", list(vt.GROUPS))
def test_one_wave_of_each_orbit_stands_for_all(group: str) -> None:
    """In every group, centred and hexagonal ones too: no wave is missing, doubled, or of a wrong phase."""
    unit, search, rows = search_of(group, list(vt.GROUPS).index(group))
    values = (search._residuals(rows, search._waves(HIGHEST), HIGHEST) ** 2).sum(axis=1)
    expected = [summed(unit, search.among, row) for row in rows]
    assert values == pytest.approx(expected, abs=2e-4, rel=2e-4)
    elsewhere = rows.copy()
    elsewhere[:, 0] += 0.3
    moved = (search._residuals(elsewhere, search._waves(HIGHEST), HIGHEST) ** 2).sum(axis=1)
    assert np.abs(moved - expected).max() > 2e-3


@pytest.mark.parametrize("group", ["p1", "p2", "cm", "cmm", "p4g", "p31m"])
def test_minima_are_lower_than_all_that_is_near(group: str) -> None:
    """The best row of a search, and steps from it in all directions."""
    _, search, _ = search_of(group, 3)
    best = search.found()[0]
    waves = search._waves(4.0)
    steps = np.vstack([np.zeros(len(best)), 0.02 * np.eye(len(best)), -0.02 * np.eye(len(best))])
    values = (search._residuals(search.among.clipped(best + steps), waves, 4.0) ** 2).sum(axis=1)
    assert values[0] <= values[1:].min() + 1e-6


@pytest.mark.parametrize("group", ["p2", "pg", "p6m"])
def test_led_on_placements_have_tiles_that_overlap_no_less(group: str) -> None:
    """Good ones more; poor ones, whose tiles nobody wants, stay where they are, as looks at them take long."""
    unit = GoalOutline.of(random_polygon(5)).unit
    among = PlacementRows.everywhere(vt.GROUPS[group], unit.width)
    for found in found_placements(unit, among, AreaTransform.of(unit), 0)[:3]:
        placement, bound = polished(unit, found)
        assert bound == pytest.approx(overlap_bound(unit, placement), abs=1e-9)
        assert bound >= found.bound
        poor = found._replace(free=found.free + np.array([0.4, *[0.0] * (len(found.free) - 1)]), bound=0.5)
        assert polished(unit, poor)[0].turn == poor.free[0]

"""Pairs of boxes that overlap: against the definition."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from voronoi_tiles.base.box_join import overlapping_boxes, points_in_boxes


@pytest.mark.parametrize("count", [2, 9, 70, 600])
def test_overlapping_boxes_are_all_found(count: int) -> None:
    """The tree gives the pairs that the definition gives."""
    rng = np.random.default_rng(count)
    start = rng.uniform(size=count) + 1j * rng.uniform(size=count)
    ends = np.stack([start, start + 0.1 * (rng.normal(size=count) + 1j * rng.normal(size=count))], axis=1)
    i, j = overlapping_boxes(ends, 0.0)
    x, y = ends.real, ends.imag
    wanted = {
        (p, q)
        for p, q in combinations(range(count), 2)
        if x[p].min() <= x[q].max()
        and x[q].min() <= x[p].max()
        and y[p].min() <= y[q].max()
        and y[q].min() <= y[p].max()
    }
    assert len(i) == len(wanted)
    assert set(zip(i.tolist(), j.tolist(), strict=True)) == wanted


@pytest.mark.parametrize("count", [1, 7, 300])
def test_points_in_boxes(count: int) -> None:
    """Every point in a box is found with it, those on its sides too, and also where boxes have no width."""
    rng = np.random.default_rng(count)
    points = np.empty(500, np.complex128)
    points.real = rng.integers(0, 40, 500) + (rng.random(500) < 0.5) * rng.random(500)
    points.imag = rng.integers(0, 40, 500)
    low = rng.integers(0, 30, count) + 1j * rng.integers(0, 30, count)
    high = low + rng.integers(0, 9, count) + 1j * rng.integers(0, 9, count)
    point, box = points_in_boxes(points, low, high)
    expected = [
        (p, b)
        for b in range(count)
        for p, z in enumerate(points.tolist())
        if low[b].real <= z.real <= high[b].real and low[b].imag <= z.imag <= high[b].imag
    ]
    assert sorted(zip(point.tolist(), box.tolist(), strict=True), key=lambda pair: pair[::-1]) == expected
    assert (np.diff(box) >= 0).all()


def test_points_in_one_box_without_width() -> None:
    """A single place is a box."""
    point, box = points_in_boxes(np.array([1 + 1j, 2 + 1j, 1 + 1j]), np.array([1 + 1j]), np.array([1 + 1j]))
    assert (point.tolist(), box.tolist()) == ([0, 2], [0, 0])

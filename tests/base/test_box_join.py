"""Pairs of boxes that overlap: against the definition."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from voronoi_tiles.base.box_join import overlapping_boxes


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

"""Halves of symmetric paths, and their images."""

from __future__ import annotations

import numpy as np
import pytest

from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.paths.symmetric_halves import doubled, first_half, moved


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_a_half_and_its_image_are_the_whole(count: int) -> None:
    """A path across the upright axis, with a corner there or an arc: the arc is one again."""
    mirror = Isometry(-1 + 0j, 0j, conj=True)
    right = np.array([1 + 1j, 2 + 0.5j, 3 + 0j])[: (count + 1) // 2]
    points = np.concatenate((right[::-1], [2j] if count % 2 == 0 else [], -right.conj()))
    path = Paths.polylines([points])
    if count % 2:
        path.kind[count // 2], path.control[count // 2, 0] = ARC, 1.5j
    whole = doubled(first_half(path), mirror, complex(path.end[-1]))
    assert whole.kind.tolist() == path.kind.tolist()
    assert np.abs(whole.start - path.start).max() < 1e-15
    assert np.abs(whole.control - path.control).max() < 1e-15
    assert (whole.kind == LINE).sum() == (path.kind == LINE).sum()
    assert whole.end[-1] == path.end[-1]


def test_an_image_is_an_image() -> None:
    """Start, end and control points where the isometry takes them."""
    path = Paths.polylines([np.array([5, 3j])])
    path.kind[0], path.control[0, 0] = ARC, 3 + 3j
    turned = moved(path, Isometry(1j, 1 + 0j, conj=True))
    assert (turned.start[0], turned.control[0, 0], turned.end[0]) == (1 + 5j, 4 + 3j, 4 + 0j)

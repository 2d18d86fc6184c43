"""Boxes that meet others: as by comparing all with all, with the compiled kernel and without."""

from __future__ import annotations

import numpy as np
import pytest

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.box_index import BoxIndex


@pytest.fixture(autouse=True, params=["compiled", "numpy"])
def _kernels(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the kernel and without."""
    if request.param == "compiled":
        request.getfixturevalue("compiled")
    else:
        monkeypatch.setenv("VORONOI_TILES_KERNELS", "numpy")


def boxes(count: int, size: float, digits: int, seed: int) -> tuple[Complexes, Complexes]:
    """The corners of random boxes up to a size, in a square of 100; of 0 digits they are on a grid, and touch."""
    rng = np.random.default_rng(seed)
    x, y, width, height = np.round(rng.uniform(0, 1, (4, count)) * np.array([100, 100, size, size])[:, None], digits)
    return x + 1j * y, (x + width) + 1j * (y + height)


@pytest.mark.parametrize("count", [1, 8, 9, 64, 65, 700])
@pytest.mark.parametrize(("size", "digits"), [(0.0, 0), (3.0, 0), (3.0, 9), (90.0, 1)])
def test_all_that_meet_are_found_in_order(count: int, size: float, digits: int) -> None:
    """Points, boxes that only touch, and some that meet hundreds: each pair once, in the order of both numbers."""
    low, high = boxes(count, size, digits, 1)
    first, last = boxes(150, 4.0, digits, 2)
    apart = (first.real[:, None] > high.real) | (last.real[:, None] < low.real)
    apart |= (first.imag[:, None] > high.imag) | (last.imag[:, None] < low.imag)
    i, j = BoxIndex(low, high).meeting(first, last)
    assert i.dtype == j.dtype == np.dtype(np.intp)
    assert [i.tolist(), j.tolist()] == [k.tolist() for k in np.nonzero(~apart)]


@pytest.mark.parametrize(("count", "asked"), [(20, 0), (0, 20), (0, 0)])
def test_there_are_none(count: int, asked: int) -> None:
    """Without boxes, here or there, there are no pairs."""
    i, j = BoxIndex(*boxes(count, 3.0, 9, 1)).meeting(*boxes(asked, 3.0, 9, 2))
    assert len(i) == len(j) == 0
    assert i.dtype == j.dtype == np.dtype(np.intp)

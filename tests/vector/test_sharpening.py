"""Points between copies that nearly touch: where they are put, by arithmetic that is exact."""

from __future__ import annotations

import numpy as np
import pytest

from voronoi_tiles.vector.complex.sharpening import sharpened
from voronoi_tiles.vector.complex.traced import Traced

GAP = 2.0**-20


def arc(*, curved: bool) -> Traced:
    """One arc: the bisector of two nodes, or of a focus and a line along x, that are GAP apart across the origin."""
    none = np.zeros(1, np.intp)
    nodes = np.array([[-GAP / 2, GAP / 2]], complex)
    return Traced(
        vertex=np.array([64j]),
        offsets=np.array([0, 1]),
        ring_tile=none,
        site=none,
        motion=none,
        curved=np.array([curved]),
        focus=np.array([GAP * 1j]),
        directrix=np.array([[0, 1]], complex),
        nodes=np.full((1, 2), np.nan + 0j) if curved else nodes,
    )


@pytest.mark.parametrize("off", [2.0**-30, -(2.0**-34)])
def test_a_point_is_put_onto_its_bisector(off: float) -> None:
    """Along the other arc that ends there, and the one that crosses most; an arc without a direction is none."""
    here = 64j + off
    assert sharpened(arc(curved=False), 0, here, [1j, 0j, 1 + 1j]) == 64j - off * 1j
    assert sharpened(arc(curved=False), 0, here, [0j]) == here
    assert sharpened(arc(curved=False), 0, here, []) == here


def test_a_point_is_put_onto_a_thin_parabola() -> None:
    """s^2 + q^2 = 2 q h, with q the distance of the focus from the directrix."""
    height = 64.0
    exact = complex((2 * GAP * height - GAP**2) ** 0.5, height)
    found = sharpened(arc(curved=True), 0, exact + 1e-9, [1 + 0j])
    assert abs(found - exact) < 1e-15
    assert found.imag == height


def test_where_nothing_nearly_touches_a_point_stays() -> None:
    """Seen from as near as the two are to each other, their distance is well known."""
    for curved in (False, True):
        assert sharpened(arc(curved=curved), 0, 4 * GAP * 1j + GAP, [1 + 0j]) == 4 * GAP * 1j + GAP

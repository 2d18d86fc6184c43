"""Integrals of curvature over arcs of parabolas, against high precision."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from helpers.outlines import RIGHT

from voronoi_tiles.gradients.bending import NODES, bending_weights
from voronoi_tiles.vector.arcs import LineArc, ParabolaArc, parabola_controls
from voronoi_tiles.vector.outline import Outline


def arc(x0: float, x1: float, q: float) -> Outline:
    """An arc over a directrix along x, with its focus at q i, between two abscissas in focal distances; and a line."""
    s = np.array([x0, x1]) * q
    ends = s + 1j * (s**2 + q * q) / (2 * q)
    directrix = np.array([[0j, 1 + 0j]])
    control = parabola_controls(ends[:1], ends[1:], np.array([1j * q]), directrix)[0]
    start, end = map(complex, ends)
    return Outline.from_rings(
        [[ParabolaArc(start, complex(control), end, 1j * q, (0j, 1 + 0j), RIGHT), LineArc(end, start, RIGHT)]]
    )


@pytest.mark.parametrize("q", [1.0, 1e-3, 40.0])
@pytest.mark.parametrize(("x0", "x1"), [(0.0, 0.5), (-1.0, 3.0), (2.0, 1.5), (-300.0, 4.0), (40.0, 41.0), (9e3, -1e4)])
@pytest.mark.parametrize("part", [(0.0, 1.0), (0.25, 0.75)])
def test_weights_integrate_cubics_times_curvature(x0: float, x1: float, q: float, part: tuple[float, float]) -> None:
    """Of any cubic, over the whole arc and a part, short and long, to 12 digits; of lines nothing."""
    outline = arc(x0, x1, q)
    begin, end = (np.array([float(t)] * 2) for t in part)
    weights = bending_weights(outline, np.arange(2), begin, end)
    assert (weights[1] == 0.0).all()
    at = (part[0] + part[1]) / 2 + (part[1] - part[0]) / 2 * NODES
    turn = 1.0 if x1 > x0 else -1.0
    with mpmath.workdps(30):
        for coefficients in ((1, 0, 0, 0), (0, 1, 0, 0), (2, -3, 1, 5)):

            def integrand(t: mpmath.mpf, cubic: tuple[int, ...] = coefficients) -> mpmath.mpf:
                x = x0 + (x1 - x0) * t
                return sum(c * t**k for k, c in enumerate(cubic)) / q / (1 + x * x) ** mpmath.mpf(1.5)

            inner = [t for t in (x0 / (x0 - x1) + s / (x1 - x0) for s in (-10, -1, 0, 1, 10)) if part[0] < t < part[1]]
            right = turn * float(mpmath.quad(integrand, sorted([*part, *inner])))
            found = float(weights[0] @ np.polynomial.polynomial.polyval(at, coefficients))
            scale = float(np.abs(weights[0]).sum())
            assert found == pytest.approx(right, rel=1e-10, abs=1e-12 * scale)

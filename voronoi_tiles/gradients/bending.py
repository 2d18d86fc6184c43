"""Integrals of curvature times a cubic over arcs of parabolas, as weights of the cubic's values at Gauss's nodes."""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints, counting
from voronoi_tiles.vector.outline import Outline

NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)
"""Gauss's nodes in (-1, 1), and their weights: exact for polynomials of degree 7."""

_PANEL: Final = np.polynomial.legendre.leggauss(10)
"""Nodes and weights on a panel of length 1 in asinh of the parameter: the integrand's poles are pi / 2 away, and what
is left out is 1e-16 of it."""

_BASIS: Final = np.linalg.inv(np.vander(NODES, increasing=True))
"""The polynomials that are 1 at one of the nodes and 0 at the others, by columns, lowest power first."""


def bending_weights(outline: Outline, arc: Ints, begin: Floats, end: Floats) -> Floats:
    """The weights w with sum(w p(t)) = the integral of curvature p dt over parts of arcs, for cubics p: float64 (k, 4).

    t are the parts' Gauss nodes in the arcs' parameters, from `begin` to `end` each. Curvature is > 0 where the outline
    turns left. With x the coordinate along the directrix over the focal distance q the curvature is
    (1 + x^2)^(-3/2) / q; x = sinh(u) leaves p / cosh(u)^2, integrated panel by panel.
    """
    result = np.zeros((len(arc), 4))
    chosen = np.flatnonzero(outline.curved[arc])
    if not len(chosen):
        return result
    arc, begin, end = arc[chosen], begin[chosen], end[chosen]
    focus, directrix = outline.focus[arc], outline.directrix[arc]
    axis = directrix[:, 1] - directrix[:, 0]
    axis = axis / np.abs(axis)
    q = np.abs(((focus - directrix[:, 0]) * axis.conj()).imag)
    ends = [((z - focus) * axis.conj()).real / q for z in (outline.start[arc], outline.end[arc])]
    x0, x1 = (ends[0] + (ends[1] - ends[0]) * t for t in (begin, end))
    u0, u1 = np.arcsinh(x0), np.arcsinh(x1)
    panels = np.maximum(np.ceil(np.abs(u1 - u0)), 1.0).astype(np.intp)
    panel, of = counting(panels)
    u = u0[of, None] + ((u1 - u0) / panels)[of, None] * (panel[:, None] + (1.0 + _PANEL[0]) / 2.0)
    place = 2.0 * (np.sinh(u) - x0[of, None]) / (x1 - x0)[of, None] - 1.0
    values = np.vander(place.ravel(), 4, increasing=True) @ _BASIS / np.cosh(u).ravel()[:, None] ** 2
    sums = np.einsum("knj,n->kj", values.reshape(*u.shape, 4), _PANEL[1] / 2.0)
    np.add.at(weights := np.zeros((len(arc), 4)), of, sums)
    scale = (end - begin) * (u1 - u0) / panels / (q * (x1 - x0))
    turn = (outline.control[arc] - outline.start[arc]).conj() * (outline.end[arc] - outline.control[arc])
    result[chosen] = (np.sign(turn.imag) * scale)[:, None] * weights
    return result

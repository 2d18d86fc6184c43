"""No-fit polygons: where the place of one polygon overlaps another that stays.

The boundaries of two polygons have a convolution: each edge of the one, added to each corner of the other whose turn
passes through the edge's direction. It winds around a place as many times as the polygons have parts in common when
one of them lies there; so its faces with a winding number above 0 make the no-fit polygon, bays and slots and all.

Source: L. Guibas, L. Ramshaw and J. Stolfi, A kinetic framework for computational geometry, 1983; R. Wein, Exact and
efficient construction of planar Minkowski sums using the convolution method, 2006.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, plane
from voronoi_tiles.base.maps import unit_at

_GRID: Final = 2.0**-20
"""Corners are moved to multiples of this, so that sums of them are exact and parallel edges lie on each other;
millimetres."""

_TURN_DIGITS: Final = 7
"""Decimals of degrees in which turns are told apart; that much less moves no piece by more than a nanometre or so."""

_ROWS: Final = 1 << 21
"""Most pairs of a place and an edge that are looked at in one go; a count."""


def no_fit(stays: Complexes, moves: Complexes) -> Any:
    """Where the place of `moves` overlaps `stays`, simple polygons (complex128, n): a polygon, perhaps with holes.

    Its outer ring runs counter-clockwise, holes clockwise.
    """
    import shapely

    start, end = _convolution(_rounded(stays), _rounded(-moves))
    lines = shapely.linestrings(np.stack((plane(start), plane(end)), axis=1))
    faces = shapely.get_parts(shapely.polygonize([shapely.union_all(lines)]))
    inner = shapely.get_coordinates(shapely.point_on_surface(faces))
    whole = shapely.union_all(faces[_winding(start, end, inner[:, 0] + 1j * inner[:, 1]) > 0])
    # A face that rounding parts from the others is a sliver.
    return shapely.orient_polygons(max(shapely.get_parts(whole), key=shapely.area))


def _rounded(ring: Complexes) -> Complexes:
    """A ring with its corners on a grid, counter-clockwise, without edges that have no length."""
    held = np.asarray(_GRID * (np.round(ring.real / _GRID) + 1j * np.round(ring.imag / _GRID)), np.complex128)
    held = held[held != np.roll(held, -1)]
    return np.asarray(held if (held.conj() * np.roll(held, -1)).imag.sum() > 0 else held[::-1])


def _convolution(one: Complexes, other: Complexes) -> tuple[Complexes, Complexes]:
    """Starts and ends of the edges of the convolution of two rings that run counter-clockwise."""
    edges = np.concatenate((np.roll(one, -1) - one, np.roll(other, -1) - other))
    # Directions are compared as whole numbers, so that nothing is lost or counted twice where edges are parallel.
    _, rank = np.unique(np.angle(edges + 0.0), return_inverse=True)
    rank, other_rank = np.split(2 * rank, [len(one)])
    # The other ring is thought to be turned by a little.
    parts = [_summed(one, rank, other, other_rank + 1), _summed(other, other_rank + 1, one, rank)]
    return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])


def _summed(corners: Complexes, rank: Ints, ring: Complexes, ring_rank: Ints) -> tuple[Complexes, Complexes]:
    """Starts and ends of a ring's edges at those corners that turn through their directions, backwards at bays."""
    around = int(max(rank.max(), ring_rank.max())) + 2
    before, after = np.roll(rank, 1), rank
    edges = np.roll(corners, -1) - corners
    left = (np.roll(edges, 1).conj() * edges).imag > 0.0
    low, high = np.where(left, before, after), np.where(left, after, before)
    turned = ((ring_rank - low[:, None]) % around) < ((high - low) % around)[:, None]
    corner, edge = np.nonzero(turned)
    start, end = corners[corner] + ring[edge], corners[corner] + np.roll(ring, -1)[edge]
    return np.where(left[corner], start, end), np.where(left[corner], end, start)


def _winding(start: Complexes, end: Complexes, places: Complexes) -> Ints:
    """How many times segments of closed curves wind around places."""
    result = np.zeros(len(places), np.intp)
    step = max(_ROWS // len(start), 1)
    for first in range(0, len(places), step):
        z = places[first : first + step, None]
        low, high = start.imag <= z.imag, end.imag <= z.imag
        on_left = ((start - z).conj() * (end - z)).imag
        result[first : first + step] = ((low & ~high) & (on_left > 0)).sum(axis=1) - (
            (~low & high) & (on_left < 0)
        ).sum(axis=1)
    return result


class NoFits:
    """No-fit polygons of some pieces, turned, as they are asked for: each relation is computed once."""

    def __init__(self, rings: Sequence[Complexes]) -> None:
        self._rings = rings
        self._known: dict[tuple[int, int, float], Complexes] = {}

    def edges(self, stays: int, turn: float, moves: int, other_turn: float) -> Floats:
        """The edges of the no-fit polygon of two pieces turned by degrees, float64 (n, 4), the region to their left."""
        edges = self._edges(stays, moves, other_turn - turn) * unit_at(turn)
        return edges.view(np.float64).reshape(-1, 4)

    def _edges(self, stays: int, moves: int, turn: float) -> Complexes:
        """The same where what stays is not turned: starts and ends, complex128 (n, 2)."""
        turn = round(turn % 360.0, _TURN_DIGITS) % 360.0
        key, other = (stays, moves, turn), (moves, stays, round(-turn % 360.0, _TURN_DIGITS) % 360.0)
        if key not in self._known:
            if other in self._known:
                self._known[key] = -self._known[other] * unit_at(turn)
            else:
                region = no_fit(self._rings[stays], self._rings[moves] * unit_at(turn))
                self._known[key] = _edges_of(region)
        return self._known[key]


def _edges_of(region: Any) -> Complexes:
    """Starts and ends of the edges of a polygon's rings, complex128 (n, 2)."""
    import shapely

    rings = [shapely.get_coordinates(ring) @ [1, 1j] for ring in (region.exterior, *region.interiors)]
    return np.concatenate([np.column_stack((z[:-1], z[1:])) for z in rings])

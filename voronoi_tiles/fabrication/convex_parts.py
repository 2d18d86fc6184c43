"""Polygons as the unions of convex parts, and what comes of moving one along another: sums of parts are quickly found.

Sources: G. H. Meisters, Polygons have ears, 1975, for the triangles; S. Hertel and K. Mehlhorn, Fast triangulation of
simple polygons, 1983, for joining them: at most four times as many parts as there have to be.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, plane

_LARGER: Final = 1e-8
"""By how much sums are larger than they are, a share, lest rounding leaves cracks between those of neighbours."""


def convex_parts(ring: Complexes) -> Complexes:
    """The corners of convex polygons that make up a simple polygon (complex128, n): complex128 (k, m).

    They are corners of the polygon; the last one of those with fewer than m is repeated.
    """
    if _doubled_area(ring) < 0.0:
        ring = ring[::-1]
    parts = _triangles(ring)
    of_side = {side: part for part in parts for side in _sides(part)}
    for a, b in [side for side in of_side if side[0] < side[1] and side[::-1] in of_side]:
        one, two = of_side[a, b], of_side[b, a]
        k, m = one.index(b), two.index(a)
        joined = [*one[k:], *one[:k], *[*two[m:], *two[:m]][1:-1]]
        # It begins at b, and a is where the one ends.
        if all(_cross(ring, joined, at) >= 0.0 for at in (0, len(one) - 1)):
            of_side.update(dict.fromkeys(_sides(joined), joined))
            del of_side[a, b], of_side[b, a]
    found = list({id(part): part for part in of_side.values()}.values())
    most = max(map(len, found))
    return np.array([ring[[*part, *[part[-1]] * (most - len(part))]] for part in found])


def _sides(part: Sequence[int]) -> list[tuple[int, int]]:
    """The sides of a polygon of numbers of corners, each from one to the next."""
    return list(zip(part, [*part[1:], part[0]], strict=True))


def _cross(ring: Complexes, part: Sequence[int], at: int) -> float:
    """Twice the area of the triangle at a corner of a polygon, above 0 where that is convex."""
    before, here, after = (complex(ring[part[(at + k) % len(part)]]) for k in (-1, 0, 1))
    return ((here - before).conjugate() * (after - here)).imag


def _triangles(ring: Complexes) -> list[list[int]]:
    """Triangles of the corners of a counter-clockwise polygon that make it up, those without an area left out."""
    left, found = list(range(len(ring))), []
    while len(left) > 3:
        bends = [_cross(ring, left, at) for at in range(len(left))]
        hollow = ring[[k for k, bend in zip(left, bends, strict=True) if bend <= 0.0]]
        # A corner is an ear where the triangle there holds no other one; the blunt ones first give better triangles.
        ears = (at for at in np.argsort(np.negative(bends), kind="stable").tolist() if _is_ear(ring, left, at, hollow))
        at = next((at for at, bend in enumerate(bends) if bend == 0.0), None)
        at = next(ears, int(np.argmax(bends))) if at is None else at
        if bends[at] != 0.0:
            found.append([left[at - 1], left[at], left[(at + 1) % len(left)]])
        del left[at]
    return [*found, left]


def _is_ear(ring: Complexes, left: Sequence[int], at: int, hollow: Complexes) -> bool:
    """Whether the triangle at a corner holds none of the hollow corners but its own."""
    corners = ring[[left[at - 1], left[at], left[(at + 1) % len(left)]]]
    inside: Bools = np.ones(len(hollow), np.bool_)
    for here, there in zip(corners, np.roll(corners, -1), strict=True):
        inside &= ((there - here).conjugate() * (hollow - here)).imag >= 0.0
    return _cross(ring, left, at) > 0.0 and not (inside & ~np.isin(hollow, corners)).any()


def _doubled_area(ring: Complexes) -> float:
    """Twice the area of a polygon, below 0 where it runs clockwise."""
    return float((ring.conj() * np.roll(ring, -1)).imag.sum())


def overlaps(stays: Complexes, moves: Complexes, within: tuple[float, float, float, float]) -> list[Any]:
    """Where the place of one of some convex polygons overlaps one of those that stay: convex shapely polygons.

    Both are rows of corners (complex128, k x n), of which some may be the same; those that stay may be lines. Only what
    meets the box `within` (x0, y0, x1, y1) is given.
    """
    import shapely

    one, other = _boxes(stays), _boxes(moves)
    low, high = one[:, None, :2] - other[:, 2:], one[:, None, 2:] - other[:, :2]
    stay, move = np.nonzero(((low < within[2:]) & (high > within[:2])).all(axis=2))
    (corner, sides), (other_corner, other_sides) = _walks(stays), _walks(-moves)
    # Around a sum of convex polygons lie the sides of both, by their directions.
    both = np.concatenate((sides[stay], other_sides[move]), axis=1)
    order = np.argsort(np.mod(np.angle(both), 2 * np.pi), axis=1, kind="stable")
    around = (corner[stay] + other_corner[move])[:, None] + np.cumsum(np.take_along_axis(both, order, axis=1), axis=1)
    middle = around.mean(axis=1)[:, None]
    around = middle + (1.0 + _LARGER) * (around - middle)
    return list(shapely.polygons(plane(around.ravel()).reshape(*around.shape, 2)))


def _walks(parts: Complexes) -> tuple[Complexes, Complexes]:
    """The lowest corner of each polygon, of two the left one; and its sides counter-clockwise from there."""
    first = np.lexsort((parts.real, parts.imag), axis=1)[:, 0]
    corners = np.take_along_axis(parts, (first[:, None] + np.arange(parts.shape[1])) % parts.shape[1], axis=1)
    return corners[:, 0], np.roll(corners, -1, axis=1) - corners


def _boxes(parts: Complexes) -> Floats:
    """The boxes around polygons, float64 (k, 4)."""
    x, y = parts.real, parts.imag
    return np.column_stack((x.min(axis=1), y.min(axis=1), x.max(axis=1), y.max(axis=1)))

"""Regions of the plane cut into triangles whose corners are those of the region's rings, and no others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, next_in_ring, plane
from voronoi_tiles.base.errors import ProofError

if TYPE_CHECKING:
    import shapely

Loops = Sequence[Ints]
"""A polygon by the indices of its points: the outer ring counter-clockwise first, then its holes, clockwise."""


def polygons(points: Complexes, offsets: Ints) -> list[list[Ints]]:
    """The polygons that rings bound, each as its outer ring and the holes in it.

    Ring k are the points from offsets[k] up to, not including, offsets[k + 1]; outer rings run counter-clockwise.
    """
    import shapely

    rings = [np.arange(a, b) for a, b in zip(offsets[:-1].tolist(), offsets[1:].tolist(), strict=True)]
    filled = [shapely.Polygon(plane(points[ring])) for ring in rings]
    outer = [k for k, ring in enumerate(rings) if signed_area(points[ring]) > 0]
    found = {k: [rings[k]] for k in outer}
    for k, ring in enumerate(rings):
        if k not in found:
            around = outer if len(outer) == 1 else [shell for shell in outer if filled[shell].covers(filled[k])]
            found[min(around, key=lambda shell: float(filled[shell].area))].append(ring)
    return list(found.values())


def filled(points: Complexes, offsets: Ints) -> shapely.MultiPolygon:
    """What rings bound, as a shape; the rings as of `polygons`."""
    import shapely

    loops = polygons(points, offsets)
    return shapely.MultiPolygon(
        [(plane(points[outer]), [plane(points[ring]) for ring in holes]) for outer, *holes in loops]
    )


def signed_area(ring: Complexes) -> float:
    """The area that a ring of points encloses: > 0 counter-clockwise."""
    ring = ring - ring[0]
    return float((ring.conj() * np.roll(ring, -1)).imag.sum()) / 2


def following(points: Complexes, offsets: Ints) -> Ints:
    """What follows each point of rings, intp (n,), where the region lies on their left.

    Where rings touch in a point, or one touches itself, the region's corners there are passed one by one: so what
    bounds it is a surface, in which no more than two walls meet.
    """
    after = next_in_ring(offsets)
    _, place, count = np.unique(points, return_inverse=True, return_counts=True)
    before = np.argsort(after)
    for one in np.flatnonzero(count > 1).tolist():
        same = np.flatnonzero(place == one)
        at = points[same[0]]
        back, leaving = points[before[same]] - at, points[after[same]] - at
        turn = np.mod(np.angle(back[:, None] / leaving[None, :]), 2 * np.pi)
        # Of a corner both sides are seen from within without any other between them.
        after[before[same]], after[same] = same, after[same][turn.argmin(axis=1)]
    return after


def triangulated(points: Complexes, regions: Sequence[Loops], after: Ints) -> Ints:
    """The triangles of some polygons, counter-clockwise: intp (m, 3), indices of points; `after` as of `following`.

    Raises ProofError where a polygon gets corners that it does not have.
    """
    import shapely

    found = []
    for loops in regions:
        shape = shapely.Polygon(plane(points[loops[0]]), [plane(points[hole]) for hole in loops[1:]])
        parts = shapely.get_parts(shapely.constrained_delaunay_triangles(shape))
        corners = shapely.get_coordinates(parts).view(np.complex128).reshape(-1, 4)[:, 2::-1]  # they run clockwise
        found.append(_named(points, np.concatenate(loops), corners, after))
    return np.concatenate([np.zeros((0, 3), np.intp), *found])


def _named(points: Complexes, own: Ints, corners: Complexes, after: Ints) -> Ints:
    """The indices, among some `own`, of the points that corners of triangles, complex128 (m, 3), are equal to.

    Where rings touch, one place has several points: that is meant between whose sides the triangle lies.
    """
    place = points[own]
    known, first, count = np.unique(place, return_index=True, return_counts=True)
    row = np.minimum(np.searchsorted(known, corners), len(known) - 1)
    if (known[row] != corners).any():
        raise ProofError("a face of a solid got corners that it does not have")
    named = own[first[row]]
    if count.max(initial=0) > 1:
        before = np.argsort(after)
        middle = corners.mean(axis=1)
        for k, j in np.argwhere(count[row] > 1).tolist():
            at = corners[k, j]
            same = own[place == at]
            leaving, back = points[after[same]] - at, points[before[same]] - at
            turn = np.mod(np.angle((middle[k] - at) / leaving), 2 * np.pi)
            excess = turn - np.mod(np.angle(back / leaving), 2 * np.pi)
            named[k, j] = same[excess.argmin()]
    return named

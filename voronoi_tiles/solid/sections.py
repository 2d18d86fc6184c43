"""Sections of meshes: whether any, at whatever height, crosses itself."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.solid.mesh import TriangleMesh

_PADDED: Final = 1e-9
"""By how much boxes are larger than what is in them, and how far rounding moves points; relative to the mesh's size."""


class CrossedSections(NamedTuple):
    """Where sections of a mesh cross themselves, in millimetres.

    `levels` are heights at which it has vertices, `between` are half way between two of these that have such a section
    between them.
    """

    levels: Floats
    between: Floats


class _MovingSides(NamedTuple):
    """The sides of all sections between two levels: each runs from one slanted side of a triangle to another one.

    Seen from below, the height is time. At the lower level a side is from `low[:, 0]` to `low[:, 1]`, at the upper one
    from `high[:, 0]` to `high[:, 1]` (complex128, n x 2), all the way along straight lines; `slab` (intp, n) numbers
    the lower level.
    """

    low: Complexes
    high: Complexes
    slab: Ints


def crossed_sections(mesh: TriangleMesh) -> CrossedSections:
    """The sections of a mesh whose vertices are at a few heights, and whose walls run from one to the next.

    A section that crosses itself, above one that does not, has a corner on a side of its own somewhere in between: as
    both move along straight lines, when is the root of a quadratic.
    """
    heights, level = np.unique(mesh.vertices[:, 2], return_inverse=True)
    corner = level[mesh.triangles]
    slab = corner.min(axis=1)
    wall = np.flatnonzero(slab < corner.max(axis=1))
    triangles, corner, slab = mesh.triangles[wall], corner[wall], slab[wall]
    lower = corner == slab[:, None]
    # The corner that is alone at its height first: the sides that leave it are slanted.
    below = lower.sum(axis=1) == 1
    alone = np.where(below, lower.argmax(axis=1), lower.argmin(axis=1))
    apex, *rest = np.take_along_axis(triangles, (alone[:, None] + np.arange(3)) % 3, axis=1).T
    plane = mesh.vertices[:, 0] + 1j * mesh.vertices[:, 1]
    one, two = np.stack([plane[apex], plane[apex]], axis=1), np.stack([plane[end] for end in rest], axis=1)
    sides = _MovingSides(np.where(below[:, None], one, two), np.where(below[:, None], two, one), slab)
    # Sides in a level are those of a triangle above and of one below: those below are enough, and those of the bottom.
    kept = below | (slab == 0)
    at = (slab + below)[kept]
    between = np.unique(_meetings(sides))
    return CrossedSections(heights[_not_simple(two[kept], at)], (heights[between] + heights[between + 1]) / 2)


def _not_simple(sides: Complexes, group: Ints) -> Ints:
    """The groups of sides, complex128 (n, 2), that have some which meet elsewhere than at their ends."""
    order = np.argsort(group, kind="stable")
    lines = shapely.linestrings(np.stack((sides.real, sides.imag), axis=-1)[order])
    simple = shapely.is_simple(shapely.multilinestrings(lines, indices=group[order]))
    return np.asarray(np.unique(group)[~simple])


def _meetings(sides: _MovingSides) -> Ints:
    """The slabs in which the end of a side meets another side on the way up."""
    every = np.concatenate((sides.low, sides.high), axis=1)
    x, y = every.real, every.imag
    size = max(float(np.ptp(x)), float(np.ptp(y)))
    pad, far = _PADDED * size, sides.slab * (2 * size)
    left, right, bottom, top = x.min(axis=1) + far, x.max(axis=1) + far, y.min(axis=1), y.max(axis=1)
    boxes = shapely.box(left - pad, bottom - pad, right + pad, top + pad)
    one, two = shapely.STRtree(boxes).query(boxes)
    one, two = one[one != two], two[one != two]
    found = []
    for end in (0, 1):
        met = _meets(sides.low[one, end], sides.high[one, end], sides.low[two], sides.high[two], pad)
        found.append(sides.slab[one[met]])
    return np.concatenate(found)


def _meets(low: Complexes, high: Complexes, side_low: Complexes, side_high: Complexes, near: float) -> Bools:
    """Whether points that move from `low` to `high`, complex128 (n,), meet sides that move too, complex128 (n, 2).

    At the start and at the end they do not, or are an end of the side. What is nearer than `near` meets.
    """
    away, along = low - side_low[:, 0], side_low[:, 1] - side_low[:, 0]
    away_by, along_by = high - side_high[:, 0] - away, side_high[:, 1] - side_high[:, 0] - along
    # Twice the area of the triangle over the side: c + b t + a t^2.
    c, a = _cross(along, away), _cross(along_by, away_by)
    b = _cross(along, away_by) + _cross(along_by, away)
    starts, ends = ((at[:, None] == side).any(axis=1) for at, side in ((low, side_low), (high, side_high)))
    same = ((low[:, None] == side_low) & (high[:, None] == side_high)).any(axis=1)
    met = np.zeros(len(low), np.bool_)
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(b * b - 4 * a * c)  # not a number where there is none
        larger = -(b + np.copysign(root, b)) / 2
        general = ~starts & ~ends
        times = [
            np.where(general, larger / a, np.where(starts, -b / a, c / a)),
            np.where(general, c / larger, np.nan),
        ]
        for t in times:
            at, side = away + t * away_by, along + t * along_by
            share = (at * side.conj()).real / (side * side.conj()).real
            # Of a side that shrinks to a point the area is nothing in the end, wherever the other point is.
            met |= (t > 0) & (t < 1) & (share >= 0) & (share <= 1) & (np.abs(at - share * side) <= near)
    return np.asarray(met & ~same & ~(starts & ends))


def _cross(u: Complexes, v: Complexes) -> Floats:
    return np.asarray(u.real * v.imag - u.imag * v.real)

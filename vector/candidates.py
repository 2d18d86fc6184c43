"""For every row, the elements near enough to shape its cell: branch and bound over a hierarchy of discs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.vector.contour import Bools, Complexes, Contour, Floats, Ints
from voronoi_tiles.vector.copies import Copies, move
from voronoi_tiles.vector.rows import Rows

# Children of an inner disc: eight keeps the levels few.
_BRANCH = 8
# Relative slack of the pruning tests, far above their rounding errors.
_SLACK = 1e-9


@dataclass(frozen=True, slots=True)
class Level:
    """Discs of all copies that together hold all elements; each has one node of the site in it as its anchor.

    Attributes:
        centre, anchor: (copies, k); radius: (k,). Disc j holds the discs 8 j to 8 j + 7 of the next level.
    """

    centre: Complexes
    anchor: Complexes
    radius: Floats


@dataclass(frozen=True, slots=True)
class Hierarchy:
    """The elements of a site's copies in nested discs.

    Attributes:
        levels: from one disc around each copy to one disc per element.
        order: element index of each disc of the last level; segments first, then isolated nodes.
    """

    levels: tuple[Level, ...]
    order: Ints


def build_hierarchy(contour: Contour, copies: Copies) -> Hierarchy:
    """Return the hierarchy of a site's elements, neighbours in the plane being neighbours in the order."""
    start, end = contour.nodes[contour.source[::2]], contour.nodes[contour.target[::2]]
    isolated = contour.nodes[contour.corner_node[len(contour.source) :: 4]]
    if len(isolated):
        start, end = np.concatenate((start, isolated)), np.concatenate((end, isolated))
    order = _z_order((start + end) / 2)
    start, end = start[order], end[order]
    plain = [((start + end) / 2, start, np.abs(end - start) / 2)]
    corners = np.stack((start.real, start.imag, end.real, end.imag))
    low, high = np.minimum(corners[:2], corners[2:]), np.maximum(corners[:2], corners[2:])
    while len(plain[0][0]) > 1:
        first = np.arange(0, low.shape[1], _BRANCH)
        low, high = np.minimum.reduceat(low, first, axis=1), np.maximum.reduceat(high, first, axis=1)
        middle, half = (low + high) / 2, (high - low) / 2
        anchor = plain[0][1][np.minimum(first + _BRANCH // 2, len(plain[0][1]) - 1)]
        plain.insert(0, (middle[0] + 1j * middle[1], anchor, np.hypot(half[0], half[1])))
    unit, shift, conj = copies.unit[:, None], copies.shift[:, None], copies.conj[:, None]
    levels = tuple(Level(move(c, unit, shift, conj), move(a, unit, shift, conj), r) for c, a, r in plain)
    return Hierarchy(levels=levels, order=order)


def _z_order(points: Complexes) -> Ints:
    """Return the order of points along the Z-order curve (Morton code of 2 x 16 bits)."""
    if len(points) <= _BRANCH:
        return np.arange(len(points))
    grid = np.stack((points.real, points.imag))
    grid -= grid.min(axis=1, keepdims=True)
    bits = (grid * (65535 / (grid.max() or 1.0))).astype(np.int64)
    for mask, step in ((0x00FF00FF, 8), (0x0F0F0F0F, 4), (0x33333333, 2), (0x55555555, 1)):
        bits = (bits | (bits << step)) & mask
    return np.argsort(bits[0] | bits[1] << 1, kind="stable")


@dataclass(frozen=True, slots=True)
class Candidates:
    """Pairs of a row and an element of a copy, sorted by row.

    Attributes:
        row, copy, element: (k,) indices.
    """

    row: Ints
    copy: Ints
    element: Ints


@dataclass(frozen=True, slots=True)
class Bounds:
    """What bounds each row's cell.

    Attributes:
        height: (rows,) no point of the cell is farther from the element.
        champion: (rows,) the point whose bisector gives that height, NaN where the lattice does.
    """

    height: Floats
    champion: Complexes


def find_candidates(
    rows: Rows, targets: list[Hierarchy], covering_radius: float
) -> tuple[list[Candidates], Bounds]:
    """Return, for each target, a superset of the pairs in which the element shapes the row's cell.

    A point p of a row's cell, at height h on a ray from b in direction n, has nothing in the disc about p of radius h,
    and all such discs of a ray lie in the one about b + H n of radius H, for a bound H on the heights. So an
    element matters only if it meets that disc, widened by what b + H n differs between the row's rays, and
    reaches in front of one of the outermost rays. Each anchor in turn bounds the heights by those at which the two outermost
    rays meet its bisector, since bisectors with points are convex as seen from the row. So the bounds tighten while the
    discs of the hierarchy shrink, and the number of pairs per row stays small at each level.
    """
    height = np.full(len(rows), covering_radius)
    champion = np.full(len(rows), np.nan, complex)
    pairs: list[tuple[Ints, Ints, Ints]] = []
    for hierarchy in targets:
        count = len(hierarchy.levels[0].centre)
        row = np.repeat(np.arange(len(rows)), count)
        pairs.append((row, np.tile(np.arange(count), len(rows)), np.zeros(len(row), np.intp)))
    for depth in range(max(len(hierarchy.levels) for hierarchy in targets)):
        for t, hierarchy in enumerate(targets):
            if depth >= len(hierarchy.levels):
                continue
            row, copy, disc = pairs[t]
            level = hierarchy.levels[depth]
            if depth:
                row, copy, disc = _children(row, copy, disc, len(level.radius))
            pairs[t] = _narrow(rows, row, copy, disc, level, height, champion)
    found = [
        Candidates(row, copy, hierarchy.order[disc]) for (row, copy, disc), hierarchy in zip(pairs, targets, strict=True)
    ]
    return found, Bounds(height, champion)


def _children(row: Ints, copy: Ints, disc: Ints, count: int) -> tuple[Ints, Ints, Ints]:
    """Return the pairs with each disc replaced by its children on the next level, which has `count` discs."""
    child = (disc[:, None] * _BRANCH + np.arange(_BRANCH)).reshape(-1)
    row, copy = np.repeat(row, _BRANCH), np.repeat(copy, _BRANCH)
    exists = child < count
    if exists.all():
        return row, copy, child
    return row[exists], copy[exists], child[exists]


def _narrow(
    rows: Rows, row: Ints, copy: Ints, disc: Ints, level: Level, height: Floats, champion: Complexes
) -> tuple[Ints, Ints, Ints]:
    """Drop the pairs that cannot matter; tighten the rows' heights and champions in place."""
    place = copy * len(level.radius) + disc
    centre, radius = level.centre.reshape(-1)[place], level.radius[disc]
    ahead = np.maximum(_along(rows.base0[row], rows.ray0[row], centre), _along(rows.base1[row], rows.ray1[row], centre))
    kept = np.flatnonzero(_meets(rows, row, centre, radius, height) & (ahead >= -radius * (1.0 + _SLACK)))
    row, copy, disc, place, centre, radius = row[kept], copy[kept], disc[kept], place[kept], centre[kept], radius[kept]
    if not len(row):
        return row, copy, disc
    anchor = level.anchor.reshape(-1)[place]
    bound = np.maximum(
        _meeting(rows.base0[row], rows.ray0[row], anchor), _meeting(rows.base1[row], rows.ray1[row], anchor)
    )
    first = np.flatnonzero(np.concatenate(([True], row[1:] != row[:-1])))
    lowest = np.minimum.reduceat(bound, first)
    better = lowest < height[row[first]]
    height[row[first[better]]] = lowest[better]
    best = np.flatnonzero(bound == height[row])
    champion[row[best]] = anchor[best]
    kept = np.flatnonzero(_meets(rows, row, centre, radius, height))
    return row[kept], copy[kept], disc[kept]


def _meets(rows: Rows, row: Ints, centre: Complexes, radius: Floats, height: Floats) -> Bools:
    """Tell which discs meet the disc that holds everything nearer to some point of the row's cell than the row."""
    away = centre - (rows.base + height * rows.ray)[row]
    widened = (height * (1.0 + rows.fan) + rows.spread) * (1.0 + _SLACK)
    return np.asarray(np.abs(away) <= widened[row] + radius)


def _along(base: Complexes, ray: Complexes, points: Complexes) -> Floats:
    """Return the points' coordinates along rays."""
    away = points - base
    return away.real * ray.real + away.imag * ray.imag


def _meeting(base: Complexes, ray: Complexes, points: Complexes) -> Floats:
    """Return the heights at which rays meet the bisectors of their base and points; infinite where they do not."""
    away = points - base
    along = away.real * ray.real + away.imag * ray.imag
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(along > 0.0, (away.real**2 + away.imag**2) / (2.0 * along), np.inf)

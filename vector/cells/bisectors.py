"""Bisectors of a row's element with other elements, as partial quadratics in the row's variable.

In the row of a half-edge the function is the height h of the bisector; in the row of a corner it is -(1 + x^2) / r
with r its distance. Either way it is a quadratic on an interval known in closed form, and the cell lies below the
lower envelope of all of them.

The arithmetic is spelt out in real numbers: the end of a half-edge's piece and the start of the next corner's are the
same expression, and must come out as the same bits wherever they stand in their arrays.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.vector.cells.candidates import Bounds, Candidates
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.cells.images import Surroundings
from voronoi_tiles.vector.cells.pencils import Rows

# Stands for an infinite tangent where a product with it must stay finite.
_INFINITE = 1e100
# A half-edge that leaves at a smaller angle than the inverse of this bounds nothing but its own end.
_STEEPEST = 1e18
# An interval whose ends come out swapped passes through infinity if the angle that it sweeps is larger than this; else
# rounding has swapped the ends of a tiny one. A tiny one at infinity is out of every row's reach, whatever rounding
# makes of its ends: there 1 + low * high, the addition theorem's denominator, is negative.
_TINY = 1e-6
# Pieces above the row's bound by less than this, relative, are kept: far above rounding.
_SLACK = 1e-9


class TouchingElementsError(ArithmeticError):
    """A node of one copy lies on another copy."""


@dataclass(frozen=True, slots=True)
class PartialQuadratics:
    """Partial quadratics a (x - m)^2 + b (x - m) + c on [low, high].

    Attributes:
        row: (k,) the row each belongs to, ascending.
        low, high, a, b, c, m: (k,) floats.
        target, copy: (k,) whose copy bounds the row there.
        item: (k,) the half-edge i, or the corner c as h + c.
    """

    row: Ints
    low: Floats
    high: Floats
    a: Floats
    b: Floats
    c: Floats
    m: Floats
    target: Ints
    copy: Ints
    item: Ints

    def take(self, index: Ints) -> PartialQuadratics:
        """The pieces at the given indices."""
        return PartialQuadratics(*(getattr(self, name)[index] for name in self.__slots__))

    def value(self, index: Ints, x: Floats) -> Floats:
        """The values at x of the pieces at the given indices."""
        step = x - self.m[index]
        return self.c[index] + step * (self.b[index] + step * self.a[index])

    def slope(self, index: Ints, x: Floats) -> Floats:
        """The derivatives at x of the pieces at the given indices."""
        return self.b[index] + 2.0 * self.a[index] * (x - self.m[index])


def bisector_pieces(
    rows: Rows, contour: Contour, targets: list[tuple[Surroundings, Candidates]], bounds: Bounds
) -> PartialQuadratics:
    """All bisectors that may shape the rows' cells, sorted by row.

    Args:
        rows, contour: of the base site.
        targets: for each site its copies and the pairs to look at.
        bounds: of the rows; pieces above them are left out.

    Raises:
        TouchingElementsError: where a node lies, but for rounding, on an element of another copy.
    """
    parts: list[PartialQuadratics] = []
    straight = rows.straight
    for t, (around, candidates) in enumerate(targets):
        row, copy, items = _items(candidates, around.segments)
        line = items < 2 * around.segments
        corner = around.bounding[items]
        for straight_rows in (True, False):
            kind = straight[row] == straight_rows
            chosen = np.flatnonzero(kind & line)
            if len(chosen):
                lines = _straight_lines if straight_rows else _round_lines
                parts.append(lines(rows, contour, t, around, row[chosen], copy[chosen], items[chosen]))
            chosen = np.flatnonzero(kind & corner)
            if len(chosen):
                points = _straight_points if straight_rows else _round_points
                parts.append(
                    points(rows, contour, t, around, row[chosen], copy[chosen], items[chosen], bounds.rounding)
                )
    pieces = PartialQuadratics(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in PartialQuadratics.__slots__)
    )
    kept = _below_bounds(rows, bounds, pieces)
    return pieces.take(kept[np.argsort(pieces.row[kept], kind="stable")])


def _items(candidates: Candidates, segments: int) -> tuple[Ints, Ints, Ints]:
    """(row, copy, item) of the half-edges of the candidates, which are corners too, and of lone corners."""
    row, copy, element = candidates.row, candidates.copy, candidates.element
    if not len(element) or element.max() < segments:
        items = (2 * element[:, None] + np.arange(2)).reshape(-1)
        return np.repeat(row, 2), np.repeat(copy, 2), items
    count = np.where(element < segments, 2, 4)
    first = np.where(element < segments, 2 * element, 4 * element - 2 * segments)
    items = np.repeat(first - (np.cumsum(count) - count), count) + np.arange(count.sum())
    return np.repeat(row, count), np.repeat(copy, count), items


def _coordinates(axis: Complexes, vector: Complexes) -> tuple[Floats, Floats]:
    """The coordinates of vectors along and to the left of unit vectors."""
    along = axis.real * vector.real + axis.imag * vector.imag
    left = axis.real * vector.imag - axis.imag * vector.real
    return along, left


def _tangent(cosine: Floats, sine: Floats, infinite: float) -> Floats:
    """-cot(th / 2) for angles th; `infinite` where th is exactly 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        result = np.where(cosine < 0.0, -sine / (1.0 - cosine), -(1.0 + cosine) / sine)
    return np.where((sine == 0.0) & (cosine > 0.0), infinite, result)


def _pieces(
    rows: Rows,
    t: int,
    row: Ints,
    copy: Ints,
    item: Ints,
    low: Floats,
    high: Floats,
    quadratic: tuple[Floats, Floats, Floats, Floats],
    wraps: Ints,
) -> PartialQuadratics:
    """Pieces on [low, high], or, where an interval wraps around infinity, on its two rays, within the rows."""
    a, b, c, m = quadratic
    if len(wraps):
        index = np.concatenate((np.arange(len(row)), wraps))
        upper = high.copy()
        upper[wraps] = np.inf
        low, high = np.concatenate((low, np.full(len(wraps), -np.inf))), np.concatenate((upper, high[wraps]))
        row, copy, item = row[index], copy[index], item[index]
        a, b, c, m = a[index], b[index], c[index], m[index]
    low, high = np.maximum(low, rows.low[row]), np.minimum(high, rows.high[row])
    i = np.flatnonzero(low < high)
    return PartialQuadratics(row[i], low[i], high[i], a[i], b[i], c[i], m[i], np.full(len(i), t), copy[i], item[i])


_NO_WRAPS = np.zeros(0, np.intp)


def _straight_lines(
    rows: Rows, contour: Contour, t: int, around: Surroundings, row: Ints, copy: Ints, item: Ints
) -> PartialQuadratics:
    """Bisectors of half-edges' rows with half-edges: linear, over an interval as long as the other half-edge.

    A disc that touches the row's line at s from its left, and another line of direction th at (p, q) from its left, has
    s = p - q cot(th/2) and radius h = q (1 + cot(th/2)^2) / 2.
    """
    place = copy * (2 * around.segments) + item
    axis, origin = rows.axis[row], rows.origin[row]
    start, end = around.start.reshape(-1)[place], around.end.reshape(-1)[place]
    first = copy * around.node.shape[1]
    node = around.node.reshape(-1)
    p1, q1 = _coordinates(axis, node[first + start] - origin)
    p2, q2 = _coordinates(axis, node[first + end] - origin)
    if around.own:
        # The half-edge's own end lies on its line and at its length, exactly.
        here, edge = copy == 0, rows.half_edge[row]
        last, length = contour.target[edge], contour.length[edge]
        for node_here, p, q in ((start, p1, q1), (end, p2, q2)):
            own_end = here & (node_here == last)
            q[own_end] = 0.0
            p[own_end] = length[own_end]
        other = ~(here & (item >> 1 == edge >> 1))
    else:
        other = np.ones(len(row), bool)
    tangent = _tangent(*_coordinates(axis, around.direction.reshape(-1)[place]), _INFINITE)
    s1, s2 = p1 + q1 * tangent, p2 + q2 * tangent
    v = np.flatnonzero(
        other
        & (np.maximum(q1, q2) > 0.0)
        & (np.abs(tangent) < _STEEPEST)
        & (s1 > rows.low[row])
        & (s2 < rows.high[row])
    )
    row, copy, item, q1, q2, s1, s2, tangent = row[v], copy[v], item[v], q1[v], q2[v], s1[v], s2[v], tangent[v]
    square = (1.0 + tangent * tangent) / 2.0
    # The nearer end has the smaller rounding error; an end behind the row's line is none.
    at_start = (q1 >= 0.0) & ((q1 <= q2) | (q2 < 0.0))
    m, c = np.where(at_start, s1, s2), np.where(at_start, q1, q2) * square
    with np.errstate(divide="ignore", invalid="ignore"):
        foot = m - c / tangent
    low, high = np.where(q2 < 0.0, foot, s2), np.where(q1 < 0.0, foot, s1)
    return _pieces(rows, t, row, copy, item, low, high, (np.zeros(len(row)), tangent, c, m), _NO_WRAPS)


def _straight_points(
    rows: Rows, contour: Contour, t: int, around: Surroundings, row: Ints, copy: Ints, corner: Ints, rounding: float
) -> PartialQuadratics:
    """Bisectors of half-edges' rows with corners: h = ((s - p)^2 + q^2) / 2q where the wedge sees the row."""
    node = around.corner[corner]
    axis = rows.axis[row]
    p, q = _coordinates(axis, around.node.reshape(-1)[copy * around.node.shape[1] + node] - rows.origin[row])
    edge = rows.half_edge[row]
    if around.own:
        other = ~((copy == 0) & ((node == contour.source[edge]) | (node == contour.target[edge])))
    else:
        other = np.ones(len(row), bool)
    on_line = np.flatnonzero(other & (np.abs(q) <= rounding))
    if (np.abs(p[on_line] - contour.length[edge[on_line]] / 2) <= contour.length[edge[on_line]] / 2 + rounding).any():
        raise TouchingElementsError
    v = np.flatnonzero(other & (q > 0.0))
    row, copy, corner, p, q, axis = row[v], copy[v], corner[v], p[v], q[v], axis[v]
    place = copy * len(around.corner) + corner
    first = _tangent(*_coordinates(axis, around.arriving.reshape(-1)[place]), _INFINITE)
    last = _tangent(*_coordinates(axis, around.leaving.reshape(-1)[place]), -_INFINITE)
    tiny = around.turn[corner] <= _TINY
    low, high = p + q * last, p + q * np.where(tiny & (1.0 + first * last < 0.0), last, first)
    wraps = np.flatnonzero((low > high) & ~tiny)
    quadratic = (0.5 / q, np.zeros(len(q)), q / 2.0, p)
    return _pieces(rows, t, row, copy, 2 * around.segments + corner, low, high, quadratic, wraps)


def _half_tangent(direction: Complexes, axis: Complexes, vector: Complexes, square: Floats, infinite: float) -> Floats:
    """x of the ray on which a disc through 0 touches a line of this direction, from its left, at `vector`.

    `infinite` where that ray is exactly opposite to the axis.
    """
    along = direction.real * axis.real - direction.imag * axis.imag
    across = direction.real * axis.imag + direction.imag * axis.real
    real = (vector.real - vector.imag) * (vector.real + vector.imag)
    imag = 2.0 * vector.real * vector.imag
    cosine = across * real - along * imag
    sine = across * imag + along * real
    with np.errstate(divide="ignore", invalid="ignore"):
        result = np.where(cosine < 0.0, (square - cosine) / sine, sine / (square + cosine))
    return np.where((sine == 0.0) & (cosine < 0.0), infinite, result)


def _round_lines(
    rows: Rows, contour: Contour, t: int, around: Surroundings, row: Ints, copy: Ints, item: Ints
) -> PartialQuadratics:
    """Bisectors of corners' rows with half-edges: 1 / r = (1 + cos) / D, a perfect square in x after scaling."""
    place = copy * (2 * around.segments) + item
    origin = rows.origin[row]
    start, end = around.start.reshape(-1)[place], around.end.reshape(-1)[place]
    first = copy * around.node.shape[1]
    node = around.node.reshape(-1)
    to1, to2 = node[first + start] - origin, node[first + end] - origin
    direction = around.direction.reshape(-1)[place]
    c1, l1 = _coordinates(direction, to1)
    c2, l2 = _coordinates(direction, to2)
    square1, square2 = to1.real**2 + to1.imag**2, to2.real**2 + to2.imag**2
    # The distance of the line, positive where the corner lies on its left; the nearer end has the smaller error.
    distance = -np.where(square1 < square2, l1, l2)
    valid = distance > 0.0
    if around.own:
        here = contour.corner_node[rows.corner[row]]
        valid &= ~((copy == 0) & ((start == here) | (end == here)))
    v = np.flatnonzero(valid)
    row, copy, item, direction, distance = row[v], copy[v], item[v], direction[v], distance[v]
    axis = rows.axis[row]
    low = _half_tangent(direction, axis, to1[v], square1[v], -_INFINITE)
    high = _half_tangent(direction, axis, to2[v], square2[v], _INFINITE)
    # The half angle swept is that between the lines to the two ends; its cosine and sine, up to a factor.
    forward = distance * distance + c1[v] * c2[v]
    tiny = distance * (c2[v] - c1[v]) <= _TINY * forward
    high = np.where(tiny & (1.0 + low * high < 0.0), low, high)
    wraps = np.flatnonzero((low > high) & ~tiny)
    # cos and sin of half the angle from the axis to the foot on the line, which lies to the right of it.
    along, across = _coordinates(axis, direction)
    big, small = np.sqrt((1.0 + np.abs(across)) / 2.0), -along / 2.0
    cosine = np.where(across >= 0.0, big, small / big)
    sine = np.where(across >= 0.0, small / big, big)
    m = np.minimum(np.maximum(low, rows.low[row]), rows.high[row])
    root = cosine + m * sine
    scale = -2.0 / distance
    quadratic = (scale * sine * sine, 2.0 * scale * sine * root, scale * root * root, m)
    return _pieces(rows, t, row, copy, item, low, high, quadratic, wraps)


def _round_points(
    rows: Rows, contour: Contour, t: int, around: Surroundings, row: Ints, copy: Ints, corner: Ints, rounding: float
) -> PartialQuadratics:
    """Bisectors of corners' rows with corners: 1 / r = 2 cos / d."""
    node = around.corner[corner]
    away = around.node.reshape(-1)[copy * around.node.shape[1] + node] - rows.origin[row]
    square = away.real**2 + away.imag**2
    other = np.ones(len(row), bool)
    if around.own:
        other = ~((copy == 0) & (node == contour.corner_node[rows.corner[row]]))
    if (square[other] <= rounding**2).any():
        raise TouchingElementsError
    v = np.flatnonzero(other)
    row, copy, corner, away, square = row[v], copy[v], corner[v], away[v], square[v]
    axis = rows.axis[row]
    place = copy * len(around.corner) + corner
    low = _half_tangent(around.arriving.reshape(-1)[place], axis, away, square, -_INFINITE)
    high = _half_tangent(around.leaving.reshape(-1)[place], axis, away, square, _INFINITE)
    tiny = around.turn[corner] <= _TINY
    high = np.where(tiny & (1.0 + low * high < 0.0), low, high)
    wraps = np.flatnonzero((low > high) & ~tiny)
    along, across = _coordinates(axis, away)
    along, across = 2.0 * along / square, 4.0 * across / square
    quadratic = (along, -across, -along, np.zeros(len(row)))
    return _pieces(rows, t, row, copy, 2 * around.segments + corner, low, high, quadratic, wraps)


def _below_bounds(rows: Rows, bounds: Bounds, pieces: PartialQuadratics) -> Ints:
    """The indices of the pieces that somewhere fall below both bounds of their rows."""
    straight = rows.straight
    # The height's: h <= H, or -(1 + x^2) / r <= -(1 + x^2) / H.
    flat = np.where(straight, 0.0, -1.0 / bounds.height)
    zero = np.zeros(len(rows))
    kept = _below(rows, pieces, flat, zero, np.where(straight, bounds.height, flat), zero, zero)
    if np.isnan(bounds.champion).any():
        return kept
    # The bisector's with the champion.
    away = bounds.champion - rows.origin
    p, q = _coordinates(rows.axis, away)
    square = away.real**2 + away.imag**2
    a = np.where(straight, 0.5 / np.where(straight, q, 1.0), 2.0 * p / square)
    b = np.where(straight, 0.0, -4.0 * q / square)
    c = np.where(straight, q / 2.0, -2.0 * p / square)
    # A champion that is near is known to fewer digits.
    doubt = 4.0 * bounds.rounding / np.where(straight, q, np.sqrt(square))
    return np.asarray(kept[_below(rows, pieces.take(kept), a, b, c, np.where(straight, p, 0.0), doubt)])


def _below(
    rows: Rows, pieces: PartialQuadratics, a0: Floats, b0: Floats, c0: Floats, m0: Floats, doubt: Floats
) -> Ints:
    """The indices of the pieces that somewhere fall below the quadratic of their row, give or take its doubt."""
    row, low, high = pieces.row, pieces.low, pieces.high
    a0, b0, c0, m0 = a0[row], b0[row], c0[row], m0[row]
    x, y = low - m0, high - m0
    bound_low, bound_high = c0 + x * (b0 + x * a0), c0 + y * (b0 + y * a0)
    u, v = low - pieces.m, high - pieces.m
    over_low = pieces.c + u * (pieces.b + u * pieces.a) - bound_low
    over_high = pieces.c + v * (pieces.b + v * pieces.a) - bound_high
    curvature = pieces.a - a0
    slope = pieces.b + 2.0 * pieces.a * u - b0 - 2.0 * a0 * x
    with np.errstate(divide="ignore", invalid="ignore"):
        step = -slope / (2.0 * curvature)
        inside = (curvature > 0.0) & (step > 0.0) & (step < high - low)
        dip = np.where(inside, over_low + slope * step / 2.0, over_low)
    least = np.minimum(np.minimum(over_low, over_high), dip)
    terms = np.abs(bound_low) + np.abs(bound_high) + np.where(rows.straight[row], 0.0, np.abs(a0) + np.abs(b0))
    return np.flatnonzero(least <= (_SLACK + doubt[row]) * terms)

"""Bisectors of a row's element with other elements, as partial quadratics in the row's variable x.

A point of a bisector is the centre of a disc that touches both elements. In the row of a half-edge, x is the coordinate
s along it and the function the height h of the bisector; in the row of a corner, x = tan(t/2) for a ray in direction t
from the row's axis, and the function -(1 + x^2) / r with r the bisector's distance along it. Either way it is a
quadratic, and the cell lies below the lower envelope of all of them. The four combinations:

    row        element    function of x                            defined between the discs
    ---------  ---------  ---------------------------------------  -------------------------------------------------
    half-edge  half-edge  h = c + k (s - m), with k = -cot(a/2)    that touch it at its end and start, above h = 0
    half-edge  corner     h = ((s - p)^2 + q^2) / 2q               that touch its leaving and arriving line in it
    corner     half-edge  -(2 / D) (cos(f/2) + x sin(f/2))^2       that touch it at its start and end
    corner     corner     -(2 / d) ((1 - x^2) cos f + 2 x sin f)   that touch its arriving and leaving line in it

In the frame of the row, a is the direction of the half-edge beyond and (p, q) the place of the corner beyond; D and f
are the distance of the half-edge's line and the direction of its foot, d and f those of the corner beyond. The discs
at the ends touch, at a node, the line through it of one half-edge, from the left. Their place depends on node and line
alone:

    row of a half-edge: s = p - q cot(a/2)          `_bisecting_slope` is -cot(a/2)
    row of a corner:    x = tan(t/2), where exp(it) = i (v/|v|)^2 conj(u) for the node v and the line's direction u,
                        both over the axis          `_touching_rays`

The arithmetic is spelt out in real numbers: where a half-edge's function ends and the next corner's begins, both ends
are the same expression, and must come out as the same bits wherever they stand in their arrays.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges
from voronoi_tiles.vector.cells.candidates import Candidates
from voronoi_tiles.vector.cells.images import Surroundings
from voronoi_tiles.vector.cells.partial_quadratics import PartialQuadratics, Quadratics
from voronoi_tiles.vector.cells.pencils import Rows
from voronoi_tiles.vector.cells.provisional import Bounds

# Stands for an infinite tangent where a product with it must stay finite.
_INFINITE = 1e100
# The same at the low and at the high end of intervals.
_ENDLESS = np.array([[-_INFINITE], [_INFINITE]])
# A half-edge that leaves at a smaller angle than the inverse of this bounds nothing but its own end.
_STEEPEST = 1e18
# An interval whose ends come out swapped passes through infinity if the angle that it sweeps is larger than this; else
# rounding has swapped the ends of a tiny one.
_TINY = 1e-6
# Functions above the row's bound by less than this, relative, are kept: far above rounding.
_SLACK = 1e-9


class TouchingElementsError(ArithmeticError):
    """A node of one copy lies on another copy."""


def find_bisectors(
    rows: Rows, around: Surroundings, elements: Ints, candidates: Candidates, bounds: Bounds
) -> PartialQuadratics:
    """All bisectors that may shape the cells of rows, sorted by row.

    `around` are all copies, `candidates` the pairs to look at, by their places in `elements`; `bounds` are the rows',
    and what lies above them is left out. Raises TouchingElementsError where a node lies, but for rounding, on an
    element of another copy.
    """
    segments = len(around.contour.source) // 2
    row, copy, item = _items(candidates, elements, segments)
    pairs = _RowPairs(rows, around, bounds.rounding, row, copy, item)
    of_half_edge = rows.straight[row]
    of_corner = ~of_half_edge
    half_edge, corner = item < 2 * segments, around.contour.bounding[item]
    found: list[PartialQuadratics] = []
    for chosen, bisectors in (
        (of_half_edge & half_edge, _half_edge_with_half_edge),
        (of_half_edge & corner, _half_edge_with_corner),
        (of_corner & half_edge, _corner_with_half_edge),
        (of_corner & corner, _corner_with_corner),
    ):
        index = chosen.nonzero()[0]
        if len(index):
            found.append(bisectors(pairs.take(index)))
    functions = PartialQuadratics.concatenate(found)
    kept = _below_bounds(rows, bounds, functions)
    return functions.take(kept[np.argsort(functions.row[kept], kind="stable")])


def _items(candidates: Candidates, elements: Ints, segments: int) -> tuple[Ints, Ints, Ints]:
    """(row, copy, item) of the candidates' half-edges, item i meaning corner i as well, and of lone corners."""
    row, copy, element = candidates.row, candidates.copy, elements[candidates.place]
    if not len(element) or element.max() < segments:
        items = (2 * element[:, None] + np.arange(2)).reshape(-1)
        return np.repeat(row, 2), np.repeat(copy, 2), items
    count = np.where(element < segments, 2, 4)
    first = np.where(element < segments, 2 * element, 4 * element - 2 * segments)
    return np.repeat(row, count), np.repeat(copy, count), ranges(first, count)


@dataclass(frozen=True, slots=True)
class _RowPairs:
    """Pairs of a row and an element beyond: half-edge or corner `item` of a copy (`row`, `copy`, `item`: intp, k).

    `around` are all copies; coordinates may be off by `rounding`.
    """

    rows: Rows
    around: Surroundings
    rounding: float
    row: Ints
    copy: Ints
    item: Ints

    def take(self, index: Ints) -> _RowPairs:
        """The pairs at the given indices."""
        return _RowPairs(self.rows, self.around, self.rounding, self.row[index], self.copy[index], self.item[index])

    @property
    def own(self) -> Bools:
        """Where what lies beyond is where it was placed: there it may be the row's element, or one that it meets."""
        return self.copy < self.around.copies.bundles

    def direction(self) -> Complexes:
        """The unit vectors of the half-edges beyond."""
        return self.around.direction[self.around.corners.place(self.copy, self.item)]

    def ends(self) -> tuple[Ints, Complexes]:
        """The nodes from and to which the half-edges beyond run, and their places from the rows' origins; (2, k)."""
        nodes = np.array(self.around.ends(self.copy, self.item))
        return nodes, self.around.position(self.copy, nodes) - self.rows.origin[self.row]

    def beside(self) -> Complexes:
        """The unit vectors of the half-edges before and after the corners beyond, complex128 (2, k)."""
        place = self.around.corners.place(self.copy, self.item)
        return np.array((self.around.arriving[place], self.around.leaving[place]))

    def functions(
        self, item: Ints, low: Floats, high: Floats, quadratics: Quadratics, tiny: Bools | None = None
    ) -> PartialQuadratics:
        """Quadratics on [low, high], as far as that lies within the rows; `item` is what they are bisectors with.

        Where an interval's ends are swapped and it is not `tiny`, it passes through infinity: there are two functions
        then, on its two rays. Without `tiny` no interval does.
        """
        row, copy = self.row, self.copy
        a, b, c, m = quadratics
        wraps = np.flatnonzero((low > high) & ~tiny) if tiny is not None else ()
        if len(wraps):
            index = np.concatenate((np.arange(len(row)), wraps))
            upper = high.copy()
            upper[wraps] = np.inf
            low, high = np.concatenate((low, np.full(len(wraps), -np.inf))), np.concatenate((upper, high[wraps]))
            row, copy, item = row[index], copy[index], item[index]
            a, b, c, m = a[index], b[index], c[index], m[index]
        low, high = np.maximum(low, self.rows.low[row]), np.minimum(high, self.rows.high[row])
        i = (low < high).nonzero()[0]
        return PartialQuadratics(row[i], low[i], high[i], a[i], b[i], c[i], m[i], copy[i], item[i])


def _half_edge_with_half_edge(pairs: _RowPairs) -> PartialQuadratics:
    """Bisectors of half-edges' rows with half-edges: h = c + k (s - m).

    Let a disc touch the row's line at s, and from its left a line of direction a at (p, q). Tangents from where the
    lines meet are equally long: s = p + q k with k = -cot(a/2), and the radius is h = q (1 + k^2) / 2. As (p, q) moves
    along the other half-edge at speed 1, s falls at speed 1 and h at speed k: so k is the slope, and the interval is as
    long as the other half-edge.
    """
    rows, contour = pairs.rows, pairs.around.contour
    row, axis = pairs.row, rows.axis[pairs.row]
    nodes, away = pairs.ends()
    p, q = _coordinates(axis, away)
    k = _bisecting_slope(*_coordinates(axis, pairs.direction()), _INFINITE)
    own, half_edge = pairs.own, rows.half_edge[row]
    # The end of the row's half-edge lies on its line and at its length, exactly.
    here = own & (nodes == contour.target[half_edge])
    p, q = np.where(here, contour.length[half_edge], p), np.where(here, 0.0, q)
    other = ~(own & (pairs.item >> 1 == half_edge >> 1))
    s = p + q * k
    valid = other & (q.max(axis=0) > 0.0) & (np.abs(k) < _STEEPEST) & (s[0] > rows.low[row]) & (s[1] < rows.high[row])
    v = valid.nonzero()[0]
    pairs, k, (q1, q2), (s1, s2) = pairs.take(v), k[v], q.take(v, axis=1), s.take(v, axis=1)
    half_square = (1.0 + k * k) / 2.0
    # The nearer end has the smaller rounding error; an end behind the row's line is none.
    at_start = (q1 >= 0.0) & ((q1 <= q2) | (q2 < 0.0))
    m, c = np.where(at_start, s1, s2), np.where(at_start, q1, q2) * half_square
    # What crosses the row's line counts in front of it only, above h = 0.
    with np.errstate(divide="ignore", invalid="ignore"):
        foot = m - c / k
    low, high = np.where(q2 < 0.0, foot, s2), np.where(q1 < 0.0, foot, s1)
    return pairs.functions(pairs.item, low, high, (np.zeros(len(v)), k, c, m))


def _half_edge_with_corner(pairs: _RowPairs) -> PartialQuadratics:
    """Bisectors of half-edges' rows with corners: h = ((s - p)^2 + q^2) / 2q, a parabola with the corner for focus.

    (s, h) is as far from (p, q) as from the row's line: (s - p)^2 + (h - q)^2 = h^2. Behind the line there is none. As
    the corner turns right, from its arriving to its leaving line, the angle a of the line falls, and s with it. Raises
    TouchingElementsError where a corner lies on the row's half-edge.
    """
    rows, around, contour = pairs.rows, pairs.around, pairs.around.contour
    row = pairs.row
    node = contour.corner_node[pairs.item]
    p, q = _coordinates(rows.axis[row], around.position(pairs.copy, node) - rows.origin[row])
    half_edge = rows.half_edge[row]
    other = ~(pairs.own & ((node == contour.source[half_edge]) | (node == contour.target[half_edge])))
    on_line = np.flatnonzero(other & (np.abs(q) <= pairs.rounding))
    half_length = contour.length[half_edge[on_line]] / 2
    if (np.abs(p[on_line] - half_length) <= half_length + pairs.rounding).any():
        raise TouchingElementsError
    v = np.flatnonzero(other & (q > 0.0))
    pairs, p, q = pairs.take(v), p[v], q[v]
    corner, axis = pairs.item, rows.axis[pairs.row]
    leaving, arriving = _bisecting_slope(*_coordinates(axis, pairs.beside()[::-1]), _ENDLESS)
    tiny = contour.turn[corner] <= _TINY
    low, high = p + q * leaving, p + q * _unswapped(leaving, arriving, tiny)
    return pairs.functions(len(contour.source) + corner, low, high, _height_of_corner(p, q), tiny)


def _corner_with_half_edge(pairs: _RowPairs) -> PartialQuadratics:
    """Bisectors of corners' rows with half-edges: -(2 / D) (cos(f/2) + x sin(f/2))^2, a perfect square.

    On a ray in direction t the point at r is at D - r cos(t - f) from the line, and that is r on the bisector: 1 / r =
    (1 + cos(t - f)) / D = 2 cos^2((t - f)/2) / D. By cos^2(t/2) = 1 / (1 + x^2), (1 + x^2) / r is the square.

    The corner sees a half-edge only from its left, and each point of it on one ray: x rises from start to end.
    """
    rows, contour = pairs.rows, pairs.around.contour
    nodes, away = pairs.ends()
    direction = pairs.direction()
    along, left = _coordinates(direction, away)
    square = away.real**2 + away.imag**2
    # The distance of the line, positive where the corner lies on its left; the nearer end has the smaller error.
    distance = -np.where(square[0] < square[1], left[0], left[1])
    here = contour.corner_node[rows.corner[pairs.row]]
    v = np.flatnonzero((distance > 0.0) & ~(pairs.own & (nodes == here).any(axis=0)))
    pairs, direction, distance = pairs.take(v), direction[v], distance[v]
    row, axis = pairs.row, rows.axis[pairs.row]
    low, high = _touching_rays(direction, axis, away.take(v, axis=1), square.take(v, axis=1))
    # Half the angle swept is that between the lines to the two ends: compare its sine and cosine, up to a factor.
    along1, along2 = along.take(v, axis=1)
    tiny = distance * (along2 - along1) <= _TINY * (distance * distance + along1 * along2)
    high = _unswapped(low, high, tiny)
    # cos(f/2) and sin(f/2): the foot lies a right angle to the right of the direction. The larger one comes first.
    along, across = _coordinates(axis, direction)
    big, small = np.sqrt((1.0 + np.abs(across)) / 2.0), -along / 2.0
    cosine = np.where(across >= 0.0, big, small / big)
    sine = np.where(across >= 0.0, small / big, big)
    # About a point m of the interval and the row: far from it the square would lose its digits.
    m = np.minimum(np.maximum(low, rows.low[row]), rows.high[row])
    root = cosine + m * sine
    scale = -2.0 / distance
    quadratics = (scale * sine * sine, 2.0 * scale * sine * root, scale * root * root, m)
    return pairs.functions(pairs.item, low, high, quadratics, tiny)


def _corner_with_corner(pairs: _RowPairs) -> PartialQuadratics:
    """Bisectors of corners' rows with corners: -(2 / d) ((1 - x^2) cos f + 2 x sin f).

    On a ray in direction t the perpendicular bisector is at r cos(t - f) = d / 2, so 1 / r = 2 cos(t - f) / d; and
    (1 + x^2) cos t = 1 - x^2, (1 + x^2) sin t = 2 x. Raises TouchingElementsError where corners of two copies coincide.
    """
    rows, around, contour = pairs.rows, pairs.around, pairs.around.contour
    node = contour.corner_node[pairs.item]
    away = around.position(pairs.copy, node) - rows.origin[pairs.row]
    square = away.real**2 + away.imag**2
    other = ~(pairs.own & (node == contour.corner_node[rows.corner[pairs.row]]))
    if (square[other] <= pairs.rounding**2).any():
        raise TouchingElementsError
    v = other.nonzero()[0]
    pairs, away, square = pairs.take(v), away[v], square[v]
    corner, axis = pairs.item, rows.axis[pairs.row]
    low, high = _touching_rays(pairs.beside(), axis, away, square)
    tiny = contour.turn[corner] <= _TINY
    high = _unswapped(low, high, tiny)
    quadratics = _distance_of_corner(*_coordinates(axis, away), square)
    return pairs.functions(len(contour.source) + corner, low, high, quadratics, tiny)


def _height_of_corner(p: Floats, q: Floats) -> Quadratics:
    """h = ((s - p)^2 + q^2) / 2q."""
    return 0.5 / q, np.zeros_like(q), q / 2.0, p


def _distance_of_corner(along: Floats, across: Floats, square: Floats) -> Quadratics:
    """-(2 / d) ((1 - x^2) cos f + 2 x sin f), where along = d cos f, across = d sin f and square = d^2."""
    a, b = 2.0 * along / square, -4.0 * across / square
    return a, b, -a, np.zeros_like(a)


def _coordinates(axis: Complexes, vector: Complexes) -> tuple[Floats, Floats]:
    """The coordinates of vectors along and to the left of unit vectors."""
    along = axis.real * vector.real + axis.imag * vector.imag
    left = axis.real * vector.imag - axis.imag * vector.real
    return along, left


def _bisecting_slope(cosine: Floats, sine: Floats, infinite: float | Floats) -> Floats:
    """-cot(a/2) for angles a, given by cosine and sine; `infinite` where a is exactly 0.

    cot(a/2) = (1 + cos a) / sin a = sin a / (1 - cos a): the one that does not cancel.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        result = np.where(cosine < 0.0, -sine / (1.0 - cosine), -(1.0 + cosine) / sine)
    return np.where((sine == 0.0) & (cosine > 0.0), infinite, result)


def _touching_rays(direction: Complexes, axis: Complexes, vector: Complexes, square: Floats) -> Floats:
    """x of the rays on which two discs through 0 touch lines of direction u, from their left, at vectors v; (2, k).

    There are two of the directions, of the vectors, or of both. `square` is |v|^2; the result is infinite, low and
    high, where the ray is exactly opposite to the axis. The centre z = v + i r u has |z| = r, so z / r is -i u mirrored
    at the line through 0 and v, i (v/|v|)^2 conj(u). Over the axis its cosine and sine, times |v|^2, are the real and
    imaginary part of i v^2 conj(u axis); x is the tangent of half its angle.
    """
    along = direction.real * axis.real - direction.imag * axis.imag
    across = direction.real * axis.imag + direction.imag * axis.real
    real = (vector.real - vector.imag) * (vector.real + vector.imag)
    imag = 2.0 * vector.real * vector.imag
    cosine = across * real - along * imag
    sine = across * imag + along * real
    with np.errstate(divide="ignore", invalid="ignore"):
        result = np.where(cosine < 0.0, (square - cosine) / sine, sine / (square + cosine))
    return np.where((sine == 0.0) & (cosine < 0.0), _ENDLESS, result)


def _unswapped(low: Floats, high: Floats, tiny: Bools) -> Floats:
    """The high ends of intervals between two tangents; the low ones where a tiny interval lies about infinity.

    It is out of every row's reach, whatever rounding makes of its ends, and is to be empty. There 1 + low * high, the
    denominator of the addition theorem for the tangent of the difference, is negative.
    """
    return np.where(tiny & (1.0 + low * high < 0.0), low, high)


def _below_bounds(rows: Rows, bounds: Bounds, functions: PartialQuadratics) -> Ints:
    """The indices of the functions that somewhere fall below both bounds of their rows."""
    straight = rows.straight
    # The height's: h <= H, or -(1 + x^2) / r <= -(1 + x^2) / H.
    flat = np.where(straight, 0.0, -1.0 / bounds.height)
    zero = np.zeros(len(rows))
    limits = flat, zero, np.where(straight, bounds.height, flat), zero
    index = _below(rows, functions, limits, zero, rows.low, rows.high).nonzero()[0]
    # The provisional envelope's, part by part, as with a corner.
    away = bounds.point - rows.origin
    p, q = _coordinates(rows.axis, away)
    square = away.real**2 + away.imag**2
    of_half_edge, of_corner = _height_of_corner(p, np.where(straight, q, 1.0)), _distance_of_corner(p, q, square)
    a, b, c, m = (np.where(straight, *either) for either in zip(of_half_edge, of_corner, strict=True))
    # A point that is near is known to fewer digits.
    doubt = 4.0 * bounds.rounding / np.where(straight, q, np.sqrt(square))
    some = functions.take(index)
    ends = np.stack((rows.low, *bounds.cut, rows.high))
    kept = _below(rows, some, (a, b, c, m), doubt, ends[:-1], ends[1:]).any(axis=0)
    kept |= np.isnan(bounds.point[0].real)[some.row]
    return np.asarray(index[kept])


def _below(
    rows: Rows, functions: PartialQuadratics, limits: Quadratics, doubt: Floats, begin: Floats, end: Floats
) -> Bools:
    """Which functions somewhere between the begin and end of their row fall below its limit, give or take a doubt.

    Of a row there may be several limits, each with a doubt, a begin and an end, along a first axis.
    """
    row = functions.row
    low, high = np.maximum(functions.low, begin.take(row, axis=-1)), np.minimum(functions.high, end.take(row, axis=-1))
    a0, b0, c0, m0 = (coefficient.take(row, axis=-1) for coefficient in limits)
    x, y = low - m0, high - m0
    limit_low, limit_high = c0 + x * (b0 + x * a0), c0 + y * (b0 + y * a0)
    u, v = low - functions.m, high - functions.m
    over_low = functions.c + u * (functions.b + u * functions.a) - limit_low
    over_high = functions.c + v * (functions.b + v * functions.a) - limit_high
    # Of the difference, convex or not: its ends, and its lowest point where that lies between them.
    curvature = functions.a - a0
    slope = functions.b + 2.0 * functions.a * u - b0 - 2.0 * a0 * x
    with np.errstate(divide="ignore", invalid="ignore"):
        step = -slope / (2.0 * curvature)
        inside = (curvature > 0.0) & (step > 0.0) & (step < high - low)
        dip = np.where(inside, over_low + slope * step / 2.0, over_low)
    least = np.minimum(np.minimum(over_low, over_high), dip)
    terms = np.abs(limit_low) + np.abs(limit_high) + np.where(rows.straight[row], 0.0, np.abs(a0) + np.abs(b0))
    return np.asarray((least <= (_SLACK + doubt.take(row, axis=-1)) * terms) & (low <= high))

"""Where an outline crosses itself.

Only arcs whose boxes meet are looked at. These boxes have upright sides, and are passed from left to right; where many
are above each other, as of long teeth that lean, they lie as the arcs do, around groups of arcs first, and a run of
arcs that all go to the right, or all up, cannot cross itself. Whether chords cross is decided by the exact signs of
areas.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, counting, owned_ranges
from voronoi_tiles.base.kernels import COMPLEXES, INT, INTS, kernel
from voronoi_tiles.base.tolerance import EPSILON, PROOF_LIMIT
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.box_tree import Boxes, boxes_around

_FEW = 6  # arcs above or below an arc, on average: of more of them groups are made
_WIDTH = 8  # consecutive arcs of a group, and groups of a larger group
_MARGIN = 1e-9  # of boxes, relative to the extent of all
_AT_ONCE = 1 << 15  # pairs of groups: their parts' take tens of megabytes
_PARTS = 8  # of a curve at first
# Halvings of crossing sub-arcs: after so many a sub-arc's sagitta is below its end points' rounding.
_DIVISIONS = 24
# The relative error of the difference of two products of differences; Shewchuk, Adaptive precision floating-point
# arithmetic and fast robust geometric predicates, 1997.
_AREA_ERROR = (3 + 8 * EPSILON) * EPSILON / 2
_RIGHT, _LEFT, _UP, _DOWN = 1, 2, 4, 8

# What the compiled kernel takes, as in crossings.c, and what it answers where too many arcs are above each other.
_COMPILED = kernel("proof_pairs", INT, COMPLEXES, COMPLEXES, COMPLEXES, INTS, INT, INTS, INTS)
_MANY = -1

_SubArcs = tuple[Ints, Floats, Floats]
"""The arc of each, and the range of the curve's parameter."""


def count_crossings(arcs: AllArcs, size: float) -> int:
    """The number of places where an outline crosses itself; where it merely touches itself it does not.

    `size` is the length of the cell's longer vector: crossings nearer to the ends of arcs than PROOF_LIMIT times this
    are rounding. Chords of curves may cross where the curves do not: where chords cross, these arcs are divided
    further, until no chords cross or the chords are as good as the curves.
    """
    limit = PROOF_LIMIT * size
    folded = _folded(arcs, limit)
    i, j = candidate_pairs(arcs)
    straight = ~(arcs.curved[i] | arcs.curved[j])
    a, b = i[straight], j[straight]
    found = int(_cross_far(arcs.start[a], arcs.end[a], arcs.start[b], arcs.end[b], limit).sum())
    return folded + found + _count_curved(arcs, i[~straight], j[~straight], limit)


def _folded(arcs: AllArcs, limit: float) -> int:
    """The number of curves that turn back upon themselves: their control point lies beyond an end, on its line."""
    u, v = arcs.control - arcs.start, arcs.end - arcs.control
    turned = np.flatnonzero(u.real * v.real + u.imag * v.imag < 0.0)
    if not len(turned):
        return 0
    turned = turned[np.minimum(np.abs(u[turned]), np.abs(v[turned])) > 2 * limit]
    return int((areas(arcs.start[turned], arcs.control[turned], arcs.end[turned]) == 0.0).sum())


def _count_curved(arcs: AllArcs, i: Ints, j: Ints, limit: float) -> int:
    """The number of crossings of arcs i and j of which at least one is curved."""
    if not len(i):
        return 0
    parts = [np.where(arcs.curved[k], _PARTS, 1) for k in (i, j)]
    part, pair = counting(parts[0] * parts[1])
    one, two = np.divmod(part, parts[1][pair])
    first, second = ((k[pair], p / n[pair], (p + 1) / n[pair]) for k, p, n in ((i, one, parts[0]), (j, two, parts[1])))
    for _ in range(_DIVISIONS):
        (a, b), (c, d) = ((arcs.at(arc, low), arcs.at(arc, high)) for arc, low, high in (first, second))
        meeting = _cross_far(a, b, c, d, limit)
        first, second = ((arc[meeting], low[meeting], high[meeting]) for arc, low, high in (first, second))
        bent = np.flatnonzero(arcs.curved[first[0]] | arcs.curved[second[0]])
        if not len(bent):
            return 0
        first, second = _divide(first, second)
    # Many pairs of tiny sub-arcs may be left of one crossing.
    return int(np.unique(np.stack((first[0], second[0])), axis=1).shape[1])


def _divide(first: _SubArcs, second: _SubArcs) -> tuple[_SubArcs, _SubArcs]:
    """The four pairs of halves of each pair of sub-arcs."""
    halves = []
    for arc, low, high in (first, second):
        middle = (low + high) / 2
        halves.append(((arc, low, middle), (arc, middle, high)))
    pairs = [(one, two) for one in halves[0] for two in halves[1]]
    ones, twos = ([np.concatenate(x) for x in zip(*half, strict=True)] for half in zip(*pairs, strict=True))
    return (ones[0], ones[1], ones[2]), (twos[0], twos[1], twos[2])


def _cross_far(a: Complexes, b: Complexes, c: Complexes, d: Complexes, limit: float) -> Bools:
    """Whether segments a b and c d have a point in common that is farther than `limit` from all their ends; bool (n,).

    Of an overlap, as of a spike that turns back upon itself, the middle counts.
    """
    result = np.zeros(len(a), bool)
    if not len(a):
        return result
    at_c, at_d, at_a, at_b = areas(a, b, c), areas(a, b, d), areas(c, d, a), areas(c, d, b)
    proper = np.flatnonzero((np.sign(at_c) * np.sign(at_d) < 0.0) & (np.sign(at_a) * np.sign(at_b) < 0.0))
    point = a[proper] + (b - a)[proper] * (at_a[proper] / (at_a[proper] - at_b[proper]))
    result[proper] = _farthest(point, a[proper], b[proper], c[proper], d[proper]) > limit
    in_line = np.flatnonzero((at_c == 0.0) & (at_d == 0.0) & (at_a == 0.0) & (at_b == 0.0))
    if len(in_line):
        a, b, c, d = a[in_line], b[in_line], c[in_line], d[in_line]
        along = np.where(np.abs(b - a) >= np.abs(d - c), b - a, d - c)
        # By the larger coordinate of their direction points in line are in order without any error.
        flat = np.abs(along.real) >= np.abs(along.imag)
        place = [np.where(flat, z.real, z.imag) for z in (a, b, c, d)]
        low = np.maximum(np.minimum(*place[:2]), np.minimum(*place[2:]))
        high = np.minimum(np.maximum(*place[:2]), np.maximum(*place[2:]))
        ends = np.stack((a, b, c, d))
        lower, upper = (
            ends[np.abs(np.stack(place) - bound).argmin(axis=0), np.arange(len(a))] for bound in (low, high)
        )
        result[in_line] = (low <= high) & (_farthest((lower + upper) / 2, a, b, c, d) > limit)
    return result


def _farthest(point: Complexes, *ends: Complexes) -> Floats:
    """How far points are from the nearest of their ends."""
    return np.asarray(np.abs(np.stack(ends) - point).min(axis=0))


def areas(a: Complexes, b: Complexes, c: Complexes) -> Floats:
    """Twice the areas of triangles, > 0 where c lies on the left of a b: float64 (n,), the signs exact, 0 as well."""
    left = (b.real - a.real) * (c.imag - a.imag)
    right = (b.imag - a.imag) * (c.real - a.real)
    result = left - right
    error = _AREA_ERROR * (np.abs(left) + np.abs(right))
    # Where two corners are one, as of neighbouring segments, both products are the same.
    for k in np.flatnonzero((np.abs(result) <= error) & (error > 0.0) & (c != a) & (c != b)).tolist():
        (x0, y0), (x1, y1), (x2, y2) = ((Fraction(z[k].real), Fraction(z[k].imag)) for z in (a, b, c))
        result[k] = float((x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0))
    return np.asarray(result)


@dataclass(frozen=True, slots=True)
class _Groups:
    """Groups of consecutive arcs, n of them: the boxes around them, and where they all go.

    `ways` (uint8, n) has a bit for each direction that all arcs of a group go in, none where they are of several rings;
    `ring` (intp, n) is that of a group's first arc.
    """

    boxes: Boxes
    ways: npt.NDArray[np.uint8]
    ring: Ints

    def __len__(self) -> int:
        return len(self.ways)

    def possible(self, i: Ints, j: Ints, margin: float) -> tuple[Ints, Ints]:
        """The pairs i <= j of groups whose arcs may cross: of no common run, their boxes not apart by `margin`."""
        run = (j - i <= 1) & (self.ring[i] == self.ring[j]) & (self.ways[i] & self.ways[j] != 0)
        i, j = i[~run], j[~run]
        meet = _meet(self.boxes, i, j, margin)
        i, j = i[meet], j[meet]
        meet = _meet(self.boxes, j, i, margin)
        return i[meet], j[meet]


def _meet(boxes: Boxes, i: Ints, j: Ints, margin: float) -> Bools:
    """Whether no side of box i separates it from box j; bool (n,)."""
    axis, other = boxes.axis[i], boxes.axis[j]
    cos = np.abs(axis.real * other.real + axis.imag * other.imag)
    sin = np.abs(_cross(axis, other))
    away = boxes.centre[j] - boxes.centre[i]
    length, width = boxes.half_length[j], boxes.half_width[j]
    along = np.abs(axis.real * away.real + axis.imag * away.imag)
    across = np.abs(_cross(axis, away))
    return np.asarray(
        (along <= boxes.half_length[i] + length * cos + width * sin + margin)
        & (across <= boxes.half_width[i] + length * sin + width * cos + margin)
    )


def _cross(u: Complexes, v: Complexes) -> Floats:
    """The cross products of vectors."""
    return np.asarray(u.real * v.imag - u.imag * v.real)


def candidate_pairs(arcs: AllArcs) -> tuple[Ints, Ints]:
    """The pairs i < j of arcs of one outline that may cross. A compiled kernel gives the same."""
    compiled, most = _COMPILED(), _FEW * len(arcs)
    if compiled is None:
        pairs = _swept(arcs, most)
        return _of_groups(arcs) if pairs is None else pairs
    i, j = np.empty((2, max(most, 0)), np.intp)
    found = compiled(len(arcs), arcs.start, arcs.control, arcs.end, arcs.tile, most, i, j)
    if found == _MANY:
        return _of_groups(arcs)
    if found < 0:
        raise MemoryError
    return i[:found], j[:found]


def _swept(arcs: AllArcs, most: int) -> tuple[Ints, Ints] | None:
    """The pairs by a sweep from left to right; None where more than `most` arcs are above each other."""
    points = np.array((arcs.start, arcs.control, arcs.end))
    left, right = points.real.min(axis=0), points.real.max(axis=0)
    # Each arc with those of its tile that begin farther to the right, before it ends.
    order = np.lexsort((left, arcs.tile))
    tile, begin = arcs.tile[order], np.arange(1, len(arcs) + 1)
    end = np.searchsorted(tile + 1j * left[order], tile + 1j * right[order], side="right")
    end = np.maximum(end, begin)  # where a result is wrong, and no number
    if (end - begin).sum() > most:
        return None
    later, earlier = owned_ranges(begin, end)
    i, j = order[earlier], order[later]
    for low, high in ((left, right), (points.imag.min(axis=0), points.imag.max(axis=0))):
        # On a side of its upright box an arc has but an end; a box without width or height has no such sides.
        meet = (low[i] < high[j]) & (low[j] < high[i]) | (low[i] == high[j]) & (low[j] == high[i])
        i, j = i[meet], j[meet]
    return np.minimum(i, j), np.maximum(i, j)


def _of_groups(arcs: AllArcs) -> tuple[Ints, Ints]:
    """The pairs by a join of groups of groups of arcs with themselves."""
    levels, margin = _levels(arcs)
    i, j = np.divmod(np.arange(len(levels[-1]) ** 2), len(levels[-1]))
    i, j = levels[-1].possible(i[i <= j], j[i <= j], margin)
    for level in reversed(levels[:-1]):
        # In portions, so that the pairs of parts of each pair never fill the memory.
        portions = [
            level.possible(*_parts(i[k : k + _AT_ONCE], j[k : k + _AT_ONCE], len(level)), margin)
            for k in range(0, max(1, len(i)), _AT_ONCE)
        ]
        i, j = (np.concatenate(part) for part in zip(*portions, strict=True))
    apart = i != j
    return i[apart], j[apart]


def _parts(i: Ints, j: Ints, count: int) -> tuple[Ints, Ints]:
    """The pairs p <= q of parts of groups i and j; there are `count` on their level."""
    shape = (len(i), _WIDTH, _WIDTH)
    steps = np.arange(_WIDTH)
    p = np.broadcast_to((_WIDTH * i[:, None] + steps)[:, :, None], shape).ravel()
    q = np.broadcast_to((_WIDTH * j[:, None] + steps)[:, None, :], shape).ravel()
    inside = (p <= q) & (q < count)
    return p[inside], q[inside]


def _levels(arcs: AllArcs) -> tuple[list[_Groups], float]:
    """Each arc as a group of its own, groups of them, and so on up to few; and the margin of their boxes.

    Every outline is pushed to a place of its own, so that none meets another.
    """
    points = np.stack((arcs.start, np.where(arcs.curved, arcs.control, arcs.start), arcs.end))
    extent = max(float(np.ptp(points.real)), float(np.ptp(points.imag)))
    points += 2 * extent * arcs.tile
    # A straight arc has but one leg; a curve goes where both of its legs go.
    first = np.where(arcs.curved, arcs.control, arcs.end) - arcs.start
    second = np.where(arcs.curved, arcs.end - arcs.control, first)
    ways = np.zeros(len(arcs), np.uint8)
    for one, two, ahead, back in ((first.real, second.real, _RIGHT, _LEFT), (first.imag, second.imag, _UP, _DOWN)):
        ways[(one > 0.0) & (two > 0.0)] |= ahead
        ways[(one < 0.0) & (two < 0.0)] |= back
    ring = np.repeat(np.arange(len(arcs.ring_offsets) - 1), np.diff(arcs.ring_offsets))
    levels = [_Groups(boxes_around(points, 1), ways, ring)]
    width = 1
    while len(levels[-1]) > _WIDTH:
        width *= _WIDTH
        begin = np.arange(0, len(arcs), width)
        ways_of_all = np.bitwise_and.reduceat(ways, begin)
        ways_of_all[ring[begin] != ring[np.minimum(begin + width, len(arcs)) - 1]] = 0
        levels.append(_Groups(boxes_around(points, width), ways_of_all, ring[begin]))
    return levels, _MARGIN * extent

"""For every row, the elements near enough to shape its cell: branch and bound over a hierarchy of boxes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges, starts
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.cells.hierarchy import FEW, Hierarchy
from voronoi_tiles.vector.cells.images import Images
from voronoi_tiles.vector.cells.pencils import Rows
from voronoi_tiles.vector.cells.provisional import Bounds, Provisional, bisector
from voronoi_tiles.vector.copies import Copies

# Relative slack of the pruning tests, far above their rounding errors.
_SLACK = 1e-9
# Pairs that are looked at together: what is computed of more neither stays in the processor's nearest caches nor is
# kept by the process for the next call.
_PORTION = 2048
# Corners begin with the elements that stand so far beside theirs, where there are more elements than a few.
_BESIDE = np.array([-2, -1, 1, 2])


@dataclass(frozen=True, slots=True)
class Level:
    """The images of one level's boxes in all copies.

    What the box `first` + j has in the copy c stands at `images.place(c, j)` in `start`, `end`, `direction` (a unit
    vector), `anchor_start` and `anchor_end` (complex128, flat over the copies). `length`, `radius` (float64, k) and
    `child` (intp, k + 1) are the boxes'; `leaf` tells of the level of the elements themselves.
    """

    first: int
    leaf: bool
    images: Images
    start: Complexes
    end: Complexes
    direction: Complexes
    anchor_start: Complexes
    anchor_end: Complexes
    length: Floats
    radius: Floats
    child: Ints


def move_levels(hierarchy: Hierarchy, copies: Copies) -> list[Level]:
    """The levels of a hierarchy in all copies, from the top."""
    result = []
    for depth, (first, last) in enumerate(pairwise(hierarchy.level.tolist())):
        images, leaf = Images.of(hierarchy.bundle[first:last], copies), depth == len(hierarchy.level) - 2
        # The elements are their own anchors.
        ends = (hierarchy.start, hierarchy.end, hierarchy.anchor_start, hierarchy.anchor_end)[: 2 if leaf else 4]
        points = images.moved(np.array([part[first:last] for part in ends]), copies)
        (start, end), (anchor_start, anchor_end) = points[:2], points[-2:]
        radius, child = hierarchy.radius[first:last], hierarchy.child[first : last + 1] - last
        # Turned, not found anew between the images: of a short box their rounding would turn it.
        chord = hierarchy.end[first:last] - hierarchy.start[first:last]
        length = np.sqrt(chord.real * chord.real + chord.imag * chord.imag)
        with np.errstate(divide="ignore"):
            inverse = np.where(length > 0.0, 1.0 / length, 0.0)
        direction = np.empty(len(chord), complex)
        direction.real, direction.imag = chord.real * inverse + (length == 0.0), chord.imag * inverse
        direction = images.turned(direction, copies.unit, copies.conj)
        found = start, end, direction, anchor_start, anchor_end, length, radius
        result.append(Level(first, leaf, images, *found, child))
    return result


def uncertainty(top: Level) -> float:
    """By how much coordinates, and their differences, may be off: 16 ulps of the largest, among the boxes on top."""
    x, y = top.start.real, top.start.imag
    return 16.0 * EPSILON * float(np.sqrt(x * x + y * y).max())


@dataclass(frozen=True, slots=True)
class Candidates:
    """Pairs of a row and an element of a copy, by its place in the hierarchy's `element`: intp (k,), sorted by row."""

    row: Ints
    copy: Ints
    place: Ints


class TooManyPairsError(Exception):
    """So many rows at once would take too much memory."""


def seeds_of(rows: Rows, contour: Contour, hierarchy: Hierarchy) -> Complexes:
    """The ends of elements beside those at corners, in the hierarchy's order: complex128 (rows, k), NaN for half-edges.

    The cell of a corner may be a sliver between its neighbours, in the midst of many: they are known at once. Where all
    elements are few this does not pay, and there are none.
    """
    count = len(hierarchy.element)
    if count <= FEW:
        return np.zeros((len(rows), 0), complex)
    half_edges = len(contour.source)
    element = np.where(rows.corner < half_edges, rows.corner >> 1, half_edges // 2 + (rows.corner - half_edges) // 4)
    place = np.empty_like(hierarchy.element)
    place[hierarchy.element] = np.arange(count)
    beside = np.minimum(np.maximum(place[element][:, None] + _BESIDE, 0), count - 1) + hierarchy.level[-2]
    ends = np.stack((hierarchy.start[beside], hierarchy.end[beside]), axis=-1).reshape(len(rows), -1)
    return np.where(rows.straight[:, None], np.nan, ends)


def find_candidates(
    rows: Rows, levels: Sequence[Level], seeds: Complexes, covering_radius: float, rounding: float, most: float
) -> tuple[Candidates, Bounds]:
    """A superset of the pairs in which the element shapes the row's cell; and bounds of the cells.

    An element matters only if, for some point of the row's cell, it meets the disc about that point that just reaches
    the row's element. Each anchor may serve the row's provisional envelope, whose discs hold all of these; so the
    bounds tighten while the boxes shrink, and the number of pairs per row stays small at each level.

    `seeds` (complex128, rows x k) are points near the rows to begin with, NaN where there are none.

    Raises TooManyPairsError where more than `most` pairs, or four times as many before they are narrowed, would be held
    at once.
    """
    top = levels[0]
    provisional = Provisional(rows, covering_radius, rounding)
    seeded = np.flatnonzero(~np.isnan(seeds).any(axis=1)) if seeds.size else np.zeros(0, np.intp)
    if len(seeded):
        provisional.lower(np.repeat(seeded, seeds.shape[1]), seeds[seeded].reshape(-1))
    if len(rows) * len(top.start) > most:
        raise TooManyPairsError
    row = np.repeat(np.arange(len(rows)), len(top.start))
    copy, place = np.tile(top.images.copy, len(rows)), np.tile(top.images.thing, len(rows))
    above: Level | None = None
    for level in levels:
        if above is not None:
            count = above.child[place + 1] - above.child[place]
            if int(count.sum()) > 4 * most:
                raise TooManyPairsError
            row, copy, place = np.repeat(row, count), np.repeat(copy, count), ranges(above.child[place], count)
        row, copy, place = _narrow(rows, row, copy, place, level, provisional)
        above = level
    return Candidates(row, copy, place), provisional.bounds


def _narrow(
    rows: Rows, row: Ints, copy: Ints, place: Ints, level: Level, provisional: Provisional
) -> tuple[Ints, Ints, Ints]:
    """The pairs whose boxes can matter, after their anchors have tightened the bounds."""
    bounds = provisional.bounds
    if level.first:
        kept = _in_reach(rows, row, place, level.images.place(copy, place), level, bounds)
        row, copy, place = row[kept], copy[kept], place[kept]
    flat = level.images.place(copy, place)
    if level.leaf:
        provisional.lower(row, level.anchor_start[flat])
    else:
        anchors = np.stack((level.anchor_start[flat], level.anchor_end[flat]), axis=1)
        provisional.lower(np.repeat(row, 2), anchors.reshape(-1))
    # Segments bound well what points do not; but of the first boxes few are near, and the next level follows.
    wide = np.flatnonzero(bounds.wide(rows)[row]) if level.first or level.leaf else ()
    if len(wide):
        at, by = row[wide], flat[wide]
        start, end = level.anchor_start[by], level.anchor_end[by]
        base, ray = np.stack((rows.base0[at], rows.base1[at])), np.stack((rows.ray0[at], rows.ray1[at]))
        _lower(bounds.height, at, _bisector_of_segment(base, ray, start, end, bounds.rounding).max(axis=0))
    kept = _in_reach(rows, row, place, flat, level, bounds)
    return row[kept], copy[kept], place[kept]


def _lower(bound: Floats, row: Ints, height: Floats) -> None:
    """Lower the rows' bounds to the least of their heights, in place; rows ascend."""
    if len(row):
        first = starts(row)
        which = row[first]
        bound[which] = np.minimum(bound[which], np.minimum.reduceat(height, first))


def _in_reach(rows: Rows, row: Ints, place: Ints, flat: Ints, level: Level, bounds: Bounds) -> Ints:
    """The pairs whose box may hold an element that matters; there is at least one pair."""
    portions = [slice(first, first + _PORTION) for first in range(0, len(row), _PORTION)]
    kept = np.concatenate([some.start + _near(row[some], place[some], flat[some], level, bounds) for some in portions])
    wide = bounds.wide(rows)[row[kept]]
    if wide.any():
        # All discs lie in this box on the row's side of its line, which is the sharper test here.
        chosen = kept[wide]
        at, width = row[chosen], level.radius[place[chosen]] * (1.0 + _SLACK)
        reach = bounds.height[at] * (1.0 + _SLACK)
        x0, y0 = _frame(rows.base[at], rows.ray[at], level.start[flat[chosen]])
        x1, y1 = _frame(rows.base[at], rows.ray[at], level.end[flat[chosen]])
        inside = ~wide
        inside[wide] = _enters_box(x0, y0, x1, y1, rows.spread[at] + reach + width, -width, 2.0 * reach + width)
        kept = kept[inside]
    return kept


def _near(row: Ints, place: Ints, flat: Ints, level: Level, bounds: Bounds) -> Ints:
    """The pairs whose box meets one of the row's discs."""
    start, direction = level.start[flat], level.direction[flat]
    length, radius = level.length[place], level.radius[place]
    # One disc holds all four: it spares most boxes the others.
    some = _meets(bounds.middle[row], bounds.around[row], start, direction, length, radius).nonzero()[0]
    near = np.zeros(len(some), bool)
    row, boxes = row[some], (start[some], direction[some], length[some], radius[some])
    for centre, reach in zip(bounds.centre, bounds.reach, strict=True):
        near |= _meets(centre[row], reach[row], *boxes)
    return some[near]


def _meets(
    centre: Complexes, reach: Floats, start: Complexes, direction: Complexes, length: Floats, radius: Floats
) -> Bools:
    """Which boxes are within reach of centres; they have this radius, and begin at start in a direction."""
    away = centre - start
    along = away.real * direction.real + away.imag * direction.imag
    across = np.abs(away.real * direction.imag - away.imag * direction.real)
    x = np.maximum(np.maximum(-along, along - length), 0.0)
    y = np.maximum(across - radius, 0.0)
    return np.asarray(x * x + y * y <= reach * reach)


def _frame(origin: Complexes, ray: Complexes, points: Complexes) -> tuple[Floats, Floats]:
    """Coordinates to the right of rays and along them."""
    away = points - origin
    return away.real * ray.imag - away.imag * ray.real, away.real * ray.real + away.imag * ray.imag


def _enters_box(x0: Floats, y0: Floats, x1: Floats, y1: Floats, width: Floats, low: Floats, high: Floats) -> Bools:
    """Which segments enter the boxes |x| <= width, low <= y <= high (Liang and Barsky)."""
    enter, leave = np.zeros(len(x0)), np.ones(len(x0))
    with np.errstate(divide="ignore", invalid="ignore"):
        for at, step, least, most in ((x0, x1 - x0, -width, width), (y0, y1 - y0, low, high)):
            one, two = (least - at) / step, (most - at) / step
            still = step == 0.0
            inside = (at >= least) & (at <= most)
            enter = np.maximum(enter, np.where(still, np.where(inside, 0.0, 2.0), np.minimum(one, two)))
            leave = np.minimum(leave, np.where(still, 1.0, np.maximum(one, two)))
    return np.asarray(enter <= leave + _SLACK)


def _bisector_of_segment(base: Complexes, ray: Complexes, start: Complexes, end: Complexes, rounding: float) -> Floats:
    """Bounds on the heights at which rays meet the bisectors of their base and segments; infinite if they do not.

    Where the base is near a segment's line only its ends count: it may be the row's own.
    """
    height = np.minimum(bisector(base, ray, start, rounding), bisector(base, ray, end, rounding))
    chord = end - start
    away = base - start
    square = chord.real**2 + chord.imag**2
    with np.errstate(divide="ignore", invalid="ignore"):
        length = np.sqrt(square)
        distance = (chord.real * away.imag - chord.imag * away.real) / length
        # How fast the distance from the line grows along the ray, away from the side on which its base lies.
        growth = (chord.real * ray.imag - chord.imag * ray.real) / length * np.sign(distance)
        touching = np.abs(distance) / (1.0 - growth)
        foot = chord.real * (away.real + touching * ray.real) + chord.imag * (away.imag + touching * ray.imag)
        inside = (foot >= 0.0) & (foot <= square) & (np.abs(distance) > rounding / _SLACK) & (growth < 1.0 - _SLACK)
    return np.where(inside, np.minimum(height, touching), height)

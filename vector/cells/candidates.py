"""For every row, the elements near enough to shape its cell: branch and bound over a hierarchy of capsules."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.vector.cells.hierarchy import Hierarchy, Level
from voronoi_tiles.vector.cells.pencils import Rows

# Relative slack of the pruning tests, far above their rounding errors.
_SLACK = 1e-9


@dataclass(frozen=True, slots=True)
class Candidates:
    """Pairs of a row and an element of a copy, as indices, intp (k,), sorted by row."""

    row: Ints
    copy: Ints
    element: Ints


@dataclass(frozen=True, slots=True)
class Bounds:
    """What bounds each row's cell; tightened in place.

    No point of a row's cell is farther from the row's element than `height` (float64, n). `by_point` (float64, n) is
    the best such bound by the bisector with a single point, and `champion` (complex128, n) that point, NaN where there
    is none. `rounding` is by how much coordinates, and their differences, may be off. All are in the design's units.
    """

    rounding: float
    height: Floats
    by_point: Floats
    champion: Complexes


class TooManyPairsError(Exception):
    """So many rows at once would take too much memory."""


def find_candidates(rows: Rows, hierarchy: Hierarchy, covering_radius: float, most: float) -> tuple[Candidates, Bounds]:
    """A superset of the pairs in which the element shapes the row's cell; and bounds of the cells.

    An element matters only if, for some point of the row's cell, it meets the disc about that point that just reaches
    the row's element. The row's bisector with a point z, its champion, bounds the cell. The discs about the points of
    that bisector all pass through z; let h0 and h1 be the radii of those on the outermost rays, a distance w
    apart. By the powers of points with respect to these circles, every other one lies in the union of these two,
    their radii enlarged to sqrt(h^2 + w^2 / 4). For a corner's fan, w is 0.

    Each anchor may become the champion: bisectors with a point or a segment are highest at the ends of a row. So the
    bounds tighten while the capsules shrink, and the number of pairs per row stays small at each level.

    Raises TooManyPairsError where more than `most` pairs, or four times as many before they are narrowed, would be held
    at once.
    """
    top = hierarchy.levels[0]
    none = np.full(len(rows), np.nan, complex)
    infinite = np.full(len(rows), np.inf)
    rounding = 16.0 * EPSILON * float(np.abs(top.start).max())
    bounds = Bounds(rounding, height=np.full(len(rows), covering_radius), by_point=infinite, champion=none)
    if len(rows) * len(top.start) > most:
        raise TooManyPairsError
    row = np.repeat(np.arange(len(rows)), len(top.start))
    copy, place = np.tile(top.images.copy, len(rows)), np.tile(top.images.thing, len(rows))
    above: Level | None = None
    for level in hierarchy.levels:
        if above is not None:
            count = above.child[place + 1] - above.child[place]
            if int(count.sum()) > 4 * most:
                raise TooManyPairsError
            row, copy, place = np.repeat(row, count), np.repeat(copy, count), ranges(above.child[place], count)
        row, copy, place = _narrow(rows, row, copy, place, level, bounds)
        above = level
    return Candidates(row, copy, hierarchy.order[place]), bounds


def _narrow(rows: Rows, row: Ints, copy: Ints, place: Ints, level: Level, bounds: Bounds) -> tuple[Ints, Ints, Ints]:
    """The pairs whose capsules can matter, after their anchors have tightened the bounds."""
    flat = level.images.place(copy, place)
    kept = _in_reach(rows, row, flat, level.radius[place], level, bounds)
    row, copy, place, flat = row[kept], copy[kept], place[kept], flat[kept]
    anchor = level.anchor_start[flat]
    height = np.maximum(
        _bisector(rows.base0[row], rows.ray0[row], anchor, bounds.rounding),
        _bisector(rows.base1[row], rows.ray1[row], anchor, bounds.rounding),
    )
    _lower(bounds.by_point, row, height)
    best = np.flatnonzero((height == bounds.by_point[row]) & (height < np.inf))
    bounds.champion[row[best]] = anchor[best]
    np.minimum(bounds.height, bounds.by_point, out=bounds.height)
    # Points bound rows badly that are long beside their height; segments do it well.
    wide = np.flatnonzero(_wide(rows, bounds)[row])
    if len(wide):
        at, by = row[wide], flat[wide]
        start, end = level.anchor_start[by], level.anchor_end[by]
        height = _bisector_of_segment(rows.base0[at], rows.ray0[at], start, end, bounds.rounding)
        height = np.maximum(height, _bisector_of_segment(rows.base1[at], rows.ray1[at], start, end, bounds.rounding))
        _lower(bounds.height, at, height)
    kept = _in_reach(rows, row, flat, level.radius[place], level, bounds)
    return row[kept], copy[kept], place[kept]


def _wide(rows: Rows, bounds: Bounds) -> Bools:
    """Which rows are long beside their height."""
    return rows.spread > bounds.height / 8.0


def _lower(bound: Floats, row: Ints, height: Floats) -> None:
    """Lower the rows' bounds to the least of their heights, in place; rows ascend."""
    if len(row):
        first = np.flatnonzero(np.concatenate(([True], row[1:] != row[:-1])))
        which = row[first]
        bound[which] = np.minimum(bound[which], np.minimum.reduceat(height, first))


def _in_reach(rows: Rows, row: Ints, flat: Ints, radius: Floats, level: Level, bounds: Bounds) -> Ints:
    """The pairs whose capsule may hold an element that matters."""
    start, end = level.start[flat], level.end[flat]
    chord = end - start
    square = chord.real**2 + chord.imag**2
    square[square == 0.0] = 1.0
    lone = np.isnan(bounds.champion)
    near = lone[row]
    for base, ray in ((rows.base0, rows.ray0), (rows.base1, rows.ray1)):
        height = np.where(lone, 0.0, _bisector(base, ray, bounds.champion, bounds.rounding))
        centre, reach = base + height * ray, np.hypot(height, rows.spread) * (1.0 + _SLACK)
        away = centre[row] - start
        along = np.minimum(np.maximum((away.real * chord.real + away.imag * chord.imag) / square, 0.0), 1.0)
        near |= np.abs(away - along * chord) <= reach[row] + radius
    kept = np.flatnonzero(near)
    wide = _wide(rows, bounds)[row[kept]]
    if wide.any():
        # All discs lie in this box on the row's side of its line, which is the sharper test here.
        chosen = kept[wide]
        at, width = row[chosen], radius[chosen] * (1.0 + _SLACK)
        reach = bounds.height[at] * (1.0 + _SLACK)
        x0, y0 = _frame(rows.base[at], rows.ray[at], start[chosen])
        x1, y1 = _frame(rows.base[at], rows.ray[at], end[chosen])
        inside = ~wide
        inside[wide] = _enters_box(x0, y0, x1, y1, rows.spread[at] + reach + width, -width, 2.0 * reach + width)
        kept = kept[inside]
    return kept


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


def _bisector(base: Complexes, ray: Complexes, points: Complexes, rounding: float) -> Floats:
    """Bounds on the heights at which rays meet the bisectors of their base and points; infinite if they do not.

    Coordinates are uncertain by `rounding`, which counts where a point is near the base or square to the ray.
    """
    away = points - base
    along = away.real * ray.real + away.imag * ray.imag - rounding
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(along > 0.0, (away.real**2 + away.imag**2) / (2.0 * along), np.inf)


def _bisector_of_segment(base: Complexes, ray: Complexes, start: Complexes, end: Complexes, rounding: float) -> Floats:
    """Bounds on the heights at which rays meet the bisectors of their base and segments; infinite if they do not.

    Where the base is near a segment's line only its ends count: it may be the row's own.
    """
    height = np.minimum(_bisector(base, ray, start, rounding), _bisector(base, ray, end, rounding))
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

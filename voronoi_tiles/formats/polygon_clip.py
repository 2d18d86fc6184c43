"""Paths clipped by a polygon, of lines, arcs and Bezier curves up to the third degree: each keeps its kind."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, offsets_of
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths
from voronoi_tiles.paths.segments import point_at, split

CLIP_MAX: Final = 20_000_000
"""Most pairs of a segment and a side of the polygon; a count. A few seconds' work."""

_FLAT: Final = 1e-9
"""The tangent of a quarter of an arc's angle below which it is a line."""

_SLACK: Final = 1e-9
"""How far beyond the polygon still counts as within, relative to all coordinates: a side of what is clipped often lies
on one of the polygon's."""


def clipped_by(paths: Paths, corners: Complexes) -> tuple[Paths, Ints]:
    """What of paths lies within a polygon or on its sides, and (intp) the path that each of them is of.

    `corners` is complex128 (k,). Closed paths that lie within as a whole stay closed.
    """
    import shapely

    area = shapely.Polygon(np.column_stack((corners.real, corners.imag)))
    slack = _SLACK * float(max(np.abs(corners).max(), np.abs(paths.start).max(initial=0.0)))
    segment, t0, t1 = _parted(paths, _crossing_shares(paths, corners, slack))
    parts = _parts(paths, segment, t0, t1)
    middle = _points(parts, np.arange(len(segment)), np.full(len(segment), 0.5))
    kept = shapely.dwithin(area, shapely.points(middle.real, middle.imag), slack)
    return _runs(paths, parts, segment, kept)


def dots_within(points: Complexes, corners: Complexes) -> Bools:
    """Which points lie within a polygon or on its sides."""
    import shapely

    area = shapely.Polygon(np.column_stack((corners.real, corners.imag)))
    slack = _SLACK * float(np.abs(corners).max())
    return np.asarray(shapely.dwithin(area, shapely.points(points.real, points.imag), slack), np.bool_)


def _crossing_shares(paths: Paths, corners: Complexes, slack: float) -> Iterator[tuple[Ints, Floats]]:
    """For each side of the polygon the segments that meet it, and at which parameter."""
    # An arc that is flat but for rounding has no circle.
    arc = (paths.kind == ARC) & (np.abs(paths.bulges()) > _FLAT)
    arcs = np.flatnonzero(arc)
    beziers = (
        (np.flatnonzero((paths.kind == LINE) | ((paths.kind == ARC) & ~arc)), [0, 3]),
        (np.flatnonzero(paths.kind == QUAD), [0, 1, 3]),
        (np.flatnonzero(paths.kind == CUBIC), [0, 1, 2, 3]),
    )
    points = np.stack((paths.start, *paths.control.T, paths.end))
    for tail, head in zip(corners, np.roll(corners, -1), strict=True):
        if head == tail:
            continue
        along = (head - tail) / abs(head - tail)
        off = ((points - tail) * np.conj(along)).imag
        found = [pair for some, rows in beziers for pair in _bezier_roots(some, off[rows][:, some])]
        for some, t in (*found, *_arc_roots(paths, arcs, tail, along)):
            inner = (t > 0.0) & (t < 1.0)
            yield _on_side(paths, some[inner], t[inner], tail, head, slack)


def _arc_roots(paths: Paths, arcs: Ints, tail: complex, along: complex) -> Iterator[tuple[Ints, Floats]]:
    """The two points in which the circle of each arc meets a line, as shares of its angle, also beyond its ends."""
    centre, radius, begin, turn = paths.circles(arcs)
    high = ((centre - tail) * np.conj(along)).imag
    meets = np.abs(high) < radius
    angle = -np.arcsin(high[meets] / radius[meets])
    for direction in (angle, np.pi - angle):
        ahead = np.mod((direction + np.angle(along) - begin[meets]) * np.sign(turn[meets]), 2 * np.pi)
        yield arcs[meets], ahead / np.abs(turn[meets])


def _on_side(paths: Paths, some: Ints, t: Floats, tail: complex, head: complex, slack: float) -> tuple[Ints, Floats]:
    """Of points on the line of a side those that are on the side itself, and not at an end of their segment."""
    points = _points(paths, some, t)
    x = ((points - tail) * np.conj(head - tail)).real / abs(head - tail)
    on = (x >= -slack) & (x <= abs(head - tail) + slack)
    on &= (np.abs(points - paths.start[some]) > slack) & (np.abs(points - paths.end[some]) > slack)
    return some[on], t[on]


def _bezier_roots(some: Ints, off: Floats) -> list[tuple[Ints, Floats]]:
    """Where Bezier curves with the ordinates `off` (degree + 1, n) are 0."""
    near = np.flatnonzero((off.min(axis=0) <= 0) & (off.max(axis=0) >= 0)) if len(some) else some
    if len(off) == 2:
        near = near[off[0, near] != off[1, near]]
        return [(some[near], off[0, near] / (off[0, near] - off[1, near]))]
    found = []
    for k in near.tolist():
        a, b, c, d = (*off[:, k].tolist(), 0.0)[:4]
        power = [c - 2 * b + a, 2 * (b - a), a]
        if len(off) == 4:
            power = [d - 3 * c + 3 * b - a, 3 * (c - 2 * b + a), 3 * (b - a), a]
        roots = np.roots(power)
        real = roots.real[np.abs(roots.imag) <= 1e-6]
        found.append((np.full(len(real), some[k], np.intp), real))
    return found


def _parted(paths: Paths, shares: Iterator[tuple[Ints, Floats]]) -> tuple[Ints, Floats, Floats]:
    """The parts of all segments between the parameters where they are cut: segment, first and last parameter."""
    count = len(paths.start)
    found = list(shares)
    segment = np.concatenate([np.arange(count), *(some for some, _ in found)])
    t = np.concatenate([np.zeros(count), *(share for _, share in found)])
    order = np.lexsort((t, segment))
    segment, t = segment[order], t[order]
    following = np.append(t[1:], 1.0)
    following[np.append(np.diff(segment) > 0, True)] = 1.0
    long = following > t
    return segment[long], t[long], following[long]


def _points(paths: Paths, segments: Ints, t: Floats) -> Complexes:
    """The points at t of segments of any kind."""
    result = np.empty(len(segments), np.complex128)
    cubic = paths.kind[segments] == CUBIC
    result[~cubic] = point_at(paths, segments[~cubic], t[~cubic])
    some, at = segments[cubic], t[cubic]
    p, q = paths.start[some], paths.end[some]
    b, c = paths.control[some].T
    s = 1 - at
    result[cubic] = s**3 * p + 3 * at * s * (s * b + at * c) + at**3 * q
    return result


def _parts(paths: Paths, segment: Ints, t0: Floats, t1: Floats) -> Paths:
    """The parts of segments from t0 to t1, a path each, those that follow each other sharing their point."""
    whole = (t0 == 0.0) & (t1 == 1.0)
    begin = np.where(t0 == 0.0, paths.start[segment], _points(paths, segment, t0))
    end = np.where(t1 == 1.0, paths.end[segment], _points(paths, segment, t1))
    control = paths.control[segment]
    plain = np.flatnonzero(~whole & (paths.kind[segment] != CUBIC))
    control[plain] = split(paths, segment[plain], t0[plain], t1[plain], begin[plain], end[plain]).control
    cubic = np.flatnonzero(~whole & (paths.kind[segment] == CUBIC))
    some, u, v = segment[cubic], t0[cubic], t1[cubic]
    points = (paths.start[some], *paths.control[some].T, paths.end[some])
    for column, (one, two, three) in enumerate(((u, u, v), (u, v, v))):
        control[cubic, column] = _blossom(points, one, two, three)
    count = len(segment)
    return Paths(begin, end, control, paths.kind[segment], np.arange(count + 1), np.zeros(count, np.bool_))


def _blossom(points: tuple[Complexes, ...], *shares: Floats) -> Complexes:
    """The polar value of cubic Bezier curves, of which control points of their parts are."""
    for t in shares:
        points = tuple((1 - t) * p + t * q for p, q in pairwise(points))
    return points[0]


def _runs(paths: Paths, parts: Paths, segment: Ints, kept: Bools) -> tuple[Paths, Ints]:
    """Kept parts that follow each other, as paths; a closed path of which some is left out begins behind that."""
    owner = paths.owner[segment]
    first = np.searchsorted(owner, np.arange(len(paths) + 1))
    order = np.arange(len(segment))
    dropped = np.flatnonzero(~kept)
    closed = paths.closed.copy()
    for path in np.unique(owner[dropped]).tolist():
        if paths.closed[path]:
            low, high = first[path], first[path + 1]
            gap = dropped[np.searchsorted(dropped, low)]
            order[low:high] = np.roll(order[low:high], low - gap)
            closed[path] = False
    order = order[kept[order]]
    number = owner[order]
    # A part goes on with the one before where that is the one before in its own path as well.
    behind = order - 1
    wraps = behind < first[number]
    behind[wraps] = first[number[wraps] + 1] - 1
    joined = np.append(False, (order[:-1] == behind[1:]) & (number[1:] == number[:-1])) if len(order) else kept[:0]
    begins = np.flatnonzero(~joined)
    taken = parts.take(order)
    counts = np.diff(np.append(begins, len(order)))
    return replace(taken, offsets=offsets_of(counts), closed=closed[number[begins]]), number[begins].astype(np.intp)

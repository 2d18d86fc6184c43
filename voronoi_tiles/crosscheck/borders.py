"""Certified crossings on the exact edges, and points of the exact edges by distance: the borders, both ways."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.crosscheck.check_report import Figure, Marks
from voronoi_tiles.crosscheck.labels import Owners
from voronoi_tiles.crosscheck.subject import STRANGER, Codes, Subject
from voronoi_tiles.raster.reference import BisectorPoints, Judge, decode, encode
from voronoi_tiles.vector.nearest import distance_to_arcs
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.scan import crossings

_ALONG = (0.0, 0.25, 0.5, 0.75)
"""Where on every arc distances are compared; its end is the next arc's start."""

_SEARCH = 0.01
"""How far around a crossing arcs are looked for; samples. Far more than the limit, so that misses are measured."""

_FEW = 1000
"""Most misses whose distance is measured over all arcs; a count."""


def compare_crossings(subject: Subject, owned: Owners) -> list[Figure]:
    """The figures "crossings", "neighbours" and "edges"."""
    found = _certified(subject, owned)
    # Every crossing lies on an edge of either tile; each is looked at from its own copy.
    own = np.concatenate((found.before, found.after))
    other = np.concatenate((found.after, found.before))
    place, slope = np.tile(found.place, 2), np.tile(found.slope, 2)
    site, beyond = subject.relative(own, other)
    home = subject.pull_back(place, own)
    limit = (subject.accuracy + 4 * subject.rounding) / np.maximum(slope, 1e-9)
    named = np.full(len(own), np.inf)
    nearest = np.full(len(own), np.inf)
    arc = np.full(len(own), -1, np.intp)
    for number, outline in enumerate(subject.outlines):
        chosen = np.flatnonzero(site == number)
        reach = _SEARCH * subject.frame.pixel + limit[chosen]
        named[chosen], nearest[chosen], arc[chosen] = _on_arcs(
            outline, subject.beyond[number], home[chosen], beyond[chosen], reach
        )
    lost = nearest > limit
    unnamed = ~lost & (named > limit)
    # Where a third copy is as near, as far as rounding tells, its edge may be there instead.
    renamed = unnamed & np.tile(found.alone, 2)
    _measure(subject, lost, site, home, nearest)
    sound = ~(lost | unnamed)
    measured = np.where(sound, named, nearest)
    worst = int(np.argmax(np.where(np.isfinite(measured), measured, 0.0) / limit)) if len(limit) else 0
    count = len(own)
    positions = Figure(
        "crossings",
        "places equally far from two copies that are not on an edge of the outline",
        count,
        int(lost.sum()),
        float(measured[worst]) if count else 0.0,
        float(limit[worst]) if count else subject.accuracy,
        subject.units,
        "(accuracy + 4 rounding) / slope of the distances' difference",
        Marks(subject.frame.origin + place[lost], nearest[lost]),
    )
    pairs = np.unique(np.stack((site, beyond), axis=1), axis=0)
    strangers = sum(int((codes == STRANGER).any()) for codes in subject.beyond)
    neighbours = Figure(
        "neighbours",
        "crossings on an edge that names another copy, and edges that name none",
        len(pairs),
        int(renamed.sum()) + strangers,
        None,
        None,
        "",
        "the pairs of copies on the two sides of a crossing",
        Marks(subject.frame.origin + place[renamed], np.full(int(renamed.sum()), np.inf)),
    )
    return [positions, neighbours, _crossed(subject, own[sound], arc[sound])]


def compare_points(subject: Subject) -> Figure:
    """The figure "equidistance": points of every exact edge, by the raster stage's distances."""
    frame, pattern = subject.frame, subject.pattern
    place, codes, own = [], [], []
    identity = pattern.group.operations[0]
    for number, (outline, across) in enumerate(zip(subject.outlines, subject.beyond, strict=True)):
        base = int(encode(np.array(pattern.locate(number, identity))))
        for t in _ALONG:
            bent = (1 - t) ** 2 * outline.start + 2 * t * (1 - t) * outline.control + t * t * outline.end
            straight = (1 - t) * outline.start + t * outline.end
            place.append(np.where(outline.curved, bent, straight))
            codes.append(across)
            own.append(np.full(len(across), base))
    points, beyond, base_copy = np.concatenate(place), np.concatenate(codes), np.concatenate(own)
    x, y = subject.grid.to_grid(points)
    m, n = np.floor(x / frame.width), np.floor(y / frame.height)
    shift = m.astype(np.int64) * subject.period[0] + n.astype(np.int64) * subject.period[1]
    x, y = x - m * frame.width, y - n * frame.height
    mine, theirs, least = (np.full(len(points), np.inf) for _ in range(3))
    for judge, index in subject.split(x, y):
        near = judge.near(x[index] - judge.frame.column, y[index] - judge.frame.row)
        np.minimum.at(least, index[near.point], near.distance)
        for distances, copies in ((mine, base_copy - shift), (theirs, beyond - shift)):
            hit = near.copy == copies[index[near.point]]
            distances[index[near.point[hit]]] = near.distance[hit]
    error = np.full(len(points), np.inf)
    known = np.isfinite(mine) & np.isfinite(theirs)
    here, there = mine[known], theirs[known]
    error[known] = np.maximum(np.abs(here - there), np.maximum(here, there) - least[known])
    error = np.maximum(error, _from_definition(subject, points, mine))
    limit = subject.accuracy + 4 * subject.rounding
    wrong = error > limit
    return Figure(
        "equidistance",
        "points of edges that are not equally far from both sides' copies, or nearer to a third",
        len(points),
        int(wrong.sum()),
        float(error.max(initial=0.0)),
        limit,
        subject.units,
        "accuracy + 4 rounding",
        Marks(points[wrong], error[wrong]),
    )


def _from_definition(subject: Subject, points: Complexes, distance: Floats) -> Floats:
    """How far the points of parabolas are from being as far from focus and directrix as from the site; 0 for lines.

    From a directrix that is given by two near points, distances are known the worse the farther the foot is away.
    """
    count = len(_ALONG)
    curved, focus, start, end = (
        np.concatenate([np.tile(values, count) for values in column])
        for column in zip(
            *((o.curved, o.focus, o.directrix[:, 0], o.directrix[:, 1]) for o in subject.outlines), strict=True
        )
    )
    bent = np.flatnonzero(curved & np.isfinite(distance))
    error = np.zeros(len(points))
    chord, away, true = (end - start)[bent], (points - start)[bent], distance[bent]
    length = np.abs(chord)
    across = np.abs(away.imag * chord.real - away.real * chord.imag) / length
    along = np.abs(away.real * chord.real + away.imag * chord.imag) / length
    slack = 2 * subject.rounding * along / length
    error[bent] = np.maximum(np.abs(np.abs((points - focus)[bent]) - true), np.abs(across - true) - slack)
    return error


def _certified(subject: Subject, owned: Owners) -> BisectorPoints:
    """Find, in float64, where the steps between samples of different owners pass from copy to copy."""
    parts = []
    for judge in subject.judges:
        for down in (False, True):
            column, row, before, after = _steps(subject, owned, judge, down=down)
            parts.append(judge.certify(column, row, np.full(len(column), down), before, after))
    return BisectorPoints(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _steps(subject: Subject, owned: Owners, judge: Judge, *, down: bool) -> tuple[Ints, Ints, Codes, Codes]:
    """The steps of one window to the next column, or row, whose ends have different owners: place, and both codes.

    The step from the last column or row leads to the first one of the next cell.
    """
    frame, window = subject.frame, judge.frame
    x, y = window.column, window.row
    here = owned.identity[y : y + window.height, x : x + window.width]
    wraps = y + window.height == frame.height if down else x + window.width == frame.width
    period = subject.period[1 if down else 0]
    different = np.ones(here.shape, bool)  # of the last ones, whose next ones lie outside, the codes tell
    if down:
        np.not_equal(here[1:], here[:-1], out=different[:-1])
    else:
        np.not_equal(here[:, 1:], here[:, :-1], out=different[:, :-1])
    row, column = np.nonzero(different)
    there = owned.identity[(y + row + down) % frame.height, (x + column + (not down)) % frame.width]
    before, after = owned.codes[here[row, column]], owned.codes[there]
    if wraps:
        after = after + period * ((row if down else column) == (window.height if down else window.width) - 1)
    real = before != after
    return column[real], row[real], before[real], after[real]


def _on_arcs(
    outline: Outline, codes: Codes, points: Complexes, beyond: Codes, reach: Floats
) -> tuple[Floats, Floats, Ints]:
    """For points that should lie on arcs: distance from the nearest arc of the right name, from any, and the former.

    Arcs within `reach` are seen.
    """
    import shapely

    ends = np.stack((outline.start, outline.control, outline.end))
    tree = shapely.STRtree(
        shapely.box(ends.real.min(axis=0), ends.imag.min(axis=0), ends.real.max(axis=0), ends.imag.max(axis=0))
    )
    around = shapely.box(points.real - reach, points.imag - reach, points.real + reach, points.imag + reach)
    point, arc = tree.query(around)
    order = np.argsort(point, kind="stable")
    point, arc = point[order], arc[order]
    distance = distance_to_arcs(outline, arc, points[point])
    right = codes[arc] == beyond[point]
    named, nearest = np.full(len(points), np.inf), np.full(len(points), np.inf)
    np.minimum.at(nearest, point, distance)
    np.minimum.at(named, point[right], distance[right])
    best = np.full(len(points), -1, np.intp)
    hit = np.flatnonzero(right & (distance == named[point]))
    best[point[hit]] = arc[hit]
    return named, nearest, best


def _measure(subject: Subject, lost: NDArray[np.bool_], site: Ints, home: Complexes, nearest: Floats) -> None:
    """Measure how far lost crossings are from the whole outline, in place; for a few of those that are far."""
    index = np.flatnonzero(lost & ~np.isfinite(nearest))[:_FEW]
    for k in index.tolist():
        outline = subject.outlines[site[k]]
        arcs = np.arange(len(outline))
        nearest[k] = distance_to_arcs(outline, arcs, np.full(len(arcs), home[k])).min()


def _crossed(subject: Subject, copy: Codes, arc: Ints) -> Figure:
    """How often every edge was crossed, against the scan conversion of the outline.

    Crossings of one outline that share a step hide each other. Beside them two may be missing or too many: an arc's
    ends, where rounding decides which of two arcs is crossed.
    """
    placements = subject.pattern.placements
    which = decode(copy)[:, 0]
    checked, wrong, worst = 0, 0, 0
    missed: list[complex] = []
    for number, placement in enumerate(placements):
        outline = subject.outlines[placement.site]
        expected, hidden = np.zeros(len(outline), np.intp), np.zeros(len(outline), np.intp)
        axes: tuple[Literal[0, 1], ...] = (0, 1)
        for axis in axes:
            scanned = crossings(outline, placement.isometry, subject.grid, axis)
            step = np.stack((scanned.line, np.floor(scanned.position).astype(np.intp)), axis=1)
            _, inverse, size = np.unique(step, axis=0, return_inverse=True, return_counts=True)
            expected += np.bincount(scanned.arc, minlength=len(outline))
            alone = size[inverse.reshape(-1)] == 1
            hidden += np.bincount(scanned.arc[~alone], minlength=len(outline))
        found = np.bincount(arc[which == number], minlength=len(outline))
        off = np.abs(found - expected) - hidden
        checked += len(outline)
        worst = max(worst, int(off.max(initial=0)))
        bad = np.flatnonzero(off > 2)
        wrong += len(bad)
        middle = outline.control[bad] / 2 + (outline.start[bad] + outline.end[bad]) / 4
        missed += placement.isometry(middle).tolist()
    return Figure(
        "edges",
        "edges crossed more or less often than the scan of the outline says",
        checked,
        wrong,
        float(max(worst, 0)),
        2.0,
        "crossings",
        "an arc's two ends, beside crossings hidden in one step",
        Marks(np.array(missed, complex), np.full(len(missed), np.inf)),
    )

"""Paths cut into smooth runs of curves, and something else put in the place of each run.

What replaces a run (biarcs, cubic curves) is drawn in one sense whichever way the run is gone through, so that a run
and its reverse are replaced by the same bits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges
from voronoi_tiles.paths.paths import CUBIC, LINE, QUAD, Kinds, Paths
from voronoi_tiles.paths.segmentation import Stretches
from voronoi_tiles.paths.smooth_runs import SmoothRuns, tangents

CORNER: Final = 1e-6
"""Tangents that differ by more than this make a corner; radians. Rounding leaves some 1e-10 of a smooth joint between
segments of a millionth of the drawing's size; a corner that is meant is far above."""

_ALIKE: Final = 1e-9
"""Coordinates that differ by less than this are alike; relative to the first and the last chord of a run."""


class Drawn(NamedTuple):
    """What replaces runs, in order along each: the run, and segments as in Paths."""

    run: Ints
    start: Complexes
    end: Complexes
    control: Complexes
    kind: Kinds

    def of(self, rows: Ints) -> Drawn:
        """Some of the segments, in this order."""
        return Drawn._make(column[rows] for column in self)


class RunCurves(NamedTuple):
    """Bezier curves, one row each; `cubic` says which have two control points."""

    start: Complexes
    first: Complexes
    second: Complexes
    end: Complexes
    cubic: Bools

    @classmethod
    def of_segments(cls, paths: Paths, segments: Ints) -> RunCurves:
        """Some segments of paths."""
        control = paths.control[segments]
        cubic = paths.kind[segments] == CUBIC
        return cls(paths.start[segments], control[:, 0], control[:, 1], paths.end[segments], cubic)

    def coefficients(self) -> tuple[Floats, Floats]:
        """Those of `SmoothRuns`, x and y, each float64 (4, n)."""
        x, y = (
            np.where(
                self.cubic,
                np.stack((p0, p1 - p0, p0 - 2 * p1 + p2, (p3 - p0) + 3 * (p1 - p2))),
                np.stack((p0, (p1 - p0) * (2 / 3), (p0 - 2 * p1 + p3) / 3, np.zeros(len(p0)))),
            )
            for p0, p1, p2, p3 in (
                (self.start.real, self.first.real, self.second.real, self.end.real),
                (self.start.imag, self.first.imag, self.second.imag, self.end.imag),
            )
        )
        return x, y


def stretch_ends(runs: SmoothRuns, curves: RunCurves, stretches: Stretches) -> tuple[Complexes, Complexes]:
    """Where stretches that cover runs begin and end; the same bits where they meet, and the runs' own at their ends."""
    run, low, _ = stretches
    begin = np.append(True, run[1:] != run[:-1])
    final = np.append(begin[1:], True)
    start = np.empty(len(run), np.complex128)
    start.real, start.imag = runs.points(*runs.locate(run, low, before=False))
    start[begin] = curves.start[runs.first[:-1]]
    end = np.append(start[1:], 0)
    end[final] = curves.end[runs.first[1:] - 1]
    return start, end


class CutPaths(NamedTuple):
    """Paths cut into smooth runs of curves: which segments are `bent`, each run's first one, how many it has."""

    paths: Paths
    bent: Bools
    first: Ints
    counts: Ints


def cut_runs(paths: Paths, corner: float, absorbed: float, breaks: Complexes | None = None) -> CutPaths:
    """Cut paths at their corners, and into runs of curved segments that join smoothly.

    Corners are where tangents differ by more than `corner` (radians), and the points `breaks`; LINEs shorter than
    `absorbed` count as curved. A closed path that began within a run begins at the end of that run instead; one that is
    all one run is cut where it began. Curved segments of length 0 vanish, unless a path has nothing else: then one line
    of length 0 stays.
    """
    short = np.flatnonzero((paths.kind == LINE) & (np.abs(paths.end - paths.start) < absorbed))
    if len(short):
        kind, control = paths.kind.copy(), paths.control.copy()
        kind[short], control[short, 0] = QUAD, (paths.start[short] + paths.end[short]) / 2
        paths = replace(paths, kind=kind, control=control)
    paths, begins = _arranged(paths, corner, breaks)
    bent = _bent(paths)
    segments = np.flatnonzero(bent)
    first = np.flatnonzero(begins & bent)
    counts = np.diff(np.append(np.searchsorted(segments, first), len(segments)))
    return CutPaths(paths, bent, first, counts)


def replace_runs(paths: Paths, corner: float, absorbed: float, draw: Callable[[SmoothRuns, RunCurves], Drawn]) -> Paths:
    """Put what `draw` makes of them in the place of the runs of `cut_runs`; all else stays as it is.

    `draw` gets the runs in both senses, and what takes fewer segments is kept.
    """
    cut = cut_runs(paths, corner, absorbed)
    if not len(cut.first):
        return cut.paths
    return replaced(cut, *_fewer(cut, draw))


def _bent(paths: Paths) -> Bools:
    """Which segments are to be replaced."""
    return np.asarray((paths.kind == QUAD) | (paths.kind == CUBIC))


def _arranged(paths: Paths, corner: float, breaks: Complexes | None) -> tuple[Paths, Bools]:
    """The paths without curves of length 0, closed ones begun where no run is cut; and where runs begin."""
    paths = _without_points(paths)
    smooth = _smooth(paths, corner)
    if breaks is not None:
        smooth &= ~np.isin(paths.start, breaks)
    owner, begin, counts = paths.owner, paths.offsets[:-1], paths.counts
    number = np.arange(len(owner)) - begin[owner]
    full = np.flatnonzero(counts)
    shift = np.zeros(len(paths), np.intp)
    if len(full):
        place = np.where(smooth, counts[owner], number)
        shift[full] = np.minimum.reduceat(place, begin[full]) % counts[full]
    order = begin[owner] + (number + shift[owner]) % counts[owner]
    begins = ~smooth[order]
    begins[begin[full]] = True
    start, end, control, kind = paths.start[order], paths.end[order], paths.control[order], paths.kind[order]
    return replace(paths, start=start, end=end, control=control, kind=kind), begins


def _without_points(paths: Paths) -> Paths:
    """The paths without curved segments of length 0; a path of nothing else becomes one line of length 0."""
    still = _bent(paths) & (paths.start == paths.end) & (paths.control[:, 0] == paths.start)
    still &= (paths.kind == QUAD) | (paths.control[:, 1] == paths.start)
    if not np.any(still):
        return paths
    kept = ~still
    left = np.bincount(paths.owner[kept], minlength=len(paths))
    kept[paths.offsets[:-1][(left == 0) & (paths.counts > 0)]] = True
    return Paths(
        start=paths.start[kept],
        end=paths.end[kept],
        control=np.where(still[:, None], 0, paths.control)[kept],
        kind=np.where(still, np.uint8(LINE), paths.kind)[kept],
        offsets=np.append(0, np.cumsum(np.bincount(paths.owner[kept], minlength=len(paths)))).astype(np.intp),
        closed=paths.closed,
    )


def _smooth(paths: Paths, corner: float) -> Bools:
    """Which segments are curves that go on smoothly from a curve before them; in closed paths the last is before."""
    bent = _bent(paths)
    curved = np.flatnonzero(bent)
    x, y = RunCurves.of_segments(paths, curved).coefficients()
    leaving, arriving = np.zeros((2, len(bent))), np.zeros((2, len(bent)))
    leaving[:, curved] = tangents(x, y, 0.0, ahead=True)
    arriving[:, curved] = tangents(x, y, 1.0, ahead=False)
    before = np.arange(-1, len(bent) - 1)
    full = np.flatnonzero(paths.counts)
    begin = paths.offsets[:-1][full]
    before[begin] = np.where(paths.closed[full], paths.offsets[full + 1] - 1, begin)
    (ax, ay), (bx, by) = arriving[:, before], leaving
    angle = np.abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))
    smooth: Bools = bent & bent[before] & (angle <= corner)
    smooth[begin[~paths.closed[full]]] = False
    return smooth


def canonical_senses(cut: CutPaths) -> Bools:
    """Which runs are looked at backwards, so that a run and its reverse look alike: by their points' order."""
    paths, first, last = cut.paths, cut.first, cut.first + cut.counts - 1
    near = paths.control[first, 0]
    far = np.where(paths.kind[last] == CUBIC, paths.control[last, 1], paths.control[last, 0])
    turned = np.zeros(len(first), np.bool_)
    equal = ~turned
    # What differs in last bits alone is equal at first: these are not the same on all processors.
    chord = np.abs(paths.end - paths.start)
    for tolerance in (_ALIKE * (chord[first] + chord[last]), 0.0):
        for a, b in ((paths.start[first], paths.end[last]), (near, far), (paths.end[first], paths.start[last])):
            for u, v in ((a.real, b.real), (a.imag, b.imag)):
                turned |= equal & (u > v + tolerance)
                equal &= np.abs(u - v) <= tolerance
    return turned


def oriented_runs(cut: CutPaths, chosen: Ints, turned: Bools) -> tuple[RunCurves, Ints]:
    """The segments of some runs, those of `turned` ones backwards, and where each run's begin; one number more."""
    first, counts = cut.first[chosen], cut.counts[chosen]
    run = np.repeat(np.arange(len(first)), counts)
    segment = ranges(first, counts)
    back = turned[run]
    segments = RunCurves.of_segments(cut.paths, np.where(back, (2 * first + counts - 1)[run] - segment, segment))
    swap = back & segments.cubic
    curves = RunCurves(
        np.where(back, segments.end, segments.start),
        np.where(swap, segments.second, segments.first),
        np.where(swap, segments.first, segments.second),
        np.where(back, segments.start, segments.end),
        segments.cubic,
    )
    return curves, np.append(0, np.cumsum(counts))


def _fewer(cut: CutPaths, draw: Callable[[SmoothRuns, RunCurves], Drawn]) -> tuple[Bools, Drawn]:
    """Draw runs from either end, and keep what takes fewer segments: whether from the far end, and the segments.

    Where both take as many, the order of the points decides, so that a run and its reverse are fitted alike.
    """
    count = len(cut.first)
    turned = canonical_senses(cut)
    twice = np.tile(np.arange(count), 2)
    curves, first = oriented_runs(cut, twice, np.concatenate((turned, ~turned)))
    drawn = draw(SmoothRuns.of_segments(*curves.coefficients(), first), curves)
    taken = np.bincount(drawn.run, minlength=2 * count)
    other = taken[count:] < taken[:count]
    run = drawn.run % count
    kept = np.flatnonzero((drawn.run >= count) == other[run])
    order = kept[np.argsort(run[kept], kind="stable")]
    return turned ^ other, drawn._replace(run=run).of(order)


def replaced(cut: CutPaths, turned: Bools, drawn: Drawn) -> Paths:
    """Put what was drawn in the place of the runs, backwards for those that are `turned`; all else stays as it is."""
    paths, old = cut.paths, np.flatnonzero(~cut.bent)
    back = turned[drawn.run]
    number = np.arange(len(drawn.run))
    rank = np.concatenate((old, cut.first[drawn.run]))
    order = np.lexsort((np.concatenate((np.zeros(len(old), np.intp), np.where(back, -number, number))), rank))
    swap = back & (drawn.kind == CUBIC)
    control = np.where(swap[:, None], drawn.control[:, ::-1], drawn.control)
    counts = np.bincount(paths.owner[rank], minlength=len(paths))
    return Paths(
        start=np.concatenate((paths.start[old], np.where(back, drawn.end, drawn.start)))[order],
        end=np.concatenate((paths.end[old], np.where(back, drawn.start, drawn.end)))[order],
        control=np.concatenate((paths.control[old], control))[order],
        kind=np.concatenate((paths.kind[old], drawn.kind))[order],
        offsets=np.append(0, np.cumsum(counts)).astype(np.intp),
        closed=paths.closed,
    )

"""Curves replaced by the fewest cubic Bezier curves within an accuracy, along smooth runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.paths.congruent_runs import RunImages, control_points, reversal, shapes
from voronoi_tiles.paths.conversion import to_cubics, usable
from voronoi_tiles.paths.cubic_fit import PlacedStretches, fit_cubics
from voronoi_tiles.paths.curved_runs import (
    CORNER,
    CutPaths,
    Drawn,
    canonical_senses,
    cut_runs,
    oriented_runs,
    replaced,
)
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, Paths
from voronoi_tiles.paths.segmentation import Rivals, Stretches, even_stretches, longest_stretches
from voronoi_tiles.paths.smooth_runs import SmoothRuns

_ROUNDED: Final = 0.5
"""An arc that turns by more than this is a rounded corner, whatever its radius; radians."""

_SAME_RADIUS: Final = 1e-6
"""How far a radius may be from one of those of rounded corners; relative to it."""

_ROUND: Final = 0.01
"""How far the cubic curves that circular arcs are seen as may be from these; relative to the accuracy."""

_FLAT: Final = 1e-9
"""A curve whose control points are nearer than this to the line between its ends is a line; relative to the
accuracy."""

_MANY: Final = 4
"""Where so many curves take the place of a run, other tangents are tried; a count."""

_WINDOWS: Final = np.array([1 / 160, 1 / 80, 1 / 40, 1 / 20, 1 / 10])
"""By how much of a run on either side tangents are found; relative to its length."""

_GIVEN_UP: Final = np.iinfo(np.intp).max
"""The number of curves of what is no longer looked at."""

_ALIKE: Final = 1e-5
"""Runs whose points are so near to each other's images have one shape; relative to the accuracy. It is part of what is
left to rounding."""


def to_fewest_cubics(
    paths: Paths,
    *,
    accuracy: float,
    corner: float = CORNER,
    absorbed: float = 0.0,
    rounded: Sequence[float] = (),
) -> Paths:
    """Replace every QUAD, CUBIC and ARC by CUBICs within `accuracy`, by the fewest; all else stays as it is.

    The Hausdorff distance between old and new curves is at most `accuracy` (in the paths' unit) both ways; it is
    bounded, not sampled. Paths are cut into runs as by `cut_runs`: corners are where tangents differ by more than
    `corner` (radians), and stay, as the ends of rounded corners do; LINEs shorter than `absorbed` count as curved.
    Rounded corners are ARCs of one of the radii `rounded` that turn by more than `corner`, and all that turn far.
    Along a run, one curve after the other takes the longest stretch that it follows within the accuracy, with the run's
    tangents at both ends: so the curves of a run join with continuous tangents. Where many are needed, tangents are
    tried too that are found by more of the run. Then the breaks are moved, at the same count, to spread the error
    evenly. Where that takes more curves than a run has, these stay, as CUBICs. What is straight is a LINE.

    Runs of one shape, wherever they lie, however turned, mirrored or run through, get the images of one fit: two that
    differ in their sense alone the same bits. A run that is its own image backwards is fitted from its middle on, and
    stays its own image.

    Raises ValueError where the accuracy is not positive and finite, or finer than the coordinates' resolution.
    """
    bound = usable(paths, accuracy)
    arcs = np.flatnonzero(paths.kind == ARC)
    round_ = arcs[_rounded_corners(*paths.arc_radius_and_turn(arcs), corner, rounded)]
    breaks = np.append(paths.start[round_], paths.end[round_])
    if len(arcs):
        paths = to_cubics(paths, accuracy=_ROUND * accuracy)
        bound -= _ROUND * accuracy
    cut = cut_runs(paths, corner, absorbed, breaks)
    if not len(cut.first):
        return cut.paths
    turned = canonical_senses(cut)
    curves, first = oriented_runs(cut, np.arange(len(cut.first)), turned)
    points, offsets = control_points(curves, first)
    found = list(shapes(points, offsets, _ALIKE * accuracy))
    models = np.array([images[0].runs[0] for images in found])
    exact = [_Spline.of_points(points[offsets[k] : offsets[k + 1]]) for k in models.tolist()]
    splines = _splines(cut, models, turned[models], exact, bound, _ALIKE * accuracy)
    images = [
        _image(one, spline, points[offsets[:-1]], points[offsets[1:] - 1], _FLAT * accuracy)
        for of_shape, spline in zip(found, splines, strict=True)
        for one in of_shape
    ]
    every = Drawn._make(np.concatenate(columns) for columns in zip(*images, strict=True))
    return replaced(cut, turned, every.of(np.argsort(every.run, kind="stable")))


def _rounded_corners(radius: Floats, turn: Floats, corner: float, radii: Sequence[float]) -> Bools:
    """Which arcs are rounded corners."""
    known = np.zeros(len(radius), np.bool_)
    for one in radii:
        known |= np.abs(np.abs(radius) - one) <= _SAME_RADIUS * one
    return np.asarray((np.abs(turn) > _ROUNDED) | (known & (np.abs(turn) > corner)))


class _Spline(NamedTuple):
    """Cubic curves one after the other: their ends, complex128 (n + 1,), and their control points, (n, 2)."""

    nodes: Complexes
    control: Complexes

    @classmethod
    def of_points(cls, points: Complexes) -> _Spline:
        """The curves whose ends and control points these are, in order."""
        return cls(points[::3], np.column_stack((points[1::3], points[2::3])))

    def reversed(self) -> _Spline:
        """The same, run through backwards."""
        return _Spline(self.nodes[::-1], self.control[::-1, ::-1])

    def moved(self, image: Isometry) -> _Spline:
        """The image under an isometry."""
        return _Spline(image(self.nodes), image(self.control))

    def doubled(self, image: Isometry, *, odd: bool) -> _Spline:
        """The whole of which this is the second half; `image` maps it onto itself backwards.

        Where the number of curves is `odd`, the first of the half is the one in the middle.
        """
        before = self.moved(image).reversed()
        if not odd:
            middle = (self.nodes[:1] + before.nodes[-1:]) / 2
            nodes = np.concatenate((before.nodes[:-1], middle, self.nodes[1:]))
            return _Spline(nodes, np.concatenate((before.control, self.control)))
        control = self.control.copy()
        control[0, 0] = before.control[-1, 0]
        nodes = np.concatenate((before.nodes[:-1], self.nodes[1:]))
        return _Spline(nodes, np.concatenate((before.control[:-1], control)))


class _Coverings(NamedTuple):
    """What is covered by stretches, of which places are counted from 0 on: of each the run, and where in it 0 lies.

    From the `middle` of a run on, its second half is covered; where `odd`, the first stretch reaches as far to the
    other side. For a whole run it is 0. Tangents are found by as much of a run as `window` says.
    """

    runs: SmoothRuns
    run: Ints
    middle: Floats
    odd: Bools
    window: Floats

    @classmethod
    def of_runs(cls, runs: SmoothRuns, chosen: Ints, symmetric: Bools, window: Floats) -> _Coverings:
        """Two for each of some runs, first one of all, then the other; the second half of `runs` are these backwards.

        A run is covered from either end; a symmetric one from its middle on, with a break there or none.
        """
        run = np.concatenate((chosen, np.where(symmetric, chosen, chosen + len(runs) // 2)))
        symmetric = np.tile(symmetric, 2)
        segment, rest = np.divmod(runs.first[run] + runs.first[run + 1], 2)
        middle = runs.begin[np.minimum(segment, len(runs.begin) - 1)] + 0.5 * rest * runs.size[segment - 1 + rest]
        odd = symmetric & (np.arange(len(run)) >= len(chosen))
        return cls(runs, run, np.where(symmetric, middle, 0.0), odd, np.tile(window, 2))

    def followed_by(self, other: _Coverings) -> _Coverings:
        """These and others of the same runs."""
        return _Coverings(
            self.runs,
            np.append(self.run, other.run),
            np.append(self.middle, other.middle),
            np.append(self.odd, other.odd),
            np.append(self.window, other.window),
        )

    def of(self, rows: Ints) -> _Coverings:
        """Some of them."""
        return _Coverings(self.runs, self.run[rows], self.middle[rows], self.odd[rows], self.window[rows])

    def numbers(self, stretches: Stretches) -> Ints:
        """How many curves each run has: a stretch one, and two where it is of a half, but for one in the middle.

        What has no stretches was given up, and has too many.
        """
        count = np.bincount(stretches.run, minlength=len(self.run))
        group = np.zeros(len(count), np.intp)
        number = self.rivals(group, group).number(np.arange(len(count)), count)
        return np.where(count > 0, number, _GIVEN_UP)

    def rivals(self, group: Ints, best: Ints) -> Rivals:
        """Which cover the same runs, as `longest_stretches` takes it."""
        return Rivals(group, np.where(self.middle > 0.0, 2, 1), self.odd.astype(np.intp), best)

    @property
    def total(self) -> Floats:
        """The last places."""
        return self.runs.total[self.run] - self.middle

    def placed(self, which: Ints, low: Floats, high: Floats) -> PlacedStretches:
        """The stretches of runs that are meant.

        Towards the ends of what is covered windows become narrow: there the run's own tangents stay.
        """
        run, middle = self.run[which], self.middle[which]
        begin, end = middle + low, middle + high
        even = self.odd[which] & (low == 0.0)
        begin = np.where(even, _opposite(self.runs, run, end), begin)
        window, total = self.window[which], self.total[which]
        near, far = (np.minimum(window, np.minimum(place, total - place)) for place in (low, high))
        return PlacedStretches(run, begin, end, near, far, even)

    def errors(self, which: Ints, low: Floats, high: Floats) -> Floats:
        """The bounds of the fits."""
        return fit_cubics(self.runs, self.placed(which, low, high)).bound


def _opposite(runs: SmoothRuns, run: Ints, place: Floats) -> Floats:
    """The places that are the images of others in runs that are their own images backwards."""
    segment, t = runs.locate(run, place, before=True)
    other = runs.first[run] + runs.first[run + 1] - 1 - segment
    return np.asarray(runs.begin[other] + (1.0 - t) * runs.size[other])


def _splines(
    cut: CutPaths, chosen: Ints, turned: Bools, exact: list[_Spline], bound: float, alike: float
) -> list[_Spline]:
    """What replaces some runs, each by the fewest curves: those of `exact`, which it is, where there are none fewer.

    Those that are their own images backwards, within `alike`, stay so.
    """
    count = len(chosen)
    reversals = [reversal(_points_of(spline), alike) for spline in exact]
    curves, first = oriented_runs(cut, np.tile(chosen, 2), np.concatenate((turned, ~turned)))
    runs = SmoothRuns.of_segments(*curves.coefficients(), first)
    symmetric = np.array([image is not None for image in reversals])
    least = np.array([len(spline.control) for spline in exact]) + 1
    tried = _Coverings.of_runs(runs, np.arange(count), symmetric, np.zeros(count))
    longest = longest_stretches(tried.total, bound, tried.errors, 6, tried.rivals(tried.run % count, least))
    number = tried.numbers(longest)
    least = np.minimum(least, np.minimum(number[:count], number[count:]))
    many = np.flatnonzero(least >= _MANY)
    if len(many):
        windows = (_WINDOWS[:, None] * runs.total[many]).ravel()
        others = np.tile(many, len(_WINDOWS))
        more = _Coverings.of_runs(runs, others, symmetric[others], windows)
        stretches = longest_stretches(more.total, bound, more.errors, 6, more.rivals(more.run % count, least))
        longest = Stretches(
            np.append(longest.run, stretches.run + len(tried.run)),
            np.append(longest.low, stretches.low),
            np.append(longest.high, stretches.high),
        )
        tried = tried.followed_by(more)
        number = tried.numbers(longest)
    order = np.lexsort((np.arange(len(number)), number, tried.run % count))
    best = order[np.searchsorted((tried.run % count)[order], np.arange(count))]
    fewer = np.flatnonzero(number[best] < _GIVEN_UP)
    splines = exact.copy()
    if len(fewer):
        covered, images = tried.of(best[fewer]), [reversals[k] for k in fewer.tolist()]
        drawn = _drawn(covered, _of_rows(longest, best[fewer]), images, bound)
        for k, back, spline in zip(fewer.tolist(), (covered.run >= count).tolist(), drawn, strict=True):
            splines[k] = spline.reversed() if back and reversals[k] is None else spline
    return splines


def _points_of(spline: _Spline) -> Complexes:
    """All points of a spline in order."""
    inner = np.column_stack((spline.nodes[:-1], spline.control)).ravel()
    return np.append(inner, spline.nodes[-1])


def _of_rows(stretches: Stretches, rows: Ints) -> Stretches:
    """The stretches of some rows, which get numbers from 0 on."""
    offsets = np.searchsorted(stretches.run, np.arange(rows.max() + 2))
    counts = np.diff(offsets)[rows]
    chosen = ranges(offsets[rows], counts)
    return Stretches(np.repeat(np.arange(len(rows)), counts), stretches.low[chosen], stretches.high[chosen])


def _drawn(covered: _Coverings, longest: Stretches, reversals: list[Isometry | None], bound: float) -> list[_Spline]:
    """What stretches are replaced by, after their errors have been spread: a spline for each covering."""
    runs = covered.runs
    stretches = even_stretches(covered.total, longest, bound, covered.errors, 6)
    placed = covered.placed(*stretches)
    fit = fit_cubics(runs, placed)
    assert np.all(fit.bound <= bound)
    x, y = fit.curves
    begin = np.empty(len(placed.run), np.complex128)
    begin.real, begin.imag = runs.points(*runs.locate(placed.run, placed.low, before=False))
    control, end = begin[:, None] + (x[1:3] + 1j * y[1:3]).T, begin + (x[3] + 1j * y[3])
    offsets = np.searchsorted(stretches.run, np.arange(len(reversals) + 1))
    splines = []
    for k, image in enumerate(reversals):
        own = slice(offsets[k], offsets[k + 1])
        spline = _Spline(np.append(begin[own][:1], end[own]), control[own])
        if image is not None:
            spline = spline.doubled(image, odd=bool(covered.odd[k]))
        splines.append(spline)
    return splines


def _image(images: RunImages, spline: _Spline, starts: Complexes, ends: Complexes, flat: float) -> Drawn:
    """The images of a spline in the place of runs, between the `starts` and `ends` of these."""
    if images.back:
        spline = spline.reversed()
    pieces = len(spline.control)
    points = np.concatenate((spline.nodes[1:-1], spline.control.ravel()))
    if images.conj:
        points = points.conj()
    moved = images.a[:, None] * points + images.b[:, None]
    inner, control = moved[:, : pieces - 1], moved[:, pieces - 1 :].reshape(-1, 2)
    start = np.column_stack((starts[images.runs], inner)).ravel()
    end = np.column_stack((inner, ends[images.runs])).ravel()
    chord = end - start
    across = np.abs(((control - start[:, None]) * chord.conj()[:, None]).imag).max(axis=1)
    straight = (across <= flat * np.abs(chord)) & (chord != 0.0)  # a loop is none
    control[straight] = 0
    return Drawn(
        np.repeat(images.runs, pieces), start, end, control, np.where(straight, np.uint8(LINE), np.uint8(CUBIC))
    )

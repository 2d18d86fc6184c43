"""Lines that run along each other: the same line drawn twice, or two that touch or cross at a small angle.

Two curves that touch stay within the tolerance for a while: of radii of 30 and 15 mm, for half a millimetre on both
sides. What tells them from a line drawn twice is how the distance grows from the contact: as a power of the length. A
line that is drawn twice, be it rounded to three digits or a thousandth beside itself, stays as it is until one of the
two ends or turns off.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.preflight.chord_distance import foot_share
from voronoi_tiles.preflight.chords import Chords
from voronoi_tiles.preflight.curve_points import at_parameter, signed_distances, tangents

COVERED: Final = 0.5
"""Which part of the shorter path has to run along the other to be the same line, whatever the distances; no unit."""

ORDER: Final = 5.0
"""The highest power with which curves part that touch, with a margin: curves whose curvature and its derivative are the
same, too, part with the fourth."""

LEAST_PART: Final = 0.1
"""Which part of a run has to be the same line; no unit. The sampling is not exact to a tenth of it."""

PARTED: Final = 0.3
"""From which distance on curves have parted at the end of a run, so that one sees on which side; in tolerances."""

_GAP: Final = 1.0  # between the lengths of paths, which stand one after the other; millimetres
_NEAR: Final = 4.0  # how far beyond the end of a run a corner may be that ends it; in tolerances
_PAST: Final = 1.0 / np.sin(np.radians(2.0))  # how far lines go on beside each other after a corner; in tolerances
_TURN: Final = np.radians(2.0)  # a corner; a curve that goes on smoothly turns by less at its nodes
_SAMPLES: Final = 65  # points of a run at which the distance is taken
_LEVELS: Final = (3.0, 10.0, 50.0, 250.0, 1000.0)
_PORTION: Final = 1000  # runs that are looked at at once, at some 100 kilobytes each


class Runs(NamedTuple):
    """Stretches along which two paths stay within the tolerance of each other, by their chords.

    `one` and `two` (intp, n) are the paths; a stretch goes from `low` to `high` (float64, n) along the first, below 0
    where it begins before the beginning of a ring. `chord_low`, `chord_high` (intp, n) are chords of the second one
    at its ends.
    """

    one: Ints
    two: Ints
    low: Floats
    high: Floats
    chord_low: Ints
    chord_high: Ints

    @property
    def length(self) -> Floats:
        """How long each is."""
        return self.high - self.low


class Judged(NamedTuple):
    """What runs are, bool (n,) each: the same line twice, curves that cross or touch, or one that ends at the other.

    Some are none of these. With `covered` the paths are the same line by all their runs together. `place` (complex128,
    n) is where the curves are nearest to each other.
    """

    covered: Bools
    twice: Bools
    crosses: Bools
    touches: Bools
    joins: Bools
    place: Complexes


def judge_runs(chords: Chords, paths: Paths, runs: Runs, near: NearChords, tolerance: float, least: float) -> Judged:
    """Tell lines that are drawn twice along `least` at least from curves that touch or cross.

    Twice drawn is a line that runs along another one from one corner or end, of either, to the next; or along half
    of it; or by more than what curves of different curvature have in common.
    """
    # A path that runs along itself does so with one half along the other.
    shorter = np.minimum(chords.total[runs.one], chords.total[runs.two]) / np.where(runs.one == runs.two, 2.0, 1.0)
    pair = np.unique(np.stack((runs.one, runs.two)), axis=1, return_inverse=True)[1].ravel()
    covered = np.bincount(pair, runs.length)[pair] >= COVERED * shorter
    turns, ends = Turns.of(chords, paths), Turns.ends(chords)
    stopped = [turns.stop(runs, tolerance, _PAST * tolerance, end) for end in (0, 1)]
    joined = [ends.stop(runs, tolerance, _NEAR * tolerance, end) for end in (0, 1)]
    corner = np.zeros(len(covered), np.bool_)
    for end in (0, 1):
        corner |= (runs.one == runs.two) & near_all_the_way(chords, runs.one, *places(chords, runs, end), tolerance)
    smooth = ~(turns.inside(runs, tolerance) | stopped[0] | stopped[1])
    twice = covered | (stopped[0] & stopped[1])
    crosses, touches = np.zeros(len(twice), np.bool_), np.zeros(len(twice), np.bool_)
    place = np.zeros(len(twice), np.complex128)
    unclear = np.flatnonzero(~twice)
    for some in np.split(unclear, range(_PORTION, len(unclear), _PORTION)):
        steps = np.linspace(0.0, 1.0, _SAMPLES)
        at = runs.low[some, None] + runs.length[some, None] * steps
        piece, points = curve_points(chords, paths, np.repeat(runs.one[some], _SAMPLES), at.ravel())
        chord = near.at(np.repeat(some, _SAMPLES), at.ravel())
        distance = signed_distances(paths, chords, points, piece, chord).reshape(at.shape)
        same = same_part(distance, runs.length[some], tolerance)
        twice[some] = same >= np.maximum(least, LEAST_PART * runs.length[some])
        first, last = distance[:, 0], distance[:, -1]
        parted = smooth[some] & ~twice[some] & (np.minimum(np.abs(first), np.abs(last)) > PARTED * tolerance)
        crosses[some], touches[some] = parted & (first * last < 0), parted & (first * last > 0)
        nearest = np.argmin(np.abs(distance), axis=1)
        place[some] = points.reshape(at.shape)[np.arange(len(some)), nearest]
    return Judged(
        covered, twice, crosses & ~corner, touches & ~corner, (joined[0] | joined[1] | corner) & ~twice, place
    )


def places(chords: Chords, runs: Runs, end: int) -> tuple[Floats, Floats]:
    """Where runs begin (0) or end (1): the lengths along both paths."""
    at, chord = (runs.low, runs.chord_low) if end == 0 else (runs.high, runs.chord_high)
    point, _ = chords.along(runs.one, at)
    share = foot_share(point, chords.start[chord], chords.end[chord])
    return at, chords.before[chord] + share * chords.lengths[chord]


def near_all_the_way(chords: Chords, path: Ints, one: Floats, other: Floats, tolerance: float) -> Bools:
    """Whether paths are beside themselves half way between two places, too: these are on both sides of a corner."""
    apart = chords.apart(path, one, other)
    points = [chords.along(path, one + share * apart)[0] for share in (0.25, 0.75)]
    return np.asarray(np.abs(points[0] - points[1]) <= tolerance, np.bool_)


def curve_points(chords: Chords, paths: Paths, path: Ints, at: Floats) -> tuple[Ints, Complexes]:
    """The pieces at these lengths along the chords of paths, and the points of the curves themselves."""
    chord, share, _ = chords.where(path, at)
    piece, t = chords.on_pieces(chord, share)
    return piece, at_parameter(paths, piece, t).point


class NearChords(NamedTuple):
    """Chords of the second path of runs, by where they are near to the first: by runs, and by `low` in each."""

    run: Ints
    low: Floats
    chord: Ints

    def at(self, run: Ints, place: Floats) -> Ints:
        """A chord that is near to the first path of runs at these lengths along it."""
        step = float(np.ptp(self.low)) + float(np.abs(place).max(initial=0.0)) + 1.0
        base = float(self.low.min())
        found = np.searchsorted(
            self.run * step + (self.low - base), run * step + np.maximum(place - base, 0.0), "right"
        )
        first, after = np.searchsorted(self.run, run), np.searchsorted(self.run, run, "right")
        return self.chord[np.clip(found - 1, first, after - 1)]


class Turns(NamedTuple):
    """Where paths turn: their corners, and the ends of those that are no rings.

    `key` (float64, n) is the length of all paths before, and along its own; `base` (float64, p + 1) that before each.
    """

    key: Floats
    base: Floats
    chords: Chords

    @classmethod
    def of(cls, chords: Chords, paths: Paths) -> Turns:
        """The corners and ends of paths."""
        begin, end = tangents(paths)
        first = np.searchsorted(chords.piece, np.arange(len(paths.start)))
        counts = paths.counts
        before = np.arange(len(first)) - 1
        heads = paths.offsets[:-1][counts > 0]
        before[heads] = paths.offsets[1:][counts > 0] - 1
        turn = np.abs(np.angle(begin * end[before].conj())) > _TURN
        there = cls.ends(chords)
        key = there.base[paths.owner] + chords.before[first]
        return there._replace(key=np.sort(np.concatenate((key[turn], there.key))))

    @classmethod
    def ends(cls, chords: Chords) -> Turns:
        """The ends alone."""
        base = np.append(0.0, np.cumsum(chords.total + _GAP))
        open_ = np.flatnonzero(~chords.ring)
        return cls(np.sort(np.concatenate((base[open_], base[open_] + chords.total[open_]))), base, chords)

    def between(self, path: Ints, low: Floats, high: Floats) -> Bools:
        """Whether paths turn between these lengths along them, round the beginning of a ring as well."""
        total = self.chords.total[path]
        found = np.zeros(len(path), np.bool_)
        for shift in (-total, np.zeros(len(path)), total):
            least, most = np.maximum(low + shift, 0.0), np.minimum(high + shift, total)
            count = np.searchsorted(self.key, self.base[path] + most, "right") - np.searchsorted(
                self.key, self.base[path] + least, "left"
            )
            found |= (most >= least) & (count > 0)
        return found

    def stop(self, runs: Runs, tolerance: float, past: float, end: int) -> Bools:
        """Whether one of the paths turns or ends, no more than `past` before, where runs begin (0) or end (1)."""
        at, other = places(self.chords, runs, end)
        outer = tolerance * _NEAR
        low, high = (at - outer, at + past) if end == 0 else (at - past, at + outer)
        # Which way the second path leaves the run is not known: its corners on either side count.
        return self.between(runs.one, low, high) | self.between(runs.two, other - past, other + past)

    def inside(self, runs: Runs, tolerance: float) -> Bools:
        """Whether the first path turns within runs."""
        return self.between(runs.one, runs.low - _NEAR * tolerance, runs.high + _NEAR * tolerance)


def same_part(distance: Floats, length: Floats, tolerance: float) -> Floats:
    """How much of runs is the same line, at least; by their distances (float64, n x samples), in the lengths' unit.

    Where curves part with a power of the length up to ORDER, the stretches within which the distance changes by less
    than w are at most (w / W)^(1 / ORDER) of that for W. What is longer is not explained by their parting.
    """
    count = distance.shape[1]
    ordered = np.sort(distance, axis=1)
    # The least band that holds so many of the samples.
    bands = np.stack([(ordered[:, more:] - ordered[:, : count - more]).min(axis=1) for more in range(count)], axis=1)
    whole = np.minimum(bands[:, -1], tolerance)

    def within(band: Floats) -> Floats:
        """How much of each run lies in a band of this width."""
        return np.asarray((np.count_nonzero(bands <= band[:, None], axis=1) - 1) / (count - 1) * length)

    all_of_it = within(whole)
    parts = []
    for level in _LEVELS:
        share = level ** (-1.0 / ORDER)
        parts.append((within(whole / level) - share * all_of_it) / (1.0 - share))
    return np.asarray(np.max(parts, axis=0))

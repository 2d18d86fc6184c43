"""Curves of one kind replaced by another within a stated accuracy: by chords or cubic Bezier curves."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final, NamedTuple, Self

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, ranges
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Kinds, Paths

MARGIN: Final = 1e-3
"""The part of an accuracy that is left to the rounding of points. A fixed part, so that the result for a path does not
depend on the others."""

_ROUNDING_ULPS = 16.0
"""What rounding moves points by, at most; ulps of the largest coordinate."""

COUNT_MAX: Final = 20_000_000
"""Most segments that a conversion makes; a count. More means a slip of the accuracy's unit, and fills the memory."""


def usable(paths: Paths, accuracy: float) -> float:
    """The part of an accuracy, in the paths' unit, that is not left to the rounding of points.

    Raises ValueError where the accuracy is not positive and finite, or finer than the coordinates' resolution.
    """
    if not (math.isfinite(accuracy) and accuracy > 0.0):
        raise ValueError(f"accuracy {accuracy!r} must be positive and finite")
    points = (paths.start, paths.end, paths.control.ravel())
    size = max(float(np.max(np.abs(z), initial=0.0)) for z in points)
    finest = _ROUNDING_ULPS * EPSILON * size / MARGIN
    if accuracy < finest:
        raise ValueError(f"accuracy {accuracy!r} must be at least {finest:.1e}, the resolution of the coordinates")
    return accuracy * (1 - MARGIN)


def to_lines(paths: Paths, *, accuracy: float) -> Paths:
    """Replace every curve by chords of it within `accuracy` (in the paths' unit) both ways; LINEs stay.

    Raises ValueError where the accuracy is not positive and finite, or finer than the coordinates' resolution, and
    where it asks for more than COUNT_MAX chords; see `chords`.
    """
    return chords(paths, _whole(chord_counts(paths, usable(paths, accuracy))))


def chord_counts(paths: Paths, accuracy: float) -> Floats:
    """The least numbers of chords, not rounded, that keep each segment within `accuracy` both ways; float64 (n,).

    Source: a curve whose second derivative is at most m differs from its k chords by at most m / (8 k^2) at equal
    parameters. For a quadratic with second difference e, m is 2 |e|; for a cubic at most 6 times the larger of
    its two. An arc is r (1 - cos(s / 2)) off a chord of angle s.
    """
    start, end, (c0, c1) = paths.start, paths.end, paths.control.T
    quads, cubics, arcs = (np.flatnonzero(paths.kind == kind) for kind in (QUAD, CUBIC, ARC))
    bend = np.zeros(len(start))
    bend[quads] = np.abs((start[quads] + end[quads]) - 2 * c0[quads]) / 4
    first = np.abs((start[cubics] - 2 * c0[cubics]) + c1[cubics])
    second = np.abs((end[cubics] - 2 * c1[cubics]) + c0[cubics])
    bend[cubics] = np.maximum(first, second) * 0.75
    counts = np.sqrt(bend / accuracy)
    frame = _Frames.of_arcs(paths, arcs)
    counts[arcs] = frame.half / (2 * np.arcsin(np.sqrt(accuracy / np.maximum(2 * frame.radius, accuracy))))
    return counts


def chords(paths: Paths, counts: Ints) -> Paths:
    """Replace every curve by so many chords; those of LINEs are 1.

    The chords of a segment span equal steps of its parameter, or of its angle for an ARC. Its ends stay. A segment that
    is run through backwards has the same points bit for bit.
    """
    split = _Split.into(counts)
    start, end, (c0, c1) = paths.start, paths.end, paths.control.T
    points = start[split.segment]
    t, s = split.number / split.counts, (split.counts - split.number) / split.counts
    # Sums whose terms swap when a segment is reversed, and products whose order stays: the same bits both ways.
    inner = (split.number > 0) & (paths.kind[split.segment] != LINE)
    rows = np.flatnonzero(inner & (paths.kind[split.segment] == QUAD))
    k, u, v = split.segment[rows], s[rows], t[rows]
    points[rows] = (start[k] * (u * u) + end[k] * (v * v)) + c0[k] * (2.0 * (u * v))
    rows = np.flatnonzero(inner & (paths.kind[split.segment] == CUBIC))
    k, u, v = split.segment[rows], s[rows], t[rows]
    middle = c0[k] * (3.0 * (u * u) * v) + c1[k] * (3.0 * (v * v) * u)
    points[rows] = (start[k] * (u * u * u) + end[k] * (v * v * v)) + middle
    rows = np.flatnonzero(inner & (paths.kind[split.segment] == ARC))
    frame, low, _ = _steps_of_arcs(paths, split, rows)
    points[rows] = frame.place(np.sin(low), 2 * np.sin(low / 2) ** 2)
    none = np.zeros((len(points), 2), np.complex128)
    return split.joined(paths, points, none, np.full(len(points), LINE, np.uint8))


def to_cubics(paths: Paths, *, accuracy: float) -> Paths:
    """Replace every ARC by CUBICs within `accuracy` (in the paths' unit) both ways, every QUAD by its exact CUBIC.

    An arc is cut into the fewest equal angles; its curves keep its tangents. LINEs stay. Raises ValueError where the
    accuracy is not positive and finite, or finer than the coordinates' resolution.

    Source: with handles of 4/3 tan(s/4) along a unit arc of angle s, |p|^2 - 1 of a cubic runs from 0 to e = 4/27
    sin(s/4)^6 / cos(s/4)^2, so that it is e / (1 + sqrt(1 + e)) off, outwards: Goldapp, Approximation of circular arcs
    by cubic polynomials, Comput. Aided Geom. Des. 8 (1991).
    """
    paths = _raised(paths)
    bound = usable(paths, accuracy)
    arcs = np.flatnonzero(paths.kind == ARC)
    frame = _Frames.of_arcs(paths, arcs)
    counts = np.ones(len(paths.kind))
    counts[arcs] = _fewest(2 * frame.half, bound / frame.radius)
    split = _Split.into(_whole(counts))
    start, control, kinds = paths.start[split.segment], paths.control[split.segment], paths.kind[split.segment]
    rows = np.flatnonzero(kinds == ARC)
    frame, low, high = _steps_of_arcs(paths, split, rows)
    begins = split.number[rows] == 0
    start[rows] = np.where(begins, start[rows], frame.place(np.sin(low), 2 * np.sin(low / 2) ** 2))
    handle = 4 / 3 * np.tan((high - low) / 4)
    for column, angle, sign in ((0, low, 1.0), (1, high, -1.0)):
        sine, cosine = np.sin(angle), np.cos(angle)
        inward = 2 * np.sin(angle / 2) ** 2 + sign * handle * sine
        control[rows, column] = frame.place(sine + sign * handle * cosine, inward)
    kinds[rows] = CUBIC
    return split.joined(paths, start, control, kinds)


def _cubic_error(angle: Floats) -> Floats:
    """How far the cubic is off a unit arc of an angle."""
    square = 4 / 27 * np.sin(angle / 4) ** 6 / np.cos(angle / 4) ** 2
    return np.asarray(square / (1 + np.sqrt(1 + square)))


def _whole(counts: Floats) -> Ints:
    """Counts rounded up; raises ValueError where they are too many altogether."""
    whole = np.maximum(np.ceil(counts * (1 - 1e-12)), 1.0)
    if whole.sum() > COUNT_MAX:
        raise ValueError(f"the accuracy asks for {whole.sum():.3g} segments, and {COUNT_MAX} is the limit")
    return whole.astype(np.intp)


class _Split(NamedTuple):
    """Segments cut into equal steps: of each step its segment, its number from 0 on, and the segment's count."""

    segment: Ints
    number: Ints
    counts: Ints

    @classmethod
    def into(cls, counts: Ints) -> Self:
        """Cut each segment into so many steps."""
        segment = np.repeat(np.arange(len(counts)), counts)
        return cls(segment, ranges(np.zeros(len(counts), np.intp), counts), counts[segment])

    def joined(self, paths: Paths, start: Complexes, control: Complexes, kind: Kinds) -> Paths:
        """The paths of these steps, each of which ends where the next begins."""
        end = np.roll(start, -1)
        last = self.number == self.counts - 1
        end[last] = paths.end
        counts = np.bincount(paths.owner[self.segment], minlength=len(paths))
        offsets = np.append(0, np.cumsum(counts)).astype(np.intp)
        return replace(paths, start=start, end=end, control=control, kind=kind, offsets=offsets)


class _Frames(NamedTuple):
    """Arcs seen from their middles: half their angle, their radius, and the units along the chord and to the chord.

    `place` gives the same bits for an arc and its reverse, whose angles have the other sign.
    """

    middle: Complexes
    along: Complexes
    inward: Complexes
    half: Floats
    radius: Floats

    @classmethod
    def of_arcs(cls, paths: Paths, arcs: Ints) -> Self:
        """The frames of some ARCs; those without a sagitta are arcs of a vast circle."""
        start, end, middle = paths.start[arcs], paths.end[arcs], paths.control[arcs, 0]
        inward, chord = (start + end) / 2 - middle, end - start
        half = np.maximum(2 * np.arctan2(2 * np.abs(inward), np.abs(chord)), 1e-100)
        unit, height = 2 * np.sin(half), 2 * np.sin(half / 2) ** 2
        radius = np.where(half < 1.0, np.abs(chord) / unit, np.abs(inward) / height)
        return cls(middle, chord / unit, inward / height, half, radius)

    def place(self, along: Floats, inward: Floats) -> Complexes:
        """The points so many radii along the chord's direction from the middle, and so many from it inwards."""
        return np.asarray(self.middle + (self.along * along + self.inward * inward))


def _steps_of_arcs(paths: Paths, split: _Split, rows: Ints) -> tuple[_Frames, Floats, Floats]:
    """The frames of steps of ARCs, and the angles from the middle where each step begins and ends."""
    frame = _Frames.of_arcs(paths, split.segment[rows])
    number, count = split.number[rows], split.counts[rows]
    low, high = (frame.half * ((2 * n - count) / count) for n in (number, number + 1))
    return frame, low, high


def _fewest(angle: Floats, limit: Floats) -> Floats:
    """The least numbers of equal parts of angles whose cubics are within a limit each; larger parts are worse."""
    low, high = np.zeros(len(angle)), np.ones(len(angle))
    while np.any(open_ := _cubic_error(angle / high) > limit):
        low, high = np.where(open_, high, low), np.where(open_, 2 * high, high)
    while np.any(high - low > 1):
        middle = np.floor((low + high) / 2)
        good = (_cubic_error(angle / np.maximum(middle, 1.0)) <= limit) & (middle > 0)
        low, high = np.where(good, low, middle), np.where(good, middle, high)
    return high


def _raised(paths: Paths) -> Paths:
    """The paths with every QUAD as the same curve's CUBIC."""
    quads = np.flatnonzero(paths.kind == QUAD)
    control, kind = paths.control.copy(), paths.kind.copy()
    middle = control[quads, 0]
    control[quads, 0] = paths.start[quads] + (middle - paths.start[quads]) * (2 / 3)
    control[quads, 1] = paths.end[quads] + (middle - paths.end[quads]) * (2 / 3)
    kind[quads] = CUBIC
    return replace(paths, control=control, kind=kind)

"""Single segments of paths: points and directions on them, parts of them, boxes around them, distances from them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Self

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.base.box_index import BoxIndex
from voronoi_tiles.paths.paths import ARC, CUBIC, QUAD, Paths

_AXES: Final = np.array([1, 1j, -1, -1j])


def point_at(paths: Paths, segments: Ints, t: Floats) -> Complexes:
    """The point at t of each segment, 0 <= t <= 1: a Bezier parameter, on ARC the share of the angle.

    The ends have the bits of the paths' own. `segments` and `t` have one shape. Raises ValueError for CUBIC.
    """
    _refuse_cubics(paths, segments)
    start, end = paths.start[segments], paths.end[segments]
    chord = end - start
    # From the nearer end: an error in proportion to what is left, and the end's own bits at the end.
    points = np.where(t <= 0.5, start + chord * t, end - chord * (1 - t))
    bent = paths.kind[segments] == QUAD
    points[bent] = bezier_at(paths, segments[bent], t[bent])
    arcs = paths.kind[segments] == ARC
    half = 2.0 * np.arctan(paths.bulges()[segments[arcs]])
    share = t[arcs]
    s = np.where(share <= 0.5, share, 1 - share)
    v = s * np.sinc(s * half / np.pi) / np.sinc(half / np.pi)
    turned = np.exp(1j * half * (1 - s))
    points[arcs] = np.where(
        share <= 0.5,
        start[arcs] + chord[arcs] * v * turned.conj(),
        end[arcs] - chord[arcs] * v * turned,
    )
    return points


def tangent_at(paths: Paths, segments: Ints, t: Floats) -> Complexes:
    """The unit direction of each segment at t, 0 <= t <= 1; see `point_at`.

    Where a QUAD has a cusp, because its control point is one of its ends, the limit is taken. Raises ValueError for
    CUBIC.
    """
    _refuse_cubics(paths, segments)
    start, end = paths.start[segments], paths.end[segments]
    along = end - start
    bent = np.flatnonzero(paths.kind[segments] == QUAD)
    control = paths.control[segments[bent], 0]
    speed = (control - start[bent]) * (1 - t[bent]) + (end[bent] - control) * t[bent]
    along[bent] = np.where(speed == 0, along[bent], speed)
    half = 2.0 * np.arctan(paths.bulges()[segments])
    along = along * np.exp(1j * half * (2 * t - 1))
    return np.asarray(along / np.abs(along), np.complex128)


def split(
    paths: Paths,
    segments: Ints,
    t0: Floats,
    t1: Floats,
    start: Complexes | None = None,
    end: Complexes | None = None,
) -> Paths:
    """The part from t0 to t1 of each segment, as an open path of one segment; exact for LINE, QUAD and ARC.

    `start` and `end` are where the parts begin and end, to share the bits of a point with another part; without
    them they are `point_at`. Raises ValueError for CUBIC.
    """
    begin = point_at(paths, segments, t0) if start is None else start
    stop = point_at(paths, segments, t1) if end is None else end
    kind = paths.kind[segments]
    control = np.zeros((len(segments), 2), np.complex128)
    bent = np.flatnonzero(kind == QUAD)
    a, b, c = paths.start[segments[bent]], paths.control[segments[bent], 0], paths.end[segments[bent]]
    u, v = t0[bent], t1[bent]
    control[bent, 0] = a * (1 - u) * (1 - v) + b * (u * (1 - v) + v * (1 - u)) + c * u * v
    arcs = np.flatnonzero(kind == ARC)
    control[arcs, 0] = point_at(paths, segments[arcs], (t0[arcs] + t1[arcs]) / 2)
    n = len(segments)
    return Paths(
        start=np.asarray(begin, np.complex128),
        end=np.asarray(stop, np.complex128),
        control=control,
        kind=kind,
        offsets=np.arange(n + 1),
        closed=np.zeros(n, np.bool_),
    )


def boxes(paths: Paths) -> Floats:
    """The smallest upright rectangle around each segment: least x, least y, greatest x, greatest y, float64 (n, 4).

    Raises ValueError for CUBIC.
    """
    everything = np.arange(len(paths.start))
    _refuse_cubics(paths, everything)
    points = np.stack((paths.start, paths.end))
    low = np.stack((points.real.min(axis=0), points.imag.min(axis=0)))
    high = np.stack((points.real.max(axis=0), points.imag.max(axis=0)))

    def widen(segments: Ints, more: Complexes) -> None:
        """Take points into the boxes; no segment may appear twice."""
        found = np.stack((more.real, more.imag))
        low[:, segments] = np.minimum(low[:, segments], found)
        high[:, segments] = np.maximum(high[:, segments], found)

    bent = np.flatnonzero(paths.kind == QUAD)
    a, b, c = paths.start[bent], paths.control[bent, 0], paths.end[bent]
    for p, q, r in ((a.real, b.real, c.real), (a.imag, b.imag, c.imag)):
        on = np.flatnonzero((p - q) * (r - q) > 0)
        widen(bent[on], bezier_at(paths, bent[on], (p[on] - q[on]) / (p[on] - 2 * q[on] + r[on])))
    arcs = np.flatnonzero(paths.kind == ARC)
    if len(arcs):
        half = 2.0 * np.arctan(paths.bulges()[arcs])
        begin = np.angle((paths.end[arcs] - paths.start[arcs]) * np.exp(-1j * half))
        for axis in np.angle(_AXES):
            # How far ahead the tangent of the arc has this direction, in the sense of its turn.
            ahead = np.mod((axis - begin) * np.sign(half), 2 * np.pi)
            on = np.flatnonzero(ahead < 2 * np.abs(half))
            widen(arcs[on], point_at(paths, arcs[on], ahead[on] / (2 * np.abs(half[on]))))
    return np.concatenate((low, high)).T


def corners(rectangles: Floats) -> tuple[Complexes, Complexes]:
    """The lower left and the upper right corners of rectangles as `boxes` gives them."""
    return rectangles[:, 0] + 1j * rectangles[:, 1], rectangles[:, 2] + 1j * rectangles[:, 3]


def item_boxes(paths: Paths, items: Ints) -> Floats:
    """The same around each item: item k are the paths from items[k] up to, not including, items[k + 1]."""
    each = boxes(paths)
    first = paths.offsets[items[:-1]]
    low = np.minimum.reduceat(each[:, :2], first)
    return np.column_stack((low, np.maximum.reduceat(each[:, 2:], first)))


@dataclass(frozen=True, eq=False)
class Circles:
    """Lines and arcs as parts of circles, of which a line is one without curvature.

    Each is the part from `start` (complex128) along `chord` that turns by 2 `half` to the left (radians); `normal` is
    the unit normal to the left at the start, `curvature` is > 0 where it turns left, in 1 / mm.
    """

    start: Complexes
    chord: Complexes
    half: Floats
    normal: Complexes
    curvature: Floats

    @classmethod
    def of(cls, paths: Paths, segments: Ints) -> Self:
        """The circles of some LINEs and ARCs; what is said about a QUAD is that of its chord."""
        chord = paths.end[segments] - paths.start[segments]
        half = 2.0 * np.arctan(paths.bulges()[segments])
        length = np.abs(chord)
        length = np.where(length == 0, 1.0, length)
        normal = 1j * chord / length * np.exp(-1j * half)
        return cls(paths.start[segments], chord, half, normal, 2.0 * np.sin(half) / length)

    def take(self, places: Ints) -> Circles:
        """Those at these places."""
        return Circles(
            self.start[places], self.chord[places], self.half[places], self.normal[places], self.curvature[places]
        )

    def off(self, points: Complexes) -> Floats:
        """How far to the right of its circle each point lies, to first order near it: the circle's equation."""
        w = points - self.start
        return np.asarray(self.curvature * np.abs(w) ** 2 / 2 - (w * self.normal.conj()).real, np.float64)

    def distance(self, points: Complexes) -> Floats:
        """The distance of each point from the segment of the same place; 0 or more."""
        ray = self.curvature * (points - self.start) - self.normal
        # How far from the centre, in radii. Its square is 1 + 2 curvature off, whose root would lose half the digits.
        reach = np.abs(ray)
        away = 2 * self.off(points) / (1 + reach)
        foot = points - away * ray / np.where(reach == 0, 1.0, reach)
        x = chord_share((foot - self.start) / self.chord, self.half)
        w = points - self.start
        ends = np.minimum(np.abs(w), np.abs(w - self.chord))
        return np.where((x >= 0) & (x <= 1), np.minimum(np.abs(away), ends), ends)


def candidate_pairs(first: Paths, second: Paths, margin: float = 0.0) -> tuple[Ints, Ints]:
    """The pairs of a segment of `first` and one of `second` whose boxes come within `margin` of each other.

    In the order of the first, then of the second. Raises ValueError for CUBIC.
    """
    if not len(first.start) or not len(second.start):
        return np.zeros(0, np.intp), np.zeros(0, np.intp)
    low, high = corners(boxes(first) + np.array([-margin, -margin, margin, margin]))
    return BoxIndex(*corners(boxes(second))).meeting(low, high)


def bezier_at(paths: Paths, segments: Ints, t: Floats) -> Complexes:
    """The points of QUADs."""
    a, b, c = paths.start[segments], paths.control[segments, 0], paths.end[segments]
    s = 1 - t
    return np.asarray(
        np.where(t <= 0.5, a + t * (2 * s * (b - a) + t * (c - a)), c + s * (2 * t * (b - c) + s * (a - c))),
        np.complex128,
    )


def from_chord_share(x: Floats, half: Floats) -> tuple[Complexes, Floats]:
    """Points v = x / (x + (1 - x) e^(i half)) on arcs from 0 to 1 that turn by 2 half; their shares of the angle."""
    below = x + (1 - x) * np.exp(1j * half)
    with np.errstate(invalid="ignore", divide="ignore"):
        # The direction from the start to v turns from -half to 0 while the share goes from 0 to 1.
        share = np.where(half == 0, x, 1 - np.angle(below) / half)
    return x / below, np.clip(share, 0.0, 1.0)


def chord_share(v: Complexes, half: Floats) -> Floats:
    """The x of `from_chord_share` for points v of the whole circle or line; it is in [0, 1] on the arc alone."""
    # The ratio of the ways to both ends, the shorter over the longer, so that rounding beside the curve tells nothing.
    second = np.abs(v) > np.abs(1 - v)
    near, far = np.where(second, 1 - v, v), np.where(second, v, 1 - v)
    ratio = (near / far * np.exp(1j * np.where(second, -half, half))).real
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(second, 1.0, ratio) / (1 + ratio)


def _refuse_cubics(paths: Paths, segments: Ints) -> None:
    if (paths.kind[segments] == CUBIC).any():
        raise ValueError("cubic curves have no place here: approximate them by lines, arcs or quadratic curves")

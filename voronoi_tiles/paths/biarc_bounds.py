"""How far a line, an arc or a biarc is from a stretch of a smooth run of curves: bounds, not samples.

Along a polynomial segment the equation of a circle is a polynomial; its Bernstein coefficients bound it everywhere.
What there is to do for every part of a stretch compiled kernels do; the numpy code beside them gives the same bits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints
from voronoi_tiles.base.kernels import FLOATS, INT, INTS, kernel
from voronoi_tiles.paths.smooth_runs import SmoothRuns
from voronoi_tiles.paths.stretch_parts import StretchEnds, StretchParts, cut, squares_of

_HALF_TURN = np.pi * (1 + 1e-12)

_BALANCE = 0.07
"""The power of the two errors' ratio by which a joint is moved to make them equal; found by trying parabolas."""

# What the compiled kernels take, as in biarc_bounds.c: numbers of stretches and parts, what there is of each of these.
_SINGLE = kernel("biarc_single", INT, INTS, INT, *13 * [FLOATS])
_DOUBLE = kernel("biarc_double", INT, INTS, INT, *11 * [FLOATS])


class BiarcFit(NamedTuple):
    """What replaces stretches, arrays of one for each stretch.

    The bounds on the Hausdorff distance of the segment between the ends (`line`), of one arc between them (`arc`)
    and of the biarc, infinite where there is none; `best` is their least. The arc turns left by `turn`, the biarc's
    arcs by `turn1` up to the joint, which lies at `joint_x`, `joint_y` from the beginning, and by `turn2` after it.
    """

    line: Floats
    arc: Floats
    biarc: Floats
    turn: Floats
    turn1: Floats
    turn2: Floats
    joint_x: Floats
    joint_y: Floats

    @property
    def best(self) -> Floats:
        """The least of the three bounds."""
        return np.minimum(np.minimum(self.line, self.arc), self.biarc)


class _FittedCircles(NamedTuple):
    """Circles and lines, one for each row: F(d) = curvature |d|^2 / 2 - x d_x - y d_y + shift is 0 on them."""

    curvature: Floats
    x: Floats
    y: Floats
    shift: Floats

    @classmethod
    def leaving(cls, curvature: Floats, tx: Floats, ty: Floats) -> _FittedCircles:
        """Through the origin with the unit tangent t there."""
        return cls(curvature, -ty, tx, np.zeros(len(tx)))

    @classmethod
    def tangent(cls, curvature: Floats, tx: Floats, ty: Floats, px: Floats, py: Floats) -> _FittedCircles:
        """Through p with the unit tangent t there; curvature > 0 turns left."""
        # F(d) = k |d - p|^2 / 2 - n (d - p), with the normal n = i t.
        return cls(
            curvature,
            curvature * px - ty,
            curvature * py + tx,
            curvature * (px * px + py * py) / 2 + (tx * py - ty * px),
        )

    def of(self, rows: Ints) -> _FittedCircles:
        """The circles of these rows."""
        return _FittedCircles(*(field[rows] for field in self))


def fit(runs: SmoothRuns, run: Ints, low: Floats, high: Floats) -> BiarcFit:
    """Replace the stretches of runs between two places each.

    The biarc leaves and arrives along the curve's tangents. Its joint is where the curve crosses the circle on which
    all possible joints lie (the middle of that circle's arc without such a place), moved once so that the errors of
    the two arcs come closer to each other.

    Bounds: on a polynomial segment F(d) = k |d|^2 / 2 - n d (k the circle's curvature, n its normal at the origin)
    is a polynomial, so the largest of its Bernstein coefficients, M, bounds it, and a point with |F| <= M is within
    2 M / (1 + sqrt(1 - 2 |k| M)) of the circle. Where the curve also runs round the circle in one sense, from the
    arc's beginning to its end, every point of the one has a partner on the same radius, and this holds for the
    Hausdorff distance both ways. A segment needs no such condition: the distance from it is convex, and a curve that
    joins its ends passes every point of it on its perpendicular.
    """
    parts, ends = cut(runs, run, low, high)
    chord = np.hypot(ends.x, ends.y)
    apart = chord > 0.0
    safe = np.where(apart, chord, 1.0)
    ux, uy = np.where(apart, ends.x / safe, 1.0), np.where(apart, ends.y / safe, 0.0)
    alpha = np.arctan2(ux * ends.ay - uy * ends.ax, ux * ends.ax + uy * ends.ay)
    beta = np.arctan2(ux * ends.by - uy * ends.bx, ux * ends.bx + uy * ends.by)
    # The circle of all joints is that of the one arc; its tangent lies evenly between those of the curve.
    omega = (alpha - beta) / 2
    frame = _ChordFrame(ux, uy, safe, alpha, beta, omega, np.sinc(omega / np.pi))
    joints = _FittedCircles.leaving(-2 * np.sin(omega) / safe, *frame.towards(omega))
    single = _single_compiled(parts, joints, ux, uy, chord, omega) or _single(parts, joints, ux, uy, chord, omega)
    # Beyond the chord lies only what is near its ends, or a curve that runs round more than the arc.
    near = (np.minimum(single.arc, chord) + single.beyond) * np.abs(2 * np.sin(omega)) < safe

    share = _crossing(parts, single.begins, single.ends, omega, ends)
    first = _biarc(parts, ends, frame, share)
    second = _biarc(parts, ends, frame, _balanced(share, first))
    better = second.error < first.error
    biarc = _Biarc(*(np.where(better, new, old) for new, old in zip(second, first, strict=True)))
    round_ = apart & (np.abs(biarc.turn1) <= _HALF_TURN) & (np.abs(biarc.turn2) <= _HALF_TURN)
    return BiarcFit(
        line=single.line,
        arc=np.where(near & apart & (2 * np.abs(omega) <= _HALF_TURN), single.arc, np.inf),
        biarc=np.where(round_, biarc.error, np.inf),
        turn=-2 * omega,
        turn1=biarc.turn1,
        turn2=biarc.turn2,
        joint_x=biarc.x,
        joint_y=biarc.y,
    )


def _balanced(share: Floats, biarc: _Biarc) -> Floats:
    """The joints of biarcs moved towards the arc with the larger error."""
    usable = np.isfinite(biarc.error) & (biarc.error1 > 0.0)
    ratio = np.where(usable, biarc.error2, 1.0) / np.where(usable, biarc.error1, 1.0)
    return np.clip(share * np.clip(ratio, 0.25, 4.0) ** _BALANCE, 0.05, 0.95)


class _ChordFrame(NamedTuple):
    """The unit chords of stretches, their lengths, and the angles from them to the curve's tangents at the ends.

    The one arc's tangent is at the angle `omega` from the chord, and `whole` is the chord's share of that arc's length.
    """

    ux: Floats
    uy: Floats
    chord: Floats
    alpha: Floats
    beta: Floats
    omega: Floats
    whole: Floats

    def towards(self, angle: Floats) -> tuple[Floats, Floats]:
        """The unit vectors at angles to the chords."""
        c, s = np.cos(angle), np.sin(angle)
        return self.ux * c - self.uy * s, self.ux * s + self.uy * c


class _Single(NamedTuple):
    """What one circle and one line are to stretches, and to their parts.

    The bounds on the distance of the `arc` and of the `line`, and how far stretches lie `beyond` their chords, on the
    side where the arc is not; the values of the circle's equation where parts begin and end.
    """

    arc: Floats
    line: Floats
    beyond: Floats
    begins: Floats
    ends: Floats


def _single_compiled(
    parts: StretchParts, joints: _FittedCircles, ux: Floats, uy: Floats, chord: Floats, omega: Floats
) -> _Single | None:
    """What `_single` gives, with the same bits; None without the compiled kernels."""
    compiled = _SINGLE()
    if compiled is None:
        return None
    arc, line, beyond = np.empty((3, len(chord)))
    begins, ends = np.empty((2, len(parts.stretch)))
    curves = len(parts.stretch), parts.x, parts.y, parts.squares
    given = np.array(joints), ux, uy, chord, np.sign(omega)
    compiled(len(chord), parts.first, *curves, *given, arc, line, beyond, begins, ends)
    return _Single(arc, line, beyond, begins, ends)


def _single(
    parts: StretchParts, joints: _FittedCircles, ux: Floats, uy: Floats, chord: Floats, omega: Floats
) -> _Single:
    """What circles through the ends of stretches, and the segments between these, are to the stretches."""
    of = parts.stretch
    circle = joints.of(of)
    values = _values(parts.x, parts.y, parts.squares, circle)
    across, along = ux[of] * parts.y - uy[of] * parts.x, ux[of] * parts.x + uy[of] * parts.y
    past = np.maximum(np.maximum(-along, along - chord[of]), 0.0)
    return _Single(
        arc=parts.most(_distances(parts.x, parts.y, values, circle)),
        line=parts.most(np.max(np.sqrt(across * across + past * past), axis=0)),
        beyond=parts.most(np.max(-across * np.sign(omega)[of], axis=0)),
        begins=values[0],
        ends=values[6],
    )


class _Biarc(NamedTuple):
    """Biarcs: bounds on the distances of the two arcs, their turns, and the joint from the beginning."""

    error1: Floats
    error2: Floats
    turn1: Floats
    turn2: Floats
    x: Floats
    y: Floats

    @property
    def error(self) -> Floats:
        """The bound on the distance."""
        return np.maximum(self.error1, self.error2)


def _biarc(parts: StretchParts, ends: StretchEnds, frame: _ChordFrame, share: Floats) -> _Biarc:
    """The biarcs whose joints have these shares of the circle of joints before them."""
    omega, whole = frame.omega, frame.whole
    phi = omega * (1 - share)
    chord1 = frame.chord * share * np.sinc(omega * share / np.pi) / whole
    chord2 = frame.chord * (1 - share) * np.sinc(phi / np.pi) / whole
    turn1, turn2 = 2 * (phi - frame.alpha), 2 * (frame.beta + omega * share)
    x, y = (chord1 * u for u in frame.towards(phi))
    joint = _Joint(x, y, *frame.towards(2 * phi - frame.alpha))
    circles = (
        _FittedCircles.leaving(2 * np.sin(turn1 / 2) / chord1, ends.ax, ends.ay),
        _FittedCircles.tangent(2 * np.sin(turn2 / 2) / chord2, ends.bx, ends.by, ends.x, ends.y),
    )
    error1, error2 = _double_compiled(parts, *circles, joint) or _double(parts, *circles, joint)
    return _Biarc(error1, error2, turn1, turn2, x, y)


class _Joint(NamedTuple):
    """The joints of biarcs, from where their stretches begin, and the unit tangents there."""

    x: Floats
    y: Floats
    tx: Floats
    ty: Floats


def _double_compiled(
    parts: StretchParts, circle1: _FittedCircles, circle2: _FittedCircles, joint: _Joint
) -> tuple[Floats, Floats] | None:
    """What `_double` gives, with the same bits; None without the compiled kernels."""
    compiled = _DOUBLE()
    if compiled is None:
        return None
    error1, error2 = np.empty((2, len(joint.x)))
    curves = len(parts.stretch), parts.x, parts.y, parts.squares
    compiled(len(joint.x), parts.first, *curves, np.array(circle1), np.array(circle2), *joint, error1, error2)
    return error1, error2


def _double(
    parts: StretchParts, circle1: _FittedCircles, circle2: _FittedCircles, joint: _Joint
) -> tuple[Floats, Floats]:
    """The bounds on the distances of stretches from the first and the second arcs of their biarcs."""
    x, y, tx, ty = joint
    # The part that crosses the normal at the joint is cut there: its left half stands behind all parts.
    stretch = parts.stretch
    passed = (parts.x[3] - x[stretch]) * tx[stretch] + (parts.y[3] - y[stretch]) * ty[stretch] > 0.0
    last = parts.first[1:] - 1
    number = np.arange(len(stretch))
    cut = np.minimum.reduceat(np.where(passed, number, last[stretch]), parts.first[:-1])
    along = (parts.x[:, cut] - x) * tx + (parts.y[:, cut] - y) * ty
    t = _root(along)
    left_x, right_x = _halves(parts.x[:, cut], t)
    left_y, right_y = _halves(parts.y[:, cut], t)
    all_x, all_y = np.concatenate((parts.x, left_x), axis=1), np.concatenate((parts.y, left_y), axis=1)
    all_squares = np.concatenate((parts.squares, squares_of(left_x, left_y)), axis=1)
    all_x[:, cut], all_y[:, cut], all_squares[:, cut] = right_x, right_y, squares_of(right_x, right_y)
    after = np.append(number >= cut[stretch], np.zeros(len(x), np.bool_))
    owner = np.append(stretch, np.arange(len(x)))
    circle = _FittedCircles(
        *(np.stack(pair)[after.astype(np.intp), owner] for pair in zip(circle1, circle2, strict=True))
    )
    off = _distances(all_x, all_y, _values(all_x, all_y, all_squares, circle), circle)
    # What lies on the wrong side of that normal is so much farther from its arc at most.
    along = (all_x - x[owner]) * tx[owner] + (all_y - y[owner]) * ty[owner]
    astray = np.maximum(np.max(np.where(after, -along, along), axis=0), 0.0)
    # A curve that runs round more than the arc comes to lie far on the wrong side.
    off += np.where(np.abs(circle.curvature) * astray <= 0.25, astray, np.inf)
    body, left, late = off[: len(stretch)], off[len(stretch) :], after[: len(stretch)]
    return np.maximum(parts.most(np.where(late, 0.0, body)), left), parts.most(np.where(late, body, 0.0))


def _root(b: Floats) -> Floats:
    """About where cubics with these Bernstein coefficients, (4, q), pass 0 upwards; without a place, an end."""
    rise = b[3] - b[0]
    t = np.clip(-b[0] / np.where(rise > 0.0, rise, 1.0), 0.0, 1.0)
    c1, c2, c3 = 3 * (b[1] - b[0]), 3 * (b[0] - 2 * b[1] + b[2]), rise + 3 * (b[1] - b[2])
    for _ in range(2):  # Newton's steps
        slope = c1 + t * (2 * c2 + t * (3 * c3))
        t = np.clip(t - (b[0] + t * (c1 + t * (c2 + t * c3))) / np.where(slope > 0.0, slope, 1.0), 0.0, 1.0)
    return np.asarray(t)


def _halves(b: Floats, t: Floats) -> tuple[Floats, Floats]:
    """Cut cubics with these Bernstein coefficients, (4, q), at parameters (de Casteljau)."""
    p01, p12, p23 = b[0] + t * (b[1] - b[0]), b[1] + t * (b[2] - b[1]), b[2] + t * (b[3] - b[2])
    p02, p13 = p01 + t * (p12 - p01), p12 + t * (p23 - p12)
    middle = p02 + t * (p13 - p02)
    return np.stack((b[0], p01, p02, middle)), np.stack((middle, p13, p23, b[3]))


def _values(x: Floats, y: Floats, squares: Floats, circle: _FittedCircles) -> Floats:
    """The Bernstein coefficients of F along cubics, one circle for each: (7, m)."""
    f0, f1, f2, f3 = circle.shift - circle.x * x - circle.y * y
    values = circle.curvature * squares
    values[0] += f0
    values[1] += (f0 + f1) / 2
    values[2] += (f0 + 3 * f1 + f2) / 5
    values[3] += (f0 + f3 + 9 * (f1 + f2)) / 20
    values[4] += (f1 + 3 * f2 + f3) / 5
    values[5] += (f2 + f3) / 2
    values[6] += f3
    return values


def _distances(x: Floats, y: Floats, values: Floats, circle: _FittedCircles) -> Floats:
    """The bounds on the distances of cubics from a circle each; infinite where one does not run round it onwards."""
    largest = np.max(np.abs(values), axis=0)
    # The tangent of the circles round the centre is i times the gradient of F.
    gx, gy = circle.curvature * x[0] - circle.x, circle.curvature * y[0] - circle.y
    vx, vy = np.diff(x, axis=0), np.diff(y, axis=0)
    size = np.sqrt(vx * vx + vy * vy)  # which is rounded alike everywhere, as np.hypot is not
    bend = np.abs(circle.curvature)
    onward = np.all(vy * gx - vx * gy >= size * (bend * (size[0] + size[1] + size[2])), axis=0)
    room = 1 - 2 * bend * largest
    return np.where(onward & (room >= 0.0), 2 * largest / (1 + np.sqrt(np.maximum(room, 0.0))), np.inf)


def _crossing(parts: StretchParts, begins: Floats, ends: Floats, omega: Floats, at: StretchEnds) -> Floats:
    """Where on the circle of all joints the biarcs have theirs: the share of the angle that lies before it."""
    crossing = np.flatnonzero((begins > 0) != (ends > 0))
    of = parts.stretch[crossing]
    crossing = crossing[(crossing != parts.first[of]) & (crossing != parts.first[of + 1] - 1)]
    share = np.full(len(omega), 0.5)
    if not len(crossing):
        return share
    stretch = parts.stretch[crossing]
    f0, f1 = begins[crossing], ends[crossing]
    t = f0 / (f0 - f1)
    x = parts.x[0, crossing] * (1 - t) + parts.x[3, crossing] * t
    y = parts.y[0, crossing] * (1 - t) + parts.y[3, crossing] * t
    before, after = np.hypot(x, y), np.hypot(x - at.x[stretch], y - at.y[stretch])
    angle = omega[stretch]
    # In the triangle of the ends and the joint the angles at the ends are to each other as the shares of omega.
    flat = np.abs(angle) < 1e-8
    round_ = np.arctan2(before * np.sin(angle), after + before * np.cos(angle)) / np.where(flat, 1.0, angle)
    found = np.where(flat, before / (before + after), round_)
    order = np.lexsort((np.abs(found - 0.5), stretch))
    stretch, found = stretch[order], found[order]
    leading = np.append(True, stretch[1:] != stretch[:-1])
    share[stretch[leading]] = np.clip(found[leading], 0.05, 0.95)
    return share

"""Where segments of paths meet, in closed form: lines, arcs and quadratic Bezier curves against lines and arcs.

A line is an arc without curvature. In the frame of its chord, from 0 to 1, an arc of the turn 2 phi is the image of
0 <= x <= 1 under v = x / (x + (1 - x) e^(i phi)); points z of the circle through p with the unit normal n (to the left)
and the curvature k satisfy k |z - p|^2 / 2 - n . (z - p) = 0. One put into the other is a quadratic in x, whatever the
curvatures, 0 among them; a quadratic Bezier curve put into it is a quartic, or a quadratic for a line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.paths.paths import CUBIC, LINE, QUAD, Paths
from voronoi_tiles.paths.segments import (
    Circles,
    bezier_at,
    candidate_pairs,
    chord_share,
    from_chord_share,
    point_at,
    split,
    tangent_at,
)

CONTACT_ULPS: Final = 16.0
"""How far apart, in ulps of the largest coordinate, two segments may pass and still touch, how far beyond its end a
segment still meets another, and how near they must run to coincide. It is what rounding leaves of a point that lies on
both."""

_POLES: Final = (np.inf, 2.0, -2.0, 4.0, -4.0)
"""Places that may be sent to infinity; a quartic vanishes in four of the five at most."""

_IMAGINARY: Final = 1e-5
"""Imaginary part below which a root is tried as a real one: a double root splits by about the root of 1e-16."""

_NEWTON_STEPS: Final = 4


@dataclass(frozen=True, eq=False)
class Intersections:
    """The points where pairs of segments meet.

    Point k lies on both segments of the pair `pair[k]` (intp), at `t[k]` of the first and `u[k]` of the second, both in
    [0, 1]: a Bezier parameter on LINE and QUAD, the share of the angle on ARC. `point` is complex128. `overlaps` (intp)
    are the pairs that run along each other for some length: they have no points here.
    """

    pair: Ints
    t: Floats
    u: Floats
    point: Complexes
    overlaps: Ints


def crossings(first: Paths, i: Ints, second: Paths, j: Ints) -> Intersections:
    """All points where the segment i[k] of `first` and the segment j[k] of `second` meet, in the order of k, then of t.

    The first may be LINE, QUAD or ARC, the second LINE or ARC; raises ValueError for others. A point up to CONTACT_ULPS
    from an end, within the segment or beyond it, is taken as the end. A tangential contact is given once or twice.
    Lines or arcs that lie on one line or circle give no points but are listed in `overlaps`; where they only touch, end
    to end, that end is a point. A straight QUAD on a second one's whole line, be it beyond its ends, counts as overlap.
    """
    if np.isin(first.kind[i], CUBIC).any() or np.isin(second.kind[j], (QUAD, CUBIC)).any():
        raise ValueError("only lines, arcs and, on the first side, quadratic curves can be intersected")
    bent = first.kind[i] == QUAD
    straight = second.kind[j] == LINE
    found = []
    for pairs, method in (
        (np.flatnonzero(~bent), _arc_arc),
        (np.flatnonzero(bent & straight), _quad_line),
        (np.flatnonzero(bent & ~straight), _quad_arc),
    ):
        if len(pairs):
            part = method(_Pairs.of(first, i[pairs], second, j[pairs]))
            found.append((pairs[part.pair], part.t, part.u, part.point, pairs[part.overlaps]))
    if not found:
        none = np.zeros(0, np.intp)
        return Intersections(none, np.zeros(0), np.zeros(0), np.zeros(0, np.complex128), none)
    pair, t, u, point, overlaps = (np.concatenate(part) for part in zip(*found, strict=True))
    order = np.lexsort((t, pair))
    return Intersections(pair[order], t[order], u[order], point[order], np.sort(overlaps))


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Pairs of segments, each segment also as a part of a circle; `touching` is the distance at which they touch."""

    first: Paths
    i: Ints
    here: Circles
    there: Circles
    touching: Floats

    @classmethod
    def of(cls, first: Paths, i: Ints, second: Paths, j: Ints) -> _Pairs:
        """The pairs of the segments i of `first` and j of `second`."""
        corners = (first.start[i], first.end[i], second.start[j], second.end[j])
        touching = CONTACT_ULPS * EPSILON * np.max(np.abs(corners), axis=0)
        return cls(first, i, Circles.of(first, i), Circles.of(second, j), touching)

    def collect(self, pair: Ints, x: Floats, overlaps: Ints) -> Intersections:
        """The points at x on the first segments, where they lie on the second ones too; x as `bezier_at` takes it.

        For ARCs x is the share in the chord's frame, see the module.
        """
        arcs = self.first.kind[self.i] != QUAD
        slack = self.touching[pair] / _at_least(np.abs(self.here.chord))[pair]
        near = np.isfinite(x) & (x >= -slack) & (x <= 1 + slack)
        pair, x = pair[near], _at_ends(x[near], slack[near])
        points = np.empty(len(pair), np.complex128)
        t = x.copy()
        on = arcs[pair]
        points[on], t[on] = _on_arcs(self.first, self.i[pair[on]], self.here.half[pair[on]], x[on])
        points[~on] = bezier_at(self.first, self.i[pair[~on]], x[~on])
        there = self.there.take(pair)
        y = chord_share((points - there.start) / there.chord, there.half)
        slack = self.touching[pair] / np.abs(there.chord)
        near = np.isfinite(y) & (y >= -slack) & (y <= 1 + slack)
        pair, points, t, y = pair[near], points[near], t[near], _at_ends(y[near], slack[near])
        return Intersections(pair, t, from_chord_share(y, self.there.half[pair])[1], points, overlaps)


def _at_ends(x: Floats, slack: Floats) -> Floats:
    """Places within `slack` of 0 or 1 there, whichever side of it."""
    return np.where(x <= slack, 0.0, np.where(x >= 1 - slack, 1.0, x))


def _on_arcs(paths: Paths, segments: Ints, half: Floats, x: Floats) -> tuple[Complexes, Floats]:
    """The points at x in the frame of the chord, and their shares of the angle."""
    v, t = from_chord_share(x, half)
    start, end = paths.start[segments], paths.end[segments]
    # From the nearer end, so that an end has the bits of the segment's own.
    return np.where(x > 0.5, end + (end - start) * (v - 1), start + (end - start) * v), t


def _arc_arc(pairs: _Pairs) -> Intersections:
    """Lines and arcs against lines and arcs: a quadratic."""
    here, there = pairs.here, pairs.there
    w, turn = here.start - there.start, np.exp(1j * here.half)
    # The equation of the second circle times |x + (1 - x) turn|^2, for z = start + chord v; its Bernstein coefficients.
    at_start, at_end = there.off(here.start), there.off(here.start + here.chord)
    slope = ((there.curvature * w - there.normal) * (here.chord * turn.conj()).conj()).real
    middle = at_start * turn.real + slope / 2
    alike = _coincident(pairs)
    x = _quadratic_roots(at_start - 2 * middle + at_end, 2 * (middle - at_start), at_start, pairs.touching)
    x[:, alike] = np.nan
    pair, roots = _listed(x)
    met, ends, overlaps = _end_to_end(pairs, np.flatnonzero(alike))
    return pairs.collect(np.concatenate((pair, met)), np.concatenate((roots, ends)), overlaps)


def _quad_line(pairs: _Pairs) -> Intersections:
    """Quadratic Bezier curves against lines: a quadratic."""
    there, start = pairs.there, pairs.here.start
    control, end = pairs.first.control[pairs.i, 0], start + pairs.here.chord
    c, middle, last = there.off(start), there.off(control), there.off(end)
    # As differences of nearby points: the distances from the line may be large.
    b = -2 * ((control - start) * there.normal.conj()).real
    a = -((start - 2 * control + end) * there.normal.conj()).real
    alike = np.max(np.abs([c, middle, last]), axis=0) <= pairs.touching
    x = _quadratic_roots(a, b, c, pairs.touching)
    x[:, alike] = np.nan
    return pairs.collect(*_listed(x), np.flatnonzero(alike))


def _quad_arc(pairs: _Pairs) -> Intersections:
    """Quadratic Bezier curves against arcs: a quartic."""
    control, start, chord = pairs.first.control[pairs.i, 0], pairs.here.start, pairs.here.chord
    # About the curve's middle, in -1 <= s <= 1: z = c0 + c1 s + c2 s^2.
    c2 = (start - control + (start + chord - control)) / 4
    c0, c1 = control + c2 - pairs.there.start, chord / 2
    k, n = pairs.there.curvature, pairs.there.normal.conj()
    poly = np.stack(
        [
            k / 2 * np.abs(c0) ** 2 - (c0 * n).real,
            k * (c0 * c1.conj()).real - (c1 * n).real,
            k * ((c0 * c2.conj()).real + np.abs(c1) ** 2 / 2) - (c2 * n).real,
            k * (c1 * c2.conj()).real,
            k / 2 * np.abs(c2) ** 2,
        ]
    )
    s = _quartic_roots(poly)

    # Not by the coefficients, in which a curve that is long beside the circle cancels.
    def off(s: Floats) -> Floats:
        z = c0 + s * (c1 + s * c2)
        return np.asarray(k / 2 * np.abs(z) ** 2 - (z * n).real)

    def slope(s: Floats) -> Floats:
        z, along = c0 + s * (c1 + s * c2), c1 + 2 * s * c2
        return np.asarray(k * (z * along.conj()).real - (along * n).real)

    for _ in range(_NEWTON_STEPS):
        s = s - _step(off(s), slope(s))
    s[np.abs(off(s)) > pairs.touching] = np.nan
    pair, root = _listed(s)
    return pairs.collect(pair, (1 + root) / 2, np.zeros(0, np.intp))


def _quartic_roots(poly: Floats) -> Floats:
    """The real parts of the nearly real roots in or near [-1, 1] of polynomials (5, n), ascending; NaN for others.

    Eigenvalues of companion matrices, after the place where the polynomial is largest was sent to infinity, so that a
    vanishing leading coefficient does no harm.
    """
    size = np.max(np.abs(poly), axis=0)
    poly = poly / _at_least(size)
    shifted = np.stack([_about(poly, pole) for pole in _POLES])
    best = np.argmax(np.abs(shifted[:, -1]), axis=0)
    chosen = np.take_along_axis(shifted, best[None, None], axis=0)[0]
    companion = np.zeros((poly.shape[1], 4, 4))
    companion[:, [1, 2, 3], [0, 1, 2]] = 1.0
    companion[:, :, 3] = -(chosen[:4] / _at_least(chosen[4])).T
    eigen = np.linalg.eigvals(companion).T.astype(np.complex128)
    pole = np.asarray(_POLES)[best]
    with np.errstate(divide="ignore", invalid="ignore"):
        roots = np.where(np.isinf(pole), eigen, np.where(np.isinf(pole), 0.0, pole) + 1 / eigen)
    real = (np.abs(roots.imag) <= _IMAGINARY) & (np.abs(roots.real) <= 1 + _IMAGINARY)
    return np.where(real & (size > 0), roots.real, np.nan)


def _about(poly: Floats, pole: float) -> Floats:
    """The coefficients in 1 / (s - pole), ascending; for an infinite pole in s itself."""
    if np.isinf(pole):
        return poly
    taylor = []
    for order in range(5):
        taylor.append(_horner(poly, np.full(poly.shape[1], pole)) / float((1, 1, 2, 6, 24)[order]))
        poly = poly[1:] * np.arange(1.0, len(poly))[:, None]
    return np.stack(taylor[::-1])


def _horner(poly: Floats, s: Floats) -> Floats:
    value = np.broadcast_to(poly[-1], s.shape)
    for coefficient in poly[-2::-1]:
        value = value * s + coefficient
    return np.asarray(value, np.float64)


def _step(value: Floats, slope: Floats) -> Floats:
    """A Newton step, none where it would be long: at a double root, where the eigenvalue is as good as it gets."""
    with np.errstate(divide="ignore", invalid="ignore"):
        step = value / slope
    return np.where(np.abs(step) <= _IMAGINARY, step, 0.0)


def _quadratic_roots(a: Floats, b: Floats, c: Floats, touching: Floats) -> Floats:
    """The real roots of a x^2 + b x + c, shape (2, n), NaN for none; one that is missed by `touching` is a double."""
    square = b * b - 4 * a * c
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        missed = np.where(square < 0, -square / (4 * np.abs(a)), 0.0)
        root = np.where(missed <= touching, np.sqrt(np.maximum(square, 0.0)), np.nan)
        far = -(b + np.copysign(root, b)) / 2
        return np.stack((far / a, np.where(far == 0, 0.0, c) / np.where(far == 0, a, far)))


def _coincident(pairs: _Pairs) -> Bools:
    """Where the first segment lies on the second one's line or circle, and the other way round."""
    off = np.zeros(len(pairs.i))
    for one, other in ((pairs.here, pairs.there), (pairs.there, pairs.here)):
        for z in (one.start, _middle(one), one.start + one.chord):
            off = np.maximum(off, np.abs(other.off(z)))
    return np.asarray(off <= pairs.touching)


def _end_to_end(pairs: _Pairs, alike: Ints) -> tuple[Ints, Floats, Ints]:
    """Of pairs on one line or circle, those touching at an end of the first, with that end; and those overlapping."""
    here, there, touching = pairs.here.take(alike), pairs.there.take(alike), pairs.touching[alike]

    def strictly_inside(z: Complexes, on: Circles) -> Bools:
        x = chord_share((z - on.start) / on.chord, on.half)
        slack = touching / np.abs(on.chord)
        return np.asarray((x > slack) & (x < 1 - slack))

    overlap = np.zeros(len(alike), np.bool_)
    for one, other in ((here, there), (there, here)):
        # The middle tells the same segment once more, whichever way, from the other half of one circle.
        for z in (one.start, _middle(one), one.start + one.chord):
            overlap |= strictly_inside(z, other)
    met, x = [], []
    for end, z in ((0.0, here.start), (1.0, here.start + here.chord)):
        near = np.abs([z - there.start, z - there.start - there.chord]).min(axis=0) <= touching
        on = np.flatnonzero(near & ~overlap)
        met.append(alike[on])
        x.append(np.full(len(on), end))
    return np.concatenate(met), np.concatenate(x), alike[overlap]


def _middle(circles: Circles) -> Complexes:
    """The middles of the segments."""
    return circles.start + circles.chord * from_chord_share(np.full(len(circles.half), 0.5), circles.half)[0]


def _listed(roots: Floats) -> tuple[Ints, Floats]:
    """The columns and values of what is not NaN in a table of roots."""
    row, column = np.nonzero(~np.isnan(roots))
    return column.astype(np.intp), roots[row, column]


def _at_least(size: Floats) -> Floats:
    """Sizes to divide by, 1 in place of 0."""
    return np.where(size == 0, 1.0, size)


__all__ = ["CONTACT_ULPS", "Intersections", "candidate_pairs", "crossings", "point_at", "split", "tangent_at"]

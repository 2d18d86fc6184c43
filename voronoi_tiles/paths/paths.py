"""Paths as arrays: what is cut, scored or engraved, as lines, Bezier curves and circular arcs.

Every stage after the exact outlines takes and gives these: clipping, offsets, ordering, and the writers of files.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.maps import Affine, move

Kinds = NDArray[np.uint8]

LINE: Final = 0
QUAD: Final = 1
CUBIC: Final = 2
ARC: Final = 3


@dataclass(frozen=True, eq=False)
class Paths:
    """p paths of n segments altogether.

    `start` and `end` are complex128 (n,). `kind` (uint8, n) says what lies between: LINE, 0; QUAD, 1, a quadratic
    Bezier curve with the control point `control[:, 0]`; CUBIC, 2, a cubic one with both of `control` (complex128, n x
    2); ARC, 3, a circular arc over the point `control[:, 0]`, which is the middle of it. What a kind does not use is 0.
    The segments of path k are those from `offsets[k]` up to, not including, `offsets[k + 1]` (intp, p + 1); each starts
    where the one before ends, bit for bit, and where `closed` (bool, p), the first where the last ends.
    """

    start: Complexes
    end: Complexes
    control: Complexes
    kind: Kinds
    offsets: Ints
    closed: Bools

    def __repr__(self) -> str:
        return f"<Paths: {len(self)} paths of {len(self.start)} segments>"

    @classmethod
    def empty(cls) -> Self:
        """No path at all."""
        none = np.zeros(0, np.complex128)
        return cls(
            start=none,
            end=none,
            control=np.zeros((0, 2), np.complex128),
            kind=np.zeros(0, np.uint8),
            offsets=np.zeros(1, np.intp),
            closed=np.zeros(0, np.bool_),
        )

    @classmethod
    def polylines(cls, lines: Sequence[Sequence[complex] | Complexes], *, closed: bool = False) -> Self:
        """Straight lines through points, one path for each; closed ones do not repeat the first point."""
        if not lines:
            return cls.empty()
        arrays = [np.asarray(line, np.complex128) for line in lines]
        starts = arrays if closed else [line[:-1] for line in arrays]
        ends = [np.roll(line, -1) if closed else line[1:] for line in arrays]
        start = np.concatenate(starts)
        return cls(
            start=start,
            end=np.concatenate(ends),
            control=np.zeros((len(start), 2), np.complex128),
            kind=np.full(len(start), LINE, np.uint8),
            offsets=np.append(0, np.cumsum([len(line) for line in starts])).astype(np.intp),
            closed=np.full(len(arrays), closed),
        )

    @classmethod
    def concatenate(cls, parts: Sequence[Paths]) -> Self:
        """All paths of several, in their order."""
        if not parts:
            return cls.empty()
        counts = np.concatenate([np.diff(part.offsets) for part in parts])
        return cls(
            start=np.concatenate([part.start for part in parts]),
            end=np.concatenate([part.end for part in parts]),
            control=np.concatenate([part.control for part in parts]),
            kind=np.concatenate([part.kind for part in parts]),
            offsets=np.append(0, np.cumsum(counts)).astype(np.intp),
            closed=np.concatenate([part.closed for part in parts]),
        )

    def __len__(self) -> int:
        """Count the paths."""
        return len(self.closed)

    @property
    def counts(self) -> Ints:
        """The number of segments of each path."""
        return np.diff(self.offsets)

    @cached_property
    def owner(self) -> Ints:
        """The path that each segment belongs to."""
        return np.repeat(np.arange(len(self)), self.counts)

    def take(self, paths: Ints) -> Paths:
        """The paths at these places, in this order."""
        segments = ranges(self.offsets[paths], self.counts[paths])
        return Paths(
            start=self.start[segments],
            end=self.end[segments],
            control=self.control[segments],
            kind=self.kind[segments],
            offsets=np.append(0, np.cumsum(self.counts[paths])).astype(np.intp),
            closed=self.closed[paths],
        )

    def part(self, low: int, high: int) -> Paths:
        """The paths from `low` up to, not including, `high`, in the same memory."""
        first, last = self.offsets[low], self.offsets[high]
        return Paths(
            start=self.start[first:last],
            end=self.end[first:last],
            control=self.control[first:last],
            kind=self.kind[first:last],
            offsets=self.offsets[low : high + 1] - first,
            closed=self.closed[low:high],
        )

    def reversed(self, flags: Bools | None = None) -> Paths:
        """The same paths, those with a flag (all without `flags`) run through backwards."""
        turned = np.ones(len(self), np.bool_) if flags is None else flags
        order = np.arange(len(self.start))
        mirrored = (self.offsets[:-1] + self.offsets[1:] - 1)[self.owner] - order
        backwards = turned[self.owner]
        order = np.where(backwards, mirrored, order)
        start, end, control = self.start[order], self.end[order], self.control[order]
        swap = backwards & (self.kind[order] == CUBIC)
        return replace(
            self,
            start=np.where(backwards, end, start),
            end=np.where(backwards, start, end),
            control=np.where(swap[:, None], control[:, ::-1], control),
            kind=self.kind[order],
        )

    def moved(self, factor: complex, shift: complex, *, conj: bool = False) -> Paths:
        """The image under z -> factor z + shift, or factor conj(z) + shift."""
        points = np.stack((self.start, self.end, *self.control.T))
        image = move(points, factor, shift, conj)
        return replace(self, start=image[0], end=image[1], control=self._used(image[2:].T))

    def mapped(self, by: Affine) -> Paths:
        """The image under an affine map, of paths without ARCs, which it may make ellipses of."""
        points = np.stack((self.start, self.end, *self.control.T))
        (a, b), (c, d) = ((by.a + by.b).real, (by.b - by.a).imag), ((by.a + by.b).imag, (by.a - by.b).real)
        image = np.empty_like(points)  # in real numbers: see `move`
        image.real = a * points.real + b * points.imag + by.c.real
        image.imag = c * points.real + d * points.imag + by.c.imag
        return replace(self, start=image[0], end=image[1], control=self._used(image[2:].T))

    def shifted(self, shift: Complexes) -> Paths:
        """The image where each segment is moved by its own vector, complex128 (n,): those that meet by the same."""
        control = self._used(self.control + shift[:, None])
        return replace(self, start=self.start + shift, end=self.end + shift, control=control)

    def turned(self, unit: Complexes, shift: Complexes) -> Paths:
        """The image where each segment is turned about 0 by a unit of its own, then moved, complex128 (n,)."""
        image = move(np.stack((self.start, self.end, *self.control.T)), unit, shift)
        return replace(self, start=image[0], end=image[1], control=self._used(image[2:].T))

    def _used(self, control: Complexes) -> Complexes:
        """Control points, after 0 has been put into them where a kind uses none."""
        control[self.kind == LINE] = 0
        control[self.kind != CUBIC, 1] = 0
        return control

    @cached_property
    def lengths(self) -> Floats:
        """The length of each segment; of cubics to about 1e-9 of it."""
        from voronoi_tiles.paths.quadratics import quadratic_lengths

        lengths = np.abs(self.end - self.start)
        bent = np.flatnonzero(self.kind == QUAD)
        lengths[bent] = quadratic_lengths(self.start[bent], self.control[bent, 0], self.end[bent])
        round_ = np.flatnonzero(self.kind == ARC)
        if len(round_):
            # The chord over the sinc of half the turn, which stays right where the arc is flat.
            lengths[round_] /= np.sinc(2.0 * np.arctan(self.bulges()[round_]) / np.pi)
        cubic = np.flatnonzero(self.kind == CUBIC)
        if len(cubic):
            lengths[cubic] = _cubic_lengths(
                self.start[cubic], self.control[cubic, 0], self.control[cubic, 1], self.end[cubic]
            )
        return lengths

    @property
    def path_lengths(self) -> Floats:
        """The length of each path."""
        return np.asarray(np.bincount(self.owner, self.lengths, len(self)), np.float64)

    def bulges(self) -> Floats:
        """The tangent of a quarter of the angle of each ARC, > 0 where it turns left; 0 for all other kinds."""
        bulge = np.zeros(len(self.start))
        arcs = np.flatnonzero(self.kind == ARC)
        chord = self.end[arcs] - self.start[arcs]
        sagitta = self.control[arcs, 0] - (self.start[arcs] + self.end[arcs]) / 2
        # The middle lies to the right of the chord where the arc turns left.
        across = (sagitta * chord.conj()).imag
        bulge[arcs] = -2.0 * across / np.abs(chord) ** 2
        return bulge

    def arc_radius_and_turn(self, arcs: Ints) -> tuple[Floats, Floats]:
        """The radius of some ARCs, and the angle by which each turns left; radians. A flat one's radius is infinite."""
        bulge = self.bulges()[arcs]
        turn = 4.0 * np.arctan(bulge)
        chord = np.abs(self.end[arcs] - self.start[arcs])
        with np.errstate(divide="ignore"):
            radius = chord * (1.0 + bulge**2) / (4.0 * np.abs(bulge))
        return radius, turn

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """The smallest upright rectangle around the paths: least x, least y, greatest x, greatest y.

        Raises ArgumentError where there is no segment.
        """
        if not len(self.start):
            raise ArgumentError("no path has no bounds")
        quads, cubics, arcs = (np.flatnonzero(self.kind == kind) for kind in (QUAD, CUBIC, ARC))
        extremes = [self.start, self.end]
        extremes += _quad_extremes(self.start[quads], self.control[quads, 0], self.end[quads])
        extremes += _cubic_extremes(
            self.start[cubics], self.control[cubics, 0], self.control[cubics, 1], self.end[cubics]
        )
        extremes += self._arc_extremes(arcs)
        points = np.concatenate(extremes)
        return float(points.real.min()), float(points.imag.min()), float(points.real.max()), float(points.imag.max())

    def _arc_extremes(self, arcs: Ints) -> list[Complexes]:
        """The points of arcs where they run along an axis."""
        if not len(arcs):
            return []
        centre, radius, begin, turn = self.circles(arcs)
        found = []
        for quarter in range(4):
            # How far the direction of the axis lies ahead of the arc's beginning, in the sense of its turn.
            ahead = np.mod((quarter * (np.pi / 2) - begin) * np.sign(turn), 2 * np.pi)
            on = ahead <= np.abs(turn)
            found.append(centre[on] + radius[on] * (1, 1j, -1, -1j)[quarter])
        return found

    def circles(self, arcs: Ints) -> tuple[Complexes, Floats, Floats, Floats]:
        """The circles of some ARCs: centre, radius, direction of the beginning from the centre, turn to the left.

        Angles are radians.
        """
        radius, turn = self.arc_radius_and_turn(arcs)
        start, end = self.start[arcs], self.end[arcs]
        chord = end - start
        # From the middle of the chord to the centre: to the left for a left turn of less than half a circle.
        centre = (start + end) / 2 + 0.5j * chord / np.tan(turn / 2)
        return centre, radius, np.angle(start - centre), turn


_LENGTH_ERROR = 1e-11
"""How exactly the lengths of cubic curves are found, relative to their control polygons."""

_POINTS_EVEN, _POINTS_UNEVEN = 10, 24
"""Points of the quadrature where the speed is even, and elsewhere; counts."""

_CURVES = 8192
"""Curves that are measured at once; a count. Bounds the memory."""


def _cubic_lengths(p0: Complexes, p1: Complexes, p2: Complexes, p3: Complexes) -> Floats:
    """The lengths of cubic Bezier curves: Gauss-Legendre quadrature of the speed, of halves where it is uneven."""
    curves = np.stack((p0, p1, p2, p3))
    portions = [curves[:, first : first + _CURVES] for first in range(0, len(p0), _CURVES)]
    return np.concatenate([_portion_lengths(portion) for portion in portions])


def _portion_lengths(curves: Complexes) -> Floats:
    """The lengths of a few cubic Bezier curves (4, n)."""
    scale = np.abs(np.diff(curves, axis=0)).sum(axis=0)
    # Most curves of files are nearly arcs: few points do for them, and others show where they do not.
    lengths = _quadrature(curves, _POINTS_EVEN)
    owner = np.flatnonzero(np.abs(lengths - _quadrature(curves, _POINTS_EVEN - 2)) > _LENGTH_ERROR * scale)
    lengths[owner] = 0.0
    curves = curves[:, owner]
    rough = _quadrature(curves)
    while len(owner):
        parts = halves(curves)
        fine = _quadrature(parts.reshape(4, -1)).reshape(2, -1)
        uneven = np.abs(fine.sum(axis=0) - rough) > _LENGTH_ERROR * scale[owner]
        np.add.at(lengths, owner[~uneven], fine.sum(axis=0)[~uneven])
        curves, rough = parts[:, :, uneven].reshape(4, -1), fine[:, uneven].ravel()
        owner = np.tile(owner[uneven], 2)
    return lengths


@cache
def _gauss(count: int) -> tuple[Floats, Floats]:
    """Nodes and weights of the quadrature; deferred, as numpy.polynomial takes a while to import."""
    return np.polynomial.legendre.leggauss(count)


def _quadrature(curves: Complexes, count: int = _POINTS_UNEVEN) -> Floats:
    """The integrals of the speed along cubic Bezier curves (4, n), from their differences."""
    nodes, weights = _gauss(count)
    t = (nodes + 1) / 2
    s = 1 - t
    a, b, c = np.diff(curves, axis=0)
    speed = np.abs(3 * (np.outer(a, s * s) + np.outer(b, 2 * s * t) + np.outer(c, t * t)))
    return np.asarray(speed @ (weights / 2), np.float64)


def halves(curves: Complexes) -> Complexes:
    """Both halves of cubic Bezier curves (4, n), by de Casteljau: (4, 2, n)."""
    a, b, c, d = curves
    ab, bc, cd = (a + b) * 0.5, (b + c) * 0.5, (c + d) * 0.5
    abc, bcd = (ab + bc) * 0.5, (bc + cd) * 0.5
    middle = (abc + bcd) * 0.5
    return np.stack((np.stack((a, middle)), np.stack((ab, bcd)), np.stack((abc, cd)), np.stack((middle, d))))


def _quad_extremes(p0: Complexes, p1: Complexes, p2: Complexes) -> list[Complexes]:
    """The points of quadratic Bezier curves where they run along an axis."""
    if not len(p0):
        return []
    found = []
    for a, b, c in ((p0.real, p1.real, p2.real), (p0.imag, p1.imag, p2.imag)):
        bend = a - 2 * b + c
        turns = (a - b) * (c - b) > 0
        t = (a[turns] - b[turns]) / bend[turns]
        found.append(p0[turns] * (1 - t) ** 2 + 2 * p1[turns] * t * (1 - t) + p2[turns] * t**2)
    return found


def _cubic_extremes(p0: Complexes, p1: Complexes, p2: Complexes, p3: Complexes) -> list[Complexes]:
    """The points of cubic Bezier curves where they run along an axis."""
    if not len(p0):
        return []
    found = []
    for a, b, c, d in zip(*((p.real, p.imag) for p in (p0, p1, p2, p3)), strict=True):
        # The derivative, divided by 3, is u t^2 + v t + w.
        u, v, w = d - 3 * c + 3 * b - a, 2 * (c - 2 * b + a), b - a
        root = np.sqrt(np.maximum(v * v - 4 * u * w, 0.0))
        far = -(v + np.where(v < 0, -root, root)) / 2
        with np.errstate(divide="ignore", invalid="ignore"):
            roots = np.stack((far / u, w / far))
        for t in roots:
            on = np.flatnonzero((t > 0) & (t < 1))
            s, t_on = 1 - t[on], t[on]
            found.append(p0[on] * s**3 + 3 * p1[on] * s * s * t_on + 3 * p2[on] * s * t_on**2 + p3[on] * t_on**3)
    return found

"""Pulling tiles apart: how much a layout has to be spread so that all contours keep a distance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, offsets_of, plane
from voronoi_tiles.paths.clearance import Outlines
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.vector.complex.period import Period

_DIRECTIONS: Final = 12
"""Directions of the greater stretch that are tried; a count."""

_RATIOS: Final = (1.0, 0.6, 0.35, 0.15, 0.0)
"""Lesser stretches that are tried, as shares of the greater one."""

_GROWTH: Final = 1.1
"""From one stretch that is tried to the next; a factor."""

_FIRST: Final = 0.3
"""The first stretch that is tried moves tiles by this share of the gap."""

FARTHEST: Final = 64.0
"""Largest stretch that is tried; a factor."""

_COARSE: Final = 0.02
"""How far the contours by which stretches are chosen may lie from the true ones; a share of the gap."""

_BISECTIONS: Final = 20
"""Halvings of the last step of a stretch, a tenth of it: they leave a ten millionth."""

_SURELY: Final = 1 - 1e-9
"""Two points that are nearer than this share of the gap are so whatever rounding does."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """A symmetric linear map of the plane, z -> `p` z + `q` conj(z): it stretches along one line, and across it."""

    p: float
    q: complex

    def __call__(self, z: Complexes) -> Complexes:
        """The images of points."""
        return np.asarray(self.p * z + self.q * z.conj())

    def inverse(self, z: complex) -> complex:
        """The point with this image."""
        return (self.p * z - self.q * z.conjugate()) / self.area

    @property
    def area(self) -> float:
        """By how much areas grow."""
        return self.p**2 - abs(self.q) ** 2

    @property
    def is_identity(self) -> bool:
        """Whether nothing moves."""
        return self.p == 1.0 and self.q == 0.0


UNSTRETCHED: Final = Stretch(1.0, 0j)


class Spacing:
    """Tiles of one period that are to be pulled apart: how much they have to be spread for a gap.

    `contours` are those of the tiles, as LINE pieces, `centres` the points that are stretched, `basis` the lattice
    vectors. Every copy moves as a whole.
    """

    def __init__(self, contours: Sequence[Paths], centres: Complexes, basis: Complexes) -> None:
        self._shapes = np.array([_shape(contour) for contour in contours])
        self._centres, self._basis = centres, basis

    def stretch(self, gap: float) -> Stretch:
        """The stretch of the places of tiles after which contours are `gap` apart: of those tried, that of least room.

        Tiles that are hooked into each other come apart sooner in one direction than in another: stretches in twelve
        directions, with five ratios of the stretch across to that along, are tried in sizes that grow by a tenth, those
        that take least room first; the first that parts all tiles is then made as small as it can be. Raises ValueError
        for tiles that none of them parts: those in a hole of another.
        """
        return common_stretch([self], gap)

    def neighbourhood(self, gap: float, *, coarse: bool = False) -> _Neighbourhood:
        """The pairs of tiles that a gap is about; `coarse`, of simpler contours."""
        import shapely

        shapes = shapely.simplify(self._shapes, _COARSE * gap) if coarse else self._shapes
        return _Neighbourhood(shapes, self._centres, self._basis, gap)


def common_stretch(spacings: Sequence[Spacing], gap: float) -> Stretch:
    """The stretch after which contours are `gap` apart in each of some layouts with one lattice; as Spacing.stretch."""
    fine = [spacing.neighbourhood(gap) for spacing in spacings]
    if all(one.too_near(1.0, 0j) is None for one in fine):
        return UNSTRETCHED
    p, q = _tried(_FIRST * gap / max(float(np.abs(one.apart).max()) for one in fine))
    best = _first_clear([spacing.neighbourhood(gap, coarse=True) for spacing in spacings], p, q)
    if best is None:
        raise ValueError("a tile lies within another, and cannot be pulled out")
    return _fitted(fine, float(p[best]), complex(q[best]))


def _first_clear(some: Sequence[_Neighbourhood], p: Floats, q: Complexes) -> int | None:
    """The first of some stretches that parts all pairs of all neighbourhoods; None where none does."""
    first, before = 0, -1
    while first != before:
        before = first
        for one in some:
            clear = one.first_clear(p[first:], q[first:])
            if clear is None:
                return None
            first += clear
    return first


def _fitted(some: Sequence[_Neighbourhood], p: float, q: complex) -> Stretch:
    """The least stretch of a kind that parts all pairs of all neighbourhoods, near one that nearly does."""

    def clear(part: float) -> bool:
        """Whether one that moves everything by so much of it does."""
        return all(one.too_near(1 + part * (p - 1), part * q) is None for one in some)

    high = 1.0
    while not clear(high):
        high *= 1 + (_GROWTH - 1) / 10
    low = 1 / _GROWTH
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        low, high = (low, middle) if clear(middle) else (middle, high)
    return Stretch(1 + high * (p - 1), high * q)


def _tried(first: float) -> tuple[Floats, Complexes]:
    """The p and q of the stretches that are tried, those that take least room first; `first` is the least size."""
    sizes = first * _GROWTH ** np.arange(int(np.log(FARTHEST / first) / np.log(_GROWTH)) + 1)
    # The same stretch along and across has no direction.
    kinds = [(np.pi * k / _DIRECTIONS, r) for r in _RATIOS for k in range(_DIRECTIONS if r < 1.0 else 1)]
    direction, ratio = np.repeat(np.array(kinds), len(sizes), axis=0).T
    along = np.tile(sizes, len(kinds))
    order = np.argsort((1 + along) * (1 + ratio * along), kind="stable")
    p = 1 + (1 + ratio) * along / 2
    q = (1 - ratio) * along / 2 * np.exp(2j * direction)
    return p[order], q[order]


class _Neighbourhood:
    """Pairs of tiles of a layout that is stretched: which of them are nearer than the gap.

    The first of pair k is the shape `one[k]`, the second the shape `two[k]` moved by the lattice vector `step[k]`;
    then its centre is `apart[k]` from the first one's. Of a pair that was too near two points are kept, one of each
    shape: while they stay so near to each other, nothing has to be measured.
    """

    def __init__(self, shapes: Any, centres: Complexes, basis: Complexes, gap: float) -> None:
        self.shapes = shapes
        self.gap = gap
        self.outlines, several = _outlines(shapes)
        boxes = self.outlines.boxes
        size = boxes[:, 2:] - boxes[:, :2]
        self.one, self.two, self.step = _pairs(boxes, basis, 2 * float(np.hypot(*size.T).max()) + gap)
        self.apart = centres[self.two] + self.step - centres[self.one]
        one, two = size[self.one], size[self.two]
        self.several = several[self.one] | several[self.two]
        # Of these one may lie within the other, and far from its border.
        self.holding = np.flatnonzero((one < two).all(axis=1) | (one > two).all(axis=1) | self.several)
        self.failures = np.zeros(len(self.one), np.intp)
        # For each pair that was too near: from a point of the second shape, unmoved, to one of the first.
        self._met, self._between = np.zeros(0, np.intp), np.zeros(0, np.complex128)

    def first_clear(self, p: Floats, q: Complexes) -> int | None:
        """The first of some stretches that parts all pairs; None where none does."""
        left = np.arange(len(p))
        while len(left):
            first = int(left[0])
            pair = self.too_near(float(p[first]), complex(q[first]))
            if pair is None:
                return first
            left = left[1:]
            shift = self.step[pair] + _moves(p[left], q[left], self.apart[pair])
            left = left[np.abs(shift - self._between[-1]) >= _SURELY * self.gap]
        return None

    def too_near(self, p: float, q: complex) -> int | None:
        """A pair that a stretch leaves nearer than the gap; None where it parts all."""
        shift = self.step + _moves(p, q, self.apart)
        still = np.flatnonzero(np.abs(shift[self._met] - self._between) < _SURELY * self.gap)
        if len(still):
            return int(self._met[still[0]])
        # What was too near most often is likely to be so again.
        order = np.argsort(-self.failures, kind="stable")
        near = self.outlines.first_near(self.one[order], self.two[order], shift[order], self.gap)
        if near is None:
            return self._held(shift)
        pair = int(order[near.pair])
        self._keep(pair, complex(shift[pair]) + near.way)
        return pair

    def _held(self, shift: Complexes) -> int | None:
        """A pair of which one lies within the other, the second ones moved by their `shift`; None without any."""
        import shapely

        one, two = self.one[self.holding], self.two[self.holding]
        here, there = self.outlines.boxes[one], self.outlines.boxes[two] + np.tile(plane(shift[self.holding]), 2)
        likely = _holds(here, there) | _holds(there, here) | self.several[self.holding]
        for pair in self.holding[likely].tolist():
            moved = shapely.transform(self.shapes[self.two[pair]], partial(np.add, plane(shift[pair])))
            if shapely.intersects(self.shapes[self.one[pair]], moved):
                self._keep(pair, complex(shift[pair]))
                return int(pair)
        return None

    def _keep(self, pair: int, between: complex) -> None:
        """Keep two points of a pair that is too near."""
        self.failures[pair] += 1
        self._met = np.append(self._met, pair)
        self._between = np.append(self._between, between)


def _holds(outer: Floats, inner: Floats) -> Bools:
    """Whether boxes hold others."""
    return np.asarray(((outer[:, :2] <= inner[:, :2]) & (inner[:, 2:] <= outer[:, 2:])).all(axis=1))


def _moves(p: Floats | float, q: Complexes | complex, points: Complexes | complex) -> Complexes:
    """How far stretches move points, one each."""
    return np.asarray((p - 1) * points + q * np.conjugate(points))


def pulled_apart(period: Period, centres: Complexes, about: complex, stretch: Stretch) -> Period:
    """The period of a layout that is spread: the centre c of each tile stands at `about` + `stretch`(c - `about`).

    Tile and lattice vector still name the same copy; but no two tiles share an edge or a vertex any more.
    """
    rings = period.rings
    ring_of = np.repeat(np.arange(len(rings.offsets) - 1), np.diff(rings.offsets))
    tile = np.repeat(np.arange(len(period.site)), np.diff(rings.tiles))[ring_of]
    shift = stretch(centres - about) - (centres - about)
    edges = period.edges.take(rings.edge)
    # The first and last point of an edge are those of its vertices, wherever it stands.
    ends = np.column_stack((period.start[rings.edge], period.end[rings.edge])).ravel()
    places = np.stack((rings.step, rings.step + period.reach[rings.edge]), axis=1).reshape(-1, 2)
    rows = np.column_stack((np.repeat(tile, 2), ends, places))
    _, first, vertex = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    start, end = vertex.reshape(-1, 2).T
    return replace(
        period,
        basis=stretch(period.basis),
        vertex=period.at(period.vertex[ends], places)[first] + np.repeat(shift[tile], 2)[first],
        start=start,
        end=end,
        reach=0 * rings.step,
        edges=edges.shifted(period.shifts(rings.step)[edges.owner]).shifted(shift[tile][edges.owner]),
        orbit=period.orbit[rings.edge],
        edge_motion=tuple(period.edge_motion[edge] for edge in rings.edge.tolist()),
        rings=replace(rings, edge=np.arange(len(rings.edge)), step=0 * rings.step),
    )


def _shape(contour: Paths) -> Any:
    """The filled shape of rings of lines, the outer one first of each part."""
    import shapely

    rings = [shapely.LinearRing(plane(points)) for points in np.split(contour.start, contour.offsets[1:-1])]
    return shapely.build_area(shapely.GeometryCollection(rings)) if len(rings) > 1 else shapely.Polygon(rings[0])


def _outlines(shapes: Any) -> tuple[Outlines, Bools]:
    """The outlines of shapes, and which have several rings."""
    import shapely

    parts, owner = shapely.get_parts(shapes, return_index=True)
    rings, part = shapely.get_rings(parts, return_index=True)
    points, ring = shapely.get_coordinates(rings, return_index=True)
    points = points.view(np.complex128)[:, 0]
    begin = np.flatnonzero(ring[1:] == ring[:-1])
    of = owner[part]
    first = offsets_of(np.bincount(of[ring[begin]], minlength=len(shapes)))
    return Outlines(points[begin], points[begin + 1], first), np.bincount(of, minlength=len(shapes)) > 1


def _pairs(boxes: Floats, basis: Complexes, reach: float) -> tuple[Ints, Ints, Complexes]:
    """The pairs of tiles, the second one moved by a lattice vector, whose boxes come within a reach; each pair once."""
    a, b = basis.tolist()
    det = abs(a.real * b.imag - a.imag * b.real)
    across = float(np.hypot(boxes[:, 2].max() - boxes[:, 0].min(), boxes[:, 3].max() - boxes[:, 1].min())) + reach
    n, m = int(np.ceil(across * abs(b) / det)), int(np.ceil(across * abs(a) / det))
    tiles = np.arange(len(boxes))
    one, two, i, j = (k.ravel() for k in np.meshgrid(tiles, tiles, np.arange(-n, n + 1), np.arange(-m, m + 1)))
    once = (two > one) | ((two == one) & ((i > 0) | ((i == 0) & (j > 0))))
    one, two, step = one[once], two[once], (i * a + j * b)[once]
    low, high = boxes[two, :2] - boxes[one, 2:], boxes[one, :2] - boxes[two, 2:]
    shift = plane(step)
    near = np.maximum(low + shift, high - shift).max(axis=1) <= reach
    return one[near], two[near], step[near]

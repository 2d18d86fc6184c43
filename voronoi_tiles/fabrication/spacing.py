"""Pulling tiles apart: how much a layout has to be spread so that all contours keep a distance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, plane
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

_ROUGH: Final = 0.1
"""The same for contours by which most stretches are found to be too small."""

_BISECTIONS: Final = 20
"""Halvings of the last step of a stretch, a tenth of it: they leave a ten millionth."""

_AT_ONCE: Final = 128
"""Stretches that are tried at once; a count. Those after the first that will do are tried in vain."""


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


def spread(contours: Sequence[Paths], centres: Complexes, basis: Complexes, gap: float) -> Stretch:
    """The stretch of the places of tiles after which contours are `gap` apart: of those tried, the one with least room.

    `contours` are those of the tiles of one period, as LINE pieces, `centres` the points that are stretched, `basis`
    the lattice vectors. Every copy moves as a whole. Tiles that are hooked into each other come apart sooner in one
    direction than in another: stretches in twelve directions, with five ratios of the stretch across to that along,
    are tried in sizes that grow by a tenth, those that take least room first; the first that parts all tiles is then
    made as small as it can be. Raises ValueError for tiles that none of them parts: those in a hole of another.
    """
    import shapely

    shapes = np.array([_shape(contour) for contour in contours])
    fine = _Neighbourhood(shapes, centres, basis, gap)
    if (fine.at_rest >= gap).all():
        return UNSTRETCHED
    p, q = _tried(_FIRST * gap / float(np.abs(fine.apart).max()))
    coarse = _Neighbourhood(shapely.simplify(shapes, _COARSE * gap), centres, basis, gap)
    # What comes so near by contours that are off by so much is too near by the coarse ones.
    rough = _Neighbourhood(shapely.simplify(coarse.shapes, _ROUGH * gap), centres, basis, (1 - 2 * _ROUGH) * gap)
    best = coarse.first_clear(p, q, rough)
    if best is None:
        raise ValueError("a tile lies within another, and cannot be pulled out")
    return fine.fitted(float(p[best]), complex(q[best]))


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
    then its centre is `apart[k]` from the first one's.
    """

    def __init__(self, shapes: Any, centres: Complexes, basis: Complexes, gap: float) -> None:
        import shapely

        shapely.prepare(shapes)
        self.shapes = shapes
        self.gap = gap
        self.boxes = np.asarray(shapely.bounds(shapes), np.float64)
        across = np.hypot(self.boxes[:, 2] - self.boxes[:, 0], self.boxes[:, 3] - self.boxes[:, 1])
        self.one, self.two, self.step = _pairs(self.boxes, basis, 2 * float(across.max()) + gap)
        self.apart = centres[self.two] + self.step - centres[self.one]
        self.everything = np.arange(len(self.one))
        self.failures = np.zeros(len(self.one), np.intp)

    @cached_property
    def at_rest(self) -> Floats:
        """How far the pairs are apart where nothing is stretched; infinite where it is more than the gap."""
        import shapely

        at_rest = np.full(len(self.one), np.inf)
        for k in np.flatnonzero(self._near(self.step, self.gap)).tolist():
            at_rest[k] = shapely.distance(
                self.shapes[self.one[k]], *_moved(self.shapes[self.two[k]], self.step[k : k + 1])
            )
        return at_rest

    def first_clear(self, p: Floats, q: Complexes, rough: _Neighbourhood) -> int | None:
        """The first of some stretches that parts all pairs; None where none does. It parts those of `rough`, too."""
        # What is nearer than the gap has to move by what is missing, whatever the direction.
        close = np.flatnonzero(self.at_rest < self.gap)
        enough = np.abs(_moves(p, q, self.apart[close])) >= self.gap - self.at_rest[close]
        likely = np.flatnonzero(enough.all(axis=1))
        for first in range(0, len(likely), _AT_ONCE):
            some = likely[first : first + _AT_ONCE]
            some = some[rough.clear(p[some], q[some], rough.everything)]
            clear = np.flatnonzero(self.clear(p[some], q[some], self.everything))
            if len(clear):
                return int(some[clear[0]])
        return None

    def fitted(self, p: float, q: complex) -> Stretch:
        """The least stretch of a kind that parts all pairs, near one that nearly does."""

        def clear(part: float) -> bool:
            """Whether one that moves everything by so much of it does."""
            return bool(self.clear(np.array([1 + part * (p - 1)]), np.array([part * q]), pairs)[0])

        pairs = self.everything
        high = 1.0
        while not clear(high):
            high *= 1 + (_GROWTH - 1) / 10
        low = 1 / _GROWTH
        # No pair comes nearer by more than it is moved.
        moves = _moves(np.array([p]), np.array([q]), self.apart)[0]
        pairs = self._nearer(self.step + high * moves, self.gap + (high - low) * np.abs(moves))
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            low, high = (low, middle) if clear(middle) else (middle, high)
        return Stretch(1 + high * (p - 1), high * q)

    def clear(self, p: Floats, q: Complexes, among: Ints) -> Bools:
        """Which of some stretches leave all pairs of these the gap apart."""
        import shapely

        shift = self.step + _moves(p, q, self.apart)
        near = self._near(shift, self.gap)
        clear = np.ones(len(shift), np.bool_)
        pairs = among[near[:, among].any(axis=0)]
        # What was too near most often is likely to be so again.
        for k in pairs[np.argsort(-self.failures[pairs], kind="stable")].tolist():
            left = np.flatnonzero(clear & near[:, k])
            if len(left):
                moved = _moved(self.shapes[self.two[k]], shift[left, k])
                close = shapely.dwithin(self.shapes[self.one[k]], moved, self.gap)
                clear[left[close]] = False
                self.failures[k] += np.count_nonzero(close)
        return clear

    def _nearer(self, shift: Complexes, reach: Floats) -> Ints:
        """The pairs that are nearer than a reach each, the second tiles moved by their `shift`."""
        import shapely

        near = np.flatnonzero(self._near(shift, reach))
        moved = [_moved(self.shapes[self.two[k]], shift[k : k + 1])[0] for k in near.tolist()]
        close: Bools = shapely.dwithin(self.shapes[self.one[near]], moved, reach[near])
        return near[close]

    def _near(self, shift: Complexes, reach: Floats | float) -> Bools:
        """Whether the boxes of pairs come within a reach, the second tiles moved by their `shift`."""
        here, there = self.boxes[self.one], self.boxes[self.two]
        x, y = shift.real, shift.imag
        free = np.maximum(there[:, 0] + x - here[:, 2], here[:, 0] - there[:, 2] - x)
        return np.maximum(free, np.maximum(there[:, 1] + y - here[:, 3], here[:, 1] - there[:, 3] - y)) < reach


def _moves(p: Floats, q: Complexes, points: Complexes) -> Complexes:
    """How far each of n stretches moves each of m points, (n, m)."""
    return np.asarray((p - 1)[:, None] * points + q[:, None] * points.conj())


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


def _moved(shape: Any, shifts: Complexes) -> Any:
    """The images of a shape, each moved by another vector."""
    import shapely

    places = shapely.get_coordinates(shape) + plane(shifts)[:, None]
    return shapely.set_coordinates(np.full(len(shifts), shape), places.reshape(-1, 2))


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

"""Pulling tiles apart: how much a layout has to be spread so that all contours keep a distance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes
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

_FARTHEST: Final = 64.0
"""Largest stretch that is tried; a factor."""

_COARSE: Final = 0.02
"""How far the contours by which stretches are chosen may lie from the true ones; a share of the gap."""

_BISECTIONS: Final = 40


@dataclass(frozen=True, slots=True)
class Stretch:
    """A symmetric linear map of the plane, z -> `p` z + `q` conj(z): it stretches along one line, and across it."""

    p: float
    q: complex

    @classmethod
    def along(cls, direction: float, along: float, across: float) -> Stretch:
        """Stretch by 1 + `along` in a direction (radians), and by 1 + `across` at right angles to it."""
        return cls(1.0 + (along + across) / 2, (along - across) / 2 * complex(np.exp(2j * direction)))

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
    are tried, each with the least size that parts all tiles, in steps of a tenth. Raises ValueError for tiles that
    none of them parts: those in a hole of another.
    """
    import shapely

    shapes = np.array([_shape(contour) for contour in contours])
    if _Neighbourhood(shapes, centres, basis, gap).clear(UNSTRETCHED):
        return UNSTRETCHED
    coarse = _Neighbourhood(shapely.simplify(shapes, _COARSE * gap), centres, basis, gap)
    best: tuple[float, float, float, float] | None = None
    for ratio in _RATIOS:
        for direction in np.pi * np.arange(_DIRECTIONS if ratio < 1.0 else 1) / _DIRECTIONS:
            size = coarse.least(float(direction), ratio, np.inf if best is None else best[0])
            if size is not None:
                best = ((1 + size) * (1 + ratio * size), float(direction), ratio, size)
    if best is None:
        raise ValueError("a tile lies within another, and cannot be pulled out")
    _, direction, ratio, size = best
    return _Neighbourhood(shapes, centres, basis, gap).fitted(direction, ratio, size)


class _Neighbourhood:
    """The tiles of a layout that is stretched: which of them are nearer than the gap."""

    def __init__(self, shapes: Any, centres: Complexes, basis: Complexes, gap: float) -> None:
        self.shapes = shapes
        self.gap = gap
        self.boxes = np.array([shape.bounds for shape in shapes])
        across = np.hypot(self.boxes[:, 2] - self.boxes[:, 0], self.boxes[:, 3] - self.boxes[:, 1])
        self.extent = float(across.max())
        pairs = _pairs(self.boxes, basis, 2 * self.extent + gap)
        self.one = np.array([one for one, _, _ in pairs])
        self.two = np.array([two for _, two, _ in pairs])
        self.step = np.array([step for _, _, step in pairs])
        self.apart = centres[self.two] + self.step - centres[self.one]
        self.last = 0

    def clear(self, stretch: Stretch) -> bool:
        """Whether all contours are the gap apart."""
        import shapely
        import shapely.affinity

        shift = self.step + stretch(self.apart) - self.apart
        here, there = self.boxes[self.one], self.boxes[self.two]
        x, y = shift.real, shift.imag
        free = np.maximum(there[:, 0] + x - here[:, 2], here[:, 0] - there[:, 2] - x)
        free = np.maximum(free, np.maximum(there[:, 1] + y - here[:, 3], here[:, 1] - there[:, 3] - y))
        near = np.flatnonzero(free < self.gap).tolist()
        # What was too near last time is likely to be so again.
        for k in sorted(near, key=lambda k: k != self.last):
            moved = shapely.affinity.translate(self.shapes[self.two[k]], x[k], y[k])
            if shapely.distance(self.shapes[self.one[k]], moved) < self.gap:
                self.last = k
                return False
        return True

    def least(self, direction: float, ratio: float, room: float) -> float | None:
        """The first size of a stretch, in steps, that parts all tiles in less than this room; None for none."""
        size = _FIRST * self.gap / float(np.abs(self.apart).max())
        while size < _FARTHEST and (1 + size) * (1 + ratio * size) < room:
            if self.clear(Stretch.along(direction, size, ratio * size)):
                return size
            size *= _GROWTH
        return None

    def fitted(self, direction: float, ratio: float, size: float) -> Stretch:
        """The least stretch of a kind that parts all tiles, near a size that nearly does."""
        high = size
        while not self.clear(Stretch.along(direction, high, ratio * high)):
            high *= 1 + (_GROWTH - 1) / 10
        low = size / _GROWTH
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            if self.clear(Stretch.along(direction, middle, ratio * middle)):
                high = middle
            else:
                low = middle
        return Stretch.along(direction, high, ratio * high)


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

    rings = [
        shapely.LinearRing(np.column_stack((points.real, points.imag)))
        for points in np.split(contour.start, contour.offsets[1:-1])
    ]
    return shapely.build_area(shapely.GeometryCollection(rings)) if len(rings) > 1 else shapely.Polygon(rings[0])


def _pairs(
    boxes: np.ndarray[tuple[int, int], np.dtype[np.float64]], basis: Complexes, reach: float
) -> list[tuple[int, int, complex]]:
    """The pairs of tiles, the second one moved by a lattice vector, whose boxes come within a reach."""
    a, b = basis.tolist()
    det = abs(a.real * b.imag - a.imag * b.real)
    across = float(np.hypot(boxes[:, 2].max() - boxes[:, 0].min(), boxes[:, 3].max() - boxes[:, 1].min())) + reach
    n, m = int(np.ceil(across * abs(b) / det)), int(np.ceil(across * abs(a) / det))
    found = []
    for one in range(len(boxes)):
        for two in range(len(boxes)):
            for i in range(-n, n + 1):
                for j in range(-m, m + 1):
                    if (one, 0, 0) >= (two, i, j):  # each pair once, none with itself
                        continue
                    step = i * a + j * b
                    x0, y0, x1, y1 = boxes[two] + np.array([step.real, step.imag, step.real, step.imag])
                    a0, b0, a1, b1 = boxes[one]
                    if max(x0 - a1, a0 - x1, y0 - b1, b0 - y1) <= reach:
                        found.append((one, two, step))
    return found

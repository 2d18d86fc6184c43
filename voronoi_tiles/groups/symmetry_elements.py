"""The symmetry elements of a wallpaper group: its rotation centres, mirror lines and glide lines, exactly.

They are derived from the group's operations and the lattice translations in fractional coordinates, where everything
is an integer or a fraction; only `placed` steps to Cartesian floating point. Source: International Tables for
Crystallography, vol. A, chapter 1.2 (the geometric meaning of matrix-column pairs).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import product

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup

# By the trace of a matrix of determinant 1.
_ROTATION_ORDERS = {-2: 2, -1: 3, 0: 4, 1: 6}

# How far outside a rectangle counts as on its border, in ulps of its largest coordinate: what rounding leaves of an
# element that is there, such as a mirror on the side of a sheet of whole cells.
_BORDER_ULPS = 64.0

# The sine of an angle that is none: what rounding leaves of 0 in a lattice that was turned.
_PARALLEL = 4.0 * math.ulp(1.0)


@dataclass(frozen=True, slots=True)
class Centre:
    """A centre of rotations by 1/order of a turn: fractional coordinates in [0, 1), and order 2, 3, 4 or 6."""

    x: Fraction
    y: Fraction
    order: int


@dataclass(frozen=True, slots=True)
class Line:
    """A mirror or glide line: all x with q x0 - p x1 = q y0 - p y1, for its `point` y and its `direction` (p, q).

    The direction is the shortest lattice vector p a + q b along the line, with p > 0, or p = 0 and q = 1. The point
    is where the line crosses the axis of a, or where it crosses that of b if it runs along a; its fractional
    coordinates are in [0, 1) and as small as lattice translations make them. `glide` is the translation along the line
    that goes with the reflection, as a fraction of the direction: 0 for mirrors, else in (0, 1).
    """

    point: tuple[Fraction, Fraction]
    direction: tuple[int, int]
    glide: Fraction

    @property
    def offset(self) -> Fraction:
        """The number q x0 - p x1 that all points of the line share; lattice translations change it by integers."""
        (x, y), (p, q) = self.point, self.direction
        return q * x - p * y


@dataclass(frozen=True, slots=True)
class SymmetryElements:
    """The symmetry elements of a group, each once up to the translations of the conventional cell.

    Centred groups thus list their elements with the images under the centring. Centres have their highest order and
    stand by falling order, lines by direction; a mirror is no glide line as well.
    """

    centres: tuple[Centre, ...]
    mirrors: tuple[Line, ...]
    glides: tuple[Line, ...]


@dataclass(frozen=True, eq=False)
class PlacedElements:
    """Symmetry elements in a rectangle, in Cartesian coordinates.

    `centres` is complex128 of shape (n,) and `orders` are their orders; `mirrors` and `glides` are the ends of the
    lines' pieces in the rectangle, complex128 of shape (n, 2).
    """

    centres: Complexes
    orders: Ints
    mirrors: Complexes
    glides: Complexes


@cache
def symmetry_elements(group: WallpaperGroup) -> SymmetryElements:
    """The rotation centres, mirror lines and glide lines of a group."""
    orders: dict[tuple[Fraction, Fraction], int] = {}
    lines: dict[tuple[tuple[int, int], tuple[Fraction, Fraction]], Fraction] = {}
    for operation in group.operations:
        if operation.determinant == -1:
            # Of q i - p j only the parity matters, and (1, 0) or (0, 1) makes it odd: p and q have no common divisor.
            for i, j in product(range(2), repeat=2):
                line = _line(operation.translated(i, j))
                key = line.direction, line.point
                # The glides of one line differ by translations of the group: where one of them is 0, all are.
                lines[key] = min(line.glide, lines.get(key, line.glide))
        elif operation.linear != (1, 0, 0, 1):
            for centre, order in _centres(operation):
                orders[centre] = max(order, orders.get(centre, order))
    centres = sorted((Centre(x, y, order) for (x, y), order in orders.items()), key=lambda c: (-c.order, c.x, c.y))
    found = [Line(point, direction, glide) for (direction, point), glide in sorted(lines.items())]
    return SymmetryElements(
        tuple(centres), tuple(line for line in found if not line.glide), tuple(line for line in found if line.glide)
    )


def _centres(operation: Operation) -> list[tuple[tuple[Fraction, Fraction], int]]:
    """The fixed points, in [0, 1), of a rotation and its products with lattice translations, and the rotation's order.

    They solve (I - W) x = t + n for integer n. There are det(I - W) of them, 1 to 4, and as this number times any
    integer vector is in the image of I - W, smaller n give them all.
    """
    a, b, c, d = operation.linear
    s, t = operation.translation
    det = 2 - a - d
    points = {
        (((1 - d) * (s + i) + b * (t + j)) / det % 1, (c * (s + i) + (1 - a) * (t + j)) / det % 1)
        for i, j in product(range(det), repeat=2)
    }
    return [(point, _ROTATION_ORDERS[a + d]) for point in points]


def _line(operation: Operation) -> Line:
    """The line of a reflection or glide reflection (W|t).

    Its direction is W's eigenvector of eigenvalue 1, which I + W maps all vectors to; the glide is the part (t + W t)/2
    of t along it; the rest of t moves the line by its half.
    """
    a, b, c, d = operation.linear
    s, t = operation.translation
    p, q = (1 + a, c) if a != -1 or c else (b, 1 + d)
    common = math.gcd(p, q) * (1 if (p, q) > (0, 0) else -1)
    p, q = p // common, q // common
    along = (s + a * s + b * t) / (2 * p) if p else (t + c * s + d * t) / (2 * q)
    offset = (q * s - p * t) / 2
    point = (offset / q % Fraction(1, abs(q)), Fraction(0)) if q else (Fraction(0), -offset % 1)
    return Line(point, (p, q), along % 1)


def placed(
    elements: SymmetryElements, lattice: Lattice, rectangle: tuple[float, float, float, float]
) -> PlacedElements:
    """All images of symmetry elements under the lattice in a rectangle (x0, y0, x1, y1) with sides along the axes.

    Coordinates are Cartesian, in the units of the lattice; what lies on the border belongs to the rectangle. The number
    of elements grows with the number of cells. Raises ValueError where x0 < x1, y0 < y1 does not hold or a number is
    not finite.
    """
    x0, y0, x1, y1 = rectangle
    if not (all(map(math.isfinite, rectangle)) and x0 < x1 and y0 < y1):
        raise ValueError(f"not a rectangle (x0, y0, x1, y1): {rectangle}")
    frame = _ShownWindow(x0, y0, x1, y1)
    points = [images_in(lattice.cartesian(centre.x, centre.y), lattice, rectangle) for centre in elements.centres]
    orders = np.repeat([centre.order for centre in elements.centres], [len(part) for part in points])
    return PlacedElements(
        np.concatenate([np.empty(0, np.complex128), *points]),
        orders.astype(np.intp),
        _placed_lines(elements.mirrors, lattice, frame),
        _placed_lines(elements.glides, lattice, frame),
    )


@dataclass(frozen=True, slots=True)
class _ShownWindow:
    """A rectangle with sides along the axes."""

    x0: float
    y0: float
    x1: float
    y1: float

    @property
    def margin(self) -> float:
        """The length that counts as nothing."""
        return _BORDER_ULPS * math.ulp(max(map(abs, (self.x0, self.y0, self.x1, self.y1))))

    def across(self, direction: complex) -> tuple[float, float]:
        """The least and the greatest cross product of `direction` with a point of the rectangle."""
        ys = [direction.real * y for y in (self.y0, self.y1)]
        xs = [direction.imag * x for x in (self.x0, self.x1)]
        slack = self.margin * abs(direction)
        return min(ys) - max(xs) - slack, max(ys) - min(xs) + slack

    def clip(self, points: Complexes, direction: complex, slack: float = 0.0) -> tuple[Floats, Floats]:
        """The range of s in which points + s direction is at most `slack` outside; first > last where it never is.

        What runs along a side may be outside by the margin.
        """
        first, last = np.full(len(points), -np.inf), np.full(len(points), np.inf)
        for start, step, low, high in (
            (points.real, direction.real, self.x0, self.x1),
            (points.imag, direction.imag, self.y0, self.y1),
        ):
            if abs(step) <= _PARALLEL * abs(direction):
                last[(start < low - self.margin) | (start > high + self.margin)] = -np.inf
            else:
                ends = np.stack(((low - slack - start) / step, (high + slack - start) / step))
                first, last = np.maximum(first, ends.min(axis=0)), np.minimum(last, ends.max(axis=0))
        return first, last

    def clamp(self, points: Complexes) -> Complexes:
        """The points, with what rounding put outside the rectangle back on its border."""
        inside = np.empty(points.shape, dtype=np.complex128)
        inside.real = np.clip(points.real, self.x0, self.x1)
        inside.imag = np.clip(points.imag, self.y0, self.y1)
        return inside


def images_in(point: complex, lattice: Lattice, rectangle: tuple[float, float, float, float]) -> Complexes:
    """The images of a point under the lattice in a rectangle (x0, y0, x1, y1), clamped to it: complex128 (n,).

    They stand in rows along the shorter vector of the reduced basis, so that few rows have none.
    """
    frame = _ShownWindow(*rectangle)
    u, v = lattice.reduced_basis
    low, high = frame.across(u)
    own, step = u.real * point.imag - u.imag * point.real, u.real * v.imag - u.imag * v.real
    rows = np.arange(math.ceil((low - own) / step), math.floor((high - own) / step) + 1)
    starts = np.asarray(point + rows * v, dtype=np.complex128)
    first, last = frame.clip(starts, u, frame.margin)
    first, last = np.ceil(first), np.floor(last)
    hit = first <= last
    starts, first, counts = starts[hit], first[hit], (last - first)[hit].astype(np.intp) + 1
    within, row = counting(counts)
    return frame.clamp(starts[row] + (first[row] + within) * u)


def _placed_lines(lines: tuple[Line, ...], lattice: Lattice, frame: _ShownWindow) -> Complexes:
    """The pieces of lines and their images under the lattice in a rectangle: complex128 of shape (n, 2)."""
    a, b = lattice.a, lattice.b
    pieces = [np.empty((0, 2), np.complex128)]
    for line in lines:
        (p, q), (x, y) = line.direction, map(float, line.point)
        along = p * a + q * b
        # The cross product of `along` with the points of a line is -det times its offset.
        low, high = frame.across(along)
        own = float(line.offset)
        k = np.arange(math.ceil(-high / lattice.det - own), math.floor(-low / lattice.det - own) + 1)
        # The translation by i a + j b adds q i - p j = 1 to the offset.
        i = pow(q, -1, p) if p else 1
        j = (q * i - 1) // p if p else 0
        s, t = x + k * i, y + k * j
        starts = (s * a.real + t * b.real) + 1j * (s * a.imag + t * b.imag)
        first, last = frame.clip(starts, along)
        hit = (last - first) * abs(along) > 4.0 * frame.margin  # a line that touches a corner has no length
        ends = starts[hit, None] + np.stack((first[hit], last[hit]), axis=1) * along
        pieces.append(frame.clamp(ends))
    return np.concatenate(pieces)

"""Collects the pieces of many shapes, as they are read, and gives them as Paths, all mapped at once."""

from __future__ import annotations

import cmath
import math
from array import array
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.maps import Affine
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.formats.shapes import CURVE_ACCURACY, PIECES_MAX, DrawingError
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

_TINY: Final = 1e-100
"""Coordinates that are smaller are 0, so that squares and quotients of lengths stay numbers; millimetres."""


class Pen:
    """Draws shapes: `begin` with the map of its coordinates, then lines and curves; `shapes` gives them all.

    Pieces are given in the shape's own coordinates. Pieces of no length are left out; an arc's or curve's end that
    is its beginning is none. Raises DrawingError when there are more than PIECES_MAX pieces or when numbers are beyond
    COORDINATE_MAX.
    """

    def __init__(self) -> None:
        self._numbers = array("d")
        self._kinds = bytearray()
        self._paths = array("q")  # where each path begins
        self._closed = bytearray()
        self._shapes = array("q")  # the first path of each shape
        self._maps: list[Affine] = []
        self._map = Affine(1 + 0j, 0j, 0j)
        self.here = self.origin = 0j
        self._open = False

    def begin(self, to_page: Affine) -> None:
        """Start a shape."""
        self._finish_path()
        self._shapes.append(len(self._paths))
        self._maps.append(to_page)
        self._map = to_page
        self.here = self.origin = 0j

    def cancel(self) -> None:
        """Drop the shape that was begun, where nothing was drawn."""
        self._shapes.pop()
        self._maps.pop()

    @property
    def has_drawn(self) -> bool:
        """Whether the shape that was begun has a piece."""
        return len(self._paths) > self._shapes[-1]

    def move(self, point: complex) -> None:
        """Start a path."""
        self._finish_path()
        self.here = self.origin = point

    def line(self, end: complex) -> None:
        """Draw a line."""
        if end != self.here:
            self._piece(LINE, 0j, 0j, end)

    def quad(self, control: complex, end: complex) -> None:
        """Draw a quadratic Bezier curve."""
        if not self.here == control == end:
            self._piece(QUAD, control, 0j, end)

    def cubic(self, first: complex, second: complex, end: complex) -> None:
        """Draw a cubic Bezier curve."""
        if not self.here == first == second == end:
            self._piece(CUBIC, first, second, end)

    def ellipse(self, centre: complex, to_ellipse: Affine, begin: float, turn: float, end: complex) -> None:
        """Draw an arc of the image of the unit circle under the linear part of `to_ellipse`, about `centre`.

        It begins at the angle `begin` of the unit circle, turns by `turn` (radians, > 0 from x to y) and ends at
        `end`, which is taken as it is. Where the arc is a circle on the page it is drawn as ARCs of at most half a
        circle, else as cubics within CURVE_ACCURACY on the page.
        """
        linear = Affine(to_ellipse.a, to_ellipse.b, 0j)
        on_page = self._map @ linear
        if on_page.is_similar:
            count = max(1, math.ceil(abs(turn) / math.pi - 1e-9))
        else:
            # Goldapp 1991: handles 4/3 tan(t/4) stay within 4/27 sin(t/4)^6 / cos(t/4)^2 of a unit arc of angle t.
            share = max(CURVE_ACCURACY / on_page.largest, 1e-15)
            step = min(math.pi / 2, 4.0 * (share * 27.0 / 4.0 * math.cos(math.pi / 8) ** 2) ** (1.0 / 6.0))
            count = math.ceil(abs(turn) / step)
        step = turn / count
        handle = 4.0 / 3.0 * math.tan(step / 4)
        for k in range(count):
            first, last = begin + k * step, begin + (k + 1) * step
            to = end if k == count - 1 else centre + linear(cmath.rect(1.0, last))
            if on_page.is_similar:
                if to != self.here:
                    self._piece(ARC, centre + linear(cmath.rect(1.0, (first + last) / 2)), 0j, to)
            else:
                out = self.here + linear(cmath.rect(handle, first + math.pi / 2))
                back = to - linear(cmath.rect(handle, last + math.pi / 2))
                self.cubic(out, back, to)

    def arc(self, middle: complex, end: complex) -> None:
        """Draw a circular arc over its middle; only where the map is similar."""
        if end != self.here:
            self._piece(ARC, middle, 0j, end)

    def close(self) -> None:
        """Join the path's end with its beginning."""
        if self._open:
            self._snap()
            self.line(self.origin)
            self._closed[-1] = 1
            self._open = False
        self.here = self.origin

    def shapes(self) -> list[Paths]:
        """The paths of every shape that was begun, on the page."""
        self._finish_path()
        points = np.frombuffer(self._numbers, np.float64).reshape(-1, 8)
        kind = np.frombuffer(bytes(self._kinds), np.uint8)
        offsets = np.append(np.frombuffer(self._paths, np.int64), len(kind)).astype(np.intp)
        firsts = np.append(np.frombuffer(self._shapes, np.int64), len(self._paths)).astype(np.intp)
        maps = np.array(self._maps, np.complex128).reshape(-1, 3)
        counts = np.diff(offsets[firsts])
        image = _mapped(points, np.repeat(maps, counts, axis=0))
        image[1, kind == LINE] = 0
        image[2, (kind != CUBIC)] = 0
        if image.size and not (
            np.abs(image.real).max() <= COORDINATE_MAX and np.abs(image.imag).max() <= COORDINATE_MAX
        ):
            raise beyond()
        closed = np.frombuffer(bytes(self._closed), np.uint8).astype(np.bool_)
        start, end, control = image[0], image[3], np.ascontiguousarray(image[1:3].T)
        result = []
        for k in range(len(firsts) - 1):
            low, high = firsts[k], firsts[k + 1]
            first, last = offsets[low], offsets[high]
            result.append(
                Paths(
                    start=start[first:last],
                    end=end[first:last],
                    control=control[first:last],
                    kind=kind[first:last],
                    offsets=offsets[low : high + 1] - first,
                    closed=closed[low:high],
                )
            )
        return result

    def _piece(self, kind: int, first: complex, second: complex, end: complex) -> None:
        """Add a piece to the path, which begins with it if need be."""
        if not self._open:
            self._paths.append(len(self._kinds))
            self._closed.append(0)
            self._open = True
        if len(self._kinds) >= PIECES_MAX:
            raise DrawingError(
                f"more than {PIECES_MAX:,} lines and curves", remedy="Split the drawing, or simplify its curves."
            )
        here = self.here
        self._numbers.extend(
            (here.real, here.imag, first.real, first.imag, second.real, second.imag, end.real, end.imag)
        )
        self._kinds.append(kind)
        self.here = end

    def _snap(self) -> None:
        """Let the path end where it began, where sums of rounded numbers have missed that by less than the accuracy."""
        begun_at, ended_at = complex(*self._numbers[-8:-6]), self.origin
        if abs(self.here - ended_at) * self._map.largest <= CURVE_ACCURACY and begun_at != ended_at:
            self._numbers[-2], self._numbers[-1] = ended_at.real, ended_at.imag
            self.here = ended_at

    def _finish_path(self) -> None:
        self._open = False


def beyond() -> DrawingError:
    """The error for numbers that are too large, or none."""
    return DrawingError(
        f"a coordinate is beyond {COORDINATE_MAX:g} mm, or is no number",
        remedy="Draw in units that keep the numbers small.",
    )


def _mapped(points: NDArray[np.float64], maps: Complexes) -> Complexes:
    """The images of four points of each piece; shape (4, n).

    In real numbers spelt out, so that a point has the same bits wherever it stands in an array.
    """
    a, b, c = maps.T
    xx, xy = a.real + b.real, b.imag - a.imag
    yx, yy = a.imag + b.imag, a.real - b.real
    image = np.empty((4, len(points)), np.complex128)
    for k in range(4):
        x, y = points[:, 2 * k], points[:, 2 * k + 1]
        with np.errstate(over="ignore", invalid="ignore"):
            image[k].real = xx * x + xy * y + c.real
            image[k].imag = yx * x + yy * y + c.imag
    parts = image.view(np.float64)
    parts[np.abs(parts) < _TINY] = 0.0
    return image

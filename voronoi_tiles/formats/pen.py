"""Pens: they collect the curves of paths as they are read, and give them as arrays, all at once."""

from __future__ import annotations

import math
from array import array
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, offsets_of
from voronoi_tiles.base.maps import Affine
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.formats.shapes import CURVE_ACCURACY, SEGMENTS_MAX, DrawingError
from voronoi_tiles.paths.ellipses import EllipticalArc
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Kinds, Paths

MOVE: Final = 4
CLOSE: Final = 5
"""What begins and what closes a path, beside the kinds of its curves."""

POINTS: Final = np.zeros(6, np.intp)
POINTS[[LINE, QUAD, CUBIC, ARC, MOVE, CLOSE]] = [1, 2, 3, 2, 1, 0]
"""The points that each of them has after its beginning: control points, of an ARC its middle, and the end."""

_TINY: Final = 1e-100
"""Coordinates that are smaller are 0, so that squares and quotients of lengths stay numbers; millimetres."""


class DrawnCurves(NamedTuple):
    """DrawnCurves as they were drawn, those of a path one after the other.

    `start` and `end` are complex128 (n,), `control` (2, n), its rows the end where a curve has no such point; `kind`
    (uint8, n) is that of Paths. `path` (intp, n) is the number of each curve's path, and `closed` (bool, paths) tells
    which paths return to their beginning. A path may have no curve.
    """

    start: Complexes
    end: Complexes
    control: Complexes
    kind: Kinds
    path: Ints
    closed: Bools

    def take(self, which: Bools) -> DrawnCurves:
        """Some of the curves."""
        return self._replace(
            start=self.start[which],
            end=self.end[which],
            control=self.control[:, which],
            kind=self.kind[which],
            path=self.path[which],
        )


class PathPen:
    """Draws paths in coordinates of their own, the first one from 0 on; arcs of ellipses as cubics within `accuracy`.

    After a path is closed, the next one begins where it did. Raises DrawingError when there are more than SEGMENTS_MAX
    lines and curves.
    """

    def __init__(self, accuracy: float) -> None:
        self._accuracy = accuracy
        self._kinds = bytearray((MOVE,))
        self._numbers = array("d", (0.0, 0.0))
        self._left = SEGMENTS_MAX
        self.here = self.origin = 0j

    def move(self, point: complex) -> None:
        """Start a path."""
        self._kinds.append(MOVE)
        self._numbers.extend((point.real, point.imag))
        self.here = self.origin = point

    def draw(self, kind: int, values: list[float]) -> None:
        """Draw curves of one kind: x and y of all their points after the beginning, see POINTS."""
        count = len(values) // (2 * int(POINTS[kind]))
        self._take_in(count)
        self._kinds += bytes((kind,)) * count
        self._numbers.extend(values)
        self.here = complex(values[-2], values[-1])

    def draw_paths(self, kinds: Kinds, values: Floats) -> None:
        """Draw whole paths, MOVE being the first of their kinds: x and y of all points, in their order."""
        self._take_in(int(np.count_nonzero(kinds < MOVE)))
        self._kinds += kinds.tobytes()
        self._numbers.frombytes(values.tobytes())

    def line(self, end: complex) -> None:
        """Draw a line."""
        self.curve(LINE, end)

    def dot(self, place: complex) -> None:
        """Draw a line of no length, for what has no size: browsers do not draw it, but cutters may."""
        self.move(place)
        self.line(place)

    def curve(self, kind: int, *points: complex) -> None:
        """Draw one curve by its points."""
        self.draw(kind, [part for point in points for part in (point.real, point.imag)])

    def elliptical(self, arc: EllipticalArc) -> None:
        """Draw an arc of an ellipse."""
        for curve in arc.cubics(arc.cubic_count(self._accuracy / arc.ellipse.largest)):
            self.curve(CUBIC, *curve)

    def close(self) -> None:
        """Join the path's end with its beginning, by a line if need be."""
        self._kinds.append(CLOSE)
        self.here = self.origin

    def curves(self) -> DrawnCurves:
        """All that was drawn and has a length; a circular arc whose end is its beginning has none."""
        points = np.frombuffer(self._numbers).view(np.complex128)
        kind = np.frombuffer(self._kinds, np.uint8)
        size = POINTS[kind]
        after = np.cumsum(size)
        end = points[after - 1]
        is_move, is_close = kind == MOVE, kind == CLOSE
        begun = np.maximum.accumulate(np.where(is_move, np.arange(len(kind)), 0))
        end[is_close] = end[begun[is_close]]
        start = np.roll(end, 1)
        control = np.stack((end, end))
        for row, before in ((0, size), (1, 2)):
            bent = np.flatnonzero(size > row + 1)
            control[row, bent] = points[(after - before)[bent]]
        long = (start != end) | ((kind != ARC) & (control != end).any(axis=0))
        path = self._path_numbers()
        closed = np.zeros(path[-1] + 1, np.bool_)
        closed[path[is_close]] = True
        kind = np.where(is_close, LINE, kind).astype(np.uint8)
        return DrawnCurves(start, end, control, kind, path, closed).take(long & ~is_move)

    def dots(self, curves: DrawnCurves) -> tuple[Ints, Complexes]:
        """The paths that were moved to and drawn, but have none of the `curves`, and their places."""
        kind = np.frombuffer(self._kinds, np.uint8)
        path = self._path_numbers()
        moves = np.flatnonzero(kind == MOVE)
        paths = len(curves.closed)
        drawn = np.bincount(path[kind != MOVE], minlength=paths) > 0
        has_length = np.bincount(curves.path, minlength=paths) > 0
        moves = moves[(drawn & ~has_length)[path[moves]]]
        points = np.frombuffer(self._numbers).view(np.complex128)
        return path[moves], points[np.cumsum(POINTS[kind])[moves] - 1]

    def _path_numbers(self) -> Ints:
        """The path of each move, curve and closing."""
        kind = np.frombuffer(self._kinds, np.uint8)
        return np.cumsum((kind == MOVE) | (np.roll(kind, 1) == CLOSE)) - 1

    def _take_in(self, count: int) -> None:
        """Refuse too many curves."""
        self._left -= count
        if self._left < 0:
            raise DrawingError(
                f"more than {SEGMENTS_MAX:,} lines and curves", remedy="Split the drawing, or simplify its curves."
            )


class Pen(PathPen):
    """Draws shapes on a page: `begin` with the map of its coordinates, then its paths; `shapes` are them all.

    Raises DrawingError also when numbers are beyond COORDINATE_MAX on the page.
    """

    def __init__(self) -> None:
        super().__init__(CURVE_ACCURACY)
        self._shapes: list[int] = []  # where each begins among all moves, curves and closings
        self._maps: list[Affine] = []

    def begin(self, to_page: Affine) -> None:
        """Start a shape."""
        self._shapes.append(len(self._kinds))
        self._maps.append(to_page)
        self.move(0j)

    def cancel(self) -> None:
        """Drop the shape that was begun, where nothing was drawn."""
        self._shapes.pop()
        self._maps.pop()

    def elliptical(self, arc: EllipticalArc) -> None:
        """Draw an arc of an ellipse.

        Where it is circular on the page it is drawn as ARCs of at most half a circle, else as cubics within
        CURVE_ACCURACY on the page.
        """
        on_page = self._maps[-1] @ arc.ellipse
        if not on_page.is_similar:
            for curve in arc.cubics(arc.cubic_count(CURVE_ACCURACY / on_page.largest)):
                self.curve(CUBIC, *curve)
            return
        count = max(1, math.ceil(2.0 * arc.half / math.pi - 1e-9))
        for k in range(count):
            middle, last = (arc.half * (n - count) / count for n in (2 * k + 1, 2 * k + 2))
            self.curve(ARC, arc.point(middle), arc.end if k == count - 1 else arc.point(last))

    def shapes(self) -> list[tuple[Paths, Complexes]]:
        """What was drawn of every shape that was begun, on the page: its paths, and the places of those of no length.

        A path that is only moved to is none. Raises DrawingError also for more than SEGMENTS_MAX places.
        """
        if not self._maps:
            return []
        curves = self.curves()
        paths = len(curves.closed)
        # Whatever was drawn before the first shape has no curves.
        shape = np.searchsorted(self._path_numbers()[self._shapes], np.arange(paths), side="right") - 1
        all_maps = np.array(self._maps, np.complex128)
        maps = all_maps[shape]
        curves = _without_closing(curves, np.abs(maps[:, 0]) + np.abs(maps[:, 1]))
        image = _mapped(np.stack((curves.start, curves.end, *curves.control)), maps[curves.path])
        image[2, curves.kind == LINE] = image[3, curves.kind != CUBIC] = 0.0
        counts = np.bincount(curves.path, minlength=paths)
        drawn = counts > 0
        offsets = offsets_of(counts[drawn])
        everything = Paths(
            start=image[0],
            end=image[1],
            control=np.ascontiguousarray(image[2:].T),
            kind=curves.kind,
            offsets=offsets,
            closed=curves.closed[drawn],
        )
        bounds = offsets_of(np.bincount(shape[drawn], minlength=len(self._maps)))
        path, at = self.dots(curves)
        if len(path) > SEGMENTS_MAX:
            raise DrawingError(f"more than {SEGMENTS_MAX:,} lines of no length", remedy="Remove them.")
        places = _mapped(at[None], maps[path])[0]
        ends = offsets_of(np.bincount(shape[path], minlength=len(self._maps)))
        return [
            (everything.part(low, high), places[first:last])
            for (low, high), (first, last) in zip(pairwise(bounds.tolist()), pairwise(ends.tolist()), strict=True)
        ]


def _without_closing(curves: DrawnCurves, growth: Floats) -> DrawnCurves:
    """Leave out lines that only close a path where sums of rounded numbers have missed its beginning.

    `growth` is by how much each path grows on the page, where such a line is no longer than CURVE_ACCURACY. What comes
    before it ends at the beginning instead.
    """
    last = np.flatnonzero(curves.path != np.append(curves.path[1:], -1))
    length = np.abs(curves.end - curves.start)[last] * growth[curves.path[last]]
    last = last[curves.closed[curves.path[last]] & (curves.kind[last] == LINE) & (length <= CURVE_ACCURACY)]
    # The curve before is of the same path, and must not become one that goes nowhere.
    before = last - 1
    some = (last > 0) & (curves.path[before] == curves.path[last]) & (curves.start[before] != curves.end[last])
    curves.end[before[some]] = curves.end[last[some]]
    kept = np.ones(len(curves.path), np.bool_)
    kept[last[some]] = False
    return curves.take(kept)


def beyond() -> DrawingError:
    """The error for numbers that are too large, or none."""
    return DrawingError(
        f"a coordinate is beyond {COORDINATE_MAX:g} mm, or is no number",
        remedy="Draw in units that keep the numbers small.",
    )


def _mapped(points: Complexes, maps: Complexes) -> Complexes:
    """The images of points (k, n) under the maps (n, 3) of their curves. Raises DrawingError beyond COORDINATE_MAX.

    In real numbers spelt out, so that a point has the same bits wherever it stands in an array.
    """
    a, b, c = maps.T
    x, y = points.real, points.imag
    image = np.empty_like(points)
    with np.errstate(over="ignore", invalid="ignore"):
        image.real = (a.real + b.real) * x + (b.imag - a.imag) * y + c.real
        image.imag = (a.imag + b.imag) * x + (a.real - b.real) * y + c.imag
    parts = image.view(np.float64)
    parts[np.abs(parts) < _TINY] = 0.0
    if not (np.abs(parts) <= COORDINATE_MAX).all():
        raise beyond()
    return image

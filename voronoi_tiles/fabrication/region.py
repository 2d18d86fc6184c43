"""The region of a sheet that is filled with tiles: closed rings of lines and circular arcs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.box_index import BoxIndex
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.paths.offset import OffsetError, offset
from voronoi_tiles.paths.paths import LINE, Paths
from voronoi_tiles.paths.segments import boxes, corners, point_at, tangent_at
from voronoi_tiles.paths.winding import winding

_CLOSE = 1e-9
"""How near to the border, relative to the region's size, a point lies on it: a nanometre on a sheet of a metre."""

_BESIDE = 10.0
"""How far beside the border, in the distances that count as on it, a place is surely not on it."""


@dataclass(frozen=True, eq=False)
class Region:
    """Closed rings of LINE and ARC pieces: outer ones counter-clockwise, holes clockwise, none crossing another."""

    border: Paths

    @classmethod
    def rectangle(cls, left: float, bottom: float, right: float, top: float) -> Region:
        """An upright rectangle. Raises ValueError where it has no area."""
        if not (left < right and bottom < top):
            raise ValueError("a rectangle needs a width and a height")
        corners = [complex(left, bottom), complex(right, bottom), complex(right, top), complex(left, top)]
        return cls(Paths.polylines([corners], closed=True))

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """The smallest upright rectangle around it: least x, least y, greatest x, greatest y."""
        return self.border.bounds

    @property
    def is_rectangle(self) -> bool:
        """Whether it is an upright rectangle."""
        steps = self.border.end - self.border.start
        return (
            len(self.border) == 1
            and len(steps) == 4
            and bool((self.border.kind == LINE).all())
            and bool(((steps.real == 0) | (steps.imag == 0)).all())
        )

    @property
    def close(self) -> float:
        """How near to the border a point lies on it."""
        left, bottom, right, top = self.bounds
        return _CLOSE * max(right - left, top - bottom)

    def contains(self, points: Complexes) -> Bools:
        """Which points lie inside; of those on the border some count as inside."""
        return winding(self.border, points) > 0

    def meets_border(self, box: Floats, margin: float) -> Bools:
        """Which boxes (n x 4, as `pieces.boxes` gives them) come within a margin of that of a border's piece."""
        grown = corners(box + margin * np.array([-1.0, -1.0, 1.0, 1.0]))
        meets = np.zeros(len(box), np.bool_)
        meets[BoxIndex(*corners(boxes(self.border))).meeting(*grown)[0]] = True
        return meets

    def distance(self, points: Complexes) -> Floats:
        """The distance of points from the border."""
        nearest = np.full(len(points), np.inf)
        for k in range(len(self.border.start)):
            nearest = np.minimum(nearest, np.abs(points - self._feet(k, points)[0]))
        return nearest

    def on_border(self, points: Complexes) -> tuple[Ints, Floats, Complexes]:
        """The nearest place on the border for each point: piece, share of its length, and the place itself."""
        nearest = np.full(len(points), np.inf)
        piece = np.zeros(len(points), np.intp)
        share = np.zeros(len(points))
        place = np.zeros(len(points), np.complex128)
        for k in range(len(self.border.start)):
            foot, along = self._feet(k, points)
            distance = np.abs(points - foot)
            better = distance < nearest
            nearest[better], piece[better] = distance[better], k
            share[better], place[better] = along[better], foot[better]
        return piece, share, place

    def _feet(self, k: int, points: Complexes) -> tuple[Complexes, Floats]:
        """The nearest points of one piece of the border, and their shares of its length."""
        a, b = complex(self.border.start[k]), complex(self.border.end[k])
        if self.border.kind[k] == LINE:
            along = b - a
            share = np.clip(((points - a) * along.conjugate()).real / abs(along) ** 2, 0.0, 1.0)
            foot = np.where(share <= 0.5, a + share * along, b - (1 - share) * along)
            # Along an axis to the bit: the tiles at a sheet's edge shall end on it.
            if along.real == 0.0:
                foot.real = a.real
            if along.imag == 0.0:
                foot.imag = a.imag
            return foot, share
        centre, radius, begin, turn = (part[0] for part in self.border.circles(np.array([k])))
        ahead = np.mod((np.angle(points - centre) - begin) * np.sign(turn), 2 * np.pi)
        size = abs(turn)
        share = np.where(ahead <= size, ahead / size, np.where(ahead - size < (2 * np.pi - size) / 2, 1.0, 0.0))
        foot = centre + radius * np.exp(1j * (begin + share * turn))
        foot[share == 0.0], foot[share == 1.0] = a, b
        return foot, share


def beside_border(border: Paths, pieces: Ints, close: float) -> tuple[Complexes, Complexes]:
    """The places to the left and to the right of the middles of some pieces of a border that are just not on it.

    `close` is how near to the border a point lies on it.
    """
    middle = np.full(len(pieces), 0.5)
    place = point_at(border, pieces, middle)
    aside = 1j * tangent_at(border, pieces, middle) * (_BESIDE * close)
    return place + aside, place - aside


def inset(region: Region, width: float) -> Region:
    """What is left of a region inside a frame of this width. Raises JobError where nothing is."""
    left, bottom, right, top = region.bounds
    if region.is_rectangle and 2 * width < min(right - left, top - bottom):
        return Region.rectangle(left + width, bottom + width, right - width, top - width)
    try:
        border = offset(region.border, -width).paths
    except OffsetError as error:
        raise JobError(
            f"the sheet's outline leaves no frame of {width:g} mm: {error}",
            remedy="Use another `frame`, `fit='whole'` or `fit='clip'`.",
        ) from error
    if not len(border):
        raise JobError(
            f"the sheet is too small for a frame of {width:g} mm",
            remedy="Take a larger sheet, a narrower `frame`, or `fit='whole'`.",
        )
    return Region(border)

"""Where to lay a tessellation so that most whole tiles lie on the sheet."""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.tile_placement import place_tiles
from voronoi_tiles.paths.segments import item_boxes
from voronoi_tiles.vector.complex.period import Period

_PLACES: Final = 48
"""Most places that are tried along each axis of a rectangle; a count."""

_GRID: Final = 8
"""Places that are tried along each side of the cell where the region is no rectangle."""

_AT_ONCE: Final = 1 << 22
"""Pairs of a tile and a place that are looked at in one go."""


def best_shift(period: Period, region: Region) -> complex:
    """The shift, of all that are tried, with which most tiles lie in a region as a whole; the shortest of the best.

    In a rectangle a best place is one where some tile touches the left or right edge and some tile the lower or upper
    one: these are tried, evenly chosen ones where there are too many. In other regions a grid over the cell is tried.
    """
    if not region.is_rectangle:
        return _best_of_grid(period, region)
    box = item_boxes(*period.own_outlines)
    left, bottom, right, top = region.bounds
    # Where a tile's place may be, by its box, for the tile to be whole.
    room = np.column_stack((left - box[:, 0], bottom - box[:, 1], right - box[:, 2], top - box[:, 3]))
    close = region.close
    a, b = (complex(vector) for vector in period.basis)
    reach = abs(a) + abs(b)
    points = [_lattice(period, *(row + np.array([-reach, -reach, reach, reach]))) for row in room]
    xs = _touching([(row[0], row[2]) for row in room], [place.real for place in points], reach / 2)
    ys = _touching([(row[1], row[3]) for row in room], [place.imag for place in points], reach / 2)
    shifts = (xs[:, None] + 1j * ys).ravel()
    counts = np.zeros(len(shifts), np.intp)
    for row, place in zip(room, points, strict=True):
        size = max(1, _AT_ONCE // max(1, len(place)))
        for first in range(0, len(shifts), size):
            here = place + shifts[first : first + size, None]
            inside = (here.real >= row[0] - close) & (here.real <= row[2] + close)
            inside &= (here.imag >= row[1] - close) & (here.imag <= row[3] + close)
            counts[first : first + size] += inside.sum(axis=1)
    best = shifts[counts == counts.max()]
    return complex(best[np.argmin(np.abs(best))])


def _lattice(period: Period, left: float, bottom: float, right: float, top: float) -> Complexes:
    """The lattice points in a rectangle."""
    place = period.shifts(period.steps_in(left, bottom, right, top))
    return place[(place.real >= left) & (place.real <= right) & (place.imag >= bottom) & (place.imag <= top)]


def _touching(edges: list[tuple[float, float]], places: list[Floats], reach: float) -> Floats:
    """The shifts along one axis, up to a reach, with which some tile touches an edge; and no shift."""
    found = [np.zeros(1)]
    for (low, high), place in zip(edges, places, strict=True):
        found += [low - place, high - place]
    shifts = np.unique(np.round(np.concatenate(found), 9))
    shifts = shifts[np.abs(shifts) <= reach]
    if len(shifts) > _PLACES:
        shifts = np.append(shifts[np.linspace(0, len(shifts) - 1, _PLACES).astype(np.intp)], 0.0)
    return np.asarray(shifts, np.float64)


def _best_of_grid(period: Period, region: Region) -> complex:
    """The best shift of a grid over the cell, by placing the tiles."""
    a, b = (complex(vector) for vector in period.basis)
    steps = (np.arange(_GRID) - _GRID // 2) / _GRID
    shifts = sorted((complex(s * a + t * b) for s in steps for t in steps), key=abs)
    counts = [int(place_tiles(period.placed(1.0, shift), region).whole.sum()) for shift in shifts]
    return shifts[int(np.argmax(counts))]

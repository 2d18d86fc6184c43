"""Where to lay a tessellation so that most whole tiles lie on the sheet, and in its middle."""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.tile_placement import group_box, whole_tiles
from voronoi_tiles.vector.complex.period import Period

_PLACES: Final = 48
"""Most places that are tried along each axis of a rectangle; a count."""

_GRID: Final = 8
"""Places that are tried along each side of the cell where the region is no rectangle."""

_ROUGH: Final = 4
"""The same for a rough shift; a divisor of the one above, so that no place is another."""

_AT_ONCE: Final = 1 << 16
"""Tiles whose places are looked at in one go; a count."""

_ROUNDS: Final = 3
"""How often a group of tiles is moved to the middle: there it may have grown, or be free to move on."""

_NEAR_MM: Final = 0.02
"""How near to the place where a tile would be lost a group is moved on its way to the middle; millimetres."""


def best_shift(period: Period, region: Region, *, rough: bool = False) -> complex:
    """The shift, of all that are tried, with which most tiles lie in a region as a whole, in its middle.

    In a rectangle a best place is one where some tile touches the left or right edge and some tile the lower or upper
    one: these are tried, evenly chosen ones where there are too many. In other regions a grid over the cell is tried.
    The shortest of the best shifts, of a grid the one that is best centred, is then changed so that what the tiles
    together leave free on the left and on the right, and below and above, is equal: the boxes of the group and of the
    region have one middle. In a rectangle that can always be; elsewhere the group goes as near to it as it can without
    losing a tile. A `rough` one is not centred, and comes from fewer places of the grid: with the best one there are as
    many tiles, or more.
    """
    if region.is_rectangle:
        found = _best_of_edges(period, region)
    else:
        found = _best_of_grid(period, region, _ROUGH if rough else _GRID)
    return found if rough else _centred(period, region, found)


def _best_of_edges(period: Period, region: Region) -> complex:
    """The shortest of the best shifts in a rectangle."""
    box = period.own_boxes
    left, bottom, right, top = region.bounds
    # Where a tile's place may be, by its box, for the tile to be whole.
    room = np.column_stack((left - box[:, 0], bottom - box[:, 1], right - box[:, 2], top - box[:, 3]))
    close = region.close
    a, b = (complex(vector) for vector in period.basis)
    reach = abs(a) + abs(b)
    points = [_lattice(period, *(row + np.array([-reach, -reach, reach, reach]))) for row in room]
    xs = _touching([(row[0], row[2]) for row in room], [place.real for place in points], reach / 2)
    ys = _touching([(row[1], row[3]) for row in room], [place.imag for place in points], reach / 2)
    shifts = xs[:, None] + 1j * ys
    counts = np.zeros(shifts.shape)
    for row, place in zip(room, points, strict=True):
        for first in range(0, len(place), _AT_ONCE):
            some = place[first : first + _AT_ONCE]
            # Which shifts keep each tile between left and right, and which between below and above: both have to.
            beside = _between(some.real + xs[:, None], row[0] - close, row[2] + close)
            above = _between(some.imag + ys[:, None], row[1] - close, row[3] + close)
            counts += beside @ above.T
    best = shifts[counts == counts.max()]
    return complex(best[np.argmin(np.abs(best))])


def _between(values: Floats, low: float, high: float) -> Floats:
    """1 where values lie in an interval, 0 elsewhere: sums of products of these are exact."""
    return ((values >= low) & (values <= high)).astype(np.float64)


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


def _best_of_grid(period: Period, region: Region, side: int) -> complex:
    """The best shift of a grid over the cell, by placing the tiles; of several the one that is best centred."""
    a, b = (complex(vector) for vector in period.basis)
    steps = (np.arange(side) - side // 2) / side
    shifts = sorted((complex(s * a + t * b) for s in steps for t in steps), key=abs)
    groups = [_group(period, region, shift) for shift in shifts]
    most = max(count for count, _ in groups)
    best = [(abs(off.real) + abs(off.imag), k) for k, (count, off) in enumerate(groups) if count == most]
    return shifts[min(best)[1]]


def _group(period: Period, region: Region, shift: complex) -> tuple[int, complex]:
    """How many whole tiles there are with a shift, and from the middle of their box to that of the region."""
    placement = whole_tiles(period, region, shift)
    tile, step = placement.tile, placement.step
    if not len(tile):
        return 0, 0j
    x0, y0, x1, y1 = group_box(period, tile, period.shifts(step) + shift)
    left, bottom, right, top = region.bounds
    return len(tile), complex(left - x0 + right - x1, bottom - y0 + top - y1) / 2


def _centred(period: Period, region: Region, shift: complex) -> complex:
    """The shift changed so that the whole tiles lie in the middle of the region, as far as they all stay there."""
    count, off = _group(period, region, shift)
    for _ in range(_ROUNDS):
        if abs(off) <= region.close:
            break
        there, rest = _group(period, region, shift + off)
        if there >= count:
            shift += off
            count, off = there, rest
            continue
        before = shift
        for way in (complex(off.real, 0.0), complex(0.0, off.imag)):
            shift += way * _free(period, region, shift, way, count)
        if shift == before:
            break
        count, off = _group(period, region, shift)
    return shift


def _free(period: Period, region: Region, shift: complex, way: complex, count: int) -> float:
    """How much of a way, from 0 to 1, tiles can go together so that as many as before stay whole."""
    if abs(way) <= _NEAR_MM:
        return 0.0
    if _group(period, region, shift + way)[0] >= count:
        return 1.0
    low, high = 0.0, 1.0
    while (high - low) * abs(way) > _NEAR_MM:
        middle = (low + high) / 2
        low, high = (middle, high) if _group(period, region, shift + middle * way)[0] >= count else (low, middle)
    return low

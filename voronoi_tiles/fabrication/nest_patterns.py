"""Pieces in rows that repeat: the densest lattices of a piece, or of a piece and its half turn, laid over a sheet.

Two pieces overlap where the place of one lies in a region about the other, their no-fit polygon. A row is a vector on
its edge, and the next row lies as low above it as the polygons of the row leave room: the densest of many such
lattices, each tried in several directions and places. All of it is repeatable.

Source: J. A. Bennell and J. F. Oliveira, The geometry of nesting problems: a tutorial, 2008; for lattices of a piece
and its half turn, G. Kuperberg and W. Kuperberg, Double-lattice packings of convex bodies in the plane, 1990.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces, ring_area
from voronoi_tiles.fabrication.next_rows import next_rows
from voronoi_tiles.fabrication.no_fit import NoFits

_PAIRS: Final = 72
"""Places of a half turn beside a piece that are tried; a count."""

_FINER: Final = 8
_BEST: Final = 6
"""Beside the best of these places others are tried, at last so many times as close; counts."""

_ROWS: Final = (160, 44)
"""Vectors along a row that are tried for one piece, and for each of a piece and its half turn; counts."""

_LINES: Final = (32, 128)
"""Places along a row at which the next one may begin, first and at last; counts."""

_WORSE: Final = 1.08
"""How much larger than the densest the cells of a lattice may be that is kept; a factor."""

_FULL: Final = 1 - 1e-6
"""A cell with less room than this share of its pieces is none: where there are no gaps it has as much, but for
rounding."""

_KEPT: Final = 100
"""Lattices that are laid on the sheet, the densest ones; a count."""

_GRID: Final = 12
"""Steps of a lattice vector by which it is moved over the sheet; a count."""


class PiecePattern(NamedTuple):
    """Pieces at all sums of multiples of two vectors; and half turns, `half` from each, where there are any."""

    u: complex
    v: complex
    half: complex | None
    density: float

    def image(self, unit: complex, *, conj: bool = False) -> PiecePattern:
        """The same for a piece that is turned by a unit, after it was mirrored in the x axis."""

        def moved(z: complex) -> complex:
            """The image of a vector."""
            return (z.conjugate() if conj else z) * unit

        half = None if self.half is None else moved(self.half)
        return PiecePattern(moved(self.u), moved(self.v), half, self.density)


def piece_patterns(ring: Complexes, no_fits: NoFits | None = None, item: int = 0) -> list[PiecePattern]:
    """The densest lattices that were found for a polygon (complex128, n), and for it and its half turn about 0."""
    return _PatternSearch(ring, no_fits or NoFits([ring]), item).patterns()


class _PatternSearch:
    """The densest lattices of a polygon."""

    def __init__(self, ring: Complexes, no_fits: NoFits, item: int) -> None:
        self._area = ring_area(ring)
        self._own, self._turned = (no_fits.edges(item, 0.0, item, turn) for turn in (0.0, 180.0))
        self._found: list[tuple[float, complex, complex, complex | None]] = []
        self._least = np.inf

    def patterns(self) -> list[PiecePattern]:
        """The densest ones."""
        self._try(self._own, _along(self._own, _ROWS[0]), None, _LINES[0])
        halves = _along(self._turned, _PAIRS * _FINER).tolist()
        known = {k: self._pair(halves[k], 1, _LINES[0]) for k in range(0, len(halves), _FINER)}
        step = _FINER // 2
        while step:
            for best in sorted(known, key=known.__getitem__)[:_BEST]:
                for k in (best - step, best + step):
                    if k % len(halves) not in known:
                        finer = 2 if step < _FINER // 2 else 1
                        known[k % len(halves)] = self._pair(halves[k % len(halves)], finer, _LINES[int(step == 1)])
            step //= 2
        self._found.sort(key=lambda one: one[0])
        return [PiecePattern(u, v, half, self._area / area) for area, u, v, half in self._found[:_KEPT]]

    def _pair(self, half: complex, finer: int, lines: int) -> float:
        """Try a place of the half turn: two such pairs overlap where a piece of one does with a piece of the other."""
        there = self._turned - np.tile([half.real, half.imag], 2)
        back = np.tile([half.real, half.imag], 2) - self._turned
        count = _ROWS[1] * finer
        rows = [_along(edges, count) for edges in (self._own, there, back)]
        return self._try(np.concatenate((self._own, there, back)), np.concatenate(rows), half, lines)

    def _try(self, edges: Floats, rows: Complexes, half: complex | None, lines: int) -> float:
        """Keep the densest lattice for each of some rows, and give the least area that a piece takes in one."""
        each = 1 if half is None else 2
        rows = rows[(rows.imag > 0) | ((rows.imag == 0) & (rows.real > 0))]
        if not len(rows):
            return np.inf
        most = min(_WORSE * self._least * each, 4.0 * self._area * each)
        found = next_rows(edges, rows, _FULL * each * self._area, most, lines)
        rows, found = rows[found != 0], found[found != 0]
        areas = (rows.conj() * found).imag / each
        each_found = zip(areas.tolist(), rows.tolist(), found.tolist(), strict=True)
        self._found += [(area, u, v, half) for area, u, v in each_found]
        least = float(areas.min(initial=np.inf))
        self._least = min(self._least, least)
        return least


def pattern_layouts(
    items: Sequence[NestItem], size: tuple[float, float], no_fits: NoFits, count: int
) -> list[NestPlaces]:
    """Several ways to lay pieces of some kinds on a rectangle from 0 to `size`, those with most pieces first.

    Each is of lattices, a band of the sheet for each kind, as wide as its share; an item that is `like` another lies as
    its image does.
    """
    patterns: list[list[PiecePattern]] = []
    for k, item in enumerate(items):
        if item.like is None:
            patterns.append(piece_patterns(item.ring, no_fits, k))
        else:
            patterns.append([one.image(item.unit, conj=item.mirrored) for one in patterns[item.like]])
    areas = np.array([item.share * ring_area(item.ring) for item in items])
    edges = np.append(0.0, np.cumsum(areas / areas.sum())) * size[1]
    bands = [
        _band(k, item, own, (size[0], low, top), count)
        for k, (item, own, (low, top)) in enumerate(zip(items, patterns, pairwise(edges.tolist()), strict=True))
    ]
    return [NestPlaces.joined(*parts) for parts in zip(*bands, strict=True)]


class _Way(NamedTuple):
    """A pattern turned by a unit: the vectors of its lattice, and where the half turn lies in one cell."""

    unit: complex
    u: complex
    v: complex
    half: complex | None


def _ways(item: NestItem, patterns: Sequence[PiecePattern]) -> Iterator[_Way]:
    """How patterns can lie: as they are, or where pieces are turned freely, with short vectors along a side."""
    for one in patterns:
        units = [1 + 0j]
        if item.turns is None:
            bases = (one.u, one.v, one.u + one.v, one.u - one.v)
            units = [quarter * (base / abs(base)).conjugate() for base in bases for quarter in (1, 1j)]
        for w in units:
            yield _Way(w, one.u * w, one.v * w, None if one.half is None else one.half * w)


def _band(
    item: int, own: NestItem, patterns: Sequence[PiecePattern], room: tuple[float, float, float], count: int
) -> list[NestPlaces]:
    """Ways to lay a kind on a band (width, bottom, top), so many, those with most pieces first; some may be alike."""
    tried: list[tuple[int, _Way, Ints]] = []
    for way in _ways(item=own, patterns=patterns):
        inside = np.zeros(_GRID * _GRID, np.intp)
        for about, places in _orbits(way, own.ring, room):
            inside += _inside(about, places, room).sum(axis=1)
        tried.append((int(inside.max()), way, inside))
    tried.sort(key=lambda one: -one[0])
    found: dict[tuple[int, int], NestPlaces] = {}
    for most, way, inside in tried:
        turn = float(np.degrees(np.angle(way.unit)))
        if (most, round(turn) % 180) not in found and len(found) < count:
            found[most, round(turn) % 180] = _laid(item, own.ring, way, room, int(inside.argmax()), turn)
    laid = list(found.values())
    return [laid[k % len(laid)] if laid else NestPlaces.none() for k in range(count)]


def _laid(
    item: int, ring: Complexes, way: _Way, room: tuple[float, float, float], move: int, turn: float
) -> NestPlaces:
    """The pieces of a way that lie on a band after the move of a number."""
    parts = []
    for half, (about, places) in enumerate(_orbits(way, ring, room)):
        z = places[move][_inside(about, places[move], room)]
        parts.append(NestPlaces(np.full(len(z), item), np.full(len(z), turn + 180.0 * half), z))
    return NestPlaces.joined(*parts)


def _orbits(way: _Way, ring: Complexes, room: tuple[float, float, float]) -> Iterator[tuple[Complexes, Complexes]]:
    """The polygons of a pattern about 0, the piece and its half turn, and their places after each move, (moves, n)."""
    cells = _cells(way, room[0], room[1], room[2])
    shares = np.arange(_GRID) / _GRID
    places = cells + (shares[:, None] * way.u + shares * way.v).ravel()[:, None]
    yield ring * way.unit, places
    if way.half is not None:
        yield -ring * way.unit, places + way.half


def _cells(way: _Way, width: float, low: float, top: float) -> Complexes:
    """The points of a lattice on a band, and some around it."""
    reach = abs(way.u) + abs(way.v) + abs(way.half or 0.0)
    box = np.array([(x, y) for x in (-reach, width + reach) for y in (low - reach, top + reach)]) @ [1, 1j]
    det = (way.u.conjugate() * way.v).imag
    first, second = (box.conj() * way.v).imag / det, (way.u.conjugate() * box).imag / det
    i, j = (np.arange(np.floor(part.min()), np.ceil(part.max()) + 1) for part in (first, second))
    z = (i[:, None] * way.u + j * way.v).ravel()
    x, y = z.real, z.imag
    return np.asarray(z[(x >= -reach) & (x <= width + reach) & (y >= low - reach) & (y <= top + reach)])


def _inside(about: Complexes, z: Complexes, room: tuple[float, float, float]) -> Bools:
    """Which places of a polygon leave it within a band."""
    x, y = about.real, about.imag
    width, low, top = room
    wide = (z.real >= -x.min()) & (z.real <= width - x.max())
    return np.asarray(wide & (z.imag >= low - y.min()) & (z.imag <= top - y.max()))


def _along(edges: Floats, count: int) -> Complexes:
    """So many points along edges (n, 4), at equal distances."""
    start, way = edges[:, 0] + 1j * edges[:, 1], (edges[:, 2] - edges[:, 0]) + 1j * (edges[:, 3] - edges[:, 1])
    reached = np.cumsum(np.abs(way))
    at = (np.arange(count) + 0.5) / count * reached[-1]
    k = np.minimum(np.searchsorted(reached, at, side="right"), len(way) - 1)
    return np.asarray(start[k] + way[k] * (1 - (reached[k] - at) / np.abs(way[k])))

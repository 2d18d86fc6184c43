"""Pieces in rows that repeat: the densest lattices of a piece, or of a piece and its half turn, laid over a sheet.

Two pieces overlap where the place of one lies in a region about the other, their no-fit polygon. A row is a vector on
its edge, and the next row lies as low above it as the polygons of the row leave room: the densest of many such
lattices, each tried in several directions and places. All of it is repeatable, and takes seconds.

Source: J. A. Bennell and J. F. Oliveira, The geometry of nesting problems: a tutorial, 2008; for lattices of a piece
and its half turn, G. Kuperberg and W. Kuperberg, Double-lattice packings of convex bodies in the plane, 1990.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, plane
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces

_PAIRS: Final = 72
"""Places of a half turn beside a piece that are tried; a count."""

_FINER: Final = 4
_BEST: Final = 5
"""Beside the best of these places, so many, others so much closer together are tried as well; counts."""

_ROWS: Final = (160, 44)
"""Vectors along a row that are tried for one piece, and for a piece with its half turn; counts."""

_KEPT: Final = 40
"""Lattices that are laid on the sheet, the densest ones; a count."""

_LOWEST: Final = 6
"""Places above a row that are tried, the lowest ones; a count."""

_GRID: Final = 8
"""Steps of a lattice vector by which it is moved over the sheet; a count."""

_SEAMS: Final = 10
"""Ways of lying that are tried beside another kind, those with most room for themselves; a count."""

_SPLITS: Final = (-0.08, -0.05, -0.03, -0.015, 0.0, 0.015, 0.03, 0.05, 0.08)
"""By how much the bands of kinds are moved; shares of the sheet."""

_HALVES: Final = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
"""Where the band of a kind is divided in two; shares of the sheet."""

_EVEN: Final = 0.8
"""The least part of its share that each kind has."""

_INSIDE_MM: Final = 1e-6
"""How deep a place may lie in a no-fit polygon, on whose edge it was found; millimetres."""


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


def piece_patterns(ring: Complexes) -> list[PiecePattern]:
    """The densest lattices that were found for a polygon (complex128, n), and for it and its half turn about 0."""
    area = _polygon(ring).area
    own, turned = no_fit(ring, ring), no_fit(ring, -ring)
    found = list(_lattices(own, area, None, _ROWS[0]))
    halves = _along(turned, _PAIRS * _FINER).tolist()
    known: dict[int, float] = {}

    def pair(k: int, rows: int) -> None:
        """Try a place of the half turn: two such pairs overlap where a piece of one does with a piece of the other."""
        half = halves[k % len(halves)]
        pairs = _union([own, _moved(turned, -half), _moved(_negative(turned), half)])
        lattices = list(_lattices(pairs, 2 * area, half, rows))
        known[k % len(halves)] = max((one.density for one in lattices), default=0.0)
        found.extend(lattices)

    for k in range(0, len(halves), _FINER):
        pair(k, _ROWS[1])
    for k in sorted(known, key=lambda k: -known[k])[:_BEST]:
        for other in range(k - _FINER // 2, k + _FINER // 2 + 1):
            pair(other, 2 * _ROWS[1])
    return sorted(found, key=lambda one: -one.density)[:_KEPT]


def _lattices(overlap: Any, area: float, half: complex | None, count: int) -> Iterator[PiecePattern]:
    """The densest lattice for each of many rows; `overlap` are the places at which what is repeated overlaps itself."""
    import shapely

    inner = overlap.buffer(-_INSIDE_MM)
    shapely.prepare(inner)
    rows = _along(overlap, count)
    for u in rows[(rows.imag > 0) | ((rows.imag == 0) & (rows.real > 0))].tolist():
        for v in _next_rows(overlap, u).tolist():
            density = area / abs((u.conjugate() * v).imag)
            if density < 1.0 and _fits(inner, u, v):
                yield PiecePattern(u, v, half, density)
                break


def _next_rows(overlap: Any, u: complex) -> Complexes:
    """The lowest places above a row, along u, of a piece that overlaps none of it."""
    import shapely

    unit, step = u / abs(u), abs(u)
    level = shapely.transform(overlap, lambda points: plane(_complex(points) * unit.conjugate()))
    left, _, right, top = shapely.bounds(level)
    many = int(np.ceil((right - left) / step)) + 1
    row = _union([_moved(level, k * step) for k in range(-many, many + 1)])
    free = shapely.box(-step / 2, 0.0, step / 2, top + 1.0).difference(row)
    corners = _complex(shapely.get_coordinates(free))
    corners = corners[corners.imag > _INSIDE_MM]
    return np.asarray(corners[np.argsort(corners.imag, kind="stable")][:_LOWEST] * unit)


def _fits(inner: Any, u: complex, v: complex) -> bool:
    """Whether none of a lattice's vectors lies in a region that holds all that are too short."""
    import shapely

    multiples = np.arange(-8, 9)
    z = (np.arange(1, 4)[:, None] * v + multiples * u).ravel()
    z = np.append(z, np.arange(1, 4) * u)
    return not shapely.contains_xy(inner, z.real, z.imag).any()


def no_fit(one: Complexes, other: Complexes) -> Any:
    """The no-fit polygon, where the place of one polygon overlaps another that stays: a polygon, perhaps with holes.

    Its edge is part of the sums of edges of the one with edges of the other one's image in 0. A gap between these sums
    is part of it, unless the one fits there into a bay of the other.
    """
    import shapely

    ends, others = np.stack((one, np.roll(one, -1))), -np.stack((other, np.roll(other, -1)))
    sums = (ends[:, None, :, None] + others[None, :, None, :]).reshape(4, -1).T
    parts = shapely.convex_hull(shapely.multipoints(plane(sums.ravel()).reshape(*sums.shape, 2)))
    whole = max(shapely.get_parts(_union(parts[shapely.area(parts) > 0])), key=shapely.area)
    stays = _polygon(one)
    gaps = [shapely.Polygon(ring) for ring in whole.interiors]
    bays = [gap for gap in gaps if not stays.intersects(_polygon(other + _complex(_inner_point(gap))[0]))]
    return shapely.Polygon(whole.exterior, [bay.exterior for bay in bays])


def lay_patterns(items: Sequence[NestItem], size: tuple[float, float]) -> NestPlaces:
    """The most pieces of these kinds that lattices lay on a rectangle from 0 to `size`, a band of it for each kind.

    Each kind has its share of them, or nearly; an item that is `like` another lies as its image does.
    """
    patterns: list[list[PiecePattern]] = []
    for item in items:
        if item.like is None:
            patterns.append(piece_patterns(item.ring))
        else:
            patterns.append([one.image(item.unit, conj=item.mirrored) for one in patterns[item.like]])
    ways = [_ways(item, own) for item, own in zip(items, patterns, strict=True)]
    shares = np.array([item.share for item in items])
    areas = shares * [_polygon(item.ring).area for item in items]
    best = _none()
    for bands in _divisions(areas / areas.sum()):
        found, taken = [], None
        for k, low, top in bands:
            places, taken = _band(k, items[k].ring, ways[k], (size[0], low * size[1], top * size[1]), taken)
            found.append(places)
        laid = NestPlaces(*(np.concatenate(parts) for parts in zip(*found, strict=True)))
        counts = np.bincount(laid.item, minlength=len(items))
        even = (counts >= np.floor(_EVEN * shares * counts.sum())).all()
        if even and counts.sum() > len(best.item):
            best = laid
    return best


def _divisions(shares: Floats) -> Iterator[list[tuple[int, float, float]]]:
    """Ways to divide a height of 1 into bands: (item, bottom, top). What is of one kind can lie in two ways."""
    if len(shares) == 1:
        yield [(0, 0.0, 1.0)]
        yield from ([(0, 0.0, split), (0, split, 1.0)] for split in _HALVES)
        return
    tops = np.cumsum(shares)[:-1]
    for move in _SPLITS:
        edges = [0.0, *(tops + move).tolist(), 1.0]
        yield [(k, low, top) for k, (low, top) in enumerate(pairwise(edges))]


class _Way(NamedTuple):
    """A pattern turned by a unit: the vectors of its lattice, and the places and turns of the pieces in one cell."""

    unit: complex
    u: complex
    v: complex
    half: complex | None


def _ways(item: NestItem, patterns: Sequence[PiecePattern]) -> list[_Way]:
    """How patterns can lie: as they are, or where pieces are turned freely, with short vectors along a side."""
    ways = []
    for one in patterns:
        units = [1 + 0j]
        if item.turns is None:
            bases = (one.u, one.v, one.u + one.v, one.u - one.v)
            units = [quarter * (base / abs(base)).conjugate() for base in bases for quarter in (1, 1j)]
        ways += [_Way(w, one.u * w, one.v * w, None if one.half is None else one.half * w) for w in units]
    return ways


def _band(
    item: int, ring: Complexes, ways: Sequence[_Way], room: tuple[float, float, float], taken: Any
) -> tuple[NestPlaces, Any]:
    """The most pieces of a kind in a band (width, bottom, top), and all that is taken then.

    They may reach below the bottom where nothing is `taken`.
    """
    import shapely

    width, low, top = room
    tried: list[tuple[int, int, complex]] = []
    shares = np.arange(_GRID) / _GRID
    for k, way in enumerate(ways):
        cells = _cells(way, width, top)
        moves = (shares[:, None] * way.u + shares * way.v).ravel()
        count = np.zeros(len(moves), np.intp)
        for about, z in _orbits(way, ring, cells):
            count += _inside(about, z + moves[:, None], width, low, top).sum(axis=1)
        tried += [
            (int(count[n]), k, complex(moves[n]))
            for n in np.argsort(-count, kind="stable")[: 1 if taken is None else 3]
        ]
    tried.sort(key=lambda one: -one[0])
    best, shapes = _none(), []
    for _, k, move in tried[: 1 if taken is None else _SEAMS]:
        way = ways[k]
        places, laid = [], []
        for half, (about, z) in enumerate(_orbits(way, ring, _cells(way, width, top))):
            inside = (z + move)[_inside(about, z + move, width, 0.0, top)]
            outlines = [_moved(_polygon(about), place) for place in inside.tolist()]
            free = [n for n, shape in enumerate(outlines) if taken is None or not taken.intersects(shape)]
            turn = float(np.degrees(np.angle(way.unit))) + 180.0 * half
            places.append(NestPlaces(np.full(len(free), item), np.full(len(free), turn), inside[free]))
            laid += [outlines[n] for n in free]
        found = NestPlaces(*(np.concatenate(parts) for parts in zip(*places, strict=True)))
        if len(found.item) > len(best.item):
            best, shapes = found, laid
    whole = _union(shapes if taken is None else [taken, *shapes])
    shapely.prepare(whole)
    return best, whole


def _cells(way: _Way, width: float, height: float) -> Complexes:
    """The points of a lattice on a rectangle, and some around it."""
    reach = 2 * (abs(way.u) + abs(way.v)) + abs(way.half or 0.0)
    corners = np.array([-reach - 1j * reach, width + reach + 1j * (height + reach)])
    box = np.array(
        [corners[0], corners[1].real + 1j * corners[0].imag, corners[1], corners[0].real + 1j * corners[1].imag]
    )
    det = (way.u.conjugate() * way.v).imag
    first, second = (box.conj() * way.v).imag / det, (way.u.conjugate() * box).imag / det
    i, j = (np.arange(np.floor(part.min()), np.ceil(part.max()) + 1) for part in (first, second))
    z = (i[:, None] * way.u + j * way.v).ravel()
    inside = (z.real >= -reach) & (z.real <= width + reach) & (z.imag >= -reach) & (z.imag <= height + reach)
    return np.asarray(z[inside])


def _orbits(way: _Way, ring: Complexes, cells: Complexes) -> Iterator[tuple[Complexes, Complexes]]:
    """The polygons of a pattern about 0, and their places: the piece, and its half turn."""
    yield ring * way.unit, cells
    if way.half is not None:
        yield -ring * way.unit, cells + way.half


def _inside(about: Complexes, z: Complexes, width: float, low: float, top: float) -> Bools:
    """Which places of a polygon leave it within a band."""
    x, y = about.real, about.imag
    wide = (z.real + x.min() >= 0.0) & (z.real + x.max() <= width)
    return np.asarray(wide & (z.imag + y.min() >= low) & (z.imag + y.max() <= top))


def _none() -> NestPlaces:
    """No piece at all."""
    return NestPlaces(np.zeros(0, np.intp), np.zeros(0), np.zeros(0, np.complex128))


def _along(region: Any, count: int) -> Complexes:
    """So many points along the edge of a polygon, as close ones along its holes, and its corners' kin none the less."""
    import shapely

    rings = [region.exterior, *region.interiors]
    step = region.exterior.length / count
    parts = [shapely.line_interpolate_point(ring, np.arange(0.0, ring.length, step)) for ring in rings]
    return _complex(shapely.get_coordinates(np.concatenate(parts)))


def _union(parts: Any) -> Any:
    """The union of polygons."""
    import shapely

    return shapely.union_all(parts)


def _polygon(ring: Complexes) -> Any:
    """A ring of points as a polygon."""
    import shapely

    return shapely.Polygon(plane(ring))


def _moved(shape: Any, by: complex) -> Any:
    """The image of a shape that is moved."""
    import shapely

    return shapely.transform(shape, lambda points: points + np.array([by.real, by.imag]))


def _negative(shape: Any) -> Any:
    """The image of a shape under a half turn about 0."""
    import shapely

    return shapely.transform(shape, np.negative)


def _inner_point(shape: Any) -> Floats:
    """A point inside a polygon, (1, 2)."""
    import shapely

    return np.asarray(shapely.get_coordinates(shapely.point_on_surface(shape)), np.float64)


def _complex(points: Floats) -> Complexes:
    """Rows of points as complex numbers."""
    return np.asarray(points[:, 0] + 1j * points[:, 1], np.complex128)

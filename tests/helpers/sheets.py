"""Designs, regions and oracles for the tests of sheets; the oracles flatten by their own formulas and ask shapely."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from helpers.examples import tiling
from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.fabrication.clipping import Strands, clipped_strands, whole_strands
from voronoi_tiles.fabrication.contours import ClosedPieces, clipped_pieces, frame_pieces
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.tile_placement import TilePlacement, place_tiles
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths
from voronoi_tiles.vector.complex.period import Period

FLAT = 1e-5
"""How far the oracles' chords may be from the curves, in millimetres."""


@cache
def period(name: str) -> Period:
    """One period of a design in its own frame."""
    return tiling(name).tessellation.period


def engine(name: str) -> Any:
    """What the engine knows of a design."""
    return tiling(name).tessellation


# --- regions -------------------------------------------------------------------------------------------------


def circle(centre: complex, radius: float, *, hole: bool = False, parts: int = 2, turn: float = 0.0) -> Paths:
    """A circle of ARCs, counter-clockwise, or clockwise as a hole."""
    angle = turn + 2 * np.pi * np.arange(parts) / parts * (-1 if hole else 1)
    step = np.pi / parts * (-1 if hole else 1)
    start = centre + radius * np.exp(1j * angle)
    middle = centre + radius * np.exp(1j * (angle + step))
    return Paths(
        start=start,
        end=np.roll(start, -1),
        control=np.column_stack((middle, np.zeros(parts))),
        kind=np.full(parts, ARC, np.uint8),
        offsets=np.array([0, parts]),
        closed=np.ones(1, np.bool_),
    )


def polygon(*corners: complex) -> Region:
    """A polygon, counter-clockwise."""
    return Region(Paths.polylines([list(corners)], closed=True))


def rounded(left: float, bottom: float, right: float, top: float, radius: float) -> Paths:
    """A rectangle with quarters of circles for corners, counter-clockwise."""
    x, y, h, v = left, bottom, right, top
    r, d = radius, radius * (1 - np.sqrt(0.5))
    points = [x + r + y * 1j, h - r + y * 1j, h + (y + r) * 1j, h + (v - r) * 1j]
    points += [h - r + v * 1j, x + r + v * 1j, x + (v - r) * 1j, x + (y + r) * 1j]
    middles = [h - d + (y + d) * 1j, h - d + (v - d) * 1j, x + d + (v - d) * 1j, x + d + (y + d) * 1j]
    start = np.array(points)
    control = np.zeros((8, 2), np.complex128)
    control[1::2, 0] = middles
    return Paths(
        start=start,
        end=np.roll(start, -1),
        control=control,
        kind=np.array([LINE, ARC] * 4, np.uint8),
        offsets=np.array([0, 8]),
        closed=np.ones(1, np.bool_),
    )


# --- flattening by formulas of its own -------------------------------------------------------------------------


def points_on(paths: Paths, k: int, t: Floats) -> Complexes:
    """Points of one piece: de Casteljau, and the circle through three points."""
    a, b, (m, n) = paths.start[k], paths.end[k], paths.control[k]
    match int(paths.kind[k]):
        case int(kind) if kind == LINE:
            return np.asarray(a + (b - a) * t)
        case int(kind) if kind == QUAD:
            p, q = a + (m - a) * t, m + (b - m) * t
            return np.asarray(p + (q - p) * t)
        case int(kind) if kind == CUBIC:
            p, q, r = a + (m - a) * t, m + (n - m) * t, n + (b - n) * t
            p, q = p + (q - p) * t, q + (r - q) * t
            return np.asarray(p + (q - p) * t)
    # Circumcentre of a, m, b.
    u, v = m - a, b - a
    centre = a + u * v * (u - v).conjugate() / (u.conjugate() * v - u * v.conjugate())
    full = np.angle((m - centre) / (a - centre)) + np.angle((b - centre) / (m - centre))
    return np.asarray(centre + (a - centre) * np.exp(1j * full * t))


def chords(paths: Paths, k: int, accuracy: float) -> int:
    """How many chords stay within `accuracy` of a piece."""
    a, b, (m, n) = paths.start[k], paths.end[k], paths.control[k]
    if paths.kind[k] == LINE:
        return 1
    if paths.kind[k] == QUAD:
        bend = abs(a - 2 * m + b) / 4
    elif paths.kind[k] == CUBIC:
        bend = 3 / 4 * max(abs(a - 2 * m + n), abs(m - 2 * n + b))
    else:
        bend = 2 * abs(m - (a + b) / 2) + abs(b - a) / 8
    return max(2, int(np.ceil(np.sqrt(bend / accuracy))))


@cache
def _steps(count: int) -> Floats:
    """So many equal steps from 0 to 1."""
    t = np.linspace(0.0, 1.0, count + 1)
    t.flags.writeable = False
    return t


def flattened(paths: Paths, accuracy: float = FLAT) -> list[Complexes]:
    """Each path as points, its ends among them with their own bits."""
    lines = []
    for first, stop in pairwise(paths.offsets.tolist()):
        parts = []
        for k in range(first, stop):
            points = points_on(paths, k, _steps(chords(paths, k, accuracy)))
            points[0], points[-1] = paths.start[k], paths.end[k]
            parts.append(points if k == stop - 1 else points[:-1])
        lines.append(np.concatenate(parts))
    return lines


def xy(points: Complexes) -> NDArray[np.float64]:
    """Points as rows."""
    return np.column_stack((points.real, points.imag))


def shape(paths: Paths, accuracy: float = FLAT) -> Any:
    """The area of closed paths with the sense of turning of outer rings and holes, as shapely sees it."""
    rings = [shapely.Polygon(xy(line)) for line in flattened(paths, accuracy)]
    if len(rings) == 1 and rings[0].is_valid:
        return rings[0]
    turns = [shapely.is_ccw(ring.exterior) for ring in rings]
    outer = shapely.union_all([ring.buffer(0) for ring, ccw in zip(rings, turns, strict=True) if ccw])
    holes = shapely.union_all([ring.buffer(0) for ring, ccw in zip(rings, turns, strict=True) if not ccw])
    return outer.difference(holes)


def shapes(paths: Paths, items: Ints, accuracy: float = FLAT) -> list[Any]:
    """The area of each item."""
    return [shape(paths.take(np.arange(a, b)), accuracy) for a, b in pairwise(items.tolist())]


# --- a sheet, whole -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Sheet:
    """A region filled with tiles in all ways."""

    period: Period
    region: Region

    @cached_property
    def placement(self) -> TilePlacement:
        """The tiles."""
        return place_tiles(self.period, self.region)

    @cached_property
    def strands(self) -> Strands:
        """The lines of the clipped sheet."""
        return clipped_strands(self.period, self.placement, self.region)

    @cached_property
    def cut(self) -> Ints:
        """The tiles that the border cuts."""
        return np.flatnonzero(~self.placement.whole)

    @cached_property
    def pieces(self) -> ClosedPieces:
        """What is left of these."""
        outlines, items = self.period.outlines(self.placement.tile[self.cut], self.placement.step[self.cut])
        return clipped_pieces(self.strands, self.cut, outlines, items)

    @cached_property
    def whole(self) -> tuple[Paths, Ints]:
        """The outlines of the whole tiles."""
        whole = self.placement.whole
        return self.period.outlines(self.placement.tile[whole], self.placement.step[whole])

    @cached_property
    def inner(self) -> TilePlacement:
        """The whole tiles alone."""
        whole = self.placement.whole
        return TilePlacement(self.placement.tile[whole], self.placement.step[whole], whole[whole])

    @cached_property
    def frame(self) -> ClosedPieces:
        """What is left around them."""
        return frame_pieces(whole_strands(self.period, self.inner), self.region)

    @cached_property
    def outline(self) -> Any:
        """The region, as shapely sees it."""
        return shape(self.region.border)

    @cached_property
    def tiles(self) -> list[Any]:
        """All tiles of the placement uncut, as shapely sees them."""
        return shapes(*self.period.outlines(self.placement.tile, self.placement.step))

    @cached_property
    def slack(self) -> float:
        """The area that chords may make of the curves along a border of this length."""
        return float(2 * FLAT * (self.outline.length + max((tile.length for tile in self.tiles), default=0.0)))


def region_area(region: Region) -> float:
    """The area of a region by Green's theorem, with a fine quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    t = (nodes + 1) / 2
    area = 0.0
    for k in range(len(region.border.start)):
        a, b = region.border.start[k], region.border.end[k]
        area += (a.conjugate() * b).imag / 2
        if region.border.kind[k] == ARC:
            points, h = points_on(region.border, k, t), 1e-6
            slope = (points_on(region.border, k, t + h) - points_on(region.border, k, t - h)) / (2 * h)
            area += float((((points - a).conj() * slope).imag * weights).sum()) / 4
    return float(area)


def check_areas(sheet: Sheet, area: float, limit: float = 1e-12) -> None:
    """Whole tiles and clipped ones, as well as whole tiles and the frame, have the area of the region."""
    whole = float(ring_areas(sheet.whole[0]).sum())
    clipped = whole + float(ring_areas(sheet.pieces.paths).sum())
    assert abs(clipped / area - 1) <= limit, f"clipped pieces: area off by {clipped / area - 1:.1e}"
    framed = whole + float(ring_areas(sheet.frame.paths).sum())
    assert abs(framed / area - 1) <= limit, f"frame: area off by {framed / area - 1:.1e}"


def check_lengths(sheet: Sheet, limit: float = 1e-9) -> None:
    """The inner strands are half of what is around the pieces without the border, which the strands have whole."""
    strands, border = sheet.strands, sheet.region.border.lengths.sum()
    along = strands.border[strands.paths.owner]
    inner, outer = strands.paths.lengths[~along].sum(), strands.paths.lengths[along].sum()
    around = sheet.whole[0].lengths.sum() + sheet.pieces.paths.lengths.sum()
    assert abs(outer - border) <= limit * border, f"the border is {outer - border:.1e} longer than the region's"
    assert abs((around - border) / 2 - inner) <= limit * around, f"inner strands: {inner - (around - border) / 2:.1e}"


def check_ends(paths: Paths, node: Complexes, first: Ints, last: Ints) -> None:
    """Strands start and end at their nodes, and pieces follow each other, bit for bit."""
    assert (paths.start[paths.offsets[:-1]] == node[first]).all()
    assert (paths.end[paths.offsets[1:] - 1] == node[last]).all()
    check_joints(paths)


def check_joints(paths: Paths) -> None:
    """Each piece starts where the one before ends, bit for bit; closed paths end where they start."""
    assert (paths.counts > 0).all()
    inner = np.ones(len(paths.start), np.bool_)
    inner[paths.offsets[:-1]] = False
    later = np.flatnonzero(inner)
    assert (paths.start[later] == paths.end[later - 1]).all()
    first, last = paths.offsets[:-1][paths.closed], paths.offsets[1:][paths.closed] - 1
    assert (paths.start[first] == paths.end[last]).all()


def check_apart(paths: Paths, limit: float = 1e-7) -> None:
    """No two strands lie on each other for any length: their union is as long as all of them."""
    lines = [shapely.LineString(xy(line)) for line in flattened(paths, 1e-4)]
    total = sum(line.length for line in lines)
    exact = shapely.union_all(lines).length
    assert abs(exact / total - 1) <= limit, f"{total - exact:.1e} of {total:.1f} mm lies on other strands"
    # Nearly the same is the same: on a grid, whose rounding changes lengths a little.
    grid = 1e-5
    snapped = shapely.union_all([shapely.set_precision(line, grid) for line in lines], grid_size=grid).length
    slack = 1e-4 * total + 10 * grid * len(lines)
    assert abs(snapped - total) <= slack, f"{total - snapped:.1e} of {total:.1f} mm lies near other strands"


def check_shapes(sheet: Sheet) -> None:
    """Every tile's pieces are what shapely leaves of the tile; the frame is what it leaves of the region."""
    pieces = shapes(sheet.pieces.paths, sheet.pieces.items)
    owners = sheet.pieces.tile.tolist()
    for tile in sheet.cut.tolist():
        own = shapely.union_all([piece for piece, owner in zip(pieces, owners, strict=True) if owner == tile])
        wanted = sheet.tiles[tile].intersection(sheet.outline)
        off = own.symmetric_difference(wanted).area
        assert off <= sheet.slack, f"tile {tile}: its pieces are off by {off:.1e}"
    for piece in pieces:
        assert piece.area > 0
    frame = shape(sheet.frame.paths)
    whole = [sheet.tiles[k] for k in np.flatnonzero(sheet.placement.whole).tolist()]
    wanted = sheet.outline.difference(shapely.union_all(whole))
    off = frame.symmetric_difference(wanted).area
    assert off <= (1 + len(whole)) * sheet.slack, f"the frame is off by {off:.1e}"


def check_placement(sheet: Sheet) -> None:
    """Those tiles are there that shapely finds on the region, those whole that it finds inside."""
    tile, step = candidates(sheet)
    found = {(k, *s): w for k, s, w in zip(*_listed(sheet.placement), sheet.placement.whole.tolist(), strict=True)}
    assert len(found) == len(sheet.placement.tile), "a tile is there twice"
    roomy, tight = sheet.outline.buffer(2 * FLAT), sheet.outline.buffer(-2 * FLAT)
    polygons = shapes(*sheet.period.outlines(tile, step), FLAT)
    for k, s, polygon_ in zip(tile.tolist(), step.tolist(), polygons, strict=True):
        key = (k, *s)
        if polygon_.intersection(tight).area > sheet.slack:
            assert key in found, f"tile {key} is missing"
        if not polygon_.intersects(roomy):
            assert key not in found, f"tile {key} is not on the region"
        if tight.covers(polygon_):
            assert found[key], f"tile {key} is whole"
        if polygon_.difference(roomy).area > sheet.slack:
            assert not found.get(key, False), f"tile {key} is not whole"
    assert found.keys() <= {(k, *s) for k, s in zip(tile.tolist(), step.tolist(), strict=True)}


def _listed(placement: TilePlacement) -> tuple[list[int], list[list[int]]]:
    return placement.tile.tolist(), placement.step.tolist()


def candidates(sheet: Sheet) -> tuple[Ints, Ints]:
    """All tiles whose boxes meet the region's, found by trying a generous block of lattice vectors."""
    count = len(sheet.period.site)
    outlines, items = sheet.period.outlines(np.arange(count), np.zeros((count, 2), np.intp))
    left, bottom, right, top = sheet.region.bounds
    a, b = sheet.period.basis.tolist()
    tiles, steps = [], []
    det = (a.conjugate() * b).imag
    for k in range(count):
        points = np.concatenate(flattened(outlines.take(np.arange(items[k], items[k + 1])), 1e-3))
        reach = abs(complex(right - left, top - bottom)) / 2 + np.abs(points - points.mean()).max()
        centre = complex(left + right, bottom + top) / 2 - points.mean()
        i, j = (centre.conjugate() * b).imag / det, (a.conjugate() * centre).imag / det
        m, n = int(reach * abs(b) / abs(det)) + 2, int(reach * abs(a) / abs(det)) + 2
        for u in range(int(i) - m, int(i) + m + 1):
            for v in range(int(j) - n, int(j) + n + 1):
                here = points + u * a + v * b
                if here.real.max() < left - 1e-3 or here.real.min() > right + 1e-3:
                    continue
                if here.imag.max() < bottom - 1e-3 or here.imag.min() > top + 1e-3:
                    continue
                tiles.append(k)
                steps.append((u, v))
    return np.array(tiles, np.intp), np.array(steps, np.intp).reshape(-1, 2)


def check_sheet(sheet: Sheet, area: float, limit: float = 1e-12) -> None:
    """All that is promised of a sheet; areas to `limit`."""
    check_placement(sheet)
    strands = sheet.strands
    check_ends(strands.paths, strands.node, strands.first, strands.last)
    check_joints(sheet.pieces.paths)
    check_joints(sheet.frame.paths)
    assert sheet.pieces.paths.closed.all()
    assert sheet.frame.paths.closed.all()
    check_areas(sheet, area, limit)
    check_lengths(sheet)
    check_apart(strands.paths)
    check_shapes(sheet)

"""The proof that a result is right: figures computed from the finished outlines, not from the engine's steps.

The area identity, the closure of the rings and the bit-for-bit agreement of shared edges together show that the copies of
the tiles cover the plane exactly once; equidistance and emptiness show that each edge is where it belongs. Distances
come from shapely.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import fsum
import numpy as np

from voronoi_tiles.tolerance import PROOF_LIMIT
from voronoi_tiles.vector.contour import Complexes, Floats, Ints
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import LocalTile, TileRecord
from voronoi_tiles.wallpaper import Lattice, Operation, WallpaperGroup

# Where on an arc its points are tested; its end is the next one's start.
_PARAMETERS = (0.0, 0.25, 0.5, 0.75)


@dataclass(frozen=True, slots=True)
class ProofReport:
    """The figures of a proof.

    Attributes:
        area: relative error of the tiles' areas, which must add up to the cell's.
        equidistance: largest difference of the distances from an edge's points to the site and to the copy beyond,
            relative to the cell's longer side.
        emptiness: by how much any other copy is nearer to such a point, on the same scale; 0 where none is.
        open_joints: arcs whose end is not, bit for bit, the start of the next.
        crossings: places where an outline crosses itself.
        unshared: arcs that the tile beyond does not have, bit for bit, as its own.
    """

    area: float
    equidistance: float
    emptiness: float
    open_joints: int
    crossings: int
    unshared: int

    def rows(self) -> list[tuple[str, float, float, bool]]:
        """Return for each figure its name, value, limit and whether it holds."""
        figures = [
            ("area", self.area, PROOF_LIMIT),
            ("equidistance", self.equidistance, PROOF_LIMIT),
            ("emptiness", self.emptiness, PROOF_LIMIT),
            ("open joints", self.open_joints, 0),
            ("crossings", self.crossings, 0),
            ("unshared edges", self.unshared, 0),
        ]
        # Written so that NaN fails.
        return [(name, value, limit, bool(value <= limit)) for name, value, limit in figures]

    @property
    def passed(self) -> bool:
        """Whether every figure holds."""
        return not self.failures

    @property
    def failures(self) -> tuple[str, ...]:
        """One sentence for each figure that does not hold."""
        return tuple(
            f"{name} is {value:.3g}, the limit {limit:.3g}" for name, value, limit, holds in self.rows() if not holds
        )


def prove(group: WallpaperGroup, lattice: Lattice, records: Sequence[TileRecord]) -> ProofReport:
    """Return the proof's figures for the tiles of all sites of a design."""
    size = max(abs(lattice.a), abs(lattice.b))
    tiles = [record.local() for record in records]
    areas = [
        tile.outline.area * group.order / len(record.symmetry) for tile, record in zip(tiles, records, strict=True)
    ]
    equidistance, emptiness = _distances(group, lattice, tiles)
    return ProofReport(
        area=abs(fsum([*areas, -lattice.det])) / lattice.det,
        equidistance=equidistance / size,
        emptiness=emptiness / size,
        open_joints=sum(_open_joints(tile.outline) for tile in tiles),
        crossings=sum(_crossings(tile.outline, size) for tile in tiles),
        unshared=sum(_unshared(tile, tiles) for tile in tiles),
    )


class _Site:
    """A site as shapely sees it: distances of points from it."""

    def __init__(self, tile: LocalTile) -> None:
        import shapely

        isolated = np.setdiff1d(np.arange(len(tile.nodes)), tile.segments)
        ends = np.concatenate((tile.segments, np.stack((isolated, isolated), axis=1)))
        self._start, self._end = tile.nodes[ends[:, 0]], tile.nodes[ends[:, 1]]
        corners = np.stack((self._start, self._end), axis=1)
        self._tree = shapely.STRtree(shapely.linestrings(np.stack((corners.real, corners.imag), axis=-1)))
        self.centre = complex(tile.nodes.mean())
        self.radius = float(np.abs(tile.nodes - self.centre).max())

    def distance(self, points: Complexes) -> Floats:
        """Return the distance of each point."""
        import shapely

        where = shapely.points(points.real, points.imag)
        nearest = self._tree.query_nearest(where, all_matches=False)[1]
        start, chord = self._start[nearest], (self._end - self._start)[nearest]
        away = points - start
        square = chord.real**2 + chord.imag**2
        along = away.real * chord.real + away.imag * chord.imag
        foot = np.clip(along / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
        return np.abs(away - foot * chord)


def _distances(group: WallpaperGroup, lattice: Lattice, tiles: Sequence[LocalTile]) -> tuple[float, float]:
    """Return the largest error of equidistance, and by how much any copy is too near, over points of all edges."""
    sites = {tile.name: _Site(tile) for tile in tiles}
    equidistance = emptiness = 0.0
    for tile in tiles:
        points, arc = _sample(tile.outline)
        here = sites[tile.name].distance(points)
        neighbour = tile.outline.neighbour[arc]
        for number, (name, operation) in enumerate(tile.outline.neighbours):
            chosen = neighbour == number
            back = lattice.isometry(operation.inverse())
            there = sites[name].distance(back(points[chosen]))
            equidistance = max(equidistance, float(np.abs(there - here[chosen]).max(initial=0.0)))
        for site in sites.values():
            for operation in group.operations:
                nearest = _nearest_translate(lattice, operation, site, points, here)
                emptiness = max(emptiness, float((here - nearest).max()))
    return equidistance, emptiness


def _nearest_translate(
    lattice: Lattice, operation: Operation, site: _Site, points: Complexes, enough: Floats
) -> Floats:
    """Return each point's distance from the nearest of the site's copies under an operation and all translations.

    Copies that are farther than `enough` are passed over; where all are, the result is `enough`.
    """
    isometry, back = lattice.isometry(operation), lattice.isometry(operation.inverse())
    centre = isometry(site.centre)
    p, q = lattice.reduced_basis
    det = p.real * q.imag - p.imag * q.real
    away = points - centre
    first = np.round((away.real * q.imag - away.imag * q.real) / det)
    second = np.round((p.real * away.imag - p.imag * away.real) / det)
    # The copy with the nearest point has that point within the lattice's Voronoi cell about the sample, and its centre a
    # radius from there: in coordinates of a reduced basis, less than 1 and this much from the sample's.
    m, n = (int(np.ceil(1.5 + site.radius * abs(v) / det)) for v in (q, p))
    result = enough.copy()
    for i in range(-m, m + 1):
        for j in range(-n, n + 1):
            shifted = points - ((first + i) * p + (second + j) * q)
            near = np.flatnonzero(np.abs(shifted - centre) - site.radius < result)
            if len(near):
                result[near] = np.minimum(result[near], site.distance(back(shifted[near])))
    return result


def _sample(outline: Outline) -> tuple[Complexes, Ints]:
    """Return points of every arc, and the index of each point's arc."""
    points = []
    for t in _PARAMETERS:
        point = (1 - t) * outline.start + t * outline.end
        bent = outline.curved
        control = outline.control[bent]
        point[bent] = (1 - t) ** 2 * outline.start[bent] + 2 * t * (1 - t) * control + t * t * outline.end[bent]
        points.append(point)
    return np.concatenate(points), np.tile(np.arange(len(outline)), len(_PARAMETERS))


def _open_joints(outline: Outline) -> int:
    """Count the arcs whose end is not the start of the next of their ring."""
    following = np.arange(1, len(outline) + 1)
    following[outline.ring_offsets[1:] - 1] = outline.ring_offsets[:-1]
    return int((outline.end != outline.start[following]).sum())


def _crossings(outline: Outline, size: float) -> int:
    """Count the places where an outline crosses itself; where it merely touches itself it does not.

    Chords of curves may cross where the curves do not: they are refined until the count is 0 or the chords are as
    good as the curves.
    """
    count = 0
    for accuracy in (1e-3, 1e-5, 1e-7, 1e-9):
        count = _chord_crossings(outline.flatten(accuracy=accuracy * size), PROOF_LIMIT * size)
        if count == 0:
            break
    return count


def _chord_crossings(rings: Sequence[Complexes], limit: float) -> int:
    """Count the crossings of closed polygons' sides farther than `limit` from the sides' ends."""
    import shapely

    start = np.concatenate(rings)
    end = np.concatenate([np.roll(ring, -1) for ring in rings])
    sides = np.stack((start, end), axis=1)
    lines = shapely.linestrings(np.stack((sides.real, sides.imag), axis=-1))
    i, j = shapely.STRtree(lines).query(lines, predicate="intersects")
    chosen = i < j
    i, j = i[chosen], j[chosen]
    shared = (start[i] == start[j]) | (start[i] == end[j]) | (end[i] == start[j]) | (end[i] == end[j])
    i, j = i[~shared], j[~shared]
    common = shapely.intersection(lines[i], lines[j])
    where = shapely.centroid(common)
    point = shapely.get_x(where) + 1j * shapely.get_y(where)
    ends = np.stack((start[i], end[i], start[j], end[j]))
    return int((np.abs(ends - point).min(axis=0) > limit).sum())


def _unshared(tile: LocalTile, tiles: Sequence[LocalTile]) -> int:
    """Count the arcs that the tile beyond does not have, reversed, bit for bit."""
    outline = tile.outline
    missing = 0
    by_name = {other.name: other for other in tiles}
    for number, (name, operation) in enumerate(outline.neighbours):
        chosen = outline.neighbour == number
        beyond = by_name[name].copy(operation)
        theirs = _bits(beyond.end, beyond.control, beyond.start)
        mine = _bits(outline.start[chosen], outline.control[chosen], outline.end[chosen])
        missing += len(mine - theirs)
    return missing


def _bits(*columns: Complexes) -> set[tuple[complex, ...]]:
    """Return rows of numbers as a set."""
    return set(zip(*(column.tolist() for column in columns), strict=True))

"""The proof that a result is right: figures computed from the finished outlines, not from the engine's steps.

Equidistance and emptiness show that every edge lies on the boundary of the true tile. So each connected part of the
true tile is either inside its outline or outside, and as it holds a stroke of the site, and all strokes are inside,
it is inside; the outline can only be too large, and the area identity says that it is not. Closure, crossings and the
bit-for-bit agreement of shared edges show that what is cut is that outline. Which element is nearest is asked of
shapely.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import fsum
from typing import Any

import numpy as np
import numpy.typing as npt

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting, next_in_ring
from voronoi_tiles.base.components import components
from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.tolerance import PROOF_LIMIT
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import LocalTile, TileRecord, tessellate

# Where on an arc its points are tested; its end is the next one's start.
_PARAMETERS = (0.0, 0.25, 0.5, 0.75)
# Twice the root of the rounding unit, times a few for constants; relative to the longer of the cell's vectors.
_UNDECIDED = 1e-7
# Up to this many nodes, asking for each is quicker than finding out which hang together.
_FEW = 256


def proved_tiles(
    sites: Sequence[NodedSite], group: WallpaperGroup, lattice: Lattice
) -> tuple[list[TileRecord], ProofReport]:
    """The tile of each site, and the proof that they are right.

    Raises TouchingCopiesError where two copies touch, ProofError where the result fails its proof.
    """
    tiles = tessellate(sites, group, lattice)
    proof = prove(group, lattice, tiles)
    if not proof.passed:
        tiles[0].refuse_touching()
        tiles = tessellate(sites, group, lattice, without_short=True)
        proof = prove(group, lattice, tiles)
    if not proof.passed:
        raise ProofError("the result failed its proof: " + "; ".join(proof.failures), proof)
    return tiles, proof


@dataclass(frozen=True, slots=True)
class ProofReport:
    """The figures of a proof.

    `area` is the relative error of the tiles' areas, which must add up to the cell's. `equidistance` is the largest
    difference of the distances from an edge's points to the site and to the copy beyond, relative to the longer of the
    cell's vectors; `emptiness` is by how much any other copy is nearer to such a point, on the same scale, 0 where none
    is.

    The others are counts: of arcs whose end is not, bit for bit, the start of the next (`open_joints`), of places where
    an outline crosses itself (`crossings`), of connected parts of sites (of one with few nodes, the nodes) that are not
    inside their tiles' outlines (`strayed`), of arcs that the tile beyond does not have, bit for bit, as its own
    (`unshared`).
    """

    area: float
    equidistance: float
    emptiness: float
    open_joints: int
    crossings: int
    strayed: int
    unshared: int

    def rows(self) -> list[tuple[str, float, float, bool]]:
        """For each figure its name, value, limit and whether it holds."""
        figures = [
            ("area", self.area, PROOF_LIMIT),
            ("equidistance", self.equidistance, PROOF_LIMIT),
            ("emptiness", self.emptiness, PROOF_LIMIT),
            ("open joints", self.open_joints, 0),
            ("crossings", self.crossings, 0),
            ("strayed strokes", self.strayed, 0),
            ("unshared edges", self.unshared, 0),
        ]
        # Written so that NaN fails.
        return [(name, value, limit, bool(value <= limit)) for name, value, limit in figures]

    def document(self) -> list[dict[str, Any]]:
        """The figures in the types of JSON: each with "name", "value", "limit" and "passed"."""
        return [
            {"name": name, "value": value, "limit": limit, "passed": passed}
            for name, value, limit, passed in self.rows()
        ]

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
    """The proof's figures for the tiles of all sites of a design."""
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
        strayed=sum(_strayed(tile, size) for tile in tiles),
        unshared=sum(_unshared(tile, tiles) for tile in tiles),
    )


class _ProvedSite:
    """A site and shapely's tree of its elements: distances of points from it."""

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
        """The distance of each point."""
        import shapely

        where = shapely.points(points.real, points.imag)
        nearest = self._tree.query_nearest(where, all_matches=False)[1]
        start, chord = self._start[nearest], (self._end - self._start)[nearest]
        away = points - start
        square = chord.real**2 + chord.imag**2
        along = away.real * chord.real + away.imag * chord.imag
        foot = np.clip(along / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
        return np.asarray(np.abs(away - foot * chord))


def _distances(group: WallpaperGroup, lattice: Lattice, tiles: Sequence[LocalTile]) -> tuple[float, float]:
    """The largest error of equidistance, and by how much any copy is too near, over points of all edges."""
    sites = {tile.name: _ProvedSite(tile) for tile in tiles}
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
    lattice: Lattice, operation: Operation, site: _ProvedSite, points: Complexes, enough: Floats
) -> Floats:
    """Each point's distance from the nearest of the site's copies under an operation and all translations.

    Copies that are farther than `enough` are passed over; where all are, the result is `enough`.
    """
    isometry, back = lattice.isometry(operation), lattice.isometry(operation.inverse())
    centre = isometry(site.centre)
    p, q = lattice.reduced_basis
    first, second = (np.round(share) for share in lattice.reduced.fractional(points - centre))
    # The copy with the nearest point has that point within the lattice's Voronoi cell about the sample, and its
    # centre a radius from there: in coordinates of a reduced basis, less than 1 and this much from the sample's.
    m, n = (int(np.ceil(1.5 + site.radius * abs(v) / lattice.reduced.det)) for v in (q, p))
    result = enough.copy()
    for i in range(-m, m + 1):
        for j in range(-n, n + 1):
            shifted = points - ((first + i) * p + (second + j) * q)
            near = np.flatnonzero(np.abs(shifted - centre) - site.radius < result)
            if len(near):
                result[near] = np.minimum(result[near], site.distance(back(shifted[near])))
    return result


def _sample(outline: Outline) -> tuple[Complexes, Ints]:
    """Points of every arc, and the index of each point's arc."""
    arc = np.tile(np.arange(len(outline)), len(_PARAMETERS))
    return _at(outline, arc, np.repeat(_PARAMETERS, len(outline))), arc


def _open_joints(outline: Outline) -> int:
    """The number of arcs whose end is not the start of the next of their ring."""
    return int((outline.end != outline.start[next_in_ring(outline.ring_offsets)]).sum())


def _crossings(outline: Outline, size: float) -> int:
    """The number of places where an outline crosses itself; where it merely touches itself it does not.

    Chords of curves may cross where the curves do not: where chords cross, these arcs are divided further, until no
    chords cross or the chords are as good as the curves.
    """
    import shapely

    # Sub-arcs: the arc and the range of the curve's parameter.
    count = np.where(outline.curved, 8, 1)
    part, arc = counting(count)
    low, high = part / count[arc], (part + 1) / count[arc]
    start, end = _at(outline, arc, low), _at(outline, arc, high)
    i, j = shapely.STRtree(_lines(start, end)).query(_lines(start, end), predicate="intersects")
    i, j = i[i < j], j[i < j]
    first, second = (arc[i], low[i], high[i]), (arc[j], low[j], high[j])
    for _ in range(_DIVISIONS):
        meeting = _crossing(outline, first, second, PROOF_LIMIT * size)
        first, second = tuple(x[meeting] for x in first), tuple(x[meeting] for x in second)
        bent = np.flatnonzero(outline.curved[first[0]] | outline.curved[second[0]])
        straight = len(first[0]) - len(bent)
        if straight or not len(bent):
            return straight + len(bent)
        first, second = _divide(first, second)
    # Many pairs of tiny sub-arcs may be left of one crossing.
    return int(np.unique(np.stack((first[0], second[0])), axis=1).shape[1])


# Halvings of crossing sub-arcs: after so many a sub-arc's sagitta is below its end points' rounding.
_DIVISIONS = 24

_SubArcs = tuple[Ints, Floats, Floats]


def _divide(first: _SubArcs, second: _SubArcs) -> tuple[_SubArcs, _SubArcs]:
    """The four pairs of halves of each pair of sub-arcs."""
    halves = []
    for arc, low, high in (first, second):
        middle = (low + high) / 2
        halves.append(((arc, low, middle), (arc, middle, high)))
    pairs = [(one, two) for one in halves[0] for two in halves[1]]
    ones, twos = ([np.concatenate(x) for x in zip(*half, strict=True)] for half in zip(*pairs, strict=True))
    return (ones[0], ones[1], ones[2]), (twos[0], twos[1], twos[2])


def _crossing(outline: Outline, first: _SubArcs, second: _SubArcs, limit: float) -> Ints:
    """The pairs of sub-arcs whose chords cross farther than `limit` from their ends."""
    import shapely

    a, b = _at(outline, first[0], first[1]), _at(outline, first[0], first[2])
    c, d = _at(outline, second[0], second[1]), _at(outline, second[0], second[2])
    common = shapely.intersection(_lines(a, b), _lines(c, d))
    meeting = np.flatnonzero(~shapely.is_empty(common))
    where = shapely.centroid(common[meeting])
    point = shapely.get_x(where) + 1j * shapely.get_y(where)
    ends = np.stack((a, b, c, d))[:, meeting]
    return np.asarray(meeting[np.abs(ends - point).min(axis=0) > limit])


def _lines(start: Complexes, end: Complexes) -> npt.NDArray[np.object_]:
    """Straight lines as shapely geometries."""
    import shapely

    ends = np.stack((start, end), axis=1)
    return np.asarray(shapely.linestrings(np.stack((ends.real, ends.imag), axis=-1)))


def _at(outline: Outline, arc: Ints, t: Floats) -> Complexes:
    """Points of arcs at their parameter, the ends exactly."""
    start, control, end = outline.start[arc], outline.control[arc], outline.end[arc]
    point = np.where(
        outline.curved[arc],
        (1 - t) ** 2 * start + 2 * t * (1 - t) * control + t * t * end,
        (1 - t) * start + t * end,
    )
    return np.where(t == 0.0, start, np.where(t == 1.0, end, point))


def _strayed(tile: LocalTile, size: float) -> int:
    """The number of connected parts of a site around which the outline of its tile does not run exactly once.

    A part meets no edge, so one of its nodes stands for all. Where copies are a distance d apart, the edge between
    them is known to eps R^2 / d at a distance R: a node nearer to an outline than the root of eps times the cell
    cannot be told to be inside or outside, and is passed over.
    """
    import shapely

    nodes = tile.nodes
    if len(nodes) > _FEW:
        nodes = nodes[np.unique(components(len(nodes), *tile.segments.T))]
    outside = np.array([node for node in nodes.tolist() if winding_number(tile.outline, node) != 1], complex)
    if not len(outside):
        return 0
    rings = [np.append(ring, ring[0]) for ring in tile.outline.flatten(accuracy=_UNDECIDED * size / 4)]
    lines = [shapely.linestrings(ring.real, ring.imag) for ring in rings]  # of any number of points each
    border = shapely.multilinestrings(lines)
    return int((shapely.distance(shapely.points(outside.real, outside.imag), border) > _UNDECIDED * size).sum())


def winding_number(outline: Outline, point: complex) -> int:
    """How often an outline runs counter-clockwise around a point that is not on it.

    An arc turns about the point as its chord does, except that a point between the two is passed on the other side. The
    barycentric coordinates (s, t, r) of such a point in the triangle of start, control and end are positive, and
    t^2 < 4 s r: on the curve s = (1 - u)^2, t = 2 u (1 - u), r = u^2.
    """
    start, control, end = outline.start - point, outline.control - point, outline.end - point
    across = _cross(start, end)
    turn = np.arctan2(across, start.real * end.real + start.imag * end.imag)
    s, t, r = _cross(control, end), -across, _cross(start, control)
    sign = np.sign(s + t + r)
    s, t, r = s * sign, t * sign, r * sign
    between = outline.curved & (s > 0.0) & (t >= 0.0) & (r > 0.0) & (t * t < 4.0 * s * r)
    # On the chord itself: as if a little to the side of the curve.
    on_chord = between & (t == 0.0)
    turn[on_chord] = -np.pi * sign[on_chord]
    turn += 2.0 * np.pi * sign * between
    return round(float(turn.sum()) / (2.0 * np.pi))


def _cross(u: Complexes, v: Complexes) -> Floats:
    """The cross products of vectors."""
    return np.asarray(u.real * v.imag - u.imag * v.real)


def _unshared(tile: LocalTile, tiles: Sequence[LocalTile]) -> int:
    """The number of arcs that the tile beyond does not have, reversed, bit for bit."""
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
    """Rows of numbers as a set."""
    return set(zip(*(column.tolist() for column in columns), strict=True))

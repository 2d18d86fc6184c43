"""Tiles of a layer drawn in: rings of points, and of each side between two of them where along the tile it lies."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting, next_in_ring, offsets_of, plane, ranges, starts
from voronoi_tiles.paths.conversion import chord_counts, to_lines
from voronoi_tiles.paths.offset import offset
from voronoi_tiles.paths.offset_events import Lost
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import point_at, tangent_at
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.vector.motion_codes import motion_of

_LONGEST: Final = 1 / 32
"""How long sides are at most; relative to the cell's size. Walls twist, and triangles do not."""

_TURNING: Final = 1 / 16
"""As much of an edge as a radian of turning counts for; relative to the cell's size.

So corners within an edge have room along it: those of two layers lie side by side."""


class InsetRing(NamedTuple):
    """A ring of a tile that is drawn in: `points`, complex128 (n,), in millimetres, with the material on their left.

    Side k, from point k to the next, comes from what lies along the edge use `use[k]` (intp) of the layer at
    `share[k]` (float64): from 0 to 1, and from 1 to 2 in the corner at its end. `number` (intp, n) are those that
    points have in a mesh that is there already, None where they have none.
    """

    points: Complexes
    use: Ints
    share: Floats
    number: Ints | None = None


@dataclass(frozen=True, eq=False)
class LayerOutlines:
    """The outlines of a layer as chords, in millimetres: `paths` has a path for each of its rings.

    Segment k is part of the edge use `use[k]` (intp). Along this it begins, it ends, and the corner at its end ends at
    `along[k]` (float64, n x 3), from 0 at the start of the use to 1 at its end, and 2 behind the corner there. A ring
    that faces one copy all round counts as one use, its first, and has no such corner.
    """

    layer: ExactLayer
    size: float
    paths: Paths
    use: Ints
    along: Floats

    @classmethod
    def of(cls, layer: ExactLayer, unit: float, accuracy: float) -> LayerOutlines:
        """Chords within an accuracy, in millimetres, of the exact edges, which are in units of `unit` millimetres."""
        edges, ends = to_lines(layer.quotient.paths(), accuracy=accuracy / unit), layer.starts
        parts, uses, rings = [], [], []
        for first, last in pairwise(layer.ring_offsets.tolist()):
            loop, count = faces_one(layer, first), 0
            for use in range(first, last):
                part = edges.take(layer.edge[use : use + 1])
                turn, shift, conj = layer.action.isometry(motion_of(int(layer.motion[use])))
                part = (part.reversed() if layer.backwards[use] else part).moved(turn, shift, conj=conj)
                part.start[0], part.end[-1] = ends[use], ends[use + 1 if use + 1 < last else first]
                parts.append(part)
                uses += [first if loop else use] * len(part.start)
                count += len(part.start)
            rings.append(count)
        joined, closed = Paths.concatenate(parts).moved(unit, 0j), np.ones(len(rings), np.bool_)
        paths, owner = replace(joined, offsets=offsets_of(rings), closed=closed), np.array(uses, np.intp)
        size = layer.action.size * unit
        return cls(layer, size, paths, owner, _along(paths, owner, _TURNING * size))

    def inset(self, tile: int, distance: float, accuracy: float) -> tuple[list[InsetRing], tuple[Lost, ...]]:
        """The rings of a base tile that is drawn in by a distance, as chords within an accuracy, and what it lost.

        Raises OffsetError as `offset`.
        """
        region = self.paths.part(*self.layer.tile_offsets[tile : tile + 2].tolist())
        drawn = offset(region, -distance)
        assert drawn.feet is not None
        counts = np.maximum(np.ceil(chord_counts(drawn.paths, accuracy / 4)), 1.0).astype(np.intp)
        step, segment = counting(counts)
        points = point_at(drawn.paths, segment, step / counts[segment])
        begin, end = drawn.feet.share[segment].T
        source = drawn.feet.segment[segment] + int(self.paths.offsets[self.layer.tile_offsets[tile]])
        low, high, behind = self.along[source].T
        limits = []
        for k in (0, 1):
            share = begin + (end - begin) * ((step + k) / counts[segment])
            limits.append(np.where(share > 1.0, high + (behind - high) * (share - 1.0), low + (high - low) * share))
        bounds, longest = offsets_of(counts)[drawn.paths.offsets], _LONGEST * self.size
        return [
            _thinned(points[a:b], self.use[source[a:b]], limits[0][a:b], limits[1][a:b], 0.75 * accuracy, longest)
            for a, b in pairwise(bounds.tolist())
        ], drawn.lost

    def plain(self, tile: int, points: Complexes, number: Ints) -> InsetRing:
        """A ring of points on the outline of a base tile, with numbers that they have."""
        import shapely

        first, last = self.paths.offsets[self.layer.tile_offsets[tile : tile + 2]].tolist()
        start, way = self.paths.start[first:last], (self.paths.end - self.paths.start)[first:last]
        middle = (points + np.roll(points, -1)) / 2
        tree = shapely.STRtree(shapely.linestrings(np.stack((plane(start), plane(start + way)), axis=1)))
        near = tree.nearest(shapely.points(middle.real, middle.imag))
        share = np.clip(((middle - start[near]) / way[near]).real, 0.0, 1.0)
        low, high, _ = self.along[first + near].T
        return InsetRing(points, self.use[first + near], low + (high - low) * share, number)


def faces_one(layer: ExactLayer, use: int) -> bool:
    """Whether the ring of an edge use faces one copy all round."""
    ring = int(layer.ring[use])
    return len(set(layer.names[slice(*layer.ring_offsets[ring : ring + 2].tolist())])) == 1


def _thinned(points: Complexes, use: Ints, begin: Floats, end: Floats, accuracy: float, longest: float) -> InsetRing:
    """The ring of some points, few of which are left: those that go are within an accuracy of it; long sides are cut.

    The side from a point to the next lies beside its `use`, from `begin` to `end` along that.
    """
    import shapely

    changes = np.flatnonzero(use != np.roll(use, 1))
    turn = -int(changes[0]) if len(changes) else 0
    points, use, begin, end = np.roll(points, turn), np.roll(use, turn), np.roll(begin, turn), np.roll(end, turn)
    first = starts(use)
    counts = np.diff(np.append(first, len(use))) + 1
    run = np.repeat(np.arange(len(first)), counts)
    row = plane(np.append(points, points[0])[ranges(first, counts)])
    lines = shapely.simplify(shapely.linestrings(row, indices=run), accuracy)
    kept = np.flatnonzero(np.isin(points, shapely.get_coordinates(lines).view(np.complex128)))
    after = np.append(kept[1:], len(points))
    start, way = points[kept], np.append(points, points[0])[after] - points[kept]
    parts = np.maximum(np.ceil(np.abs(way) / longest), 1.0).astype(np.intp)
    step, side = counting(parts)
    low, high = begin[kept], end[after - 1]
    return InsetRing(
        (start[side] + way[side] * (step / parts[side])),
        use[kept][side],
        low[side] + (high - low)[side] * ((step + 0.5) / parts[side]),
    )


def _along(paths: Paths, use: Ints, turning: float) -> Floats:
    """Where segments lie along their uses, as of `LayerArcs`; a radian counts for as much as a length `turning`."""
    every, after = np.arange(len(use)), next_in_ring(paths.offsets)
    ahead, leaving = (tangent_at(paths, every, np.full(len(use), t)) for t in (1.0, 0.0))
    corner = np.abs(np.angle(leaving[after] * ahead.conj()))
    corner = np.where(use[after] == use, corner, 0.0)
    length = paths.lengths
    both, first = length + turning * corner, starts(use)
    owner = np.repeat(np.arange(len(first)), np.diff(np.append(first, len(use))))
    begin = np.cumsum(both) - both
    begin -= begin[first][owner]
    total = np.bincount(owner, weights=both)[owner]
    along = np.column_stack((begin, begin + length, begin + both)) / total[:, None]
    along[use[after] != use, 2] = 2.0
    return along

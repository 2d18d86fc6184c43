"""Prisms over regions of the plane, with or without a chamfer: their triangles, and where the corners of these are."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, plane
from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.solid.face_triangles import following, polygons, signed_area, triangulated
from voronoi_tiles.solid.mesh import TriangleMesh


class Face(NamedTuple):
    """A region of the plane: rings of points in millimetres, outer ones counter-clockwise, holes clockwise.

    Ring k are the points from offsets[k] up to, not including, offsets[k + 1]. `area` is that of the exact region,
    whose curves the points lie on; square millimetres. `forward`, None where nobody minds, says of each point whether
    the side from it to the next runs as its edge does: beside it a neighbour's runs backwards, and walls are alike.
    """

    points: Complexes
    offsets: Ints
    area: float
    forward: Bools | None = None


@dataclass(frozen=True, eq=False)
class Prism:
    """A prism as triangles over the points of its faces: `outer` is what its walls stand on.

    `inner` is the upper and lower face where a chamfer makes them smaller, None without one. Vertices are `layers`,
    from the lowest up, each a height in millimetres and whether it is the inner face. All copies of a tile have the
    same `triangles`, which close it: raises ProofError where they do not.
    """

    outer: Face
    inner: Face | None
    layers: tuple[tuple[float, bool], ...]
    triangles: Ints

    def __post_init__(self) -> None:
        if not TriangleMesh(np.zeros((int(self.triangles.max()) + 1, 3)), self.triangles).is_closed:
            raise ProofError("the faces of a solid do not close it")

    @classmethod
    def over(cls, face: Face, height: float) -> Prism:
        """The prism over a face."""
        after, count = following(face.points, face.offsets), len(face.points)
        cap = triangulated(face.points, polygons(face.points, face.offsets), after)
        triangles = np.concatenate([cap[:, ::-1], _walls(after, face.forward, 0, count), cap + count])
        return cls(face, None, ((0.0, False), (height, False)), triangles)

    @classmethod
    def chamfered(cls, outer: Face, inner: Face, height: float, chamfer: float) -> Prism:
        """The same whose rims run at 45 degrees: `inner`, what lies `chamfer` within `outer`, has a ring in each of it.

        Where the rim is a thin part's, which has no inner face, it is level.
        """
        n, m = len(outer.points), len(inner.points)
        after, within = following(outer.points, outer.offsets), following(inner.points, inner.offsets)
        cap = triangulated(inner.points, polygons(inner.points, inner.offsets), within)
        # Seen from the band between them the inner rings run the other way.
        points, back = np.concatenate([outer.points, inner.points]), np.argsort(within)
        band = triangulated(points, _bands(outer, inner), np.append(after, back + n))
        # Layers from below: inner, outer, outer, inner.
        below = np.where(band < n, band + m, band - n)[:, ::-1]
        above = band + (m + n)
        return cls(
            outer,
            inner,
            ((0.0, True), (chamfer, False), (height - chamfer, False), (height, True)),
            np.concatenate([cap[:, ::-1], below, _walls(after, outer.forward, m, m + n), above, cap + (m + 2 * n)]),
        )

    def mesh(self, outer: Complexes | None = None, inner: Complexes | None = None) -> TriangleMesh:
        """The solid where its faces have their points, or these."""
        base = None if self.inner is None else self.inner.points
        faces = (self.outer.points if outer is None else outer, base if inner is None else inner)
        rows = [(z, points) for z, within in self.layers if (points := faces[within]) is not None]
        return TriangleMesh(
            np.concatenate([np.column_stack((plane(points), np.full(len(points), z))) for z, points in rows]),
            self.triangles,
        )


def _walls(after: Ints, forward: Bools | None, low: int, high: int) -> Ints:
    """The triangles of upright walls from each point to the one after it, with the solid on their left.

    `low` and `high` are where the points' vertices begin in the lower and the upper layer. The diagonal of a wall rises
    along its edge, whichever way the side runs.
    """
    a, b = np.arange(len(after)), after
    along = np.ones(len(a), np.bool_) if forward is None else forward
    first = np.column_stack((a + low, b + low, np.where(along, b, a) + high))
    second = np.column_stack((np.where(along, a, b) + low, b + high, a + high))
    return np.concatenate((first, second))


def _bands(outer: Face, inner: Face) -> list[list[Ints]]:
    """What lies between the rings of two faces, a polygon each; the points of the inner one count after the others."""
    import shapely

    def rings(face: Face, first: int) -> list[tuple[Ints, bool, shapely.Polygon]]:
        """Each ring's indices, whether it is a hole, and what it encloses."""
        bounds = pairwise(face.offsets.tolist())
        parts = [(np.arange(a, b) + first, face.points[a:b]) for a, b in bounds]
        return [(own, signed_area(points) < 0, shapely.Polygon(plane(points))) for own, points in parts]

    within = rings(inner, len(outer.points))
    found = []
    for ring, hole, shape in rings(outer, 0):
        # An outer ring shrinks, a hole grows; of several that fit the nearest is its own.
        own = [
            (other, filled)
            for other, is_hole, filled in within
            if is_hole == hole and (filled.covers(shape) if hole else shape.covers(filled))
        ]
        if not own:
            raise ProofError("a chamfer has no edge")
        other, _ = min(own, key=lambda one: abs(float(one[1].area) - float(shape.area)))
        found.append([other[::-1], ring] if hole else [ring, other[::-1]])
    return found

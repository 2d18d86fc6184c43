"""A closed mesh of triangles: what solids are made as, and what their files hold."""

from __future__ import annotations

from math import fsum
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints


def point_numbers(points: Floats) -> Ints:
    """A number for each point, float64 (n, 3), the same for points with the same coordinates: intp (n,)."""
    order = np.lexsort(points.T)
    new = np.append(False, (points[order[1:]] != points[order[:-1]]).any(axis=1))
    number = np.empty(len(points), np.intp)
    number[order] = np.cumsum(new)
    return number


class TriangleMesh(NamedTuple):
    """A solid bounded by triangles: `vertices` float64 (n, 3) in millimetres, `triangles` intp (m, 3), indices of them.

    Seen from outside, the corners of a triangle run counter-clockwise.
    """

    vertices: Floats
    triangles: Ints

    @property
    def corners(self) -> Floats:
        """The corners of all triangles, float64 (m, 3, 3) in millimetres."""
        return self.vertices[self.triangles]

    @property
    def volume(self) -> float:
        """The enclosed volume in cubic millimetres, negative where the triangles are turned inside out."""
        if not len(self.triangles):
            return 0.0
        # From a point nearby, products are of the solid's size, wherever it stands.
        a, b, c = np.moveaxis(self.corners - self.vertices[0], 1, 0)
        return fsum(np.einsum("ij,ij->i", a, np.cross(b, c)).tolist()) / 6

    @property
    def centroid(self) -> Floats:
        """The centre of the enclosed volume, float64 (3,) in millimetres."""
        a, b, c = np.moveaxis(self.corners - self.vertices[0], 1, 0)
        parts = np.einsum("ij,ij->i", a, np.cross(b, c))
        return np.asarray(self.vertices[0] + (a + b + c).T @ parts / (4 * parts.sum()))

    @property
    def normals(self) -> Floats:
        """The unit normals of the triangles, outward, float64 (m, 3); 0 for a triangle without area."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        normal = np.cross(b - a, c - a)
        length = np.linalg.norm(normal, axis=1, keepdims=True)
        return np.asarray(normal / np.where(length > 0.0, length, 1.0))

    @property
    def areas(self) -> Floats:
        """The areas of the triangles in square millimetres, float64 (m,)."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)

    @property
    def euler_characteristic(self) -> int:
        """Vertices less sides and more triangles, of a mesh that is closed: each side is that of two triangles."""
        return len(self.vertices) - len(self.triangles) // 2

    @property
    def is_closed(self) -> bool:
        """Whether every side of a triangle is there once in each direction: the triangles enclose a solid."""
        sides = np.concatenate([self.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
        if not len(sides) or (sides[:, 0] == sides[:, 1]).any():
            return False
        count = len(self.vertices)
        there = np.sort(sides[:, 0] * count + sides[:, 1])
        back = np.sort(sides[:, 1] * count + sides[:, 0])
        return bool((there == back).all() and (there[1:] != there[:-1]).all())

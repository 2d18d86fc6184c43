"""In which directions a solid leaves the walls that it touches, and which of them leads it away from all the most."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Floats
from voronoi_tiles.solid.mesh import TriangleMesh, point_numbers

SLIDING: Final = 1e-8
"""A direction that leaves a wall by a smaller angle, or enters it by one, slides along it; radians. It is what the
rounding of normals leaves."""

_SLIVER: Final = 1e-6
"""Triangles that are narrower have no normal to rely on; relative to the solid's size."""

_SHARE: Final = 1e-9
"""Smaller weights are none; a share of the greatest."""

_ROUNDING: Final = 1e-13
"""Smaller coordinates of a direction are none; relative to its largest."""

_ROUNDS: Final = 200
"""How many walls are taken into account one by one at most; a count."""


def contacts(mesh: TriangleMesh, others: Sequence[TriangleMesh]) -> list[Bools]:
    """For each of the others which triangles of a mesh are its own, too, bit for bit, either way round: bool (m,)."""
    meshes = (mesh, *others)
    number = point_numbers(np.concatenate([one.vertices for one in meshes]))
    first = np.cumsum([0, *(len(one.vertices) for one in meshes)])
    corners = [np.sort(number[start + one.triangles], axis=1) for start, one in zip(first[:-1], meshes, strict=True)]
    keys = [np.ascontiguousarray(three).view(np.dtype((np.void, three.itemsize * 3))).ravel() for three in corners]
    return [np.isin(keys[0], other) for other in keys[1:]]


def reliable(mesh: TriangleMesh) -> Bools:
    """Which triangles of a mesh are wide enough for their normals to be right: bool (m,)."""
    sides = np.linalg.norm(mesh.corners - np.roll(mesh.corners, 1, axis=1), axis=2).max(axis=1)
    return np.asarray(2.0 * mesh.areas > _SLIVER * float(np.ptp(mesh.vertices, axis=0).max()) * sides)


def widest(normals: Floats, *, floor: bool) -> Floats | None:
    """The direction that leaves walls at the widest angle, a unit vector, float64 (3,); None where all enter one.

    `normals` are those of the walls, unit vectors out of the solid, float64 (m, 3); on a `floor` no direction leads
    down. Where none leaves all of them, it slides along some.

    The direction is the shortest x with n x <= -1 for all normals n, made a unit vector. Where there is no such x,
    normals with positive weights come to nothing, and a direction that enters none of them slides along all of these:
    it is looked for among those that do (Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23).
    """
    basis = np.eye(3)
    up = np.array([[0.0, 0.0, 1.0]]) if floor else np.zeros((0, 3))
    while basis.shape[1]:
        inner = normals @ basis
        length = np.linalg.norm(inner, axis=1)
        inner = inner[length > SLIDING] / length[length > SLIDING, None]
        if not len(inner):
            # Nothing is in the way.
            return _unit(basis[:, 0] if basis[2, 0] >= 0.0 else -basis[:, 0])
        direction, opposed = _shortest(inner, up @ basis)
        if direction is not None:
            return _unit(basis @ direction)
        # What is left is across all that are opposed to each other.
        _, size, rows = np.linalg.svd(opposed)
        rank = int(np.count_nonzero(size > 1e-6 * size[0]))
        basis = basis @ rows[rank:].T
    return None


def _unit(direction: Floats) -> Floats:
    """The unit vector of a direction, without what rounding left in its coordinates."""
    longest = np.abs(direction).max()
    found = np.where(np.abs(direction) > _ROUNDING * longest, direction, 0.0)
    return np.asarray(found / np.linalg.norm(found))


def _shortest(normals: Floats, up: Floats) -> tuple[Floats | None, Floats]:
    """The shortest x with n x <= -1 for all normals and up x >= 0; or None, and normals that oppose each other."""
    from scipy.optimize import nnls

    dimension = normals.shape[1]
    signs = np.array(np.meshgrid(*[[-1.0, 0.0, 1.0]] * dimension)).reshape(dimension, -1)
    used = np.unique((normals @ signs).argmax(axis=0)).tolist()
    x = np.zeros(dimension)
    for _ in range(_ROUNDS):
        rows = np.concatenate((-normals[used], up))
        level = np.append(np.ones(len(used)), np.zeros(len(up)))
        weights, _ = nnls(np.vstack((rows.T, level)), np.append(np.zeros(dimension), 1.0))
        rest = np.append(rows.T @ weights, level @ weights - 1.0)
        size = float(np.linalg.norm(rest))
        if size <= SLIDING:  # the sine of the angle that is left
            return None, rows[weights > _SHARE * weights.max()]
        x = rest[:-1] / size**2
        worst = int((normals @ x).argmax())
        if worst in used or normals[worst] @ x <= -1.0 + SLIDING:
            break
        used.append(worst)
    return x, rows[:0]

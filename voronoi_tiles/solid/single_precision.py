"""Meshes in single precision, as STL has them: what is left of their triangles, and the proof that it is a solid."""

from __future__ import annotations

from math import sqrt
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints
from voronoi_tiles.solid.mesh import TriangleMesh, point_numbers

VOLUME: Final = 1e-4
"""By how much the volume may change, relative to it: a layer of a printer, or a part of one, on a solid as large as its
bed."""


class RoundedAwayError(ValueError):
    """A mesh that rounding makes something else than the solid that it was; the text says what."""


def kept_triangles(mesh: TriangleMesh) -> Bools:
    """Which triangles of a closed mesh are left when its vertices are rounded to single precision: bool (m,).

    Those go two corners of which become one, and pairs that lie on each other, face to face. Raises RoundedAwayError
    where the rest is not closed, where it touches itself along sides where the mesh does not, or where its volume is
    another.
    """
    rounded = mesh.vertices.astype(np.float32).astype(np.float64)
    corners = point_numbers(rounded)[mesh.triangles]
    a, b, c = corners.T
    kept: Bools = (a != b) & (b != c) & (c != a)
    kept[kept] = ~_folded(corners[kept])
    there, back = _sides(corners[kept])
    if (there != back).any():
        raise RoundedAwayError("it is not closed")
    if _repeated(there) > _repeated(_sides(point_numbers(mesh.vertices)[mesh.triangles])[0]):
        raise RoundedAwayError("it touches itself where it did not")
    volume = TriangleMesh(rounded, mesh.triangles[kept]).volume
    # Along each axis points move by half a unit in the last place of the largest number at most.
    moved = sqrt(3.0) / 2 * float(np.spacing(np.abs(rounded).max().astype(np.float32)))
    if abs(volume - mesh.volume) > min(2.0 * moved * float(mesh.areas.sum()), VOLUME * mesh.volume):
        raise RoundedAwayError(f"it has {volume:.6g} cubic millimetres, and not {mesh.volume:.6g}")
    return kept


def _folded(corners: Ints) -> Bools:
    """Which triangles lie on another one that faces the other way."""
    first = corners.argmin(axis=1)
    turned = np.take_along_axis(corners, (first[:, None] + np.arange(3)) % 3, axis=1)
    size = int(corners.max(initial=0)) + 1
    low, high = turned[:, 1:].min(axis=1), turned[:, 1:].max(axis=1)
    _, name = np.unique((turned[:, 0] * size + low) * size + high, return_inverse=True)
    up = turned[:, 1] == low
    both = (np.bincount(name, up) > 0) & (np.bincount(name, ~up) > 0)
    return np.asarray(both[name], np.bool_)


def _sides(corners: Ints) -> tuple[Ints, Ints]:
    """The sides of triangles as numbers, ascending: as they run, and as they run backwards."""
    size = int(corners.max(initial=0)) + 1
    begin, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    return np.sort(begin * size + end), np.sort(end * size + begin)


def _repeated(sides: Ints) -> int:
    """How many sides, ascending, are there before."""
    return int(np.count_nonzero(sides[1:] == sides[:-1]))

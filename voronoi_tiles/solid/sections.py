"""Sections of meshes: whether levels, and what is half way between two, cross themselves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Floats, Ints
from voronoi_tiles.solid.mesh import TriangleMesh


class CrossedSections(NamedTuple):
    """The heights in millimetres at which a mesh crosses itself: `levels` where it has vertices, `between` half way."""

    levels: Floats
    between: Floats


def crossed_sections(mesh: TriangleMesh) -> CrossedSections:
    """The sections of a mesh whose vertices are at a few heights, and whose walls run from one to the next."""
    heights, level = np.unique(mesh.vertices[:, 2], return_inverse=True)
    corner = level[mesh.triangles]
    low = corner.min(axis=1)
    wall = np.flatnonzero(low < corner.max(axis=1))
    triangles, corner, low = mesh.triangles[wall], corner[wall], low[wall]
    # The corner that is alone at its height first: the sides that leave it cross the middle.
    alone = np.where((corner == low[:, None]).sum(axis=1) == 1, corner.argmin(axis=1), corner.argmax(axis=1))
    apex, *rest = np.take_along_axis(triangles, (alone[:, None] + np.arange(3)) % 3, axis=1).T
    plane = mesh.vertices[:, :2]
    middle = np.stack([(plane[apex] + plane[other]) / 2 for other in rest], axis=1)
    ends = np.stack([plane[other] for other in rest], axis=1)
    # Sides in a level are those of a triangle above and of one below: those below are enough, and those of the bottom.
    at = level[rest[0]]
    kept = (at > low) | (at == 0)
    between = _not_simple(middle, low)
    return CrossedSections(heights[_not_simple(ends[kept], at[kept])], (heights[between] + heights[between + 1]) / 2)


def _not_simple(sides: Floats, group: Ints) -> Ints:
    """The groups of sides, float64 (n, 2, 2), that have some which meet elsewhere than at their ends."""
    order = np.argsort(group, kind="stable")
    lines = shapely.multilinestrings(shapely.linestrings(sides[order]), indices=group[order])
    return np.unique(group)[~shapely.is_simple(lines)]

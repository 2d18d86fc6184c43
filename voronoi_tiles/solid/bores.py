"""Prisms with upright round holes through them, as meshes; proved by their volume."""

from __future__ import annotations

from math import acos, ceil, cos, fsum, pi
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, offsets_of
from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.solid.face_triangles import signed_area
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.prism import Face, Prism

_LEAST: Final = 8
"""Least corners of a hole; a count."""

_ROUNDING: Final = 64 * EPSILON
"""By how much the volume may differ from that without holes less theirs; relative to the cube around the solid."""


def bored(mesh: TriangleMesh, prism: Prism, centres: Complexes, radius: float, accuracy: float) -> TriangleMesh:
    """The mesh of a prism without chamfers, which stands on z = 0, with holes; millimetres.

    Holes are polygons around circles of the `radius`, no point of which is farther from these than `accuracy`: what
    fits the circle fits the hole. Raises ProofError where the result has not the volume that it should have.
    """
    outer = prism.outer
    count = len(outer.points)
    points = mesh.vertices[:count, 0] + 1j * mesh.vertices[:count, 1]
    rings = [_hole(centre, radius, accuracy) for centre in centres.tolist()]
    sizes = np.append(np.diff(outer.offsets), [len(ring) for ring in rings])
    forward = None
    if outer.forward is not None:
        forward = np.append(outer.forward, np.ones(sum(map(len, rings)), np.bool_))
    holes = -fsum(map(signed_area, rings))
    face = Face(np.concatenate([points, *rings]), offsets_of(sizes), outer.area - holes, forward)
    height = float(mesh.vertices[:, 2].max())
    made = Prism.over(face, height).mesh()
    if abs(mesh.volume - holes * height - made.volume) > _ROUNDING * float(np.abs(mesh.vertices).max()) ** 3:
        raise ProofError(f"a solid with holes has {made.volume:.6g} cubic millimetres")
    return made


def _hole(centre: complex, radius: float, accuracy: float) -> Complexes:
    """The corners of a hole, clockwise, the sides of which touch its circle."""
    count = max(_LEAST, ceil(pi / acos(radius / (radius + accuracy))))
    corner = radius / cos(pi / count)
    return np.asarray(centre + corner * np.exp(-2j * pi * (np.arange(count) + 0.5) / count))

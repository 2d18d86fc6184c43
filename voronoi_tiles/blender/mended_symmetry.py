"""Sites that are symmetric but for the rounding of their coordinates to single precision, made symmetric."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.neighbours import Neighbours
from voronoi_tiles.blender.drawn_splines import DrawnSpline
from voronoi_tiles.vector.copies import symmetrized
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, translated

ROUNDED: Final = 1e-6
"""How near the image of a point must be to a point for an operation to map a site onto itself; relative to the cell or
the farthest coordinate, whichever is larger. Sixteen times the rounding of a coordinate to float32: those of an object
that is moved and turned are rounded more than once."""


def symmetric_splines(action: Action, splines: Sequence[DrawnSpline]) -> tuple[DrawnSpline, ...]:
    """Splines of one site whose control points are where the operations that nearly keep them take them.

    Else copies that are meant to be one would touch: a circle about a threefold centre is never its own image in
    single precision. No point moves farther than what rounding may have moved it.
    """
    parts = [part for spline in splines for part in (spline.points, spline.left, spline.right)]
    points = np.concatenate([np.zeros(0, np.complex128), *parts])
    stabilizer = _stabilizer(action, points) if len(points) and np.isfinite(points).all() else (IDENTITY,)
    if len(stabilizer) == 1:
        return tuple(splines)
    moved = np.split(symmetrized(action, points, stabilizer), np.cumsum([len(part) for part in parts])[:-1])
    return tuple(
        spline._replace(points=moved[3 * k], left=moved[3 * k + 1], right=moved[3 * k + 2])
        for k, spline in enumerate(splines)
    )


def _stabilizer(action: Action, points: Complexes) -> tuple[Motion, ...]:
    """The motions that nearly map some points onto themselves, the identity first."""
    middle = complex(points.mean())
    close = ROUNDED * max(action.size, float(np.abs(points).max()))
    found = [IDENTITY]
    for motion in action.motions[1:]:
        x, y = action.fractional(middle - action.apply_to_point(motion, middle))
        candidate = translated(motion, round(x), round(y))
        if candidate[:4] == IDENTITY[:4] or abs(action.apply_to_point(candidate, middle) - middle) > close:
            continue
        images = action.apply(candidate, points)
        if max(Neighbours(a).nearest(b)[0].max() for a, b in ((points, images), (images, points))) <= close:
            found.append(candidate)
    return tuple(found)

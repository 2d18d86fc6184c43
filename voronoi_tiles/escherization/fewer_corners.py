"""Strokes of few corners whose tile is that of a stroke of many, within a distance."""

from __future__ import annotations

from typing import Final

import numpy as np
from shapely.geometry import LinearRing, Polygon

from voronoi_tiles.base.arrays import Complexes, Floats, plane
from voronoi_tiles.designs.design import Design
from voronoi_tiles.escherization.closed_design import DIGITS, MIRRORED_DIGITS, closed_design, corners_of, tiled
from voronoi_tiles.escherization.goal_outline import ring_corners
from voronoi_tiles.escherization.mirror_axis import MirrorAxis
from voronoi_tiles.escherization.outline_distance import largest_distance, towards
from voronoi_tiles.tiling import Tiling

_TOLERANCES: Final = (0.06, 0.04, 0.03, 0.02, 0.014, 0.01, 0.007, 0.005, 0.0035)
"""How far corners that are left out lie from the stroke, the most first; relative to the size."""

_STEPS: Final = 6
"""How many steps of least squares a stroke is led by; a count."""

_SAMPLES: Final = 400
"""At how many points of the tile its outline is compared; a count."""

_STILL: Final = 1e-9
"""Added to the mean square of the tile's velocities: where mirrors enclose it, so that it follows no corner, these are
noise, and so would the steps be."""

DISTANCE_STEP: Final = 4e-3
"""The step at which distances of outlines are sampled; relative to the size."""


def fewer_corners(tiling: Tiling, size: float, within: float, axis: MirrorAxis | None = None) -> Tiling | None:
    """The tiling of a stroke of fewer corners, its tile nowhere further than `within` from that of the whole one.

    The corners that are left are moved so that the tile comes as near as least squares of its distances along the
    normals lead, by the tile's gradient; the cell stays. Where the whole one is its own mirror image about an axis, as
    it has made it, this one is. None where no stroke of fewer corners is near enough.
    """
    accuracy = min(1e-4 * size, 0.1 * within)
    wanted: LinearRing = tiling[0].to_shapely(accuracy=accuracy).exterior
    whole = tiling.design
    corners = corners_of(whole)
    digits = DIGITS if axis is None else MIRRORED_DIGITS

    def written(fewer: Complexes) -> Design:
        return closed_design(whole.group, whole.cell, fewer, whole.name, size, digits)

    for tolerance in _TOLERANCES:
        fewer = _simplified(corners, tolerance * size, axis)
        if not 3 <= len(fewer) < len(corners):
            continue
        led = _led(written(fewer), wanted, axis)
        found = None if led is None else tiled(written(corners_of(led)))
        if found is None:
            continue
        ring = found[0].to_shapely(accuracy=accuracy).exterior
        if largest_distance(ring, wanted, DISTANCE_STEP * size) <= within:
            return found
    return None


def _simplified(corners: Complexes, tolerance: float, axis: MirrorAxis | None) -> Complexes:
    """A closed line without the corners that are so near to it without them, both halves alike where it has an axis."""
    if axis is None:
        return ring_corners(Polygon(plane(corners)).simplify(tolerance).exterior)
    return axis.completed(axis.seen(corners[: len(corners) // 2 + 1]), tolerance)


def _led(design: Design, wanted: LinearRing, axis: MirrorAxis | None) -> Design | None:
    """A design led towards an outline by its stroke's corners (Levenberg, Marquardt); None without a tile."""
    tiling = tiled(design)
    if tiling is None:
        return None
    gradient = tiling.shape_gradient("site")
    points = gradient[0].along(_SAMPLES)
    away = towards(points.place, points.normal, wanted)
    count = len(gradient.parameters)
    together = np.eye(count) if axis is None else _moved_together(count // 2, axis)
    damping = 1e-2
    for _ in range(_STEPS):
        velocity = points.velocity @ together
        squares = velocity.T @ velocity
        ridge = damping * (np.trace(squares) / count + _STILL)
        step = np.linalg.solve(squares + ridge * np.eye(count), velocity.T @ away)
        stepped = tiled(gradient.stepped(step))
        damping *= 10.0
        if stepped is None:
            continue
        new_gradient = stepped.shape_gradient("site")
        new_points = new_gradient[0].along(_SAMPLES)
        new_away = towards(new_points.place, new_points.normal, wanted)
        if new_away @ new_away < away @ away:
            tiling, gradient, points, away = stepped, new_gradient, new_points, new_away
            damping *= 0.03
    return tiling.design


def _moved_together(count: int, axis: MirrorAxis) -> Floats:
    """The projection of steps of corners' x and y to those that leave a line its own mirror image: (2 n, 2 n).

    The corners are n, those of MirrorAxis.completed. Least squares of projected numbers have no part beside them.
    """
    unit = axis.direction**2
    mirror = np.array([[unit.real, unit.imag], [unit.imag, -unit.real]])
    image = np.zeros((count, 2, count, 2))
    for k in range(count):
        image[k, :, -k % count, :] = mirror
    return np.asarray((np.eye(2 * count) + image.reshape(2 * count, 2 * count)) / 2.0)

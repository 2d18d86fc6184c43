"""Which copies of the tiles meet a region of the plane."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, to_operation
from voronoi_tiles.vector.tessellation import Tessellation

COPIES_MAX: Final = 1_000_000
"""Most copies that are looked at for one region; a count. Their outlines take gigabytes."""


def read_region(region: Any) -> Any:
    """A region as a shapely geometry: a rectangle (x0, y0, x1, y1), or what has `__geo_interface__`.

    Raises ArgumentError for what is none, is not finite, or crosses itself.
    """
    import shapely

    remedy = "Give x0, y0, x1, y1 with x0 <= x1 and y0 <= y1, or a valid geometry of shapely's."
    if hasattr(region, "__geo_interface__"):
        found = region if isinstance(region, shapely.Geometry) else shapely.geometry.shape(region)
        if not shapely.is_valid(found):
            raise ArgumentError(f"the `region` is no valid geometry: {shapely.is_valid_reason(found)}", remedy=remedy)
        return found
    try:
        x0, y0, x1, y1 = (float(side) for side in region)
    except (TypeError, ValueError):
        raise ArgumentError(f"the `region` {region!r} is no rectangle", remedy=remedy) from None
    if not (all(map(math.isfinite, (x0, y0, x1, y1))) and x0 <= x1 and y0 <= y1):
        raise ArgumentError(f"the `region` {x0:g}, {y0:g}, {x1:g}, {y1:g} is no rectangle", remedy=remedy)
    return shapely.box(x0, y0, x1, y1) if x0 < x1 and y0 < y1 else shapely.LineString([(x0, y0), (x1, y1)])


def copies_in_region(tessellation: Tessellation, region: Any) -> Iterator[tuple[int, Operation]]:
    """The copies of tiles that meet a region, as the tile's index and the operation that takes the tile there.

    `region` is what `read_region` gives. A copy meets it that comes as near as the outline's `display_accuracy`: none
    that has a point in common with the region is left out. Operations are those that outlines name neighbours by.
    Raises ArgumentError where there would be more than COPIES_MAX.
    """
    import shapely

    if region.is_empty:
        return
    action = tessellation.action
    low_x, low_y, high_x, high_y = region.bounds
    for tile, placed in enumerate(tessellation.placed):
        back = (*IDENTITY[:4], -2 * placed.shift[0], -2 * placed.shift[1])
        for motion in placed.representatives:
            outline = tessellation.placed_outline(tile, motion)
            near = outline.display_accuracy
            shape = outline.to_shapely(accuracy=near)
            left, bottom, right, top = outline.bounds
            box = (low_x - right - near, low_y - top - near, high_x - left + near, high_y - bottom + near)
            steps = _steps_in(box, action)
            away = action.cartesian(steps[:, 0], steps[:, 1])
            # The region is moved, not the tile: one of them has to be, and a rectangle has fewer points.
            moved = _moved(region, -away)
            for i, j in steps[shapely.dwithin(moved, shape, near)].tolist():
                there: Motion = (*motion[:4], motion[4] + 2 * i, motion[5] + 2 * j)
                yield tile, to_operation(compose(there, back))


def _steps_in(box: tuple[float, float, float, float], action: Action) -> Ints:
    """The lattice vectors i a + j b in a box, and at most those about it: (i, j) as intp (n, 2)."""
    x0, y0, x1, y1 = box
    corners = np.array([complex(x, y) for x in (x0, x1) for y in (y0, y1)])
    # Over the shortest basis, in which the box is hardly longer than it is.
    ranges = [
        np.arange(math.floor(part.min()), math.ceil(part.max()) + 1)
        for part in action.lattice.reduced.fractional(corners)
    ]
    if len(ranges[0]) * len(ranges[1]) > COPIES_MAX:
        raise ArgumentError(
            "the `region` holds millions of tiles", remedy=f"Take a smaller one: {COPIES_MAX:,} copies are the most."
        )
    steps = np.stack(np.meshgrid(*ranges, indexing="ij"), axis=-1).reshape(-1, 2) @ np.array(action.reduced)
    z = action.cartesian(steps[:, 0], steps[:, 1])
    return np.asarray(steps[(z.real >= x0) & (z.real <= x1) & (z.imag >= y0) & (z.imag <= y1)], np.intp)


def _moved(region: Any, shifts: Any) -> Any:
    """A geometry moved by each of some vectors, complex (n,)."""
    import shapely

    moved = np.repeat(region, len(shifts))
    points = shapely.get_coordinates(region)
    shift = np.stack((shifts.real, shifts.imag), axis=1)
    return shapely.set_coordinates(moved, (points[None] + shift[:, None]).reshape(-1, 2))

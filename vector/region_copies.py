"""Which copies of the tiles meet a region of the plane."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.base.values import shown
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, to_operation
from voronoi_tiles.vector.tessellation import Tessellation

COPIES_MAX: Final = 100_000
"""Most copies that are looked at for one region; a count. Their outlines take gigabytes, and a minute."""

_AT_ONCE: Final = 1_000_000
"""Points of moved regions that are held at once; a count."""


def read_region(region: Any) -> Any:
    """A region as a shapely geometry: a rectangle (x0, y0, x1, y1), or what has `__geo_interface__`.

    Raises ArgumentError for what is none, is not finite, or crosses itself.
    """
    import shapely

    remedy = "Give x0, y0, x1, y1 with x0 <= x1 and y0 <= y1, or a valid geometry of shapely's."
    if hasattr(region, "__geo_interface__"):
        try:
            found = region if isinstance(region, shapely.Geometry) else _united(region.__geo_interface__)
        except Exception as error:  # whatever a geometry of others is made of
            raise ArgumentError("the `region` is no geometry that shapely reads", remedy=remedy) from error
        farthest = max(map(abs, found.bounds), default=0.0)
        if farthest > COORDINATE_MAX:
            raise ArgumentError(
                f"the `region` reaches to {farthest:g}", remedy=f"Its coordinates must be within {COORDINATE_MAX:g}."
            )
        if not shapely.is_valid(found):
            raise ArgumentError(f"the `region` is no valid geometry: {shapely.is_valid_reason(found)}", remedy=remedy)
        return found
    try:
        x0, y0, x1, y1 = (float(side) for side in region)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"the `region` {shown(region)} is no rectangle", remedy=remedy) from None
    if not (max(map(abs, (x0, y0, x1, y1))) <= COORDINATE_MAX and x0 <= x1 and y0 <= y1):
        raise ArgumentError(f"the `region` {x0:g}, {y0:g}, {x1:g}, {y1:g} is no rectangle", remedy=remedy)
    return shapely.box(x0, y0, x1, y1) if x0 < x1 and y0 < y1 else shapely.LineString([(x0, y0), (x1, y1)])


def _united(geometry: Mapping[str, Any]) -> Any:
    """A geometry as GeoJSON has it, or the union of a FeatureCollection's, such as a tiling's own."""
    import shapely

    if geometry.get("type") == "FeatureCollection":
        return shapely.union_all([_united(feature) for feature in geometry["features"]])
    return shapely.geometry.shape(geometry["geometry"] if geometry.get("type") == "Feature" else geometry)


def copies_in_region(tessellation: Tessellation, region: Any) -> Iterator[tuple[int, Operation]]:
    """The copies of tiles that meet a region, as the tile's index and the operation that takes the tile there.

    `region` is what `read_region` gives. A copy meets it that comes as near as the outline's `display_accuracy`: none
    that has a point in common with the region is left out. Operations are those that outlines name neighbours by.
    Raises ArgumentError where more than COPIES_MAX lie in the box around the region.
    """
    import shapely

    if region.is_empty:
        return
    action = tessellation.action
    low_x, low_y, high_x, high_y = region.bounds
    looked_at = 0
    for tile, placed in enumerate(tessellation.placed):
        back = (*IDENTITY[:4], -2 * placed.shift[0], -2 * placed.shift[1])
        for motion in placed.representatives:
            outline = tessellation.placed_outline(tile, motion)
            near = outline.display_accuracy
            shape = outline.to_shapely(accuracy=near)
            left, bottom, right, top = outline.bounds
            box = (low_x - right - near, low_y - top - near, high_x - left + near, high_y - bottom + near)
            steps = _steps_in(box, action)
            looked_at += len(steps)
            _refuse_too_many(looked_at)
            # One of the two is moved: the region back to the tile, or the tile, whichever has fewer points.
            points, others = shapely.get_num_coordinates([region, shape]).tolist()
            moving, still, sign = (region, shape, -1) if points < others else (shape, region, 1)
            shapely.prepare(still)
            for part in np.array_split(steps, 1 + len(steps) * min(points, others) // _AT_ONCE):
                moved = _moved(moving, sign * action.cartesian(part[:, 0], part[:, 1]))
                for i, j in part[shapely.dwithin(still, moved, near)].tolist():
                    there: Motion = (*motion[:4], motion[4] + 2 * i, motion[5] + 2 * j)
                    yield tile, to_operation(compose(there, back))


def _refuse_too_many(copies: int) -> None:
    """Raise ArgumentError for more copies than COPIES_MAX."""
    if copies > COPIES_MAX:
        raise ArgumentError(
            f"more than {COPIES_MAX:,} copies of tiles lie in the box around the `region`",
            remedy="Take smaller ones, one by one.",
        )


def _steps_in(box: tuple[float, float, float, float], action: Action) -> Ints:
    """The lattice vectors i a + j b in a box: (i, j) as intp (n, 2). Raises ArgumentError for too many."""
    x0, y0, x1, y1 = box
    corners = np.array([complex(x, y) for x in (x0, x1) for y in (y0, y1)])
    # Over the shortest basis, in which the box is hardly longer than it is.
    u, v = (
        range(math.floor(part.min()), math.ceil(part.max()) + 1) for part in action.lattice.reduced.fractional(corners)
    )
    _refuse_too_many(len(u) * len(v))
    steps = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2) @ np.array(action.reduced)
    z = action.cartesian(steps[:, 0], steps[:, 1])
    return np.asarray(steps[(z.real >= x0) & (z.real <= x1) & (z.imag >= y0) & (z.imag <= y1)], np.intp)


def _moved(geometry: Any, shifts: Any) -> Any:
    """A geometry moved by each of some vectors, complex (n,)."""
    import shapely

    moved = np.repeat(geometry, len(shifts))
    points = shapely.get_coordinates(geometry)
    shift = np.stack((shifts.real, shifts.imag), axis=1)
    return shapely.set_coordinates(moved, (points[None] + shift[:, None]).reshape(-1, 2))

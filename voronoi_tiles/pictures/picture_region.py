"""The region that a picture shows, in the picture's own shape."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.tolerance import COORDINATE_MAX, EPSILON, NUMBER_MIN
from voronoi_tiles.base.values import is_number, shown
from voronoi_tiles.pictures.picture_size import SIDE_MAX
from voronoi_tiles.raster.picture import Region


def fitted_region(region: Region, size: int | tuple[int, int]) -> tuple[Region, int, int]:
    """The region, grown to the shape of the picture, and the picture's width and height in pixels.

    Raises ArgumentError for what is no rectangle or no size, and where pixels would be as small as the rounding.
    """
    remedy = "Give x0,y0,x1,y1 with x0 < x1 and y0 < y1."
    try:
        x0, y0, x1, y1 = (float(side) for side in region)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"the `region` {shown(region)} is no rectangle", remedy=remedy) from None
    finite = all(map(math.isfinite, (x0, y0, x1, y1)))
    if not (finite and x1 > x0 and y1 > y0):
        what = "is empty" if finite else "is not finite"
        raise ArgumentError(f"the `region` {x0:g},{y0:g},{x1:g},{y1:g} {what}", remedy=remedy)
    farthest = max(map(abs, (x0, y0, x1, y1)))
    if farthest > COORDINATE_MAX:
        raise ArgumentError(
            f"the `region` reaches to {farthest:g}", remedy=f"Its coordinates must be within {COORDINATE_MAX:g}."
        )
    across, down = x1 - x0, y1 - y0
    sides: tuple[Any, ...] = size if isinstance(size, tuple) else (size,)
    whole = all(is_number(side) and isinstance(side, int | np.integer) and -(2**63) < side < 2**63 for side in sides)
    if not (whole and len(sides) == (2 if isinstance(size, tuple) else 1)):
        raise ArgumentError(f"a `size` of {shown(size)} pixels", remedy="Give whole numbers, one or two.")
    if isinstance(size, tuple):
        width, height = map(int, sides)
    else:  # a strip is one pixel wide at least
        width, height = (max(min(size, 1), round(size * side / max(across, down))) for side in (across, down))
    if not (1 <= width <= SIDE_MAX and 1 <= height <= SIDE_MAX):
        raise ArgumentError(
            f"a picture of {width} x {height} pixels", remedy=f"Choose sides from 1 to {SIDE_MAX:,} pixels."
        )
    step = max(across / width, down / height)
    if step < max(100 * EPSILON * farthest, NUMBER_MIN):
        raise ArgumentError(
            f"the pixels would be {step:.3g} wide, no more than the rounding of coordinates of {farthest:g}",
            remedy="Show a larger region, or one nearer to the origin.",
        )
    middle = (x0 + x1) / 2, (y0 + y1) / 2
    grown = (
        middle[0] - step * width / 2,
        middle[1] - step * height / 2,
        middle[0] + step * width / 2,
        middle[1] + step * height / 2,
    )
    return grown, width, height

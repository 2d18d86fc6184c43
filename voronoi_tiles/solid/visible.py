"""What is seen of triangles: for each pixel the nearest of those that cover its middle."""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints, ranges

_CHUNK: Final = 1_000_000
"""Covered pixels of triangles that are compared at once; a count. Bounds the memory, for each, to 200 bytes."""

NOTHING: Final = -1
"""What is seen where no triangle is."""


def seen(corners: Floats, width: int, rows: range) -> Ints:
    """The triangle that is seen in each pixel of some rows, NOTHING where there is none: intp (len(rows), width).

    `corners` float64 (m, 3, 3) are x to the right and y down in pixels, and the depth: the greater, the nearer. The
    middle of the first pixel of row 0 is at (0.5, 0.5).
    """
    nearest = np.full(width * len(rows), -np.inf)
    found = np.full(width * len(rows), NOTHING, np.intp)
    top, bottom = corners[:, :, 1].min(axis=1), corners[:, :, 1].max(axis=1)
    first = np.clip(np.ceil(top - 0.5), rows.start, rows.stop).astype(np.intp)
    count = np.clip(np.ceil(bottom - 0.5), rows.start, rows.stop).astype(np.intp) - first
    area = count * (np.ptp(corners[:, :, 0], axis=1) + 1.0)
    bounds = np.searchsorted(np.cumsum(area), np.arange(_CHUNK, area.sum() + _CHUNK, _CHUNK)) + 1
    for some in np.split(np.arange(len(corners)), bounds[bounds < len(corners)]):
        pixel, triangle, depth = _covered(corners[some], first[some], count[some], width)
        pixel -= rows.start * width
        np.maximum.at(nearest, pixel, depth)
        won = depth == nearest[pixel]
        found[pixel[won]] = some[triangle[won]]
    return found.reshape(len(rows), width)


def _covered(corners: Floats, first: Ints, rows: Ints, width: int) -> tuple[Ints, Ints, Floats]:
    """The pixels that triangles cover: number of the pixel, triangle and depth, one row of each after the other."""
    triangle = np.repeat(np.arange(len(corners)), rows)
    row = ranges(first, rows)
    y = row.astype(np.float64) + 0.5
    low, high = np.full(len(row), np.inf), np.full(len(row), -np.inf)
    for k in range(3):
        a, b = corners[triangle, k], corners[triangle, (k + 1) % 3]
        rise = b[:, 1] - a[:, 1]
        t = (y - a[:, 1]) / np.where(rise == 0.0, 1.0, rise)
        met = (rise != 0.0) & (t >= 0.0) & (t <= 1.0)
        x = a[:, 0] + t * (b[:, 0] - a[:, 0])
        low, high = np.where(met, np.minimum(low, x), low), np.where(met, np.maximum(high, x), high)
    begin = np.clip(np.ceil(low - 0.5), 0, width)
    count = np.clip(np.where(low <= high, np.clip(np.ceil(high - 0.5), 0, width) - begin, 0), 0, None).astype(np.intp)
    begin = np.where(count > 0, begin, 0).astype(np.intp)
    column, owner = ranges(begin, count), np.repeat(np.arange(len(row)), count)
    of = triangle[owner]
    depth = _plane_at(corners, of, column.astype(np.float64) + 0.5, y[owner])
    return row[owner] * width + column, of, depth


def _plane_at(corners: Floats, triangle: Ints, x: Floats, y: Floats) -> Floats:
    """The depth of triangles' planes at places."""
    weights = barycentric(corners, triangle, x, y)
    return np.asarray((weights * corners[triangle, :, 2]).sum(axis=1))


def barycentric(corners: Floats, triangle: Ints, x: Floats, y: Floats) -> Floats:
    """The weights of the corners of triangles at places, float64 (n, 3); those of one seen from its edge are thirds."""
    (ax, ay), (bx, by), (cx, cy) = (corners[:, k, :2].T for k in range(3))
    twice = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    flat = twice == 0.0
    scale = 1.0 / np.where(flat, 1.0, twice)
    dx, dy = x - ax[triangle], y - ay[triangle]
    b = (dx * (cy - ay)[triangle] - dy * (cx - ax)[triangle]) * scale[triangle]
    c = (dy * (bx - ax)[triangle] - dx * (by - ay)[triangle]) * scale[triangle]
    weights = np.column_stack((1.0 - b - c, b, c))
    weights[flat[triangle]] = 1 / 3
    return weights

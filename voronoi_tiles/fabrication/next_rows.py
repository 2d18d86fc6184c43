"""The lowest next rows of lattices: how near above a row of copies of a region another such row may begin.

A row is a region at all multiples of a vector. Upright lines, that part the vector's length, pass through its copies:
where one leaves the last part that it is in, another row may begin, if no sum of multiples of both vectors lies
within the region.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.kernels import COMPLEXES, FLOAT, FLOATS, INT, INTS, kernel

_NUDGE: Final = 1e-5
"""A place that is less within a region, in x or in y, lies on its border; millimetres. As in next_rows.c, as the
next."""

_MULTIPLES: Final = 8
_ABOVE: Final = 6
"""The multiples of vectors along a row, and upwards, that are looked at; counts."""

_TRIES: Final = 16
"""How many levels are tried above a row, the lowest ones; a count."""

_COMPILED = kernel(
    "lattice_next_rows",
    INT,
    *2 * [FLOATS],
    INT,
    COMPLEXES,
    *2 * [FLOAT],
    *2 * [INT],
    *2 * [INTS],
    *2 * [FLOATS],
    INT,
    COMPLEXES,
)


def next_rows(edges: Floats, rows: Complexes, least: float, most: float, lines: int) -> Complexes:
    """The lowest row above each, complex128 (n,); 0 where none has cells of an area between `least` and `most`.

    `edges` (m, 4) have the region to their left, from x and y to x and y, and may overlap.
    """
    box = np.concatenate(
        (np.minimum(edges[:, :2], edges[:, 2:]).min(axis=0), np.maximum(edges[:, :2], edges[:, 2:]).max(axis=0))
    )
    compiled = _COMPILED()
    if compiled is None:
        return np.array([_next_row(edges, box, row, least, most, lines) for row in rows.tolist()], np.complex128)
    found, room = np.zeros(len(rows), np.complex128), 64 * len(edges)
    while room:
        scratch = [np.empty(lines + 1, np.int64) for _ in range(2)], [np.empty((room, 3)) for _ in range(2)]
        missing = compiled(
            len(edges), edges, box, len(rows), rows, least, most, lines, _TRIES, *scratch[0], *scratch[1], room, found
        )
        room = 2 * missing
    return found


def _next_row(edges: Floats, box: Floats, row: complex, least: float, most: float, lines: int) -> complex:
    """What next_rows.c does for a row, by numpy."""
    step = float(np.sqrt(row.real * row.real + row.imag * row.imag))
    along = np.arange(1.0, _ABOVE + 1)
    if _within(edges, box, along * row.real, along * row.imag).any():
        return 0j
    a, b = row.real / step, row.imag / step
    line, level, free = _passages(edges, a, b, step, lines)
    low = least / step
    for _ in range(_TRIES):
        open_ = np.flatnonzero(free & (level > low) & (level < most / step))
        if not len(open_):
            return 0j
        best = open_[np.lexsort((line[open_], level[open_]))[0]]
        low = float(level[best])
        x = (float(line[best]) + 0.5) * (step / lines)
        v = complex(x * a - low * b, x * b + low * a)
        j, i = np.meshgrid(along, np.arange(-_MULTIPLES, _MULTIPLES + 1.0))
        if not _within(edges, box, j * v.real + i * row.real, j * v.imag + i * row.imag).any():
            return v
    return 0j


def _passages(edges: Floats, a: float, b: float, step: float, lines: int) -> tuple[Ints, Floats, Bools]:
    """Of upright lines through a row: for each passage of the region's border its line, its level, if it leads out."""
    x0, y0 = edges[:, 0] * a + edges[:, 1] * b, edges[:, 1] * a - edges[:, 0] * b
    x1, y1 = edges[:, 2] * a + edges[:, 3] * b, edges[:, 3] * a - edges[:, 2] * b
    width = step / lines
    from_, to = (np.ceil(x / width - 0.5).astype(np.int64) for x in (x0, x1))
    count = np.abs(to - from_)
    edge = np.repeat(np.arange(len(edges)), count)
    number = np.minimum(from_, to)[edge] + np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = (y1 - y0) / (x1 - x0)
    level = y0[edge] + ((number + 0.5) * width - x0[edge]) * slope[edge]
    line, way = number % lines, np.sign(to - from_)[edge]
    order = np.lexsort((level, line))
    line, level, way = line[order], level[order], way[order]
    inside = np.cumsum(way)
    return line, level, np.asarray(inside <= 0)


def _within(edges: Floats, box: Floats, x: Floats, y: Floats) -> Bools:
    """Whether places lie in the region, and not on its border."""
    x, y = x.ravel(), y.ravel()
    result = (x > box[0]) & (x < box[2]) & (y > box[1]) & (y < box[3])
    for dx, dy in ((-_NUDGE, -_NUDGE), (_NUDGE, -_NUDGE), (_NUDGE, _NUDGE), (-_NUDGE, _NUDGE)):
        near = np.flatnonzero(result)
        result[near] = _winding(edges, x[near] + dx, y[near] + dy) > 0
    return np.asarray(result)


def _winding(edges: Floats, x: Floats, y: Floats) -> Ints:
    """How many times edges wind around places."""
    x0, y0, x1, y1 = edges.T
    x, y = x[:, None], y[:, None]
    low, high = y0 <= y, y1 > y
    left = (x0 - x) * (y1 - y) - (y0 - y) * (x1 - x)
    return np.asarray((low & high & (left > 0.0)).sum(axis=1) - (~low & ~high & (left < 0.0)).sum(axis=1))

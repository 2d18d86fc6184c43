"""Areas drawn in an image: how much of each pixel lies within closed outlines, exactly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting

Floats32 = NDArray[np.float32]


def area_coverage(start: Complexes, end: Complexes, width: int, height: int) -> Floats32:
    """How much of each pixel lies within closed polygons: float32 (height, width), 0 to 1.

    The polygons' sides run from `start` to `end` (complex128, n), in any order; x is in columns and y, the imaginary
    part, in rows, of which pixel (j, i) has i to i + 1 and j to j + 1. Outlines run one way round and their holes the
    other; what several cover counts once.

    Source: the signed areas between a side and the picture's right border, pixel by pixel, as in font-rs (R. Levien).
    """
    z, step = _split_at_pixels(start, end)
    rows, columns = np.floor(z.imag).astype(np.intp), np.floor(z.real).astype(np.intp)
    seen = (rows >= 0) & (rows < height) & (columns < width)
    rows, columns, rise, x = rows[seen], columns[seen], step.imag[seen], z.real[seen]
    left = columns < 0
    beyond = np.where(left, 0.0, rise * (x - columns))
    column = np.where(left, 0, columns)
    # One column more takes what reaches beyond the last pixel.
    size = height * (width + 1)
    at = rows * (width + 1) + column
    change = np.bincount(at, rise - beyond, size) + np.bincount(at + 1, beyond, size)[:size]
    covered = np.abs(np.cumsum(change.reshape(height, width + 1), axis=1)[:, :width])
    return np.minimum(covered, 1.0).astype(np.float32)


def _split_at_pixels(start: Complexes, end: Complexes) -> tuple[Complexes, Complexes]:
    """Cut sides where they cross from one pixel to the next: the middles of the parts, and their steps."""
    count = len(start)
    whole = np.arange(count)
    cuts, owners = [np.zeros(count), np.ones(count)], [whole, whole]
    for a, b in ((start.real, end.real), (start.imag, end.imag)):
        t, of = _cuts(a, b)
        cuts.append(t)
        owners.append(of)
    t, of = np.concatenate(cuts), np.concatenate(owners)
    order = np.lexsort((t, of))
    t, of = t[order], of[order]
    same = of[1:] == of[:-1]
    low, high, of = t[:-1][same], t[1:][same], of[1:][same]
    step = (end - start)[of]
    return start[of] + (low + high) / 2 * step, (high - low) * step


def _cuts(a: Floats, b: Floats) -> tuple[Floats, Ints]:
    """The parameters, 0 to 1, at which values that run from a to b are whole numbers, and the run of each."""
    low, high = np.minimum(a, b), np.maximum(a, b)
    first = np.ceil(low)
    number, of = counting(np.maximum(np.floor(high) - first + 1, 0).astype(np.intp))
    length = (b - a)[of]
    moving = length != 0.0
    number, of, length = number[moving], of[moving], length[moving]
    return np.clip((first[of] + number - a[of]) / length, 0.0, 1.0), of

"""Arrays: the names of their types, and indices into rows of different lengths that stand one after the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Complexes = NDArray[np.complex128]
Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Bools = NDArray[np.bool_]


def offsets_of(counts: ArrayLike) -> Ints:
    """Where rows of these lengths begin that stand one after the other, and where the last ends: intp (rows + 1)."""
    counts = np.asarray(counts, np.intp)
    offsets = np.zeros(len(counts) + 1, np.intp)
    counts.cumsum(out=offsets[1:])
    return offsets


def counts_of(offsets: Ints) -> Ints:
    """The lengths of rows that stand one after the other, from where they begin and the last ends; see `offsets_of`."""
    return offsets[1:] - offsets[:-1]


def plane(points: Complexes) -> Floats:
    """Points as rows of x and y, float64 (..., 2)."""
    return np.stack((points.real, points.imag), axis=-1)


def from_plane(points: Floats) -> Complexes:
    """Rows of x and y, (..., 2), as points: the inverse of `plane`."""
    return np.asarray(points[..., 0] + 1j * points[..., 1])


def ranges(first: Ints, counts: Ints) -> Ints:
    """The numbers first[0], first[0] + 1, ... (counts[0] of them), then those from first[1], and so on."""
    ends = counts.cumsum()
    if not len(ends) or not ends[-1]:
        return np.zeros(0, np.intp)
    numbers: Ints = (first - ends + counts).repeat(counts)
    numbers += np.arange(ends[-1])
    return numbers


def owned_ranges(first: Ints, last: Ints) -> tuple[Ints, Ints]:
    """The numbers from first[k] up to, not including, last[k], one k after the other; and the k of each."""
    counts = last - first
    return ranges(first, counts), np.repeat(np.arange(len(counts)), counts)


def counting(counts: Ints) -> tuple[Ints, Ints]:
    """The numbers 0 ... counts[k] - 1, one k after the other; and the k of each."""
    owner = np.arange(len(counts)).repeat(counts)
    return np.arange(len(owner)) - (counts.cumsum() - counts)[owner], owner


def next_in_ring(offsets: Ints) -> Ints:
    """The index of what follows each entry in its ring, the last one by the first.

    The entries of ring k are those from offsets[k] up to, not including, offsets[k + 1] (intp, r + 1); none is empty.
    """
    following = np.arange(1, int(offsets[-1]) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    return following


def backwards(offsets: Ints) -> Ints:
    """The order in which each ring is run through backwards, ring after ring; `offsets` as in `next_in_ring`."""
    ring = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    return np.asarray((offsets[:-1] + offsets[1:] - 1)[ring] - np.arange(int(offsets[-1])))


def starts(values: NDArray[np.generic]) -> Ints:
    """Where runs of equal values begin; the array is not empty."""
    changes = (values[1:] != values[:-1]).nonzero()[0]
    begin = np.zeros(len(changes) + 1, np.intp)
    np.add(changes, 1, out=begin[1:])
    return begin


def first_least(value: NDArray[np.float64], of: Ints, count: int) -> Ints:
    """The index of the first least value of each owner 0 ... count - 1; `of` ascends and has them all."""
    start = np.searchsorted(of, np.arange(count))
    hit = np.flatnonzero(value == np.minimum.reduceat(value, start)[of])
    return hit[np.searchsorted(of[hit], np.arange(count))]

"""Indices into rows of different lengths that stand one after the other in one array."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.intp]


def ranges(first: Ints, last: Ints) -> tuple[Ints, Ints]:
    """The numbers from first[k] up to, not including, last[k], one k after the other; and the k of each."""
    size = last - first
    of = np.repeat(np.arange(len(size)), size)
    return np.arange(int(size.sum())) + np.repeat(first - (np.cumsum(size) - size), size), of


def counting(size: Ints) -> tuple[Ints, Ints]:
    """The numbers 0 ... size[k] - 1, one k after the other; and the k of each."""
    return ranges(np.zeros_like(size), size)


def starts(values: NDArray[np.generic]) -> Ints:
    """Where runs of equal values begin; the array is not empty."""
    return np.flatnonzero(np.append(True, values[1:] != values[:-1]))


def first_least(value: NDArray[np.float64], of: Ints, count: int) -> Ints:
    """The index of the first least value of each owner 0 ... count - 1; `of` ascends and has them all."""
    start = np.searchsorted(of, np.arange(count))
    hit = np.flatnonzero(value == np.minimum.reduceat(value, start)[of])
    return hit[np.searchsorted(of[hit], np.arange(count))]

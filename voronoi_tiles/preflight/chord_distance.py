"""Pairs of chords: how near they are and where, and the runs that neighbouring pairs make along two paths."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.preflight.chords import Chords

_TINY: Final = 1e-200
"""No length, and no square of one; a coordinate, of 1e12 at most, divided by it is still a number."""


class Nearest(NamedTuple):
    """The nearest points of two chords: their shares of the chords, from 0 to 1, the points, and the distance."""

    share_one: Floats
    share_two: Floats
    one: Complexes
    two: Complexes
    distance: Floats

    def take(self, which: Bools) -> Nearest:
        """Some of the pairs."""
        return Nearest._make(column[which] for column in self)

    @classmethod
    def concatenate(cls, parts: Sequence[Nearest]) -> Nearest:
        """All pairs of several."""
        return cls._make(np.concatenate(column) for column in zip(*parts, strict=True))


def divisor(length: Floats) -> Floats:
    """What shares of lengths are taken by: 1 where a length is so small that a quotient might overflow."""
    return np.where(length > _TINY, length, 1.0)


def dot(u: Complexes, v: Complexes) -> Floats:
    """The scalar product of vectors."""
    return u.real * v.real + u.imag * v.imag


def cross(u: Complexes, v: Complexes) -> Floats:
    """The area of the parallelogram of two vectors, > 0 where the second lies to the left of the first."""
    return u.real * v.imag - u.imag * v.real


def nearest(chords: Chords, one: Ints, two: Ints) -> Nearest:
    """Where pairs of chords are nearest: at their crossing, or at an end of one of them."""
    a, b, c, d = chords.start[one], chords.end[one], chords.start[two], chords.end[two]
    shares = np.empty((5, 2, len(one)))
    shares[0] = np.zeros(len(one)), foot_share(a, c, d)
    shares[1] = np.ones(len(one)), foot_share(b, c, d)
    shares[2] = foot_share(c, a, b), np.zeros(len(one))
    shares[3] = foot_share(d, a, b), np.ones(len(one))
    area = cross(b - a, d - c)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        t, u = cross(c - a, d - c) / area, cross(c - a, b - a) / area
    crossing = (area != 0) & (t >= 0) & (t <= 1) & (u >= 0) & (u <= 1)
    shares[4] = np.where(crossing, t, 0.0), np.where(crossing, u, 0.0)
    on_one, on_two = a + shares[:, 0] * (b - a), c + shares[:, 1] * (d - c)
    distance = np.abs(on_one - on_two)
    distance[4] = np.where(crossing, 0.0, np.inf)
    best = np.argmin(distance, axis=0)
    column = np.arange(len(one))
    return Nearest(
        shares[best, 0, column],
        shares[best, 1, column],
        on_one[best, column],
        on_two[best, column],
        distance[best, column],
    )


def foot_share(point: Complexes, start: Complexes, end: Complexes) -> Floats:
    """The share of segments at which they are nearest to points."""
    way = end - start
    length = dot(way, way)
    return np.clip(dot(point - start, way) / divisor(length), 0.0, 1.0)


def distinct(pairs: Sequence[tuple[int, int]], places: Complexes, reach: float) -> list[int]:
    """Which places are the first of their pair of paths within `reach`: a ring's beginning is met from both sides."""
    seen: dict[tuple[tuple[int, int], int, int], list[complex]] = {}
    kept = []
    for k, (pair, place) in enumerate(zip(pairs, places.tolist(), strict=True)):
        x, y = round(place.real / reach), round(place.imag / reach)
        cells = ((pair, x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1))
        if not any(abs(place - other) <= reach for cell in cells for other in seen.get(cell, ())):
            seen.setdefault((pair, x, y), []).append(place)
            kept.append(k)
    return kept


def runs(path_one: Ints, path_two: Ints, low: Floats, high: Floats, slack: float) -> tuple[Ints, Ints]:
    """Group intervals along path one, for each pair of paths, that overlap or are nearer than `slack`.

    Gives the order in which the intervals are grouped, and where in it each group begins.
    """
    order = np.lexsort((low, path_two, path_one))
    one, two, begin, end = path_one[order], path_two[order], low[order], high[order]
    if not len(order):
        return order, order
    new = np.append(True, (one[1:] != one[:-1]) | (two[1:] != two[:-1]))
    # The greatest end so far, of the same pair of paths: pairs are moved apart by more than any path is long.
    step = float(end.max() - begin.min()) + slack + 1.0
    moved = end + (np.cumsum(new) - 1) * step
    reached = np.maximum.accumulate(moved) - (np.cumsum(new) - 1) * step
    new[1:] |= begin[1:] > reached[:-1] + slack
    return order, np.flatnonzero(new)

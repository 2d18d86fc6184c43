"""Runs of curves that are images of one another under isometries, so that what is found for one serves all."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.paths.curved_runs import RunCurves

_SENSES: Final = ((False, False), (True, False), (False, True), (True, True))
"""How an image may run: backwards or not, mirrored or not."""


class RunImages(NamedTuple):
    """Runs that are the images of one under z -> a z + b, of the conjugate of z where `conj`, or run through backwards.

    All are of length m but the two flags.
    """

    runs: Ints
    a: Complexes
    b: Complexes
    conj: bool
    back: bool


def control_points(curves: RunCurves, first: Ints) -> tuple[Complexes, Ints]:
    """The control points of runs as cubic curves, one run's after the other's, and where those of each begin.

    The segments of run k are those from first[k] up to, not including, first[k + 1]; it has three points for each, and
    its end.
    """
    start, end = curves.start, curves.end
    near = np.where(curves.cubic, curves.first, start + (curves.first - start) * (2 / 3))
    far = np.where(curves.cubic, curves.second, end + (curves.first - end) * (2 / 3))
    count = np.diff(first)
    offsets = 3 * first + np.arange(len(first))
    points = np.empty(offsets[-1], np.complex128)
    at = 3 * np.arange(len(start)) + np.repeat(np.arange(len(count)), count)
    points[at], points[at + 1], points[at + 2] = start, near, far
    points[offsets[1:] - 1] = end[first[1:] - 1]
    return points, offsets


def shapes(points: Complexes, offsets: Ints, tolerance: float) -> Iterator[list[RunImages]]:
    """The runs by shape: for each, the images of one run within the `tolerance`, that run among them, its own first.

    `points` and `offsets` are as `control_points` gives them. Every run is in one list.
    """
    size = np.diff(offsets)
    steps = np.abs(np.diff(points, append=points[-1:]))
    steps[offsets[1:] - 1] = 0.0
    length = np.add.reduceat(steps, offsets[:-1])
    order = np.lexsort((length, size))
    other = np.diff(size[order]) > 0
    apart = np.diff(length[order]) > 2 * tolerance * size[order[1:]]
    bounds = (0, *(np.flatnonzero(other | apart) + 1).tolist(), len(order))
    for low, high in pairwise(bounds):
        block = np.sort(order[low:high])  # the first is the first of all, whichever last bits make it the shorter
        rows = points[offsets[block][:, None] + np.arange(size[block[0]])]
        while len(block):
            found = []
            left = np.ones(len(block), np.bool_)
            for back, conj in _SENSES:
                a, b, error = _compared(rows[0], rows, back=back, conj=conj)
                alike = np.flatnonzero(left & (error <= tolerance))
                left[alike] = False
                if len(alike):
                    found.append(RunImages(block[alike], a[alike], b[alike], conj, back))
            yield found
            block, rows = block[left], rows[left]


def reversal(points: Complexes, tolerance: float) -> Isometry | None:
    """What maps a run onto itself backwards, within a tolerance; None where nothing does."""
    for conj in (False, True):
        a, b, error = _compared(points, points[None], back=True, conj=conj)
        if error[0] <= tolerance:
            return Isometry(complex(a[0]), complex(b[0]), conj)
    return None


def _compared(one: Complexes, others: Complexes, *, back: bool, conj: bool) -> tuple[Complexes, Complexes, Floats]:
    """The isometries a z + b that lay a run, mirrored first or not, on others (m, n), and how far points then are."""
    others = others[:, ::-1] if back else others
    one = one.conj() if conj else one
    here, there = one - one[0], others - others[:, :1]
    turn = np.sum(there * here.conj(), axis=1)
    size = np.abs(turn)
    a = np.where(size > 0.0, turn / np.where(size > 0.0, size, 1.0), 1.0 + 0j)
    error = np.max(np.abs(there - a[:, None] * here), axis=1)
    return a, others[:, 0] - a * one[0], np.asarray(error, np.float64)

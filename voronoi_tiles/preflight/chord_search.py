"""The search for chords near each other: in portions that fit into memory, and given up where there is no end of it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, starts
from voronoi_tiles.formats.reading import DrawingError
from voronoi_tiles.preflight.chords import Chords

CANDIDATES_MAX: Final = 30_000_000
"""Most pairs that one search compares; a count. Half a minute's work; 10,000 tiles that lie edge to edge have 13
million within a millimetre."""

FOUND_MAX: Final = 2_000_000
"""Most pairs that are found near to each other; a count. Each takes half a kilobyte."""

_PORTION: Final = 2_000_000  # pairs that a search may give at once
_SLICE: Final = 250_000  # pairs that are measured at once, at some 500 bytes each

_REMEDY: Final = "Remove what is drawn many times over, or split the drawing."


def too_dense(remedy: str = _REMEDY) -> DrawingError:
    """The error for a drawing with more than CANDIDATES_MAX pairs to compare."""
    return DrawingError(
        f"its lines lie so densely that more than {CANDIDATES_MAX:,} pairs of them had to be compared", remedy=remedy
    )


def too_many(what: str, remedy: str = _REMEDY) -> DrawingError:
    """The error for a drawing with more than FOUND_MAX places of one kind."""
    return DrawingError(f"its lines {what} in more than {FOUND_MAX:,} places", remedy=remedy)


def chords_in(chords: Chords, low: Complexes, high: Complexes) -> Iterator[tuple[Ints, Ints]]:
    """All pairs of a box, from its lower left to its upper right corner, and a chord whose box meets it.

    They come in portions of whole boxes, in their order. How many a box has at most is known before: the chords beside
    it in x, or in y, whatever are fewer.
    """
    if not len(low):
        return
    left, right = chords.sides
    bound = np.searchsorted(left, high.real, "right") - np.searchsorted(right, low.real, "left")
    if bound.sum() > _PORTION:
        lower, upper = chords.levels
        bound = np.minimum(bound, np.searchsorted(lower, high.imag, "right") - np.searchsorted(upper, low.imag, "left"))
    portion = np.cumsum(bound) // _PORTION
    for first, after in pairwise([*starts(portion).tolist(), len(low)]):
        some = slice(first, after)
        box, chord = chords.index.meeting(low[some], high[some])
        yield box + first, chord


def pairs(chords: Chords, reach: float, remedy: str = _REMEDY) -> Iterator[tuple[Ints, Ints]]:
    """The pairs of chords (the first before the second) that may be nearer than `reach`, in slices.

    All that are nearer are among them. A chord and the one that follows it on its path are none. Raises DrawingError
    with this remedy where there are more than CANDIDATES_MAX.
    """
    low, high = chords.corners
    margin = complex(reach, reach)
    count = 0
    for one, two in chords_in(chords, low - margin, high + margin):
        ahead = two > one
        one, two = one[ahead], two[ahead]  # noqa: PLW2901 - a portion is large: none is kept twice
        count += len(one)
        if count > CANDIDATES_MAX:
            raise too_dense(remedy)
        for first in range(0, len(one), _SLICE):
            a, b = one[first : first + _SLICE], two[first : first + _SLICE]
            apart = (chords.next(a) != b) & (chords.next(b) != a)
            a, b = a[apart], b[apart]
            beside = _beside(chords, a, b, reach) | _beside(chords, b, a, reach)
            yield a[~beside], b[~beside]


def _beside(chords: Chords, one: Ints, two: Ints, reach: float) -> Bools:
    """Whether the second chord lies on one side of the first one's line, further than `reach`."""
    a, way, length = chords.start[one], chords.end[one] - chords.start[one], chords.lengths[one]
    c, d = ((end[two] - a) * way.conj() for end in (chords.start, chords.end))
    limit = 1.01 * reach * length  # rounding stays far below a hundredth of what is reached
    return np.asarray((np.minimum(c.imag, d.imag) > limit) | (np.maximum(c.imag, d.imag) < -limit), np.bool_)

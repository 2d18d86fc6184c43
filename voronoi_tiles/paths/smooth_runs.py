"""Smooth runs of cubic curves, and places along them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints

SNAP = 1e-6
"""A parameter that is nearer than this to an end of its segment means the end."""

_UNIT = 2.0**-40
"""Sizes are whole numbers of this part of the run's longest segment, so fine that last bits, in which processors
differ, move places by little more; 8 million segments of a run add up to what an int64 holds."""


@dataclass(frozen=True, eq=False)
class SmoothRuns:
    """Smooth runs of cubic segments.

    The point at t in [0, 1] of a segment is c0 + 3 c1 t + 3 c2 t^2 + c3 t^3; `x` and `y` are float64 (4, n). Run r
    are the segments from `first[r]` up to, not including, `first[r + 1]`. A place along run r is a number between 0 and
    `total[r]`: a segment takes up `size`, which is about its length, from `begin` on, evenly in t. Arithmetic on runs
    is spelt out in real numbers and sums are exact, so that the bits of a result do not depend on the other runs.
    """

    x: Floats
    y: Floats
    first: Ints
    begin: Floats
    size: Floats
    total: Floats

    @classmethod
    def of_segments(cls, x: Floats, y: Floats, first: Ints) -> SmoothRuns:
        """Lay out the segments of runs along them; no segment has length 0."""
        owner = np.repeat(np.arange(len(first) - 1), np.diff(first))
        length = sum((np.hypot(x[k], y[k]) for k in (1, 2, 3)), start=np.zeros(x.shape[1]))
        unit = np.maximum.reduceat(length, first[:-1])[owner] * _UNIT
        whole = np.maximum(np.rint(length / unit), 1.0).astype(np.int64)  # they add up without rounding
        sums = np.append(0, np.cumsum(whole))
        begin = (sums[:-1] - sums[first[:-1]][owner]) * unit
        total = (sums[first[1:]] - sums[first[:-1]]) * unit[first[:-1]]
        return cls(x, y, first, begin, whole * unit, total)

    def __len__(self) -> int:
        """Count the runs."""
        return len(self.total)

    def locate(self, run: Ints, place: Floats, *, before: bool) -> tuple[Ints, Floats]:
        """The segments and parameters at places; at a joint, those of the segment before it or of the one after it."""
        segment = last_up_to(self.begin, self.first, run, place)
        t = np.clip((place - self.begin[segment]) / self.size[segment], 0.0, 1.0)
        t = np.where(t < SNAP, 0.0, np.where(t > 1 - SNAP, 1.0, t))
        back = before & (t == 0.0) & (segment > self.first[run])
        on = (not before) & (t == 1.0) & (segment < self.first[run + 1] - 1)
        return segment + on - back, np.where(back, 1.0, np.where(on, 0.0, t))

    def points(self, segment: Ints, t: Floats) -> tuple[Floats, Floats]:
        """The points of segments at parameters: x, y."""
        x, y = (
            c[0, segment] + t * (3 * c[1, segment] + t * (3 * c[2, segment] + t * c[3, segment]))
            for c in (self.x, self.y)
        )
        return x, y


def last_up_to(values: Floats, first: Ints, row: Ints, limit: Floats) -> Ints:
    """The last place in each `row` whose value is at most the `limit`, or the row's first.

    `values` has the rows one after the other, each ascending; row k are the places from first[k] up to first[k + 1].
    """
    owner = np.repeat(np.arange(len(first) - 1), np.diff(first))
    # Complex numbers are in the order of their real parts, and where these are equal, of their imaginary parts.
    after = np.searchsorted(owner + 1j * values, row + 1j * limit, side="right")
    return np.maximum(after - 1, first[row])


def tangents(x: Floats, y: Floats, t: Floats | float, *, ahead: bool) -> tuple[Floats, Floats]:
    """The unit tangents of segments as in SmoothRuns, (4, n), at parameters: x, y.

    Where the speed is 0 they are the limit from ahead or from behind. No segment has length 0.
    """
    sign = 1.0 if ahead else -1.0
    u, v = (c[1] + t * (2 * c[2] + t * c[3]) for c in (x, y))
    still = (u == 0.0) & (v == 0.0)
    if still.any():
        for further in ([sign * (c[2] + t * c[3]) for c in (x, y)], [c[3] for c in (x, y)]):
            u, v = (np.where(still, new, old) for new, old in zip(further, (u, v), strict=True))
            still = (u == 0.0) & (v == 0.0)
    size = np.hypot(u, v)
    return u / size, v / size

"""Tabs: short bridges that are left uncut, so that pieces stay in the sheet until they are broken out."""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints, ranges
from voronoi_tiles.paths.paths import QUAD, Paths
from voronoi_tiles.paths.segments import split

TABS_LEAST: Final = 2
"""Tabs of every closed path: one would let it turn."""

TAB_SPACING_MM: Final = 150.0
"""Longest way along a closed path between two tabs; millimetres."""

_BISECTIONS: Final = 50


def with_tabs(paths: Paths, width: float) -> Paths:
    """Leave bridges of this width uncut in closed paths of LINE, QUAD and ARC segments: open paths, exact but for that.

    Each has TABS_LEAST of them or more, the same way apart, TAB_SPACING_MM at most; the first is in the middle of
    the longest segment, for corners are cut. Raises ValueError where bridges would take more than half of a path.
    """
    if not len(paths):
        return paths
    lengths = paths.lengths
    behind = np.append(0.0, np.cumsum(lengths))
    base, total = behind[paths.offsets[:-1]], np.diff(behind[paths.offsets])
    count = np.maximum(TABS_LEAST, np.ceil(total / TAB_SPACING_MM)).astype(np.intp)
    if (2 * width * count > total).any():
        least = float(total[2 * width * count > total].min())
        raise ValueError(f"tabs of {width:g} mm leave nothing to cut of a contour of {least:.3g} mm")
    order = np.lexsort((-lengths, paths.owner))
    longest = order[paths.offsets[:-1]]
    first = (behind[longest] + behind[longest + 1]) / 2 - base
    path = np.repeat(np.arange(len(paths)), count)
    number = ranges(np.zeros(len(paths), np.intp), count)
    spacing = (total / count)[path]
    begin = first[path] + number * spacing + width / 2
    return stretches(paths, path, begin, begin + spacing - width)


def stretches(paths: Paths, path: Ints, first: Floats, last: Floats) -> Paths:
    """Parts of paths, from one length along them to another: open paths.

    0 <= first < last < first + the path's length; in a closed path a part may go on through its start. Where a part
    begins or ends with its path, it has that end to the bit.
    """
    lengths = paths.lengths
    behind = np.append(0.0, np.cumsum(lengths))
    base, total = behind[paths.offsets[path]], np.diff(behind[paths.offsets])[path]
    last = np.where(paths.closed[path], last, np.minimum(last, total))
    start, stop = np.where(first >= total, first - total, first), np.where(last > total, last - total, last)
    low, size = paths.offsets[path], paths.counts[path]
    a = np.clip(np.searchsorted(behind, base + start, side="right") - 1, low, low + size - 1)
    b = np.clip(np.searchsorted(behind, base + stop, side="left") - 1, low, low + size - 1)
    whole_turn = (a == b) & (stop <= start)
    count = np.where(whole_turn, size + 1, np.mod(b - a, size) + 1)
    at = np.repeat(low, count)
    segments = at + np.mod(ranges(a, count) - at, np.repeat(size, count))
    opening = np.cumsum(count) - count
    closing = opening + count - 1
    t0, t1 = np.zeros(len(segments)), np.ones(len(segments))
    t0[opening] = _parameter(paths, a, base + start - behind[a])
    t1[closing] = _parameter(paths, b, base + stop - behind[b])
    kept = t1 > t0
    parts = split(paths, segments[kept], t0[kept], t1[kept])
    owner = np.repeat(np.arange(len(path)), count)[kept]
    joint = np.flatnonzero(owner[1:] == owner[:-1]) + 1
    parts.start[joint] = parts.end[joint - 1]
    return Paths(
        start=parts.start,
        end=parts.end,
        control=parts.control,
        kind=parts.kind,
        offsets=np.append(0, np.cumsum(np.bincount(owner, minlength=len(path)))).astype(np.intp),
        closed=np.zeros(len(path), np.bool_),
    )


def _parameter(paths: Paths, segments: Ints, lengths: Floats) -> Floats:
    """The parameters at which segments have given lengths behind them; on curves by bisection."""
    whole = paths.lengths[segments]
    share = np.clip(lengths / np.where(whole > 0, whole, 1.0), 0.0, 1.0)
    bent = np.flatnonzero((paths.kind[segments] == QUAD) & (share > 0) & (share < 1))
    if len(bent):
        low, high = np.zeros(len(bent)), np.ones(len(bent))
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            short = split(paths, segments[bent], 0 * middle, middle).lengths < lengths[bent]
            low, high = np.where(short, middle, low), np.where(short, high, middle)
        share[bent] = (low + high) / 2
    return np.asarray(share, np.float64)

"""Segments that are hardly any: too short to be seen, and arcs too flat to be told from lines. Offsets leave both."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from voronoi_tiles.base.arrays import next_in_ring
from voronoi_tiles.base.components import components
from voronoi_tiles.paths.paths import ARC, LINE, Paths


def without_short_segments(rings: Paths, size: float) -> Paths:
    """The same closed paths without segments shorter than `size`: what they joined meets in their middle.

    Several in a row go where they are that short together. So nothing moves by more than `size`: ends move by half of
    it at most, and the middles of arcs stay. What a ring loses depends neither on where it starts nor on its direction.
    One that would keep fewer than two segments stays. Raises ValueError for open paths.
    """
    if not rings.closed.all():
        raise ValueError("only closed paths can lose short segments")
    short = rings.lengths < size
    if not short.any():
        return rings
    everything, after = np.arange(len(short)), next_in_ring(rings.offsets)
    before = np.empty_like(after)
    before[after] = everything
    together = np.flatnonzero(short & short[after])
    row = components(len(short), together, after[together])
    gone = short & (np.bincount(row, rings.lengths, len(short))[row] < size)
    gone &= (np.bincount(rings.owner[~gone], minlength=len(rings)) >= 2)[rings.owner]
    first, last = np.flatnonzero(gone & ~gone[before]), np.flatnonzero(gone & ~gone[after])
    first, last = first[np.argsort(row[first])], last[np.argsort(row[last])]
    start, end = rings.start.copy(), rings.end.copy()
    start[after[last]] = end[before[first]] = (start[first] + end[last]) / 2
    kept = np.flatnonzero(~gone)
    counts = np.bincount(rings.owner[kept], minlength=len(rings))
    left = Paths(
        start=start[kept],
        end=end[kept],
        control=rings.control[kept],
        kind=rings.kind[kept],
        offsets=np.append(0, np.cumsum(counts)).astype(np.intp),
        closed=rings.closed,
    )
    return straightened(left, 0.0)


def straightened(paths: Paths, tolerance: float) -> Paths:
    """The same paths, with ARCs that leave their chord by no more than `tolerance`, or have no length, as LINEs."""
    sagitta = np.abs(paths.control[:, 0] - (paths.start + paths.end) / 2)
    flat = (paths.kind == ARC) & ((sagitta <= tolerance) | (paths.start == paths.end))
    kind = np.where(flat, LINE, paths.kind).astype(np.uint8)
    return replace(paths, control=np.where(flat[:, None], 0, paths.control), kind=kind)

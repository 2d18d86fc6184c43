"""Specks: pieces too short to be seen, which offsets leave at corners, and which machines stumble over."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from voronoi_tiles.paths.paths import Paths


def without_specks(paths: Paths, size: float) -> Paths:
    """Leave out pieces that are shorter than `size`: the piece after each starts where the speck did.

    Nothing moves by more than `size`: of specks in a row only those are left out that are that short together. A path
    of specks alone stays.
    """
    lengths = paths.lengths
    small = np.flatnonzero(lengths < size)
    if not len(small):
        return paths
    dropped = np.zeros(len(lengths), np.bool_)
    left = paths.counts.tolist()
    owner, last = paths.owner.tolist(), (paths.offsets[1:] - 1).tolist()
    run, before = 0.0, -2
    for k in small.tolist():
        run = run + float(lengths[k]) if k == before + 1 else float(lengths[k])
        # The last piece of a path leads back to its start, or ends where it must.
        if run < size and left[owner[k]] > 2 and k != last[owner[k]]:
            dropped[k] = True
            left[owner[k]] -= 1
            before = k
        else:
            run = 0.0
    kept = np.flatnonzero(~dropped)
    start = paths.start.copy()
    # A row of specks ends at a piece that starts where the first of them did.
    for k in np.flatnonzero(dropped).tolist():
        start[k + 1] = start[k]
    counts = np.bincount(paths.owner[kept], minlength=len(paths))
    return replace(
        paths,
        start=start[kept],
        end=paths.end[kept],
        control=paths.control[kept],
        kind=paths.kind[kept],
        offsets=np.append(0, np.cumsum(counts)).astype(np.intp),
    )

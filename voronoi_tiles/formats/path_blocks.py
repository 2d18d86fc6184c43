"""Paths in portions, for writers that would otherwise hold a whole sheet as text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from voronoi_tiles.paths.paths import Paths

_BLOCK: Final = 1 << 16  # segments that are held as text at a time


def path_blocks(paths: Paths) -> Iterator[Paths]:
    """The paths that have segments, in blocks of bounded size."""
    kept = np.flatnonzero(paths.counts > 0)
    block = np.cumsum(paths.counts[kept]) // _BLOCK
    for part in np.split(kept, np.flatnonzero(np.diff(block)) + 1):
        if len(part):
            yield paths.take(part)

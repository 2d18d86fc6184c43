"""Tabs where every line is cut once: a bridge in some of the edges, so that two at least hold every tile."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.fabrication.clipping import Strands
from voronoi_tiles.paths.contour_tabs import TABS_LEAST, stretches
from voronoi_tiles.paths.paths import Paths


def bridged(
    paths: Paths, first: Ints, last: Ints, node: Complexes, strands: Strands, chosen: Ints, width: float
) -> tuple[Paths, Ints, Ints, Complexes]:
    """Leave bridges in strands: the strands, the nodes where they start and end, and where the nodes are.

    `paths`, `first` and `last` are the strands `chosen` of all. The longest edges come first; one that is shorter
    than four bridges has none.
    """
    length = paths.path_lengths
    bridge = _edges_with_bridge(strands, chosen, length, 4 * width)
    cut = np.flatnonzero(bridge)
    half = (length[cut] - width) / 2
    before = stretches(paths, cut, np.zeros(len(cut)), half)
    after = stretches(paths, cut, half + width, length[cut])
    kept = np.flatnonzero(~bridge)
    loose = len(node) + np.arange(2 * len(cut))
    ends = np.concatenate((before.end[before.offsets[1:] - 1], after.start[after.offsets[:-1]]))
    return (
        Paths.concatenate([paths.take(kept), before, after]),
        np.concatenate((first[kept], first[cut], loose[len(cut) :])),
        np.concatenate((last[kept], loose[: len(cut)], last[cut])),
        np.concatenate((node, ends)),
    )


def _edges_with_bridge(strands: Strands, chosen: Ints, length: Floats, least: float) -> Bools:
    """Choose strands, long ones first, until every tile has TABS_LEAST bridges, as far as its edges are long enough."""
    left, right = strands.left[chosen].tolist(), strands.right[chosen].tolist()
    count: dict[int, int] = {}
    bridge = np.zeros(len(chosen), np.bool_)
    # Equal lengths to nanometres are one length, so that copies are treated alike.
    for k in np.argsort(-np.round(length, 6), kind="stable").tolist():
        if length[k] < least:
            break
        beside = (left[k], right[k])
        if any(count.get(tile, 0) < TABS_LEAST for tile in beside):
            bridge[k] = True
            for tile in beside:
                count[tile] = count.get(tile, 0) + 1
    return bridge

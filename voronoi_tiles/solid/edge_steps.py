"""In how many steps edges are drawn at each level: as chords need them there, and walls to the levels beside."""

from __future__ import annotations

from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counts_of
from voronoi_tiles.solid.correspondence import Correspondence
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.levels import along_edges, sagging, weighed
from voronoi_tiles.vector.motion_codes import images

CHORDS: Final = 0.5
"""How much of the accuracy chords may take, at most; a share. The rest is left to what is between levels."""

_TWISTED: Final = 0.6
"""How much of it the diagonals of walls may take that turn on the way up; a share."""

_TWISTED_MOST: Final = 64.0
"""The most steps that are taken because walls turn; a count. With more levels these turn less."""

_FINER: Final = 8
"""How often edges that are too far from their chords get more of them, at most; a count."""

_SHARES: Final = np.linspace(0.0, 1.0, 9)
"""Where directions of edges are compared, as shares of their lengths."""


def turning(low: ExactLayer, high: ExactLayer, same: Correspondence) -> Floats:
    """How far chords of corresponding uses of two layers turn, altogether: the sum of their differences, (uses,).

    Cut in two triangles, the piece of a wall between two chords is off the straight way from one to the other by a
    quarter of their difference, half way up.
    """
    chords = [np.diff(_seen(layer, use), axis=1) for layer, use in ((low, same.low), (high, same.high))]
    return np.asarray(np.abs(chords[0] - chords[1]).sum(axis=1))


def _seen(layer: ExactLayer, use: Ints) -> Complexes:
    """Points of uses at equal shares of their lengths, in the order of their boundaries, complex128 (uses, shares)."""
    edge = layer.edge[use]
    points = along_edges(layer, _SHARES)[edge]
    points = np.where(layer.backwards[use][:, None], points[:, ::-1], points)
    moved = images(layer.action, np.repeat(layer.motion[use], len(_SHARES)), points.ravel())
    return np.asarray(moved.reshape(points.shape))


def stepped(layer: ExactLayer, turns: Floats, accuracy: float) -> tuple[Ints, Floats]:
    """For each edge of a layer its steps, and the weight of each arc: they are taken by equal shares of these.

    Chords keep within CHORDS of the accuracy. `turns`, float64 (edges,), is how far edges turn on the way to the levels
    beside, at most.
    """
    quotient = layer.quotient
    paths, first = quotient.paths(), quotient.offsets[:-1]
    turning_steps = np.minimum(turns / (4 * _TWISTED * accuracy), _TWISTED_MOST)
    share = paths.lengths / np.maximum(layer.lengths, 1e-300)[paths.owner]
    weight = np.maximum(weighed(layer, CHORDS * accuracy), turning_steps[paths.owner] * share)
    least = np.ones(len(first), np.intp)
    # A ring has three sides at least.
    uses = counts_of(layer.ring_offsets)[layer.ring]
    np.maximum.at(least, layer.edge, -(-3 // uses))
    turned = [k for k, pairs in quotient.symmetric.items() if any(back for _, back in pairs)]
    steps = _whole(np.add.reduceat(weight, first), least, turned)
    for _ in range(_FINER):
        # A vertex that is moved to where arcs meet leaves longer chords beside it.
        sag = sagging(layer, steps, weight)
        if sag.max(initial=0.0) <= CHORDS * accuracy:
            break
        steps = _whole(steps * np.clip(np.sqrt(sag / (CHORDS * accuracy)), 1.0, 2.0), least, turned)
    return steps, weight


def _whole(steps: Floats, least: Ints, turned: list[int]) -> Ints:
    """Numbers of steps, even ones where a motion turns an edge round: halves are images of each other."""
    found = np.maximum(np.ceil(steps).astype(np.intp), least)
    found[turned] += found[turned] % 2
    return found

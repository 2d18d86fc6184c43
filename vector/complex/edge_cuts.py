"""Where the rings of boundaries are cut into edges, besides where the copy beyond changes."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints
from voronoi_tiles.vector.complex.site_symmetry import SiteSymmetry
from voronoi_tiles.vector.complex.traced import Traced
from voronoi_tiles.vector.motion_codes import composed, images, inverted
from voronoi_tiles.vector.motions import Action

# How near vertices must be to count as one, relative to the cell's size: far above rounding.
_SAME = 1e-6
# Turns the plane so that no mirror and no row of copies is upright.
_SLANT = np.exp(1j)

Cuts = Bools
"""Whether a boundary is cut at the start of each of its arcs."""


def cut_further(action: Action, symmetry: SiteSymmetry, traced: Traced, *, pinched: bool) -> Cuts:
    """The places where rings are cut: where the copy beyond changes, and more vertices with all images of these.

    They are one vertex of each ring that faces one copy only and, where `pinched`, those where a boundary touches
    itself.
    """
    limit, cuts = _SAME * action.size, traced.changes
    first = traced.offsets[:-1]
    waiting = first[~np.logical_or.reduceat(cuts, first)].tolist()
    if pinched:
        waiting += _pinches(traced, limit).tolist()
    if not waiting:
        return cuts
    cuts, done = cuts.copy(), np.zeros(len(traced), bool)
    before = np.empty(len(traced), np.intp)
    before[traced.following] = np.arange(len(traced))
    while waiting:
        arc = waiting.pop()
        if done[arc]:
            continue
        done[arc] = cuts[arc] = True
        # What a vertex is mapped to depends on the copies beyond its own arc and the one before.
        for faced in {arc, int(before[arc])}:
            for on, facing, motion, image in _moved(action, symmetry, traced, arc, faced):
                at = (traced.tile == on) & (traced.site == facing) & (traced.motion == motion)
                waiting += np.flatnonzero(at & (np.abs(traced.vertex - image) <= limit)).tolist()
    return cuts


def _moved(
    action: Action, symmetry: SiteSymmetry, traced: Traced, arc: int, faced: int
) -> list[tuple[int, int, int, complex]]:
    """The images of an arc's start under all motions that take its tile, or the copy beyond `faced`, to a base tile.

    With each come this tile, the site beyond, its motion, and the point.
    """
    tile, site = int(traced.tile[arc]), int(traced.site[faced])
    own, theirs = (symmetry.stabilizer[slice(*symmetry.offsets[k : k + 2])] for k in (tile, site))
    there = traced.motion[faced : faced + 1]
    back = composed(theirs, inverted(there))
    rows = [
        (tile, site, own, symmetry.canonical(np.full(len(own), site), composed(own, there))),
        (site, tile, back, symmetry.canonical(np.full(len(back), tile), back)),
    ]
    return [
        (on, facing, motion, point)
        for on, facing, by, there in rows
        for motion, point in zip(there.tolist(), images(action, by, traced.vertex[arc]).tolist(), strict=True)
    ]


def _pinches(traced: Traced, limit: float) -> Ints:
    """The vertices at which a boundary touches itself: another one is within a limit, and not just along the way."""
    # Sorted from left to right, turned by the slant, few vertices of a tile are near each other.
    along, tile = (traced.vertex * _SLANT).real, traced.tile
    order = np.lexsort((along, tile))
    vertex, along, tile = traced.vertex[order], along[order], tile[order]
    pairs = []
    for step in range(1, len(order)):
        near = np.flatnonzero((along[step:] - along[:-step] <= limit) & (tile[step:] == tile[:-step]))
        if not len(near):
            break
        same = near[np.abs(vertex[near + step] - vertex[near]) <= limit]
        pairs.append(np.stack((order[same], order[same + step])))
    if not any(pair.size for pair in pairs):
        return np.zeros(0, np.intp)
    one, two = np.concatenate(pairs, axis=1)
    # Vertices along a ring may be as close without touching: only short arcs lie between them, one way or the other.
    chord = np.abs(traced.vertex[traced.following] - traced.vertex)
    walk, around = np.cumsum(chord) - chord, np.bincount(traced.ring, chord)
    between = np.abs(walk[one] - walk[two])
    between = np.minimum(between, around[traced.ring[one]] - between)
    apart = (traced.ring[one] != traced.ring[two]) | (between > limit)
    return np.unique(np.concatenate((one[apart], two[apart])))

"""How near copies of moving strokes come to each other: proved over all heights, not at some of them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, plane
from voronoi_tiles.solid.events import LoftError
from voronoi_tiles.solid.motion import Motion
from voronoi_tiles.vector.motion_codes import Codes, code_of, images, operation_of
from voronoi_tiles.vector.motions import Action, translated

NEAREST: Final = 1e-7
"""Copies that come nearer than this between layers are taken to meet; relative to the cell's size."""

_LOOKED_AT: Final = 0.25
"""How far copies are apart, at least, that are not looked at; relative to the cell's shorter vector."""


class Approach(NamedTuple):
    """Between all heights copies are apart by at least `proved`; they were seen as near as `seen` at the height `z`."""

    proved: float
    seen: float
    z: float


class CopyPairs(NamedTuple):
    """Pairs of a site and the copy of one: numbers `site` and `other` (intp, n), and the motion of the copy `code`."""

    site: Ints
    other: Ints
    code: Codes

    def take(self, places: Ints) -> CopyPairs:
        """Some of them."""
        return CopyPairs(self.site[places], self.other[places], self.code[places])


def approach(
    motion: Motion, action: Action, stabilizers: Sequence[tuple[int, ...]], heights: Sequence[float]
) -> Approach:
    """How near different copies come to each other from the first height to the last.

    No point of a stroke goes farther than a known bound: where the distance of two copies is more than they can lose on
    the way to the middle of an interval, they do not meet in it; else it is halved. Raises LoftError, with the height,
    where copies come so near that they are taken to meet.
    """
    apart = _LOOKED_AT * abs(action.lattice.reduced_basis[0])
    every = copy_pairs(motion, action, stabilizers, heights, apart)
    proved, seen, where = apart, apart, heights[0]
    if not len(every.code):
        return Approach(proved, seen, where)
    nearest = NEAREST * action.size

    def distances(z: float, pairs: CopyPairs) -> Floats:
        nonlocal seen, where
        found = _distances(motion, action, z, pairs)
        if len(found) and found.min() < seen:
            seen, where = float(found.min()), z
            if seen < nearest:
                pair = pairs.take(np.array([found.argmin()]))
                names = [motion.moving[k].name for k in (int(pair.site[0]), int(pair.other[0]))]
                raise LoftError(
                    f'site "{names[0]}" comes within {seen:.2g} of the copy of site "{names[1]}" under '
                    f"{operation_of(int(pair.code[0]))}",
                    z,
                    remedy="Copies must keep apart at all heights.",
                )
        return found

    waiting = []
    rows = [distances(z, every) for z in heights]
    for (low, high), (below, above) in zip(pairwise(heights), pairwise(rows), strict=True):
        waiting.append((low, high, np.arange(len(every.code)), below, above))
    while waiting:
        low, high, which, below, above = waiting.pop()
        # Both copies move: towards each other by twice as much.
        bound = (below + above) / 2 - motion.travel(low, high)
        good = bound > np.minimum(below, above) / 4
        if good.any():
            proved = min(proved, float(bound[good].min()))
        left = np.flatnonzero(~good)
        if len(left):
            middle = (low + high) / 2
            there = distances(middle, every.take(which[left]))
            waiting.append((low, middle, which[left], below[left], there))
            waiting.append((middle, high, which[left], there, above[left]))
    return Approach(proved, seen, where)


def copy_pairs(
    motion: Motion, action: Action, stabilizers: Sequence[tuple[int, ...]], heights: Sequence[float], apart: float
) -> CopyPairs:
    """All pairs whose boxes, swept over the heights, are no more than `apart` from each other."""
    drawn = [motion.points(z) for z in heights]
    steps = [motion.travel(low, high) / 2 for low, high in pairwise(heights)]
    boxes = []
    for k in range(len(motion.moving)):
        points = np.concatenate([sites[k] for sites in drawn])
        low = complex(points.real.min(), points.imag.min()) - max(steps) * (1 + 1j)
        high = complex(points.real.max(), points.imag.max()) + max(steps) * (1 + 1j)
        boxes.append(np.array([low, complex(high.real, low.imag), high, complex(low.real, high.imag)]))
    rows = []
    for i, box in enumerate(boxes):
        for j, other in enumerate(boxes):
            for own in action.motions:
                corners = action.apply(own, other)
                # Where the images of one box must be moved to for it to be near the other.
                gaps = (box[:, None] - corners).ravel()
                reach = np.concatenate([gaps + apart * turn for turn in (1 + 1j, 1 - 1j, -1 + 1j, -1 - 1j)])
                x, y = action.lattice.fractional(reach)
                for s in range(int(np.ceil(x.min())), int(np.floor(x.max())) + 1):
                    for t in range(int(np.ceil(y.min())), int(np.floor(y.max())) + 1):
                        code = code_of(translated(own, s, t))
                        if i == j and code in stabilizers[i]:
                            continue
                        if _gap(box, corners + (s * action.lattice.a + t * action.lattice.b)) <= apart:
                            rows.append((i, j, code))
    table = np.array(rows, np.int64).reshape(-1, 3)
    return CopyPairs(table[:, 0].astype(np.intp), table[:, 1].astype(np.intp), table[:, 2].copy())


def _gap(one: Complexes, two: Complexes) -> float:
    """How far upright boxes about points are apart, along x or along y; <= 0 where they meet."""
    gaps = [
        max(float(part(two).min() - part(one).max()), float(part(one).min() - part(two).max()))
        for part in (np.real, np.imag)
    ]
    return max(gaps)


def _distances(motion: Motion, action: Action, z: float, pairs: CopyPairs) -> Floats:
    """How far the sites and copies of pairs are apart at a height, float64 (n,)."""
    drawn = motion.points(z)
    found = np.empty(len(pairs.code))
    for k, points in enumerate(drawn):
        at = np.flatnonzero(pairs.other == k)
        if len(at):
            code = np.repeat(pairs.code[at], len(points))
            copies = images(action, code, np.tile(points, len(at))).reshape(len(at), -1)
            there = _shapes(copies, [line.shape[1] for line in motion.moving[k].lines])
            for i in np.unique(pairs.site[at]).tolist():
                own = _shapes(drawn[i][None, :], [line.shape[1] for line in motion.moving[i].lines])[0]
                those = pairs.site[at] == i
                found[at[those]] = shapely.distance(own, there[those])
    return found


def _shapes(points: Complexes, sizes: Sequence[int]) -> np.ndarray:
    """The strokes of copies, whose points are the rows of `points`, as geometries: one for each copy."""
    coordinates, at, parts = plane(points), 0, []
    for size in sizes:
        line = coordinates[:, at : at + size]
        parts.append(shapely.points(line[:, 0]) if size == 1 else shapely.linestrings(line))
        at += size
    return np.asarray(parts[0] if len(parts) == 1 else shapely.geometrycollections(np.stack(parts, axis=1)))

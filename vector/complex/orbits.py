"""Sides that symmetry maps onto each other, and one approximation for all of them.

What replaces the exact curves of one side (arcs for a machine that knows no parabolas) has to be the same for every
copy of it: then copies of a tile stay congruent, and what lies between two tiles stays one line.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints
from voronoi_tiles.base.maps import move
from voronoi_tiles.paths.paths import LINE, Paths
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, inverse, reverses_orientation

_SYMMETRIC = 1e-9
"""How far a side may be from its own image, to count as symmetric; relative to its extent. Far above rounding."""


@dataclass(frozen=True, eq=False)
class Orbits:
    """For each side of a period the side that stands for its orbit, the motion from there, and whether it runs against.

    `source` (intp, s), `motion` (s of them), `against` (bool, s).
    """

    source: Ints
    motion: tuple[Motion, ...]
    against: Bools


def find_orbits(period: Period) -> Orbits:
    """Find which sides are images of each other, through the tiles that they belong to.

    A run along a tile is the image of a run along the tile of the base site. Two runs along one side tell that two base
    runs are images of each other; what is connected so is an orbit.
    """
    rings = period.rings
    tile = np.repeat(np.arange(len(period.site)), np.diff(rings.offsets[rings.tiles]))
    views: list[list[tuple[tuple[int, int], Motion, bool]]] = [[] for _ in range(len(period.sides))]
    for k, side in enumerate(rings.side.tolist()):
        here = period.motion[tile[k]]
        i, j = rings.step[k].tolist()
        # From the base run to the side where it stands; a copy that is turned over is run through the other way.
        views[side].append(
            (
                (int(period.site[tile[k]]), int(rings.place[k])),
                compose((*IDENTITY[:4], -2 * i, -2 * j), here),
                bool(rings.forward[k]) == reverses_orientation(here),
            )
        )
    links: dict[tuple[int, int], list[tuple[tuple[int, int], Motion, bool]]] = {}
    for (one, to_one, against_one), (two, to_two, against_two) in views:
        across = compose(inverse(to_two), to_one)
        links.setdefault(one, []).append((two, across, against_one != against_two))
        links.setdefault(two, []).append((one, inverse(across), against_one != against_two))
    # Every base run as the image of the first of its orbit.
    origin: dict[tuple[int, int], tuple[tuple[int, int], Motion, bool]] = {}
    for root in links:
        if root in origin:
            continue
        origin[root] = (root, IDENTITY, False)
        waiting = deque([root])
        while waiting:
            node = waiting.popleft()
            _, motion, against = origin[node]
            for other, across, turns in links[node]:
                if other not in origin:
                    origin[other] = (root, compose(across, motion), against != turns)
                    waiting.append(other)
    first: dict[tuple[int, int], tuple[int, Motion, bool]] = {}
    source, motions, flips = [], [], []
    for side, (view, _) in enumerate(views):
        node, to_side, against = view
        root, motion, turned = origin[node]
        whole, sense = compose(to_side, motion), against != turned
        number, to_first, first_sense = first.setdefault(root, (side, whole, sense))
        source.append(number)
        motions.append(compose(whole, inverse(to_first)))
        flips.append(sense != first_sense)
    return Orbits(np.array(source), tuple(motions), np.array(flips))


def approximated(period: Period, action: Action, fit: Callable[[Paths], Paths]) -> Period:
    """Replace the curves of all sides by those that `fit` gives for one of each orbit; what is symmetric stays so.

    `fit` replaces every path by another one from the same start to the same end. It is not asked about sides that are
    one straight line, as all on mirrors are. The period stands in the design's own frame, that of `action`.
    """
    orbits = find_orbits(period)
    chosen = np.unique(orbits.source)
    originals = [period.sides.take(np.array([k])) for k in chosen.tolist()]
    straight = [side.kind.tolist() == [LINE] for side in originals]
    symmetry = [_own_symmetry(side) for side in originals]
    asked = [
        side if mirrored is None else _first_half(side)
        for side, line, mirrored in zip(originals, straight, symmetry, strict=True)
        if not line
    ]
    fitted = fit(Paths.concatenate(asked)) if asked else Paths.empty()
    answers = iter(range(len(fitted)))
    whole = []
    for side, line, mirrored in zip(originals, straight, symmetry, strict=True):
        answer = side if line else fitted.take(np.array([next(answers)]))
        whole.append(answer if line or mirrored is None else _doubled(answer, side, mirrored))
    place = np.searchsorted(chosen, orbits.source)
    images = []
    for k, motion, against in zip(place.tolist(), orbits.motion, orbits.against.tolist(), strict=True):
        unit, conj = action.linear[motion[:4]]
        shift = complex(action.cartesian(motion[4] / 2, motion[5] / 2))
        image = whole[k].moved(unit, shift, conj=conj)
        images.append(image.reversed() if against else image)
    return replace(period, sides=Paths.concatenate(images))


def _own_symmetry(path: Paths) -> bool | None:
    """Tell whether a path is its own image run backwards: under a mirror (True), a half turn (False), or not (None)."""
    start, end, kind = path.start, path.end, path.kind
    if start[0] == end[-1] or not (kind == kind[::-1]).all():
        return None
    points = np.concatenate((start, end[-1:], path.control[:, 0]))
    back = np.concatenate((end[::-1], start[:1], path.control[:, 0][::-1]))
    curved = np.concatenate((np.ones(len(start) + 1, np.bool_), kind > 0))
    extent = float(np.abs(points[curved] - points[0]).max())
    for conj in (False, True):
        factor, shift = _swap(complex(start[0]), complex(end[-1]), conj)
        image = move(points, factor, shift, conj)
        if float(np.abs(image - back)[curved].max()) <= _SYMMETRIC * extent:
            return conj
    return None


def _swap(start: complex, end: complex, conj: bool) -> tuple[complex, complex]:
    """Give the half turn, or the reflection, that swaps two points: factor and shift."""
    if not conj:
        return -1 + 0j, start + end
    factor = -(end - start) / (end - start).conjugate()
    return factor, end - factor * start.conjugate()


def _first_half(path: Paths) -> Paths:
    """Cut a symmetric path of lines and quadratic curves in its middle."""
    count = len(path.start)
    half, odd = divmod(count, 2)
    kept = half + odd
    start, end, control = path.start[:kept].copy(), path.end[:kept].copy(), path.control[:kept].copy()
    if odd:
        a, b, c = start[half], control[half, 0], end[half]
        if path.kind[half] > 0:
            control[half, 0] = (a + b) / 2
            end[half] = (a + 2 * b + c) / 4
        else:
            end[half] = (a + c) / 2
    return replace(path, start=start, end=end, control=control, kind=path.kind[:kept], offsets=np.array([0, kept]))


def _doubled(half: Paths, original: Paths, conj: bool) -> Paths:
    """Add the other half of a symmetric path."""
    start, end = complex(original.start[0]), complex(original.end[-1])
    factor, shift = _swap(start, end, conj)
    other = half.moved(factor, shift, conj=conj).reversed()
    other.start[0] = half.end[-1]
    other.end[-1] = end
    both = Paths.concatenate([half, other])
    return replace(both, offsets=np.array([0, len(both.start)]), closed=half.closed)

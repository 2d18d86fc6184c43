"""Halves of paths that an isometry maps onto themselves backwards, and the whole again.

What finds few arcs along a path (biarcs.py) decides from its start on, and gives other arcs for its image: a symmetric
path keeps its symmetry where one half is fitted, and the other one is its image.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.paths.segments import split, tangent_at

_TANGENT: Final = 1e-9
"""How far a path may be from crossing a mirror at a right angle for the arcs beside it to be one; radians."""


def first_half(path: Paths) -> Paths:
    """The first half of a path that is its own image backwards: half of its segments, of a middle one a half."""
    count = len(path.start)
    half, odd = divmod(count, 2)
    first = _part(path, np.arange(half))
    if not odd:
        return first
    middle = split(path, np.array([half]), np.zeros(1), np.full(1, 0.5), path.start[[half]])
    both = Paths.concatenate([first, middle]) if half else middle
    return replace(both, offsets=np.array([0, half + 1]), closed=np.zeros(1, np.bool_))


def doubled(half: Paths, image: Isometry, end: complex) -> Paths:
    """A half followed by its image, which runs backwards to `end`. Where a mirror halves an arc, it is one again."""
    other = moved(half, image).reversed()
    other.start[0] = half.end[-1]
    other.end[-1] = end
    both = Paths.concatenate([half, other])
    both = replace(both, offsets=np.array([0, len(both.start)]), closed=half.closed)
    k = len(half.start) - 1
    if not (image.conj and half.kind[k] in (ARC, LINE) and _crosses_upright(half, image)):
        return both
    joined = np.delete(np.arange(len(both.start)), k + 1)
    end_of = both.end.copy()
    end_of[k] = both.end[k + 1]
    control = both.control.copy()
    control[k, 0] = half.end[k] if half.kind[k] == ARC else 0
    return replace(
        both,
        start=both.start[joined],
        end=end_of[joined],
        control=control[joined],
        kind=both.kind[joined],
        offsets=np.array([0, len(joined)]),
    )


def moved(paths: Paths, image: Isometry) -> Paths:
    """The image of paths under an isometry."""
    return paths.moved(image.a, image.b, conj=image.conj)


def _part(paths: Paths, segments: Ints) -> Paths:
    """Segments that follow each other as one open path."""
    return Paths(
        start=paths.start[segments],
        end=paths.end[segments],
        control=paths.control[segments],
        kind=paths.kind[segments],
        offsets=np.array([0, len(segments)]),
        closed=np.zeros(1, np.bool_),
    )


def _crosses_upright(half: Paths, mirror: Isometry) -> bool:
    """Whether a path ends at a right angle to a mirror."""
    tangent = complex(tangent_at(half, np.array([len(half.start) - 1]), np.ones(1))[0])
    # Across the mirror a direction becomes its opposite.
    return abs(mirror.a * tangent.conjugate() + tangent) <= _TANGENT

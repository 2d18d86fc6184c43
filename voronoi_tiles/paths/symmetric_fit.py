"""Fits of closed paths that keep their symmetry: one part of each kind is fitted, and mapped to where the others are.

What finds few arcs along a path (biarcs.py) decides from its start on, and gives other arcs for its image. So a ring
that isometries map onto itself is cut at images of one node; of the parts between, one of each orbit is fitted, and of
a part that an isometry maps onto itself backwards, one half.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, next_in_ring
from voronoi_tiles.base.maps import Isometry, move
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.paths.segments import split, tangent_at

CORNER: Final = 0.1
"""Turns above this are corners, at which rings are cut first; radians."""

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


def fitted_symmetrically(
    rings: Paths, maps: Sequence[Isometry], fit: Callable[[Paths], Paths], *, close: float
) -> Paths:
    """Fit closed paths of lines and arcs so that what maps them onto themselves maps the result onto itself.

    `maps` are all isometries of the group but the identity, `fit` replaces open paths by others between the same ends.
    Nodes within `close` of an image are that image. Where rings are not symmetric node by node, as where an offset was
    on the verge of losing a part, they are fitted as they are.
    """
    if not len(rings):
        return rings
    images = [_images(rings.start, image, close) for image in maps]
    if not maps or any(image is None for image in images):
        return fit(rings)
    node_images = [image for image in images if image is not None]
    runs = _runs(rings, _breaks(rings, node_images, close))
    sources, asked = _orbits(rings, runs, maps, node_images)
    answers = fit(Paths.concatenate([asked[k] for k in sorted(asked)]))
    whole = {}
    for place, k in enumerate(sorted(asked)):
        answer, source = answers.take(np.array([place])), sources[k]
        end = complex(rings.start[runs[k].end])
        whole[k] = answer if source.reversal is None else doubled(answer, source.reversal, end)
    parts = []
    for run, source in zip(runs, sources, strict=True):
        part = whole[source.run]
        if source.image is not None:
            part = moved(part, source.image)
            part = part.reversed() if source.image.conj else part
            part.start[0], part.end[-1] = rings.start[run.start], rings.start[run.end]
        parts.append(part)
    counts = [len(part.start) for part in parts]
    ring_of = np.array([run.ring for run in runs])
    sizes = np.bincount(ring_of, counts, len(rings)).astype(np.intp)
    joined = Paths.concatenate(parts)
    return replace(joined, offsets=np.append(0, np.cumsum(sizes)).astype(np.intp), closed=np.ones(len(rings), np.bool_))


class _Run(NamedTuple):
    """A part of a ring between two nodes at which it is cut: its segments in order, and the nodes at its ends."""

    ring: int
    segments: Ints
    start: int
    end: int


class _Source(NamedTuple):
    """The run that is fitted for one, and what takes it here, None for itself; what maps that run onto itself."""

    run: int
    image: Isometry | None
    reversal: Isometry | None


def _images(nodes: Complexes, image: Isometry, close: float) -> Ints | None:
    """The index of the node onto which each is mapped; None where there is none for some, or one for two."""
    places = move(nodes, image.a, image.b, image.conj)
    order = np.argsort(nodes.real)
    found = np.full(len(nodes), -1)
    low = np.searchsorted(nodes.real[order], places.real - close)
    high = np.searchsorted(nodes.real[order], places.real + close)
    for k, (a, b) in enumerate(zip(low.tolist(), high.tolist(), strict=True)):
        if b > a:
            gaps = np.abs(nodes[order[a:b]] - places[k])
            best = int(gaps.argmin())
            found[k] = order[a + best] if gaps[best] <= close else -1
    return found if found.min() >= 0 and len(np.unique(found)) == len(found) else None


def _breaks(rings: Paths, images: Sequence[Ints], close: float) -> Bools:
    """Choose nodes at which rings are cut: of each ring one node, with all its images."""
    chosen = np.zeros(len(rings.start), np.bool_)
    score = _scores(rings, close)
    for first, stop in pairwise(rings.offsets.tolist()):
        if not chosen[first:stop].any():
            node = first + int(score[first:stop].argmax())
            chosen[[node, *(int(image[node]) for image in images)]] = True
    return chosen


def _scores(rings: Paths, close: float) -> Floats:
    """How good a place to cut each node is: a corner between long segments, else a node between long segments.

    What is alike under symmetry is so to rounding, and comes out the same to `close`.
    """
    everything = np.arange(len(rings.start))
    before = np.empty(len(everything), np.intp)
    before[next_in_ring(rings.offsets)] = everything
    incoming = tangent_at(rings, before, np.ones(len(everything)))
    outgoing = tangent_at(rings, everything, np.zeros(len(everything)))
    corner = np.abs(np.angle(outgoing * incoming.conj())) > CORNER
    room = np.minimum(rings.lengths, rings.lengths[before])
    # Corners whose neighbours are specks are no better than others.
    long = room > 0.05 * np.median(rings.lengths)
    return np.asarray(np.round(room / close) * close + np.where(corner & long, rings.lengths.sum(), 0.0))


def _runs(rings: Paths, breaks: Bools) -> list[_Run]:
    """The parts of rings between the nodes at which they are cut, ring after ring."""
    runs = []
    for ring, (first, stop) in enumerate(pairwise(rings.offsets.tolist())):
        cuts = (first + np.flatnonzero(breaks[first:stop])).tolist()
        for start, end in pairwise([*cuts, cuts[0]]):
            length = end - start if end > start else end - start + stop - first
            segments = first + (np.arange(start, start + length) - first) % (stop - first)
            runs.append(_Run(ring, segments, start, end))
    return runs


def _orbits(
    rings: Paths, runs: Sequence[_Run], maps: Sequence[Isometry], images: Sequence[Ints]
) -> tuple[list[_Source], dict[int, Paths]]:
    """For each run the one that stands for its orbit, and those with what is to be fitted of them."""
    number = {run.start: k for k, run in enumerate(runs)}
    sources: dict[int, _Source] = {}
    asked = {}
    for k, run in enumerate(runs):
        if k in sources:
            continue
        # A reflection turns the ring round: the image begins where the end goes.
        there = [number[int(image[run.end if by.conj else run.start])] for by, image in zip(maps, images, strict=True)]
        reversal = next((by for by, other in zip(maps, there, strict=True) if other == k and by.conj), None)
        sources[k] = _Source(k, None, reversal)
        for by, other in zip(maps, there, strict=True):
            sources.setdefault(other, _Source(k, by, None))
        path = _part(rings, run.segments)
        asked[k] = path if reversal is None else first_half(path)
    return [sources[k] for k in range(len(runs))], asked


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

"""Edges of the tiling: maximal runs of arcs between two tiles, each paired with all its images.

Seen from the tile beyond, and wherever a site's own symmetry maps it, an edge is an edge of some base tile again. All
of these are found, and which motion takes which to which: so they form orbits, of which one edge each is needed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.base.tolerance import PROOF_LIMIT
from voronoi_tiles.vector.complex.traced import Traced
from voronoi_tiles.vector.copies import Placed
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, inverse, reverses_orientation

# How near vertices must be to count as one, relative to the cell's size: far above rounding.
_SAME = 1e-6
# How far an edge may be from the image of its counterpart, on the same scale. Where copies nearly touch, vertices are
# known to far fewer digits along their edges; the proof judges what comes of it.
PAIRING = 1e-3
# An edge this short, on the same scale, may have come out in one tile only.
_ONE_SIDED = 1e-6
# Turns the plane so that no mirror and no row of copies is upright.
_SLANT = np.exp(1j)

Corner = tuple[int, int]
"""Where an arc starts: its tile, and its index in the traced boundary of that."""


@dataclass(eq=False, slots=True)
class Edge:
    """A maximal run of arcs that face one copy; where it is a whole ring, it is cut at one vertex or several.

    It is part of the boundary of the base tile `tile`: its k arcs are `arcs` (intp, k), in order, and `beyond` are the
    site and the motion of the copy on their other side. It runs from the corner `start` to the corner `end`, over the
    points `vertex` (complex128, k + 1) at the ends of its arcs; `course` (complex128, 2 k + 1) has a point between the
    ends of each arc besides, halfway by its parameter.

    `images` are all edges of base tiles that motions map it to, each with the motion and whether its image runs
    backwards along that edge; itself under the identity comes first.
    """

    tile: int
    arcs: Ints
    beyond: tuple[int, Motion]
    start: Corner
    end: Corner
    vertex: Complexes
    course: Complexes
    images: list[tuple[Motion, Edge, bool]]


class UnpairedEdgeError(ArithmeticError):
    """An edge, `edge`, has no counterpart in the tile beyond, or no image there."""

    def __init__(self, edge: Edge) -> None:
        super().__init__("an edge has no counterpart in the tile beyond")
        self.edge = edge


def find_edges(
    action: Action, placed: list[Placed], traced: list[Traced], *, without_short: bool
) -> tuple[list[Traced], list[Edge]]:
    """The boundaries of all base tiles and their edges, ring after ring, each with its images.

    Edges that rounding has made, where many tiles meet, are left out of the boundaries. `without_short` leaves out all
    that may be such; this is tried as well where the edges cannot be paired otherwise. Raises UnpairedEdgeError where
    they cannot be paired at all.
    """
    limit = (_ONE_SIDED if without_short else PROOF_LIMIT) * action.size
    traced = [_without_short_edges(boundary, limit) for boundary in traced]
    pinched = True
    while True:
        try:
            return traced, _paired(action, placed, traced, pinched=pinched)
        except UnpairedEdgeError as error:
            edge = error.edge
            extent = float(np.abs(edge.vertex - edge.vertex[0]).max())
            boundary = traced[edge.tile]
            rest = np.delete(np.arange(len(boundary)), edge.arcs)
            if extent <= _ONE_SIDED * action.size and len(rest):
                traced = [boundary.take(rest) if t == edge.tile else other for t, other in enumerate(traced)]
            elif pinched:
                pinched = False
            elif not without_short:
                return find_edges(action, placed, traced, without_short=True)
            else:
                raise


def _paired(action: Action, placed: list[Placed], traced: list[Traced], *, pinched: bool) -> list[Edge]:
    """The edges of boundaries, ring after ring, each with its images.

    `pinched` looks for vertices at which a boundary touches itself, and ends edges there: such a tile may have the same
    neighbour before and after the vertex, while an edge of that neighbour ends. Raises UnpairedEdgeError.
    """
    cuts = [_cuts(boundary) for boundary in traced]
    _cut_further(action, placed, traced, cuts, pinched)
    edges = [edge for tile, boundary in enumerate(traced) for edge in _edges(tile, boundary, cuts[tile])]
    between: defaultdict[tuple[int, tuple[int, Motion]], list[Edge]] = defaultdict(list)
    for edge in edges:
        between[edge.tile, edge.beyond].append(edge)
    limit = PAIRING * action.size
    for edge in edges:
        for motion, tile, beyond, flips in _images(placed, edge.tile, *edge.beyond):
            if motion == IDENTITY and not flips:
                edge.images.append((motion, edge, False))
                continue
            image = action.apply(motion, edge.course)
            candidates = between.get((tile, beyond), [])
            if flips:
                image = image[::-1]
            gaps = [_gap(image, other.course, limit) for other in candidates]
            best = int(np.argmin(gaps)) if gaps else -1
            if best < 0 or gaps[best] > limit:
                raise UnpairedEdgeError(edge)
            edge.images.append((motion, candidates[best], flips))
    return edges


def _without_short_edges(boundary: Traced, limit: float) -> Traced:
    """The boundary of the edges that extend farther than a limit; of all in a ring that would have none."""
    kept = []
    for ring, cut in zip(boundary.rings, _cuts(boundary), strict=True):
        long = [
            arcs
            for arcs, end in _runs(ring, cut)
            if np.abs(boundary.vertex[np.append(arcs, end)] - boundary.vertex[arcs[0]]).max() > limit
        ]
        kept.append(np.sort(np.concatenate(long)) if len(cut) > 1 and long else ring)
    index = np.concatenate(kept)
    return boundary if len(index) == len(boundary) else boundary.take(index)


def _gap(one: Complexes, other: Complexes, limit: float) -> float:
    """How far the courses of two edges are from being the same.

    Where they do not agree one by one, points at equal shares of their lengths are compared: rounding may split a
    vertex, in one of the two, into several.
    """
    if len(one) == len(other):
        gap = float(np.abs(one - other).max())
        if gap <= limit:
            return gap
    shares = np.linspace(0.0, 1.0, 9)
    places = []
    for course in (one, other):
        run = np.append(0.0, np.cumsum(np.abs(np.diff(course))))
        places.append(
            np.interp(shares * run[-1], run, course.real) + 1j * np.interp(shares * run[-1], run, course.imag)
        )
    return float(np.abs(places[0] - places[1]).max())


def _cuts(boundary: Traced) -> list[list[int]]:
    """For each ring the places in it where the copy beyond changes."""
    result = []
    for ring in boundary.rings:
        target, copy = boundary.target[ring], boundary.copy[ring]
        changes = (target != np.roll(target, 1)) | (copy != np.roll(copy, 1))
        result.append(np.flatnonzero(changes).tolist())
    return result


def _images(
    placed: list[Placed], tile: int, target: int, there: Motion
) -> Iterator[tuple[Motion, int, tuple[int, Motion], bool]]:
    """Every way to move an edge between a base tile and the copy of `target` under `there` onto a base tile.

    That is the motion, the tile, site and motion of the copy then beyond, and whether the image runs backwards.
    """
    for motion in placed[tile].stabilizer:
        beyond = placed[target].canonical(compose(motion, there))
        yield motion, tile, (target, beyond), reverses_orientation(motion)
    back = inverse(there)
    for element in placed[target].stabilizer:
        motion = compose(element, back)
        yield motion, target, (tile, placed[tile].canonical(motion)), not reverses_orientation(motion)


def _cut_further(
    action: Action, placed: list[Placed], traced: list[Traced], cuts: list[list[list[int]]], pinched: bool
) -> None:
    """Cut rings at more vertices, and at all images of these, in place.

    They are one vertex of each ring that faces one copy only and, where `pinched`, those where a boundary touches
    itself.
    """
    # A vertex is where its arc starts; what it is mapped to depends on the copies beyond this arc and the one before.
    waiting: list[Corner] = []
    for tile, boundary in enumerate(traced):
        if pinched:
            waiting += [(tile, arc) for arc in _pinches(boundary, _SAME * action.size)]
        waiting += [(tile, int(r[0])) for r, cut in zip(boundary.rings, cuts[tile], strict=True) if not cut]
    done: set[Corner] = set()
    while waiting:
        tile, arc = waiting.pop()
        if (tile, arc) in done:
            continue
        done.add((tile, arc))
        boundary = traced[tile]
        number, ring = next((n, r) for n, r in enumerate(boundary.rings) if r[0] <= arc <= r[-1])
        before = arc - 1 if arc > ring[0] else int(ring[-1])
        place = arc - int(ring[0])
        if place not in cuts[tile][number]:
            cuts[tile][number] = sorted([*cuts[tile][number], place])
        here = boundary.vertex[arc : arc + 1]
        for faced in {boundary.beyond(arc), boundary.beyond(before)}:
            for motion, other, beyond, _ in _images(placed, tile, *faced):
                waiting += [
                    (other, k)
                    for k in _at(traced[other], action.apply(motion, here), _SAME * action.size)
                    if traced[other].beyond(k) == beyond
                ]


def _at(boundary: Traced, point: Complexes, limit: float) -> list[int]:
    """The arcs that start at a point."""
    return [int(arc) for arc in np.flatnonzero(np.abs(boundary.vertex - point) <= limit)]


def _pinches(boundary: Traced, limit: float) -> list[int]:
    """The vertices at which a boundary touches itself: another one is within a limit, and not just along the way."""
    # Sorted from left to right, turned by the slant, few vertices are near each other.
    along = (boundary.vertex * _SLANT).real
    order = np.argsort(along)
    vertex, along = boundary.vertex[order], along[order]
    pairs = [np.zeros((0, 2), np.intp)]
    for step in range(1, len(order)):
        near = np.flatnonzero(along[step:] - along[:-step] <= limit)
        if not len(near):
            break
        same = near[np.abs(vertex[near + step] - vertex[near]) <= limit]
        pairs.append(np.stack((order[same], order[same + step]), axis=1))
    one, two = np.concatenate(pairs).T
    # Vertices along a ring may be as close without touching: only short arcs lie between them, one way or the other.
    chord = np.abs(boundary.vertex[boundary.following] - boundary.vertex)
    walk, around = np.cumsum(chord) - chord, np.bincount(boundary.ring, chord)
    between = np.abs(walk[one] - walk[two])
    between = np.minimum(between, around[boundary.ring[one]] - between)
    apart = (boundary.ring[one] != boundary.ring[two]) | (between > limit)
    return [int(vertex) for vertex in np.unique(np.concatenate((one[apart], two[apart])))]


def _runs(ring: Ints, cut: list[int]) -> Iterator[tuple[Ints, int]]:
    """The arcs between the places where a ring is cut, and the arc that starts where they end."""
    for first, last in zip(cut, [*cut[1:], *(place + len(ring) for place in cut[:1])], strict=True):
        yield ring[np.arange(first, last) % len(ring)], int(ring[last % len(ring)])


def _edges(tile: int, boundary: Traced, cuts: list[list[int]]) -> Iterator[Edge]:
    """The edges of a boundary whose rings are cut at these places."""
    for ring, cut in zip(boundary.rings, cuts, strict=True):
        for arcs, end in _runs(ring, cut):
            start = int(arcs[0])
            vertex = boundary.vertex[np.append(arcs, end)]
            course = np.empty(2 * len(vertex) - 1, complex)
            course[::2], course[1::2] = vertex, boundary.middles[arcs]
            yield Edge(
                tile=tile,
                arcs=arcs,
                beyond=boundary.beyond(start),
                start=(tile, start),
                end=(tile, end),
                vertex=vertex,
                course=course,
                images=[],
            )

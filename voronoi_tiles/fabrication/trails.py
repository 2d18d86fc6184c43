"""Every line cut once, in the fewest strokes: Eulerian trails, and short ways between them.

A vertex at which an odd number of strands ends is the end of some trail, so half as many trails as there are such
vertices are needed, and they suffice (Euler; Listing). Ways between the ends are added as if they were strands, short
ones first; then one closed walk (Hierholzer 1873) takes everything, and falls into the trails where it takes a way.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, offsets_of
from voronoi_tiles.base.neighbours import Neighbours
from voronoi_tiles.paths.paths import Paths

_NEAR = 8
"""Neighbours that are looked at for each loose end in one round."""


@dataclass(frozen=True, eq=False)
class Trails:
    """Trails through strands: trail k is `strand[offsets[k]:offsets[k + 1]]`, run backwards unless `forward`."""

    strand: Ints
    forward: Bools
    offsets: Ints


def find_trails(first: Ints, last: Ints, place: Complexes) -> Trails:
    """Find the fewest trails that take every strand once.

    Strand k joins the vertices `first[k]` and `last[k]` (intp, n); `place` says where the vertices are. The trails come
    in an order in which the ways between them are short. Where a part of the drawing is closed, one trail goes round.
    """
    if not len(first):
        return Trails(np.zeros(0, np.intp), np.zeros(0, np.bool_), np.zeros(1, np.intp))
    one, two = _ways(first, last, place)
    count = len(first)
    tail, head = np.concatenate((first, one)), np.concatenate((last, two))
    circuits = _circuits(tail.tolist(), head.tolist(), len(place))
    trails = [trail for circuit in circuits for trail in _cut(circuit, count)]
    strands = np.array([strand for trail in trails for strand, _ in trail], np.intp)
    forward = np.array([sense for trail in trails for _, sense in trail], np.bool_)
    trails_of = Trails(strands, forward, offsets_of([len(trail) for trail in trails]))
    if len(circuits) == 1:
        return trails_of
    return _nearest_next(trails_of, first, last, place)


def joined(strands: Paths, trails: Trails) -> Paths:
    """Join strands to one path for each trail; one that ends where it began is closed."""
    turned = strands.take(trails.strand).reversed(~trails.forward)
    offsets = turned.offsets[trails.offsets]
    closed = turned.start[offsets[:-1]] == turned.end[offsets[1:] - 1]
    return replace(turned, offsets=offsets, closed=closed)


def travel(paths: Paths) -> float:
    """The way from the end of each path to the start of the next one."""
    starts, ends = paths.start[paths.offsets[1:-1]], paths.end[paths.offsets[1:-1] - 1]
    return float(np.abs(starts - ends).sum())


def _ways(first: Ints, last: Ints, place: Complexes) -> tuple[Ints, Ints]:
    """Join the vertices with an odd number of ends in pairs, near ones first."""
    degree = np.bincount(np.concatenate((first, last)), minlength=len(place))
    loose = np.flatnonzero(degree % 2)
    one: list[Ints] = []
    two: list[Ints] = []
    while len(loose):
        points = place[loose]
        near = min(_NEAR, len(loose) - 1)
        distance, other = Neighbours(points).nearest(points, near + 1)
        mine = np.repeat(np.arange(len(loose)), near + 1)
        gap, theirs = distance.ravel(), other.ravel()
        pairs = np.flatnonzero(mine < theirs)
        order = pairs[np.lexsort((theirs[pairs], mine[pairs], gap[pairs]))]
        free = [True] * len(loose)
        # The nearest two of all are among the pairs: every round takes some.
        chosen = []
        for a, b in zip(mine[order].tolist(), theirs[order].tolist(), strict=True):
            if free[a] and free[b]:
                free[a] = free[b] = False
                chosen.append((a, b))
        pair = np.array(chosen)
        one.append(loose[pair[:, 0]])
        two.append(loose[pair[:, 1]])
        loose = loose[np.array(free)]
    none = np.zeros(0, np.intp)
    return np.concatenate([none, *one]), np.concatenate([none, *two])


def _circuits(tail: list[int], head: list[int], vertices: int) -> list[list[tuple[int, bool]]]:
    """Walk round every part of a graph in which all vertices are even: strands, with whether they run forwards."""
    beside: list[list[int]] = [[] for _ in range(vertices)]
    for k in range(len(tail) - 1, -1, -1):
        beside[tail[k]].append(k)
        beside[head[k]].append(k)
    used = [False] * len(tail)
    circuits = []
    for begin in range(len(tail)):
        if used[begin]:
            continue
        stack: list[tuple[int, int, bool]] = [(tail[begin], -1, True)]
        circuit: list[tuple[int, bool]] = []
        while stack:
            vertex, strand, sense = stack[-1]
            edges = beside[vertex]
            while edges and used[edges[-1]]:
                edges.pop()
            if edges:
                taken = edges.pop()
                used[taken] = True
                forward = tail[taken] == vertex
                stack.append((head[taken] if forward else tail[taken], taken, forward))
            else:
                stack.pop()
                if strand >= 0:
                    circuit.append((strand, sense))
        circuits.append(circuit[::-1])
    return circuits


def _cut(circuit: list[tuple[int, bool]], count: int) -> list[list[tuple[int, bool]]]:
    """Cut a circuit at the ways, which are numbered from `count` on."""
    cuts = [k for k, (strand, _) in enumerate(circuit) if strand >= count]
    if not cuts:
        return [circuit]
    turned = circuit[cuts[0] + 1 :] + circuit[: cuts[0] + 1]
    trails: list[list[tuple[int, bool]]] = [[]]
    for strand, sense in turned:
        if strand < count:
            trails[-1].append((strand, sense))
        else:
            trails.append([])
    return trails[:-1]


def _nearest_next(trails: Trails, first: Ints, last: Ints, place: Complexes) -> Trails:
    """Put trails into an order with short ways."""
    from voronoi_tiles.fabrication.tour import short_tour

    begin, stop = trails.offsets[:-1], trails.offsets[1:] - 1
    start = np.where(trails.forward[begin], first[trails.strand[begin]], last[trails.strand[begin]])
    end = np.where(trails.forward[stop], last[trails.strand[stop]], first[trails.strand[stop]])
    order, turned = short_tour(place[start], place[end])
    parts = [
        np.arange(begin[k], stop[k] + 1)[::-1] if back else np.arange(begin[k], stop[k] + 1)
        for k, back in zip(order.tolist(), turned.tolist(), strict=True)
    ]
    places = np.concatenate(parts)
    flip = np.repeat(turned, [len(part) for part in parts])
    return Trails(
        trails.strand[places],
        trails.forward[places] ^ flip,
        offsets_of([len(part) for part in parts]),
    )

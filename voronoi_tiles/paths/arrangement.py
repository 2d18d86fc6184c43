"""Segments cut at all their crossings: the parts between, and the nodes where they begin and end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.components import components
from voronoi_tiles.paths.intersections import crossings
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import Circles, candidate_pairs, chord_share, from_chord_share, point_at, tangent_at


@dataclass(frozen=True, eq=False)
class Arrangement:
    """The parts of segments between their crossings.

    Part k runs along the segment `segment[k]` from `t0[k]` to `t1[k]`, from the node `tail[k]` to the node `head[k]`
    (intp); `nodes` (complex128) are their places. Parts of one segment stand together, in its order.
    """

    segment: Ints
    t0: Floats
    t1: Floats
    tail: Ints
    head: Ints
    nodes: Complexes


def arrangement(paths: Paths, tail: Ints, head: Ints, nodes: Complexes, tolerance: float) -> Arrangement:
    """Cut LINEs and ARCs, each a path of its own, at their crossings, and join nodes nearer than `tolerance`.

    Segment k runs from the node `tail[k]` to `head[k]`; `nodes` are the places. A crossing of a segment with the one
    that follows it is the node between them where the two do not part by `tolerance` in between: the point where two
    curves touch is known to the root of the rounding only. Segments that run along each other are cut at each other's
    ends.
    """
    i, j = candidate_pairs(paths, paths, tolerance)
    once = i < j
    i, j = i[once], j[once]
    met = crossings(paths, i, paths, j)
    near = _at_common_node(paths, tail, head, nodes, i[met.pair], j[met.pair], met.point, tolerance)
    pair, t, u = met.pair[~near], met.t[~near], met.u[~near]
    count = len(nodes)
    fresh = count + np.arange(len(pair))
    along = _ends_on(paths, i[met.overlaps], j[met.overlaps], tail, head, nodes, tolerance)
    places = np.concatenate((nodes, met.point[~near]))
    everything = np.arange(len(paths.start))
    segment = np.concatenate((everything, everything, i[pair], j[pair], along[0]))
    share = np.concatenate((np.zeros(len(everything)), np.ones(len(everything)), t, u, along[1]))
    node = np.concatenate((tail, head, fresh, fresh, along[2]))
    node = merged(places, tolerance)[node]
    # The ends stay first and last, whatever else has the same share.
    rank = np.repeat([0, 2, 1], [len(everything), len(everything), len(segment) - 2 * len(everything)])
    order = np.lexsort((rank, share, segment))
    segment, share, node = segment[order], share[order], node[order]
    inner = np.flatnonzero(segment[1:] == segment[:-1])
    begin, stop = node[inner], node[inner + 1]
    length = paths.lengths[segment[inner]] * (share[inner + 1] - share[inner])
    real = (begin != stop) | (length > 4 * tolerance)
    inner = inner[real]
    return Arrangement(
        segment=segment[inner],
        t0=share[inner],
        t1=share[inner + 1],
        tail=begin[real],
        head=stop[real],
        nodes=places,
    )


def merged(places: Complexes, tolerance: float) -> Ints:
    """For each place the first of those that are one with it: within `tolerance`, or by a chain of such."""
    import shapely

    points = shapely.points(places.real, places.imag)
    near = shapely.STRtree(points).query(points, predicate="dwithin", distance=tolerance)
    return components(len(places), near[0], near[1])


def _at_common_node(
    paths: Paths, tail: Ints, head: Ints, nodes: Complexes, i: Ints, j: Ints, points: Complexes, tolerance: float
) -> Bools:
    """Whether segments that follow each other part by no more than `tolerance` between their node and a crossing."""
    circles = Circles.of(paths, np.arange(len(paths.start)))
    near = np.zeros(len(i), np.bool_)
    for first, second in ((i, j), (j, i)):
        joint = np.flatnonzero(head[first] == tail[second])
        a, b = first[joint], second[joint]
        ahead = tangent_at(paths, a, np.ones(len(a)))
        angle = np.abs(np.angle(tangent_at(paths, b, np.zeros(len(b))) * ahead.conj()))
        away = np.abs(points[joint] - nodes[head[a]])
        bend = np.abs(circles.curvature[a] - circles.curvature[b])
        near[joint] |= away * angle + away**2 * bend / 8 <= tolerance
        near[joint] |= away <= tolerance
    return near


def _ends_on(
    paths: Paths, i: Ints, j: Ints, tail: Ints, head: Ints, nodes: Complexes, tolerance: float
) -> tuple[Ints, Floats, Ints]:
    """The ends of segments that lie on the other of their pair: the other, the share of its angle there, the node."""
    segment, share, node = [], [], []
    for on, of in ((i, j), (j, i)):
        circles = Circles.of(paths, on)
        for end in (tail, head):
            z = nodes[end[of]]
            x = chord_share((z - circles.start) / circles.chord, circles.half)
            slack = tolerance / np.abs(circles.chord)
            inside = np.flatnonzero((x > slack) & (x < 1 - slack))
            segment.append(on[inside])
            share.append(from_chord_share(x[inside], circles.half[inside])[1])
            node.append(end[of[inside]])
    return np.concatenate(segment), np.concatenate(share), np.concatenate(node)


def without_doubles(parts: Arrangement, paths: Paths, kept: Bools, tolerance: float) -> Bools:
    """Of `kept` parts that lie on each other one, where they run the same way, and none, where they run both ways."""
    middle = point_at(paths, parts.segment, (parts.t0 + parts.t1) / 2)
    low, high = np.minimum(parts.tail, parts.head), np.maximum(parts.tail, parts.head)
    forward = parts.tail <= parts.head
    places = np.flatnonzero(kept)
    order = places[np.lexsort((high[places], low[places]))]
    same = (low[order[1:]] == low[order[:-1]]) & (high[order[1:]] == high[order[:-1]])
    result = kept.copy()
    if not same.any():
        return result
    for members in np.split(order, np.flatnonzero(~same) + 1):
        rest = members.tolist() if len(members) > 1 else []
        while rest:
            alike = [k for k in rest if abs(middle[k] - middle[rest[0]]) <= 8 * tolerance]
            rest = [k for k in rest if k not in alike]
            ahead = [k for k in alike if forward[k]]
            back = [k for k in alike if not forward[k]]
            result[alike] = False
            if not ahead or not back:
                result[(ahead or back)[0]] = True
    return result

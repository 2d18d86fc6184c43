"""Walls between two levels: triangles between the chains of each edge, once for all tiles that share it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, counting, counts_of, offsets_of, owned_ranges
from voronoi_tiles.solid.correspondence import Correspondence
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.levels import VertexChains
from voronoi_tiles.solid.vertices import Vertices
from voronoi_tiles.vector.complex.representatives import Points
from voronoi_tiles.vector.motion_codes import Codes, code_of, composed, inverted

_PASSES: Final = 4
"""How often it is looked which of two sides is shorter; an even count: for steps that are even and odd in turn."""

_ALONG: Final = 13
"""At how many vertices along them two loops are compared; a count."""


@dataclass(frozen=True, eq=False)
class Walls:
    """The walls between two levels, as triangles where the edges of the lower layer stand for their orbits.

    The corners of triangle k are the points 3 k to 3 k + 2, counter-clockwise as seen from the right of the edge, which
    is outside where a tile's boundary runs along it. Those of edge k are the triangles from `offsets[k]` up to, not
    including, `offsets[k + 1]`.
    """

    layer: ExactLayer
    corners: Points
    offsets: Ints

    def of_tile(self, tile: int) -> tuple[Points, Ints]:
        """The corners of the walls of a base tile, counter-clockwise as seen from outside, and the ring of each."""
        layer = self.layer
        rings = layer.tile_offsets[tile : tile + 2]
        uses = np.arange(*layer.ring_offsets[rings])
        edge = layer.edge[uses]
        triangle, which = owned_ranges(self.offsets[edge], self.offsets[edge + 1])
        turned = layer.backwards[uses][which]
        at = 3 * triangle[:, None] + np.where(turned[:, None], [0, 2, 1], [0, 1, 2])
        by = np.repeat(layer.motion[uses][which], 3)
        return self.corners.take(at.ravel()).moved(by), np.repeat(layer.ring[uses][which], 3)


def walls(
    vertices: Vertices,
    low: ExactLayer,
    high: ExactLayer,
    chains: tuple[VertexChains, VertexChains],
    same: Correspondence,
) -> Walls:
    """The walls from the chains of one layer to those of the next, whose uses correspond.

    An edge may have more steps in one of them than in the other, and is a point where it has none. Where a motion turns
    an edge round, one half of its wall is the image of the other.
    """
    one, two = chains
    by, turned, partner = _onto(low, high, same)
    above = _rolled(vertices, low, one, _rearranged(two, partner, by, turned))
    flips = {
        k: code_of(motion) for k, pairs in low.quotient.symmetric.items() for motion, back in reversed(pairs) if back
    }
    steps = np.stack((one.counts, above.counts)) - 1  # none for a point
    steps[:, list(flips)] //= 2
    pool = one.points.and_then(above.points)
    places = vertices.representatives.locate(pool)
    begin = np.stack((one.offsets[:-1], len(one.points) + above.offsets[:-1]))
    triangle, owner = _zipped(places, begin, steps)
    corners = pool.take(triangle.ravel())
    if flips:
        back = np.zeros(len(partner), np.int64)
        back[list(flips)] = list(flips.values())
        image = back[owner] != 0
        half = pool.take(triangle[image][:, [0, 2, 1]].ravel()).moved(np.repeat(back[owner[image]], 3))
        corners, owner = corners.and_then(half), np.concatenate((owner, owner[image]))
        order = np.argsort(owner, kind="stable")
        corners, owner = corners.take((3 * order[:, None] + np.arange(3)).ravel()), owner[order]
    return Walls(low, corners, offsets_of(np.bincount(owner, minlength=len(partner))))


def _zipped(places: Complexes, begin: Ints, steps: Ints) -> tuple[Ints, Ints]:
    """Triangles between two chains of each edge, intp (n, 3), numbers of `places`, and the edge of each.

    For both chains, lower first, `begin` and `steps` (intp, 2 x edges) are where they begin among the places and how
    many steps they take. Step follows step as their middles do, by shares of the chains' lengths; two that follow each
    other go the other way round where that makes the side between them shorter.
    """
    number, edge, middle = [], [], []
    for first, count in zip(begin, steps, strict=True):
        step, owner = counting(count)
        length = np.abs(places[first[owner] + step + 1] - places[first[owner] + step])
        after, whole = np.cumsum(length), np.bincount(owner, weights=length, minlength=len(count))
        before = np.cumsum(whole) - whole
        even = (step + 0.5) / count[owner]
        number.append(step)
        edge.append(owner)
        middle.append(np.where(whole[owner] > 0.0, (after - length / 2 - before[owner]) / whole[owner], even))
    upper = np.repeat([False, True], [len(part) for part in number])
    owner = np.concatenate(edge)
    order = np.lexsort((upper, np.concatenate(middle), owner))
    upper, owner = upper[order], owner[order]
    joint = np.flatnonzero(owner[1:] == owner[:-1])
    for turn in range(_PASSES):
        low, high = _reached(upper, owner, begin)
        pair = joint[(joint % 2 == turn % 2) & (upper[joint] != upper[joint + 1])]
        over = np.abs(places[low[pair]] - places[high[pair] + 1])
        under = np.abs(places[low[pair] + 1] - places[high[pair]])
        upper[pair] = over < under
        upper[pair + 1] = ~upper[pair]
    low, high = _reached(upper, owner, begin)
    return np.column_stack((low, np.where(upper, high + 1, low + 1), high)), owner


def _reached(upper: Bools, owner: Ints, begin: Ints) -> tuple[Ints, Ints]:
    """Where steps that are `upper`, or not, of each owner one after the other, begin in either chain."""
    found = []
    for first, moves in zip(begin, (~upper, upper), strict=True):
        done: Ints = np.cumsum(moves) - moves
        start = np.searchsorted(owner, np.arange(begin.shape[1]))
        found.append(first[owner] + done - np.append(done, 0)[start][owner])
    return found[0], found[1]


def _onto(low: ExactLayer, high: ExactLayer, same: Correspondence) -> tuple[Codes, Bools, Ints]:
    """For each edge of the lower layer the motion that takes its partner there, whether that runs backwards, and it."""
    count = len(low.quotient.offsets) - 1
    by, turned, partner = np.zeros(count, np.int64), np.zeros(count, np.bool_), np.zeros(count, np.intp)
    # Of the uses of an orbit the last one counts; all say the same.
    edge = low.edge[same.low]
    by[edge] = composed(inverted(low.motion[same.low]), high.motion[same.high])
    turned[edge] = low.backwards[same.low] != high.backwards[same.high]
    partner[edge] = high.edge[same.high]
    return by, turned, partner


def _rearranged(chains: VertexChains, partner: Ints, by: Codes, turned: Bools) -> VertexChains:
    """The chains of the partners of edges, moved to these, and turned round where they run against them."""
    counts = counts_of(chains.offsets)[partner]
    step, owner = counting(counts)
    step = np.where(turned[owner], counts[owner] - 1 - step, step)
    points = chains.points.take(chains.offsets[partner][owner] + step).moved(by[owner])
    return VertexChains(points, offsets_of(counts))


def _rolled(vertices: Vertices, layer: ExactLayer, below: VertexChains, above: VertexChains) -> VertexChains:
    """The chains above, begun elsewhere where a boundary faces one copy all round: where those below begin.

    Such a boundary has no corners, and the engine begins it anywhere. A motion takes its first vertex to its last one.
    """
    rings = [ring for tile in layer.rings for ring in tile]
    uses = [np.arange(*layer.ring_offsets[k : k + 2]) for k, ring in enumerate(rings) if len(set(ring)) == 1]
    if not uses:
        return above
    index, motion = above.points.index.copy(), above.points.motion.copy()
    fixed = {k for k, pairs in layer.quotient.symmetric.items() if any(back for _, back in pairs)}
    for k in set(layer.edge[np.concatenate(uses)].tolist()) - fixed:
        first, last = above.offsets[k : k + 2].tolist()
        steps = last - first - 1
        if index[first] != index[last - 1]:
            continue
        on = composed(motion[last - 1 :][:1], inverted(motion[first:][:1]))
        own = Points(index[first : last - 1], motion[first : last - 1])
        turns = [own.moved(np.repeat(by, steps)) for by in (inverted(on), composed(on, inverted(on)), on)]
        longer = turns[0].and_then(turns[1]).and_then(turns[2])
        places = vertices.representatives.locate(longer)
        there = vertices.representatives.locate(below.points.take(slice(*below.offsets[k : k + 2].tolist())))
        starts = range(steps // 2, steps // 2 + steps)
        shown = np.linspace(0, steps, _ALONG).round().astype(np.intp)
        facing = there[np.linspace(0, len(there) - 1, _ALONG).round().astype(np.intp)]
        begin = min(starts, key=lambda at: float(np.abs(places[at + shown] - facing).sum()))
        rolled = longer.take(slice(begin, begin + steps + 1))
        index[first:last], motion[first:last] = rolled.index, rolled.motion
    return VertexChains(Points(index, motion), above.offsets)

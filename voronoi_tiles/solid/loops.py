"""Boundaries that face one copy all round: they have no corners, and where the engine cuts them says nothing."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints, counts_of, offsets_of, ranges
from voronoi_tiles.vector.complex.quotient import Quotient
from voronoi_tiles.vector.complex.representatives import Points
from voronoi_tiles.vector.motion_codes import Codes, composed, inverted


def with_whole_loops(quotient: Quotient) -> Quotient:
    """A quotient complex in which rings that face one copy are cut as seldom as their symmetry allows.

    Their edges are joined to one, of which the ring is the images under rotations that map it onto itself. Rings on
    mirrors stay as they are.
    """
    uses = quotient.uses
    faced = np.column_stack((uses.site, uses.beyond))
    bounds = uses.ring_offsets.tolist()
    rings = [list(range(a, b)) for a, b in pairwise(bounds)]
    loops = [k for k, ring in enumerate(rings) if len(ring) > 1 and (faced[ring] == faced[ring[0]]).all()]
    if not loops:
        return quotient
    edge, motion, back = uses.edge.copy(), uses.motion.copy(), uses.backwards.copy()
    joined: dict[int, list[int]] = {}  # an edge of a loop: the uses that are joined
    count = len(quotient.offsets) - 1
    parts: list[list[int]] = []
    for k in loops:
        ring = rings[k]
        leader = joined.get(int(edge[ring[0]]))
        if leader is None:
            size = len(set(edge[ring].tolist()))
            turned = ring[size:] + ring[:size]
            even = (edge[ring] == edge[turned]).all() and (back[ring] == back[turned]).all()
            if not even or any(int(e) in quotient.symmetric for e in edge[ring]):
                continue
            leader = ring[:size]
            joined.update({int(edge[use]): leader for use in leader})
            parts.append(leader)
        first = leader[0]
        rings[k] = [use for use in ring if uses.edge[use] == uses.edge[first]]
        for use in rings[k]:
            by = composed(uses.motion[use : use + 1], inverted(uses.motion[first : first + 1]))
            motion[use], back[use] = by[0], uses.backwards[use] != uses.backwards[first]
            edge[use] = count + parts.index(leader)
    gone = np.zeros(count, np.bool_)
    for part in parts:
        gone[uses.edge[part]] = True
    return _renumbered(quotient, rings, parts, gone, (edge, motion, back))


def _renumbered(
    quotient: Quotient,
    rings: list[list[int]],
    parts: list[list[int]],
    gone: Bools,
    changed: tuple[Ints, Codes, Bools],
) -> Quotient:
    """The complex without the edges that are `gone`, and with those that are joined of the uses `parts` behind them."""
    uses = quotient.uses
    kept = np.flatnonzero(~gone)
    number = np.append(np.cumsum(~gone) - 1, len(kept) + np.arange(len(parts)))
    counts = counts_of(quotient.offsets)
    arcs = ranges(quotient.offsets[kept], counts[kept])
    corners = ranges(quotient.offsets[kept] + kept, counts[kept] + 1)
    vertex, control = [quotient.vertex.take(corners)], [quotient.control.take(arcs)]
    sources, sizes = [arcs], counts[kept].tolist()
    for part in parts:
        for place, use in enumerate(part):
            k, turn = int(uses.edge[use]), -1 if uses.backwards[use] else 1
            own = np.arange(quotient.offsets[k], quotient.offsets[k + 1])[::turn]
            ends = np.arange(quotient.offsets[k] + k, quotient.offsets[k + 1] + k + 1)[::turn]
            ends = ends[bool(place) :]  # it begins where the one before has ended
            vertex.append(quotient.vertex.take(ends).moved(np.repeat(uses.motion[use], len(ends))))
            control.append(quotient.control.take(own).moved(np.repeat(uses.motion[use], len(own))))
            sources.append(own)
        sizes.append(int(counts[uses.edge[part]].sum()))
    edge, motion, back = changed
    order = np.array([use for ring in rings for use in ring], np.intp)
    source = np.concatenate(sources)
    return replace(
        quotient,
        vertex=Points.joined(vertex),
        control=Points.joined(control),
        focus=quotient.focus[source],
        directrix=quotient.directrix[source],
        offsets=offsets_of(sizes),
        symmetric={int(number[k]): pairs for k, pairs in quotient.symmetric.items() if not gone[k]},
        uses=replace(
            uses,
            edge=number[edge[order]],
            motion=motion[order],
            backwards=back[order],
            site=uses.site[order],
            beyond=uses.beyond[order],
            ring_offsets=offsets_of([len(ring) for ring in rings]),
        ),
    )

"""Parts chained to closed rings by the nodes that they share."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints
from voronoi_tiles.paths.arrangement import Arrangement
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import point_at, split, tangent_at
from voronoi_tiles.paths.short_segments import straightened

_ROUNDS = 1000
"""Most parts of one dead end; a longer one means that a crossing was missed, which the length of what is left tells."""


def without_dead_ends(parts: Arrangement, kept: Bools) -> Bools:
    """Of `kept` parts those that are left when all that lead nowhere or come from nowhere are taken away in turn."""
    kept, n = kept.copy(), len(parts.nodes)
    for _ in range(_ROUNDS):
        leads = np.bincount(parts.tail[kept], minlength=n) > 0
        comes = np.bincount(parts.head[kept], minlength=n) > 0
        dead = kept & ~(leads[parts.head] & comes[parts.tail])
        if not dead.any():
            break
        kept &= ~dead
    return kept


def chained(parts: Arrangement, paths: Paths, kept: Bools) -> list[Ints]:
    """The rings of `kept` parts, as the parts in their order.

    Where several parts leave a node, a ring takes the leftmost, so that rings touch and do not cross: what they
    enclose on the left is parted there. Raises LookupError with the number of a part where a ring does not close.
    """
    places = np.flatnonzero(kept)
    following = _following(parts, paths, places)
    rings, left = [], dict.fromkeys(places.tolist())
    while left:
        first = next(iter(left))
        ring, part = [], first
        while part in left:
            del left[part]
            ring.append(part)
            if part not in following:
                raise LookupError(part)
            part = following[part]
        if part != first:
            raise LookupError(part)
        rings.append(np.array(ring, np.intp))
    return rings


def _following(parts: Arrangement, paths: Paths, places: Ints) -> dict[int, int]:
    """The part that each part goes on with."""
    leaving: dict[int, list[int]] = {}
    for part, node in zip(places.tolist(), parts.tail[places].tolist(), strict=True):
        leaving.setdefault(node, []).append(part)
    arriving: dict[int, list[int]] = {}
    for part, node in zip(places.tolist(), parts.head[places].tolist(), strict=True):
        arriving.setdefault(node, []).append(part)
    following = {}
    for node, comes in arriving.items():
        goes = leaving.get(node, [])
        if len(comes) == len(goes) == 1:
            following[comes[0]] = goes[0]
        elif goes:
            following.update(_paired(parts, paths, comes, goes))
    return following


def _paired(parts: Arrangement, paths: Paths, comes: list[int], goes: list[int]) -> dict[int, int]:
    """Pair the parts that arrive at a node with those that leave it, without crossings: the leftmost turn first."""
    into, out = np.array(comes), np.array(goes)
    t_in, t_out = 0.75 * parts.t1 + 0.25 * parts.t0, 0.75 * parts.t0 + 0.25 * parts.t1
    node = parts.nodes[parts.tail[goes[0]]]
    # A chord of a quarter of the part, beside the tangent, tells curves that leave in one direction.
    back = node - point_at(paths, parts.segment[into], t_in[into])
    ahead = point_at(paths, parts.segment[out], t_out[out]) - node
    tangents = (
        tangent_at(paths, parts.segment[into], parts.t1[into]),
        tangent_at(paths, parts.segment[out], parts.t0[out]),
    )
    rough = np.angle(tangents[1][None] / tangents[0][:, None])
    fine = np.angle(ahead[None] / np.where(back == 0, 1, back)[:, None])
    turn = np.where(np.abs(np.abs(rough) - np.pi) < 1e-6, np.copysign(np.abs(rough), fine), rough)
    turn = turn + 1e-3 * (fine - rough) * (np.abs(fine - rough) < 1)
    pairs: dict[int, int] = {}
    for k in np.argsort(-turn, axis=None):
        a, b = divmod(int(k), len(goes))
        if comes[a] not in pairs and goes[b] not in pairs.values():
            pairs[comes[a]] = goes[b]
    return pairs


def built(parts: Arrangement, paths: Paths, rings: list[Ints], tolerance: float) -> tuple[Paths, Ints, Ints]:
    """Rings of parts as closed paths, and of each of their segments, intp (n,), the first and the last part.

    Parts that go on along one segment are one again.
    """
    if not rings:
        return Paths.empty(), np.zeros(0, np.intp), np.zeros(0, np.intp)
    firsts, lasts, counts = [], [], []
    for parts_of in rings:
        before = np.roll(parts_of, 1)
        other = parts.segment[parts_of] != parts.segment[before]
        breaks = np.flatnonzero(other | (parts.t0[parts_of] < parts.t1[before]))
        ring = np.roll(parts_of, -breaks[0]) if len(breaks) else parts_of
        starts = breaks - breaks[0] if len(breaks) else np.zeros(1, np.intp)
        firsts.append(ring[starts])
        lasts.append(ring[np.append(starts[1:], len(ring)) - 1])
        counts.append(len(starts))
    first, last = np.concatenate(firsts), np.concatenate(lasts)
    segments = split(
        paths,
        parts.segment[first],
        parts.t0[first],
        parts.t1[last],
        parts.nodes[parts.tail[first]],
        parts.nodes[parts.head[last]],
    )
    whole = Paths(
        start=segments.start,
        end=segments.end,
        control=segments.control,
        kind=segments.kind,
        offsets=np.append(0, np.cumsum(counts)).astype(np.intp),
        closed=np.ones(len(rings), np.bool_),
    )
    return straightened(whole, tolerance), first, last

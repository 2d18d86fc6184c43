"""What an offset loses: rings that vanish, necks that break, gaps that close, parts too thin to stay."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.paths.arrangement import Arrangement
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.raw_offset import RawOffset
from voronoi_tiles.paths.segments import point_at, tangent_at

Loss = Literal["ring", "neck", "gap", "part"]
"""A ring of which nothing is left: a piece, or a hole; a neck that broke when the region shrank; a gap that closed when
it grew; a part of a ring, dead end or bay, that is gone."""

_PART_REACH: Final = 4.0
"""How far from what is left an edge lay that is reported as a lost part; in distances. Corners down to 29 degrees
recede less."""

_BULB_REACH: Final = 1.5
"""The same where the edge winds as no corner's does: a bulb behind a neck, a bay behind a mouth."""

_WINDING: Final = 0.5
"""How far an edge turns against the sense of a corner if it winds; radians. Fitted curves waver by less."""

_SAMPLES: Final = 16
"""Points on each segment, where the place of a loss is sought."""


@dataclass(frozen=True)
class Lost:
    """Something that an offset lost: what it was, and where, in the region's units.

    `place` is the middle of a neck or gap where it is narrowest, the middle of the largest circle in a ring, and the
    point of a part that is farthest from what is left.
    """

    kind: Loss
    place: complex


def losses(region: Paths, distance: float, raw: RawOffset, parts: Arrangement, rings: list[Ints]) -> tuple[Lost, ...]:
    """What the offset of a region by `distance` lost, from its raw offset, the parts of this and the rings of parts."""
    ring_of = np.full(len(parts.segment), -1)
    for number, ring in enumerate(rings):
        ring_of[ring] = number
    origin = region.owner[raw.source[parts.segment]]
    gone = np.setdiff1d(np.arange(len(region)), origin[ring_of >= 0])
    lost = [Lost("ring", _inmost(region, int(ring))) for ring in gone]
    chains = _Chains.of(region, distance, raw, parts, ring_of)
    for members in chains.groups():
        found = chains.judge(members, region, distance, parts)
        if found is not None:
            lost.append(found)
    return tuple(lost)


@dataclass(frozen=True, eq=False)
class _Chains:
    """Runs of the region's edge whose offset is gone, c of them, between two parts that are left.

    Each runs from the share `begin` (c) of the first of its `segments` to the share `stop` of the last, round the ring
    `origin` of the region. `nodes` (intp, c x 2) are what is left at both ends, `rings` the result's rings there.
    """

    segments: list[Ints]
    begin: Floats
    stop: Floats
    origin: Ints
    nodes: Ints
    rings: Ints

    @classmethod
    def of(cls, region: Paths, distance: float, raw: RawOffset, parts: Arrangement, ring_of: Ints) -> _Chains:
        """The runs that may mean a loss: not those of one node that are too short to reach far from it."""
        source, joins = raw.source[parts.segment], raw.joins[parts.segment]
        order = np.lexsort((parts.t0, parts.segment, source + 0.5 * joins))
        rank = np.empty(len(order), np.intp)
        rank[order] = np.arange(len(order))
        left = order[ring_of[order] >= 0]
        owner = region.owner[source]
        # The next that is left, round the ring; the parts of a ring stand together.
        after, last = np.roll(left, -1), np.flatnonzero(owner[left] != owner[np.roll(left, -1)])
        if len(last):
            after[last] = left[np.append(0, last[:-1] + 1)]
        total = np.bincount(owner, minlength=len(region))[owner[left]]
        steps = (rank[after] - rank[left]) % total
        gone = (steps != 1 % total) | (parts.head[left] != parts.tail[after])
        left, after = left[gone], after[gone]
        begin, stop = np.where(joins[left], 1.0, parts.t1[left]), np.where(joins[after], 1.0, parts.t0[after])
        first, final = source[left], source[after]
        lengths = region.lengths
        upto = np.append(0.0, np.cumsum(lengths))
        run = upto[final] + stop * lengths[final] - upto[first] - begin * lengths[first]
        ring = region.offsets[owner[left]], region.offsets[owner[left] + 1]
        run = np.where(run < 0, run + upto[ring[1]] - upto[ring[0]], run)
        nodes = np.stack((parts.head[left], parts.tail[after]), axis=1)
        far = np.flatnonzero((run > abs(distance)) | (nodes[:, 0] != nodes[:, 1]))
        return cls(
            segments=[_between(region, *pair) for pair in zip(first[far].tolist(), final[far].tolist(), strict=True)],
            begin=begin[far],
            stop=stop[far],
            origin=owner[left[far]],
            nodes=nodes[far],
            rings=np.stack((ring_of[left[far]], ring_of[after[far]]), axis=1),
        )

    def groups(self) -> list[Ints]:
        """The chains that hang together by their nodes."""
        group: dict[int, int] = {}

        def root(node: int) -> int:
            while group.setdefault(node, node) != node:
                node = group[node]
            return node

        for a, b in self.nodes.tolist():
            group[root(a)] = root(b)
        members: dict[int, list[int]] = {}
        for k, (a, _) in enumerate(self.nodes.tolist()):
            members.setdefault(root(a), []).append(k)
        return [np.array(chains, np.intp) for chains in members.values()]

    def judge(self, members: Ints, region: Paths, distance: float, parts: Arrangement) -> Lost | None:
        """What the loss of some chains means."""
        sides = [self.samples(region, int(k)) for k in members]
        apart = len(np.unique(self.rings[members])) > 1 or len(np.unique(self.origin[members])) > 1
        if apart and len(members) > 1:
            return Lost("gap" if distance > 0 else "neck", _narrowest(sides))
        points = np.concatenate(sides)
        away = np.abs(points[:, None] - parts.nodes[self.nodes[members].ravel()]).min(axis=1)
        tip = int(np.argmax(away))
        winds = sum(_winding(region, self.segments[k], distance) for k in members) > _WINDING
        reach = _BULB_REACH if winds else _PART_REACH
        return Lost("part", complex(points[tip])) if away[tip] > reach * abs(distance) else None

    def samples(self, region: Paths, chain: int) -> Complexes:
        """Points on a chain, in its order."""
        segments = self.segments[chain]
        low, high = np.zeros(len(segments)), np.ones(len(segments))
        low[0], high[-1] = self.begin[chain], self.stop[chain]
        t = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _SAMPLES + 1)
        return point_at(region, np.repeat(segments, _SAMPLES + 1), np.clip(t, 0.0, 1.0).ravel())


def _between(region: Paths, first: int, last: int) -> Ints:
    """The segments of a ring from one to another, both included."""
    ring = int(region.owner[first])
    begin, count = int(region.offsets[ring]), int(region.counts[ring])
    steps = (last - first) % count + 1
    return np.asarray(begin + (first - begin + np.arange(steps)) % count, np.intp)


def _winding(region: Paths, segments: Ints, distance: float) -> float:
    """How far the edge turns, between the first and last of some segments in a row, to where offsets open."""
    ends = [tangent_at(region, segments, np.full(len(segments), t)) for t in (0.0, 1.0)]
    corners = np.angle(ends[0][1:] * ends[1][:-1].conj())
    arcs = 4 * np.arctan(region.bulges()[segments[1:-1]])
    return float(np.maximum(np.concatenate((corners, arcs)) * np.sign(distance), 0.0).sum())


def _narrowest(sides: list[Complexes]) -> complex:
    """The middle of the shortest way from one row of points to another."""
    import shapely

    lines = [shapely.LineString(np.stack((side.real, side.imag), axis=1)) for side in sides]
    ways = [shapely.shortest_line(a, b) for k, a in enumerate(lines) for b in lines[k + 1 :]]
    best = min(ways, key=shapely.length)
    return complex(*np.asarray(best.coords).mean(axis=0))


def _inmost(region: Paths, ring: int) -> complex:
    """The middle of the largest circle inside a ring, to a thousandth of its size."""
    import shapely

    segments = np.arange(region.offsets[ring], region.offsets[ring + 1])
    t = np.tile(np.linspace(0.0, 1.0, _SAMPLES + 1), len(segments))
    points = point_at(region, np.repeat(segments, _SAMPLES + 1), t)
    shape = shapely.make_valid(shapely.Polygon(np.stack((points.real, points.imag), axis=1)))
    size = max(np.ptp(points.real), np.ptp(points.imag))
    circle = shapely.maximum_inscribed_circle(shape, tolerance=1e-3 * size)
    return complex(*circle.coords[0])

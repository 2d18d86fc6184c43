"""The lines of a sheet as strands between nodes, each once: edges of tiles, whole or in part, and the border."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, next_in_ring
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.tile_placement import TilePlacement
from voronoi_tiles.paths.intersections import candidate_pairs, crossings
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import item_boxes, point_at, split
from voronoi_tiles.vector.complex.period import Period

OUTSIDE = -1
"""What lies beside a strand where no tile of the sheet does."""


@dataclass(frozen=True, eq=False)
class Strands:
    """Strands, each once: strand k runs from `node[first[k]]` to `node[last[k]]` along path k of `paths`.

    `left` and `right` (intp) are the tiles beside it, as indices of a placement, or OUTSIDE. `border` tells which are
    parts of the region's border, which runs with the region on its left; what tile lies there is not told. The nodes of
    the border are the first `on_border` ones.
    """

    paths: Paths
    first: Ints
    last: Ints
    node: Complexes
    left: Ints
    right: Ints
    border: Bools
    on_border: int


@dataclass(frozen=True, eq=False)
class _SheetEdges:
    """The edges around the tiles of a placement, each once: the curves of strands, not yet made."""

    edge: Ints
    step: Ints
    left: Ints
    right: Ints
    first: Ints
    last: Ints
    node: Complexes

    def boxes(self, period: Period) -> Floats:
        """The boxes of all (n x 4), as `pieces.boxes` gives them."""
        shift = period.shifts(self.step)
        box = item_boxes(period.edges, np.arange(len(period.edges) + 1))[self.edge]
        return box + np.column_stack((shift.real, shift.imag, shift.real, shift.imag))

    def strands(self, period: Period, chosen: Ints) -> Strands:
        """Some of them as strands."""
        return Strands(
            paths=period.curves(self.edge[chosen], self.step[chosen]),
            first=self.first[chosen],
            last=self.last[chosen],
            node=self.node,
            left=self.left[chosen],
            right=self.right[chosen],
            border=np.zeros(len(chosen), np.bool_),
            on_border=0,
        )


def whole_strands(period: Period, placement: TilePlacement) -> Strands:
    """The edges around all tiles of a placement."""
    edges = _sheet_edges(period, placement)
    return edges.strands(period, np.arange(len(edges.edge)))


def clipped_strands(period: Period, placement: TilePlacement, region: Region) -> Strands:
    """The edges around the tiles of a placement as far as they lie in the region, and the region's border.

    What runs along the border within `region.close` is left to the border.
    """
    edges = _sheet_edges(period, placement)
    near = region.meets_border(edges.boxes(period), 2 * region.close)
    # Beside a whole tile all is inside; OUTSIDE is the last place.
    whole = np.append(placement.whole, False)
    inside = whole[edges.left] | whole[edges.right]
    unclear = np.flatnonzero(~near & ~inside)
    inside[unclear] = region.contains(edges.node[edges.first[unclear]])
    kept = edges.strands(period, np.flatnonzero(~near & inside))
    return _bordered(region, kept, edges.strands(period, np.flatnonzero(near)))


def outer_strands(strands: Strands, region: Region) -> Strands:
    """The boundary of what is left of a region around tiles that lie in it, from the edges around these.

    It is the region's border, and the edges that have no tile beyond, as far as they are not part of the border.
    """
    lone = np.flatnonzero((strands.left == OUTSIDE) | (strands.right == OUTSIDE))
    return _bordered(region, _taken(strands, lone[:0]), _taken(strands, lone))


def _taken(strands: Strands, chosen: Ints) -> Strands:
    """Some of the strands, between the same nodes."""
    return replace(
        strands,
        paths=strands.paths.take(chosen),
        first=strands.first[chosen],
        last=strands.last[chosen],
        left=strands.left[chosen],
        right=strands.right[chosen],
        border=strands.border[chosen],
    )


def _bordered(region: Region, kept: Strands, near: Strands) -> Strands:
    """The border of a region, strands inside it, and of strands near to it, between the same nodes, what is inside."""
    runs = inner_runs(near.paths, region)
    nodes, at_start, at_end = _border_nodes(region, runs)
    portions, portion_first, portion_last, extra = _portions(region, nodes)
    on_border = len(nodes.place) + len(extra)
    run_first = np.where(at_start >= 0, at_start, near.first[runs.path] + on_border)
    run_last = np.where(at_end >= 0, at_end, near.last[runs.path] + on_border)
    outside = np.full(len(portions), OUTSIDE)
    count = len(portions) + len(kept.paths) + len(runs.paths)
    return Strands(
        paths=Paths.concatenate([portions, kept.paths, runs.paths]),
        first=np.concatenate((portion_first, kept.first + on_border, run_first)),
        last=np.concatenate((portion_last, kept.last + on_border, run_last)),
        node=np.concatenate((nodes.place, extra, near.node)),
        left=np.concatenate((outside, kept.left, near.left[runs.path])),
        right=np.concatenate((outside, kept.right, near.right[runs.path])),
        border=np.arange(count) < len(portions),
        on_border=on_border,
    )


def _sheet_edges(period: Period, placement: TilePlacement) -> _SheetEdges:
    """The edges around tiles, each once, with the tiles beside it and the vertices at its ends."""
    tile, edge, step, forward = period.borders(placement.tile, placement.step)
    _, one, which = np.unique(_packed(edge, step), return_index=True, return_inverse=True)
    beside = np.full((2, len(one)), OUTSIDE)
    beside[np.where(forward, 0, 1), which.reshape(-1)] = tile
    edge, step = edge[one], step[one]
    vertex = np.concatenate((period.start[edge], period.end[edge]))
    place = np.concatenate((step, step + period.reach[edge]))
    _, one, which = np.unique(_packed(vertex, place), return_index=True, return_inverse=True)
    first, last = np.split(np.asarray(which.reshape(-1), np.intp), 2)
    return _SheetEdges(edge, step, beside[0], beside[1], first, last, period.at(period.vertex[vertex[one]], place[one]))


def _packed(number: Ints, step: Ints) -> Ints:
    """Pack a number and a lattice vector into one number."""
    low = step.min(axis=0, initial=0)
    i, j = (step - low).T
    m, n = (step.max(axis=0, initial=0) - low + 1).tolist()
    return np.asarray((number * m + i) * n + j, np.intp)


@dataclass(frozen=True, eq=False)
class InnerRuns:
    """Parts of paths inside a region: `path` is the path that each is part of; whether its ends lie on the border."""

    paths: Paths
    path: Ints
    starts_on_border: Bools
    ends_on_border: Bools


def inner_runs(paths: Paths, region: Region) -> InnerRuns:
    """Cut paths where they meet the border, and keep what lies inside."""
    count = len(paths.start)
    i, j = candidate_pairs(paths, region.border, region.close)
    met = crossings(paths, i, region.border, j)
    piece, t, point = i[met.pair], met.t, met.point
    # A crossing at the end of a piece is that end.
    apart = np.minimum(np.abs(point - paths.start[piece]), np.abs(point - paths.end[piece])) > region.close
    piece, t, point = piece[apart], t[apart], point[apart]
    everything = np.arange(count)
    piece = np.concatenate((everything, piece, everything))
    t = np.concatenate((np.zeros(count), t, np.ones(count)))
    point = np.concatenate((paths.start, point, paths.end))
    order = np.lexsort((t, piece))
    piece, t, point = piece[order], t[order], point[order]
    # Of crossings in one place the first stands for all.
    new = np.append(True, (piece[1:] != piece[:-1]) | (np.abs(np.diff(point)) > region.close) | (t[1:] == 1.0))
    new = new[: len(piece)]
    piece, t, point = piece[new], t[new], point[new]
    part = np.flatnonzero(piece[1:] == piece[:-1])
    of, t0, t1 = piece[part], t[part], t[part + 1]
    middle = point_at(paths, of, (t0 + t1) / 2)
    inside = (region.distance(middle) > region.close) & region.contains(middle)
    kept = np.flatnonzero(inside)
    of, t0, t1 = of[kept], t0[kept], t1[kept]
    start, end = point[part[kept]], point[part[kept] + 1]
    parts = split(paths, of, t0, t1, start, end)
    on_start, on_end = region.distance(start) <= region.close, region.distance(end) <= region.close
    owner = paths.owner[of]
    # A run goes on while one part begins where the last one ended, inside.
    opens = np.append(True, (owner[1:] != owner[:-1]) | on_start[1:] | (np.diff(kept) != 1))[: len(kept)]
    first = np.flatnonzero(opens)
    last = np.append(first[1:], len(kept)) - 1 if len(first) else first
    runs = replace(parts, offsets=np.append(first, len(kept)).astype(np.intp), closed=np.zeros(len(first), np.bool_))
    return InnerRuns(runs, owner[first], on_start[first], on_end[last])


@dataclass(frozen=True, eq=False)
class _Nodes:
    """Places on a border in its order: piece, share of its length, point."""

    piece: Ints
    share: Floats
    place: Complexes


def _border_nodes(region: Region, runs: InnerRuns) -> tuple[_Nodes, Ints, Ints]:
    """Put the ends of runs onto the border: the nodes there, and which one each start and end is, -1 for none."""
    paths = runs.paths
    first, last = paths.offsets[:-1], paths.offsets[1:] - 1
    at_start, at_end = np.flatnonzero(runs.starts_on_border), np.flatnonzero(runs.ends_on_border)
    ends = np.concatenate((paths.start[first[at_start]], paths.end[last[at_end]]))
    piece, share, place = region.on_border(ends)
    following = next_in_ring(region.border.offsets)
    at_corner = np.abs(place - region.border.end[piece]) <= region.close
    piece, share = np.where(at_corner, following[piece], piece), np.where(at_corner, 0.0, share)
    at_corner = np.abs(place - region.border.start[piece]) <= region.close
    share = np.where(at_corner, 0.0, share)
    place = np.where(at_corner, region.border.start[piece], place)
    order = np.lexsort((share, piece))
    fresh = np.append(True, (np.diff(piece[order]) != 0) | (np.abs(np.diff(place[order])) > 2 * region.close))[
        : len(order)
    ]
    number = np.empty(len(order), np.intp)
    number[order] = np.cumsum(fresh) - 1
    chosen = order[fresh]
    nodes = _Nodes(piece[chosen], share[chosen], place[chosen])
    starts, stops = np.full(len(paths), -1), np.full(len(paths), -1)
    starts[at_start], stops[at_end] = number[: len(at_start)], number[len(at_start) :]
    # The ends of the runs are the nodes, to the bit.
    paths.start[first[at_start]] = nodes.place[starts[at_start]]
    paths.end[last[at_end]] = nodes.place[stops[at_end]]
    return nodes, starts, stops


def _portions(region: Region, nodes: _Nodes) -> tuple[Paths, Ints, Ints, Complexes]:
    """The border between its nodes; and the places where rings begin that have no node, which are nodes as well."""
    border = region.border
    pieces: list[tuple[int, float, float, complex, complex]] = []
    offsets, first, last = [0], [], []
    extra: list[complex] = []
    place = nodes.place.tolist()
    for begin, stop in zip(border.offsets[:-1].tolist(), border.offsets[1:].tolist(), strict=True):
        here = np.flatnonzero((nodes.piece >= begin) & (nodes.piece < stop)).tolist()
        if not here:
            pieces += [(k, 0.0, 1.0, complex(border.start[k]), complex(border.end[k])) for k in range(begin, stop)]
            first.append(len(place) + len(extra))
            last.append(first[-1])
            offsets.append(len(pieces))
            extra.append(complex(border.start[begin]))
        for one, two in zip(here, [*here[1:], *here[:1]], strict=True):
            k, share, point = int(nodes.piece[one]), float(nodes.share[one]), place[one]
            goal, goal_share = int(nodes.piece[two]), float(nodes.share[two])
            while k != goal or share >= goal_share:
                pieces.append((k, share, 1.0, point, complex(border.end[k])))
                k = k + 1 if k + 1 < stop else begin
                share, point = 0.0, complex(border.start[k])
                if k == goal:
                    break
            if goal_share > share:
                pieces.append((k, share, goal_share, point, place[two]))
            first.append(one)
            last.append(two)
            offsets.append(len(pieces))
    table = list(zip(*pieces, strict=True))
    parts = split(
        border,
        np.array(table[0], np.intp),
        np.array(table[1]),
        np.array(table[2]),
        np.array(table[3], np.complex128),
        np.array(table[4], np.complex128),
    )
    count = len(first)
    paths = replace(parts, offsets=np.array(offsets, np.intp), closed=np.zeros(count, np.bool_))
    return paths, np.array(first, np.intp), np.array(last, np.intp), np.array(extra, np.complex128)

"""Levels: the heights at which walls have vertices, each with the chains of vertices that its edges are drawn as."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, counts_of, offsets_of, ranges
from voronoi_tiles.paths.conversion import chord_counts
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.solid.corner_vertices import CornerVertex, corner_vertices, edge_ends, inverse, product
from voronoi_tiles.solid.correspondence import Correspondence
from voronoi_tiles.solid.events import LoftError
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.vertices import VertexTable
from voronoi_tiles.vector.complex.quotient import Stabilizer
from voronoi_tiles.vector.complex.representatives import Points
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, code_of

_KINK: Final = 0.05
"""How far a bisector must turn in a vertex for a wall to have a vertex there; radians."""


_LONGEST: Final = 1 / 8
"""How long a step is at most, relative to the cell's size."""

_SEEN: Final = np.linspace(0.0, 1.0, 9)
"""At these parameters of arcs it is seen how far they are from chords."""


@dataclass(frozen=True, eq=False)
class VertexChains:
    """The vertices along each edge of a layer: those of edge k are from `offsets[k]` up to, not incl., the next.

    An edge that is a point has one, all others at least two.
    """

    points: Points
    offsets: Ints

    @property
    def counts(self) -> Ints:
        """How many vertices each edge has."""
        return counts_of(self.offsets)


def weighed(layer: ExactLayer, accuracy: float) -> Floats:
    """The steps that each arc of a layer's edges takes for chords to keep within an accuracy: no whole numbers."""
    paths = layer.quotient.paths()
    return chord_counts(paths, accuracy) + paths.lengths / (_LONGEST * layer.action.size)


def sampled(table: VertexTable, layer: ExactLayer, short: Bools, steps: Ints, weight: Floats) -> VertexChains:
    """The chains of a layer: edge k in `steps[k]` steps, by equal shares of its arcs' weights; if `short` as a point.

    All vertices are on the exact arcs, but for those in which short edges end. Where bisectors turn, there is a vertex.
    """
    quotient, count = layer.quotient, len(layer.quotient.offsets) - 1
    corners, ends = corner_vertices(table, layer, short), edge_ends(layer)
    turned = np.zeros(count, np.bool_)
    turned[[k for k, pairs in quotient.symmetric.items() if any(back for _, back in pairs)]] = True
    inner = np.where(short, 0, np.where(turned, steps // 2, steps - 1))
    positions = _along(quotient.paths(), weight, inner, steps)
    numbers = table.add(positions, layer.z)
    bounds = offsets_of(inner).tolist()
    parts = []
    for k, ((i, a), (j, b)) in enumerate(ends):
        start, end = corners[i].seen(a), corners[j].seen(b)
        own = slice(bounds[k], bounds[k + 1])
        within = Points(numbers[own], np.full(inner[k], IDENTITY_CODE))
        if k in quotient.symmetric:
            within = _symmetric(table, positions[own], within, layer.z, quotient.symmetric[k])
        parts.append(start if short[k] else Points.joined([start, within, end]))
    return VertexChains(Points.joined(parts), offsets_of([len(part) for part in parts]))


def _symmetric(table: VertexTable, positions: Complexes, within: Points, z: float, stabilizer: Stabilizer) -> Points:
    """The vertices within an edge that motions map onto itself, put where these leave them.

    On a mirror that is all along it. Of an edge that is turned round they are those up to the middle: the others are
    their images.
    """
    still, back = ([code_of(motion) for motion, turns in stabilizer if turns is turned] for turned in (False, True))
    if not len(within):
        return within
    if len(still) > 1:
        within = Points(np.array([table.add_fixed(at, z, still) for at in positions.tolist()]), within.motion)
    if not back:
        return within
    middle = table.add_fixed(complex(positions[-1]), z, still + back)
    half = within.take(slice(0, -1))
    image = half.moved(np.full(len(half), back[0])).take(slice(None, None, -1))
    return Points.joined([half, Points(np.array([middle]), np.array([IDENTITY_CODE])), image])


def _along(paths: Paths, lengths: Floats, inner: Ints, steps: Ints) -> Complexes:
    """The first `inner[k]` points within path k when it is cut into `steps[k]` parts, whose arcs have these lengths."""
    return _on_arcs(paths, lengths, _cuts(paths, lengths, inner, steps), np.repeat(np.arange(len(inner)), inner))


def _cuts(paths: Paths, lengths: Floats, inner: Ints, steps: Ints) -> Floats:
    """Where these points are along all paths: in equal steps, but at an angle of arcs the nearest is put there."""
    ends = np.cumsum(lengths)
    path_begin, path_end = (ends - lengths)[paths.offsets[:-1]], ends[paths.offsets[1:] - 1]
    owner = np.repeat(np.arange(len(inner)), inner)
    number = ranges(np.ones(len(inner), np.intp), inner)
    share = number / np.maximum(steps, 1)[owner]
    at = path_begin[owner] * (1.0 - share) + path_end[owner] * share
    kink, where = _kinks(paths, ends)
    if len(kink):
        nearest = np.rint((where - path_begin[kink]) / (path_end - path_begin)[kink] * steps[kink]).astype(np.intp)
        # What a motion leaves in the middle stays there.
        last = np.where(2 * inner == steps, inner - 1, inner)
        fits = (nearest >= 1) & (nearest <= last[kink])
        place = (np.cumsum(inner) - inner)[kink] + nearest - 1
        at[place[fits]] = where[fits]
    return at


def _on_arcs(paths: Paths, lengths: Floats, at: Floats, owner: Ints) -> Complexes:
    """The points of paths, to the last bits, at places along all of them; each lies on path `owner`.

    Arcs are cut into equal parts of their parameter.
    """
    ends = np.cumsum(lengths)
    arc = np.minimum(np.searchsorted(ends, at, side="left"), paths.offsets[1:][owner] - 1)
    arc = np.maximum(arc, paths.offsets[:-1][owner])
    t = np.clip((at - (ends - lengths)[arc]) / np.where(lengths[arc] > 0.0, lengths[arc], 1.0), 0.0, 1.0)
    s = 1.0 - t
    start, end, bent = paths.start[arc], paths.end[arc], paths.kind[arc] > 0
    line = start * s + end * t
    curve = (start * (s * s) + end * (t * t)) + paths.control[arc, 0] * (2.0 * (s * t))
    return np.where(bent, curve, line)


def along_edges(layer: ExactLayer, shares: Floats) -> Complexes:
    """Points of all edges of a layer at these shares of their lengths, complex128 (edges, shares)."""
    paths = layer.quotient.paths()
    ends = np.cumsum(paths.lengths)
    begin, end = (ends - paths.lengths)[paths.offsets[:-1]], ends[paths.offsets[1:] - 1]
    at = begin[:, None] * (1.0 - shares) + end[:, None] * shares
    return _on_arcs(paths, paths.lengths, at.ravel(), np.repeat(np.arange(len(begin)), len(shares))).reshape(at.shape)


def sagging(layer: ExactLayer, steps: Ints, weight: Floats) -> Floats:
    """How far the edges of a layer are from the chords of their vertices, as `sampled` has them; float64 (edges,)."""
    paths = layer.quotient.paths()
    edges, inner = np.arange(len(steps)), steps - 1
    ends = np.cumsum(weight)
    bounds = np.stack(((ends - weight)[paths.offsets[:-1]], ends[paths.offsets[1:] - 1]), axis=1)
    owner = np.concatenate((edges, np.repeat(edges, inner), edges))
    cuts = np.concatenate((bounds[:, 0], _cuts(paths, weight, inner, steps), bounds[:, 1]))
    order = np.lexsort((cuts, owner))
    cuts, owner = cuts[order], owner[order]
    corners = _on_arcs(paths, weight, cuts, owner)
    seen = (ends - weight)[:, None] + weight[:, None] * _SEEN
    edge = np.repeat(paths.owner, len(_SEEN))
    points = _on_arcs(paths, weight, seen.ravel(), edge)
    first = offsets_of(steps + 1)
    after = np.clip(np.searchsorted(cuts, seen.ravel(), side="left"), first[edge] + 1, first[edge + 1] - 1)
    start, along = corners[after - 1], corners[after] - corners[after - 1]
    square = np.maximum(along.real * along.real + along.imag * along.imag, 1e-300)
    away = points - start
    share = np.clip((away.real * along.real + away.imag * along.imag) / square, 0.0, 1.0)
    found = np.zeros(len(steps))
    np.maximum.at(found, edge, np.abs(away - share * along))
    return found


def _kinks(paths: Paths, ends: Floats) -> tuple[Ints, Floats]:
    """The paths that turn by an angle between two arcs, and where along all paths."""
    bent = paths.kind > 0
    out = np.where(bent, paths.end - paths.control[:, 0], paths.end - paths.start)
    into = np.where(bent, paths.control[:, 0] - paths.start, paths.end - paths.start)
    joint = np.flatnonzero(paths.owner[1:] == paths.owner[:-1])
    before, after = out[joint], into[joint + 1]
    turn = np.abs(np.angle(after * before.conj()))
    turned = joint[(turn > _KINK) & (before != 0) & (after != 0)]
    return paths.owner[turned], ends[turned]


def carried(
    layer: ExactLayer, short: Bools, core: ExactLayer, chains: VertexChains, same: Correspondence
) -> VertexChains:
    """The chains of another layer at the level of a `core`, whose uses `same.low` are uses `same.high` of the layer.

    Edges of the layer that are `short`, and correspond to none, are points there. Raises LoftError where corners do
    not fit.
    """
    ends = edge_ends(layer)
    place: dict[int, CornerVertex] = {}
    parts: dict[int, Points] = {}
    for low, high in zip(same.low.tolist(), same.high.tolist(), strict=True):
        k, edge = int(layer.edge[high]), int(core.edge[low])
        if k in parts:
            continue
        by = product(inverse(int(layer.motion[high])), int(core.motion[low]))
        own = chains.points.take(slice(*chains.offsets[edge : edge + 2].tolist()))
        own = own.moved(np.full(len(own), by))
        parts[k] = own.take(slice(None, None, -1)) if layer.backwards[high] != core.backwards[low] else own
        for (i, code), at in zip(ends[k], (0, -1), strict=True):
            vertex = CornerVertex(int(parts[k].index[at]), int(parts[k].motion[at]))
            place.setdefault(i, vertex.from_(code))
    waiting = [k for k in range(len(ends)) if k not in parts]
    if not short[waiting].all():
        raise LoftError("an edge vanishes at once", core.z)
    while waiting:
        left = []
        for k in waiting:
            known = next(((i, code) for i, code in ends[k] if i in place), None)
            if known is None:
                left.append(k)
                continue
            parts[k] = place[known[0]].seen(known[1])
            vertex = CornerVertex(int(parts[k].index[0]), int(parts[k].motion[0]))
            for i, code in ends[k]:
                place.setdefault(i, vertex.from_(code))
        if len(left) == len(waiting):
            raise LoftError("an edge appears in the middle of nothing", core.z)
        waiting = left
    ordered = [parts[k] for k in range(len(ends))]
    return VertexChains(Points.joined(ordered), offsets_of([len(part) for part in ordered]))

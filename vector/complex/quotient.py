"""The quotient complex of a tessellation: what is left of its vertices, edges and tiles when symmetric ones are one.

Each edge is computed once, for one tile, and mapped to all its places by exact motions. From whichever tile it is
reached, the same representative is moved by the same motion, and comes out as the same bits; so tiles share their edges
exactly. Outlines, sheets, colourings, and what approximates edges, all read this complex.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints
from voronoi_tiles.paths.paths import LINE, QUAD, Paths
from voronoi_tiles.vector.complex.corners import find_corners
from voronoi_tiles.vector.complex.edge_points import represent
from voronoi_tiles.vector.complex.edges import Edges
from voronoi_tiles.vector.complex.representatives import Builder, Points, Representatives
from voronoi_tiles.vector.motion_codes import Codes, motion_of
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion

_NONE = ((IDENTITY, False),)

Stabilizer = tuple[tuple[Motion, bool], ...]
"""The motions that map an edge onto itself, the identity first, each with whether it comes out running backwards."""


@dataclass(frozen=True, eq=False, slots=True)
class QuotientEdge:
    """The edge that stands for an orbit of edges: k arcs between two tiles.

    `vertex` are its ends and the points between its arcs, k + 1 of them. `control` are the control points of the arcs
    as quadratic Bezier curves, none for a line.
    """

    vertex: Points
    control: Points
    stabilizer: Stabilizer

    def __len__(self) -> int:
        """The number of arcs."""
        return len(self.control)

    @property
    def reversal(self) -> Motion | None:
        """The motion that maps the edge onto itself backwards, None where there is none."""
        return _reversal(self.stabilizer)


class EdgeUse(NamedTuple):
    """An edge as part of the boundary of a base tile: the image under `motion` of the edge that stands for its orbit.

    `edge` is the number of that one; `backwards` says whether the boundary runs against the image, and `beyond` are the
    site and the motion of the copy on the other side.
    """

    edge: int
    motion: Motion
    backwards: bool
    beyond: tuple[int, Motion]


@dataclass(frozen=True, eq=False, slots=True)
class EdgeUses:
    """The boundaries of all base tiles, ring after ring and tile after tile: m edges, as in `EdgeUse`.

    `edge` (intp), `motion` (int64), `backwards` (bool), and of the copies beyond `site` (intp) and `beyond` (int64).
    The edges of ring r are those from `ring_offsets[r]` up to, not including, `ring_offsets[r + 1]`, the rings of tile
    t those from `tile_offsets[t]` up to `tile_offsets[t + 1]`.
    """

    edge: Ints
    motion: Codes
    backwards: Bools
    site: Ints
    beyond: Codes
    ring_offsets: Ints
    tile_offsets: Ints


@dataclass(frozen=True, eq=False)
class Quotient:
    """The quotient complex: one edge of each orbit, and the boundary of the base tile of each site.

    All points of edges are images of `representatives`. Edge k are the arcs from `offsets[k]` up to, not including,
    `offsets[k + 1]`: `control` are their control points as quadratic Bezier curves, none for a line; `focus`
    (complex128, n) and `directrix` (complex128, n x 2) are those of the parabolas before the motions that take the
    control points to their places. The ends of its arcs are the points of `vertex` from `offsets[k] + k` up to and
    including `offsets[k + 1] + k`. `symmetric` has the stabilizers of those edges that have others than the identity.
    Of the rings of a tile in `uses` the outer ones run counter-clockwise and come first, holes run clockwise.
    """

    representatives: Representatives
    vertex: Points
    control: Points
    focus: Complexes
    directrix: Complexes
    offsets: Ints
    symmetric: dict[int, Stabilizer]
    uses: EdgeUses

    @cached_property
    def edges(self) -> tuple[QuotientEdge, ...]:
        """The edges, one by one."""
        bounds = self.offsets.tolist()
        return tuple(
            QuotientEdge(
                self.vertex.take(slice(first + k, last + k + 1)),
                self.control.take(slice(first, last)),
                self.symmetric.get(k, _NONE),
            )
            for k, (first, last) in enumerate(pairwise(bounds))
        )

    @cached_property
    def boundaries(self) -> tuple[tuple[tuple[EdgeUse, ...], ...], ...]:
        """For each tile its rings, with their edges one by one."""
        uses = self.uses
        rows = [
            EdgeUse(edge, motion_of(motion), backwards, (site, motion_of(beyond)))
            for edge, motion, backwards, site, beyond in zip(
                uses.edge.tolist(),
                uses.motion.tolist(),
                uses.backwards.tolist(),
                uses.site.tolist(),
                uses.beyond.tolist(),
                strict=True,
            )
        ]
        ring, tile = uses.ring_offsets.tolist(), uses.tile_offsets.tolist()
        rings = [tuple(rows[a:b]) for a, b in pairwise(ring)]
        return tuple(tuple(rings[a:b]) for a, b in pairwise(tile))

    def paths(self) -> Paths:
        """The edges as paths of lines and quadratic curves, in the places in which they stand for their orbits."""
        vertex = self.representatives.locate(self.vertex)
        start = np.arange(len(self.control)) + np.repeat(np.arange(len(self.offsets) - 1), np.diff(self.offsets))
        return Paths(
            start=vertex[start],
            end=vertex[start + 1],
            control=np.column_stack((self.representatives.locate(self.control), np.zeros(len(start)))),
            kind=np.where(self.control.index >= 0, QUAD, LINE).astype(np.uint8),
            offsets=self.offsets,
            closed=np.zeros(len(self.offsets) - 1, np.bool_),
        )


def _reversal(stabilizer: Stabilizer) -> Motion | None:
    """The first motion that maps an edge onto itself backwards, None where there is none."""
    return next((motion for motion, flips in stabilizer if flips), None)


def build_quotient(action: Action, tiles: int, edges: Edges) -> Quotient:
    """The quotient complex of a tessellation, of which all edges of its base tiles are given."""
    builder = Builder(action)
    corners = find_corners(builder, edges)
    kept, link = edges.orbits
    number = np.empty(len(edges), np.intp)
    number[kept] = np.arange(len(kept))
    symmetric = _stabilizers(edges, number, link)
    uses = EdgeUses(
        edge=number[edges.source[link]],
        motion=edges.by[link],
        backwards=edges.backwards[link],
        site=edges.site,
        beyond=edges.motion,
        ring_offsets=edges.ring_offsets,
        tile_offsets=edges.tile[edges.ring_offsets[:-1]].searchsorted(np.arange(tiles + 1)),
    )
    # An edge on a mirror is straight, and needs no other symmetry.
    reversals = {
        k: _reversal(stabilizer) if all(flips for _, flips in stabilizer[1:]) else None
        for k, stabilizer in symmetric.items()
    }
    vertex, control, arcs, offsets = represent(builder, edges, kept, corners, reversals)
    curved = control.index >= 0
    return Quotient(
        representatives=builder.snapshot(),
        vertex=vertex,
        control=control,
        focus=np.where(curved, edges.traced.focus[arcs], 0),
        directrix=np.where(curved[:, None], edges.traced.directrix[arcs], 0),
        offsets=offsets,
        symmetric=symmetric,
        uses=uses,
    )


def _stabilizers(edges: Edges, number: Ints, link: Ints) -> dict[int, Stabilizer]:
    """The stabilizers of those edges that stand for orbits and have others than the identity, by their `number`."""
    found: dict[int, Stabilizer] = {}
    at = edges.symmetries
    at = at[edges.source[link[edges.source[at]]] == edges.source[at]]
    rows = zip(edges.source[at].tolist(), edges.by[at].tolist(), edges.backwards[at].tolist(), strict=True)
    for edge, by, flips in rows:
        k = int(number[edge])
        found[k] = (*found.get(k, _NONE), (motion_of(by), flips))
    return found

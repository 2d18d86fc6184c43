"""The quotient complex of a tessellation: what is left of its vertices, edges and tiles when symmetric ones are one.

Each edge is computed once, for one tile, and mapped to all its places by exact motions. From whichever tile it is
reached, the same representative is moved by the same motion, and comes out as the same bits; so tiles share their edges
exactly. Outlines, sheets, colourings, and what approximates edges, all read this complex.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.paths.paths import LINE, QUAD, Paths
from voronoi_tiles.vector.arcs import parabola_controls
from voronoi_tiles.vector.complex.corners import Corners, find_corners
from voronoi_tiles.vector.complex.edges import PAIRING, Edge
from voronoi_tiles.vector.complex.representatives import Builder, Points, Representatives
from voronoi_tiles.vector.complex.traced import Traced
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion

# How near to a vertex the image of its counterpart must be, relative to the cell's size, where some have none.
_COUNTERPART = 1e-6


@dataclass(frozen=True, eq=False, slots=True)
class QuotientEdge:
    """The edge that stands for an orbit of edges: k arcs between two tiles.

    Attributes:
        vertex: (k + 1,) its ends and the points between its arcs.
        control: (k,) of the quadratic Bezier of each arc; the index is -1 for a line.
        focus, directrix: (k,) and (k, 2), of the representative arc, to be moved as the control point.
        stabilizer: the motions that map it onto itself, each with whether it comes out running backwards; the identity
            first.
    """

    vertex: Points
    control: Points
    focus: Complexes
    directrix: Complexes
    stabilizer: tuple[tuple[Motion, bool], ...]

    @property
    def reversal(self) -> Motion | None:
        """The motion that maps the edge onto itself backwards, None where there is none."""
        return next((motion for motion, flips in self.stabilizer if flips), None)


class EdgeUse(NamedTuple):
    """An edge as part of the boundary of a base tile.

    Attributes:
        edge: the one that stands for its orbit.
        motion: what takes that one here.
        backwards: whether the boundary runs against it.
        beyond: site and motion of the copy on the other side.
    """

    edge: int
    motion: Motion
    backwards: bool
    beyond: tuple[int, Motion]


@dataclass(frozen=True, eq=False, slots=True)
class Quotient:
    """The quotient complex.

    Attributes:
        representatives: the points that all points of edges are images of.
        edges: one of each orbit.
        boundaries: for the base tile of each site its rings, outer ones counter-clockwise and first, holes clockwise.
    """

    representatives: Representatives
    edges: tuple[QuotientEdge, ...]
    boundaries: tuple[tuple[tuple[EdgeUse, ...], ...], ...]

    def paths(self) -> Paths:
        """The edges as paths of lines and quadratic curves, in the places in which they stand for their orbits."""
        start, end, control = ([np.zeros(0, np.complex128)] for _ in range(3))
        for edge in self.edges:
            vertex = self.representatives.locate(edge.vertex)
            start.append(vertex[:-1])
            end.append(vertex[1:])
            control.append(self.controls(edge))
        curved = np.concatenate([edge.control.index >= 0 for edge in self.edges])
        counts = [len(edge.focus) for edge in self.edges]
        return Paths(
            start=np.concatenate(start),
            end=np.concatenate(end),
            control=np.column_stack((np.concatenate(control), np.zeros(len(curved)))),
            kind=np.where(curved, QUAD, LINE).astype(np.uint8),
            offsets=np.append(0, np.cumsum(counts)).astype(np.intp),
            closed=np.zeros(len(counts), np.bool_),
        )

    def controls(self, edge: QuotientEdge) -> Complexes:
        """The control points of an edge's arcs, 0 for lines."""
        result = np.zeros(len(edge.focus), np.complex128)
        curved = np.flatnonzero(edge.control.index >= 0)
        result[curved] = self.representatives.locate(edge.control.take(curved))
        return result


def build_quotient(action: Action, traced: list[Traced], edges: list[Edge]) -> Quotient:
    """The quotient complex of a tessellation.

    Args:
        traced: for each site its tile's boundary.
        edges: of these boundaries, paired, ring after ring.
    """
    builder = Builder(action)
    corners = find_corners(builder, traced, edges)
    positions = builder.snapshot()
    kept: list[QuotientEdge] = []
    source: dict[Edge, tuple[int, Motion, bool]] = {}
    for edge in edges:
        if edge not in source:
            for motion, image, flips in edge.images:
                source.setdefault(image, (len(kept), motion, flips))
            kept.append(_represent(builder, positions, traced[edge.tile], edge, corners))
    rings: list[dict[int, list[EdgeUse]]] = [{} for _ in traced]
    for edge in edges:
        ring = rings[edge.tile].setdefault(int(traced[edge.tile].ring[edge.arcs[0]]), [])
        ring.append(EdgeUse(*source[edge], edge.beyond))
    boundaries = tuple(tuple(map(tuple, boundary.values())) for boundary in rings)
    return Quotient(builder.snapshot(), tuple(kept), boundaries)


def _represent(
    builder: Builder, positions: Representatives, boundary: Traced, edge: Edge, corners: Corners
) -> QuotientEdge:
    """The edge that stands for its orbit, symmetric under the motions that map it onto itself."""
    action = builder.action
    stabilizer = tuple((motion, flips) for motion, image, flips in edge.images if image is edge)
    start, end = corners[edge.start], corners[edge.end]
    selfmaps = [(motion, flips) for motion, flips in stabilizer if motion != IDENTITY]
    none = np.zeros(0, np.intp)
    if any(not flips for _, flips in selfmaps):
        # It lies on a mirror: one straight line, whatever elements take turns beside it.
        line = _Arcs(none, none, np.array([-1]), np.zeros(1, np.intp), np.zeros(1, complex), np.zeros((1, 2), complex))
        return line.between(start, end, IDENTITY, stabilizer)
    vertex, arcs = edge.vertex.copy(), edge.arcs
    ends = Points(np.array([start[0], end[0]]), np.array([0, 1]), (start[1], end[1]))
    vertex[[0, -1]] = positions.locate(ends)
    if not selfmaps:
        inner = builder.add(vertex[1:-1])
        control = _controls(builder, boundary, arcs, vertex)
        plain = _Arcs(inner, 0 * inner, control, 0 * control, boundary.focus[arcs], boundary.directrix[arcs])
        return plain.between(start, end, IDENTITY, stabilizer)
    mirror = selfmaps[0][0]
    vertex, arcs = _symmetric(action, mirror, vertex, arcs)
    half, odd = divmod(len(arcs), 2)
    pair = tuple(sorted((IDENTITY, mirror)))
    inner = builder.add(vertex[1 : half + odd])
    if odd:
        vertex[half + 1 : -1] = action.apply(mirror, vertex[1 : half + 1][::-1])
        core = arcs[: half + 1]
        control = _controls(builder, boundary, core, vertex[: half + 2])
        if control[half] >= 0:
            control[half] = builder.add_fixed(builder.last(), pair)
        order = np.concatenate((inner, inner[::-1]))
    else:
        centre = builder.add_fixed(complex(vertex[half]), pair)
        vertex[half] = builder.last()
        core = arcs[:half]
        control = _controls(builder, boundary, core, vertex[: half + 1])
        order = np.concatenate((inner, [centre], inner[::-1]))
    places = np.concatenate((np.arange(len(core)), np.arange(half)[::-1]))
    symmetric = _Arcs(
        inner=order,
        inner_by=(np.arange(len(order)) >= half).astype(np.intp),
        control=control[places],
        control_by=(np.arange(len(places)) >= len(core)).astype(np.intp),
        focus=boundary.focus[core][places],
        directrix=boundary.directrix[core][places],
    )
    return symmetric.between(start, end, mirror, stabilizer)


@dataclass(frozen=True, slots=True)
class _Arcs:
    """The arcs of an edge between its corners, as indices of representatives.

    Attributes:
        inner: (k - 1,) the vertices between the arcs; control: (k,) the control points, -1 for lines.
        inner_by, control_by: 0 where they stand for themselves, 1 where the motion that reverses the edge moves them.
        focus, directrix: (k,) and (k, 2), to be moved as the control points.
    """

    inner: Ints
    inner_by: Ints
    control: Ints
    control_by: Ints
    focus: Complexes
    directrix: Complexes

    def between(
        self,
        start: tuple[int, Motion],
        end: tuple[int, Motion],
        reversal: Motion,
        stabilizer: tuple[tuple[Motion, bool], ...],
    ) -> QuotientEdge:
        """The edge between two corners."""
        motions = (IDENTITY, reversal)
        corners = [Points(np.array([index]), np.zeros(1, np.intp), (motion,)) for index, motion in (start, end)]
        return QuotientEdge(
            vertex=Points.concatenate([corners[0], Points(self.inner, self.inner_by, motions), corners[1]]),
            control=Points(self.control, self.control_by, motions),
            focus=self.focus,
            directrix=self.directrix,
            stabilizer=stabilizer,
        )


def _symmetric(action: Action, mirror: Motion, vertex: Complexes, arcs: Ints) -> tuple[Complexes, Ints]:
    """The vertices of a symmetric edge that have a counterpart, and its arcs: rounding splits some on one side only."""
    image = action.apply(mirror, vertex)[::-1]
    if len(arcs) == 1 or np.abs(image - vertex).max() <= PAIRING * action.size:
        return vertex, arcs
    gaps = np.abs(image[:, None] - vertex)
    kept = [0]
    for k in range(1, len(arcs)):
        partner = int(gaps[:, k].argmin())
        if gaps[partner, k] <= _COUNTERPART * action.size and int(gaps[partner].argmin()) == k:
            kept.append(k)
    length = np.abs(np.diff(vertex))
    bounds = [*kept, len(arcs)]
    longest = [a + int(length[a:b].argmax()) for a, b in zip(kept, bounds[1:], strict=True)]
    return vertex[bounds], arcs[longest]


def _controls(builder: Builder, boundary: Traced, arcs: Ints, vertex: Complexes) -> Ints:
    """The indices of the control points, which are added, of arcs between consecutive vertices; -1 for lines."""
    control = np.full(len(arcs), -1)
    curved = np.flatnonzero(boundary.curved[arcs])
    bent = arcs[curved]
    control[curved] = builder.add(
        parabola_controls(vertex[curved], vertex[curved + 1], boundary.focus[bent], boundary.directrix[bent])
    )
    return control

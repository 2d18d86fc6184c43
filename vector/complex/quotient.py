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
from voronoi_tiles.vector.complex.sharpening import sharpen_within
from voronoi_tiles.vector.complex.traced import Traced
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion

# How near to a vertex the image of its counterpart must be, relative to the cell's size, where some have none.
_COUNTERPART = 1e-6


@dataclass(frozen=True, eq=False, slots=True)
class QuotientEdge:
    """The edge that stands for an orbit of edges: k arcs between two tiles.

    `vertex` are its ends and the points between its arcs, k + 1 of them. `control` are the control points of the arcs
    as quadratic Bezier curves, none for a line; `focus` (complex128, k) and `directrix` (complex128, k x 2) are those
    of the parabolas before the motions that take the control points to their places. `stabilizer` are the motions that
    map the edge onto itself, the identity first, each with whether it comes out running backwards.
    """

    vertex: Points
    control: Points
    focus: Complexes
    directrix: Complexes
    stabilizer: tuple[tuple[Motion, bool], ...]

    def __len__(self) -> int:
        """The number of arcs."""
        return len(self.focus)

    @property
    def reversal(self) -> Motion | None:
        """The motion that maps the edge onto itself backwards, None where there is none."""
        return next((motion for motion, flips in self.stabilizer if flips), None)


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
class Quotient:
    """The quotient complex: one edge of each orbit, and the boundary of the base tile of each site.

    All points of edges are images of `representatives`. Of a boundary's rings the outer ones run counter-clockwise and
    come first, holes run clockwise.
    """

    representatives: Representatives
    edges: tuple[QuotientEdge, ...]
    boundaries: tuple[tuple[tuple[EdgeUse, ...], ...], ...]

    def paths(self) -> Paths:
        """The edges as paths of lines and quadratic curves, in the places in which they stand for their orbits."""
        vertices = [self.representatives.locate(edge.vertex) for edge in self.edges]
        controls = [self.representatives.locate(edge.control) for edge in self.edges]
        curved = np.concatenate([edge.control.index >= 0 for edge in self.edges])
        return Paths(
            start=np.concatenate([vertex[:-1] for vertex in vertices]),
            end=np.concatenate([vertex[1:] for vertex in vertices]),
            control=np.column_stack((np.concatenate(controls), np.zeros(len(curved)))),
            kind=np.where(curved, QUAD, LINE).astype(np.uint8),
            offsets=np.append(0, np.cumsum([len(edge) for edge in self.edges])).astype(np.intp),
            closed=np.zeros(len(self.edges), np.bool_),
        )


def build_quotient(action: Action, traced: list[Traced], edges: list[Edge]) -> Quotient:
    """The quotient complex of a tessellation: of each site's traced boundary, and their edges, ring after ring."""
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
    stabilizer = tuple((motion, flips) for motion, image, flips in edge.images if image is edge)
    others = [(motion, flips) for motion, flips in stabilizer if motion != IDENTITY]
    start, end = (
        Points.under(motion, np.array([number])) for number, motion in (corners[edge.start], corners[edge.end])
    )
    if any(not flips for _, flips in others):
        # It lies on a mirror: one straight line, whatever elements take turns beside it.
        inner, control = Points.under(IDENTITY, np.zeros(0, np.intp)), Points.under(IDENTITY, np.array([-1]))
        focus, directrix = np.zeros(1, complex), np.zeros((1, 2), complex)
    else:
        vertex = edge.vertex.copy()
        vertex[[0, -1]] = positions.locate(Points.concatenate([start, end]))
        sharpen_within(boundary, edge.arcs, vertex)
        if others:
            inner, control, arcs = _add_symmetric(builder, boundary, edge.arcs, vertex, others[0][0])
        else:
            inner, control, arcs = *_add(builder, boundary, edge.arcs, vertex), edge.arcs
        focus, directrix = boundary.focus[arcs], boundary.directrix[arcs]
    return QuotientEdge(Points.concatenate([start, inner, end]), control, focus, directrix, stabilizer)


def _add(builder: Builder, boundary: Traced, arcs: Ints, vertex: Complexes) -> tuple[Points, Points]:
    """Add the points of arcs between consecutive vertices: those within, and the control points, none for lines."""
    inner = builder.add(vertex[1:-1])
    control = np.full(len(arcs), -1)
    curved = np.flatnonzero(boundary.curved[arcs])
    bent = arcs[curved]
    control[curved] = builder.add(
        parabola_controls(vertex[curved], vertex[curved + 1], boundary.focus[bent], boundary.directrix[bent])
    )
    return Points.under(IDENTITY, inner), Points.under(IDENTITY, control)


def _add_symmetric(
    builder: Builder, boundary: Traced, arcs: Ints, vertex: Complexes, reversal: Motion
) -> tuple[Points, Points, Ints]:
    """Add the points of an edge that a motion maps onto itself backwards: those within, the control points, the arcs.

    Some of the arcs may go. The points of the second half are the images of those of the first half; what lies in the
    middle, a vertex or the control point of an arc, is fixed by the motion.
    """
    vertex, arcs = _with_counterparts(builder.action, reversal, vertex, arcs)
    fixing = tuple(sorted((IDENTITY, reversal)))
    half, odd = divmod(len(arcs), 2)
    first, back = arcs[: half + odd], np.arange(half)[::-1]
    centre = []
    if not odd:
        centre = [Points.under(IDENTITY, np.array([builder.add_fixed(complex(vertex[half]), fixing)]))]
        vertex[half] = builder.last()
    elif half:
        vertex[half + 1] = builder.action.apply_to_point(reversal, complex(vertex[half]))
    inner, control = _add(builder, boundary, first, vertex[: len(first) + 1])
    if odd and control.index[half] >= 0:
        control.index[half] = builder.add_fixed(builder.last(), fixing)
    other = inner.take(np.arange(len(inner))[::-1]).moved(reversal)
    inner = Points.concatenate([inner, *centre, other])
    control = Points.concatenate([control, control.take(back).moved(reversal)])
    return inner, control, np.concatenate((first, first[back]))


def _with_counterparts(action: Action, reversal: Motion, vertex: Complexes, arcs: Ints) -> tuple[Complexes, Ints]:
    """The vertices of a symmetric edge that have a counterpart, and its arcs: rounding splits some in one half only."""
    image = action.apply(reversal, vertex)[::-1]
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

"""Outlines whose edges are shared: each edge is computed once, and mapped to all its places.

A point is held as a representative and an exact motion. From whichever tile it is reached, the same representative is
moved by the same motion, and comes out as the same bits; so tiles share their edges exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.vector.arcs import parabola_controls
from voronoi_tiles.vector.complex.corners import Corners, find_corners
from voronoi_tiles.vector.complex.edges import PAIRING, Edge, Traced
from voronoi_tiles.vector.complex.representatives import Builder, Points, Representatives
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose

# How near to a vertex the image of its counterpart must be, relative to the cell's size, where some have none.
_COUNTERPART = 1e-6


@dataclass(frozen=True)
class SharedOutline:
    """The outline of a tile.

    Attributes:
        representatives: of all tiles.
        start: (n,) where each arc starts; it ends where the next of its ring starts.
        control: (n,) of the quadratic Bezier; its index is -1 for a line.
        focus: (n,) and directrix: (n, 2), of the representative arc, to be moved as the control point.
        ring_offsets: (r + 1,) the arcs of ring k are ring_offsets[k] to ring_offsets[k + 1].
        beyond: (n,) into `neighbours`: site and motion of the copy beyond each arc.
    """

    representatives: Representatives
    start: Points
    control: Points
    focus: Complexes
    directrix: Complexes
    ring_offsets: Ints
    beyond: Ints
    neighbours: tuple[tuple[int, Motion], ...]


@dataclass(frozen=True, slots=True)
class _Arcs:
    """The arcs of an edge as references to representatives, each with the index of its motion in a given pair.

    Attributes:
        inner, inner_by: (k - 1,) the vertices between the arcs.
        control, control_by: (k,) the control points, -1 for lines.
        focus, directrix: (k,) and (k, 2), to be moved as the control points.
        motions: the identity and, if the edge is symmetric, the motion that maps it onto itself.
    """

    inner: Ints
    inner_by: Ints
    control: Ints
    control_by: Ints
    focus: Complexes
    directrix: Complexes
    motions: tuple[Motion, ...]

    def reversed(self) -> _Arcs:
        """Return the same edge run through from its end."""
        arrays = {name: getattr(self, name)[::-1] for name in self.__slots__ if name != "motions"}
        return _Arcs(**arrays, motions=self.motions)


def share_edges(action: Action, traced: list[Traced], edges: list[Edge]) -> list[SharedOutline]:
    """Return the outlines of all tiles, their edges and corners shared.

    Args:
        traced: for each site its tile's boundary.
        edges: of these boundaries, paired, ring after ring.
    """
    builder = Builder(action)
    corners = find_corners(builder, traced, edges)
    positions = builder.snapshot()
    sources: dict[Edge, tuple[Motion, bool, _Arcs]] = {}
    for edge in edges:
        if edge not in sources:
            arcs = _represent(builder, positions, traced[edge.tile], edge, corners)
            for motion, image, flips in edge.images:
                sources.setdefault(image, (motion, flips, arcs))
    representatives = builder.snapshot()
    outlines = []
    for tile, boundary in enumerate(traced):
        own = [edge for edge in edges if edge.tile == tile]
        outlines.append(_assemble(representatives, boundary, own, sources, corners))
    return outlines


def _represent(builder: Builder, positions: Representatives, boundary: Traced, edge: Edge, corners: Corners) -> _Arcs:
    """Return the arcs of an edge that stands for its orbit, symmetric under the motions that map it onto itself."""
    action = builder.action
    selfmaps = [(motion, flips) for motion, image, flips in edge.images if image is edge and motion != IDENTITY]
    if any(not flips for _, flips in selfmaps):
        # It lies on a mirror: one straight line, whatever elements take turns beside it.
        none, one = np.zeros(0, np.intp), np.zeros(1, np.intp)
        return _Arcs(none, none, one - 1, one, np.zeros(1, complex), np.zeros((1, 2), complex), (IDENTITY,))
    vertex, arcs = edge.vertex.copy(), edge.arcs
    (first, by), (last, last_by) = corners[edge.start], corners[edge.end]
    ends = Points(np.array([first, last]), np.array([0, 1]), (by, last_by))
    vertex[[0, -1]] = positions.locate(ends)
    if not selfmaps:
        inner = builder.add(vertex[1:-1])
        control = _controls(builder, boundary, arcs, vertex)
        focus, directrix = boundary.focus[arcs], boundary.directrix[arcs]
        return _Arcs(inner, 0 * inner, control, 0 * control, focus, directrix, (IDENTITY,))
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
    return _Arcs(
        inner=order,
        inner_by=(np.arange(len(order)) >= half).astype(np.intp),
        control=control[places],
        control_by=(np.arange(len(places)) >= len(core)).astype(np.intp),
        focus=boundary.focus[core][places],
        directrix=boundary.directrix[core][places],
        motions=(IDENTITY, mirror),
    )


def _symmetric(action: Action, mirror: Motion, vertex: Complexes, arcs: Ints) -> tuple[Complexes, Ints]:
    """Leave out vertices of a symmetric edge that have no counterpart: rounding splits a vertex on one side only."""
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
    """Add the control points of arcs between consecutive vertices; return their indices, -1 for lines."""
    control = np.full(len(arcs), -1)
    curved = np.flatnonzero(boundary.curved[arcs])
    bent = arcs[curved]
    control[curved] = builder.add(
        parabola_controls(vertex[curved], vertex[curved + 1], boundary.focus[bent], boundary.directrix[bent])
    )
    return control


def _assemble(
    representatives: Representatives,
    boundary: Traced,
    edges: list[Edge],
    sources: dict[Edge, tuple[Motion, bool, _Arcs]],
    corners: Corners,
) -> SharedOutline:
    """Return a tile's outline from its edges, ring after ring."""
    numbers: dict[Motion, int] = {}
    start, start_by, control, control_by, focus, directrix = [], [], [], [], [], []
    beyond, offsets = [], [0]
    rings = [int(boundary.ring[edge.arcs[0]]) for edge in edges]
    faces: dict[tuple[int, Motion], int] = {}
    for place, edge in enumerate(edges):
        outer, flips, arcs = sources[edge]
        if flips:
            arcs = arcs.reversed()
        by = np.array([numbers.setdefault(compose(outer, motion), len(numbers)) for motion in arcs.motions])
        corner, corner_motion = corners[edge.start]
        start.append(np.append(corner, arcs.inner))
        start_by.append(np.append(numbers.setdefault(corner_motion, len(numbers)), by[arcs.inner_by]))
        control.append(arcs.control)
        control_by.append(by[arcs.control_by])
        focus.append(arcs.focus)
        directrix.append(arcs.directrix)
        count = len(arcs.control)
        beyond.append(np.full(count, faces.setdefault((edge.target, edge.motion), len(faces))))
        if place and rings[place] != rings[place - 1]:
            offsets.append(offsets[-1])
        if len(offsets) == 1:
            offsets.append(0)
        offsets[-1] += count
    motions = tuple(numbers)
    return SharedOutline(
        representatives=representatives,
        start=Points(np.concatenate(start), np.concatenate(start_by), motions),
        control=Points(np.concatenate(control), np.concatenate(control_by), motions),
        focus=np.concatenate(focus),
        directrix=np.concatenate(directrix),
        ring_offsets=np.array(offsets),
        beyond=np.concatenate(beyond),
        neighbours=tuple(faces),
    )

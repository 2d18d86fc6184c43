"""The traced boundaries of all tiles: their arcs, each with the curve that it lies on and the copy beyond."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, counts_of, next_in_ring, ranges, starts
from voronoi_tiles.base.kernels import BOOLS, COMPLEXES, INT, INTS, kernel
from voronoi_tiles.base.maps import move
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.vector.arcs import parabola_controls
from voronoi_tiles.vector.cells.cells import Parts
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.cells.pencils import Rows
from voronoi_tiles.vector.cells.trace import Boundary
from voronoi_tiles.vector.complex.handovers import sharpen_handovers
from voronoi_tiles.vector.copies import Copies
from voronoi_tiles.vector.motion_codes import Codes

NEARLY_TOUCHING = 1e-3
"""Two nodes, or a node and a line, this near to each other, relative to the distance R of a point, determine it badly
across their bisector: to EPSILON R / NEARLY_TOUCHING, a fifth of what the proof accepts where R is the cell's size."""

# What the compiled kernel takes, as in traced.c.
_CURVES = kernel(
    "complex_curves",
    *(INT, INTS, COMPLEXES, INTS, INTS, INTS, INTS, INTS, INTS, INT, INTS, INTS, INTS, COMPLEXES),
    *(COMPLEXES, COMPLEXES, BOOLS, COMPLEXES, INTS, INTS, INTS, INTS, COMPLEXES, INTS),
)


@dataclass(frozen=True, eq=False)
class Traced:
    """The traced boundaries of all tiles: n arcs, ring after ring and tile after tile, each with its tile on the left.

    Arc k starts at `vertex[k]` (complex128) and ends where the next arc of its ring starts; the arcs of ring r are
    those from `offsets[r]` up to, not including, `offsets[r + 1]` (intp, r + 1). The ring belongs to the tile
    `ring_tile[r]` (intp), whose outer rings come before its holes. Beyond the arc lies the copy of the site `site[k]`
    (intp) under the motion `motion[k]` (int64). Where `curved[k]` (bool) the arc lies on the parabola with the focus
    `focus[k]` (complex128) and the directrix through the two points `directrix[k]` (complex128, n x 2); else on a line,
    and these are 0. `nodes[k]` (complex128, n x 2) are the two nodes between which it is the bisector, NaN where it is
    that of other elements.
    """

    vertex: Complexes
    offsets: Ints
    ring_tile: Ints
    site: Ints
    motion: Codes
    curved: Bools
    focus: Complexes
    directrix: Complexes
    nodes: Complexes

    def __len__(self) -> int:
        """The number of arcs."""
        return len(self.vertex)

    def take(self, index: Ints) -> Traced:
        """The boundaries of these arcs only, ring after ring, each ending where the next one starts."""
        arrays = {name: getattr(self, name)[index] for name in _OF_ARCS}
        ring = self.ring[index]
        first = starts(ring)
        return replace(self, offsets=np.append(first, len(ring)), ring_tile=self.ring_tile[ring[first]], **arrays)

    @cached_property
    def ring(self) -> Ints:
        """The ring of each arc, intp (n,)."""
        return np.arange(len(self.ring_tile)).repeat(counts_of(self.offsets))

    @cached_property
    def tile(self) -> Ints:
        """The tile of each arc, intp (n,)."""
        return self.ring_tile.repeat(counts_of(self.offsets))

    @cached_property
    def nearly_touching(self) -> frozenset[int]:
        """The arcs that are the bisectors of what nearly touches, as seen from their farther end; hardly ever any."""
        return frozenset(np.flatnonzero(self.uncertainty).tolist())

    @cached_property
    def uncertainty(self) -> Floats:
        """How far rounding moves each arc's farther end across it, where what it is the bisector of nearly touches.

        That is EPSILON Z R / d, where d is the gap, R how far away it is, and Z how large the coordinates are, or R if
        that is more; float64 (n,), 0 where nothing nearly touches.
        """
        one, two = self.nodes.T
        axis = self.directrix[:, 1] - self.directrix[:, 0]
        across = (self.focus - self.directrix[:, 0]) * axis.conj()
        here = np.where(self.curved, self.focus, one)
        away = np.maximum(np.abs(self.vertex - here), np.abs(self.vertex[self.following] - here))
        gap = np.abs(two - one)
        np.divide(np.abs(across.imag), np.abs(axis), out=gap, where=self.curved)
        moved = np.zeros(len(self))
        # Twice as many as are sharpened: a point that was sharpened before has moved.
        near = (gap < 2 * NEARLY_TOUCHING * away).nonzero()[0]
        if len(near):
            with np.errstate(divide="ignore"):
                moved[near] = EPSILON * np.maximum(np.abs(here[near]), away[near]) * away[near] / gap[near]
        return moved

    @cached_property
    def following(self) -> Ints:
        """The next arc of each arc's ring, intp (n,)."""
        return next_in_ring(self.offsets)

    @cached_property
    def changes(self) -> Bools:
        """Where the copy beyond is another one than before, bool (n,)."""
        changes = np.empty(len(self), bool)
        after = self.following
        changes[after] = (self.motion[after] != self.motion) | (self.site[after] != self.site)
        return changes

    @cached_property
    def middles(self) -> Complexes:
        """The point of each arc halfway between its ends, by its parameter."""
        start, end = self.vertex, self.vertex[self.following]
        middle = (start + end) / 2
        bent = np.flatnonzero(self.curved)
        control = parabola_controls(start[bent], end[bent], self.focus[bent], self.directrix[bent])
        middle[bent] = (middle[bent] + control) / 2
        return middle


_OF_ARCS = ("vertex", "site", "motion", "curved", "focus", "directrix", "nodes")


def with_curves(
    boundary: Boundary, rows: Rows, contour: Contour, parts: Parts, copies: Copies, node_site: Ints
) -> Traced:
    """The boundaries of all tiles, with the curve of each arc: the bisector of two elements, here and beyond.

    Arcs in a row that lie on one curve are one arc; vertices where nearly parallel segments hand over are sharpened.
    Rings are in the order of their tiles, outer ones before holes. A compiled kernel gives the same.

    `rows`, `contour` and `parts` are those of all sites, `node_site` (intp, m) is the site of each node.
    """
    compiled = _CURVES()
    curves = _curves if compiled is None else partial(_curves_compiled, compiled)
    vertex, bounds, copy, item, (first, second), ends = curves(boundary, rows, contour, parts, copies)
    node_here, node_there = first == second
    here, there = ends[:, 0], ends[:, 1]
    curved = node_here != node_there
    sharpen_handovers(vertex, bounds, copy, copies, contour, item, ends)
    traced = Traced(
        vertex=vertex,
        offsets=bounds,
        ring_tile=node_site[first[0, bounds[:-1]]],
        site=node_site[first[1]],
        motion=copies.motions[copy],
        curved=curved,
        focus=np.where(curved, np.where(node_here, here[0], there[0]), 0),
        directrix=np.where(curved, np.where(node_here, there, here), 0).T,
        nodes=np.where(node_here & node_there, ends[0], np.nan).T,
    )
    return traced if (traced.ring_tile[1:] > traced.ring_tile[:-1]).all() else _in_order(traced)


class _BisectorArcs(NamedTuple):
    """The arcs of boundaries, and what determines the curves that they lie on, for n arcs in r rings.

    Arc k starts at `vertex[k]` (complex128); the arcs of ring r are those from `bounds[r]` up to, not including,
    `bounds[r + 1]` (intp, r + 1). It is the bisector of two elements, one here and one of the copy `copy[k]` (intp) of
    the sites. Of both `item` (intp, 2 x n) is the half-edge i, or the corner c as h + c where there are h half-edges;
    `node` (intp, 2 x 2 x n) are the nodes at their ends, by end and by side, `ends` (complex128) where these lie.
    """

    vertex: Complexes
    bounds: Ints
    copy: Ints
    item: Ints
    node: Ints
    ends: Complexes


def _curves(boundary: Boundary, rows: Rows, contour: Contour, parts: Parts, copies: Copies) -> _BisectorArcs:
    """The arcs of boundaries, of several in a row that lie on one curve the first; of a ring of one curve all."""
    row, copy = parts.row[boundary.part], parts.copy[boundary.part]
    half_edges, corner = len(contour.source), rows.corner[row]
    item = np.array((np.where(corner >= 0, half_edges + corner, rows.half_edge[row]), parts.item[boundary.part]))
    first = np.concatenate((contour.source, contour.corner_node))[item]
    # What half-edges and corners lie on: segments, and behind them nodes.
    carrier = np.where(item < half_edges, item >> 1, half_edges + first)
    bounds = np.concatenate((starts(boundary.ring), [len(boundary.ring)]))
    kept = _without_seams(bounds, np.array((carrier[0], copy, carrier[1])))
    vertex, item, copy = boundary.vertex[kept], item[:, kept], copy[kept]
    node = np.array((first[:, kept], np.concatenate((contour.target, contour.corner_node))[item]))
    ends = contour.nodes[node]
    ends[:, 1] = move(ends[:, 1], copies.unit[copy], copies.shift[copy], copies.conj[copy])
    return _BisectorArcs(vertex, kept.searchsorted(bounds), copy, item, node, ends)


def _curves_compiled(
    compiled: Callable[..., int], boundary: Boundary, rows: Rows, contour: Contour, parts: Parts, copies: Copies
) -> _BisectorArcs:
    """The same by the compiled kernel."""
    count = len(boundary.part)
    vertex, ends, rings = np.empty(count, complex), np.empty((2, 2, count), complex), np.empty(1, np.intp)
    bounds, copy = np.empty(count + 1, np.intp), np.empty(count, np.intp)
    item, node = np.empty((2, count), np.intp), np.empty((2, 2, count), np.intp)
    kept = compiled(
        *(count, boundary.part, boundary.vertex, boundary.ring, rows.half_edge, rows.corner),
        *(parts.row, parts.copy, parts.item, len(contour.source), contour.source, contour.target),
        *(contour.corner_node, contour.nodes, copies.unit, copies.shift, copies.conj),
        *(vertex, bounds, copy, item, node, ends, rings),
    )
    bounds = bounds[: int(rings[0]) + 1]
    return _BisectorArcs(vertex[:kept], bounds, copy[:kept], item[:, :kept], node[..., :kept], ends[..., :kept])


def _without_seams(bounds: Ints, curve: Ints) -> Ints:
    """The arcs without those that go on along the curve of the one before; of a ring with one curve only, all.

    The arcs of ring r are those from `bounds[r]` up to, not including, `bounds[r + 1]`; `curve` (intp, m x n) is what
    determines the curve of each of the n arcs.
    """
    first = bounds[:-1]
    before = np.arange(-1, int(bounds[-1]) - 1)
    before[first] = bounds[1:] - 1
    fresh = (curve != curve[:, before]).any(axis=0)
    whole = ~np.logical_or.reduceat(fresh, first)
    if whole.any():
        fresh |= whole.repeat(counts_of(bounds))
    return np.flatnonzero(fresh)


def _in_order(traced: Traced) -> Traced:
    """The boundaries in the order of their tiles, outer rings before holes."""
    first, sizes = traced.offsets[:-1], counts_of(traced.offsets)
    start, end = traced.vertex, traced.vertex[traced.following]
    twice = start.real * end.imag - start.imag * end.real
    bent = np.flatnonzero(traced.curved)
    tangent = parabola_controls(start[bent], end[bent], traced.focus[bent], traced.directrix[bent]) - start[bent]
    chord = end[bent] - start[bent]
    twice[bent] += (tangent.real * chord.imag - tangent.imag * chord.real) * (2 / 3)
    order = np.lexsort((np.add.reduceat(twice, first) <= 0.0, traced.ring_tile))
    return traced.take(ranges(first[order], sizes[order]))


def clearance(boundary: Boundary, rows: Rows, parts: Parts) -> float:
    """The least distance of a site from a vertex of its tile's boundary."""
    row = parts.row[boundary.part]
    away, normal = boundary.vertex - rows.origin[row], rows.ray0[row]
    height = np.abs(away.real * normal.real + away.imag * normal.imag)
    return float(np.where(rows.straight[row], height, np.abs(away)).min())

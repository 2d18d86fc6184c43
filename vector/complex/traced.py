"""The traced boundary of a tile: its arcs, each with the curve that it lies on and the copy beyond."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, next_in_ring, starts
from voronoi_tiles.base.maps import move
from voronoi_tiles.vector.arcs import parabola_controls
from voronoi_tiles.vector.cells.cells import Parts
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.cells.pencils import Rows
from voronoi_tiles.vector.cells.trace import Boundary
from voronoi_tiles.vector.copies import Copies
from voronoi_tiles.vector.motions import Motion

NEARLY_TOUCHING = 1e-4
"""Two nodes, or a node and a line, this near to each other, relative to the distance of a point, determine it badly
across their bisector."""


@dataclass(frozen=True, eq=False)
class Traced:
    """The traced boundary of a tile: n arcs, ring after ring, with the tile on their left.

    Arc k starts at `vertex[k]` (complex128) and ends where the next arc of the ring `ring[k]` (intp) starts. Beyond it
    lies the copy `copy[k]` of the site `target[k]` (intp); `copies` has for each site its copies around this tile.
    Where `curved[k]` (bool) the arc lies on the parabola with the focus `focus[k]` (complex128) and the directrix
    through the two points `directrix[k]` (complex128, n x 2); else on a line, and these are 0. `nodes[k]` (complex128,
    n x 2) are the two nodes between which it is the bisector, NaN where it is that of other elements.
    """

    vertex: Complexes
    ring: Ints
    target: Ints
    copy: Ints
    curved: Bools
    focus: Complexes
    directrix: Complexes
    nodes: Complexes
    copies: list[Copies]

    def __len__(self) -> int:
        """The number of arcs."""
        return len(self.vertex)

    def take(self, index: Ints) -> Traced:
        """The boundary of these arcs only, each ending where the next one starts."""
        arrays = {field.name: getattr(self, field.name)[index] for field in fields(self) if field.name != "copies"}
        return Traced(**arrays, copies=self.copies)

    @cached_property
    def nearly_touching(self) -> frozenset[int]:
        """The arcs that are the bisectors of what nearly touches, as seen from their farther end; hardly ever any."""
        one, two = self.nodes.T
        axis = self.directrix[:, 1] - self.directrix[:, 0]
        across = (self.focus - self.directrix[:, 0]) * axis.conj()
        with np.errstate(invalid="ignore"):
            gap = np.where(self.curved, np.abs(across.imag) / np.abs(axis), np.abs(two - one))
        here = np.where(self.curved, self.focus, one)
        away = np.maximum(np.abs(self.vertex - here), np.abs(self.vertex[self.following] - here))
        # Twice as many as are sharpened: a point that was sharpened before has moved.
        return frozenset(np.flatnonzero(gap < 2 * NEARLY_TOUCHING * away).tolist())

    @cached_property
    def rings(self) -> list[Ints]:
        """The indices of each ring's arcs."""
        return np.split(np.arange(len(self)), starts(self.ring)[1:])

    @cached_property
    def following(self) -> Ints:
        """The next arc of each arc's ring, intp (n,)."""
        return next_in_ring(np.append(starts(self.ring), len(self)))

    def beyond(self, arc: int) -> tuple[int, Motion]:
        """The copy beyond an arc: its site, and the motion that takes that site there."""
        target = int(self.target[arc])
        a, b, c, d, s, t = self.copies[target].motions[self.copy[arc]].tolist()
        return target, (a, b, c, d, s, t)

    @cached_property
    def middles(self) -> Complexes:
        """The point of each arc halfway between its ends, by its parameter."""
        start, end = self.vertex, self.vertex[self.following]
        middle = (start + end) / 2
        bent = np.flatnonzero(self.curved)
        control = parabola_controls(start[bent], end[bent], self.focus[bent], self.directrix[bent])
        middle[bent] = (middle[bent] + control) / 2
        return middle


def with_curves(
    boundary: Boundary, rows: Rows, contours: list[Contour], tile: int, parts: Parts, copies: list[Copies]
) -> Traced:
    """The boundary of the tile of a site, with the curve of each arc: the bisector of two elements, here and beyond.

    Arcs in a row that lie on one curve are one arc; outer rings come before holes. `contours` and `copies` are of all
    sites, `rows` and `parts` of the site with the number `tile`.
    """
    row, target, copy, item = (values[boundary.part] for values in (parts.row, parts.target, parts.copy, parts.item))
    contour, corner = contours[tile], rows.corner[row]
    here, first, second = _elements(contour, np.where(corner >= 0, len(contour.source) + corner, rows.half_edge[row]))
    node_here, ends_here = first == second, contour.nodes[np.stack((first, second))]
    there, node_there, ends_there = np.empty_like(here), np.empty_like(node_here), np.empty_like(ends_here)
    for t, other in enumerate(contours):
        chosen = np.flatnonzero(target == t)
        there[chosen], first, second = _elements(other, item[chosen])
        node_there[chosen] = first == second
        k, images = copy[chosen], copies[t]
        ends = other.nodes[np.stack((first, second))]
        ends_there[:, chosen] = move(ends, images.unit[k], images.shift[k], images.conj[k])
    curved = node_here != node_there
    between = np.where(node_here & node_there, np.stack((ends_here[0], ends_there[0])), np.nan)
    traced = Traced(
        vertex=boundary.vertex,
        ring=boundary.ring,
        target=target,
        copy=copy,
        curved=curved,
        focus=np.where(curved, np.where(node_here, ends_here[0], ends_there[0]), 0),
        directrix=np.where(curved, np.where(node_here, ends_there, ends_here), 0).T,
        nodes=between.T,
        copies=copies,
    )
    return _tidy(traced, np.stack((here, target, copy, there)))


def _elements(contour: Contour, item: Ints) -> tuple[Ints, Ints, Ints]:
    """What half-edges i and corners h + c lie on, segment k or node h + m; and the nodes at its ends."""
    count = len(contour.source)
    first = np.concatenate((contour.source, contour.corner_node))[item]
    second = np.concatenate((contour.target, contour.corner_node))[item]
    return np.where(item < count, item >> 1, count + first), first, second


def _tidy(traced: Traced, curve: Ints) -> Traced:
    """The boundary with neighbouring arcs of one curve joined, and outer rings before holes.

    `curve` (intp, m x n) is what determines the curve of each of the n arcs.
    """
    kept, areas = [], []
    for ring in traced.rings:
        fresh = (curve[:, ring] != np.roll(curve[:, ring], 1, axis=1)).any(axis=0)
        kept.append(ring[fresh] if fresh.any() else ring)
        start = traced.vertex[ring]
        end = np.roll(start, -1)
        area = (start.real * end.imag - start.imag * end.real).sum() / 2
        bent = np.flatnonzero(traced.curved[ring])
        start, end = start[bent], end[bent]
        control = parabola_controls(start, end, traced.focus[ring[bent]], traced.directrix[ring[bent]])
        chord, tangent = end - start, control - start
        areas.append(area + (tangent.real * chord.imag - tangent.imag * chord.real).sum() / 3)
    order = np.argsort(-np.sign(areas), kind="stable")
    ring_number = np.repeat(np.arange(len(order)), [len(kept[k]) for k in order])
    tidy = traced.take(np.concatenate([kept[k] for k in order]))
    return replace(tidy, ring=ring_number)


def clearance(boundary: Boundary, rows: Rows, parts: Parts) -> float:
    """The distance of a site from the nearest vertex of its tile's boundary."""
    row = parts.row[boundary.part]
    away, normal = boundary.vertex - rows.origin[row], rows.ray0[row]
    height = np.abs(away.real * normal.real + away.imag * normal.imag)
    return float(np.where(rows.straight[row], height, np.abs(away)).min())

"""Spans: the parts of a tile's edges along which the feet on both sides stay on one node or one segment each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.gradients.feet import AllStrokes
from voronoi_tiles.gradients.sides import Sides
from voronoi_tiles.vector.outline import Outline

_INSIDE: Final = 2.0**-16
"""How far from an edge's ends it is looked at; relative to its parameter. At the ends themselves feet are ambiguous."""

_HALVINGS: Final = 20
"""How often an edge is halved about a place where a foot changes over; a count. Velocities are continuous there, so
that what is left, a millionth, counts with its square; and nearer by, rounding alone says on what the foot is."""

_LONG: Final = 1e-7
"""Edges that are shorter have one span; relative to the tile's size. Feet change over where strokes go straight on over
a joint, and within shorter edges rounding alone would say where."""


@dataclass(frozen=True, eq=False)
class FootSpans:
    """Parts of edges, one edge after the other: the edge `arc` (intp, n) and its parameters from `begin` to `end`.

    `lines` (intp, n x m x 2) are the nodes between which the foot on each image of `Sides` lies, one of them twice
    where it is that node.
    """

    arc: Ints
    begin: Floats
    end: Floats
    lines: Ints

    @classmethod
    def of(cls, outline: Outline, sides: Sides, strokes: AllStrokes) -> FootSpans:
        """Divide the edges of a tile."""

        def lines(arc: Ints, t: Floats) -> Ints:
            neighbour = outline.neighbour[arc]
            back = sides.back(points_at(outline, arc, t), neighbour)
            return strokes.lines(back, sides.site[neighbour], sides.weight[neighbour] != 0.0)

        arc = np.arange(len(outline))
        size = float(np.ptp(outline.start.real) + np.ptp(outline.start.imag))
        arc = arc[outline.lengths > _LONG * size]
        low, high = np.full(len(arc), _INSIDE), np.full(len(arc), 1.0 - _INSIDE)
        before, after = lines(arc, low), lines(arc, high)
        for _ in range(_HALVINGS):
            changed = _differ(before, after)
            arc, low, high, before, after = (part[changed] for part in (arc, low, high, before, after))
            if not len(arc):
                break
            middle = (low + high) / 2.0
            between = lines(arc, middle)
            arc = np.concatenate([arc, arc])
            low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
            before, after = np.concatenate([before, between]), np.concatenate([between, after])
        changed = _differ(before, after)
        arcs = np.concatenate([np.arange(len(outline)), arc[changed]])
        begin = np.concatenate([np.zeros(len(outline)), (low + high)[changed] / 2.0])
        order = np.lexsort((begin, arcs))
        arcs, begin = arcs[order], begin[order]
        last = np.append(arcs[1:] != arcs[:-1], True)
        end = np.where(last, 1.0, np.roll(begin, -1))
        return cls(arcs, begin, end, lines(arcs, (begin + end) / 2.0))

    def at(self, arc: Ints, t: Floats) -> Ints:
        """The spans of points of edges: intp (k,). A point between two is in the one that it begins."""
        # An edge's end is its own, not the next one's start.
        place = arc + np.minimum(t, 1.0 - _INSIDE)
        return np.searchsorted(self.arc + np.minimum(self.begin, 1.0 - _INSIDE), place, side="right") - 1


def _differ(before: Ints, after: Ints) -> Bools:
    """Whether any foot lies on something else."""
    return np.asarray((before != after).any(axis=(1, 2)))


def points_at(outline: Outline, arc: Ints, t: Floats) -> Complexes:
    """Points of edges, each at a parameter from 0 to 1 of its quadratic curve: complex128 (k,)."""
    s = 1.0 - t
    return s * s * outline.start[arc] + 2.0 * s * t * outline.control[arc] + t * t * outline.end[arc]


def speeds_at(outline: Outline, arc: Ints, t: Floats) -> Floats:
    """The lengths of edges by their parameters, as `points_at` has them: float64 (k,)."""
    start, control, end = outline.start[arc], outline.control[arc], outline.end[arc]
    return np.asarray(2.0 * np.abs((1.0 - t) * (control - start) + t * (end - control)))

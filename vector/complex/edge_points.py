"""The points of the edges that stand for their orbits: vertices and control points, symmetric where the edges are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, counting, offsets_of, ranges
from voronoi_tiles.vector.arcs import parabola_controls
from voronoi_tiles.vector.complex.edges import PAIRING, Edges
from voronoi_tiles.vector.complex.representatives import Builder, Points, fixed
from voronoi_tiles.vector.complex.sharpening import sharpen_within
from voronoi_tiles.vector.complex.traced import Traced
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, code_of
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion

# How near to a vertex the image of its counterpart must be, relative to the cell's size, where some have none.
_COUNTERPART = 1e-6


@dataclass(frozen=True, slots=True)
class _ArcRuns:
    """Runs of arcs, one of each edge: those of run k from `offsets[k]` up to, not including, `offsets[k + 1]`.

    `arcs` (intp, n) are arcs of the traced boundary, drawn as parabolas where `curved` (bool, n); `vertex` (complex128,
    n + r) are the ends of each run's arcs.
    """

    arcs: Ints
    curved: Bools
    vertex: Complexes
    offsets: Ints

    @property
    def begin(self) -> Ints:
        """The first vertex of each run."""
        return self.offsets[:-1] + np.arange(len(self.offsets) - 1)

    @property
    def end(self) -> Ints:
        """The last vertex of each run."""
        return self.offsets[1:] + np.arange(len(self.offsets) - 1)

    def run(self, k: int) -> tuple[Ints, Complexes]:
        """The arcs of one run and the vertices at their ends, as views."""
        first, last = self.offsets[k : k + 2].tolist()
        return self.arcs[first:last], self.vertex[first + k : last + k + 1]

    def replaced(self, others: Mapping[int, tuple[Ints, Bools, Complexes]]) -> _ArcRuns:
        """The runs with some of them exchanged for other arcs, curved or not, and vertices."""
        counts = np.diff(self.offsets)
        stays = np.ones(len(counts), bool)
        stays[list(others)] = False
        new_counts = counts.copy()
        new_counts[~stays] = [len(others[k][0]) for k in np.flatnonzero(~stays).tolist()]
        offsets = offsets_of(new_counts)
        new = _ArcRuns(
            np.empty(offsets[-1], np.intp),
            np.empty(offsets[-1], bool),
            np.empty(offsets[-1] + len(counts), complex),
            offsets,
        )
        source, target = (ranges(runs.offsets[:-1][stays], counts[stays]) for runs in (self, new))
        new.arcs[target], new.curved[target] = self.arcs[source], self.curved[source]
        source, target = (ranges(runs.begin[stays], counts[stays] + 1) for runs in (self, new))
        new.vertex[target] = self.vertex[source]
        for k, (arcs, curved, vertex) in others.items():
            first, last = offsets[k : k + 2].tolist()
            new.arcs[first:last], new.curved[first:last] = arcs, curved
            new.vertex[first + k : last + k + 1] = vertex
        return new


def represent(
    builder: Builder,
    edges: Edges,
    kept: Ints,
    ends: tuple[Points, Points],
    reversals: Mapping[int, Motion | None],
) -> tuple[Points, Points, Ints, Ints]:
    """The vertices, control points and arcs of the edges that stand for orbits, and where the arcs of each begin.

    These are the edges `kept` (intp, k) with corners at their two `ends`. Those among them that motions map onto
    themselves have `reversals`: a motion that does so backwards, or None for what lies on a mirror. That is one
    straight line, whatever elements take turns beside it. Of the others the points of the second half are the images of
    those of the first half, and what lies in the middle, a vertex or the control point of an arc, the motion fixes.
    """
    action, traced = builder.action, edges.traced
    runs = _runs(builder, edges, kept, ends)
    if traced.nearly_touching:
        for k in range(len(kept)):
            if reversals.get(k, IDENTITY) is not None:
                sharpen_within(traced, *runs.run(k))
    total = np.diff(runs.offsets)
    fixing: dict[int, tuple[Motion, Motion]] = {}
    if reversals:
        others = {}
        for k, reversal in reversals.items():
            arcs, vertex = runs.run(k)
            if reversal is None:
                total[k] = 1
                others[k] = arcs[:1], np.zeros(1, bool), vertex[[0, -1]]
            else:
                vertex, arcs = _with_counterparts(action, reversal, vertex, arcs)
                total[k] = len(arcs)
                first, second = sorted((IDENTITY, reversal))
                fixing[k] = first, second
                others[k] = _first_half(action, traced, reversal, arcs, vertex, fixing[k])
        runs = runs.replaced(others)
    index = np.empty(len(runs.vertex), np.intp)
    index[runs.begin], index[runs.end] = ends[0].index, ends[1].index
    inner = np.ones(len(index), bool)
    inner[runs.begin] = inner[runs.end] = False
    centre = {k: int(runs.end[k]) for k in fixing if total[k] % 2 == 0}
    inner[list(centre.values())] = True
    index[inner] = builder.add(runs.vertex[inner])
    for k, place in centre.items():
        builder.fix(int(index[place]), fixing[k])
    return _unfolded(ends, index, _controls(builder, traced, runs, fixing, total), runs, total, reversals)


def _runs(builder: Builder, edges: Edges, kept: Ints, ends: tuple[Points, Points]) -> _ArcRuns:
    """The arcs of edges and their vertices, those at the ends where the corners are."""
    located = builder.snapshot().locate(ends[0].and_then(ends[1]))
    counts = np.diff(edges.offsets)[kept]
    arcs = edges.arcs[ranges(edges.offsets[kept], counts)]
    runs = _ArcRuns(arcs, edges.traced.curved[arcs], np.empty(len(arcs) + len(kept), complex), offsets_of(counts))
    runs.vertex[np.arange(len(arcs)) + np.repeat(np.arange(len(kept)), counts)] = edges.traced.vertex[arcs]
    runs.vertex[runs.begin], runs.vertex[runs.end] = located[: len(kept)], located[len(kept) :]
    return runs


def _controls(
    builder: Builder, traced: Traced, runs: _ArcRuns, fixing: Mapping[int, tuple[Motion, Motion]], total: Ints
) -> Ints:
    """The control points of all arcs, -1 for lines; those in the middle of symmetric edges put where they are fixed."""
    curved = runs.curved
    run = np.repeat(np.arange(len(total)), np.diff(runs.offsets))
    start, bent = (np.arange(len(curved)) + run)[curved], runs.arcs[curved]
    position = parabola_controls(runs.vertex[start], runs.vertex[start + 1], traced.focus[bent], traced.directrix[bent])
    control = np.full(len(curved), -1)
    control[curved] = np.arange(len(position))
    middle = {k: int(control[runs.offsets[k + 1] - 1]) for k in fixing if total[k] % 2}
    for k, place in middle.items():
        if place >= 0:
            position[place] = fixed(builder.action, complex(position[place]), fixing[k])
    control[curved] = numbers = builder.add(position)
    for k, place in middle.items():
        if place >= 0:
            builder.fix(int(numbers[place]), fixing[k])
    return control


def _unfolded(
    ends: tuple[Points, Points],
    index: Ints,
    control: Ints,
    runs: _ArcRuns,
    total: Ints,
    reversals: Mapping[int, Motion | None],
) -> tuple[Points, Points, Ints, Ints]:
    """The vertices, control points and arcs of whole edges, of `total` arcs each, and where the arcs of each begin.

    Of what is reversed onto itself `runs` has the first half: `index` are the numbers of their vertices, `control`
    those of the control points.
    """
    reversal = np.full(len(total), IDENTITY_CODE)
    for k, motion in reversals.items():
        if motion is not None:
            reversal[k] = code_of(motion)
    symmetric = reversal != IDENTITY_CODE
    offsets = offsets_of(total)
    place, edge = counting(total)
    folded = np.where(symmetric[edge], np.minimum(place, total[edge] - 1 - place), place)
    at = runs.offsets[edge] + folded
    controls = Points(control[at], np.where(folded != place, reversal[edge], IDENTITY_CODE))
    arcs = runs.arcs[at]
    place, edge = counting(total + 1)
    folded = np.where(symmetric[edge], np.minimum(place, total[edge] - place), place)
    vertices = Points(index[runs.begin[edge] + folded], np.where(folded != place, reversal[edge], IDENTITY_CODE))
    for corner, bound in zip(ends, (offsets[:-1], offsets[1:]), strict=True):
        where = bound + np.arange(len(total))
        vertices.index[where], vertices.motion[where] = corner.index, corner.motion
    return vertices, controls, arcs, offsets


def _first_half(
    action: Action,
    traced: Traced,
    reversal: Motion,
    arcs: Ints,
    vertex: Complexes,
    fixing: tuple[Motion, ...],
) -> tuple[Ints, Bools, Complexes]:
    """The first half of an edge that a motion maps onto itself backwards: arcs, curved or not, and vertices."""
    half, odd = divmod(len(arcs), 2)
    vertex = vertex.copy()
    if not odd:
        vertex[half] = fixed(action, complex(vertex[half]), fixing)
    elif half:
        vertex[half + 1] = action.apply_to_point(reversal, complex(vertex[half]))
    first = arcs[: half + odd]
    return first, traced.curved[first], vertex[: len(first) + 1]


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

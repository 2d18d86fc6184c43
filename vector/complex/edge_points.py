"""The points of the edges that stand for their orbits: vertices and control points, symmetric where the edges are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, counts_of, offsets_of, ranges
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
    def starts(self) -> Ints:
        """The vertex where each arc starts."""
        return np.arange(len(self.arcs)) + np.arange(len(self.offsets) - 1).repeat(counts_of(self.offsets))

    @property
    def begin(self) -> Ints:
        """The first vertex of each run."""
        return self.offsets[:-1] + np.arange(len(self.offsets) - 1)

    @property
    def end(self) -> Ints:
        """The last vertex of each run."""
        return self.offsets[1:] + np.arange(len(self.offsets) - 1)

    def run(self, k: int) -> tuple[Ints, Bools, Complexes]:
        """The arcs of one run, whether they are curved, and the vertices at their ends, as views."""
        first, last = self.offsets[k : k + 2].tolist()
        return self.arcs[first:last], self.curved[first:last], self.vertex[first + k : last + k + 1]

    def replaced(self, others: Mapping[int, tuple[Ints, Bools, Complexes]]) -> _ArcRuns:
        """The runs with some of them exchanged for other arcs, curved or not, and vertices."""
        runs = [others[k] if k in others else self.run(k) for k in range(len(self.offsets) - 1)]
        arcs, curved, vertex = (np.concatenate(parts) for parts in zip(*runs, strict=True))
        return _ArcRuns(arcs, curved, vertex, offsets_of([len(arcs) for arcs, _, _ in runs]))


def represent(
    builder: Builder,
    edges: Edges,
    kept: Ints,
    corners: Points,
    reversals: Mapping[int, Motion | None],
) -> tuple[Points, Points, Ints, Ints]:
    """The vertices, control points and arcs of the edges that stand for orbits, and where the arcs of each begin.

    These are the edges `kept` (intp, k); corner k of `corners` is the one where edge k starts. Those among them that
    motions map onto themselves have `reversals`: a motion that does so backwards, or None for what lies on a mirror.
    That is one straight line, whatever elements take turns beside it. Of the others the points of the second half are
    the images of those of the first half, and what lies in the middle, a vertex or the control point of an arc, the
    motion fixes.
    """
    action, traced = builder.action, edges.traced
    runs = _runs(builder, edges, kept, corners)
    if traced.nearly_touching:
        for k in range(len(kept)):
            if reversals.get(k, IDENTITY) is not None:
                arcs, _, vertex = runs.run(k)
                sharpen_within(traced, arcs, vertex)
    if reversals:
        runs = _symmetrized(action, traced, runs, reversals)
    flips = {k: reversal for k, reversal in reversals.items() if reversal is not None}
    # The vertices and the arcs as images of themselves and of others.
    vertices, arcs_of = _folded(runs.offsets + np.arange(len(kept) + 1), flips), _folded(runs.offsets, flips)
    begin, end = runs.begin, runs.end
    inner = vertices.motion == IDENTITY_CODE
    inner[begin] = inner[end] = False
    number = np.full(len(inner), -1)
    number[inner] = builder.add(runs.vertex[inner])
    fixing = {k: sorted((IDENTITY, reversal)) for k, reversal in flips.items()}
    for k, motions in fixing.items():
        if (end[k] - begin[k]) % 2 == 0:
            builder.fix(int(number[(begin[k] + end[k]) // 2]), motions)
    control = _controls(builder, traced, runs, arcs_of.motion == IDENTITY_CODE, fixing)
    vertices = Points(number[vertices.index], vertices.motion)
    for corner, where in ((kept, begin), (edges.following[kept], end)):
        vertices.index[where], vertices.motion[where] = corners.index[corner], corners.motion[corner]
    return vertices, Points(control[arcs_of.index], arcs_of.motion), runs.arcs[arcs_of.index], runs.offsets


def _runs(builder: Builder, edges: Edges, kept: Ints, corners: Points) -> _ArcRuns:
    """The arcs of edges and their vertices, those at the ends where the corners are."""
    counts = edges.counts[kept]
    arcs = edges.arcs[ranges(edges.offsets[kept], counts)]
    vertex = np.empty(len(arcs) + len(kept), complex)
    runs = _ArcRuns(arcs, edges.traced.curved[arcs], vertex, offsets_of(counts))
    located = builder.snapshot().locate(corners)
    vertex[runs.starts] = edges.traced.vertex[arcs]
    vertex[runs.begin], vertex[runs.end] = located[kept], located[edges.following[kept]]
    return runs


def _symmetrized(action: Action, traced: Traced, runs: _ArcRuns, reversals: Mapping[int, Motion | None]) -> _ArcRuns:
    """The runs of edges that motions map onto themselves made so, in place where their numbers of arcs stay.

    Those on mirrors become one line. In those that are reversed the middle is put where the motion leaves it: a vertex,
    or the second end of an arc.
    """
    others = {}
    for k, reversal in reversals.items():
        arcs, curved, vertex = runs.run(k)
        if reversal is None:
            curved[:] = False
            if len(arcs) > 1:
                others[k] = arcs[:1], curved[:1], vertex[[0, -1]]
            continue
        whole, chosen = _with_counterparts(action, reversal, vertex, arcs)
        half, odd = divmod(len(chosen), 2)
        if not odd:
            whole[half] = fixed(action, complex(whole[half]), sorted((IDENTITY, reversal)))
        elif half:
            whole[half + 1] = action.apply_to_point(reversal, complex(whole[half]))
        if chosen is not arcs:
            others[k] = chosen, traced.curved[chosen], whole
    return runs.replaced(others) if others else runs


def _folded(bounds: Ints, flips: Mapping[int, Motion]) -> Points:
    """What the entries of runs are images of: themselves, or in the second half of reversed runs those of the first.

    Run k are the entries from `bounds[k]` up to, not including, `bounds[k + 1]`; `flips` has the motions that reverse
    some of the runs onto themselves.
    """
    folded = Points(np.arange(bounds[-1]), np.full(bounds[-1], IDENTITY_CODE))
    for k, reversal in flips.items():
        first, last = bounds[k : k + 2].tolist()
        half = (last - first) // 2
        folded.index[last - half : last] = folded.index[first : first + half][::-1]
        folded.motion[last - half : last] = code_of(reversal)
    return folded


def _controls(
    builder: Builder, traced: Traced, runs: _ArcRuns, own: Bools, fixing: Mapping[int, Sequence[Motion]]
) -> Ints:
    """The control points of those arcs that are their `own` images, -1 for lines.

    Those in the middle of edges that the motions `fixing` map onto themselves are put where they are fixed.
    """
    bent = (runs.curved & own).nonzero()[0]
    start = runs.starts[bent]
    arcs = runs.arcs[bent]
    position = parabola_controls(runs.vertex[start], runs.vertex[start + 1], traced.focus[arcs], traced.directrix[arcs])
    control = np.full(len(runs.curved), -1)
    control[bent] = np.arange(len(bent))
    middle = {}
    for k, motions in fixing.items():
        first, last = runs.offsets[k : k + 2].tolist()
        place = int(control[(first + last) // 2])
        if (last - first) % 2 and place >= 0:
            position[place] = fixed(builder.action, complex(position[place]), motions)
            middle[place] = motions
    control[bent] = numbers = builder.add(position)
    for place, motions in middle.items():
        builder.fix(int(numbers[place]), motions)
    return control


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

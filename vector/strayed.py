"""Whether sites lie inside their tiles: how often the outline of a tile runs around the parts of its site."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from voronoi_tiles.base import kernels
from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, owned_ranges
from voronoi_tiles.base.components import components
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.all_nodes import AllNodes
from voronoi_tiles.vector.nearest import distance_to_arcs
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import LocalTile

# Twice the root of the rounding unit, times a few for constants; relative to the longer of the cell's vectors.
_UNDECIDED = 1e-7


_COMPILED = kernels.kernel(
    "proof_windings",
    *(kernels.INT, kernels.COMPLEXES, kernels.INTS, kernels.INT, kernels.INTS),
    *(kernels.INT, kernels.COMPLEXES, kernels.COMPLEXES, kernels.COMPLEXES, kernels.BOOLS, kernels.INTS),
    kernels.INTS,
)


def strayed_parts(tiles: Sequence[LocalTile], nodes: AllNodes, arcs: AllArcs, size: float) -> int:
    """The number of connected parts of sites around which the outlines of their tiles do not run exactly once.

    `nodes` and `arcs` are those of the tiles, `size` is the length of the cell's longer vector. A part meets no edge,
    so one of its nodes stands for all. Where copies are a distance d apart, the edge between them is known to
    eps R^2 / d at a distance R: a node nearer to an outline than the root of eps times the cell cannot be told to be
    inside or outside, and is passed over.
    """
    outside = np.flatnonzero(windings_of_parts(nodes, arcs) != 1)
    return sum(_is_far(tiles[nodes.tile[k]].outline, nodes.position[k], _UNDECIDED * size) for k in outside.tolist())


def windings_of_parts(nodes: AllNodes, arcs: AllArcs) -> Ints:
    """How often outlines run counter-clockwise around the parts of their sites: intp (n,), of each part's least node.

    For all other nodes it is 1. A compiled kernel gives the same.
    """
    compiled = _COMPILED()
    count = len(nodes.position)
    if compiled is None:
        result = np.ones(count, np.intp)
        part = np.flatnonzero(components(count, *nodes.segments.T) == np.arange(count))
        result[part] = winding_numbers(arcs, nodes.position[part], nodes.tile[part])
        return result
    result = np.empty(count, np.intp)
    failed = compiled(
        *(count, nodes.position, nodes.tile, len(nodes.segments), nodes.segments),
        *(len(arcs), arcs.start, arcs.control, arcs.end, arcs.curved, arcs.tile, result),
    )
    if failed:
        raise MemoryError
    return result


def _is_far(outline: Outline, point: complex, distance: float) -> bool:
    """Whether a point is farther from an outline than a distance."""
    arc = np.arange(len(outline))
    return bool((distance_to_arcs(outline, arc, np.full(len(arc), point)) > distance).all())


def winding_numbers(arcs: AllArcs, points: Complexes, tile: Ints) -> Ints:
    """How often the outline of its tile runs counter-clockwise around each point: intp (n,).

    `points` is complex128 (n,), none on its outline; `tile` (intp, n). Arcs are looked at from the points at whose
    height they are, in the order of tiles and heights (complex numbers are sorted by their real parts first).
    """
    order = np.lexsort((points.imag, tile))
    key = tile[order] + 1j * points.imag[order]
    heights = np.array((arcs.start, arcs.control, arcs.end)).imag
    first = np.searchsorted(key, arcs.tile + 1j * heights.min(axis=0), side="left")
    last = np.searchsorted(key, arcs.tile + 1j * heights.max(axis=0), side="right")
    beside, arc = owned_ranges(first, last)
    point = points[order[beside]]
    turns = _turns(arcs.start[arc] - point, arcs.control[arc] - point, arcs.end[arc] - point, arcs.curved[arc])
    result = np.zeros(len(points), np.intp)
    np.add.at(result, order[beside], turns)
    return result


def _turns(start: Complexes, control: Complexes, end: Complexes, curved: Bools) -> Ints:
    """What arcs add to the winding numbers of their outlines around 0: 1, 0 or -1, intp (n,).

    A chord adds 1 where it crosses the positive real axis upwards. An arc does as its chord does, except that a point
    between the two is passed on the other side. The barycentric coordinates (s, t, r) of such a point in the triangle
    of start, control and end are positive, and t^2 < 4 s r: on the curve s = (1 - u)^2, t = 2 u (1 - u), r = u^2.

    What meets the point, or an end at its height, is decided as if the point were a little farther to the right and,
    less than that, farther up.
    """
    chord, across = end - start, _cross(start, end)
    side = np.where(across != 0.0, across, np.where(chord.imag != 0.0, -chord.imag, chord.real))
    rising = (start.imag <= 0.0).astype(np.intp) - (end.imag <= 0.0)
    turns = np.where(rising * side > 0.0, rising, 0)
    s, t, r = _cross(control, end), -across, _cross(start, control)
    sign = np.sign(s + t + r)
    between = curved & (s * sign > 0.0) & (r * sign > 0.0) & (side * sign < 0.0) & (t * t < 4.0 * s * r)
    turns[between] += sign[between].astype(np.intp)
    return turns


def _cross(u: Complexes, v: Complexes) -> Floats:
    """The cross products of vectors."""
    return np.asarray(u.real * v.imag - u.imag * v.real)

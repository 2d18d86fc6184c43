"""Vertices where two nearly parallel segments of one stroke hand over: put onto the bisector of their angle.

Where a stroke turns by a small angle a, its two segments hand over inside an edge, at a vertex where two arcs cross at
about that angle. Rounding leaves each arc where it is, but moves the crossing along both by eps / a. The bisector of
the two segments goes through their common node and crosses the arcs steeply: there the vertex is sharp.
"""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, next_in_ring
from voronoi_tiles.base.maps import move
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.copies import Copies

NEARLY_STRAIGHT = 1e-3
"""A stroke that turns by this, in radians, costs its vertices EPSILON / NEARLY_STRAIGHT, 2e-13 of the cell's size."""


def sharpen_handovers(
    vertex: Complexes, bounds: Ints, copy: Ints, copies: Copies, contour: Contour, item: Ints, ends: Complexes
) -> None:
    """Move the vertices of boundaries where two nearly parallel segments hand over along their arcs, in place.

    Arc k of n starts at `vertex[k]`; the arcs of ring r are those from `bounds[r]` up to, not including,
    `bounds[r + 1]`. Beyond it lies the copy `copy[k]` (intp) of `copies`. Of each arc `item` (intp, 2 x n) are the
    elements here and beyond: the half-edge i, or the corner c as h + c where there are h half-edges. `ends`
    (complex128, 2 x 2 x n) are the two ends of both where they lie, by end and by side.
    """
    half_edges = len(contour.source)
    shallow = (contour.turn[:half_edges] < 0.0) & (contour.turn[:half_edges] > -NEARLY_STRAIGHT)
    if not shallow.any():
        return
    following = next_in_ring(bounds)
    before = np.empty_like(following)
    before[following] = np.arange(len(vertex))
    stays = (ends == ends[..., before]).all(axis=0)
    reach = np.abs(vertex[following] - vertex)
    reach = np.minimum(reach, reach[before]) / 2
    step = np.zeros(len(vertex), complex)
    for side in (0, 1):
        joint = _joints(contour, item[side], item[side, before])
        found = (joint >= 0) & shallow[joint] & stays[1 - side] & (copy == copy[before])
        at = found.nonzero()[0]
        corner, here = joint[at], vertex[at]
        node, along = contour.nodes[contour.corner_node[corner]], contour.arriving[corner] + contour.leaving[corner]
        if side == 1:
            beyond = copy[at]
            node = move(node, copies.unit[beyond], copies.shift[beyond], copies.conj[beyond])
            along = move(along, copies.unit[beyond], 0j, copies.conj[beyond])
        # An arc runs at right angles to the difference of the directions away from the elements on its two sides.
        # Where there is no such difference the arc is none, and its vertex stays.
        with np.errstate(divide="ignore", invalid="ignore"):
            tangent = 1j * (_away(here, node, node + along) - _away(here, *ends[:, 1 - side, at]))
            step[at] = -tangent * _inner(here - node, along) / _inner(tangent, along)
    moved = np.abs(step) < reach
    vertex[moved] += step[moved]


def _joints(contour: Contour, one: Ints, two: Ints) -> Ints:
    """The corners between half-edges that follow each other around a face, either way; -1 between other elements."""
    following = np.append(contour.following, np.full(len(contour.corner_node), -1))
    return np.where(following[one] == two, one, np.where(following[two] == one, two, -1))


def _away(points: Complexes, first: Complexes, second: Complexes) -> Complexes:
    """The unit directions in which points leave nodes, or lines through two points, where these are not the same."""
    along = second - first
    across = _inner(points - first, 1j * along)
    direction = np.where(first == second, points - first, np.sign(across) * 1j * along)
    return np.asarray(direction / np.abs(direction))


def _inner(one: Complexes, other: Complexes) -> Floats:
    """The inner products of vectors in the plane."""
    return np.asarray(one.real * other.real + one.imag * other.imag)

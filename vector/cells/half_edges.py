"""The contour of a site: its half-edges and corners, in the order in which one walks around its strokes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints

# A corner that turns left by less than this still counts as an element of the site when other cells are bounded by
# it: the two segments' lines may miss each other by an ulp there, and the corner's point closes that gap.
_NEARLY_STRAIGHT = 1e-9


@dataclass(frozen=True, slots=True)
class Contour:
    """The half-edges and corners of a site.

    Segment k gives half-edge 2k, from its first node to its second, and half-edge 2k + 1 back. The face of a
    half-edge lies on its left. Corner c lies at the end of half-edge c, between it and the one that follows it around
    the same face. An isolated node has four corners of a right angle each, which no half-edge bounds: they stand
    behind the half-edges' corners.

    `nodes` (complex128, m) are positions. A half-edge runs from the node `source` to the node `target` (intp, h), has
    the unit vector `direction` (complex128, h) and a `length` (float64, h); `following` (intp, h) is the next one
    around the face on the left. A corner lies at the node `corner_node` (intp, c, with c >= h); `arriving` and
    `leaving` (complex128, c) are the unit vectors of the half-edges before and after it, and `turn` (float64, c) is
    the angle in (-pi, pi], in radians, by which the contour turns right there.
    """

    nodes: Complexes
    source: Ints
    target: Ints
    direction: Complexes
    length: Floats
    following: Ints
    corner_node: Ints
    arriving: Complexes
    leaving: Complexes
    turn: Floats

    def faces(self) -> Ints:
        """For each half-edge a number of the cycle that it belongs to: its walk around one face."""
        following = self.following.tolist()
        label = [-1] * len(following)
        number = 0
        for first in range(len(following)):
            if label[first] < 0:
                k = first
                while label[k] < 0:
                    label[k] = number
                    k = following[k]
                number += 1
        return np.array(label, np.intp)

    @property
    def convex(self) -> Bools:
        """(c,) whether a corner has directions of its own: a wedge at right angles or more to both neighbours."""
        return self.turn > 0.0

    @property
    def bounding(self) -> Bools:
        """(c,) whether a corner counts among the elements that bound other cells."""
        return self.turn > -_NEARLY_STRAIGHT


def trace_contour(nodes: Complexes, segments: Ints) -> Contour:
    """The contour of a site with nodes at positions, complex128 (m,), and segments between them, intp (n, 2).

    Segments meet only at common nodes.
    """
    count = len(segments)
    source = segments.reshape(-1)
    target = np.ascontiguousarray(segments[:, ::-1]).reshape(-1)
    step = nodes[target] - nodes[source]
    length = np.abs(step)
    direction = step / length
    half_edges = np.arange(2 * count)
    order = np.lexsort((np.angle(direction), source))
    place = np.empty_like(order)
    place[order] = half_edges
    degree = np.bincount(source, minlength=len(nodes))
    first = degree.cumsum() - degree
    # The next half-edge around the face on the left leaves the target next clockwise from the way back.
    back = place[half_edges ^ 1]
    at = first[target]
    following = order[at + (back - at - 1) % degree[target]]
    arriving, leaving = direction, direction[following]
    turn = np.arctan2(
        arriving.imag * leaving.real - arriving.real * leaving.imag,
        arriving.real * leaving.real + arriving.imag * leaving.imag,
    )
    turn[following == half_edges ^ 1] = np.pi
    isolated = (degree == 0).nonzero()[0]
    if len(isolated):
        axes = np.array([1, -1j, -1, 1j])
        arriving = np.concatenate((arriving, np.tile(axes, len(isolated))))
        leaving = np.concatenate((leaving, np.tile(np.roll(axes, -1), len(isolated))))
        turn = np.concatenate((turn, np.full(4 * len(isolated), np.pi / 2)))
    return Contour(
        nodes=nodes,
        source=source,
        target=target,
        direction=direction,
        length=length,
        following=following,
        corner_node=np.concatenate((target, np.repeat(isolated, 4))),
        arriving=arriving,
        leaving=leaving,
        turn=turn,
    )

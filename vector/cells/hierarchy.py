"""The elements of all sites in nested boxes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting, offsets_of
from voronoi_tiles.base.box_join import z_order
from voronoi_tiles.vector.cells.half_edges import Contour

# Children of an inner box: eight keeps the levels few.
_BRANCH = 8
# Relative slack of a box's radius, far above its rounding errors.
_SLACK = 1e-9


@dataclass(frozen=True, slots=True)
class Hierarchy:
    """The elements of all sites, where they were placed, in nested boxes: from few around each bundle to themselves.

    A box lies along the line from `start` to `end` (complex128, k) and reaches as far as `radius` (float64, k) to both
    sides; it fits a run of a smooth curve's chords, or of parallel strokes, far better than a disc. `anchor_start` and
    `anchor_end` (complex128, k) are the ends of one element in it. It holds the boxes `child[j]` up to, not including,
    `child[j + 1]` (intp, k + 1).

    The boxes stand level by level, and in each by their `bundle` (intp, k); level l are those from `level[l]` up to,
    not including, `level[l + 1]` (intp). Those of the last level are elements: `element` (intp) are their numbers,
    segments first, then isolated nodes.
    """

    start: Complexes
    end: Complexes
    radius: Floats
    anchor_start: Complexes
    anchor_end: Complexes
    bundle: Ints
    child: Ints
    level: Ints
    element: Ints


def build_hierarchy(contour: Contour, node_bundle: Ints) -> Hierarchy:
    """The hierarchy of all elements, neighbours in the plane being neighbours in the order of their bundle."""
    source, target = contour.source[::2], contour.target[::2]
    isolated = contour.corner_node[len(contour.source) :: 4]
    if len(isolated):
        source, target = np.concatenate((source, isolated)), np.concatenate((target, isolated))
    start, end, bundle = contour.nodes[source], contour.nodes[target], node_bundle[source]
    middle = (start + end) / 2
    order = z_order(middle) if len(middle) > _BRANCH else np.arange(len(middle))
    order = order[np.argsort(bundle[order], kind="stable")]
    start, end, bundle = start[order], end[order], bundle[order]
    below = np.bincount(bundle)
    first = offsets_of(below)
    levels = [(start, end, np.zeros(len(order)), start, end, bundle)]
    children: list[Ints] = [np.zeros(len(order), np.intp)]
    run = 1
    while below.max() > 1:
        run *= _BRANCH
        above = -(-below // _BRANCH)
        place, of = counting(above)
        begin = first[of] + place * run
        anchor = np.minimum(begin + run // 2, first[of + 1] - 1)
        levels.append((*_boxes(start, end, begin), start[anchor], end[anchor], of))
        children.append(offsets_of(below)[of] + place * _BRANCH)
        below = above
    levels.reverse()
    offsets = offsets_of([len(level[0]) for level in levels])
    # The children of the elements are none: they would begin behind all boxes.
    child = [one + behind for one, behind in zip(children[:0:-1], offsets[1:-1], strict=True)]
    child.append(np.full(len(order) + 1, offsets[-1]))
    start, end, radius, anchor_start, anchor_end, of = (np.concatenate(field) for field in zip(*levels, strict=True))
    return Hierarchy(start, end, radius, anchor_start, anchor_end, of, np.concatenate(child), offsets, order)


def _boxes(start: Complexes, end: Complexes, first: Ints) -> tuple[Complexes, Complexes, Floats]:
    """The ends and radii of boxes along the principal axes of runs of segments, which start at `first`."""
    count = np.diff(np.append(first, len(start)))
    middle = np.add.reduceat(start + end, first) / (2 * count)
    which = np.repeat(np.arange(len(first)), count)
    a, b = start - middle[which], end - middle[which]
    # The square of a complex number has twice its angle: the sum's half angle is the principal axis.
    moment = np.add.reduceat(a * a + b * b, first)
    axis = np.exp(0.5j * np.angle(moment))
    turned = axis.conj()[which]
    a, b = a * turned, b * turned
    low = np.minimum.reduceat(np.minimum(a.real, b.real), first)
    high = np.maximum.reduceat(np.maximum(a.real, b.real), first)
    right = np.minimum.reduceat(np.minimum(a.imag, b.imag), first)
    left = np.maximum.reduceat(np.maximum(a.imag, b.imag), first)
    across = 1j * (right + left) / 2
    radius = (left - right) / 2 * (1.0 + _SLACK) + _SLACK * (high - low)
    return middle + axis * (low + across), middle + axis * (high + across), radius

"""The elements of all sites in nested boxes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting, offsets_of
from voronoi_tiles.base.box_join import z_order
from voronoi_tiles.base.kernels import COMPLEXES, FLOATS, INT, INTS, kernel
from voronoi_tiles.vector.cells.half_edges import Contour

FEW: Final = 64
"""So many elements, or fewer, are in one box for each bundle: more levels would not pay."""
# Children of a box where there are more elements: eight keeps the levels few.
_BRANCH = 8
# Relative slack of a box's radius, far above its rounding errors.
_SLACK = 1e-9
# What the compiled kernel takes, as in hierarchy.c.
_COMPILED = kernel(
    "hierarchy_build",
    *(INT, INTS, INTS, INT, INTS, COMPLEXES, INTS, INT),
    *(COMPLEXES, COMPLEXES, FLOATS, COMPLEXES, COMPLEXES, INTS, INTS, INTS, INTS),
)


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
    """The hierarchy of all elements, neighbours in the plane being neighbours in the order of their bundle.

    `node_bundle` (intp, m) is the bundle of each of the contour's nodes. None is without elements.
    """
    half_edges, corners = len(contour.source), len(contour.corner_node)
    count = half_edges // 2 + (corners - half_edges) // 4
    compiled = _COMPILED()
    if compiled is None:
        return _build(contour, node_bundle)
    bundles, depth = int(node_bundle.max()) + 1, 1
    while _BRANCH**depth < count:
        depth += 1
    # On each level a bundle has at most one box more than its share.
    room = count + sum(count // _BRANCH**level + bundles for level in range(1, depth + 1))
    start, end, anchor_start, anchor_end = (np.empty(room, complex) for _ in range(4))
    radius, (bundle, child) = np.empty(room), np.empty((2, room + 1), np.intp)
    level, element = np.empty(depth + 2, np.intp), np.empty(count, np.intp)
    of_contour = half_edges, contour.source, contour.target, corners, contour.corner_node, contour.nodes
    boxes = start, end, radius, anchor_start, anchor_end, bundle, child
    levels = compiled(*of_contour, node_bundle, bundles, *boxes, level, element)
    if levels < 0:
        raise MemoryError
    n = int(level[levels])
    start, end, radius, anchor_start, anchor_end, bundle = (of_boxes[:n] for of_boxes in boxes[:-1])
    return Hierarchy(start, end, radius, anchor_start, anchor_end, bundle, child[: n + 1], level[: levels + 1], element)


def _build(contour: Contour, node_bundle: Ints) -> Hierarchy:
    """The same without the kernel."""
    source, target = contour.source[::2], contour.target[::2]
    isolated = contour.corner_node[len(contour.source) :: 4]
    if len(isolated):
        source, target = np.concatenate((source, isolated)), np.concatenate((target, isolated))
    start, end, bundle = contour.nodes[source], contour.nodes[target], node_bundle[source]
    order = z_order((start + end) / 2) if len(start) > _BRANCH else np.arange(len(start))
    order = order[np.argsort(bundle[order], kind="stable")]
    start, end, bundle = start[order], end[order], bundle[order]
    below = np.bincount(bundle)
    first = offsets_of(below)
    levels = [(start, end, np.zeros(len(order)), start, end, bundle)]
    children: list[Ints] = [np.zeros(len(order), np.intp)]
    run, branch = 1, _BRANCH if len(order) > FEW else FEW
    while below.max() > 1:
        run *= branch
        above = -(-below // branch)
        place, of = counting(above)
        begin = first[of] + place * run
        anchor = np.minimum(begin + run // 2, first[of + 1] - 1)
        levels.append((*_boxes(start, end, begin), start[anchor], end[anchor], of))
        children.append(offsets_of(below)[of] + place * branch)
        below = above
    levels.reverse()
    offsets = offsets_of([len(level[0]) for level in levels])
    # The children of the elements are none: they would begin behind all boxes.
    child = [one + behind for one, behind in zip(children[:0:-1], offsets[1:-1], strict=True)]
    child.append(np.full(len(order) + 1, offsets[-1]))
    start, end, radius, anchor_start, anchor_end, of = (np.concatenate(field) for field in zip(*levels, strict=True))
    return Hierarchy(start, end, radius, anchor_start, anchor_end, of, np.concatenate(child), offsets, order)


def _boxes(start: Complexes, end: Complexes, first: Ints) -> tuple[Complexes, Complexes, Floats]:
    """The ends and radii of boxes along the principal axes of runs of segments, which start at `first`.

    Sums are taken in order, by `bincount`, and the arithmetic is spelt out in real numbers, as in the compiled kernel.
    """
    count = np.diff(np.append(first, len(start)))
    which = np.repeat(np.arange(len(first)), count)
    ends = np.stack((start, end))
    x, y = ends.real, ends.imag
    middle_x, middle_y = (np.bincount(which, part[0] + part[1]) / (2 * count) for part in (x, y))
    x, y = x - middle_x[which], y - middle_y[which]
    # The square of a complex number has twice its angle: the sum's half angle is the principal axis.
    u, v = (np.bincount(which, part[0] + part[1]) for part in (x * x - y * y, 2.0 * (x * y)))
    moment = np.sqrt(u * u + v * v)
    u[moment == 0.0] = moment[moment == 0.0] = 1.0  # no direction stands out
    big = np.sqrt((1.0 + np.abs(u) / moment) / 2.0)
    small = v / (2.0 * moment * big)
    cosine = np.where(u >= 0.0, big, np.abs(small))
    sine = np.where(u >= 0.0, small, np.copysign(big, v))
    c, s = cosine[which], sine[which]
    along, left = x * c + y * s, y * c - x * s
    back, front = (reduce.reduceat(reduce.reduce(along), first) for reduce in (np.minimum, np.maximum))
    low, high = (reduce.reduceat(reduce.reduce(left), first) for reduce in (np.minimum, np.maximum))
    across = (low + high) / 2.0
    result = np.empty((2, len(first)), complex)
    for box_end, at in zip(result, (back, front), strict=True):
        box_end.real = middle_x + (cosine * at - sine * across)
        box_end.imag = middle_y + (sine * at + cosine * across)
    radius = (high - low) / 2.0 * (1.0 + _SLACK) + _SLACK * (front - back)
    return result[0], result[1], radius

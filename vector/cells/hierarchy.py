"""The elements of all sites in nested capsules, and the images of these in all copies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting, offsets_of
from voronoi_tiles.base.box_join import z_order
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.cells.images import Images
from voronoi_tiles.vector.copies import Copies

# Children of an inner capsule: eight keeps the levels few.
_BRANCH = 8
# Relative slack of a capsule's radius, far above its rounding errors.
_SLACK = 1e-9


@dataclass(frozen=True, slots=True)
class Level:
    """Capsules of all copies that together hold all elements.

    A capsule is all that is within a radius of a segment; it fits a run of a smooth curve's chords far better than a
    disc. Its segment runs from `start` to `end` (complex128, flat over the copies) and its radius is `radius` (float64,
    k); `anchor_start` and `anchor_end` (complex128, flat) are the ends of one element in it. What the capsule j has in
    the copy c stands at `images.place(c, j)`. It holds the capsules `child[j]` up to, not including, `child[j + 1]`
    (intp, k + 1) of the next level.
    """

    images: Images
    start: Complexes
    end: Complexes
    radius: Floats
    anchor_start: Complexes
    anchor_end: Complexes
    child: Ints


@dataclass(frozen=True, slots=True)
class Hierarchy:
    """The elements of all sites in nested capsules.

    `levels` go from one capsule around each bundle to the elements themselves; `order` (intp, k) is the element of each
    capsule of the last level, numbered segments first, then isolated nodes.
    """

    levels: tuple[Level, ...]
    order: Ints


def build_hierarchy(contour: Contour, copies: Copies, node_bundle: Ints) -> Hierarchy:
    """The hierarchy of all elements, neighbours in the plane being neighbours in the order of their bundle."""
    source, target = contour.source[::2], contour.target[::2]
    isolated = contour.corner_node[len(contour.source) :: 4]
    if len(isolated):
        source, target = np.concatenate((source, isolated)), np.concatenate((target, isolated))
    start, end, bundle = contour.nodes[source], contour.nodes[target], node_bundle[source]
    middle = (start + end) / 2
    order = z_order(middle) if len(middle) > _BRANCH else np.arange(len(middle))
    order = order[np.argsort(bundle[order], kind="stable")]
    start, end = start[order], end[order]
    size = np.bincount(bundle, minlength=copies.bundles)
    first = offsets_of(size)
    every = np.arange(len(order) + 1)
    levels = [
        _level(copies, np.repeat(np.arange(len(size)), size), start, end, np.zeros(len(order)), start, end, every)
    ]
    below, run = size, 1
    while below.max() > 1:
        run *= _BRANCH
        above = -(-below // _BRANCH)
        place, of = counting(above)
        begin = first[of] + place * run
        child = np.append(offsets_of(below)[of] + place * _BRANCH, below.sum())
        from_, to, radius = _capsules(start, end, begin)
        anchor = np.minimum(begin + run // 2, first[of + 1] - 1)
        levels.insert(0, _level(copies, of, from_, to, radius, start[anchor], end[anchor], child))
        below = above
    return Hierarchy(tuple(levels), order)


def _level(
    copies: Copies,
    bundle: Ints,
    start: Complexes,
    end: Complexes,
    radius: Floats,
    anchor_start: Complexes,
    anchor_end: Complexes,
    child: Ints,
) -> Level:
    """The images of capsules in all copies."""
    images = Images.of(bundle, copies)
    from_, to = images.moved(start, copies), images.moved(end, copies)
    if anchor_start is start:
        return Level(images, from_, to, radius, from_, to, child)
    anchors = images.moved(anchor_start, copies), images.moved(anchor_end, copies)
    return Level(images, from_, to, radius, *anchors, child)


def _capsules(start: Complexes, end: Complexes, first: Ints) -> tuple[Complexes, Complexes, Floats]:
    """The ends and radii of capsules along the principal axes of runs of segments, which start at `first`."""
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

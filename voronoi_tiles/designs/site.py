"""A site: the union of the strokes of one tile shape, noded into segments that meet only at shared nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, plane
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.tolerance import EPSILON, NODE_MERGE, NODE_MERGE_ULPS, STRAIGHT_ULPS
from voronoi_tiles.designs.noding import noded


@dataclass(frozen=True, eq=False, repr=False)
class NodedSite:
    """A noded union of segments and points, in the units of the design.

    `nodes` is complex128 of shape (m,), no two of them equal; `segments` is intp of shape (n, 2), the
    indices of each segment's end nodes. Two segments meet only at common nodes; none occurs twice, none has
    zero length. A node that belongs to no segment is an isolated point.
    """

    name: str
    nodes: Complexes
    segments: Ints

    def __repr__(self) -> str:
        return f"<NodedSite {self.name!r}: {len(self.nodes)} nodes, {len(self.segments)} segments>"

    def __post_init__(self) -> None:
        # Tiles are computed from these: they stay as they were checked.
        self.nodes.setflags(write=False)
        self.segments.setflags(write=False)

    @cached_property
    def isolated(self) -> Ints:
        """The indices of the nodes that belong to no segment, ascending; shape (k,)."""
        used = np.zeros(len(self.nodes), dtype=bool)
        used[self.segments.ravel()] = True
        return np.flatnonzero(~used)

    @cached_property
    def ends(self) -> Complexes:
        """The ends of the elements, complex128 of shape (k, 2): segments, then isolated points (both ends equal)."""
        ends = self.nodes.take(np.concatenate([self.segments, np.stack([self.isolated] * 2, axis=1)]))
        ends.setflags(write=False)
        return ends

    @cached_property
    def elements(self) -> Floats:
        """The elements x0, y0, x1, y1, float64 of shape (k, 4), in the order of `ends`."""
        elements = plane(self.ends).reshape(-1, 4)
        elements.setflags(write=False)
        return elements

    @property
    def extent(self) -> float:
        """The larger side of the bounding box; 0 for a single point."""
        return _extent(self.nodes)


def build_site(name: str, polylines: Sequence[Complexes]) -> NodedSite:
    """Node the strokes of a site: crossings, T-junctions, overlaps, repeated strokes, points on segments.

    `polylines` are complex128 arrays of finite points; one of length 1 is a point. Nodes nearer than
    NODE_MERGE of the site's extent become one, and a segment that passes a node as near runs through it;
    nothing else moves, except that crossings are rounded. Joints on a straight line are left out. The
    result is verified: it is a set of segments among which the search for contacts finds none. Raises
    DesignError where there is no stroke, where strokes overlap too often to be worth noding, and where they
    run so close that no noding at this precision separates them.
    """
    if not any(len(line) for line in polylines):
        raise DesignError(f'site "{name}" has no stroke', key="strokes", remedy="Give it at least one stroke.")
    if len(polylines) == 1 and len(polylines[0]) == 2 and polylines[0][0] != polylines[0][1]:
        return NodedSite(name, np.array(polylines[0], dtype=np.complex128), np.array([[0, 1]], dtype=np.intp))

    points = np.concatenate([np.asarray(line, dtype=np.complex128) for line in polylines])
    sizes = np.array([len(line) for line in polylines])
    first = np.arange(len(points))
    last_of_line = np.zeros(len(points), dtype=bool)
    last_of_line[np.cumsum(sizes[sizes > 0]) - 1] = True
    # A point is a segment from its node to itself.
    second = np.where(last_of_line, first, first + 1)
    keep = ~last_of_line
    keep[np.flatnonzero(last_of_line)[sizes[sizes > 0] == 1]] = True
    segments = np.stack([first[keep], second[keep]], axis=1)

    extent = _extent(points)
    near = merging(points)
    if extent == 0.0:
        return NodedSite(name, points[:1].copy(), np.empty((0, 2), dtype=np.intp))
    if extent <= near:
        raise DesignError(
            "the strokes are no larger than the rounding of their coordinates",
            key="strokes",
            remedy="Draw them larger, or nearer to the origin.",
        )

    return _compact(name, *noded(points, segments, near, STRAIGHT_ULPS * EPSILON * extent))


def merging(points: Complexes) -> float:
    """How near to each other points of a site's strokes are one, in units; complex128 (n,)."""
    largest = float(max(abs(points.real).max(), abs(points.imag).max()))
    return max(NODE_MERGE * _extent(points), NODE_MERGE_ULPS * EPSILON * largest)


def _extent(z: Complexes) -> float:
    x, y = z.real, z.imag
    return float(max(x.max() - x.min(), y.max() - y.min()))


def _compact(name: str, nodes: Complexes, segments: Ints) -> NodedSite:
    """The site of these nodes and segments (points are segments from a node to itself), without unused nodes."""
    used = np.zeros(len(nodes), dtype=bool)
    used[segments.ravel()] = True
    index = np.cumsum(used) - 1
    real = segments[:, 0] != segments[:, 1]
    return NodedSite(name, nodes[used], index[segments[real]])

"""The rows of a site: pencils of rays from its half-edges, to their left, and from its convex corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, counting
from voronoi_tiles.vector.cells.half_edges import Contour

# A corner's rows span at most this angle, and a half-edge's rows at most this part of the covering radius: within
# narrow rows one bound on the height holds well.
_WIDEST_FAN = np.pi / 2
_LONGEST_PART = 1.0


@dataclass(frozen=True, slots=True)
class Rows:
    """The frames of the elements' Voronoi cells: a row is a pencil of rays, with one variable x in [low, high].

    The rays of a half-edge's rows are parallel: the point at x and height h is origin + (x + i h) axis, with the
    half-edge's direction as axis. Those of a corner's rows fan out over its wedge: the point at x and distance r is
    origin + r axis (1 + i x)^2 / (1 + x^2), with the wedge's middle as axis; x is the tangent of half the angle
    from it.

    `half_edge` and `corner` (intp, n) are the index of the element, -1 where it is of the other kind. `origin` and
    `axis` (complex128, n), `low` and `high` (float64, n) are as above. The first ray of a row starts at `base0` in the
    direction of the unit vector `ray0`, the last one at `base1` along `ray1`, one between them at `base` along `ray`
    (complex128, n). The rays' origins are within `spread` (float64, n) of that one's along the half-edge; in a corner
    this is 0.
    """

    half_edge: Ints
    corner: Ints
    origin: Complexes
    axis: Complexes
    low: Floats
    high: Floats
    base0: Complexes
    ray0: Complexes
    base1: Complexes
    ray1: Complexes
    base: Complexes
    ray: Complexes
    spread: Floats

    def __len__(self) -> int:
        return len(self.half_edge)

    @property
    def straight(self) -> Bools:
        """Whether each row belongs to a half-edge, bool (n,)."""
        return self.corner < 0

    def slice(self, start: int, stop: int) -> Rows:
        """The rows from start to stop."""
        return Rows(*(getattr(self, name)[start:stop] for name in self.__slots__))


def make_rows(contour: Contour, covering_radius: float, without: Bools) -> Rows:
    """The rows of a contour: those of half-edges in order, then those of convex corners in order.

    Long half-edges (as measured by the lattice's covering radius) and wide corners have several rows, by ascending x.
    Half-edges `without` (bool, h) get no rows, nor do the corners at their ends.
    """
    wanted = (~without).nonzero()[0]
    half_edge, part, parts = _divide(contour.length[wanted] / (_LONGEST_PART * covering_radius))
    half_edge = wanted[half_edge]
    start, end = contour.nodes[contour.source[half_edge]], contour.nodes[contour.target[half_edge]]
    along, length = contour.direction[half_edge], contour.length[half_edge]
    low, high = length * (part / parts), length * ((part + 1) / parts)
    normal = 1j * along
    kept = contour.convex
    kept[: len(without)] &= ~without
    convex = kept.nonzero()[0]
    corner, part, parts_of_corner = _divide(contour.turn[convex] / _WIDEST_FAN)
    corner = convex[corner]
    turn, point = contour.turn[corner], contour.nodes[contour.corner_node[corner]]
    before, after = contour.arriving[corner], contour.leaving[corner]
    # Each formula for the middle of the wedge loses its digits where the other one is good.
    axis = np.where(turn < np.pi / 2, 1j * (before + after), before - after)
    axis /= np.abs(axis)
    low_x, high_x = np.tan(turn / 2 * np.array((part / parts_of_corner, (part + 1) / parts_of_corner)) - turn / 4)
    count = len(half_edge) + len(corner)
    rows = Rows(
        half_edge=np.full(count, -1),
        corner=np.full(count, -1),
        origin=np.empty(count, complex),
        axis=np.empty(count, complex),
        low=np.empty(count),
        high=np.empty(count),
        base0=np.empty(count, complex),
        ray0=np.empty(count, complex),
        base1=np.empty(count, complex),
        ray1=np.empty(count, complex),
        base=np.empty(count, complex),
        ray=np.empty(count, complex),
        spread=np.zeros(count),
    )
    straight, fan = slice(len(half_edge)), slice(len(half_edge), count)
    rows.half_edge[straight], rows.corner[fan] = half_edge, corner
    rows.origin[straight], rows.origin[fan] = start, point
    rows.axis[straight], rows.axis[fan] = along, axis
    rows.low[straight], rows.low[fan] = low, low_x
    rows.high[straight], rows.high[fan] = high, high_x
    rows.base0[straight], rows.ray0[straight] = start + low * along, normal
    rows.base1[straight], rows.ray1[straight] = np.where(high == length, end, start + high * along), normal
    rows.base[straight], rows.ray[straight] = start + (low + high) / 2 * along, normal
    rows.base0[fan] = rows.base1[fan] = rows.base[fan] = point
    rows.ray0[fan], rows.ray1[fan], rows.ray[fan] = _ray(axis, np.array((low_x, high_x, (low_x + high_x) / 2)))
    rows.spread[straight] = (high - low) / 2
    return rows


def _divide(size: Floats) -> tuple[Ints, Ints, Floats]:
    """The parts, of size at most 1, of things of these sizes: the thing, the part's number, the count of its parts."""
    if size.max(initial=0.0) <= 1.0:
        return np.arange(len(size)), np.zeros(len(size), np.intp), np.ones(len(size))
    parts = np.maximum(np.ceil(size), 1.0)
    part, thing = counting(parts.astype(np.intp))
    return thing, part, parts[thing]


def _ray(axis: Complexes, x: Floats) -> Complexes:
    """The unit directions at x from the axes."""
    return axis * ((1.0 - x) * (1.0 + x) + 2j * x) / (1.0 + x * x)

"""A drawing as points of a square grid, and how far these are from those of its images, wherever an image is moved."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, counting, plane
from voronoi_tiles.base.maps import move
from voronoi_tiles.designs.site import NodedSite

_PIXELS: Final = 96
"""Along the drawing's diameter; a count. Distances are right to one or two of them."""

REACH: Final = 0.3
"""Distances are known up to this; relative to the diameter."""

_NEIGHBOURS: Final = 1.5
"""How far points of one part of a drawing are from the next ones, at most; pixels."""

_FAST: Final = sorted(2**i * 3**j for i in range(10) for j in range(6))
"""Sides of pictures whose Fourier transforms are fast; pixels."""


@dataclass(frozen=True, eq=False)
class Silhouette:
    """Strokes as points of a square grid.

    `points` (complex128, n) are their lines and what these enclose, about the middle of the bounding box, `middle`, in
    steps of `pixel`; `diameter` is the longer side of the box. `bridged` are these and the discs over the shortest
    bridges between the parts of the drawing: a tile is in one part where no copy comes into these.
    """

    points: Complexes
    bridged: Complexes
    middle: complex
    pixel: float
    diameter: float

    @classmethod
    def of(cls, sites: Sequence[NodedSite]) -> Silhouette:
        """The drawing of some sites."""
        ends = np.concatenate([site.ends for site in sites])
        x, y = ends.real, ends.imag
        middle = complex(x.min() + x.max(), y.min() + y.max()) / 2.0
        diameter = float(max(np.ptp(x), np.ptp(y))) or 1.0  # a single point is as good anywhere
        pixel = diameter / _PIXELS
        lines = _snapped(_samples(ends - middle, pixel), pixel)
        faces = [shapely.polygonize(shapely.linestrings(plane(site.nodes[site.segments] - middle))) for site in sites]
        points = np.unique(np.concatenate([lines, *(_inside(face, pixel) for face in faces)]))
        # A bridge is nearer to its own ends than to anything outside the disc over it.
        bridges = long_bridges(np.rint(points.real / pixel) + 1j * np.rint(points.imag / pixel)) * pixel
        middles, radii = bridges.mean(axis=1), np.abs(bridges[:, 1] - bridges[:, 0]) / 2.0
        discs = shapely.buffer(shapely.points(plane(middles)), radii)
        bridged = np.unique(np.concatenate([points, *(_inside(disc, pixel) for disc in discs)]))
        return cls(points, bridged, middle, pixel, diameter)

    def distances(self, parts: Iterable[tuple[complex, bool]]) -> dict[tuple[complex, bool], Floats]:
        """For each linear part the distances of the drawing from its image moved by v, (column, row) from the middle.

        float64 (m, m), m odd; what is farther than REACH is cut off there.
        """
        # Of pixels; of images too, as they are turned.
        half = math.ceil(float(np.abs(self.bridged).max()) / self.pixel) + 1
        whole = 4 * half + 1
        side = next(side for side in _FAST if side >= whole)

        def waves(points: Complexes) -> Complexes:
            picture = np.zeros((side, side))
            cells = np.rint(plane(points / self.pixel)).astype(np.intp) + half
            picture[cells[:, 1], cells[:, 0]] = 1.0
            return np.fft.rfft2(picture)

        own, bridged = waves(self.points), waves(self.bridged)
        found = {}
        for factor, conj in parts:
            image, image_bridged = (
                waves(_snapped(-move(points, factor, 0j, conj), self.pixel)) for points in (self.points, self.bridged)
            )
            pairs = np.fft.irfft2(bridged * image + own * image_bridged, (side, side))[:whole, :whole]
            distance = distances_to(pairs > 0.5) * self.pixel  # whole, but for rounding
            found[factor, conj] = np.minimum(distance, REACH * self.diameter)
        return found


def distances_to(marked: Bools) -> Floats:
    """The distances of all pixels, and of a rim about them, to the nearest that is marked, up to REACH; in pixels.

    That of scipy.ndimage is the same; its import takes longer than all else that is done here.
    """
    most = math.ceil(REACH * _PIXELS)
    squares = np.pad(np.where(marked, 0, most**2), most + 1, constant_values=most**2).astype(np.int16)
    for _ in range(2):  # along columns, then along rows
        found = squares.copy()
        for step in range(1, most):
            np.minimum(found[step:], squares[:-step] + step**2, out=found[step:])
            np.minimum(found[:-step], squares[step:] + step**2, out=found[:-step])
        squares = found.T.copy()
    return np.sqrt(squares, dtype=np.float64)


def _samples(ends: Complexes, step: float) -> Complexes:
    """Points along segments (n, 2), no farther apart than a step."""
    counts = np.ceil(np.abs(ends[:, 1] - ends[:, 0]) / step).astype(np.intp) + 1
    number, row = counting(counts)
    along = number / np.maximum(counts - 1, 1)[row]
    points: Complexes = ends[row, 0] + along * (ends[row, 1] - ends[row, 0])
    return points


def _snapped(points: Complexes, step: float) -> Complexes:
    """The points of the grid that are nearest to some points."""
    grid: Complexes = np.unique(np.rint(points.real / step) + 1j * np.rint(points.imag / step)) * step
    return grid


def long_bridges(points: Complexes) -> Complexes:
    """The sides (n, 2) of the shortest tree that joins points in ascending order, those longer than between neighbours.

    The points are whole numbers: of others GEOS 3.14.1 makes triangles that are none of Delaunay's, at times. Importing
    scipy takes longer than this.
    """
    if len(points) < 3 or np.linalg.matrix_rank(plane(points - points[0])) < 2:
        sides = np.stack((points[:-1], points[1:]), axis=1)  # on a line, in their order
        return sides[np.abs(sides[:, 1] - sides[:, 0]) > _NEIGHBOURS]
    triangles = shapely.delaunay_triangles(shapely.multipoints(plane(points)), only_edges=True)
    x, y = shapely.get_coordinates(triangles).T
    ends = np.searchsorted(points, (x + 1j * y).reshape(-1, 2))
    lengths = np.abs(points[ends[:, 1]] - points[ends[:, 0]])
    part = _parts(ends[lengths <= _NEIGHBOURS], len(points))
    ends, lengths = (listed[part[ends[:, 0]] != part[ends[:, 1]]] for listed in (ends, lengths))
    bridges = []
    for one, other in ends[lengths.argsort(kind="stable")].tolist():
        if part[one] != part[other]:
            part[part == part[one]] = part[other]
            bridges.append((one, other))
    return points[np.array(bridges, np.intp).reshape(-1, 2)]


def _parts(sides: Ints, count: int) -> Ints:
    """The parts into which sides (n, 2) join points: for each point the first one of its part."""
    part = np.arange(count)
    while True:
        before = part.copy()
        np.minimum.at(part, sides[:, 0], before[sides[:, 1]])
        np.minimum.at(part, sides[:, 1], before[sides[:, 0]])
        part = part[part]
        if (part == before).all():
            return part


def _inside(area: shapely.Geometry, step: float) -> Complexes:
    """The points of the grid in areas, single ones or a collection of them."""
    if area.is_empty:
        return np.empty(0, np.complex128)
    whole = shapely.union_all(shapely.get_parts(area))
    shapely.prepare(whole)
    left, bottom, right, top = (round(bound / step) for bound in whole.bounds)
    x, y = np.meshgrid(np.arange(left, right + 1) * step, np.arange(bottom, top + 1) * step)
    inside = shapely.contains_xy(whole, x.ravel(), y.ravel())
    found: Complexes = x.ravel()[inside] + 1j * y.ravel()[inside]
    return found

"""A cell and a place in it for given strokes, so that all copies keep well apart.

How near a drawing S comes to its image A S + v, A one of the group's linear parts, depends on v alone: it is the
distance of v from the set {s - A s'}, the Minkowski sum of S and -A S. So one picture of distances for each linear
part, made once, answers for all cells and all places. The cell is the smallest, among some shapes that the group
allows, in which some place keeps the copies a share of the drawing's diameter apart; the place is the one that keeps
them farthest apart.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
import shapely
from scipy import ndimage, sparse, spatial

from voronoi_tiles.base.arrays import Complexes, Floats, counting, plane
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Isometry, move
from voronoi_tiles.base.tolerance import CELL_MIN
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup

CLEARANCE: Final = 0.12
"""How far apart copies are to be; relative to the drawing's diameter. Less leaves thin necks, more makes tiles rounder
than the drawing."""

_PIXELS: Final = 96
"""Along the drawing's diameter; a count. Distances are right to one or two of them."""

_REACH: Final = 0.3
"""Distances are known up to this; relative to the diameter."""

_PLACES: Final = 48
"""Places that are tried along each side of the cell; a count."""

_RATIOS: Final = tuple(2.0 ** (k / 3.0) for k in sorted(range(-9, 10), key=abs))
_ANGLES: Final = (90.0, 80.0, 100.0, 70.0, 110.0, 60.0, 120.0)
"""Shapes of cells that are tried, the plainest first: b over a, and degrees from a to b."""

_GAIN: Final = 0.97
"""A less plain shape is taken where its area is less than this share of the best one's."""

_STEP: Final = 1.02
"""How exactly the size of the cell is found; a factor."""


class Place(NamedTuple):
    """A cell, as a design has it, and the vector by which the strokes are moved into it."""

    cell: dict[str, float]
    translate: complex


def find_place(sites: Sequence[NodedSite], group: WallpaperGroup) -> Place:
    """A cell of a group and a place in it for sites, which stay as they lie to each other; numbers are short.

    Raises DesignError for what is smaller than the smallest cell.
    """
    drawing = _Silhouette.of(sites)
    if drawing.diameter < CELL_MIN:
        raise DesignError(f"the strokes are smaller than {CELL_MIN:g} together", remedy="Draw them larger.")
    upright = group.lattice(1.0, 1.0, 90.0)
    parts = {(unit, conj) for unit, _, conj in map(upright.isometry, group.operations)}
    search = _CellSearch(drawing, group, {part: drawing.distances(*part) for part in parts})
    cell = search.smallest_cell()
    step = 10.0 ** (math.floor(math.log10(drawing.diameter / 2.0)) - 2)
    rounded = {
        name: side if name == "angle" else round(math.ceil(side / step) * step, 12) for name, side in cell.items()
    }
    place = search.best_place(rounded)
    return Place(rounded, complex(_short(place.real, step), _short(place.imag, step)))


def _short(value: float, step: float) -> float:
    """A number rounded to a multiple of a power of ten."""
    return round(round(value / step) * step, 12) + 0.0


@dataclass(frozen=True, eq=False)
class _Silhouette:
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
    def of(cls, sites: Sequence[NodedSite]) -> _Silhouette:
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
        bridges = _bridges(points, 1.5 * pixel)
        middles, radii = bridges.mean(axis=1), np.abs(bridges[:, 1] - bridges[:, 0]) / 2.0
        discs = shapely.buffer(shapely.points(plane(middles)), radii)
        bridged = np.unique(np.concatenate([points, *(_inside(disc, pixel) for disc in discs)]))
        return cls(points, bridged, middle, pixel, diameter)

    def distances(self, factor: complex, conj: bool) -> Floats:
        """The distances of the drawing from its image moved by v, which is (column, row) pixels from the middle.

        float64 (m, m), m odd; what is farther than _REACH is cut off there.
        """
        own, bridged = self._picture(self.points), self._picture(self.bridged)
        image, image_bridged = (
            self._picture(_snapped(-move(points, factor, 0j, conj), self.pixel))
            for points in (self.points, self.bridged)
        )
        pairs = _convolved(bridged, image) + _convolved(own, image_bridged)
        field = np.pad(pairs < 0.5, math.ceil(_REACH * _PIXELS) + 1, constant_values=True)  # whole, but for rounding
        distance: Floats = ndimage.distance_transform_edt(field) * self.pixel
        return np.minimum(distance, _REACH * self.diameter)

    def _picture(self, points: Complexes) -> Floats:
        """Points as a picture whose middle is the origin."""
        half = _PIXELS
        picture = np.zeros((2 * half + 1, 2 * half + 1))
        cells = np.rint(plane(points / self.pixel)).astype(np.intp) + half
        picture[cells[:, 1], cells[:, 0]] = 1.0
        return picture


def _convolved(one: Floats, other: Floats) -> Floats:
    """The convolution of two pictures, as large as both together.

    That of scipy.signal is the same; its import takes longer than all else that is done here.
    """
    shape = [a + b - 1 for a, b in zip(one.shape, other.shape, strict=True)]
    fast = [2 ** math.ceil(math.log2(side)) for side in shape]
    product = np.fft.irfft2(np.fft.rfft2(one, fast) * np.fft.rfft2(other, fast), fast)
    return product[: shape[0], : shape[1]]


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


def _bridges(points: Complexes, least: float) -> Complexes:
    """The sides (n, 2) of the shortest tree that joins points, those longer than a length."""
    spread = plane(points - points[0])
    if len(points) < 3 or np.linalg.matrix_rank(spread, tol=1e-9 * float(np.abs(spread).max())) < 2:
        joined = np.stack((points[:-1], points[1:]), axis=1)  # on a line, in their order
    else:
        corners = spatial.Delaunay(spread).simplices
        sides = np.unique(np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])), axis=0)
        lengths = np.abs(points[sides[:, 0]] - points[sides[:, 1]])
        graph = sparse.coo_array((lengths, sides.T), shape=(len(points), len(points)))
        tree = sparse.csgraph.minimum_spanning_tree(graph.tocsr()).tocoo()
        joined = np.stack((points[tree.row], points[tree.col]), axis=1)
    long: Complexes = joined[np.abs(joined[:, 1] - joined[:, 0]) > least]
    return long


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


class _CellSearch(NamedTuple):
    """The search for a cell and a place; `fields` are the pictures of distances by linear parts."""

    drawing: _Silhouette
    group: WallpaperGroup
    fields: dict[tuple[complex, bool], Floats]

    def smallest_cell(self) -> dict[str, float]:
        """The cell with the least area of all shapes that are tried."""
        best: dict[str, float] | None = None
        area = math.inf
        for shape in self._shapes():
            # Bisected by the factor of the lengths: too small, and large enough.
            large = self.drawing.diameter if best is None else math.sqrt(_GAIN * area / self._lattice(shape, 1.0).det)
            if best is None:
                while not self._fits(shape, large):
                    large *= 1.5
                small = large / 1.5 if large > self.drawing.diameter else 0.2 * large
            elif self._fits(shape, large):
                small = 0.6 * large
            else:
                continue
            while large > _STEP * small:
                middle = math.sqrt(small * large)
                small, large = (small, middle) if self._fits(shape, middle) else (middle, large)
            best = self._cell(shape, large)
            area = self._lattice(shape, large).det
        assert best is not None
        return best

    def _shapes(self) -> Iterator[tuple[float, float]]:
        """The shapes of cells that are tried: b over a, and the angle."""
        for ratio in (1.0,) if self.group.fixes_b else _RATIOS:
            for angle in _ANGLES if self.group.fixed_angle is None else (self.group.fixed_angle,):
                yield ratio, angle

    def _cell(self, shape: tuple[float, float], size: float) -> dict[str, float]:
        """The cell of a shape, as a design has it; `size` squared is a b."""
        ratio, angle = shape
        cell = {"a": size / math.sqrt(ratio), "b": size * math.sqrt(ratio), "angle": angle}
        free = (
            ("a",) if self.group.fixes_b else ("a", "b") if self.group.fixed_angle is not None else ("a", "b", "angle")
        )
        return {name: cell[name] for name in free}

    def _lattice(self, shape: tuple[float, float], size: float) -> Lattice:
        return self._lattice_of(self._cell(shape, size))

    def _lattice_of(self, cell: dict[str, float]) -> Lattice:
        return self.group.lattice(cell["a"], cell.get("b"), cell.get("angle"))

    def _fits(self, shape: tuple[float, float], size: float) -> bool:
        """Whether some place in a cell keeps the copies apart."""
        lattice = self._lattice(shape, size)
        goal = CLEARANCE * self.drawing.diameter
        return bool(self._clearance(lattice, self._places(lattice), goal).max() >= goal)

    def _places(self, lattice: Lattice) -> Complexes:
        """Places all over a cell; along directions in which nothing changes, one."""
        sides = []
        for side in (lattice.a, lattice.b):
            moves = max(abs(Isometry(factor, 0j, conj)(side) - side) for factor, conj in self.fields)
            sides.append(np.arange(_PLACES) / _PLACES if moves > 1e-9 * abs(side) else np.array([0.5]))
        x, y = np.meshgrid(*sides)
        places: Complexes = (x * lattice.a + y * lattice.b).ravel()
        return places

    def _clearance(self, lattice: Lattice, places: Complexes, goal: float = 0.0) -> Floats:
        """The least distance between copies, for the middle of the drawing at each of some places.

        A place is given up, its distance being too large, as soon as it is nearer than the goal.
        """
        basis = lattice.reduced
        steps = self._steps(basis, math.hypot(*(2.0 + _REACH,) * 2) * self.drawing.diameter)
        least = np.full(len(places), np.inf)
        left = np.arange(len(places))
        for number, operation in enumerate(self.group.operations):
            factor, shift, conj = lattice.isometry(operation)
            apart = move(places[left], factor, shift, conj) - places[left]
            x, y = basis.fractional(apart)
            apart = apart - (np.rint(x) * basis.a + np.rint(y) * basis.b)
            # The identity moves nothing, and is no copy.
            for step in steps[1:] if number == 0 else steps:
                least[left] = np.minimum(least[left], self._looked_up((factor, conj), apart + step))
                near = least[left] < goal
                if near.any():
                    left, apart = left[~near], apart[~near]
            if not len(left):
                break
        return least

    def _steps(self, basis: Lattice, reach: float) -> list[complex]:
        """The translations that bring copies near, the zero first."""
        far = reach + (abs(basis.a) + abs(basis.b)) / 2.0
        height = basis.det / abs(basis.b)
        rows, columns = math.ceil(far / height), math.ceil(far / (basis.det / abs(basis.a)))
        steps = [i * basis.a + j * basis.b for i in range(-rows, rows + 1) for j in range(-columns, columns + 1)]
        return sorted((step for step in steps if abs(step) <= far), key=abs)

    def _looked_up(self, part: tuple[complex, bool], vectors: Complexes) -> Floats:
        """The distances of the drawing from its images moved by vectors."""
        field = self.fields[part]
        half = len(field) // 2
        cells = np.rint(plane(vectors) * (1.0 / self.drawing.pixel)).astype(np.intp) + half
        np.clip(cells, 0, 2 * half, out=cells)
        return field[cells[:, 1], cells[:, 0]]

    def best_place(self, cell: dict[str, float]) -> complex:
        """By what the strokes are moved to keep farthest apart from their copies."""
        lattice = self._lattice_of(cell)
        places = self._places(lattice)
        free = [len(set(values)) > 1 for values in lattice.fractional(places)]
        spread = max(abs(lattice.a), abs(lattice.b)) / _PLACES
        best = places[self._clearance(lattice, places).argmax()]
        while spread > self.drawing.pixel / 4.0:
            grid = np.arange(-4, 5) / 4.0 * spread
            x, y = np.meshgrid(*(side if moves else [0.0] for side, moves in zip((grid, grid), free, strict=True)))
            near = best + (x + 1j * y).ravel()
            best = near[self._clearance(lattice, near).argmax()]
            spread /= 2.0
        across, up = lattice.fractional(complex(best))
        inside = lattice.cartesian(across - math.floor(across), up - math.floor(up))
        return inside - self.drawing.middle

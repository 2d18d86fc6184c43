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
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Isometry, move
from voronoi_tiles.base.tolerance import CELL_MIN
from voronoi_tiles.designs.silhouette import REACH, Silhouette
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup

CLEARANCE: Final = 0.12
"""How far apart copies are to be; relative to the drawing's diameter. Less leaves thin necks, more makes tiles rounder
than the drawing."""

_PLACES: Final = 48
"""Places that are tried along each side of the cell; a count."""

_RATIOS: Final = tuple(2.0 ** (k / 3.0) for k in sorted(range(-9, 10), key=abs))
_ANGLES: Final = (90.0, 80.0, 100.0, 70.0, 110.0, 60.0, 120.0)
"""Shapes of cells that are tried, the plainest first: b over a, and degrees from a to b."""

_GAIN: Final = 0.97
"""A less plain shape is taken where its area is less than this share of the best one's."""

_STEP: Final = 1.02
"""How exactly the size of the cell is found; a factor."""

_BATCH: Final = 1 << 13
"""Places times translations that are looked up at once; a count. With more, many are of places given up already."""


class Place(NamedTuple):
    """A cell, as a design has it, and the vector by which the strokes are moved into it."""

    cell: dict[str, float]
    translate: complex


def find_place(sites: Sequence[NodedSite], group: WallpaperGroup) -> Place:
    """A cell of a group and a place in it for sites, which stay as they lie to each other; numbers are short.

    Raises DesignError for what is smaller than the smallest cell.
    """
    drawing = Silhouette.of(sites)
    if drawing.diameter < CELL_MIN:
        raise DesignError(f"the strokes are smaller than {CELL_MIN:g} together", remedy="Draw them larger.")
    upright = group.lattice(1.0, 1.0, 90.0)
    parts = {(unit, conj) for unit, _, conj in map(upright.isometry, group.operations)}
    search = _CellSearch(drawing, group, drawing.distances(parts))
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


class _CellSearch(NamedTuple):
    """The search for a cell and a place; `fields` are the pictures of distances by linear parts."""

    drawing: Silhouette
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
        steps = self._steps(basis)
        least = np.full(len(places), REACH * self.drawing.diameter)
        left = np.arange(len(places))
        for number, operation in enumerate(self.group.operations):
            factor, shift, conj = lattice.isometry(operation)
            apart = move(places[left], factor, shift, conj) - places[left]
            x, y = basis.fractional(apart)
            apart = apart - (np.rint(x) * basis.a + np.rint(y) * basis.b)
            # The identity moves nothing, and is no copy.
            first = 1 if number == 0 else 0
            while first < len(steps) and len(left):
                last = first + max(_BATCH // len(left), 1)
                distances = self._looked_up((factor, conj), apart + steps[first:last, None]).min(axis=0)
                least[left] = np.minimum(least[left], distances)
                kept = least[left] >= goal
                left, apart, first = left[kept], apart[kept], last
        return least

    def _steps(self, basis: Lattice) -> Complexes:
        """The translations that bring copies within the pictures of distances, the zero first."""
        reach = max(len(field) for field in self.fields.values()) * self.drawing.pixel / math.sqrt(2.0)
        far = reach + (abs(basis.a) + abs(basis.b)) / 2.0
        height = basis.det / abs(basis.b)
        rows, columns = math.ceil(far / height), math.ceil(far / (basis.det / abs(basis.a)))
        i, j = np.meshgrid(np.arange(-rows, rows + 1), np.arange(-columns, columns + 1))
        steps = (i * basis.a + j * basis.b).ravel()
        length = np.abs(steps)
        order = np.argsort(length, kind="stable")
        found: Complexes = steps[order[: np.count_nonzero(length <= far)]]
        return found

    def _looked_up(self, part: tuple[complex, bool], vectors: Complexes) -> Floats:
        """The distances of the drawing from its images moved by vectors."""
        field = self.fields[part]
        half = len(field) // 2
        column, row = (
            np.minimum(np.maximum(np.rint(side * (1.0 / self.drawing.pixel)), -half), half).astype(np.intp)
            for side in (vectors.real, vectors.imag)
        )
        found: Floats = field.ravel()[(row + half) * len(field) + column + half]
        return found

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

"""The outline of a tile: rings of line segments and parabolic arcs, held as arrays.

Area, perimeter and bounds are closed forms; only `flatten` and `to_shapely` approximate, and take an accuracy.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import fsum
from typing import TYPE_CHECKING, Any, Final, assert_never

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.text import counted
from voronoi_tiles.base.values import is_number, shown
from voronoi_tiles.paths.conversion import chord_counts, chords
from voronoi_tiles.paths.paths import LINE, QUAD, Paths
from voronoi_tiles.vector.arcs import Arc, LineArc, Neighbour, ParabolaArc

if TYPE_CHECKING:
    from shapely import MultiPolygon, Polygon


DISPLAY_SHARE: Final = 1e-4
"""How far the chords of `__geo_interface__` and of pictures are from an outline; relative to its larger side."""

_SPLITTER = 134217729.0  # 2**27 + 1 cuts a float64 into two halves of 26 bits (Dekker 1971)


@dataclass(frozen=True, eq=False)
class Outline:
    """The boundary of one tile: n arcs in r rings, every ring closed bit for bit.

    `start`, `control`, `end`, `focus` are complex128 (n,), `directrix` complex128 (n, 2), in the design's units;
    where `curved` (bool, n) is False, the control point is the midpoint and focus and directrix are 0. `neighbour`
    (intp, n) indexes `neighbours`. The arcs of ring k are those from `ring_offsets[k]` up to, not including,
    `ring_offsets[k + 1]` (intp, r + 1). Outer rings run counter-clockwise and come first, holes run clockwise. The
    arrays can only be read.
    """

    start: Complexes
    control: Complexes
    end: Complexes
    curved: NDArray[np.bool_]
    focus: Complexes
    directrix: Complexes
    neighbour: NDArray[np.intp]
    neighbours: tuple[Neighbour, ...]
    ring_offsets: NDArray[np.intp]

    def __post_init__(self) -> None:
        # What was proved stays as it is.
        for name in ("start", "control", "end", "curved", "focus", "directrix", "neighbour", "ring_offsets"):
            getattr(self, name).setflags(write=False)

    @classmethod
    def from_rings(cls, rings: Iterable[Iterable[Arc]]) -> Outline:
        """The outline of given rings; outer rings counter-clockwise and first, holes clockwise."""
        offsets = [0]
        rows: list[tuple[complex, complex, complex, bool, complex, tuple[complex, complex]]] = []
        neighbour: list[int] = []
        index_of: dict[Neighbour, int] = {}
        for ring in rings:
            for arc in ring:
                match arc:
                    case LineArc(start, end):
                        rows.append((start, (start + end) / 2, end, False, 0j, (0j, 0j)))
                    case ParabolaArc(start, control, end, focus, directrix):
                        rows.append((start, control, end, True, focus, directrix))
                    case _:
                        assert_never(arc)
                neighbour.append(index_of.setdefault(arc.neighbour, len(index_of)))
            offsets.append(len(rows))
        return cls(
            start=np.array([row[0] for row in rows], dtype=np.complex128),
            control=np.array([row[1] for row in rows], dtype=np.complex128),
            end=np.array([row[2] for row in rows], dtype=np.complex128),
            curved=np.array([row[3] for row in rows], dtype=np.bool_),
            focus=np.array([row[4] for row in rows], dtype=np.complex128),
            directrix=np.array([row[5] for row in rows], dtype=np.complex128).reshape(-1, 2),
            neighbour=np.array(neighbour, dtype=np.intp),
            neighbours=tuple(index_of),
            ring_offsets=np.array(offsets, dtype=np.intp),
        )

    def __len__(self) -> int:
        """The number of arcs."""
        return len(self.start)

    def __repr__(self) -> str:
        return f"<Outline: {counted(len(self), 'edge')} in {counted(len(self.ring_offsets) - 1, 'ring')}>"

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """The outline as GeoJSON names it, Polygon or MultiPolygon, within `display_accuracy`."""
        shape: dict[str, Any] = self.to_shapely(accuracy=self.display_accuracy).__geo_interface__
        return shape

    @property
    def display_accuracy(self) -> float:
        """How far chords are from the outline where nobody says: DISPLAY_SHARE of its larger side, in units."""
        low_x, low_y, high_x, high_y = self.bounds
        return DISPLAY_SHARE * max(high_x - low_x, high_y - low_y)

    @cached_property
    def rings(self) -> tuple[tuple[Arc, ...], ...]:
        """The arcs as objects, ring by ring."""
        arcs: list[Arc] = [
            ParabolaArc(start, control, end, focus, (directrix[0], directrix[1]), self.neighbours[k])
            if curved
            else LineArc(start, end, self.neighbours[k])
            for start, control, end, curved, focus, directrix, k in zip(
                self.start.tolist(),
                self.control.tolist(),
                self.end.tolist(),
                self.curved.tolist(),
                self.focus.tolist(),
                self.directrix.tolist(),
                self.neighbour.tolist(),
                strict=True,
            )
        ]
        return tuple(tuple(arcs[ring]) for ring in self._ring_slices())

    @cached_property
    def paths(self) -> Paths:
        """The rings as closed paths."""
        return Paths(
            start=self.start,
            end=self.end,
            control=np.column_stack((np.where(self.curved, self.control, 0), np.zeros(len(self)))),
            kind=np.where(self.curved, QUAD, LINE).astype(np.uint8),
            offsets=self.ring_offsets,
            closed=np.ones(len(self.ring_offsets) - 1, np.bool_),
        )

    @cached_property
    def area(self) -> float:
        """The enclosed area in square units, holes taken off; correctly rounded but for one division by six."""
        return self._area_of(slice(None))

    @cached_property
    def ring_areas(self) -> tuple[float, ...]:
        """The signed area of each ring in square units: > 0 for an outer ring, < 0 for a hole."""
        return tuple(self._area_of(ring) for ring in self._ring_slices())

    @cached_property
    def lengths(self) -> Floats:
        """The length of each arc in units: float64 (n,)."""
        lengths = self.paths.lengths
        lengths.setflags(write=False)
        return lengths

    @cached_property
    def perimeter(self) -> float:
        """The length of all rings in units."""
        return fsum(self.lengths.tolist())

    @cached_property
    def curved_length(self) -> float:
        """The length of all parabolic arcs in units."""
        return fsum(self.lengths[self.curved].tolist())

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """The smallest upright rectangle around the arcs: least x, least y, greatest x, greatest y, in units.

        Raises ArgumentError for an outline without arcs.
        """
        if not len(self):
            raise ArgumentError("an outline without arcs has no bounds")
        return self.paths.bounds

    def flatten(self, *, accuracy: float) -> list[Complexes]:
        """Replace every parabolic arc by chords that stay within `accuracy` (in units) of it.

        Returns one complex128 array per ring, closed implicitly: the first point is not repeated. An arc and its
        reverse give the same points bit for bit. Raises ArgumentError when the accuracy is not positive, or finer than
        the coordinates' own resolution. See `paths.conversion.chords`.
        """
        size = float(np.abs(self.start).max(initial=0.0))
        if not (is_number(accuracy) and accuracy > 4 * np.finfo(np.float64).eps * size):
            raise ArgumentError(f"`accuracy` {shown(accuracy)} must be positive and above the coordinates' resolution")
        counts = np.maximum(np.ceil(chord_counts(self.paths, accuracy)), 1.0).astype(np.intp)
        lines = chords(self.paths, counts)
        return np.split(lines.start, lines.offsets[1:-1]) if len(self) else []

    def to_shapely(self, *, accuracy: float) -> Polygon | MultiPolygon:
        """The tile as a shapely polygon whose chords stay within `accuracy` (in units) of the outline.

        A tile in several parts is a MultiPolygon, an outline without arcs an empty Polygon. Raises as `flatten` does.
        """
        import shapely

        rings = [np.column_stack((ring.real, ring.imag)) for ring in self.flatten(accuracy=accuracy)]
        outer = [ring for ring, area in zip(rings, self.ring_areas, strict=True) if area > 0]
        holes = [ring for ring, area in zip(rings, self.ring_areas, strict=True) if area <= 0]
        if len(outer) < 2:
            return shapely.Polygon(*outer, holes=holes)
        shells = [shapely.Polygon(ring) for ring in outer]
        inside: list[list[Floats]] = [[] for _ in shells]
        for hole in holes:
            patch = shapely.Polygon(hole)
            around = [k for k, shell in enumerate(shells) if shell.covers(patch)]
            inside[min(around, key=lambda k: float(shells[k].area))].append(hole)
        return shapely.MultiPolygon(list(zip(outer, inside, strict=True)))

    def transformed(self, isometry: Isometry, operation: Operation | None = None) -> Outline:
        """The image of the outline; a reflection also reverses every ring, so that the tile stays on the left.

        With `operation`, the isometry's lattice form, the neighbours are named as seen from the base site (operation
        @ the neighbour's operation); without it they keep their names, relative to the mapped tile.
        """
        order = np.arange(len(self))
        ends = (self.start, self.end)
        if isometry.conj:
            order = np.concatenate([order[ring][::-1] for ring in self._ring_slices()] or [order])
            ends = (self.end, self.start)
        start, end, control = (isometry(points[order]) for points in (*ends, self.control))
        curved = self.curved[order]
        focus = np.where(curved, isometry(self.focus[order]), 0j)
        directrix = np.where(curved[:, None], isometry(self.directrix[order]), 0j)
        neighbours = self.neighbours
        if operation is not None:
            neighbours = tuple(Neighbour(site, operation @ other) for site, other in neighbours)
        offsets = self.ring_offsets
        return Outline(start, control, end, curved, focus, directrix, self.neighbour[order], neighbours, offsets)

    def _ring_slices(self) -> list[slice]:
        """The arcs of each ring as a slice."""
        offsets = self.ring_offsets.tolist()
        return [slice(*pair) for pair in pairwise(offsets)]

    def _area_of(self, arcs: slice) -> float:
        """The integral of x dy over some arcs.

        Six times the area is an integer combination of cross products of the control points. The products are split
        without error and summed without error, so that neither a thin tile nor one far from the origin loses digits.
        """
        start, control, end, curved = self.start[arcs], self.control[arcs], self.end[arcs], self.curved[arcs]
        chords = _exact_cross(start, end)
        legs = (_exact_cross(start[curved], control[curved]), _exact_cross(control[curved], end[curved]))
        terms = [chords, 2 * chords[:, ~curved], *(2 * leg for leg in legs)]
        return fsum(np.concatenate([term.ravel() for term in terms]).tolist()) / 6


def _exact_cross(u: Complexes, v: Complexes) -> Floats:
    """The cross products u x v as four floats each, (4, n), whose exact sum is the exact product."""
    gain = _exact_product(u.real, v.imag)
    loss = _exact_product(u.imag, v.real)
    return np.concatenate((gain, -loss))


def _exact_product(a: Floats, b: Floats) -> Floats:
    """The products a*b as rounded value and rounding error, (2, n) (Dekker 1971)."""
    product = a * b
    wide_a, wide_b = _SPLITTER * a, _SPLITTER * b
    high_a, high_b = wide_a - (wide_a - a), wide_b - (wide_b - b)
    low_a, low_b = a - high_a, b - high_b
    error = low_a * low_b - (((product - high_a * high_b) - low_a * high_b) - high_a * low_b)
    return np.stack((product, error))

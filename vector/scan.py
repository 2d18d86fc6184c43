"""Scan conversion of outlines on a periodic grid of samples: which copy of which tile each sample lies in.

A sample on an edge belongs to what lies on its right, along the row; on an edge along the row, to what lies above.
Coordinates are rounded to a tiny fraction of a step, and crossings are computed from an arc's lower end, in coordinates
from a whole number near to it. So two copies that share an edge cross each row at the same place, bit for bit, even
where they are found a period of the grid apart, and every sample on the edge belongs to exactly one of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.vector.outline import Outline

QUANTUM: Final = 2.0**-24
"""What coordinates are rounded to; sample steps. Far above the rounding of a copy's coordinates (2^-40 for thousands of
steps, 2^-30 for a site drawn thousands of cells from the origin), so that shared points agree; far below what a
picture shows. A sample that is farther than this from every edge has its true owner."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Samples of a lattice's cell, nx along its vector a, ny along b, going on periodically over the plane.

    Sample (i, j) lies at origin + (i + phase[0]) a / nx + (j + phase[1]) b / ny, for all integers i and j; `origin`,
    `a` and `b` are in the design's units. b may lie on either side of a. Raises ValueError where there is no sample,
    or the cell has no area.
    """

    origin: complex
    a: complex
    b: complex
    nx: int
    ny: int
    phase: tuple[float, float] = (0.5, 0.5)

    def __post_init__(self) -> None:
        if self.nx < 1 or self.ny < 1:
            raise ValueError(f"a grid needs samples both ways, not {self.nx} by {self.ny}")
        if not (np.isfinite(self.origin) and 0.0 < abs(self.det) < np.inf):
            raise ValueError(f"a grid needs a cell with an area, not {self.a}, {self.b} at {self.origin}")

    @property
    def det(self) -> float:
        """The area of the cell, positive where b lies to the left of a."""
        return self.a.real * self.b.imag - self.a.imag * self.b.real

    def to_grid(self, z: Complexes) -> tuple[Floats, Floats]:
        """The coordinates x, y of points, of the same shape; sample (i, j) has about i, j."""
        away = z - self.origin
        x = (away.real * self.b.imag - away.imag * self.b.real) / self.det * self.nx - self.phase[0]
        y = (self.a.real * away.imag - self.a.imag * away.real) / self.det * self.ny - self.phase[1]
        return x, y

    def at(self, x: npt.ArrayLike, y: npt.ArrayLike) -> Complexes:
        """The points of coordinates, which may be fractions: the samples, for integers."""
        s = (np.asarray(x, np.float64) + self.phase[0]) / self.nx
        t = (np.asarray(y, np.float64) + self.phase[1]) / self.ny
        return np.asarray(self.origin + (s * self.a + t * self.b))


class ScanCrossings(NamedTuple):
    """Where an outline crosses the rows (or columns) of a grid, k times altogether.

    The arc with the index `arc` (intp, k) crosses the row (or column) with the number `line` (intp, k), not wrapped, at
    the coordinate x (or y) `position` (float64, k), in sample steps and a multiple of QUANTUM. `direction` (intp, k) is
    1 where a walk to greater x (or y) enters the tile, -1 where it leaves it.
    """

    arc: Ints
    line: Ints
    position: Floats
    direction: Ints


@dataclass(frozen=True, slots=True)
class Spans:
    """Runs of samples of one row that lie in one copy; none is empty, and those of one copy do not overlap.

    All are intp (k,): `copy` is the number of the copy, `row` is j, `first` and `stop` are i of the first sample and of
    the one after the last, none of them wrapped. `winding` is how often the outline runs around them counter-clockwise,
    not 0, and 1 for a sound outline.
    """

    copy: Ints
    row: Ints
    first: Ints
    stop: Ints
    winding: Ints


@dataclass(frozen=True, slots=True)
class OwnerImage:
    """What each sample of one cell lies in; row j, column i of the images is sample (i, j).

    `label` (int32, ny x nx) is the row of `labels` of the one copy that holds the sample; -1 where none does, or
    several do, or one whose outline does not run around it just once. A row k, m, n of `labels` (intp, l x 3) is copy k
    translated by m a + n b. `count` (int32, ny x nx) are the outlines' winding numbers, summed over all copies: 1 where
    they fill the plane.
    """

    label: npt.NDArray[np.int32]
    labels: Ints
    count: npt.NDArray[np.int32]


def crossings(outline: Outline, isometry: Isometry, grid: Grid, axis: Literal[0, 1] = 0) -> ScanCrossings:
    """Where the image of an outline crosses the lines of samples: rows along a (axis 0), columns along b (1).

    An arc's parts between its ends and its turning point meet the rows j with ceil(low) <= j < ceil(high), where low
    and high are the y of the part's ends: a ring enters every line as often as it leaves it, whatever it touches. The
    crossings are in no order.

    Source: y(t) = j on a part is A t^2 + 2 B t + C = 0, and half the slope there, B + A t = s, is the root of
    B^2 - A C whose sign is the part's. Of (s - B) / A and -C / (s + B), which are equal, one does not cancel.
    """
    x, y = grid.to_grid(isometry(np.stack((outline.start, outline.control, outline.end))))
    if axis:
        x, y = y, x
    x, y = _snapped(x), _snapped(y)
    # One direction for an arc and its reverse, from the lower end, and coordinates from a whole number near to it.
    turned = (y[2] < y[0]) | ((y[2] == y[0]) & (x[2] < x[0]))
    x, y = np.where(turned, x[::-1], x), np.where(turned, y[::-1], y)
    base_x, base_y = np.floor(x[0]), np.floor(y[0])
    x, y = x - base_x, y - base_y
    # x = x0 + 2 U t + V t^2, y = y0 + 2 B t + A t^2.
    U, V = _polynomial(x, outline.curved)
    B, A = _polynomial(y, outline.curved)
    bent = np.flatnonzero(outline.curved & ((y[1] < y[0]) | (y[1] > y[2])))
    turn, peak = np.ones(len(A)), y[2].copy()
    turn[bent] = -B[bent] / A[bent]
    peak[bent] = y[0, bent] + turn[bent] * B[bent]
    # Parts: up to the turning point, or all of an arc that has none; and from there.
    arc = np.concatenate((np.arange(len(A)), bent))
    start, end = np.concatenate((y[0], peak[bent])), np.concatenate((peak, y[2, bent]))
    since, until = np.concatenate((np.zeros(len(A)), turn[bent])), np.concatenate((turn, np.ones(len(bent))))
    first = np.ceil(np.minimum(start, end)).astype(np.intp)
    step, part = counting(np.ceil(np.maximum(start, end)).astype(np.intp) - first)
    rising = (end > start)[part]
    j, arc = first[part] + step, arc[part]
    A, B, C = A[arc], B[arc], y[0, arc] - j
    s = np.sqrt(np.maximum(B * B - A * C, 0.0)) * np.where(rising, 1.0, -1.0)
    # An arc that does not bend has s = B.
    cancels = s * B >= 0.0
    below = np.where(cancels, s + B, A)
    t = np.divide(np.where(cancels, -C, s - B), below, out=np.zeros_like(below), where=below != 0.0)
    t = np.clip(t, since[part], until[part])
    position = base_x[arc] + _snapped(x[0, arc] + t * (2.0 * U[arc] + t * V[arc]))
    # To the right of what rises lies what is outside, unless the plane is turned over.
    flips = isometry.conj ^ (grid.det < 0.0) ^ (axis == 1)
    enters = (rising ^ turned[arc]) == flips
    return ScanCrossings(arc, base_y.astype(np.intp)[arc] + j, position, np.where(enters, 1, -1))


def scan_spans(copies: Sequence[tuple[Outline, Isometry]], grid: Grid) -> Spans:
    """The samples in the images of outlines, row by row, over the whole plane.

    Copy k is the image of the outline copies[k][0] under the isometry copies[k][1]. Raises ValueError where a ring is
    not closed.
    """
    found = [crossings(outline, isometry, grid) for outline, isometry in copies]
    none = np.zeros(0, np.intp)
    copy = np.concatenate([none, *(np.full(len(crossed.line), k) for k, crossed in enumerate(found))])
    row = np.concatenate([none, *(crossed.line for crossed in found)])
    i = np.concatenate([none, *(np.ceil(crossed.position).astype(np.intp) for crossed in found)])
    direction = np.concatenate([none, *(crossed.direction for crossed in found)])
    order = np.lexsort((i, row, copy))
    copy, row, i = copy[order], row[order], i[order]
    winding = np.cumsum(direction[order])
    last = np.ones(len(row), bool)
    last[:-1] = (row[1:] != row[:-1]) | (copy[1:] != copy[:-1])
    if winding[last].any():
        gap = np.flatnonzero(last & (winding != 0))[0]
        raise ValueError(f"the outline of copy {copy[gap]} is open: it has a gap that row {row[gap]} passes")
    k = np.flatnonzero((winding[:-1] != 0) & (i[:-1] < i[1:]))
    return Spans(copy[k], row[k], i[k], i[k + 1], winding[k])


def owners(copies: Sequence[tuple[Outline, Isometry]], grid: Grid) -> OwnerImage:
    """Which copy each sample of a cell lies in, where each copy stands for all its lattice translates.

    Copy k is the image of the outline copies[k][0] under the isometry copies[k][1]. Raises ValueError where a ring is
    not closed.
    """
    spans = scan_spans(copies, grid)
    # A span's parts in each cell, and which translate of the copy has them in the cell at the origin.
    cell = spans.first // grid.nx
    step, k = counting((spans.stop - 1) // grid.nx - cell + 1)
    m, n = cell[k] + step, spans.row[k] // grid.ny
    first = np.maximum(spans.first[k] - m * grid.nx, 0)
    stop = np.minimum(spans.stop[k] - m * grid.nx, grid.nx)
    names = np.stack((spans.copy[k], -m, -n))
    # By their places among all that occur: the translates of a copy may be billions.
    values, places = zip(*(np.unique(row, return_inverse=True) for row in names), strict=True)
    box = [max(len(found), 1) for found in values]
    keys, label = np.unique(np.ravel_multi_index(places, box), return_inverse=True)
    labels = np.stack([found[place] for found, place in zip(values, np.unravel_index(keys, box), strict=True)], axis=1)
    # Differences along all rows in one run: what ends at a row's end ends where the next row begins.
    begin = (spans.row[k] - n * grid.ny) * grid.nx
    ends = np.concatenate((begin + first, begin + stop))
    winding = spans.winding[k]
    count, total, sums = (_accumulated(ends, height, grid) for height in (winding, np.abs(winding), winding * label))
    sums[(count != 1) | (total != 1)] = -1
    return OwnerImage(sums, labels.astype(np.intp), count)


def _snapped(x: Floats) -> Floats:
    """Numbers rounded to the quantum."""
    return np.asarray(np.rint(x / QUANTUM) * QUANTUM)


def _polynomial(x: Floats, curved: npt.NDArray[np.bool_]) -> tuple[Floats, Floats]:
    """The coefficients of 2 t and of t^2 of one coordinate of arcs, float64 (n,) each.

    `x` (float64, 3 x n) is that of their starts, control points and ends; the control points of lines are not read.
    """
    return np.where(curved, x[1] - x[0], (x[2] - x[0]) / 2.0), np.where(curved, x[0] - 2.0 * x[1] + x[2], 0.0)


def _accumulated(ends: Ints, height: Ints, grid: Grid) -> npt.NDArray[np.int32]:
    """The (ny, nx) sum of steps of given heights, whose 2 k ends are indices of the flattened image."""
    image = np.zeros(grid.ny * grid.nx + 1, np.int32)
    np.add.at(image, ends, np.concatenate((height, -height)).astype(np.int32))
    np.cumsum(image, out=image)
    return image[:-1].reshape(grid.ny, grid.nx)

"""Pulling tiles apart: how much a layout has to be spread so that all contours keep a distance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from voronoi_tiles.vector.curves.paths import CUBIC, LINE, Complexes, Paths
from voronoi_tiles.vector.sheet.period import Period

_STEPS: Final = 64
"""Spreads that are tried between none and one that is surely enough; a count."""

_BISECTIONS: Final = 40


def spread(contours: Sequence[Paths], centres: Complexes, basis: Complexes, gap: float) -> float:
    """The factor by which the places of tiles have to be spread, so that contours are `gap` apart.

    `contours` are those of the tiles of one period, as LINE pieces, `centres` the points that are spread, `basis`
    the lattice vectors. Every copy moves as a whole, from its centre c to s c. Tiles that are hooked into each other
    may meet again farther out: s is the least factor from which on, in steps of a sixty-fourth of the range, none do.
    """
    import shapely
    import shapely.affinity

    shapes = [_shape(contour) for contour in contours]
    boxes = np.array([shape.bounds for shape in shapes])
    extent = float(np.hypot(boxes[:, 2] - boxes[:, 0], boxes[:, 3] - boxes[:, 1]).max())
    pairs = _pairs(boxes, basis, 2 * extent + gap)
    moves = [(one, two, complex(step), complex(centres[two] + step - centres[one])) for one, two, step in pairs]
    least = min(abs(apart) for *_, apart in moves)

    def clear(factor: float) -> bool:
        for one, two, step, apart in moves:
            shift = step + (factor - 1.0) * apart
            x0, y0, x1, y1 = boxes[two] + np.array([shift.real, shift.imag, shift.real, shift.imag])
            a0, b0, a1, b1 = boxes[one]
            if max(x0 - a1, a0 - x1, y0 - b1, b0 - y1) >= gap:
                continue
            other = shapely.affinity.translate(shapes[two], shift.real, shift.imag)
            if shapely.distance(shapes[one], other) < gap:
                return False
        return True

    enough = 1.0 + (extent + gap) / least
    factors = np.linspace(1.0, enough, _STEPS + 1)
    last = next((k for k in range(_STEPS, -1, -1) if not clear(float(factors[k]))), -1)
    if last < 0:
        return 1.0
    low, high = float(factors[last]), float(factors[min(last + 1, _STEPS)])
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        low, high = (low, middle) if clear(middle) else (middle, high)
    return high


def pulled_apart(period: Period, centres: Complexes, about: complex, factor: float) -> Period:
    """The period of a layout that is spread: the centre c of each tile stands at `about` + `factor` (c - `about`).

    Tile and lattice vector still name the same copy; but no two tiles share a side or a vertex any more.
    """
    rings = period.rings
    ring_of = np.repeat(np.arange(len(rings.offsets) - 1), np.diff(rings.offsets))
    tile = np.repeat(np.arange(len(period.site)), np.diff(rings.tiles))[ring_of]
    shift = (factor - 1.0) * (centres - about)
    sides = period.sides.take(rings.side)
    steps, away = np.repeat(rings.step, sides.counts, axis=0), np.repeat(shift[tile], sides.counts)
    # The first and last point of a side are those of its vertices, wherever it stands.
    ends = np.column_stack((period.start[rings.side], period.end[rings.side])).ravel()
    places = np.stack((rings.step, rings.step + period.reach[rings.side]), axis=1).reshape(-1, 2)
    rows = np.column_stack((np.repeat(tile, 2), ends, places))
    _, first, vertex = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    start, end = vertex.reshape(-1, 2).T
    control = np.stack([period.at(part, steps) for part in sides.control.T], axis=1) + away[:, None]
    control[sides.kind == LINE] = 0
    control[sides.kind != CUBIC, 1] = 0
    return replace(
        period,
        basis=factor * period.basis,
        vertex=period.at(period.vertex[ends], places)[first] + np.repeat(shift[tile], 2)[first],
        start=start,
        end=end,
        reach=0 * rings.step,
        sides=replace(
            sides, start=period.at(sides.start, steps) + away, end=period.at(sides.end, steps) + away, control=control
        ),
        rings=replace(rings, side=np.arange(len(rings.side)), step=0 * rings.step),
    )


def _shape(contour: Paths) -> object:
    """The filled shape of rings of lines, the outer one first of each part."""
    import shapely

    rings = [
        shapely.LinearRing(np.column_stack((points.real, points.imag)))
        for points in np.split(contour.start, contour.offsets[1:-1])
    ]
    return shapely.build_area(shapely.GeometryCollection(rings)) if len(rings) > 1 else shapely.Polygon(rings[0])


def _pairs(
    boxes: np.ndarray[tuple[int, int], np.dtype[np.float64]], basis: Complexes, reach: float
) -> list[tuple[int, int, complex]]:
    """The pairs of tiles, the second one moved by a lattice vector, whose boxes come within a reach."""
    a, b = basis.tolist()
    det = abs(a.real * b.imag - a.imag * b.real)
    across = float(np.hypot(boxes[:, 2].max() - boxes[:, 0].min(), boxes[:, 3].max() - boxes[:, 1].min())) + reach
    n, m = int(np.ceil(across * abs(b) / det)), int(np.ceil(across * abs(a) / det))
    found = []
    for one in range(len(boxes)):
        for two in range(len(boxes)):
            for i in range(-n, n + 1):
                for j in range(-m, m + 1):
                    if (one, 0, 0) >= (two, i, j):  # each pair once, none with itself
                        continue
                    step = i * a + j * b
                    x0, y0, x1, y1 = boxes[two] + np.array([step.real, step.imag, step.real, step.imag])
                    a0, b0, a1, b1 = boxes[one]
                    if max(x0 - a1, a0 - x1, y0 - b1, b0 - y1) <= reach:
                        found.append((one, two, step))
    return found

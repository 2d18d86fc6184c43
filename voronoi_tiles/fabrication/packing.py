"""Packing of pieces: in rows, each pushed against the one beside it, the rows against those below, a gap between all.

Pieces are not turned. A piece is pushed by conservative advancement: as far as its distance from what lies there
exceeds the gap it can go without coming nearer to anything than that, since no distance changes by more than the way.
So the gap is kept wherever the pushing stops. Source: B. Mirtich, Impulse-based Dynamic Simulation of Rigid Body
Systems, 1996.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints

_NEAR_MM: Final = 0.05
"""How much farther apart than the gap pieces may stay; millimetres."""

_PUSHES: Final = 100
"""Most steps of a push; a count."""

_PLACES: Final = 4
"""Places along the free rest of a row that are tried for it; a count. The one where it sinks deepest is taken."""


class Packed(NamedTuple):
    """Where pieces lie: the number of their sheet, intp (n,), and how far each is moved, float64 (n, 2)."""

    sheet: Ints
    shift: Floats


class _Row(NamedTuple):
    """Pieces side by side, standing on y = 0: their indices, how far each is moved along x, and the rest's width."""

    piece: list[int]
    x: list[float]
    free: float


def pack_pieces(shapes: Sequence[Any], kind: Ints, size: tuple[float, float], gap: float) -> Packed:
    """Lay pieces on as many sheets of a size as they take; piece k has the shape `shapes[kind[k]]`, a polygon.

    All lie between 0 and the size, no two nearer than the gap. High pieces come first, those of a kind together. In
    rows or in columns, as takes fewer sheets. Raises ValueError where a piece is larger than a sheet.
    """
    import shapely

    rows = _pack_rows(shapes, kind, size, gap)
    columns = _pack_rows([shapely.transform(one, _swapped) for one in shapes], kind, size[::-1], gap)
    return columns._replace(shift=_swapped(columns.shift)) if columns.sheet.max() < rows.sheet.max() else rows


def _swapped(points: Floats) -> Floats:
    """Points (n, 2) with x and y exchanged."""
    return points[:, ::-1]


def _pack_rows(shapes: Sequence[Any], kind: Ints, size: tuple[float, float], gap: float) -> Packed:
    """Lay pieces in rows; see `pack_pieces`."""
    import shapely

    boxes = np.asarray(shapely.bounds(shapes), np.float64)
    sizes = boxes[:, 2:] - boxes[:, :2]
    for k in np.unique(kind).tolist():
        if sizes[k, 0] > size[0] or sizes[k, 1] > size[1]:
            raise ValueError(f"one piece takes {sizes[k, 0]:.4g} x {sizes[k, 1]:.4g} mm")
    # From here on every shape stands on the axes.
    corner = boxes[:, :2]
    standing = np.array([_moved(shape, *-at) for shape, at in zip(shapes, corner, strict=True)])
    shapely.prepare(standing)
    order = np.lexsort((np.arange(len(kind)), kind, -np.round(sizes[kind, 1], 3)))
    sheet = np.zeros(len(kind), np.intp)
    shift = np.zeros((len(kind), 2))
    here: list[Any] = []
    number, low = 0, 0.0
    for row in _rows(standing, sizes, kind, order.tolist(), size[0], gap):
        placed = [_moved(standing[kind[piece]], x, 0.0) for piece, x in zip(row.piece, row.x, strict=True)]
        aside, up = _sunk(placed, here, row.free, gap, low)
        if here and up + float(shapely.total_bounds(placed)[3]) > size[1]:
            here, number = [], number + 1
            aside, up = 0.0, 0.0
        # No row goes below the one before: what does not reach above its foot is in no one's way.
        low = up
        here = [one for one in here if shapely.bounds(one)[3] + gap > low]
        here += [_moved(one, aside, up) for one in placed]
        sheet[row.piece] = number
        shift[row.piece] = np.column_stack((np.array(row.x) + aside, np.full(len(row.x), up)))
    return Packed(sheet, shift - corner[kind])


def _rows(standing: Any, sizes: Floats, kind: Ints, order: Sequence[int], width: float, gap: float) -> list[_Row]:
    """The pieces in rows that are no wider than a sheet."""
    import shapely

    known: dict[tuple[int, int], float] = {}

    def beside(one: int, other: int) -> float:
        """How far right of a shape another can begin: nowhere beyond are they nearer than the gap."""
        if (one, other) not in known:
            first, second = standing[one], standing[other]
            known[one, other] = _pushed(
                float(sizes[one, 0]) + gap, lambda x: float(shapely.distance(first, _moved(second, x, 0.0))), gap
            )
        return known[one, other]

    rows: list[_Row] = []
    pieces: list[int] = []
    places: list[float] = []
    right = 0.0
    for piece in order:
        own = int(kind[piece])
        x = max((at + beside(int(kind[other]), own) for other, at in zip(pieces, places, strict=True)), default=0.0)
        x = max(x, 0.0)
        if x + sizes[own, 0] > width:
            rows.append(_Row(pieces, places, width - right))
            pieces, places, x, right = [], [], 0.0, 0.0
        pieces.append(piece)
        places.append(x)
        right = max(right, x + float(sizes[own, 0]))
    return [*rows, _Row(pieces, places, width - right)]


def _sunk(row: Sequence[Any], below: Sequence[Any], free: float, gap: float, low: float) -> tuple[float, float]:
    """How far a row is moved right and up to lie on what is below: to where along its free rest it comes lowest.

    It is not moved below `low`.
    """
    import shapely

    if not below:
        return 0.0, 0.0
    bottom = shapely.MultiPolygon(list(below))
    shapely.prepare(bottom)
    start = float(shapely.bounds(bottom)[3]) + gap
    best = (start, 0.0)
    for aside in np.linspace(0.0, max(free, 0.0), _PLACES).tolist():
        moved = shapely.MultiPolygon([_moved(one, aside, 0.0) for one in row])
        up = _pushed(start, lambda y, part=moved: float(shapely.distance(bottom, _moved(part, 0.0, y))), gap)
        best = min(best, (max(up, low), aside))
    return best[1], best[0]


def _pushed(start: float, distance: Any, gap: float) -> float:
    """How far down from a start something can be pushed without coming nearer than the gap."""
    at = start
    for _ in range(_PUSHES):
        room = distance(at) - gap
        if room <= _NEAR_MM or at <= 0.0:
            break
        at -= room
    return at


def _moved(shape: Any, x: float, y: float) -> Any:
    """The image of a shape that is moved."""
    import shapely

    return shapely.transform(shape, lambda points: points + np.array([x, y]))

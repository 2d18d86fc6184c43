"""Every piece of a path as a line or a cubic Bezier curve, for file formats that know no other curve."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from voronoi_tiles.vector.curves.paths import ARC, CUBIC, LINE, QUAD, Complexes, Floats, Ints, Paths, ranges
from voronoi_tiles.vector.writers.drawing import Layer

_BLOCK: Final = 1 << 16  # pieces that a writer holds as text at a time


def cubic_blocks(layer: Layer, *, accuracy: float) -> Iterator[tuple[Paths, Ints]]:
    """The items of a layer in blocks of bounded size, as lines and cubic curves.

    Gives the paths of a block, and where its items begin and end among them (intp, items + 1). Raises ValueError where
    `accuracy` (millimetres, for circular arcs) is not positive.
    """
    pieces, count = layer.paths.offsets[layer.items], len(layer.items) - 1
    first = 0
    while first < count:
        fitting = int(np.searchsorted(pieces, pieces[first] + _BLOCK, side="right")) - 1
        stop = max(min(fitting, count), first + 1)
        chosen = np.arange(layer.items[first], layer.items[stop])
        yield to_cubics(layer.paths.take(chosen), accuracy=accuracy), layer.items[first : stop + 1] - layer.items[first]
        first = stop


def to_cubics(paths: Paths, *, accuracy: float, lines: bool = False) -> Paths:
    """The same paths with CUBIC in the place of QUAD and ARC; with `lines`, in the place of LINE too.

    Degrees are raised exactly; arcs are cut into the fewest equal parts that keep the curve within `accuracy` (in
    millimetres, > 0) of the circle. All points where pieces meet keep their bits.

    Raises ValueError where `accuracy` is not positive.
    """
    if not accuracy > 0:
        raise ValueError(f"the accuracy must be greater than 0, not {accuracy}")
    arcs = np.flatnonzero(paths.kind == ARC)
    turns = _turns(paths, arcs)
    parts = np.ones(len(paths.start), np.intp)
    parts[arcs] = _parts(np.abs(paths.end[arcs] - paths.start[arcs]), turns, accuracy)

    piece = np.repeat(np.arange(len(parts)), parts)
    first = np.cumsum(parts) - parts
    start, end, kind = paths.start[piece], paths.end[piece], paths.kind[piece]
    control = paths.control[piece]
    _cut_arcs(start, end, control, first[arcs], parts[arcs], turns)

    low = np.flatnonzero(kind == QUAD)
    bend = control[low, 0]
    control[low] = np.stack((_third(start[low], bend), _third(end[low], bend)), axis=1)
    if lines:
        straight = np.flatnonzero(kind == LINE)
        begin, stop = start[straight], end[straight]
        control[straight] = np.stack((begin + (stop - begin) / 3, stop + (begin - stop) / 3), axis=1)
    kept = (kind == LINE) & (not lines)
    return Paths(
        start=start,
        end=end,
        control=control,
        kind=np.where(kept, LINE, CUBIC).astype(np.uint8),
        offsets=np.append(0, np.cumsum(parts))[paths.offsets].astype(np.intp),
        closed=paths.closed,
    )


def _third(end: Complexes, bend: Complexes) -> Complexes:
    """The cubic's control point beside an end of a quadratic curve: two thirds of the way to the bend."""
    return end + (bend - end) * (2 / 3)


def _turns(paths: Paths, arcs: Ints) -> Floats:
    """The angle by which each ARC turns left; radians."""
    return np.asarray(4.0 * np.arctan(paths.bulges()[arcs]), np.float64)


def _parts(chord: Floats, turn: Floats, accuracy: float) -> Ints:
    """The number of equal parts of each arc.

    A part of the angle 4x has the greatest distance R (2/27) sin(x)^6 / cos(x)^2 from its circle (Goldapp 1991), which
    for x up to pi/8 is less than R (4/27) x^6.
    """
    half = np.abs(turn) / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = np.where(half > 0, chord / (2 * np.sin(half)), np.inf)
        largest = np.minimum(np.pi / 8, (27 * accuracy / (4 * radius)) ** (1 / 6))
        parts = np.ceil(half / (2 * largest))
    return np.where(half > 0, np.maximum(parts, 1), 1).astype(np.intp)


def _cut_arcs(start: Complexes, end: Complexes, control: Complexes, first: Ints, parts: Ints, turns: Floats) -> None:
    """Write the cubic parts of arcs to their places: arc k takes `parts[k]` rows from `first[k]`.

    Everything is taken from the chord, not from the centre, which is far away where an arc is nearly straight.
    """
    rows = ranges(first, parts)
    index = np.arange(len(rows)) - np.repeat(np.cumsum(parts) - parts, parts)
    count, turn = np.repeat(parts, parts), np.repeat(turns, parts)
    begin, chord = start[rows], end[rows] - start[rows]
    inner = index > 0
    share = index[inner] / count[inner]
    half = turn[inner] / 2
    points = begin[inner] + chord[inner] * (np.sin(share * half) / np.sin(half)) * np.exp(1j * (share - 1) * half)
    start[rows[inner]] = points
    end[rows[inner] - 1] = points
    part = turn / count
    reach = (end[rows] - start[rows]) / (3 * np.cos(part / 4) ** 2)
    control[rows, 0] = start[rows] + reach * np.exp(-0.5j * part)
    control[rows, 1] = end[rows] - reach * np.exp(0.5j * part)

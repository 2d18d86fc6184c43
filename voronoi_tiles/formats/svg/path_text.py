"""SVG path data, absolute: of many paths at once in nanometres, or of a few in any number of digits.

SVG's y runs down, ours up: whatever is written is turned, so that the picture looks the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from decimal import Decimal

import numpy as np

from voronoi_tiles.base.arrays import Ints, offsets_of
from voronoi_tiles.formats.decimals import WIDTH, decimals
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

_ROWS = 1 << 16
"""Pairs of coordinates that are written at a time: a few megabytes."""

_LETTERS = np.zeros(4, np.uint8)
_LETTERS[[LINE, QUAD, CUBIC]] = [ord("L"), ord("Q"), ord("C")]

# A row is a pair of coordinates: space, letter, space, x, space, y, space, Z.
_X = slice(3, 3 + WIDTH)
_Y = slice(4 + WIDTH, 4 + 2 * WIDTH)
_BYTES = 6 + 2 * WIDTH


def decimal_text(value: float) -> str:
    """Write a float as the shortest decimal that reads back as the same float, without exponent or sign of zero."""
    text = repr(value + 0.0)  # adding zero makes -0.0 a 0
    if "e" in text:
        text = format(Decimal(text), "f")
    return text.removesuffix(".0")


def path_data(paths: Paths, *, top: float | None = 0.0, number: Callable[[float], str] = decimal_text) -> str:
    """Write paths as one text: M, L, Q, C, A and Z.

    y is turned about `top`, the ordinate that becomes SVG's 0; None, of paths without ARCs alone, leaves it running up.
    `number` writes a coordinate; by default it reads back as the same float. A last straight segment of a closed path
    is drawn by Z.
    """
    points = np.column_stack((paths.start, paths.control, paths.end))
    x, y = points.real.tolist(), (points.imag if top is None else top - points.imag).tolist()

    def point(k: int, column: int) -> str:
        """The start, one of both controls or the end of a segment: columns 0 to 3."""
        return f"{number(x[k][column])} {number(y[k][column])}"

    arcs = np.flatnonzero(paths.kind == ARC)
    radius, turn = paths.arc_radius_and_turn(arcs)
    sweeps = {
        arc: f"A {number(r)} {number(r)} 0 {int(abs(angle) > np.pi)} {int(angle < 0)}"
        for arc, r, angle in zip(arcs.tolist(), radius.tolist(), turn.tolist(), strict=True)
    }
    kinds, offsets = paths.kind.tolist(), paths.offsets.tolist()
    words = []
    for path, closed in enumerate(paths.closed.tolist()):
        words.append(f"M {point(offsets[path], 0)}")
        for k in range(offsets[path], offsets[path + 1]):
            kind = kinds[k]
            if kind == QUAD:
                words.append(f"Q {point(k, 1)} {point(k, 3)}")
            elif kind == CUBIC:
                words.append(f"C {point(k, 1)} {point(k, 2)} {point(k, 3)}")
            elif kind == ARC:
                words.append(f"{sweeps[k]} {point(k, 3)}")
            elif not (closed and k == offsets[path + 1] - 1):
                words.append(f"L {point(k, 3)}")
        if closed:
            words.append("Z")
    return " ".join(words)


def path_texts(paths: Paths, items: Ints, height: float) -> Iterator[bytes]:
    """Write the path data of every item: those paths from items[k] up to, not including, items[k + 1].

    y is turned about a page of this height. A last straight segment of a closed path is drawn by Z. Raises ValueError
    for circular arcs, which path data hold only as elliptical ones: cutters' readers do not agree on these.
    """
    if (paths.kind == ARC).any():
        raise ValueError("circular arcs have to become cubic curves before they are written as path data")
    sizes = paths.offsets[items[1:]] - paths.offsets[items[:-1]]
    # Three pairs a segment at most, and one more at the beginning of a path.
    weight = np.cumsum(3 * sizes + np.diff(items))
    first = 0
    while first < len(sizes):
        before = int(weight[first - 1]) if first else 0
        stop = max(int(np.searchsorted(weight, before + _ROWS, side="right")), first + 1)
        chunk = paths.take(np.arange(items[first], items[stop]))
        yield from _texts(chunk, items[first : stop + 1] - items[first], height)
        first = stop


def _texts(paths: Paths, items: Ints, height: float) -> Iterator[bytes]:
    """Write items that fit into memory."""
    count = len(paths.start)
    last = np.zeros(count, np.bool_)
    last[paths.offsets[1:] - 1] = True
    closing = last & paths.closed[paths.owner]
    opening = np.zeros(count, np.bool_)
    opening[paths.offsets[:-1]] = True
    pairs = np.where(closing & (paths.kind == LINE), 0, 1 + paths.kind.astype(np.intp))
    rows = pairs + opening
    at = np.cumsum(rows) - rows
    total = int(rows.sum())
    point = np.empty(total, np.complex128)
    letter = np.zeros(total, np.uint8)
    closes = np.zeros(total, np.bool_)
    point[at[opening]], letter[at[opening]] = paths.start[opening], ord("M")
    first = at + opening
    drawn = np.flatnonzero(pairs)
    letter[first[drawn]] = _LETTERS[paths.kind[drawn]]
    point[(first + pairs - 1)[drawn]] = paths.end[drawn]
    for place, kinds in ((0, (QUAD, CUBIC)), (1, (CUBIC,))):
        bent = np.flatnonzero(np.isin(paths.kind, kinds))
        point[first[bent] + place] = paths.control[bent, place]
    closes[(at + rows - 1)[closing]] = True
    text = np.empty((total, _BYTES), np.uint8)
    used = np.ones((total, _BYTES), np.bool_)
    text[:] = ord(" ")
    text[:, 1] = letter
    used[:, 1] = used[:, 2] = letter > 0
    text[:, _X], used[:, _X] = decimals(point.real)
    text[:, _Y], used[:, _Y] = decimals(height - point.imag)
    text[:, -1] = ord("Z")
    used[:, -2] = used[:, -1] = closes
    begin = at[paths.offsets[items[:-1]]]
    used[begin, 0] = False
    stops = np.append(begin[1:], total)
    length = offsets_of(used.sum(axis=1))
    data = text[used].tobytes()
    for a, b in zip(length[begin].tolist(), length[stops].tolist(), strict=True):
        yield data[a:b]

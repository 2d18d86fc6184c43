"""Pieces that overlap on a rectangle, moved until none does: guided local search along lines.

A piece that overlaps others is tried on lines across the sheet, its own and some at random, in each way that it may
lie: on a line the others block spans, and the best place is at the end of one. Pairs that stay in each other's way
weigh more and more. The search is repeatable: it is given a number of lines, and no time.

Source: J. Egeblad, B. K. Nielsen and A. Odgaard, Fast neighborhood search for two- and three-dimensional nesting
problems, 2007; S. Umetani et al., Solving the irregular strip packing problem via guided local search for overlap
minimization, 2009.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, offsets_of, owned_ranges
from voronoi_tiles.base.kernels import COMPLEXES, FLOATS, INT, INTS, kernel

_TOUCH: Final = 1e-6
"""Pieces that overlap by no more touch; millimetres. As in separation.c, as the next two."""

_SLABS: Final = 32
"""Slabs that each polygon is cut into along either axis, so that a line has to do with few edges; a count."""

_SETTLED: Final = 4
"""Lines along which a piece is moved on from the best place that was found; a count."""

_LINES: Final = 6
"""Lines on which a piece is tried in each way, two of them through where it is; a count."""

_WORD: Final = (1 << 64) - 1

_COMPILED = kernel(
    "pieces_separate", INT, INT, INTS, *3 * [FLOATS], *3 * [INTS], COMPLEXES, *4 * [FLOATS], INTS, *3 * [INT]
)


class Separated(NamedTuple):
    """How pieces lie after a search: the way of each, its place, whether none overlaps; and how many lines it took."""

    way: Ints
    place: Complexes
    apart: bool
    tried: int


class Separation:
    """Ways in which pieces may lie on a sheet.

    `edges[a * ways + b]`, (n, 4), are those of the rings in which the place of b, seen from that of a, overlaps it;
    `rooms` (ways, 4) the least x and y of its place on the sheet, and the greatest ones. A piece of kind k may lie in
    the ways range[k] ... range[k + 1].
    """

    def __init__(self, edges: Sequence[Floats], rooms: Floats, range_: Ints) -> None:
        self.first = offsets_of(np.array([len(ring) for ring in edges]))
        self.edges = np.concatenate(edges)
        ends = np.concatenate((self.edges[:, :2], self.edges[:, 2:]), axis=1).reshape(-1, 2, 2)
        low, high = ends.min(axis=1), ends.max(axis=1)
        self.boxes = np.concatenate(
            (np.minimum.reduceat(low, self.first[:-1]), np.maximum.reduceat(high, self.first[:-1])), axis=1
        )
        self.rooms, self.range = rooms, range_
        self._slab_first, self._slab_edges = self._slabs()

    def _slabs(self) -> tuple[Ints, Floats]:
        """The edges in each slab of each pair, those that are cut across y before those across x."""
        pair = np.repeat(np.arange(len(self.boxes)), np.diff(self.first))
        box, number, edge = self.boxes[pair], [], []
        for axis in (0, 1):
            low, scale = box[:, 1 - axis], _SLABS / (box[:, 3 - axis] - box[:, 1 - axis])
            ends = (np.column_stack((self.edges[:, 1 - axis], self.edges[:, 3 - axis])) - low[:, None]) * scale[:, None]
            ends = np.minimum(ends.astype(np.int64), _SLABS - 1)
            slab, of = owned_ranges(ends.min(axis=1), ends.max(axis=1) + 1)
            number.append((2 * pair[of] + axis) * _SLABS + slab)
            edge.append(of)
        numbers = np.concatenate(number)
        order = np.argsort(numbers, kind="stable")
        first = offsets_of(np.bincount(numbers, minlength=2 * _SLABS * len(self.boxes)))
        return first, self.edges[np.concatenate(edge)[order]]

    def separated(self, kind: Ints, way: Ints, place: Complexes, *, seed: int, effort: int) -> Separated:
        """Pieces moved, turned and swapped until none overlaps another, or `effort` lines were tried, or little more.

        The same bits come from a compiled kernel and from numpy.
        """
        pieces, ways = len(kind), len(self.rooms)
        state = (seed * 0x9E3779B97F4A7C15 + 0x1234567) >> 1 & (_WORD >> 1) | 1
        compiled = _COMPILED()
        if compiled is None:
            return _SeparationByNumpy(self, kind, way.copy(), place.copy(), state).separated(effort)
        way, place = way.copy(), place.copy()
        most = int(np.diff(self.first).max())
        weight, depths = np.ones((pieces, pieces)), np.zeros((pieces, pieces))
        tables = self._slab_first, self._slab_edges, self.boxes, self.rooms, self.range
        scratch = depths, np.empty(most + 1), np.empty(3 * pieces * (most // 2 + 1)), np.empty(pieces, np.int64)
        tried = compiled(ways, pieces, *tables, kind, way, place, weight, *scratch, state, _LINES, effort)
        return Separated(way, place, tried >= 0, tried if tried >= 0 else -1 - tried)


class _SeparationByNumpy:
    """What separation.c does, by numpy."""

    def __init__(self, known: Separation, kind: Ints, way: Ints, place: Complexes, state: int) -> None:
        self.known, self.kind, self.way, self.state = known, kind, way, state
        self.place = place.view(np.float64).reshape(-1, 2)
        self.weight = np.ones((len(kind), len(kind)))
        self.tried = 0

    def separated(self, effort: int) -> Separated:
        """Move pieces until none overlaps another, or so many lines were tried."""
        pieces = len(self.kind)
        while True:
            depths = np.zeros((pieces, pieces))
            for i in range(pieces):
                depths[i] = self.depths(i, int(self.way[i]), *self.place[i].tolist())
            depths = np.tril(depths) + np.tril(depths).T
            most = float(depths.max())
            if most == 0.0 or self.tried >= effort:
                return Separated(self.way, self.place.view(np.complex128)[:, 0], most == 0.0, self.tried)
            grown = np.where(depths > 0.0, 1.2 + 0.8 * depths / most, 0.95)
            self.weight = np.maximum(self.weight * grown, 1.0)
            np.fill_diagonal(self.weight, 1.0)
            order = np.flatnonzero((depths > 0.0).any(axis=1)).tolist()
            for k in range(len(order) - 1, 0, -1):
                other = self.random_bits() % (k + 1)
                order[k], order[other] = order[other], order[k]
            for i in order:
                self.move(i)

    def random_bits(self) -> int:
        """The next 64 bits of a xorshift generator (G. Marsaglia, Xorshift RNGs, 2003)."""
        self.state ^= self.state << 13 & _WORD
        self.state ^= self.state >> 7
        self.state ^= self.state << 17 & _WORD
        return self.state

    def random_share(self) -> float:
        """A number from 0 up to 1."""
        return (self.random_bits() >> 11) * 2.0**-53

    def crossings(self, pair: int, axis: int, across: float) -> Floats:
        """Where a line along an axis, at `across` on the other, meets the rings of a pair, the least first."""
        edges = self.known.edges[self.known.first[pair] : self.known.first[pair + 1]]
        edges = edges[(edges[:, 1 - axis] <= across) != (edges[:, 3 - axis] <= across)]
        low, high = edges[:, 1 - axis], edges[:, 3 - axis]
        return np.sort(edges[:, axis] + (across - low) * (edges[:, 2 + axis] - edges[:, axis]) / (high - low))

    def way_out(self, pair: int, axis: int, along: float, across: float) -> float:
        """How far a place within the rings of a pair is from leaving them along an axis; 0 outside."""
        levels = self.crossings(pair, axis, across)
        least = np.minimum(along - levels[::2], levels[1::2] - along)
        return float(least[least > _TOUCH][0]) if (least > _TOUCH).any() else 0.0

    def depths(self, i: int, way: int, x: float, y: float) -> Floats:
        """How deep a piece that lies in a way at a place overlaps each: by x or by y, whichever is less."""
        pairs = self.way * len(self.known.rooms) + way
        box = self.known.boxes[pairs]
        away = np.array([x, y]) - self.place
        near = np.asarray(((away > box[:, :2]) & (away < box[:, 2:])).all(axis=1))
        near[i] = False
        result = np.zeros(len(near))
        for j in np.flatnonzero(near).tolist():
            dx, dy = away[j].tolist()
            wide = self.way_out(int(pairs[j]), 0, dx, dy)
            result[j] = min(wide, self.way_out(int(pairs[j]), 1, dy, dx)) if wide else 0.0
        return result

    def overlap(self, i: int, way: int, place: Sequence[float]) -> float:
        """What piece i would overlap in a way at a place, weighed."""
        # Not a sum, whose order is numpy's own.
        return float(np.cumsum(self.weight[i] * self.depths(i, way, *place))[-1])

    def on_line(self, i: int, way: int, axis: int, across: float, here: float) -> float:
        """The best place on a line for piece i in a way; of several the one nearest to `here`."""
        low, high = self.known.rooms[way, axis], self.known.rooms[way, 2 + axis]
        self.tried += 1
        pairs = self.way * len(self.known.rooms) + way
        box, level, start = self.known.boxes[pairs], across - self.place[:, 1 - axis], self.place[:, axis]
        near = (level > box[:, 1 - axis]) & (level < box[:, 3 - axis])
        near &= (start + box[:, axis] < high) & (start + box[:, 2 + axis] > low)
        near[i] = False
        spans = [np.empty((0, 3))]
        for j in np.flatnonzero(near).tolist():
            levels = start[j] + self.crossings(int(pairs[j]), axis, float(level[j]))
            spans.append(np.column_stack((levels[::2], levels[1::2], np.full(len(levels) // 2, self.weight[i, j]))))
        begin, end, weight = np.concatenate(spans).T
        at = np.concatenate(([low, high], np.column_stack((begin, end)).ravel()))
        at = at[(at >= low) & (at <= high)]
        deep = np.minimum(at[:, None] - begin, end - at[:, None])
        costs = np.cumsum(np.where(deep > _TOUCH, weight * deep, 0.0), axis=1)[:, -1] if len(begin) else 0.0 * at
        away = (at - here) * (at - here)
        return float(at[np.lexsort((away, costs))[0]]) if len(at) else float(low)

    def move(self, i: int) -> None:
        """Move a piece to where what it overlaps weighs less, if there is such a place on a few lines."""
        x, y = self.place[i].tolist()
        best, way = (x, y), int(self.way[i])
        least = self.overlap(i, way, best)
        first, last = self.known.range[self.kind[i] : self.kind[i] + 2].tolist()
        for other in range(first, last):
            room = self.known.rooms[other].tolist()
            for k in range(_LINES):
                if least == 0.0:
                    break
                axis = k % 2
                low, high = room[1 - axis], room[3 - axis]
                here = x if axis else y
                # A room may be narrower than 0, by a little.
                held = low if here < low else min(here, high)
                across = held if k < 2 else low + self.random_share() * (high - low)
                at = self.on_line(i, other, axis, across, y if axis else x)
                place = (across, at) if axis else (at, across)
                cost = self.overlap(i, other, place)
                if cost < least:
                    least, best, way = cost, place, other
        for k in range(_SETTLED):
            if least == 0.0:
                break
            axis = k % 2
            at = self.on_line(i, way, axis, best[1 - axis], best[axis])
            place = (best[0], at) if axis else (at, best[1])
            cost = self.overlap(i, way, place)
            if cost < least:
                least, best = cost, place
        self.place[i], self.way[i] = best, way

"""Distances in float64 at any point of a window, and the points where two copies' distances are equal.

What the cross-check compares the exact outlines with: computed from the sites alone, through the candidate lists.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, first_least, owned_ranges, starts
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.raster.block_lists import BlockLists
from voronoi_tiles.raster.frame import BLOCK, Frame
from voronoi_tiles.raster.scene import Pattern, from_feet, lengths

_CELLS = 1 << 23
_PLACEMENTS = 1 << 14
_PORTION = 2_000_000
"""Pairs of points and elements that are handled at once; a count."""

_CHORDS = 40
"""After so many steps on an interval only halvings; a count. Chords do no good where the distances' difference is flat
but for a jump, as beside two copies that are nearly the same. Enough for all else."""

_STEPS = _CHORDS + 60
"""Most steps on an interval; a count. Float64 is at its end after less than 60 halvings."""


def encode(copies: Ints) -> NDArray[np.int64]:
    """One number for each copy, rows (placement, i, j): the same for the same copy, wherever it is met.

    Raises DesignError where copies are numbered beyond _CELLS, because a site lies so many cells from the origin.
    """
    k, i, j = (copies[..., column].astype(np.int64) for column in range(3))
    if max(np.abs(i).max(initial=0), np.abs(j).max(initial=0)) >= _CELLS or k.max(initial=0) >= _PLACEMENTS:
        raise DesignError(
            f"a site lies more than {_CELLS:,} cells from the origin, or a cell has more than {_PLACEMENTS:,} copies",
            remedy="Draw it nearer to the origin.",
        )
    return np.asarray((k * 2 * _CELLS + (i + _CELLS)) * 2 * _CELLS + (j + _CELLS))


def decode(codes: NDArray[np.int64]) -> Ints:
    """The rows (placement, i, j) of copies."""
    rest, j = np.divmod(codes, 2 * _CELLS)
    k, i = np.divmod(rest, 2 * _CELLS)
    return np.stack((k, i - _CELLS, j - _CELLS), axis=-1).astype(np.intp)


class Near(NamedTuple):
    """Copies near points: `point` (n,) is the number of the point, `copy` a code, `distance` in units."""

    point: Ints
    copy: NDArray[np.int64]
    distance: Floats


class BisectorPoints(NamedTuple):
    """Points that are equally far from two copies and from no other nearer, on steps between samples.

    `step` (n,) is the number of the step, `place` complex128 the point, from the frame's origin, `before` and `after`
    the codes of the copies on the step's sides. `slope` is the length of the gradient of the distances' difference:
    an error e of the distances moves the point's edge by at most e / slope. Where a third copy is as near, as far as
    rounding tells, the point is not `alone` (bool): the edge may end before it, even in another point, and the slope is
    that along the edge, if less.
    """

    step: Ints
    place: Complexes
    before: NDArray[np.int64]
    after: NDArray[np.int64]
    slope: Floats
    alone: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Judge:
    """The candidate lists of one window; points are given by their sample coordinates x, y in it."""

    pattern: Pattern
    frame: Frame
    candidates: BlockLists

    @cached_property
    def codes(self) -> NDArray[np.int64]:
        """The codes of the scene's copies."""
        return encode(self.candidates.scene.copies)

    @cached_property
    def rounding(self) -> float:
        """A bound for the rounding of distances, in units."""
        return self.pattern.rounding(self.frame)

    def near(self, x: Floats, y: Floats) -> Near:
        """For each point the copies that may be nearest, or nearest of another copy, and perhaps some more.

        The distances of the two nearest are true, those of others upper bounds.
        """
        block = self._block(x, y)
        place = self.frame.offsets(x, y)
        rows = []
        lists = self.candidates
        first, last = lists.run_start[block], lists.run_start[block + 1]
        for part in _portions(lists.element_start[last] - lists.element_start[first]):
            runs, point = owned_ranges(first[part], last[part])
            point = point + part.start
            element, of_run = owned_ranges(lists.element_start[runs], lists.element_start[runs + 1])
            away = self._away(place[point[of_run]], lists.element[element])
            rows.append((point, self.codes[lists.run_label[runs]], np.minimum.reduceat(lengths(away), starts(of_run))))
        return Near(*(np.concatenate(column) for column in zip(*rows, strict=True))) if rows else _NOTHING

    def certify(
        self, column: Ints, row: Ints, down: NDArray[np.bool_], before: NDArray[np.int64], after: NDArray[np.int64]
    ) -> BisectorPoints:
        """Where steps from samples (column, row) to the next column, or `down` to the next row, pass from copy to copy.

        `before` and `after` are the codes of the owners of a step's two samples. Where a third copy is nearer at the
        point that is equally far from both, the step passes through it, and has a crossing on either side.
        """
        parts = []
        block = self._block(column.astype(float), row.astype(float))
        lists = self.candidates
        first, last = lists.element_start[lists.run_start[block]], lists.element_start[lists.run_start[block + 1]]
        for part in _portions(last - first):
            found = self._certify(
                column[part], row[part], down[part], before[part], after[part], first[part], last[part]
            )
            parts.append(found._replace(step=found.step + part.start))
        if not parts:
            none = np.zeros(0)
            codes = none.astype(np.int64)
            return BisectorPoints(none.astype(np.intp), none.astype(complex), codes, codes, none, none.astype(bool))
        return BisectorPoints(*(np.concatenate(column) for column in zip(*parts, strict=True)))

    def _certify(
        self,
        column: Ints,
        row: Ints,
        down: NDArray[np.bool_],
        before: NDArray[np.int64],
        after: NDArray[np.int64],
        first: Ints,
        last: Ints,
    ) -> BisectorPoints:
        lists, frame = self.candidates, self.frame
        start = frame.offsets(column.astype(float), row.astype(float))
        stride = np.where(down, frame.v, frame.u)
        # What can be nearest anywhere on the step: half a step from its middle, distances differ by a step at most.
        pair, step = owned_ranges(first, last)
        element = lists.element[pair]
        distance = lengths(self._away((start + stride / 2)[step], element))
        segment = np.cumsum(last - first) - (last - first)
        limit = np.minimum.reduceat(distance, segment) + np.abs(stride) * (1 + 1e-9)
        kept = distance <= limit[step]
        element, step = element[kept], step[kept]
        copy = self.codes[lists.scene.label[element]]

        found = []
        number = np.arange(len(column))
        low, high = np.zeros(len(column)), np.ones(len(column))
        while len(number):
            # The intervals still to be decided, with their own elements: of both copies, and of all others.
            index, of = owned_ranges(*_extent_of(step, number))
            owned_by_before, owned_by_after = copy[index] == before[of], copy[index] == after[of]
            t = self._equal(
                start[number],
                stride[number],
                low,
                high,
                (element[index[owned_by_before]], of[owned_by_before]),
                (element[index[owned_by_after]], of[owned_by_after]),
            )
            place = start[number] + t * stride[number]
            away = self._away(place[of], element[index])
            distance = lengths(away)
            nearest = first_least(distance, of, len(number))
            mine = first_least(np.where(owned_by_before, distance, np.inf), of, len(number))
            theirs = first_least(np.where(owned_by_after, distance, np.inf), of, len(number))
            third = distance[nearest] < np.minimum(distance[mine], distance[theirs]) - 4 * self.rounding
            gradient = away / np.maximum(distance, 1e-300)
            across = gradient[mine] - gradient[theirs]
            slope = np.abs(across)
            # A third copy as near, as far as rounding tells, may own the point: the two cease to meet where it falls
            # behind them, along their bisector.
            close = distance < (np.minimum(distance[mine], distance[theirs]) + 4 * self.rounding)[of]
            tied = np.flatnonzero(close & ~owned_by_before & ~owned_by_after)
            turn, falling = 1j * across[of[tied]], gradient[tied] - gradient[mine[of[tied]]]
            along = np.abs((turn.conj() * falling).real) / np.maximum(np.abs(turn), 1e-300)
            np.minimum.at(slope, of[tied], along)
            alone = np.ones(len(number), bool)
            alone[of[tied]] = False
            good = ~third
            found.append((number[good], place[good], before[good], after[good], slope[good], alone[good]))
            between = copy[index[nearest]][third]
            number = np.concatenate((number[third], number[third]))
            low, high = np.concatenate((low[third], t[third])), np.concatenate((t[third], high[third]))
            before, after = np.concatenate((before[third], between)), np.concatenate((between, after[third]))
        return BisectorPoints(*(np.concatenate(part) for part in zip(*found, strict=True)))

    def _equal(
        self,
        start: Complexes,
        stride: Complexes,
        low: Floats,
        high: Floats,
        mine: tuple[NDArray[np.int32], Ints],
        theirs: tuple[NDArray[np.int32], Ints],
    ) -> Floats:
        """Where on start + t stride, low <= t <= high, two copies are equally far; (n,).

        By the rule of Anderson and Bjorck, which keeps the root between two values of unlike sign and meets it faster
        than any power of halves does; one step of four is a halving, and all are where that has not met it.
        """

        def difference(t: Floats, active: Ints) -> Floats:
            place = start[active] + t * stride[active]
            least = []
            for element, of in (mine, theirs):
                index, point = owned_ranges(*_extent_of(of, active))
                distance = lengths(self._away(place[point], element[index]))
                least.append(np.minimum.reduceat(distance, starts(point)))
            return np.asarray(least[0] - least[1])

        active = np.arange(len(start))
        low, high = low.copy(), high.copy()
        at_low, at_high = difference(low, active), difference(high, active)
        best = np.where(np.abs(at_low) < np.abs(at_high), low, high)
        value = np.minimum(np.abs(at_low), np.abs(at_high))
        enough = self.rounding / 16
        active = active[(at_low < 0) & (at_high > 0) & (value > 0)]
        for count in range(_STEPS):
            if not len(active):
                break
            a, b, fa, fb = low[active], high[active], at_low[active], at_high[active]
            t = np.where(count % 4 == 3 or count >= _CHORDS, (a + b) / 2, b - fb * ((b - a) / (fb - fa)))
            t = np.clip(t, a, b)
            f = difference(t, active)
            closer = np.abs(f) < value[active]
            best[active[closer]], value[active[closer]] = t[closer], np.abs(f[closer])
            left = f < 0
            # The end that stays is weighed down, so that the next chord reaches beyond the root.
            weight_b = np.where(1 - f / fa > 0, 1 - f / fa, 0.5)
            weight_a = np.where(1 - f / fb > 0, 1 - f / fb, 0.5)
            low[active], at_low[active] = np.where(left, t, a), np.where(left, f, fa * weight_a)
            high[active], at_high[active] = np.where(left, b, t), np.where(left, fb * weight_b, f)
            done = (np.abs(f) <= enough) | ((high - low)[active] <= 4 * np.finfo(float).eps)
            active = active[~done]
        return best

    def _block(self, x: Floats, y: Floats) -> Ints:
        """The block of points; those on its far sides, or a hair outside the window, still belong to it."""
        down = len(self.candidates) // self.candidates.columns
        i = np.clip(np.floor(x / BLOCK).astype(np.intp), 0, self.candidates.columns - 1)
        j = np.clip(np.floor(y / BLOCK).astype(np.intp), 0, down - 1)
        return np.asarray(j * self.candidates.columns + i)

    def _away(self, place: Complexes, element: NDArray[np.int32]) -> Complexes:
        scene = self.candidates.scene
        return from_feet(place, scene.middle[element], scene.half[element])


_NOTHING = Near(np.zeros(0, np.intp), np.zeros(0, np.int64), np.zeros(0))


def _extent_of(sorted_owner: Ints, wanted: Ints) -> tuple[Ints, Ints]:
    """Where in an ascending array the entries equal to each wanted number begin and end."""
    return np.searchsorted(sorted_owner, wanted, side="left"), np.searchsorted(sorted_owner, wanted, side="right")


def _portions(sizes: Ints) -> list[slice]:
    """Cut a sequence of tasks into slices of about _PORTION in all."""
    total = np.cumsum(sizes)
    if not len(total):
        return []
    cuts = np.unique(np.searchsorted(total, np.arange(_PORTION, int(total[-1]) + _PORTION, _PORTION)) + 1)
    cuts = np.append(0, np.minimum(cuts, len(sizes)))
    return [slice(int(p), int(q)) for p, q in pairwise(cuts) if q > p]

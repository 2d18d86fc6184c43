"""Smooth runs of curves covered by the fewest stretches that something follows, with the error spread evenly."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from voronoi_tiles.base.arrays import Bools, Floats, Ints
from voronoi_tiles.paths.smooth_runs import last_up_to

Error: TypeAlias = Callable[[Ints, Floats, Floats], Floats]
"""How far what follows them is from stretches: of runs, from places to places."""

Order: TypeAlias = Literal[3, 6]
"""The power of a stretch's length with which the error grows: of biarcs, of cubic curves with the tangents given."""

_FULL = 0.99
"""A stretch is the longest when its error is above this part of the bound; errors grow with the third power or faster,
so it is at most 0.4 percent too short."""

_NARROW = 3e-3
"""It is also the longest when one that is longer by this part is too long."""

_AIM = 0.996
"""The part of the bound that the next trial aims at."""

_NO_LESS = 1e-3
"""Errors below this part of the bound are taken for as much: those of straight stretches are nothing but last bits, of
which no trial may depend."""

_ROUNDS = 3
"""How often breaks are moved to spread the error; each time brings the errors nearer by a factor of about ten."""

_UNITS = 2.0**30
"""Places are whole numbers of so many parts of a run."""

_STEPS = 12
"""Trials and moved breaks are at whole numbers of a power of two near 2^-12 of the stretch's length. Last bits, in
which processors differ, move an error by some 1e-12, and so no trial, but once in many millions."""

_BETWEEN = 0.382
"""What is this far beyond a whole number, or less, is rounded down to it: nothing has a reason to be just there."""


class Stretches(NamedTuple):
    """Stretches of runs in order: the run, and the places where each begins and ends."""

    run: Ints
    low: Floats
    high: Floats


class Rivals(NamedTuple):
    """Which rows are for one and the same run, of which only the one with the fewest curves is wanted.

    Row k is for the run `group[k]`; a cover by n stretches is worth `factor[k]` n - `less[k]` curves. It is given up
    when it cannot come below `best`, of each group, any more.
    """

    group: Ints
    factor: Ints
    less: Ints
    best: Ints

    def number(self, row: Ints, count: Ints) -> Ints:
        """How many curves rows with so many stretches have."""
        return np.asarray(self.factor[row] * count - self.less[row])

    def covered(self, row: Ints, count: Ints) -> Rivals:
        """After some rows were covered by so many stretches."""
        best = self.best.copy()
        np.minimum.at(best, self.group[row], self.number(row, count))
        return self._replace(best=best)

    def hopeful(self, row: Ints, count: Ints) -> Bools:
        """Which rows could be the best if they were covered by so many stretches."""
        return np.asarray(self.number(row, count) < self.best[self.group[row]])


class _Search(NamedTuple):
    """Searches for longest stretches, one row for each run that is not covered yet.

    A stretch that starts at `begin` may end at `low` (where it begins, as long as nothing better is known) with the
    error `low_error`, in units of the bound, and not at `high` (infinite until known) with `high_error`. `trial` is
    tried next, and `halve` says whether the last trial left more than half of what was between them. Places are whole
    numbers.
    """

    run: Ints
    begin: Floats
    low: Floats
    low_error: Floats
    high: Floats
    high_error: Floats
    trial: Floats
    halve: Bools

    def where(self, flags: Bools) -> _Search:
        """The rows with a flag."""
        return _Search._make(values[flags] for values in self)

    @classmethod
    def beginning(cls, run: Ints, begin: Floats, trial: Floats) -> _Search:
        """Stretches of which nothing is known."""
        zero, endless = np.zeros(len(run)), np.full(len(run), np.inf)
        return cls(run, begin, begin, zero, endless, endless, trial, np.zeros(len(run), np.bool_))

    def tried(self, error: Floats) -> _Search:
        """What is known after the trials, with their errors."""
        error = np.maximum(error, _NO_LESS)
        good = error <= 1.0
        low, high = np.where(good, self.trial, self.low), np.where(good, self.high, self.trial)
        return self._replace(
            low=low,
            low_error=np.where(good, error, self.low_error),
            high=high,
            high_error=np.where(good, self.high_error, error),
            halve=np.isfinite(self.high) & (high - low > 0.5 * (self.high - self.low)),
        )

    def aimed(self, order: Order) -> _Search:
        """With the next trial: where the error would be just below 1 if it grew with a power of the length.

        The power is `order` until two errors tell.
        """
        length, known, bounded = self.low - self.begin, self.low > self.begin, np.isfinite(self.high)
        with np.errstate(divide="ignore", invalid="ignore"):
            power = np.log(self.high_error / self.low_error) / np.log((self.high - self.begin) / length)
            up = length * (_AIM / self.low_error) ** (1 / np.where(bounded & np.isfinite(power), power, order))
            down = (self.high - self.begin) * _root(_AIM / self.high_error, order)
        room = np.where(bounded, self.high - self.low, 0.0)
        between = np.clip(
            np.where(known, up, np.maximum(down, 0.2 * room)),
            length + 0.02 * room,
            length + np.where(self.halve, 0.5, 0.98) * room,
        )
        between = np.where(self.halve & known, length + 0.5 * room, between)
        beyond = np.clip(up, 1.02 * length, 3.0 * length)
        length = np.where(known, length, self.high - self.begin)
        trial = _rounded(np.where(bounded, between, beyond), length, _STEPS)
        highest = np.minimum(self.high - 1.0, _UNITS)
        return self._replace(trial=np.clip(self.begin + trial, self.low + 1.0, highest))


def _rounded(values: Floats, length: Floats, steps: int) -> Floats:
    """Values as whole numbers of a power of two: about 2^-steps of a length each, 1 or more."""
    step = np.ldexp(1.0, np.maximum(np.frexp(length)[1] - steps, 0))
    return np.asarray(np.floor(values / step + (1.0 - _BETWEEN)) * step)


def _root(values: Floats, order: Order) -> Floats:
    """The `order`-th roots."""
    cube = np.cbrt(values)
    return cube if order == 3 else np.sqrt(cube)


def longest_stretches(
    total: Floats, bound: float, error_of: Error, order: Order, rivals: Rivals | None = None
) -> Stretches:
    """Cover runs by stretches whose error is within the bound, each as long as can be; all runs side by side.

    `total` is the place where each run ends; the first is 0. Errors grow with about the power `order` of the length.
    Of `rivals`, those that are given up have no stretches.
    """
    unit, rows = total / _UNITS, len(total)
    search = _Search.beginning(np.arange(rows), np.zeros(rows), np.full(rows, _UNITS))
    found: list[tuple[Ints, Floats, Floats]] = []
    count, left = np.zeros(rows, np.intp), np.ones(rows, np.bool_)
    while len(search.run):
        scale = unit[search.run]
        search = search.tried(error_of(search.run, search.begin * scale, search.trial * scale) / bound)
        length = search.low - search.begin
        full = (search.low == search.trial) & (search.low_error >= _FULL)
        done = full | (search.low >= _UNITS) | (search.high - search.low <= np.maximum(_NARROW * length, 1.0))
        ready = search.where(done)
        assert np.all(ready.low > ready.begin), "the accuracy is too fine"
        found.append((ready.run, ready.begin, ready.low))
        count[ready.run] += 1
        # The next stretch begins where this one ends, and is tried at the same length.
        after = _Search.beginning(ready.run, ready.low, np.minimum(ready.low + length[done], _UNITS))
        going = search.where(~done).aimed(order)
        search = _Search(*(np.concatenate(pair) for pair in zip(going, after, strict=True)))
        search = search.where(search.begin < _UNITS)
        if rivals is not None:
            whole = ready.run[ready.low >= _UNITS]
            rivals = rivals.covered(whole, count[whole])
            hopeful = rivals.hopeful(search.run, count[search.run] + 1)
            left[search.run[~hopeful]] = False
            search = search.where(hopeful)
    run, begin, low = (np.concatenate(parts) for parts in zip(*found, strict=True))
    along = np.lexsort((begin, run))
    along = along[left[run[along]]]
    run = run[along]
    return Stretches(run, begin[along] * unit[run], low[along] * unit[run])


def even_stretches(total: Floats, stretches: Stretches, bound: float, error_of: Error, order: Order) -> Stretches:
    """Move the breaks between stretches so that their errors become alike, where all stay within the bound."""
    first = np.searchsorted(stretches.run, np.arange(len(total)))
    best = stretches
    error = error_of(*best)
    worst = np.maximum.reduceat(error, first)
    trial, trial_error = best, error
    for _ in range(_ROUNDS):
        trial = _moved(total, trial, trial_error / bound, first, order)
        trial_error = error_of(*trial)
        trial_worst = np.maximum.reduceat(trial_error, first)
        better = (trial_worst < worst)[stretches.run]
        best = Stretches(best.run, np.where(better, trial.low, best.low), np.where(better, trial.high, best.high))
        worst = np.minimum(worst, trial_worst)
    return best


def _moved(total: Floats, stretches: Stretches, error: Floats, first: Ints, order: Order) -> Stretches:
    """Cut each run into as many stretches again, of equal shares of the root of the error."""
    run = stretches.run
    offsets = np.append(first, len(run))
    count = np.diff(offsets)[run]
    root = _root(np.clip(error, 1e-6, 1e3), order)
    weight = np.ceil(root * 2.0**30).astype(np.int64)  # whole numbers add up without rounding
    sums = np.append(0, np.cumsum(weight))
    whole = (sums[offsets[1:]] - sums[first])[run]
    before = (sums[:-1] - sums[first][run]).astype(np.float64)
    number = np.arange(len(run)) - first[run]
    target = whole * (number / count)
    at = last_up_to(before, offsets, run, target)
    share = (target - before[at]) / weight[at]
    unit = total[run] / _UNITS
    begin, length = np.rint(stretches.low[at] / unit), np.rint((stretches.high - stretches.low)[at] / unit)
    low = np.where(number == 0, 0.0, (begin + _rounded(share * length, length, _STEPS)) * unit)
    last = number == count - 1
    return Stretches(run, low, np.where(last, total[run], np.append(low[1:], 0.0)))

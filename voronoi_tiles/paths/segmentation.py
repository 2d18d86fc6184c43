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

_ROUNDS = 3
"""How often breaks are moved to spread the error; each time brings the errors nearer by a factor of about ten."""


class Stretches(NamedTuple):
    """Stretches of runs in order: the run, and the places where each begins and ends."""

    run: Ints
    low: Floats
    high: Floats


class _Search(NamedTuple):
    """Searches for longest stretches, one row for each run that is not covered yet.

    A stretch that starts at `begin` may end at `low` (where it begins, as long as nothing better is known) with the
    error `low_error`, in units of the bound, and not at `high` (infinite until known) with `high_error`. `trial` is
    tried next, and `halve` says whether the last trial left more than half of what was between them.
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
        return self._replace(trial=self.begin + np.where(bounded, between, beyond))


def _root(values: Floats, order: Order) -> Floats:
    """The `order`-th roots."""
    cube = np.cbrt(values)
    return cube if order == 3 else np.sqrt(cube)


def longest_stretches(total: Floats, bound: float, error_of: Error, order: Order) -> Stretches:
    """Cover runs by stretches whose error is within the bound, each as long as can be; all runs side by side.

    `total` is the place where each run ends; the first is 0.
    Errors grow with about the power `order` of the length.
    """
    search = _Search.beginning(np.arange(len(total)), np.zeros(len(total)), total)
    found: list[tuple[Ints, Floats, Floats]] = []
    while len(search.run):
        search = search.tried(error_of(search.run, search.begin, search.trial) / bound)
        length = search.low - search.begin
        full = (search.low == search.trial) & (search.low_error >= _FULL)
        done = full | (search.low >= total[search.run]) | (search.high - search.low <= _NARROW * length)
        ready = search.where(done)
        found.append((ready.run, ready.begin, ready.low))
        # The next stretch begins where this one ends, and is tried at the same length.
        after = _Search.beginning(ready.run, ready.low, ready.low + length[done])
        going = search.where(~done).aimed(order)
        search = _Search(*(np.concatenate(pair) for pair in zip(going, after, strict=True)))
        end = total[search.run]
        search = search._replace(trial=np.minimum(search.trial, end)).where(search.begin < end)
        assert np.all((search.trial > search.low) & (search.trial < search.high)), "the accuracy is too fine"
    run, begin, low = (np.concatenate(parts) for parts in zip(*found, strict=True))
    along = np.lexsort((begin, run))
    return Stretches(run[along], begin[along], low[along])


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
    low = np.where(number == 0, 0.0, stretches.low[at] + share * (stretches.high[at] - stretches.low[at]))
    last = number == count - 1
    return Stretches(run, low, np.where(last, total[run], np.append(low[1:], 0.0)))

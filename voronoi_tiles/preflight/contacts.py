"""Where cut lines meet: along a length (cut twice), crossing, or touching."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.preflight.chord_distance import cross, distinct, divisor, dot, nearest, runs
from voronoi_tiles.preflight.chord_search import FOUND_MAX, pairs, too_many
from voronoi_tiles.preflight.chords import Chords
from voronoi_tiles.preflight.coincidence import NearChords, Runs, judge_runs, near_all_the_way

OVERLAP: Final = 40.0
"""From which length on lines that run along each other are cut twice; in tolerances. Two lines that part at an angle of
a degree and a half stay within one tolerance for as long."""

MOST: Final = 0.9
"""The same as a share of the shorter path, for those that are short altogether."""

AROUND: Final = 4.0
"""How far from a meeting place it is seen which way the lines go on; in tolerances."""

_PARALLEL: Final = np.sin(np.radians(15.0))


@dataclass(frozen=True, eq=False)
class Contacts:
    """Pairs of chords that are within the tolerance.

    `one` and `two` are the chords, `at_one` and `at_two` the lengths along their paths where they are nearest, `point`
    that place and `distance` how near. Along path one they run along each other from `low` to `high`, the same length
    where they only meet.
    """

    one: Ints
    two: Ints
    at_one: Floats
    at_two: Floats
    point: Complexes
    distance: Floats
    low: Floats
    high: Floats

    def take(self, which: Ints | Bools) -> Contacts:
        """Some of the pairs."""
        return Contacts(*(getattr(self, column.name)[which] for column in fields(self)))


class Meeting(NamedTuple):
    """A place where two paths meet: `length` is how far they stay within the tolerance, 0 where that is not known."""

    place: complex
    paths: tuple[int, int]
    length: float


def find_contacts(chords: Chords, tolerance: float) -> Contacts:
    """All pairs of chords within the tolerance, except neighbours on a path that do not turn back.

    Raises DrawingError where there are more than FOUND_MAX.
    """
    found = []
    count = 0
    for first, second in pairs(chords, tolerance):
        near = nearest(chords, first, second)
        close = near.distance <= tolerance
        count += int(np.count_nonzero(close))
        if count > FOUND_MAX:
            raise too_many("cross or lie on each other")
        one, two = first[close], second[close]
        at_one = chords.before[one] + near.share_one[close] * chords.lengths[one]
        at_two = chords.before[two] + near.share_two[close] * chords.lengths[two]
        low, high = run_beside(chords, one, two, tolerance)
        found.append(
            Contacts(
                one,
                two,
                at_one,
                at_two,
                near.one[close],
                near.distance[close],
                np.where(high > low, chords.before[one] + low, at_one),
                np.where(high > low, chords.before[one] + high, at_one),
            )
        )
    found.append(_turning_back(chords, tolerance))
    return Contacts(*(np.concatenate([getattr(part, column.name) for part in found]) for column in fields(Contacts)))


def _turning_back(chords: Chords, tolerance: float) -> Contacts:
    """The neighbours on a path of which the second goes back over the first."""
    one = np.arange(len(chords.start))
    two = chords.next(one)
    one, two = one[two >= 0], two[two >= 0]
    way = dot(chords.end[one] - chords.start[one], chords.end[two] - chords.start[two])
    back = (way < 0.0) & (one != two)
    one, two = one[back], two[back]
    low, high = run_beside(chords, one, two, tolerance)
    over = high > low
    one, two, low, high = one[over], two[over], low[over], high[over]
    return Contacts(
        one,
        two,
        chords.before[one] + chords.lengths[one],
        chords.before[two],
        chords.end[one],
        np.zeros(len(one)),
        chords.before[one] + low,
        chords.before[one] + high,
    )


def run_beside(chords: Chords, one: Ints, two: Ints, tolerance: float) -> tuple[Floats, Floats]:
    """From where to where along the first chord the second runs beside it, within the tolerance."""
    a, b, c, d = chords.start[one], chords.end[one], chords.start[two], chords.end[two]
    length, other = chords.lengths[one], chords.lengths[two]
    along = (b - a) / divisor(length)
    begin, end = dot(c - a, along), dot(d - a, along)
    beside, beside_end = cross(along, c - a), cross(along, d - a)
    low, high = np.maximum(np.minimum(begin, end), 0.0), np.minimum(np.maximum(begin, end), length)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        slope = (beside_end - beside) / (end - begin)
        bounds = np.sort(np.stack(((-tolerance - beside) / slope, (tolerance - beside) / slope)) + begin, axis=0)
    level = np.abs(beside_end - beside) <= 1e-9 * tolerance
    low = np.where(level, low, np.maximum(low, np.nan_to_num(bounds[0], nan=0.0)))
    high = np.where(level, high, np.minimum(high, np.nan_to_num(bounds[1], nan=0.0)))
    none = np.abs(beside_end - beside) > _PARALLEL * other
    none |= level & (np.abs(beside) > tolerance)
    return low, np.where(none, low, high)


class Alongs(NamedTuple):
    """Where paths run along each other: lines drawn twice, curves that cross, and that touch.

    `part` (bool, as many as there are contacts) are the contacts of which nothing else is to be said.
    """

    twice: list[Meeting]
    crossed: list[Meeting]
    touched: list[Meeting]
    part: Bools


def overlaps(chords: Chords, paths: Paths, contacts: Contacts, tolerance: float) -> Alongs:
    """Where paths run along each other, and which contacts belong to that."""
    path_one, path_two = chords.path[contacts.one], chords.path[contacts.two]
    order, begins = runs(path_one, path_two, contacts.low, contacts.high, AROUND * tolerance)
    part = np.zeros(len(order), np.bool_)
    if not len(order):
        return Alongs([], [], [], part)
    low, high = contacts.low[order], contacts.high[order]
    # What only meets beside a run makes it no longer.
    beside = high > low
    first = np.minimum.reduceat(np.where(beside, low, np.inf), begins)
    last = np.maximum.reduceat(np.where(beside, high, -np.inf), begins)
    one, two = path_one[order][begins], path_two[order][begins]
    group = np.repeat(np.arange(len(begins)), np.diff(np.append(begins, len(order))))
    whole = _round_rings(chords, one, two, first, last, AROUND * tolerance)
    low = np.where(whole[group] == group, low, low - chords.total[one[group]])
    group = whole[group]
    shorter = np.minimum(chords.total[one], chords.total[two])
    length = np.where(last > first, last - first, 0.0)
    least = np.minimum(OVERLAP * tolerance, np.maximum(MOST * shorter, AROUND * tolerance))
    long = np.flatnonzero(((length > 2 * AROUND * tolerance) | (length >= least)) & (whole == np.arange(len(whole))))
    number = np.full(len(begins), -1)
    number[long] = np.arange(len(long))
    some = np.flatnonzero(beside & (number[group] >= 0))
    some = some[np.lexsort((low[some], number[group][some]))]
    near = NearChords(number[group][some], low[some], contacts.two[order][some])
    if not len(long):
        return Alongs([], [], [], part)
    every = np.arange(len(long))
    stretch = Runs(
        one[long], two[long], first[long], last[long], near.at(every, first[long]), near.at(every, last[long])
    )
    judged = judge_runs(chords, paths, stretch, near, tolerance, OVERLAP * tolerance)
    said = judged.twice & (length[long] >= least[long]) | judged.crosses | judged.touches | judged.joins
    part[order] = (number[group] >= 0) & said[number[group]]
    # What else they have in common says nothing more of lines that are drawn twice all along.
    pair = one * len(chords.total) + two
    part[order] |= np.isin(pair[group], pair[long[judged.covered]])
    middle, _ = chords.along(stretch.one, (stretch.low + stretch.high) / 2)
    place = np.where(judged.twice, middle, judged.place)

    def meetings(which: Bools) -> list[Meeting]:
        """Those of the runs that are said, with their places."""
        return [
            Meeting(complex(place[k]), (int(stretch.one[k]), int(stretch.two[k])), float(stretch.length[k]))
            for k in np.flatnonzero(said & which)
        ]

    return Alongs(meetings(judged.twice), meetings(judged.crosses), meetings(judged.touches), part)


def _round_rings(chords: Chords, one: Ints, two: Ints, first: Floats, last: Floats, slack: float) -> Ints:
    """The run that each run is part of: those at the beginning and at the end of a ring are one.

    The first of two then begins before the ring's beginning: `first` is changed.
    """
    whole = np.arange(len(one))
    total = chords.total[one]
    heads = np.flatnonzero(chords.ring[one] & (first <= slack) & (last < total - slack))
    tails = np.flatnonzero(chords.ring[one] & (last >= total - slack) & (first > slack) & (last > first))
    of = {(int(one[k]), int(two[k])): int(k) for k in tails.tolist()}
    for head in heads.tolist():
        tail = of.get((int(one[head]), int(two[head])))
        if tail is not None:
            whole[tail] = head
            first[head] = first[tail] - total[head]
    return whole


def crossings(
    chords: Chords, paths: Paths, contacts: Contacts, tolerance: float
) -> tuple[list[Meeting], list[Meeting]]:
    """Where paths cross, and where they touch and part on the same side.

    Not where one of them ends, and not at a point that both have as a node: there lines are joined. Lines that pass
    there from one side of the other to the other side cross.
    """
    path_one, path_two = chords.path[contacts.one], chords.path[contacts.two]
    order, begins = runs(path_one, path_two, contacts.low, contacts.high, AROUND * tolerance)
    if not len(order):
        return [], []
    group = np.repeat(np.arange(len(begins)), np.diff(np.append(begins, len(order))))
    best = order[np.lexsort((contacts.distance[order], group))[begins]]
    chosen = contacts.take(best)
    one, two = path_one[best], path_two[best]
    away_one = chords.apart(path_one[order], chosen.at_one[group], contacts.at_one[order])
    away_two = chords.apart(path_two[order], chosen.at_two[group], contacts.at_two[order])
    reach = AROUND * tolerance
    sides = []
    inside = np.ones(len(best), np.bool_)
    for path, at, away in ((one, chosen.at_one, away_one), (two, chosen.at_two, away_two)):
        for least, sign in ((np.minimum, -1.0), (np.maximum, 1.0)):
            point, on = chords.along(path, at + least.reduceat(away, begins) + sign * reach)
            sides.append(point)
            inside &= on
    # A sharp corner is near to itself, too.
    own = np.where(one == two, np.abs(chords.apart(one, chosen.at_one, chosen.at_two)), np.inf)
    narrow = np.minimum.reduceat(
        np.where(
            (path_one == path_two)[order],
            np.abs(chords.apart(path_one[order], contacts.at_one[order], contacts.at_two[order])),
            np.inf,
        ),
        begins,
    )
    inside &= np.minimum(own, narrow) > 2 * reach
    inside &= ~((one == two) & near_all_the_way(chords, one, chosen.at_one, chosen.at_two, tolerance))
    joined = _at_node(chords, paths, chosen.one, chosen.point, tolerance) & _at_node(
        chords, paths, chosen.two, chosen.point, tolerance
    )
    before, after, other, beyond = (side - chosen.point for side in sides)
    # A line that goes back over itself may have the same point on both sides: no way has the angle 0.
    with np.errstate(divide="ignore", invalid="ignore"):
        sweep = np.mod(np.angle(after * before.conj()), 2 * np.pi)
        within = [np.mod(np.angle(way * before.conj()), 2 * np.pi) < sweep for way in (other, beyond)]
    crossed = within[0] != within[1]
    kept = inside & ~joined
    return tuple(  # type: ignore[return-value]
        _distinct(chords, chosen, np.flatnonzero(kept & side), reach) for side in (crossed, ~crossed)
    )


def _at_node(chords: Chords, paths: Paths, chord: Ints, point: Complexes, tolerance: float) -> Bools:
    """Whether points on chords are at an end of their piece."""
    piece = chords.piece[chord]
    off = np.minimum(np.abs(paths.start[piece] - point), np.abs(paths.end[piece] - point))
    return np.asarray(off <= 2 * tolerance, np.bool_)


def _distinct(chords: Chords, chosen: Contacts, which: Ints, reach: float) -> list[Meeting]:
    """Meetings, each place of two paths once."""
    some = chosen.take(which)
    pairs = list(zip(chords.path[some.one].tolist(), chords.path[some.two].tolist(), strict=True))
    return [Meeting(complex(some.point[k]), pairs[k], 0.0) for k in distinct(pairs, some.point, 2 * reach)]

"""The published eigenvalue method of Escherization: the polygon of an isohedral type that is nearest to a goal.

A tile is a polygon of n points, so many on each edge of a template; what pairs its edges (translations, rotations, half
turns, glides) makes the tiles of a template with given numbers a linear space. Nearest is meant as for Procrustes: by
the squares of the distances of corresponding points, the goal turned as is best, which is an eigenvalue problem.

Sources: Koizumi and Sugihara, Maximum eigenvalue problem for Escherization, Graphs Comb. 27 (2011); Imahori and Sakai,
A local-search based algorithm for the Escherization problem, IEEM 2012; Nagata and Imahori, An efficient exhaustive
search algorithm for the Escherization problem, Algorithmica 82 (2020), arXiv 1912.09605: the nine most general types,
all numbers of points on the edges, all points of the goal to begin at. The other types without reflections are these
with edges of no length.

Here a distance costs the same for all n, so that all numbers are tried: given how tiles are copied, each point of the
tile lies in the middle of what is mapped onto it, and what that leaves is sums of products of two points of the goal,
which are differences of two sums that are in a table. How tiles are copied is a few numbers, a system of linear
equations.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from isohedral import TEMPLATES, Complexes, Floats, Ints, Template
from numpy.typing import NDArray

KEPT = 100
"""How many numbers of points and beginnings of each type are followed to more points; a count."""

ROUNDS = 8
"""How often these are changed by one point at most, with each number of points; a count."""

FINEST = 120
"""The number of points of the tiles that are given; a count."""

_AT_ONCE = 200_000
"""Distances that are computed at once; a count. Bounds the memory."""


class Goal:
    """A goal polygon's points about their centre, complex128 (n,), counter-clockwise; and the tables of its sums."""

    def __init__(self, points: Complexes) -> None:
        self.points = points - points.mean()
        count = len(points)
        self.count = count
        again = np.tile(self.points, 3)
        self.again = again
        self.sums = _summed(again)
        self.squares = _summed(np.abs(again) ** 2)
        at = np.arange(3 * count)
        row = np.arange(count)[:, None]
        # Products with what stands before and behind a common place, and with what stands a step ahead.
        self.facing = _summed(again * self.points[(row - at) % count].conj())
        self.ahead = _summed(again * self.points[(row + at) % count])


def _summed(values: NDArray[np.generic]) -> NDArray[np.generic]:
    """The sums of all that comes before each place, along the last axis."""
    sums = np.zeros((*values.shape[:-1], values.shape[-1] + 1), values.dtype)
    np.cumsum(values, axis=-1, out=sums[..., 1:])
    return sums


class _Moments(NamedTuple):
    """Of a goal that is turned by an angle: C is constant + Re(turning exp(2i angle)), the sums R are two columns' mix.

    The squares of the distances that the tile leaves are C - R' H R, H being `Template.solving`.
    """

    constant: Floats
    turning: Complexes
    differences: Floats  # (..., 2g, 2): of the goal as it is, and turned by a quarter


def _moments(template: Template, goal: Goal, numbers: Ints, begin: Ints) -> _Moments:
    """The sums over all pairs of points; `numbers` (..., g) and `begin` (...) broadcast."""
    w, count = goal.again, goal.count
    start = np.cumsum(numbers[..., list(template.edges)], axis=-1) - numbers[..., list(template.edges)]
    shape = np.broadcast_shapes(numbers.shape[:-1], begin.shape)
    constant, turning = np.zeros(shape), np.zeros(shape, complex)
    differences = np.empty((*shape, 2 * len(template.pairings), 2))
    for g, ((kind, edge, onto), factor) in enumerate(zip(template.pairings, template.factors, strict=True)):
        inner, first, last = template.weights(g)
        steps = numbers[..., g]
        a, b = begin + start[..., edge], begin + start[..., onto]
        glide = kind in "GH"
        at_first, at_last = (b, b + steps) if glide else (b + steps, b)
        own = inner * (goal.sums[a + steps] - goal.sums[a + 1]) + first * w[a] + last * w[a + steps]
        other = inner * (goal.sums[b + steps] - goal.sums[b + 1]) + first * w[at_first] + last * w[at_last]
        for c, d, e in ((a, a, a + steps), (b, at_first, at_last)):
            constant += inner * (goal.squares[c + steps] - goal.squares[c + 1])
            constant += first * np.abs(w[d]) ** 2 + last * np.abs(w[e]) ** 2
        if glide:
            row = (b - a) % count
            product = inner * (goal.ahead[row, a + steps] - goal.ahead[row, a + 1])
            product += first * w[a] * w[b] + last * w[a + steps] * w[b + steps]
            turning -= 2 * factor * product
            columns = other - factor * own.conj(), 1j * (other + factor * own.conj())
        else:
            row = (a + b + steps) % count
            product = inner * (goal.facing[row, a + steps] - goal.facing[row, a + 1])
            product += first * w[a] * w[b + steps].conj() + last * w[a + steps] * w[b].conj()
            constant -= 2 * (factor * product).real
            columns = other - factor * own, 1j * (other - factor * own)
        for column, values in enumerate(columns):
            differences[..., 2 * g, column], differences[..., 2 * g + 1, column] = values.real, values.imag
    return _Moments(constant, turning, differences)


def _forms(moments: _Moments, solving: Floats) -> Floats:
    """What is left as a quadratic form of the cosine and the sine of the goal's angle: its entries 11, 12, 22."""
    taken = np.einsum("...ia,...ij,...jb->...ab", moments.differences, solving, moments.differences, optimize=True)
    return np.stack(
        (
            moments.constant + moments.turning.real - taken[..., 0, 0],
            -moments.turning.imag - taken[..., 0, 1],
            moments.constant - moments.turning.real - taken[..., 1, 1],
        ),
        axis=-1,
    )


def _least(forms: Floats) -> Floats:
    """The smaller eigenvalue of each form."""
    a, b, c = np.moveaxis(forms, -1, 0)
    return np.asarray((a + c) / 2 - np.hypot((a - c) / 2, b))


def distances(template: Template, goal: Goal, numbers: Ints, begin: Ints) -> Floats:
    """The least sums of squared distances of the goal and tiles with these numbers that begin there, each of m."""
    parts = []
    for first in range(0, len(numbers), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        moments = _moments(template, goal, numbers[some], begin[some])
        parts.append(_least(_forms(moments, template.solving(numbers[some]))))
    return np.concatenate(parts)


@cache
def _everything(name: str, points: int) -> tuple[Ints, Floats]:
    """All numbers of a type, and what solves for its translations: the same for all goals."""
    template = Template(name, TEMPLATES[name])
    numbers = template.numbers(points)
    return numbers, template.solving(numbers)


def exhaustive(template: Template, goal: Goal, kept: int) -> tuple[Ints, Ints]:
    """Of all numbers and all beginnings the best: intp (kept, g) and (kept,)."""
    numbers, solving = _everything(template.name, goal.count)
    begin = np.arange(goal.count)
    portion = max(1, _AT_ONCE // goal.count)
    found = []
    for first in range(0, len(numbers), portion):
        some = slice(first, first + portion)
        moments = _moments(template, goal, numbers[some, None], begin)
        left = _least(_forms(moments, solving[some, None]))
        best = np.argpartition(left.ravel(), min(kept, left.size - 1))[:kept]
        found.append((left.ravel()[best], first + best // goal.count, best % goal.count))
    left, row, at = (np.concatenate(part) for part in zip(*found, strict=True))
    order = np.argsort(left, kind="stable")[:kept]
    return numbers[row[order]], at[order]


def climbed(template: Template, goal: Goal, numbers: Ints, begin: Ints, kept: int) -> tuple[Ints, Ints, Floats]:
    """The best of these and of what changes by one at most lead to, step by step, with their distances."""
    rows = np.column_stack((numbers, begin))
    left = distances(template, goal, numbers, begin)
    fresh = rows
    for _ in range(ROUNDS):
        near = (fresh[:, None] + template.moves).reshape(-1, rows.shape[1])
        near = near[(near[:, :-1] >= 1).all(axis=1)]
        near[:, -1] %= goal.count
        near = np.unique(near, axis=0)
        known = {row.tobytes() for row in rows}
        near = near[[row.tobytes() not in known for row in near]]
        if not len(near):
            break
        both = np.concatenate((rows, near))
        all_left = np.concatenate((left, distances(template, goal, near[:, :-1], near[:, -1])))
        order = np.argsort(all_left, kind="stable")[:kept]
        fresh = both[order[order >= len(rows)]]
        rows, left = both[order], all_left[order]
        if not len(fresh):
            break
    return rows[:, :-1], rows[:, -1], left


class Tile(NamedTuple):
    """A polygon of a type, complex128 (n,), beside the goal as it is: `left` is the sum of their squared distances.

    `numbers` are the steps along the edges of each pairing, the first from `begin` on. `maps` are the factor and the
    translation of each pairing, conj saying whether it is a glide: these make the tile's neighbours.
    """

    template: str
    numbers: tuple[int, ...]
    begin: int
    left: float
    points: Complexes
    maps: tuple[tuple[complex, complex, bool], ...]


def tile_of(template: Template, goal: Goal, numbers: Ints, begin: int) -> Tile:
    """The nearest tile with these numbers."""
    moments = _moments(template, goal, numbers[None], np.array([begin]))
    solving = template.solving(numbers[None])
    a, b, c = _forms(moments, solving)[0].tolist()
    # The eigenvector of the smaller eigenvalue.
    angle = math.atan2(2 * b, a - c) / 2 + math.pi / 2
    turn = cmath.exp(1j * angle)
    translations = solving[0] @ moments.differences[0] @ (turn.real, turn.imag)
    shifts = translations[::2] + 1j * translations[1::2]
    w = np.roll(goal.points, -begin) * turn
    tile = np.zeros(len(w), complex)
    edges = list(template.edges)
    start = np.append(0, np.cumsum(numbers[edges]))
    maps = []
    for g, ((kind, edge, onto), factor, shift) in enumerate(
        zip(template.pairings, template.factors, shifts.tolist(), strict=True)
    ):
        glide = kind in "GH"
        maps.append((factor, complex(shift), glide))
        at = np.arange(1, numbers[g])
        own, other = start[edge] + at, start[onto] + (at if glide else numbers[g] - at)
        middle = (w[own] + _moved(w[other], _inverse(maps[-1]))) / 2
        tile[own], tile[other] = middle, _moved(middle, maps[-1])
        if kind in {"C3", "C4", "C6"}:
            tile[start[onto]] = shift / (1 - factor)
    for corner in {corner for _, *corners in template.relations for corner in corners}:
        seen = [w[start[corner]]]
        for g, a_, b_ in template.relations:
            if corner == a_:
                seen.append(_moved(w[start[b_]], _inverse(maps[g])))
            if corner == b_:
                seen.append(_moved(w[start[a_]], maps[g]))
        tile[start[corner]] = sum(seen) / len(seen)
    left = float((np.abs(tile - w) ** 2).sum())
    # Back to where the goal is.
    back = []
    for factor, shift, glide in maps:
        linear = factor * turn.conjugate() ** 2 if glide else factor
        back.append((linear, shift * turn.conjugate(), glide))
    points = np.roll(tile * turn.conjugate(), begin)
    return Tile(template.name, tuple(numbers.tolist()), begin, left, points, tuple(back))


def _moved(z: Complexes, by: tuple[complex, complex, bool]) -> Complexes:
    factor, shift, conj = by
    return factor * (z.conj() if conj else z) + shift


def _inverse(by: tuple[complex, complex, bool]) -> tuple[complex, complex, bool]:
    factor, shift, conj = by
    back = factor if conj else 1 / factor
    return back, -back * (shift.conjugate() if conj else shift), conj


def nearest_tiles(sampled: Sequence[Complexes], count: int) -> Iterator[Tile]:
    """The nearest tiles of all types to a goal, so many of each, the nearest first.

    `sampled` are the goal's points, counter-clockwise, ever twice as many: 30, 60 and 120, the coarser ones among the
    finer. All numbers are tried with 60 points, of IH4, which has five of them, with 30; the best are followed. (Of
    four icons 60 points gave the same tiles of IH4, in twenty times the time.)
    """
    goals = [Goal(points) for points in sampled]
    for name, pairings in TEMPLATES.items():
        template = Template(name, pairings)
        first = 0 if len(pairings) > 4 else 1
        numbers, begin = exhaustive(template, goals[first], KEPT)
        for goal in goals[first + 1 :]:
            numbers, begin, _ = climbed(template, goal, 2 * numbers, 2 * begin, KEPT)
        for row, at in zip(numbers[:count], begin[:count].tolist(), strict=True):
            yield tile_of(template, goals[-1], row, at)

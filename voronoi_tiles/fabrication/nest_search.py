"""Places for pieces on a rectangle, by spyrrow: strip packing of a number of pieces, and a search for the number.

spyrrow lays given polygons into a strip of a height, as short as it can in a time. So a number of pieces is laid; of
those that reach beyond the sheet's width the rest is dropped; and what was learnt of the density says how many
are laid next. Its answers are in single precision, and a search that the clock ends is not repeatable.

Source: J. Gardeyn, G. Vanden Berghe and T. Wauters, An open-source heuristic to reboot 2D nesting research, 2025: the
heuristic is called sparrow.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from importlib import import_module
from threading import Thread
from time import monotonic
from typing import Any, Final, NamedTuple, Self

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, plane
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.fabrication.job_options import JobError

HEADROOM_MM: Final = 1e-3
"""What a strip is higher than the sheet; millimetres. A piece that fits exactly is refused by single precision."""

_DENSITY: Final = 0.62
"""The share of the strip that the first number of pieces would fill."""

_SHARES: Final = (0.2, 0.35, 0.45)
"""How the time is shared among the numbers that are tried; below _SHORT_S one has all of it."""

_SHORT_S: Final = 8.0

_HOPE: Final = 1.04
"""By how much more time is hoped to make layouts denser; a factor."""

_EVEN: Final = 0.8
"""The least part of its share that each kind has, lest there be many of what is small."""

_WATCH_S: Final = 0.1
"""How often the search is looked after; seconds."""

Progress = Callable[[float, float], None]
"""Is told how many seconds of how many have passed."""


class NestItem(NamedTuple):
    """A polygon that is laid (complex128, n), what share of all pieces it makes, the turns it may take (None: any).

    It may be the image of the item number `like`, turned by `unit`, after it was `mirrored` in the x axis.
    """

    ring: Complexes
    share: float
    turns: tuple[float, ...] | None
    like: int | None = None
    unit: complex = 1 + 0j
    mirrored: bool = False


class NestPlaces(NamedTuple):
    """Where pieces lie: which item each is, intp (n,), and z -> unit_at(turn) z + shift; turns in degrees."""

    item: Ints
    turn: Floats
    shift: Complexes

    @classmethod
    def none(cls) -> Self:
        """No places."""
        return cls(np.zeros(0, np.intp), np.zeros(0), np.zeros(0, np.complex128))

    @classmethod
    def joined(cls, *parts: NestPlaces) -> Self:
        """All of some places."""
        return cls(*(np.concatenate(columns) for columns in zip(cls.none(), *parts, strict=True)))

    def rows(self) -> list[tuple[int, float, complex]]:
        """Item, turn and shift of each."""
        return list(zip(*(part.tolist() for part in self), strict=True))

    def moved(self, turn: float, shift: complex) -> NestPlaces:
        """All of them turned about 0 by degrees, and moved."""
        return NestPlaces(self.item, (self.turn + turn) % 360.0, self.shift * unit_at(turn) + shift)

    def take(self, which: Ints) -> NestPlaces:
        """Some of them."""
        return NestPlaces(self.item[which], self.turn[which], self.shift[which])


def least_counts(share: Floats, count: int) -> Floats:
    """How many of each kind are among so many pieces at least where each nearly has its share, float64 (n,)."""
    return np.floor(_EVEN * share * count)


def counts_of(items: Sequence[NestItem], count: int) -> Ints:
    """How many of each item make so many pieces: their shares, the largest remainders rounded up."""
    wanted = count * np.array([item.share for item in items])
    whole = np.floor(wanted + 1e-9).astype(np.intp)
    order = np.argsort(whole - wanted, kind="stable")
    whole[order[: count - int(whole.sum())]] += 1
    return whole


def most_pieces(
    items: Sequence[NestItem],
    size: tuple[float, float],
    known: NestPlaces,
    effort: float,
    seed: int,
    watch: Callable[[float], None] = lambda _: None,
) -> NestPlaces:
    """The most pieces that fit into a rectangle from 0 to `size`: those `known`, or more found in `effort` seconds.

    `watch` is told of the seconds that passed. spyrrow has to be installed. Raises JobError where it gives up, as for
    an item that does not fit by itself, and none are known.
    """
    width, height = size
    each = sum(item.share * ring_area(item.ring) for item in items)
    density, hope, best = _DENSITY, 1.0, known
    begun = monotonic()
    for share in _SHARES if effort >= _SHORT_S else (1.0,):
        count = max(math.floor(hope * density * width * height / each), len(best.item) + 1)
        hope = _HOPE
        seconds = max(1, round(effort * share))
        demand = counts_of(items, count)
        try:
            found = strip(items, demand, height, seconds, seed, lambda now: watch(now - begun))
        except JobError:
            if not len(best.item):
                raise
            break
        reach = _right_ends(items, found)
        density = count * each / (float(reach.max()) * height)
        fitting = found.take(np.flatnonzero(reach <= width))
        best = max(best, fitting, key=lambda places: len(places.item))
    return best


def strip(
    items: Sequence[NestItem], demand: Ints, height: float, seconds: int, seed: int, watch: Callable[[float], None]
) -> NestPlaces:
    """Lay so many of each item into a strip of a height, as short as can be in a time."""
    import spyrrow

    kinds = [
        spyrrow.Item(str(k), list(map(tuple, plane(item.ring).tolist())), int(count), item.turns)
        for k, (item, count) in enumerate(zip(items, demand, strict=True))
        if count
    ]
    instance = spyrrow.StripPackingInstance("sheet", height + HEADROOM_MM, kinds)
    config = spyrrow.StripPackingConfig(total_computation_time=seconds, seed=seed)
    done: list[Any] = []

    def solve() -> None:
        """Solve, and keep what comes of it."""
        try:
            done.append(instance.solve(config))
        except BaseException as error:  # noqa: BLE001 - a panic in Rust is no Exception
            done.append(error)

    # Beside this thread, which can be interrupted meanwhile.
    worker = Thread(target=solve, daemon=True)
    worker.start()
    while worker.is_alive():
        worker.join(_WATCH_S)
        watch(monotonic())
    (solution,) = done
    if isinstance(solution, BaseException):
        raise JobError(
            f"the search for places failed: {str(solution).splitlines()[0]}",
            remedy="Use `layout='tessellated'`, another `seed`, or a larger sheet.",
        ) from solution
    placed = solution.placed_items
    return NestPlaces(
        np.array([int(one.id) for one in placed], np.intp),
        np.array([float(one.rotation) for one in placed]),
        np.array([complex(*one.translation) for one in placed]),
    )


def has_search() -> bool:
    """Whether spyrrow is installed, and of this kind of machine."""
    try:
        import_module("spyrrow")
    except Exception:  # noqa: BLE001 - whatever a broken build raises
        return False
    return True


def _right_ends(items: Sequence[NestItem], places: NestPlaces) -> Floats:
    """How far right each piece reaches."""
    ends = [
        float((unit_at(turn) * items[item].ring).real.max()) + shift.real
        for item, turn, shift in zip(places.item.tolist(), places.turn.tolist(), places.shift.tolist(), strict=True)
    ]
    return np.array(ends)


def ring_area(ring: Complexes) -> float:
    """The area of a polygon."""
    return abs(float((ring.conj() * np.roll(ring, -1)).imag.sum())) / 2

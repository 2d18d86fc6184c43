"""More pieces on a sheet than are laid there: one after the other is put in, and all are moved until none overlaps."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import count
from time import monotonic
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.fabrication.nest_patterns import pattern_layouts
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces, least_counts
from voronoi_tiles.fabrication.no_fit import NoFits
from voronoi_tiles.fabrication.separation import Separation

_TURN_DIGITS: Final = 6
"""Decimals of degrees in which ways to lie are told apart."""

_STARTS: Final = 6
"""Layouts of patterns from which more are looked for; a count."""

_ROUNDS: Final = ((_STARTS + 1, 4_000), (3, 16_000), (3, 16_000))
"""How many of the layouts, the best ones, are let grow, and along how many lines pieces are moved for each; counts."""

_AGAIN: Final = 40_000
_SEEDS: Final = 1_000_003
"""The former each time that a search goes on; and by how much the seeds of two such searches differ."""

_MANY: Final = 64
"""Of more pieces the fewer lines are tried, as each takes longer; a count."""


_REMEMBERED_MAX: Final = 8
"""Most layouts that are remembered; a count."""

_REMEMBERED: dict[tuple[bytes, ...], list[NestPlaces]] = {}

Kept = Callable[[NestPlaces], NestPlaces]
"""Gives those of some places that are good, lest a layout is chosen for pieces that are left out afterwards."""


def most_laid(
    items: Sequence[NestItem],
    size: tuple[float, float],
    others: Sequence[NestPlaces] = (),
    kept: Kept = lambda places: places,
) -> NestPlaces:
    """The most pieces that patterns, and what grows of them and of other layouts, lay on a rectangle from 0 to `size`.

    What is put in is of the kind that lacks most of its share; of a layout counts what is `kept`. All of it is
    repeatable, and the last few are remembered, as in the studio one job follows another that differs in something
    else.
    """
    arrays = [item.ring for item in items] + [array for places in others for array in places]
    asked = (repr((size, [item[1:] for item in items])).encode(), *(array.tobytes() for array in arrays))
    found = _REMEMBERED.pop(asked, None)
    if found is None:
        found = [*others, *(growth.places for growth in _grown(items, size, others))]
    _REMEMBERED[asked] = found
    if len(_REMEMBERED) > _REMEMBERED_MAX:
        _REMEMBERED.pop(next(iter(_REMEMBERED)))
    return _best(items, map(kept, found))


def most_found(
    items: Sequence[NestItem],
    size: tuple[float, float],
    others: Sequence[NestPlaces],
    effort: float,
    seed: int,
    progress: Callable[[float], None],
    kept: Kept = lambda places: places,
) -> NestPlaces:
    """The same where each layout grows again and again, for `effort` seconds; `progress` is told of those passed."""
    begun = monotonic()
    growths = _grown(items, size, others)
    for number in count():
        now = monotonic() - begun
        progress(now)
        if now >= effort or not growths:
            break
        growths[number % len(growths)].grow((seed + 1) * _SEEDS + number, _AGAIN)
    return _best(items, map(kept, (*others, *(growth.places for growth in growths))))


def _grown(items: Sequence[NestItem], size: tuple[float, float], others: Sequence[NestPlaces]) -> list[Growth]:
    """Layouts of patterns, and others, each after a short search, the best ones after longer ones."""
    no_fits = NoFits([item.ring for item in items])
    starts = (*others, *pattern_layouts(items, size, no_fits, _STARTS))
    growths = [Growth(items, size, start, no_fits) for start in starts if len(start.item)]
    seed = 0
    for few, effort in _ROUNDS:
        growths.sort(key=lambda growth: -growth.count)
        for growth in growths[:few]:
            growth.grow(seed := seed + 1, effort)
    return growths


def _best(items: Sequence[NestItem], found: Iterable[NestPlaces]) -> NestPlaces:
    """Those of most pieces; of each kind as many as its share, or nearly, where there are such."""
    share = np.array([item.share for item in items])
    return max(found, key=lambda places: (_is_even(places, share), len(places.item)), default=NestPlaces.none())


def _is_even(places: NestPlaces, share: Floats) -> bool:
    """Whether each kind has its share of the pieces, or nearly."""
    counts = np.bincount(places.item, minlength=len(share))
    return bool((counts >= least_counts(share, int(counts.sum()))).all())


class Growth:
    """Pieces of some kinds on a rectangle from 0 to `size`, in the turns of some places, and in their half turns."""

    def __init__(
        self, items: Sequence[NestItem], size: tuple[float, float], places: NestPlaces, no_fits: NoFits
    ) -> None:
        self._items = items
        lies = [(k, _turn(turn)) for k, turn in zip(places.item.tolist(), places.turn.tolist(), strict=True)]
        ways = {*lies, *((k, 0.0) for k in range(len(items)) if k not in places.item)}
        ways |= {(k, _turn(turn + 180.0)) for k, turn in ways}
        # Pieces of a tessellation may fit by less than their polygons, whose turns others do without.
        rooms = {way: _room(items[way[0]].ring * unit_at(way[1]), size) for way in ways}
        self._ways = sorted(way for way in ways if way in lies or _is_room(rooms[way]))
        self._rooms = np.array([rooms[way] for way in self._ways])
        self._range = np.searchsorted([k for k, _ in self._ways], np.arange(len(items) + 1)).astype(np.int64)
        edges = [no_fits.edges(*one, *other) for one in self._ways for other in self._ways]
        self._separation = Separation(edges, self._rooms, self._range)
        self._kind = places.item.astype(np.int64)
        self._way = np.array([self._ways.index(way) for way in lies], np.int64)
        left, low, right, top = self._rooms[self._way].T
        self._place = np.clip(places.shift.real, left, right) + 1j * np.clip(places.shift.imag, low, top)

    @property
    def places(self) -> NestPlaces:
        """Where the pieces lie."""
        turn = np.array([turn for _, turn in self._ways])
        return NestPlaces(self._kind.astype(np.intp), turn[self._way], self._place)

    @property
    def count(self) -> int:
        """How many pieces there are."""
        return len(self._kind)

    def grow(self, seed: int, effort: int) -> None:
        """Put in pieces for as long as a search along so many lines, or fewer for many pieces, finds places for all."""
        random = np.random.default_rng(seed)
        effort = effort * _MANY // max(_MANY, self.count)
        while effort > 0:
            kind = self._lacking()
            way = int(random.integers(self._range[kind], self._range[kind + 1]))
            left, low, right, top = self._rooms[way]
            place = complex(left + random.random() * (right - left), low + random.random() * (top - low))
            found = self._separation.separated(
                np.append(self._kind, kind),
                np.append(self._way, way),
                np.append(self._place, place),
                seed=seed,
                effort=effort,
            )
            effort -= found.tried
            if not found.apart:
                break
            self._kind = np.append(self._kind, kind)
            self._way, self._place = found.way, found.place

    def _lacking(self) -> int:
        """The kind of which there are fewest, for its share; of those that fit on the sheet in some way."""
        counts = np.bincount(self._kind, minlength=len(self._items))
        share = np.array([item.share for item in self._items])
        lacking = share * (len(self._kind) + 1) - counts
        return int(np.argmax(np.where(np.diff(self._range) > 0, lacking, -np.inf)))


def _room(ring: Complexes, size: tuple[float, float]) -> tuple[float, float, float, float]:
    """The least x and y of the place of a polygon on a rectangle, and the greatest."""
    x, y = ring.real, ring.imag
    return -float(x.min()), -float(y.min()), size[0] - float(x.max()), size[1] - float(y.max())


def _is_room(room: tuple[float, float, float, float]) -> bool:
    """Whether there is any."""
    return room[0] <= room[2] and room[1] <= room[3]


def _turn(degrees: float) -> float:
    """A turn from 0 up to 360 degrees."""
    return round(degrees % 360.0, _TURN_DIGITS) % 360.0

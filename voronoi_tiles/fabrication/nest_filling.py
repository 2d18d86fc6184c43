"""Further places for pieces in a region with holes and of parts, beside pieces that lie there.

A piece fits where its outline meets no side of the region, nor a piece that lies there: what is left of all places
without the sums of convex parts, tried at a number of turns. Most of it is known at once: the largest circles in a
piece have to lie in the region, so that places are looked for only where there is nearly room. Pieces are laid one by
one, each as low as there is a place, and then as far left. All of it is repeatable.

Source: J. A. Bennell and J. F. Oliveira, The geometry of nesting problems: a tutorial, 2008, for inner-fit regions and
laying at the bottom left.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, plane
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.fabrication.convex_parts import convex_parts, overlaps
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces, least_counts

_TURNS: Final = 24
"""Turns at which a piece is tried that may be turned as it likes, beside those of pieces of its kind; a count."""

_KNOWN: Final = 8
"""Turns of pieces of its kind at which a piece is tried at most; a count."""

_CIRCLES: Final = 3
"""Circles in a piece that have to lie in the region; a count."""

_SMALL: Final = 0.4
"""A circle that is smaller than the largest one by more than this factor tells little."""

_FINE: Final = 0.01
"""How far a circle's middle may be from the best one; a share of the piece's size."""

_LEVEL_DIGITS: Final = 6
"""Decimals of a millimetre to which places are equally low."""

_TURN_DIGITS: Final = 9
"""Decimals of a degree to which turns are the same."""

_EVERYWHERE: Final = (-math.inf, -math.inf, math.inf, math.inf)

_NOTHING_MM2: Final = 1e-9
"""What is left of places that is smaller came about by rounding; square millimetres."""


def fill(
    items: Sequence[NestItem],
    region: Any,
    laid: NestPlaces,
    demand: Ints | None = None,
    outlines: Sequence[Complexes] | None = None,
    *,
    even: bool = False,
    beside: Ints | int = 0,
) -> NestPlaces:
    """Further places for items in a region, a shapely polygon, or several, beside those that are `laid`.

    As many as fit, or at most as `demand` says (intp, one for each item); the next is always one of which there are
    the fewest for its share, if it fits, and if `even`, as long as each item then nearly has its share. No two of the
    items' polygons overlap; in the region are these or, if given, their `outlines` about the same 0. `beside` says how
    many there are of each elsewhere.
    """
    import shapely

    counts, share = beside + np.bincount(laid.item, minlength=len(items)), np.array([item.share for item in items])
    left = np.full(len(items), np.iinfo(np.intp).max) if demand is None else demand.copy()
    rings = [_PartedRing.of(item.ring) for item in items]
    within = rings if outlines is None else [_PartedRing.of(ring) for ring in outlines]
    room = _Room(region, [rings[k].turned(turn).moved(shift) for k, turn, shift in laid.rows()])
    postures = [
        _Posture(k, turn, rings[k].turned(turn), room.places(rings[k].turned(turn), within[k].turned(turn)))
        for k, item in enumerate(items)
        if left[k] > 0
        for turn in _turns(item, laid.turn[laid.item == k])
    ]
    overlap: dict[tuple[int, int, float], Any] = {}

    def no_fit(stays: _Posture, moves: _Posture, shift: complex) -> Any:
        """Where one overlaps another that stays: found once for two items, however they are turned together."""
        turn = round(math.remainder(moves.turn - stays.turn, 360.0), _TURN_DIGITS)
        key = stays.item, moves.item, turn
        if key not in overlap:
            parts = rings[moves.item].parts * unit_at(turn)
            overlap[key] = shapely.union_all(overlaps(rings[stays.item].parts, parts, _EVERYWHERE))
        return _image(overlap[key], unit_at(stays.turn), shift)

    def may_come(item: int) -> bool:
        """Whether there may be one more of an item: of what lacks there may, even where another lacks more."""
        more = counts + (np.arange(len(items)) == item)
        need = even * least_counts(share, int(more.sum()))
        return bool(left[item] > 0 and (counts[item] < need[item] or (more >= need).all()))

    found: list[tuple[int, float, complex]] = []
    while True:
        by_need = np.argsort((counts + 1) / share, kind="stable").tolist()
        best = next(filter(None, (_lowest(postures, k) for k in by_need if may_come(k))), None)
        if best is None:
            break
        posture, shift = best
        found.append((posture.item, posture.turn, shift))
        counts[posture.item] += 1
        left[posture.item] -= 1
        for other in postures:
            if left[other.item] > 0 and not other.places.is_empty:
                other.places = shapely.MultiPolygon(_polygons(other.places.difference(no_fit(posture, other, shift))))
    return NestPlaces(*map(np.array, zip(*found, strict=True))) if found else NestPlaces.none()


@dataclass(frozen=True, eq=False)
class _PartedRing:
    """A polygon (complex128, n), its convex parts (k x m), and the middles and radii of circles in it."""

    ring: Complexes
    parts: Complexes
    middle: Complexes
    radius: Floats

    @classmethod
    def of(cls, ring: Complexes) -> _PartedRing:
        """A ring of points as a polygon."""
        return cls(ring, convex_parts(ring), *_circles(ring))

    def turned(self, turn: float) -> _PartedRing:
        """The polygon turned about 0; degrees."""
        unit = unit_at(turn)
        return _PartedRing(self.ring * unit, self.parts * unit, self.middle * unit, self.radius)

    def moved(self, shift: complex) -> _PartedRing:
        """The polygon moved."""
        return _PartedRing(self.ring + shift, self.parts + shift, self.middle + shift, self.radius)


@dataclass(eq=False)
class _Posture:
    """An item at a turn, and all places that there are for it yet: a shapely polygon, or several."""

    item: int
    turn: float
    ring: _PartedRing
    places: Any


class _Room:
    """A region, and what lies there."""

    def __init__(self, region: Any, laid: Sequence[_PartedRing]) -> None:
        import shapely

        self.region = region
        shapely.prepare(region)
        rings = [ring for part in _polygons(region) for ring in (part.exterior, *part.interiors)]
        sides = [np.column_stack((ends[:-1], ends[1:])) for ends in map(_complex, rings)]
        self.sides = np.concatenate([np.zeros((0, 2), np.complex128), *sides])
        self.taken = _stacked([one.parts for one in laid])
        around = region.envelope.buffer(max((np.ptp(one.ring.real) + np.ptp(one.ring.imag) for one in laid), default=0))
        self.free = around.difference(shapely.union_all([shapely.Polygon(plane(one.ring)) for one in laid]))
        self.eroded: dict[tuple[bool, float], Any] = {}

    def places(self, ring: _PartedRing, within: _PartedRing) -> Any:
        """All places for a polygon that may not overlap what lies there, as its part `within` may not leave the region.

        A shapely polygon, or several.
        """
        import shapely

        room = shapely.intersection_all([*self._middles(within, beside=False), *self._middles(ring, beside=True)])
        room = _without(_without(room, self.sides, within.parts), self.taken, ring.parts)
        # Where it meets no side it may lie beyond all of them, or around a hole.
        inside = []
        for part in _polygons(room):
            at = _complex(part.point_on_surface())[0]
            if self.region.contains(shapely.Polygon(plane(within.ring + at))):
                inside.append(part)
        return shapely.MultiPolygon(inside)

    def _middles(self, ring: _PartedRing, *, beside: bool) -> list[Any]:
        """The places at which each circle of a polygon lies in the region, or `beside` what lies there."""
        if beside and not len(self.taken):
            return []
        found = []
        for middle, radius in zip(ring.middle.tolist(), ring.radius.tolist(), strict=True):
            if (beside, radius) not in self.eroded:
                self.eroded[beside, radius] = (self.free if beside else self.region).buffer(-radius)
            found.append(_image(self.eroded[beside, radius], 1 + 0j, -middle))
        return found


def _lowest(postures: Sequence[_Posture], item: int) -> tuple[_Posture, complex] | None:
    """The lowest place for an item, of equally low ones the leftmost, and at which turn it is; None where none is."""
    best: tuple[tuple[float, float], _Posture, complex] | None = None
    for posture in postures:
        if posture.item != item or posture.places.is_empty:
            continue
        z, ring = _complex(posture.places), posture.ring.ring
        top, left = np.round(z.imag + ring.imag.max(), _LEVEL_DIGITS), z.real + ring.real.min()
        at = int(np.lexsort((left, top))[0])
        rank = float(top[at]), float(left[at])
        if best is None or rank < best[0]:
            best = rank, posture, complex(z[at])
    return None if best is None else best[1:]


def _without(places: Any, stays: Complexes, moves: Complexes) -> Any:
    """What is left of places at which the convex parts of a polygon overlap none of those that stay."""
    import shapely

    left = []
    for part in _polygons(places):
        left += _polygons(part.difference(shapely.union_all(overlaps(stays, moves, part.bounds))))
    return shapely.MultiPolygon(left)


def _circles(ring: Complexes) -> tuple[Complexes, Floats]:
    """The middles and radii of the largest circle in a polygon, of the largest in what it leaves, and so on."""
    import shapely
    from shapely.ops import polylabel

    rest = shapely.Polygon(plane(ring))
    fine = _FINE * float(np.sqrt(rest.area))
    found: list[tuple[complex, float]] = []
    for _ in range(_CIRCLES):
        poles = [polylabel(part, tolerance=fine) for part in _polygons(rest)]
        pole, radius = max(((pole, rest.boundary.distance(pole)) for pole in poles), key=lambda one: one[1])
        if found and radius < _SMALL * found[0][1]:
            break
        found.append((complex(pole.x, pole.y), radius))
        rest = rest.difference(pole.buffer(radius))
    middle, radius = zip(*found, strict=True)
    return np.array(middle), np.array(radius)


def _image(shape: Any, unit: complex, shift: complex) -> Any:
    """The image of a shape that is turned about 0 and moved."""
    import shapely

    return shapely.transform(shape, lambda points: plane((points[:, 0] + 1j * points[:, 1]) * unit + shift))


def _turns(item: NestItem, known: Floats) -> list[float]:
    """The turns at which an item is tried; `known` are those of pieces of it that lie there."""
    if item.turns is not None:
        return list(item.turns)
    return list(dict.fromkeys([*np.unique(known)[:_KNOWN].tolist(), *np.linspace(0.0, 360.0, _TURNS, endpoint=False)]))


def _polygons(shape: Any) -> list[Any]:
    """The polygons that a shape is made of, but for those that came about by rounding."""
    import shapely

    parts = shapely.get_parts(shape)
    return list(parts[shapely.area(parts) > _NOTHING_MM2])


def _stacked(parts: Sequence[Complexes]) -> Complexes:
    """Convex parts of several polygons in one array: their last corners are repeated where they have fewer."""
    most = max((one.shape[1] for one in parts), default=1)
    filled = [np.concatenate((one, np.repeat(one[:, -1:], most - one.shape[1], axis=1)), axis=1) for one in parts]
    return np.concatenate([np.zeros((0, most), np.complex128), *filled])


def _complex(shape: Any) -> Complexes:
    """The points of a shape."""
    import shapely

    points = shapely.get_coordinates(shape)
    return np.asarray(points[:, 0] + 1j * points[:, 1], np.complex128)

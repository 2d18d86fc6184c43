"""Pieces nested in what a drawing bounds, with its holes, and in the holes of other pieces."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, plane
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.fabrication.nest_filling import fill
from voronoi_tiles.fabrication.nest_kinds import NestKind
from voronoi_tiles.fabrication.nest_patterns import pattern_layouts
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces
from voronoi_tiles.fabrication.no_fit import NoFits
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths

_WIDER: Final = 1.25
"""By how much a pattern is wider than the region that it is moved over, a factor."""

_MOVES: Final = 8
"""Steps by which it is moved, either way; a count."""


def region_within(outline: Paths, margin: float, accuracy: float) -> Any:
    """What is inside an outline and its holes by more than a margin: a shapely polygon, or several; millimetres."""
    import shapely

    lines = to_lines(outline, accuracy=accuracy)
    rings = [shapely.Polygon(plane(lines.start[a:b])) for a, b in pairwise(lines.offsets.tolist())]
    outer = ring_areas(outline) > 0
    solid, holes = (
        shapely.union_all([ring for ring, one in zip(rings, outer, strict=True) if one == k]) for k in (1, 0)
    )
    return solid.difference(holes).buffer(-(margin + accuracy))


def lay_in_region(kinds: Sequence[NestKind], region: Any, demand: Ints, *, even: bool) -> NestPlaces:
    """Places in a region: those of a pattern moved over it as holds most, and what fits beside them.

    Not more than `demand` of each kind (intp), and if `even`, of each nearly its share where there is room.
    """
    import shapely

    items = [kind.item for kind in kinds]
    x0, y0, x1, y1 = region.bounds
    wider = (_WIDER * (x1 - x0), _WIDER * (y1 - y0))
    pattern, *_ = pattern_layouts(items, wider, NoFits([item.ring for item in items]), 1)
    outlines = [shapely.Polygon(plane(ring)) for ring in _turned(pattern, [kind.outline for kind in kinds])]
    best, move = np.zeros(0, np.intp), 0j
    steps = np.linspace(0.0, _WIDER - 1.0, _MOVES)
    for by in (steps[:, None] * (x1 - x0) + 1j * steps * (y1 - y0)).ravel().tolist():
        away = by - (x0 + 1j * y0)
        here = shapely.transform(region, lambda points, z=away: points + np.array([z.real, z.imag]))
        shapely.prepare(here)
        inside = np.flatnonzero(shapely.contains(here, outlines))
        if len(inside) > len(best):
            best, move = inside, x0 + 1j * y0 - by
    # Of a kind whose band is within by more than those of others there are no more than its share: the rest is filled.
    share = np.array([item.share for item in items])
    laid = capped(pattern.take(best), np.minimum(demand, np.ceil(share * len(best)).astype(np.intp)))
    laid = laid._replace(shift=laid.shift + move)
    left = demand - np.bincount(laid.item, minlength=len(items))
    more = fill(items, region, laid, left, [kind.outline for kind in kinds], even=even)
    return NestPlaces.joined(laid, more)


def lay_in_holes(kinds: Sequence[NestKind], laid: NestPlaces, demand: Ints) -> NestPlaces:
    """Places in the holes of pieces that are laid, and in the holes of those; not more than `demand` of each kind.

    Pieces of a kind have the same in them, as long as the same kinds are wanted, in the same order of need.
    """
    import shapely

    items, outlines = [kind.item for kind in kinds], [kind.outline for kind in kinds]
    share = np.array([item.share for item in items])
    known: dict[tuple[int, ...], NestPlaces] = {}
    found, left, counts = NestPlaces.none(), demand, np.bincount(laid.item, minlength=len(items))
    while len(laid.item) and left.any():
        inner = []
        for k, turn, shift in laid.rows():
            for number, hole in enumerate(kinds[k].holes):
                key = k, number, *np.argsort((counts + 1) / share, kind="stable").tolist(), *(left > 0).tolist()
                if key not in known or (_counts(known[key], items) > left).any():
                    known[key] = fill(
                        items, shapely.Polygon(plane(hole)), NestPlaces.none(), left, outlines, beside=counts
                    )
                inner.append(known[key].moved(turn, shift))
                more = _counts(inner[-1], items)
                left, counts = left - more, counts + more
        laid = NestPlaces.joined(*inner)
        found = NestPlaces.joined(found, laid)
    return found


def _counts(places: NestPlaces, items: Sequence[NestItem]) -> Ints:
    """How many there are of each item."""
    return np.bincount(places.item, minlength=len(items))


def _turned(places: NestPlaces, rings: Sequence[Complexes]) -> list[Complexes]:
    """The polygons of pieces where they lie; `rings` are those of the kinds."""
    return [rings[k] * unit_at(turn) + shift for k, turn, shift in places.rows()]


def capped(places: NestPlaces, demand: Ints) -> NestPlaces:
    """Not more than so many of each kind, those on the left first."""
    own = [np.flatnonzero(places.item == k) for k in range(len(demand))]
    first = [one[np.argsort(places.shift.real[one], kind="stable")] for one in own]
    return places.take(np.concatenate([one[:most] for one, most in zip(first, demand.tolist(), strict=True)]))

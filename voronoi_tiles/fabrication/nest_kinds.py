"""The kinds of pieces that are nested, and the polygons that stand for them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, plane
from voronoi_tiles.fabrication.dressed_tiles import DressedTiles
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.nest_search import NestItem
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.motions import compose, inverse, reverses_orientation

_COARSE: Final = 0.06
"""By how much the polygon that stands for a piece may be larger than the piece grown by half the gap; a share of the
gap. Fewer corners leave the search more time."""

_SINGLE_MM: Final = 2e-4
"""More than what single precision and the digits of the recipe move a piece by; millimetres."""

_QUARTER: Final = 8
"""Chords of a quarter circle around a corner of a piece; a count."""


class NestKind(NamedTuple):
    """A kind of pieces: a tile of the period that stands for it, and its polygons, moved by -`middle`.

    `item` is the piece grown by half the gap, its holes filled, with its share of all; `outline` holds the piece
    closely; in each of `holes` other pieces may lie, which then keep the gap.
    """

    tile: int
    middle: complex
    item: NestItem
    outline: Complexes
    holes: tuple[Complexes, ...]


def kind_keys(period: Period, *, grain: bool) -> list[tuple[int, ...]]:
    """What tells the kinds of a period's tiles apart: site, and how each is turned over or, with a grain, turned."""
    keys: list[tuple[int, ...]] = []
    for site, motion in zip(period.site.tolist(), period.motion, strict=True):
        linear = tuple(map(int, motion[:4]))
        along = max(linear, tuple(-part for part in linear)) if grain else (int(reverses_orientation(motion)),)
        keys.append((site, *along))
    return keys


def kind_numbers(period: Period, *, grain: bool) -> Ints:
    """The number of the kind of each tile of a period, in the order of `kinds_of`, intp (n,)."""
    keys = kind_keys(period, grain=grain)
    numbers = {key: k for k, key in enumerate(dict.fromkeys(keys))}
    return np.array([numbers[key] for key in keys], np.intp)


def kinds_of(tiles: DressedTiles, gap: float, accuracy: float, *, grain: bool) -> list[NestKind]:
    """The kinds of pieces: those of a site are one, but those turned over, and with a grain, those turned otherwise.

    With a grain, a half turn makes no difference.
    """
    period = tiles.period
    number = kind_numbers(period, grain=grain)
    kinds: list[NestKind] = []
    first: dict[int, int] = {}
    for tile in np.unique(number, return_index=True)[1].tolist():
        site, share = int(period.site[tile]), float((number == number[tile]).mean())
        like = first.setdefault(site, len(kinds))
        if like == len(kinds):
            ring, outline, holes = _polygons(tiles, tile, gap, accuracy)
            middle = complex(ring.mean())
            item = NestItem(ring - middle, share, (0.0, 180.0) if grain else None)
            kinds.append(NestKind(tile, middle, item, outline - middle, tuple(hole - middle for hole in holes)))
            continue
        model = kinds[like]
        image = tiles.page.isometry(compose(period.motion[tile], inverse(period.motion[model.tile])))

        def moved(ring: Complexes, unit: complex = image.a, conj: bool = image.conj) -> Complexes:
            """The image of a polygon about 0."""
            return unit * (ring.conj() if conj else ring)

        item = NestItem(moved(model.item.ring), share, model.item.turns, like, image.a, image.conj)
        kinds.append(NestKind(tile, image(model.middle), item, moved(model.outline), tuple(map(moved, model.holes))))
    return kinds


def _polygons(
    tiles: DressedTiles, tile: int, gap: float, accuracy: float
) -> tuple[Complexes, Complexes, list[Complexes]]:
    """Polygons around a piece: one that holds all within half a gap, one that holds it; and those in its holes."""
    import shapely

    lines = to_lines(tiles.rings(tile), accuracy=accuracy)
    outer, *holes = (shapely.Polygon(plane(lines.start[a:b])) for a, b in pairwise(lines.offsets.tolist()))
    slack = max(_COARSE * gap, accuracy)

    def grown(distance: float) -> Complexes:
        """A polygon that holds all within a distance."""
        # Chords cut off what simplifying may cut off in turn, and the arcs of the buffer are chords as well.
        reach = distance + accuracy + slack + _SINGLE_MM
        around = outer.buffer(reach / math.cos(math.pi / (4 * _QUARTER)), quad_segs=_QUARTER)
        return _ring(shapely.Polygon(around.exterior).simplify(slack))

    rooms = shapely.get_parts([hole.buffer(-gap - accuracy - _SINGLE_MM, quad_segs=_QUARTER) for hole in holes])
    return grown(gap / 2), grown(0.0), [_ring(room) for room in rooms if not room.is_empty]


def _ring(polygon: Any) -> Complexes:
    """The corners of a polygon."""
    x, y = polygon.exterior.coords.xy
    return np.array(x[:-1]) + 1j * np.array(y[:-1])


def refuse_large(items: Sequence[NestItem], room: tuple[float, float], gap: float) -> None:
    """Refuse pieces that do not fit on the sheet by themselves, in whole degrees or as they may be turned."""
    for item in items:
        turns = np.arange(180.0) if item.turns is None else np.zeros(1)
        turned = np.exp(1j * np.radians(turns))[:, None] * item.ring
        sizes = np.column_stack((np.ptp(turned.real, axis=1), np.ptp(turned.imag, axis=1)))
        excess = (sizes / room).max(axis=1)
        if excess.min() > 1.0:
            width, height = sizes[np.argmin(excess)] - (1 + 2 * _COARSE) * gap
            raise JobError(
                f"one piece takes {width:.4g} x {height:.4g} mm, and the sheet has room for {room[0] - gap:.4g} x "
                f"{room[1] - gap:.4g} mm",
                remedy="Take a larger sheet, or a smaller margin, gap or design.",
            )

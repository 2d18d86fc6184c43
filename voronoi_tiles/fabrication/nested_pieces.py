"""Pieces at places: each turned and moved there from where its tile stands in the period, and checked as it is cut."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.base.text import counted
from voronoi_tiles.base.values import shown
from voronoi_tiles.fabrication.dressed_tiles import DressedTiles
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.layout import Layout, Piece, PlacedTiles
from voronoi_tiles.fabrication.nest_kinds import NestKind, kind_numbers
from voronoi_tiles.fabrication.nest_search import NestPlaces
from voronoi_tiles.fabrication.tile_placement import TilePlacement
from voronoi_tiles.paths.near_items import ROUNDING, near_items
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import item_boxes
from voronoi_tiles.paths.winding import item_winding
from voronoi_tiles.vector.motions import reverses_orientation

_ANGLE_DIGITS: Final = 7
_PLACE_DIGITS: Final = 6
"""Decimals of turns in degrees, and of places in millimetres, in recipes: at the edge of a piece of 300 mm half a
micrometre, and a nanometre."""

_SAME_DEG: Final = 1e-6
"""Turns that differ by less are the same; degrees."""


def laid_again(layout: Layout, pieces: Sequence[Piece], name: str, *, grain: bool = False) -> Layout:
    """A layout with its pieces where a file has them. Raises JobError where they do not fit, or cross the grain."""
    if not {(piece.site, piece.over) for piece in pieces} <= set(_stand_ins(layout)):
        raise JobError(f"`layout`: {shown(name)} is of another design", remedy="Name a file of this one.")
    across = sum(not _is_along(piece, layout.tiles) for piece in pieces) if grain else 0
    if across:
        raise JobError(
            f"`layout`: {counted(across, 'piece')} in {shown(name)} would lie across the grain",
            remedy="Leave `grain` out, or nest anew with it.",
        )
    laid = placed(layout, pieces)
    wrong = misplaced(laid)
    if len(wrong):
        raise JobError(
            f"`layout`: {counted(len(np.unique(wrong)), 'piece')} in {shown(name)} would leave this job's sheet, "
            f"or be nearer to each other than {layout.job.side_by_side:g} mm",
            remedy="Give the options that it was made with, or use `layout='nested'`.",
        )
    return laid


def placed(layout: Layout, pieces: Sequence[Piece]) -> Layout:
    """A layout with pieces at places.

    They are numbered kind by kind: those of a kind can change places, wherever they belong in the tessellation.
    """
    tiles, stand_ins = layout.tiles, _stand_ins(layout)
    tile = np.array([stand_ins[piece.site, piece.over] for piece in pieces], np.intp)
    unit, shift = np.zeros((2, len(pieces)), np.complex128)
    for k, piece in enumerate(pieces):
        factor, place, _ = tiles.page.after(layout.period.motion[int(tile[k])])
        unit[k] = unit_at(piece.turn) * (factor / abs(factor)).conjugate()
        shift[k] = piece.shift - unit[k] * place
    step, whole = np.zeros((len(tile), 2), np.intp), np.ones(len(tile), np.bool_)
    numbers = np.zeros(len(pieces), np.intp)
    by_kind = sorted(range(len(pieces)), key=lambda k: (*pieces[k][:2], -pieces[k].shift.imag, pieces[k].shift.real))
    numbers[by_kind] = np.arange(len(pieces)) + 1
    return replace(
        layout,
        placement=TilePlacement(tile, step, whole),
        copies=PlacedTiles(tile, step, whole, shift, unit),
        numbers=numbers,
        pieces=tuple(pieces),
    )


def numbered_on(sheets: Sequence[Layout], first: int) -> list[Layout]:
    """Sheets of nested pieces, numbered through from a number on."""
    found = []
    for sheet in sheets:
        assert sheet.numbers is not None, "pieces at places have numbers"
        found.append(replace(sheet, numbers=sheet.numbers - sheet.numbers.min() + first))
        first += len(sheet.pieces)
    return found


def _is_along(piece: Piece, tiles: DressedTiles) -> bool:
    """Whether a piece is turned as a tile of its kind in the tessellation, or by half a turn against that."""
    for site, motion in zip(tiles.period.site.tolist(), tiles.period.motion, strict=True):
        factor, _, conj = tiles.page.after(motion)
        away = math.degrees(cmath.phase(unit_at(piece.turn) * factor.conjugate()))
        if (site, conj) == (piece.site, piece.over) and abs(math.remainder(away, 180.0)) < _SAME_DEG:
            return True
    return False


def _stand_ins(layout: Layout) -> dict[tuple[int, bool], int]:
    """The first tile of the period of each site, as drawn and, where the group does so, turned over."""
    period = layout.period
    found: dict[tuple[int, bool], int] = {}
    for tile, (site, motion) in enumerate(zip(period.site.tolist(), period.motion, strict=True)):
        found.setdefault((site, reverses_orientation(motion)), tile)
    return found


def misplaced(layout: Layout) -> Ints:
    """The pairs of pieces that are nearer to each other than they may be, intp (k, 2); a piece off the sheet twice.

    Contours are compared as they are, arcs and parabolas.
    """
    contours, sheet, margin = layout.contours, layout.sheet, layout.job.margin
    pairs = near_items(contours.paths, contours.items, layout.job.side_by_side)
    if sheet.outline is None:
        box = item_boxes(contours.paths, contours.items)
        low, high = margin - ROUNDING, np.array([sheet.width, sheet.height]) - margin + ROUNDING
        off = np.flatnonzero((box[:, :2] < low).any(axis=1) | (box[:, 2:] > high).any(axis=1))
    else:
        # All that is not the sheet is an item as well, in whose hole the pieces lie.
        beyond = _beyond(Paths.concatenate([contours.paths, sheet.outline]), sheet.outline, margin)
        paths = Paths.concatenate([contours.paths, beyond])
        near = near_items(paths, np.append(contours.items, len(paths)), margin)
        # A hole of the sheet may lie in a piece, far from its edge.
        holes = sheet.outline.start[sheet.outline.offsets[:-1]]
        around = item_winding(contours.paths, contours.paths.offsets[contours.items], holes) > 0
        off = np.union1d(near[near[:, 1] == len(contours.items) - 1, 0], np.flatnonzero(around.any(axis=1)))
    return np.concatenate((pairs, np.column_stack((off, off))))


def _beyond(everything: Paths, outline: Paths, margin: float) -> Paths:
    """All that an outline leaves of a rectangle around everything, and more than a margin around that."""
    x0, y0, x1, y1 = everything.bounds
    low, high = complex(x0, y0) - (margin + 1.0) * (1 + 1j), complex(x1, y1) + (margin + 1.0) * (1 + 1j)
    corners = [low, complex(high.real, low.imag), high, complex(low.real, high.imag)]
    return Paths.concatenate([Paths.polylines([corners], closed=True), outline.reversed()])


def piece_at(tiles: DressedTiles, tile: int, about: complex, turn: float, shift: complex) -> Piece:
    """What a recipe says of a tile of the period that is turned about a point, which is moved to `shift`."""
    factor, place, conj = tiles.page.after(tiles.period.motion[tile])
    unit = unit_at(turn)
    where = unit * (place - about) + shift
    angle = round(math.degrees(cmath.phase(unit * factor)), _ANGLE_DIGITS)
    x, y = round(where.real, _PLACE_DIGITS), round(where.imag, _PLACE_DIGITS)
    return Piece(int(tiles.period.site[tile]), conj, angle, complex(x, y))


def as_laid(
    layout: Layout, tiles: DressedTiles, kinds: Sequence[NestKind], corner: complex, *, grain: bool
) -> NestPlaces:
    """Where the tiles of a tessellation lie, as places of items; `tiles` are those that the kinds were found in."""
    copies, period = layout.copies, layout.period
    of = layout.contours.copy
    tile = copies.tile[of]
    item = kind_numbers(period, grain=grain)[tile]
    factor, origin = _origins(layout.tiles)
    own_factor, own_origin = (part[np.array([kind.tile for kind in kinds])][item] for part in _origins(tiles))
    unit = factor[tile] / own_factor
    place = origin[tile] + period.shifts(copies.step[of]) + copies.moved_by[of]
    middle = np.array([kind.middle for kind in kinds])[item]
    return NestPlaces(item, np.degrees(np.angle(unit)), place - unit * (own_origin - middle) - corner)


def _origins(tiles: DressedTiles) -> tuple[Complexes, Complexes]:
    """How each tile of the period is turned on the page, and where its origin lies, complex128 (n,) both."""
    placed = [tiles.page.after(motion)[:2] for motion in tiles.period.motion]
    factor, origin = np.array(placed, np.complex128).T
    return factor, origin

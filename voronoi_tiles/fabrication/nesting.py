"""Pieces nested on a sheet: as many as a search finds room for, turned as they may be, or where a file has them.

The places go into the file's recipe, by which the same file is made again.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, plane
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.base.text import counted
from voronoi_tiles.base.values import shown
from voronoi_tiles.fabrication.dressed_tiles import DressedTiles
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import EFFORT_S, LAYOUTS, JobError
from voronoi_tiles.fabrication.layout import Layout, Piece, PlacedTiles, Sheet
from voronoi_tiles.fabrication.nest_patterns import lay_patterns
from voronoi_tiles.fabrication.nest_places import NESTED_MAX, read_places
from voronoi_tiles.fabrication.nest_search import NestItem, NestPlaces, Progress, has_search, most_pieces
from voronoi_tiles.fabrication.tile_placement import TilePlacement
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.near_items import ROUNDING, near_items
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.segments import item_boxes
from voronoi_tiles.vector.motions import compose, inverse, reverses_orientation

_COARSE: Final = 0.06
"""By how much the polygon that stands for a piece may be larger than the piece grown by half the gap; a share of the
gap. Fewer corners leave the search more time."""

_SINGLE_MM: Final = 2e-4
"""More than what single precision and the digits of the recipe move a piece by; millimetres."""

_ANGLE_DIGITS: Final = 7
_PLACE_DIGITS: Final = 6
"""Decimals of turns in degrees, and of places in millimetres, in recipes: at the edge of a piece of 300 mm half a
micrometre, and a nanometre."""

_SAME_DEG: Final = 1e-6
"""Turns that differ by less are the same; degrees."""

_UNSEARCHED: Final = (
    "spyrrow is not installed, so pieces were nested in patterns alone: with `pip install spyrrow` a search may find "
    "places for more"
)

_QUARTER: Final = 8
"""Chords of a quarter circle around a corner of a piece; a count."""


@dataclass(frozen=True, eq=False)
class _Kinds:
    """The kinds of pieces of a tessellation: for each a tile of the period that stands for it, and its share of all."""

    tile: tuple[int, ...]
    share: tuple[float, ...]

    @classmethod
    def of(cls, tiles: DressedTiles, grain: bool) -> _Kinds:
        """Tiles of a site are of one kind, but those turned over, and with a grain, those turned by less than 180."""
        members: dict[tuple[int, ...], list[int]] = {}
        for tile, (site, motion) in enumerate(zip(tiles.period.site.tolist(), tiles.period.motion, strict=True)):
            linear = tuple(map(int, motion[:4]))
            along = max(linear, tuple(-part for part in linear)) if grain else (reverses_orientation(motion),)
            members.setdefault((site, *along), []).append(tile)
        count = len(tiles.period.site)
        return cls(tuple(own[0] for own in members.values()), tuple(len(own) / count for own in members.values()))


def arranged(
    lay: Callable[..., Layout], job: Job, sheet: Sheet, progress: Progress | None
) -> tuple[Layout, tuple[str, ...]]:
    """The tiles of a job on its sheet, and what is to be said of them; `lay`, given job and sheet, does as `lay_out`.

    The job of the layout says how they lie, and not how that was found. Raises what `lay_out` does, and JobError where
    pieces cannot be nested.
    """
    plain = replace(job, layout="tessellated", grain=False, effort=EFFORT_S, seed=0)
    if not (job.nests or (job.layout == "auto" and job.apart and job.not_nestable is None)):
        return lay(job=plain, sheet=sheet), ()
    if job.gap is None and not job.kerf:
        plain = replace(plain, gap=job.side_by_side)
    saved = None if job.layout in LAYOUTS else read_places(job.layout)
    if saved is not None and not saved.pieces:
        tessellated = lay(job=plain, sheet=sheet)
        return tessellated, saved.doubts(tessellated.design, job.layout)
    # Nothing is to be filled: one tile stands for all of its kind.
    base = lay(job=replace(plain, layout="nested"), sheet=Sheet(0.0, 0.0, None, 0j))
    base = replace(base, sheet=sheet)
    if saved is not None:
        return laid_again(base, saved.pieces, job.layout, grain=job.grain), saved.doubts(base.design, job.layout)
    return _densest(base, partial(lay, job=plain, sheet=sheet), job, progress)


def _densest(
    base: Layout, lay: Callable[[], Layout], job: Job, progress: Progress | None
) -> tuple[Layout, tuple[str, ...]]:
    """The pieces of `base` nested on its sheet, or as `lay` lays them where that is as good; and what is to be said."""
    about = base.sheet.width * base.sheet.height / float(base.tile_areas.mean())
    if about > NESTED_MAX:
        if job.layout == "auto":
            return lay(), ()
        raise JobError(
            f"the sheet would hold about {about:,.0f} pieces, and {NESTED_MAX:,} are the most that are nested",
            remedy="Take a smaller sheet or a larger design, or `layout='tessellated'`.",
        )
    unnested: Layout | None = None
    refusal: JobError | None = None
    try:
        unnested = lay()
    except JobError as error:
        refusal = error  # what is hooked, or does not fit as it lies, may fit by itself
    fewer = 0 if unnested is None else len(unnested.copies.tile)
    search = job.layout == "nested" and has_search()
    nested = nest(base, job, progress, search=search)
    count = len(nested.pieces)
    said = [] if search or job.layout == "auto" else [_UNSEARCHED]
    if unnested is not None and count <= fewer:
        said.append(f"nested there would be {_counts(nested)}: they lie as in the tessellation")
        return unnested, tuple(said)
    if not count and job.layout == "auto" and refusal is not None:
        raise refusal
    if not count:
        raise JobError("no places were found for any piece", remedy="Give a longer `effort`, or a larger sheet.")
    as_drawn = counted(0, "piece") if unnested is None else _counts(unnested)
    said.append(f"nested are {_counts(nested)}: as in the tessellation there would be {as_drawn}")
    return nested, tuple(said)


def _counts(layout: Layout) -> str:
    """How many pieces a layout has; of several sites, each site's."""
    names = [site.name for site in layout.design.noded]
    of_site = np.bincount(layout.period.site[layout.copies.tile], minlength=len(names)).tolist()
    each = [f"{count:,} {name}" for count, name in zip(of_site, names, strict=True)]
    return counted(sum(of_site), "piece") + (f" ({', '.join(each)})" if len(each) > 1 else "")


def nest(layout: Layout, job: Job, progress: Progress | None = None, *, search: bool = True) -> Layout:
    """A layout with as many of its pieces on its sheet as patterns, or with `search` that, find places for.

    Raises JobError where a piece is larger than the sheet.
    """
    tiles, sheet = layout.tiles, layout.sheet
    kinds = _Kinds.of(tiles, grain=job.grain)
    gap = job.side_by_side
    items, middle = _items(tiles, kinds, gap, layout.budget.measured, grain=job.grain)
    # Polygons reach half a gap beyond the pieces, and may do so beyond the margin.
    room = (sheet.width - 2 * job.margin + gap, sheet.height - 2 * job.margin + gap)
    _refuse_large(items, room, gap)
    found = lay_patterns(items, room)
    if search:
        found = most_pieces(items, room, found, job.effort, job.seed, progress)
    corner = (job.margin - gap / 2) * (1 + 1j)
    laid = placed(
        layout, [_piece(tiles, kinds.tile[k], middle[k], turn, shift + corner) for k, turn, shift in _rows(found)]
    )
    # What the search gives is not trusted: of pieces that are too near, those with the most such neighbours go.
    wrong, gone = misplaced(laid), set()
    while len(wrong):
        worst = int(np.argmax(np.bincount(wrong.ravel())))
        gone.add(worst)
        wrong = wrong[(wrong != worst).all(axis=1)]
    return placed(layout, [piece for k, piece in enumerate(laid.pieces) if k not in gone]) if gone else laid


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
    """A layout with pieces at places."""
    tiles, stand_ins = layout.tiles, _stand_ins(layout)
    tile = np.array([stand_ins[piece.site, piece.over] for piece in pieces], np.intp)
    unit, shift = np.zeros((2, len(pieces)), np.complex128)
    for k, piece in enumerate(pieces):
        factor, place, _ = tiles.page.after(layout.period.motion[int(tile[k])])
        unit[k] = unit_at(piece.turn) * (factor / abs(factor)).conjugate()
        shift[k] = piece.shift - unit[k] * place
    step, whole = np.zeros((len(tile), 2), np.intp), np.ones(len(tile), np.bool_)
    return replace(
        layout,
        placement=TilePlacement(tile, step, whole),
        copies=PlacedTiles(tile, step, whole, shift, unit),
        pieces=tuple(pieces),
    )


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
    box = item_boxes(contours.paths, contours.items)
    low, high = margin - ROUNDING, np.array([sheet.width, sheet.height]) - margin + ROUNDING
    off = np.flatnonzero((box[:, :2] < low).any(axis=1) | (box[:, 2:] > high).any(axis=1))
    return np.concatenate((pairs, np.column_stack((off, off))))


def _rows(places: NestPlaces) -> list[tuple[int, float, complex]]:
    """Item, turn and shift of each, from the left to the right."""
    order = np.lexsort((places.shift.imag, places.shift.real))
    return list(zip(*(part[order].tolist() for part in places), strict=True))


def _piece(tiles: DressedTiles, tile: int, about: complex, turn: float, shift: complex) -> Piece:
    """What a recipe says of a tile of the period that is turned about a point, which is moved to `shift`."""
    factor, place, conj = tiles.page.after(tiles.period.motion[tile])
    unit = unit_at(turn)
    where = unit * (place - about) + shift
    angle = round(math.degrees(cmath.phase(unit * factor)), _ANGLE_DIGITS)
    x, y = round(where.real, _PLACE_DIGITS), round(where.imag, _PLACE_DIGITS)
    return Piece(int(tiles.period.site[tile]), conj, angle, complex(x, y))


def _items(
    tiles: DressedTiles, kinds: _Kinds, gap: float, accuracy: float, *, grain: bool
) -> tuple[list[NestItem], list[complex]]:
    """What is laid: the pieces of each kind grown by half the gap, about 0; and what of the page was taken there."""
    period = tiles.period
    items: list[NestItem] = []
    middle: list[complex] = []
    first: dict[int, int] = {}
    for tile, share in zip(kinds.tile, kinds.share, strict=True):
        site = int(period.site[tile])
        like = first.setdefault(site, len(items))
        image = tiles.page.isometry(compose(period.motion[tile], inverse(period.motion[kinds.tile[like]])))
        if like == len(items):
            ring = _grown(tiles.rings(tile), gap, accuracy)
            middle.append(complex(ring.mean()))
            items.append(NestItem(ring - middle[-1], share, (0.0, 180.0) if grain else None))
        else:
            ring = image.a * (items[like].ring.conj() if image.conj else items[like].ring)
            middle.append(image(middle[like]))
            items.append(NestItem(ring, share, items[like].turns, like, image.a, image.conj))
    return items, middle


def _grown(rings: Paths, gap: float, accuracy: float) -> Complexes:
    """A polygon around a piece, its holes filled, that holds all within half a gap of it: complex128 (n,)."""
    import shapely

    lines = to_lines(rings, accuracy=accuracy)
    outer = shapely.Polygon(plane(lines.start[: lines.offsets[1]]))
    slack = max(_COARSE * gap, accuracy)
    # Chords cut off what simplifying may cut off in turn, and the arcs of the buffer are chords as well.
    reach = gap / 2 + accuracy + slack + _SINGLE_MM
    grown = outer.buffer(reach / math.cos(math.pi / (4 * _QUARTER)), quad_segs=_QUARTER)
    x, y = shapely.Polygon(grown.exterior).simplify(slack).exterior.coords.xy
    return np.array(x[:-1]) + 1j * np.array(y[:-1])


def _refuse_large(items: Sequence[NestItem], room: tuple[float, float], gap: float) -> None:
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

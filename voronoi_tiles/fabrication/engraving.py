"""What is drawn on the pieces and beside them: art of the sites, labels, marks, the bar."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from voronoi_tiles.design import Art
from voronoi_tiles.errors import DesignError
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.fitting import side_arcs
from voronoi_tiles.fabrication.layout import Contours, Layout, Sheet
from voronoi_tiles.lettering import fitting_height, label_position, place_labels, printable
from voronoi_tiles.marks import BAR_MM, bar_height, reference_bar, registration_marks
from voronoi_tiles.vector.contour import Bools, Complexes, Floats, Ints
from voronoi_tiles.vector.curves.biarcs import to_arcs
from voronoi_tiles.vector.curves.conversion import to_lines
from voronoi_tiles.vector.curves.paths import Paths
from voronoi_tiles.vector.sheet.region import Region
from voronoi_tiles.vector.sheet.strands import inner_runs
from voronoi_tiles.wallpaper import unit_at

if TYPE_CHECKING:
    from voronoi_tiles.tiling import Tiling

LABEL_MIN: Final = 0.5
"""Smallest height of a label that is drawn; millimetres. What is smaller nobody reads."""

_ROOM: Final = 0.9
"""The part of the room in a tile that a label takes."""

_SIZES: Final = 64
"""Heights of labels: so many steps in every factor of two, so that pieces of a kind have labels of one height."""

_WANTED: Final = 1e6
"""More than any letters are high; millimetres."""

_MARK_MM: Final = 6.0
_LETTERS_MM: Final = 3.0
_FREE_MM: Final = 1.0
"""The bar's distance from what is beside it."""

GUIDE: Final = "guide"
"""The layer of a drawing that is a help for drawing, and not art."""


@dataclass(frozen=True, eq=False)
class Engraving:
    """Paths on the page that are engraved and scored, and what is to be said of them, in sentences."""

    engraved: Paths
    scored: Paths
    notes: tuple[str, ...] = ()


def engrave(tiling: Tiling, layout: Layout, contours: Contours | None, sheet: Sheet, shown: Bools) -> Engraving:
    """Draw what a job asks for beside its cuts; art on those tiles on the page that are `shown`.

    Raises DesignError where the art of a site cannot be read, JobError where marks or the bar have no room.
    """
    job = layout.job
    engraved, scored = ([], []) if job.art == "none" else _art(tiling, layout, shown)
    notes: list[str] = []
    if job.labels != "none":
        labels, small = _labels(tiling, layout, contours if contours is not None else layout.contours())
        engraved.append(labels)
        if small:
            notes.append(f"{small} pieces are too small for a label of {LABEL_MIN:g} mm")
    engraved += _beside(layout, contours, sheet)
    return Engraving(Paths.concatenate(engraved), Paths.concatenate(scored), tuple(notes))


# --- art --------------------------------------------------------------------------------------------------------


def _art(tiling: Tiling, layout: Layout, shown: Bools) -> tuple[list[Paths], list[Paths]]:
    """The art of every copy on the page: what is engraved, and what is scored."""
    design, job = tiling.design, layout.job
    engraved: list[Paths] = []
    scored: list[Paths] = []
    for site, art in enumerate(design.art):
        if art is None:
            continue
        for work, drawn in zip((engraved, scored), _read_art(art, design.folder, site, design.unit_mm), strict=True):
            if not len(drawn):
                continue
            if job.art == "clip":
                accuracy = job.accuracy / 2 / design.unit_mm
                outline = side_arcs(_outline(tiling, site), accuracy=accuracy, absorbed=0.0)
                drawn = _clipped(drawn, Region(outline), job.accuracy / 2 / design.unit_mm)  # noqa: PLW2901
            work += _copies_of(drawn, layout, site, shown)
    return engraved, scored


def _read_art(art: Art, folder: str, site: int, unit_mm: float) -> tuple[Paths, Paths]:
    """Read a site's art into the design's units: what is engraved, what is scored."""
    from voronoi_tiles.drawings import read_drawing

    try:
        drawing = read_drawing(Path(folder) / art.file)
    except DesignError as error:
        raise DesignError(
            f"the art cannot be used: {error.message}",
            file=error.file,
            key=f"site[{site}].art",
            line=error.line,
            remedy=error.remedy,
        ) from error
    factor = art.placement.scale * unit_at(art.placement.rotate) / unit_mm
    works: tuple[list[Paths], list[Paths]] = ([], [])
    for shape in drawing.shapes:
        layer = shape.layer.casefold()
        if GUIDE not in layer and (shape.stroke is not None or shape.fill is not None):
            works["score" in layer].append(shape.paths.moved(factor, art.placement.translate))
    return Paths.concatenate(works[0]), Paths.concatenate(works[1])


def _outline(tiling: Tiling, site: int) -> Paths:
    """The outline of a site's tile, in the design's units."""
    outline = tiling.tiles[site].outline
    return Paths(
        start=outline.start,
        end=outline.end,
        control=np.column_stack((np.where(outline.curved, outline.control, 0), np.zeros(len(outline)))),
        kind=outline.curved.astype(np.uint8),
        offsets=outline.ring_offsets,
        closed=np.ones(len(outline.ring_offsets) - 1, np.bool_),
    )


def _clipped(paths: Paths, region: Region, accuracy: float) -> Paths:
    """What of paths lies in a region; closed paths that lie in it as a whole stay closed."""
    simple = to_arcs(paths, accuracy=accuracy)
    runs = inner_runs(simple, region)
    whole = np.bincount(runs.path, minlength=len(simple)) == 1
    whole &= np.bincount(runs.path, runs.paths.counts, len(simple)) == simple.counts
    whole[runs.path[runs.starts_on_border | runs.ends_on_border]] = False
    closed = (whole & simple.closed)[runs.path]
    return replace(runs.paths, closed=closed)


def _copies_of(drawn: Paths, layout: Layout, site: int, shown: Bools) -> list[Paths]:
    """The images of a site's art on all copies of its tile on the page."""
    copies = layout.copies
    result: list[Paths] = []
    for tile in np.flatnonzero(layout.period.site == site).tolist():
        factor, shift, conj = layout.motion_to_page(tile)
        image = drawn.moved(factor, shift, conj=conj)
        here = np.flatnonzero((copies.tile == tile) & shown)
        place = layout.period.at(np.zeros(len(here), np.complex128), copies.step[here]) + copies.moved_by[here]
        result.append(stamped(image, place[copies.whole[here]]))
        rest = here[~copies.whole[here]]
        if len(rest) and layout.region is not None:
            for k, shift_k in zip(rest.tolist(), place[~copies.whole[here]].tolist(), strict=True):
                pulled = complex(copies.moved_by[k])
                inside = _clipped(image.moved(1.0, shift_k - pulled), layout.region, layout.job.accuracy / 2)
                result.append(inside.moved(1.0, pulled))
    return result


def stamped(paths: Paths, places: Complexes) -> Paths:
    """The same paths at many places, one after the other."""
    count, many = len(paths.start), len(places)
    shift = np.repeat(places, count)
    control = np.tile(paths.control, (many, 1)) + shift[:, None]
    kind = np.tile(paths.kind, many)
    control[kind == 0] = 0
    control[kind != 2, 1] = 0
    return Paths(
        start=np.tile(paths.start, many) + shift,
        end=np.tile(paths.end, many) + shift,
        control=control,
        kind=kind,
        offsets=np.append(0, np.cumsum(np.tile(paths.counts, many))).astype(np.intp),
        closed=np.tile(paths.closed, many),
    )


# --- labels -----------------------------------------------------------------------------------------------------


def _labels(tiling: Tiling, layout: Layout, contours: Contours) -> tuple[Paths, int]:
    """A label in every piece of a tile, and how many pieces are too small for one."""
    job = layout.job
    place, room = _label_places(layout, contours)
    pieces = np.flatnonzero(contours.copy >= 0)
    names = [printable(site.name) for site in tiling.design.sites]
    sites = layout.site[contours.copy[pieces]]
    texts = [str(k + 1) if job.labels == "number" else names[sites[k]] for k in range(len(pieces))]
    unit = {text: fitting_height(text, 1.0, _WANTED) if text.strip() else 1.0 for text in set(texts)}
    height = np.array([unit[text] for text in texts]) * room[pieces] * _ROOM
    height = 2.0 ** (np.floor(np.log2(np.maximum(height, 1e-9)) * _SIZES) / _SIZES)
    height = np.minimum(height, job.label_height)
    drawn = np.flatnonzero(height >= LABEL_MIN)
    labels = place_labels([texts[k] for k in drawn.tolist()], place[pieces[drawn]], height=height[drawn])
    return labels, len(pieces) - len(drawn)


def _label_places(layout: Layout, contours: Contours) -> tuple[Complexes, Floats]:
    """The point with the most room in every piece, and its distance from the contour; nothing for a frame's."""
    copies = layout.copies
    place = np.zeros(len(contours.copy), np.complex128)
    room = np.zeros(len(contours.copy))
    known: Bools = contours.copy >= 0
    whole = np.zeros(len(contours.copy), np.bool_)
    whole[known] = copies.whole[contours.copy[known]]
    tiles, first = np.unique(copies.tile[contours.copy[whole]], return_index=True)
    for tile, one in zip(tiles.tolist(), np.flatnonzero(whole)[first].tolist(), strict=True):
        here = np.flatnonzero(whole)[copies.tile[contours.copy[whole]] == tile]
        point, radius = _pole(contours, one, layout.job)
        shift = layout.period.at(np.zeros(len(here), np.complex128), copies.step[contours.copy[here]])
        shift = shift + copies.moved_by[contours.copy[here]]
        place[here] = point + (shift - shift[here.tolist().index(one)])
        room[here] = radius
    for k in np.flatnonzero(known & ~whole).tolist():
        place[k], room[k] = _pole(contours, k, layout.job)
    return place, room


def _pole(contours: Contours, piece: int, job: Job) -> tuple[complex, float]:
    """The point of a piece that is farthest from its contour."""
    rings: Ints = np.arange(contours.items[piece], contours.items[piece + 1])
    lines = to_lines(contours.paths.take(rings), accuracy=max(job.accuracy, 0.01))
    return label_position(np.split(lines.start, lines.offsets[1:-1]))


# --- beside the tiles ---------------------------------------------------------------------------------------------


def _beside(layout: Layout, contours: Contours | None, sheet: Sheet) -> list[Paths]:
    """Marks and the bar."""
    job = layout.job
    result = []
    if job.marks:
        size = min(_MARK_MM, job.margin)
        if size < 2.0:
            raise JobError("--marks need room at the edge", remedy="Give the sheet a --margin of 6mm, at least 2mm.")
        try:
            result.append(registration_marks(sheet.width, sheet.height, size=size, inset=job.margin / 2))
        except ValueError as error:
            raise JobError(str(error).rstrip("."), remedy="Take a larger sheet.") from error
    if job.bar:
        result.append(_bar(layout, contours, sheet))
    return result


def _bar(layout: Layout, contours: Contours | None, sheet: Sheet) -> Paths:
    """The reference bar: in the sheet's margin below, or below the tiles."""
    job = layout.job
    if sheet.region is None:
        paths = contours.paths if contours is not None else layout.contours().paths
        low_x, low_y, _, _ = paths.bounds
        height = bar_height(_LETTERS_MM)
        return reference_bar(letters=_LETTERS_MM).moved(1.0, complex(low_x, low_y - height - 2 * _FREE_MM))
    letters = min(_LETTERS_MM, (job.margin - 2 * _FREE_MM) / 2)
    beside = 2 * (job.margin + _MARK_MM) if job.marks else 2 * _FREE_MM
    if letters < 1.0 or sheet.width < BAR_MM + beside or not sheet.region.is_rectangle:
        raise JobError(
            "--bar, 100 mm long, has no room at the sheet's edge",
            remedy="Give a rectangular sheet that is wide enough a --margin of 8mm, at least 4mm.",
        )
    place = complex(sheet.width / 2 - BAR_MM / 2, (job.margin - bar_height(letters)) / 2)
    return reference_bar(letters=letters).moved(1.0, place)

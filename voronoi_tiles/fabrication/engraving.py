"""What is drawn on the pieces and beside them: art, labels, marks, the bar."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.fabrication.artwork import Works, draw_art
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.job_limits import LABEL_MIN
from voronoi_tiles.fabrication.layout import Contours, Layout, Sheet
from voronoi_tiles.fabrication.lettering import fitting_height, label_position, place_labels, printable
from voronoi_tiles.fabrication.marks import BAR_MM, bar_height, reference_bar, registration_marks
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths

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


def engrave(layout: Layout, contours: Contours | None, sheet: Sheet, shown: Bools, *, fills: bool) -> Works:
    """Draw what a job asks for beside its cuts; art on those tiles on the page that are `shown`.

    With `fills` the target engraves what is filled: then all lines are scored. Raises DesignError where the art of a
    site cannot be used, JobError where marks or the bar have no room.
    """
    job = layout.job
    art = draw_art(layout, shown, fills=fills)
    lines: list[Paths] = []
    notes = list(art.notes)
    if job.labels != "none":
        labels, small = _labels(layout, contours if contours is not None else layout.contours)
        lines.append(labels)
        if small:
            notes.append(f"{small} pieces are too small for a label of {LABEL_MIN:g} mm")
        names = [site.name for site in layout.design.noded if layout.job.labels == "site"]
        notes += [
            f'the label of "{name}" is engraved as "{printable(name)}": the font has no more'
            for name in names
            if printable(name) != name
        ]
    lines += _beside(layout, contours, sheet)
    engraved, scored = ([art.engraved], [art.scored, *lines]) if fills else ([art.engraved, *lines], [art.scored])
    return replace(art, engraved=Paths.concatenate(engraved), scored=Paths.concatenate(scored), notes=tuple(notes))


# --- labels -----------------------------------------------------------------------------------------------------


def _labels(layout: Layout, contours: Contours) -> tuple[Paths, int]:
    """A label in every piece of a tile, and how many pieces are too small for one."""
    job = layout.job
    place, room = _label_places(layout, contours)
    pieces = _read(layout, contours, place)
    numbers = np.arange(len(pieces)) + 1 if layout.numbers is None else layout.numbers[contours.copy[pieces]]
    names = [printable(site.name) for site in layout.design.noded]
    sites = layout.site[contours.copy[pieces]]
    texts = [
        layout.numbered(int(numbers[k])) if job.labels == "number" else names[sites[k]] for k in range(len(pieces))
    ]
    unit = {text: fitting_height(text, 1.0, _WANTED) if text.strip() else 1.0 for text in set(texts)}
    height = np.array([unit[text] for text in texts]) * room[pieces] * _ROOM
    height = 2.0 ** (np.floor(np.log2(np.maximum(height, 1e-9)) * _SIZES) / _SIZES)
    height = np.minimum(height, job.label_height)
    drawn = np.flatnonzero(height >= LABEL_MIN)
    labels = place_labels([texts[k] for k in drawn.tolist()], place[pieces[drawn]], height=height[drawn])
    return labels, len(pieces) - len(drawn)


def piece_numbers(layout: Layout, contours: Contours) -> Ints:
    """The number by which each tile on the page is labelled, from 1; of one in several pieces that of the last."""
    pieces = _read(layout, contours, _label_places(layout, contours)[0])
    numbers = np.zeros(len(layout.copies.tile), np.intp)
    numbers[contours.copy[pieces]] = np.arange(len(pieces)) + 1
    return numbers


def _read(layout: Layout, contours: Contours, place: Complexes) -> Ints:
    """The pieces of tiles as one reads."""
    pieces = np.flatnonzero(contours.copy >= 0)
    return pieces[reading_order(place[pieces], layout)]


def reading_order(place: Complexes, layout: Layout) -> Ints:
    """The order of places from left to right, line by line from above; lines are half a tile high."""
    line = np.round(-place.imag / (0.5 * float(np.sqrt(np.median(layout.tile_areas)))))
    return np.lexsort((place.real, line))


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
        copy = contours.copy[here]
        shift, k = layout.copy_shifts[copy], here.tolist().index(one)
        place[here] = point + (shift - shift[k])
        if copies.unit is not None:
            unit = copies.unit[copy]
            place[here] = unit * ((point - shift[k]) * unit[k].conjugate()) + shift
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
            raise JobError("`marks` need room at the edge", remedy="Give the sheet a `margin` of 6mm, at least 2mm.")
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
        paths = contours.paths if contours is not None else layout.contours.paths
        low_x, low_y, _, _ = paths.bounds
        height = bar_height(_LETTERS_MM)
        return reference_bar(_LETTERS_MM).moved(1.0, complex(low_x, low_y - height - 2 * _FREE_MM))
    letters = min(_LETTERS_MM, (job.margin - 2 * _FREE_MM) / 2)
    beside = 2 * (job.margin + _MARK_MM) if job.marks else 2 * _FREE_MM
    if letters < 1.0 or sheet.width < BAR_MM + beside or not sheet.region.is_rectangle:
        raise JobError(
            "`bar`, 100 mm long, has no room at the sheet's edge",
            remedy="Give a rectangular sheet that is wide enough, and a `margin` of 8mm, at least 4mm.",
        )
    place = complex(sheet.width / 2 - BAR_MM / 2, (job.margin - bar_height(letters)) / 2)
    return reference_bar(letters).moved(1.0, place)

"""The design of a selection, in the frame of its cell, and what its errors are about in the drawing."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from voronoi_tiles.base.errors import DesignError, TouchingCopiesError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.enclosed import ENCLOSED, enclosed_note
from voronoi_tiles.formats.svg.path_text import path_data
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.inkscape.cell_frame import CellFrame, frame_of_numbers, frame_of_place, frame_of_rectangle
from voronoi_tiles.inkscape.dialog_fields import CELL_LABEL, DesignFields
from voronoi_tiles.inkscape.selected_strokes import SelectedObject, Selection

_ROOM: Final = CellFrame({"a": 1e9, "b": 1e9, "angle": 90.0}, 0j, 1 + 0j)
"""A cell for strokes of any size, whose own is not known yet."""

_PASSED_OVER: Final = f'the cell is the rectangle "{CELL_LABEL}": the numbers of the dialog were not read'

_SITE: Final = re.compile(r"site\[(\d+)\](?:\.strokes\[(\d+)\])?")


@dataclass(frozen=True, eq=False)
class SelectionDesign:
    """A design of what is selected, in millimetres, and its frame on the page.

    `sources` name the objects of each site's strokes. `fitted` says that the cell was found for the strokes; `notes`
    are sentences on where it comes from, and on what the tile cannot be.
    """

    design: Design
    frame: CellFrame
    sources: tuple[tuple[str, ...], ...]
    fitted: bool
    notes: tuple[str, ...] = ()


def design_of(selection: Selection, fields: DesignFields) -> SelectionDesign:
    """The design of a selection: the strokes as they lie, in the cell of its rectangle or of the dialog.

    Raises DesignError, which names objects and entries of the dialog.
    """
    group = GROUPS[fields.group]
    fitted = selection.cell is None and fields.cell == "fitted"
    if selection.cell is not None:
        frame = frame_of_rectangle(selection.cell, group)
    elif fitted:
        from voronoi_tiles.designs.placing import find_place  # and shapely with it

        place = find_place(_made(selection, "p1", _ROOM, fields.tolerance).design.noded, group)
        frame = frame_of_place(place.cell, place.translate)
    else:
        frame = frame_of_numbers(fields)
    made = _made(selection, group.name, frame, fields.tolerance)
    notes = []
    if selection.cell is not None and fields.cell == "numbers":
        notes.append(_PASSED_OVER)
    if group.name in ENCLOSED and len(selection.sites) == 1:
        notes.append(enclosed_note(group.name))
    return SelectionDesign(made.design, frame, made.sources, fitted, tuple(notes))


def _made(selection: Selection, group: str, frame: CellFrame, tolerance: float) -> SelectionDesign:
    """The design of a selection in a frame."""
    strokes = [[stroke for drawn in site.objects for stroke in _strokes(drawn, frame)] for site in selection.sites]
    sources = tuple(tuple(source for source, _ in listed) for listed in strokes)
    table = {
        "schema": 1,
        "group": group,
        "cell": frame.cell,
        "site": [
            {"name": site.name, "tolerance": tolerance, "strokes": [stroke for _, stroke in listed]}
            for site, listed in zip(selection.sites, strokes, strict=True)
        ],
    }
    try:
        return SelectionDesign(Design.from_dict(table, name="selection"), frame, sources, fitted=False)
    except DesignError as error:
        raise _in_drawing(error, selection, sources) from None


def _strokes(drawn: SelectedObject, frame: CellFrame) -> list[tuple[str, Mapping[str, Any]]]:
    """The strokes of an object, in the frame, each with the object's name."""
    back = frame.turn.conjugate()
    found: list[Mapping[str, Any]] = []
    if len(drawn.paths):
        # Path data are written with y turned over, and strokes are read as they are.
        turned = drawn.paths.moved(back, -back * frame.origin).moved(1.0, 0j, conj=True)
        found.append({"path": path_data(turned)})
    for place in drawn.points:
        point = (place - frame.origin) * back
        found.append({"point": [point.real, point.imag]})
    return [(drawn.source, stroke) for stroke in found]


def _in_drawing(error: DesignError, selection: Selection, sources: tuple[tuple[str, ...], ...]) -> DesignError:
    """An error with the name of its object, or of its site, in the place of the key; of others as in the dialog."""
    found = _SITE.match(error.key or "")
    if found is None:
        return error.with_key((error.key or "").removeprefix("cell."))
    site = int(found[1])
    what = f'site "{selection.sites[site].name}"' if found[2] is None else sources[site][int(found[2])]
    return error.with_key(what.partition(", line ")[0])


def touching_error(error: TouchingCopiesError, frame: CellFrame, height: float) -> DesignError:
    """The error for copies that touch, with the place from the upper left corner of a page of this height."""
    place = frame.on_page(error.place)
    other = "its own copy" if error.site == error.other else f'the copy of "{error.other}"'
    return DesignError(
        f'"{error.site}" touches {other} under {error.operation}, {place.real:.4g} mm to the right and '
        f"{height - place.imag:.4g} mm down from the page's upper left corner",
        remedy="Move or shorten the strokes there, or make the cell larger: copies must keep apart.",
    )

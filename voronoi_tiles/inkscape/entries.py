"""The entries in Inkscape's menus and file dialogs, and the pages of their dialogs: all from the options themselves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Literal

from voronoi_tiles.fabrication.job_fields import JobFields
from voronoi_tiles.fabrication.job_options import Option, OptionTable
from voronoi_tiles.inkscape.dialog_fields import DesignFields, TilesFields

EntryName = Literal["tiles", "sheet", "strokes", "open"]

MENU: Final = "Voronoi tiles"
"""The submenu of Extensions, and what the names of file types begin with."""

_CELL: Final = tuple(DesignFields.options())

SHEET_PAGES: Final[Mapping[str, tuple[str, ...]]] = {
    "Cell": _CELL,
    "Sheet": ("sheet", "margin", "fit", "frame", "pieces", "rotate", "offset"),
    "Pieces": ("edges", "gap", "kerf", "fillet", "tabs", "curves", "accuracy"),
    "Nesting": ("layout", "grain", "count", "effort", "seed"),
    "Drawing": ("preset", "stroke", "colours", "labels", "label_height", "marks", "bar"),
}
"""The pages of the sheet's dialog, each with its options."""

ELSEWHERE: Final[Mapping[str, str]] = {
    "sheets": "several files",
    "into": "several files",
    "pack": "several files",
    "stock": "several files",
    "only_colour": "one file of several",
    "dxf_version": "another format",
    "feed": "another format",
    "power": "another format",
    "art": "what is selected has none",
}
"""Options of a job that no dialog has, each with its reason: the command line has them."""


@dataclass(frozen=True)
class Entry:
    """An entry: its name, its title, a line and more lines on it, and the options on the pages of its dialog.

    `suffix` is that of the files that it opens, "" where it changes a drawing; `live` says that it can be previewed.
    """

    name: EntryName
    title: str
    tip: str
    help: str = ""
    options: Mapping[str, Option[Any, Any]] = field(default_factory=dict)
    pages: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    suffix: str = ""
    live: bool = False


_SELECT: Final = """\
Select strokes: paths, shapes, clones, or groups of them. Each group is a site, which has a tile of its own; what is \
in no group is one site together. Texts have to be converted by Path > Object to Path.
A rectangle with the label "cell" (Object > Object Properties) is the cell; its lower left corner is the origin of \
the group. Without one the cell is fitted to the strokes, and drawn as such a rectangle: by each run anew, until it is \
moved or resized.
"""
_TILES_HELP: Final = """\
The exact tiles, proved, come to a layer of their own, which the next run replaces: to keep some, move them to another \
layer.
"""
_SHEET_HELP: Final = """\
The sheet comes to a layer of its own, its lower left corner in that of the page; the next run replaces it. Without a \
size it is the page. What is left empty is as usual.
"""


def _options(*tables: type[OptionTable]) -> dict[str, Option[Any, Any]]:
    """The options of tables that have no names in common."""
    return {name: option for table in tables for name, option in table.options().items() if name not in ELSEWHERE}


ENTRIES: Final = (
    Entry(
        "tiles",
        "Tiles from Selection",
        "The exact tiles that strokes have in a wallpaper group",
        _SELECT + _TILES_HELP,
        _options(TilesFields),
        {"Cell": (*_CELL, "line_width")},
        live=True,
    ),
    Entry(
        "sheet",
        "Sheet from Selection",
        "A sheet of the tiles that strokes have in a wallpaper group, ready to cut",
        _SELECT + _SHEET_HELP,
        _options(DesignFields, JobFields),
        SHEET_PAGES,
    ),
    Entry(
        "strokes",
        "Strokes of this Drawing",
        "The strokes, the cell and the tiles of the design that a file of ours was made from, beside its page",
    ),
    Entry(
        "open",
        f"{MENU}: a design (*.toml)",
        "The strokes of a design, to be changed, with its cell and its tiles",
        suffix=".toml",
    ),
)
"""All of them, in the order of the menu."""

assert all(name in entry.options for entry in ENTRIES for page in entry.pages.values() for name in page)

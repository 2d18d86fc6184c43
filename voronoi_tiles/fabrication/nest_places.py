"""Where pieces lie, as files say it in their recipes, from which the same files are made again."""

from __future__ import annotations

import json
import math
from typing import Final, NamedTuple

from voronoi_tiles.base.documents import read_bytes
from voronoi_tiles.base.errors import why_not_opened
from voronoi_tiles.base.files import is_special
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.job_options import SHEET_MAX, SHEETS_MOST, JobError
from voronoi_tiles.fabrication.layout import Layout, Piece
from voronoi_tiles.formats.recipe import recipe_of
from voronoi_tiles.formats.shapes import BYTES_MAX

NESTED_MAX: Final = 1_000
"""Most pieces that are nested; a count. Their check takes a minute, and at a border so long there is little to gain."""

_FIRST: Final = "numbered_from"
"""The key of the first number in recipes of sheets that are not the first."""


class SavedPlaces(NamedTuple):
    """The pieces of a file, none where they lie as in the tessellation; the text of its design; the first number."""

    pieces: tuple[Piece, ...]
    design: str
    first: int = 1

    def doubts(self, design: Design, name: str) -> tuple[str, ...]:
        """What there is to say where another design is laid as the file has it."""
        if self.design == design.source:
            return ()
        return (f"{shown(name)} was made of another design, or of this one before it was changed",)


def read_places(name: str) -> SavedPlaces:
    """The places in the recipe of a file of ours. Raises JobError."""
    if is_special(name):  # which may never end
        raise JobError(f"`layout`: {shown(name)} is a pipe or a device", remedy="Name a file.")
    try:
        recipe = recipe_of(read_bytes(name, BYTES_MAX))
    except (OSError, ValueError) as error:
        reason = why_not_opened(name, error)
        raise JobError(f"`layout`: {shown(name)} cannot be read: {reason}", remedy="Check the name.") from error
    remedy = "Name a file that was made with `layout='nested'`."
    if "design" not in recipe:
        raise JobError(f"`layout`: {shown(name)} is no file of tiles of ours, and has no places", remedy=remedy)
    damaged = JobError(f"`layout`: the places in {shown(name)} are damaged", remedy=remedy)
    try:
        if "places" not in recipe:
            if json.loads(recipe.get("job", "{}")).get("layout", "tessellated") != "tessellated":
                raise damaged
            return SavedPlaces((), recipe["design"])
        rows = json.loads(recipe["places"])
        count = len(rows)
        pieces = tuple(_piece(*row) for row in list(rows)[:NESTED_MAX])
        first = int(recipe.get(_FIRST, "1"))
    except (ValueError, TypeError, AttributeError, OverflowError, RecursionError):
        raise damaged from None
    if not pieces or not 1 <= first <= NESTED_MAX * SHEETS_MOST:
        raise damaged
    if count > NESTED_MAX:
        raise JobError(f"`layout`: {shown(name)} has {count:,} places, and {NESTED_MAX:,} are the most", remedy=remedy)
    return SavedPlaces(pieces, recipe["design"], first)


def _piece(site: object, over: object, turn: object, x: object, y: object) -> Piece:
    """The piece of a row. Raises ValueError, also for what is far off any sheet."""
    if isinstance(site, bool) or not isinstance(site, int) or over not in (0, 1):
        raise ValueError
    degrees, *place = (float(value) if isinstance(value, int | float) else math.nan for value in (turn, x, y))
    if not (abs(degrees) <= 360.0 and all(abs(value) <= SHEET_MAX for value in place)):
        raise ValueError
    return Piece(site, bool(over), degrees, complex(*place))


def places_recipe(layout: Layout) -> dict[str, str]:
    """What a recipe says of where nested pieces lie, and of their first number where that is not 1; JSON."""
    if not layout.pieces or layout.numbers is None:
        return {}
    rows = [[k, int(over), turn, place.real, place.imag] for k, over, turn, place in layout.pieces]
    first = int(layout.numbers.min())
    return {"places": json.dumps(rows), **({_FIRST: str(first)} if first > 1 else {})}

"""Files that are dropped onto the studio's page: drawings become strokes, designs and files of ours the design."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Final

from voronoi_tiles.base.documents import document_text
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.text import printable
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.load import STARTER, parse
from voronoi_tiles.formats.recipe import json_object, recipe_of
from voronoi_tiles.formats.shapes import DrawingError, ReadDrawing
from voronoi_tiles.studio.design_parts import require_parts
from voronoi_tiles.studio.matching import json_form
from voronoi_tiles.studio.messages import DROP_MAX, named_files

STROKES_MAX: Final = 500
"""Most strokes that a drawing becomes; a count. The paths of one with more objects are one stroke."""

SEGMENTS_MAX: Final = 5_000
"""Most lines and curves of a drawing; a count. A design of that many takes a second for its outline."""


def dropped(data: bytes, name: str, unit_mm: float, folder: str = os.curdir) -> dict[str, Any]:
    """What a file becomes in a design of a folder, whose unit is `unit_mm` millimetres.

    A design file (TOML, JSON) gives the "design" in its JSON form. One that we have exported (SVG, DXF, PDF, LightBurn,
    G-code) gives it, too, and the options of its "job". Any other SVG, DXF or G-code file gives "strokes" of path data,
    one for each object, as strokes of the kind `file` have it: in its real size, y up, the lower left corner of all at
    the origin. "notes" are sentences on what was left out or guessed, or is not in the folder. Raises DesignError.
    """
    name = printable(os.path.basename(name)) or "drawing"  # noqa: PTH119 - any name
    if name.lower().endswith((".toml", ".json")):
        return _design(data, name, folder)
    recipe = recipe_of(data)
    design = json_object(recipe.get("design", ""))
    if design:
        return {"design": _checked(design, name), "job": _job(json_object(recipe.get("job", ""))), "notes": []}
    if len(data) > DROP_MAX:
        raise DrawingError(
            f"larger than {DROP_MAX >> 20} MiB", file=name, remedy="Take a part of it, or simplify its curves."
        )
    from voronoi_tiles.formats.reading import drawing_of

    return _strokes(drawing_of(data, name), name, unit_mm)


def _design(data: bytes, name: str, folder: str) -> dict[str, Any]:
    """The design of a design file, and which of the files that it names are not in the folder. Raises DesignError."""
    try:
        text = document_text(data, "design", remedy=STARTER)
    except DesignError as error:
        raise error.with_file(name) from None
    table = parse(text, name[-4:].lower(), name)
    if "tiles" in table and "site" not in table:
        remedy = "Open the design, or an SVG, DXF, PDF or LightBurn file of it."
        raise DesignError("holds the outlines of tiles, not their design", file=name, remedy=remedy)
    design = json_form(_checked(table, name))
    missing = [shown(file) for file in sorted(named_files(design)) if not _is_there(file, folder)]
    notes = [f"{name} names {', '.join(missing)}, not to be found from {folder}: copy it there."] if missing else []
    return {"design": design, "notes": notes}


def _checked(design: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """A design that has its parts; `name` is its file's. Raises DesignError."""
    try:
        return require_parts(design)
    except DesignError as error:
        raise error.with_file(name) from None


def _is_there(file: str, folder: str) -> bool:
    """Whether there is a file, whose name may be any."""
    return os.path.exists(os.path.join(folder, file))  # noqa: PTH110, PTH118 - any name


def _strokes(drawing: ReadDrawing, name: str, unit_mm: float) -> dict[str, Any]:
    """The strokes of a drawing. Raises DrawingError."""
    from voronoi_tiles.designs.drawn_files import chosen_shapes, outlines_of, remarks
    from voronoi_tiles.formats.caveats import caveats
    from voronoi_tiles.formats.svg.path_text import path_data
    from voronoi_tiles.paths.paths import Paths

    shapes = chosen_shapes(drawing, None)
    found = [outlines_of([shape]) for shape in shapes]
    outlines = [paths for paths, _ in found if len(paths)]
    if not outlines:
        raise DrawingError(
            "nothing is drawn",
            file=name,
            remedy="Draw lines or curves, and show their layer; texts have to be converted to paths.",
        )
    together = Paths.concatenate(outlines)
    if len(together.start) > SEGMENTS_MAX:
        raise DrawingError(
            f"has {len(together.start):,} lines and curves, and {SEGMENTS_MAX:,} can be drawn with",
            file=name,
            remedy="Take a part of it, or simplify its curves.",
        )
    notes = [*caveats(drawing, name)]
    notes += remarks(name, joined=sum(joined for _, joined in found), guides=len(shapes) < len(drawing.shapes))
    if len(outlines) > STROKES_MAX:
        notes.append(
            f"{name}: its {len(outlines):,} objects are one stroke; {STROKES_MAX} would be strokes of their own"
        )
        outlines = [together]
    left, bottom, _, _ = together.bounds
    # Path data turn y over once more.
    lines = (paths.moved(1.0, -complex(left, bottom)).moved(1.0 / unit_mm, 0j, conj=True) for paths in outlines)
    return {"strokes": [{"path": path_data(paths)} for paths in lines], "notes": notes}


def _job(recipe: Mapping[str, Any]) -> dict[str, str | float | bool]:
    """The options of a job by name, as one would type them: sizes and places are lists in a recipe."""
    job = {}
    for name, value in recipe.items():
        match value:
            case str() | bool() | int() | float():
                job[name] = value
            case [int() | float() as x, int() | float() as y]:
                across, up = (repr(size).removesuffix(".0") for size in (x, y))
                job[name] = f"{across},{up}" if name == "offset" else f"{across}x{up}mm"
    return job

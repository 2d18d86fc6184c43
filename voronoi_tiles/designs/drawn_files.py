"""The lines of drawings, SVG and DXF files, as strokes: path data in the units of the design.

A stroke that names a file is the stroke of this path data, digit for digit: the recipe in files of ours has the path in
the place of the name, and gives the same tiles when the drawing has changed, or is gone.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.files import is_special
from voronoi_tiles.base.values import Table, file_name, shown, text, within
from voronoi_tiles.designs.art import GUIDE
from voronoi_tiles.formats.caveats import caveats
from voronoi_tiles.paths.paths import LINE, Paths

if TYPE_CHECKING:
    from voronoi_tiles.formats.shapes import ReadDrawing, Shape

FILE_REMEDY: Final = 'Write { file = "leaf.svg" }, the name of an SVG or DXF file beside the design.'

_NAMED: Final = 12
"""How many layers a message names."""


class DrawnFiles:
    """Reads the drawings that the strokes of a design name, relative to its `folder`.

    `unit_mm` is the design's unit in millimetres. `names` are the files that were read, as the strokes name them,
    `texts` the path data of one after the other, and `notes` sentences on what of them is left out or guessed. `size`
    is the longer side of the last one, in millimetres.
    """

    def __init__(self, folder: str, unit_mm: float) -> None:
        self._folder = folder
        self._unit_mm = unit_mm
        self._read_before: dict[tuple[str, str | None], ReadDrawing] = {}
        self.names: list[str] = []
        self.texts: list[str] = []
        self.notes: list[str] = []
        self.size = 0.0

    def path_data(self, stroke: Table) -> str:
        """The path data of a stroke's `file`, of its `layer` and its `id` alone where it has these.

        All that is drawn: lines as they are, and the outlines of what is filled, closed. The lower left corner of that
        is at the origin, y up. Raises DesignError, its key relative to the stroke.
        """
        with within("file"):
            name = file_name(stroke["file"], FILE_REMEDY)
        for key in ("layer", "id"):
            if key in stroke:
                with within(key):
                    if not text(stroke[key], f'Write {key} = "...", or leave it out.'):
                        raise DesignError("is empty", remedy="Leave it out.")
        try:
            drawing = self._read(name, stroke.get("id"))
            self.names.append(name)
            self._note(caveats(drawing, name))
            self.texts.append(self._text(drawing, name, stroke.get("layer")))
        except DesignError as error:
            line = None if error.line is None else f"line {error.line}"
            place = ", ".join(part for part in (name, line, error.key) if part)
            raise DesignError(f"{place}: {error.message}", key="file", remedy=error.remedy) from error
        return self.texts[-1]

    def _read(self, name: str, element: str | None) -> ReadDrawing:
        from voronoi_tiles.formats.reading import read_drawing

        if (name, element) not in self._read_before:
            # Never "-": a stroke is no place for standard input.
            path = os.path.join(self._folder or os.curdir, name)  # noqa: PTH118 - any name
            if is_special(path):  # which would wait for a writer, and holds nothing the next time
                raise DesignError("is a pipe or a device", remedy=FILE_REMEDY)
            self._read_before[name, element] = read_drawing(path, element=element)
        return self._read_before[name, element]

    def _text(self, drawing: ReadDrawing, name: str, layer: str | None) -> str:
        """The path data of what is drawn."""
        from voronoi_tiles.formats.svg.path_text import path_data

        shapes = chosen_shapes(drawing, layer)
        outlines, joined = outlines_of(shapes)
        self._note(remarks(name, joined=joined, guides=layer is None and len(shapes) < len(drawing.shapes)))
        if not len(outlines):
            where = "" if layer is None else f" on the layer {shown(layer)}"
            raise DesignError(
                f"nothing is drawn{where}",
                remedy="Draw lines or curves, and show their layer; texts have to be converted to paths.",
            )
        left, bottom, right, top = outlines.bounds
        self.size = max(right - left, top - bottom)
        lines = outlines.moved(1.0, -complex(left, bottom)).moved(1.0 / self._unit_mm, 0j, conj=True)
        return path_data(lines)  # which turns y over once more

    def _note(self, sentences: Iterable[str]) -> None:
        """Remember what there is to say of files, each sentence once."""
        self.notes += [note for note in sentences if note not in self.notes]


def chosen_shapes(drawing: ReadDrawing, layer: str | None) -> list[Shape]:
    """The shapes of a layer, or a colour "#rrggbb"; without one, all that are not on a layer of guides.

    Raises DesignError for a layer that the drawing has not.
    """
    if layer is None:
        return [shape for shape in drawing.shapes if GUIDE not in shape.layer.casefold()]
    found = [shape for shape in drawing.shapes if layer == shape.layer or layer.lower() == _colour(shape)]
    if not found:
        there = sorted({name for shape in drawing.shapes for name in (shape.layer, _colour(shape)) if name})
        more = f" and {len(there) - _NAMED} more" if len(there) > _NAMED else ""
        raise DesignError(
            f"there is no layer or colour {shown(layer)}",
            remedy=f"The drawing has {', '.join(map(shown, there[:_NAMED])) or 'none'}{more}; "
            "hidden layers do not count.",
        )
    return found


def _colour(shape: Shape) -> str | None:
    """The colour that a shape is drawn in."""
    return shape.stroke or shape.fill


def remarks(name: str, *, joined: int, guides: bool) -> Iterator[str]:
    """Sentences on what was done to a drawing: how many open paths were closed, whether guides were left out."""
    if guides:
        yield f'{name}: what is on the layer "{GUIDE}" is left out, as in art; name it to have it'
    if joined:
        many = f"{joined:,} open paths" if joined > 1 else "an open path"
        yield f"{name}: the fill of {many} is closed by a straight line; give lines a fill of none"


def outlines_of(shapes: list[Shape]) -> tuple[Paths, int]:
    """The paths of shapes, and how many of them, open ones that are filled, are closed by a line of their own."""
    parts, joined = [], 0
    for shape in shapes:
        paths = shape.paths
        parts.append(paths)
        if shape.fill is None:
            continue
        start, end = paths.start[paths.offsets[:-1]], paths.end[paths.offsets[1:] - 1]
        # A single line encloses nothing, and is not filled.
        flat = (paths.counts == 1) & (paths.kind[paths.offsets[:-1]] == LINE)
        gaps = np.flatnonzero(~paths.closed & (start != end) & ~flat)
        parts.append(Paths.polylines(list(np.stack((end, start), axis=1)[gaps])))
        joined += len(gaps)
    return Paths.concatenate(parts), joined

"""What the entries for drawings do: the tiles of what is selected, or a sheet of them, as a layer of the drawing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from voronoi_tiles.base.errors import DesignError, TouchingCopiesError
from voronoi_tiles.base.maps import Affine
from voronoi_tiles.fabrication.exact import design_recipe
from voronoi_tiles.formats.svg.path_text import path_data
from voronoi_tiles.formats.svg.reader import svg_tree
from voronoi_tiles.inkscape.cell_drawing import cell_layer
from voronoi_tiles.inkscape.cell_frame import CellFrame
from voronoi_tiles.inkscape.dialog_fields import DesignFields, TilesFields
from voronoi_tiles.inkscape.own_layers import OwnGroup, drawn_style, free_id, layer_text, with_layers
from voronoi_tiles.inkscape.selected_strokes import Selection, selected
from voronoi_tiles.inkscape.selection_design import SelectionDesign, design_of, touching_error

if TYPE_CHECKING:
    from voronoi_tiles.fabrication.product import Product
    from voronoi_tiles.tiling import Tiling

COLOUR: Final = "#000000"
"""The colour of outlines."""

DRAWING: Final = "the drawing"
"""What messages call it: Inkscape hands over a copy, whose name says nothing."""


def tiles(data: bytes, ids: Sequence[str], fields: TilesFields) -> bytes:
    """A drawing with the tiles of what is selected on a layer of their own, where they lie about their strokes.

    Raises VoronoiTilesError.
    """
    run = _Run.of(data, ids, fields)
    layer = layer_text(
        "tiles",
        "tiles",
        run.free_id("voronoi-tiles"),
        [outlines(run.tiling, run.made.frame, run.selection.to_page, fields.line_width)],
        recipe=design_recipe(run.made.design),
        notes=run.notes,
    )
    return with_layers(run.with_cell(data), "tiles", layer)


def outlines(tiling: Tiling, frame: CellFrame, to_page: Affine, line: float) -> OwnGroup:
    """The exact outlines of tiles where a frame has them, in user units, drawn with lines of some millimetres."""
    back, turn = to_page.inverse, frame.turn * tiling.design.unit_mm
    paths = [tile.outline.paths.moved(turn, frame.origin).mapped(back) for tile in tiling]
    texts = [(path_data(outline, top=None).encode(), tile.name) for outline, tile in zip(paths, tiling, strict=True)]
    return OwnGroup("outlines", drawn_style(COLOUR, line, to_page), texts)


def sheet(data: bytes, ids: Sequence[str], fields: DesignFields, job: Mapping[str, Any]) -> bytes:
    """A drawing with a sheet of tiles of what is selected on a layer, from the page's lower left corner.

    `job` are the arguments of a Job; without a size the sheet is the page. Raises VoronoiTilesError.
    """
    from voronoi_tiles.fabrication.job import Job
    from voronoi_tiles.inkscape.inx import in_dialog

    run = _Run.of(data, ids, fields)
    if "sheet" not in job and run.selection.size is None:
        raise DesignError("the page has no size", remedy="Give the sheet a size, such as 300x200mm.")
    product = run.tiling.make(Job(**{"sheet": run.selection.size, **job}), "svg")
    layer = layer_text(
        "sheet",
        f"sheet: {product.pieces.counted}",
        run.free_id("voronoi-sheet"),
        _works(product, run.selection.to_page),
        recipe=product.drawing.recipe,
        notes=[in_dialog(note) for note in (product.summary(), *run.notes, *product.notes)],
    )
    return with_layers(run.with_cell(data), "sheet", layer)


def _works(product: Product, to_page: Affine) -> Iterator[OwnGroup]:
    """The layers of a product, in user units, as groups."""
    from voronoi_tiles.formats.writing import without_arcs

    drawing = without_arcs(product.drawing)
    back = to_page.inverse
    for layer in drawing.layers:
        paths = layer.paths.moved(1.0, complex(0.0, -drawing.bottom)).mapped(back)
        style = drawn_style(layer.colour, layer.stroke, to_page)
        yield OwnGroup(
            layer.name,
            f"fill:{layer.colour};stroke:none" if layer.filled else style,
            [
                (path_data(paths.take(np.arange(first, stop)), top=None).encode(), label)
                for (first, stop), label in zip(
                    pairwise(layer.items.tolist()), layer.labels or ("",) * (len(layer.items) - 1), strict=True
                )
            ],
        )


@dataclass(frozen=True, eq=False)
class _Run:
    """One call: what is selected, its design, and its tiles."""

    selection: Selection
    made: SelectionDesign
    tiling: Tiling

    @classmethod
    def of(cls, data: bytes, ids: Sequence[str], fields: DesignFields) -> _Run:
        """Compute the tiles of what is selected."""
        root, _ = svg_tree(data, DRAWING)
        selection = selected(root, DRAWING, ids)
        made = design_of(selection, fields)
        try:
            return cls(selection, made, made.design.tessellate())
        except TouchingCopiesError as error:
            height = 0.0 if selection.size is None else selection.size[1]
            raise touching_error(error, made.frame, height) from None

    @property
    def notes(self) -> tuple[str, ...]:
        """What there is to say of the strokes."""
        return (*self.selection.notes, *self.made.design.notes, *self.made.notes)

    def free_id(self, wanted: str) -> str:
        """An id that nothing in the drawing begins with, but what is replaced."""
        return free_id(wanted, self.selection.names)

    def with_cell(self, data: bytes) -> bytes:
        """A drawing with the cell that was fitted in the place of the one before, which goes where numbers count."""
        frame, group, name = self.made.frame, self.made.design.group, self.free_id("voronoi-cell")
        layer = cell_layer(frame, group, self.selection.to_page, name, fitted=True) if self.made.fitted else b""
        return with_layers(data, "cell", layer, self.selection.fitted)

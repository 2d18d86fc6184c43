"""The exact tiles of a design where they lie in the plane, as a drawing: nothing is rounded, nothing approximated."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import offsets_of
from voronoi_tiles.base.version import __version__
from voronoi_tiles.designs.design import Design
from voronoi_tiles.formats.page import Drawing, Layer, fitting_page
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.vector.outline import Outline

CUT_LAYER: Final = "cut"
CUT_COLOUR: Final = "#000000"
HAIRLINE_MM: Final = 0.025


def design_recipe(design: Design) -> dict[str, str]:
    """What files say of the program and the design that they were made from."""
    return {"program": "voronoi-tiles", "version": __version__, "design": design.source}


def exact_svg(design: Design, tiles: Sequence[tuple[str, Outline]], evidence: Mapping[str, Any] | None) -> str:
    """The named outlines of a design's tiles as an SVG file; with evidence its metadata hold what was proved."""
    from voronoi_tiles.formats.svg.writer import write_svg

    drawing = exact_drawing(tiles, design.unit_mm, design_recipe(design))
    if evidence is not None:
        drawing = drawing.with_evidence(evidence)
    buffer = io.BytesIO()
    write_svg(drawing, buffer, exact=True)
    return buffer.getvalue().decode()


def exact_drawing(tiles: Sequence[tuple[str, Outline]], unit_mm: float, recipe: Mapping[str, str]) -> Drawing:
    """Draw the named outlines of tiles, in units of `unit_mm` millimetres, one object each.

    The page is the smallest of short sides, with the tiles in its middle. Its upper left corner is at 0: then a file
    whose y runs down has differences of the outlines' coordinates, rounded no further where the unit is the millimetre.
    """
    outlines = [outline for _, outline in tiles]
    bounds = np.array([outline.bounds for outline in outlines]) * unit_mm
    low, high = bounds[:, :2].min(axis=0).tolist(), bounds[:, 2:].max(axis=0).tolist()
    width, height, corner = fitting_page(*low, *high)
    paths = Paths.concatenate([outline.paths for outline in outlines])
    layer = Layer(
        name=CUT_LAYER,
        work="cut",
        colour=CUT_COLOUR,
        stroke=HAIRLINE_MM,
        paths=paths.moved(1.0, -(corner + 1j * height) / unit_mm).moved(unit_mm, 0j),
        items=offsets_of([len(outline.paths) for outline in outlines]),
        labels=tuple(name for name, _ in tiles),
    )
    return Drawing(width, height, (layer,), recipe=recipe, bottom=-height)

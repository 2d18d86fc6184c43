"""Lines of no length: dots that some machines burn, and that nobody sees."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator

from voronoi_tiles.formats.reading import ReadDrawing
from voronoi_tiles.preflight.cut_lines import any_stroke, is_cut
from voronoi_tiles.preflight.findings import Finding


def dot_findings(
    drawing: ReadDrawing, layers: Collection[str], place: Callable[[complex], tuple[float, float]]
) -> Iterator[Finding]:
    """The places of no length on what is cut; `layers` are as `cut_shapes` takes them, `place` is that of CutLines."""
    stroked = any_stroke(drawing)
    for dots in drawing.dots:
        if not is_cut(dots.layer, dots.stroke, layers, stroked):
            continue
        for point in dots.places.tolist():
            yield Finding(
                "dot",
                "warning",
                "a line of no length burns a point, or draws nothing",
                "Remove it, unless a point is meant.",
                place(point),
                0.0,
                (dots.source,),
            )

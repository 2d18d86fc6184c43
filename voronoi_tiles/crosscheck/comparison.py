"""The cross-check: the exact outlines of the vector stage against an image of the raster stage, both ways.

The two stages share no code but the vocabulary: what one has computed the other has not seen. Every threshold follows
from a precision that one of them states; none is tuned.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.values import is_number, shown
from voronoi_tiles.crosscheck.borders import compare_crossings, compare_points
from voronoi_tiles.crosscheck.check_report import CheckReport
from voronoi_tiles.crosscheck.labels import compare_labels
from voronoi_tiles.crosscheck.subject import Subject
from voronoi_tiles.designs.design import Design
from voronoi_tiles.raster.frame import cell_frame
from voronoi_tiles.raster.renderer import Choice, Method, Renderer
from voronoi_tiles.raster.scene import Pattern
from voronoi_tiles.vector.outline import Outline

SAMPLES_MAX = 8192
"""Most samples along the side of a cell; a count. They take 4 GB."""

DEFAULT_SAMPLES = 1024
"""Samples along the side of a cell where the caller names no number."""


def crosscheck(
    design: Design,
    outlines: Sequence[Outline],
    *,
    samples: int = DEFAULT_SAMPLES,
    renderer: Choice = "auto",
    device: int | None = None,
    method: Method = "exact",
    notice: Callable[[str], None] | None = None,
) -> CheckReport:
    """Compare the outlines of a design's tiles with an image of it over one cell, which stands for the whole plane.

    The image has about samples x samples samples. `renderer`, `device`, `method` and `notice` are those of Renderer.
    Raises RenderError where there is no image to be had, ArgumentError for fewer than one sample, or more than
    SAMPLES_MAX, and ValueError where an outline is open (which the proof refuses).
    """
    if not (is_number(samples) and float(samples).is_integer() and 1 <= samples <= SAMPLES_MAX):
        raise ArgumentError(
            f"`samples` {shown(samples)} cannot be", remedy=f"Give a whole number from 1 to {SAMPLES_MAX:,}."
        )
    pattern = Pattern(design.noded, design.group, design.lattice)
    frame = cell_frame(design.lattice, samples, centre=complex(design.noded[0].nodes.mean()))
    image = Renderer(renderer, device=device, method=method, notice=notice).render(pattern, frame)
    subject = Subject(design.units, tuple(outlines), pattern, image)
    owned, figures = compare_labels(subject)
    figures += compare_crossings(subject, owned)
    figures.append(compare_points(subject))
    return CheckReport(image.provenance, frame, design.units, design.source, tuple(figures))

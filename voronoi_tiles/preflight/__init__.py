"""Preflight: whether a drawing, ours or not, can be cut as it is, and where it cannot."""

from __future__ import annotations

import os
from collections.abc import Collection
from dataclasses import replace

import numpy as np

from voronoi_tiles.formats.reading import DrawingError, ReadDrawing, read_drawing
from voronoi_tiles.formats.recipe import tab_width
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.preflight.cut_lines import cut_shapes, layer_uses, subject_of
from voronoi_tiles.preflight.file_findings import page_findings
from voronoi_tiles.preflight.findings import DEFAULT_LIMITS, Finding, LayerUse, Limits, PreflightReport, report_text
from voronoi_tiles.preflight.line_findings import line_findings

__all__ = ["Finding", "LayerUse", "Limits", "PreflightReport", "judge", "preflight", "report_text"]


def preflight(
    path: str | os.PathLike[str], *, limits: Limits = DEFAULT_LIMITS, layers: Collection[str] = ()
) -> PreflightReport:
    """Find what would spoil the cut of an SVG or DXF file; `-` is standard input.

    Only the `layers` (or colours "#rrggbb") are judged; without any, all strokes but those on layers whose names say
    that they are engraved or scored. Raises DrawingError for what cannot be read, and for a layer that the file has
    not.
    """
    name = os.fspath(path)
    shown = "standard input" if name == "-" else name
    try:
        return judge(read_drawing(path), shown, limits=limits, layers=layers)
    except DrawingError as error:
        raise error.with_file(shown) from None


def judge(
    drawing: ReadDrawing, file: str, *, limits: Limits = DEFAULT_LIMITS, layers: Collection[str] = ()
) -> PreflightReport:
    """Find what would spoil the cut of a drawing that was read; `file` is its name in the report."""
    if limits.tabs is None:
        limits = replace(limits, tabs=tab_width(drawing.job))
    cut = cut_shapes(drawing, layers)
    uses = layer_uses(drawing, cut)
    drawn = Paths.concatenate([shape.paths for shape in drawing.shapes])
    bounds = drawn.bounds if len(drawn.start) else None
    findings = list(page_findings(drawing, bounds, uses))
    subject = subject_of(drawing, cut, limits)
    pieces = len(subject.paths.start)
    if pieces:
        findings += line_findings(subject, limits)
    extents = None
    if bounds is not None:
        (x0, y0), (x1, y1) = subject.place(complex(*bounds[:2])), subject.place(complex(*bounds[2:]))
        extents = (x0, min(y0, y1), x1, max(y0, y1))
    lengths = subject.paths.lengths
    return PreflightReport(
        file=file,
        drawing=drawing,
        limits=limits,
        layers=uses,
        findings=tuple(findings),
        extents=extents,
        pieces=pieces,
        nodes=pieces + int(np.count_nonzero(~subject.paths.closed)),
        shortest=float(lengths.min()) if pieces else None,
        length=float(lengths.sum()),
        cut=tuple(cut),
    )

"""Preflight: whether a drawing, ours or not, can be cut as it is, and where it cannot."""

from __future__ import annotations

import os
import sys
from collections.abc import Collection
from dataclasses import replace
from inspect import signature
from types import ModuleType

import numpy as np

from voronoi_tiles.base.arguments import instance, path_name, texts
from voronoi_tiles.base.files import refuse_overwriting, write_whole
from voronoi_tiles.formats.reading import DrawingError, ReadDrawing, read_drawing
from voronoi_tiles.formats.recipe import tab_width
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.preflight.annotated import marked_svg
from voronoi_tiles.preflight.cut_lines import cut_shapes, layer_uses, subject_of
from voronoi_tiles.preflight.dot_findings import dot_findings
from voronoi_tiles.preflight.everywhere import findings_everywhere
from voronoi_tiles.preflight.file_findings import page_findings
from voronoi_tiles.preflight.findings import DEFAULT_LIMITS, Finding, LayerUse, Limits, PreflightReport, report_text

__all__ = ["Finding", "LayerUse", "Limits", "PreflightReport", "judge", "preflight", "report_text"]


def preflight(
    path: str | os.PathLike[str],
    *,
    limits: Limits = DEFAULT_LIMITS,
    layers: Collection[str] = (),
    marked: str | os.PathLike[str] | None = None,
) -> PreflightReport:
    """Find what would spoil the cut of an SVG, DXF or G-code file; `-` is standard input.

    Only the `layers` (or colours "#rrggbb") are judged; without any, all strokes but those on layers whose names say
    that they are engraved or scored. With `marked` a picture of the drawing is written, an SVG file with a numbered
    mark at every finding. Raises DrawingError for what cannot be read, and for a layer that the file has not,
    OutputError, and ArgumentError.

    >>> import tempfile, voronoi_tiles as vt
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     files = vt.starter("p4m").tessellate().export(f"{folder}/pair.svg")
    ...     report = vt.preflight(f"{folder}/pair.svg")
    >>> report.passed, sorted({finding.kind for finding in report.findings})
    (False, ['duplicate'])
    """
    name = path_name("path", path)
    layers = _check(limits, layers)
    shown = "standard input" if name == "-" else name
    try:
        report = judge(read_drawing(path), shown, limits=limits, layers=layers)
    except DrawingError as error:
        raise error.with_file(shown) from None
    if marked is not None:
        refuse_overwriting([path_name("marked", marked)], [name])
        write_whole(marked, marked_svg(report).encode())
    return report


def judge(
    drawing: ReadDrawing, file: str, *, limits: Limits = DEFAULT_LIMITS, layers: Collection[str] = ()
) -> PreflightReport:
    """Find what would spoil the cut of a drawing that was read; `file` is its name in the report.

    Raises DrawingError for a layer that the drawing has not, and ArgumentError.
    """
    layers = _check(limits, layers)
    if drawing.job and drawing.format == "dxf" and not drawing.unit_known:
        drawing = replace(drawing, unit="mm", unit_known=True)  # R12 of our own, before it said so
    if limits.tabs is None:
        limits = replace(limits, tabs=tab_width(drawing.job))
    cut = cut_shapes(drawing, layers)
    drawn = Paths.concatenate([shape.paths for shape in drawing.shapes])
    uses = layer_uses(drawing, drawn, cut)
    bounds = drawn.bounds if len(drawn.start) else None
    findings = list(page_findings(drawing, bounds, uses))
    subject = subject_of(drawing, drawn, cut)
    findings += dot_findings(drawing, layers, subject.place)
    pieces = len(subject.paths.start)
    if pieces:
        findings += findings_everywhere(subject, limits)
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


def _check(limits: Limits, layers: Collection[str]) -> list[str]:
    """The names of the layers. Raises ArgumentError for arguments of other types."""
    instance("limits", limits, Limits)
    return texts("layers", layers, 'Give names of layers or colours, such as ["cut", "#ff0000"].')


class _CallableModule(ModuleType):
    """This package as `vt.preflight`: its name and that of the function are one, and the import binds the package."""

    __call__ = staticmethod(preflight)
    __signature__ = signature(preflight)


__doc__ = f"{__doc__}\n\nIt can be called: see `preflight` in it."
sys.modules[__name__].__class__ = _CallableModule

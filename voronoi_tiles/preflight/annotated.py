"""A picture of what a preflight found: the drawing in grey, a numbered mark at each finding, and a legend."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import Final

from voronoi_tiles.base.text import printable
from voronoi_tiles.formats.svg.path_text import path_data
from voronoi_tiles.preflight.findings import Finding, PreflightReport, Severity, grouped

MARKS_MAX: Final = 500
"""Most marks of one kind; a count. The legend says how many more there are."""

LINES_MAX: Final = 25
"""Most findings of one kind that the legend lists; a count."""

_COLOURS: Final[dict[Severity, str]] = {"error": "#d60000", "warning": "#e08000", "info": "#0060d0"}


def marked_svg(report: PreflightReport) -> str:
    """The picture as an SVG file in millimetres, its marks where the findings' places are.

    Numbers count the findings by severity and kind, as the text does.
    """
    left, top, width, height = _frame(report)
    unit = max(width, height, 1e-3) / 100
    groups = grouped(report.findings)
    legend = list(_legend(groups))
    rows = len(legend)
    whole_width, whole_height = width + 50 * unit, max(height, (rows + 3) * 1.6 * unit)
    box = f"{whole_width:.6g} {whole_height:.6g}"
    size = f'width="{whole_width:.6g}mm" height="{whole_height:.6g}mm"'
    corner = f'x="{left:.6g}" y="{top:.6g}"'
    parts = ['<?xml version="1.0" encoding="utf-8"?>\n']
    parts.append(f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="{left:.6g} {top:.6g} {box}">\n')
    parts.append(f'<rect {corner} width="{whole_width:.6g}" height="{whole_height:.6g}" fill="#ffffff"/>\n')
    parts += _page(report, unit)
    parts += _drawing(report, unit)
    parts += _marks(groups, unit, 1.0 if report.drawing.format == "svg" else -1.0)
    x, y = left + width + 2 * unit, top + 2 * unit
    for row, (colour, text, bold) in enumerate(legend):
        weight = ' font-weight="bold"' if bold else ""
        parts.append(
            f'<text x="{x:.6g}" y="{y + 1.6 * unit * row:.6g}" font-family="sans-serif" font-size="{unit:.6g}" '
            f'fill="{colour}"{weight}>{escape(printable(text), quote=False)}</text>\n'
        )
    parts.append("</svg>\n")
    return "".join(parts)


def _frame(report: PreflightReport) -> tuple[float, float, float, float]:
    """The rectangle around page and drawing, with a margin: left, top, width, height; y down."""
    boxes = []
    drawing = report.drawing
    if drawing.width is not None and drawing.height is not None:
        boxes.append((0.0, 0.0, drawing.width, drawing.height))
    if report.extents is not None:
        x0, y0, x1, y1 = report.extents
        boxes.append((x0, y0, x1, y1) if drawing.format == "svg" else (x0, -y1, x1, -y0))
    if not boxes:
        return 0.0, 0.0, 100.0, 100.0
    x0, y0 = (min(box[k] for box in boxes) for k in (0, 1))
    x1, y1 = (max(box[k] for box in boxes) for k in (2, 3))
    margin = max(x1 - x0, y1 - y0, 1e-3) / 20
    return x0 - margin, y0 - margin, x1 - x0 + 2 * margin, y1 - y0 + 2 * margin


def _page(report: PreflightReport, unit: float) -> Iterator[str]:
    drawing = report.drawing
    if drawing.width is not None and drawing.height is not None:
        yield (
            f'<rect width="{drawing.width:.6g}" height="{drawing.height:.6g}" fill="none" stroke="#cccccc" '
            f'stroke-width="{unit / 10:.6g}"/>\n'
        )


def _drawing(report: PreflightReport, unit: float) -> Iterator[str]:
    """What is cut in grey, the rest in light grey."""
    drawing = report.drawing
    height = (drawing.height or 0.0) if drawing.format == "svg" else 0.0
    for shape, cut in zip(drawing.shapes, report.cut, strict=True):
        data = path_data(shape.paths, top=height, number="{:.4f}".format)
        yield (
            f'<path d="{data}" fill="none" stroke="{"#808080" if cut else "#d8d8d8"}" '
            f'stroke-width="{unit / 10:.6g}"/>\n'
        )


def _marks(groups: list[list[Finding]], unit: float, down: float) -> Iterator[str]:
    """A ring with its number at each place; those of errors on top. `down` is -1 where places have y up."""
    number = 0
    marks = []
    for group in groups:
        colour = _COLOURS[group[0].severity]
        for k, finding in enumerate(group):
            number += 1
            if finding.place is None or k >= MARKS_MAX:
                continue
            x, y = finding.place[0], down * finding.place[1]
            marks.append(
                f'<circle cx="{x:.4f}" cy="{y:.4f}" r="{unit:.6g}" fill="none" stroke="{colour}" '
                f'stroke-width="{unit / 5:.6g}"/>\n'
                f'<text x="{x + 1.2 * unit:.4f}" y="{y - 0.5 * unit:.4f}" font-family="sans-serif" '
                f'font-size="{unit:.6g}" fill="{colour}">{number}</text>\n'
            )
    yield from reversed(marks)


def _legend(groups: list[list[Finding]]) -> Iterator[tuple[str, str, bool]]:
    """The lines of the legend: colour, text, and whether it is a heading."""
    if not groups:
        yield "#008000", "nothing found", True
    number = 0
    for group in groups:
        first = group[0]
        colour = _COLOURS[first.severity]
        yield colour, f"{first.kind} ({first.severity}): {len(group):,}", True
        for k, finding in enumerate(group):
            number += 1
            if k < LINES_MAX:
                yield colour, f"{number}  {finding.message}", False
        if len(group) > LINES_MAX:
            yield colour, f"and {len(group) - LINES_MAX:,} more; {min(len(group), MARKS_MAX):,} are marked", False

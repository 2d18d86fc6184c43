"""What a preflight finds, as data, as a document for programs and as text for people."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any, Final, Literal

from voronoi_tiles.base.arguments import number
from voronoi_tiles.base.text import counted, printable
from voronoi_tiles.formats.reading import ReadDrawing

Severity = Literal["error", "warning", "info"]
SEVERITIES: Final[tuple[Severity, ...]] = ("error", "warning", "info")

LENGTH_MIN: Final = 1e-6
"""Smallest distance at which lines are still two; millimetres. Files hold nanometres."""

PLACES_SHOWN: Final = 20
"""How many places of one kind the text shows; a count. The document has them all."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What a preflight measures against; millimetres, `corner` in degrees.

    Lines nearer than `tolerance` are one place; ends nearer than `gap` should have met; material narrower than `neck`
    and contours smaller than `feature` break or burn; pieces shorter than `shortest` are rubbish; corners sharper than
    `corner` burn. Gaps up to the width `tabs` are bridges that are meant; None takes what a file of our own says.
    Raises ArgumentError for numbers that cannot be.
    """

    tolerance: float = 0.005
    gap: float = 0.5
    neck: float = 1.0
    feature: float = 1.0
    shortest: float = 0.01
    corner: float = 20.0
    tabs: float | None = None

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            least = LENGTH_MIN if field.name == "tolerance" else 0.0
            if not (value is None and field.name == "tabs"):
                unit = "degrees" if field.name == "corner" else "millimetres"
                number(field.name, value, f"Give a number of {unit}, {least:g} or more.", least=least)


DEFAULT_LIMITS: Final = Limits()
"""What a laser cutter and a sheet of 3 mm ask for."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was found.

    `place` is in millimetres as the file's own program shows it: SVG from the page's upper left corner, y down; DXF y
    up. It is None for what concerns the whole file. `value` is the size that was measured, in millimetres (corners:
    degrees). `sources` are the objects it concerns.
    """

    kind: str
    severity: Severity
    message: str
    remedy: str
    place: tuple[float, float] | None = None
    value: float | None = None
    sources: tuple[str, ...] = ()

    def document(self) -> dict[str, Any]:
        """The finding in the types of JSON."""
        place = None if self.place is None else list(self.place)
        return {**asdict(self), "place": place, "sources": list(self.sources)}


@dataclass(frozen=True, slots=True)
class LayerUse:
    """A layer and colour of the file: its objects, pieces and millimetres, and whether it is judged as cut."""

    layer: str
    colour: str | None
    shapes: int
    pieces: int
    length: float
    cut: bool


@dataclass(frozen=True, eq=False, repr=False)
class PreflightReport:
    """All findings on one file; `extents` (least, then greatest x and y) are as places, None where nothing is drawn."""

    file: str
    drawing: ReadDrawing
    limits: Limits
    layers: tuple[LayerUse, ...]
    findings: tuple[Finding, ...]
    extents: tuple[float, float, float, float] | None
    pieces: int
    nodes: int
    shortest: float | None
    length: float
    cut: tuple[bool, ...] = ()

    def __repr__(self) -> str:
        kinds = ", ".join(dict.fromkeys(finding.kind for finding in self.findings)) or "nothing found"
        return f"<PreflightReport {self.file!r}: {'passed' if self.passed else 'failed'}, {kinds}>"

    @property
    def passed(self) -> bool:
        """Whether nothing was found that would spoil a cut."""
        return not any(finding.severity == "error" for finding in self.findings)

    def document(self) -> dict[str, Any]:
        """The report as what JSON can hold; the keys are stable."""
        drawing = self.drawing
        return {
            "schema": 1,
            "file": self.file,
            "format": drawing.format,
            "passed": self.passed,
            "y": "down" if drawing.format == "svg" else "up",
            "width": drawing.width,
            "height": drawing.height,
            "unit": drawing.unit,
            "unit_known": drawing.unit_known,
            "extents": None if self.extents is None else list(self.extents),
            "pieces": self.pieces,
            "nodes": self.nodes,
            "shortest": self.shortest,
            "length": self.length,
            "limits": asdict(self.limits),
            "layers": [asdict(use) for use in self.layers],
            "ignored": dict(drawing.ignored),
            "clones": drawing.clones,
            "findings": [finding.document() for finding in self.findings],
        }

    def json(self) -> str:
        """The document as text."""
        return json.dumps(self.document(), indent=2, allow_nan=False) + "\n"


def grouped(findings: Sequence[Finding]) -> list[list[Finding]]:
    """The findings by severity and kind, the worst first."""
    groups: dict[tuple[int, str], list[Finding]] = {}
    for finding in findings:
        groups.setdefault((SEVERITIES.index(finding.severity), finding.kind), []).append(finding)
    return [groups[key] for key in sorted(groups)]


def report_text(report: PreflightReport) -> str:
    """Write a report for people: the file, its layers, and the findings, at most PLACES_SHOWN of each kind."""
    drawing = report.drawing
    page = "no page" if drawing.width is None or drawing.height is None else _size(drawing.width, drawing.height)
    lines = [
        f"file      {printable(report.file)}",
        f"page      {page}, unit {drawing.unit or 'not declared'}",
    ]
    if report.extents is not None:
        x0, y0, x1, y1 = report.extents
        lines.append(f"drawing   {_size(x1 - x0, y1 - y0)} from ({x0:.6g}, {y0:.6g}) to ({x1:.6g}, {y1:.6g})")
    shortest = "" if report.shortest is None else f", the shortest {report.shortest:.4g} mm"
    segments = counted(report.pieces, "segment")
    lines += [
        f"cut       {report.length:.6g} mm, {segments}{shortest}, {counted(report.nodes, 'node')}",
        f"places    in mm, y {'down from the upper left corner' if drawing.format == 'svg' else 'up'}",
        "",
    ]
    rows = [
        (
            printable(use.layer) or "-",
            use.colour or "no stroke",
            f"{use.shapes:,}",
            f"{use.pieces:,}",
            f"{use.length:.6g}",
            "cut" if use.cut else "not cut",
        )
        for use in report.layers
    ]
    lines += _columns([("layer", "colour", "objects", "segments", "mm", ""), *rows])
    for group in grouped(report.findings):
        first = group[0]
        found = f": {len(group):,} found" if len(group) > 1 else ""
        lines += ["", f"{first.severity.upper()}  {first.kind}{found}"]
        for finding in group[:PLACES_SHOWN]:
            place = "" if finding.place is None else f"({finding.place[0]:.3f}, {finding.place[1]:.3f}) "
            sources = f" [{'; '.join(printable(source) for source in finding.sources)}]" if finding.sources else ""
            lines.append(f"  {place}{printable(finding.message)}{sources}")
        if len(group) > PLACES_SHOWN:
            lines.append(f"  and {len(group) - PLACES_SHOWN:,} more; --json lists them all")
        lines.append(f"  {first.remedy}")
    counts = [
        counted(sum(finding.severity == severity for finding in report.findings), noun)
        for severity, noun in zip(SEVERITIES, ("error", "warning", "remark"), strict=True)
    ]
    verdict = "nothing that would spoil the cut" if report.passed else "this would spoil the cut"
    lines += ["", f"{', '.join(counts)}: {verdict}."]
    return "\n".join(lines) + "\n"


def _size(width: float, height: float) -> str:
    return f"{width:.6g} x {height:.6g} mm"


def _columns(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """A table, the numbers flush right."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return [
        "  ".join(
            cell.rjust(width) if k in {2, 3, 4} else cell.ljust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]

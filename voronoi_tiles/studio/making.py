"""From a design and a job of the page to what is cut: shown with its report and its findings, or as files."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from functools import lru_cache
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, Final
from zipfile import ZipFile, ZipInfo

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.coupon import coupon
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import JobError, read_number
from voronoi_tiles.fabrication.job_report import report_figures
from voronoi_tiles.fabrication.product import make_reported
from voronoi_tiles.formats.cubics import CUBIC_ACCURACY_MM
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.formats.presets import FORMATS as DRAWINGS
from voronoi_tiles.formats.presets import load_preset
from voronoi_tiles.formats.reading import drawing_of
from voronoi_tiles.formats.svg.path_text import path_texts
from voronoi_tiles.formats.writing import write_drawing
from voronoi_tiles.paths.conversion import to_cubics
from voronoi_tiles.preflight import Finding, Limits, judge
from voronoi_tiles.preflight.findings import grouped
from voronoi_tiles.studio.messages import named_files
from voronoi_tiles.studio.tables import FORMS, HIDDEN, Form
from voronoi_tiles.tiling import Tiling

SHOWN_MAX: Final = 16 << 20
"""Most path data that is sent to be shown; bytes. A browser draws no more."""

FINDINGS_MAX: Final = 1_000
"""Most findings that are sent, the worst first; a count."""

_STEM_MAX: Final = 150
"""Longest name of a download; bytes of UTF-8. File systems take 255, with what tells several files apart."""

_ODD: Final = re.compile(r"[^\w.-]+")
_LONG_AGO: Final = (1980, 1, 1, 0, 0, 0)


def product(
    rev: int, design: Mapping[str, Any], job: Mapping[str, Any], limits: Mapping[str, Any], name: str
) -> dict[str, Any]:
    """The message "product": what a job makes of a design, its report, and what would spoil its cut.

    Paths and places are in millimetres from the upper left corner of the page, y down. Raises VoronoiTilesError.
    """
    begun = perf_counter()
    asked, form = read_options(job)
    if form in DRAWINGS:
        load_preset(asked.preset).require(form)
    tiling = tiling_of(design, name)
    made, packing = make_reported(tiling.design, tiling.tessellation, asked)
    drawing = made.drawing
    layers, whole = _shown_layers(drawing)
    findings = _findings(drawing, limits)
    notes = [*tiling.design.notes, *made.notes]
    notes.extend(re.sub(r"^with `gap='([\d.]+)mm'`", r"With a gap of \1 mm", hint) for hint in made.hints)
    if not whole:
        notes.append("there is more than can be shown here; the file has it all")
    return {
        "type": "product",
        "rev": rev,
        "report": report_figures(tiling.design, made, packing=packing),
        "sheet": None if asked.sheet is None else {"width": drawing.width, "height": drawing.height},
        "page": {"width": drawing.width, "height": drawing.height},
        "layers": layers,
        "found": len(findings),
        "findings": list(map(_finding_document, findings[:FINDINGS_MAX])),
        "notes": notes,
        "ms": round(1000 * (perf_counter() - begun), 3),
    }


def exported(design: Mapping[str, Any], job: Mapping[str, Any], name: str) -> tuple[str, bytes]:
    """The name and the bytes of the file that a job makes of a design: what `voronoi-tiles export` writes of it.

    Several files are put into one, a zip. Raises VoronoiTilesError.
    """
    asked, form = read_options(job)
    options = asked if job.keys() - {"format"} else None  # without any, the exact tiles as they lie in the plane
    tiling = tiling_of(design, name)
    stem = stem_of(name)
    with TemporaryDirectory(prefix="voronoi-tiles-") as folder:
        path = Path(folder) / f"{stem}.{form}"
        if form == "png":
            tiling.render(path, colours="none" if asked.colours == "none" else asked.scheme)
        else:
            tiling.export(path, job=options, file_format=form)
        return _one_file(stem, {path.name: path.read_bytes() for path in sorted(Path(folder).iterdir())})


def coupon_file(options: Mapping[str, Any]) -> tuple[str, bytes]:
    """The name and the bytes of a coupon for `thickness`, `kerfs`, `plug`, `preset`, `feed`, `power` and `format`.

    Raises VoronoiTilesError.
    """
    given = dict(options)
    form = given.pop("format", "svg")
    if form not in DRAWINGS:
        raise ArgumentError(f"no coupon can be made as {shown(form)}", remedy=f"Use one of {', '.join(DRAWINGS)}.")
    known = ("thickness", "kerfs", "plug", "preset", "feed", "power")
    for unknown in given.keys() - set(known):
        raise ArgumentError(f"a coupon has no option {shown(unknown)}", remedy=f"Give {', '.join(known)}.")
    if "thickness" not in given:
        raise ArgumentError("a coupon needs a `thickness`", remedy="Give that of the sheet, such as 3mm.")
    with TemporaryDirectory(prefix="voronoi-tiles-") as folder:
        path = Path(folder) / f"coupon.{form}"
        coupon(path, **given)
        return path.name, path.read_bytes()


def read_options(job: Mapping[str, Any]) -> tuple[Job, Form]:
    """The job of the page's options, and the format; SVG where they name none. Raises ArgumentError, JobError."""
    given = dict(job)
    asked = given.pop("format", "svg")
    form = next((form for form in FORMS if form == asked), None)
    if form is None:
        raise ArgumentError(f"unknown `format` {shown(asked)}", remedy=f"Use one of {', '.join(FORMS)}.")
    known = Job.options()
    for name in given:
        if name not in known or name in HIDDEN:
            raise JobError(f"a job has no option {shown(name)}", remedy="Load the page again.")
    asked_for = Job(**given)
    if asked_for.layout == "nested":
        raise JobError(
            "`layout='nested'` searches for longer than the studio waits",
            remedy="Use `layout='auto'` here, and nest with voronoi-tiles export.",
        )
    return asked_for, form


def tiling_of(design: Mapping[str, Any], name: str) -> Tiling:
    """The tiling of a design, proved; it is kept while only the job changes. Raises VoronoiTilesError."""
    if named_files(design):  # which may change meanwhile
        return Design.from_dict(design, name=name).tessellate()
    return _kept(json.dumps(design), name)


@lru_cache(maxsize=2)
def _kept(design: str, name: str) -> Tiling:
    """The tiling of a design in JSON."""
    return Design.loads(design, format="json", name=name).tessellate()


def _shown_layers(drawing: Drawing) -> tuple[list[dict[str, Any]], bool]:
    """The layers with their path data, and whether these are all there: what is beyond SHOWN_MAX has none."""
    found, left = [], SHOWN_MAX
    for layer in drawing.layers:
        data = b" ".join(path_texts(to_cubics(layer.paths, accuracy=CUBIC_ACCURACY_MM), layer.items, drawing.height))
        left -= len(data)
        found.append(_layer_document(layer, data.decode() if left >= 0 else ""))
    return found, left >= 0


def _layer_document(layer: Layer, path: str) -> dict[str, Any]:
    """A layer as the page draws it."""
    return {
        "name": layer.name,
        "kind": layer.work,
        "colour": layer.colour,
        "filled": layer.filled,
        "closed": bool(layer.paths.closed.all()),
        "path": path,
    }


def _findings(drawing: Drawing, limits: Mapping[str, Any]) -> list[Finding]:
    """What a preflight of the file finds, the worst first."""
    measures = {name: read_number(name, value) for name, value in limits.items()}
    unknown = measures.keys() - set(Limits.__slots__)
    if unknown:
        raise ArgumentError(f"a preflight has no limit {shown(min(unknown))}", remedy="Load the page again.")
    file = BytesIO()
    write_drawing(drawing, file, "svg", accuracy=CUBIC_ACCURACY_MM)
    report = judge(drawing_of(file.getvalue(), "drawing.svg"), "drawing.svg", limits=Limits(**measures))
    return [finding for group in grouped(report.findings) for finding in group]


def _finding_document(finding: Finding) -> dict[str, Any]:
    """A finding as the page shows it."""
    return {
        "kind": finding.kind,
        "severity": finding.severity,
        "message": finding.message,
        "remedy": finding.remedy,
        "at": None if finding.place is None else list(finding.place),
        "sources": list(finding.sources),
    }


def stem_of(name: str) -> str:
    """What a download is called that is made of a design of this name, without a suffix."""
    return _ODD.sub("-", name).encode()[:_STEM_MAX].decode(errors="ignore").strip(".-") or "design"


def _one_file(stem: str, files: Mapping[str, bytes]) -> tuple[str, bytes]:
    """The only file, or all in a zip; the same files give the same bytes."""
    if len(files) == 1:
        return next(iter(files.items()))
    archive = BytesIO()
    with ZipFile(archive, "w") as zipped:
        for name, data in files.items():
            zipped.writestr(ZipInfo(name, _LONG_AGO), data)
    return f"{stem}.zip", archive.getvalue()

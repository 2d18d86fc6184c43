"""What the curves of a job become in a file: which kind it is to hold, and how paths get there."""

from __future__ import annotations

from collections.abc import Callable

from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.arc_fitting import corner_radii, edge_cubics
from voronoi_tiles.fabrication.demands import refuse_misread
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.formats.cubics import CUBIC_ACCURACY_MM
from voronoi_tiles.formats.presets import Format, Preset
from voronoi_tiles.paths.biarcs import to_arcs
from voronoi_tiles.paths.conversion import to_cubics, to_lines
from voronoi_tiles.paths.paths import Paths


def file_curves(job: Job, preset: Preset, form: Format) -> str:
    """What curves become in a file: as the job says, or the preset. Raises JobError where the format has none such."""
    wanted = job.curves
    if wanted is None:
        wanted = {"svg": preset.svg_curves, "dxf": preset.dxf_curves, "gcode": "polyline"}.get(form, "exact")
    if form == "dxf" and wanted == "exact":
        wanted = "spline"
    if form == "gcode" and wanted not in {"arc", "polyline"}:
        raise JobError(
            f"G-code has lines and circular arcs, and no `curves='{wanted}'`", remedy="Use polyline, or arc."
        )
    if form == "dxf" and wanted == "cubic":
        raise JobError(
            "DXF has no Bezier curves, and no `curves='cubic'`",
            remedy="Use arc, the fewest arcs, or spline, the exact curves; or write SVG, PDF or lbrn2.",
        )
    refuse_misread(job, preset, form, wanted)
    return wanted


def curve_converter(curves: str, job: Job, budget: AccuracyBudget) -> Callable[[Paths], Paths]:
    """What is still to be done to paths so that they hold only what the file takes."""
    match curves:
        case "polyline":
            return lambda paths: to_lines(paths, accuracy=budget.chords)
        case "arc":
            return lambda paths: to_arcs(paths, accuracy=budget.arcs)
        case "cubic":
            return lambda paths: edge_cubics(paths, budget, corner_radii(job))
        case "spline":
            return lambda paths: to_cubics(paths, accuracy=CUBIC_ACCURACY_MM)
        case _:
            return lambda paths: paths

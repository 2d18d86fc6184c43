"""What the target of a preset demands of a job, said or done before anything is computed for nothing."""

from __future__ import annotations

from dataclasses import replace

from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.job_limits import APART_MM
from voronoi_tiles.formats.presets import Format, Preset


def as_demanded(job: Job, preset: Preset) -> Job:
    """A job with the contours that a target takes: closed ones, and apart where it unites what touches.

    Raises JobError where the job asks for others.
    """
    if preset.contours == "shared":
        return job
    if job.edges == "once" or job.tabs > 0.0:
        option, why = ("tabs", "leave them open") if job.tabs > 0.0 else ("edges='once'", "cuts lines that are open")
        raise JobError(
            f"{preset.name} makes shapes of closed contours, and `{option}` {why}",
            remedy=f"Leave `{option.partition('=')[0]}` out, or take another preset.",
        )
    gap = job.gap
    if preset.contours == "apart" and not job.pack and job.apart is None:
        if gap is not None or job.fit == "frame":
            option, instead = ("gap=0", "`gap='0.5mm'`") if gap is not None else ("fit='frame'", "`fit='whole'`")
            raise JobError(
                f"{preset.name} unites pieces that touch, and with `{option}` they do",
                remedy=f"Use {instead}, or another preset.",
            )
        gap = APART_MM
    return replace(job, edges="pieces", gap=gap)


def refuse_misread(job: Job, preset: Preset, form: Format, curves: str) -> None:
    """Raise JobError where the target gets these `curves`, or the version of DXF, wrong, and where that has no such."""
    if form == "dxf" and job.dxf_version == "R12" and curves == "spline":
        raise JobError("DXF of the version R12 has no splines", remedy="Use `curves='arc'` or `curves='polyline'`.")
    wrong = preset.misread.get(form, ())
    if form == "dxf" and job.dxf_version in wrong:
        raise JobError(
            f"{preset.name} does not read `dxf_version='{job.dxf_version}'` right", remedy="Leave `dxf_version` out."
        )
    if curves in wrong:
        raise JobError(
            f"{preset.name} does not read `curves='{curves}'` of {form} files right",
            remedy="Leave `curves` out: the preset says which it reads.",
        )

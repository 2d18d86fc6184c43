"""What is said beside a product: widths that change nothing, lines that are cut twice, pieces that fall out."""

from __future__ import annotations

from typing import Final

from voronoi_tiles.base.text import counted
from voronoi_tiles.fabrication.cutting import Cut
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.layout import Layout
from voronoi_tiles.formats.presets import Format

_STROKED: Final = ("svg", "pdf")
"""The formats that have widths of lines."""


def untabbed(cuts: list[Cut], job: Job) -> list[str]:
    """Say how many pieces are too small for tabs, where there are any."""
    small = sum(int(cut.paths.closed.sum()) for cut in cuts) if job.tabs > 0.0 and job.cuts_pieces else 0
    if not small:
        return []
    are, fall = ("is", "falls") if small == 1 else ("are", "fall")
    return [f"{counted(small, 'contour')} {are} too short for tabs of {job.tabs:g} mm, and {fall} out"]


def without_effect(form: Format, job: Job) -> list[str]:
    """Say that a format has no widths of lines, or no version of DXF, where one is asked for."""
    said = []
    if job.stroke and form not in _STROKED:
        said.append(f"{form} files have no line widths: `stroke` changes nothing")
    if job.dxf_version != "R2000" and form != "dxf":
        said.append(f"{form} files are not DXF: `dxf_version` changes nothing")
    return said


def unnested(job: Job) -> list[str]:
    """Say what of that which was asked about nesting changes nothing."""
    said = [
        f"`{name}` changes nothing without {what}"
        for name, works, what in (
            ("grain", job.layout != "tessellated", "a `layout`"),
            ("effort", job.layout == "nested", "`layout='nested'`"),
            ("seed", job.layout == "nested", "`layout='nested'`"),
        )
        if not works and getattr(job, name) != Job.options()[name].default
    ]
    drawn = isinstance(job.sheet, str) and job.layout == "nested" and not job.pack
    if drawn and any(getattr(job, name) != Job.options()[name].default for name in ("effort", "seed")):
        said.append("a sheet that is drawn is nested without a search: `effort` and `seed` change nothing")
    if job.layout == "auto" and job.not_nestable is not None:
        why, remedy = job.not_nestable
        said.append(f"pieces are not nested: `layout='auto'` {why}. {remedy.rstrip('.')}")
    elif job.layout == "auto" and not job.apart:
        said.append("pieces are not nested: `layout='auto'` is for those that a `kerf` or a `gap` pulls apart")
    return said


def doubled(layout: Layout, job: Job) -> list[str]:
    """Say that neighbours' contours lie on each other, or touch, where they do."""
    if not job.cuts_pieces or job.nests or (job.apart or 0.0) > 0.0 or len(layout.copies.tile) < 2 or job.sheet is None:
        return []
    if job.pack or (job.split == "files" and (job.scheme == "fewest" or isinstance(job.scheme, int))):
        return []  # neighbours are in different files
    if job.apart is not None:
        return ["neighbouring contours touch, and are cut twice where they lie on each other: `gap='1mm'` avoids it"]
    once = "" if job.needs_pieces() else "`edges='once'`, or "
    return [f"neighbouring contours lie on each other, and are cut twice: {once}`gap='1mm'`, avoids it"]

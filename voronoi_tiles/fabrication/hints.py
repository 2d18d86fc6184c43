"""What another gap, or layout, would be good for where tiles are pulled apart: more of them on the sheet."""

from __future__ import annotations

from typing import Final

from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.layout import Layout, refilled

_LESS: Final = 0.5
"""The gap that is tried, a share of the one that there is."""

_LEAST_MM: Final = 0.3
"""A gap that is not gone below; millimetres. Nor is twice the kerf: what is left between two cuts would burn."""

_NEARLY: Final = 0.9
"""A gap that is hardly smaller, as a share, is not worth a word."""

ROOM: Final = 1.5
"""Tiles that are pulled apart to so many times their room are hooked: nested by themselves they take less."""


def hints_of(layout: Layout, asked: Job) -> tuple[str, ...]:
    """How more tiles may fit than lie on the sheet as a job asked for it, in words."""
    stretch = layout.stretch
    room = stretch.p**2 - abs(stretch.q) ** 2
    hints = [smaller_gap(layout)]
    if room >= ROOM and asked.layout == "tessellated" and asked.not_nestable is None:
        hints.append(f"tiles are pulled apart to {room:.1f} times their room: `layout='auto'` may hold more")
    return tuple(filter(None, hints))


def smaller_gap(layout: Layout) -> str:
    """That a smaller gap would let more whole tiles on the sheet, in words; nothing where it would not."""
    apart, job = layout.job.apart, layout.job
    if not apart or layout.region is None or job.fit != "whole" or layout.stretch.is_identity:
        return ""
    gap = float(f"{max(_LESS * apart, 2 * job.kerf, _LEAST_MM):.2g}")
    if gap >= _NEARLY * apart:
        return ""
    here = len(layout.copies.tile)
    try:
        count = len(refilled(layout, gap=gap).copies.tile)
    except JobError:
        return ""
    return f"with `gap='{gap:g}mm'` {count:,} tiles would fit" if count > here else ""

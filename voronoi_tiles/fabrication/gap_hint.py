"""What a smaller gap would be good for: how many more tiles a sheet would hold."""

from __future__ import annotations

from typing import Final

from voronoi_tiles.fabrication.job import JobError
from voronoi_tiles.fabrication.layout import Layout, refilled

_LESS: Final = 0.5
"""The gap that is tried, a share of the one that there is."""

_LEAST_MM: Final = 0.3
"""A gap that is not gone below; millimetres. Nor is twice the kerf: what is left between two cuts would burn."""

_NEARLY: Final = 0.9
"""A gap that is hardly smaller, as a share, is not worth a word."""


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

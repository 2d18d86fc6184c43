"""What is to be said to whoever uses a drawing that was read: what was guessed, mended and left out."""

from __future__ import annotations

from voronoi_tiles.base.text import counted
from voronoi_tiles.base.units import RELATIVE
from voronoi_tiles.formats.shapes import ReadDrawing


def unit_caveat(drawing: ReadDrawing) -> str:
    """A sentence on the unit that was taken where the file declares none, or pixels; "" where it declares another."""
    if drawing.unit_known:
        return ""
    if drawing.format == "dxf":
        return drawing.unit_guess
    if drawing.unit in RELATIVE:
        return f"the page's size is in {drawing.unit}, which every program takes for another length"
    if drawing.unit == "px":
        size = "the page's size is in px"
    else:
        size = "the page has no size" if drawing.width is None else "the page's size has no unit"
    return f"{size}; 96 user units to the inch were taken, as CSS says, and other programs take 72 or 90"


def caveats(drawing: ReadDrawing, file: str) -> tuple[str, ...]:
    """Sentences on a drawing, each with the `file` it is about: its unit, its remarks, and what was left out of it."""
    said = [unit_caveat(drawing), *drawing.remarks]
    what = ", ".join(f"{name} ({count:,})" for name, count in sorted(drawing.ignored.items()))
    if what:
        said.append(f"left out what is no path: {what}; convert texts to paths")
    count = sum(len(dots.places) for dots in drawing.dots)
    if count:
        said.append(f"left out {counted(count, 'line')} of no length")
    return tuple(f"{file}: {text}" for text in said if text)

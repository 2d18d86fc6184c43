"""What concerns the file as a whole: its size, its unit, and what was left out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from voronoi_tiles.base.text import counted
from voronoi_tiles.formats.caveats import unit_caveat
from voronoi_tiles.formats.reading import ReadDrawing
from voronoi_tiles.preflight.findings import Finding, LayerUse

OUTSIDE: Final = 0.01
"""By how much a drawing may reach over its page; millimetres. Pages are rounded to the hundredth."""

LARGE: Final = 5_000.0
"""Larger drawings are a slip of the unit; millimetres. No laser's bed is as long."""

_TEXT: Final = frozenset({"text", "flowRoot", "TEXT", "MTEXT", "ATTDEF", "ATTRIB"})
_IMAGE: Final = frozenset({"image", "IMAGE"})


def page_findings(
    drawing: ReadDrawing, extents: tuple[float, float, float, float] | None, layers: tuple[LayerUse, ...]
) -> Iterator[Finding]:
    """What is wrong with size, unit and content; `extents` are those of all that is drawn, y up."""
    yield from _unit(drawing)
    yield from _remarks(drawing)
    if extents is None:
        yield Finding(
            "empty",
            "error",
            "the file draws nothing",
            "Draw lines or curves; text and images have to be converted to paths.",
        )
    else:
        yield from _size(drawing, extents)
        if not any(use.cut for use in layers):
            yield Finding(
                "empty",
                "error",
                "nothing is cut: all layers are named as not cut",
                "Name what is cut: `layers=['NAME']`.",
            )
        elif all(use.colour is None for use in layers):
            yield Finding(
                "no stroke",
                "warning",
                "nothing has a stroke; the outlines of what is filled were judged",
                "Give what is cut a stroke and no fill: many drivers engrave what is filled.",
            )
    yield from _left_out(drawing)


def _unit(drawing: ReadDrawing) -> Iterator[Finding]:
    message = unit_caveat(drawing)
    if not message:
        return
    if drawing.format == "dxf":
        remedy = "Set $INSUNITS, 4 for millimetres or 1 for inches: the unit for inserted content, in CAD programs."
    else:
        remedy = 'Write the size with its unit and a viewBox: width="300mm" height="200mm" viewBox="0 0 300 200".'
    yield Finding("unit", "warning", message, remedy)


def _remarks(drawing: ReadDrawing) -> Iterator[Finding]:
    for remark in drawing.remarks:
        yield Finding("reading", "warning", remark, "Compare what was read with what was drawn, or save the file anew.")


def _size(drawing: ReadDrawing, extents: tuple[float, float, float, float]) -> Iterator[Finding]:
    x0, y0, x1, y1 = extents
    if max(x1 - x0, y1 - y0) <= 0.0:
        yield Finding("size", "error", "the drawing has no size", "Check its transforms and its unit.", value=0.0)
        return
    if max(x1 - x0, y1 - y0) > LARGE:
        yield Finding(
            "size",
            "warning",
            f"the drawing is {x1 - x0:.6g} x {y1 - y0:.6g} mm large",
            "Check its unit.",
            value=max(x1 - x0, y1 - y0),
        )
    if drawing.width is None or drawing.height is None:
        return
    over = {
        "left": -x0,
        "right": x1 - drawing.width,
        "upper": y1 - drawing.height,
        "lower": -y0,
    }
    for side, far in over.items():
        if far > OUTSIDE:
            yield Finding(
                "outside",
                "error",
                f"the drawing reaches {far:.4g} mm over the {side} edge of the page",
                "Move it, or fit the page to it: drivers leave out or cut off what is outside.",
                value=far,
            )


def _left_out(drawing: ReadDrawing) -> Iterator[Finding]:
    for name, count in drawing.ignored.items():
        if name in _TEXT:
            message, remedy = f"{count:,} {name}: text is not cut", "Convert it to paths."
        elif name in _IMAGE:
            message, remedy = f"{count:,} {name}: images are not cut", "Trace them, or remove them."
        elif "another file" in name:
            message, remedy = f"{count:,} {name}: other files are not opened", "Embed them as paths."
        elif name.startswith("paint "):
            message = f"{count:,} {name}: not understood; it counts as paint, whatever its colour"
            remedy = 'Write it as "#rrggbb", or as none.'
        elif name == "invisible object":
            message = f"{counted(count, name)}: an opacity of 0 hides what many drivers cut; left out here"
            remedy = "Remove it, or make it visible."
        elif name == "clip of a nested svg":
            message = f"{count:,} {name}: objects reach over the edge of a nested drawing, and are not cut off there"
            remedy = "Cut them off in the drawing, or ungroup it."
        elif name == "style rule" or name.endswith("'"):
            message, remedy = f"{count:,} {name}: not read", "Correct it, or save the file as plain SVG."
        else:
            message, remedy = f"{count:,} {name}: not read", "Convert it to paths, or remove it if it is not needed."
        yield Finding("unsupported", "warning", message, remedy, value=float(count))
    if drawing.clones:
        clones = counted(drawing.clones, "block" if drawing.format == "dxf" else "clone")
        they_are, them = ("it is", "it") if drawing.clones == 1 else ("they are", "them")
        yield Finding(
            "clones",
            "info" if drawing.format == "dxf" else "warning",
            f"{clones}: {they_are} judged as drawn here, but many drivers leave {them} out",
            "Unlink the clones." if drawing.format == "svg" else "Explode the blocks.",
            value=float(drawing.clones),
        )

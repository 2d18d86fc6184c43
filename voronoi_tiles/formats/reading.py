"""Drawings of others: SVG, DXF and G-code files, read without trusting them.

Whatever a file holds, reading it ends with the drawing or with one DrawingError, in bounded time and memory: nothing
outside the file is opened, and sizes, depths and numbers of elements are limited (`voronoi_tiles.formats.shapes`).
"""

from __future__ import annotations

import os
import re
from dataclasses import replace
from typing import Final

from voronoi_tiles.base.documents import read_bytes
from voronoi_tiles.base.errors import why_not_opened
from voronoi_tiles.base.values import shown as in_quotes
from voronoi_tiles.formats.recipe import job_of
from voronoi_tiles.formats.shapes import BYTES_MAX, DrawingError, ReadDrawing, Shape

_GCODE: Final = re.compile(rb"[;(]|[GMNgmn][ \t]*\d|%[ \t]*[\r\n]")
"""How files of G-code begin: a comment, a word, or a line of a percent sign."""

__all__ = ["DrawingError", "ReadDrawing", "Shape", "read_drawing"]


def read_drawing(path: str | os.PathLike[str], *, element: str | None = None) -> ReadDrawing:
    """Read an SVG, DXF or G-code file, by its content where that is clear, else by its suffix; `-` is standard input.

    With `element` only what has that id and what stands in it (SVG), or the entity with that handle (DXF), is drawn.
    Raises DrawingError for what cannot be read, and for an element that the file has not.
    """
    name = os.fspath(path)
    shown = "standard input" if name == "-" else name or repr(name)
    try:
        data = read_bytes(name, BYTES_MAX + 1)
    except (OSError, ValueError) as error:
        reason = why_not_opened(name, error)
        raise DrawingError(f"cannot be read: {reason}", file=shown, remedy="Check the name.") from error
    return drawing_of(data, shown, element=element)


def drawing_of(data: bytes, name: str, *, element: str | None = None) -> ReadDrawing:
    """The drawing of an SVG, DXF or G-code file's content; `name` is that of the file. See `read_drawing`."""
    if len(data) > BYTES_MAX:
        raise DrawingError(f"larger than {BYTES_MAX >> 20} MiB", file=name, remedy="Split it, or simplify its curves.")
    head = data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n")
    suffix = os.path.splitext(name)[1].lower()  # noqa: PTH122 - a name that is no path is no error here
    is_xml = head.startswith((b"<", b"\x1f\x8b", b"\xff\xfe<", b"\xfe\xff\x00<"))
    if is_xml or suffix in {".svg", ".svgz"}:
        from voronoi_tiles.formats.svg.reader import svg_drawing

        return replace(svg_drawing(data, name, element), job=job_of(data))
    if suffix == ".dxf" or head.startswith((b"0", b"999", b"AutoCAD Binary DXF")):
        from voronoi_tiles.formats.dxf.reader import dxf_drawing

        return replace(dxf_drawing(data, name, element), job=job_of(data))
    if suffix in {".gcode", ".nc"} or _GCODE.match(head):
        from voronoi_tiles.formats.gcode.reader import gcode_drawing

        if element is not None:
            raise DrawingError(f"G-code has no element {in_quotes(element)}", file=name, remedy="Take all of it.")
        return replace(gcode_drawing(data, name), job=job_of(data))
    raise DrawingError(
        "neither an SVG nor a DXF file, nor G-code",
        file=name,
        remedy="Give it the suffix .svg, .dxf or .gcode if it is.",
    )

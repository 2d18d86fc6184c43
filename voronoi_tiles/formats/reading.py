"""Drawings of others: SVG and DXF files, read without trusting them.

Whatever a file holds, reading it ends with the drawing or with one DrawingError, in bounded time and memory: nothing
outside the file is opened, and sizes, depths and numbers of elements are limited (`voronoi_tiles.formats.shapes`).
"""

from __future__ import annotations

import os
from dataclasses import replace

from voronoi_tiles.base.documents import read_bytes
from voronoi_tiles.base.errors import why_not_opened
from voronoi_tiles.formats.recipe import job_of
from voronoi_tiles.formats.shapes import BYTES_MAX, DrawingError, ReadDrawing, Shape

__all__ = ["DrawingError", "ReadDrawing", "Shape", "read_drawing"]


def read_drawing(path: str | os.PathLike[str], *, element: str | None = None) -> ReadDrawing:
    """Read an SVG or DXF file, by its content where that is clear and else by its suffix; `-` is standard input.

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
    """The drawing of an SVG or DXF file's content; `name` is that of the file. See `read_drawing`."""
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
    raise DrawingError("neither an SVG nor a DXF file", file=name, remedy="Give it the suffix .svg or .dxf if it is.")

"""The outline of a drawing: the closed line around all else, and what is drawn within."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np
import shapely
from scipy.spatial import cKDTree
from shapely.geometry import Polygon

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.art import GUIDE
from voronoi_tiles.escherization.goal_outline import GoalOutline
from voronoi_tiles.formats.caveats import caveats
from voronoi_tiles.formats.reading import DrawingError, ReadDrawing, Shape, drawing_of, read_drawing
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths

_FLAT: Final = 1e-4
"""How far chords may be from the outline's curves; relative to the larger side of the drawing."""

_SPECK: Final = 1e-3
"""What lies outside of the outline and has a smaller area than this is no second outline; relative to the first."""

_PIXELS: Final = (b"\x89PNG", b"\xff\xd8\xff", b"GIF8", b"BM", b"RIFF", b"II*\0", b"MM\0*")
"""How files of pixels begin: PNG, JPEG, GIF, BMP, WebP, TIFF."""


@dataclass(frozen=True, eq=False)
class DrawnOutline:
    """The silhouette of a drawing, in its millimetres, and the drawing of all else, whose shapes are art.

    `name` is that of the file without its suffix; `notes` are sentences on what was taken for what.
    """

    name: str
    silhouette: GoalOutline
    rest: ReadDrawing
    notes: tuple[str, ...]


class _Closed(NamedTuple):
    """Paths of shapes, by the numbers of both, as one polygon; `closed` is whether they are drawn closed, or filled."""

    parts: tuple[tuple[int, int], ...]
    polygon: Polygon
    closed: bool
    ends: float


def read_outline(path: str | os.PathLike[str], *, element: str | None = None) -> DrawnOutline:
    """Read the outline of an SVG or DXF file: of its closed lines that of the largest area.

    Several open lines that meet end to end are one.
    With `element` it is looked for in what has that id (SVG) or handle (DXF) alone. Lines within it, holes of its shape
    too, are art; a second closed line beside it is refused. Raises DrawingError.
    """
    name = os.fspath(path)
    _refuse_pixels(_head(name), name)
    drawing = read_drawing(name)
    return _outline(drawing, name, None if element is None else read_drawing(name, element=element))


def outline_of(data: bytes, name: str) -> DrawnOutline:
    """The outline of an SVG or DXF file's content; `name` is that of the file. See `read_outline`."""
    _refuse_pixels(data, name)
    return _outline(drawing_of(data, name), name, None)


def _outline(drawing: ReadDrawing, name: str, asked: ReadDrawing | None) -> DrawnOutline:
    """The outline of a drawing; where a part of it is asked for, it is looked for in that alone."""
    shapes = [shape for shape in drawing.shapes if GUIDE not in shape.layer.casefold() and len(shape.paths)]
    contours = _contours(shapes, name)
    candidates = contours
    if asked is not None:
        starts = [shape.paths.start for shape in asked.shapes]
        own = [any(np.array_equal(shape.paths.start, start) for start in starts) for shape in shapes]
        candidates = [each for each in contours if any(own[shape] for shape, _ in each.parts)]
    chosen = max((each for each in candidates if each.closed), key=lambda each: each.polygon.area, default=None)
    longest = max(candidates, key=lambda each: _extent(each.polygon), default=None)
    if longest is None:
        _refuse_image(drawing, name)
        raise DrawingError(
            "nothing is drawn that encloses an area",
            file=name,
            remedy="Draw one closed line around the shape; texts have to be converted to paths.",
        )
    if chosen is None or (not longest.closed and _extent(longest.polygon) > _extent(chosen.polygon)):
        raise DrawingError(
            f"the outline is open: the ends of {_called(longest, shapes)} are {longest.ends:.4g} mm apart",
            file=name,
            remedy="Close its path.",
        )
    try:
        silhouette = GoalOutline.of(chosen.polygon)
    except ArgumentError as error:
        message = error.message.replace("`outline`", f"the outline, {_called(chosen, shapes)},")
        message += ", in mm from the page's lower left corner" if " at " in message else ""
        raise DrawingError(message, file=name, remedy=error.remedy) from None
    if asked is None:
        _refuse_second(chosen, contours, shapes, name)
    rest, holes = _without(shapes, [chosen, *_again(chosen, contours)])
    notes = [*caveats(drawing, name)]
    if asked is None and rest and _is_page(chosen.polygon, drawing):
        what = f"the rectangle of the page, {_called(chosen, shapes)}, is taken as the outline"
        notes.append(f"{name}: {what}; name another by its id, --element ID")
    if holes:
        became = "becomes" if holes == 1 else "become"
        notes.append(f"{name}: {counted(holes, 'hole')} of the outline {became} art: a tile has none")
    stem = os.path.splitext(os.path.basename(name))[0]  # noqa: PTH119, PTH122 - any name
    return DrawnOutline(stem or "outline", silhouette, replace(drawing, shapes=tuple(rest)), tuple(notes))


def _head(name: str) -> bytes:
    """How a file begins. One that cannot be read is refused by the reader."""
    try:
        with open(name, "rb") as file:  # noqa: PTH123 - any name
            return file.read(8)
    except (OSError, ValueError):
        return b""


def _refuse_pixels(head: bytes, name: str) -> None:
    """Refuse a file of pixels, with what to do."""
    if head.startswith(_PIXELS):
        raise _no_pixels(name)


def _refuse_image(drawing: ReadDrawing, name: str) -> None:
    """Refuse a drawing that holds a picture of pixels and no outline, with what to do."""
    if any("image" in kind.casefold() for kind in drawing.ignored):
        raise _no_pixels(name)


def _no_pixels(name: str) -> DrawingError:
    return DrawingError(
        "a picture of pixels has no outline",
        file=name,
        remedy="Trace it first, in Inkscape by Path > Trace Bitmap, and save the outline as SVG.",
    )


def _contours(shapes: list[Shape], name: str) -> list[_Closed]:
    """All lines of shapes that enclose something, also several that do so together, end to end."""
    if not shapes:
        return []
    left, bottom, right, top = Paths.concatenate([shape.paths for shape in shapes]).bounds
    accuracy = _FLAT * max(right - left, top - bottom)
    if not accuracy > 0.0:
        raise DrawingError("what is drawn has no size", file=name, remedy="Draw one closed line around the shape.")
    found: list[_Closed] = []
    single: list[tuple[tuple[int, int], Complexes]] = []
    for number, shape in enumerate(shapes):
        lines = to_lines(shape.paths, accuracy=accuracy)
        for k in range(len(lines)):
            points = np.append(
                lines.start[lines.offsets[k] : lines.offsets[k + 1]], lines.end[lines.offsets[k + 1] - 1]
            )
            ends = float(abs(points[-1] - points[0]))
            filled = shape.fill is not None and len(points) > 2  # a single line encloses nothing
            closed = bool(lines.closed[k]) or filled or ends <= accuracy
            if not closed:
                single.append(((number, k), points))
            if len(points) - (ends == 0.0) > 2:
                found.append(_Closed(((number, k),), Polygon(plane(points)), closed, ends))
    return found + _end_to_end(single, accuracy)


def _end_to_end(single: list[tuple[tuple[int, int], Complexes]], near: float) -> list[_Closed]:
    """Open lines that close a ring together: at each of their ends one other begins or ends, as near as that."""
    if not single:
        return []
    ends = np.array([points[[0, -1]] for _, points in single]).ravel()
    pairs = cKDTree(plane(ends)).query_pairs(near, output_type="ndarray")
    alone = np.bincount(pairs.ravel(), minlength=len(ends)) == 1
    mate = np.full(len(ends), -1)
    for one, other in pairs[alone[pairs].all(axis=1)].tolist():
        mate[one], mate[other] = other, one
    found = []
    left = set(range(len(single)))
    while left:
        end = first = 2 * min(left)
        walked = []
        while end >= 0 and end // 2 in left:
            left.remove(end // 2)
            walked.append(end)
            end = int(mate[end ^ 1])
        if end == first:
            points = np.concatenate([single[each // 2][1][:: -1 if each % 2 else 1] for each in walked])
            if len(points) >= 4:
                parts = tuple(single[each // 2][0] for each in walked)
                found.append(_Closed(parts, Polygon(plane(points)), closed=True, ends=0.0))
    return found


def _called(contour: _Closed, shapes: list[Shape]) -> str:
    """What messages call a contour: as its object is called, the first one of several."""
    more = len(contour.parts) - 1
    return shapes[contour.parts[0][0]].source + (f" and {more} more, end to end," if more else "")


def _is_page(polygon: Polygon, drawing: ReadDrawing) -> bool:
    """Whether a polygon is a rectangle that covers the page, as backgrounds do."""
    page = math.inf if drawing.width is None or drawing.height is None else drawing.width * drawing.height
    return bool(polygon.area >= (1.0 - _SPECK) * max(page, polygon.envelope.area))


def _again(chosen: _Closed, contours: list[_Closed]) -> list[_Closed]:
    """The contours that are drawn over the outline once more, as fills and strokes of their own are."""
    allowed = _SPECK * chosen.polygon.area
    return [
        each
        for each in contours
        if each is not chosen
        and each.closed
        and abs(each.polygon.area - chosen.polygon.area) <= allowed
        and each.polygon.is_valid
        and each.polygon.symmetric_difference(chosen.polygon).area <= allowed
    ]


def _extent(polygon: Polygon) -> float:
    """The larger side of the rectangle around a polygon."""
    left, bottom, right, top = polygon.bounds
    return float(max(right - left, top - bottom))


def _refuse_second(chosen: _Closed, contours: list[_Closed], shapes: list[Shape], name: str) -> None:
    """Refuse another closed line that is not within the outline, a valid one."""
    for other in contours:
        if other is chosen or not other.closed or other.polygon.area <= _SPECK * chosen.polygon.area:
            continue
        if not chosen.polygon.covers(shapely.point_on_surface(other.polygon)):
            raise DrawingError(
                f"there are two outlines beside each other, {_called(chosen, shapes)} and {_called(other, shapes)}",
                file=name,
                remedy="Name the one to fit by its id, --element ID, or take the other out.",
            )


def _without(shapes: list[Shape], taken: list[_Closed]) -> tuple[list[Shape], int]:
    """The shapes but the outline, and how many other paths its shapes have, which are lines of their own then."""
    rest, holes = [], 0
    for number, shape in enumerate(shapes):
        paths = [path for each in taken for part, path in each.parts if part == number]
        others = np.delete(np.arange(len(shape.paths)), paths)
        if not paths:
            rest.append(shape)
        elif len(others):
            ink = shape.stroke or shape.fill or "#000000"
            rest.append(replace(shape, paths=shape.paths.take(others), fill=None, stroke=ink))
            holes += len(others)
    return rest, holes

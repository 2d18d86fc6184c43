"""A contact sheet: many small pictures with captions on one sheet, as SVG, PNG or a page (HTML).

Each is drawn of the same paths in all three, so that they show the same; on the page and in SVG a picture with a link
leads to its file.
"""

from __future__ import annotations

import html
import math
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Final, Self

import numpy as np
import shapely
from numpy.typing import NDArray

from voronoi_tiles.base.arguments import path_name
from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.base.files import require_suffix, write_whole
from voronoi_tiles.base.text import xml_text
from voronoi_tiles.base.version import __version__
from voronoi_tiles.fabrication.lettering import Align, lettering, printable, text_width
from voronoi_tiles.formats.svg.path_text import path_data
from voronoi_tiles.formats.svg.writer import document_text, new_document
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.pictures.area_coverage import area_coverage
from voronoi_tiles.pictures.rendered import Rendering
from voronoi_tiles.raster.frame import Frame, rectangle_frame
from voronoi_tiles.raster.line_coverage import coverage
from voronoi_tiles.raster.picture import Pixels, Region
from voronoi_tiles.vector.outline import Outline

SUFFIXES: Final = (".svg", ".png", ".html")
"""The files that a contact sheet can be."""

TILE_FILL, INK, SITE_INK = "#f3ead8", "#26222a", "#b03020"

_SIDE: Final = 220
"""The side of a picture; pixels."""

_GAP: Final = 16
"""Between pictures, and around all; pixels."""

_LINE: Final = 16
"""The height of a line of text; pixels."""

_CAPITALS: Final = 8.0
"""The height of capitals; pixels. A line that would be longer than its picture has smaller ones."""

_TITLE: Final = 1.5
"""How much larger the letters of the title are; a factor."""

_CAPITAL_SHARE: Final = 0.72
"""The height of capitals beside a font's size, which most fonts have."""

_PEN: Final = 1.1
"""The width of letters' strokes; pixels."""

_STROKE: Final = 2.0
"""The width of a site's strokes; pixels."""

_DOT: Final = 6.0
"""The width of its points; pixels."""

_ROUGH: Final = 0.05
"""How far chords may be from curves; pixels."""

_SLIGHT: Final = 0.1
"""How far lines may be from chords that they take the place of; pixels."""

_COLUMNS_MAX: Final = 8
"""Most pictures beside each other where their number is not given; a count."""


@dataclass(frozen=True, eq=False)
class DrawnPaths:
    """Paths that are filled and drawn with colours, "#rrggbb", "" for none; `width` is that of lines, in pixels.

    Filled are closed paths; outlines run one way round, holes the other.
    """

    paths: Paths
    fill: str = ""
    ink: str = ""
    width: float = 1.0


def square_around(bounds: Region, times: float) -> Region:
    """The square about a rectangle's middle, its side so many times the rectangle's longer one."""
    left, bottom, right, top = bounds
    half, x, y = times / 2.0 * max(right - left, top - bottom), (left + right) / 2.0, (bottom + top) / 2.0
    return x - half, y - half, x + half, y + half


def square_about(outlines: Iterable[Outline]) -> Region:
    """The square about outlines that a picture of them is of, with a margin."""
    bounds = np.array([outline.bounds for outline in outlines])
    low, high = bounds[:, :2].min(axis=0).tolist(), bounds[:, 2:].max(axis=0).tolist()
    return square_around((low[0], low[1], high[0], high[1]), 1.125)


@dataclass(frozen=True, eq=False)
class SheetPicture:
    """A small picture: what is drawn in turn, y up, of the rectangle x0, y0, x1, y1; lines of text below, and a link.

    `link` is the address of a file, as seen from the sheet; "" for none.
    """

    drawn: tuple[DrawnPaths, ...]
    region: Region
    caption: tuple[str, ...] = ()
    link: str = ""

    @classmethod
    def of_tiles(
        cls,
        tiles: Sequence[tuple[Outline, Complexes]],
        copies: Iterable[Outline] = (),
        *,
        over: Sequence[DrawnPaths] = (),
        caption: Iterable[str] = (),
        link: str = "",
    ) -> Self:
        """Tiles, filled, each with the ends of its site's elements (k, 2), over `copies` about them; `over` comes last.

        The picture is of the square about the tiles, `square_about` them, and shows what copies have in it.
        """
        fills = [TILE_FILL] if len(tiles) == 1 else [f"#{bytes(row).hex()}" for row in palette(len(tiles))]
        outlines = Paths.concatenate([outline.paths for outline in copies])
        drawn = [DrawnPaths(outlines, "", INK, 0.5)] if len(outlines) else []
        drawn += [DrawnPaths(outline.paths, fill, INK) for (outline, _), fill in zip(tiles, fills, strict=True)]
        drawn += [shown for _, ends in tiles for shown in _strokes(ends)]
        return cls((*drawn, *over), square_about(outline for outline, _ in tiles), tuple(caption), link)

    @property
    def svg(self) -> str:
        """The picture alone as an SVG file, without its caption and link."""
        return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_SIDE} {_SIDE}">{_elements(self)}</svg>'


@dataclass(frozen=True, eq=False)
class ContactSheet:
    """Pictures in rows, with a title above. `columns` are beside each other, None: about as many as rows, 8 at most."""

    pictures: tuple[SheetPicture, ...]
    title: str = ""
    columns: int | None = None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the sheet, whole or not at all, as its suffix says: .svg, .png or .html. Raises OutputError."""
        name = path_name("path", path)
        require_suffix(name, SUFFIXES)
        suffix = os.path.splitext(name)[1].lower()  # noqa: PTH122 - a name, not a place
        write_whole(name, self.png if suffix == ".png" else (self.svg if suffix == ".svg" else self.html).encode())

    @property
    def svg(self) -> str:
        """The sheet as an SVG file, its links relative to where it lies."""
        width, height = self._size
        document = new_document(str(width), str(height), f"0 0 {width} {height}")
        document.add(document.rect(size=("100%", "100%"), fill="#ffffff"))
        if self.title:
            document.set_desc(title=xml_text(self.title))
            place = complex(_GAP, self._top - 0.75 * _LINE)
            document.add(_text(document, self.title, place, _TITLE, width - 2 * _GAP, "start"))
        for picture, (x, y) in zip(self.pictures, self._corners, strict=True):
            holder = document.add(document.a(xml_text(picture.link)) if picture.link else document.g())
            drawing = holder.add(document.svg(insert=(x, y), size=(_SIDE, _SIDE), overflow="hidden"))
            for shown in picture.drawn:
                drawing.add(document.path(_data(shown, picture), **_style(shown)))
            for k, line in enumerate(picture.caption):
                place = complex(x + _SIDE / 2, y + _SIDE + (k + 0.75) * _LINE)
                holder.add(_text(document, line, place, 1.0, _SIDE, "middle"))
        return document_text(document)

    @property
    def html(self) -> str:
        """The sheet as a page that is complete in itself, its links relative to where it lies."""
        title = html.escape(self.title)
        head = f"<h1>{title}</h1>\n" if title else ""
        return _PAGE.format(title=title, version=__version__, body=head + "\n".join(map(_figure, self.pictures)))

    @property
    def png(self) -> bytes:
        """The sheet as a PNG file."""
        return Rendering(self.pixels, {"Software": f"voronoi-tiles {__version__}", "Title": self.title}).png

    @property
    def pixels(self) -> Pixels:
        """The sheet as an image, uint8 (rows, columns, 3)."""
        width, height = self._size
        image = np.full((height, width, 3), 255, np.uint8)
        if self.title:
            line = _letters(self.title, _TITLE, width - 2 * _GAP, "left").moved(1.0, _GAP + 0.75j * _LINE)
            image[: self._top] = _image((), line, rectangle_frame((0, 0, width, self._top), width, self._top))
        below = self._row - _GAP - _SIDE
        frame = rectangle_frame((0, -below, _SIDE, _SIDE), _SIDE, _SIDE + below)
        for picture, (x, y) in zip(self.pictures, self._corners, strict=True):
            lines = [
                _letters(line, 1.0, _SIDE, "centre").moved(1.0, _SIDE / 2 - 1j * (k + 0.75) * _LINE)
                for k, line in enumerate(picture.caption)
            ]
            drawn = [_in_pixels(shown, picture) for shown in picture.drawn]
            image[y : y + frame.height, x : x + _SIDE] = _image(drawn, Paths.concatenate(lines), frame)
        return image

    @property
    def _across(self) -> int:
        """How many pictures are beside each other."""
        return self.columns or min(_COLUMNS_MAX, max(1, math.ceil(math.sqrt(len(self.pictures)))))

    @property
    def _row(self) -> int:
        """From one row to the next; pixels."""
        return _SIDE + _GAP + _LINE * max((len(picture.caption) for picture in self.pictures), default=0)

    @property
    def _top(self) -> int:
        """Where the first row begins; pixels."""
        return _GAP + (2 * _LINE if self.title else 0)

    @property
    def _size(self) -> tuple[int, int]:
        """Width and height; pixels."""
        rows = math.ceil(len(self.pictures) / self._across)
        return _GAP + self._across * (_SIDE + _GAP), self._top + max(rows * self._row, _GAP)

    @property
    def _corners(self) -> list[tuple[int, int]]:
        """The upper left corner of each picture; pixels."""
        places = (divmod(k, self._across) for k in range(len(self.pictures)))
        return [(_GAP + column * (_SIDE + _GAP), self._top + row * self._row) for row, column in places]


_PAGE: Final = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<meta name="generator" content="voronoi-tiles {version}">
<title>{title}</title>
<style>
body {{ font: 14px/1.3 system-ui, sans-serif; color: #26222a; background: #fff; margin: 16px; }}
main {{ display: grid; grid-template-columns: repeat(auto-fill, minmax(220px, 1fr)); gap: 16px; }}
h1 {{ grid-column: 1 / -1; font-size: 18px; margin: 0; }}
figure {{ margin: 0; }}
svg {{ width: 100%; height: auto; overflow: hidden; }}
figcaption {{ text-align: center; overflow-wrap: anywhere; }}
a {{ color: inherit; }}
</style>
</head>
<body>
<main>
{body}
</main>
</body>
</html>
"""


def _figure(picture: SheetPicture) -> str:
    """A picture of the page."""
    lines = [html.escape(line) for line in picture.caption]
    label = html.escape(", ".join(picture.caption) or "a tile", quote=True)
    image = f'<svg role="img" aria-label="{label}" viewBox="0 0 {_SIDE} {_SIDE}">{_elements(picture)}</svg>'
    caption = f"<figcaption>{'<br>'.join(lines)}</figcaption>" if lines else ""
    inside = (
        f'<a href="{html.escape(picture.link, quote=True)}">{image}{caption}</a>' if picture.link else image + caption
    )
    return f"<figure>{inside}</figure>"


def _elements(picture: SheetPicture) -> str:
    """What is drawn, as elements of SVG."""
    return "".join(
        f'<path d="{_data(shown, picture)}" '
        + " ".join(f'{name.replace("_", "-")}="{value}"' for name, value in _style(shown).items())
        + "/>"
        for shown in picture.drawn
    )


def _style(shown: DrawnPaths) -> dict[str, object]:
    """The attributes of paths in SVG."""
    style: dict[str, object] = {"fill": shown.fill or "none", "stroke": shown.ink or "none"}
    if shown.ink:
        style |= {"stroke_width": shown.width, "stroke_linecap": "round", "stroke_linejoin": "round"}
    return style


def _data(shown: DrawnPaths, picture: SheetPicture) -> str:
    """The path data of a drawing."""
    return path_data(_in_pixels(shown, picture).paths, top=_SIDE, number=_decimal)


def _decimal(value: float) -> str:
    """A coordinate in pixels, to a tenth."""
    text = f"{value:.1f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _strokes(ends: Complexes) -> list[DrawnPaths]:
    """The elements of a site (k, 2): lines, that go on where the next begins at the end of one, and dots."""
    dot = ends[:, 0] == ends[:, 1]
    lines = ends[~dot]
    begins = np.flatnonzero(lines[1:, 0] != lines[:-1, 1]) + 1
    chains = [np.append(part[:, 0], part[-1, 1]) for part in np.split(lines, begins) if len(part)]
    drawn = ((chains, _STROKE), (list(ends[dot]), _DOT))
    return [DrawnPaths(Paths.polylines(paths), "", SITE_INK, width) for paths, width in drawn if paths]


def _in_pixels(shown: DrawnPaths, picture: SheetPicture) -> DrawnPaths:
    """A drawing in the pixels of its picture, from the lower left corner, y up; the region lies in the middle.

    It is of as few straight lines as show the same, and of what is not filled no more than can be seen: an outline may
    have a thousand arcs, a picture a dozen copies, and a sheet as many of them.
    """
    x0, y0, x1, y1 = picture.region
    scale = _SIDE / max(x1 - x0, y1 - y0)
    placed = shown.paths.moved(scale, complex(_SIDE, _SIDE) / 2 - scale * complex(x0 + x1, y0 + y1) / 2)
    cut = to_lines(placed, accuracy=_ROUGH)
    lines = [
        shapely.linestrings(plane(np.append(cut.start[first:last], cut.end[last - 1])))
        for first, last in pairwise(cut.offsets.tolist())
    ]
    few = shapely.simplify(np.array(lines, object), _SLIGHT, preserve_topology=False)
    if shown.fill:
        rings = [shapely.get_coordinates(line)[:-1] @ (1, 1j) for line in few]
        return replace(shown, paths=Paths.polylines(rings, closed=True))
    low, high = -shown.width, _SIDE + shown.width
    length = shapely.length(few)
    dots = [
        line for line, long in zip(lines, length, strict=True) if not long
    ]  # a line of no length is nothing to clip
    seen = [*shapely.get_parts(shapely.clip_by_rect(few[length > 0], low, low, high, high)), *dots]
    return replace(shown, paths=Paths.polylines([shapely.get_coordinates(line) @ (1, 1j) for line in seen]))


def _height(text: str, size: float, room: float) -> float:
    """The height of a line's capitals, so that the line keeps to its room; pixels."""
    wide = text_width(printable(text), height=_CAPITALS * size)
    return _CAPITALS * size * min(1.0, room / wide if wide else 1.0)


def _letters(text: str, size: float, room: float, align: Align) -> Paths:
    """A line of text as strokes, about 0 or from there on."""
    return lettering(printable(text), height=_height(text, size, room), align=align)


def _text(document: Any, text: str, place: complex, size: float, room: float, anchor: str) -> Any:
    """A line of text of SVG, as long as that of strokes or shorter."""
    font = {"font_family": "sans-serif", "font_size": _decimal(_height(text, size, room) / _CAPITAL_SHARE)}
    return document.text(
        xml_text(text), insert=(_decimal(place.real), _decimal(place.imag)), text_anchor=anchor, fill=INK, **font
    )


def _image(drawn: Sequence[DrawnPaths], letters: Paths, frame: Frame) -> Pixels:
    """Paths and letters in an image whose samples are pixels, y up; what is drawn reaches down to y = 0 at most."""
    image = np.full((frame.height, frame.width, 3), 255.0, np.float32)
    top = frame.origin.imag
    seen = image[: int(top)]
    for shown in drawn:
        sides = shown.paths
        if shown.fill:
            start, end = (1j * top + points.conj() for points in (sides.start, sides.end))
            _blend(seen, area_coverage(start, end, frame.width, int(top)), shown.fill)
        if shown.ink:
            segments = np.stack((sides.start, sides.end), axis=1)
            _blend(seen, coverage(segments, shown.width, frame)[: int(top)], shown.ink)
    _blend(image, coverage(np.stack((letters.start, letters.end), axis=1), _PEN, frame), INK)
    return np.round(image).astype(np.uint8)


def _blend(image: NDArray[np.float32], covered: NDArray[np.float32], colour: str) -> None:
    """Lay a colour over an image where it is covered."""
    ink = np.frombuffer(bytes.fromhex(colour.removeprefix("#")), np.uint8).astype(np.float32)
    image += covered[..., None] * (ink - image)

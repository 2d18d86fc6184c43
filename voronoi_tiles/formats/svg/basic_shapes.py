"""SVG's basic shapes and paths, drawn by a pen in their own coordinates."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from voronoi_tiles.base.maps import Affine
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.formats.pen import Pen
from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.lengths import Units, length
from voronoi_tiles.formats.svg.pathdata import draw_path
from voronoi_tiles.formats.svg.transforms import numbers
from voronoi_tiles.paths.ellipses import EllipticalArc

DRAWN: Final = frozenset({"path", "rect", "circle", "ellipse", "line", "polyline", "polygon"})


def draw_shape(pen: Pen, tag: str, attributes: Mapping[str, str], view: tuple[float, float], units: Units) -> None:
    """Draw one of DRAWN; `view` is the size that percentages refer to, `units` what relative units are.

    Raises DrawingError for attributes that are broken, and for negative sizes.
    """
    match tag:
        case "path":
            try:
                draw_path(pen, attributes.get("d", ""))
            except DrawingError as error:
                raise error.under("d") from None
        case "polyline" | "polygon":
            _draw_points(pen, attributes.get("points", ""), tag == "polygon")
        case "line":
            sizes = _Sizes(attributes, view, units)
            pen.move(complex(sizes.across("x1"), sizes.down("y1")))
            pen.line(complex(sizes.across("x2"), sizes.down("y2")))
        case "rect":
            _draw_rect(pen, _Sizes(attributes, view, units))
        case "circle":
            sizes = _Sizes(attributes, view, units)
            radius = sizes.size("r", diagonal(view))
            _draw_ellipse(pen, complex(sizes.across("cx"), sizes.down("cy")), radius, radius)
        case _:
            sizes = _Sizes(attributes, view, units)
            rx, ry = sizes.radii()
            _draw_ellipse(pen, complex(sizes.across("cx"), sizes.down("cy")), rx, ry)


def diagonal(view: tuple[float, float]) -> float:
    """What percentages refer to that run neither across nor down."""
    return math.hypot(*view) / math.sqrt(2.0)


class _Sizes:
    """The lengths of an element's attributes, in user units; one that is missing is 0."""

    def __init__(self, attributes: Mapping[str, str], view: tuple[float, float], units: Units) -> None:
        self._attributes = attributes
        self._units = units
        self.view = view

    def _length(self, name: str, whole: float) -> float:
        text = self._attributes.get(name)
        if text is None:
            return 0.0
        try:
            return length(text, whole, self._units)
        except DrawingError as error:
            raise error.under(name) from None

    def across(self, name: str) -> float:
        return self._length(name, self.view[0])

    def down(self, name: str) -> float:
        return self._length(name, self.view[1])

    def size(self, name: str, whole: float) -> float:
        """A length that must not be negative; "auto" is 0."""
        value = 0.0 if self._attributes.get(name, "").strip().lower() == "auto" else self._length(name, whole)
        if value < 0.0:
            raise DrawingError(f"must not be negative, but is {value:g}", key=name, remedy="Remove the object.")
        return value

    def radii(self) -> tuple[float, float]:
        """The radii rx, ry; one that is missing is as the other."""
        said = [self._attributes.get(name, "auto").strip().lower() != "auto" for name in ("rx", "ry")]
        rx = self.size("rx", self.view[0]) if said[0] else 0.0
        ry = self.size("ry", self.view[1]) if said[1] else rx
        return (rx if said[0] else ry), ry


def _draw_points(pen: Pen, text: str, closed: bool) -> None:
    """A polyline or polygon."""
    if text.strip() == "none":
        return
    values = numbers(text)
    if values is None or len(values) % 2 or not all(abs(value) <= COORDINATE_MAX for value in values):
        raise DrawingError("broken list of points", key="points", remedy='Write them as "0,0 10,0 10,10".')
    points = [complex(x, y) for x, y in zip(values[0::2], values[1::2], strict=True)]
    if not points:
        return
    pen.move(points[0])
    for point in points[1:] or points:
        pen.line(point)
    if closed:
        pen.close()


def _draw_rect(pen: Pen, sizes: _Sizes) -> None:
    """A rectangle, its corners rounded where it has radii."""
    x, y = sizes.across("x"), sizes.down("y")
    across, down = sizes.size("width", sizes.view[0]), sizes.size("height", sizes.view[1])
    if across == 0.0 or down == 0.0:
        pen.dot(complex(x, y))
        return
    rx, ry = sizes.radii()
    rx, ry = min(rx, across / 2), min(ry, down / 2)
    if rx == 0.0 or ry == 0.0:
        pen.move(complex(x, y))
        for corner in (complex(x + across, y), complex(x + across, y + down), complex(x, y + down)):
            pen.line(corner)
        pen.close()
        return
    round_ = Affine(complex((rx + ry) / 2), complex((rx - ry) / 2), 0j)
    left, right, top, bottom = x + rx, x + across - rx, y + ry, y + down - ry
    quarter = math.pi / 2
    pen.move(complex(left, y))
    pen.line(complex(right, y))
    _draw_corner(pen, round_, -quarter, complex(x + across, top))
    pen.line(complex(x + across, bottom))
    _draw_corner(pen, round_, 0.0, complex(right, y + down))
    pen.line(complex(left, y + down))
    _draw_corner(pen, round_, quarter, complex(x, bottom))
    pen.line(complex(x, top))
    _draw_corner(pen, round_, 2 * quarter, complex(left, y))
    pen.close()


def _draw_corner(pen: Pen, round_: Affine, begin: float, end: complex) -> None:
    """A quarter of an ellipse, from an angle on."""
    pen.elliptical(EllipticalArc.about(pen.here, end, round_, begin, math.pi / 2))


def _draw_ellipse(pen: Pen, centre: complex, rx: float, ry: float) -> None:
    """A circle or an ellipse."""
    if rx == 0.0 or ry == 0.0:
        pen.dot(centre)
        return
    round_ = Affine(complex((rx + ry) / 2), complex((rx - ry) / 2), 0j)
    start = centre + rx
    pen.move(start)
    pen.elliptical(EllipticalArc.about(start, start, round_, 0.0, math.tau))
    pen.close()

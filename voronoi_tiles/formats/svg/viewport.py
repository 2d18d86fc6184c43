"""SVG's lengths and viewports: how user units become millimetres on the page."""

from __future__ import annotations

import math
import re
from typing import Final, NamedTuple

from voronoi_tiles.base.maps import IDENTITY_MAP, Affine, from_matrix
from voronoi_tiles.base.text import NUMBER
from voronoi_tiles.base.tolerance import COORDINATE_MAX, NUMBER_MIN
from voronoi_tiles.base.units import MILLIMETRES
from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.transforms import numbers

PIXEL: Final = float(MILLIMETRES["px"])
"""One CSS pixel; millimetres."""

_UNITS: Final = ("px", "mm", "cm", "in", "pt", "pc", "q")
_PIXELS: Final = {"": 1.0} | {unit: float(MILLIMETRES[unit] / MILLIMETRES["px"]) for unit in _UNITS}
_LENGTH: Final = re.compile(rf"({NUMBER})\s*([a-z]*|%)", re.IGNORECASE)


class Page(NamedTuple):
    """The page of an SVG file: its size in millimetres, its unit, and the map from its user units, y still down.

    `view` is the size that percentages refer to, in user units.
    """

    width: float | None
    height: float | None
    unit: str
    unit_known: bool
    to_page: Affine
    view: tuple[float, float]


def length(text: str, whole: float) -> float:
    """A length in user units (CSS pixels); percentages are of `whole`.

    Raises DrawingError for what is no length or is beyond COORDINATE_MAX.
    """
    match = _LENGTH.fullmatch(text.strip())
    unit = match[2].lower() if match else ""
    if match is None or (unit not in _PIXELS and unit != "%"):
        raise DrawingError(
            f"{text[:40]!r} is no length", remedy="Write a number with mm, cm, in, pt, pc, px or no unit."
        )
    value = float(match[1]) * (whole / 100 if unit == "%" else _PIXELS[unit])
    if not abs(value) <= COORDINATE_MAX:
        raise DrawingError(f"length beyond {COORDINATE_MAX:g}", remedy="Draw in units that keep the numbers small.")
    return value


def read_page(attributes: dict[str, str]) -> Page:
    """The page of the root element.

    Raises DrawingError where width, height or viewBox are broken, not greater than 0, or not finite.
    """
    box = view_box(attributes)
    sides: list[float | None] = []
    units = []
    for name in ("width", "height"):
        text = attributes.get(name, "").strip()
        if text in {"", "auto"} or text.endswith("%"):
            sides.append(None)
            continue
        try:
            value = length(text, 0.0)
        except DrawingError as error:
            raise error.under(name) from None
        if value < NUMBER_MIN:
            raise DrawingError(
                f"must be greater than 0, not {text[:40]}", key=name, remedy='Write the size of the page, "300mm".'
            )
        sides.append(value)
        match = _LENGTH.fullmatch(text)
        assert match is not None  # length() has taken it
        units.append(match[2].lower())
    unit = units[0] if units else ""
    known = all(units) and (len(units) == 2 or (len(units) == 1 and box is not None))
    width, height = sides
    if box is not None:
        # A side that is missing follows from the other by the viewBox.
        _, _, across, down = box
        if width is None and height is None:
            width, height = across, down
        width = width if width is not None else (height or 0.0) * across / down
        height = height if height is not None else width * down / across
        to_page = viewport(box, (width, height), attributes.get("preserveAspectRatio", ""))
        view = (across, down)
    else:
        to_page, view = IDENTITY_MAP, (width or 0.0, height or 0.0)
    scaled = Affine(to_page.a * PIXEL, to_page.b * PIXEL, to_page.c * PIXEL)
    return Page(
        None if width is None else width * PIXEL, None if height is None else height * PIXEL, unit, known, scaled, view
    )


def view_box(attributes: dict[str, str]) -> tuple[float, float, float, float] | None:
    """The viewBox of an element: x, y, width, height; None where it has none.

    Raises DrawingError where it is broken.
    """
    text = attributes.get("viewBox")
    if text is None:
        return None
    v = numbers(text)
    if v is None or len(v) != 4 or not all(abs(value) <= COORDINATE_MAX for value in v):
        raise DrawingError(f"{text[:60]!r} is no viewBox", key="viewBox", remedy='Write it as "0 0 300 200".')
    if min(v[2], v[3]) < NUMBER_MIN:
        raise DrawingError(
            f"its width and height must be greater than 0, not {v[2]:g} {v[3]:g}",
            key="viewBox",
            remedy='Write it as "0 0 300 200".',
        )
    return v[0], v[1], v[2], v[3]


def viewport(box: tuple[float, float, float, float], size: tuple[float, float], ratio: str) -> Affine:
    """The map from a viewBox to a viewport at the origin, by preserveAspectRatio."""
    x, y, across, down = box
    sx, sy = size[0] / across, size[1] / down
    words = ratio.replace("defer", " ").split()
    align = words[0] if words else "xMidYMid"
    if align != "none":
        sx = sy = max(sx, sy) if "slice" in words else min(sx, sy)
    left = {"xMin": 0.0, "xMax": 1.0}.get(align[:4], 0.5) * (size[0] - sx * across)
    top = {"YMin": 0.0, "YMax": 1.0}.get(align[4:], 0.5) * (size[1] - sy * down)
    if align == "none":
        left = top = 0.0
    result = from_matrix(sx, 0.0, 0.0, sy, left - sx * x, top - sy * y)
    if not all(math.isfinite(abs(part)) for part in result):
        raise DrawingError("the viewBox is beyond all measure", key="viewBox", remedy='Write it as "0 0 300 200".')
    return result

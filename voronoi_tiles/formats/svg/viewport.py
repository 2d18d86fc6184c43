"""SVG's viewports: how user units become millimetres on the page, and what is cut off at their edges."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import NamedTuple

from voronoi_tiles.base.maps import IDENTITY_MAP, Affine, from_matrix
from voronoi_tiles.base.text import NUMBER
from voronoi_tiles.base.tolerance import COORDINATE_MAX, NUMBER_MIN
from voronoi_tiles.base.units import RELATIVE
from voronoi_tiles.formats.shapes import CURVE_ACCURACY, DrawingError
from voronoi_tiles.formats.svg.cascade import Note
from voronoi_tiles.formats.svg.lengths import PIXEL, Units, length, parse_measure
from voronoi_tiles.formats.svg.transforms import numbers
from voronoi_tiles.paths.paths import Paths


class Page(NamedTuple):
    """The page of an SVG file: its size in millimetres, its unit, and the map from its user units, y still down.

    `view` is the size that percentages refer to, in user units; `window` is the page's in pixels, 0 where it has none.
    """

    width: float | None
    height: float | None
    unit: str
    unit_known: bool
    to_page: Affine
    view: tuple[float, float]
    window: tuple[float, float]

    @property
    def upwards(self) -> Affine:
        """The map with y turned about the page's height; a file without one keeps the origin where it is."""
        return Affine(0j, 1 + 0j, complex(0.0, self.height or 0.0)) @ self.to_page


def read_page(attributes: Mapping[str, str], units: Units, note: Note) -> Page:
    """The page of the root element; a size that is no length is noted, and as good as none.

    Raises DrawingError where width or height are not greater than 0 or not finite, and where viewBox is broken.
    """
    box = view_box(attributes)
    sides: list[float | None] = []
    found = []
    for name in ("width", "height"):
        text = attributes.get(name, "").strip()
        unit = "calc()" if text.endswith(")") else _NUMERAL.sub("", text).strip().lower()
        if text in {"", "auto"} or unit == "%" or unit.startswith("v"):
            sides.append(None)
            continue
        if parse_measure(text, units) is None:
            note(f"{name} {text[:40]!r}")
            sides.append(None)
            continue
        try:
            value = length(text, 0.0, units)
        except DrawingError as error:
            raise error.under(name) from None
        if value < NUMBER_MIN:
            raise DrawingError(
                f"must be greater than 0, not {text[:40]}", key=name, remedy='Write the size of the page, "300mm".'
            )
        sides.append(value)
        found.append(unit)
    unit = found[0] if found else ""
    known = all(found) and not {*RELATIVE, "calc()", "px"}.intersection(found)
    known = known and (len(found) == 2 or (len(found) == 1 and box is not None))
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
        None if width is None else width * PIXEL,
        None if height is None else height * PIXEL,
        unit,
        known,
        scaled,
        view,
        (width or 0.0, height or 0.0),
    )


_NUMERAL = re.compile(rf"\A\s*{NUMBER}")


def view_box(attributes: Mapping[str, str], *, nested: bool = False) -> tuple[float, float, float, float] | None:
    """The viewBox of an element: x, y, width, height; None where it has none.

    Raises DrawingError where it is broken, or empty, unless it is that of a nested drawing, which is not drawn then.
    """
    text = attributes.get("viewBox")
    if text is None:
        return None
    v = numbers(text)
    if v is None or len(v) != 4 or not all(abs(value) <= COORDINATE_MAX for value in v):
        raise DrawingError(f"{text[:60]!r} is no viewBox", key="viewBox", remedy='Write it as "0 0 300 200".')
    if min(v[2], v[3]) < (0.0 if nested else NUMBER_MIN):
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


class Clip(NamedTuple):
    """A viewport at whose edges is cut off what it holds: a rectangle from the origin, and its map to the page."""

    to_page: Affine
    size: tuple[float, float]

    def holds(self, paths: Paths) -> bool | None:
        """Whether paths lie in the viewport; None where its edges cut them, False where nothing of them is left.

        Paths that pass by one of its corners may count as cut.
        """
        across, down = self.size
        corners = [self.to_page(corner) for corner in (0j, complex(across), complex(across, down), complex(0.0, down))]
        whole = True
        for end in (corners[1], corners[3]):
            side = end - corners[0]
            turn = side.conjugate() / abs(side) if side else 1 + 0j
            _, low, _, high = paths.moved(turn, 0j).bounds
            least, most = (pick((corner * turn).imag for corner in corners) for pick in (min, max))
            if low > most + CURVE_ACCURACY or high < least - CURVE_ACCURACY:
                return False
            whole &= low >= least - CURVE_ACCURACY and high <= most + CURVE_ACCURACY
        return whole or None

"""Where an element is put: the attribute `transform` and the properties of CSS that move it."""

from __future__ import annotations

from collections.abc import Callable

from voronoi_tiles.base.maps import IDENTITY_MAP, Affine
from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.cascade import Declarations, called
from voronoi_tiles.formats.svg.lengths import Units
from voronoi_tiles.formats.svg.properties import MOVING, TRANSFORMS, Origin
from voronoi_tiles.formats.svg.transforms import (
    Box,
    css_rotate,
    css_scale,
    css_transform,
    css_translate,
    parse_transform,
    transform_origin,
)

_OTHERS = TRANSFORMS - {"transform"}

Bounds = Callable[[], tuple[float, float, float, float] | None]
"""Gives the bounds of an element in its own coordinates: least x, least y, greatest x, greatest y."""


def placed(said: Declarations, view: tuple[float, float], units: Units, bounds: Bounds | None) -> Affine:
    """The map that an element's transforms make; `view` is the size that percentages refer to.

    `bounds` gives the element's own box, where that is known: without it transforms about it are noted, and made about
    the viewport's instead. Raises DrawingError for transforms beyond all measure.
    """
    if said.names.isdisjoint(MOVING):
        return IDENTITY_MAP
    if said.is_attribute("transform") and said.names.isdisjoint(_OTHERS):
        alone = said.attribute("transform")
        found = parse_transform(alone)
        if found is None:
            said.note(called("transform", alone))
        return found or IDENTITY_MAP
    text, origin = said.own_written("transform")
    box = Box(0j, *view, units)
    if (said.own("transform-box") or "view-box").lower() != "view-box":
        box = _own_box(said, bounds, units) or box
    inner = parse_transform(text or "") if origin == Origin.ATTRIBUTE else css_transform(text or "none", box)
    result = IDENTITY_MAP
    for part in (
        css_translate(said.own("translate") or "none", box),
        css_rotate(said.own("rotate") or "none"),
        css_scale(said.own("scale") or "none"),
        inner,
    ):
        result = result @ (part or IDENTITY_MAP)
    text, origin = said.own_written("transform-origin")
    about = transform_origin(text or "0 0", box, unitless=origin == Origin.ATTRIBUTE) or 0j
    if about != 0j:
        result = Affine(1 + 0j, 0j, about) @ result @ Affine(1 + 0j, 0j, -about)
    if not abs(result.c) < float("inf"):
        raise DrawingError("transforms beyond all measure", remedy="Draw in units that keep numbers small.")
    return result


def _own_box(said: Declarations, bounds: Bounds | None, units: Units) -> Box | None:
    """The box of the element itself, without its stroke; None, and noted, where that is not known."""
    if (said.own("transform-box") or "").lower() == "stroke-box" or bounds is None:
        said.note("transform-box")
        return None
    found = bounds()
    if found is None:
        return None
    left, top, right, bottom = found
    return Box(complex(left, top), right - left, bottom - top, units)

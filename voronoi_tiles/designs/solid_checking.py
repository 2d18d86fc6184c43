"""The check of a solid: its height and motion, and keys that have the structure of the design's own strokes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from math import radians
from typing import Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.base import values
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.tolerance import SITE_EXTENT_MAX
from voronoi_tiles.designs import schema

LAYERS: Final = 5
"""At how many heights tiles are exact at least, where nobody says; a count. Others are added as accuracy needs them."""

LAYERS_MAX: Final = 2_000
"""Most of them, with those that are added; a count. They take half a minute, and a millimetre of a print has 20."""

TRAVEL_MAX: Final = 100.0
"""The longest way of a point from the bottom to the top; relative to the square root of the cell's area. Each part of
it takes levels of its own, in which copies are shown to keep apart."""

HEIGHT_MM: Final = (0.01, 1e5)
"""The least height and the greatest; millimetres. STL files hold no others beside a tile's width."""

DrawnStroke = tuple[Complexes, bool]
"""A stroke where it is placed: a polyline (n,) and False, or cubic Bezier pieces (k, 4) and True."""


class KeyDrawing(NamedTuple):
    """The strokes of a site at a height `z`, in the design's units."""

    z: float
    strokes: tuple[DrawnStroke, ...]


class DrawnInHeight(NamedTuple):
    """A site on the way up: its key drawings, the design's own at 0 first, and how its curves are flattened."""

    keys: tuple[KeyDrawing, ...]
    accuracy: float


class CheckedSolid(NamedTuple):
    """What a checked solid is; lengths in the design's units, `turn` in degrees, all at the top.

    `layers` is how many heights have exact tiles at least; `sites` has an entry for each site of the design.
    """

    height: float
    layers: int
    turn: float
    shift: complex
    scale: float
    about: complex
    sites: tuple[DrawnInHeight, ...]


class SiteDrawing(NamedTuple):
    """What of a site a key needs: its name, its strokes as written and as drawn, and what reads others as it was read.

    `accuracy` is what its curves are flattened within.
    """

    name: str
    strokes: Sequence[values.Table]
    drawn: tuple[DrawnStroke, ...]
    accuracy: float
    read: Callable[[Any], tuple[list[values.Table], tuple[DrawnStroke, ...]]]


def read_solid(
    table: values.Table, scale: float, sites: Sequence[SiteDrawing]
) -> tuple[CheckedSolid | None, dict[str, Any]]:
    """The solid of a design whose lengths are times `scale`, None where it has none; and its keys as files hold them.

    In these the paths of drawings stand in the place of their names. Raises DesignError.
    """
    if "solid" not in table:
        if "key" in table:
            raise DesignError(
                "there are keys, and no solid", key="key", remedy="Write [solid] and, below it, height = 20."
            )
        return None, {}
    with values.within("solid"):
        height, layers, motion = _read_motion(table["solid"])
    with values.within("key"):
        listed = values.sequence(table.get("key", ()), "Write [[key]], in double brackets, above the keys of each.")
    found: list[list[KeyDrawing]] = [[KeyDrawing(0.0, site.drawn)] for site in sites]
    written = []
    for k, item in enumerate(listed):
        with values.within(f"key[{k}]"):
            written.append(_read_key(item, height, scale, sites, found))
    checked = CheckedSolid(
        height=height * scale,
        layers=layers,
        turn=motion["turn"],
        shift=motion["shift"] * scale,
        scale=motion["scale"],
        about=motion["about"] * scale,
        sites=tuple(DrawnInHeight(tuple(keys), site.accuracy) for keys, site in zip(found, sites, strict=True)),
    )
    return checked, {"key": written} if written else {}


def refuse_far(solid: CheckedSolid, size: float, unit: float) -> None:
    """Refuse a solid that is too low or too high, grows too large, or moves too far.

    `size` is the square root of the cell's area in the design's units, one of which has `unit` millimetres. Raises
    DesignError.
    """
    low, high = HEIGHT_MM
    if not low <= solid.height * unit <= high:
        raise DesignError(
            f"{solid.height * unit:.4g} mm is no height from {low:g} to {high:,.0f} mm",
            key="solid.height",
            remedy="Give another height, in the design's units and times its scale.",
        )
    grown = max(1.0, solid.scale)
    for site in solid.sites:
        drawn = [np.concatenate([points.ravel() for points, _ in key.strokes]) for key in site.keys]
        extent = max(max(np.ptp(points.real), np.ptp(points.imag)) for points in drawn)
        if not grown * extent <= SITE_EXTENT_MAX * size:
            raise DesignError(
                f"a site becomes more than {SITE_EXTENT_MAX:,.0f} times larger than the cell",
                key="solid.scale" if extent <= SITE_EXTENT_MAX * size else "key",
                remedy="Make the scale or the strokes smaller, or the cell larger.",
            )
        away = max(float(np.abs(points - solid.about).max()) for points in drawn)
        moved = grown * sum(float(np.abs(below.mean() - above.mean())) for below, above in pairwise(drawn))
        travel = moved + abs(solid.shift) + away * (abs(solid.scale - 1.0) + grown * radians(abs(solid.turn)))
        if not travel <= TRAVEL_MAX * size:
            raise DesignError(
                f"a site moves by more than {TRAVEL_MAX:,.0f} times the cell on its way up",
                key="solid",
                remedy="Make turn, shift or scale smaller, or put about, the point that strokes turn about, near them.",
            )


def _read_motion(value: object) -> tuple[float, int, dict[str, Any]]:
    """The height, the number of layers, and turn, shift, scale and about."""
    known = ("height", "layers", "turn", "shift", "scale", "about")
    table = values.table(value, known, "Write [solid] and, below it, height = 20.")
    height = values.required(table, "height", "Write height = 20.")
    with values.within("height"):
        height = values.positive(height)
    layers = table.get("layers", LAYERS)
    if isinstance(layers, bool) or not isinstance(layers, int) or not 2 <= layers <= LAYERS_MAX:
        raise DesignError(
            f"must be a whole number from 2 to {LAYERS_MAX:,}, not {values.shown(layers)}",
            key="layers",
            remedy=f"Write layers = {LAYERS}.",
        )
    motion: dict[str, Any] = {"turn": 0.0, "shift": 0j, "scale": 1.0, "about": 0j}
    readers = {"turn": values.number, "shift": schema.point, "scale": values.positive, "about": schema.point}
    for name, read in readers.items():
        if name in table:
            with values.within(name):
                motion[name] = read(table[name])
    return height, layers, motion


def _read_key(
    value: object,
    height: float,
    scale: float,
    sites: Sequence[SiteDrawing],
    found: Sequence[list[KeyDrawing]],
) -> Mapping[str, Any]:
    """Read a key, and put it behind those of its site in `found`; its table as files hold it."""
    table = values.table(value, ("z", "site", "strokes"), "Write [[key]] and, below it, z = 10 and its strokes.")
    z = values.required(table, "z", "Write the height of the key, such as z = 10.")
    which = _site_of(table, sites)
    site, keys = sites[which], found[which]
    with values.within("z"):
        z = values.number(z)
        if not 0.0 < z <= height:
            raise DesignError(
                f"the height {z:g} is not above 0 and up to {height:g}, the solid's",
                remedy="The drawing at 0 is the design's own."
                if z <= 0.0
                else "Write a lower one, or a greater height of the solid.",
            )
        if z * scale <= keys[-1].z:
            raise DesignError(
                f"the height {z:g} comes after {keys[-1].z / scale:g}", remedy="Write keys from the bottom to the top."
            )
    listed = values.required(table, "strokes", f'Write those of site "{site.name}" as they are at this height.')
    with values.within("strokes"):
        written, drawn = site.read(listed)
        if len(drawn) != len(site.drawn):
            raise DesignError(
                f'{len(drawn)} strokes at the height {z:g}, and site "{site.name}" has {len(site.drawn)}',
                remedy="Write as many, in the same order.",
            )
        for k, (own, item, other, drawing) in enumerate(zip(site.strokes, written, site.drawn, drawn, strict=True)):
            if _structure(own, other) != _structure(item, drawing):
                raise DesignError(
                    f'{_described(item, drawing)} at the height {z:g}, and site "{site.name}" has '
                    f"{_described(own, other)}",
                    key=f"[{k}]",
                    remedy="Write the same kind of stroke, with as many points.",
                )
    keys.append(KeyDrawing(z * scale, drawn))
    return {**table, "strokes": written}


def _site_of(table: values.Table, sites: Sequence[SiteDrawing]) -> int:
    """The number of the site that a key is of."""
    names = [site.name for site in sites]
    if "site" not in table and len(sites) == 1:
        return 0
    remedy = f"Name one of {', '.join(names)}."
    name = values.required(table, "site", remedy)
    if name not in names:
        raise DesignError(f"there is no site {values.shown(name)}", key="site", remedy=remedy)
    return names.index(name)


def _kind(item: values.Table) -> str:
    """The kind of a stroke; a drawing is read as a path."""
    return next(name for name in schema.KINDS if name in item)


def _structure(item: values.Table, drawn: DrawnStroke) -> tuple[object, ...]:
    """What two strokes have in common that are interpolated; polygons of circles are made alike."""
    kind = _kind(item)
    return kind, bool(item.get("closed", False)), 0 if kind == "circle" else len(drawn[0])


def _described(item: values.Table, drawn: DrawnStroke) -> str:
    """A stroke in words."""
    kind, closed, _ = _structure(item, drawn)
    count = f" of {len(drawn[0])} {'pieces' if drawn[1] else 'points'}" if len(drawn[0]) > 1 else ""
    return f"a {'closed ' if closed else ''}{kind}{'' if kind == 'circle' else count}"


def like(drawings: Sequence[DrawnStroke]) -> list[Complexes]:
    """The drawings of one stroke at several heights with the same number of points.

    Only polygons of circles differ: all get as many vertices as that with the most.
    """
    sizes = [len(points) for points, _ in drawings]
    most = max(sizes)
    if min(sizes) == most:
        return [points for points, _ in drawings]
    from voronoi_tiles.designs.strokes import regular_polygon

    found = []
    for points, _ in drawings:
        centre = complex((points[0] + points[(len(points) - 1) // 2]) / 2)
        found.append(regular_polygon(centre, float(np.abs(points[0] - centre)), most - 1))
    return found

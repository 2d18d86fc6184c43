"""Strokes as they are drawn: `segment`, `catmull_rom`, ... and what they make.

A stroke is a description, as a design file has it; the design that it becomes a part of checks it. Every function
takes the keys that place a stroke: `mirror` (x -> -x), `scale` (any factor but 0), `rotate` (degrees,
counter-clockwise) and `translate`, which are applied in this order about the origin.

Points are complex numbers, pairs, arrays (complex (n,) or float (n, 2)), or a geometry with `__geo_interface__` such as
shapely's: a LineString is its points, a ring of a Polygon is closed, and a geometry of several lines gives as many
strokes, drawn alike, which count one by one in the site that they come to.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, get_args

from voronoi_tiles.base.maps import Placement
from voronoi_tiles.designs.coordinates import GeoInterface, PathData, PointLike, PointsLike, lines, pair, pairs
from voronoi_tiles.designs.keys import Keys, keys_of, keys_of_placement
from voronoi_tiles.designs.schema import placement

StrokeKind = Literal[
    "point", "segment", "polyline", "bezier", "hermite", "catmull_rom", "bspline", "circle", "path", "file"
]

ARGUMENTS: Mapping[str, tuple[str, ...]] = {
    "point": ("place",),
    "segment": ("start", "end"),
    "circle": ("centre",),
    "path": ("data",),
    "file": ("file",),
}
"""What the functions call the value of a stroke's own key, or its two; all others call it `points`."""


@dataclass(frozen=True, repr=False)
class Stroke:
    """One stroke of a site, as `segment`, `catmull_rom`, ... make it.

    `kind` is its key in a design file; `keys` are that and its others, but for those at their defaults. A geometry of
    several lines makes a stroke with `others`: they are drawn alike, and in a site each is a stroke of its own.

    >>> import voronoi_tiles as vt
    >>> vt.catmull_rom([6 + 9j, 22 + 5j, 27 + 17j], closed=True)
    <Stroke catmull_rom: 3 points>
    >>> vt.segment(0, 5j, rotate=30) == vt.segment((0, 0), (0, 5), rotate=30.0)
    True
    """

    kind: StrokeKind
    keys: Keys
    others: tuple[Stroke, ...] = ()

    def __repr__(self) -> str:
        own = dict(self.keys)[self.kind]
        size = f": {len(own)} points" if isinstance(own, tuple) and self.kind not in ARGUMENTS else ""
        return f"<Stroke {self.kind}{size}{f', and {len(self.others)} more' if self.others else ''}>"

    @property
    def parts(self) -> tuple[Stroke, ...]:
        """The strokes that it stands for: itself, and the others of a geometry of several lines."""
        return (Stroke(self.kind, self.keys), *self.others) if self.others else (self,)

    @property
    def table(self) -> dict[str, Any]:
        """The stroke as in a design file."""
        return dict(self.keys)

    def placed(self, by: Placement) -> Stroke:
        """The same stroke, moved after it has been placed where it is."""
        table = {**self.table, **keys_of_placement(by @ placement(self.table))}
        return Stroke(self.kind, keys_of(table), tuple(stroke.placed(by) for stroke in self.others))


def stroke_of(table: Mapping[str, Any]) -> Stroke:
    """The stroke of a table that has been checked."""
    return Stroke(next(kind for kind in get_args(StrokeKind) if kind in table), keys_of(table))


def _stroke(kind: StrokeKind, own: object, *, translate: object = 0j, **others: object) -> Stroke:
    """The stroke of a kind with the values of its own key and of the others."""
    return Stroke(kind, keys_of({kind: own, **others, "translate": pair(translate)}))


def _joined(strokes: list[Stroke]) -> Stroke:
    """One stroke that stands for several."""
    first, *others = strokes
    return Stroke(first.kind, first.keys, tuple(others))


def drawn_lines(geometry: GeoInterface) -> Stroke:
    """A geometry as it is: points are points, lines are polylines, rings are closed ones."""
    return _joined(
        [
            _stroke("point", line[0]) if len(line) == 1 else _stroke("polyline", line, closed=ring)
            for line, ring in lines(geometry)
        ]
    )


def _along(kind: StrokeKind, points: PointsLike, closed: bool | None, **others: object) -> Stroke:
    """The strokes along each line of some points; `closed` None closes those that are rings."""
    return _joined(
        [_stroke(kind, line, closed=ring if closed is None else closed, **others) for line, ring in lines(points)]
    )


def _controlled(kind: StrokeKind, points: PointsLike, **others: object) -> Stroke:
    """The strokes whose points are those of each line, the first one once more at the end of rings."""
    return _joined([_stroke(kind, (*line, line[0]) if ring else line, **others) for line, ring in lines(points)])


def point(
    place: PointLike,
    *,
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """An isolated point; several for a geometry of several."""
    found = [line for line, _ in lines(place)] if isinstance(place, GeoInterface) else [(pair(place),)]
    own = [line[0] if len(line) == 1 else line for line in found]
    return _joined(
        [_stroke("point", one, mirror=mirror, scale=scale, rotate=rotate, translate=translate) for one in own]
    )


def segment(
    start: PointLike,
    end: PointLike,
    *,
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """A straight line between two points."""
    return _stroke("segment", (pair(start), pair(end)), mirror=mirror, scale=scale, rotate=rotate, translate=translate)


def polyline(
    points: PointsLike,
    *,
    closed: bool | None = None,
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """Straight lines from point to point; `closed` joins the ends, None where the points are a ring."""
    return _along("polyline", points, closed, mirror=mirror, scale=scale, rotate=rotate, translate=translate)


def bezier(
    points: PointsLike,
    *,
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """Cubic Bezier curves in a chain: 3n + 1 control points, every third of which lies on the curve."""
    return _controlled("bezier", points, mirror=mirror, scale=scale, rotate=rotate, translate=translate)


def hermite(
    points: PointsLike,
    tangents: PointsLike,
    *,
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """The cubic curve through points with a tangent at each: the derivative by a parameter that grows by 1 a piece."""
    own = pairs(tangents)
    return _controlled("hermite", points, tangents=own, mirror=mirror, scale=scale, rotate=rotate, translate=translate)


def catmull_rom(
    points: PointsLike,
    *,
    alpha: float = 0.5,
    closed: bool | None = None,
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """The smooth curve through points; `alpha` 0 is uniform, 0.5 centripetal, 1 chordal; `closed` as in `polyline`."""
    return _along(
        "catmull_rom", points, closed, alpha=alpha, mirror=mirror, scale=scale, rotate=rotate, translate=translate
    )


def bspline(
    points: PointsLike,
    *,
    closed: bool | None = None,
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """The uniform cubic B-spline of control points, which starts near the second; `closed` as in `polyline`."""
    return _along("bspline", points, closed, mirror=mirror, scale=scale, rotate=rotate, translate=translate)


def circle(
    centre: PointLike,
    radius: float,
    *,
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """A circle about a point."""
    return _stroke(
        "circle", pair(centre), radius=radius, mirror=mirror, scale=scale, rotate=rotate, translate=translate
    )


def path(
    data: str | PathData,
    *,
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """The curves of SVG path data, all commands; or of a path of svgpathtools, or of others that have a method `d`.

    Coordinates are taken as they are, y up: what was copied from an SVG file comes out as its mirror image.
    """
    text = data.d() if isinstance(data, PathData) else data
    return _stroke("path", text, mirror=mirror, scale=scale, rotate=rotate, translate=translate)


def drawing(
    file: str | os.PathLike[str],
    *,
    layer: str | None = None,
    id: str | None = None,  # noqa: A002 - the word of SVG, and of the design file
    mirror: bool = False,
    scale: float = 1.0,
    rotate: float = 0.0,
    translate: PointLike = 0j,
) -> Stroke:
    """The lines of an SVG or DXF file, and the outlines of what is filled, in their real size, upside up.

    `file` is relative to the design's folder. With `layer` only what is on that layer, or has that colour "#rrggbb",
    is drawn, with `id` only the object of that id (SVG), or the entity of that handle (DXF). The lower left corner of
    what is drawn is at the origin.
    """
    given = {key: value for key, value in (("layer", layer), ("id", id)) if value is not None}
    return _stroke(
        "file",
        os.fspath(file) if isinstance(file, os.PathLike) else file,
        **given,
        mirror=mirror,
        scale=scale,
        rotate=rotate,
        translate=translate,
    )

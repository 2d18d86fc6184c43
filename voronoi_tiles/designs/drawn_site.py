"""A site as it is drawn: the strokes of one tile shape, with its name, tolerance and art."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from voronoi_tiles.base import values
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.text import counted
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.art import Art
from voronoi_tiles.designs.coordinates import GeoInterface, PathData, PointLike, pair
from voronoi_tiles.designs.drawn_strokes import Stroke, drawn_lines, path, stroke_of
from voronoi_tiles.designs.keys import PLACEMENT, Keys, keys_of
from voronoi_tiles.designs.schema import placement

Drawn: TypeAlias = Stroke | GeoInterface | PathData
"""What a site is made of: strokes, and geometries, whose points are points and whose lines are polylines."""


@dataclass(frozen=True, init=False, repr=False)
class Site:
    """One tile shape: the strokes of a site, which may meet, cross and branch.

    `strokes` are one or several strokes, geometries, of which each point, line and ring is a stroke, or paths of
    svgpathtools. The name None is "site1", "site2", ... by the place in the design. Curves are flattened to within
    `tolerance`, in the design's units; None is 0.01 mm. `art` is a drawing that every copy carries, or its file.
    `mirror` (x -> -x), `scale`, `rotate` (degrees, counter-clockwise) and `translate` place the site, art and all, in
    this order about the origin, after its strokes have been placed by their own: `keys` are those that say something.

    >>> import voronoi_tiles as vt
    >>> vt.Site([vt.segment(5 + 3j, 25 + 11j), vt.circle(9j, 2)], name="bird")
    <Site 'bird': 2 strokes>
    """

    strokes: tuple[Stroke, ...]
    name: str | None
    tolerance: float | None
    art: Art | None
    keys: Keys

    def __init__(
        self,
        strokes: Drawn | Iterable[Drawn],
        *,
        name: str | None = None,
        tolerance: float | None = None,
        art: Art | str | os.PathLike[str] | None = None,
        mirror: bool = False,
        scale: float = 1.0,
        rotate: float = 0.0,
        translate: PointLike = 0j,
    ) -> None:
        """Describe a site. Raises DesignError for what is no stroke and no geometry."""
        if isinstance(strokes, Stroke | GeoInterface | PathData):
            strokes = (strokes,)
        if isinstance(strokes, str | Mapping) or not isinstance(strokes, Iterable):
            raise DesignError(
                f"must be a sequence of strokes, not {shown(strokes)}",
                key="strokes",
                remedy="Write [segment(5+3j, 25+11j)].",
            )
        parts = [part for k, item in enumerate(strokes) for part in _drawn(item, k).parts]
        object.__setattr__(self, "strokes", tuple(parts))
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "tolerance", tolerance)
        object.__setattr__(self, "art", art if art is None or isinstance(art, Art) else Art(art))
        keys = {"mirror": mirror, "scale": scale, "rotate": rotate, "translate": pair(translate)}
        object.__setattr__(self, "keys", keys_of(keys))

    def __repr__(self) -> str:
        return f"<Site {self.name!r}: {counted(len(self.strokes), 'stroke')}>"

    @property
    def placement(self) -> Placement:
        """Where the site is laid."""
        return placement(dict(self.keys))

    @property
    def table(self) -> dict[str, Any]:
        """The site as in a design file."""
        found = {"name": self.name, "tolerance": self.tolerance, "art": None if self.art is None else self.art.table}
        return {
            **{name: value for name, value in found.items() if value is not None},
            **dict(self.keys),
            "strokes": [stroke.table for stroke in self.strokes],
        }

    def moved(
        self, *, mirror: bool = False, scale: float = 1.0, rotate: float = 0.0, translate: PointLike = 0j
    ) -> Site:
        """The same site with all its strokes and its art moved, in the order of the arguments, about the origin.

        `mirror` is x -> -x, `rotate` in degrees counter-clockwise. What placed the site has become a part of what
        places its strokes.
        """
        return self.placed(
            placement({"mirror": mirror, "scale": scale, "rotate": rotate, "translate": pair(translate)})
        )

    def placed(self, by: Placement) -> Site:
        """The same site, moved after it has been placed where it is; see `moved`."""
        by = by @ self.placement
        with values.within("strokes"):
            strokes = values.each(self.strokes, lambda stroke: stroke.placed(by))
        art = None if self.art is None else self.art.placed(by)
        return Site(strokes, name=self.name, tolerance=self.tolerance, art=art)


def _drawn(item: object, index: int) -> Stroke:
    """What a site is given as one stroke, of several parts where it is a geometry of several."""
    try:
        match item:
            case Stroke():
                return item
            case GeoInterface():
                return drawn_lines(item)
            case PathData():
                return path(item)
    except DesignError as error:
        raise error.under(f"strokes[{index}]") from None
    raise DesignError(
        f"must be a stroke or a geometry, not {shown(item)}",
        key=f"strokes[{index}]",
        remedy="Make one with segment(5+3j, 25+11j), or the like.",
    )


def site_of(table: Mapping[str, Any], name: str) -> Site:
    """The site of a table that has been checked; `name` is what it is called where the table does not say."""
    art = table.get("art")
    return Site(
        [stroke_of(stroke) for stroke in table["strokes"]],
        name=table.get("name", name),
        tolerance=table.get("tolerance"),
        art=Art(**art) if isinstance(art, Mapping) else art,
        **{key: table[key] for key in PLACEMENT if key in table},
    )

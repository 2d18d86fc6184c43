"""A solid as it is drawn: how high a design stands, and how its strokes change on the way up."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from voronoi_tiles.base import values
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.coordinates import PointLike, pair
from voronoi_tiles.designs.drawn_site import Site
from voronoi_tiles.designs.drawn_strokes import Stroke, stroke_of
from voronoi_tiles.designs.keys import DEFAULTS
from voronoi_tiles.designs.schema import point
from voronoi_tiles.designs.solid_checking import LAYERS


@dataclass(frozen=True, init=False, repr=False)
class Key:
    """The strokes of a site at the height `z`, in the design's units: of the same kinds and numbers of points.

    Between two keys strokes are interpolated; the drawing of the design itself is that at 0. `site` is a name, None
    the only site.
    """

    z: float
    strokes: tuple[Stroke, ...]
    site: str | None

    def __init__(self, z: float, strokes: Stroke | Iterable[Stroke], *, site: str | None = None) -> None:
        """Describe a key. Raises DesignError for what is no stroke."""
        if isinstance(strokes, Stroke):
            strokes = (strokes,)
        if isinstance(strokes, str | Mapping) or not isinstance(strokes, Iterable):
            raise DesignError(f"must be strokes, not {shown(strokes)}", key="strokes", remedy="Write [segment(0, 5)].")
        listed = tuple(part for stroke in strokes for part in _parts(stroke))
        for name, value in (("z", z), ("strokes", listed), ("site", site)):
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        return f"<Key at {self.z}: {len(self.strokes)} strokes>"

    @property
    def table(self) -> dict[str, Any]:
        """The key as in a design file."""
        named = {} if self.site is None else {"site": self.site}
        return {"z": self.z, **named, "strokes": [stroke.table for stroke in self.strokes]}

    def placed(self, by: Placement, height: float) -> Key:
        """The same key, its strokes moved after they have been placed and its height times a factor."""
        with values.within("strokes"):
            return Key(self.z * height, values.each(self.strokes, lambda stroke: stroke.placed(by)), site=self.site)


def _parts(stroke: object) -> tuple[Stroke, ...]:
    if not isinstance(stroke, Stroke):
        raise DesignError(f"must be a stroke, not {shown(stroke)}", key="strokes", remedy="Write segment(0, 5).")
    return stroke.parts


@dataclass(frozen=True, init=False)
class Solid:
    """How high a design stands, in its units, and how its strokes move on the way up.

    At the height z, strokes are interpolated between the `keys`, then scaled by a factor that runs from 1 to `scale`,
    turned by an angle that runs to `turn` degrees, both about the point `about`, and moved by a vector that runs to
    `shift`. `layers` counts the heights at which tiles are exact, bottom and top among them; where walls between them
    would be farther from the tiles than the accuracy, there are more.

    >>> import voronoi_tiles as vt
    >>> vt.Solid(20, turn=90, about=15 + 7j).table
    {'height': 20, 'turn': 90, 'about': [15.0, 7.0]}
    """

    height: float
    layers: int
    turn: float
    shift: complex
    scale: float
    about: complex
    keys: tuple[Key, ...]

    def __init__(
        self,
        height: float,
        *,
        layers: int = LAYERS,
        turn: float = 0.0,
        shift: PointLike = 0j,
        scale: float = 1.0,
        about: PointLike = 0j,
        keys: Sequence[Key] = (),
    ) -> None:
        """Describe a solid. Raises DesignError for what is no key and no point; a design checks the rest."""
        if isinstance(keys, str | Mapping) or not isinstance(keys, Iterable):
            raise DesignError(f"must be keys, not {shown(keys)}", key="keys", remedy="Write keys=[Key(5, [...])].")
        keys = list(keys)
        for k, key in enumerate(keys):
            if not isinstance(key, Key):
                raise DesignError(f"must be a Key, not {shown(key)}", key=f"keys[{k}]", remedy="Write Key(5, [...]).")
        points = []
        for name, value in (("shift", shift), ("about", about)):
            with values.within(name):
                points.append(point(pair(value)))
        names = ("height", "layers", "turn", "scale", "keys", "shift", "about")
        for name, given in zip(names, (height, layers, turn, scale, tuple(keys), *points), strict=True):
            object.__setattr__(self, name, given)

    @property
    def table(self) -> dict[str, Any]:
        """The table [solid] of a design file, without its keys."""
        shift, about = ([z.real, z.imag] for z in (self.shift, self.about))
        found = {"layers": self.layers, "turn": self.turn, "shift": shift, "scale": self.scale, "about": about}
        plain = {"layers": LAYERS, "turn": DEFAULTS["rotate"], "shift": [0.0, 0.0], "scale": 1.0, "about": [0.0, 0.0]}
        return {"height": self.height, **{key: value for key, value in found.items() if value != plain[key]}}

    def placed(self, by: Placement, sites: Sequence[Site], height: float = 1.0) -> Solid:
        """The same solid for sites that are moved by `by` after they have been placed as they are, and its height.

        Strokes of keys are placed as those of their sites; the motion is the same one, seen from where it is now.
        """
        places = {site.name: by @ site.placement for site in sites}
        keys = []
        for k, key in enumerate(self.keys):
            with values.within(f"key[{k}]"):
                keys.append(key.placed(places[sites[0].name if key.site is None else key.site], height))
        return Solid(
            self.height * height,
            layers=self.layers,
            turn=-self.turn if by.mirror else self.turn,
            shift=by(self.shift) - by(0j),
            scale=self.scale,
            about=by(self.about),
            keys=keys,
        )


def solid_of(table: Mapping[str, Any]) -> Solid | None:
    """The solid of a design's table that has been checked, None where it has none."""
    if "solid" not in table:
        return None
    keys = [
        Key(key["z"], [stroke_of(stroke) for stroke in key["strokes"]], site=key.get("site"))
        for key in table.get("key", ())
    ]
    return Solid(**table["solid"], keys=keys)


def solid_tables(solid: Solid | None) -> dict[str, Any]:
    """The keys "solid" and "key" of a design's table, those that say something."""
    if solid is None:
        return {}
    if not isinstance(solid, Solid):
        raise DesignError(f"must be a Solid, not {shown(solid)}", key="solid", remedy="Write solid=Solid(20, turn=90).")
    keys = [key.table for key in solid.keys]
    return {"solid": solid.table, **({"key": keys} if keys else {})}

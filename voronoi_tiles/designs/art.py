"""The art of a site: a drawing that every copy of its tile carries."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Final

from voronoi_tiles.base.maps import Placement
from voronoi_tiles.designs.coordinates import PointLike, pair
from voronoi_tiles.designs.keys import Keys, keys_of, keys_of_placement
from voronoi_tiles.designs.schema import placement

GUIDE: Final = "guide"
"""The layer of a drawing that is a help for drawing, and neither art nor strokes."""


@dataclass(frozen=True, init=False, repr=False)
class Art:
    """A drawing that belongs to a site: its strokes are engraved or scored on every copy of the tile.

    `file` is its path as written in the design, relative to the design's folder. Its lower left corner is laid on the
    design's origin, its millimetres become the design's units, and then it is mirrored (x -> -x), scaled, turned by
    `rotate` degrees counter-clockwise, and moved by `translate`, in this order about the origin.

    >>> import voronoi_tiles as vt
    >>> vt.Art("face.svg", translate=(-10, -3))
    Art('face.svg', translate=(-10, -3))
    """

    file: str
    keys: Keys

    def __init__(
        self,
        file: str | os.PathLike[str],
        *,
        mirror: bool = False,
        scale: float = 1.0,
        rotate: float = 0.0,
        translate: PointLike = 0j,
    ) -> None:
        object.__setattr__(self, "file", os.fspath(file) if isinstance(file, os.PathLike) else file)
        keys = {"mirror": mirror, "scale": scale, "rotate": rotate, "translate": pair(translate)}
        object.__setattr__(self, "keys", keys_of(keys))

    def __repr__(self) -> str:
        return f"Art({', '.join([repr(self.file), *(f'{name}={value!r}' for name, value in self.keys)])})"

    @property
    def placement(self) -> Placement:
        """Where the drawing is laid."""
        return placement(dict(self.keys))

    @property
    def table(self) -> dict[str, Any]:
        """The drawing as in a design file."""
        return {"file": self.file, **dict(self.keys)}

    def placed(self, by: Placement) -> Art:
        """The same drawing, moved after it has been laid where it is."""
        return Art(self.file, **keys_of_placement(by @ self.placement))

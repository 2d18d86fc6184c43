"""Whether tiles can be put together one after the other, and from where each comes in."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from math import degrees, radians
from typing import Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.solid.loft import Loft
from voronoi_tiles.solid.ways_out import UP, TileWays, WayOut
from voronoi_tiles.vector.motion_codes import code_of, composed, motion_of

ORDERS: Final = 24
"""So many orders are looked at; a count. Turned and mirrored by the operations of any group they are the same ones."""

_FIRST: Final = 7.5
"""The first of them, in degrees from x: along none of them do two lattice points of a square or a hexagonal lattice
lie side by side."""


class _AlikeCopies(NamedTuple):
    """Copies of a site that are laid alike: by an operation up to translations, in Cartesian coordinates."""

    operation: str
    turn: complex
    mirrors: bool

    def base(self, order: int) -> int:
        """In which order the base tile goes in as these copies do in an order."""
        towards = cmath.rect(1.0, radians(towards_of(order)))
        there = self.turn * towards.conjugate() if self.mirrors else self.turn.conjugate() * towards
        return round((degrees(cmath.phase(there)) - _FIRST) * ORDERS / 360) % ORDERS

    def image(self, direction: tuple[float, float, float]) -> list[float]:
        """The direction of these copies where that of the base tile is given."""
        x, y, z = direction
        there = self.turn * complex(x, -y if self.mirrors else y)
        return [there.real + 0.0, there.imag + 0.0, z]


def towards_of(order: int) -> float:
    """The direction in which rows follow each other in an order; degrees counter-clockwise from x."""
    return _FIRST + order * 360 / ORDERS


def assembly(loft: Loft) -> dict[str, Any]:
    """How the solids of a loft go together, in the types of JSON.

    They are laid in the order of their places along a direction: each comes in along a straight way while all before it
    stand. "tried" is how many directions were looked at, "orders" are those in which every copy has such a way, in
    degrees from x; "best" is the one in which all come in from above, or leave the walls that they touch at the widest
    angle: its direction "towards", and for the copies of a "site" under "operations" (up to translations, None for all
    of them) the unit vector to where they come "from", and the "clearance", in degrees, of that from the nearest wall.
    "out" is for each site the direction in which a single tile comes out while all others stand, None where it is
    locked. Room that a clearance adds is not counted.
    """
    names = [site.name for site in loft.design.noded]
    tiles = [TileWays(loft, site) for site in range(len(names))]
    kinds = [_kinds(loft, site) for site in range(len(names))]
    known: dict[tuple[int, int], WayOut | None] = {}

    def way(site: int, order: int) -> WayOut | None:
        if (site, order) not in known:
            known[site, order] = tiles[site].way(cmath.rect(1.0, radians(towards_of(order))))
        return known[site, order]

    found: dict[int, list[list[tuple[_AlikeCopies, WayOut]]]] = {}
    for order in range(ORDERS):
        ways: list[list[tuple[_AlikeCopies, WayOut]]] = []
        for site, own in enumerate(kinds):
            own_ways = [(kind, way(site, kind.base(order))) for kind in own]
            if any(one is None for _, one in own_ways):
                break
            ways.append([(kind, one) for kind, one in own_ways if one is not None])
        else:
            found[order] = ways
    best = max(found, key=lambda order: _ease(found[order]), default=None)
    return {
        "tried": ORDERS,
        "orders": [towards_of(order) for order in found],
        "best": None
        if best is None
        else {
            "towards": towards_of(best),
            "tiles": [row for name, own in zip(names, found[best], strict=True) for row in _rows(name, own)],
        },
        "out": {
            name: None if (out := tile.way(None)) is None else list(out.direction)
            for name, tile in zip(names, tiles, strict=True)
        },
    }


def prism_assembly(names: Sequence[str]) -> dict[str, Any]:
    """The same of prisms, drawn in or not: each stays over its own tile, and so comes in from above, in any order."""
    rows = [{"site": name, "operations": None, "from": list(UP), "clearance": 0.0} for name in names]
    return {
        "tried": ORDERS,
        "orders": [towards_of(order) for order in range(ORDERS)],
        "best": {"towards": towards_of(0), "tiles": rows},
        "out": {name: list(UP) for name in names},
    }


def _kinds(loft: Loft, site: int) -> list[_AlikeCopies]:
    """The copies of a site that are laid differently: the operations of the group up to what maps it onto itself."""
    core = loft.levels[0].core
    found: dict[tuple[int, ...], _AlikeCopies] = {}
    for operation, motion in zip(loft.design.group.operations, core.action.motions, strict=True):
        alike = [motion_of(int(code))[:4] for code in composed(code_of(motion), np.array(core.stabilizers[site]))]
        turn, mirrors = core.action.linear[motion[:4]]
        found.setdefault(min(alike), _AlikeCopies(str(operation), turn, mirrors))
    return list(found.values())


def _ease(ways: Sequence[Sequence[tuple[_AlikeCopies, WayOut]]]) -> tuple[bool, float]:
    """What makes an order better: that all come in from above, or how clear of walls the least clear one comes in."""
    every = [way for own in ways for _, way in own]
    return all(way.direction == UP for way in every), round(min(way.clearance for way in every), 6)


def _rows(name: str, ways: Sequence[tuple[_AlikeCopies, WayOut]]) -> list[dict[str, Any]]:
    """The copies of a site, those together that come in from the same side."""
    rows: dict[tuple[float, ...], dict[str, Any]] = {}
    for kind, way in ways:
        come = kind.image(way.direction)
        row = rows.setdefault(
            tuple(round(part, 9) for part in come),
            {"site": name, "operations": [], "from": come, "clearance": way.clearance},
        )
        row["operations"].append(kind.operation)
        row["clearance"] = min(row["clearance"], way.clearance)
    if len(rows) == 1:
        next(iter(rows.values()))["operations"] = None
    return list(rows.values())

"""Placements that leave least uncovered: what least squares of waves found, led on by areas themselves."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from scipy import optimize

from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.escherization.area_transform import AreaTransform
from voronoi_tiles.escherization.covering import gap
from voronoi_tiles.escherization.goal_outline import GoalOutline
from voronoi_tiles.escherization.group_placement import GroupPlacement
from voronoi_tiles.escherization.placement_search import PlacementSearch, placement_of
from voronoi_tiles.groups.wallpaper import GROUPS

_SIMPLEX: Final = 0.02
"""The size of the first simplex; radians, fractions of the cell, logarithms."""

_EVALUATIONS: Final = 240
"""How many placements are compared at most; a count."""

_POOR: Final = 0.25
"""Placements that leave more uncovered are not led on; a share of the plane. Their tiles have three fifths in common
with the outline at most, and those of stars with long rays, on which dozens of copies lie, would take an hour."""


class Found(NamedTuple):
    """A placement as the search has it, and the share of the plane that copies leave uncovered."""

    group: str
    row: Floats
    uncovered: float


class Polished(NamedTuple):
    """A placement of a silhouette of area 1, and the share of the plane that its copies leave uncovered."""

    placement: GroupPlacement
    uncovered: float


def found_placements(unit: GoalOutline, seed: int, group: str) -> list[Found]:
    """The best placements of a silhouette of area 1 in a group, as waves see it; those that cover most first."""
    search = PlacementSearch(GROUPS[group], AreaTransform.of(unit), unit.width)
    found = [Found(group, row, gap(unit, placement_of(search.group, row))) for row in search.found(seed)]
    return sorted(found, key=lambda each: each.uncovered)


def polished(unit: GoalOutline, found: Found) -> Polished:
    """A placement led on to where copies leave least uncovered, if it is not a poor one.

    The share has kinks where corners pass outlines, so that it is led down without derivatives (Nelder, Mead).
    """
    group = GROUPS[found.group]
    if found.uncovered > _POOR:
        return Polished(placement_of(group, found.row), found.uncovered)
    options = {
        "initial_simplex": np.vstack((found.row, found.row + _SIMPLEX * np.eye(len(found.row)))),
        "maxfev": _EVALUATIONS,
        "xatol": 1e-6,
        "fatol": 1e-7,
    }
    led = optimize.minimize(
        lambda row: gap(unit, placement_of(group, row)), found.row, method="Nelder-Mead", options=options
    )
    return Polished(placement_of(group, led.x), float(led.fun))

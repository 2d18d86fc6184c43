"""Placements whose tiles come nearest to an outline: what least squares of waves found, led on by areas themselves."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from scipy import optimize

from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.escherization.area_transform import AreaTransform
from voronoi_tiles.escherization.covering import overlap_bound
from voronoi_tiles.escherization.goal_outline import GoalOutline
from voronoi_tiles.escherization.group_placement import GroupPlacement
from voronoi_tiles.escherization.placement_rows import PlacementRows
from voronoi_tiles.escherization.placement_search import PlacementSearch

_SIMPLEX: Final = 0.02
"""The size of the first simplex; radians, fractions of the cell, logarithms."""

_EVALUATIONS: Final = 240
"""How many placements are compared at most; a count."""

_POOR: Final = 0.6
"""Placements whose tiles have less in common with the outline at most are not led on. Those of stars with long rays, on
which dozens of copies lie, would take an hour."""


class FoundPlacement(NamedTuple):
    """A placement of a silhouette of area 1, by the free numbers of rows, and the largest overlap of its tiles."""

    among: PlacementRows
    free: Floats
    bound: float


def found_placements(
    unit: GoalOutline, among: PlacementRows, transform: AreaTransform, seed: int
) -> list[FoundPlacement]:
    """The best placements of a silhouette of area 1, as waves see it, in any order."""
    search = PlacementSearch(among, transform)
    return [FoundPlacement(among, free, overlap_bound(unit, among.placement(free))) for free in search.found(seed)]


def polished(unit: GoalOutline, found: FoundPlacement) -> tuple[GroupPlacement, float]:
    """A placement led on to where tiles can overlap most with the outline, if it is not a poor one; that overlap.

    The cell may become smaller or larger than its copies are together. The overlap has kinks where corners pass
    outlines, so that it is led up without derivatives (Nelder, Mead).
    """
    if found.bound < _POOR:
        return found.among.placement(found.free), found.bound

    def placed(numbers: Floats) -> GroupPlacement:
        *free, growth = numbers
        return found.among.placement(np.array(free)).scaled(math.exp(growth))

    start = np.append(found.free, 0.0)
    options = {
        "initial_simplex": np.vstack((start, start + _SIMPLEX * np.eye(len(start)))),
        "maxfev": _EVALUATIONS,
        "xatol": 1e-6,
        "fatol": 1e-7,
    }
    led = optimize.minimize(
        lambda numbers: -overlap_bound(unit, placed(numbers)), start, method="Nelder-Mead", options=options
    )
    return placed(led.x), -float(led.fun)

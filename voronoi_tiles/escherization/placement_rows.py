"""Placements of a silhouette of area 1 as rows of numbers, all of a group's or some of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats
from voronoi_tiles.escherization.group_placement import GroupPlacement
from voronoi_tiles.groups.wallpaper import WallpaperGroup

_LONGEST: Final = 5.0
"""How many times as long as wide reduced cells may be at least; wide outlines need longer ones."""


def sides(group: WallpaperGroup, rows: Floats) -> tuple[Complexes, Complexes]:
    """The sides of the cells of rows of numbers, for silhouettes of area 1: complex128 (m,) twice."""
    one = np.ones(len(rows))
    match group.system:
        case "oblique":
            ratio: Complexes = rows[:, -2] + np.exp(rows[:, -1]) * 1j
        case "rectangular":
            ratio = np.asarray(1j * np.exp(rows[:, -1]), complex)
        case "square":
            ratio = np.asarray(1j * one, complex)
        case "hexagonal":
            ratio = np.asarray(one * complex(-0.5, math.sqrt(0.75)), complex)
    a = np.sqrt(group.order / ratio.imag) + 0j
    return a, ratio * a


def longest_cell(group: WallpaperGroup, width: float) -> float:
    """The logarithm of how long cells may be at most relative to their width, for outlines of a least width."""
    return math.log(max(_LONGEST, group.order / width**2))


@dataclass(frozen=True, eq=False)
class PlacementRows:
    """The placements of a silhouette, of area 1, in a group, as rows of d numbers; or some, by k numbers that are free.

    A row is the turn in radians, where the centroid lies in fractions of the cell, and the shape of the cell: none of a
    square or hexagonal one, the logarithm of b / a of a rectangular one, and of an oblique one the point b / a of the
    upper half plane as its real part and the logarithm of its imaginary part. Where the group is p1 all places are one.

    Rows are `origin` (float64, d) and sums of those of `basis` (k, d), as many times as the free numbers say, which lie
    between `low` and `high` (k,); those that are `periodic` (bool, k) may leave them.
    """

    group: WallpaperGroup
    origin: Floats
    basis: Floats
    low: Floats
    high: Floats
    periodic: Bools

    @classmethod
    def everywhere(cls, group: WallpaperGroup, width: float) -> PlacementRows:
        """All placements of a silhouette of a least width."""
        longest = longest_cell(group, width)
        place = [] if group.name == "p1" else [(0.0, 1.0)] * 2
        cell = {
            "oblique": [(-0.5, 0.5), (math.log(0.86), longest)],
            "rectangular": [(-longest, longest)],
        }.get(group.system, [])
        low, high = np.array([(0.0, 2.0 * math.pi), *place, *cell]).T
        count = len(low)
        return cls(group, np.zeros(count), np.eye(count), low, high, np.arange(count) < 1 + len(place))

    def rows(self, free: Floats) -> Floats:
        """The rows (m, d) of free numbers (m, k)."""
        return np.asarray(self.origin + free @ self.basis)

    def placement(self, free: Floats) -> GroupPlacement:
        """The placement of free numbers (k,)."""
        row = self.rows(free[None])
        a, b = (complex(side[0]) for side in sides(self.group, row))
        lattice = self.group.lattice(a.real, abs(b), math.degrees(np.angle(b)))
        centre = 0j if self.group.name == "p1" else lattice.cartesian(row[0, 1], row[0, 2])
        return GroupPlacement(self.group, lattice, float(row[0, 0]), centre)

    def clipped(self, free: Floats) -> Floats:
        """Free numbers (m, k) within their bounds."""
        return np.asarray(np.where(self.periodic, free, np.clip(free, self.low, self.high)))

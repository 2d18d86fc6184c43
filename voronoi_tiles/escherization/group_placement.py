"""A silhouette in a wallpaper group: the cell, where it lies in it, and its copies."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup


@dataclass(frozen=True)
class GroupPlacement:
    """A silhouette turned and moved into a cell of a group, in millimetres.

    `turn` is in radians, counter-clockwise about the silhouette's centroid, which comes to lie at `centre`.
    """

    group: WallpaperGroup
    lattice: Lattice
    turn: float
    centre: complex

    @cached_property
    def cell(self) -> dict[str, float]:
        """The cell's sides and angle, as far as the group leaves them free."""
        a, b = self.lattice.a, self.lattice.b
        sides = {"a": abs(a)} if self.group.fixes_b else {"a": abs(a), "b": abs(b)}
        angle = {} if self.group.fixed_angle else {"angle": math.degrees(cmath.phase(b))}
        return sides | angle

    def scaled(self, factor: float) -> GroupPlacement:
        """The placement of a silhouette that is so many times as large."""
        lattice = Lattice(self.lattice.a * factor, self.lattice.b * factor)
        return GroupPlacement(self.group, lattice, self.turn, self.centre * factor)

    def laid(self, points: Complexes, centroid: complex) -> Complexes:
        """Points of the silhouette, of this centroid, where they come to lie in the cell."""
        return np.asarray((points - centroid) * cmath.exp(1j * self.turn) + self.centre)

    def taken_back(self, points: Complexes, centroid: complex) -> Complexes:
        """Points of the cell where they were in the silhouette: the inverse of `laid`."""
        return np.asarray((points - self.centre) * cmath.exp(-1j * self.turn) + centroid)

    def copies(self, distance: float) -> list[Isometry]:
        """The operations but the identity that leave the centre within a distance, in millimetres: all copies near."""
        lattice = self.lattice
        found: list[Isometry] = []
        for number, operation in enumerate(self.group.operations):
            image = lattice.isometry(operation)(self.centre)
            # All translations that bring the image near: in fractions of the cell they fill a box about the difference.
            x, y = lattice.fractional(self.centre - image)
            wide = distance * abs(lattice.b) / lattice.det
            high = distance * abs(lattice.a) / lattice.det
            found += [
                lattice.isometry(operation.translated(i, j))
                for i in range(math.ceil(x - wide), math.floor(x + wide) + 1)
                for j in range(math.ceil(y - high), math.floor(y + high) + 1)
                if (number or i or j) and abs(image + lattice.cartesian(i, j) - self.centre) <= distance
            ]
        return found

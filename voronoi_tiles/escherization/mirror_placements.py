"""Placements of an outline that is its own mirror image, among copies that are so all together, about the same line.

A reflection that takes every operation of a group to another one of it takes copies of such an outline on its line to
copies. The group with the reflection has the outline in a special position, and a tile that is its own mirror image. It
is looked for in the group without it, where it lies in general position: its stroke can be changed at will later.
"""

from __future__ import annotations

import cmath
import math
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.operations import Operation
from voronoi_tiles.escherization.placement_rows import PlacementRows, longest_cell, sides
from voronoi_tiles.groups.symmetry_elements import symmetry_elements
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup

_STEPS: Final = 24
"""In how many places of a cell lines are looked for; a count. Symmetry elements lie at eighths and sixths of it."""

_RIGHT: Final = ((1, 0), (0, 1))
_DIRECTIONS: Final = {
    ("oblique", 0.0): _RIGHT,
    ("oblique", 0.5): ((1, 0), (1, -2)),
    ("rectangular", 0.0): (*_RIGHT, (1, 1), (1, -1)),
    ("square", 0.0): (*_RIGHT, (1, 1), (1, -1)),
    ("hexagonal", 0.0): (*_RIGHT, (1, 1), (1, -1), (1, 2), (2, 1)),
}
"""In which directions lattices have mirrors, in the cell's sides, by the system and the real part of b / a. Diagonals
of a rectangle are some where it is a square."""


class MirrorLine(NamedTuple):
    """A line about which the operations of a group are mirror images of each other.

    It goes through a point in a direction, in fractions of the cell; `skew` is the real part of b / a of an oblique
    cell: 0 where it is a rectangle, 1/2 where its lattice is a rhombic one.
    """

    point: tuple[Fraction, Fraction]
    direction: tuple[int, int]
    skew: float

    def lattice(self, group: WallpaperGroup) -> Lattice:
        """Some lattice of a group that has the line as a mirror."""
        shape = {"oblique": [self.skew, 0.1], "rectangular": [0.0 if self.diagonal else 0.1]}.get(group.system, [])
        a, b = (complex(side[0]) for side in sides(group, np.array([shape])))
        return Lattice(a, b)

    def angle(self, group: WallpaperGroup) -> float:
        """Its direction in radians."""
        return cmath.phase(self.lattice(group).cartesian(*self.direction))

    @property
    def diagonal(self) -> bool:
        """Whether it runs along neither side of the cell."""
        return 0 not in self.direction


def mirror_rows(group: WallpaperGroup, axis: float, width: float) -> list[PlacementRows]:
    """The placements of an outline with an axis at an angle, through its centroid, that keep mirror images.

    The angle is in radians; `width` is the least width of the outline. None of groups that have mirrors themselves:
    rotations and translations alone make the same copies of what is its own mirror image, in a group that has none.
    Turned by half a turn about a point of the line, a placement is another one of these.
    """
    longest = longest_cell(group, width)
    found: list[PlacementRows] = []
    for line in mirror_lines(group):
        place: tuple[float, ...] = () if group.name == "p1" else (float(line.point[0]), float(line.point[1]))
        shape = {"oblique": (line.skew, 0.0), "rectangular": (0.0,)}.get(group.system, ())
        # The free numbers: how far along the line, and how long the cell is. Of oblique cells both directions are
        # looked at, so that no other lattice is shorter along b.
        basis: list[tuple[float, ...]] = []
        bounds: list[tuple[float, float]] = []
        if place:
            basis.append((0.0, *line.direction, *(0.0 for _ in shape)))
            bounds.append((0.0, 1.0))
        if shape and not (group.system == "rectangular" and line.diagonal):
            basis.append((*(0.0 for _ in (*place, *shape)), 1.0))
            bounds.append((math.log(1.0 - line.skew) if group.system == "oblique" else -longest, longest))
        low, high = np.array(bounds).T
        periodic = np.arange(len(basis)) < (1 if place else 0)
        origin = np.array([line.angle(group) - axis, *place, *shape])
        found.append(PlacementRows(group, origin, np.array(basis), low, high, periodic))
    return found


@cache
def mirror_lines(group: WallpaperGroup) -> tuple[MirrorLine, ...]:
    """The lines about which a group without mirrors is its own mirror image; one of those that it takes to each other.

    Translations that keep the group take lines to others as well.
    """
    if symmetry_elements(group).mirrors:
        return ()
    own = {operation.reduced() for operation in group.operations}
    linear = {operation.linear for operation in own}
    grid = [Fraction(k, _STEPS) for k in range(_STEPS)]
    shifts = [(x, y) for x, y in product(grid, repeat=2) if _keeps(Operation((1, 0, 0, 1), (x, y)), own)]
    found: list[MirrorLine] = []
    for skew in (0.0, 0.5) if group.system == "oblique" else (0.0,):
        seen: set[tuple[int, int]] = set()
        for p, q in _DIRECTIONS[group.system, skew]:
            if (p, q) in seen:
                continue
            seen |= {(s * (a * p + b * q), s * (c * p + d * q)) for a, b, c, d in linear for s in (1, -1)}
            moves = {(q * x - p * y) % 1 for x, y in shifts}
            offsets: set[Fraction] = set()
            lattice = MirrorLine((Fraction(0), Fraction(0)), (p, q), skew).lattice(group)
            for offset in grid:
                point = (offset / q, Fraction(0)) if q else (Fraction(0), -offset / p)
                mirror = _reflection(lattice, point, (p, q))
                if offset not in offsets and _keeps(mirror, own):
                    found.append(MirrorLine(point, (p, q), skew))
                    offsets |= {(offset + move) % 1 for move in moves}
    return tuple(found)


def _keeps(operation: Operation, group: set[Operation]) -> bool:
    """Whether an operation takes those of a group to others of it, up to translations of the lattice."""
    inverse = operation.inverse()
    return all((operation @ each @ inverse).reduced() in group for each in group)


def _reflection(lattice: Lattice, point: tuple[Fraction, Fraction], direction: tuple[int, int]) -> Operation:
    """The reflection about a line of a lattice, by a point and a direction in fractions of the cell."""
    along = lattice.cartesian(*direction)
    unit = along / along.conjugate()
    (a, c), (b, d) = (tuple(map(round, lattice.fractional(unit * side.conjugate()))) for side in (lattice.a, lattice.b))
    x, y = point
    return Operation((a, b, c, d), (x - a * x - b * y, y - c * x - d * y))

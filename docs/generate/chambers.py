"""The chambers of a group: the parts into which its mirrors cut the plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.groups.symmetry_elements import placed, symmetry_elements
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup

Complexes = NDArray[np.complex128]

NEAR = 1e-12
"""What counts as nothing beside some cells: rounding."""

ANGLES = {(90, 90, 90, 90): "rectangle", (60, 60, 60): "equilateral triangle"}


@dataclass(frozen=True, eq=False)
class Chamber:
    """The part of the plane between mirrors that a point lies in.

    `sides` complex128 (n, 2) are the mirrors about it, the chamber to their left; `corners` complex128 (m,) those of
    the chamber, counter-clockwise, or of the part of it within some cells, where it is not `bounded`.
    """

    sides: Complexes
    corners: Complexes
    bounded: bool

    @property
    def area(self) -> float:
        """The area; infinite where it is not bounded."""
        if not self.bounded:
            return float("inf")
        return float((self.corners.conj() * np.roll(self.corners, -1)).imag.sum()) / 2

    @property
    def name(self) -> str:
        """What the chamber is, by its sides and angles in whole degrees."""
        if not len(self.sides):
            return "plane"
        if not self.bounded:
            return "strip"
        sides = np.roll(self.corners, -1) - self.corners
        angles = np.degrees(np.angle(-np.roll(sides, 1) / sides))
        if not np.allclose(angles, np.round(angles), rtol=0.0, atol=1e-6):
            raise ArithmeticError(f"a chamber with the angles {angles}")
        shape = tuple(sorted(np.round(angles).astype(int).tolist()))
        if shape == (90, 90, 90, 90) and np.ptp(np.abs(sides)) <= 1e-9 * np.abs(sides).max():
            return "square"
        return ANGLES.get(shape, "-".join(map(str, shape)) + " triangle")

    def beyond(self, points: Complexes) -> float:
        """How far the farthest of the points is outside; not above 0 where all are inside."""
        start, end = self.sides[:, 0, None], self.sides[:, 1, None]
        chord = end - start
        left = ((points - start) * chord.conj()).imag / np.abs(chord)
        return float(-left.min(initial=np.inf))


def chamber_about(group: WallpaperGroup, lattice: Lattice, point: complex) -> Chamber:
    """The chamber of a point that lies on no mirror."""
    reach = abs(lattice.a) + abs(lattice.b)
    box = (point.real - reach, point.imag - reach, point.real + reach, point.imag + reach)
    mirrors = placed(symmetry_elements(group), lattice, box).mirrors
    side = ((point - mirrors[:, 0]) * (mirrors[:, 1] - mirrors[:, 0]).conj()).imag
    mirrors = np.where(side[:, None] > 0, mirrors, mirrors[:, ::-1])
    corners: Complexes = np.asarray(point + reach * np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j]), np.complex128)
    for mirror in mirrors:
        corners = _left_of(corners, mirror)
    chord = mirrors[:, 1:] - mirrors[:, :1]
    off = np.abs(((corners - mirrors[:, :1]) * chord.conj()).imag) / np.abs(chord)
    sides = mirrors[np.count_nonzero(off <= NEAR * reach, axis=1) >= 2]
    rim = np.maximum(np.abs((corners - point).real), np.abs((corners - point).imag))
    bounded = bool(rim.max() < reach * (1 - NEAR))
    return Chamber(sides, corners, bounded)


def chamber_numbers(group: WallpaperGroup, lattice: Lattice, points: Complexes) -> NDArray[np.int64]:
    """Between which mirrors of each direction and offset points lie, int64 (n, m): equal rows are one chamber."""
    x, y = lattice.fractional(points)
    rows = [
        np.floor(line.direction[1] * x - line.direction[0] * y - float(line.offset))
        for line in symmetry_elements(group).mirrors
    ]
    return np.array(rows, np.int64).reshape(-1, len(points)).T


def _left_of(corners: Complexes, line: Complexes) -> Complexes:
    """The part of a convex polygon to the left of a line (Sutherland and Hodgman 1974)."""
    chord = line[1] - line[0]
    left = ((corners - line[0]) * chord.conj()).imag / abs(chord)
    left[np.abs(left) <= NEAR * abs(chord)] = 0.0  # mirrors meet in corners
    found: list[complex] = []
    for k, (corner, here) in enumerate(zip(corners.tolist(), left.tolist(), strict=True)):
        after, there = complex(corners[(k + 1) % len(corners)]), float(left[(k + 1) % len(corners)])
        if here >= 0:
            found.append(corner)
        if here * there < 0:
            found.append(corner + (after - corner) * (here / (here - there)))
    return np.array(found)

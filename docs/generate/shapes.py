"""When two tiles have one shape: the same outline, moved and perhaps turned over."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from voronoi_tiles.vector.outline import Outline

Complexes = NDArray[np.complex128]

SAME = 1e-9
"""How far points may be apart that are one, beside the tile's extent. Outlines are right to 1e-12 of the cell."""


class Shape(NamedTuple):
    """An outline without its place: its edges, with straight ones that go on straight made one.

    `start`, `end`, `control` are complex128 (n,), the control point in the middle where `curved` (bool, n) is False.
    """

    start: Complexes
    control: Complexes
    end: Complexes
    curved: NDArray[np.bool_]

    @classmethod
    def of(cls, outline: Outline) -> Shape:
        """The shape of an outline."""
        rings = [
            _merged(outline, slice(first, last))
            for first, last in zip(outline.ring_offsets[:-1], outline.ring_offsets[1:], strict=True)
        ]
        return cls(*(np.concatenate(part) for part in zip(*rings, strict=True)))

    @property
    def mirrored(self) -> Shape:
        """The mirror image, run through the other way: the inside stays to the left."""
        return Shape(self.end.conj(), self.control.conj(), self.start.conj(), self.curved)

    @property
    def extent(self) -> float:
        """The diagonal of the box about all points."""
        points = np.concatenate((self.start, self.control))
        return abs(complex(np.ptp(points.real), np.ptp(points.imag)))


def congruent(one: Shape, other: Shape) -> bool:
    """Whether one shape lies on the other when it is moved and turned in the plane, but not turned over.

    The longest edge is laid on every edge of the other of its length and kind; then all points must meet points.
    """
    if one.curved.sum() != other.curved.sum() or len(one.start) != len(other.start):
        return False
    near = SAME * max(one.extent, other.extent)
    chord, others = one.end - one.start, other.end - other.start
    first = int(np.argmax(np.abs(chord)))
    alike = (np.abs(np.abs(others) - abs(chord[first])) <= near) & (other.curved == one.curved[first])
    corners, controls = _tree(other.start), _tree(other.control)
    for k in np.flatnonzero(alike).tolist():
        turn = others[k] / chord[first]
        turn /= abs(turn)
        moved = [turn * (points - one.start[first]) + other.start[k] for points in (one.start, one.control)]
        if max(_farthest(corners, moved[0]), _farthest(controls, moved[1])) <= near:
            return True
    return False


def _merged(outline: Outline, ring: slice) -> tuple[Complexes, Complexes, Complexes, NDArray[np.bool_]]:
    """One ring's edges, straight ones joined where they go on straight."""
    start, end, control, curved = outline.start[ring], outline.end[ring], outline.control[ring], outline.curved[ring]
    chord = end - start
    before = np.roll(chord, 1)
    turn = np.abs((chord * before.conj()).imag) / (np.abs(chord) * np.abs(before))
    on = ~curved & ~np.roll(curved, 1) & (turn <= SAME)
    kept = np.flatnonzero(~on)
    first = start[kept]
    last = np.roll(first, -1)
    return first, np.where(curved[kept], control[kept], (first + last) / 2), last, curved[kept]


def _tree(points: Complexes) -> cKDTree:
    """A tree to look up points in."""
    return cKDTree(np.column_stack((points.real, points.imag)))


def _farthest(tree: cKDTree, points: Complexes) -> float:
    """How far the farthest of the points is from the nearest in the tree."""
    return float(tree.query(np.column_stack((points.real, points.imag)))[0].max())

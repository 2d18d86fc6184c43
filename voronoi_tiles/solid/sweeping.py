"""Whether a solid that moves along a straight line meets another one, at whatever distance."""

from __future__ import annotations

from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.solid.mesh import TriangleMesh

CONTACT: Final = 1e-10
"""Solids that would be apart if one were moved aside by so much do not meet, they touch; relative to the size of the
one that moves. It is what rounding leaves of walls that slide along each other, a hundred thousand times over, and
far below what anybody prints."""

_AT_ONCE: Final = 1 << 14
"""So many pairs of triangles are compared at a time; a count."""

_PAIRS: Final = np.triu_indices(6, 1)
"""The pairs of the six lines that bound two triangles."""


class _SeenAlong(NamedTuple):
    """Triangles as seen along a direction: `corners` complex128 (n, 3), counter-clockwise in the plane across it.

    A point z of triangle k is `along[k] + Re(conj(slope[k]) (z - corners[k, 0]))` far along the direction; `nearest`
    and `farthest` are how far its corners are, all float64 (n,). `boxes` are float64 (n, 4): left, bottom, right, top.
    """

    corners: Complexes
    along: Floats
    slope: Complexes
    nearest: Floats
    farthest: Floats
    boxes: Floats

    def take(self, which: Ints | Bools) -> _SeenAlong:
        """Some of the triangles."""
        return _SeenAlong(
            self.corners[which],
            self.along[which],
            self.slope[which],
            self.nearest[which],
            self.farthest[which],
            self.boxes[which],
        )


class Sweeping:
    """A solid that moves along a direction, a unit vector, float64 (3,): from where it is to any distance."""

    def __init__(self, mesh: TriangleMesh, direction: Floats) -> None:
        self._axes = _axes(direction)
        self._contact = CONTACT * float(np.ptp(mesh.vertices, axis=0).max())
        self._back = self._seen(mesh, -1.0)
        self._low, self._high = self._back.boxes[:, :2].min(axis=0), self._back.boxes[:, 2:].max(axis=0)

    def meets(self, other: TriangleMesh) -> bool:
        """Whether it comes to overlap a solid, of which it may touch any part at the start.

        It does not where on every line along the direction all of the other is behind all of it: where no front of the
        other is ahead of a back of its own. That is so in the whole of the polygon that two triangles share as they are
        seen along the direction if it is at the corners.
        """
        front = self._seen(other, 1.0)
        near = (front.boxes[:, :2] < self._high).all(axis=1) & (front.boxes[:, 2:] > self._low).all(axis=1)
        front = front.take(near & (front.farthest > self._back.nearest.min() + self._contact))
        if not len(front.along):
            return False
        two, one = self._tree.query(shapely.box(*front.boxes.T))
        ahead = front.farthest[two] > self._back.nearest[one] + self._contact
        one, two = one[ahead], two[ahead]
        highest = _highest(self._back, front, one, two)
        one, two = one[highest > self._contact], two[highest > self._contact]
        for first, second, turned in ((self._back, front, False), (front, self._back, True)):
            i, j = (two, one) if turned else (one, two)
            apart = _apart(first.corners[i], second.corners[j], self._contact)
            one, two = one[~apart], two[~apart]
        return any(
            _ahead(self._back.take(one[k : k + _AT_ONCE]), front.take(two[k : k + _AT_ONCE]), self._contact)
            for k in range(0, len(one), _AT_ONCE)
        )

    @cached_property
    def _tree(self) -> shapely.STRtree:
        return shapely.STRtree(shapely.box(*self._back.boxes.T))

    def _seen(self, mesh: TriangleMesh, side: float) -> _SeenAlong:
        """The triangles of a mesh that face the direction, 1, or away from it, -1; without those seen edge-on."""
        points = mesh.vertices @ self._axes.T
        at, along = (points[:, 0] + 1j * points[:, 1])[mesh.triangles], points[:, 2][mesh.triangles]
        if side < 0.0:
            at, along = at[:, ::-1], along[:, ::-1]
        one, two = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
        twice = _cross(one, two)
        # Those with an inscribed circle of four contacts or less are seen edge-on, but for rounding.
        wide = twice > 4.0 * self._contact * (np.abs(one) + np.abs(two) + np.abs(two - one))
        at, along, one, two, twice = at[wide], along[wide], one[wide], two[wide], twice[wide]
        rise, climb = along[:, 1] - along[:, 0], along[:, 2] - along[:, 0]
        slope = 1j * (climb * one - rise * two) / twice
        x, y = at.real, at.imag
        boxes = np.stack((x.min(axis=1), y.min(axis=1), x.max(axis=1), y.max(axis=1)), axis=1)
        return _SeenAlong(at, along[:, 0], slope, along.min(axis=1), along.max(axis=1), boxes)


def _axes(direction: Floats) -> Floats:
    """Three unit vectors at right angles, the last the direction: float64 (3, 3), right-handed.

    Straight up or down, coordinates keep their bits.
    """
    x, y, z = direction.tolist()
    flat = np.hypot(x, y)
    if flat == 0.0:
        return np.diag([1.0, np.sign(z), np.sign(z)])
    across = np.array([-y, x, 0.0]) / flat
    return np.stack((across, np.cross(direction, across), direction))


def _highest(back: _SeenAlong, front: _SeenAlong, one: Ints, two: Ints) -> Floats:
    """No more than this is a front triangle ahead of a back one anywhere in the box that theirs share."""
    slope = front.slope[two] - back.slope[one]
    away = front.corners[two, 0] - back.corners[one, 0]
    base = front.along[two] - back.along[one] - (back.slope[one].conj() * away).real
    low = np.maximum(back.boxes[one, :2], front.boxes[two, :2])
    high = np.minimum(back.boxes[one, 2:], front.boxes[two, 2:])
    x, y = front.corners[two, 0].real, front.corners[two, 0].imag
    for part, k, at in ((slope.real, 0, x), (slope.imag, 1, y)):
        base = base + np.maximum(part * (low[:, k] - at), part * (high[:, k] - at))
    return np.asarray(base)


def _apart(first: Complexes, second: Complexes, contact: float) -> Bools:
    """Whether all of a triangle lies outside a side of another one, but for the contact; both complex128 (n, 3)."""
    found = np.zeros(len(first), np.bool_)
    for k in range(3):
        start, along = first[:, k], first[:, (k + 1) % 3] - first[:, k]
        inward = _cross(along[:, None], second - start[:, None]).max(axis=1)
        found |= inward <= contact * np.abs(along)
    return found


def _ahead(back: _SeenAlong, front: _SeenAlong, contact: float) -> bool:
    """Whether a front triangle is ahead of the back one of the same row in what they share, drawn in by the contact."""
    corners = np.concatenate((back.corners, front.corners), axis=1)
    sides = np.concatenate([np.roll(part.corners, -1, axis=1) - part.corners for part in (back, front)], axis=1)
    sides /= np.abs(sides)
    starts = corners + 1j * contact * sides
    one, two = _PAIRS
    sine = _cross(sides[:, one], sides[:, two])
    crossing = sine != 0.0
    share = _cross(starts[:, two] - starts[:, one], sides[:, two]) / np.where(crossing, sine, 1.0)
    at = starts[:, one] + share * sides[:, one]
    for k in range(6):
        crossing &= _cross(sides[:, k, None], at - starts[:, k, None]) >= -contact / 2
    one_along, two_along = (
        part.along[:, None] + (part.slope.conj()[:, None] * (at - part.corners[:, :1])).real for part in (back, front)
    )
    # What is moved aside along a slope is ahead by as much more.
    allowed = contact * (1.0 + np.abs(back.slope) + np.abs(front.slope))
    return bool((crossing & (two_along - one_along > allowed[:, None])).any())


def _cross(u: Complexes, v: Complexes) -> Floats:
    return np.asarray(u.real * v.imag - u.imag * v.real)

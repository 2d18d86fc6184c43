"""How far walls are, at levels and between, from where strokes have them: measured on finished meshes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.solid.approach import CopyPairs, copy_pairs
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.motion import Motion
from voronoi_tiles.solid.stroke_feet import StrokesInHeight, nearest_feet
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, composed
from voronoi_tiles.vector.motions import Action

_SHARES: Final = np.array([0.25, 0.5, 0.75])
"""Where between two levels it is looked; shares of the way up. Most walls are farthest off half way; beside events,
where an edge begins or ends, they are so nearer to these."""

_BESIDE: Final = 2.5
"""How far copies are looked for that may be beyond a wall: this times the farthest that a wall is from its strokes."""

_ALIKE: Final = 1.0
"""Where own strokes and a copy are seen in directions that differ by less, they are about as far off all around; a
difference of vectors of length 1. Else the wall is no farther off than twice the nearest one."""


class Deviation(NamedTuple):
    """How far walls are from the true ones between the levels `heights`, float64 (n + 1,), ascending.

    `off`, float64 (n,), is the most in each slab, a quarter, half and three quarters of the way up. All are in
    millimetres.
    """

    heights: Floats
    off: Floats

    @property
    def worst(self) -> float:
        """The most of all; not a number where one is none."""
        return float(np.max(self.off, initial=0.0))


class _SectionSides(NamedTuple):
    """The sides of a tile's sections between levels, from `start` to `end`, complex128 (n,).

    `section` (intp, n) is that of each, `before` (intp, n) the side that ends where it starts.
    """

    start: Complexes
    end: Complexes
    section: Ints
    before: Ints


class _Strokes(NamedTuple):
    """The strokes of all sites at the heights of sections, and the copies of them that may be beside a tile."""

    sites: tuple[StrokesInHeight, ...]
    action: Action
    copies: tuple[tuple[int, int], ...]

    def away(self, place: Complexes, section: Ints) -> tuple[Complexes, Ints]:
        """From the nearest point of a copy to each place, and the number of that copy."""
        feet, copy = nearest_feet(place, section, self.sites, self.action, self.copies)
        return place - feet, copy

    def away_from(self, place: Complexes, section: Ints, copy: Ints) -> Complexes:
        """From the nearest point of one copy each."""
        found = np.empty(len(place), np.complex128)
        for number in np.unique(copy).tolist():
            at = np.flatnonzero(copy == number)
            found[at], _ = self._replace(copies=(self.copies[number],)).away(place[at], section[at])
        return found


def deviation(
    meshes: Sequence[TriangleMesh], motion: Motion, action: Action, stabilizers: Sequence[tuple[int, ...]], unit: float
) -> Deviation:
    """The deviation of the solids of all sites; one unit of the design has `unit` millimetres.

    At the corners of sections, and in the middles of their sides, the distance from the own strokes and from those of
    the nearest copy are compared. By how fast their difference changes it is, to first order, known how far the true
    wall is. So it is where three tiles meet how far the true corner is, which may be more where it is sharp.
    """
    heights = np.unique(np.concatenate([mesh.vertices[:, 2] for mesh in meshes]))
    sections = (heights[:-1, None] * (1.0 - _SHARES) + heights[1:, None] * _SHARES).ravel()
    sides = [_sides(mesh, heights, unit) for mesh in meshes]
    places = [(part.start, part.section) for part in sides]
    off = np.zeros(len(sections))
    nearby = _nearby(places, motion, action, stabilizers, (sections / unit).tolist())
    for part, (own, beside) in zip(sides, nearby, strict=True):
        with np.errstate(divide="ignore", invalid="ignore"):  # a wall on a stroke is not a number off
            found = _off(part, own, beside)
        np.maximum.at(off, np.tile(part.section, 3), found * unit)
    return Deviation(heights, off.reshape(-1, len(_SHARES)).max(axis=1))


def equidistance(
    meshes: Sequence[TriangleMesh],
    motion: Motion,
    action: Action,
    stabilizers: Sequence[tuple[int, ...]],
    unit: float,
    levels: Sequence[float],
) -> float:
    """How far vertices at levels are from being as far from the own strokes as from the nearest copy's, at most.

    `levels` and the result are in the design's units, of which one has `unit` millimetres.
    """
    heights = np.array(levels) * unit
    places = []
    for mesh in meshes:
        level = np.searchsorted(heights, mesh.vertices[:, 2]).clip(max=len(heights) - 1)
        at = np.flatnonzero(heights[level] == mesh.vertices[:, 2])
        places.append(((mesh.vertices[at, 0] + 1j * mesh.vertices[at, 1]) / unit, level[at]))
    nearby = _nearby(places, motion, action, stabilizers, levels)
    off = [
        np.abs(_gap(own.away(*at)[0], beside.away(*at)[0])) for at, (own, beside) in zip(places, nearby, strict=True)
    ]
    return float(np.concatenate(off).max())


def _nearby(
    places: Sequence[tuple[Complexes, Ints]],
    motion: Motion,
    action: Action,
    stabilizers: Sequence[tuple[int, ...]],
    heights: Sequence[float],
) -> list[tuple[_Strokes, _Strokes]]:
    """For each tile its own strokes, and the copies that may be beside it, at heights in the design's units.

    `places` are on the walls of each, with the number of their height.
    """
    drawn = [motion.points(z) for z in heights]
    strokes = tuple(
        StrokesInHeight.of(np.stack([sites[k] for sites in drawn]), [line.shape[1] for line in site.lines])
        for k, site in enumerate(motion.moving)
    )
    mine = [_Strokes(strokes, action, ((k, IDENTITY_CODE),)) for k in range(len(places))]
    farthest = max(float(np.abs(own.away(*at)[0]).max()) for own, at in zip(mine, places, strict=True))
    pairs = copy_pairs(motion, action, stabilizers, heights, _BESIDE * farthest)
    return [(own, own._replace(copies=_distinct(pairs, k, stabilizers))) for k, own in enumerate(mine)]


def _distinct(pairs: CopyPairs, site: int, stabilizers: Sequence[tuple[int, ...]]) -> tuple[tuple[int, int], ...]:
    """The copies beside a site, each once, as numbers of sites and codes of motions."""
    found = set()
    for k in np.flatnonzero(pairs.site == site).tolist():
        other = int(pairs.other[k])
        found.add((other, int(composed(pairs.code[k], np.array(stabilizers[other])).min())))
    return tuple(sorted(found))


def _off(sides: _SectionSides, own: _Strokes, beside: _Strokes) -> Floats:
    """How far the starts of sides are from the true wall, then their middles, then the starts from true corners."""
    place, section = np.concatenate((sides.start, (sides.start + sides.end) / 2)), np.tile(sides.section, 2)
    away, (other, copy) = own.away(place, section)[0], beside.away(place, section)
    walls = np.abs(_gap(away, other)) / np.abs(_slope(away, other))
    # Within the tile the nearest copy need not have the nearest wall.
    unsure = np.flatnonzero((_gap(away, other) > 0.0) & (np.abs(_slope(away, other)) < _ALIKE))
    for number in range(len(beside.copies)):
        third = beside.away_from(place[unsure], section[unsure], np.full(len(unsure), number))
        off = _gap(away[unsure], third) / np.abs(_slope(away[unsure], third))
        nearer = unsure[off < walls[unsure]]
        walls[nearer], copy[nearer] = off[off < walls[unsure]], number
    # Of both feet one is in the tile: a wall lies on the way to that one, or to the other.
    walls = np.fmin(walls, np.maximum(np.abs(away), np.abs(other)))
    middle = copy[len(sides.start) :]
    before = middle[sides.before]
    at = np.flatnonzero(before != middle)
    start, own_away = sides.start[at], away[at]
    two, three = (beside.away_from(start, sides.section[at], which[at]) for which in (before, middle))
    to = _meeting(_slope(own_away, two), _gap(own_away, two), _slope(own_away, three), _gap(own_away, three))
    # Beyond the corner, as seen from both sides; elsewhere the sides say how far they are.
    back = sides.start[sides.before[at]] - start
    beyond = ((to * back.conj()).real < 0.0) & ((to * (sides.end[at] - start).conj()).real < 0.0)
    corners = np.zeros(len(sides.start))
    corners[at[beyond]] = np.abs(to[beyond])
    return np.concatenate((walls, corners))


def _gap(one: Complexes, two: Complexes) -> Floats:
    """By how much one of two places is farther than the other."""
    return np.asarray(np.abs(two) - np.abs(one))


def _slope(one: Complexes, two: Complexes) -> Complexes:
    """How that changes with the place: where to it shrinks fastest, and how fast."""
    return np.asarray(one / np.abs(one) - two / np.abs(two))


def _meeting(slope: Complexes, gap: Floats, other_slope: Complexes, other_gap: Floats) -> Complexes:
    """Where to both gaps are closed, not finite where there is no such place."""
    area = slope.real * other_slope.imag - slope.imag * other_slope.real
    x = (gap * other_slope.imag - other_gap * slope.imag) / area
    y = (other_gap * slope.real - gap * other_slope.real) / area
    return np.asarray(x + 1j * y)


def _sides(mesh: TriangleMesh, heights: Floats, unit: float) -> _SectionSides:
    """The sides of sections at _SHARES between levels, in the design's units."""
    level = np.searchsorted(heights, mesh.vertices[:, 2])
    corner = level[mesh.triangles]
    slab = corner.min(axis=1)
    wall = np.flatnonzero(slab < corner.max(axis=1))
    triangles, slab, over = mesh.triangles[wall], slab[wall], corner[wall] > slab[wall, None]
    ahead = np.roll(over, -1, axis=1)
    plane = (mesh.vertices[:, 0] + 1j * mesh.vertices[:, 1]) / unit
    every, count = np.arange(len(triangles)), len(mesh.vertices)
    ends, names = [], []
    # Seen from outside a triangle is crossed to the left of the side that rises, which the next one has falling.
    for side, turned in (((~over & ahead).argmax(axis=1), False), ((over & ~ahead).argmax(axis=1), True)):
        low, high = triangles[every, side], triangles[every, (side + 1) % 3]
        if turned:
            low, high = high, low
        ends.append((plane[low] * (1.0 - _SHARES[:, None]) + plane[high] * _SHARES[:, None]).ravel())
        names.append(low * count + high)
    (end, start), (rising, falling) = ends, names
    order = np.argsort(rising)
    place = np.searchsorted(rising[order], falling).clip(max=len(order) - 1)
    number = np.arange(len(_SHARES))[:, None]
    return _SectionSides(
        start, end, (len(_SHARES) * slab + number).ravel(), (order[place] + len(triangles) * number).ravel()
    )

"""How far walls are, half way between levels, from where strokes have them: measured on finished meshes."""

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

_BESIDE: Final = 2.5
"""How far copies are looked for that may be beyond a wall: this times the farthest that a wall is from its strokes."""


class Deviation(NamedTuple):
    """How far walls are from the true ones half way between the levels `heights`, float64 (n + 1,), ascending.

    `off`, float64 (n,), is the most in each slab between two of them. All are in millimetres.
    """

    heights: Floats
    off: Floats

    @property
    def worst(self) -> float:
        """The most of all; not a number where one is none."""
        return float(np.max(self.off, initial=0.0))


class _SectionSides(NamedTuple):
    """The sides of a tile's sections half way between levels, from `start` to `end`, complex128 (n,).

    `slab` (intp, n) is that of each, `before` (intp, n) the side that ends where it starts.
    """

    start: Complexes
    end: Complexes
    slab: Ints
    before: Ints


class _Strokes(NamedTuple):
    """The strokes of all sites half way between levels, and the copies of them that may be beside a tile."""

    sites: tuple[StrokesInHeight, ...]
    action: Action
    copies: tuple[tuple[int, int], ...]

    def away(self, place: Complexes, slab: Ints) -> tuple[Complexes, Ints]:
        """From the nearest point of a copy to each place, and the number of that copy."""
        feet, copy = nearest_feet(place, slab, self.sites, self.action, self.copies)
        return place - feet, copy

    def away_from(self, place: Complexes, slab: Ints, copy: Ints) -> Complexes:
        """From the nearest point of one copy each."""
        found = np.empty(len(place), np.complex128)
        for number in np.unique(copy).tolist():
            at = np.flatnonzero(copy == number)
            found[at], _ = self._replace(copies=(self.copies[number],)).away(place[at], slab[at])
        return found


def deviation(
    meshes: Sequence[TriangleMesh], motion: Motion, action: Action, stabilizers: Sequence[tuple[int, ...]], unit: float
) -> Deviation:
    """The deviation of the solids of all sites; one unit of the design has `unit` millimetres.

    At the corners of the section half way, and in the middles of its sides, the distance from the own strokes and from
    those of the nearest copy are compared. By how fast their difference changes it is, to first order, known how far
    the true wall is. So it is where three tiles meet how far the true corner is, which may be more where it is sharp.
    """
    heights = np.unique(np.concatenate([mesh.vertices[:, 2] for mesh in meshes]))
    middles = (heights[1:] + heights[:-1]) / 2
    drawn = [motion.points(z) for z in (middles / unit).tolist()]
    strokes = tuple(
        StrokesInHeight.of(np.stack([sites[k] for sites in drawn]), [line.shape[1] for line in site.lines])
        for k, site in enumerate(motion.moving)
    )
    sides = [_sides(mesh, heights, unit) for mesh in meshes]
    mine = [_Strokes(strokes, action, ((k, IDENTITY_CODE),)) for k in range(len(meshes))]
    farthest = max(
        float(np.abs(own.away(part.start, part.slab)[0]).max()) for own, part in zip(mine, sides, strict=True)
    )
    pairs = copy_pairs(motion, action, stabilizers, (heights / unit).tolist(), _BESIDE * farthest)
    off = np.zeros(len(middles))
    for k, (own, part) in enumerate(zip(mine, sides, strict=True)):
        beside = own._replace(copies=_distinct(pairs, k, stabilizers))
        with np.errstate(divide="ignore", invalid="ignore"):  # a wall on a stroke is not a number off
            found = _off(part, own, beside)
        np.maximum.at(off, np.tile(part.slab, 3), found * unit)
    return Deviation(heights, off)


def _distinct(pairs: CopyPairs, site: int, stabilizers: Sequence[tuple[int, ...]]) -> tuple[tuple[int, int], ...]:
    """The copies beside a site, each once, as numbers of sites and codes of motions."""
    found = set()
    for k in np.flatnonzero(pairs.site == site).tolist():
        other = int(pairs.other[k])
        found.add((other, int(composed(pairs.code[k], np.array(stabilizers[other])).min())))
    return tuple(sorted(found))


def _off(sides: _SectionSides, own: _Strokes, beside: _Strokes) -> Floats:
    """How far the starts of sides are from the true wall, then their middles, then the starts from true corners."""
    place, slab = np.concatenate((sides.start, (sides.start + sides.end) / 2)), np.tile(sides.slab, 2)
    away, (other, copy) = own.away(place, slab)[0], beside.away(place, slab)
    walls = np.abs(_gap(away, other)) / np.abs(_slope(away, other))
    middle = copy[len(sides.start) :]
    before = middle[sides.before]
    at = np.flatnonzero(before != middle)
    start, own_away = sides.start[at], away[at]
    two, three = (beside.away_from(start, sides.slab[at], which[at]) for which in (before, middle))
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
    """The sides of sections half way between levels, in the design's units."""
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
        a, b = triangles[every, side], triangles[every, (side + 1) % 3]
        ends.append((plane[a] + plane[b]) / 2)
        names.append(b * count + a if turned else a * count + b)
    (end, start), (rising, falling) = ends, names
    order = np.argsort(rising)
    place = np.searchsorted(rising[order], falling).clip(max=len(order) - 1)
    return _SectionSides(start, end, slab, order[place])

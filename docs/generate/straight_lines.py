"""Straight lines without an end among the edges of a tiling."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.groups.symmetry_elements import symmetry_elements
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.tiling import Tiling

Complexes = NDArray[np.complex128]

NEAR = 1e-9
"""What counts as nothing beside the cell's longer side. Edges are right to 1e-12 of it."""


class EndlessLine(NamedTuple):
    """All points x a + y b with q x - p y = offset (mod 1), for the shortest lattice vector p a + q b along it."""

    direction: tuple[int, int]
    offset: float


def endless_lines(tiling: Tiling) -> list[EndlessLine]:
    """The straight lines, up to translations of the lattice, every point of which lies on an edge.

    Such a line runs along a lattice vector: otherwise its translates would be dense, and edges are not. Per period it
    takes as much of the straight edges' length as the vector is long, which bounds the vectors to be tried.
    """
    lattice = tiling.design.lattice
    start, end = _straight_edges(tiling)
    # Every edge is there twice, once for either side.
    longest = float(np.abs(end - start).sum()) / 2
    return [
        EndlessLine((p, q), offset)
        for p, q in _primitive_vectors(lattice, longest * (1 + NEAR))
        for offset in _covered_offsets(lattice, p, q, start, end)
    ]


def mirror_lines(group: WallpaperGroup) -> list[EndlessLine]:
    """The mirrors of a group, up to translations of the lattice."""
    return [EndlessLine(line.direction, float(line.offset % 1)) for line in symmetry_elements(group).mirrors]


def same_line(one: EndlessLine, other: EndlessLine) -> bool:
    """Whether two lines are one, up to translations."""
    apart = abs(one.offset - other.offset) % 1
    return one.direction == other.direction and min(apart, 1 - apart) <= 1e-7


def _straight_edges(tiling: Tiling) -> tuple[Complexes, Complexes]:
    """The ends of all straight edges of all copies of one cell."""
    lattice = tiling.design.lattice
    motions = [lattice.isometry(operation) for operation in tiling.design.group.operations]
    ends = [
        (motion(tile.outline.start[~tile.outline.curved]), motion(tile.outline.end[~tile.outline.curved]))
        for tile in tiling.tiles
        for motion in motions
    ]
    start, end = (np.concatenate(part) for part in zip(*ends, strict=True))
    return start, end


def _primitive_vectors(lattice: Lattice, longest: float) -> list[tuple[int, int]]:
    """The integers p, q without a common divisor, p > 0 or (0, 1), whose p a + q b is at most so long."""
    reach_p = math.floor(longest * abs(lattice.b) / lattice.det)
    reach_q = math.floor(longest * abs(lattice.a) / lattice.det)
    p, q = (part.ravel() for part in np.meshgrid(np.arange(reach_p + 1), np.arange(-reach_q, reach_q + 1)))
    kept = (np.gcd(p, q) == 1) & ((p > 0) | (q == 1)) & (np.abs(p * lattice.a + q * lattice.b) <= longest)
    return list(zip(p[kept].tolist(), q[kept].tolist(), strict=True))


def _covered_offsets(lattice: Lattice, p: int, q: int, start: Complexes, end: Complexes) -> list[float]:
    """The offsets of the lines along p a + q b that edges cover from end to end."""
    along = p * lattice.a + q * lattice.b
    scale = max(abs(lattice.a), abs(lattice.b))
    chord = (end - start) / along
    parallel = (np.abs(chord.imag) * abs(along) <= NEAR * scale) & (np.abs(chord.real) * abs(along) > NEAR * scale)
    if float(np.abs(chord.real[parallel]).sum()) < 2 * (1 - NEAR):
        return []
    # The translation by i a + j b with q i - p j = 1 adds 1 to the offset.
    i = pow(q, -1, p) if p else 1
    j = (q * i - 1) // p if p else 0
    step = (i * lattice.a + j * lattice.b) / along
    x, y = lattice.fractional((start[parallel] + end[parallel]) / 2)
    offset = q * x - p * y
    middle = (((start + end)[parallel] / 2) / along).real
    half = np.abs(chord.real[parallel]) / 2
    order = np.argsort(offset % 1)
    near = NEAR * scale * abs(along) / lattice.det
    found = []
    # Classes of equal offsets, mod 1: the first gap is where the circle of offsets is cut open.
    turned = (offset % 1)[order]
    gaps = np.diff(turned, append=turned[0] + 1) > near
    if not gaps.any():
        return []
    order = np.roll(order, -1 - int(np.flatnonzero(gaps)[0]))
    begins = np.flatnonzero(np.roll(gaps, -int(np.flatnonzero(gaps)[0])))
    for rows in np.split(order, begins[1:]):
        whole = np.round(offset[rows] - offset[rows[0]])
        place = middle[rows] - whole * step.real
        if _covers_circle(place - half[rows], place + half[rows], 1e-7):
            found.append(float(offset[rows[0]] % 1))
    return found


def _covers_circle(low: NDArray[np.float64], high: NDArray[np.float64], near: float) -> bool:
    """Whether intervals cover the numbers mod 1, but for gaps of a length that is nothing."""
    first = low.min()
    begin, length = (low - first) % 1, high - low
    begin = np.where(begin > 1 - near, begin - 1, begin)
    begin, end = (np.concatenate(part) for part in ((begin, begin + 1), (begin + length, begin + 1 + length)))
    order = np.argsort(begin)
    reached = np.maximum.accumulate(end[order])
    within = begin[order] < 1
    return bool(np.all(begin[order][1:][within[1:]] <= reached[:-1][within[1:]] + near)) and bool(
        reached[within][-1] >= 1 - near
    )

"""Paths of curves for tests, and the distances between them by dense samples."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from helpers.sheets import xy
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths
from voronoi_tiles.paths.smooth_runs import SmoothRuns

Points = tuple[complex, ...]


def chain(*pieces: Points, closed: bool = False) -> Paths:
    """One path of lines (2 points), quadratic (3) and cubic (4) curves."""
    kind = [{2: LINE, 3: QUAD, 4: CUBIC}[len(piece)] for piece in pieces]
    control = [[*piece[1:-1], 0j, 0j][:2] for piece in pieces]
    return Paths(
        start=np.array([piece[0] for piece in pieces]),
        end=np.array([piece[-1] for piece in pieces]),
        control=np.array(control),
        kind=np.array(kind, np.uint8),
        offsets=np.array([0, len(pieces)]),
        closed=np.array([closed]),
    )


def arc(start: complex, middle: complex, end: complex) -> Paths:
    """One path of one ARC."""
    return replace(chain((start, middle, end)), kind=np.array([ARC], np.uint8))


def smooth_side(seed: int, count: int, size: float) -> Paths:
    """A side of a tile: quadratic curves that join smoothly, of different sizes and bends."""
    rng = np.random.default_rng(seed)
    angles = np.cumsum(rng.uniform(-0.3, 0.3, count + 1))
    at, pieces = 0j, []
    for before, after in pairwise(np.exp(1j * angles).tolist()):
        near, far = rng.uniform(0.05, 1.0, 2) * size
        pieces.append((at, at + near * before, at + near * before + far * after))
        at = pieces[-1][2]
    return chain(*pieces)


def sampled(paths: Paths, step: float) -> Complexes:
    """Points of all pieces, at most about `step` apart; straight from the definitions of the kinds."""
    found = []
    for a, b, (c, d), kind in zip(paths.start, paths.end, paths.control, paths.kind, strict=True):
        legs = {LINE: [a, b], QUAD: [a, c, b], CUBIC: [a, c, d, b], ARC: [a, c, b]}[int(kind)]
        count = 8 + math.ceil(sum(abs(q - p) for p, q in pairwise(legs)) / step)
        t = np.linspace(0.0, 1.0, count)
        if kind == ARC:
            found.append(circular(a, c, b, t))
            continue
        points = [np.full(count, p) for p in legs]
        while len(points) > 1:
            points = [p * (1 - t) + q * t for p, q in pairwise(points)]
        found.append(points[0])
    return np.concatenate(found)


def circular(a: complex, c: complex, b: complex, t: np.ndarray) -> np.ndarray:
    """Points of the arc from a over c to b, from its circle's centre by the perpendicular bisectors."""
    u, v = c - a, b - a
    area = 2 * (u.conjugate() * v).imag
    if abs(area) <= 1e-12 * abs(u) * abs(v):
        return a + v * t
    centre = a + 1j * (v * abs(u) ** 2 - u * abs(v) ** 2) / -area
    turn = np.angle((b - centre) / (a - centre))
    if turn * area < 0:
        turn += math.copysign(2 * math.pi, area)
    return centre + (a - centre) * np.exp(1j * turn * t)


def distance(one: Paths, other: Paths, step: float) -> float:
    """The Hausdorff distance of two paths both ways, by dense samples; at most curvature * step^2 / 8 wrong."""
    assert len(one) == len(other) == 1
    p, q = sampled(one, step), sampled(other, step)
    return max(farthest(p, q), farthest(q, p))


def farthest(points: Complexes, line: Complexes) -> float:
    """The largest distance of points from a line: from the segments at the two corners that are nearest."""
    _, corners = cKDTree(xy(line)).query(xy(points), k=2)
    first = np.clip(np.hstack((corners - 1, corners)), 0, len(line) - 2)
    start, along = line[first], line[first + 1] - line[first]
    length = np.where(along == 0, 1, np.abs(along) ** 2)
    share = np.clip((along.conj() * (points[:, None] - start)).real / length, 0.0, 1.0)
    return float(np.abs(points[:, None] - start - share * along).min(axis=1).max())


def same(one: Paths, other: Paths) -> bool:
    """Whether two sets of paths have the same bits."""
    return all(
        np.array_equal(getattr(one, name), getattr(other, name))
        for name in ("start", "end", "control", "kind", "offsets", "closed")
    )


def assert_joined(paths: Paths) -> None:
    """Pieces follow one another bit for bit; closed paths close."""
    for k in range(len(paths)):
        piece = slice(paths.offsets[k], paths.offsets[k + 1])
        start, end = paths.start[piece], paths.end[piece]
        assert np.array_equal(start[1:], end[:-1])
        if paths.closed[k] and len(start):
            assert start[0] == end[-1]


def runs_of(paths: Paths) -> SmoothRuns:
    """The one run that the quadratic curves of a path are."""
    p0, p1, p2 = paths.start, paths.control[:, 0], paths.end
    c = np.stack((p0, (p1 - p0) * (2 / 3), (p0 - 2 * p1 + p2) / 3, 0 * p0))
    return SmoothRuns.of_segments(c.real.copy(), c.imag.copy(), np.array([0, len(p0)]))

"""Points of curves themselves, not of their chords: by their parameters, and the nearest to other points."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.paths.paths import ARC, CUBIC, QUAD, Paths
from voronoi_tiles.preflight.chord_distance import cross, dot, foot_share
from voronoi_tiles.preflight.chords import Chords

_STEPS: Final = 5
"""Steps to the nearest point of a curve; a count. Each leaves, of what it is off by, the distance over the radius."""

_FLAT: Final = 1e-12
"""Arcs that turn by less are lines; radians."""


class CurvePoints(NamedTuple):
    """Points of curves and the derivatives there, complex128 (n,) each."""

    point: Complexes
    way: Complexes


def at_parameter(paths: Paths, piece: Ints, t: Floats) -> CurvePoints:
    """The points of pieces at their parameters, from 0 to 1; an arc's goes with the angle."""
    a, d, (b, c) = paths.start[piece], paths.end[piece], paths.control[piece].T
    s = 1.0 - t
    point, way = a * s + d * t, d - a
    kind = paths.kind[piece]
    some = np.flatnonzero(kind == QUAD)
    p, q, r, u, v = a[some], b[some], d[some], s[some], t[some]
    point[some], way[some] = p * u * u + 2 * q * u * v + r * v * v, 2 * ((q - p) * u + (r - q) * v)
    some = np.flatnonzero(kind == CUBIC)
    p, q, r, e, u, v = a[some], b[some], c[some], d[some], s[some], t[some]
    point[some] = p * u**3 + 3 * q * u * u * v + 3 * r * u * v * v + e * v**3
    way[some] = 3 * ((q - p) * u * u + 2 * (r - q) * u * v + (e - r) * v * v)
    some = np.flatnonzero(kind == ARC)
    if len(some):
        _, turn = paths.arc_radius_and_turn(piece[some])
        some, turn = some[np.abs(turn) > _FLAT], turn[np.abs(turn) > _FLAT]
        centre = (a[some] + d[some]) / 2 + 0.5j * (d[some] - a[some]) / np.tan(turn / 2)
        out = (a[some] - centre) * np.exp(1j * turn * t[some])
        point[some], way[some] = centre + out, 1j * turn * out
    return CurvePoints(point, way)


def tangents(paths: Paths) -> tuple[Complexes, Complexes]:
    """The directions in which the pieces of paths begin and end, of any length."""
    every = np.arange(len(paths.start))
    found = []
    # Where a control point lies on the end the curve shows its way a little further on.
    for end, inner in ((0.0, 1e-6), (1.0, 1.0 - 1e-6)):
        way, nearly = (at_parameter(paths, every, np.full(len(every), t)).way for t in (end, inner))
        found.append(np.where(way == 0, nearly, way))
    return found[0], found[1]


def signed_distances(paths: Paths, chords: Chords, points: Complexes, own: Ints, chord: Ints) -> Floats:
    """How far points lie from the curves near chords, > 0 to the left of these; the chords' neighbours count as well.

    A neighbour on the point's `own` piece does not: next to a cusp the curve before it is no other one.
    """
    before = np.where(chord > chords.first[chords.path[chord]], chord - 1, chord)
    after = chords.next(chord)
    best, result = np.full(len(points), np.inf), np.zeros(len(points))
    for near in (chord, before, np.where(after < 0, chord, after)):
        piece, t = chords.on_pieces(near, foot_share(points, chords.start[near], chords.end[near]))
        for _ in range(_STEPS):
            there = at_parameter(paths, piece, t)
            speed = dot(there.way, there.way)
            t = np.clip(t - dot(there.point - points, there.way) / np.where(speed > 0, speed, 1.0), 0.0, 1.0)
        there = at_parameter(paths, piece, t)
        away = np.abs(points - there.point)
        nearer = (away < best) & ((piece != own) | (near == chord))
        best = np.where(nearer, away, best)
        result = np.where(nearer, np.copysign(away, cross(there.way, points - there.point)), result)
    return result

"""The raw offset of rings: every piece moved sideways and corners joined, before self-overlaps are removed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.components import components
from voronoi_tiles.paths.paths import ARC, LINE, Kinds, Paths
from voronoi_tiles.paths.segments import Circles, point_at, tangent_at

Join = Literal["round", "mitre"]

_CUSP: Final = 1e-6
"""A corner that turns by less than this short of half a circle is a cusp, whose side its curvatures tell; radians."""


@dataclass(frozen=True, eq=False)
class RawOffset:
    """Pieces at a distance from rings, in no order; overlaps and dead ends among them.

    `paths` has every piece as a path of its own. Piece k runs from the node `tail[k]` to the node `head[k]` (intp),
    whose places are `nodes` (complex128), with the bits of the piece's ends. It comes from the region's piece
    `source[k]`, or where `joins[k]`, from the corner at that piece's end. `mitred[k]` is set on both lines of a mitre.
    """

    paths: Paths
    tail: Ints
    head: Ints
    nodes: Complexes
    source: Ints
    joins: Bools
    mitred: Bools


def next_pieces(region: Paths) -> Ints:
    """The piece that follows each piece on its ring."""
    following = np.arange(1, len(region.start) + 1)
    following[region.offsets[1:] - 1] = region.offsets[:-1]
    return following


def raw_offset(
    region: Paths, distance: float, tolerance: float, *, join: Join, mitre_limit: float, plain: Bools
) -> RawOffset:
    """The raw offset of closed rings of LINEs and ARCs by `distance`, > 0 to the right.

    A piece that would run backwards is left out: none of its points is at the distance from the whole region. A corner
    is taken as none where that moves no point by more than `tolerance`. A mitre longer than `mitre_limit` times the
    distance is rounded, and so are the corners at the ends of the pieces flagged in `plain`.
    """
    n = len(region.start)
    pieces, following = np.arange(n), next_pieces(region)
    circles = Circles.of(region, pieces)
    right = [-1j * tangent_at(region, pieces, np.full(n, t)) for t in (0.0, 0.5, 1.0)]
    begin, end = region.start + distance * right[0], region.end + distance * right[2]
    factor = 1 + distance * circles.curvature
    length = np.abs(factor) * np.abs(circles.chord)
    # The direction of a short piece is known to the rounding over its length; it moves the offset's ends.
    point = length <= tolerance * (1 + abs(distance) / np.maximum(np.abs(circles.chord), tolerance) / 16)
    turned = (factor < 0) & ~point
    # A piece of no length, or one that runs back so little that its neighbours' crossing cannot be told from it.
    with np.errstate(divide="ignore"):
        flat = length**2 / np.maximum(np.abs(factor / circles.curvature), tolerance) <= tolerance
    point |= turned & (length * np.abs(2 * circles.half) <= tolerance) & flat
    present = ~point & ~turned

    angle = _corner_angles(right[2], right[0][following], circles.curvature, circles.curvature[following])
    shift = np.abs(distance * angle)
    reach = np.abs(distance * angle**2)
    bent = np.maximum(*(np.abs(circles.curvature / np.where(factor == 0, 1.0, factor))[k] for k in (pieces, following)))
    smooth = (shift <= tolerance) | ((reach <= tolerance) & (shift**2 * bent <= 2 * tolerance))
    opening = (angle * distance > 0) & ~smooth

    nodes = np.stack((begin, end), axis=1).ravel()
    one = np.concatenate((2 * pieces[point], 2 * pieces[smooth] + 1))
    name = components(2 * n, one, np.concatenate((2 * pieces[point] + 1, 2 * following[smooth])))
    nodes = _means(nodes, name)[name]
    rounded, mitres = _corner_kinds(opening, angle, plain, join, mitre_limit)
    kept = pieces[present]
    offset = _open(nodes[2 * kept], nodes[2 * kept + 1], _middles(region, kept, distance, right[1]), region.kind[kept])
    corner = region.end[rounded] + distance * right[2][rounded] * np.exp(0.5j * angle[rounded])
    tail, head = 2 * rounded + 1, 2 * following[rounded]
    round_ = _open(nodes[tail], nodes[head], corner, np.full(len(rounded), ARC, np.uint8))
    half = angle[mitres] / 2
    tips = region.end[mitres] + distance / np.cos(half) * right[2][mitres] * np.exp(1j * half)
    tip = 2 * n + np.arange(len(mitres))
    lines = Paths.concatenate(
        [_line(nodes[2 * mitres + 1], tips), _line(tips, nodes[2 * following[mitres]])],
    )
    return RawOffset(
        paths=straightened(Paths.concatenate([offset, round_, lines]), tolerance / 64),
        tail=np.concatenate((name[2 * kept], name[tail], name[2 * mitres + 1], tip)),
        head=np.concatenate((name[2 * kept + 1], name[head], tip, name[2 * following[mitres]])),
        nodes=np.concatenate((nodes, tips)),
        source=np.concatenate((kept, rounded, mitres, mitres)),
        joins=np.repeat([False, True], [len(kept), len(rounded) + 2 * len(mitres)]),
        mitred=np.repeat([False, True], [len(kept) + len(rounded), 2 * len(mitres)]),
    )


def straightened(paths: Paths, tolerance: float) -> Paths:
    """The same paths, with ARCs that leave their chord by less than `tolerance` as LINEs, and those of no length."""
    sagitta = np.abs(paths.control[:, 0] - (paths.start + paths.end) / 2)
    flat = (paths.kind == ARC) & ((sagitta <= tolerance) | (paths.start == paths.end))
    return Paths(
        start=paths.start,
        end=paths.end,
        control=np.where(flat[:, None], 0, paths.control),
        kind=np.where(flat, LINE, paths.kind).astype(np.uint8),
        offsets=paths.offsets,
        closed=paths.closed,
    )


def _corner_angles(before: Complexes, after: Complexes, bend_before: Floats, bend_after: Floats) -> Floats:
    """How far each corner turns to the left, from the normals of its sides; in (-pi, pi], radians.

    At a cusp the inside is between the two curves where the one that arrives is on the left of the one that leaves.
    """
    angle = np.angle(after * before.conj())
    cusp = np.abs(angle) > np.pi - _CUSP
    return np.where(cusp, np.where(bend_before + bend_after <= 0, np.abs(angle), -np.abs(angle)), angle)


def _corner_kinds(opening: Bools, angle: Floats, plain: Bools, join: Join, mitre_limit: float) -> tuple[Ints, Ints]:
    """The corners to be rounded, and those to be mitred."""
    pointed = opening & ~plain & (np.cos(angle / 2) * mitre_limit >= 1) if join == "mitre" else np.zeros_like(opening)
    return np.flatnonzero(opening & ~pointed), np.flatnonzero(pointed)


def _middles(region: Paths, pieces: Ints, distance: float, right: Complexes) -> Complexes:
    middle = point_at(region, pieces, np.full(len(pieces), 0.5)) + distance * right[pieces]
    return np.where(region.kind[pieces] == ARC, middle, 0)


def _open(start: Complexes, end: Complexes, middle: Complexes, kind: Kinds) -> Paths:
    n = len(start)
    control = np.stack((middle, np.zeros(n)), axis=1).astype(np.complex128)
    return Paths(start, end, control, kind, np.arange(n + 1), np.zeros(n, np.bool_))


def _line(start: Complexes, end: Complexes) -> Paths:
    return _open(start, end, np.zeros(len(start), np.complex128), np.full(len(start), LINE, np.uint8))


def _means(values: Complexes, name: Ints) -> Complexes:
    """The mean of the values of one name, at the place of the name."""
    total = np.bincount(name, values.real, len(values)) + 1j * np.bincount(name, values.imag, len(values))
    return np.asarray(total / np.maximum(np.bincount(name, minlength=len(values)), 1), np.complex128)

"""One period of a tessellation: its vertices, its sides and its tiles, each once, that all copies are made from.

A side is a run of arcs between two vertices at which three or more arcs meet. It belongs to the two tiles beside it,
and is one object: what is cut from it is cut once, and what approximates it is the same for both.

Everything is named by integers, which come from the exact motions that place every point (`shared.py`). So which tiles
share a side, and where sides meet, is known without a tolerance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, ranges
from voronoi_tiles.base.maps import move
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.paths.paths import LINE, QUAD, Paths
from voronoi_tiles.vector.complex.representatives import Points
from voronoi_tiles.vector.complex.shared import SharedOutline
from voronoi_tiles.vector.motions import Motion, compose, reverses_orientation
from voronoi_tiles.vector.tessellation import Tessellation


@dataclass(frozen=True, eq=False)
class Rings:
    """The rings of tiles as runs through sides.

    Entry k of a ring is side `side[k]`, moved by the lattice vector `step[k]` (intp, n x 2) from where it stands in the
    period, run through from its start to its end where `forward[k]`. The entries of ring r are those from `offsets[r]`
    up to, not including, `offsets[r + 1]`; the rings of tile c those from `tiles[c]` up to `tiles[c + 1]`. `place`
    names the run within its tile: copies of one tile have the same.
    """

    side: Ints
    step: Ints
    forward: Bools
    place: Ints
    offsets: Ints
    tiles: Ints


@dataclass(frozen=True, eq=False)
class Period:
    """The tiles of one cell, with their sides.

    `basis` are the two lattice vectors, complex128 (2,). `vertex` (complex128, v) are the points where sides meet;
    the sides' curves `sides` (one path each, in the same order) start at `vertex[start]` and end at
    `vertex[end]` moved by the lattice vector `reach` (intp, s x 2). `site` (intp, c) is the site of each tile and
    `motion` what takes the tile of that site there. Outer rings run counter-clockwise and come first, holes clockwise.
    """

    basis: Complexes
    vertex: Complexes
    start: Ints
    end: Ints
    reach: Ints
    sides: Paths
    site: Ints
    motion: tuple[Motion, ...]
    rings: Rings

    def placed(self, factor: complex, shift: complex) -> Period:
        """The image under z -> factor z + shift."""
        return replace(
            self,
            basis=move(self.basis, factor, 0j),
            vertex=move(self.vertex, factor, shift),
            sides=self.sides.moved(factor, shift),
        )

    @property
    def lattice(self) -> Lattice:
        """The lattice of the basis."""
        return Lattice(*self.basis.tolist())

    def at(self, points: Complexes, steps: Ints) -> Complexes:
        """Points of the period moved by lattice vectors (n x 2): the same bits for the same point and vector."""
        return points + self.shifts(steps)

    def shifts(self, steps: Ints) -> Complexes:
        """Lattice vectors (n x 2) as vectors of the plane."""
        a, b = self.basis.tolist()
        i, j = steps[:, 0].astype(np.float64), steps[:, 1].astype(np.float64)
        image = np.empty(len(steps), np.complex128)
        image.real = i * a.real + j * b.real
        image.imag = i * a.imag + j * b.imag
        return image

    def steps_in(self, left: float, bottom: float, right: float, top: float) -> Ints:
        """The lattice vectors (n x 2) to the points of an upright rectangle, and to some near it."""
        corners = np.array([complex(x, y) for x in (left, right) for y in (bottom, top)])
        i, j = (
            np.arange(np.floor(along.min()), np.ceil(along.max()) + 1, dtype=np.intp)
            for along in self.lattice.fractional(corners)
        )
        return np.stack(np.meshgrid(i, j), axis=-1).reshape(-1, 2)

    def curves(self, side: Ints, step: Ints, forward: Bools | None = None) -> Paths:
        """The curves of sides moved by lattice vectors, one path each; those that are not `forward`, backwards.

        Where sides meet, their ends are the same bits.
        """
        paths = self.sides.take(side)
        paths = paths.shifted(self.shifts(step)[paths.owner])
        paths.start[paths.offsets[:-1]] = self.at(self.vertex[self.start[side]], step)
        paths.end[paths.offsets[1:] - 1] = self.at(self.vertex[self.end[side]], step + self.reach[side])
        return paths if forward is None else paths.reversed(~forward)

    def outlines(self, tile: Ints, step: Ints) -> tuple[Paths, Ints]:
        """The rings of tiles moved by lattice vectors, closed paths; and where each tile's rings begin (k + 1)."""
        rings, entries, counts = self._expand(tile)
        ring_counts = self.rings.tiles[tile + 1] - self.rings.tiles[tile]
        by_entry = np.repeat(np.repeat(step, ring_counts, axis=0), counts, axis=0)
        curves = self.curves(self.rings.side[entries], self.rings.step[entries] + by_entry, self.rings.forward[entries])
        sizes = np.append(0, np.cumsum(curves.counts))
        bounds = np.append(0, np.cumsum(counts))
        paths = Paths(
            start=curves.start,
            end=curves.end,
            control=curves.control,
            kind=curves.kind,
            offsets=sizes[bounds].astype(np.intp),
            closed=np.ones(len(rings), np.bool_),
        )
        return paths, np.append(0, np.cumsum(ring_counts)).astype(np.intp)

    @cached_property
    def own_outlines(self) -> tuple[Paths, Ints]:
        """The rings of all tiles where they stand in the period, as `outlines` gives them."""
        everything = np.arange(len(self.site))
        return self.outlines(everything, np.zeros((len(everything), 2), np.intp))

    def borders(self, tile: Ints, step: Ints) -> tuple[Ints, Ints, Ints, Bools]:
        """The sides around tiles moved by lattice vectors: index into `tile`, side, its lattice vector, forward."""
        _, entries, counts = self._expand(tile)
        ring_counts = self.rings.tiles[tile + 1] - self.rings.tiles[tile]
        owner = np.repeat(np.repeat(np.arange(len(tile)), ring_counts), counts)
        return owner, self.rings.side[entries], self.rings.step[entries] + step[owner], self.rings.forward[entries]

    def _expand(self, tile: Ints) -> tuple[Ints, Ints, Ints]:
        """The rings of tiles, the entries of these, and how many entries each ring has."""
        rings = ranges(self.rings.tiles[tile], self.rings.tiles[tile + 1] - self.rings.tiles[tile])
        counts = np.diff(self.rings.offsets)[rings]
        return rings, ranges(self.rings.offsets[rings], counts), counts


def make_period(tessellation: Tessellation) -> Period:
    """Collect one period of a tessellation."""
    numbers = _Numbers()
    loops = [
        _loop(numbers, tessellation, site, motion)
        for site, placed in enumerate(tessellation.placed)
        for motion in placed.representatives
    ]
    return _assemble(tessellation, numbers, loops)


class _Numbers:
    """Numbers the linear parts and half translations of motions: what is left of a motion modulo the lattice."""

    def __init__(self) -> None:
        self.of: dict[Motion, int] = {}
        self.motions: list[Motion] = []

    def split(self, motion: Motion) -> tuple[int, int, int]:
        """The number of a motion modulo the lattice, and the lattice vector that is left."""
        i, j = motion[4] // 2, motion[5] // 2
        rest = (*motion[:4], motion[4] - 2 * i, motion[5] - 2 * j)
        number = self.of.setdefault(rest, len(self.motions))
        if number == len(self.motions):
            self.motions.append(rest)
        return number, i, j


@dataclass(frozen=True, slots=True)
class _Loop:
    """The arcs of one tile, ring after ring, counter-clockwise around it.

    A point is a row: representative, number of its motion, lattice vector. `control` has -1 for lines. `place` is each
    arc's index in the base tile's outline.
    """

    site: int
    motion: Motion
    start: Ints
    end: Ints
    control: Ints
    place: Ints
    offsets: Ints


def _loop(numbers: _Numbers, tessellation: Tessellation, site: int, motion: Motion) -> _Loop:
    shared = tessellation.shared[site]
    start = _rows(numbers, shared, shared.start.moved(motion))
    control = np.full((len(start), 4), -1)
    curved = np.flatnonzero(shared.control.index >= 0)
    if len(curved):
        control[curved] = _rows(numbers, shared, shared.control.moved(motion).take(curved))
    offsets = shared.ring_offsets
    following = np.arange(1, len(start) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    end = start[following]
    order = np.arange(len(start))
    if reverses_orientation(motion):
        order = (offsets[:-1] + offsets[1:] - 1)[np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))] - order
        start, end = end, start
    return _Loop(site, motion, start[order], end[order], control[order], order, offsets)


def _rows(numbers: _Numbers, shared: SharedOutline, points: Points) -> Ints:
    """Name points: representative, number of the motion, lattice vector (n x 4)."""
    table = np.array([numbers.split(motion) for motion in points.motions])
    rows = np.column_stack((points.index, table[points.motion]))
    special = shared.representatives.stabilizer
    for k in np.flatnonzero(np.isin(points.index, list(special))).tolist():
        motion = points.motions[points.motion[k]]
        rows[k, 1:] = numbers.split(min(compose(motion, s) for s in special[int(points.index[k])]))
    return rows


def _identify(loops: Sequence[_Loop]) -> tuple[Ints, Bools]:
    """Number the arcs of all loops: an arc and its reverse, seen from the tile beyond, are one.

    Returns each one's number, and whether it runs as the first that was met.
    """
    start, end, control = (
        np.concatenate([getattr(loop, name) for loop in loops]) for name in ("start", "end", "control")
    )
    straight = control[:, 0] < 0

    def rows(first: Ints, last: Ints) -> Ints:
        middle = control.copy()
        middle[:, 2:] -= first[:, 2:]
        middle[straight] = -1
        return np.column_stack((first[:, :2], last[:, :2], last[:, 2:] - first[:, 2:], middle))

    both = np.concatenate((rows(start, end), rows(end, start)))
    _, number = np.unique(both, axis=0, return_inverse=True)
    here, back = np.split(number.reshape(-1), 2)
    _, first, arcs, counts = np.unique(
        np.minimum(here, back), return_index=True, return_inverse=True, return_counts=True
    )
    arcs = arcs.reshape(-1)
    assert (counts == 2).all(), "an arc lies between two tiles"
    return np.asarray(arcs, np.intp), here == here[first][arcs]


@dataclass(frozen=True, slots=True)
class _ArcRuns:
    """The runs of arcs between vertices where three or more meet, ring after ring; a ring without such is one run.

    `first` and `count` say which of the arcs in `order` they are; `key` is the smallest number among them, at which
    each run decides on its direction: `forward`. `ring` is the ring of each run.
    """

    order: Ints
    first: Ints
    count: Ints
    ring: Ints
    key: Ints
    forward: Bools
    place: Ints


def _assemble(tessellation: Tessellation, numbers: _Numbers, loops: Sequence[_Loop]) -> Period:
    """Join the arcs to sides, and describe the tiles by them."""
    arcs, forward = _identify(loops)
    start, end, control, place = (
        np.concatenate([getattr(loop, name) for loop in loops]) for name in ("start", "end", "control", "place")
    )
    _, vertex = np.unique(start[:, :2], axis=0, return_inverse=True)
    runs = _runs(loops, arcs, forward, place, vertex.reshape(-1))
    first, last = runs.order[runs.first], runs.order[runs.first + runs.count - 1]
    # A side stands where its start has the lattice vector 0; a run backwards ends there.
    step = np.where(runs.forward[:, None], start[first, 2:], end[last, 2:])
    keys, side = np.unique(runs.key, return_inverse=True)
    side = np.asarray(side.reshape(-1), np.intp)
    own = np.zeros(len(keys), np.intp)
    own[side[runs.forward]] = np.flatnonzero(runs.forward)
    action = tessellation.action
    basis = np.array([action.lattice.a, action.lattice.b])
    position = tessellation.shared[0].representatives.position

    def located(rows: Ints, shift: Ints) -> Complexes:
        """Return points, moved back by lattice vectors."""
        result = np.empty(len(rows), np.complex128)
        for number in np.unique(rows[:, 1]).tolist():
            chosen = rows[:, 1] == number
            result[chosen] = action.apply(numbers.motions[number], position[rows[chosen, 0]])
        return np.asarray(result + (rows[:, 2:] - shift) @ basis, np.complex128)

    counts = runs.count[own]
    pieces = runs.order[ranges(runs.first[own], counts)]
    shift = np.repeat(step[own], counts, axis=0)
    curved = control[pieces, 0] >= 0
    controls = np.zeros((len(pieces), 2), np.complex128)
    controls[curved, 0] = located(control[pieces[curved]], shift[curved])
    sides = Paths(
        start=located(start[pieces], shift),
        end=located(end[pieces], shift),
        control=controls,
        kind=np.where(curved, QUAD, LINE).astype(np.uint8),
        offsets=np.append(0, np.cumsum(counts)).astype(np.intp),
        closed=np.zeros(len(own), np.bool_),
    )
    # Of the vertices within sides nobody asks again.
    corners = np.concatenate((start[first[own], :2], end[last[own], :2]))
    corners, corner_of = np.unique(corners, axis=0, return_inverse=True)
    start_corner, end_corner = np.split(np.asarray(corner_of.reshape(-1), np.intp), 2)
    ring_counts = [len(loop.offsets) - 1 for loop in loops]
    return Period(
        basis=basis,
        vertex=located(np.column_stack((corners, 0 * corners)), 0 * corners),
        start=start_corner,
        end=end_corner,
        reach=end[last[own], 2:] - step[own],
        sides=sides,
        site=np.array([loop.site for loop in loops]),
        motion=tuple(loop.motion for loop in loops),
        rings=Rings(
            side=side,
            step=step,
            forward=runs.forward,
            place=runs.place,
            offsets=np.append(0, np.cumsum(np.bincount(runs.ring))).astype(np.intp),
            tiles=np.append(0, np.cumsum(ring_counts)).astype(np.intp),
        ),
    )


def _runs(loops: Sequence[_Loop], arcs: Ints, forward: Bools, place: Ints, vertex: Ints) -> _ArcRuns:
    """Cut the rings of all loops into runs."""
    # Every arc starts at one of its ends in one tile, and at the other in the tile beyond: starts count all ends.
    opens = np.bincount(vertex)[vertex] != 2
    order, first, ring = [], [], []
    at = rings = length = 0
    for loop in loops:
        for begin, stop in zip(loop.offsets[:-1].tolist(), loop.offsets[1:].tolist(), strict=True):
            members = np.arange(at + begin, at + stop)
            starts = np.flatnonzero(opens[members])
            if len(starts):
                members = np.roll(members, -int(starts[0]))
                starts = starts - starts[0]
            else:
                # Both tiles begin such a ring at one vertex: where its smallest arc starts, run forwards.
                least = int(arcs[members].argmin())
                members = np.roll(members, -least if forward[members[least]] else -least - 1)
                starts = np.zeros(1, np.intp)
            order.append(members)
            first.append(starts + length)
            ring.append(np.full(len(starts), rings))
            length += len(members)
            rings += 1
        at += len(loop.start)
    members = np.concatenate(order)
    opening = np.concatenate(first)
    numbers = arcs[members]
    key = np.minimum.reduceat(numbers, opening)
    count = np.diff(np.append(opening, len(members)))
    # The arc that a run is named by; in a closed one it may be met twice, then the first decides.
    deciding = np.flatnonzero(numbers == np.repeat(key, count))
    deciding = deciding[np.searchsorted(deciding, opening)]
    return _ArcRuns(
        order=members,
        first=opening,
        count=count,
        ring=np.concatenate(ring),
        key=key,
        forward=forward[members[deciding]],
        place=np.minimum.reduceat(place[members], opening),
    )

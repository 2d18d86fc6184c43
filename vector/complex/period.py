"""One period of a tessellation: its vertices, its edges and its tiles, each once, that all copies are made from.

An edge belongs to the two tiles beside it, and is one object: what is cut from it is cut once, and what approximates it
is the same for both. Everything is named by integers, which come from the exact motions of the quotient complex. So
which tiles share an edge, and where edges meet, is known without a tolerance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges
from voronoi_tiles.base.maps import move
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.paths.paths import LINE, QUAD, Paths
from voronoi_tiles.paths.segments import item_boxes
from voronoi_tiles.vector.complex.quotient import EdgeUse, Quotient
from voronoi_tiles.vector.complex.representatives import Points, Representatives
from voronoi_tiles.vector.copies import Placed
from voronoi_tiles.vector.motion_codes import code_of, motion_of
from voronoi_tiles.vector.motions import Action, Motion, compose, reverses_orientation, split, translated


@dataclass(frozen=True, eq=False)
class Rings:
    """The rings of tiles as walks along edges.

    Entry k of a ring is edge `edge[k]`, moved by the lattice vector `step[k]` (intp, n x 2) from where it stands in the
    period, run through from its start to its end where `forward[k]`. The entries of ring r are those from `offsets[r]`
    up to, not including, `offsets[r + 1]`; the rings of tile c those from `tiles[c]` up to `tiles[c + 1]`.
    """

    edge: Ints
    step: Ints
    forward: Bools
    offsets: Ints
    tiles: Ints


@dataclass(frozen=True, eq=False)
class Period:
    """The tiles of one cell, with their edges.

    `basis` are the two lattice vectors, complex128 (2,). `vertex` (complex128, v) are the points where edges meet;
    the edges' curves `edges` (one path each, in the same order) start at `vertex[start]` and end at
    `vertex[end]` moved by the lattice vector `reach` (intp, s x 2). Edge k is the image of edge `orbit[k]` (intp) of
    the quotient complex under `edge_motion[k]`. `site` (intp, c) is the site of each tile and `motion` what takes the
    tile of that site there. Outer rings run counter-clockwise and come first, holes clockwise.
    """

    basis: Complexes
    vertex: Complexes
    start: Ints
    end: Ints
    reach: Ints
    edges: Paths
    orbit: Ints
    edge_motion: tuple[Motion, ...]
    site: Ints
    motion: tuple[Motion, ...]
    rings: Rings

    def placed(self, factor: complex, shift: complex) -> Period:
        """The image under z -> factor z + shift."""
        return replace(
            self,
            basis=move(self.basis, factor, 0j),
            vertex=move(self.vertex, factor, shift),
            edges=self.edges.moved(factor, shift),
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

    def curves(self, edge: Ints, step: Ints, forward: Bools | None = None) -> Paths:
        """The curves of edges moved by lattice vectors, one path each; those that are not `forward`, backwards.

        Where edges meet, their ends are the same bits.
        """
        paths = self.edges.take(edge)
        paths = paths.shifted(self.shifts(step)[paths.owner])
        paths.start[paths.offsets[:-1]] = self.at(self.vertex[self.start[edge]], step)
        paths.end[paths.offsets[1:] - 1] = self.at(self.vertex[self.end[edge]], step + self.reach[edge])
        return paths if forward is None else paths.reversed(~forward)

    def outlines(self, tile: Ints, step: Ints) -> tuple[Paths, Ints]:
        """The rings of tiles moved by lattice vectors, closed paths; and where each tile's rings begin (k + 1)."""
        rings, entries, counts = self._expand(tile)
        ring_counts = self.rings.tiles[tile + 1] - self.rings.tiles[tile]
        by_entry = np.repeat(np.repeat(step, ring_counts, axis=0), counts, axis=0)
        curves = self.curves(self.rings.edge[entries], self.rings.step[entries] + by_entry, self.rings.forward[entries])
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

    @cached_property
    def own_boxes(self) -> Floats:
        """The boxes around all tiles where they stand in the period: least x, y, greatest x, y, float64 (c, 4)."""
        return item_boxes(*self.own_outlines)

    def borders(self, tile: Ints, step: Ints) -> tuple[Ints, Ints, Ints, Bools]:
        """The edges around tiles moved by lattice vectors: index into `tile`, edge, its lattice vector, forward."""
        _, entries, counts = self._expand(tile)
        ring_counts = self.rings.tiles[tile + 1] - self.rings.tiles[tile]
        owner = np.repeat(np.repeat(np.arange(len(tile)), ring_counts), counts)
        return owner, self.rings.edge[entries], self.rings.step[entries] + step[owner], self.rings.forward[entries]

    def _expand(self, tile: Ints) -> tuple[Ints, Ints, Ints]:
        """The rings of tiles, the entries of these, and how many entries each ring has."""
        rings = ranges(self.rings.tiles[tile], self.rings.tiles[tile + 1] - self.rings.tiles[tile])
        counts = np.diff(self.rings.offsets)[rings]
        return rings, ranges(self.rings.offsets[rings], counts), counts


def make_period(action: Action, placed: Sequence[Placed], quotient: Quotient) -> Period:
    """One period of the tessellation by the placed sites, of which `quotient` is the complex."""
    collector = _Collector(quotient)
    motions = [(site, motion) for site, base in enumerate(placed) for motion in base.representatives]
    rings = collector.rings(motions)
    points = _Located(action, quotient.representatives)
    vertices = [points.name(quotient.edges[orbit].vertex.moved(code_of(motion))) for orbit, motion in collector.edges]
    controls = [points.name(quotient.edges[orbit].control.moved(code_of(motion))) for orbit, motion in collector.edges]
    counts = np.array([len(rows) for rows in controls])
    # An edge stands where its start has the lattice vector 0.
    home = np.array([rows[0, 2:] for rows in vertices])
    shift = np.repeat(home, counts, axis=0)
    control = np.concatenate(controls)
    curved = control[:, 0] >= 0
    bent = np.zeros((len(control), 2), np.complex128)
    bent[curved, 0] = points.locate(control[curved], shift[curved])
    # Of the vertices within edges nobody asks again.
    ends = np.array([rows[[0, -1]] for rows in vertices]).reshape(-1, 4)
    corners, corner = np.unique(ends[:, :2], axis=0, return_inverse=True)
    start, end = np.asarray(corner.reshape(-1, 2).T, np.intp)
    return Period(
        basis=np.array([action.lattice.a, action.lattice.b]),
        vertex=points.locate(np.column_stack((corners, 0 * corners)), 0 * corners),
        start=start,
        end=end,
        reach=ends[1::2, 2:] - home,
        edges=Paths(
            start=points.locate(np.concatenate([rows[:-1] for rows in vertices]), shift),
            end=points.locate(np.concatenate([rows[1:] for rows in vertices]), shift),
            control=bent,
            kind=np.where(curved, QUAD, LINE).astype(np.uint8),
            offsets=np.append(0, np.cumsum(counts)).astype(np.intp),
            closed=np.zeros(len(counts), np.bool_),
        ),
        orbit=np.array([orbit for orbit, _ in collector.edges]),
        edge_motion=tuple(
            translated(motion, -i, -j) for (_, motion), (i, j) in zip(collector.edges, home.tolist(), strict=True)
        ),
        site=np.array([site for site, _ in motions]),
        motion=tuple(motion for _, motion in motions),
        rings=replace(rings, step=rings.step + home[rings.edge]),
    )


class _Collector:
    """Numbers the edges of a period: the cosets of their stabilizers, modulo the lattice.

    `edges` are the orbit of each and the motion that names it, of those that lead there the least modulo the lattice.
    """

    def __init__(self, quotient: Quotient) -> None:
        self.quotient = quotient
        self.edges: list[tuple[int, Motion]] = []
        self._number: dict[tuple[int, Motion], int] = {}

    def rings(self, tiles: Sequence[tuple[int, Motion]]) -> Rings:
        """The rings of tiles, each the image of a site's base tile under a motion; new edges of them get numbers."""
        entries: list[tuple[int, int, int, bool]] = []
        offsets, bounds = [0], [0]
        for site, motion in tiles:
            over = reverses_orientation(motion)
            boundary = self.quotient.boundaries[site]
            for ring in boundary:
                entries += [self._entry(use, motion) for use in (ring[::-1] if over else ring)]
                offsets.append(len(entries))
            bounds.append(bounds[-1] + len(boundary))
        edge, i, j, forward = zip(*entries, strict=True)
        return Rings(
            edge=np.array(edge),
            step=np.column_stack((i, j)),
            forward=np.array(forward),
            offsets=np.array(offsets),
            tiles=np.array(bounds),
        )

    def _entry(self, use: EdgeUse, outer: Motion) -> tuple[int, int, int, bool]:
        """The image of a use of an edge: number of the edge, lattice vector, whether it runs forward."""
        here = compose(outer, use.motion)
        rest, i, j, flips = min(
            (*split(compose(here, motion)), flips) for motion, flips in self.quotient.edges[use.edge].stabilizer
        )
        number = self._number.setdefault((use.edge, rest), len(self.edges))
        if number == len(self.edges):
            self.edges.append((use.edge, rest))
        return number, i, j, use.backwards == (flips != reverses_orientation(outer))


class _Located:
    """Names points by integers: representative, number of the motion modulo the lattice, lattice vector."""

    def __init__(self, action: Action, representatives: Representatives) -> None:
        self.action = action
        self.representatives = representatives
        self.motions: list[Motion] = []
        self._number: dict[Motion, int] = {}

    def name(self, points: Points) -> Ints:
        """The names of points, intp (n, 4); the first of the four is -1 where there is no point."""
        motions = self.representatives.canonical(points)
        table = {code: self._row(motion_of(code)) for code in dict.fromkeys(motions.tolist())}
        distinct, motion = np.unique(motions, return_inverse=True)
        rows = np.array([table[code] for code in distinct.tolist()])
        return np.column_stack((points.index, rows[motion]))

    def _row(self, motion: Motion) -> tuple[int, int, int]:
        """The number of a motion modulo the lattice, and its lattice vector."""
        rest, i, j = split(motion)
        number = self._number.setdefault(rest, len(self.motions))
        if number == len(self.motions):
            self.motions.append(rest)
        return number, i, j

    def locate(self, rows: Ints, shift: Ints) -> Complexes:
        """The positions of named points, moved back by lattice vectors (n, 2)."""
        basis = np.array([self.action.lattice.a, self.action.lattice.b])
        result = np.empty(len(rows), np.complex128)
        for number in np.unique(rows[:, 1]).tolist():
            chosen = rows[:, 1] == number
            result[chosen] = self.action.apply(self.motions[number], self.representatives.position[rows[chosen, 0]])
        return np.asarray(result + (rows[:, 2:] - shift) @ basis, np.complex128)

"""The boundaries of base tiles, put together from the edges of the quotient complex, and their outlines."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from voronoi_tiles.base.arrays import (
    Bools,
    Complexes,
    Ints,
    backwards,
    counting,
    counts_of,
    next_in_ring,
    offsets_of,
    ranges,
)
from voronoi_tiles.base.kernels import COMPLEXES, INT, INTS, kernel
from voronoi_tiles.vector.arcs import Neighbour
from voronoi_tiles.vector.complex.quotient import Quotient
from voronoi_tiles.vector.complex.representatives import OF_REPRESENTATIVES, Points, Representatives
from voronoi_tiles.vector.complex.site_symmetry import SiteSymmetry
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, Codes, code_of, images, inverted, reversing
from voronoi_tiles.vector.motions import Motion, reverses_orientation
from voronoi_tiles.vector.outline import Outline

# What the compiled kernels take, as in boundary.c.
_GIVEN = INT, INTS, INTS, INTS, INTS, *OF_REPRESENTATIVES, INT, INTS
_ARCS = kernel("complex_arcs", *_GIVEN, COMPLEXES, COMPLEXES, INT, INT, INT, *[COMPLEXES] * 5)
_COUNTERPARTS = kernel("complex_counterparts", *_GIVEN, INT, INTS, INTS, INT, INTS, INTS, INT, COMPLEXES)


@dataclass(frozen=True, eq=False, slots=True)
class TileBoundaries:
    """The boundaries of tiles, n arcs in r rings, tile after tile, as images of representatives.

    An arc starts at one of the n points `start` and ends where the next of its ring starts; `control` are the control
    points of the arcs as quadratic Bezier curves, none for a line. `focus` (complex128, n) and `directrix` (complex128,
    n x 2) are those of the parabolas before the motions that take the control points to their places. The arcs of edge
    k are those from `use_offsets[k]` up to, not including, `use_offsets[k + 1]` (intp, m + 1), those of ring k from
    `ring_offsets[k]` up to `ring_offsets[k + 1]` (intp, r + 1), the rings of tile t those from `tile_offsets[t]` up to
    `tile_offsets[t + 1]`.

    Beyond an arc lies the copy of the site `site[face[k]]` under the motion `motion[face[k]]`: the faces of tile t
    are those from `face_offsets[t]` up to `face_offsets[t + 1]`.
    """

    representatives: Representatives
    start: Points
    control: Points
    focus: Complexes
    directrix: Complexes
    use_offsets: Ints
    ring_offsets: Ints
    tile_offsets: Ints
    face: Ints
    site: Ints
    motion: Codes
    face_offsets: Ints

    @classmethod
    def of(cls, quotient: Quotient) -> TileBoundaries:
        """The boundaries of all base tiles."""
        uses = quotient.uses
        counts = counts_of(quotient.offsets)[uses.edge]
        place, use = counting(counts)
        edge, back = uses.edge[use], uses.backwards[use]
        # Run through backwards, arc k starts where it ends else: at vertex k + 1.
        arc = quotient.offsets[edge] + np.where(back, counts[use] - 1 - place, place)
        start = arc + edge + back
        by = uses.motion[use]
        use_offsets = offsets_of(counts)
        tiles = np.arange(len(uses.tile_offsets))
        tile = tiles[:-1].repeat(counts_of(uses.ring_offsets[uses.tile_offsets]))
        face, numbers = _numbered(tile, uses.site, uses.beyond)
        beside, site, beyond = np.array([*zip(*numbers, strict=True)])
        return cls(
            representatives=quotient.representatives,
            start=quotient.vertex.take(start).moved(by),
            control=quotient.control.take(arc).moved(by),
            focus=quotient.focus[arc],
            directrix=np.ascontiguousarray(quotient.directrix[arc]),
            use_offsets=use_offsets,
            ring_offsets=use_offsets[uses.ring_offsets],
            tile_offsets=uses.tile_offsets,
            face=face[use],
            site=site,
            motion=beyond,
            face_offsets=beside.searchsorted(tiles),
        )

    def of_tile(self, tile: int) -> TileBoundaries:
        """The boundary of one of the tiles."""
        rings = slice(self.tile_offsets[tile], self.tile_offsets[tile + 1] + 1)
        ring_offsets = self.ring_offsets[rings]
        arcs = slice(ring_offsets[0], ring_offsets[-1])
        faces = slice(self.face_offsets[tile], self.face_offsets[tile + 1])
        uses = slice(*(np.searchsorted(self.use_offsets, ring_offsets[[0, -1]]) + np.array([0, 1])))
        return TileBoundaries(
            representatives=self.representatives,
            start=self.start.take(arcs),
            control=self.control.take(arcs),
            focus=self.focus[arcs],
            directrix=self.directrix[arcs],
            use_offsets=self.use_offsets[uses] - ring_offsets[0],
            ring_offsets=ring_offsets - ring_offsets[0],
            tile_offsets=np.array([0, len(ring_offsets) - 1]),
            face=self.face[arcs] - faces.start,
            site=self.site[faces],
            motion=self.motion[faces],
            face_offsets=np.array([0, faces.stop - faces.start]),
        )

    def outlines(self, motion: Motion, neighbours: Sequence[tuple[Neighbour, ...]]) -> list[Outline]:
        """The outlines of the tiles' images under a motion.

        `neighbours` names for each tile the copies that are then beyond its faces.
        """
        # Its translation may be longer than codes hold.
        turn, offsets = code_of((*motion[:4], 0, 0)), self.ring_offsets
        curved = self.control.index >= 0
        compiled = _ARCS()
        place = self._arcs if compiled is None else partial(self._arcs_compiled, compiled)
        start, control, end, focus, directrix = place(turn, (motion[4], motion[5]), curved)
        face = self.face - self.face_offsets[:-1].repeat(counts_of(offsets[self.tile_offsets]))
        if reverses_orientation(motion):
            # A motion that turns the plane over turns the rings round: run through each backwards.
            order = backwards(offsets)
            start, control, end = end[order], control[order], start[order]
            curved, focus, directrix, face = curved[order], focus[order], directrix[order], face[order]
        bounds = self.tile_offsets.tolist()
        found = []
        for tile, names in enumerate(neighbours):
            rings = offsets[bounds[tile] : bounds[tile + 1] + 1]
            first, last = rings[[0, -1]].tolist()
            arcs = slice(first, last)
            found.append(
                Outline(
                    start=start[arcs],
                    control=control[arcs],
                    end=end[arcs],
                    curved=curved[arcs],
                    focus=focus[arcs],
                    directrix=directrix[arcs],
                    neighbour=face[arcs],
                    neighbours=names,
                    ring_offsets=rings - first,
                )
            )
        return found

    def counterparts(self, symmetry: SiteSymmetry) -> tuple[Complexes, Complexes, Complexes]:
        """Of each arc the one that the tile beyond has there: start, control and end, complex128 (n,), reversed.

        Each tile beyond is asked for what it faces itself where it lies at the place of its site, and that is moved to
        where it is beyond. NaN where such a tile has no edge there, or one of another number of arcs. The control point
        of a line is that of a quadratic Bezier curve, the middle.
        """
        partner, compiled = self._partners(symmetry), _COUNTERPARTS()
        result = np.full((3, len(self.face)), np.nan + 0j)
        if compiled is None:
            self._match(partner, result)
        elif compiled(
            *(*self._given, len(self.use_offsets) - 1, self.use_offsets, self.face),
            *(len(partner), self.motion, partner, IDENTITY_CODE, result),
        ):
            raise MemoryError
        return result[0], result[1], result[2]

    def _match(self, partner: Ints, result: Complexes) -> None:
        """Write the counterparts of arcs into three rows, by the faces that are `partner` of others.

        A compiled kernel gives the same bits.
        """
        # The edges of each face, and `there` those that come from beyond, whose arcs are put in the order of ours.
        first, sizes = self.use_offsets[:-1], self.use_offsets[1:] - self.use_offsets[:-1]
        of = self.face[first]
        begin = offsets_of(np.bincount(of, minlength=len(partner)))
        counts = np.where(partner >= 0, (begin[1:] - begin[:-1])[partner], 0)
        there = of.argsort(kind="stable")[ranges(begin[partner], counts)]
        face = np.arange(len(partner)).repeat(counts)
        size = sizes[there]
        place, edge = counting(size)
        by = self.motion[face][edge]
        turned = reversing(by)
        arc = first[there][edge] + np.where(turned, place, size[edge] - 1 - place)
        # Edges are told apart by their face, their ends, and their first arc. All points are located at once.
        following, points, control = next_in_ring(self.ring_offsets), self.start.and_then(self.control), len(self.face)
        ours = points.take(np.concatenate((first, following[first + sizes - 1], following[first], control + first)))
        theirs = points.take(np.concatenate((arc, following[arc], control + arc))).moved(np.concatenate((by, by, by)))
        places = self.representatives.locate(ours.and_then(theirs))
        one, two, over = places[len(ours) :].reshape(3, -1)
        low, high = np.where(turned, one, two), np.where(turned, two, one)
        at = offsets_of(size)
        here = np.lexsort((*places[: len(ours)].reshape(4, -1)[::-1], of))
        order = np.lexsort((over[at[:-1]], high[at[:-1]], high[at[1:] - 1], low[at[:-1]], face))
        bounds, of = offsets_of(counts), of[here]
        row = np.arange(len(here)) + (bounds - begin)[of]
        matched = row < bounds[of + 1]
        use, edge = here[matched], order[row[matched]]
        same = sizes[use] == size[edge]
        use, edge = use[same], edge[same]
        over = np.where(self.control.index[arc] >= 0, over, (one + two) / 2)
        result[:, ranges(first[use], sizes[use])] = np.array((low, over, high))[:, ranges(at[edge], sizes[use])]

    def _partners(self, symmetry: SiteSymmetry) -> Ints:
        """Of each face that of the tile beyond, at the place of its site, which faces this one; -1 where none does."""
        tile = np.arange(len(self.face_offsets) - 1).repeat(counts_of(self.face_offsets))
        back = symmetry.canonical(tile, inverted(self.motion))
        _, numbers = _numbered(tile, self.site, self.motion)
        asked = zip(self.site.tolist(), tile.tolist(), back.tolist(), strict=True)
        return np.array([numbers.get(face, -1) for face in asked])

    def _arcs(self, turn: int, further: tuple[int, int], curved: Bools) -> tuple[Complexes, ...]:
        """Starts, control points, ends, foci and directrices of all arcs under a motion, as an `Outline` has them.

        `further` is twice a translation that comes after the motion. A compiled kernel gives the same bits.
        """
        count, points = len(self.face), self.start.and_then(self.control)
        if turn != IDENTITY_CODE:
            points = points.moved(turn)
        start, control = self.representatives.position[points.index].reshape(2, count)
        canonical, by = self.representatives.canonical(points), points.motion[count:]
        motion = np.array((canonical[:count], canonical[count:], by, by, by))
        before = np.array((start, control, self.focus, *self.directrix.T))
        located = images(self.representatives.action, motion, before, further)
        located[1:, ~curved] = 0.0
        start, control, focus, first, second = located
        end = start[next_in_ring(self.ring_offsets)]
        return start, np.where(curved, control, (start + end) / 2), end, focus, np.array((first, second)).T

    def _arcs_compiled(
        self, compiled: Callable[..., int], turn: int, further: tuple[int, int], curved: Bools
    ) -> tuple[Complexes, ...]:
        """The same by the compiled kernel."""
        count = len(curved)
        start, control, end, focus = (np.empty(count, complex) for _ in range(4))
        arcs = start, control, end, focus, np.empty((count, 2), complex)
        compiled(*self._given, self.focus, self.directrix, turn, *further, *arcs)
        return arcs

    @property
    def _given(self) -> tuple[Any, ...]:
        """What compiled kernels take of boundaries."""
        points = self.start.index, self.start.motion, self.control.index, self.control.motion
        return len(self.face), *points, *self.representatives.given, len(self.ring_offsets) - 1, self.ring_offsets


def _numbered(*columns: Ints) -> tuple[Ints, dict[tuple[int, ...], int]]:
    """Numbers for rows, in the order in which they appear, equal ones for equal rows; and those of all rows."""
    numbers: dict[tuple[int, ...], int] = {}
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return np.array([numbers.setdefault(row, len(numbers)) for row in rows]), numbers

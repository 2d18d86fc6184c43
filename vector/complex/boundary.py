"""The boundary of a base tile, put together from the edges of the quotient complex, and its outline."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, backwards, next_in_ring
from voronoi_tiles.vector.arcs import Neighbour
from voronoi_tiles.vector.complex.quotient import Quotient
from voronoi_tiles.vector.complex.representatives import Points, Representatives
from voronoi_tiles.vector.motions import Motion, reverses_orientation
from voronoi_tiles.vector.outline import Outline


@dataclass(frozen=True, eq=False, slots=True)
class TileBoundary:
    """The boundary of a tile, n arcs in r rings.

    Attributes:
        representatives: of all tiles.
        start: (n,) where each arc starts; it ends where the next of its ring starts.
        control: (n,) of the quadratic Bezier; its index is -1 for a line.
        focus: (n,) and directrix: (n, 2), of the representative arc, to be moved as the control point.
        ring_offsets: (r + 1,) the arcs of ring k are ring_offsets[k] to ring_offsets[k + 1].
        beyond: (n,) into `neighbours`: site and motion of the copy beyond each arc.
    """

    representatives: Representatives
    start: Points
    control: Points
    focus: Complexes
    directrix: Complexes
    ring_offsets: Ints
    beyond: Ints
    neighbours: tuple[tuple[int, Motion], ...]

    @classmethod
    def of(cls, quotient: Quotient, tile: int) -> TileBoundary:
        """The boundary of the base tile of a site."""
        start, control, focus, directrix = [], [], [], []
        beyond, counts = [], []
        faces: dict[tuple[int, Motion], int] = {}
        for ring in quotient.boundaries[tile]:
            for use in ring:
                edge = quotient.edges[use.edge]
                count = len(edge.focus)
                order = np.arange(count)[:: -1 if use.backwards else 1]
                start.append(edge.vertex.moved(use.motion).take(order + use.backwards))
                control.append(edge.control.moved(use.motion).take(order))
                focus.append(edge.focus[order])
                directrix.append(edge.directrix[order])
                beyond.append(np.full(count, faces.setdefault(use.beyond, len(faces))))
            counts.append(sum(len(quotient.edges[use.edge].focus) for use in ring))
        return cls(
            representatives=quotient.representatives,
            start=Points.concatenate(start),
            control=Points.concatenate(control),
            focus=np.concatenate(focus),
            directrix=np.concatenate(directrix),
            ring_offsets=np.append(0, np.cumsum(counts)),
            beyond=np.concatenate(beyond),
            neighbours=tuple(faces),
        )

    def outline(self, motion: Motion, neighbours: tuple[Neighbour, ...]) -> Outline:
        """The outline of the image under a motion; `neighbours` names the copies that are then beyond its arcs."""
        action = self.representatives.action
        start = self.representatives.locate(self.start.moved(motion))
        offsets = self.ring_offsets
        end = start[next_in_ring(offsets)]
        curved = self.control.index >= 0
        control = (start + end) / 2
        focus, directrix = np.zeros(len(start), complex), np.zeros((len(start), 2), complex)
        points = self.control.moved(motion).take(np.flatnonzero(curved))
        control[curved] = self.representatives.locate(points)
        for number, by in enumerate(points.motions):
            chosen = np.flatnonzero(curved)[points.motion == number]
            focus[chosen] = action.apply(by, self.focus[chosen])
            directrix[chosen] = action.apply(by, self.directrix[chosen])
        # A motion that turns the plane over turns the rings round: run through each backwards.
        order = np.arange(len(start))
        if reverses_orientation(motion):
            order = backwards(offsets)
            start, end = end, start
        return Outline(
            start=start[order],
            control=control[order],
            end=end[order],
            curved=curved[order],
            focus=focus[order],
            directrix=directrix[order],
            neighbour=self.beyond[order],
            neighbours=neighbours,
            ring_offsets=offsets,
        )

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
    """The boundary of a tile, n arcs in r rings, as images of representatives.

    An arc starts at one of the n points `start` and ends where the next of its ring starts; `control` are the control
    points of the arcs as quadratic Bezier curves, none for a line. `focus` (complex128, n) and `directrix` (complex128,
    n x 2) are those of the parabolas before the motions that take the control points to their places. The arcs of ring
    k are those from `ring_offsets[k]` up to, not including, `ring_offsets[k + 1]` (intp, r + 1). Beyond an arc lies the
    copy of the site and under the motion `neighbours[beyond[k]]` (`beyond`: intp, n).
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
        rings = quotient.boundaries[tile]
        start, control, focus, directrix, beyond = [], [], [], [], []
        number: dict[tuple[int, Motion], int] = {}
        for use in (use for ring in rings for use in ring):
            edge = quotient.edges[use.edge]
            order = np.arange(len(edge))[:: -1 if use.backwards else 1]
            # Run through backwards, arc k starts where it ends else: at vertex k + 1.
            start.append(edge.vertex.moved(use.motion).take(order + use.backwards))
            control.append(edge.control.moved(use.motion).take(order))
            focus.append(edge.focus[order])
            directrix.append(edge.directrix[order])
            beyond.append(np.full(len(edge), number.setdefault(use.beyond, len(number))))
        counts = [sum(len(quotient.edges[use.edge]) for use in ring) for ring in rings]
        return cls(
            representatives=quotient.representatives,
            start=Points.concatenate(start),
            control=Points.concatenate(control),
            focus=np.concatenate(focus),
            directrix=np.concatenate(directrix),
            ring_offsets=np.append(0, np.cumsum(counts)),
            beyond=np.concatenate(beyond),
            neighbours=tuple(number),
        )

    def outline(self, motion: Motion, neighbours: tuple[Neighbour, ...]) -> Outline:
        """The outline of the image under a motion; `neighbours` names the copies that are then beyond its arcs."""
        action = self.representatives.action
        start = self.representatives.locate(self.start.moved(motion))
        offsets = self.ring_offsets
        end = start[next_in_ring(offsets)]
        points = self.control.moved(motion)
        curved = points.index >= 0
        control = np.where(curved, self.representatives.locate(points), (start + end) / 2)
        parabola = np.column_stack((self.focus, self.directrix))
        parabola[~curved] = 0
        for number, by in enumerate(points.motions):
            chosen = np.flatnonzero(curved & (points.motion == number))
            parabola[chosen] = action.apply(by, parabola[chosen])
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
            focus=parabola[order, 0],
            directrix=parabola[order, 1:],
            neighbour=self.beyond[order],
            neighbours=neighbours,
            ring_offsets=offsets,
        )

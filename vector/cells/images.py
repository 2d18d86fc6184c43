"""The half-edges and corners of a site's copies, as seen from the site whose cells are sought."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.maps import move
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.copies import Copies


@dataclass(frozen=True, slots=True)
class Surroundings:
    """The half-edges and corners of all copies of a site, the face on the left of each.

    A copy that is turned over has its half-edges run through backwards. `own` says whether copy 0 is the site whose
    rows are looked at; the site has `segments` segments, and twice as many half-edges.

    `node` (complex128, copies x m) are positions. A half-edge runs from the node `start` to the node `end` (intp,
    copies x h) in the direction of the unit vector `direction` (complex128, copies x h). A corner lies at the node
    `corner` (intp, c) and has the angle `turn` (float64, c) of the site's own; where `bounding` (bool, c) it counts
    among the elements that bound other cells. `arriving` and `leaving` (complex128, copies x c) are the unit vectors
    of the half-edges before and after it.
    """

    own: bool
    segments: int
    node: Complexes
    start: Ints
    end: Ints
    direction: Complexes
    corner: Ints
    turn: Floats
    bounding: Bools
    arriving: Complexes
    leaving: Complexes


def surround(contour: Contour, copies: Copies, *, own: bool) -> Surroundings:
    """All copies of a contour; `own` where the first of them is the site whose rows are looked at."""
    unit, shift, conj = copies.unit[:, None], copies.shift[:, None], copies.conj[:, None]
    turned, still = np.where(conj, -unit, unit), np.zeros((1, 1), complex)
    before, after = move(contour.arriving, turned, still, conj), move(contour.leaving, turned, still, conj)
    return Surroundings(
        own=own,
        segments=len(contour.source) // 2,
        node=move(contour.nodes, unit, shift, conj),
        start=np.where(conj, contour.target, contour.source),
        end=np.where(conj, contour.source, contour.target),
        direction=move(contour.direction, turned, still, conj),
        corner=contour.corner_node,
        turn=contour.turn,
        bounding=contour.bounding,
        arriving=np.where(conj, after, before),
        leaving=np.where(conj, before, after),
    )

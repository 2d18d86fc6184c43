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

    A copy that is turned over has its half-edges run through backwards.

    Attributes:
        own: whether copy 0 is the site whose rows are looked at.
        segments: how many the site has; half-edges are twice as many.
        node: (copies, m) positions.
        start, end: (copies, h) nodes of each half-edge.
        direction: (copies, h).
        corner: (c,) node of each corner; turn: (c,) its angle; bounding: (c,) whether it counts.
        arriving, leaving: (copies, c) directions of the half-edges before and after.
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
    """All copies of a contour."""
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

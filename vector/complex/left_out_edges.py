"""Where two arcs of a boundary cross: the corner in the place of an edge between them that rounding has made."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.vector.complex.sharpening import off_arc
from voronoi_tiles.vector.complex.traced import Traced

# Steps of Newton's method: between lines one is enough, and on a parabola each squares the error.
_STEPS = 4
# How far from the arcs' ends, relative to the distance between these, the crossing may be: at tiny angles it is known
# badly along both arcs, and as good as it is where they end.
_FAR = 100.0


def without(boundary: Traced, kept: Ints) -> Traced:
    """The boundary of the arcs `kept` (intp, ascending), with each corner that others leave behind on both its arcs."""
    rest = boundary.take(kept)
    before = np.empty_like(kept)
    before[rest.following] = kept
    for k in np.flatnonzero(boundary.following[before] != kept).tolist():
        rest.vertex[k] = _crossing(boundary, int(before[k]), int(kept[k]))
    return rest


def _crossing(boundary: Traced, before: int, after: int) -> complex:
    """Where an arc crosses another one that starts near its end; that start where they do not cross near there."""
    end, start = complex(boundary.vertex[boundary.following[before]]), complex(boundary.vertex[after])
    here = (end + start) / 2
    for _ in range(_STEPS):
        (off, normal), (other_off, other_normal) = off_arc(boundary, before, here), off_arc(boundary, after, here)
        turn = (normal.conjugate() * other_normal).imag
        if turn == 0.0:
            return start
        # The point that is as far as this from either along its normal.
        here += 1j * (other_off * normal - off * other_normal) / turn
        if not abs(here - start) <= _FAR * abs(end - start):
            return start
    return here

"""What replaces the exact curves of tiles where a job asks for arcs or chords, or where kerf and fillets need arcs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.paths.biarcs import to_arcs
from voronoi_tiles.paths.conversion import to_cubics, to_lines
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.paths.short_segments import without_specks

JOINT: Final = 0.1
"""Angles below this are joints of a flattened curve, and no corners; radians: some six degrees."""

ABSORBED: Final = 400.0
"""Straight edges shorter than so many accuracies may become parts of arcs: 2 mm at the accuracy that is usual."""


def curve_fit(job: Job, curves: str, unit_mm: float) -> tuple[Callable[[Paths], Paths] | None, float]:
    """What replaces the exact curves before anything else is done, and the accuracy that is left for afterwards.

    Kerf and fillets need arcs, and leave many short ones.
    """
    absorbed = ABSORBED * job.accuracy / unit_mm
    # Half for the arcs that kerf and fillet start from, half for what is made of these.
    left = 0.5 * job.accuracy if job.dressed else job.accuracy
    accuracy = left / unit_mm

    def arcs(paths: Paths) -> Paths:
        """The fewest arcs and lines."""
        return side_arcs(paths, accuracy=accuracy, absorbed=absorbed)

    def lines(paths: Paths) -> Paths:
        """Chords."""
        return to_lines(paths, accuracy=accuracy)

    if job.dressed or curves == "arc":
        return arcs, left
    return (lines if curves == "polyline" else None), left


def side_arcs(paths: Paths, *, accuracy: float, absorbed: float) -> Paths:
    """Replace the sides of tiles by the fewest arcs and lines within an accuracy, lines below `absorbed` by arcs too.

    Where curves were flattened for the exact tiles, these have a hundred small joints a side, and as many short
    straight edges: they are no corners, and no edges that anybody drew.
    """
    return to_arcs(paths, accuracy=accuracy, corner=JOINT, absorbed=absorbed)


def fewer_arcs(rings: Paths, accuracy: float) -> Paths:
    """Replace the many short arcs that an offset leaves by the fewest within half of an accuracy.

    A hundredth of the accuracy is for the cubic curves in between, a fifth for specks. Arcs around corners stay.
    """
    rings = without_specks(rings, 0.1 * accuracy)
    corners = _round_corners(rings, accuracy)
    kind, control = np.where(corners, np.uint8(LINE), rings.kind), np.where(corners[:, None], 0, rings.control)
    curves = to_cubics(replace(rings, kind=kind, control=control), accuracy=0.01 * accuracy)
    # Lines stay what they are, one each: so the corners are found again.
    again = np.flatnonzero(curves.kind == LINE)[corners[kind == LINE]]
    curves.kind[again], curves.control[again] = ARC, rings.control[corners]
    fitted = side_arcs(curves, accuracy=0.28 * accuracy, absorbed=ABSORBED * accuracy)
    return without_specks(fitted, 0.1 * accuracy)


def _round_corners(rings: Paths, accuracy: float) -> Bools:
    """Tell which arcs turn like a corner, and rise too far above their chords to be parts of longer ones."""
    arcs = np.flatnonzero(rings.kind == ARC)
    radius, turn = rings.arc_radius_and_turn(arcs)
    corners = np.zeros(len(rings.kind), np.bool_)
    corners[arcs] = (np.abs(turn) > JOINT) & (radius * (1 - np.cos(turn / 2)) > accuracy)
    return corners

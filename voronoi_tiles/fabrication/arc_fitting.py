"""What replaces the exact curves of tiles where a job asks for arcs or chords, or where kerf and fillets need arcs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.paths.biarcs import to_arcs
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.fewest_cubics import to_fewest_cubics
from voronoi_tiles.paths.paths import Paths

JOINT: Final = 0.1
"""Angles below this are joints of a flattened curve, and no corners; radians: some six degrees."""

ABSORBED: Final = 400.0
"""Straight edges shorter than so many accuracies may become parts of arcs: 2 mm at the accuracy that is usual."""


def curve_fit(job: Job, curves: str, budget: AccuracyBudget, unit_mm: float) -> Callable[[Paths], Paths] | None:
    """What replaces the exact curves of tiles, in units of `unit_mm` millimetres, before anything else is done.

    Kerf and fillets need arcs. None where the exact curves stay. What does the same is equal.
    """
    if job.moves_contours or curves == "arc":
        return EdgeArcs(budget.arcs / unit_mm, ABSORBED * budget.whole / unit_mm)
    # Nothing else is done to these.
    return EdgeLines(budget.whole / unit_mm) if curves == "polyline" else None


@dataclass(frozen=True)
class EdgeArcs:
    """Replaces the edges of tiles by arcs, as `edge_arcs` does; two of the same measures are equal."""

    accuracy: float
    absorbed: float

    def __call__(self, paths: Paths) -> Paths:
        """Fit the arcs."""
        return edge_arcs(paths, accuracy=self.accuracy, absorbed=self.absorbed)


@dataclass(frozen=True)
class EdgeLines:
    """Replaces the edges of tiles by chords within an accuracy; two of the same are equal."""

    accuracy: float

    def __call__(self, paths: Paths) -> Paths:
        """Lay the chords."""
        return to_lines(paths, accuracy=self.accuracy)


def edge_arcs(paths: Paths, *, accuracy: float, absorbed: float) -> Paths:
    """The edges of tiles as the fewest arcs and lines within an accuracy; lines below `absorbed` count as curved.

    Where curves were flattened for the exact tiles, these have a hundred small joints an edge, and as many short
    straight edges: they are no corners, and no edges that anybody drew.
    """
    return to_arcs(paths, accuracy=accuracy, corner=JOINT, absorbed=absorbed)


def corner_radii(job: Job) -> list[float]:
    """The radii of the arcs that the job's fillet and kerf make of corners; millimetres."""
    half = job.kerf / 2
    if job.fillet == 0.0:
        return [half] if half > 0.0 else []
    return [radius for radius in (half, job.fillet + half, abs(job.fillet - half)) if radius > 0.0]


def edge_cubics(paths: Paths, budget: AccuracyBudget, rounded: Sequence[float]) -> Paths:
    """The lines of a page as the fewest cubic curves within its budget; corners are as for `edge_arcs`.

    Arcs of the radii `rounded` are corners too, whose ends stay.
    """
    absorbed = ABSORBED * budget.whole
    return to_fewest_cubics(paths, accuracy=budget.cubics, corner=JOINT, absorbed=absorbed, rounded=rounded)

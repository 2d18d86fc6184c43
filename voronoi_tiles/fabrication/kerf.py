"""What kerf and fillets do to the contours of pieces, and what they lose by it."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.contours import ClosedPieces
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.offset import Offset, OffsetError, offset, round_corners
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.short_segments import without_short_segments
from voronoi_tiles.paths.winding import item_winding

SHORTEST_MM: Final = 0.01
"""Segments shorter than this are left out where the accuracy allows it; millimetres. Machines stutter at them."""

_LOSSES = {
    "ring": "a piece vanishes",
    "neck": "a neck breaks",
    "gap": "a gap closes",
    "part": "a thin part vanishes",
}


class Compensation:
    """Applies the fillet and the kerf of a job to contours; `losses` says in sentences what pieces have lost so far."""

    def __init__(self, job: Job, budget: AccuracyBudget) -> None:
        self.job = job
        self.budget = budget
        self.losses: list[str] = []

    def tile(self, rings: Paths) -> Paths:
        """Apply them to a whole tile, which must keep all its rings. Raises JobError where it does not."""
        return self._compensated(rings, whole=True)

    def pieces(self, pieces: ClosedPieces) -> tuple[ClosedPieces, Ints]:
        """Apply fillet and kerf to pieces one by one; also gives of which of them each of the pieces now is."""
        if not self.job.moves_contours:
            return pieces, np.arange(len(pieces.tile))
        done: list[Paths] = []
        of: list[int] = []
        for k, (a, b) in enumerate(pairwise(pieces.items.tolist())):
            parts = _parts(self._compensated(pieces.paths.take(np.arange(a, b)), whole=False))
            done += parts
            of += [k] * len(parts)
        items = np.append(0, np.cumsum([len(rings) for rings in done])).astype(np.intp)
        owner = np.array(of, np.intp)
        return ClosedPieces(Paths.concatenate(done), items, pieces.tile[owner]), owner

    def _compensated(self, rings: Paths, *, whole: bool) -> Paths:
        """The rings of a piece with round corners, half the kerf outside of it, and without short segments.

        A tile that is `whole` must leave all its rings; of a part of one, or of a frame, less may be left, or nothing.
        """
        job = self.job
        if job.fillet > 0.0:
            rings = self._kept(round_corners, rings, job.fillet, "fillet", whole=whole)
        if job.kerf > 0.0 and len(rings):
            rings = self._kept(offset, rings, job.kerf / 2, "kerf", whole=whole)
        return without_short_segments(rings, SHORTEST_MM, self.budget.short)

    def _kept(
        self, change: Callable[[Paths, float], Offset], rings: Paths, size: float, name: str, *, whole: bool
    ) -> Paths:
        """Apply a change to a piece, and note what is lost by it."""
        return changed(change, rings, size, (name, getattr(self.job, name)), self.losses, whole=whole)


def changed(
    change: Callable[[Paths, float], Offset],
    rings: Paths,
    size: float,
    asked: tuple[str, float],
    losses: list[str],
    *,
    whole: bool,
) -> Paths:
    """Apply a change of some size to a piece, and note in `losses` what is lost by it.

    `asked` is the option that wants it, and its millimetres. Of a piece that is `whole` all rings must stay. Raises
    JobError.
    """
    name, given = asked
    try:
        result = change(rings, size)
    except OffsetError as error:
        raise JobError(
            f"`{name}` cannot be applied at ({error.place.real:.4g}, {error.place.imag:.4g}) mm of the page",
            remedy=f"Change `{name}` a little, and please report the design.",
        ) from error
    for lost in result.lost:
        place = f"({lost.place.real:.4g}, {lost.place.imag:.4g}) mm"
        if whole and (lost.kind in ("ring", "neck") or len(result.paths) != len(rings)):
            raise JobError(
                f"`{name}='{given:g}mm'` is too much: {_LOSSES[lost.kind]} at {place} of the page",
                remedy=f"Use a smaller `{name}`, or a larger design.",
            )
        losses.append(f"`{name}='{given:g}mm'`: {_LOSSES[lost.kind]} at {place} of the page")
    return result.paths


def _parts(rings: Paths) -> list[Paths]:
    """The parts that rings bound: an outer one each, and the holes in it."""
    areas = ring_areas(rings)
    outer, holes = np.flatnonzero(areas > 0), np.flatnonzero(areas <= 0)
    shells = rings.take(outer)
    inside = item_winding(shells, shells.offsets, rings.start[rings.offsets[:-1]][holes]) > 0
    return [rings.take(np.append(one, holes[held])) for one, held in zip(outer, inside, strict=True)]

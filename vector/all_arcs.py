"""The arcs of the outlines of all tiles as one set of arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.vector.outline import Outline


@dataclass(frozen=True, slots=True)
class AllArcs:
    """n arcs in r rings, those of the first outline, then those of the second, and so on.

    `start`, `control`, `end` (complex128, n) and `curved` (bool, n) are those of the outlines, `ring_offsets` (intp,
    r + 1) as well; `tile` (intp, n) is the outline's number.
    """

    start: Complexes
    control: Complexes
    end: Complexes
    curved: Bools
    tile: Ints
    ring_offsets: Ints

    def __len__(self) -> int:
        return len(self.start)

    @classmethod
    def of(cls, outlines: Sequence[Outline]) -> AllArcs:
        """The arcs of outlines."""
        counts = np.array([len(outline) for outline in outlines])
        before = np.cumsum(counts) - counts
        offsets = [outline.ring_offsets[:-1] + k for outline, k in zip(outlines, before.tolist(), strict=True)]
        return cls(
            start=np.concatenate([outline.start for outline in outlines]),
            control=np.concatenate([outline.control for outline in outlines]),
            end=np.concatenate([outline.end for outline in outlines]),
            curved=np.concatenate([outline.curved for outline in outlines]),
            tile=np.repeat(np.arange(len(outlines)), counts),
            ring_offsets=np.append(np.concatenate(offsets), counts.sum()),
        )

    def at(self, arc: Ints, t: Floats) -> Complexes:
        """Points of arcs at their parameter 0 ... 1, the ends exactly; arc and t are (m,)."""
        start, control, end = self.start[arc], self.control[arc], self.end[arc]
        point = np.where(
            self.curved[arc],
            (1 - t) ** 2 * start + 2 * t * (1 - t) * control + t * t * end,
            (1 - t) * start + t * end,
        )
        return np.where(t == 0.0, start, np.where(t == 1.0, end, point))

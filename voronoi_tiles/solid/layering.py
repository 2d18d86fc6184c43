"""The exact layers of a solid and the events between them, to which layers are added where they are wanted."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import Final

import numpy as np

from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.solid.events import Event, LoftError, events_between
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.motion import Motion

_THIN: Final = 1e-6
"""How far layers that are added are from what is there; relative to the solid's height. Events are known better."""


class Layering:
    """Layers and events of a design, from the bottom to the top."""

    def __init__(self, design: Design, motion: Motion) -> None:
        """Describe one without layers."""
        self._design, self._motion = design, motion
        self._known: dict[float, ExactLayer] = {}
        self._line: list[ExactLayer | Event] = []

    def __iter__(self) -> Iterator[ExactLayer | Event]:
        """From the bottom to the top."""
        return iter(self._line)

    def layer_at(self, z: float) -> ExactLayer:
        """The layer at a height, which is none of the line yet. Raises LoftError where copies meet."""
        if z not in self._known:
            own = self.layer_at(0.0).stabilizers if z else ()
            try:
                layer = ExactLayer.of(z, self._motion.at(z), self._design.group, self._design.lattice, own)
            except TouchingCopiesError as error:
                text = str(error).partition(". ")[0]
                raise LoftError(text, z, remedy="Copies must keep apart at all heights.") from None
            self._known[z] = layer
        return self._known[z]

    @property
    def count(self) -> int:
        """How many layers there are; events are not counted."""
        return sum(isinstance(item, ExactLayer) for item in self._line)

    def add(self, heights: Iterable[float]) -> bool:
        """Add layers at heights, but for those at which there is one, or an event; whether any was added.

        Raises LoftError.
        """
        thin = _THIN * self._motion.height
        there = np.array([z for item in self._line for z in (_below(item).z, _above(item).z)])
        fresh = [self.layer_at(z) for z in sorted(set(heights)) if (np.abs(there - z) > thin).all()]
        self._line = sorted([*self._line, *fresh], key=lambda item: _below(item).z)
        self._line = list(self._completed(set(fresh)))
        return bool(fresh)

    def _completed(self, fresh: set[ExactLayer | Event]) -> Iterator[ExactLayer | Event]:
        """The line, with the events beside layers that are new in it."""
        yield self._line[0]
        for low, high in pairwise(self._line):
            if low in fresh or high in fresh:
                yield from events_between(_above(low), _below(high), self.layer_at, self._motion.height)
            yield high


def _below(item: ExactLayer | Event) -> ExactLayer:
    """The layer with which an item begins."""
    return item.low if isinstance(item, Event) else item


def _above(item: ExactLayer | Event) -> ExactLayer:
    """The layer with which it ends."""
    return item.high if isinstance(item, Event) else item

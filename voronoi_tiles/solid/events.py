"""Events: the heights at which tiles exchange neighbours, each found as two layers between which one happens."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple

from voronoi_tiles.base.arrays import Bools
from voronoi_tiles.base.errors import ProofError, VoronoiTilesError
from voronoi_tiles.base.text import counted
from voronoi_tiles.solid.correspondence import Correspondence, corresponding
from voronoi_tiles.solid.layers import ExactLayer

_ABOUT: Final = 1e-8
"""How far the layers before and after an event are from it; relative to the solid's height."""

_CLOSEST: Final = 1e-13
"""Events that are not hit are left alone when they are known so well; relative to the solid's height."""

_TURNS: Final = 100
"""How often is looked for an event, at most; a count. Ten times are the rule."""

_SHORT: Final = (1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5)
"""How long edges are that an event makes points of; relative to the cell's size. The least that will do is taken."""

_GONE: Final = 1e-7
"""How long edges are, altogether, that are about to vanish in an event that is hit; relative to the cell's size."""


class LoftError(VoronoiTilesError, ValueError):
    """A design that has no solid: copies meet at some height, or parts of a tile do.

    `z` is the height, in the units of the design.
    """

    def __init__(self, message: str, z: float, *, remedy: str | None = None) -> None:
        super().__init__(message)
        self.message, self.z, self.remedy = message, z, remedy

    def __str__(self) -> str:
        text = f"{self.message} at the height {self.z:.6g}."
        return f"{text} {self.remedy}" if self.remedy else text


class Event(NamedTuple):
    """The layer of an event, `core`, and those just before and after it; edges up to `limit` are points in it.

    Before or after it the core itself may be what it was.
    """

    low: ExactLayer
    core: ExactLayer
    high: ExactLayer
    limit: float


LayerAt = Callable[[float], ExactLayer]
"""What gives the layer at a height."""


def events_between(low: ExactLayer, high: ExactLayer, layer_at: LayerAt, height: float) -> list[Event]:
    """The events between two layers of a solid of this height, from below.

    Edges that vanish, or appear, have lengths that are nearly linear near an event: where they would be nothing is
    looked next, and in the middle where that is no good. In the end a layer is hit in which the engine finds that more
    than three tiles meet in a point. Raises LoftError where an event is no exchange of neighbours.
    """
    below: list[ExactLayer] = [low]
    above: list[ExactLayer] = [high]
    for turn in range(_TURNS):
        low, high = below[-1], above[-1]
        if corresponding(low, high) is not None:
            return []
        span, vanishing, appearing = high.z - low.z, _only_in(low, high), _only_in(high, low)
        if span <= (_CLOSEST if vanishing and appearing else _ABOUT) * height:
            break
        guess = (low.z + high.z) / 2 if turn % 4 == 3 else _guess(below, above, vanishing, appearing)
        try:
            middle = layer_at(min(max(guess, low.z + span / 64), high.z - span / 64))
        except ProofError:  # so near to an event that a vertex is not known to the last digits
            break
        if corresponding(low, middle) is not None:
            below.append(middle)
        elif corresponding(middle, high) is not None:
            above.append(middle)
        elif max(_only_in(middle, low), _only_in(middle, high)) <= _GONE * low.action.size:
            return _about(low, middle, high, layer_at, height)
        else:
            return events_between(low, middle, layer_at, height) + events_between(middle, high, layer_at, height)
    return [_event(low, high if not appearing else low, high)]


def _guess(below: list[ExactLayer], above: list[ExactLayer], vanishing: float, appearing: float) -> float:
    """Where edges that vanish, or appear, have no length: on the line through two lengths, or between two sides."""
    low, high = below[-1], above[-1]
    found = []
    for near, far, length in ((below, high, vanishing), (above, low, appearing)):
        if len(near) > 1 and length:
            slope = (_only_in(near[-2], far) - length) / (near[-1].z - near[-2].z)
            at = near[-1].z + length / slope if slope else far.z
            if low.z < at < high.z:
                found.append((length, at))
    total = vanishing + appearing
    straight = low.z + (high.z - low.z) * (vanishing / total if total else 0.5)
    return min(found)[1] if found else straight


def _about(low: ExactLayer, core: ExactLayer, high: ExactLayer, layer_at: LayerAt, height: float) -> list[Event]:
    """The event that has been hit, and others that there may be besides, between two layers."""
    before, after = core.z - _ABOUT * height, core.z + _ABOUT * height
    below = low if low.z >= before else layer_at(before)
    above = high if high.z <= after else layer_at(after)
    return [
        *events_between(low, below, layer_at, height),
        _event(below, core, above),
        *events_between(above, high, layer_at, height),
    ]


def _only_in(layer: ExactLayer, other: ExactLayer) -> float:
    """How long the edges are, altogether, beyond which lies what is beyond none of another layer's tile."""
    length = 0.0
    for own, there, tile in zip(layer.rings, other.rings, range(len(layer.rings)), strict=True):
        names = {name for ring in there for name in ring}
        first = int(layer.ring_offsets[layer.tile_offsets[tile]])
        beyond = [name for ring in own for name in ring]
        length += sum(float(layer.lengths[layer.edge[first + k]]) for k, name in enumerate(beyond) if name not in names)
    return length


def matched(low: ExactLayer, high: ExactLayer, limit: float) -> tuple[tuple[Bools, Bools], Correspondence | None]:
    """The edges of two layers that are no longer than a limit, and how the others correspond."""
    short = low.lengths <= limit, high.lengths <= limit
    return short, corresponding(low, high, short)


def _event(low: ExactLayer, core: ExactLayer, high: ExactLayer) -> Event:
    """The event of a core. Raises LoftError where edges that are long have no counterpart."""
    for share in _SHORT:
        limit = share * core.action.size
        if all(matched(one, two, limit)[1] is not None for one, two in ((low, core), (core, high))):
            return Event(low, core, high, limit)
    raise LoftError(_why(low, high), core.z, remedy="Draw strokes that stay in one piece, or move them less.")


def _why(low: ExactLayer, high: ExactLayer) -> str:
    """What happens where tiles do not just exchange neighbours: copies keep apart, as has been proved before."""
    for record, below, above in zip(low.records, low.rings, high.rings, strict=True):
        if len(below) != len(above):
            rings = counted(len(below), "ring")
            return f'the boundary of the tile of site "{record.name}" changes from {rings} to {len(above)}'
    return "parts of a tile meet, or come apart,"

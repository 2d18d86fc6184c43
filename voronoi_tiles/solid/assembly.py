"""Solids put together: levels of layers and events, the walls between them, bottoms and tops."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.solid.correspondence import Correspondence, corresponding
from voronoi_tiles.solid.edge_steps import stepped, turning
from voronoi_tiles.solid.events import Event, LoftError, matched
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.levels import VertexChains, carried, sampled
from voronoi_tiles.solid.loft_caps import cap, outline_of
from voronoi_tiles.solid.vertices import VertexTable, Vertices
from voronoi_tiles.solid.walls import Walls, walls
from voronoi_tiles.vector.complex.representatives import Points

TRIANGLES_MAX: Final = 250_000
"""Of how many triangles solids are, at most; a count. They take half a minute, and slicers are slow with more."""

_OTHERS: Final = "Write more layers in [solid], or draw keys that differ less."


class _View(NamedTuple):
    """A layer at a level: its edges that are points, and how the uses of the level's core correspond to its own."""

    layer: ExactLayer
    short: Bools
    same: Correspondence


@dataclass(eq=False)
class LoftLevel:
    """A height at which walls have vertices: those of `core`, whose edges up to `limit` are points.

    Below an event, or above, tiles have other neighbours: then `lower` or `upper` is the layer next to it.
    """

    core: ExactLayer
    limit: float = -1.0
    lower: ExactLayer | None = None
    upper: ExactLayer | None = None

    @property
    def points(self) -> Bools:
        """The edges of the core that are points."""
        return self.core.lengths <= self.limit

    @property
    def layers(self) -> Iterator[ExactLayer]:
        """The core, and those next to it."""
        return (layer for layer in (self.lower, self.core, self.upper) if layer is not None)

    @property
    def views(self) -> tuple[_View, _View]:
        """The level as seen from below, and from above."""
        return self._view(self.lower), self._view(self.upper)

    def _view(self, other: ExactLayer | None) -> _View:
        if other is None:
            every = np.arange(len(self.core.names))
            return _View(self.core, self.points, Correspondence(every, every))
        (_, short), same = matched(self.core, other, self.limit)
        if same is None:
            raise LoftError("tiles exchange neighbours twice", self.core.z, remedy=_OTHERS)
        return _View(other, short, same)


def matching(below: ExactLayer, above: ExactLayer) -> Correspondence:
    """How the uses of two layers correspond that have no event between them. Raises LoftError where they do not."""
    same = corresponding(below, above)
    if same is None:
        raise LoftError("tiles exchange neighbours twice", above.z, remedy=_OTHERS)
    return same


@dataclass(frozen=True, eq=False)
class LoftTile:
    """The solid of one site: triangles between `points`, intp (m, 3), counter-clockwise as seen from outside."""

    name: str
    points: Points
    triangles: Ints


def refuse_many(triangles: int) -> None:
    """Raise ArgumentError where solids would have too many triangles."""
    if triangles > TRIANGLES_MAX:
        raise ArgumentError(
            f"the solids would have more than {TRIANGLES_MAX:,} triangles",
            remedy="Give a coarser accuracy, fewer layers in [solid], or strokes of fewer elements.",
        )


def solids_of(
    names: Sequence[str], levels: Sequence[LoftLevel], accuracy: float
) -> tuple[Vertices, tuple[LoftTile, ...]]:
    """The vertices and the solids of sites of these names; chords are within `accuracy` units of their arcs.

    Raises LoftError where levels do not fit each other, ArgumentError where they would be of too many triangles.
    """
    table, views = VertexTable(levels[0].core.action), [level.views for level in levels]
    slabs = []
    for (_, below), (above, _) in pairwise(views):
        slabs.append(matching(below.layer, above.layer))
    chains, labels = _chains(table, levels, views, slabs, accuracy), _labels(levels, views, slabs)
    count = sum(int(chains[k][1].counts[view.layer.edge].sum()) for k, (_, view) in enumerate(views))
    refuse_many(2 * count)  # each side of a chain is that of one below and of one above
    vertices = table.snapshot()
    between = [
        (walls(vertices, below.layer, above.layer, (chains[k][1], chains[k + 1][0]), slabs[k]), labels[k][1])
        for k, ((_, below), (above, _)) in enumerate(pairwise(views))
    ]
    closed = [(views[k][side].layer, chains[k][side], labels[k][side]) for k, side in ((0, 1), (-1, 0))]
    return vertices, tuple(_tile(vertices, between, closed, k, name) for k, name in enumerate(names))


def levels_of(line: Iterable[ExactLayer | Event]) -> list[LoftLevel]:
    """The levels of layers and of the events between them, from below; an event at a layer is part of it."""
    levels: list[LoftLevel] = []
    for item in line:
        core = item.core if isinstance(item, Event) else item
        if not levels or levels[-1].core is not core:
            levels.append(LoftLevel(core))
        if isinstance(item, Event):
            level = levels[-1]
            level.limit = max(level.limit, item.limit)
            level.lower = level.lower if item.low is core else item.low
            level.upper = level.upper if item.high is core else item.high
    return levels


def _chains(
    table: VertexTable,
    levels: Sequence[LoftLevel],
    views: Sequence[tuple[_View, _View]],
    slabs: Sequence[Correspondence],
    accuracy: float,
) -> list[tuple[VertexChains, VertexChains]]:
    """The chains of each level, as seen from below and from above."""
    turns = [np.zeros(len(level.core.lengths)) for level in levels]
    for k, same in enumerate(slabs):
        below, above = views[k][1], views[k + 1][0]
        turned = turning(below.layer, above.layer, same)
        for at, view, use in ((k, below, same.low), (k + 1, above, same.high)):
            edge = _core_edges(levels[at].core, view)[view.layer.edge[use]]
            np.maximum.at(turns[at], edge[edge >= 0], turned[edge >= 0])
    found = []
    for level, turn, (below, above) in zip(levels, turns, views, strict=True):
        own = sampled(table, level.core, level.points, *stepped(level.core, turn, accuracy))
        lower, upper = (
            own if layer is level.core else carried(layer, short, level.core, own, same)
            for layer, short, same in (below, above)
        )
        found.append((lower, upper))
    return found


def _core_edges(core: ExactLayer, view: _View) -> Ints:
    """For each edge of a layer at a level that of the core which it is there, -1 for those that are points."""
    found = np.full(len(view.short), -1)
    found[view.layer.edge[view.same.high]] = core.edge[view.same.low]
    found[view.short] = -1
    return found


def _labels(
    levels: Sequence[LoftLevel], views: Sequence[tuple[_View, _View]], slabs: Sequence[Correspondence]
) -> list[tuple[Ints, Ints]]:
    """For both views of each level which ring at the bottom each of its rings is, intp (rings,)."""
    found = np.arange(len(views[0][0].layer.ring_offsets) - 1)
    labels = []
    for k, (level, (below, above)) in enumerate(zip(levels, views, strict=True)):
        if k:
            found = _ring_labels(found, views[k - 1][1].layer, slabs[k - 1], below.layer)
        here = found
        found = _ring_labels(found, below.layer, below.same.reversed, level.core)
        found = _ring_labels(found, level.core, above.same, above.layer)
        labels.append((here, found))
    return labels


def _ring_labels(labels: Ints, low: ExactLayer, same: Correspondence, high: ExactLayer) -> Ints:
    """The labels of a layer's rings as those of another one's, whose uses correspond."""
    found = np.zeros(len(high.ring_offsets) - 1, np.intp)
    found[high.ring[same.high]] = labels[low.ring[same.low]]
    return found


def _tile(
    vertices: Vertices,
    between: Sequence[tuple[Walls, Ints]],
    closed: Sequence[tuple[ExactLayer, VertexChains, Ints]],
    tile: int,
    name: str,
) -> LoftTile:
    """The solid of a site: its walls, its bottom and its top; where rings touch, each has a vertex of its own."""
    parts, labels = [], []
    for part, rings in between:
        corners, ring = part.of_tile(tile)
        parts.append(corners)
        labels.append(rings[ring])
    for top, (layer, chains, names) in enumerate(closed):
        outline = outline_of(layer, chains, tile)
        triangles = cap([vertices.representatives.locate(ring) for ring in outline])
        every = Points.joined(outline)
        ring = np.repeat(names[slice(*layer.tile_offsets[tile : tile + 2])], [len(ring) for ring in outline])
        corner = (triangles if top else triangles[:, [0, 2, 1]]).ravel()
        parts.append(every.take(corner))
        labels.append(ring[corner])
    points, number = vertices.indexed(Points.joined(parts), np.concatenate(labels))
    return LoftTile(name, points, number.reshape(-1, 3))

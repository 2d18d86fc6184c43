"""Solids put together: levels of layers and events, the walls between them, bottoms and tops."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Floats, Ints, offsets_of
from voronoi_tiles.base.components import components
from voronoi_tiles.solid.correspondence import Correspondence, corresponding
from voronoi_tiles.solid.events import Event, LoftError, matched
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.levels import VertexChains, carried, sagging, sampled, weighed
from voronoi_tiles.solid.loft_caps import cap, outline_of
from voronoi_tiles.solid.vertices import VertexTable, Vertices
from voronoi_tiles.solid.walls import Walls, walls
from voronoi_tiles.vector.complex.representatives import Points

_OTHERS = "Write another number of `layers`."

_FINER = 8
"""How often edges that are too far from their chords get more of them, at most; a count."""


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


@dataclass(frozen=True, eq=False)
class LoftTile:
    """The solid of one site: triangles between `points`, intp (m, 3), counter-clockwise as seen from outside."""

    name: str
    points: Points
    triangles: Ints


def solids_of(
    names: Sequence[str], levels: Sequence[LoftLevel], accuracy: float
) -> tuple[Vertices, tuple[LoftTile, ...]]:
    """The vertices and the solids of sites of these names; chords are within `accuracy` units of their arcs.

    Raises LoftError where levels do not fit each other.
    """
    table, views = VertexTable(levels[0].core.action), [level.views for level in levels]
    slabs = []
    for (_, below), (above, _) in pairwise(views):
        same = corresponding(below.layer, above.layer)
        if same is None:
            raise LoftError("tiles exchange neighbours twice", above.layer.z, remedy=_OTHERS)
        slabs.append(same)
    chains, labels = _chains(table, levels, views, slabs, accuracy), _labels(levels, views, slabs)
    vertices = table.snapshot()
    between = [
        (walls(vertices, below.layer, above.layer, (chains[k][1], chains[k + 1][0]), slabs[k]), labels[k][1])
        for k, ((_, below), (above, _)) in enumerate(pairwise(views))
    ]
    closed = [(views[k][side].layer, chains[k][side], labels[k][side]) for k, side in ((0, 1), (-1, 0))]
    return vertices, tuple(_tile(vertices, between, closed, k, name) for k, name in enumerate(names))


def levels_of(layers: Sequence[ExactLayer], events: Sequence[Sequence[Event]]) -> list[LoftLevel]:
    """The levels of layers and of the events between them; an event at a layer is part of it."""
    levels = [LoftLevel(layers[0])]
    for (low, high), found in zip(pairwise(layers), events, strict=True):
        top = LoftLevel(high)
        for event in found:
            if event.core is low:
                level = levels[-1]
            elif event.core is high:
                level = top
            else:
                level = LoftLevel(event.core)
                levels.append(level)
            level.limit = max(level.limit, event.limit)
            level.lower = level.lower if event.low is event.core else event.low
            level.upper = level.upper if event.high is event.core else event.high
        levels.append(top)
    return levels


def _chains(
    table: VertexTable,
    levels: Sequence[LoftLevel],
    views: Sequence[tuple[_View, _View]],
    slabs: Sequence[Correspondence],
    accuracy: float,
) -> list[tuple[VertexChains, VertexChains]]:
    """The chains of each level, as seen from below and from above.

    An edge has as many steps in all levels in which it is there: as it needs where it needs most.
    """
    weights = [weighed(level.core, accuracy) for level in levels]
    needed = [
        np.add.reduceat(weight, level.core.quotient.offsets[:-1]) for weight, level in zip(weights, levels, strict=True)
    ]
    first = offsets_of([len(need) for need in needed])
    links = [np.zeros((2, 0), np.intp)]
    for k, same in enumerate(slabs):
        below, above = views[k][1], views[k + 1][0]
        one = _core_edges(levels[k].core, below)[below.layer.edge[same.low]]
        two = _core_edges(levels[k + 1].core, above)[above.layer.edge[same.high]]
        both = (one >= 0) & (two >= 0)
        links.append(np.stack((first[k] + one[both], first[k + 1] + two[both])))
    one, two = np.concatenate(links, axis=1)
    family = components(int(first[-1]), one, two)
    steps = _steps(family, np.concatenate(needed))
    for _ in range(_FINER):
        # A vertex that is moved to where arcs meet leaves longer chords beside it.
        sag = np.concatenate(
            [
                sagging(level.core, steps[a:b], weight)
                for level, weight, (a, b) in zip(levels, weights, pairwise(first.tolist()), strict=True)
            ]
        )
        if sag.max(initial=0.0) <= accuracy:
            break
        steps = _steps(family, steps * np.clip(np.sqrt(sag / accuracy), 1.0, 2.0))
    found = []
    for k, level in enumerate(levels):
        own = sampled(table, level.core, level.points, steps[first[k] : first[k + 1]], weights[k])
        lower, upper = (
            own if layer is level.core else carried(layer, short, level.core, own, same)
            for layer, short, same in views[k]
        )
        found.append((lower, upper))
    return found


def _steps(family: Ints, needed: Floats) -> Ints:
    """For each edge the steps that the neediest of its family takes, an even number."""
    most = np.ones(len(needed))
    np.maximum.at(most, family, needed)
    steps = np.ceil(most).astype(np.intp)[family]
    return steps + steps % 2  # halves are images of each other where a motion turns an edge round


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

"""The nodes and segments of the sites of all tiles as one set of arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.vector.tessellation import LocalTile


@dataclass(frozen=True, slots=True)
class AllNodes:
    """n nodes of sites, those of the first tile, then those of the second, and so on; and m segments between them.

    `position` is complex128 (n,), `tile` (intp, n) the number of the tile, `segments` (intp, m x 2) has indices of
    nodes.
    """

    position: Complexes
    tile: Ints
    segments: Ints

    @classmethod
    def of(cls, tiles: Sequence[LocalTile]) -> AllNodes:
        """The nodes of the sites of tiles."""
        nodes, segments = [tile.nodes for tile in tiles], [tile.segments for tile in tiles]
        counts = np.array([len(own) for own in nodes])
        before = (counts.cumsum() - counts).repeat([len(own) for own in segments])
        return cls(
            position=np.concatenate(nodes),
            tile=np.arange(len(tiles)).repeat(counts),
            segments=np.concatenate(segments) + before[:, None],
        )

    def elements(self) -> tuple[Ints, Complexes, Complexes]:
        """Of the sites' elements, tile after tile, the tile, intp (k,), and both ends, complex128 (k,).

        The elements are the segments, and the nodes that are in none: their ends are the same.
        """
        alone = np.ones(len(self.position), bool)
        alone[self.segments] = False
        points = alone.nonzero()[0]
        start, end = (np.concatenate((side, points)) for side in self.segments.T)
        tile = self.tile[start]
        order = tile.argsort(kind="stable")
        return tile[order], self.position[start[order]], self.position[end[order]]

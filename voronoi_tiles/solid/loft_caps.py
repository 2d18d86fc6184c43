"""Bottoms and tops of solids: outlines of vertices, filled with triangles that have no other vertices."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, counting, offsets_of
from voronoi_tiles.solid.face_triangles import following, polygons, triangulated
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.levels import VertexChains
from voronoi_tiles.vector.complex.representatives import Points


def outline_of(layer: ExactLayer, chains: VertexChains, tile: int) -> list[Points]:
    """The rings of a base tile as vertices, each once."""
    found = []
    for ring in range(*layer.tile_offsets[tile : tile + 2].tolist()):
        uses = np.arange(*layer.ring_offsets[ring : ring + 2])
        edge = layer.edge[uses]
        counts = chains.counts[edge] - 1
        step, owner = counting(counts)
        at = np.where(layer.backwards[uses][owner], counts[owner] - step, step)
        found.append(chains.points.take(chains.offsets[edge][owner] + at).moved(layer.motion[uses][owner]))
    return found


def cap(rings: list[Complexes]) -> Ints:
    """Triangles that fill rings of points, intp (n, 3): numbers of points, ring after ring, counter-clockwise.

    Rings that run counter-clockwise are outer ones, others are holes. Each part is filled by itself: where rings touch,
    points are told apart by their numbers. Raises ProofError where a part gets corners that it does not have.
    """
    points, offsets = np.concatenate(rings), offsets_of(list(map(len, rings)))
    return triangulated(points, polygons(points, offsets), following(points, offsets))

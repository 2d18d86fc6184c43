"""How far the points of edges are from the site, from the copy beyond, and from whatever is nearest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base import kernels
from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.base.box_join import z_order
from voronoi_tiles.base.maps import Isometry, move
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.all_nodes import AllNodes
from voronoi_tiles.vector.box_tree import BoxTree
from voronoi_tiles.vector.nearest_copies import (
    Motions,
    NearestCopies,
    distances,
    inverses,
    nearest_copies,
    steps_around,
)
from voronoi_tiles.vector.tessellation import LocalTile

# Where on an arc its points are tested; its end is the next one's start.
_PARAMETERS = np.array([0.0, 0.25, 0.5, 0.75])
# So many times the limit of an error an element may be farther than the nearest one and still be taken into account.
_SLACK = 10.0
_NEAR = 0.12  # of the cell's width: how far the compiled search moves on before it chooses copies anew
_AT_ONCE = 1 << 20  # pairs of a point and an element: tens of megabytes

_COMPILED = kernels.kernel(
    "proof_nearest",
    *(kernels.INT, kernels.COMPLEXES, kernels.INTS),
    *(kernels.INT, kernels.COMPLEXES, kernels.COMPLEXES, kernels.BOOLS, kernels.COMPLEXES),
    *(kernels.INT, kernels.INT, kernels.FLOAT, kernels.FLOAT),
    *(kernels.INT, kernels.COMPLEXES, kernels.COMPLEXES, kernels.INTS),
    *(kernels.INTS, kernels.COMPLEXES, kernels.COMPLEXES, kernels.FLOATS),
)


def errors_of_distance(
    group: WallpaperGroup, lattice: Lattice, tiles: Sequence[LocalTile], nodes: AllNodes, arcs: AllArcs, limit: float
) -> tuple[float, float]:
    """The largest error of equidistance, and by how much any copy is too near, in units, over points of all edges.

    `nodes` and `arcs` are those of the tiles, `limit` is what the proof accepts of either.
    """
    owner, start, end = nodes.elements()
    sites = Sites(owner, start, end - start)
    order = _side_by_side(arcs, np.array([tile.nodes[0] for tile in tiles]))
    of = order.repeat(len(_PARAMETERS))
    points = arcs.sample(_PARAMETERS)[order].ravel()
    if not np.isfinite(points).all():  # of a result that is wrong
        return np.inf, np.inf
    tile = arcs.tile[of]
    neighbour, site, isometries = _neighbours(lattice, tiles)
    beyond = neighbour[of]
    unit, shift, conj = inverses(isometries)
    back = move(points, unit[beyond], shift[beyond], conj[beyond])
    claims = Claims(np.array((points, back)), np.array((tile, np.array(site)[beyond])))
    slack = _SLACK * limit
    found = distances_of_claims(
        lattice, _motions(group, lattice), BoxTree.of(lattice, start, end), sites, claims, slack
    )
    here, there = (
        sites.complete(distance, found[0] + slack, *side)
        for distance, *side in zip(found[1:], claims.places, claims.sites, strict=True)
    )
    return float(np.abs(here - there).max()), float((here - found[0]).max())


@lru_cache(maxsize=16)
def _motions(group: WallpaperGroup, lattice: Lattice) -> Motions:
    """What undoes the group's operations: it serves all designs of this group on this lattice."""
    return inverses([lattice.isometry(operation) for operation in group.operations])


def _side_by_side(arcs: AllArcs, places: Complexes) -> Ints:
    """The arcs in an order in which tiles follow each other whose places are beside each other: intp (n,)."""
    if len(places) == 1:
        return np.arange(len(arcs))
    rank = np.empty(len(places), np.intp)
    rank[z_order(places)] = np.arange(len(places))
    return rank[arcs.tile].argsort(kind="stable")


class Claims(NamedTuple):
    """Points of edges, n of them, and which two sites they claim to be as near to as to none.

    In `places`, complex128 (2, n), the points stand in the places in which the sites `sites` (intp, 2 x n) are where
    they are.
    """

    places: Complexes
    sites: Ints


@dataclass(frozen=True, slots=True)
class Sites:
    """The elements of all sites in their places: `site` (intp, m), in order, `start` and `chord` (complex128, m)."""

    site: Ints
    start: Complexes
    chord: Complexes

    def among(self, found: NearestCopies, places: Complexes, site: Ints) -> Floats:
        """The distances of places from the elements of a site each that are among the pairs found; float64 (n,)."""
        result = np.full(len(places), np.inf)
        of = self.site[found.element] == site[found.point]
        point, element = found.point[of], found.element[of]
        np.minimum.at(result, point, distances(places[point], self.start[element], self.chord[element]))
        return result

    def complete(self, known: Floats, enough: Floats, places: Complexes, site: Ints) -> Floats:
        """The distance of each place from a site: as `known` up to `enough`; beyond, of all elements of the site."""
        missed = (known > enough).nonzero()[0]
        if not len(missed):
            return known
        result = known.copy()
        for number in np.unique(site[missed]).tolist():
            chosen = missed[site[missed] == number]
            elements = slice(*np.searchsorted(self.site, (number, number + 1)).tolist())
            start, chord = self.start[elements], self.chord[elements]
            portion = max(1, _AT_ONCE // len(start))
            for part in np.split(chosen, range(portion, len(chosen), portion)):
                result[part] = distances(places[part, None], start, chord).min(axis=1)
        return result


def distances_of_claims(
    lattice: Lattice, motions: Motions, tree: BoxTree, sites: Sites, claims: Claims, slack: float
) -> Floats:
    """The distances of points from what is nearest to them and from the two sites they claim, float64 (3, n).

    Those from sites are right up to that from the nearest and the slack. The copies are as in `nearest_copies`. A
    compiled kernel gives the same bits.
    """
    compiled = _COMPILED()
    if compiled is None:
        found = nearest_copies(lattice, motions, tree, claims.places[0], slack)
        among = (sites.among(found, *side) for side in zip(claims.places, claims.sites, strict=True))
        return np.stack((found.distance, *among))
    near = _NEAR * lattice.reduced.det / max(map(abs, lattice.reduced_basis))
    count = claims.places.shape[1]
    result = np.empty((3, count))
    failed = compiled(
        *(count, claims.places, claims.sites, len(motions[0]), *motions, np.array(lattice.reduced_basis)),
        *(*steps_around(lattice, tree, (_NEAR, _NEAR)), near, slack),
        *(len(tree.start), tree.start, tree.chord, tree.element),
        *(sites.site, sites.start, sites.chord, result),
    )
    if failed:
        raise MemoryError
    return result


def _neighbours(lattice: Lattice, tiles: Sequence[LocalTile]) -> tuple[Ints, list[int], list[Isometry]]:
    """For each arc the number of its neighbour, intp (n,); of each neighbour its site and what takes that to it."""
    number = {tile.name: k for k, tile in enumerate(tiles)}
    neighbours: list[Ints] = []
    sites: list[int] = []
    isometries: list[Isometry] = []
    for tile in tiles:
        neighbours.append(tile.outline.neighbour + len(sites))
        sites += [number[name] for name, _ in tile.outline.neighbours]
        isometries += [lattice.isometry(operation) for _, operation in tile.outline.neighbours]
    return np.concatenate(neighbours), sites, isometries

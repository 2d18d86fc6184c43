"""How far the points of edges are from the site, from the copy beyond, and from whatever is nearest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.box_join import z_order
from voronoi_tiles.base.maps import Isometry, move
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.box_tree import BoxTree, combination
from voronoi_tiles.vector.nearest_copies import NearestCopies, distances, nearest_copies
from voronoi_tiles.vector.tessellation import LocalTile

# Where on an arc its points are tested; its end is the next one's start.
_PARAMETERS = np.array([0.0, 0.25, 0.5, 0.75])
# So many times the limit of an error an element may be farther than the nearest one and still be taken into account.
_SLACK = 10.0
_AT_ONCE = 1 << 20  # pairs of a point and an element: tens of megabytes


def errors_of_distance(
    group: WallpaperGroup, lattice: Lattice, tiles: Sequence[LocalTile], limit: float
) -> tuple[float, float]:
    """The largest error of equidistance, and by how much any copy is too near, in units, over points of all edges.

    `limit` is what the proof accepts of either.
    """
    tiles = _side_by_side(lattice, tiles)
    elements = [_elements(tile) for tile in tiles]
    site = np.repeat(np.arange(len(tiles)), [len(start) for start, _ in elements])
    start, end = (np.concatenate(ends) for ends in zip(*elements, strict=True))
    tree = BoxTree.of(lattice, start, end)
    arcs = AllArcs.of([tile.outline for tile in tiles])
    arc = np.repeat(np.arange(len(arcs)), len(_PARAMETERS))
    points = arcs.at(arc, np.tile(_PARAMETERS, len(arcs)))
    x, y = (np.round(share) for share in lattice.reduced.fractional(np.array([tile.nodes[0] for tile in tiles])))
    vector = combination(*lattice.reduced_basis, x, y)
    inverses = [lattice.isometry(operation.inverse()) for operation in group.operations]
    found = nearest_copies(lattice, inverses, tree, points - vector[arcs.tile[arc]], _SLACK * limit)

    sites = _Sites(site, start, end - start)
    beyond, unit, shift, conj = (column[arc] for column in _neighbours(lattice, tiles))
    here = sites.distances(points, arcs.tile[arc], found, _SLACK * limit)
    there = sites.distances(move(points, unit, shift, conj), beyond, found, _SLACK * limit)
    return float(np.abs(here - there).max()), float((here - found.distance).max())


@dataclass(frozen=True, slots=True)
class _Sites:
    """The elements of all sites in their places: `site` (intp, m), in order, `start` and `chord` (complex128, m)."""

    site: Ints
    start: Complexes
    chord: Complexes

    def distances(self, points: Complexes, site: Ints, found: NearestCopies, slack: float) -> Floats:
        """The distance of each point from one of the sites, float64 (n,).

        Where the nearest of all copies was found at this distance or less, but for the slack, an element of the pairs
        found is the nearest of the site as well; from elsewhere one looks at all elements.
        """
        result = np.full(len(points), np.inf)
        of = self.site[found.element] == site[found.point]
        point, element = found.point[of], found.element[of]
        np.minimum.at(result, point, distances(points[point], self.start[element], self.chord[element]))
        missed = np.flatnonzero(result > found.distance + slack)
        for number in np.unique(site[missed]).tolist():
            chosen = missed[site[missed] == number]
            elements = slice(*np.searchsorted(self.site, (number, number + 1)).tolist())
            start, chord = self.start[elements], self.chord[elements]
            portion = max(1, _AT_ONCE // len(start))
            for part in np.split(chosen, range(portion, len(chosen), portion)):
                result[part] = distances(points[part, None], start, chord).min(axis=1)
        return result


def _side_by_side(lattice: Lattice, tiles: Sequence[LocalTile]) -> list[LocalTile]:
    """The tiles in an order in which those are near each other, modulo the lattice, that follow each other."""
    if len(tiles) == 1:
        return list(tiles)
    x, y = lattice.reduced.fractional(np.array([tile.nodes[0] for tile in tiles]))
    order = z_order(combination(*lattice.reduced_basis, x - np.round(x), y - np.round(y)))
    return [tiles[k] for k in order.tolist()]


def _elements(tile: LocalTile) -> tuple[Complexes, Complexes]:
    """The two ends of the site's elements: of its segments, and twice the same of nodes that are in none."""
    alone = np.ones(len(tile.nodes), bool)
    alone[tile.segments] = False
    points = tile.nodes[alone]
    start, end = tile.nodes[tile.segments].T
    return np.concatenate((start, points)), np.concatenate((end, points))


def _neighbours(lattice: Lattice, tiles: Sequence[LocalTile]) -> tuple[Ints, Complexes, Complexes, Bools]:
    """For each arc the site of its neighbour, and the isometry that takes the neighbour back to that site.

    The numbers of sites, intp (n,), and the isometries as unit and shift, complex128 (n,), and conj, bool (n,).
    """
    number = {tile.name: k for k, tile in enumerate(tiles)}
    isometries: dict[Operation, Isometry] = {}
    rows, sites, which = [], [], 0
    for tile in tiles:
        rows.append(tile.outline.neighbour + which)
        which += len(tile.outline.neighbours)
        for name, operation in tile.outline.neighbours:
            if operation not in isometries:
                isometries[operation] = lattice.isometry(operation.inverse())
            sites.append((number[name], *isometries[operation]))
    row = np.concatenate(rows)
    site, unit, shift, conj = (np.array(column)[row] for column in zip(*sites, strict=True))
    return site, unit, shift, conj

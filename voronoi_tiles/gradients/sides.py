"""The copies on the two sides of a tile's edges, as images of the sites that are drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.vector.arcs import Neighbour


class TileOfSite(NamedTuple):
    """The name of a site, and the operations that map it onto itself, the identity first."""

    name: str
    symmetry: tuple[Operation, ...]


@dataclass(frozen=True, eq=False)
class Sides:
    """For each of n neighbours of a tile the images of sites on both sides of their edges, m at most.

    A site that operations map onto itself is as many images of what is drawn, all in one place: what a change of its
    strokes does is the mean over them, which is the change's symmetric part. The first `own` images are those of the
    tile's site. An image is that of `site` (intp) under z -> unit z + shift, or unit conj(z) + shift where `conj`; its
    `translation` (float64, n x m x 2) is in fractions of the cell. `weight` is its share, > 0 for the tile's own, < 0
    for the neighbour's, and 0 for none.
    """

    own: int
    site: Ints
    unit: Complexes
    shift: Complexes
    conj: Bools
    translation: Floats
    weight: Floats

    @classmethod
    def of(cls, tile: int, sites: Sequence[TileOfSite], neighbours: Sequence[Neighbour], lattice: Lattice) -> Sides:
        """The sides of the edges of a tile, by its number among the sites."""
        number: Mapping[str, int] = {site.name: k for k, site in enumerate(sites)}
        own = len(sites[tile].symmetry)
        width = own + max((len(sites[number[name]].symmetry) for name, _ in neighbours), default=0)
        shape = (len(neighbours), width)
        site, conj, weight = np.zeros(shape, np.intp), np.zeros(shape, bool), np.zeros(shape)
        unit, shift, translation = np.ones(shape, complex), np.zeros(shape, complex), np.zeros((*shape, 2))
        for row, (name, beyond) in enumerate(neighbours):
            there = number[name]
            images = [(tile, operation, 1.0 / own) for operation in sites[tile].symmetry]
            others = sites[there].symmetry
            images += [(there, beyond @ operation, -1.0 / len(others)) for operation in others]
            for column, (of, operation, share) in enumerate(images):
                isometry = lattice.isometry(operation)
                at = row, column
                site[at], weight[at], conj[at] = of, share, isometry.conj
                unit[at], shift[at] = isometry.a, isometry.b
                translation[at] = [float(part) for part in operation.translation]
        return cls(own, site, unit, shift, conj, translation, weight)

    def back(self, points: Complexes, neighbour: Ints) -> Complexes:
        """Points on edges with neighbours, complex128 (k,), as each image's site sees them: complex128 (k, m)."""
        back = (points[:, None] - self.shift[neighbour]) * self.unit[neighbour].conj()
        return np.where(self.conj[neighbour], back.conj(), back)

    def forth(self, directions: Complexes, neighbour: Ints) -> Complexes:
        """Directions as the images' sites see them, complex128 (k, m), where the images are."""
        return self.unit[neighbour] * np.where(self.conj[neighbour], directions.conj(), directions)

"""The proof that a result is right: figures computed from the finished outlines, not from the engine's steps.

Equidistance and emptiness show that every edge lies on the boundary of the true tile. So each connected part of the
true tile is either inside its outline or outside, and as it holds a stroke of the site, and all strokes are inside,
it is inside; the outline can only be too large, and the area identity says that it is not. Closure, crossings and the
bit-for-bit agreement of shared edges show that what is cut is that outline. Which element is nearest is found by a
search of the proof's own, over all copies of all sites.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from voronoi_tiles.base.arrays import Complexes, next_in_ring
from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.base.tolerance import PROOF_LIMIT
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.all_nodes import AllNodes
from voronoi_tiles.vector.crossings import count_crossings
from voronoi_tiles.vector.equidistance import errors_of_distance
from voronoi_tiles.vector.strayed import strayed_parts
from voronoi_tiles.vector.tessellation import TileRecord, tessellate


def proved_tiles(
    sites: Sequence[NodedSite], group: WallpaperGroup, lattice: Lattice
) -> tuple[list[TileRecord], ProofReport]:
    """The tile of each site, and the proof that they are right.

    Raises TouchingCopiesError where two copies touch, ProofError where the result fails its proof.
    """
    tiles = tessellate(sites, group, lattice)
    proof = prove(group, lattice, tiles)
    if not proof.passed:
        tiles[0].refuse_touching()
        tiles = tessellate(sites, group, lattice, without_short=True)
        proof = prove(group, lattice, tiles)
    if not proof.passed:
        raise ProofError("the result failed its proof: " + "; ".join(proof.failures), proof)
    return tiles, proof


def figures_document(rows: Iterable[tuple[str, float, float, bool]]) -> list[dict[str, Any]]:
    """Figures, each a name, a value, a limit and whether it holds, in the types of JSON."""
    return [{"name": name, "value": value, "limit": limit, "passed": passed} for name, value, limit, passed in rows]


@dataclass(frozen=True, slots=True)
class ProofReport:
    """The figures of a proof.

    `area` is the relative error of the tiles' areas, which must add up to the cell's. `equidistance` is the largest
    difference of the distances from an edge's points to the site and to the copy beyond, relative to the longer of the
    cell's vectors; `emptiness` is by how much any other copy is nearer to such a point, on the same scale, 0 where none
    is.

    The others are counts: of arcs whose end is not, bit for bit, the start of the next (`open_joints`), of places where
    an outline crosses itself (`crossings`), of connected parts of sites that are not inside their tiles' outlines
    (`strayed`), of arcs that the tile beyond does not have, bit for bit, as its own (`unshared`).
    """

    area: float
    equidistance: float
    emptiness: float
    open_joints: int
    crossings: int
    strayed: int
    unshared: int

    def rows(self) -> list[tuple[str, float, float, bool]]:
        """For each figure its name, value, limit and whether it holds."""
        figures = [
            ("area", self.area, PROOF_LIMIT),
            ("equidistance", self.equidistance, PROOF_LIMIT),
            ("emptiness", self.emptiness, PROOF_LIMIT),
            ("open joints", self.open_joints, 0),
            ("crossings", self.crossings, 0),
            ("strayed strokes", self.strayed, 0),
            ("unshared edges", self.unshared, 0),
        ]
        # Written so that NaN fails.
        return [(name, value, limit, bool(value <= limit)) for name, value, limit in figures]

    def document(self) -> list[dict[str, Any]]:
        """The figures in the types of JSON: each with "name", "value", "limit" and "passed"."""
        return figures_document(self.rows())

    @property
    def passed(self) -> bool:
        """Whether every figure holds."""
        return not self.failures

    @property
    def failures(self) -> tuple[str, ...]:
        """One sentence for each figure that does not hold."""
        return tuple(
            f"{name} is {value:.3g}, the limit {limit:.3g}" for name, value, limit, holds in self.rows() if not holds
        )


def prove(group: WallpaperGroup, lattice: Lattice, records: Sequence[TileRecord]) -> ProofReport:
    """The proof's figures for the tiles of all sites of a design."""
    size = max(abs(lattice.a), abs(lattice.b))
    tiles = [record.local() for record in records]
    arcs = AllArcs.of([tile.outline for tile in tiles])
    nodes = AllNodes.of(tiles)
    copies = np.array([group.order // len(record.symmetry) for record in records])
    equidistance, emptiness = errors_of_distance(group, lattice, tiles, nodes, arcs, PROOF_LIMIT * size)
    return ProofReport(
        area=abs(arcs.area(copies) - lattice.det) / lattice.det,
        equidistance=equidistance / size,
        emptiness=emptiness / size,
        open_joints=open_joints(arcs),
        crossings=count_crossings(arcs, size),
        strayed=strayed_parts(tiles, nodes, arcs, size),
        unshared=_unshared(arcs, records[0].tessellation.counterparts()),
    )


def open_joints(arcs: AllArcs) -> int:
    """The number of arcs whose end is not, bit for bit, the start of the next of their ring."""
    return int(np.count_nonzero(arcs.end != arcs.start[next_in_ring(arcs.ring_offsets)]))


def _unshared(arcs: AllArcs, counterparts: tuple[Complexes, Complexes, Complexes]) -> int:
    """The number of arcs that the tiles beyond do not have, reversed, bit for bit; all, where these have others."""
    if len(counterparts[0]) != len(arcs):
        return len(arcs)
    start, control, end = counterparts
    # Written so that NaN fails.
    same = (start == arcs.start) & (control == arcs.control) & (end == arcs.end)
    return len(arcs) - int(np.count_nonzero(same))

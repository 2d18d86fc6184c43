"""The engine's entry: from sites and a group to their tessellation, and to the outline of one tile of each site.

A `Tessellation` is what the engine computes: all tiles in terms of exact motions, not proved yet. A `TileRecord` is the
tile of one of its sites where the design has it, a `LocalTile` the same tile where it was computed, near the origin:
that one is proved. What users hold is a `voronoi_tiles.tiling.Tiling`, the tiles of a design with their proof.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, offsets_of
from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.base.maps import move
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.tolerance import SAME_POINT
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.vector.arcs import Neighbour
from voronoi_tiles.vector.cells.bisectors import TouchingElementsError
from voronoi_tiles.vector.cells.cells import Parts, UnboundedCellError, bound_cells
from voronoi_tiles.vector.cells.half_edges import Contour, enclosed, trace_contour
from voronoi_tiles.vector.cells.pencils import Rows, make_rows
from voronoi_tiles.vector.cells.touching import refuse_touching
from voronoi_tiles.vector.cells.trace import OpenBoundaryError, trace_boundary
from voronoi_tiles.vector.complex.boundary import TileBoundary
from voronoi_tiles.vector.complex.edges import UnpairedEdgeError, find_edges
from voronoi_tiles.vector.complex.period import Period, make_period
from voronoi_tiles.vector.complex.quotient import Quotient, build_quotient
from voronoi_tiles.vector.complex.traced import Traced, clearance, with_curves
from voronoi_tiles.vector.copies import Copies, Placed, copies_near, place, translation
from voronoi_tiles.vector.motions import (
    IDENTITY,
    Action,
    Motion,
    compose,
    modulo_lattice,
    to_motion,
    to_operation,
)
from voronoi_tiles.vector.outline import Outline

# A gap this small between copies, relative to the cell's size, makes the engine look whether they touch.
_SUSPICIOUS = 1e-9


@dataclass(frozen=True, eq=False)
class TileRecord:
    """The tile of the base site of a name, where the design has it.

    `symmetry` are the operations that map the site onto itself, the identity first; `tessellation` is what the tile
    belongs to.
    """

    name: str
    outline: Outline
    symmetry: tuple[Operation, ...]
    tessellation: Tessellation
    _index: int

    def copy(self, operation: Operation) -> Outline:
        """The outline of the copy of this tile onto which an operation of the group takes it.

        Where two copies share an edge, its points are the same in both, bit for bit. Raises ValueError where the group
        has no such operation.
        """
        motion = to_motion(operation)
        action = self.tessellation.action
        if modulo_lattice(motion) not in action.motions:
            raise ValueError(f"{operation} is no operation of the group {action.group.name}")
        return self.tessellation.outline(self._index, motion)

    def refuse_touching(self) -> None:
        """Raise TouchingCopiesError if any copies touch."""
        tessellation = self.tessellation
        refuse_touching(tessellation.action, tessellation.names, tessellation.placed)

    def local(self) -> LocalTile:
        """The same tile where it was computed."""
        return LocalTile(self.name, self.tessellation, self._index)


@dataclass(frozen=True, eq=False)
class LocalTile:
    """A tile and its site where they were computed: moved by the lattice to near the origin, where rounding is least.

    Operations, those of neighbours as well, are on sites in these places.
    """

    name: str
    _tessellation: Tessellation
    _index: int

    @property
    def nodes(self) -> Complexes:
        """The site's nodes, complex128 (m,)."""
        return self._tessellation.placed[self._index].nodes

    @property
    def segments(self) -> Ints:
        """The site's segments, as indices of nodes, intp (n, 2)."""
        return self._tessellation.placed[self._index].segments

    @cached_property
    def outline(self) -> Outline:
        """The outline of the tile."""
        return self._tessellation.placed_outline(self._index, IDENTITY)

    def copy(self, operation: Operation) -> Outline:
        """The outline of a copy."""
        return self._tessellation.placed_outline(self._index, to_motion(operation))


@dataclass(frozen=True, eq=False)
class Tessellation:
    """What the engine computes: all tiles of the plane, as images of the quotient complex of their edges.

    The sites have `names` and are `placed` near the origin. The proof is not part of it.
    """

    action: Action
    names: tuple[str, ...]
    placed: list[Placed]
    quotient: Quotient

    @cached_property
    def _boundaries(self) -> list[TileBoundary]:
        """The boundary of each site's base tile."""
        return [TileBoundary.of(self.quotient, tile) for tile in range(len(self.placed))]

    @cached_property
    def period(self) -> Period:
        """The tiles of one cell, with the edges that they share."""
        return make_period(self.action, self.placed, self.quotient)

    def placed_outline(self, tile: int, motion: Motion) -> Outline:
        """The outline of a copy of a tile, named by a motion of the placed site."""
        boundary = self._boundaries[tile]
        # The copy, not the motion that names it, decides on the bits.
        here = self.placed[tile].canonical(motion)
        neighbours = tuple(
            Neighbour(self.names[t], to_operation(self.placed[t].canonical(compose(here, beyond))))
            for t, beyond in boundary.neighbours
        )
        return boundary.outline(here, neighbours)

    def outline(self, tile: int, motion: Motion) -> Outline:
        """The outline of a copy of a tile, named by a motion of the site as it was drawn."""
        outline = self.placed_outline(tile, compose(motion, translation(self.placed[tile], 1)))
        if all(placed.shift == (0, 0) for placed in self.placed):
            return outline
        back = {
            name: to_operation(translation(placed, -1)) for name, placed in zip(self.names, self.placed, strict=True)
        }
        neighbours = tuple(Neighbour(name, operation @ back[name]) for name, operation in outline.neighbours)
        return replace(outline, neighbours=neighbours)


def tessellate(
    sites: Sequence[NodedSite], group: WallpaperGroup, lattice: Lattice, *, without_short: bool = False
) -> list[TileRecord]:
    """The tile of each site of a design: all that is nearer to it than to any other copy of any site.

    `without_short` leaves out edges that are so short that rounding may have made them: beside copies that nearly
    touch, two neighbours may take turns along an edge by rounding alone; a proof tells. Raises TouchingCopiesError
    where two copies touch or cross, ProofError where no boundary was found, which is not known to happen to any design.
    """
    action = Action(group, lattice)
    placed = [place(action, site.nodes, site.segments) for site in sites]
    names = tuple(site.name for site in sites)
    try:
        contours = [trace_contour(p.nodes, p.segments) for p in placed]
        found = [_trace(action, placed, contours, tile) for tile in range(len(sites))]
        traced, edges = find_edges(action, placed, [boundary for boundary, _ in found], without_short=without_short)
    except (TouchingElementsError, UnboundedCellError, OpenBoundaryError, UnpairedEdgeError) as error:
        refuse_touching(action, names, placed)
        raise ProofError(
            "the boundary of a tile does not close, though no copies touch; please report this design"
        ) from error
    if min(clearance for _, clearance in found) < _SUSPICIOUS * action.size:
        refuse_touching(action, names, placed)
    tessellation = Tessellation(action, names, placed, build_quotient(action, traced, edges))
    return [
        TileRecord(
            name=name,
            outline=tessellation.outline(tile, IDENTITY),
            symmetry=tuple(
                to_operation(compose(compose(translation(p, 1), m), translation(p, -1))) for m in p.stabilizer
            ),
            tessellation=tessellation,
            _index=tile,
        )
        for tile, (name, p) in enumerate(zip(names, placed, strict=True))
    ]


def _trace(action: Action, placed: list[Placed], contours: list[Contour], tile: int) -> tuple[Traced, float]:
    """The boundary of one tile, and the site's distance from the nearest of its vertices."""
    contour = contours[tile]
    copies = [copies_near(action, placed[tile], other) for other in placed]
    images = [
        move(other.nodes, near.unit[:, None], near.shift[:, None], near.conj[:, None])
        for other, near in zip(contours, copies, strict=True)
    ]
    strangers = [nodes.reshape(-1) for t, nodes in enumerate(images) if t != tile]
    siblings = images[tile][1:].reshape(-1)
    inside = enclosed(contour, np.concatenate([np.zeros(0, complex), *strangers]), siblings)
    rows = make_rows(contour, action.covering_radius, inside)
    parts = _bound_cells_of_one(action, placed, contours, tile, copies, rows)
    inner = (parts.target == tile) & (parts.copy == 0)
    # Beside the shorter vector of the cell: an edge as long as the longer one may turn about what is left out.
    boundary = trace_boundary(rows, contour, parts, inner, SAME_POINT * abs(action.lattice.reduced_basis[0]))
    return with_curves(boundary, rows, contours, tile, parts, copies), clearance(boundary, rows, parts)


@dataclass(frozen=True, slots=True)
class _PartsOfOne(Parts):
    """Parts of one site's rows: beyond part k lies the item `item[k]` of the copy `copy[k]` of the site `target[k]`."""

    target: Ints


def _bound_cells_of_one(
    action: Action, placed: list[Placed], contours: list[Contour], tile: int, near: list[Copies], rows: Rows
) -> _PartsOfOne:
    """What bounds the cells of one site, by the search of all sites: each site is a bundle of its own."""
    counts = np.array([len(p.segments) for p in placed])
    half_edges, nodes = offsets_of(2 * counts), offsets_of([len(p.nodes) for p in placed])
    lone = offsets_of([len(c.corner_node) - len(c.source) for c in contours])
    everything = trace_contour(
        np.concatenate([p.nodes for p in placed]),
        np.concatenate([p.segments + first for p, first in zip(placed, nodes, strict=False)]),
    )
    node_bundle = np.repeat(np.arange(len(placed)), np.diff(nodes))
    # The copies near the site that are not where they were placed, behind the identities.
    others = [np.flatnonzero((copies.motions != IDENTITY).any(axis=1)) for copies in near]
    bundle = np.repeat(np.arange(len(near)), [len(index) for index in others])
    still = np.ones(len(near), bool)
    copies = Copies(
        motions=np.concatenate(
            [np.tile(IDENTITY, (len(near), 1)), *(c.motions[i] for c, i in zip(near, others, strict=True))]
        ),
        unit=np.concatenate([still.astype(complex), *(c.unit[i] for c, i in zip(near, others, strict=True))]),
        shift=np.concatenate([0j * still, *(c.shift[i] for c, i in zip(near, others, strict=True))]),
        conj=np.concatenate([~still, *(c.conj[i] for c, i in zip(near, others, strict=True))]),
        bundle=np.append(np.arange(len(near)), bundle),
    )
    split, count = 2 * len(placed[tile].segments), half_edges[-1]
    shifted = replace(
        rows,
        half_edge=np.where(rows.half_edge >= 0, rows.half_edge + half_edges[tile], -1),
        corner=np.where(
            rows.corner >= split,
            rows.corner - split + count + lone[tile],
            np.where(rows.corner >= 0, rows.corner + half_edges[tile], -1),
        ),
    )
    parts = bound_cells(shifted, everything, copies, node_bundle, action.covering_radius)
    item = parts.item
    corner = np.where(item >= count, item - count, item)
    target = node_bundle[
        np.concatenate((everything.corner_node, everything.source))[
            corner + (item < count) * len(everything.corner_node)
        ]
    ]
    there = 2 * counts[target]
    local = np.where(corner >= count, corner - count - lone[target] + there, corner - half_edges[target])
    # Back to the numbers of the copies near the site.
    number = np.zeros(len(copies), np.intp)
    number[len(near) :] = np.concatenate(others)
    for t, known in enumerate(near):
        own = np.flatnonzero((known.motions == IDENTITY).all(axis=1))
        number[t] = own[0] if len(own) else 0
    return _PartsOfOne(
        parts.row, number[parts.copy], np.where(item >= count, there + local, local), parts.begin, parts.end, target
    )

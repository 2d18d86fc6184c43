"""The engine's entry: from sites and a group to their tessellation, and to the outline of one tile of each site.

A `Tessellation` is what the engine computes: all tiles in terms of exact motions, not proved yet. A `TileRecord` is the
tile of one of its sites where the design has it, a `LocalTile` the same tile where it was computed, near the origin:
that one is proved. What users hold is a `voronoi_tiles.tiling.Tiling`, the tiles of a design with their proof.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.tolerance import SAME_POINT
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.vector.arcs import Neighbour
from voronoi_tiles.vector.cells.bisectors import TouchingElementsError
from voronoi_tiles.vector.cells.cells import UnboundedCellError, bound_cells
from voronoi_tiles.vector.cells.enclosures import enclosed
from voronoi_tiles.vector.cells.half_edges import trace_contour
from voronoi_tiles.vector.cells.pencils import make_rows
from voronoi_tiles.vector.cells.touching import refuse_touching
from voronoi_tiles.vector.cells.trace import OpenBoundaryError, trace_boundary
from voronoi_tiles.vector.complex.approximation import approximated
from voronoi_tiles.vector.complex.boundary import TileBoundaries
from voronoi_tiles.vector.complex.edges import UnpairedEdgeError, find_edges
from voronoi_tiles.vector.complex.period import Period, make_period
from voronoi_tiles.vector.complex.quotient import Quotient, build_quotient
from voronoi_tiles.vector.complex.site_symmetry import SiteSymmetry
from voronoi_tiles.vector.complex.traced import Traced, clearance, with_curves
from voronoi_tiles.vector.copies import Placed, SiteUnion, bundles, copies_near, place, translation
from voronoi_tiles.vector.motion_codes import motion_of, operation_of
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
        return self._tessellation.placed_outlines[self._index]


@dataclass(frozen=True, eq=False)
class Tessellation:
    """What the engine computes: all tiles of the plane, as images of the quotient complex of their edges.

    The sites have `names` and are `placed` near the origin, and `symmetry` is what maps them onto themselves. The proof
    is not part of it.
    """

    action: Action
    names: tuple[str, ...]
    placed: list[Placed]
    symmetry: SiteSymmetry
    quotient: Quotient

    @cached_property
    def boundaries(self) -> TileBoundaries:
        """The boundaries of the sites' base tiles."""
        return TileBoundaries.of(self.quotient)

    @cached_property
    def period(self) -> Period:
        """The tiles of one cell, with the edges that they share."""
        return make_period(self.action, self.placed, self.quotient)

    def approximated(self, fit: Callable[[Paths], Paths]) -> Period:
        """The period with the curves that `fit` gives for its exact edges, as `voronoi_tiles.vector.complex` has them.

        It takes longer than all else that is done for a sheet: that of the last fit is kept, for one that is equal.
        """
        kept = self._approximations
        period = kept.get(fit)
        if period is None:
            period = approximated(self.period, self.quotient, fit)
            kept.clear()
            kept[fit] = period
        return period

    @cached_property
    def _approximations(self) -> dict[Callable[[Paths], Paths], Period]:
        """The period with other curves, by what gave them: the last one alone."""
        return {}

    @cached_property
    def placed_outlines(self) -> list[Outline]:
        """The outlines of all base tiles, in the places of their sites."""
        boundaries = self.boundaries
        names = [
            Neighbour(self.names[site], operation_of(motion))
            for site, motion in zip(boundaries.site.tolist(), boundaries.motion.tolist(), strict=True)
        ]
        bounds = boundaries.face_offsets.tolist()
        return boundaries.outlines(IDENTITY, [tuple(names[first:last]) for first, last in pairwise(bounds)])

    @cached_property
    def outlines(self) -> list[Outline]:
        """The outlines of all base tiles, where their sites were drawn."""
        if all(placed.shift == (0, 0) for placed in self.placed):
            return self.placed_outlines
        return [self.outline(tile, IDENTITY) for tile in range(len(self.placed))]

    def placed_outline(self, tile: int, motion: Motion) -> Outline:
        """The outline of a copy of a tile, named by a motion of the placed site."""
        # The copy, not the motion that names it, decides on the bits.
        here = self.placed[tile].canonical(motion)
        boundary = self.boundaries.of_tile(tile)
        neighbours = tuple(
            Neighbour(self.names[t], to_operation(self.placed[t].canonical(compose(here, motion_of(beyond)))))
            for t, beyond in zip(boundary.site.tolist(), boundary.motion.tolist(), strict=True)
        )
        return boundary.outlines(here, [neighbours])[0]

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

    def counterparts(self) -> tuple[Complexes, Complexes, Complexes]:
        """Of each arc of all `placed_outlines` the one that the tile beyond has there, reversed.

        That is start, control and end, complex128 (n,), as that tile's own boundary has them; NaN where it has none.
        """
        return self.boundaries.counterparts(self.symmetry)


def tessellate(
    sites: Sequence[NodedSite], group: WallpaperGroup, lattice: Lattice, *, without_short: bool = False
) -> list[TileRecord]:
    """The tile of each site of a design: all that is nearer to it than to any other copy of any site.

    `without_short` leaves out edges that are so short that rounding may have made them: beside copies that nearly
    touch, two neighbours may take turns along an edge by rounding alone; a proof tells. Raises TouchingCopiesError
    where two copies touch or cross, ProofError where no boundary was found, which is not known to happen to any design.
    """
    action = _action(group, lattice)
    placed, union = place(action, sites)
    names = tuple(site.name for site in sites)
    symmetry = SiteSymmetry.of(placed)
    try:
        traced, least = _trace(action, placed, union)
        if least < _SUSPICIOUS * action.size:
            refuse_touching(action, names, placed)
        edges = find_edges(action, symmetry, traced, without_short=without_short)
    except (TouchingElementsError, UnboundedCellError, OpenBoundaryError, UnpairedEdgeError) as error:
        refuse_touching(action, names, placed)
        raise ProofError(
            "the boundary of a tile does not close, though no copies touch; please report this design"
        ) from error
    tessellation = Tessellation(action, names, placed, symmetry, build_quotient(action, len(placed), edges))
    return [
        TileRecord(
            name=name,
            outline=tessellation.outlines[tile],
            symmetry=tuple(
                to_operation(compose(compose(translation(p, 1), m), translation(p, -1))) for m in p.stabilizer
            ),
            tessellation=tessellation,
            _index=tile,
        )
        for tile, (name, p) in enumerate(zip(names, placed, strict=True))
    ]


@lru_cache(maxsize=16)
def _action(group: WallpaperGroup, lattice: Lattice) -> Action:
    """A group over a lattice: what is found out about them serves all designs that have them, as while one is drawn."""
    return Action(group, lattice)


def _trace(action: Action, placed: list[Placed], union: SiteUnion) -> tuple[Traced, float]:
    """The boundaries of all tiles, and the least distance of a site from a vertex of its own."""
    contour, node_bundle = trace_contour(union.nodes, union.segments), bundles(placed)[union.node_site]
    copies = copies_near(action, placed, union.nodes, node_bundle)
    rows = make_rows(contour, action.covering_radius, enclosed(contour, copies, union.node_site, node_bundle))
    parts = bound_cells(rows, contour, copies, node_bundle, action.covering_radius)
    # Beside the shorter vector of the cell: an edge as long as the longer one may turn about what is left out.
    null = SAME_POINT * abs(action.lattice.reduced_basis[0])
    boundary = trace_boundary(rows, contour, parts, union.node_site, copies.bundles, null)
    traced = with_curves(boundary, rows, contour, parts, copies, union.node_site)
    return traced, clearance(boundary, rows, parts)

"""Lofts: solids whose cross-sections are the exact tiles of strokes that move with the height."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import chain, pairwise
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.design import Design
from voronoi_tiles.solid.approach import Approach, approach
from voronoi_tiles.solid.assembly import LoftLevel, LoftTile, levels_of, solids_of
from voronoi_tiles.solid.events import LoftError, events_between
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.motion import Motion
from voronoi_tiles.solid.sections import crossed_sections
from voronoi_tiles.solid.vertices import Vertices
from voronoi_tiles.vector.complex.representatives import Points
from voronoi_tiles.vector.motion_codes import code_of, composed, motion_of
from voronoi_tiles.vector.motions import reverses_orientation, to_motion

ACCURACY_MM: Final = 0.05
"""How far chords of a layer are from its arcs where nobody says; millimetres. What a printer's nozzle cannot show."""

_ROUNDS: Final = 8
"""How often layers are added, or chords made finer, at most; a count."""


@dataclass(frozen=True, eq=False)
class Loft:
    """The solids of a design's sites, in the places where these are drawn."""

    design: Design
    motion: Motion
    approach: Approach
    levels: tuple[LoftLevel, ...]
    vertices: Vertices
    tiles: tuple[LoftTile, ...]

    @cached_property
    def meshes(self) -> tuple[TriangleMesh, ...]:
        """The mesh of each site, in millimetres."""
        return tuple(self._mesh(tile.points, tile.triangles) for tile in self.tiles)

    def image(self, site: int, operation: Operation | str) -> TriangleMesh:
        """The mesh of the copy of a site's solid under an operation of the group, in millimetres.

        What two copies share has the same numbers in both, bit for bit.
        """
        if isinstance(operation, str):
            operation = Operation.parse(operation)
        tile = self.tiles[site]
        motion = to_motion(operation)
        # The copy, not the motion that names it, decides on the vertices.
        placed = self.levels[0].core.stabilizers[site]
        code = int(composed(np.array([code_of(motion)]), np.array(placed)).min())
        triangles = tile.triangles[:, [0, 2, 1]] if reverses_orientation(motion_of(code)) else tile.triangles
        return self._mesh(tile.points.moved(np.full(len(tile.points), code)), triangles)

    def _mesh(self, points: Points, triangles: Ints) -> TriangleMesh:
        return TriangleMesh(self.vertices.located(points) * self.design.unit_mm, triangles)


def lofted(design: Design, *, accuracy: float = ACCURACY_MM, heights: Iterable[float] = ()) -> Loft:
    """The solids of a design that has one; chords of layers are within `accuracy` millimetres of their arcs.

    There is an exact layer at each of `heights`, in the design's units, besides those that the design asks for. Where
    walls would cross between two layers there is one more, and where chords cross in one they are finer. Raises
    ArgumentError for a flat design and for heights outside of the solid, LoftError with the height where copies meet,
    or where tiles change in a way that has no walls.
    """
    motion = Motion.of(design)
    exact = motion.heights_with(heights)

    @cache
    def layer_at(z: float) -> ExactLayer:
        own = () if z == 0.0 else layer_at(0.0).stabilizers
        try:
            return ExactLayer.of(z, motion.at(z), design.group, design.lattice, own)
        except TouchingCopiesError as error:
            raise LoftError(str(error).partition(". ")[0], z, remedy="Copies must keep apart at all heights.") from None

    layers = [layer_at(z) for z in exact]
    for layer in layers:
        if layer.stabilizers != layers[0].stabilizers:
            raise LoftError("copies of a site coincide", layer.z, remedy="Copies must keep apart at all heights.")
    nearest = approach(motion, layers[0].action, layers[0].stabilizers, exact)
    for _ in range(_ROUNDS):
        layers = [layer_at(z) for z in exact]
        events = [events_between(low, high, layer_at, motion.height) for low, high in pairwise(layers)]
        levels = levels_of(layers, events)
        solids = solids_of([site.name for site in design.noded], levels, accuracy / design.unit_mm)
        loft = Loft(design, motion, nearest, tuple(levels), *solids)
        crossed = [crossed_sections(mesh) for mesh in loft.meshes]
        if not any(map(len, chain(*crossed))):
            return loft
        exact = sorted({*exact, *(z / design.unit_mm for sections in crossed for z in sections.between.tolist())})
        if any(len(sections.levels) for sections in crossed):
            accuracy /= 4
    at = next(chain(*chain(*crossed)))
    raise LoftError("walls cross", at / design.unit_mm, remedy="Write more `layers`, or draw keys that differ less.")

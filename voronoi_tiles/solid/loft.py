"""Lofts: solids whose cross-sections are the exact tiles of strokes that move with the height."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from math import ceil
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.solid_checking import LAYERS_MAX
from voronoi_tiles.solid.approach import Approach, approach
from voronoi_tiles.solid.assembly import LoftLevel, LoftTile, levels_of, solids_of
from voronoi_tiles.solid.deviation import Deviation, deviation
from voronoi_tiles.solid.events import LoftError
from voronoi_tiles.solid.layering import Layering
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.motion import Motion
from voronoi_tiles.solid.sections import CrossedSections, crossed_sections
from voronoi_tiles.solid.vertices import Vertices
from voronoi_tiles.vector.complex.representatives import Points
from voronoi_tiles.vector.motion_codes import code_of, composed, motion_of
from voronoi_tiles.vector.motions import reverses_orientation, to_motion

ACCURACY_MM: Final = 0.05
"""How far walls are from where strokes have them where nobody says; millimetres. What a nozzle cannot show."""

_ROUNDS: Final = 10
"""How often layers are added, or chords made finer, at most; a count."""

_PARTS: Final = 8
"""Into how many parts a slab is cut at once, at most; a count. What is far off tells little of how far it will be."""

_AIMED: Final = 0.9
"""What slabs that are cut are to be off, at most; relative to the accuracy. How far is guessed."""


@dataclass(frozen=True, eq=False)
class Loft:
    """The solids of a design's sites, in the places where these are drawn, within `accuracy` millimetres."""

    design: Design
    motion: Motion
    approach: Approach
    levels: tuple[LoftLevel, ...]
    vertices: Vertices
    tiles: tuple[LoftTile, ...]
    accuracy: float

    @cached_property
    def meshes(self) -> tuple[TriangleMesh, ...]:
        """The mesh of each site, in millimetres."""
        return tuple(self._mesh(tile.points, tile.triangles) for tile in self.tiles)

    @cached_property
    def deviation(self) -> Deviation:
        """How far the walls of the meshes are, between levels, from where the strokes have them."""
        core = self.levels[0].core
        return deviation(self.meshes, self.motion, core.action, core.stabilizers, self.design.unit_mm)

    @cached_property
    def crossed(self) -> tuple[CrossedSections, ...]:
        """For each mesh where its sections cross themselves."""
        return tuple(map(crossed_sections, self.meshes))

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
    """The solids of a design that has one; walls are within `accuracy` millimetres of where strokes have them.

    There are exact layers at those heights that the design asks for, at `heights`, in its units, and at others where
    walls between two would be farther off, or would cross. Where chords cross in one they are finer. Raises
    ArgumentError for a flat design, for heights outside of the solid, and where the accuracy takes more layers or
    triangles than there may be, LoftError with the height where copies meet, where tiles change in a way that has no
    walls, or where walls do not become right.
    """
    motion = Motion.of(design)
    exact, layering = motion.heights_with(heights), Layering(design, motion)
    layers = [layering.layer_at(z) for z in exact]
    for layer in layers:
        if layer.stabilizers != layers[0].stabilizers:
            raise LoftError("copies of a site coincide", layer.z, remedy="Copies must keep apart at all heights.")
    nearest = approach(motion, layers[0].action, layers[0].stabilizers, exact)
    layering.add(exact)
    chords = accuracy
    for _ in range(_ROUNDS):
        levels = levels_of(layering)
        solids = solids_of([site.name for site in design.noded], levels, chords / design.unit_mm)
        loft = Loft(design, motion, nearest, tuple(levels), *solids, accuracy)
        if loft.deviation.worst <= accuracy:
            if not any(map(len, chain(*loft.crossed))):
                return loft
            more = [float(z) / design.unit_mm for crossed in loft.crossed for z in crossed.between]
            finer = any(len(crossed.levels) for crossed in loft.crossed)
        else:
            more, finer = _wanted(loft, accuracy), False
        if layering.count + len(more) > LAYERS_MAX:
            raise ArgumentError(
                f"walls within {accuracy:g} mm would take more than {LAYERS_MAX:,} layers",
                remedy="Give a coarser accuracy, or draw keys that differ less.",
            )
        if not layering.add(more) and not finer:
            break
        chords /= 4 if finer else 1
    raise _refused(loft)


def _wanted(loft: Loft, accuracy: float) -> list[float]:
    """The heights at which layers are wanted for walls to be within an accuracy in millimetres; the design's units."""
    found = loft.deviation
    off = np.nan_to_num(found.off, nan=np.inf)
    parts = np.sqrt(off / (_AIMED * accuracy)).clip(2, _PARTS)
    more: list[float] = []
    for k in np.flatnonzero(~(found.off <= accuracy)).tolist():
        low, high = (found.heights[k : k + 2] / loft.design.unit_mm).tolist()
        more += np.linspace(low, high, ceil(parts[k]) + 1)[1:-1].tolist()
    return more


def _refused(loft: Loft) -> LoftError:
    """Why a loft that is not right cannot be made so."""
    found, unit = loft.deviation, loft.design.unit_mm
    if not found.worst <= loft.accuracy:
        k = int(np.argmax(found.off))
        return LoftError(
            f"walls stay {found.worst:.3g} mm off, however many layers are beside,",
            float(found.heights[k] + found.heights[k + 1]) / 2 / unit,
            remedy=f"Give a coarser accuracy than {loft.accuracy:g} mm, or draw keys that differ less.",
        )
    at = float(next(chain(*chain(*loft.crossed))))
    return LoftError("walls cross", at / unit, remedy="Write more layers in [solid], or draw keys that differ less.")

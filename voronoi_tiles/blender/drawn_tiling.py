"""What is drawn in Blender, as a design: its tiles at once, and what is wrong with it in its own words."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.errors import DesignError, TouchingCopiesError, VoronoiTilesError
from voronoi_tiles.blender.drawn_splines import DrawnSpline, strokes_of
from voronoi_tiles.blender.mended_symmetry import symmetric_splines
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.drawn_site import Site
from voronoi_tiles.designs.drawn_solid import Solid
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.tiling import tessellate as prove_tiling
from voronoi_tiles.vector.motions import Action
from voronoi_tiles.vector.tessellation import TileRecord, tessellate

FLATTENING: Final = 1 / 6000
"""How far the chords of curves may be from them; relative to the cell's side: 0.01 mm of a cell of 60 mm."""


def decimal(value: float) -> float:
    """The shortest decimal number that is this one in single precision: Blender keeps no more, and people wrote it."""
    return float(str(np.float32(value)))


@dataclass(frozen=True)
class DrawnTiling:
    """A group, the sides and the angle (degrees) of its cell, and the splines of each site by its name, in units.

    What the group fixes is not read. `smoothing` is as of `strokes_of`, relative to the side `a`.
    """

    group: str
    a: float
    b: float
    angle: float
    sites: tuple[tuple[str, tuple[DrawnSpline, ...]], ...]
    smoothing: float = 0.005

    def design(self, unit_mm: float = 1.0, solid: Solid | None = None, name: str = "tiling") -> Design:
        """The design in millimetres, a unit being so many; `solid` in units. Raises DesignError."""
        group = GROUPS[self.group]
        cell = {"a": self.a}
        if not group.fixes_b:
            cell["b"] = self.b
        if group.fixed_angle is None:
            cell["angle"] = self.angle
        tolerance = FLATTENING * self.a * unit_mm
        action = Action(group, group.lattice(self.a, self.b, self.angle))
        sites = [
            Site(
                strokes_of(symmetric_splines(action, splines), self.smoothing * self.a), name=site, tolerance=tolerance
            )
            for site, splines in self.sites
        ]
        return Design(self.group, cell, sites, scale=unit_mm, solid=solid, name=name)

    def tiles(self) -> list[TileRecord]:
        """The tiles, not proved. Raises DesignError, TouchingCopiesError and ProofError."""
        design = self.design()
        return tessellate(design.noded, design.group, design.lattice)

    def proved(self) -> Tiling:
        """The tiles, proved; raises as `tiles`."""
        return prove_tiling(self.design())

    def said(self, error: VoronoiTilesError) -> str:
        """What is wrong, with the names that Blender has for sites."""
        if isinstance(error, TouchingCopiesError):
            place = f"({error.place.real:.4g}, {error.place.imag:.4g})"
            who = "its own copy" if error.site == error.other else f"a copy of {error.other}"
            return f"{error.site} touches {who} at {place}: the marker is there. Move it away, or fit the cell."
        if isinstance(error, DesignError):
            where = re.match(r"sites\[(\d+)\](?:\.strokes\[(\d+)\])?", error.key or "")
            if where is not None:
                spline = f", stroke {int(where[2]) + 1}" if where[2] else ""
                return f"{self.sites[int(where[1])][0]}{spline}: {error.message}."
            return f"{error.key}: {error.message}." if error.key else f"{error.message}."
        return str(error)

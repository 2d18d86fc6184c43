"""Designs as what Blender draws: splines that give the same strokes again; and a cell for what is drawn already."""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.tolerance import FLATTENING_MM
from voronoi_tiles.blender.drawn_splines import DrawnSpline
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.drawn_solid import Solid
from voronoi_tiles.designs.schema import stroke
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.vector.tessellation import tessellate

ROOM = 1.1
"""How much larger a proposed cell is, relative to the drawing, than that of the starter; a factor."""


class OpenedDesign(NamedTuple):
    """A design as it is drawn: the splines of each site by its name, in units of so many millimetres.

    `solid` is None as well where it has keys, which Blender has nothing for.
    """

    group: str
    a: float
    b: float
    angle: float
    unit_mm: float
    sites: tuple[tuple[str, tuple[DrawnSpline, ...]], ...]
    solid: Solid | None = None


def opened(design: Design) -> OpenedDesign:
    """What a design draws: lines and Bezier splines, circles and arcs within its tolerance."""
    tables = json.loads(design.source)["site"]
    lattice = design.lattice
    sites = []
    for site, noded, table in zip(design.sites, design.noded, tables, strict=True):
        by = Placement(design.scale) @ site.placement
        accuracy = FLATTENING_MM / design.unit_mm if site.tolerance is None else site.tolerance
        drawn = tuple(_spline(*stroke(one, accuracy, by)) for one in table["strokes"])
        sites.append((noded.name, drawn))
    angle = float(np.degrees(np.angle(lattice.b / lattice.a)))
    solid = design.solid
    if solid is not None:
        solid = None if solid.keys else solid.placed(Placement(design.scale), (), design.scale)
    return OpenedDesign(design.group.name, abs(lattice.a), abs(lattice.b), angle, design.unit_mm, tuple(sites), solid)


def _spline(points: Complexes, curved: bool) -> DrawnSpline:
    """A stroke as it is read: a polyline, or cubic curves one after the other."""
    if not curved:
        closed = len(points) > 3 and bool(points[0] == points[-1])
        return DrawnSpline("poly", points[:-1] if closed else points, closed)
    ends = np.append(points[:, 0], points[-1, 3])
    left, right = np.append(points[:1, 0], points[:, 2]), np.append(points[:, 1], points[-1:, 3])
    if ends[0] != ends[-1]:
        return DrawnSpline("bezier", ends, False, left, right)
    left[0] = left[-1]
    return DrawnSpline("bezier", ends[:-1], True, left[:-1], right[:-1])


class ProposedCell(NamedTuple):
    """The sides and the angle (degrees) of a cell, and where the group's origin is."""

    a: float
    b: float
    angle: float
    origin: complex


def proposed_cell(group: str, points: Complexes) -> ProposedCell:
    """A cell for what is drawn: as large and as far from the drawing as a starter's is from its largest site.

    Of those that lie beside rotation centres and mirrors: on them, copies of another drawing would touch in any cell.
    """
    design = starter(group)
    tiles = tessellate(design.noded, design.group, design.lattice)
    beside = [site.nodes for site, tile in zip(design.noded, tiles, strict=True) if len(tile.symmetry) == 1]
    middle, size = max(map(_extent, beside), key=lambda extent: extent[1])
    at, own = _extent(points)
    factor = ROOM * own / size if own > 0.0 else 1.0
    cell = opened(design)
    return ProposedCell(cell.a * factor, cell.b * factor, cell.angle, at - middle * factor)


def _extent(points: Complexes) -> tuple[complex, float]:
    """The middle and the longer side of the box around points."""
    low = complex(points.real.min(), points.imag.min())
    high = complex(points.real.max(), points.imag.max())
    return (low + high) / 2, max((high - low).real, (high - low).imag)

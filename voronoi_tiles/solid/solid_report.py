"""What solids come to for who prints them: volume, mass, narrowest neck, overhangs, which way up, how to lay them."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arguments import number
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.preflight.chords import chords_of, counts_of
from voronoi_tiles.preflight.necks import find_necks
from voronoi_tiles.solid.cross_sections import section
from voronoi_tiles.solid.laying_orders import prism_assembly
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.solid_model import SolidModel

DENSITY: Final = 1.24
"""Of polylactic acid, the usual filament; grams per cubic centimetre."""

PLYWOOD: Final = 0.68
"""Of birch plywood, which is what is cut most; grams per cubic centimetre."""

OVERHANG: Final = 45.0
"""From which angle on a wall that leans out needs supports; degrees from the vertical."""

_SLACK: Final = 1.5
"""By how much an angle may be greater; degrees. Rims of chamfers are chords, and lean by a little more or less."""

_SPECK: Final = 1e-5
"""Less of a surface leans on what is beside it; a share of it."""

_HEIGHTS: Final = 7
"""At so many levels the narrowest neck is looked for; a count."""

_FIRST: Final = 0.01
_GROWTH: Final = 3.0
_LAST: Final = 0.5
"""Necks are looked for that are narrower than a share of the solid's size; while there is none, than more of it."""


def solid_report(model: SolidModel, density: float = DENSITY) -> dict[str, Any]:
    """What the solids of each site come to, in the types of JSON; millimetres, cubic millimetres, grams, degrees.

    `density` is in grams per cubic centimetre. "overhang" is the share of the surface that leans out by more than 45
    degrees, what lies on the bed not counted, the way up that has least of it; "up" says which that is. "assembly" is
    what `laying_orders.assembly` gives. Raises ArgumentError for a density that is no positive number.
    """
    density = number("density", density, "Give grams per cubic centimetre, such as 1.24.", least=1e-6)
    first = {piece.site: piece for piece in reversed(model.pieces)}
    rows = []
    for site in dict.fromkeys(piece.site for piece in model.pieces):
        mesh = first[site].mesh
        lying, turned = overhang(mesh, 1.0), overhang(mesh, -1.0)
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        rows.append(
            {
                "site": site,
                "count": sum(piece.site == site for piece in model.pieces),
                "size": (high - low).tolist(),
                "volume": mesh.volume,
                "mass": mesh.volume / 1000 * density,
                "neck": narrowest_neck(mesh),
                "overhang": min(lying[0], turned[0]),
                "steepest": (turned if turned[0] < lying[0] else lying)[1],
                "up": "turned over" if turned[0] < lying[0] else "as it lies",
            }
        )
    return {
        "density": density,
        "volume": model.volume,
        "mass": model.volume / 1000 * density,
        "solids": rows,
        "assembly": prism_assembly([row["site"] for row in rows]) if model.assembly is None else model.assembly(),
        "proof": dict(model.proof),
    }


def overhang(mesh: TriangleMesh, up: float) -> tuple[float, float]:
    """The share of the surface that leans out by more than OVERHANG, and how far it leans at most; degrees.

    What leans most is left out while it is a speck, less than _SPECK of the surface. `up` is 1 for a solid as it lies,
    -1 for one that is turned over. What lies on the bed leans on that.
    """
    heights = up * mesh.corners[:, :, 2]
    bed = (heights == heights.min()).all(axis=1)
    lean = np.degrees(np.arcsin(np.clip(-up * mesh.normals[:, 2], 0.0, 1.0)))
    lean[bed] = 0.0
    areas = mesh.areas
    # Where a chamfer loses a corner, a speck of its rim is level.
    steepest = np.argsort(-lean)
    first = np.searchsorted(np.cumsum(areas[steepest]), _SPECK * areas.sum(), side="right")
    return float(areas[lean > OVERHANG + _SLACK].sum() / areas.sum()), float(lean[steepest[first]])


def narrowest_neck(mesh: TriangleMesh) -> float | None:
    """How narrow the narrowest neck at seven levels is; millimetres. None where there is none."""
    low, high = float(mesh.vertices[:, 2].min()), float(mesh.vertices[:, 2].max())
    # Not in the middles of layers, where vertices may lie.
    levels = low + (high - low) * (np.arange(_HEIGHTS) + 0.4873) / _HEIGHTS
    widths = [width for z in levels.tolist() if (width := _narrowest(section(mesh, z))) is not None]
    return min(widths, default=None)


def _narrowest(rings: Paths) -> float | None:
    """The least distance across the inside of rings."""
    left, bottom, right, top = rings.bounds
    size = max(right - left, top - bottom)
    chords = chords_of(rings, counts_of(rings, size), 0.0)
    share = _FIRST
    while share < _LAST * _GROWTH:
        found = [neck.width for neck in find_necks(chords, 1e-9 * size, min(share, _LAST) * size) if neck.material]
        if found:
            return min(found)
        share *= _GROWTH
    return None

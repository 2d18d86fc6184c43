"""Exact space-filling tiles: Voronoi cells of strokes, repeated by a wallpaper group.

The public names are loaded on first use, so that importing the package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from voronoi_tiles.base.version import __version__

if TYPE_CHECKING:
    from voronoi_tiles.base.errors import (
        CheckError,
        DesignError,
        OutputError,
        ProofError,
        RenderError,
        TouchingCopiesError,
        VoronoiTilesError,
    )
    from voronoi_tiles.base.maps import Isometry
    from voronoi_tiles.base.operations import Operation
    from voronoi_tiles.crosscheck import CheckReport
    from voronoi_tiles.designs.design import Design
    from voronoi_tiles.designs.site import Site
    from voronoi_tiles.fabrication import Job, JobError, Product
    from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup
    from voronoi_tiles.pictures.rendering import render
    from voronoi_tiles.tiling import Tile, Tiling
    from voronoi_tiles.vector.arcs import Arc, LineArc, Neighbour, ParabolaArc
    from voronoi_tiles.vector.outline import Outline


__all__ = [
    "GROUPS",
    "Arc",
    "CheckError",
    "CheckReport",
    "Design",
    "DesignError",
    "Isometry",
    "Job",
    "JobError",
    "Lattice",
    "LineArc",
    "Neighbour",
    "Operation",
    "Outline",
    "OutputError",
    "ParabolaArc",
    "Product",
    "ProofError",
    "RenderError",
    "Site",
    "Tile",
    "Tiling",
    "TouchingCopiesError",
    "VoronoiTilesError",
    "WallpaperGroup",
    "__version__",
    "render",
]

_HOMES = {
    "voronoi_tiles.crosscheck": ("CheckReport",),
    "voronoi_tiles.designs.design": ("Design",),
    "voronoi_tiles.base.errors": (
        "CheckError",
        "DesignError",
        "OutputError",
        "ProofError",
        "RenderError",
        "TouchingCopiesError",
        "VoronoiTilesError",
    ),
    "voronoi_tiles.fabrication": ("Job", "JobError", "Product"),
    "voronoi_tiles.pictures.rendering": ("render",),
    "voronoi_tiles.designs.site": ("Site",),
    "voronoi_tiles.tiling": ("Tile", "Tiling"),
    "voronoi_tiles.vector.arcs": ("Arc", "LineArc", "Neighbour", "ParabolaArc"),
    "voronoi_tiles.vector.outline": ("Outline",),
    "voronoi_tiles.groups.wallpaper": ("GROUPS", "Isometry", "Lattice", "Operation", "WallpaperGroup"),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> object:
    """Import a public name from the module that defines it (PEP 562)."""
    home = _HOME_OF.get(name)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value: object = getattr(import_module(home), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """List the public names, loaded or not."""
    return sorted({*globals(), *__all__})

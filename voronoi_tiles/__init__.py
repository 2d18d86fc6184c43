"""Exact space-filling tiles: Voronoi cells of strokes, repeated by a wallpaper group.

The public names are loaded on first use, so that importing the package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from voronoi_tiles.crosscheck import CheckReport
    from voronoi_tiles.design import Design
    from voronoi_tiles.errors import (
        CheckError,
        DesignError,
        OutputError,
        ProofError,
        RenderError,
        TouchingCopiesError,
        VoronoiTilesError,
    )
    from voronoi_tiles.fabrication import Job, JobError, Product
    from voronoi_tiles.picture import render
    from voronoi_tiles.site import Site
    from voronoi_tiles.tiling import Tile, Tiling
    from voronoi_tiles.vector.arcs import Arc, LineArc, Neighbour, ParabolaArc
    from voronoi_tiles.vector.outline import Outline
    from voronoi_tiles.wallpaper import GROUPS, Isometry, Lattice, Operation, WallpaperGroup

__version__ = "0.1.0"

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
    "voronoi_tiles.design": ("Design",),
    "voronoi_tiles.errors": (
        "CheckError",
        "DesignError",
        "OutputError",
        "ProofError",
        "RenderError",
        "TouchingCopiesError",
        "VoronoiTilesError",
    ),
    "voronoi_tiles.fabrication": ("Job", "JobError", "Product"),
    "voronoi_tiles.picture": ("render",),
    "voronoi_tiles.site": ("Site",),
    "voronoi_tiles.tiling": ("Tile", "Tiling"),
    "voronoi_tiles.vector.arcs": ("Arc", "LineArc", "Neighbour", "ParabolaArc"),
    "voronoi_tiles.vector.outline": ("Outline",),
    "voronoi_tiles.wallpaper": ("GROUPS", "Isometry", "Lattice", "Operation", "WallpaperGroup"),
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

"""Exact space-filling tiles: Voronoi cells of strokes, repeated by a wallpaper group.

The public names are loaded on first use, so that importing the package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from voronoi_tiles.base.version import __version__

if TYPE_CHECKING:
    from voronoi_tiles.base.errors import (
        ArgumentError,
        CheckError,
        DesignError,
        MissingLibraryError,
        OutputError,
        ProofError,
        RenderError,
        SchedulerError,
        TouchingCopiesError,
        UnknownNameError,
        VoronoiTilesError,
    )
    from voronoi_tiles.base.maps import Isometry, Placement
    from voronoi_tiles.base.operations import Operation
    from voronoi_tiles.crosscheck.check_report import CheckReport, Figure, Marks
    from voronoi_tiles.designs.art import Art
    from voronoi_tiles.designs.design import Design
    from voronoi_tiles.designs.drawn_site import Site
    from voronoi_tiles.designs.drawn_solid import Key, Solid
    from voronoi_tiles.designs.drawn_strokes import (
        Stroke,
        bezier,
        bspline,
        catmull_rom,
        circle,
        drawing,
        hermite,
        path,
        point,
        polyline,
        segment,
    )
    from voronoi_tiles.designs.proposals import placed
    from voronoi_tiles.designs.site import NodedSite
    from voronoi_tiles.designs.starters import starter, starter_text
    from voronoi_tiles.escherization.fits import Fit, fit
    from voronoi_tiles.escherization.goal_outline import GoalOutline
    from voronoi_tiles.escherization.group_placement import GroupPlacement
    from voronoi_tiles.fabrication.coupon import coupon
    from voronoi_tiles.fabrication.exporting import Exported
    from voronoi_tiles.fabrication.inventory import Inventory
    from voronoi_tiles.fabrication.job import Job
    from voronoi_tiles.fabrication.job_options import JobError
    from voronoi_tiles.fabrication.product import Product
    from voronoi_tiles.formats.burns import Burn
    from voronoi_tiles.formats.page import Drawing, Layer
    from voronoi_tiles.formats.shapes import Dots, DrawingError, ReadDrawing, Shape
    from voronoi_tiles.gradients.shape_gradient import ShapeGradient
    from voronoi_tiles.gradients.tile_gradient import MovingPoints, TileGradient
    from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup
    from voronoi_tiles.paths.paths import Paths
    from voronoi_tiles.pictures.rendered import Rendering
    from voronoi_tiles.pictures.rendering import RenderOptions, render
    from voronoi_tiles.preflight import preflight
    from voronoi_tiles.preflight.findings import Finding, LayerUse, Limits, PreflightReport
    from voronoi_tiles.raster.frame import Frame
    from voronoi_tiles.raster.renderer import Provenance
    from voronoi_tiles.solid.extrusion import extrude
    from voronoi_tiles.solid.mesh import TriangleMesh
    from voronoi_tiles.solid.pieces import SolidPiece
    from voronoi_tiles.solid.solid_job import SolidJob
    from voronoi_tiles.solid.solid_model import SolidModel
    from voronoi_tiles.solid.stack import Stack, StackSheet, stack
    from voronoi_tiles.solid.stack_job import StackJob
    from voronoi_tiles.solid.standing import stand
    from voronoi_tiles.sweeps.sweep import Sweep
    from voronoi_tiles.sweeps.sweep_run import SweepResult, sweep
    from voronoi_tiles.sweeps.sweep_table import SweepTable
    from voronoi_tiles.tile import Tile, TileCopy
    from voronoi_tiles.tiling import Tiling
    from voronoi_tiles.vector.arcs import Arc, LineArc, Neighbour, ParabolaArc
    from voronoi_tiles.vector.outline import Outline
    from voronoi_tiles.vector.proof import ProofReport


__all__ = [
    "GROUPS",
    "Arc",
    "ArgumentError",
    "Art",
    "Burn",
    "CheckError",
    "CheckReport",
    "Design",
    "DesignError",
    "Dots",
    "Drawing",
    "DrawingError",
    "Exported",
    "Figure",
    "Finding",
    "Fit",
    "Frame",
    "GoalOutline",
    "GroupPlacement",
    "Inventory",
    "Isometry",
    "Job",
    "JobError",
    "Key",
    "Lattice",
    "Layer",
    "LayerUse",
    "Limits",
    "LineArc",
    "Marks",
    "MissingLibraryError",
    "MovingPoints",
    "Neighbour",
    "NodedSite",
    "Operation",
    "Outline",
    "OutputError",
    "ParabolaArc",
    "Paths",
    "Placement",
    "PreflightReport",
    "Product",
    "ProofError",
    "ProofReport",
    "Provenance",
    "ReadDrawing",
    "RenderError",
    "RenderOptions",
    "Rendering",
    "SchedulerError",
    "Shape",
    "ShapeGradient",
    "Site",
    "Solid",
    "SolidJob",
    "SolidModel",
    "SolidPiece",
    "Stack",
    "StackJob",
    "StackSheet",
    "Stroke",
    "Sweep",
    "SweepResult",
    "SweepTable",
    "Tile",
    "TileCopy",
    "TileGradient",
    "Tiling",
    "TouchingCopiesError",
    "TriangleMesh",
    "UnknownNameError",
    "VoronoiTilesError",
    "WallpaperGroup",
    "__version__",
    "bezier",
    "bspline",
    "catmull_rom",
    "circle",
    "coupon",
    "drawing",
    "extrude",
    "fit",
    "hermite",
    "path",
    "placed",
    "point",
    "polyline",
    "preflight",
    "render",
    "segment",
    "stack",
    "stand",
    "starter",
    "starter_text",
    "sweep",
]

_HOMES = {
    "voronoi_tiles.base.errors": (
        "ArgumentError CheckError DesignError MissingLibraryError OutputError ProofError RenderError "
        "SchedulerError TouchingCopiesError UnknownNameError VoronoiTilesError"
    ),
    "voronoi_tiles.base.maps": "Isometry Placement",
    "voronoi_tiles.base.operations": "Operation",
    "voronoi_tiles.crosscheck.check_report": "CheckReport Figure Marks",
    "voronoi_tiles.designs.art": "Art",
    "voronoi_tiles.designs.design": "Design",
    "voronoi_tiles.designs.drawn_site": "Site",
    "voronoi_tiles.designs.drawn_solid": "Key Solid",
    "voronoi_tiles.designs.drawn_strokes": (
        "Stroke bezier bspline catmull_rom circle drawing hermite path point polyline segment"
    ),
    "voronoi_tiles.designs.proposals": "placed",
    "voronoi_tiles.designs.site": "NodedSite",
    "voronoi_tiles.designs.starters": "starter starter_text",
    "voronoi_tiles.escherization.fits": "Fit fit",
    "voronoi_tiles.escherization.goal_outline": "GoalOutline",
    "voronoi_tiles.escherization.group_placement": "GroupPlacement",
    "voronoi_tiles.fabrication.coupon": "coupon",
    "voronoi_tiles.fabrication.exporting": "Exported",
    "voronoi_tiles.fabrication.inventory": "Inventory",
    "voronoi_tiles.fabrication.job": "Job",
    "voronoi_tiles.fabrication.job_options": "JobError",
    "voronoi_tiles.fabrication.product": "Product",
    "voronoi_tiles.formats.burns": "Burn",
    "voronoi_tiles.formats.page": "Drawing Layer",
    "voronoi_tiles.formats.shapes": "Dots DrawingError ReadDrawing Shape",
    "voronoi_tiles.gradients.shape_gradient": "ShapeGradient",
    "voronoi_tiles.gradients.tile_gradient": "MovingPoints TileGradient",
    "voronoi_tiles.groups.wallpaper": "GROUPS Lattice WallpaperGroup",
    "voronoi_tiles.paths.paths": "Paths",
    "voronoi_tiles.pictures.rendered": "Rendering",
    "voronoi_tiles.pictures.rendering": "RenderOptions render",
    "voronoi_tiles.preflight": "preflight",
    "voronoi_tiles.preflight.findings": "Finding LayerUse Limits PreflightReport",
    "voronoi_tiles.raster.frame": "Frame",
    "voronoi_tiles.raster.renderer": "Provenance",
    "voronoi_tiles.solid.extrusion": "extrude",
    "voronoi_tiles.solid.mesh": "TriangleMesh",
    "voronoi_tiles.solid.solid_job": "SolidJob",
    "voronoi_tiles.solid.pieces": "SolidPiece",
    "voronoi_tiles.solid.solid_model": "SolidModel",
    "voronoi_tiles.solid.stack": "Stack StackSheet stack",
    "voronoi_tiles.solid.stack_job": "StackJob",
    "voronoi_tiles.solid.standing": "stand",
    "voronoi_tiles.sweeps.sweep": "Sweep",
    "voronoi_tiles.sweeps.sweep_run": "SweepResult sweep",
    "voronoi_tiles.sweeps.sweep_table": "SweepTable",
    "voronoi_tiles.tile": "Tile TileCopy",
    "voronoi_tiles.tiling": "Tiling",
    "voronoi_tiles.vector.arcs": "Arc LineArc Neighbour ParabolaArc",
    "voronoi_tiles.vector.outline": "Outline",
    "voronoi_tiles.vector.proof": "ProofReport",
}
"""Where the public names are defined."""

_HOME_OF = {name: home for home, names in _HOMES.items() for name in names.split()}


def __getattr__(name: str) -> object:
    """Import a public name from the module that defines it (PEP 562)."""
    home = _HOME_OF.get(name)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(home)
    # The import of a subpackage binds its name here: the one that has a function's name stands for it, and is called.
    value: object = module if home == f"{__name__}.{name}" else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """List the public names, loaded or not."""
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})

# SPDX-License-Identifier: GPL-3.0-or-later
"""What one can ask for: tiles of what is selected, a starter, a design file, solids, files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, StringProperty

from voronoi_tiles.base.errors import DesignError, VoronoiTilesError
from voronoi_tiles.blender.design_splines import opened
from voronoi_tiles.blender.drawn_tiling import decimal
from voronoi_tiles.blender.polygon_mesh import PolygonMesh
from voronoi_tiles.blender.solid_meshes import placed_solids
from voronoi_tiles.blender.written_files import FORMATS, FileJob, write_file
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.drawn_solid import Solid
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.solid.solid_job import SolidJob

from . import reading, showing
from .new_tilings import add_sites, draw_design, fit_cell, new_tiling
from .requirements import missing
from .settings import DRAWN, ELSEWHERE, GROUP_ITEMS, is_local, owner, tiling_of
from .updating import drawing_of, rebuild


class _Operator(bpy.types.Operator):
    """An operator that says what is wrong in a sentence."""

    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Any) -> set[str]:
        try:
            self.done(context)
        except VoronoiTilesError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except ImportError as error:
            self.report({"ERROR"}, f"{error}: Blender has it not. Export a .toml, and use the command line.")
            return {"CANCELLED"}
        return {"FINISHED"}

    def done(self, context: Any) -> None:
        raise NotImplementedError


class _OnTiling(_Operator):
    """An operator on the tiling of the active object."""

    @classmethod
    def poll(cls, context: Any) -> bool:
        tiling = tiling_of(context.object)
        if tiling is not None and not is_local(tiling):
            cls.poll_message_set(f"The tiling {ELSEWHERE}")
        return tiling is not None and is_local(tiling)


class VORONOI_TILES_OT_tile(_Operator):
    """Make the selected curves and grease pencils the sites of a tiling, or of the one that is selected as well"""

    bl_idname = "voronoi_tiles.tile"
    bl_label = "Tile"
    __annotations__ = {"group": EnumProperty(name="Group", items=GROUP_ITEMS, default="p4")}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return bool(drawings(context))

    def done(self, context: Any) -> None:
        chosen = drawings(context)
        there = next((found for item in context.selected_objects if (found := tiling_of(item))), None)
        for item in filter(None, (there, *chosen)):
            if not is_local(item):
                raise DesignError(f"{item.name} {ELSEWHERE}")
        if there is not None:
            add_sites(there, chosen)
            rebuild(there)
            return
        tiling = new_tiling(context, self.group, chosen[0].name)
        add_sites(tiling, chosen)
        fit_cell(context, tiling)
        rebuild(tiling)


def drawings(context: Any) -> list[Any]:
    """The selected objects that can be sites: no tiles, but those that are left of a tiling that has been deleted."""
    return [
        item
        for item in context.selected_objects
        if item.type in DRAWN and (item.voronoi_tiles.role in ("", "site") or tiling_of(item) is None)
    ]


class VORONOI_TILES_OT_starter(_Operator):
    """Draw a starter of a group, and its tiles"""

    bl_idname = "voronoi_tiles.starter"
    bl_label = "Starter"
    __annotations__ = {"group": EnumProperty(name="Group", items=GROUP_ITEMS, default="p4")}

    def done(self, context: Any) -> None:
        draw_design(context, self.group, opened(starter(self.group)))


class VORONOI_TILES_OT_open(_Operator):
    """Draw the sites of a design file, and its tiles"""

    bl_idname = "voronoi_tiles.open"
    bl_label = "Open a Design"
    __annotations__ = {
        "filepath": StringProperty(subtype="FILE_PATH"),
        "filter_glob": StringProperty(default="*.toml;*.json", options={"HIDDEN"}),
    }

    def invoke(self, context: Any, _event: Any) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def done(self, context: Any) -> None:
        path = bpy.path.abspath(self.filepath)
        design = Design.load(path)
        draw_design(context, Path(path).stem, opened(design))
        if design.solid is not None and design.solid.keys:
            self.report({"WARNING"}, "Keys of solids are left out: the command line makes them.")


class VORONOI_TILES_OT_update(_OnTiling):
    """Compute the tiles of the active tiling, and prove them"""

    bl_idname = "voronoi_tiles.update"
    bl_label = "Update"

    def done(self, context: Any) -> None:
        rebuild(tiling_of(context.object))


class VORONOI_TILES_OT_fit(_OnTiling):
    """Choose a cell about what is drawn, in which copies keep apart, and move the group there"""

    bl_idname = "voronoi_tiles.fit"
    bl_label = "Fit Cell"

    def done(self, context: Any) -> None:
        tiling = tiling_of(context.object)
        fit_cell(context, tiling)
        rebuild(tiling)


class VORONOI_TILES_OT_remove(_Operator):
    """Remove the tiling and its tiles; what is drawn stays"""

    bl_idname = "voronoi_tiles.remove"
    bl_label = "Remove Tiling"

    @classmethod
    def poll(cls, context: Any) -> bool:
        tiling = owner(context.object)
        return tiling is not None and is_local(tiling)

    def done(self, context: Any) -> None:
        showing.remove_all(owner(context.object))


class VORONOI_TILES_OT_solids(_OnTiling):
    """Show solids in the field: prisms with clearance and chamfer, or lofts; they stay until the drawing changes"""

    bl_idname = "voronoi_tiles.solids"
    bl_label = "Make Solids"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return not missing() and super().poll(context)

    def done(self, context: Any) -> None:
        tiling = tiling_of(context.object)
        settings = tiling.voronoi_tiles
        settings.field = True
        rebuild(tiling)
        if settings.message:
            self.report({"ERROR"}, settings.message)
            return
        job, solid = solid_jobs(settings)
        drawn = reading.drawn_tiling(tiling)
        made = placed_solids(drawn, decimal(settings.unit_mm), job, solid)
        sites = reading.drawn_sites(tiling)
        for (number, mirrored), mesh in showing.sources(tiling).items():
            pivot = complex(*sites[number].pivot)
            showing.set_mesh(mesh, about(made.meshes[number], pivot, mirrored=mirrored))
        showing.mark_solids(tiling, drawing_of(tiling, drawn), made.proved)


class VORONOI_TILES_OT_export(_OnTiling):
    """Write the tiles as a file, proved and exact: drawings to cut, solids, or the design for the command line"""

    bl_idname = "voronoi_tiles.export"
    bl_label = "Export Tiles"
    bl_options = {"REGISTER"}
    __annotations__ = {
        "filepath": StringProperty(subtype="FILE_PATH"),
        "filter_glob": StringProperty(default=";".join(f"*{suffix}" for suffix in FORMATS), options={"HIDDEN"}),
        "check_existing": BoolProperty(default=True, options={"HIDDEN"}),
        "suffix": EnumProperty(name="Format", items=[(key, *text) for key, text in FORMATS.items()]),
    }

    def invoke(self, context: Any, _event: Any) -> set[str]:
        name = bpy.path.clean_name(tiling_of(context.object).name)
        self.filepath = str(Path(bpy.path.abspath("//") or Path.home()) / f"{name}{self.suffix}")
        self.filter_glob = f"*{self.suffix}"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def done(self, context: Any) -> None:
        tiling = tiling_of(context.object)
        path = bpy.path.abspath(self.filepath)
        job = file_job(tiling.voronoi_tiles, Path(path).suffix.lower())
        self.report({"INFO"}, write_file(reading.drawn_tiling(tiling), path, job))


def file_job(settings: Any, suffix: str) -> FileJob:
    """What a file is to hold: of the settings those alone that are for files of its suffix."""
    flat = prisms = solid = None
    if suffix in (".3mf", ".stl") or (suffix == ".toml" and settings.loft):
        prisms, solid = solid_jobs(settings)
    elif suffix != ".toml":
        names = ("kerf", "feed", "power") if suffix == ".gcode" else ("kerf",)
        cuts: dict[str, Any] = {name: value for name in names if (value := decimal(getattr(settings, name)))}
        if settings.sheet:
            cuts["sheet"] = bpy.path.abspath(settings.sheet)
        flat = Job(**cuts) if cuts else None
    return FileJob(decimal(settings.unit_mm), flat, prisms, solid)


def solid_jobs(settings: Any) -> tuple[SolidJob, Solid | None]:
    """The job of prisms in millimetres, and how strokes move in units, None where they do not."""
    if settings.loft:
        return SolidJob(), Solid(
            decimal(settings.height),
            layers=settings.layers,
            turn=decimal(settings.turn),
            scale=decimal(settings.grow),
            shift=tuple(map(decimal, settings.shift)),
            about=tuple(map(decimal, settings.about)),
        )
    return (
        SolidJob(
            height=decimal(settings.height) * decimal(settings.unit_mm),
            clearance=decimal(settings.clearance),
            chamfer=decimal(settings.chamfer),
        ),
        None,
    )


def about(mesh: PolygonMesh, pivot: complex, *, mirrored: bool) -> PolygonMesh:
    """A mesh moved so that a pivot is its origin, and turned over in y."""
    vertices = mesh.vertices - np.array([pivot.real, pivot.imag, 0.0], np.float32)
    if not mirrored:
        return mesh._replace(vertices=vertices)
    # Triangles: backwards they are seen from outside again.
    return mesh._replace(vertices=vertices * np.array([1, -1, 1], np.float32), corners=mesh.corners[::-1].copy())


CLASSES = (
    VORONOI_TILES_OT_tile,
    VORONOI_TILES_OT_starter,
    VORONOI_TILES_OT_open,
    VORONOI_TILES_OT_update,
    VORONOI_TILES_OT_fit,
    VORONOI_TILES_OT_remove,
    VORONOI_TILES_OT_solids,
    VORONOI_TILES_OT_export,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the sidebar of the 3D view, and what it says."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable
from typing import Any

import bpy

from . import requirements

WIDTH = 42
"""Letters of a line of the panel, as wide as a sidebar is when it is opened; a count."""


class VORONOI_TILES_PT_tiles(bpy.types.Panel):
    """Tiles of what is drawn"""

    bl_label = "Voronoi Tiles"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Tiles"

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        if not requirements.usable():
            say(layout, requirements.engine_missing(), "ERROR")
            return
        from .settings import ELSEWHERE, is_local, owner, tiling_of

        say(layout, requirements.missing(), "ERROR")
        tiling = tiling_of(context.object)
        if tiling is None:
            if owner(context.object) is not None:
                say(layout, ["The tiling of this object has been deleted: its tiles follow nothing."], "ERROR")
                layout.operator("voronoi_tiles.remove", text="Remove Tiles")
            say(layout, ["Select curves or grease pencils: each is the site of a tile."], "INFO")
            row = layout.row()
            row.operator("voronoi_tiles.tile")
            row = layout.row(align=True)
            row.operator_menu_enum("voronoi_tiles.starter", "group", text="Starter")
            row.operator("voronoi_tiles.open", text="Open")
            return
        if not is_local(tiling):
            say(layout, [f"{tiling.name} {ELSEWHERE}."], "LIBRARY_DATA_DIRECT")
            return
        draw_tiling(layout, tiling)


def draw_tiling(layout: Any, tiling: Any) -> None:
    """The settings of a tiling, and how it is."""
    from voronoi_tiles.groups.wallpaper import GROUPS

    from .reading import drawn_sites

    settings = tiling.voronoi_tiles
    group = GROUPS[settings.group]
    box = layout.box()
    if settings.message:
        say(box, [settings.message], "ERROR")
    else:
        box.label(
            text="Proved" if settings.proved else "Not proved yet", icon="CHECKMARK" if settings.proved else "SORTTIME"
        )
    sites = drawn_sites(tiling)
    for site in sites:
        width, height = (settings.unit_mm * size for size in site.size)
        box.label(text=f"{site.object.name}: {width:.4g} x {height:.4g} mm in files", icon="OUTLINER_OB_CURVE")
    row = box.row(align=True)
    row.prop(settings, "live", toggle=True)
    row.operator("voronoi_tiles.update")
    row.operator("voronoi_tiles.tile", text="Add Selected")
    column = layout.column(align=True)
    column.prop(settings, "group")
    column.prop(settings, "a")
    if not group.fixes_b:
        column.prop(settings, "b")
    if group.fixed_angle is None:
        column.prop(settings, "angle")
    layout.operator("voronoi_tiles.fit")
    if any(is_smoothed(site.object) for site in sites):
        column.prop(settings, "smoothing")


def is_smoothed(item: Any) -> bool:
    """Whether a site is drawn by hand, or has NURBS."""
    return item.type != "CURVE" or any(spline.type == "NURBS" for spline in item.data.splines)


class _Part(bpy.types.Panel):
    """A part of the panel that a tiling has."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Tiles"
    bl_parent_id = "VORONOI_TILES_PT_tiles"

    @classmethod
    def poll(cls, context: Any) -> bool:
        if not requirements.usable():
            return False
        from .settings import is_local, tiling_of

        tiling = tiling_of(context.object)
        return tiling is not None and is_local(tiling)

    def draw(self, context: Any) -> None:
        from .settings import tiling_of

        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.shown(self.layout, tiling_of(context.object).voronoi_tiles)

    def shown(self, layout: Any, settings: Any) -> None:
        raise NotImplementedError


class VORONOI_TILES_PT_field(_Part):
    """Copies of the tiles over cells"""

    bl_label = "Field"

    def shown(self, layout: Any, settings: Any) -> None:
        layout.prop(settings, "field")
        column = layout.column(align=True)
        column.active = settings.field
        for name in ("columns", "rows", "height", "colours"):
            column.prop(settings, name)


class VORONOI_TILES_PT_solids(_Part):
    """Solids in the field"""

    bl_label = "Solids"
    bl_options = {"DEFAULT_CLOSED"}

    def shown(self, layout: Any, settings: Any) -> None:
        column = layout.column(align=True)
        column.prop(settings, "loft")
        for name in ("turn", "grow", "shift", "about", "layers") if settings.loft else ("clearance", "chamfer"):
            column.prop(settings, name)
        layout.operator("voronoi_tiles.solids")
        from .showing import proved_solids

        if proved := proved_solids(settings.id_data):
            say(layout, [f"Proved: {proved}"], "CHECKMARK")


class VORONOI_TILES_PT_files(_Part):
    """Files of the tiles"""

    bl_label = "Files"
    bl_options = {"DEFAULT_CLOSED"}

    def shown(self, layout: Any, settings: Any) -> None:
        column = layout.column(align=True)
        for name in ("unit_mm", "sheet", "kerf", "feed", "power"):
            column.prop(settings, name)
        layout.operator_menu_enum("voronoi_tiles.export", "suffix")
        layout.operator("voronoi_tiles.remove")


def say(layout: Any, sentences: Iterable[str], icon: str) -> None:
    """Sentences in lines that the panel holds."""
    for sentence in sentences:
        column = layout.column(align=True)
        for number, line in enumerate(textwrap.wrap(sentence, WIDTH)):
            column.label(text=line, icon="BLANK1" if number else icon)


CLASSES = (VORONOI_TILES_PT_tiles, VORONOI_TILES_PT_field, VORONOI_TILES_PT_solids, VORONOI_TILES_PT_files)

register, unregister = bpy.utils.register_classes_factory(CLASSES)

# SPDX-License-Identifier: GPL-3.0-or-later
"""What a tiling keeps in the file: settings of the empty object that stands at the group's origin, and whose it is."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from voronoi_tiles.groups.wallpaper import GROUPS

DRAWN = ("CURVE", "GPENCIL", "GREASEPENCIL")
"""The types of objects that can be sites; grease pencil is called otherwise before 4.3."""

GROUP_ITEMS = [(name, name, f"{group.system} cell, {group.order} copies") for name, group in GROUPS.items()]

ELSEWHERE = "is of another file: make it local, or open that file"
"""What keeps an object from being changed, after its name."""


def _changed(settings: Any, _context: Any) -> None:
    """The tiles are others: at once, so that what comes and goes is in the step of undo that follows."""
    from . import live, updating

    if settings.role == "tiling" and settings.live and is_local(settings.id_data):
        updating.update(settings.id_data, built=True)
        live.mark(settings.id_data)


def _length(name: str, description: str, default: float, least: float = 0.0, **others: Any) -> Any:
    return FloatProperty(name=name, description=description, default=default, min=least, precision=3, **others)


class VORONOI_TILES_Site(bpy.types.PropertyGroup):
    """A site of a tiling: the object that it is drawn as, that of its tile, and what the tile's mesh is drawn about.

    It is one for as long as the object says so, whose `of` is the tiling.
    """

    __annotations__ = {
        "object": PointerProperty(type=bpy.types.Object, name="Site"),
        "tile": PointerProperty(type=bpy.types.Object),
        "pivot": FloatVectorProperty(size=2),
        "size": FloatVectorProperty(size=2),
    }


class VORONOI_TILES_Source(bpy.types.PropertyGroup):
    """What copies are instances of: a collection that holds a tile, as drawn or turned over, in a colour."""

    __annotations__ = {
        "site": IntProperty(),
        "mirrored": BoolProperty(),
        "colour": IntProperty(),
        "collection": PointerProperty(type=bpy.types.Collection),
        "object": PointerProperty(type=bpy.types.Object),
    }


class VORONOI_TILES_Settings(bpy.types.PropertyGroup):
    """What the extension knows of an object.

    `role` is "tiling" for the empty at the origin, else what it is of the tiling `of`: "site", "tile", "copy",
    "source", "marker"; `key` is the name of the site or copy, `number` a copy's. All others are the tiling's, and
    `of` is itself: in a copy that a user makes, it is not.
    """

    __annotations__ = {
        "role": StringProperty(),
        "key": StringProperty(),
        "number": IntProperty(),
        "of": PointerProperty(type=bpy.types.Object),
        "sites": CollectionProperty(type=VORONOI_TILES_Site),
        "sources": CollectionProperty(type=VORONOI_TILES_Source),
        "results": PointerProperty(type=bpy.types.Collection),
        "field_results": PointerProperty(type=bpy.types.Collection),
        "marker": PointerProperty(type=bpy.types.Object),
        # What is shown, and of what: undo takes both back together.
        "drawn": StringProperty(),
        "built": StringProperty(),
        "placed": StringProperty(),
        "message": StringProperty(),
        "proved": BoolProperty(),
        "group": EnumProperty(
            name="Group",
            description="The wallpaper group that copies the sites over the plane",
            items=GROUP_ITEMS,
            default="p4",
            update=_changed,
        ),
        "a": _length("a", "The cell's side along x", 60.0, 1e-3, update=_changed),
        "b": _length("b", "The cell's other side", 60.0, 1e-3, update=_changed),
        "angle": FloatProperty(
            name="Angle", description="Degrees from a to b", default=90.0, min=1.0, max=179.0, update=_changed
        ),
        "live": BoolProperty(
            name="Live", description="Compute the tiles anew whenever a site changes", default=True, update=_changed
        ),
        "smoothing": FloatProperty(
            name="Smoothing",
            description="How far strokes drawn by hand may be smoothed, in percent of the cell's side",
            default=0.5,
            min=0.001,
            max=10.0,
            update=_changed,
        ),
        "field": BoolProperty(
            name="Field", description="Fill cells with copies of the tiles", default=True, update=_changed
        ),
        "columns": IntProperty(name="Cells", description="Cells along a", default=3, min=1, max=100, update=_changed),
        "rows": IntProperty(name="Rows", description="Cells along b", default=3, min=1, max=100, update=_changed),
        "height": _length("Height", "How high tiles are", 3.0, 1e-4, update=_changed),
        "colours": EnumProperty(
            name="Colours",
            description="What the colours of copies go by",
            items=[
                ("fewest", "Fewest", "No two neighbours are alike"),
                ("none", "One", "All are alike"),
                ("site", "Site", "Each site has its colour"),
                ("handedness", "Handedness", "Tiles that are turned over have another"),
                ("orientation", "Orientation", "Tiles that are turned otherwise have another"),
            ],
            default="fewest",
            update=_changed,
        ),
        "unit_mm": _length("Unit in mm", "How many millimetres a unit of Blender is in files", 1.0, 1e-4),
        "clearance": _length("Clearance", "Room between neighbours, in mm", 0.0),
        "chamfer": _length("Chamfer", "How far rims are broken, in mm", 0.0),
        "loft": BoolProperty(name="Loft", description="Let the strokes move on the way up", default=False),
        "turn": FloatProperty(name="Turn", description="Degrees by which strokes turn on the way up", default=90.0),
        "grow": FloatProperty(name="Scale", description="What strokes become on the way up", default=1.0, min=0.01),
        "shift": FloatVectorProperty(name="Shift", description="How far strokes move on the way up", size=2),
        "about": FloatVectorProperty(name="About", description="The point that strokes turn about", size=2),
        "layers": IntProperty(
            name="Layers", description="Heights at which tiles are exact", default=21, min=2, max=500
        ),
        "sheet": StringProperty(
            name="Sheet", description="What to fill, a size such as 300x200mm, or an SVG file; empty for one of each"
        ),
        "kerf": _length("Kerf", "The width of the cut, in mm", 0.0),
        "feed": _length("Feed", "For G-code, how fast the laser moves, in mm a minute", 0.0),
        "power": _length("Power", "For G-code, how strong it is: the value of S", 0.0),
    }


CLASSES = (VORONOI_TILES_Site, VORONOI_TILES_Source, VORONOI_TILES_Settings)

_register, _unregister = bpy.utils.register_classes_factory(CLASSES)


def register() -> None:
    """Give every object its settings."""
    _register()
    bpy.types.Object.voronoi_tiles = PointerProperty(type=VORONOI_TILES_Settings)


def unregister() -> None:
    """Take them away; what they hold stays in the file."""
    del bpy.types.Object.voronoi_tiles
    _unregister()


def owner(item: Any) -> Any:
    """The empty of the tiling that an object belongs to, which may have been deleted; None where it belongs to none."""
    if item is None:
        return None
    return item if item.voronoi_tiles.role == "tiling" else item.voronoi_tiles.of


def tiling_of(item: Any) -> Any:
    """The same, None where it has been deleted."""
    found = owner(item)
    return found if found is not None and found.users_scene else None


def is_local(item: Any) -> bool:
    """Whether an object is of this file: what is linked, or overridden, keeps nothing that is written to it."""
    return item.library is None and item.override_library is None


def tilings() -> list[Any]:
    """The empties of all tilings in the file."""
    return [
        item for item in bpy.data.objects if item.voronoi_tiles.role == "tiling" and is_local(item) and item.users_scene
    ]

"""From the file to its removal: install, use, save, open again, disable, enable."""

from session import FOLDER, ID, answer, bpy, installed, quiet, site, tile_points, tiling

import addon_utils

installed()
import voronoi_tiles
from voronoi_tiles.base import kernels

library = voronoi_tiles.__file__
bpy.ops.voronoi_tiles.starter(group="pgg")
bpy.context.view_layer.update()
before = tile_points("lizard")
copies = sum(item.voronoi_tiles.role == "copy" for item in bpy.data.objects)
saved = str(FOLDER / "saved.blend")
bpy.ops.wm.save_as_mainfile(filepath=saved)
bpy.ops.wm.read_homefile(use_empty=True)
bpy.ops.wm.open_mainfile(filepath=saved)
quiet()
again = tile_points("lizard")
proved = tiling().voronoi_tiles.proved
copies_again = sum(item.voronoi_tiles.role == "copy" for item in bpy.data.objects)
site().data.splines[0].bezier_points[0].co.x += 1.0
quiet()
moved = tile_points("lizard")


def handlers():
    """How many of ours listen."""
    return sum(handler.__module__.startswith(ID) for handler in bpy.app.handlers.depsgraph_update_post)


listening = handlers()
bpy.context.view_layer.update()
addon_utils.disable(ID, default_set=True)
left = {
    "handlers": handlers(),
    "settings": hasattr(bpy.types.Object, "voronoi_tiles"),
    "operators": hasattr(bpy.types, "VORONOI_TILES_OT_tile"),
    "panels": hasattr(bpy.types, "VORONOI_TILES_PT_tiles"),
    "objects": len(bpy.data.objects),
}
addon_utils.enable(ID, default_set=True)
bpy.context.view_layer.update()
site().data.splines[0].bezier_points[0].co.x += 1.0
quiet()
enabled = tile_points("lizard")
objects = len(bpy.data.objects)
bpy.context.view_layer.objects.active = tiling()
bpy.ops.voronoi_tiles.remove()
answer(
    library=library,
    kernels=kernels.in_use(),
    same=before == again,
    proved=proved,
    copies=[copies, copies_again],
    follows=moved not in (again, enabled) and len(enabled) > 50,
    listening=listening,
    left=left,
    objects=objects,
    remain=sorted(item.name for item in bpy.data.objects),
    collections=len(bpy.data.collections),
)

"""What a step of dragging costs Blender: a site of 24 segments, one of whose points moves; processor time.

The arguments are how many cells the fields have along each side.
"""

import sys
import time

import numpy as np
from session import answer, bpy, installed, module, quiet, site, tiling

installed()
live = module("live")
curve = bpy.data.curves.new("line", "CURVE")
spline = curve.splines.new("POLY")
spline.points.add(24)
for k, point in enumerate(spline.points):
    point.co = (6 + 0.8 * k, 12 + 6 * np.sin(k / 4), 0, 1)
item = bpy.data.objects.new("line", curve)
bpy.context.scene.collection.objects.link(item)
item.select_set(True)
bpy.context.view_layer.objects.active = item
bpy.ops.voronoi_tiles.tile(group="p4")
assert tiling().voronoi_tiles.proved
from voronoi_tiles.base import kernels


def dragged(cells):
    """The seconds of each step in a field, of what the extension does and of Blender's views, and of the pauses."""
    settings = tiling().voronoi_tiles
    settings.columns = settings.rows = cells
    quiet()
    found = {"updates": [], "views": [], "proofs": []}
    for k in range(120):
        moved(k, found)
    found["copies"] = sum(one.voronoi_tiles.role == "copy" for one in tiling().children)
    return found


def moved(k, found):
    """One step, and after ten of them a pause."""
    site().data.splines[0].points[12].co.y += 0.02 * (-1) ** (k // 20)
    begun = time.process_time()
    bpy.context.view_layer.update()
    marked = time.process_time()
    assert live._changed
    live.tick()
    done = time.process_time()
    bpy.context.view_layer.update()
    seen = time.process_time()
    assert not tiling().voronoi_tiles.message
    found["updates"].append(done - marked)
    found["views"].append(seen - done + marked - begun)
    if k % 10 == 9:
        begun = time.process_time()
        quiet()
        found["proofs"].append(time.process_time() - begun)
        assert tiling().voronoi_tiles.proved


fields = [dragged(int(cells)) for cells in sys.argv[3:]]
(tile,) = (one for one in tiling().children if one.voronoi_tiles.role == "tile")
arcs = sum(len(one.bezier_points) for one in tile.data.splines)
answer(fields=fields, kernels=kernels.in_use(), arcs=arcs)

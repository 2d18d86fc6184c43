"""What a step of dragging costs Blender: a site of 24 segments, one of whose points moves; processor time."""

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

updates, views, proofs = [], [], []
for k in range(120):
    site().data.splines[0].points[12].co.y += 0.02 * (-1) ** (k // 20)
    begun = time.process_time()
    bpy.context.view_layer.update()
    assert live._changed
    live.tick()
    done = time.process_time()
    bpy.context.view_layer.update()
    seen = time.process_time()
    assert not tiling().voronoi_tiles.message
    updates.append(done - begun)
    views.append(seen - done)
    if k % 10 == 9:
        begun = time.process_time()
        quiet()
        proofs.append(time.process_time() - begun)
        assert tiling().voronoi_tiles.proved
(tile,) = (one for one in tiling().children if one.voronoi_tiles.role == "tile")
answer(
    updates=updates,
    views=views,
    proofs=proofs,
    kernels=kernels.in_use(),
    arcs=sum(len(one.bezier_points) for one in tile.data.splines),
    copies=sum(one.voronoi_tiles.role == "copy" for one in tiling().children),
)

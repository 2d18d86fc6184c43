"""All that can be drawn: splines of all types, grease pencil; objects that are moved; several sites."""

import numpy as np
from session import answer, bpy, installed, module, quiet, tiling

installed()
reading = module("reading")
from voronoi_tiles.blender.drawn_splines import _along_nurbs

off = {}
for order, flags, count in [
    (3, {}, 7),
    (4, {}, 7),
    (5, {"use_endpoint_u": True}, 7),
    (4, {"use_cyclic_u": True}, 7),
    (4, {"use_endpoint_u": True}, 7),
    (4, {"use_bezier_u": True, "use_endpoint_u": True}, 7),
    (3, {"use_bezier_u": True}, 7),
    # Bezier curves that are closed by as many points as they need, and that are not.
    (3, {"use_bezier_u": True, "use_cyclic_u": True}, 8),
    (3, {"use_bezier_u": True, "use_cyclic_u": True}, 7),
    (4, {"use_bezier_u": True, "use_cyclic_u": True, "use_endpoint_u": True}, 9),
    (4, {"use_bezier_u": True, "use_cyclic_u": True}, 8),
    (5, {"use_bezier_u": True}, 5),
]:
    curve = bpy.data.curves.new("nurbs", "CURVE")
    curve.dimensions = "3D"
    spline = curve.splines.new("NURBS")
    spline.points.add(count - 1)
    for k, point in enumerate(spline.points):
        point.co = (k + 0.3 * (k % 3), (k * k) % 5, 0, 1 + k % 2)
    spline.order_u = order
    for name, value in flags.items():
        setattr(spline, name, value)
    spline.resolution_u = 200
    item = bpy.data.objects.new("nurbs", curve)
    bpy.context.scene.collection.objects.link(item)
    bpy.context.view_layer.update()
    mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    drawn = np.array([complex(v.co.x, v.co.y) for v in mesh.vertices])
    (read,) = reading.splines(item, np.eye(4))
    ours = read.points if read.kind == "poly" else np.concatenate(_along_nurbs(read))
    # The chords of Blender's own are short: each of our points is on one, and its ends are ours.
    chords = np.column_stack((drawn, np.roll(drawn, -1)))[: None if flags.get("use_cyclic_u") else -1]
    t = ((ours[:, None] - chords[:, 0]) * (chords[:, 1] - chords[:, 0]).conj()).real
    t = np.clip(t / np.maximum(np.abs(chords[:, 1] - chords[:, 0]) ** 2, 1e-30), 0, 1)
    away = np.abs(ours[:, None] - chords[:, 0] - t * (chords[:, 1] - chords[:, 0])).min(axis=1).max()
    ends = 0.0 if flags.get("use_cyclic_u") else max(abs(ours[0] - drawn[0]), abs(ours[-1] - drawn[-1]))
    off[f"{order} {' '.join(flags)} {count}"] = [float(away), float(ends)]
    bpy.data.objects.remove(item)

# Grease pencil, in whichever way this Blender has it.
pencil = getattr(bpy.data, "grease_pencils_v3", bpy.data.grease_pencils).new("pencil")
layer = pencil.layers.new("lines")
frame = layer.frames.new(1)
row = [(6 + 0.2 * k, 9 + np.sin(k / 12) * 4, 0.0) for k in range(100)]
if hasattr(frame, "drawing"):
    frame.drawing.add_strokes([len(row)])
    for point, place in zip(frame.drawing.strokes[0].points, row, strict=True):
        point.position = place
else:
    stroke = frame.strokes.new()
    stroke.points.add(len(row))
    for point, place in zip(stroke.points, row, strict=True):
        point.co = place
hand = bpy.data.objects.new("hand", pencil)
bpy.context.scene.collection.objects.link(hand)
curve = bpy.data.curves.new("line", "CURVE")
spline = curve.splines.new("POLY")
spline.points.add(1)
spline.points[0].co, spline.points[1].co = (0, 0, 0, 1), (0, 8, 0, 1)
line = bpy.data.objects.new("line", curve)
line.location, line.rotation_euler, line.scale = (40, 9, 2), (0, 0, np.pi / 2), (2, 2, 2)
bpy.context.scene.collection.objects.link(line)
bpy.context.view_layer.update()
for item in (hand, line):
    item.select_set(True)
bpy.context.view_layer.objects.active = hand
bpy.ops.voronoi_tiles.tile(group="pmg")
# A stroke of Bezier curves, since 4.3; a layer in a hidden group.
bezier = []
if hasattr(frame, "drawing"):
    other = bpy.data.objects.new("other", pencil.copy())
    bpy.context.scene.collection.objects.link(other)
    drawing = other.data.layers[0].frames[0].drawing
    drawing.set_types(type="BEZIER", indices=[0])
    for k, name in enumerate(("handle_left", "handle_right")):
        made = drawing.attributes.get(name) or drawing.attributes.new(name, "FLOAT_VECTOR", "POINT")
        made.data.foreach_set("vector", np.array(row, np.float32).ravel() + np.float32(k + 1))
    (read,) = reading.splines(other, np.eye(4))
    bezier = [read.kind, *(abs(part - read.points).max() for part in (read.left, read.right)), len(read.points)]
    group = other.data.layer_groups.new("group")
    other.data.layers.move_to_layer_group(other.data.layers[0], group)
    group.hide = True
    bezier.append(len(list(reading.splines(other, np.eye(4)))))
    bpy.data.objects.remove(other)
settings = tiling().voronoi_tiles
first = [settings.message, settings.proved, [site.object.name for site in settings.sites]]
cell = [settings.a, settings.b]
drawn = dict(reading.drawn_tiling(tiling()).sites)
origin = tiling().matrix_world.translation
seen = [complex(z + complex(origin.x, origin.y)) for z in drawn["line"][0].points]
sizes = [list(site.size) for site in settings.sites]
tiling().location.x += 1.5
quiet()
moved = [list(site.size) for site in settings.sites]
bpy.data.objects.remove(line)
bpy.context.view_layer.update()
bpy.context.view_layer.objects.active = tiling()
bpy.ops.voronoi_tiles.update()
tiles = sorted(item.voronoi_tiles.key for item in tiling().children if item.voronoi_tiles.role == "tile")
message = [settings.message, settings.proved]
# A tiling whose empty is deleted is gone, though its site names it; another begins.
for one in list(tiling().users_collection):
    one.objects.unlink(tiling())
gone = module("settings").tiling_of(hand)
bpy.context.view_layer.objects.active = hand
hand.select_set(True)
bpy.ops.voronoi_tiles.tile(group="pg")
another = [tiling().voronoi_tiles.group, tiling().voronoi_tiles.proved]
answer(
    nurbs=off,
    tile=first,
    cell=cell,
    seen=[[z.real, z.imag] for z in seen],
    resized=sizes != moved,
    bezier=bezier,
    strokes=len(drawn["hand"][0].points),
    left=message,
    tiles=tiles,
    gone=gone is None,
    another=another,
)

"""What users' hands do to what is shown: copies, deletions, new names, other modes, frames, files of others."""

import numpy as np
from session import FOLDER, answer, bpy, installed, module, quiet, site, tile_points, tiling

installed()
panel, settings_of, showing = module("panel"), module("settings"), module("showing")
found = {}


def emptied():
    """Start anew, with a starter in p4, undo and all."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.voronoi_tiles.starter(group="p4")
    quiet()
    bpy.ops.ed.undo_push(message="starter")


def chosen(*items):
    """Select these objects, the first one as the active one."""
    bpy.context.view_layer.update()
    for item in bpy.context.view_layer.objects:
        item.select_set(item in items)
    bpy.context.view_layer.objects.active = items[0]


def role(item, name):
    """The objects of a tiling that have a role."""
    return [one for one in item.children if one.voronoi_tiles.role == name]


def updated(item):
    """Press Update on a tiling, and let the timer do its work."""
    chosen(item)
    bpy.ops.voronoi_tiles.update()
    quiet()


def sizes():
    """How many vertices the meshes have: prisms and solids have others."""
    return sorted(len(mesh.vertices) for mesh in showing.sources(tiling()).values())


def shown(item):
    """What is seen of a tiling: its tiles' points, and of each copy where it is and what it shows."""
    bpy.context.view_layer.update()
    curves = [[list(point.co) for point in one.data.splines[0].bezier_points] for one in role(item, "tile")]
    copies = []
    for one in sorted(role(item, "copy"), key=lambda one: one.voronoi_tiles.key):
        mesh = one.instance_collection.objects[0].data
        coordinates = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", coordinates)
        copies.append([one.voronoi_tiles.key, [list(row) for row in one.matrix_world], coordinates.tolist()])
    return [curves, copies]


# A copy of the empty alone has no sites; one of all is a tiling of its own after Update.
emptied()
one = tiling()
before = shown(one)
chosen(one)
bpy.ops.object.duplicate()
two = bpy.context.object
quiet()
found["copy of the empty"] = two.voronoi_tiles.message
two.voronoi_tiles.group = "p6"
bpy.ops.voronoi_tiles.remove()
quiet()
found["the other stays"] = [shown(one) == before]
chosen(*one.children_recursive, site(), one)
bpy.ops.object.duplicate()
two = next(item for item in settings_of.tilings() if item != one)
quiet()
found["copy of all"] = two.voronoi_tiles.message
updated(two)
two.voronoi_tiles.group = "p2"
(sole,) = two.voronoi_tiles.sites
sole.object.location.x += 1.0
quiet()
found["copy of all"] = [found["copy of all"], two.voronoi_tiles.message, len(role(two, "copy"))]
found["the other stays"].append(shown(one) == before)
chosen(two)
bpy.ops.voronoi_tiles.remove()
quiet()
found["the other stays"].append(shown(one) == before)

# A tiling whose empty is deleted: a tile that is left can be a site, and all that is left can be removed.
chosen(one)
bpy.ops.object.delete()
(left,) = (item for item in bpy.data.objects if item.voronoi_tiles.role == "tile")
chosen(left)
bpy.ops.voronoi_tiles.tile(group="p1")
found["tile as site"] = [tiling().voronoi_tiles.message, tiling().voronoi_tiles.proved]
chosen(tiling())
bpy.ops.voronoi_tiles.remove()
chosen(bpy.data.objects["bird"])
bpy.ops.voronoi_tiles.remove()
found["left of it"] = sorted(item.name for item in bpy.data.objects)

# What has no place, and back; what is deleted comes back with Update.
emptied()
before = shown(tiling())
said = []
for matrix in (np.zeros((4, 4)), np.diag([1e-30, 1.0, 1.0, 1.0]), np.full((4, 4), np.nan)):
    tiling().matrix_world = matrix.tolist()
    quiet()
    said.append(tiling().voronoi_tiles.message)
tiling().matrix_world = np.eye(4).tolist()
for place in (np.nan, np.inf, 1e30, 1e6):
    site().location.x = place
    quiet()
    said.append(tiling().voronoi_tiles.message)
site().location.x = 0.0
quiet()
found["no place"] = said
found["back"] = shown(tiling()) == before
chosen(*role(tiling(), "tile"))
bpy.ops.object.convert(target="MESH")
site().location.x = 1.0
quiet()
for item in (*role(tiling(), "tile"), *role(tiling(), "marker"), *role(tiling(), "copy")[:5]):
    bpy.data.objects.remove(item)
site().location.x = 0.0
quiet()
for name in ("field_results", "results"):
    for item in list(getattr(tiling().voronoi_tiles, name).objects):
        bpy.context.scene.collection.objects.link(item)
    bpy.data.collections.remove(getattr(tiling().voronoi_tiles, name))
updated(tiling())
found["mended"] = shown(tiling()) == before
tiling().voronoi_tiles.a = 20.0
quiet()
found["marked"] = not role(tiling(), "marker")[0].hide_viewport
chosen(site())
bpy.ops.object.convert(target="MESH")
quiet()
found["converted"] = tiling().voronoi_tiles.message

# New names: tiles follow as before, and are called so with Update; copies are called as what they are.
emptied()
site().name = "robin"
before = shown(tiling())
site().location.x += 1.0
quiet()
found["renamed"] = [tiling().voronoi_tiles.message, shown(tiling()) != before]
updated(tiling())
role(tiling(), "copy")[0].location.z = 7.0
lifted = role(tiling(), "copy")[0].voronoi_tiles.key
tiling().voronoi_tiles.columns = 4
quiet()
found["lifted"] = [item.voronoi_tiles.key == lifted for item in role(tiling(), "copy") if item.location.z]
tiling().voronoi_tiles.group = "p2"
quiet()
found["called"] = [item.name.startswith("robin ") for item in role(tiling(), "tile")]
found["called"] += [item.name == item.voronoi_tiles.key for item in role(tiling(), "copy")]

# Solids stay through undo of something else, Update and files; a drag ends them.
emptied()
prisms = sizes()
tiling().voronoi_tiles.chamfer = 0.5
bpy.ops.voronoi_tiles.solids()
bpy.ops.ed.undo_push(message="solids")
solids = [sizes()]
bpy.ops.mesh.primitive_cube_add()
bpy.ops.ed.undo_push(message="cube")
bpy.ops.ed.undo()
quiet()
solids.append(sizes())
updated(tiling())
solids.append(sizes())
bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "solids.blend"))
bpy.ops.wm.open_mainfile(filepath=str(FOLDER / "solids.blend"))
quiet()
solids.append(sizes())
found["solids"] = [prisms != solids[0], solids == 4 * solids[:1], showing.proved_solids(tiling())]
site().location.x += 0.5
quiet()
found["dragged"] = [sizes() == solids[0], showing.proved_solids(tiling())]

# Another object in the edit mode; frames; a tiling and a site of another file.
bpy.ops.wm.read_homefile(use_empty=True)
bpy.ops.mesh.primitive_cube_add()
bpy.ops.object.mode_set(mode="EDIT")
bpy.ops.voronoi_tiles.starter(group="p4")
found["modes"] = [item.name for item in bpy.data.objects if item.mode != "OBJECT"]
before = tile_points("bird")
for frame, x in ((1, 0.0), (11, 2.0)):
    site().location.x = x
    site().keyframe_insert("location", frame=frame)
bpy.context.scene.frame_set(6)
quiet()
during = tile_points("bird")
bpy.context.scene.frame_set(1)
quiet()
found["frames"] = [during != before, tile_points("bird") == before]
bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "other.blend"))
bpy.ops.wm.read_homefile(use_empty=True)
with bpy.data.libraries.load(str(FOLDER / "other.blend"), link=True) as (_, wanted):
    wanted.collections, wanted.objects = ["p4 tiles"], ["bird", "Cube"]
bpy.context.scene.collection.children.link(bpy.data.collections["p4 tiles"])
bpy.context.scene.collection.objects.link(bpy.data.objects["bird"])
linked = bpy.data.objects["p4 tiling"]
chosen(linked)
before = shown(linked)
linked.voronoi_tiles.group = "p2"
module("live").on_other_state()
quiet()
offers = ("update", "solids", "export", "remove")
found["linked"] = [shown(linked) == before, [getattr(bpy.ops.voronoi_tiles, name).poll() for name in offers]]
try:
    chosen(bpy.data.objects["bird"])
    bpy.ops.voronoi_tiles.tile()
except RuntimeError as error:
    found["linked"].append(str(error))
answer(**found)

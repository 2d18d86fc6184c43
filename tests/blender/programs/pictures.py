"""The pictures of the documentation: fields as Cycles renders them by the processor, without a window."""

import sys

from session import FOLDER, answer, bpy, installed, module, quiet, tiling

from mathutils import Vector

WIDTH, HEIGHT = 600, 400

installed()


def rendered(name, centre, distance, rise):
    """Render what there is, seen from a distance, as a PNG."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.seed = "CPU", 32, True, 1
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    scene.view_settings.view_transform = "Standard"
    world = scene.world = bpy.data.worlds.new("world")
    if world.node_tree is None:
        world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (1.0, 1.0, 1.0, 1.0)
    world.node_tree.nodes["Background"].inputs[1].default_value = 0.7
    lamp = bpy.data.lights.new("sun", "SUN")
    lamp.energy, lamp.angle = 2.5, 0.05
    sun = bpy.data.objects.new("sun", lamp)
    sun.rotation_euler = (0.7, 0.25, 0.6)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.clip_end, camera.data.lens = 10 * distance, 60
    camera.location = Vector(centre) + distance * Vector((0.25, -1.0, rise)).normalized()
    camera.rotation_euler = (Vector(centre) - camera.location).to_track_quat("-Z", "Y").to_euler()
    for item in (sun, camera):
        scene.collection.objects.link(item)
    scene.camera = camera
    scene.render.filepath = str(FOLDER / f"{name}.png")
    bpy.ops.render.render(write_still=True)


def emptied():
    """Start anew."""
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    for one in (*bpy.data.collections, *bpy.data.materials):
        bpy.data.batch_remove([one])


def copies():
    """The copies that are seen."""
    return [item for item in tiling().children if item.voronoi_tiles.role == "copy" and not item.hide_viewport]


def lifted(by):
    """Lift the tile that is drawn."""
    for item in copies():
        if item.voronoi_tiles.key.endswith(" x,y"):
            item.location.z = by


bpy.ops.voronoi_tiles.open(filepath=sys.argv[3])
settings = tiling().voronoi_tiles
settings.columns, settings.rows, settings.height = 4, 4, 6.0
quiet()
lifted(12.0)
rendered("field", (30, 25, 0), 430, 1.1)
emptied()
bpy.ops.voronoi_tiles.open(filepath=sys.argv[4])
settings = tiling().voronoi_tiles
settings.columns, settings.rows, settings.height = 3, 3, 40.0
settings.loft, settings.turn, settings.about = True, 90.0, (15.0, 14.0)
quiet()
bpy.ops.voronoi_tiles.solids()
assert module("showing").proved_solids(tiling())
lifted(55.0)
rendered("loft", (15, 5, 25), 440, 0.75)
answer()

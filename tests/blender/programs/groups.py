"""The starters of all groups: the instances that Blender draws, and what it finds of their meshes."""

import sys

import numpy as np
from session import FOLDER, answer, bpy, installed, quiet, tiling

import bmesh  # after Blender, which brings it

installed()
found = {}
for group in sys.argv[3].split(","):
    bpy.ops.voronoi_tiles.starter(group=group)
    settings = tiling().voronoi_tiles
    settings.columns, settings.rows = 2, 3
    quiet()
    assert settings.proved, settings.message
    bpy.context.view_layer.update()
    names, matrices, vertices, tops = [], [], {}, []
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for instance in depsgraph.object_instances:
        if not instance.is_instance:
            continue
        names.append(instance.parent.original.voronoi_tiles.key)
        mesh = instance.object.data
        matrices.append(np.array(instance.matrix_world))
        if mesh.name not in vertices:
            co = np.empty(3 * len(mesh.vertices), np.float32)
            mesh.vertices.foreach_get("co", co)
            shape = bmesh.new()
            shape.from_mesh(mesh)
            manifold = all(edge.is_manifold and edge.is_contiguous for edge in shape.edges)
            area = sum(face.calc_area() for face in shape.faces if face.normal.z > 0.5)
            vertices[mesh.name] = co.reshape(-1, 3), manifold, area, shape.calc_volume(signed=True)
            shape.free()
        tops.append([mesh.name, *vertices[mesh.name][1:]])
    np.savez(FOLDER / f"{group}.npz", matrices=np.array(matrices), **{name: row[0] for name, row in vertices.items()})
    bpy.context.view_layer.objects.active = tiling()
    bpy.ops.voronoi_tiles.export(filepath=str(FOLDER / f"{group}.toml"))
    found[group] = {"names": names, "meshes": tops, "height": settings.height}
    bpy.context.view_layer.objects.active = tiling()
    bpy.ops.voronoi_tiles.remove()
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
answer(groups=found)

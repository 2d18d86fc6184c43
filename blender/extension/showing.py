# SPDX-License-Identifier: GPL-3.0-or-later
"""What is shown of a tiling: a curve for each tile, meshes that copies are instances of, the copies, a marker.

Objects are found by their settings and changed in place, and nothing is held between calls: undo, a new file and a
user's own hand may change all of it at any time.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from voronoi_tiles.blender.cubic_splines import CubicSpline, coordinates, cubic_splines
from voronoi_tiles.blender.field import FieldCopies
from voronoi_tiles.blender.polygon_mesh import PolygonMesh
from voronoi_tiles.vector.outline import Outline

FREE = 0
"""What `foreach_set` takes for a handle of the type FREE."""

RESOLUTION = 4
"""Chords of an arc in a view; a count. Arcs are short, and files have them exactly."""


def own(tiling: Any, role: str) -> list[Any]:
    """The objects of a tiling that have a role, children of its empty."""
    return [item for item in tiling.children if item.voronoi_tiles.role == role]


def build_tiles(tiling: Any, names: Sequence[str]) -> None:
    """A curve object for each tile, whose name is its site's, and a marker; those of other sites are removed."""
    there = {item.voronoi_tiles.key: item for item in own(tiling, "tile")}
    for name in names:
        item = there.pop(name, None)
        if item is None:
            curve = bpy.data.curves.new(f"{name} tile", "CURVE")
            curve.dimensions = "2D"
            curve.resolution_u = RESOLUTION
            item = _added(tiling, f"{name} tile", curve, "tile", name)
        # Beneath prisms a face would fight with theirs.
        item.data.fill_mode = "NONE" if tiling.voronoi_tiles.field else "BOTH"
    _remove(list(there.values()))


def build_marker(tiling: Any) -> None:
    """The marker of a place where copies touch, hidden."""
    item = _added(tiling, "Copies touch here", None, "marker", "")
    item.empty_display_type = "SPHERE"
    item.show_in_front = item.show_name = True
    item.hide_viewport = item.hide_render = True


def show_tiles(tiling: Any, outlines: Sequence[tuple[str, Outline]]) -> None:
    """Give the tiles' curves their outlines."""
    there = {item.voronoi_tiles.key: item for item in own(tiling, "tile")}
    for name, outline in outlines:
        if name in there:  # else someone has deleted it
            set_splines(there[name].data, cubic_splines(outline))


def set_splines(curve: Any, found: Sequence[CubicSpline]) -> None:
    """Give a curve these splines."""
    if [len(spline.bezier_points) for spline in curve.splines] != [len(spline.points) for spline in found]:
        curve.splines.clear()
        for one in found:
            spline = curve.splines.new("BEZIER")
            spline.bezier_points.add(len(one.points) - 1)
            spline.use_cyclic_u = True
            for side in ("left", "right"):
                spline.bezier_points.foreach_set(f"handle_{side}_type", np.full(len(one.points), FREE, np.int32))
    for spline, one in zip(curve.splines, found, strict=True):
        for name, points in (("co", one.points), ("handle_left", one.left), ("handle_right", one.right)):
            spline.bezier_points.foreach_set(name, coordinates(points))
    curve.update_tag()


def set_mesh(mesh: Any, found: PolygonMesh) -> None:
    """Give a mesh these polygons."""
    if len(mesh.vertices) != len(found.vertices) or len(mesh.loops) != len(found.corners):
        mesh.clear_geometry()
        mesh.vertices.add(len(found.vertices))
        mesh.loops.add(len(found.corners))
        mesh.polygons.add(len(found.starts) - 1)
        mesh.shade_flat()
    mesh.vertices.foreach_set("co", found.vertices.ravel())
    mesh.loops.foreach_set("vertex_index", found.corners)
    mesh.polygons.foreach_set("loop_start", found.starts[:-1])
    mesh.update(calc_edges=True)


def build_field(tiling: Any, copies: FieldCopies | None, names: Sequence[str]) -> None:
    """The copies of a field, each an instance of a collection that holds its tile; None removes them.

    `names` are those of the sites.
    """
    settings = tiling.voronoi_tiles
    there = own(tiling, "copy")
    if copies is None:
        _remove(there)
        _keep_sources(settings, set())
        return
    kinds = np.column_stack((copies.tile, copies.mirrored, copies.colour))
    used, index = np.unique(kinds, axis=0, return_inverse=True)
    wanted = [(int(tile), bool(mirrored), int(colour)) for tile, mirrored, colour in used]
    collections = [_source(tiling, kind, names[kind[0]], copies.colours[kind[2]]) for kind in wanted]
    _remove(there[len(kinds) :])
    there = there[: len(kinds)]
    for name in copies.names[len(there) :]:
        item = _added(tiling, name, None, "copy", name, settings.field_results)
        item.instance_type = "COLLECTION"
        item.empty_display_size = settings.a / 60
        there.append(item)
    for number, (item, name, kind) in enumerate(zip(there, copies.names, index.ravel().tolist(), strict=True)):
        item.voronoi_tiles.key, item.voronoi_tiles.number = name, number
        item.instance_collection = collections[kind]
    _keep_sources(settings, set(wanted))


def place_copies(tiling: Any, copies: FieldCopies) -> None:
    """Put the copies of a field where they are, and hide those that are there already."""
    matrices, shown = copies.matrices().tolist(), copies.shown.tolist()
    for item in own(tiling, "copy"):
        number = item.voronoi_tiles.number
        # Whole, as it is: of location, rotation and scale Blender would make angles, whose sines are not exact.
        item.matrix_parent_inverse = Matrix(matrices[number])
        if item.hide_viewport == shown[number]:
            item.hide_viewport = item.hide_render = not shown[number]


def sources(tiling: Any) -> dict[tuple[int, bool], Any]:
    """The meshes that copies show, by the number of the site and whether they are turned over."""
    return {(one.site, one.mirrored): one.mesh for one in tiling.voronoi_tiles.sources}


def mark_place(tiling: Any, place: complex | None) -> None:
    """Put the marker at a place in the plane, or hide it."""
    for item in own(tiling, "marker"):
        if item.hide_viewport != (place is None):
            item.hide_viewport = place is None
        if place is not None:
            item.empty_display_size = tiling.voronoi_tiles.a / 40
            item.location = (place.real, place.imag, 0.0)


def remove_all(tiling: Any) -> None:
    """Remove what is shown of a tiling, and the tiling; the sites stay."""
    settings = tiling.voronoi_tiles
    for site in settings.sites:
        if site.object:
            site.object.voronoi_tiles.role = ""
            site.object.voronoi_tiles.of = None
    build_field(tiling, None, ())
    collections = [one for one in (settings.field_results, settings.results) if one]
    _remove([item for role in ("tile", "marker") for item in own(tiling, role)])
    bpy.data.objects.remove(tiling)
    for one in collections:
        if not one.all_objects and not one.children:
            bpy.data.collections.remove(one)


def _added(tiling: Any, name: str, data: Any, role: str, key: str, collection: Any = None) -> Any:
    """A new object of a tiling."""
    item = bpy.data.objects.new(name, data)
    item.voronoi_tiles.role, item.voronoi_tiles.of, item.voronoi_tiles.key = role, tiling, key
    item.parent = tiling
    (collection or tiling.voronoi_tiles.results).objects.link(item)
    return item


def _source(tiling: Any, kind: tuple[int, bool, int], name: str, colour: str) -> Any:
    """The collection that copies of a kind are instances of; made where it is not there."""
    settings = tiling.voronoi_tiles
    found = next((one for one in settings.sources if (one.site, one.mirrored, one.colour) == kind), None)
    if found is not None and found.collection is not None and found.mesh is not None and found.collection.objects:
        return found.collection
    title = f"{name} turned over" if kind[1] else name
    mesh = sources(tiling).get(kind[:2]) or bpy.data.meshes.new(title)
    item = bpy.data.objects.new(title, mesh)
    item.voronoi_tiles.role, item.voronoi_tiles.of, item.voronoi_tiles.key = "source", tiling, name
    if not mesh.materials:
        mesh.materials.append(None)  # a slot, whose material each object has for itself
    item.material_slots[0].link = "OBJECT"
    item.material_slots[0].material = _material(f"{tiling.name} colour {kind[2] + 1}", colour)
    collection = bpy.data.collections.new(title)
    collection.objects.link(item)
    if found is None:
        found = settings.sources.add()
    found.site, found.mirrored, found.colour, found.collection, found.mesh = *kind, collection, mesh
    return collection


def _keep_sources(settings: Any, wanted: set[tuple[int, bool, int]]) -> None:
    """Remove what no copy is an instance of any more."""
    for k in reversed(range(len(settings.sources))):
        one = settings.sources[k]
        if (one.site, one.mirrored, one.colour) in wanted:
            continue
        collection, mesh = one.collection, one.mesh
        settings.sources.remove(k)
        if collection:
            _remove(list(collection.objects))
            bpy.data.collections.remove(collection)
        if mesh and not any(other.mesh == mesh for other in settings.sources):
            bpy.data.meshes.remove(mesh)


def _material(name: str, colour: str) -> Any:
    """The material of a name, made with a colour "#rrggbb" where there is none: what a user makes of it stays."""
    found = bpy.data.materials.get(name)
    if found is not None:
        return found
    found = bpy.data.materials.new(name)
    if found.node_tree is None:
        found.use_nodes = True
    shade = [_linear(int(colour[k : k + 2], 16) / 255) for k in (1, 3, 5)] + [1.0]
    found.diffuse_color = shade
    for node in found.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            node.inputs["Base Color"].default_value = shade
    return found


def _linear(value: float) -> float:
    """A part of a colour of sRGB in linear light, which Blender's are in."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def _remove(items: Sequence[Any]) -> None:
    """Remove objects, and the curves that nobody else has."""
    curves = [item.data for item in items if item.type == "CURVE" and item.data.users == 1]
    bpy.data.batch_remove([*items, *curves])

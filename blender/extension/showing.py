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

SOLID = "voronoi_tiles solid"
"""The property of a mesh that says of which drawing it is a solid, and in a second line what was proved of it.

With the mesh itself, so that undo and files cannot part the two.
"""


def own(tiling: Any, role: str) -> list[Any]:
    """The objects of a tiling that have a role, children of its empty."""
    return [item for item in tiling.children if item.voronoi_tiles.role == role]


def is_copied(tiling: Any) -> bool:
    """Whether what is shown belongs to another tiling, of which this one is a copy that a user has made."""
    settings = tiling.voronoi_tiles
    shown = [settings.marker, *(site.tile for site in settings.sites), *(one.object for one in settings.sources)]
    return settings.of != tiling or any(item is not None and not _is_own(tiling, item) for item in shown)


def _is_own(tiling: Any, item: Any) -> bool:
    return item is not None and item.voronoi_tiles.of == tiling


def build_tiles(tiling: Any, sites: Sequence[Any]) -> None:
    """A curve object for the tile of each site, and a marker; those of other sites are removed."""
    settings = tiling.voronoi_tiles
    settings.of = tiling
    for name in ("results", "field_results"):
        if getattr(settings, name) is None:  # someone has deleted it
            collection = bpy.data.collections.new(f"{tiling.name} {name.partition('_')[0]}")
            tiling.users_scene[0].collection.children.link(collection)
            setattr(settings, name, collection)
    gone = own(tiling, "tile")
    for site in sites:
        name, item = f"{site.object.name} tile", site.tile
        if not _is_own(tiling, item) or not item.users_scene or item.type != "CURVE":
            curve = bpy.data.curves.new(name, "CURVE")
            curve.dimensions = "2D"
            curve.resolution_u = RESOLUTION
            item = site.tile = _added(tiling, name, curve, "tile")
        elif item.voronoi_tiles.key != site.object.name:
            item.name = name
        item.voronoi_tiles.key = site.object.name
        # Beneath prisms a face would fight with theirs.
        item.data.fill_mode = "NONE" if settings.field else "BOTH"
    tiles = [site.tile for site in sites]
    _remove([item for item in gone if item not in tiles])
    build_marker(tiling)


def build_marker(tiling: Any) -> None:
    """The marker of a place where copies touch, hidden, where there is none."""
    settings = tiling.voronoi_tiles
    if _is_own(tiling, settings.marker) and settings.marker.users_scene:
        return
    item = settings.marker = _added(tiling, "Copies touch here", None, "marker")
    item.empty_display_type = "SPHERE"
    item.show_in_front = item.show_name = True
    item.hide_viewport = item.hide_render = True


def show_tiles(sites: Sequence[Any], outlines: Sequence[Outline]) -> None:
    """Give the tiles' curves their outlines."""
    for site, outline in zip(sites, outlines, strict=True):
        if site.tile and site.tile.type == "CURVE":  # else someone has deleted or converted it
            set_splines(site.tile.data, cubic_splines(outline))


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
    mesh.pop(SOLID, None)


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
    # Each stays which one it is, where it can: someone may have lifted it.
    named = {item.voronoi_tiles.key: item for item in there}
    kept = {name: named[name] for name in copies.names if name in named}
    chosen = set(kept.values())
    others = [item for item in there if item not in chosen]
    for number, (name, kind) in enumerate(zip(copies.names, index.ravel().tolist(), strict=True)):
        item = kept.get(name)
        if item is None and others:
            item = others.pop()
            item.name = name
        elif item is None:
            item = _added(tiling, name, None, "copy", settings.field_results)
            item.instance_type = "COLLECTION"
        item.empty_display_size = settings.a / 60
        item.voronoi_tiles.key, item.voronoi_tiles.number = name, number
        item.instance_collection = collections[kind]
    _remove(others)
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
    return {(one.site, one.mirrored): one.object.data for one in tiling.voronoi_tiles.sources if one.object}


def mark_solids(tiling: Any, drawing: str, proved: str) -> None:
    """Say of the meshes that they are solids of a drawing, and what was proved of them."""
    for mesh in sources(tiling).values():
        mesh[SOLID] = f"{drawing}\n{proved}"


def proved_solids(tiling: Any, drawing: str | None = None) -> str:
    """What was proved of the solids that are shown, of a drawing or of any; "" where none are."""
    said = {mesh.get(SOLID, "") for mesh in sources(tiling).values()}
    of, _, proved = said.pop().partition("\n") if len(said) == 1 else ("", "", "")
    return proved if drawing in (None, of) else ""


def mark_place(tiling: Any, place: complex | None) -> None:
    """Put the marker at a place in the plane, or hide it."""
    item = tiling.voronoi_tiles.marker
    if item is None:
        return
    if item.hide_viewport != (place is None):
        item.hide_viewport = place is None
    if place is not None:
        item.empty_display_size = tiling.voronoi_tiles.a / 40
        item.location = (place.real, place.imag, 0.0)


def remove_all(tiling: Any) -> None:
    """Remove what is shown of a tiling, and the tiling; the sites stay."""
    settings = tiling.voronoi_tiles
    for site in settings.sites:
        if _is_own(tiling, site.object):
            site.object.voronoi_tiles.role = ""
            site.object.voronoi_tiles.of = None
    build_field(tiling, None, ())
    collections = [one for one in (settings.field_results, settings.results) if one]
    _remove([item for role in ("tile", "marker") for item in own(tiling, role)])
    bpy.data.objects.remove(tiling)
    for one in collections:
        if not one.all_objects and not one.children:
            bpy.data.collections.remove(one)


def _added(tiling: Any, name: str, data: Any, role: str, collection: Any = None) -> Any:
    """A new object of a tiling."""
    item = bpy.data.objects.new(name, data)
    item.voronoi_tiles.role, item.voronoi_tiles.of = role, tiling
    item.parent = tiling
    (collection or tiling.voronoi_tiles.results).objects.link(item)
    return item


def _source(tiling: Any, kind: tuple[int, bool, int], name: str, colour: str) -> Any:
    """The collection that copies of a kind are instances of; made where it is not there."""
    settings = tiling.voronoi_tiles
    found = next((one for one in settings.sources if (one.site, one.mirrored, one.colour) == kind), None)
    if found is not None and found.collection and _is_own(tiling, found.object) and found.object.users_collection:
        return found.collection
    title = f"{name} turned over" if kind[1] else name
    shared = (one.object for one in settings.sources if (one.site, one.mirrored) == kind[:2])
    mesh = next((item.data for item in shared if _is_own(tiling, item)), None) or bpy.data.meshes.new(title)
    item = bpy.data.objects.new(title, mesh)
    item.voronoi_tiles.role, item.voronoi_tiles.of = "source", tiling
    if not mesh.materials:
        mesh.materials.append(None)  # a slot, whose material each object has for itself
    item.material_slots[0].link = "OBJECT"
    item.material_slots[0].material = _material(f"{tiling.name} colour {kind[2] + 1}", colour)
    collection = bpy.data.collections.new(title)
    collection.objects.link(item)
    if found is None:
        found = settings.sources.add()
    found.site, found.mirrored, found.colour, found.collection, found.object = *kind, collection, item
    return collection


def _keep_sources(settings: Any, wanted: set[tuple[int, bool, int]]) -> None:
    """Remove what no copy is an instance of any more."""
    for k in reversed(range(len(settings.sources))):
        one = settings.sources[k]
        if (one.site, one.mirrored, one.colour) in wanted:
            continue
        collection, item = one.collection, one.object
        settings.sources.remove(k)
        if not _is_own(settings.id_data, item):
            continue
        _remove([item])
        if collection and not collection.objects:
            bpy.data.collections.remove(collection)


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
    """Remove objects, and the curves and meshes that nobody else has."""
    data = [item.data for item in items if item.data and item.data.users == 1]
    bpy.data.batch_remove([*items, *data])

# SPDX-License-Identifier: GPL-3.0-or-later
"""Tilings that begin: their empty and collections, a cell about what is drawn, the sites of a design."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix, Vector

from voronoi_tiles.base.errors import TouchingCopiesError, VoronoiTilesError
from voronoi_tiles.blender.cubic_splines import coordinates
from voronoi_tiles.blender.design_splines import OpenedDesign, proposed_cell
from voronoi_tiles.blender.drawn_splines import DrawnSpline
from voronoi_tiles.solid.solid_job import HEIGHT_MM

from . import reading, showing
from .updating import rebuild

LARGER = 1.25
"""By how much a proposed cell grows where copies touch in it; a factor."""

TRIES = 12
"""How often; a count."""


def new_tiling(context: Any, group: str, name: str) -> Any:
    """The empty of a new tiling, and its collections."""
    results = bpy.data.collections.new(f"{name} tiles")
    context.scene.collection.children.link(results)
    field = bpy.data.collections.new(f"{name} field")
    results.children.link(field)
    tiling = bpy.data.objects.new(f"{name} tiling", None)
    tiling.lock_scale = (True, True, True)
    results.objects.link(tiling)
    settings = tiling.voronoi_tiles
    settings.results, settings.field_results = results, field
    settings.group = group
    settings.role, settings.of = "tiling", tiling
    showing.build_marker(tiling)
    return tiling


def add_sites(tiling: Any, items: Iterable[Any]) -> None:
    """Make objects sites of a tiling; those of others leave them."""
    for item in items:
        if all(site.object != item for site in tiling.voronoi_tiles.sites):
            tiling.voronoi_tiles.sites.add().object = item
        item.voronoi_tiles.role, item.voronoi_tiles.of = "site", tiling


def fit_cell(context: Any, tiling: Any) -> None:
    """Give a tiling a cell about what is drawn, in which its copies keep apart, where one is found."""
    settings = tiling.voronoi_tiles
    context.view_layer.update()
    parts = [spline.points for _, splines in reading.drawn_tiling(tiling).sites for spline in splines]
    points = np.concatenate([np.zeros(0, np.complex128), *parts])
    if not len(points) or not np.isfinite(points).all():
        return
    cell = proposed_cell(settings.group, points)
    middle = complex(points.real.min() + points.real.max(), points.imag.min() + points.imag.max()) / 2
    live, settings.live = settings.live, False  # else each setting would build all anew
    frame = tiling.matrix_world.copy()
    before = settings.a
    for _ in range(TRIES):
        settings.a, settings.b, settings.angle = cell.a, cell.b, cell.angle
        tiling.matrix_world = frame @ Matrix.Translation((cell.origin.real, cell.origin.imag, 0.0))
        context.view_layer.update()
        try:
            reading.drawn_tiling(tiling).tiles()
        except TouchingCopiesError:
            larger = middle + LARGER * (cell.origin - middle)
            cell = cell._replace(a=LARGER * cell.a, b=LARGER * cell.b, origin=larger)
        except VoronoiTilesError:
            break
        else:
            break
    settings.height *= settings.a / before
    settings.live = live


def draw_design(context: Any, name: str, design: OpenedDesign) -> Any:
    """Draw a design: a curve object for each site, and the tiling."""
    if context.object and context.object.mode != "OBJECT":  # the first site will be the active object
        bpy.ops.object.mode_set(mode="OBJECT")
    tiling = new_tiling(context, design.group, name)
    settings = tiling.voronoi_tiles
    settings.a, settings.b, settings.angle, settings.unit_mm = design.a, design.b, design.angle, design.unit_mm
    settings.height = HEIGHT_MM / design.unit_mm
    solid = design.solid
    if solid is not None:
        settings.loft, settings.height, settings.layers = True, solid.height, solid.layers
        settings.turn, settings.grow = solid.turn, solid.scale
        settings.shift, settings.about = coordinates(np.array([solid.shift, solid.about])).reshape(2, 3)[:, :2].tolist()
    items = []
    for site, splines in design.sites:
        curve = bpy.data.curves.new(site, "CURVE")
        curve.dimensions = "2D"
        curve.fill_mode = "NONE"
        for spline in splines:
            _draw(curve, spline)
        item = bpy.data.objects.new(site, curve)
        context.scene.collection.objects.link(item)
        items.append(item)
    add_sites(tiling, items)
    for item in context.selected_objects:
        item.select_set(False)
    items[0].select_set(True)
    context.view_layer.objects.active = items[0]
    context.view_layer.update()
    rebuild(tiling)
    return tiling


def _draw(curve: Any, spline: DrawnSpline) -> None:
    """Add a spline to a curve."""
    if spline.kind == "bezier":
        drawn = curve.splines.new("BEZIER")
        drawn.bezier_points.add(len(spline.points) - 1)
        for side in ("left", "right"):
            drawn.bezier_points.foreach_set(f"handle_{side}_type", np.full(len(spline.points), showing.FREE, np.int32))
        for key, points in (("co", spline.points), ("handle_left", spline.left), ("handle_right", spline.right)):
            drawn.bezier_points.foreach_set(key, coordinates(points))
    else:
        drawn = curve.splines.new("POLY")
        drawn.points.add(len(spline.points) - 1)
        for point, place in zip(drawn.points, spline.points.tolist(), strict=True):
            point.co = Vector((place.real, place.imag, 0.0, 1.0))
    drawn.use_cyclic_u = spline.closed

"""Two hundred steps of dragging, undo, redo and settings, in and out of the edit mode."""

import random
import sys

import numpy as np
from session import answer, bpy, installed, module, quiet, site, tiling

from mathutils import Vector

installed()
random.seed(int(sys.argv[3]))
bpy.ops.voronoi_tiles.starter(group="p4")
bpy.ops.ed.undo_push(message="start")
reading, showing = module("reading"), module("showing")
from voronoi_tiles.base.errors import VoronoiTilesError
from voronoi_tiles.blender.cubic_splines import coordinates, cubic_splines

steps = {"drag": 0, "undo": 0, "redo": 0, "group": 0, "cells": 0, "edit": 0, "site": 0}
start = [
    {name: getattr(point, name).copy() for name in ("co", "handle_left", "handle_right")}
    for point in site().data.splines[0].bezier_points
]
depth = 0
wrong, refused, shown, asked = [], 0, 0, {"update": 0}


def step(what):
    """Do one thing as a user does it, a step of undo behind it."""
    global depth
    if what == "drag":
        points = site().data.splines[0].bezier_points
        number = random.randrange(len(points))
        by = Vector((random.uniform(-3, 3), random.uniform(-3, 3), 0))
        for name in ("co", "handle_left", "handle_right"):
            setattr(points[number], name, start[number][name] + by)
    elif what == "undo":
        if depth:
            bpy.ops.ed.undo()
            depth -= 1
        return
    elif what == "redo":
        if bpy.ops.ed.redo.poll():
            bpy.ops.ed.redo()
            depth += 1
        return
    elif what == "group":
        tiling().voronoi_tiles.group = random.choice(["p1", "p2", "pgg", "p4", "p6", "pm"])
    elif what == "cells":
        tiling().voronoi_tiles.columns = random.randint(1, 4)
        tiling().voronoi_tiles.colours = random.choice(["fewest", "none", "handedness"])
        tiling().voronoi_tiles.field = random.random() < 0.8
    elif what == "site":
        site().location.x += random.uniform(-1, 1)
    else:
        bpy.context.view_layer.objects.active = site()
        bpy.ops.object.mode_set(mode="EDIT")
        for point in site().data.splines[0].bezier_points:
            point.select_control_point = random.random() < 0.5
        bpy.ops.transform.translate(value=(random.uniform(-1, 1), random.uniform(-1, 1), 0))
        bpy.context.view_layer.update()
        module("live").tick()
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message=what)
    depth += 1


def as_shown():
    """What is shown is what is drawn, unless it says what is wrong."""
    global refused, shown, depth
    settings = tiling().voronoi_tiles
    drawn = reading.drawn_tiling(tiling())
    try:
        tiles = drawn.tiles()
    except VoronoiTilesError:
        refused += 1
        return bool(settings.message)
    shown += 1
    if settings.message == module("updating").NOT_BUILT:
        bpy.context.view_layer.objects.active = tiling()
        bpy.ops.voronoi_tiles.update()
        bpy.ops.ed.undo_push(message="update")
        depth += 1
        settings, asked["update"] = tiling().voronoi_tiles, asked["update"] + 1
    if settings.message:
        return False
    there = {item.voronoi_tiles.key: item for item in showing.own(tiling(), "tile")}
    for tile in tiles:
        for spline, one in zip(there[tile.name].data.splines, cubic_splines(tile.outline), strict=False):
            co = np.empty(3 * len(spline.bezier_points), np.float32)
            spline.bezier_points.foreach_get("co", co)
            if co.tolist() != coordinates(one.points).tolist():
                return False
    copies = showing.own(tiling(), "copy")
    count = sum(tile.tessellation.action.group.order // len(tile.symmetry) for tile in tiles)
    wanted = count * settings.columns * settings.rows if settings.field else 0
    return len(copies) == wanted and all(copy.instance_collection for copy in copies)


for number in range(200):
    what = random.choices(list(steps), (8, 4, 2, 1, 1, 2, 1))[0]
    steps[what] += 1
    step(what)
    if random.random() < 0.3:
        quiet()
    else:
        bpy.context.view_layer.update()
        module("live").tick()
    if not as_shown():
        wrong.append([number, what, tiling().voronoi_tiles.message])
answer(steps=steps, wrong=wrong, refused=refused, shown=shown, asked=asked)

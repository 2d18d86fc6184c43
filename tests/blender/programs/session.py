"""Blender as a Python module, in which the extension has been installed from its file as a user does it."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

FILE, FOLDER = Path(sys.argv[1]), Path(sys.argv[2])
os.environ["BLENDER_USER_RESOURCES"] = str(FOLDER / "home")
(FOLDER / "home").mkdir(exist_ok=True)

import bpy

ID = "bl_ext.user_default.voronoi_tiles"


def installed() -> None:
    """Start with an empty file, and install and enable the extension."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    done = bpy.ops.extensions.package_install_files(filepath=str(FILE), repo="user_default", enable_on_install=True)
    assert done == {"FINISHED"}


def module(name: str) -> Any:
    """A module of the extension."""
    return sys.modules[f"{ID}.{name}"]


def tiling() -> Any:
    """The only tiling; looked up anew, since undo makes all objects others."""
    (found,) = module("settings").tilings()
    return found


def site(number: int = 0) -> Any:
    """An object that is a site."""
    return tiling().voronoi_tiles.sites[number].object


def quiet() -> None:
    """Let the timer do all that it has to, which never fires without a window."""
    live = module("live")
    bpy.context.view_layer.update()
    live.tick()
    live._quiet.update(dict.fromkeys(live._quiet, 0.0))
    live.tick()


def tile_points(name: str) -> list[list[float]]:
    """The points of a tile's curve."""
    (item,) = (one for one in tiling().children if one.voronoi_tiles.role == "tile" and one.voronoi_tiles.key == name)
    return [list(point.co) for spline in item.data.splines for point in spline.bezier_points]


def answer(**found: Any) -> None:
    """Write down what was found: Blender prints much, in an order of its own."""
    (FOLDER / "found.json").write_text(json.dumps({"blender": bpy.app.version_string, **found}))

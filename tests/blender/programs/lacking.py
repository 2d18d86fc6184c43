"""The extension where its engine cannot be loaded: enabled all the same, its panel says why, and it can be disabled."""

import sys

from session import ID, answer, bpy, installed, module

import addon_utils

sys.modules["voronoi_tiles"] = None
installed()
panel = module("panel")
lines = []


class Layout:
    """A layout that keeps the lines that it is asked to show."""

    def column(self, **_):
        """A part of it, which is as good as all."""
        return self

    def label(self, text="", **_):
        """Keep a line."""
        lines.append(text)


panel.VORONOI_TILES_PT_tiles.draw(type("Shown", (), {"layout": Layout()})(), bpy.context)
shown = [one.__name__ for one in panel.CLASSES if not hasattr(one, "poll") or one.poll(bpy.context)]
listening = sum(handler.__module__.startswith(ID) for handler in bpy.app.handlers.depsgraph_update_post)
addon_utils.disable(ID)
answer(lines=lines, shown=shown, listening=listening, left=hasattr(bpy.types, "VORONOI_TILES_PT_tiles"))

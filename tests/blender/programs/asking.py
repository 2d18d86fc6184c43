"""What the panel shows and says, solids, files, a design that is opened; and where a library is missing."""

import sys

from session import FOLDER, answer, bpy, installed, module, quiet, site, tiling

installed()
panel, requirements = module("panel"), module("requirements")


class Layout:
    """A layout that keeps what it is asked to show, and whether it could."""

    def __init__(self, shown):
        self.shown = shown

    def __getattr__(self, name):
        if name in ("row", "column", "box"):
            return lambda **_: Layout(self.shown)
        if name == "label":
            return lambda text="", icon="NONE": self.shown.append(text)
        if name == "prop":
            return lambda data, name, **_: self.shown.append(data.bl_rna.properties[name].name)
        if name in ("operator", "operator_menu_enum"):
            return lambda idname, *_, **__: self.shown.append(
                getattr(bpy.types, "VORONOI_TILES_OT_" + idname.partition(".")[2]).bl_label
            )
        raise AttributeError(name)


def shown():
    """All lines of the panel and its parts."""
    found = []
    for one in panel.CLASSES:
        if not hasattr(one, "poll") or one.poll(bpy.context):
            fake = type("Shown", (), {"layout": Layout(found), **{k: v for k, v in vars(one).items() if k == "shown"}})
            one.draw(fake(), bpy.context)
    return found


nothing = shown()
bpy.ops.voronoi_tiles.starter(group="p2")
settings = tiling().voronoi_tiles
oblique = shown()
site().data.splines.new("NURBS")
smoothed = shown()
site().data.splines.remove(site().data.splines[1])
settings.group = "p6"
quiet()
hexagonal = shown()
fitted = {}
for group in module("settings").GROUPS:
    settings.group = group
    bpy.ops.voronoi_tiles.fit()
    fitted[group] = [settings.message, settings.proved, settings.a / settings.height]
bpy.ops.voronoi_tiles.remove()
for item in list(bpy.data.objects):
    bpy.data.objects.remove(item)
bpy.ops.voronoi_tiles.starter(group="p2")
settings = tiling().voronoi_tiles
settings.group = "p4"
quiet()
settings.clearance, settings.unit_mm = 0.3, 2.0
prisms = bpy.ops.voronoi_tiles.solids()
made = module("showing").proved_solids(tiling())

closed = []
import bmesh

for mesh in module("showing").sources(tiling()).values():
    shape = bmesh.new()
    shape.from_mesh(mesh)
    closed.append(
        [all(edge.is_manifold and edge.is_contiguous for edge in shape.edges), shape.calc_volume(signed=True)]
    )
    shape.free()
settings.loft, settings.turn, settings.height, settings.about, settings.layers = True, 10.0, 20.0, (15.0, 15.0), 5
quiet()
lofts = bpy.ops.voronoi_tiles.solids()
volumes = []
for mesh in module("showing").sources(tiling()).values():
    shape = bmesh.new()
    shape.from_mesh(mesh)
    volumes.append(shape.calc_volume(signed=True))
    shape.free()
files = {}
settings.feed, settings.power = 300.0, 800.0
for suffix in ("svg", "pdf", "lbrn2", "gcode", "json", "toml", "3mf", "stl"):
    file = FOLDER / f"out.{suffix}"
    done = bpy.ops.voronoi_tiles.export(filepath=str(file))
    files[suffix] = file.stat().st_size
settings.unit_mm, settings.kerf = 25.4, 0.15
bpy.ops.voronoi_tiles.export(filepath=str(FOLDER / "inch.toml"))
bpy.ops.voronoi_tiles.export(filepath=str(FOLDER / "inch.svg"))
settings.unit_mm, settings.kerf = 2.0, 0.0
bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "out.blend"))
settings.sheet = "//sheet.svg"
(FOLDER / "sheet.svg").write_text(
    '<svg xmlns="http://www.w3.org/2000/svg" width="300mm" height="200mm" viewBox="0 0 300 200">'
    '<path stroke="red" fill="none" d="M10 10H290"/><path stroke="red" fill="none" d="M290 10 200 190 10 10"/></svg>'
)
bpy.ops.voronoi_tiles.export(filepath="//filled.svg")
files["sheet"] = (FOLDER / "filled.svg").stat().st_size
settings.sheet = "//sheet.dxf"
(FOLDER / "sheet.dxf").write_text("0\nSECTION\n0\nENDSEC\n0\nEOF\n")
refused = []
for name in ("out.dxf", "other.svg"):
    try:
        bpy.ops.voronoi_tiles.export(filepath=str(FOLDER / name))
    except RuntimeError as error:
        refused.append(str(error))
bpy.ops.voronoi_tiles.remove()
for item in list(bpy.data.objects):
    bpy.data.objects.remove(item)
bpy.ops.voronoi_tiles.open(filepath="//out.toml")
names = ("group", "a", "unit_mm", "loft", "height", "turn", "about", "layers")
opened = [site().name]
for name in names:
    value = getattr(tiling().voronoi_tiles, name)
    opened.append([*value] if name == "about" else value)

# A library that is not there, an engine of another version, an old numpy on Windows.
requirements.missing.cache_clear()
sys.modules["shapely"], kept = None, sys.modules["shapely"]
lacking, solids = shown(), bpy.types.VORONOI_TILES_OT_solids.poll(bpy.context)
sys.modules["shapely"] = kept
requirements.missing.cache_clear()
import numpy
import voronoi_tiles

requirements.engine_missing.cache_clear()
voronoi_tiles.__version__, version = "0.0.1", voronoi_tiles.__version__
other = requirements.engine_missing()
voronoi_tiles.__version__ = version
requirements.engine_missing.cache_clear()
sys.platform, platform, numpy.__version__, number = "win32", sys.platform, "1.26.4", numpy.__version__
old = requirements.engine_missing()
said = shown()
sys.platform, numpy.__version__ = platform, number
requirements.engine_missing.cache_clear()
answer(
    nothing=nothing,
    oblique=oblique,
    smoothed=smoothed,
    hexagonal=hexagonal,
    fitted=fitted,
    prisms=[*prisms, made],
    closed=closed,
    lofts=[*lofts],
    volumes=volumes,
    files=files,
    refused=refused,
    opened=opened,
    lacking=lacking,
    solids=solids,
    other=other,
    old=old,
    said=said,
)

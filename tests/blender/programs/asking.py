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
settings.group = "p6"
quiet()
hexagonal = shown()
settings.group = "p4"
quiet()
settings.clearance, settings.unit_mm = 0.3, 2.0
prisms = bpy.ops.voronoi_tiles.solids()
made = settings.solids

closed = []
import bmesh

for mesh in module("showing").sources(tiling()).values():
    shape = bmesh.new()
    shape.from_mesh(mesh)
    closed.append(
        [all(edge.is_manifold and edge.is_contiguous for edge in shape.edges), shape.calc_volume(signed=True)]
    )
    shape.free()
settings.loft, settings.turn, settings.height, settings.about = True, 10.0, 20.0, (15.0, 15.0)
quiet()
lofts = bpy.ops.voronoi_tiles.solids()
volumes = []
for mesh in module("showing").sources(tiling()).values():
    shape = bmesh.new()
    shape.from_mesh(mesh)
    volumes.append(shape.calc_volume(signed=True))
    shape.free()
files = {}
for suffix in ("svg", "pdf", "lbrn2", "json", "toml", "3mf", "stl"):
    file = FOLDER / f"out.{suffix}"
    done = bpy.ops.voronoi_tiles.export(filepath=str(file))
    files[suffix] = file.stat().st_size
try:
    bpy.ops.voronoi_tiles.export(filepath=str(FOLDER / "out.dxf"))
except RuntimeError as error:
    refused = str(error)
bpy.ops.voronoi_tiles.remove()
for item in list(bpy.data.objects):
    bpy.data.objects.remove(item)
bpy.ops.voronoi_tiles.open(filepath=str(FOLDER / "out.toml"))
opened = [tiling().voronoi_tiles.group, tiling().voronoi_tiles.a, tiling().voronoi_tiles.unit_mm, site().name]

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
    hexagonal=hexagonal,
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

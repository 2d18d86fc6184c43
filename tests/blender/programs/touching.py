"""Copies that touch: what is said, the marker, the tile that stays; and what is said where nothing is drawn."""

from session import answer, bpy, installed, quiet, site, tile_points, tiling

installed()
bpy.ops.voronoi_tiles.starter(group="p4")
before = tile_points("bird")
settings = tiling().voronoi_tiles
settings.a = 20.0
quiet()
said, during = settings.message, tile_points("bird")
(marker,) = (item for item in bpy.data.objects if item.voronoi_tiles.role == "marker")
bpy.context.view_layer.update()
place, shown = list(marker.matrix_world.translation), not marker.hide_viewport
settings.a = 60.0
quiet()
after, hidden, proved = tile_points("bird"), marker.hide_viewport, settings.proved
site().data.splines.clear()
quiet()
nothing, stays = settings.message, tile_points("bird")
answer(
    said=said,
    stays=during == before == stays,
    place=place,
    shown=shown,
    back=after == before,
    hidden=hidden,
    proved=proved,
    nothing=nothing,
)

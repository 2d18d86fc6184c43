"""The raster stage: an image of the same tessellation, rendered by a method of its own.

Installed as `voronoi_tiles.raster`. It imports the vocabulary modules of `voronoi_tiles`, never the vector stage:
two stages that share code could share a mistake, and then comparing them would prove nothing.
"""

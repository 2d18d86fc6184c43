"""The vector stage: exact cells, their outlines, and the files that carry them.

Installed as `voronoi_tiles.vector`. It imports the vocabulary modules of `voronoi_tiles`, never the raster stage.
"""

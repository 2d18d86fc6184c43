"""The vector stage: exact cells, the complex of the edges that they share, outlines, and the proof.

Installed as `voronoi_tiles.vector`. It imports packages of lower ranks only, never the raster stage.
"""

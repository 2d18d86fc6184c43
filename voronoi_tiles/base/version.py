"""The version of voronoi_tiles, which every file of ours names."""

__version__ = "0.2.0"

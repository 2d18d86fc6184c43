"""The cross-check: the exact outlines of the vector stage against an image of the raster stage, both ways."""

from voronoi_tiles.crosscheck.check_report import CheckReport, Figure, Marks
from voronoi_tiles.crosscheck.comparison import DEFAULT_SAMPLES, crosscheck

__all__ = ["DEFAULT_SAMPLES", "CheckReport", "Figure", "Marks", "crosscheck"]

"""From proved tiles to files that are cut: sheets, kerf, tabs, art and labels, and what they come to."""

from __future__ import annotations

from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.product import Product, colour_names, make, make_colours

__all__ = ["Job", "JobError", "Product", "colour_names", "make", "make_colours"]

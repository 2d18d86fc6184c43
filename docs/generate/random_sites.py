"""Random designs to measure what a wallpaper group does to tiles: lines and cubic curves, as in the paper's figures."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from voronoi_tiles.groups.wallpaper import GROUPS

CELLS: dict[str, dict[str, float]] = {
    "oblique": {"a": 60.0, "b": 47.0, "angle": 73.0},
    "rectangular": {"a": 60.0, "b": 44.0},
    "square": {"a": 60.0},
    "hexagonal": {"a": 60.0},
}
"""The cells, by crystal system, in mm: no more symmetric than the system asks for."""

KINDS: tuple[tuple[str, int], ...] = (("segment", 1), ("segment", 3), ("bezier", 1), ("bezier", 2))
"""What a site is made of: strokes and how many of them. Random sites take turns."""

TOLERANCE = 0.05
"""Within what curves are flattened; mm."""


def random_design(group: str, number: int, rng: np.random.Generator, cell: dict[str, float] | None = None) -> Any:
    """One site in general position in a group's cell, as the data of a design file.

    Its points scatter about a point anywhere in the cell, by 0.1 to 0.8 of the side of a square as large as a tile, so
    that some sites are short beside their tiles and others reach far beyond any fundamental domain. Copies may touch.
    """
    row = GROUPS[group]
    cell = cell or CELLS[row.system]
    lattice = row.lattice(cell["a"], cell.get("b"), cell.get("angle"))
    stroke, count = KINDS[number % len(KINDS)]
    points = 2 if stroke == "segment" else 4
    spread = math.sqrt(lattice.det / row.order) * 0.1 * 8.0 ** rng.random()
    centre = lattice.cartesian(*rng.random(2))
    xy = rng.normal(scale=spread, size=(count, points, 2)) + np.array([centre.real, centre.imag])
    strokes = [{stroke: line} for line in xy.tolist()]
    site = {"name": "random", "tolerance": TOLERANCE, "strokes": strokes}
    return {"schema": 1, "group": group, "units": "mm", "cell": cell, "site": [site]}

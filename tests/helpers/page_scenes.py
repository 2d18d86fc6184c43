"""What the page's picture is told of a pattern, and the raster stage's image of the same window."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from helpers import strategies
from helpers.page_vectors import motion_table, xy
from voronoi_tiles.designs.design import Design
from voronoi_tiles.groups.periodic_colouring import PeriodicColouring
from voronoi_tiles.raster.frame import Frame
from voronoi_tiles.raster.renderer import LabelImage, Renderer
from voronoi_tiles.raster.scene import Pattern

WIDTH, HEIGHT = 120, 80
"""The window, in pixels."""


def scene_of(pattern: Pattern, centre: complex, scale: float, colouring: PeriodicColouring) -> dict[str, Any]:
    """What the page is told of a pattern and a window of WIDTH x HEIGHT pixels, `scale` of them a unit."""
    isometries = [pattern.lattice.isometry(operation) for operation in pattern.group.operations]
    numbers = {operation: number for number, operation in enumerate(pattern.group.operations)}
    return {
        "lattice": {"a": xy(pattern.lattice.a), "b": xy(pattern.lattice.b)},
        "motions": list(map(motion_table, isometries)),
        "sites": [
            {
                "segments": site.elements.ravel().tolist(),
                "cosets": [numbers[row.operation] for row in pattern.placements if row.site == number],
            }
            for number, site in enumerate(pattern.sites)
        ],
        "camera": {"centre": xy(centre), "scale": scale, "size": [WIDTH, HEIGHT], "ratio": 1},
        "colouring": {
            "rows": colouring.repeat.rows,
            "m": colouring.repeat.m,
            "n": colouring.repeat.n,
            "colour": colouring.colour.tolist(),
        },
    }


def rendered(pattern: Pattern, centre: complex, scale: float, width: int, height: int) -> LabelImage:
    """The raster stage's image of the window in so many pixels, from the lowest row up."""
    u, v = WIDTH / width / scale, HEIGHT / height / scale
    origin = centre - complex(WIDTH, HEIGHT) / (2 * scale)
    return Renderer("cpu").render(pattern, Frame(origin, complex(u), complex(0, v), width, height, (0.5, 0.5)))


def names(image: LabelImage) -> NDArray[np.intp]:
    """Who owns each sample, as the page says it: site, operation, and the cells that it is moved by."""
    pattern = image.pattern
    numbers = {operation: number for number, operation in enumerate(pattern.group.operations)}
    rows = np.array([(row.site, numbers[row.operation]) for row in pattern.placements])
    return np.column_stack((rows[image.copies[:, 0]], image.copies[:, 1:]))[image.first]


def pattern_of(group: str, sites: strategies.Sites, cell: dict[str, float], tolerance: float = 0.3) -> Pattern:
    """The sites of a design in a cell."""
    site = [{"tolerance": tolerance, "strokes": strokes} for strokes in sites]
    design = Design.from_dict({"schema": 1, "group": group, "cell": cell, "site": site})
    return Pattern(design.noded, design.group, design.lattice)

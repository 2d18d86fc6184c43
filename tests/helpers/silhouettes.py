"""Random outlines to fit tiles to: polygons, and tiles of random strokes."""

from __future__ import annotations

import numpy as np
import shapely
import shapely.affinity

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import plane


def random_polygon(seed: int) -> shapely.Polygon:
    """A polygon of 12 to 30 corners that bulges and recedes, some 40 mm wide, somewhere."""
    dice = np.random.default_rng(seed)
    count = int(dice.integers(12, 31))
    angle = (np.arange(count) + dice.uniform(0.1, 0.9, count)) / count * 2.0 * np.pi
    waves = sum(dice.normal(0.0, 4.0 / k) * np.cos(k * angle + dice.uniform(0, 6.28)) for k in range(1, 5))
    radius = np.clip(20.0 + waves + dice.normal(0.0, 1.5, count), 6.0, 40.0)
    return shapely.Polygon(plane(radius * np.exp(1j * angle) + complex(*dice.uniform(-90, 90, 2))))


def random_tiling(seed: int, group: str) -> vt.Tiling:
    """A tiling of a random curve whose tile is one piece."""
    dice = np.random.default_rng(seed)
    while True:
        sides = (50.0, 50.0 * dice.uniform(0.6, 1.6), dice.uniform(60, 120))
        free = {"oblique": 3, "rectangular": 2}.get(vt.GROUPS[group].system, 1)
        cell = dict(zip(("a", "b", "angle"), sides[:free], strict=False))
        lattice = vt.GROUPS[group].lattice(*sides)
        middle = lattice.cartesian(*dice.uniform(0.1, 0.9, 2))
        reach = 0.35 * np.sqrt(lattice.det / vt.GROUPS[group].order)
        points = middle + reach * (dice.uniform(-1, 1, (int(dice.integers(3, 6)), 2)) @ np.array([1.0, 1j]))
        try:
            tiling = vt.Design(group, cell, vt.Site(vt.catmull_rom(points.tolist()))).tessellate()
        except vt.VoronoiTilesError:
            continue
        if len(tiling[0].outline.ring_offsets) == 2 and len(tiling[0].symmetry) == 1:
            return tiling


def lost(tiling: vt.Tiling, seed: int) -> shapely.Polygon:
    """The tile of a tiling, turned and moved at random: nothing says any more which group it is of."""
    dice = np.random.default_rng(seed)
    tile = tiling[0].to_shapely(accuracy=0.01)
    turned = shapely.affinity.rotate(tile, dice.uniform(0, 360))
    return shapely.affinity.translate(turned, *dice.uniform(-50, 50, 2))

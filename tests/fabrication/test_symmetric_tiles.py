"""Tiles of symmetric sites as they are cut: arcs, kerf and fillets keep every symmetry, node by node."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from helpers.examples import NAMES, tiling

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.arc_fitting import curve_fit
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.layout import Contours, Layout, lay_out
from voronoi_tiles.fabrication.sheets import read_sheet
from voronoi_tiles.paths.paths import ARC
from voronoi_tiles.vector.motions import Motion, compose, inverse

SYMMETRIC = [name for name in NAMES if any(len(tile.symmetry) > 1 for tile in tiling(name).tiles)]

JOBS: dict[str, dict[str, Any]] = {
    "arcs": {"edges": "pieces", "curves": "arc"},
    "kerf": {"kerf": 0.15},
    "fillets": {"edges": "pieces", "fillet": 0.4},
    "kerf and fillets": {"kerf": 0.2, "fillet": 0.4},
    "kerf on a sheet": {"kerf": 0.15, "sheet": (250.0, 250.0), "rotate": 20.0},
}

CLOSE = 1e-8
"""How far a node may be from the image of another one; millimetres. The symmetry of sites is that of their coordinates
in decimals: some, as 11.547 in a hexagonal cell, have it to 1e-9 of the cell and less."""


def laid_out(name: str, **options: Any) -> Layout:
    """Lay out a design's tiles."""
    tiles, job = tiling(name), Job(**options)
    budget = AccuracyBudget.of(job, "arc")
    fit = curve_fit(job, "arc", budget, tiles.design.unit_mm)
    return lay_out(tiles.design, tiles.tessellation, job, read_sheet(job, budget), budget, fit)


def page_map(layout: Layout, motion: Motion, place: complex) -> Callable[[Complexes], Complexes]:
    """What a motion of the design's plane is on the page, for a tile that was moved by `place` after all else."""
    unit, conj = layout.tiles.page.action.linear[motion[:4]]
    shift = complex(layout.tiles.page.action.cartesian(motion[4] / 2, motion[5] / 2))

    def image(nodes: Complexes) -> Complexes:
        z = (nodes - place - layout.tiles.page.shift) / layout.tiles.page.factor
        return layout.tiles.page.factor * (unit * (z.conj() if conj else z) + shift) + layout.tiles.page.shift + place

    return image


def asymmetry(name: str, layout: Layout, contours: Contours) -> float:
    """The farthest that a node of any whole tile is from all images of nodes under an operation of its stabilizer."""
    worst, checked = 0.0, 0
    for piece, copy in enumerate(contours.copy.tolist()):
        tile = int(layout.copies.tile[copy])
        motion = layout.period.motion[tile]
        rings = contours.paths.take(np.arange(contours.items[piece], contours.items[piece + 1]))
        nodes = np.concatenate((rings.start, rings.control[rings.kind == ARC, 0]))
        for element in tiling(name).tessellation.placed[int(layout.period.site[tile])].stabilizer[1:]:
            turned = compose(compose(motion, element), inverse(motion))
            image = page_map(layout, turned, complex(layout.copy_shifts[copy]))(nodes)
            worst = max(worst, float(np.abs(image[:, None] - nodes).min(axis=1).max()))
            checked += 1
    assert checked
    return worst


@pytest.mark.parametrize("job", JOBS)
@pytest.mark.parametrize("name", SYMMETRIC)
def test_a_symmetric_tile_stays_symmetric(name: str, job: str) -> None:
    """Every node and every middle of an arc has its image under each operation that maps the site onto itself."""
    layout = laid_out(name, **JOBS[job])
    assert asymmetry(name, layout, layout.contours) <= CLOSE


def test_an_asymmetric_node_is_seen() -> None:
    """One node of the moth, moved by a micrometre."""
    layout = laid_out("cm-moth", **JOBS["kerf"])
    contours = layout.contours
    start, end = contours.paths.start.copy(), contours.paths.end.copy()
    start[5] = end[4] = start[5] + 1e-3
    bent = replace(contours, paths=replace(contours.paths, start=start, end=end))
    assert asymmetry("cm-moth", layout, bent) > 1e-4

"""The place of a tessellation where most whole tiles lie on a sheet."""

from __future__ import annotations

import numpy as np
import pytest
from helpers.sheets import circle, period

from voronoi_tiles.fabrication.best_offset import best_shift
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.tile_placement import place_tiles
from voronoi_tiles.paths.paths import Paths

NAMES = ("p1-heron", "p2-lizard", "p3-mitten", "p4-hook", "pgg-crane", "p6-manta", "cmm-scroll", "cm-moth")


def whole(name: str, region: Region, shift: complex) -> int:
    """How many whole tiles lie in a region when all are shifted."""
    return int(place_tiles(period(name).placed(1.0, shift), region).whole.sum())


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("size", [(290.0, 190.0), pytest.param((150.0, 260.0), marks=pytest.mark.slow)])
def test_no_other_place_has_more(name: str, size: tuple[float, float]) -> None:
    """Of thirty random ones, and of that where nothing is shifted."""
    region = Region.rectangle(5.0, 5.0, *size)
    shift = best_shift(period(name), region)
    a, b = period(name).basis
    assert abs(shift) <= abs(a) + abs(b)
    count = whole(name, region, shift)
    rng = np.random.default_rng(len(name))
    others = [0j, *(complex(u * a + v * b) for u, v in rng.uniform(-1, 1, (30, 2)))]
    assert all(whole(name, region, other) <= count for other in others)


def test_a_sheet_that_fits_exactly_is_filled() -> None:
    """A rectangle of whole mirror tiles, wherever it lies: the tiles are laid edge to edge with it."""
    text = 'schema = 1\ngroup = "pmm"\n[cell]\na = 20\nb = 30\n[[site]]\nstrokes = [{ segment = [[3, 4], [7, 9]] }]\n'
    from voronoi_tiles import Design

    tiles = Design.loads(text).tessellate().tessellation.period
    region = Region.rectangle(1.234, 5.678, 61.234, 65.678)
    shift = best_shift(tiles, region)
    assert place_tiles(tiles.placed(1.0, shift), region).whole.sum() == 6 * 4


def test_other_regions_take_a_grid() -> None:
    """A disc with a hole: no worse than without a shift."""
    border = Paths.concatenate([circle(150 + 100j, 90.0), circle(160 + 110j, 12.0, hole=True)])
    region = Region(border)
    shift = best_shift(period("p4-key"), region)
    assert whole("p4-key", region, shift) >= whole("p4-key", region, 0j)

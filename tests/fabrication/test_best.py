"""The place of a tessellation where most whole tiles lie on a sheet."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from helpers.sheets import circle, flattened, period, polygon, xy
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.fabrication.best_offset import best_shift
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.fabrication.tile_placement import place_tiles, whole_tiles
from voronoi_tiles.paths.paths import Paths

NAMES = ("p1-heron", "p2-lizard", "p3-mitten", "p4-hook", "pgg-crane", "p6-manta", "cmm-scroll", "cm-moth")
SLOW = ("pgg-crane", "p6-manta", "cm-moth")
"""Those that take the longest; the quick tests have oblique, square, hexagonal and centred cells without them."""


def whole(name: str, region: Region, shift: complex) -> int:
    """How many whole tiles lie in a region when all are shifted."""
    return int(place_tiles(period(name).placed(1.0, shift), region).whole.sum())


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow if name in SLOW else ()) for name in NAMES])
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


@pytest.mark.parametrize("name", NAMES)
def test_boxes_tell_which_tiles_a_rectangle_holds(name: str) -> None:
    """The same as where outlines meet the border, in the same order; vertices lie on it."""
    tiles = period(name)
    rng = np.random.default_rng(len(name))
    corners = tiles.own_outlines[0].start[:2]
    for shift in (0j, *(rng.uniform(-40, 40, (2, 2)) @ [1, 1j]).tolist()):
        a, b = (complex(corner) + shift for corner in corners)
        left, bottom = min(a.real, b.real), min(a.imag, b.imag)
        region = Region.rectangle(left, bottom, left + 170.0, bottom + 130.0)
        placed = place_tiles(tiles.placed(1.0, shift), region)
        found = whole_tiles(tiles, region, shift)
        assert 0 < len(found.tile) < len(placed.tile)
        assert found.whole.all()
        assert found.tile.tolist() == placed.tile[placed.whole].tolist()
        assert found.step.tolist() == placed.step[placed.whole].tolist()


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


def rims(name: str, region: Region, shift: complex) -> tuple[float, float, float, float]:
    """What the whole tiles leave free on the left, below, on the right and above; by points along their outlines."""
    placement = place_tiles(period(name).placed(1.0, shift), region)
    kept = placement.whole
    outlines, _ = period(name).placed(1.0, shift).outlines(placement.tile[kept], placement.step[kept])
    x0, y0, x1, y1 = shapely.total_bounds(shapely.multipoints(xy(np.concatenate(flattened(outlines)))))
    left, bottom, right, top = region.bounds
    return x0 - left, y0 - bottom, right - x1, top - y1


@given(
    st.sampled_from(NAMES), st.floats(60.0, 320.0), st.floats(60.0, 320.0), st.floats(-50.0, 50.0), st.floats(0.0, 9.0)
)
@settings(max_examples=6)
def test_tiles_lie_in_the_middle_of_a_rectangle(
    name: str, width: float, height: float, left: float, bottom: float
) -> None:
    """What is free is the same left and right, and above and below, wherever the rectangle is."""
    region = Region.rectangle(left, bottom, left + width, bottom + height)
    shift = best_shift(period(name), region)
    if whole(name, region, shift):
        free = rims(name, region, shift)
        assert free[0] == pytest.approx(free[2], abs=1e-3)
        assert free[1] == pytest.approx(free[3], abs=1e-3)
        assert min(free) >= -1e-4


@pytest.mark.parametrize("name", ["p4-key", pytest.param("p6-manta", marks=pytest.mark.slow)])
def test_tiles_go_towards_the_middle_of_a_drawing_as_far_as_they_can(name: str) -> None:
    """A step that makes rims more equal loses a tile, or there is none to make; by trying steps of all sizes."""
    corners = [0j, 260 + 20j, 250 + 240j, 90 + 260j]
    region = polygon(*corners)
    shift = best_shift(period(name), region)
    count = whole(name, region, shift)
    left, bottom, right, top = rims(name, region, shift)
    assert min(left, bottom, right, top) > 0.0
    for off, unit in ((right - left, 1.0), (top - bottom, 1j)):
        if abs(off) > 0.1:
            steps = np.linspace(0.05, abs(off) / 2, 6) * np.sign(off)
            assert all(whole(name, region, shift + step * unit) < count for step in steps.tolist())


def test_a_group_that_is_not_in_the_middle_is_seen() -> None:
    """The measure of the tests above, for a group that is moved by a millimetre."""
    region = Region.rectangle(0.0, 0.0, 200.0, 150.0)
    shift = best_shift(period("p4-key"), region)
    left, bottom, right, top = rims("p4-key", region, shift)
    assert min(left, bottom) > 0.1
    moved = rims("p4-key", region, shift + 0.1)
    assert moved == pytest.approx((left + 0.1, bottom, right - 0.1, top), abs=1e-6)

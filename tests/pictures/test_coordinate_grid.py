"""The grid of coordinates: round numbers, each at its place, none upon another."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

import voronoi_tiles as vt
from voronoi_tiles.fabrication.lettering import text_width
from voronoi_tiles.pictures.coordinate_grid import GridStep, coordinate_grid, grid_step, labels

BLUE = (24, 52, 140)


@given(
    st.sampled_from([1, 2, 5]),
    st.integers(-9, 9),
    st.floats(-1e3, 1e3),
    st.floats(0.5, 30.0),
    st.sampled_from([False, True]),
)
def test_numbers_are_the_multiples(mantissa: int, exponent: int, low: float, span: float, fine: bool) -> None:
    """Every multiple in the range and no other, as the decimal number that its text says."""
    step = GridStep(mantissa, exponent)
    exact = mantissa * Fraction(10) ** exponent / (step.parts if fine else 1)
    low, high = low * step.length, (low + span) * step.length
    found = step.multiples(low, high, parts=step.parts if fine else 1)
    beyond = exact * (Fraction(low) // exact)
    for value in found.tolist():
        beyond += exact
        nearest = beyond - exact if value == float(beyond - exact) else beyond
        assert value == float(nearest)
        beyond = nearest
        if not fine:
            assert Fraction(step.text(value)) == nearest
            assert not step.text(value).startswith("-0") or value < 0
    assert beyond + exact > high


@given(
    st.floats(-2e4, 2e4),
    st.floats(-2e4, 2e4),
    st.integers(-6, 9),
    st.tuples(st.integers(1, 3000), st.integers(1, 3000)),
)
def test_numbers_keep_apart(x: float, y: float, power: int, size: tuple[int, int]) -> None:
    """In pictures of all shapes and sizes, of cells of all sizes: no text reaches into another, nor beyond the edge."""
    width, height = size
    scale = 10.0**-power * 8
    region = (x / scale * 8, y / scale * 8, x / scale * 8 + width / scale, y / scale * 8 + height / scale)
    letter = max(9.0, (width * height) ** 0.5 / 72)
    step = grid_step(region, scale, letter)
    unit = letter / scale
    found = labels(step.multiples(region[0], region[2]), step.multiples(region[1], region[3]), region, step, unit)
    boxes = [
        (place.real - half, place.real + half, place.imag - unit / 2, place.imag + unit / 2)
        for text, place in found
        for half in [text_width(text, height=unit) / 2]
    ]
    gap = 0.4 * unit
    for k, (left, right, low, high) in enumerate(boxes):
        assert region[0] + gap <= left <= right <= region[2] - gap
        assert region[1] + gap <= low <= high <= region[3] - gap
        for other_left, other_right, other_low, other_high in boxes[:k]:
            apart = max(other_left - right, left - other_right), max(other_low - high, low - other_high)
            assert max(apart) >= gap
    if min(width, height) >= 400 and abs(power) < 6 and max(abs(x), abs(y)) < 1000:
        assert len(found) >= 5


@pytest.mark.parametrize(("size", "step"), [(400, 20), (600, 10)])
def test_lines_are_where_the_coordinates_are(size: int, step: int) -> None:
    """Dark lines through the picture at the multiples of the step, thick ones through the origin; y runs up."""
    design = vt.Design("p4", 60, vt.Site([vt.segment(25 + 3j, 5 + 11j)]))
    scale, half = size / 100, 50 / size  # lines through the pixels' middles
    left, top = -31 - half, 97 + half
    region = (left, top - 100, left + 100, top)
    plain, ruled = (
        vt.render(design, size=size, region=region, renderer="cpu", overlay=overlay).pixels.astype(int)
        for overlay in ([], ["grid"])
    )

    def blue(pixels: NDArray[np.int_], x: float, y: float) -> bool:
        """Whether a pixel is nearer to the lines' colour than any tile is."""
        return bool(np.abs(pixels[int((top - y) * scale), int((x - left) * scale)] - BLUE).max() < 90)

    for value in range(0, 61, step):
        for other in (13.3, 33.3, 53.3):
            for x, y in ((value, other), (other, value)):
                assert blue(ruled, x, y)
                assert not blue(plain, x, y)
    for x, y in ((26.7, 33.3), (6.7, 13.3), (-17.3, 83.3)):
        assert not blue(ruled, x, y)
    for x, y in ((0.1, 33.3), (33.3, 0.1)):
        assert blue(ruled, x, y)


def test_the_units_are_named_and_nothing_is_lost_far_from_the_origin() -> None:
    """In cells of 1e-6 and of 1e9, a million cells away: letters keep their shape to a tenth of a pixel."""
    for size in (1e-6, 1.0, 1e9):
        x = 1e6 * size
        (*_, here) = coordinate_grid((x, x, x + 2 * size, x + 2 * size), 800, 800, "cm")
        (*_, there) = coordinate_grid((0.0, 0.0, 2 * size, 2 * size), 800, 800, "cm")
        name = here.segments[-12:] - complex(x, x), there.segments[-12:]
        assert np.abs(name[0] - name[1]).max() < 0.1 * size / 400

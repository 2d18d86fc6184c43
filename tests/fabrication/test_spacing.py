"""Tiles that are pulled apart: by shapely's measure they are the gap apart, and hardly more."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.fabrication.spacing import Spacing, Stretch
from voronoi_tiles.paths.paths import Paths

SQUARE = np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j])
HOOK = np.array([0, 6, 6 + 4j, 4 + 4j, 4 + 2j, 2 + 2j, 2 + 4j, 4j]) - (3 + 2j)
"""A U, whose arms are 2 wide."""


def least_distance(shapes: list[Complexes], centres: Complexes, basis: Complexes, stretch: Stretch) -> float:
    """The least distance of two tiles, those of the first cell and all round it; 0 for one within another."""
    moved = [shape + stretch(centre) for shape, centre in zip(shapes, centres, strict=True)]
    a, b = stretch(basis).tolist()
    here = [shapely.Polygon(plane(shape)) for shape in moved]
    all_round = [
        shapely.Polygon(plane(shape + i * a + j * b))
        for i in range(-3, 4)
        for j in range(-3, 4)
        for shape in moved
        if i or j
    ]
    pairs = [(one, two) for k, one in enumerate(here) for two in (*here[k + 1 :], *all_round)]
    return min(float(one.distance(two)) for one, two in pairs)


@pytest.mark.parametrize(
    ("shapes", "centres", "basis"),
    [
        ([SQUARE], [0j], [2 + 0j, 2j]),
        ([SQUARE], [0j], [2 + 0j, 1 + 2j]),
        # The arms of one lie between those of the other: they come apart in one direction only.
        ([HOOK, HOOK * -1], [0j, 2 + 2j], [16 + 0j, 7j]),
        # A small tile lies in the middle of a large one, far from its border.
        ([10 * SQUARE, SQUARE], [0j, 3 + 0j], [40 + 0j, 40j]),
    ],
)
@pytest.mark.parametrize("kernels", ["compiled", "numpy"])
def test_tiles_come_apart_by_the_gap(
    shapes: list[Complexes],
    centres: list[complex],
    basis: list[complex],
    kernels: str,
    request: pytest.FixtureRequest,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They are the gap apart wherever they are looked for, and with a hundredth of a percent less they are not."""
    if kernels == "compiled":
        request.getfixturevalue(kernels)
    else:
        monkeypatch.setenv("VORONOI_TILES_KERNELS", kernels)
    places, vectors, gap = np.array(centres), np.array(basis), 0.25
    contours = [
        Paths.polylines([(shape + place).tolist()], closed=True) for shape, place in zip(shapes, places, strict=True)
    ]
    spacing = Spacing(contours, places, vectors)
    for asked in (gap, gap / 4):
        stretch = spacing.stretch(asked)
        assert least_distance(shapes, places, vectors, stretch) == pytest.approx(asked, rel=1e-5)
        less = Stretch(1 + 0.9999 * (stretch.p - 1), 0.9999 * stretch.q)
        assert least_distance(shapes, places, vectors, less) < asked

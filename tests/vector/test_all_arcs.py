"""All arcs of several outlines at once."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from helpers.outlines import RIGHT, polygon

from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.arcs import Arc, LineArc, ParabolaArc
from voronoi_tiles.vector.outline import Outline


def exact_area(outline: Outline) -> Fraction:
    """The integral of x dy by fractions."""
    total = Fraction(0)
    for arc in (arc for ring in outline.rings for arc in ring):
        corners = [arc.start, *([arc.control] if isinstance(arc, ParabolaArc) else []), arc.end]
        p = [(Fraction(z.real), Fraction(z.imag)) for z in corners]
        products = [a[0] * b[1] - a[1] * b[0] for a, b in pairwise(p)]
        chord = p[0][0] * p[-1][1] - p[0][1] * p[-1][0]
        total += chord / 6 + sum(products, Fraction(0)) / 3
    return total


@pytest.mark.parametrize("far", [0.0, 1e6 - 3e6j])
@pytest.mark.parametrize("thin", [1.0, 1e-4])
def test_the_area_has_all_digits(far: complex, thin: float) -> None:
    """Of thin tiles at an angle and of tiles far away, some of them with more copies than others."""
    random = np.random.default_rng(1)
    outlines = []
    for number in (1, 3, 4, 50, 333):
        turn = np.exp(2j * np.pi * np.arange(number) / number)
        corner = (turn.real + 1j * thin * turn.imag) * np.exp(0.7j) * 1e3 + far
        control = (corner + np.roll(corner, -1)) / 2 * (1 + 1e-7 * random.random(number))
        ring: list[Arc] = [
            ParabolaArc(a, b, c, 0j, (0j, 1j), RIGHT) if random.random() < 0.5 else LineArc(a, c, RIGHT)
            for a, b, c in zip(corner.tolist(), control.tolist(), np.roll(corner, -1).tolist(), strict=True)
        ]
        outlines.append(Outline.from_rings([ring, ring]))
    copies = np.array([3, 12, 3, 1, 12])
    wanted = sum(int(times) * exact_area(outline) for times, outline in zip(copies, outlines, strict=True))
    assert AllArcs.of(outlines).area(copies) == pytest.approx(float(wanted), rel=4e-16)


def test_arcs_stand_outline_after_outline() -> None:
    """Rings and tiles keep their numbers, and points on an arc are those of the curve."""
    first = Outline.from_rings([[LineArc(0j, 1 + 0j, RIGHT), LineArc(1 + 0j, 0j, RIGHT)], [LineArc(5j, 5j, RIGHT)]])
    second = Outline.from_rings([[ParabolaArc(0j, 1 + 1j, 2 + 0j, 0j, (0j, 1j), RIGHT)]])
    arcs = AllArcs.of([first, second])
    assert arcs.ring_offsets.tolist() == [0, 2, 3, 4]
    assert arcs.tile.tolist() == [0, 0, 0, 1]
    assert arcs.at(np.array([0, 3, 3, 3]), np.array([0.25, 0.0, 0.5, 1.0])).tolist() == [0.25, 0, 1 + 0.5j, 2]


@pytest.mark.parametrize("wrong", [complex("nan"), complex("inf"), complex(0, float("-inf"))])
@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
def test_the_area_of_what_is_no_number_is_none(wrong: complex) -> None:
    """Neither a number, which could be right, nor an error."""
    arcs = AllArcs.of([Outline.from_rings([polygon(0j, 3 + 0j, wrong, 2 + 5j)])])
    assert np.isnan(arcs.area(np.array([4])))

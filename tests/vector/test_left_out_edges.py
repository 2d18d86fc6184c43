"""Corners that edges of no length leave behind: on both the arcs that then meet there."""

from __future__ import annotations

import numpy as np
import pytest

from voronoi_tiles.vector.complex.left_out_edges import without
from voronoi_tiles.vector.complex.traced import Traced

PARABOLA = (1j, (0j, 1 + 0j))
"""Focus and directrix: 2 y = x^2 + 1 goes through 1 + 1j, and as steeply as the diagonal."""


def ring(vertex: list[complex], curved: int | None = None) -> Traced:
    """A ring of arcs, lines but for one on the parabola."""
    none = np.zeros(len(vertex), np.intp)
    bent = np.arange(len(vertex)) == curved
    focus, directrix = PARABOLA
    return Traced(
        vertex=np.array(vertex, complex),
        offsets=np.array([0, len(vertex)]),
        ring_tile=none[:1],
        site=none,
        motion=none,
        curved=bent,
        focus=np.where(bent, focus, 0),
        directrix=np.where(bent[:, None], np.array(directrix), 0),
        nodes=np.full((len(vertex), 2), np.nan + 0j),
    )


@pytest.mark.parametrize("off", [1e-6, -1e-9])
def test_a_corner_is_the_crossing_of_its_arcs(off: float) -> None:
    """Of a line and a parabola, of two lines, and across the seam where a ring's arcs begin."""
    below = 1 + off
    parabola = [1 + 4j, complex(1, 1 + 3 * off), complex(below, (below**2 + 1) / 2), -1 + 1j]
    assert abs(without(ring(parabola, curved=2), np.array([0, 2, 3])).vertex[1] - (1 + 1j)) < 4e-16
    lines = [1 + 4j, complex(1, 1 + off), complex(1 - off, 1 - off), 0j]
    kept = without(ring(lines), np.array([0, 2, 3]))
    assert abs(kept.vertex[1] - (1 + 1j)) < 4e-16
    assert kept.vertex[[0, 2]].tolist() == [1 + 4j, 0j]
    turned = without(ring([*lines[1:], lines[0]]), np.array([1, 2, 3]))
    assert abs(turned.vertex[0] - (1 + 1j)) < 4e-16


def test_two_arcs_left_out_together_leave_one_corner() -> None:
    """And where nothing is left out all stays."""
    lines = [1 + 4j, 1 + (1 + 2e-8) * 1j, 1 + 1e-8 + 1j, 1 - 1e-8 + (1 - 1e-8) * 1j, 0j]
    assert abs(without(ring(lines), np.array([0, 3, 4])).vertex[1] - (1 + 1j)) < 4e-16
    assert without(ring(lines), np.arange(5)).vertex.tolist() == lines


def test_parallel_arcs_meet_where_the_second_starts() -> None:
    """They cross nowhere, or so far off that it is not the corner."""
    for slope in (0.0, 1e-6):
        lines = [0j, 1 + 0j, 1 + 1e-7j, complex(2, 1e-7 + slope), 1 + 5j]
        assert without(ring(lines), np.array([0, 2, 3, 4])).vertex[1] == 1 + 1e-7j


@pytest.mark.parametrize(("point", "left_out"), [(1, 2), (2, 1)])
def test_an_arc_of_no_length_meets_others_where_the_second_starts(point: int, left_out: int) -> None:
    """It has no direction in which the corner could be moved, whether it comes before that or after."""
    after = 1 + 1e-7j
    lines = [0j, 1 + 0j, 1 + 0j if point == 1 else after, after, 1j]
    kept = np.delete(np.arange(5), left_out)
    assert without(ring(lines), kept).vertex.tolist() == [lines[k] for k in kept]

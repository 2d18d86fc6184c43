"""Sites: their nodes, segments and points."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.site import build_site


@pytest.mark.parametrize(
    ("lines", "elements"),
    [
        ([[0, 2], [0, 2]], [[0, 0, 2, 0]]),
        ([[0, 2], [2, 0]], [[0, 0, 2, 0]]),
        ([[0, 2], [1, 3]], [[0, 0, 3, 0]]),
        ([[0, 1, 2, 3 + 0j]], [[0, 0, 3, 0]]),
        ([[0, 2, 1]], [[0, 0, 2, 0]]),
        ([[0, 2], [1]], [[0, 0, 2, 0]]),
        ([[0, 2], [2]], [[0, 0, 2, 0]]),
        ([[0, 2], [3]], [[0, 0, 2, 0], [3, 0, 3, 0]]),
        ([[1 + 1j], [1 + 1j]], [[1, 1, 1, 1]]),
        ([[1], [2]], [[1, 0, 1, 0], [2, 0, 2, 0]]),
        ([[0, 2], [1 - 1j, 1 + 1j]], [[0, 0, 1, 0], [1, 0, 2, 0], [1, -1, 1, 0], [1, 0, 1, 1]]),
        ([[0, 2], [1, 1 + 1j]], [[0, 0, 1, 0], [1, 0, 2, 0], [1, 0, 1, 1]]),
    ],
)
def test_small_sites(lines: list[list[complex]], elements: list[list[float]]) -> None:
    """Overlaps, T-junctions, crossings and points, by hand."""

    def canonical(rows: list[list[float]]) -> set[tuple[float, ...]]:
        return {tuple(min(row, row[2:] + row[:2])) for row in rows}

    site = build_site("bird", [np.array(line, dtype=complex) for line in lines])
    assert len(site.elements) == len(elements)
    assert canonical(site.elements.tolist()) == canonical(elements)
    assert site.segments.dtype == np.intp
    assert site.nodes.dtype == np.complex128


def test_no_stroke_is_an_error() -> None:
    """A site has at least one stroke."""
    with pytest.raises(DesignError, match="no stroke"):
        build_site("bird", [])


def test_no_heavy_import() -> None:
    """Building sites, crossings too, needs neither shapely nor scipy."""
    code = (
        "import sys, numpy as np; from voronoi_tiles.designs.site import build_site;"
        "build_site('a', [np.array([0, 1+1j]), np.array([1, 1j])]);"
        "assert not {'shapely', 'scipy'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)

"""Winding numbers of outlines beside those of their paths, and parts of sites that strayed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from helpers.outlines import RIGHT, polygon, winding_number
from numpy.typing import NDArray

from voronoi_tiles.paths.winding import winding
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.all_nodes import AllNodes
from voronoi_tiles.vector.arcs import Arc, LineArc, ParabolaArc
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.strayed import strayed_parts, winding_numbers, windings_of_parts


@dataclass(frozen=True)
class _SiteInOutline:
    """What is read of a tile here."""

    nodes: NDArray[np.complex128]
    segments: NDArray[np.intp]
    outline: Outline


def wild(random: np.random.Generator, number: int) -> Outline:
    """A ring of lines and curves through places at random, which crosses itself at will."""
    corner = random.integers(-4, 5, number) + 1j * random.integers(-4, 5, number)
    control = random.integers(-6, 7, number) + 1j * random.integers(-6, 7, number)
    ring: list[Arc] = []
    for start, middle, end, bent in zip(corner, control, np.roll(corner, -1), random.random(number) < 0.6, strict=True):
        a, b, c = complex(start), complex(middle), complex(end)
        ring.append(ParabolaArc(a, b, c, 0j, (0j, 1j), RIGHT) if bent else LineArc(a, c, RIGHT))
    return Outline.from_rings([ring])


def test_against_the_winding_of_paths() -> None:
    """Another computation of the same, on outlines that wind any number of times, points of a grid among them."""
    random = np.random.default_rng(2)
    outlines = [wild(random, int(random.integers(2, 30))) for _ in range(12)]
    x, y = random.uniform(-6, 6, (2, 400))
    points = np.concatenate((x + 1j * y, x + 1j * np.round(y)))
    tile = random.integers(0, 12, len(points))
    found = winding_numbers(AllArcs.of(outlines), points, tile)
    for k, outline in enumerate(outlines):
        assert (found[tile == k] == winding(outline.paths, points[tile == k])).all()
    assert len(set(found.tolist())) > 4


@pytest.mark.parametrize("bulge", [-3, 3])
@pytest.mark.parametrize("turn", [1, 1j, -1, -1j, (3 + 4j) / 5])
def test_points_on_chords(bulge: float, turn: complex) -> None:
    """A point on the chord of a curve is on the side on which the curve is not."""
    a, b, c, d = (turn * z for z in (-4 + 0j, 4 + 0j, 4 + 8j, -4 + 8j))
    ring: list[Arc] = [ParabolaArc(a, turn * bulge * -1j, b, 0j, (0j, 1j), RIGHT)]
    ring += [LineArc(b, c, RIGHT), LineArc(c, d, RIGHT), LineArc(d, a, RIGHT)]
    for x in (-2, 0, 1):
        assert winding_number(Outline.from_rings([ring]), turn * x) == (bulge > 0)


@pytest.mark.parametrize("path", ["as it is", "numpy"])
def test_parts_that_strayed(path: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each connected part counts once, one on the outline not at all, and those of another tile as well."""
    if path == "numpy":
        monkeypatch.setenv("VORONOI_TILES_KERNELS", path)

    def strayed(*tiles: _SiteInOutline) -> int:
        given: Any = tiles
        return strayed_parts(given, AllNodes.of(given), AllArcs.of([tile.outline for tile in tiles]), 10.0)

    square = Outline.from_rings([polygon(0j, 10 + 0j, 10 + 10j, 10j)])
    nodes = np.array([1 + 1j, 2 + 2j, 12 + 2j, 13 + 2j, 5 - 3j, 10 + 5j, 10 + 1e-9 + 4j, -1 + 5j])
    segments = np.array([[0, 1], [3, 2]])
    inside = _SiteInOutline(np.array([5 + 5j]), np.zeros((0, 2), np.intp), square)
    assert strayed(inside, _SiteInOutline(nodes, segments, square)) == 3
    assert strayed(inside) == 0
    turned = Outline.from_rings([polygon(0j, 10j, 10 + 10j, 10 + 0j)])
    assert strayed(_SiteInOutline(inside.nodes, inside.segments, turned)) == 1


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("seed", range(4))
def test_the_kernel_gives_the_same(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of outlines that cross themselves at will; many nodes lie on them or at the heights of their ends."""
    random = np.random.default_rng(seed)
    tiles: Any = []
    for number in random.integers(1, 40, 12).tolist():
        nodes = np.round(2 * random.uniform(-6, 6, number)) / 2 + 1j * random.integers(-6, 7, number)
        segments = random.integers(0, number, (int(random.integers(0, number)), 2))
        tiles.append(_SiteInOutline(nodes, segments, wild(random, int(random.integers(2, 30)))))
    nodes, arcs = AllNodes.of(tiles), AllArcs.of([tile.outline for tile in tiles])
    compiled = windings_of_parts(nodes, arcs)
    monkeypatch.setenv("VORONOI_TILES_KERNELS", "numpy")
    assert compiled.tolist() == windings_of_parts(nodes, arcs).tolist()
    assert len(set(compiled.tolist())) > 4

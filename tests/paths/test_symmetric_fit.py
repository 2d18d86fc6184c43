"""Fits that keep symmetry: whatever the fit does, the result has the symmetry of what it was given."""

from __future__ import annotations

import numpy as np
import pytest

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.paths.symmetric_fit import doubled, first_half, fitted_symmetrically, moved


def dihedral(order: int, *, mirrors: bool) -> list[Isometry]:
    """The symmetries of a regular polygon about 0, the identity left out."""
    turns = [complex(np.exp(2j * np.pi * k / order)) for k in range(order)]
    rotations = [Isometry(turn, 0j, conj=False) for turn in turns[1:]]
    return rotations + [Isometry(turn, 0j, conj=True) for turn in turns] if mirrors else rotations


def ring(order: int, *, mirrors: bool, arcs: bool) -> Paths:
    """A star with the symmetry asked for and no more, of lines or of arcs, and a hole in the middle."""
    spoke = np.array([5.0, 3.0 * np.exp(0.2j), 2.0 * np.exp(0.35j)])
    if mirrors:
        spoke = np.append(spoke, (spoke[1:].conj() * np.exp(2j * np.pi / order))[::-1])
    points = np.concatenate([spoke * np.exp(2j * np.pi * k / order) for k in range(order)])
    hole = 0.5 * np.exp(-2j * np.pi * np.arange(3 * order) / (3 * order))
    star = Paths.polylines([points, hole], closed=True)
    if not arcs:
        return star
    chord = star.end - star.start
    # Bent to the left as far as each is long: what is alike stays alike, and mirrors keep the side.
    control = np.column_stack(((star.start + star.end) / 2 - 0.1j * chord, 0 * chord))
    return Paths(star.start, star.end, control, np.full(len(chord), ARC, np.uint8), star.offsets, star.closed)


def crooked(paths: Paths) -> Paths:
    """A fit without any symmetry: each path goes through its nodes, and aside after every one of them."""
    lines = []
    for path in range(len(paths)):
        first, stop = paths.offsets[path], paths.offsets[path + 1]
        start, end = paths.start[first:stop], paths.end[first:stop]
        aside = start + (end - start) * (0.3 + 0.05j * np.arange(1, stop - first + 1))
        points = np.column_stack((start, aside)).ravel()
        lines.append(np.append(points, end[-1]))
    return Paths.polylines(lines)


def farthest(nodes: Complexes, maps: list[Isometry]) -> float:
    """How far any node is from being the image of another one, under any of the maps."""
    images = [image(nodes) for image in maps]
    return max(float(np.abs(image[:, None] - nodes).min(axis=1).max()) for image in images)


@pytest.mark.parametrize("arcs", [False, True])
@pytest.mark.parametrize(
    ("order", "mirrors"), [(1, True), *((order, mirrors) for order in (2, 3, 4, 6) for mirrors in (False, True))]
)
def test_the_result_is_as_symmetric_as_what_was_given(order: int, mirrors: bool, arcs: bool) -> None:
    """Node by node, for a fit that is as crooked as can be; every ring stays closed."""
    maps, given = dihedral(order, mirrors=mirrors), ring(order, mirrors=mirrors, arcs=arcs)
    result = fitted_symmetrically(given, maps, crooked, close=1e-9)
    assert farthest(result.start, maps) < 1e-9
    assert farthest(crooked(given).start, maps) > 1e-2, "the fit alone keeps the symmetry: it tests nothing"
    assert len(result) == len(given)
    assert result.closed.all()
    for path in range(len(result)):
        part = result.take(np.array([path]))
        assert (part.end == np.roll(part.start, -1)).all()


def test_without_symmetry_rings_are_fitted_as_they_are() -> None:
    """No maps, or rings that do not have the symmetry that is claimed: the fit's own result."""
    given = ring(3, mirrors=False, arcs=False)
    for maps in ([], dihedral(3, mirrors=True)):
        result = fitted_symmetrically(given, maps, crooked, close=1e-9)
        assert (result.start == crooked(given).start).all()


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_a_half_and_its_image_are_the_whole(count: int) -> None:
    """A path across the upright axis, with a corner there or an arc: the arc is one again."""
    mirror = Isometry(-1 + 0j, 0j, conj=True)
    right = np.array([1 + 1j, 2 + 0.5j, 3 + 0j])[: (count + 1) // 2]
    points = np.concatenate((right[::-1], [2j] if count % 2 == 0 else [], -right.conj()))
    path = Paths.polylines([points])
    if count % 2:
        path.kind[count // 2], path.control[count // 2, 0] = ARC, 1.5j
    whole = doubled(first_half(path), mirror, complex(path.end[-1]))
    assert whole.kind.tolist() == path.kind.tolist()
    assert np.abs(whole.start - path.start).max() < 1e-15
    assert np.abs(whole.control - path.control).max() < 1e-15
    assert (whole.kind == LINE).sum() == (path.kind == LINE).sum()
    assert whole.end[-1] == path.end[-1]


def test_an_image_is_an_image() -> None:
    """Start, end and control points where the isometry takes them."""
    turned = moved(ring(2, mirrors=True, arcs=True), Isometry(1j, 1 + 0j, conj=True))
    assert turned.start[0] == 1j * 5.0 + 1.0

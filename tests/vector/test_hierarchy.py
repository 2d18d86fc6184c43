"""The tree of boxes around the elements: what it holds, and the compiled kernel against numpy."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from voronoi_tiles.vector.cells.half_edges import Contour, trace_contour
from voronoi_tiles.vector.cells.hierarchy import Hierarchy, build_hierarchy

Ints = NDArray[np.intp]


def scattered(segments: int, points: int, bundles: int) -> tuple[Contour, Ints]:
    """Segments apart from each other and points among them, and the bundle of each node."""
    rng = np.random.default_rng(segments + points)
    start = rng.uniform(-20, 60, segments) + 1j * rng.uniform(-9, 40, segments)
    ends = np.stack((start, start + rng.normal(size=segments) + 0.3j * rng.normal(size=segments)), axis=1)
    lone = rng.uniform(-20, 60, points) + 1j * rng.uniform(-9, 40, points)
    contour = trace_contour(np.append(ends.ravel(), lone), np.arange(2 * segments).reshape(-1, 2))
    of_element = np.append(np.arange(bundles), rng.integers(0, bundles, segments + points - bundles))
    return contour, np.append(np.repeat(of_element[:segments], 2), of_element[segments:])


def cross(arms: int) -> tuple[Contour, Ints]:
    """A cross whose arms are chains, the same in all four directions: no direction stands out."""
    arm = np.arange(1.0, arms + 1)
    nodes = np.concatenate(([0.0], arm, 1j * arm, -arm, -1j * arm))
    number = np.arange(1, 4 * arms + 1)
    before = np.where((number - 1) % arms == 0, 0, number - 1)
    return trace_contour(nodes, np.stack((before, number), axis=1)), np.zeros(len(nodes), np.intp)


CASES = {
    "one": scattered(1, 0, 1),
    "point": scattered(0, 1, 1),
    "few": scattered(50, 14, 3),
    "more": scattered(51, 14, 3),
    "bundles": scattered(20, 300, 60),
    "many": scattered(900, 100, 2),
    "cross": cross(3),
    "long-cross": cross(40),
}


@pytest.mark.parametrize("name", CASES)
def test_every_box_holds_what_is_below_it(name: str) -> None:
    """Every element stands once on the last level, in a box of its bundle on each level above, and lies in all."""
    contour, node_bundle = CASES[name]
    tree = build_hierarchy(contour, node_bundle)
    last = int(tree.level[-2])
    lone = contour.corner_node[len(contour.source) :: 4]
    source, target = np.append(contour.source[::2], lone), np.append(contour.target[::2], lone)
    assert sorted(tree.element.tolist()) == list(range(len(source)))
    start, end = contour.nodes[source[tree.element]], contour.nodes[target[tree.element]]
    assert np.array_equal(tree.start[last:], start)
    assert np.array_equal(tree.end[last:], end)
    assert np.array_equal(tree.bundle[last:], node_bundle[source[tree.element]])
    parent = np.full(len(tree.start), -1)
    for above in range(last):
        parent[tree.child[above] : tree.child[above + 1]] = above
    box, levels = np.arange(last, len(tree.start)), 1
    while (box >= tree.level[1]).any():
        box = parent[box]
        levels += 1
        assert np.array_equal(tree.bundle[box], tree.bundle[last:])
        axis = tree.end[box] - tree.start[box]
        length = np.abs(axis)
        direction = np.where(length > 0, axis / np.where(length > 0, length, 1), 1)
        for point in (start, end):
            place = (point - tree.start[box]) * direction.conj()
            assert (np.abs(place.imag) <= tree.radius[box] + 1e-12).all()
            assert (np.abs(place.real - length / 2) <= length / 2 + 1e-12).all()
    assert levels == len(tree.level) - 1


@pytest.mark.parametrize("name", CASES)
def test_a_box_is_no_larger_than_it_must_be(name: str) -> None:
    """It reaches to the outermost of its elements on each of its sides."""
    contour, node_bundle = CASES[name]
    tree = build_hierarchy(contour, node_bundle)
    last = int(tree.level[-2])
    ends = np.stack((tree.start[last:], tree.end[last:]))
    first = np.append(np.arange(last, len(tree.start)), len(tree.start)) - last
    for begin, stop in zip(tree.level[-3::-1], tree.level[-2:0:-1], strict=False):
        first = first[tree.child[begin : stop + 1] - tree.child[begin]]
        for box, (one, two) in enumerate(pairwise(first.tolist()), int(begin)):
            axis = tree.end[box] - tree.start[box]
            place = (ends[:, one:two] - tree.start[box]) * np.conj(axis / (abs(axis) or 1.0))
            assert np.ptp(place.real) == pytest.approx(abs(axis), abs=1e-9)
            assert np.ptp(place.imag) == pytest.approx(2 * tree.radius[box], abs=1e-6)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.usefixtures("compiled")
def test_kernel_builds_the_boxes_of_numpy(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same arrays, bit for bit."""
    trees = []
    for chosen in ("", "numpy"):
        monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
        tree = build_hierarchy(*CASES[name])
        trees.append([(array.dtype, array.tobytes()) for array in (getattr(tree, k) for k in Hierarchy.__slots__)])
    assert trees[0] == trees[1]

"""Nearest points and connected parts, beside scipy's."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from voronoi_tiles.base.components import components
from voronoi_tiles.base.neighbours import Neighbours


@pytest.mark.parametrize("number", [1, 2, 50, 1000, 1001, 1500])
@pytest.mark.parametrize("count", [1, 7])
def test_nearest_are_those_of_a_tree(number: int, count: int) -> None:
    """The same distances in the same order, from a tree or not, and they are those of the indices."""
    count = min(count, number)
    random = np.random.default_rng(number)
    among, points = (random.random((2, n, 2)).view(np.complex128)[0, :, 0] for n in (number, 40))
    distance, index = Neighbours(among).nearest(points, count)
    wanted, _ = cKDTree(among.view(np.float64).reshape(-1, 2)).query(
        points.view(np.float64).reshape(-1, 2), k=np.arange(1, count + 1)
    )
    assert distance.shape == index.shape == (40, count)
    assert distance == pytest.approx(wanted, rel=1e-12)
    assert distance == pytest.approx(np.abs(points[:, None] - among[index]), rel=1e-12)
    assert all(len(set(row)) == count for row in index.tolist())


@pytest.mark.parametrize("count", [1, 5])
def test_without_scipy_nearest_are_the_same(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Blender's Python has none: many points are looked through in portions."""
    random = np.random.default_rng(count)
    among, points = (random.random((2, n, 2)).view(np.complex128)[0, :, 0] for n in (3000, 4000))
    tree = Neighbours(among)
    monkeypatch.setitem(sys.modules, "scipy.spatial", None)
    plain = Neighbours(among)
    assert plain._tree is None
    assert tree._tree is not None
    for one, other in zip(plain.nearest(points, count), tree.nearest(points, count), strict=True):
        assert one == pytest.approx(other, rel=1e-12)


@pytest.mark.parametrize("edges", [0, 1, 30, 60, 200])
@pytest.mark.parametrize("seed", range(5))
def test_components_are_those_of_scipy(seed: int, edges: int) -> None:
    """The same parts, each named by its least node."""
    random = np.random.default_rng(seed)
    first, last = random.integers(0, 60, (2, edges))
    least = components(60, first, last)
    graph = coo_array((np.ones(edges), (first, last)), shape=(60, 60))
    _, label = connected_components(graph, directed=False)
    assert ((least[:, None] == least) == (label[:, None] == label)).all()
    assert all(least[k] == np.flatnonzero(label == label[k])[0] for k in range(60))


def test_a_long_chain_in_bad_order_is_one_part() -> None:
    """Edges whose numbers run up and down along the chain take some rounds."""
    order = np.random.default_rng(1).permutation(5000)
    assert not components(5000, order[1:], order[:-1]).any()


def test_few_points_need_no_scipy() -> None:
    """Its import takes longer than most sheets."""
    code = (
        "import sys, numpy as np\n"
        "from voronoi_tiles.base.neighbours import Neighbours\n"
        "Neighbours(np.arange(1000) + 0j).nearest(np.array([3.2 + 0j]), 4)\n"
        "assert 'scipy' not in sys.modules\n"
        "Neighbours(np.arange(1001) + 0j)\n"
        "assert 'scipy' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)

"""The distances of edges' points, with and without the compiled kernel."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.base.maps import move
from voronoi_tiles.designs.design import Design
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.all_nodes import AllNodes
from voronoi_tiles.vector.box_tree import BoxTree
from voronoi_tiles.vector.equidistance import Claims, Sites, distances_of_claims, errors_of_distance
from voronoi_tiles.vector.nearest_copies import distances, inverses
from voronoi_tiles.vector.tessellation import tessellate

SLACK = 1e-9


def problem(name: str, kind: str, number: int, seed: int) -> tuple[Any, ...]:
    """Elements of three sites and a walk of points beside them, with a few jumps, in a cell of a group."""
    random = np.random.default_rng(seed)
    lattice = GROUPS[name].lattice(30.0, 2.0 if kind == "thin" else 27.0, 64.0)
    turn = np.exp(2j * np.pi * random.random(number))
    x, y = random.uniform(-1.5, 1.5, (2, number))
    start = x * lattice.a + y * lattice.b
    match kind:
        case "points":
            end = start.copy()
        case "long":
            end = start + turn * random.uniform(0, 40, number)
        case "grid":  # many that are equally near
            start = np.round(start)
            end = start + np.round(turn)
        case _:
            start = np.cumsum(turn) * 0.3
            end = start + turn * 0.3
    site = np.sort(random.integers(0, 3, number))
    steps = 0.02 * np.exp(2j * np.pi * random.random(300)) + 15 * (random.random(300) < 0.02)
    points: NDArray[np.complex128] = np.cumsum(steps)
    if kind == "grid":
        points = np.round(2 * points) / 2
    motions = inverses([lattice.isometry(operation) for operation in GROUPS[name].operations])
    places = np.stack((points, move(points, *(part[-1] for part in motions))))
    claims = Claims(places, random.integers(0, 3, (2, len(points))))
    return lattice, motions, BoxTree.of(lattice, start, end), Sites(site, start, end - start), claims, SLACK


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("kind", ["points", "long", "grid", "thin", "chain"])
@pytest.mark.parametrize("name", ["p1", "cm", "p6m"])
def test_the_kernel_gives_the_same_bits(name: str, kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of all three distances, few elements or many; infinite are those of sites that are not near."""
    for number in (1, 5, 300):
        given = problem(name, kind, number, number)
        compiled = distances_of_claims(*given)
        monkeypatch.setenv("VORONOI_TILES_KERNELS", "numpy")
        assert compiled.tobytes() == distances_of_claims(*given).tobytes()
        monkeypatch.delenv("VORONOI_TILES_KERNELS")
        assert np.isfinite(compiled[0]).all()


@pytest.mark.parametrize("path", ["as it is", "numpy"])
def test_distances_from_sites_are_right_however_far(path: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a claimed site is not the nearest, all its elements are asked."""
    if path == "numpy":
        monkeypatch.setenv("VORONOI_TILES_KERNELS", path)
    *_, sites, claims, slack = given = problem("p2", "chain", 90, 4)
    found = distances_of_claims(*given)
    for known, places, site in zip(found[1:], claims.places, claims.sites, strict=True):
        got = sites.complete(known, found[0] + slack, places, site)
        every: Floats = distances(places[:, None], sites.start, sites.chord)
        every[site[:, None] != sites.site] = np.inf
        assert (got == every.min(axis=1)).all()
        assert (known > found[0] + slack).any()


def test_what_is_no_number_is_no_small_error() -> None:
    """A vertex that is not a number, of a result that is wrong."""
    read = Design.from_dict(
        {"schema": 1, "group": "p2", "cell": {"a": 9, "b": 8, "angle": 80}, "site": [{"strokes": [{"point": [1, 2]}]}]}
    )
    (record,) = tessellate(read.noded, read.group, read.lattice)
    tile = record.local()
    for wrong in (np.nan, np.inf):
        start = tile.outline.start.copy()
        start[2] = wrong
        vars(tile)["outline"] = replace(tile.outline, start=start)
        with np.errstate(invalid="ignore"):
            of_tile = [tile], AllNodes.of([tile]), AllArcs.of([tile.outline])
            error, _ = errors_of_distance(read.group, read.lattice, *of_tile, 1e-11)
        assert not error <= 1

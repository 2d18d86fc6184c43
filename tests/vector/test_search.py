"""All sites in one search: special positions beside general ones, what belongs to which site, how the work grows."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely
from helpers import fuzz

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.vector import tessellation
from voronoi_tiles.vector.cells import cells, enclosures, trace
from voronoi_tiles.vector.cells.bisectors import find_bisectors
from voronoi_tiles.vector.cells.cells import Parts
from voronoi_tiles.vector.cells.half_edges import Contour, trace_contour
from voronoi_tiles.vector.cells.trace import OpenBoundaryError
from voronoi_tiles.vector.copies import bundles, copies_near, place
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, motion_of
from voronoi_tiles.vector.motions import Action

_THIRD = 60 * math.sqrt(3) / 6
SPECIAL: dict[str, list[tuple[float, float, int]]] = {
    "p1": [],
    "p2": [(0, 0, 2), (30, 0, 2), (0, 30, 2)],
    "pm": [(0, 7, 2), (30, 20, 2)],
    "pg": [],
    "cm": [(0, 7, 2), (0, 25, 2)],
    "pmm": [(30, 0, 4), (0, 0, 4), (11, 0, 2), (0, 17, 2)],
    "pmg": [(0, 0, 2), (15, 4, 2), (0, 30, 2)],
    "pgg": [(30, 0, 2), (0, 0, 2)],
    "cmm": [(0, 0, 4), (15, 15, 2), (0, 20, 2), (17, 0, 2)],
    "p4": [(30, 30, 4), (30, 0, 2), (0, 0, 4)],
    "p4m": [(0, 0, 8), (30, 0, 4), (7, 7, 2), (30, 30, 8), (13, 0, 2)],
    "p4g": [(0, 0, 4), (30, 0, 4), (20, 10, 2)],
    "p3": [(0, 0, 3), (30, _THIRD, 3)],
    "p3m1": [(0, 0, 6), (30, _THIRD, 6), (15, _THIRD / 2, 2)],
    "p31m": [(0, 0, 6), (30, _THIRD, 3), (14, 0, 2)],
    "p6": [(0, 0, 6), (30, _THIRD, 3), (30, 0, 2)],
    "p6m": [(0, 0, 12), (30, _THIRD, 6), (30, 0, 4), (9, 0, 2)],
}
"""Places of each group in a cell of 60 that are mapped onto themselves, with how many operations do it."""


def design(group: str, *strokes: dict[str, Any]) -> dict[str, Any]:
    """A design of one site for each stroke, in a cell of 60."""
    kind = GROUPS[group]
    cell = {"a": 60.0} | ({} if kind.fixes_b else {"b": 60.0})
    if kind.fixed_angle is None:
        cell["angle"] = 90.0
    sites = [{"name": f"site{k}", "strokes": [stroke]} for k, stroke in enumerate(strokes)]
    return {"schema": 1, "group": group, "cell": cell, "site": sites}


def square(x: float, y: float) -> dict[str, Any]:
    """A closed square with sides of 6 about a place."""
    return {"polyline": [[x - 3, y - 3], [x + 3, y - 3], [x + 3, y + 3], [x - 3, y + 3]], "closed": True}


def scattered(count: int) -> dict[str, Any]:
    """A design in p4 of so many points, the same number to an area however many they are."""
    side = 6.0 * math.sqrt(count)
    places = np.random.default_rng(5).uniform(0, side, (count, 2))
    found = design("p4", *({"point": [float(x), float(y)]} for x, y in places))
    return found | {"cell": {"a": 2 * side}}


CIRCLES = [pytest.param(group, "circle", marks=pytest.mark.slow) for group in GROUPS]


@pytest.mark.parametrize(("group", "shape"), [*((group, "point") for group in GROUPS), *CIRCLES])
def test_special_positions_beside_general_ones(group: str, shape: str) -> None:
    """Sites on centres and mirrors have their symmetry, those beside them none; brute force agrees with all tiles."""
    special = SPECIAL[group]
    places = [place[:2] for place in special] + [(16.5, 3.25), (19.125, 4.5), (17.0, 6.75)]
    strokes = [{"point": at} if shape == "point" else {"circle": at, "radius": 0.75} for at in map(list, places)]
    read = design(group, *strokes)
    orders = [len(tile.symmetry) for tile in Design.from_dict(read).tessellate().tiles]
    assert orders == [order for *_, order in special] + [1, 1, 1]
    assert fuzz.try_design(read, np.random.default_rng(1), points=3) == "tiled"


def test_bundles_are_few() -> None:
    """Sites that the same motions copy are one bundle, and the first copies are the bundles where they were placed."""
    read = Design.from_dict(
        design("p4m", *({"point": [x, y]} for x, y in [(17, 5), (0, 0), (30, 30), (19, 9), (30, 0), (14, 3)]))
    )
    action = Action(read.group, read.lattice)
    placed, union = place(action, read.noded)
    bundle = bundles(placed)
    assert bundle.tolist() == [0, 1, 1, 0, 2, 0]
    copies = copies_near(action, placed, union.nodes, bundle[union.node_site])
    identity = copies.motions == IDENTITY_CODE
    assert copies.bundle[identity].tolist() == [0, 1, 2]
    assert identity[:3].all()
    assert len(np.unique(np.column_stack((copies.bundle, copies.motions)), axis=0)) == len(copies)


def test_copies_reach_as_far_as_twice_the_cell_of_the_lattice() -> None:
    """A copy is left out only where no difference of its points and the sites' lies in twice the lattice's cell."""
    read = Design.from_dict(
        {
            **design("p2", {"segment": [[3, 4], [25, 9]]}, {"point": [44, 31]}),
            "cell": {"a": 60.0, "b": 41.0, "angle": 71.0},
        }
    )
    action = Action(read.group, read.lattice)
    placed, union = place(action, read.noded)
    copies = copies_near(action, placed, union.nodes, bundles(placed)[union.node_site])
    found = {motion_of(code) for code in copies.motions.tolist()}
    points = union.nodes
    vectors = [action.cartesian(i, j) for i in range(-2, 3) for j in range(-2, 3) if (i, j) != (0, 0)]
    for motion in action.motions:
        for i in range(-4, 5):
            for j in range(-4, 5):
                moved = (*motion[:4], motion[4] + 2 * i, motion[5] + 2 * j)
                steps = action.apply(moved, points)[:, None] - points
                within = np.ones(steps.shape, bool)
                for vector in vectors:
                    within &= (steps * vector.conj()).real <= abs(vector) ** 2
                assert moved in found or not within.any()


def greedy(ends: Complexes, begins: Complexes, site: list[int], other: list[int]) -> list[int]:
    """For each end a begin of its site: the nearest pair of all first."""
    away = np.abs(ends[:, None] - begins)
    away[np.array(site)[:, None] != np.array(other)] = np.inf
    partner = [-1] * len(ends)
    for _ in ends:
        i, j = np.unravel_index(away.argmin(), away.shape)
        partner[i] = int(j)
        away[i], away[:, j] = np.inf, np.inf
    return partner


def continued(ends: Complexes, begins: Complexes, site: list[int], other: list[int]) -> Ints:
    """For each end, of a part of a site, the begin that continues it: of parts of the sites `other`."""
    count = len(ends)
    early = np.arange(2 * count) < count
    nowhere = np.full(count, 1e9 + 0j)
    links = trace._Links(
        following=np.where(early, -1, 0),
        inner=np.zeros(2 * count, bool),
        entered=early.copy(),
        start=np.concatenate((nowhere, begins)),
        end=np.concatenate((ends, nowhere)),
        site=np.array(site + other),
    )
    trace._match(links)
    trace._close(links)
    return links.following[:count] - count


@pytest.mark.parametrize("error", [0.0, 1e-12, 0.1, 3.0])
def test_ends_are_continued_within_their_site(error: float) -> None:
    """Ends meet their nearest begins, also where other sites have theirs at the same places, and however far apart."""
    rng = np.random.default_rng(7)
    places = rng.normal(size=12) + 1j * rng.normal(size=12)
    site = [0] * 12 + [1] * 12 + [2]
    ends = np.concatenate((places, places, places[:1])).astype(np.complex128)
    order = rng.permutation(25)
    begins = np.asarray(ends[order] + error * (rng.normal(size=25) + 1j * rng.normal(size=25)), np.complex128)
    other = [site[k] for k in order]
    found = continued(ends, begins, site, other)
    assert found.tolist() == greedy(ends, begins, site, other)
    if error < 1e-3:
        assert found[order].tolist() == list(range(25))


def test_as_many_ends_as_begins_of_other_sites_do_not_close() -> None:
    """What does not close within each site is an error, though the numbers of all sites agree."""
    places = np.arange(4).astype(np.complex128)
    with pytest.raises(OpenBoundaryError):
        continued(places, places, [0, 0, 1, 1], [0, 1, 1, 1])


def test_a_tile_without_a_boundary_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """The other tiles' boundaries do not make up for it."""
    read = Design.from_dict(design("p4", {"point": [8, 5]}, {"point": [17, 3]}))
    action = Action(read.group, read.lattice)
    honest = cells.bound_cells

    def without_first(rows: Any, contour: Contour, *others: Any) -> Parts:
        parts = honest(rows, contour, *others)
        first = contour.corner_node[rows.corner[parts.row]] == 0
        return replace(parts, copy=np.where(first, 0, parts.copy), item=np.where(first, 0, parts.item))

    monkeypatch.setattr(tessellation, "bound_cells", without_first)
    with pytest.raises(OpenBoundaryError):
        tessellation._trace(action, *place(action, read.noded))


def test_only_regions_with_guests_are_looked_into() -> None:
    """Of many closed strokes those with another site in them, or a copy, share what they enclose."""
    strokes = [square(8 + 9 * (k % 6), 8 + 9 * (k // 6)) for k in range(36)]
    guests = [{"point": [8 + 9 * 2, 8 + 9 * 3]}, {"point": [68 + 9 * 4, 8 + 9 * 1]}]
    read = Design.from_dict(design("p1", *strokes, *guests))
    action = Action(read.group, read.lattice)
    placed, union = place(action, read.noded)
    bundle = bundles(placed)
    contour = trace_contour(union.nodes, union.segments)
    copies = copies_near(action, placed, union.nodes, bundle[union.node_site])
    enclosed = enclosures.enclosed(contour, copies, union.node_site, bundle[union.node_site])
    inner = np.bincount(union.node_site[contour.source], enclosed, minlength=38)
    assert np.flatnonzero(inner == 0).tolist() == [10, 20, 36, 37]
    holes = [len(tile.outline.ring_areas) for tile in read.tessellate().tiles]
    assert np.flatnonzero(np.array(holes) == 2).tolist() == [10, 20]


# --- how the work grows -------------------------------------------------------------------------------------


def calls(read: Design) -> int:
    """How many functions the search of a design calls, numpy's among them."""
    count = 0

    def counted(_frame: Any, event: str, _argument: Any) -> None:
        nonlocal count
        count += event in {"call", "c_call"}

    action = Action(read.group, read.lattice)
    sites = read.noded
    sys.setprofile(counted)
    try:
        tessellation._trace(action, *place(action, sites))
    finally:
        sys.setprofile(None)
    return count


def test_calls_do_not_grow_with_pairs_of_sites() -> None:
    """Four times as many sites take fewer than twice as many calls: what is left per site is little."""
    few, many = (calls(Design.from_dict(scattered(count))) for count in (16, 64))
    assert many < 2 * few


def test_work_grows_with_the_number_of_sites(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four times as many sites, equally dense, are about four times as many pairs of elements."""
    monkeypatch.setenv("VORONOI_TILES_KERNELS", "numpy")
    pairs: list[int] = []
    honest = find_bisectors

    def counted(rows: Any, around: Any, elements: Any, candidates: Any, bounds: Any) -> Any:
        pairs[-1] += len(candidates.row)
        return honest(rows, around, elements, candidates, bounds)

    monkeypatch.setattr(cells, "find_bisectors", counted)
    for count in (30, 120):
        read = Design.from_dict(scattered(count))
        pairs.append(0)
        action = Action(read.group, read.lattice)
        tessellation._trace(action, *place(action, read.noded))
    assert pairs[0] > 30
    assert pairs[1] < 5 * pairs[0]


def test_what_touches_is_found_among_many(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two of 150 sites touch: the error names them, and distances are taken of neighbours only."""
    strokes = [square(8 + 9 * (k % 15), 8 + 9 * (k // 15)) for k in range(150)]
    strokes[47] = {"segment": [[27, 34], [32, 35]]}
    read = Design.from_dict(design("p1", *strokes) | {"cell": {"a": 150.0, "b": 100.0, "angle": 90.0}})
    taken = []
    honest = shapely.distance

    def counted(here: Any, there: Any) -> Any:
        taken.append(len(here))
        return honest(here, there)

    monkeypatch.setattr(shapely, "distance", counted)
    with pytest.raises(TouchingCopiesError) as caught:
        read.tessellate()
    assert {caught.value.site, caught.value.other} == {"site47", "site48"}
    assert caught.value.place == pytest.approx(32 + 35j)
    assert 0 < sum(taken) < 150

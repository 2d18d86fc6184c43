"""How lofts go together: beside manifold3d, which moves the tiles, and what is known of some designs."""

from __future__ import annotations

import cmath
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from helpers.examples import FOLDER
from helpers.swept import Crowd

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.solid.laying_orders import ORDERS, assembly, prism_assembly, towards_of
from voronoi_tiles.solid.loft import Loft, lofted
from voronoi_tiles.solid.ways_out import UP, TileWays, WayOut

CELLS: dict[str, Any] = {"p1": (40, 40, 80), "p2": (40, 35, 75)}
SEGMENT = vt.Site(vt.segment(5 + 3j, 14 + 8j))
COMMON = 1e-9
"""More than this of its volume in common with another solid is an overlap; walls that slide have 4e-18 at most."""

DISTANCES = (0.1, 0.3, 0.03, 0.6, 0.01, 1.0, 1e-3, 1.5, 1e-4, 2.0, 3.0)
"""Tiles are moved so far, in their sizes: first to where most of them meet something."""


FEW = range(2, ORDERS, 8)
"""The orders that the quick tests take."""


def solid(group: str, strokes: Any = SEGMENT, *, height: float = 20, layers: int = 6, **motion: Any) -> vt.Design:
    """A design that stands, of one site, or of the sites that are given."""
    chosen = vt.GROUPS[group]
    cell = CELLS.get(group, 40 if chosen.fixes_b else (40, 50))
    return vt.Design(chosen, cell, strokes, solid=vt.Solid(height, layers=layers, **motion))


def turned(group: str, degrees: float, about: complex = 9.5 + 5.5j) -> vt.Design:
    """A segment that turns about its middle."""
    return solid(group, vt.Site(vt.segment(about - 4.5 - 2.5j, about + 4.5 + 2.5j)), turn=degrees, about=about)


def short(group: str, at: complex, degrees: float) -> vt.Design:
    """One that has room between mirrors."""
    return solid(group, vt.Site(vt.segment(at - 1 - 1j, at + 2 + 1j)), turn=degrees, about=at)


def hooked(group: str, degrees: float) -> vt.Design:
    """A hook, in which a copy's end lies, that turns about its middle as well."""
    hook = vt.polyline([4 + 8j, 4 + 16j, 14 + 16j, 14 + 9j])
    return solid(group, vt.Site(hook), turn=degrees, about=9 + 12j, layers=11)


def ring() -> vt.Design:
    """A ring about a lid; both turn."""
    square = vt.Site(vt.polyline([4 + 4j, 14 + 4j, 14 + 14j, 4 + 14j], closed=True), name="ring")
    return solid("p4", [square, vt.Site(vt.segment(7 + 9j, 11 + 10j), name="lid")], turn=40, about=9 + 9j)


def wedges() -> vt.Design:
    """Of two sites one grows upward all around, and the other one gives way."""

    def square(half: float) -> vt.Stroke:
        corners = [20 + 20j + half * corner for corner in (-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j)]
        return vt.polyline(corners, closed=True)

    sites = [vt.Site(square(4), name="growing"), vt.Site(vt.point(0), name="giving")]
    return vt.Design(
        "p1", (40, 40, 90), sites, solid=vt.Solid(20, layers=6, keys=[vt.Key(20, square(9), site="growing")])
    )


DESIGNS: dict[str, Callable[[], vt.Design]] = {
    "p4 prism": lambda: solid("p4"),
    "p1 prism": lambda: solid("p1"),
    "p6m prism": lambda: solid("p6m", vt.Site(vt.segment(12 + 2j, 15 + 4j))),
    "p1 sheared": lambda: solid("p1", shift=(7, -3)),
    "p1": lambda: turned("p1", 90),
    "p2": lambda: turned("p2", 90),
    "pg": lambda: turned("pg", 60),
    "pgg": lambda: turned("pgg", 90),
    "cm": lambda: turned("cm", 45, 10 + 12j),
    "p3": lambda: turned("p3", 90),
    "p4": lambda: turned("p4", 90),
    "p4 a little": lambda: turned("p4", 10),
    "p6": lambda: short("p6", 12 + 6j, 90),
    "p31m": lambda: short("p31m", 14 + 4j, 60),
    "pmg": lambda: short("pmg", 4 + 10j, 90),
    "ring": ring,
    "wedges": wedges,
    "p3 steps": lambda: vt.Design.load(FOLDER / "solid" / "p3-steps.toml"),
    "p4 hooks": lambda: hooked("p4", 50),
    "p2 hooks": lambda: hooked("p2", -60),
}


def directions(*, down: bool) -> Floats:
    """Sixty directions all over the upper half of a sphere, or over all of it, and twelve that are level."""
    k = np.arange(60) + 0.5
    z = 1 - 2 * k / 60 if down else k / 60
    around = np.pi * (1 + np.sqrt(5)) * k
    spread = np.column_stack((np.sqrt(1 - z * z) * np.cos(around), np.sqrt(1 - z * z) * np.sin(around), z))
    level = np.exp(2j * np.pi * np.arange(12) / 12)
    return np.concatenate((spread, np.column_stack((level.real, level.imag, np.zeros(12)))))


def agrees(crowd: Crowd, way: WayOut | None, towards: float | None) -> bool:
    """Whether a tile that manifold3d moves has its way where one is said, and in no direction where none is."""
    standing = crowd.behind(towards)

    def met(direction: Floats) -> bool:
        return any(crowd.meets(standing, direction * far * crowd.size, COMMON) for far in DISTANCES)

    if way is not None:
        return not met(np.array(way.direction))
    return all(met(direction) for direction in directions(down=towards is None))


def judge(loft: Loft, orders: Sequence[int | None]) -> None:
    """Assert that the ways of a loft's tiles in some orders are as manifold3d says; None has all others standing."""
    for site in range(len(loft.meshes)):
        crowd, tile = Crowd.about(loft, site), TileWays(loft, site)
        for towards in (None if order is None else towards_of(order) for order in orders):
            way = tile.way(None if towards is None else cmath.rect(1, np.radians(towards)))
            assert agrees(crowd, way, towards)


@pytest.mark.parametrize("name", DESIGNS)
def test_ways_are_as_manifold3d_says(name: str) -> None:
    """A free tile has at no distance anything in common with what stands; a locked one has in all directions."""
    judge(lofted(DESIGNS[name]()), (None, *FEW))


@pytest.mark.slow
@pytest.mark.parametrize("name", DESIGNS)
def test_ways_in_all_orders_are_as_manifold3d_says(name: str) -> None:
    """In each of the 24: in those that the quick tests leave."""
    judge(lofted(DESIGNS[name]()), [order for order in range(ORDERS) if order not in FEW])


def test_manifold3d_sees_wrong_ways() -> None:
    """A way that leads into what stands, or that is said to be none, does not agree."""
    loft = lofted(DESIGNS["p4 a little"]())
    crowd, tile = Crowd.about(loft, 0), TileWays(loft, 0)
    way = tile.way(cmath.rect(1, np.radians(towards_of(3))))
    assert way is not None
    x, y, z = way.direction
    assert agrees(crowd, way, towards_of(3))
    assert not agrees(crowd, way._replace(direction=(-x, -y, z)), towards_of(3))
    assert not agrees(crowd, None, towards_of(3))


# --- what is known --------------------------------------------------------------------------------------------


def free(design: vt.Design) -> int:
    """In how many orders the tile, as drawn, has a way in."""
    tile = TileWays(lofted(design), 0)
    return sum(tile.way(cmath.rect(1, np.radians(towards_of(order)))) is not None for order in range(ORDERS))


def test_a_turned_p4_tile_goes_in_beside_half_of_its_neighbours() -> None:
    """The more it turns the fewer half planes leave it a way; with all neighbours there it has none."""
    assert free(turned("p4", 90)) < free(turned("p4", 10)) == ORDERS
    assert free(turned("p4", 90)) >= ORDERS // 2
    for degrees in (10, 90):
        found = assembly(lofted(turned("p4", degrees)))
        assert found["out"] == {"site1": None}
        assert found["orders"]


def test_prisms_are_lifted() -> None:
    """Whatever their outline, in any order, and from among all others; what is said of prisms without looking is so."""
    for name in ("p4 prism", "p1 prism", "p6m prism"):
        assert assembly(lofted(DESIGNS[name]())) == prism_assembly(["site1"])


def test_a_sheared_prism_comes_out_along_its_walls() -> None:
    """And nowhere else, where all others stand."""
    out = assembly(lofted(DESIGNS["p1 sheared"]()))["out"]["site1"]
    assert out == pytest.approx(np.array([7, -3, 20]) / np.linalg.norm([7, -3, 20]), abs=1e-12)


def test_wedges_come_out_where_they_are_wider() -> None:
    """What grows upward comes out above, what gives way below."""
    out = assembly(lofted(wedges()))["out"]
    assert out["growing"][2] > 0 > out["giving"][2]


def test_an_order_needs_ways_for_all_copies() -> None:
    """An order is one in which the base tile has a way in the orders that the group's operations make of it."""
    loft = lofted(DESIGNS["p4"]())
    tile, found = TileWays(loft, 0), assembly(loft)
    for order in range(ORDERS):
        four = [tile.way(cmath.rect(1, np.radians(towards_of(order) + turn))) for turn in (0, 90, 180, 270)]
        assert (towards_of(order) in found["orders"]) == all(four)


@pytest.mark.parametrize("name", ["p4", "pgg", "p3", "cm", "wedges"])
def test_copies_come_in_as_it_is_said(name: str) -> None:
    """The copy under each operation, moved by manifold3d among all that stand before it, in the best order."""
    loft = lofted(DESIGNS[name]())
    best = assembly(loft)["best"]
    names = [site.name for site in loft.design.noded]
    for row in best["tiles"]:
        site = names.index(row["site"])
        base = Crowd.about(loft, site)
        for text in row["operations"] or [str(operation) for operation in loft.design.group.operations]:
            isometry = loft.design.lattice.isometry(vt.Operation.parse(text))
            # The copy among the others is the tile among those that the inverse makes of them.
            x, y, z = row["from"]
            back = complex(x, y) * isometry.a.conjugate()
            towards = cmath.rect(1, np.radians(best["towards"])) * isometry.a.conjugate()
            if isometry.conj:
                back, towards = back.conjugate(), towards.conjugate()
            standing = base.behind(float(np.degrees(cmath.phase(towards))))
            for far in DISTANCES:
                assert not base.meets(standing, np.array([back.real, back.imag, z]) * far * base.size, COMMON)


def test_turning_a_design_turns_its_orders() -> None:
    """By a quarter about a centre, and mirrored: the same orders and ways, turned and mirrored."""
    about, ends = 9.5 + 5.5j, (5 + 3j, 14 + 8j)
    plain = assembly(lofted(solid("p4", vt.Site(vt.segment(*ends)), turn=90, about=about)))
    quarter = assembly(lofted(solid("p4", vt.Site(vt.segment(*(1j * z for z in ends))), turn=90, about=1j * about)))
    assert quarter["orders"] == sorted((towards + 90) % 360 for towards in plain["orders"])
    mirrored = vt.Site(vt.segment(*(z.conjugate() for z in ends)))
    other = assembly(lofted(solid("p4", mirrored, turn=-90, about=about.conjugate())))
    assert other["orders"] == sorted(360 - towards for towards in plain["orders"])
    assert min(row["clearance"] for row in other["best"]["tiles"]) == pytest.approx(
        min(row["clearance"] for row in plain["best"]["tiles"])
    )
    twice = vt.Site(vt.segment(*(2 * z for z in ends)))
    larger = vt.Design("p4", 80, twice, solid=vt.Solid(40, layers=6, turn=90, about=2 * about))
    assert assembly(lofted(larger))["orders"] == plain["orders"]


def test_ways_of_the_tile_turn_with_it() -> None:
    """The tile of a design that is turned by a quarter has the way that the tile had, turned."""
    about, ends = 9.5 + 5.5j, (5 + 3j, 14 + 8j)
    plain = TileWays(lofted(solid("p4", vt.Site(vt.segment(*ends)), turn=60, about=about)), 0)
    quarter = TileWays(lofted(solid("p4", vt.Site(vt.segment(*(1j * z for z in ends))), turn=60, about=1j * about)), 0)
    seen = 0
    for order in range(ORDERS):
        towards = cmath.rect(1, np.radians(towards_of(order)))
        one, other = plain.way(towards), quarter.way(1j * towards)
        assert (one is None) == (other is None)
        if one is not None and other is not None:
            x, y, z = one.direction
            assert other.direction == pytest.approx((-y, x, z), abs=1e-6)
            seen += 1
    assert seen > 0


def test_straight_up_is_preferred() -> None:
    """Where a tile has that way, it is the one that is said, although another one leaves the walls at once."""
    way = TileWays(lofted(DESIGNS["p4 prism"]()), 0).way(1j)
    assert way == (UP, 0.0)

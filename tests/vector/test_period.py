"""One period of a tessellation against the tiles' own outlines, and approximations that keep its symmetry."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from helpers.examples import each_design, tiling
from helpers.sheets import check_joints, engine, flattened, period, points_on

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.paths import ARC, CUBIC, Paths
from voronoi_tiles.vector.complex.approximation import approximated
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.copies import translation
from voronoi_tiles.vector.motions import Motion, compose, to_operation

CLOSE = 1e-12
"""How far points may be from where the tiles' own outlines have them, relative to the cell."""


def block(here: Period, reach: int = 1) -> tuple[Ints, Ints]:
    """All tiles of a block of cells about the origin."""
    steps = np.array([(i, j) for i in range(-reach, reach + 1) for j in range(-reach, reach + 1)])
    count = len(here.site)
    return np.repeat(np.arange(count), len(steps)), np.tile(steps, (count, 1))


def extent(name: str) -> float:
    """The cell's longer side."""
    return float(np.abs(period(name).basis).max())


def marks(paths: Paths) -> Complexes:
    """Start, middle and end of each piece."""
    return np.array([points_on(paths, k, np.array([0.0, 0.5, 1.0])) for k in range(len(paths.start))])


def arcs(paths: Paths) -> list[tuple[complex, complex, complex]]:
    """Each piece as its start, control point and end."""
    return list(zip(paths.start.tolist(), paths.control[:, 0].tolist(), paths.end.tolist(), strict=True))


def assert_neighbours_share(paths: Paths, inner: Paths) -> None:
    """Assert that no directed arc is there twice, and that all of inner tiles are there backwards: the same bits."""
    there = Counter(arcs(paths))
    assert max(there.values()) == 1, "an arc is there twice"
    lonely = sum((end, control, start) not in there for start, control, end in arcs(inner))
    assert not lonely, f"{lonely} arcs of inner tiles have no other side"


@each_design
def test_every_side_lies_between_two_tiles(name: str) -> None:
    """It is run through once forwards and once backwards; where many tiles meet, all have the same bits."""
    here = period(name)
    uses = Counter(zip(here.rings.edge.tolist(), here.rings.forward.tolist(), strict=True))
    assert uses == Counter((side, sense) for side in range(len(here.edges)) for sense in (False, True))
    paths, items = here.outlines(*block(here, 2))
    check_joints(paths)
    assert paths.closed.all()
    assert items[-1] == len(paths)
    assert_neighbours_share(paths, here.outlines(*block(here, 0))[0])


@each_design
def test_outlines_are_those_of_the_copies(name: str) -> None:
    """To rounding, arc for arc; the outer ring comes first, and the areas add up to the cell's."""
    here, tiles = period(name), tiling(name).tiles
    unit = extent(name)
    steps = np.zeros((len(here.site), 2), np.intp)
    paths, items = here.outlines(np.arange(len(here.site)), steps)
    area = ring_areas(paths)
    assert (area[items[:-1]] > 0).all()
    assert (np.delete(area, items[:-1]) < 0).all()
    assert area.sum() == pytest.approx(tiling(name).design.lattice.det, rel=1e-13)
    placed = engine(name).placed
    for k, (site, motion) in enumerate(zip(here.site.tolist(), here.motion, strict=True)):
        outline = tiles[site].copy(to_operation(compose(motion, translation(placed[site], -1))))
        ours = marks(paths.take(np.arange(items[k], items[k + 1])))
        theirs = np.stack((outline.start, (outline.start + 2 * outline.control + outline.end) / 4, outline.end), axis=1)
        assert len(ours) == len(theirs)
        partner = np.abs(ours[:, None, 1] - theirs[None, :, 1]).argmin(axis=1)
        assert sorted(partner.tolist()) == list(range(len(ours)))
        assert np.abs(ours - theirs[partner]).max() <= CLOSE * unit


@each_design
def test_ends_of_sides_are_the_same_bits_exactly_where_they_meet(name: str) -> None:
    """Among all sides of a block: ends are one vertex, or far apart."""
    here = period(name).placed(np.exp(0.7j), 1.1 - 2.3j)
    steps = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)])
    side, step = np.repeat(np.arange(len(here.edges)), 9), np.tile(steps, (len(here.edges), 1))
    curves = here.curves(side, step)
    ends = np.unique(np.concatenate((curves.start[curves.offsets[:-1]], curves.end[curves.offsets[1:] - 1])))
    apart = np.abs(ends[:, None] - ends) + np.eye(len(ends))
    assert apart.min() > 1e-6
    backwards = here.curves(side, step, np.zeros(len(side), np.bool_))
    assert (backwards.start[backwards.offsets[:-1]] == curves.end[curves.offsets[1:] - 1]).all()
    assert backwards.lengths.sum() == pytest.approx(curves.lengths.sum(), rel=1e-14)
    check_joints(backwards)


def test_a_placed_period_is_the_image() -> None:
    """Turned, scaled and shifted, with all that belongs to it."""
    here = period("p6-rosette")
    factor, shift = 2 * np.exp(0.3j), 5 - 7j
    there = here.placed(complex(factor), shift)
    before, _ = here.outlines(*block(here))
    after, _ = there.outlines(*block(there))
    assert np.abs(marks(before) * factor + shift - marks(after)).max() < 1e-11


def test_borders_name_the_sides_of_outlines() -> None:
    """The curves of a tile's borders, one after another, are its outline."""
    here = period("p4-mill")
    tile, step = block(here)
    owner, side, at, forward = here.borders(tile, step)
    curves = here.curves(side, at, forward)
    paths, items = here.outlines(tile, step)
    assert (curves.start == paths.start).all()
    assert (curves.end == paths.end).all()
    assert (np.bincount(curves.counts.repeat(1).cumsum() * 0 + owner, curves.counts) == tile_counts(paths, items)).all()


def tile_counts(paths: Paths, items: Ints) -> Ints:
    """The number of pieces of each tile."""
    return np.add.reduceat(paths.counts, items[:-1])


# --- approximations --------------------------------------------------------------------------------------------------


def crooked(paths: Paths) -> Paths:
    """Polylines through points of each path at uneven places, a little aside: as asymmetric as a fit can be."""
    lines = []
    for line in flattened(paths, 1e-2):
        share = np.array([0.0, 0.13, 0.37, 0.45, 0.81, 1.0])
        walked = np.append(0.0, np.cumsum(np.abs(np.diff(line))))
        points = np.interp(share * walked[-1], walked, line.real) + 1j * np.interp(
            share * walked[-1], walked, line.imag
        )
        points[1:-1] += 0.003 * walked[-1] * np.array([1 + 2j, -1j, 2, -3 + 1j])
        points[0], points[-1] = line[0], line[-1]
        lines.append(points)
    return Paths.polylines(lines)


def assert_tiles_congruent(here: Period, exact: Period, name: str) -> None:
    """Assert that tiles of a site are images of the first one, and it is its own image under its site's symmetry."""
    action = engine(name).action
    paths, items = here.outlines(np.arange(len(here.site)), np.zeros((len(here.site), 2), np.intp))
    base: dict[int, Complexes] = {}
    for k, (site, motion) in enumerate(zip(exact.site.tolist(), exact.motion, strict=True)):
        unit, conj = action.linear[motion[:4]]
        shift = complex(action.cartesian(motion[4] / 2, motion[5] / 2))
        points = paths.start[paths.offsets[items[k]] : paths.offsets[items[k + 1]]]
        back = (points - shift) / unit
        back = back.conj() if conj else back
        first = base.setdefault(site, back)
        assert len(first) == len(back), f"tile {k} has another number of vertices"
        gap = np.abs(first[:, None] - back).min(axis=1).max()
        assert gap <= 1e-11 * extent(name), f"tile {k} differs by {gap:.1e} from the first of its site"
        for element in engine(name).placed[site].stabilizer:
            gap = np.abs(action.apply(element, first)[:, None] - first).min(axis=1).max()
            assert gap <= 1e-11 * extent(name), f"tile {k} differs by {gap:.1e} from its own image"


@each_design
def test_approximated_tiles_stay_congruent_and_share_their_sides(name: str) -> None:
    """Whatever the fit: copies are images under the exact motions, neighbours share bits, the areas make the cell's."""
    exact = period(name)
    here = approximated(exact, engine(name).quotient, crooked)
    paths, _ = here.outlines(*block(here, 2))
    check_joints(paths)
    assert_neighbours_share(paths, here.outlines(*block(here, 0))[0])
    assert_tiles_congruent(here, exact, name)
    cell, _ = here.outlines(*block(here, 0))
    assert ring_areas(cell).sum() == pytest.approx(tiling(name).design.lattice.det, rel=1e-12)


@pytest.mark.parametrize("name", ["p2-lizard", "p2-drop", "p6-propeller", "p4-hook", "pgg-crane", "cmm-scroll"])
def test_sides_with_a_half_turn_keep_it(name: str) -> None:
    """A side that is its own image under a half turn still is; and this is not for lack of such sides."""
    exact = period(name)
    here = approximated(exact, engine(name).quotient, crooked)
    symmetric = 0
    for k in range(len(exact.edges)):
        exact_points, points = (np.array(flattened(p.edges.take(np.array([k])), 1e-3)[0]) for p in (exact, here))
        swap = exact_points[0] + exact_points[-1]
        if exact_points[0] == exact_points[-1] or np.abs(swap - exact_points[::-1] - exact_points).max() > 1e-9:
            continue
        symmetric += 1
        assert np.abs(swap - points[::-1] - points).max() < 1e-10
    assert symmetric > 0


def test_sides_that_cross_a_mirror_keep_it() -> None:
    """The moth is symmetric about x = 0: its sides across the mirror are their own images backwards."""
    here = approximated(period("cm-moth"), engine("cm-moth").quotient, crooked)
    mirrored = 0
    for k in range(len(here.edges)):
        points = flattened(here.edges.take(np.array([k])))[0]
        a, b = points[0], points[-1]
        if abs(a.imag - b.imag) < 1e-12 and abs(a.real - b.real) > 1:
            centre = (a.real + b.real) / 2
            mirrored += 1
            assert np.abs(2 * centre - points[::-1].conj() - points).max() < 1e-10
    assert mirrored > 0


@each_design
def test_edges_are_images_of_those_of_the_quotient_complex(name: str) -> None:
    """Every edge is where its motion takes the one of its orbit; a fit that changes nothing changes nothing."""
    here, quotient = period(name), engine(name).quotient
    originals = quotient.paths()
    for k, (orbit, motion) in enumerate(zip(here.orbit.tolist(), here.edge_motion, strict=True)):
        image = moved(name, originals.take(np.array([orbit])), motion)
        assert np.abs(marks(image) - marks(here.edges.take(np.array([k])))).max() <= CLOSE * extent(name)
    same = approximated(here, quotient, lambda paths: paths)
    assert same.edges.lengths.sum() == pytest.approx(here.edges.lengths.sum(), rel=1e-12)
    assert sorted(set(here.orbit.tolist())) == list(range(len(originals)))


@each_design
def test_edges_of_one_orbit_are_those_that_symmetry_maps_onto_each_other(name: str) -> None:
    """Told by brute force, from the places of the edges alone: every operation of the group, every pair of edges."""
    here, action = period(name), engine(name).action
    middles = [complex(flattened(here.edges.take(np.array([k])), 1e-3)[0].mean()) for k in range(len(here.edges))]
    corners = [edge_corners(here, k) for k in range(len(here.edges))]
    for one in range(len(here.edges)):
        for two in range(one):
            found = any(
                maps_onto(action, motion, (corners[one], middles[one]), (corners[two], middles[two]))
                for motion in action.motions
            )
            assert found == (here.orbit[one] == here.orbit[two]), (one, two)


def edge_corners(here: Period, edge: int) -> Complexes:
    """Its ends."""
    path = here.edges.take(np.array([edge]))
    return np.array([path.start[0], path.end[-1]])


def maps_onto(action: Any, motion: Motion, one: tuple[Complexes, complex], two: tuple[Complexes, complex]) -> bool:
    """Whether a motion, followed by some lattice translation, takes one edge to another, by ends and middle."""
    ends, middle = action.apply(motion, one[0]), complex(action.apply(motion, np.array([one[1]]))[0])
    x, y = action.fractional(two[1] - middle)
    shift = complex(action.cartesian(round(x), round(y)))
    close = 1e-6 * action.size
    gaps = [np.abs(ends + shift - there).max() for there in (two[0], two[0][::-1])]
    return bool(min(gaps) <= close and abs(middle + shift - two[1]) <= close)


def moved(name: str, paths: Paths, motion: Motion) -> Paths:
    """The image of paths under a motion."""
    action = engine(name).action
    unit, conj = action.linear[motion[:4]]
    return paths.moved(unit, complex(action.cartesian(motion[4] / 2, motion[5] / 2)), conj=conj)


def test_curves_of_other_kinds_come_through() -> None:
    """A fit may give arcs and cubic curves: reflections and half turns take them along."""

    def fit(paths: Paths) -> Paths:
        ends = [paths.take(np.array([k])) for k in range(len(paths))]
        first, last = (np.array([p.start[0] for p in ends]), np.array([p.end[-1] for p in ends]))
        chord = last - first
        kind = np.where(np.arange(len(ends)) % 2, ARC, CUBIC).astype(np.uint8)
        bend = first + chord * (0.5 + 0.1j)
        control = np.column_stack((bend, np.where(kind == CUBIC, first + chord * (0.9 - 0.3j), 0)))
        closed = first == last
        assert not closed.any()
        return Paths(first, last, control, kind, np.arange(len(ends) + 1), closed)

    for name in ("p4g-fan", "pgg-crane", "cm-moth"):
        here = approximated(period(name), engine(name).quotient, fit)
        paths, _ = here.outlines(*block(here))
        check_joints(paths)
        assert (here.edges.kind >= CUBIC).any()
        tile, _ = here.outlines(np.arange(len(here.site)), np.zeros((len(here.site), 2), np.intp))
        around = np.add.reduceat(tile.lengths, tile.offsets[:-1])
        for site in np.unique(here.site):
            own = around[np.flatnonzero(here.site == site)]
            assert np.abs(own - own[0]).max() < 1e-9


def test_the_oracle_of_congruence_sees_a_tile_that_is_not_symmetric() -> None:
    """All copies are alike, but edges across the mirror are fitted as if it were not there."""
    here, quotient = period("cm-moth"), engine("cm-moth").quotient
    bent = approximated(here, replace(quotient, symmetric={}), crooked)
    with pytest.raises(AssertionError, match="own image"):
        assert_tiles_congruent(bent, here, "cm-moth")


# --- the oracles can fail ----------------------------------------------------------------------------------------


def test_the_oracles_of_sharing_and_congruence_see_what_is_wrong() -> None:
    """A vertex moved by an ulp, and one side fitted differently from the others of its orbit."""
    name = "p4-hook"
    here = period(name)
    paths, _ = here.outlines(*block(here, 0))
    doubled = Paths.concatenate([paths, paths])
    with pytest.raises(AssertionError, match="twice"):
        assert_neighbours_share(doubled, paths)
    around, _ = here.outlines(*block(here, 2))
    start = around.start.copy()
    start[0] = complex(np.nextafter(start[0].real, np.inf), start[0].imag)
    with pytest.raises(AssertionError, match="no other side"):
        assert_neighbours_share(replace(around, start=start), around)
    inner = int(np.flatnonzero(np.diff(here.edges.offsets) > 1)[0])
    start, end = here.edges.start.copy(), here.edges.end.copy()
    at = int(here.edges.offsets[inner])
    start[at + 1] = end[at] = end[at] + 1e-6
    bent = replace(here, edges=replace(here.edges, start=start, end=end))
    with pytest.raises(AssertionError, match="differs by"):
        assert_tiles_congruent(bent, here, name)

"""Boundaries of all tiles at once: their outlines, and what the tiles beyond have in the place of each arc."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from helpers import fuzz
from helpers.examples import tiling

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.vector.complex.boundary import TileBoundaries
from voronoi_tiles.vector.complex.site_symmetry import SiteSymmetry
from voronoi_tiles.vector.motions import IDENTITY, to_motion, translated
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import Tessellation, tessellate

Arcs = tuple[Complexes, Complexes, Complexes]

# Sites in general positions and on a mirror, and one around another: a ring with one neighbour only.
SEVERAL = {
    "schema": 1,
    "group": "pm",
    "cell": {"a": 60.0, "b": 50.0},
    "site": [
        {"strokes": [{"point": [11, 7]}]},
        {"strokes": [{"segment": [[0, 30], [0, 39]]}]},
        {"strokes": [{"circle": [17, 27], "radius": 9}]},
        {"strokes": [{"segment": [[14, 26], [18, 29]]}]},
    ],
}

# A ring of points on either side of a mirror: two edges with the same neighbour run between the same two vertices.
RING = {
    "schema": 1,
    "group": "p4m",
    "cell": {"a": 60.0},
    "site": [
        {
            "strokes": [
                {"point": [20 + x, 45 + y]}
                for x, y in (
                    (3, 3),
                    (0, 18**0.5),
                    (-3, 3),
                    (-(18**0.5), 0),
                    (-3, -3),
                    (0, -(18**0.5)),
                    (3, -3),
                    (18**0.5, 0),
                )
            ]
        }
    ],
}


@cache
def tessellation(name: str) -> Tessellation:
    """That of a starter, of several sites, or of a ring of points."""
    own = {"several": SEVERAL, "ring": RING}
    found = Design.from_dict(own[name]).tessellate() if name in own else tiling(name)
    return found.tessellation


def arcs(outlines: list[Outline]) -> Arcs:
    """Start, control and end of all arcs."""
    start, control, end = (
        np.concatenate([getattr(outline, name) for outline in outlines]) for name in ("start", "control", "end")
    )
    return start, control, end


def differing(one: Arcs, other: Arcs) -> list[int]:
    """The arcs that are not the same, bit for bit."""
    return np.flatnonzero(np.any([a != b for a, b in zip(one, other, strict=True)], axis=0)).tolist()


@pytest.mark.parametrize("name", ["pg", "cm", "p3m1", "p4g", "p6", "several", "ring"])
def test_the_tiles_beyond_have_every_arc_reversed(name: str) -> None:
    """Bit for bit, each from the boundary of the tile beyond; and so it is in the outline of that tile's copy."""
    here = tessellation(name)
    found = here.counterparts()
    assert differing(found, arcs(here.placed_outlines)) == []
    k = 0
    for outline in here.placed_outlines:
        copies = [
            here.placed_outline(here.names.index(site), motion)
            for site, motion in ((site, to_motion(operation)) for site, operation in outline.neighbours)
        ]
        theirs = [set(zip(c.end.tolist(), c.control.tolist(), c.start.tolist(), strict=True)) for c in copies]
        for neighbour in outline.neighbour.tolist():
            assert tuple(complex(part[k]) for part in found) in theirs[neighbour]
            k += 1
    assert k == len(found[0])


@pytest.mark.parametrize("name", ["p4", "several"])
def test_an_arc_that_one_tile_has_elsewhere_is_not_what_the_other_has(name: str) -> None:
    """One vertex of one boundary is another point, or one edge faces another copy than the tile there does."""
    here = tessellation(name)
    symmetry, boundaries = SiteSymmetry.of(here.placed), TileBoundaries.of(here.quotient)
    start = replace(boundaries.start, index=boundaries.start.index.copy())
    start.index[3], start.index[4] = start.index[4], start.index[3]
    bent = replace(boundaries, start=start)
    names = [outline.neighbours for outline in here.placed_outlines]
    assert {3, 4} & set(differing(bent.counterparts(symmetry), arcs(bent.outlines(IDENTITY, names))))
    motion = boundaries.motion.copy()
    motion[0] += 2
    lost = replace(boundaries, motion=motion).counterparts(symmetry)
    assert set(np.flatnonzero(boundaries.face == 0).tolist()) <= set(differing(lost, arcs(here.placed_outlines)))


@pytest.mark.parametrize("name", ["p4m", "several"])
def test_all_outlines_at_once_are_those_of_single_tiles(name: str) -> None:
    """The same arrays, neighbours and rings."""
    here = tessellation(name)
    for tile, outline in enumerate(here.outlines):
        single = here.outline(tile, IDENTITY)
        for part in ("start", "control", "end", "curved", "focus", "directrix", "neighbour", "ring_offsets"):
            np.testing.assert_array_equal(getattr(outline, part), getattr(single, part), strict=True)
        assert outline.neighbours == single.neighbours


def same_by_the_kernels(here: Tessellation, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both paths give the same outlines and counterparts, bit for bit, as arrays of the same types.

    Under a motion that turns the plane over as well, and where arcs have no counterparts, or others.
    """
    boundaries, rng = TileBoundaries.of(here.quotient), np.random.default_rng(len(here.boundaries.face))
    shuffled = replace(boundaries, start=boundaries.start.take(rng.permutation(len(boundaries.face))))
    lost = replace(boundaries, motion=boundaries.motion + 2 * (rng.random(len(boundaries.motion)) < 0.3))
    names = [outline.neighbours for outline in here.placed_outlines]
    motions = [IDENTITY, *(translated(motion, 3, -(2**40)) for motion in here.action.motions[-2:])]
    found = []
    for chosen in ("", "numpy"):
        monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
        arrays = [array for some in (boundaries, shuffled, lost) for array in some.counterparts(here.symmetry)]
        for outline in (outline for motion in motions for outline in boundaries.outlines(motion, names)):
            arrays += [getattr(outline, name) for name in ("start", "control", "end", "focus", "directrix")]
        found.append([(array.dtype, array.shape, array.tobytes()) for array in arrays])
    assert found[0] == found[1]


@pytest.mark.parametrize("name", [*GROUPS, "several", "ring"])
@pytest.mark.usefixtures("compiled")
def test_kernels_give_the_boundaries_of_numpy(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of starters, of several sites, and where two edges of one face run between the same vertices."""
    same_by_the_kernels(tessellation(name), monkeypatch)


@pytest.mark.parametrize("number", range(30))
@pytest.mark.usefixtures("compiled")
def test_kernels_give_the_boundaries_of_numpy_for_any_design(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Fuzzed designs, as far as their copies do not touch."""
    design = Design.from_dict(fuzz.design_of(2029, number)[1])
    try:
        tiles = tessellate(design.noded, design.group, design.lattice)
    except TouchingCopiesError:
        return
    same_by_the_kernels(tiles[0].tessellation, monkeypatch)

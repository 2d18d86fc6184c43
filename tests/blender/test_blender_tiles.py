"""Tiles as Blender is given them: curves, meshes, copies in a field, the same as those of the engine."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
import shapely

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.blender.cubic_splines import CubicSpline, coordinates, cubic_splines
from voronoi_tiles.blender.field import FIELD_MAX, FieldCopies, copies_in_cell, lay_field, pivot_of
from voronoi_tiles.blender.polygon_mesh import PolygonMesh, polygon_prism
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import TileRecord, tessellate

RING = vt.Design(
    "p4",
    60,
    [
        vt.Site([vt.polyline([8 + 9j, 21 + 7j, 23 + 20j, 9 + 22j], closed=True), vt.segment(21 + 7j, 27 + 12j)]),
        vt.Site([vt.polyline([14 + 13j, 17 + 16j, 14 + 17j])]),
    ],
)
"""A tile with a hole, and one that lies in it."""


def tiles_of(design: vt.Design) -> list[TileRecord]:
    """The engine's tiles."""
    return tessellate(design.noded, design.group, design.lattice)


def cubic_at(spline: CubicSpline, t: float) -> Complexes:
    """The point of each curve of a spline at a parameter, by the polynomials of Bernstein."""
    ends, handles = np.roll(spline.points, -1), np.roll(spline.left, -1)
    s = 1 - t
    return np.asarray(s**3 * spline.points + 3 * s * s * t * spline.right + 3 * s * t * t * handles + t**3 * ends)


def edges(mesh: PolygonMesh) -> Counter[tuple[int, int]]:
    """How often each side of a polygon is there, in its direction."""
    found: Counter[tuple[int, int]] = Counter()
    for a, b in zip(mesh.starts[:-1].tolist(), mesh.starts[1:].tolist(), strict=True):
        face = mesh.corners[a:b].tolist()
        found.update(zip(face, face[1:] + face[:1], strict=True))
    return found


def is_closed(mesh: PolygonMesh) -> bool:
    """Whether each side of a polygon is there once in each direction."""
    found = edges(mesh)
    return all(count == 1 and found[pair[::-1]] == 1 for pair, count in found.items())


def volume(mesh: PolygonMesh) -> float:
    """The enclosed volume, by the divergence theorem over fans."""
    points = mesh.vertices.astype(np.float64)
    total = 0.0
    for a, b in zip(mesh.starts[:-1].tolist(), mesh.starts[1:].tolist(), strict=True):
        face = points[mesh.corners[a:b]]
        total += float(np.einsum("j,ij->", face[0], np.cross(face[1:-1], face[2:])))
    return total / 6


@pytest.mark.parametrize("group", vt.GROUPS)
def test_curves_are_the_outline(group: str) -> None:
    """Each arc is a cubic curve that is the parabola, or the line, at every parameter; rings stay rings."""
    for tile in tiles_of(vt.starter(group)):
        outline = tile.outline
        splines = cubic_splines(outline)
        assert [len(spline.points) for spline in splines] == np.diff(outline.ring_offsets).tolist()
        for t in (0.0, 0.25, 0.6, 1.0):
            quadratic = (1 - t) ** 2 * outline.start + 2 * t * (1 - t) * outline.control + t * t * outline.end
            found = np.concatenate([cubic_at(spline, t) for spline in splines])
            assert np.abs(found - quadratic).max() < 1e-13 * 60


def test_handles_of_lines_are_at_their_thirds() -> None:
    """So that a straight edge stays straight, and even, however it is drawn."""
    outline = tiles_of(vt.Design("p1", (10, 8, 90), [vt.Site([vt.point(0)])]))[0].outline
    (spline,) = cubic_splines(outline)
    ends = np.roll(spline.points, -1)
    assert np.abs(spline.right - (2 * spline.points + ends) / 3).max() < 1e-15 * 10
    assert np.abs(np.roll(spline.left, -1) - (spline.points + 2 * ends) / 3).max() < 1e-15 * 10


def test_coordinates_are_rounded_once() -> None:
    """Single precision, x, y and z of one point after the other."""
    assert coordinates(np.array([0.1 + 2j, -3j]), 4.0).tolist() == [np.float32(0.1), 2.0, 4.0, 0.0, -3.0, 4.0]


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("group", vt.GROUPS)
def test_prisms_are_closed_and_have_their_volume(group: str, mirrored: bool) -> None:
    """Without a gap, faces outward, turned over as well; the tiles of a cell fill its part of the slab."""
    tiles, total = tiles_of(vt.starter(group)), 0.0
    cell = tiles[0].tessellation.action.lattice.det
    order = tiles[0].tessellation.action.group.order
    for tile in tiles:
        mesh = polygon_prism(tile.outline, pivot_of(tile.outline), 3.0, 3e-3, mirrored=mirrored)
        assert is_closed(mesh)
        total += volume(mesh) * order / len(tile.symmetry)
    assert total == pytest.approx(3.0 * cell, rel=1e-6)


@pytest.mark.parametrize("mirrored", [False, True])
def test_tiles_with_holes_are_closed_too(mirrored: bool) -> None:
    """Their faces are triangles; what lies in the hole fills it."""
    outer, inner = (tile.outline for tile in tiles_of(RING))
    assert len(outer.ring_areas) == 2
    meshes = [polygon_prism(outline, 10 + 10j, 2.0, 1e-3, mirrored=mirrored) for outline in (outer, inner)]
    assert all(map(is_closed, meshes))
    assert sum(map(volume, meshes)) == pytest.approx(2.0 * 900, rel=1e-6)


def test_an_open_mesh_is_seen() -> None:
    """The oracle can fail: a face less, and one that is turned over."""
    outline = tiles_of(vt.starter("p4"))[0].outline
    mesh = polygon_prism(outline, 0j, 3.0, 1e-2, mirrored=False)
    assert not is_closed(mesh._replace(starts=mesh.starts[:-1]))
    turned = mesh.corners.copy()
    turned[mesh.starts[-2] :] = turned[mesh.starts[-2] :][::-1]
    assert not is_closed(mesh._replace(corners=turned))


def placed(outline: Outline, pivot: complex, mirrored: bool, matrix: Floats) -> Complexes:
    """Where a matrix takes the vertices of a tile, which is drawn about its pivot, turned over or not."""
    z = outline.start - pivot
    z = z.conj() if mirrored else z
    x, y, *_ = matrix @ np.stack((z.real, z.imag, 0 * z.real, 1 + 0 * z.real))
    return np.asarray(x + 1j * y)


def base(tiles: list[TileRecord], pivots: list[complex], copies: FieldCopies, k: int) -> tuple[Outline, complex, bool]:
    """What copy k is a copy of: the outline, its pivot, whether it is turned over."""
    number = int(copies.tile[k])
    return tiles[number].outline, pivots[number], bool(copies.mirrored[k])


@pytest.mark.parametrize("group", vt.GROUPS)
def test_copies_are_the_engines(group: str) -> None:
    """Every copy in a field is where the engine has it, by a turn and a shift alone, and none is there twice."""
    tiling = vt.starter(group).tessellate()
    tiles = tiles_of(tiling.design)
    pivots = [pivot_of(tile.outline) for tile in tiles]
    copies = lay_field(tiles, pivots, 2, 3, "fewest")
    assert len(set(copies.names)) == len(copies.names) == 6 * len(tiles) * tiling.design.group.order
    assert np.count_nonzero(copies.shown) == 6 * sum(tile.copies_per_cell for tile in tiling)
    middles = [
        np.round(placed(*base(tiles, pivots, copies, k), copies.matrices()[k]).mean(), 6)
        for k in np.flatnonzero(copies.shown).tolist()
    ]
    assert len(set(middles)) == len(middles)
    assert np.abs(np.abs(copies.unit) - 1).max() < 1e-15
    for k, matrix in enumerate(copies.matrices()):
        assert np.linalg.det(matrix) == pytest.approx(1.0)
        number = int(copies.tile[k])
        operation = copies.names[k].removeprefix(f"{tiling[number].name} ")
        expected = set(np.round(tiling[number].copy(operation).start, 9).tolist())
        found = placed(*base(tiles, pivots, copies, k), matrix)
        assert np.abs(np.sort_complex(np.round(found, 9)) - np.sort_complex(np.array([*expected]))).max() < 1e-8


@pytest.mark.parametrize("group", ["p4", "pgg", "p6m", "cm"])
@pytest.mark.parametrize("pull", [0, -2])
def test_neighbours_differ_in_colour(group: str, pull: int) -> None:
    """No two copies that share an edge are alike, wherever the site is drawn; most tiles of a field are neighbours."""
    design = vt.starter(group)
    design = design.moved(translate=pull * (design.lattice.a + design.lattice.b))
    tiling = design.tessellate()
    tiles = tiles_of(design)
    copies = lay_field(tiles, [pivot_of(tile.outline) for tile in tiles], 3, 3, "fewest")
    middles: dict[complex, list[int]] = {}
    for k, name in enumerate(copies.names):
        if not copies.shown[k]:
            continue
        tile = tiling[int(copies.tile[k])]
        outline = tile.copy(name.removeprefix(f"{tile.name} "))
        long = outline.lengths > 1e-3
        for middle in np.round(((outline.start + outline.end) / 2)[long], 6).tolist():
            middles.setdefault(middle, []).append(int(copies.colour[k]))
    shared = [pair for pair in middles.values() if len(pair) > 1]
    assert len(shared) > 50
    assert all(len(pair) == 2 and pair[0] != pair[1] for pair in shared)
    assert len(copies.colours) == max(copies.colour) + 1


def test_a_mirror_symmetric_tile_is_never_turned_over() -> None:
    """Where a turn does as well as a reflection: one mesh is enough."""
    tiles = tiles_of(vt.Design("cm", (60, 60), [vt.Site([vt.segment(5j, 20j), vt.segment(-4 + 9j, 4 + 9j)])]))
    assert len(tiles[0].symmetry) == 2
    assert copies_in_cell(tiles[0].tessellation.action.group, tiles[0].symmetry) == [True, False, True, False]
    copies = lay_field(tiles, [0j], 2, 2, "none")
    assert np.count_nonzero(copies.shown) == 8
    assert not copies.mirrored[copies.shown].any()


def test_too_large_a_field_is_refused() -> None:
    """With how many tiles it would have, and how many can be."""
    tiles = tiles_of(vt.starter("p6m"))
    with pytest.raises(vt.ArgumentError, match=rf"50 x 50 cells has [\d,]+ tiles. .*{FIELD_MAX:,}"):
        lay_field(tiles, [0j, 0j], 50, 50, "none")


def test_pivots_are_near_the_middle_and_exact() -> None:
    """Single precision holds them, and a tile is no farther from its pivot than half its size and a little."""
    for group in vt.GROUPS:
        for tile in tiles_of(vt.starter(group)):
            pivot = pivot_of(tile.outline)
            assert complex(np.complex64(pivot)) == pivot
            left, bottom, right, top = tile.outline.bounds
            assert shapely.box(left, bottom, right, top).contains(shapely.Point(pivot.real, pivot.imag))
            size = max(right - left, top - bottom)
            assert abs(pivot - complex(left + right, bottom + top) / 2) < size / 60

"""Tiles as prisms: closed, of the right volume, beside each other, and refused where they cannot be."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import manifold3d
import numpy as np
import pytest
import shapely
from helpers.examples import EXAMPLES, tiling
from helpers.programs import PIECES

from voronoi_tiles import GROUPS, Design, JobError, ProofError, SolidJob, TriangleMesh, extrude
from voronoi_tiles.solid import extrusion
from voronoi_tiles.solid.extrusion import surrounded
from voronoi_tiles.solid.extrusion_proof import prove_prisms
from voronoi_tiles.solid.loft_caps import cap
from voronoi_tiles.solid.prism import Face, Prism
from voronoi_tiles.solid.slab import Slab

QUICK = ["p1", "p2", "pg", "pmm", "cm", "p4", "p4m", "p3", "p6"]
"""Designs of the quick run: the cells of all kinds, mirrors, glides, special positions."""


def quick(some: list[str], names: list[str]) -> list[Any]:
    """The names as parameters, all but some of them slow."""
    return [name if name in some else pytest.param(name, marks=pytest.mark.slow) for name in names]


def judged(mesh: TriangleMesh) -> Any:
    """The solid as manifold3d takes it, which refuses what is no closed surface."""
    solid = manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices, mesh.triangles.astype(np.uint64)))
    assert solid.status() == manifold3d.Error.NoError
    return solid


def cell_volume(name: str, height: float) -> float:
    """The volume of a slab over the cell of a design, in cubic millimetres."""
    design = tiling(name).design
    return float(design.lattice.det * design.unit_mm**2 * height)


@pytest.mark.parametrize("name", quick(QUICK, [*GROUPS, *EXAMPLES]))
def test_tiles_fill_the_slab(name: str) -> None:
    """Each is one solid as manifold3d judges it; with their copies they have the volume of the slab over the cell."""
    tiles = tiling(name)
    solid = extrude(tiles, SolidJob(height=5.0))
    assert len(solid.pieces) == len(tiles)
    total = 0.0
    for tile, piece in zip(tiles, solid.pieces, strict=True):
        made = judged(piece.mesh)
        assert made.volume() == pytest.approx(piece.mesh.volume, rel=1e-12)
        holes = sum(area < 0 for area in tile.outline.ring_areas)
        parts = len(tile.outline.ring_areas) - holes
        assert made.genus() == 1 - parts + holes
        assert piece.mesh.volume == pytest.approx(5.0 * tile.area * tiles.design.unit_mm**2, rel=2e-3)
        total += tile.copies_per_cell * piece.mesh.volume
    assert total == pytest.approx(cell_volume(name, 5.0), rel=1e-12)


@pytest.mark.parametrize("name", quick(["pgg"], ["p4", "pgg", "p6m"]))
def test_neighbours_on_a_sheet_share_their_walls(name: str) -> None:
    """Within the sheet every triangle of an upright wall is one of a neighbour as well, turned over, bit for bit."""
    solid = extrude(tiling(name), SolidJob(sheet="200x150mm", height=2.0))
    corners = np.concatenate([piece.mesh.corners for piece in solid.pieces])
    upright = np.abs(np.concatenate([piece.mesh.normals for piece in solid.pieces])[:, 2]) < 0.5
    vertex = np.unique(corners[upright].reshape(-1, 3), axis=0, return_inverse=True)[1].reshape(-1, 3)
    there = {min((a, b, c), (b, c, a), (c, a, b)) for a, b, c in vertex.tolist()}
    lone = np.array([min((c, b, a), (b, a, c), (a, c, b)) not in there for a, b, c in vertex.tolist()])
    assert len(there) == len(vertex)
    assert lone.mean() < 0.6
    # What has no counterpart bounds all pieces together: seen from above, its lower sides close.
    ends = corners[upright][lone]
    outside = shapely.union_all([face(piece.mesh) for piece in solid.pieces], grid_size=1e-9).boundary
    middles = ends.mean(axis=1)[:, :2]
    assert shapely.distance(shapely.points(middles), outside).max() < 1e-6


def test_neighbours_do_not_overlap() -> None:
    """Two prisms that touch have no volume in common."""
    solid = extrude(tiling("p3"), SolidJob(sheet="150x120mm"))
    made = [judged(piece.mesh) for piece in solid.pieces]
    common = [(one ^ other).volume() for k, one in enumerate(made) for other in made[:k]]
    assert max(common) <= 1e-9 * made[0].volume()


@pytest.mark.parametrize("name", quick(["p3"], ["p4", "p3", "pg", "p4m"]))
def test_a_clearance_parts_neighbours(name: str) -> None:
    """As far as it says, within the accuracy; and each tile loses half of it along its edge."""
    solid = extrude(tiling(name), SolidJob(sheet="160x160mm", clearance=0.3))
    shapes = shapely.union_all([face(piece.mesh) for piece in solid.pieces], grid_size=None)
    parts = shapely.get_parts(shapes)
    assert len(parts) >= len(solid.pieces)
    one, other = np.triu_indices(len(parts), 1)
    apart = shapely.distance(parts[one], parts[other])
    assert 0.3 <= apart.min() <= 0.32
    tile = tiling(name)[0]
    piece = next(piece for piece in solid.pieces if piece.site == tile.name)
    outline = tile.to_shapely(accuracy=0.001 / tiling(name).design.unit_mm)
    scale = tiling(name).design.unit_mm
    expected = outline.buffer(-0.15 / scale, quad_segs=64, join_style="mitre").area * scale**2
    assert piece.mesh.volume / 3.0 == pytest.approx(expected, rel=2e-3)


def face(mesh: TriangleMesh) -> Any:
    """The region of the plane that a prism stands on."""
    corners = mesh.corners[(mesh.corners[:, :, 2] == 0.0).all(axis=1)][:, :, :2]
    return shapely.union_all(shapely.polygons(corners))


@pytest.mark.parametrize("clearance", [pytest.param(0.0, marks=pytest.mark.slow), 0.2])
def test_a_chamfer_breaks_both_rims(clearance: float) -> None:
    """The solid is closed; its faces lie the chamfer within its middle; between them its walls run at 45 degrees."""
    whole = extrude(tiling("p6"), SolidJob(height=4.0, clearance=clearance)).pieces[0].mesh
    mesh = extrude(tiling("p6"), SolidJob(height=4.0, clearance=clearance, chamfer=0.5)).pieces[0].mesh
    assert judged(mesh).genus() == 0
    assert sorted(set(mesh.vertices[:, 2].tolist())) == [0.0, 0.5, 3.5, 4.0]
    rim = face(whole).exterior
    corner = whole.vertices[:, :2].min(axis=0) - mesh.vertices[:, :2].min(axis=0)
    upper = mesh.vertices[mesh.vertices[:, 2] == 4.0][:, :2] + corner
    assert shapely.distance(shapely.points(upper), rim) == pytest.approx(0.5, abs=0.03)
    areas = mesh.areas[np.abs(np.abs(mesh.normals[:, 2]) - np.sqrt(0.5)) < 0.02]
    assert areas.sum() > 0.8 * 2 * rim.length * 0.5 * np.sqrt(2)
    steiner = [face(whole).buffer(-t, join_style="mitre").area for t in (0.0, 0.25, 0.5)]
    expected = 3.0 * steiner[0] + 2 * 0.5 * (steiner[0] + 4 * steiner[1] + steiner[2]) / 6
    assert mesh.volume == pytest.approx(expected, rel=2e-3)


def test_holes_are_kept() -> None:
    """A tile with a hole is a solid with one, and so with a clearance and a chamfer; what lies in it is another."""
    tiles = Design.loads(PIECES).tessellate()
    for job in (SolidJob(), SolidJob(clearance=0.2), SolidJob(chamfer=0.4), SolidJob(clearance=0.2, chamfer=0.4)):
        ring, stone = extrude(tiles, job).pieces
        assert (judged(ring.mesh).genus(), judged(stone.mesh).genus()) == (1, 0)
        assert ring.mesh.volume > stone.mesh.volume


def test_rings_that_touch_in_a_point_are_parted() -> None:
    """Where a hole touches the outer ring, no more than two walls meet."""
    points = np.array([0, 10, 10 + 10j, 10j, 5j, 5j, 3 + 6j, 6 + 6j, 6 + 3j])
    mesh = Prism.over(Face(points, np.array([0, 5, 9]), 89.5), 2.0).mesh()
    assert mesh.is_closed
    assert judged(mesh).volume() == pytest.approx(179.0)
    # And so at the ends of a loft.
    assert set(cap([points[:5], points[5:]]).ravel().tolist()) == set(range(9))


def test_one_of_each_stands_at_the_origin_and_a_sheet_on_its_page() -> None:
    """No coordinate is negative, and nothing lies beyond the sheet's margin."""
    alone = extrude(tiling("p4m"), SolidJob(margin=5.0))
    assert alone.bounds[0] == pytest.approx([5.0, 5.0, 0.0])
    low, high = extrude(tiling("p4m"), SolidJob(sheet="200x100mm", margin=7.0, rotate=30.0)).bounds
    assert (low[:2] >= 7.0 - 1e-9).all()
    assert (high[:2] <= np.array([193.0, 93.0]) + 1e-9).all()


def test_a_gap_pulls_tiles_apart() -> None:
    """What a clearance has parted counts."""
    for clearance in (0.0, 0.4):
        job = SolidJob(sheet="200x150mm", gap=2.0, clearance=clearance)
        shapes = [face(piece.mesh) for piece in extrude(tiling("p2"), job).pieces]
        one, other = np.triu_indices(len(shapes), 1)
        apart = shapely.distance(np.array(shapes)[one], np.array(shapes)[other])
        assert 2.0 - 1e-6 <= apart.min() <= 2.1


def test_what_a_sheet_lacks_is_said() -> None:
    """Sites that are not on it, and that pulling a stone out of its ring takes most of it."""
    tiles = Design.loads(PIECES).tessellate()
    assert extrude(tiles, SolidJob(sheet="200x200mm")).notes == ()
    assert "times their room" in "".join(extrude(tiles, SolidJob(sheet="300x300mm", gap=2.0)).notes)
    notes = extrude(Design.loads(WAISTED).tessellate(), SolidJob(sheet="45x20mm")).notes
    assert notes == ("no whole tile of 'bar', 'above' is on the sheet",)


def test_colours_are_the_schemes() -> None:
    """Without one each site has its own; tiles that share an edge differ where the fewest are asked for."""
    assert [piece.colour for piece in extrude(tiling("p4m")).pieces] == [0, 1]
    solid = extrude(tiling("p3"), SolidJob(sheet="150x120mm", colours="fewest"))
    assert (solid.grouped, len(solid.colours), len(set(solid.colours))) == (True, 3, 3)
    shapes = [face(piece.mesh) for piece in solid.pieces]
    for k, one in enumerate(solid.pieces):
        for j, other in enumerate(solid.pieces[:k]):
            if one.colour == other.colour:
                assert shapely.intersection(shapes[k], shapes[j]).length < 1e-9


def test_a_recipe_makes_the_same_solid() -> None:
    """The design and the job that files hold are all that it was made of."""
    solid = extrude(tiling("cm"), SolidJob(sheet=(120, 100), chamfer=0.3, rotate=10, colours="handedness"))
    job = SolidJob(**json.loads(solid.recipe["solid"]))
    again = extrude(Design.loads(solid.recipe["design"]).tessellate(), job)
    assert [piece.name for piece in again.pieces] == [piece.name for piece in solid.pieces]
    for one, other in zip(solid.pieces, again.pieces, strict=True):
        assert (one.mesh.vertices == other.mesh.vertices).all()
        assert (one.mesh.triangles == other.mesh.triangles).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"height": 0}, "`height` 0 mm cannot be"),
        ({"height": "0mm"}, "`height` 0 mm cannot be"),
        ({"clearance": -1}, "`clearance` -1 mm cannot be"),
        ({"height": 3, "chamfer": 1.5}, "leave nothing of a `height` of 3 mm"),
        ({"clearance": 1e-3}, "hardly more than the `accuracy`"),
        ({"sheet": "10x10mm", "margin": 5}, "`margin`"),
        ({"colours": "rainbow"}, "`colours` 'rainbow' is unknown"),
        ({"colours": "files"}, "`colours` 'files' is unknown"),
    ],
)
def test_a_job_that_cannot_be_is_refused(options: dict[str, Any], message: str) -> None:
    """With the option and what to do."""
    with pytest.raises(JobError) as refusal:
        SolidJob(**options)
    assert message in str(refusal.value)
    assert refusal.value.remedy


WAISTED = """
schema = 1
group = "p1"
cell = { a = 40, b = 40, angle = 90 }
site = [
  { name = "bar", strokes = [{ segment = [[8, 20], [32, 20]] }] },
  { name = "above", strokes = [{ point = [20, 23] }] },
  { name = "below", strokes = [{ point = [20, 17] }] },
]
"""
"""A bar with a waist of three millimetres."""


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"clearance": 60.0}, "`clearance='60mm'` is too much: a piece vanishes"),
        ({"clearance": 3.5}, "`clearance='3.5mm'` is too much: a neck breaks at (20, 20) mm"),
        ({"chamfer": 1.75, "height": 4}, "`chamfer='1.75mm'` is too much: a neck breaks"),
        ({"sheet": "20x20mm"}, "no whole tile fits on the sheet"),
        ({"sheet": "500x500mm"}, "triangles"),
    ],
)
def test_a_tile_that_is_eaten_is_refused(
    options: dict[str, Any], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A clearance or a chamfer must leave it in one piece; a sheet must hold one, and not too many for the memory."""
    monkeypatch.setattr(extrusion, "TRIANGLES_MAX", 10_000)
    tiles = Design.loads(WAISTED).tessellate()
    with pytest.raises(JobError) as refusal:
        extrude(tiles, SolidJob(**options))
    assert message in str(refusal.value)
    assert refusal.value.remedy


@pytest.mark.parametrize(
    ("fault", "job", "message"),
    [
        (lambda z: z * 1.001, SolidJob(), "do not share the point"),
        (lambda z: np.where(np.arange(len(z)) == 3, z + 1e-12, z), SolidJob(), "do not share the point"),
        (lambda z: z * 1.05, SolidJob(clearance=0.2), "apart"),
        (lambda z: z * 1.0005, SolidJob(clearance=0.2), "apart"),
        (lambda z: z * 0.99, SolidJob(clearance=0.2), "cubic millimetres"),
    ],
    ids=["too large", "a point beside its place", "too near", "a little too near", "too small"],
)
def test_the_proof_sees_what_is_wrong(fault: Callable[[Any], Any], job: SolidJob, message: str) -> None:
    """Outlines that are not the tiles', by the least."""
    tiles = tiling("p4")
    slab = Slab.of(tiles.design, tiles.tessellation, job)
    prisms = slab.prisms()
    prove_prisms(prisms, slab.lines, job)
    wrong = [replace(prism, outer=prism.outer._replace(points=fault(prism.outer.points))) for prism in prisms]
    with pytest.raises(ProofError, match=message):
        prove_prisms(wrong, slab.lines, job)


def test_the_proof_sees_a_slab_that_is_not_filled() -> None:
    """A height that is off by a billionth."""
    tiles = tiling("p4")
    slab = Slab.of(tiles.design, tiles.tessellation, SolidJob())
    with pytest.raises(ProofError, match="volume of the solids"):
        prove_prisms(slab.prisms(), slab.lines, SolidJob(height=3.000000003))


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        (lambda mesh: mesh._replace(vertices=mesh.vertices * [1, 1, 2]), "from 0 to 6 mm, and not from 0 to 3 mm"),
        (lambda mesh: mesh._replace(vertices=mesh.vertices * [1 + 1e-9, 1, 1]), "cubic millimetres, and its tile's"),
        (lambda mesh: mesh._replace(vertices=mesh.vertices * [-1, 1, 1], triangles=mesh.triangles[:, ::-1]), "tile"),
        (lambda mesh: mesh._replace(triangles=mesh.triangles[1:]), "not closed"),
    ],
    ids=["twice as high", "a little too wide", "mirrored", "open"],
)
def test_what_is_written_is_proved(
    fault: Callable[[TriangleMesh], TriangleMesh], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the tiles of the period are right and one of the solids on the sheet is not."""
    made = Slab.meshes

    def wrong(self: Slab, prisms: Any) -> Any:
        *others, last = made(self, prisms)
        return iter([*others, fault(last)])

    monkeypatch.setattr(Slab, "meshes", wrong)
    with pytest.raises(ProofError, match=message):
        extrude(tiling("p4m"), SolidJob(sheet="150x120mm"))


def test_what_is_pulled_apart_is_not_said_to_touch() -> None:
    """Its neighbours share their points, or are a clearance apart, before that alone."""
    for clearance in (0.0, 0.3):
        together = extrude(tiling("p2"), SolidJob(sheet="150x120mm", clearance=clearance))
        pulled = extrude(tiling("p2"), SolidJob(sheet="150x120mm", clearance=clearance, gap=5.0))
        said = ("neighbours" in together.proved, "pulled" in together.proved, "before they are pulled" in pulled.proved)
        assert said == (True, False, True)
        assert (together.proof["pulled_apart"], pulled.proof["pulled_apart"]) == (False, True)
        assert surrounded(tiling("p2"), SolidJob(clearance=clearance)).proved.endswith("before they are pulled apart")

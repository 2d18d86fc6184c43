"""Lofts that are drawn in: by shapely's erosions of exact tiles and manifold3d's slices they keep what they promise."""

from __future__ import annotations

import dataclasses
import json
from typing import Any

import manifold3d
import numpy as np
import pytest
import shapely
from helpers.random_solids import KINDS, random_solid
from shapely.affinity import affine_transform

import voronoi_tiles as vt
from voronoi_tiles.solid import assembly
from voronoi_tiles.solid.events import LoftError
from voronoi_tiles.solid.inset_depth import InsetDepth
from voronoi_tiles.solid.inset_loft import InsetLoft
from voronoi_tiles.solid.inset_making import inset_loft
from voronoi_tiles.solid.inset_proof import prove_inset, proved_inset
from voronoi_tiles.solid.loft import lofted
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.motion import Motion
from voronoi_tiles.vector.motion_codes import motion_of

CELLS: dict[str, Any] = {"p1": (40, 40, 80), "p2": (40, 35, 75)}
SEGMENT = vt.Site(vt.segment(5 + 3j, 14 + 8j), name="bird")
HEIGHTS = (0.0, 0.013, 0.09, 0.257, 0.31, 0.493, 0.5, 0.751, 0.94, 0.987, 1.0)
"""Shares of the height at which solids are looked at: rims among them, and levels."""


def design_of(group: str = "p4", sites: vt.Site | list[vt.Site] = SEGMENT, **motion: Any) -> vt.Design:
    """A design of a group with a small solid: a segment that turns by a quarter, where nothing else is said."""
    chosen = vt.GROUPS[group]
    cell = CELLS.get(group, 40 if chosen.fixes_b else (40, 50))
    motion = {"height": 20, "layers": 6, **(motion or {"turn": 90, "about": 9.5 + 5.5j})}
    return vt.Design(chosen, cell, sites, solid=vt.Solid(**motion))


def made(design: vt.Design, clearance: float = 0.2, chamfer: float = 0.0, accuracy: float = 0.05) -> InsetLoft:
    """A loft that is drawn in, proved."""
    height = Motion.of(design).height * design.unit_mm
    inset, proof = proved_inset(design, InsetDepth(clearance / 2, chamfer, accuracy, height))
    assert proof.failures == ()
    return inset


def judged(mesh: TriangleMesh) -> Any:
    """The solid as manifold3d takes it: with 64 bits, and nothing merged."""
    solid = manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices, mesh.triangles.astype(np.uint64)))
    assert solid.status() == manifold3d.Error.NoError
    return solid


def slice_of(solid: Any, z: float) -> Any:
    """What manifold3d cuts out of a solid at a height, as shapely's region."""
    rings = [shapely.Polygon(ring) for ring in solid.slice(z).to_polygons()]
    region = shapely.Polygon()
    for ring in sorted(rings, key=lambda ring: -ring.area):
        region = region.symmetric_difference(ring)
    return region


def tiles_at(design: vt.Design, z: float) -> list[Any]:
    """The exact tiles of the strokes at a height, in millimetres, from a flat design that has these."""
    sites = [
        vt.Site([vt.segment(a, b) if a != b else vt.point(a) for a, b in site.ends.tolist()], name=site.name)
        for site in Motion.of(design).at(z)
    ]
    flat = vt.Design(design.group, design.cell, sites)
    unit = design.unit_mm
    return [affine_transform(tile.to_shapely(accuracy=1e-4), [unit, 0, 0, unit, 0, 0]) for tile in flat.tessellate()]


def eroded(tile: Any, by: float) -> Any:
    """What of a region is farther than so much from its edge."""
    return tile.buffer(-by, quad_segs=64) if by > 0 else tile


def check_slices(inset: InsetLoft, shares: Any = HEIGHTS, *, slack: float = 1e-4) -> None:
    """Slices lie in the exact tiles' erosions by what is asked, and cover those by the accuracy more.

    With a clearance, slices of neighbours are so far apart.
    """
    design, depth = inset.loft.design, inset.depth
    solids = [judged(mesh) for mesh in inset.meshes]
    action = inset.loft.levels[0].core.action
    below = depth.accuracy if depth.half == 0 else 0.0
    for share in shares:
        # A slice at the very ends is none.
        z = min(max(share * depth.height, 1e-6), depth.height - 1e-6)
        slices = [slice_of(solid, z) for solid in solids]
        asked = depth.half + max(depth.chamfer - z, depth.chamfer - (depth.height - z), 0.0)
        for tile, own in zip(tiles_at(design, z / design.unit_mm), slices, strict=True):
            assert own.difference(eroded(tile, asked - below - slack)).area < 1e-9
            assert eroded(tile, asked + depth.accuracy + slack).difference(own).area < 1e-9
        names = {
            (t, *name)
            for level in inset.levels
            for t, tile in enumerate(level.level.core.rings)
            for r in tile
            for name in r
        }
        for t, site, code in names if depth.half else ():
            turn, shift, conj = action.isometry(motion_of(code))
            flip = -1.0 if conj else 1.0
            matrix = [turn.real, -flip * turn.imag, turn.imag, flip * turn.real, shift.real, shift.imag]
            unit = design.unit_mm
            matrix[4:] = [shift.real * unit, shift.imag * unit]
            assert slices[t].distance(affine_transform(slices[site], matrix)) >= 2 * depth.half * (1 - 1e-9)


# --- right ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("group", ["p1", "p2", "pg", "pgg", "p4", "p3", "p31m"])
def test_solids_keep_their_clearance(group: str) -> None:
    """At heights of levels, of rims and anywhere between, by other libraries' slices and erosions; closed balls."""
    inset = made(design_of(group), chamfer=0.5)
    check_slices(inset)
    assert [judged(mesh).genus() for mesh in inset.meshes] == [0]


def test_the_volume_is_that_of_the_drawn_in_tiles() -> None:
    """By Simpson's rule over erosions of exact tiles: between that of what is asked and that of the accuracy more."""
    inset = made(design_of("pgg"), accuracy=0.02)
    shares = np.linspace(0, 1, 41)
    tiles = [tiles_at(inset.loft.design, 20 * share)[0] for share in shares]

    def volume(by: float) -> float:
        areas = np.array([eroded(tile, by).area for tile in tiles])
        return float((areas[:-1:2] + 4 * areas[1::2] + areas[2::2]).sum() / 3 * 20 / 40)

    assert volume(0.12) < inset.meshes[0].volume < volume(0.1)
    assert inset.meshes[0].volume == pytest.approx(volume(0.11), rel=2e-4)


def test_a_chamfer_alone_leaves_the_walls_between_as_they_are() -> None:
    """They are the loft's, bit for bit; rims run at 45 degrees."""
    inset = made(design_of("pgg"), clearance=0.0, chamfer=0.5)
    check_slices(inset, (0.0, 0.005, 0.0125, 0.02, 0.024, 0.98, 0.99, 1.0))
    (own,), (whole,) = inset.meshes, inset.loft.meshes
    kept = {tuple(row) for row in whole.vertices.tolist() if 0.5 <= row[2] <= 19.5}
    assert kept <= {tuple(row) for row in own.vertices.tolist()}
    corners = own.corners[(own.corners[:, :, 2] >= 0.5).all(axis=1) & (own.corners[:, :, 2] <= 19.5).all(axis=1)]
    there = {tuple(sorted(map(tuple, three))) for three in whole.corners.tolist()}
    assert {tuple(sorted(map(tuple, three))) for three in corners.tolist()} <= there
    assert len(corners) > 300


def test_faces_of_rims_are_chamfer_and_clearance_further_in() -> None:
    """The bottom is the tile at the height 0, drawn in by all of it."""
    inset = made(design_of("p4"), chamfer=1.0)
    (mesh,) = inset.meshes
    (tile,) = tiles_at(inset.loft.design, 0.0)
    bottom = mesh.vertices[mesh.vertices[:, 2] == 0.0][:, :2]
    away = shapely.distance(shapely.points(bottom), tile.exterior)
    assert (away >= 1.1).all()
    assert (away <= 1.15).all()


def test_tiles_in_holes_have_room_all_round() -> None:
    """A ring, and in its hole a tile whose edge faces one copy all round, and so has no corner to begin at."""
    square = vt.Site(vt.polyline([4 + 4j, 14 + 4j, 14 + 14j, 4 + 14j], closed=True), name="ring")
    inside = vt.Site(vt.segment(7 + 9j, 11 + 9j), name="inside")
    inset = made(design_of("p4", [square, inside], turn=40, about=9 + 9j), chamfer=0.4)
    check_slices(inset, (0.01, 0.4, 0.77))
    assert [judged(mesh).genus() for mesh in inset.meshes] == [1, 0]


def test_images_of_a_site_that_is_symmetric_are_apart() -> None:
    """A cross on a centre of quarter turns."""
    inset = made(design_of("p4", vt.Site([vt.segment(-9, 9), vt.segment(-9j, 9j)]), turn=30))
    check_slices(inset, (0.2, 0.61))


def test_other_units_are_the_same_solid() -> None:
    """A clearance is in millimetres, whatever the design's unit."""
    site = vt.Site(vt.segment(0.2 + 0.1j, 0.55 + 0.3j))
    design = vt.Design("p4", 1.5, site, units="in", solid=vt.Solid(0.8, layers=6, turn=60, about=0.4 + 0.2j))
    inset = made(design, chamfer=0.5)
    check_slices(inset, (0.01, 0.41, 0.6))
    assert inset.meshes[0].vertices[:, 2].max() == pytest.approx(0.8 * 25.4)


def test_images_are_the_solids_of_copies() -> None:
    """Turned, moved and mirrored by the operation, and no inside out."""
    inset = made(design_of("pgg"))
    for operation in ("x,y", "-x,-y", "-x+1/2,y+1/2"):
        image = inset.image(0, operation)
        assert image.is_closed
        assert image.volume == pytest.approx(inset.meshes[0].volume, rel=1e-12)
    turned = inset.image(0, "-x,-y").vertices
    assert turned == pytest.approx(inset.meshes[0].vertices * [-1, -1, 1])


# --- refused --------------------------------------------------------------------------------------------------

WAISTED = [
    vt.Site(vt.segment(8 + 20j, 32 + 20j), name="bar"),
    vt.Site(vt.point(20 + 26j), name="above"),
    vt.Site(vt.point(20 + 14j), name="below"),
]


@pytest.mark.parametrize(
    ("clearance", "message"),
    [
        (2.2, r"`clearance='2.2mm'` is too much: a neck breaks at .* in the tile of site \"bar\", at the height"),
        (60.0, "`clearance='60mm'` is too much: nothing is left at"),
    ],
)
def test_what_is_left_in_pieces_is_refused(clearance: float, message: str) -> None:
    """A bar whose waist shrinks on the way up: the height and the place are named."""
    keys = [vt.Key(20, vt.point(20 + 22j), site="above"), vt.Key(20, vt.point(20 + 18j), site="below")]
    design = vt.Design("p1", (40, 40, 90), WAISTED, solid=vt.Solid(20, layers=5, keys=keys))
    with pytest.raises(vt.JobError, match=message) as refusal:
        vt.stand(design, vt.SolidJob(clearance=clearance))
    assert "Use a smaller `clearance`" in str(refusal.value)
    assert vt.stand(design, vt.SolidJob(clearance=0.2)).pieces[0].mesh.is_closed


# --- the proof ------------------------------------------------------------------------------------------------


def broken(inset: InsetLoft, vertices: Any = None, triangles: Any = None) -> InsetLoft:
    """The same with another mesh."""
    (mesh,) = inset.meshes
    copy = dataclasses.replace(inset)
    copy.__dict__["meshes"] = (
        TriangleMesh(
            mesh.vertices if vertices is None else vertices, mesh.triangles if triangles is None else triangles
        ),
    )
    return copy


def test_what_takes_too_many_triangles_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where only what is drawn in has more than there may be, it is refused as it is made, with what to do."""
    inset = made(design_of())
    plain, drawn = (sum(len(mesh.triangles) for mesh in of.meshes) for of in (inset.loft, inset))
    assert plain < drawn
    monkeypatch.setattr(assembly, "TRIANGLES_MAX", drawn + 4)  # four more: two for each corner of a ring
    assert made(design_of()).loft is not None
    monkeypatch.setattr(assembly, "TRIANGLES_MAX", (plain + drawn) // 2)
    with pytest.raises(vt.ArgumentError, match=r"more than [\d,]+ triangles. Give a coarser accuracy"):
        made(design_of())


def test_the_proof_sees_what_is_wrong() -> None:
    """A solid that is too large, or too small, a vertex too far out, or inside out, and what is no closed ball."""
    inset = made(design_of("p4"))
    (mesh,) = inset.meshes
    middle = mesh.vertices[:, :2].mean(axis=0)

    def failures(other: InsetLoft) -> set[str]:
        return {sentence.split(" is ")[0] for sentence in prove_inset(other).failures}

    def scaled(by: float) -> Any:
        return np.column_stack((middle + (mesh.vertices[:, :2] - middle) * by, mesh.vertices[:, 2]))

    assert failures(inset) == set()
    assert failures(broken(inset, scaled(1.006))) >= {"nearer to the tile's edge", "neighbours apart"}
    assert failures(broken(inset, scaled(0.98))) == {"farther from the tile's edge"}
    assert failures(broken(inset, scaled(1.2))) >= {"points outside of the tile"}
    doubled = np.concatenate((mesh.triangles, mesh.triangles + len(mesh.vertices)))
    assert failures(broken(inset, np.concatenate((mesh.vertices, mesh.vertices)), doubled)) >= {"handles, drawn in"}


def test_what_stands_has_its_clearance_in_its_recipe() -> None:
    """It is made again from it bit for bit; the proof says how far neighbours are apart."""
    model = vt.stand(design_of("p4"), vt.SolidJob(clearance=0.2, chamfer=0.4))
    again = vt.stand(vt.Design.loads(model.recipe["design"]), vt.SolidJob(**json.loads(model.recipe["solid"])))
    assert (again.pieces[0].mesh.vertices == model.pieces[0].mesh.vertices).all()
    assert "neighbours at least 0.2" in model.proved
    assert all(figure["passed"] for figure in model.proof["figures"])
    assert {figure["name"] for figure in model.proof["figures"]} > {"neighbours apart", "approach"}


def test_a_picture_has_neighbours_of_other_colours() -> None:
    """Though they do not touch."""
    model = vt.stand(design_of("p4"), vt.SolidJob(clearance=0.3, chamfer=0.4), around=True)
    assert len(model.pieces) > 4
    assert model.pieces[0].colour not in {piece.colour for piece in model.pieces[1:]}


@pytest.mark.slow
@pytest.mark.parametrize("kind", range(len(KINDS)))
@pytest.mark.parametrize("group", vt.GROUPS)
def test_random_lofts_are_drawn_in_or_refused(group: str, kind: int) -> None:
    """Of all groups, proved and right by other libraries, or refused for what an erosion shows at that height."""
    design = random_solid(0, kind, group)
    try:
        loft = lofted(design, heights=(0.5, 19.5))
    except LoftError:
        return
    depth = InsetDepth(0.15, 0.5, 0.05, 20.0)
    try:
        inset = inset_loft(loft, depth)
    except vt.JobError as error:
        height = float(str(error).split("at the height ")[1].split(" mm")[0])
        parts = [(tile, eroded(tile, depth.at(height))) for tile in tiles_at(design, height)]
        counts = [(shapely.get_num_geometries(one), shapely.get_num_geometries(two)) for one, two in parts]
        assert any(one != two or right.is_empty for (one, two), (_, right) in zip(counts, parts, strict=True))
        return
    assert prove_inset(inset).failures == ()
    check_slices(inset, (0.01, 0.337, 0.62, 0.985), slack=2e-3)

"""Lofts: their proof in all groups, the judgement of others, what happens at special heights, and what is refused."""

from __future__ import annotations

import cmath
import dataclasses
from itertools import pairwise
from typing import Any

import manifold3d
import numpy as np
import pytest
import shapely
from helpers.random_solids import KINDS, random_solid

import voronoi_tiles as vt
from voronoi_tiles.solid.events import LoftError
from voronoi_tiles.solid.loft import Loft, lofted
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.motion import Motion
from voronoi_tiles.solid.solid_proof import prove_loft, proved_loft
from voronoi_tiles.vector.motion_codes import operation_of
from voronoi_tiles.vector.motions import Action, to_motion

CELLS: dict[str, Any] = {"p1": (40, 40, 80), "p2": (40, 35, 75)}
SEGMENT = vt.Site(vt.segment(5 + 3j, 14 + 8j), name="bird")

NARROW: dict[str, complex] = {"pmg": 4 + 10j, "p4m": 12 + 5j, "p4g": 8 + 3j, "p3m1": 14 + 3j, "p6m": 12 + 3j}
"""Where there is room between the mirrors of some groups, about this point."""


def design_of(group: str = "p4", sites: vt.Site | list[vt.Site] = SEGMENT, **motion: Any) -> vt.Design:
    """A design of a group with a small solid: a segment that turns by a quarter, where nothing else is said."""
    chosen = vt.GROUPS[group]
    cell = CELLS.get(group, 40 if chosen.fixes_b else (40, 50))
    motion = {"height": 20, "layers": 6, **(motion or {"turn": 90, "about": 9.5 + 5.5j})}
    return vt.Design(chosen, cell, sites, solid=vt.Solid(**motion))


def judged(mesh: TriangleMesh) -> Any:
    """The solid as manifold3d takes it: with 64 bits, and nothing merged."""
    return manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices, mesh.triangles.astype(np.uint64)))


def neighbours(loft: Loft, site: int) -> set[tuple[int, int]]:
    """All copies that the solid of a site ever has a wall with: numbers of sites and codes of motions."""
    layers = [layer for level in loft.levels for layer in level.layers]
    return {name for layer in layers for ring in layer.rings[site] for name in ring}


def overlap(loft: Loft, site: int) -> float:
    """What a solid has in common with those beside it, by manifold3d; relative to its volume, the most of all."""
    own = judged(loft.meshes[site])
    beside = [judged(loft.image(other, operation_of(code))) for other, code in neighbours(loft, site)]
    return max(float((own ^ other).volume()) for other in beside) / float(own.volume())


# --- right ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("group", vt.GROUPS)
def test_every_group_has_lofts(group: str) -> None:
    """A segment that turns by a quarter: proved, of the volume that is the tile's share of the slab, a closed ball."""
    design = design_of(group)
    if group in NARROW:
        at = NARROW[group]
        design = design_of(group, vt.Site(vt.segment(at - 1 - 1j, at + 2 + 1j)), turn=90, about=at)
    loft, proof = proved_loft(design)
    assert proof.passed
    (mesh,) = loft.meshes
    share = design.lattice.det * 20 / design.group.order
    assert abs(mesh.volume - share) <= 1e-12 * share
    solid = judged(mesh)
    assert solid.status() == manifold3d.Error.NoError
    assert solid.genus() == 0
    assert abs(solid.volume() - share) <= 1e-12 * share


@pytest.mark.parametrize("group", ["p2", "pgg", "p31m"])
def test_solids_do_not_overlap(group: str) -> None:
    """No two have more than rounding in common."""
    loft = lofted(design_of(group))
    assert len(neighbours(loft, 0)) >= 3
    assert overlap(loft, 0) <= 1e-9


def test_sections_are_the_tiles_of_the_strokes_there() -> None:
    """At an exact layer the vertices lie on the outline of a design that has the strokes of that height."""
    design = design_of()
    loft = lofted(design)
    (mesh,) = loft.meshes
    for z in (0.0, 8.0, 20.0):
        turn = cmath.rect(1, cmath.pi / 2 * z / 20)
        ends = [9.5 + 5.5j + turn * (end - 9.5 - 5.5j) for end in (5 + 3j, 14 + 8j)]
        tile = vt.Design("p4", 40, vt.Site(vt.segment(*ends))).tessellate()[0]
        ring = tile.to_shapely(accuracy=1e-9).exterior
        at = mesh.vertices[mesh.vertices[:, 2] == z][:, :2]
        assert len(at) > 20
        assert shapely.distance(shapely.points(at), ring).max() < 2e-9


def test_a_design_that_only_shifts_in_p1_is_a_sheared_prism() -> None:
    """All copies move alike: the top is the bottom, moved."""
    loft = lofted(design_of("p1", shift=(7, -3)))
    (mesh,) = loft.meshes
    low, high = (mesh.vertices[mesh.vertices[:, 2] == z][:, :2] for z in (0, 20))
    assert len(low) == len(high)
    moved = shapely.MultiPoint(low + np.array([7, -3]))
    assert shapely.hausdorff_distance(moved, shapely.MultiPoint(high)) < 1e-9


def test_copies_share_walls_bit_for_bit() -> None:
    """Where p3's copies meet about a centre, points are the same numbers in all of them."""
    loft = lofted(design_of("p3"))
    own, others = loft.meshes[0], [loft.image(0, operation_of(code)) for _, code in neighbours(loft, 0)]
    mine = set(map(tuple, own.vertices.tolist()))
    theirs = [point for mesh in others for point in map(tuple, mesh.vertices.tolist())]
    assert mine <= set(theirs)
    assert len([point for point in theirs if point in mine]) > len(mine)  # corners belong to three


def test_symmetric_sites_have_symmetric_places() -> None:
    """A cross on a centre of quarter turns: one copy a cell, whichever operation names it."""
    strokes = [vt.segment(-9, 9), vt.segment(-9j, 9j)]
    loft, proof = proved_loft(design_of("p4", vt.Site(strokes), turn=30))
    assert proof.passed
    (mesh,) = loft.meshes
    assert abs(mesh.volume - 1600 * 20) <= 1e-12 * 1600 * 20
    turned = loft.image(0, "-y,x")
    assert turned.vertices.tolist() == loft.image(0, "x,y").vertices.tolist()
    assert {tuple(point) for point in turned.vertices.tolist()} == {tuple(point) for point in mesh.vertices.tolist()}


def test_a_tile_with_a_hole_is_a_ring() -> None:
    """A closed site about another one: the tile has a hole all the way up, which the tile inside fills."""
    square = vt.Site(vt.polyline([4 + 4j, 14 + 4j, 14 + 14j, 4 + 14j], closed=True), name="ring")
    inside = vt.Site(vt.segment(7 + 9j, 11 + 9j), name="inside")
    loft, proof = proved_loft(design_of("p4", [square, inside], turn=40, about=9 + 9j))
    assert proof.passed
    assert [judged(mesh).genus() for mesh in loft.meshes] == [1, 0]
    assert overlap(loft, 1) <= 1e-9


def test_parts_that_touch_stay_apart() -> None:
    """A tile in two parts that meet along a line: a closed mesh, in which each part has vertices of its own there."""
    loft, proof = proved_loft(random_solid(26, 3))
    assert proof.passed
    (mesh,) = loft.meshes
    assert len(np.unique(mesh.vertices, axis=0)) < len(mesh.vertices)
    assert len(judged(mesh).decompose()) == 2


# --- events ---------------------------------------------------------------------------------------------------


def test_events_are_where_neighbours_change() -> None:
    """Between two levels nothing changes, at an event it does; what a slice just above and below has says so too."""
    design = design_of("p1", turn=90, about=9.5 + 5.5j, layers=11)
    loft, proof = proved_loft(design)
    assert proof.passed
    events = [level.core.z for level in loft.levels if level.lower is not None and level.upper is not None]
    assert events
    motion = Motion.of(design)

    def faced(z: float) -> set[str]:
        sites = [vt.Site([vt.polyline(line) for line in motion.points(z)])]
        outline = vt.Design("p1", (40, 40, 80), sites).tessellate()[0].outline
        return {str(operation) for _, operation in outline.neighbours}

    for z in events:
        assert faced(z - 1e-4) != faced(z + 1e-4)
    inner = [z for z in np.linspace(0, 20, 31).tolist() if min(abs(z - at) for at in events) > 1e-3]
    for low, high in pairwise(inner):
        crossed = any(low < at < high for at in events)
        assert (faced(low) != faced(high)) == crossed


def test_a_layer_in_which_four_tiles_meet_is_no_trouble() -> None:
    """A straight drawing at the bottom, where corners of four tiles are, and at a key: what leaves them is right."""
    straight, bent = vt.segment(6 + 10j, 14 + 10j), vt.segment(6 + 8j, 14 + 12j)
    keys = [vt.Key(8, bent), vt.Key(12, straight), vt.Key(20, bent)]
    loft, proof = proved_loft(design_of("pmm", vt.Site(straight), keys=keys))
    assert proof.passed
    loft, proof = proved_loft(design_of("p1", vt.Site(vt.point(0)), shift=(10, 0)))
    assert proof.passed
    square = vt.Design("p1", (40, 40, 90), [vt.Site(vt.point(0), name="a"), vt.Site(vt.point(20 + 20j), name="b")])
    keys = [vt.Key(20, vt.point(25 + 18j), site="b")]
    loft, proof = proved_loft(square.replace(solid=vt.Solid(20, layers=5, keys=keys)))
    assert proof.passed
    assert overlap(loft, 0) <= 1e-9


# --- refused --------------------------------------------------------------------------------------------------


def test_copies_that_meet_between_layers_are_found() -> None:
    """A segment sweeps over a centre of half turns half way between two layers, where it meets its image."""
    site, key = vt.Site(vt.segment(-0.6 + 4j, -0.6 + 9j)), vt.Key(20, vt.segment(0.6 - 9j, 0.6 - 4j))
    design = design_of("p2", site, keys=[key])
    with pytest.raises(LoftError) as caught:
        lofted(design)
    assert abs(caught.value.z - 10) < 1e-3
    motion, action = Motion.of(design), Action(design.group, design.lattice)

    def gap(z: float) -> float:
        (own,) = motion.points(z)
        other = action.apply(to_motion(vt.Operation.parse("-x,-y")), own)
        lines = (shapely.LineString(np.column_stack((line.real, line.imag))) for line in (own, other))
        return float(shapely.distance(*lines))

    assert gap(caught.value.z) < 1e-5
    assert "under -x,-y" in str(caught.value)
    assert all(gap(z) > 0.1 for z in motion.layers.tolist())  # no layer shows it


def test_copies_that_touch_in_a_layer_are_refused() -> None:
    """The height is named, and what touches."""
    with pytest.raises(LoftError, match=r'"bird" touches its own copy under -x,-y .* at the height 12\.') as caught:
        lofted(design_of("p2", keys=[vt.Key(12, vt.segment(-5, 4)), vt.Key(20, vt.segment(5 + 3j, 14 + 8j))]))
    assert caught.value.z == 12.0
    assert caught.value.exit_code == 2


def test_a_tile_that_falls_apart_is_refused() -> None:
    """Two strokes of a site are driven apart until another one's tile is between them."""
    pair = vt.Site([vt.segment(4 + 19j, 4 + 21j), vt.segment(10 + 19j, 10 + 21j)], name="pair")
    third = vt.Site(vt.segment(7 + 6j, 7 + 8j), name="third")
    keys = [
        vt.Key(20, [vt.segment(-2 + 19j, -2 + 21j), vt.segment(17 + 19j, 17 + 21j)], site="pair"),
        vt.Key(20, vt.segment(7 + 20j, 7 + 22j), site="third"),
    ]
    with pytest.raises(LoftError, match=r"parts of a tile meet, or come apart, at the height 15\.9"):
        lofted(design_of("p1", [pair, third], keys=keys))


def test_layers_are_where_they_are_asked_for() -> None:
    """Besides those of the design, each once, and there the tiles are the exact ones; none is outside of the solid."""
    design = design_of()
    asked = [0.37, 19.9, 20.0]
    loft = lofted(design, heights=asked)
    (mesh,) = loft.meshes
    assert {0.0, *asked} <= set(mesh.vertices[:, 2].tolist())
    assert prove_loft(loft).passed
    layers = [level.core.z for level in loft.levels]
    assert len(layers) == len(set(layers))
    for outside in (-0.1, 20.1, float("nan")):
        with pytest.raises(vt.ArgumentError, match="outside of the solid, which is 20 high"):
            lofted(design, heights=[outside])


def test_a_flat_design_has_no_loft() -> None:
    """It is said what to write."""
    with pytest.raises(vt.ArgumentError, match=r"the design is flat. Write \[solid\]"):
        lofted(vt.Design("p4", 40, SEGMENT))


# --- the proof ------------------------------------------------------------------------------------------------


def broken(loft: Loft, vertices: Any = None, triangles: Any = None) -> Loft:
    """A loft whose first mesh is another one."""
    mesh = loft.meshes[0]
    other = TriangleMesh(
        mesh.vertices if vertices is None else vertices, mesh.triangles if triangles is None else triangles
    )
    copy = dataclasses.replace(loft)
    copy.__dict__["meshes"] = (other, *loft.meshes[1:])
    return copy


def test_the_proof_sees_what_is_wrong() -> None:
    """A vertex that is moved, a triangle that is lost, or cut the other way, or a wall that is bent into itself."""
    loft = lofted(design_of())
    (mesh,) = loft.meshes
    assert prove_loft(loft).passed
    wall = int(np.flatnonzero((mesh.vertices[:, 2] > 0) & (mesh.vertices[:, 2] < 20))[0])

    def moved(by: float) -> Any:
        vertices = mesh.vertices.copy()
        vertices[wall, 0] += by
        return vertices

    slightly = prove_loft(broken(loft, moved(1e-8)))
    assert slightly.distance > 1e-12
    assert slightly.unshared > 0
    assert slightly.volume > 1e-13
    assert {sentence.split(" is ")[0] for sentence in slightly.failures} >= {"distance", "unshared triangles"}
    assert prove_loft(broken(loft, moved(30.0))).crossings > 0
    assert prove_loft(broken(loft, moved(0.3))).deviation > 0.1
    assert prove_loft(loft)._replace(deviation=float("nan")).failures == ("deviation is nan, the limit 0.05",)
    assert prove_loft(broken(loft, triangles=mesh.triangles[1:])).open_meshes == 1
    doubled = np.concatenate((mesh.triangles, mesh.triangles + len(mesh.vertices)))
    assert prove_loft(broken(loft, np.concatenate((mesh.vertices, mesh.vertices)), doubled)).handles == 1
    # Two triangles with a common side, cut along the other diagonal: as closed as before, and nobody else's.
    first = mesh.triangles[0]
    second = next(row for row in mesh.triangles[1:] if len(set(row.tolist()) & set(first.tolist())) == 2)
    (a,), (b,) = set(first.tolist()) - set(second.tolist()), set(second.tolist()) - set(first.tolist())
    k = first.tolist().index(a)
    c, d = first[(k + 1) % 3], first[(k + 2) % 3]
    rest = [row for row in mesh.triangles.tolist() if row not in (first.tolist(), second.tolist())]
    turned = prove_loft(broken(loft, triangles=np.array([*rest, [a, c, b], [b, d, a]])))
    assert turned.open_meshes == 0
    assert turned.unshared > 0


def test_there_are_more_layers_where_walls_would_cross() -> None:
    """Where walls may be off by much they would cross between the first two layers: one more is between."""
    design = random_solid(34, 4)
    assert design.solid is not None
    solid = vt.Solid(20, layers=2, turn=design.solid.turn, about=design.solid.about)
    loft, proof = proved_loft(design.replace(solid=solid), accuracy=2.0)
    assert proof.passed
    assert [level.core.z for level in loft.levels] == [0, 5, 10, 20]


def test_gentle_solids_have_few_layers() -> None:
    """What moves straight has those of the design, what turns has the more, the less it may be off."""
    straight = lofted(design_of("p1", shift=(7, -3), layers=3))
    assert [level.core.z for level in straight.levels] == [0, 10, 20]
    counts = [
        len(lofted(design_of(layers=2, turn=90, about=9.5 + 5.5j), accuracy=a).levels) for a in (0.5, 0.05, 0.005)
    ]
    assert counts[0] < counts[1] < counts[2]


def test_strokes_that_come_round_are_seen_on_their_way() -> None:
    """Two whole turns between the bottom and the top, which are alike, as half way up: there are layers between."""
    design = design_of("p1", layers=2, turn=720, about=9.5 + 5.5j)
    loft, proof = proved_loft(design)
    assert proof.passed
    still, _ = proved_loft(design_of("p1", layers=2, shift=(0, 0)))
    assert len(still.levels) == 2
    assert len(loft.levels) > 30


def test_keys_that_make_a_step_take_few_layers() -> None:
    """Two keys next to each other: strokes are fast between them, and there alone layers are put for that."""
    low, high = (vt.Key(z, vt.segment(5 + 3j, end)) for z, end in ((10, 14 + 8j), (10.01, 4 + 22j)))
    loft, proof = proved_loft(design_of("p1", height=20, layers=2, keys=[low, high]))
    assert proof.passed
    assert len(loft.motion.layers) < 10
    fast = (loft.motion.layers > 10) & (loft.motion.layers < 10.01)
    assert fast.any()


def test_what_cannot_be_reached_is_refused() -> None:
    """With what to do: an accuracy that takes too many triangles. Layers are a key of the design, and no option."""
    text = r"more than 250,000 triangles. Give a coarser accuracy, fewer layers in \[solid\]"
    with pytest.raises(vt.ArgumentError, match=text) as caught:
        lofted(design_of(), accuracy=1e-5)
    assert caught.value.exit_code == 2


@pytest.mark.slow
@pytest.mark.parametrize("kind", range(len(KINDS)))
def test_random_solids_are_right_or_refused(kind: int) -> None:
    """Proved and apart, or refused for a reason that shapely sees at the height that is named."""
    made, refused = 0, []
    for seed in range(12):
        design = random_solid(seed, kind)
        try:
            loft, proof = proved_loft(design)
        except LoftError as error:
            refused.append((design, error))
            continue
        made += 1
        assert proof.passed
        if seed % 6 == 0:
            assert max(overlap(loft, site) for site in range(len(loft.meshes))) <= 1e-9
    assert made > 2
    for design, why in refused:
        assert least_gap(design, why.z) < 1e-4 or " tile " in str(why)


@pytest.mark.slow
@pytest.mark.parametrize("group", vt.GROUPS)
def test_planted_collisions_are_all_found(group: str) -> None:
    """A short stroke is moved through the middle of another one, at a height at which there is no layer."""
    chosen = vt.GROUPS[group]
    for seed in range(4):
        rng = np.random.default_rng(seed)
        design = design_of(group)
        at = complex(rng.random() * design.lattice.a + rng.random() * design.lattice.b)
        along, speed = 3 * cmath.rect(rng.random(), rng.uniform(0, 6)), cmath.rect(0.1, rng.uniform(0, 6))
        low = at - rng.uniform(1, 19) * speed
        high = low + 20 * speed
        site = vt.Site(vt.segment(at - along, at + 0.7 * along), name="struck")
        across = 0.02j * along
        moving = vt.Site(vt.segment(low - across, low + across), name="moving")
        key = vt.Key(20, vt.segment(high - across, high + across), site="moving")
        planted = vt.Design(chosen, design.cell, [site, moving], solid=vt.Solid(20, layers=7, keys=[key]))
        with pytest.raises(LoftError):
            lofted(planted)


def least_gap(design: vt.Design, z: float) -> float:
    """How near two copies are to each other at a height, by brute force over 7 x 7 cells; 1 where they are farther."""
    action, drawn = Action(design.group, design.lattice), Motion.of(design).at(z)

    def lines(ends: Any) -> Any:
        return shapely.MultiLineString(np.stack((ends.real, ends.imag), axis=-1).tolist())

    images = [action.apply(own, site.ends.ravel()).reshape(-1, 2) for site in drawn for own in action.motions]
    steps = [i * design.lattice.a + j * design.lattice.b for i in range(-3, 4) for j in range(-3, 4)]
    tree = shapely.STRtree([lines(image + step) for image in images for step in steps])
    gaps = []
    for own in (lines(site.ends) for site in drawn):
        near = tree.geometries[tree.query(own, predicate="dwithin", distance=1.0)]
        gaps += [own.distance(other) for other in near if own.hausdorff_distance(other) > 1e-6]
    return min(gaps, default=1.0)

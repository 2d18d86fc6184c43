"""Properties of the tiles, over random designs in all groups and of all kinds of strokes."""

from __future__ import annotations

import cmath
import math
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers import brute, fuzz, strategies
from helpers.designs import tampered
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.vector import tessellation
from voronoi_tiles.vector.outline import Outline

Complexes = NDArray[np.complex128]

MANY = settings(
    max_examples=60,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large],
)
FEW = settings(MANY, max_examples=25)
SMALL = strategies.designs("plain", "grid", "polygon", "special", "points", "several")

ROTATABLE = st.sampled_from(["p1", "p2", "pmm", "pgg", "cmm"]).flatmap(
    lambda group: strategies.designs("plain", "grid", "points", "several", group=group)
)


def tile(design: dict[str, Any] | Design) -> Tiling:
    """Tile a design; one whose copies touch is no example."""
    read = design if isinstance(design, Design) else Design.from_dict(design)
    try:
        return read.tessellate()
    except TouchingCopiesError:
        assume(False)
        raise


def size(design: Design) -> float:
    """The cell's longer side."""
    return max(abs(design.lattice.a), abs(design.lattice.b))


def one(group: str, *strokes: dict[str, Any], **cell: float) -> dict[str, Any]:
    """A design of one site in a cell of 60."""
    return {"schema": 1, "group": group, "cell": {"a": 60.0, **cell}, "site": [{"strokes": list(strokes)}]}


def moved(design: Design, change: Callable[[Complexes], Complexes], **others: Any) -> Design:
    """A design with all sites mapped, and whatever else changes with them."""
    sites = tuple(NodedSite(site.name, change(site.nodes), site.segments) for site in design.noded)
    return tampered(design, noded=sites, **others)


def marks(outline: Outline, least: float) -> Complexes:
    """Start, middle and end of each arc longer than `least`, as rows; a line's ends in order of their coordinates."""
    middle = (outline.start + 2 * outline.control + outline.end) / 4
    rows = np.stack([outline.start, middle, outline.end], axis=1)
    return rows[outline.lengths > least]


def assert_same(one: Outline, other: Outline, unit: float) -> None:
    """Assert that two outlines, of a cell of side `unit`, have the same edges up to rounding, in whatever order.

    Edges that are nearly nothing may be missing from one of them: where more than three copies meet.
    """
    assert one.area == pytest.approx(other.area, abs=1e-11 * unit**2)
    for mine, theirs in ((marks(one, 1e-4 * unit), marks(other, 0.0)), (marks(other, 1e-4 * unit), marks(one, 0.0))):
        both = np.concatenate([theirs, theirs[:, ::-1]])
        for row in mine:
            assert np.abs(both - row).max(axis=1).min() <= 1e-8 * unit


# --- what every tile must satisfy ---------------------------------------------------------------------------


@settings(MANY, max_examples=50)  # those of `make fuzz` are 500 more
@given(design=strategies.designs(), seed=st.integers(0, 99))
def test_tiles_are_right_or_refused_with_reason(design: dict[str, Any], seed: int) -> None:
    """The proof passes and the brute-force oracle agrees, or copies truly touch where the error says."""
    assert fuzz.try_design(design, np.random.default_rng(seed), points=30) in {"tiled", "refused"}


@pytest.mark.parametrize("group", list(GROUPS))
def test_every_group(group: str) -> None:
    """In each group a site in general position has as many copies as the group has operations, and shares the cell."""
    rng = np.random.default_rng(12)
    for _ in range(4):
        canvas = strategies.canvas(strategies.Dice(rng), group)
        ends = canvas.spot(strategies.Dice(rng)), canvas.spot(strategies.Dice(rng))
        design = {"schema": 1, "group": group, "cell": canvas.cell, "site": [{"strokes": [strategies.segment(*ends)]}]}
        tiling = tile(design)
        assert tiling.proof.passed
        assert tiling.tiles[0].copies_per_cell == GROUPS[group].order
        assert tiling.tiles[0].area == pytest.approx(canvas.lattice.det / GROUPS[group].order, rel=1e-12)
        assert brute.complaints(tiling.document(), rng, points=100, edges=100) == []


@FEW
@given(design=strategies.designs("long", "dense"))
def test_fine_curves(design: dict[str, Any]) -> None:
    """Sites of up to 200 segments."""
    assume(sum(len(stroke.get("polyline", ())) for site in design["site"] for stroke in site["strokes"]) <= 201)
    assert fuzz.try_design(design, np.random.default_rng(1), points=10) in {"tiled", "refused"}


@FEW
@given(design=SMALL)
def test_areas_fill_the_cell(design: dict[str, Any]) -> None:
    """The tiles' areas times their copies per cell make the cell."""
    tiling = tile(design)
    total = math.fsum(part.area * part.copies_per_cell for part in tiling.tiles)
    assert total == pytest.approx(tiling.design.lattice.det, rel=1e-12)


def bits(*columns: Complexes) -> set[tuple[complex, ...]]:
    """Rows of numbers."""
    return set(zip(*(column.tolist() for column in columns), strict=True))


@MANY
@given(design=strategies.designs())
def test_neighbours_share_edges_bit_for_bit(design: dict[str, Any]) -> None:
    """The copy beyond each edge has the same edge, reversed, and names this tile as its neighbour there."""
    tiling = tile(design)
    tiles = {part.site.name: part for part in tiling.tiles}
    for part in tiling.tiles:
        outline = part.outline
        for number, (name, operation) in enumerate(outline.neighbours):
            chosen = outline.neighbour == number
            beyond = tiles[name].copy(operation)
            mine = bits(outline.start[chosen], outline.control[chosen], outline.end[chosen])
            assert mine <= bits(beyond.end, beyond.control, beyond.start)
            itself = [k for k, other in enumerate(beyond.neighbours) if other.site == part.site.name]
            itself = [k for k in itself if beyond.neighbours[k].operation in part.symmetry]
            shared = np.isin(beyond.neighbour, itself)
            assert mine == bits(beyond.end[shared], beyond.control[shared], beyond.start[shared])


@FEW
@given(design=SMALL)
def test_copies_are_images(design: dict[str, Any]) -> None:
    """A tile's copy is its image, and the identity's copy is the tile itself, bit for bit."""
    tiling = tile(design)
    lattice = tiling.design.lattice
    for part in tiling.tiles:
        assert bits(part.copy(Operation.parse("x,y")).start) == bits(part.outline.start)
        for operation in tiling.design.group.operations:
            shifted = operation.translated(2, -1)
            image = part.outline.transformed(lattice.isometry(shifted))
            assert_same(part.copy(shifted), image, size(tiling.design))
            assert [area > 0 for area in image.ring_areas] == [area > 0 for area in part.copy(shifted).ring_areas]


@FEW
@given(design=strategies.designs("special", "nearly special", "polygon", "points", "grid"))
def test_symmetry(design: dict[str, Any]) -> None:
    """The symmetries are those that brute force finds: they map the site onto itself, and so the tile."""
    tiling = tile(design)
    plane = brute.Plane.of(tiling.document())
    for number, part in enumerate(tiling.tiles):
        expected = plane.symmetries(number)
        assert part.symmetry[0].is_identity
        assert {brute.read_operation(plane.group, str(operation)) for operation in part.symmetry} == set(expected)
        assert part.copies_per_cell * len(expected) == tiling.design.group.order
        for operation in part.symmetry:
            assert bits(part.copy(operation).start) == bits(part.outline.start)
            image = part.outline.transformed(tiling.design.lattice.isometry(operation))
            assert_same(image, part.outline, size(tiling.design))


# --- the same design in other words -------------------------------------------------------------------------


@FEW
@given(design=SMALL, i=st.integers(-30, 30), j=st.integers(-30, 30))
def test_translated_by_the_lattice(design: dict[str, Any], i: int, j: int) -> None:
    """All sites moved by a lattice vector: the tiles move with them."""
    tiling = tile(design)
    shift = tiling.design.lattice.cartesian(i, j)
    for before, after in zip(tiling.tiles, tile(moved(tiling.design, lambda z: z + shift)).tiles, strict=True):
        assert_same(before.outline.transformed(Isometry(1 + 0j, shift, False)), after.outline, size(tiling.design))
        assert before.copies_per_cell == after.copies_per_cell


@FEW
@given(design=SMALL, choice=st.integers(0, 11))
def test_given_through_an_equivalent_site(design: dict[str, Any], choice: int) -> None:
    """The first site replaced by an image of it: its tile is the image of the tile, the others stay."""
    tiling = tile(design)
    operations = tiling.design.group.operations
    isometry = tiling.design.lattice.isometry(operations[choice % len(operations)].translated(1, -2))
    first, *rest = tiling.design.noded
    image = NodedSite(first.name, isometry(first.nodes), first.segments)
    other = tile(tampered(tiling.design, noded=(image, *rest)))
    assert_same(tiling.tiles[0].outline.transformed(isometry), other.tiles[0].outline, size(tiling.design))
    for before, after in zip(tiling.tiles[1:], other.tiles[1:], strict=True):
        assert_same(before.outline, after.outline, size(tiling.design))


@FEW
@given(design=SMALL, exponent=st.integers(-20, 20))
def test_scaled_by_a_power_of_two(design: dict[str, Any], exponent: int) -> None:
    """Every number is scaled, without rounding: the result is the same bits."""
    tiling = tile(design)
    factor, lattice = 2.0**exponent, tiling.design.lattice
    scaled = Lattice(lattice.a * factor, lattice.b * factor)
    other = tile(moved(tiling.design, lambda z: z * factor, lattice=scaled))
    for before, after in zip(tiling.tiles, other.tiles, strict=True):
        assert (before.outline.start * factor).tolist() == after.outline.start.tolist()
        assert (before.outline.control * factor).tolist() == after.outline.control.tolist()
        assert before.outline.neighbours == after.outline.neighbours


@FEW
@given(design=SMALL, exponent=st.floats(-3, 3))
def test_scaled_by_any_factor(design: dict[str, Any], exponent: float) -> None:
    """The tile is scaled."""
    tiling = tile(design)
    factor, lattice = 10.0**exponent, tiling.design.lattice
    scaled = Lattice(lattice.a * factor, lattice.b * factor)
    other = tile(moved(tiling.design, lambda z: z * factor, lattice=scaled))
    for before, after in zip(tiling.tiles, other.tiles, strict=True):
        outline = before.outline
        image = replace(
            outline, start=outline.start * factor, control=outline.control * factor, end=outline.end * factor
        )
        assert_same(image, after.outline, size(tiling.design) * factor)


@FEW
@given(design=SMALL)
def test_mirrored(design: dict[str, Any]) -> None:
    """The plane turned over about the x axis: every group stays, an oblique cell becomes its mirror image."""
    tiling = tile(design)
    lattice = tiling.design.lattice
    if tiling.design.group.system == "oblique":
        lattice = Lattice(lattice.a, -lattice.b.conjugate())
    other = tile(moved(tiling.design, np.conj, lattice=lattice))
    for before, after in zip(tiling.tiles, other.tiles, strict=True):
        assert_same(before.outline.transformed(Isometry(1 + 0j, 0j, True)), after.outline, size(tiling.design))


@FEW
@given(design=ROTATABLE)
def test_rotated(design: dict[str, Any]) -> None:
    """The cell's sides exchanged by a rotation that brings b to the x axis."""
    tiling = tile(design)
    lattice = tiling.design.lattice
    turn = lattice.b.conjugate() / abs(lattice.b)
    rotated = Lattice(complex(abs(lattice.b)), -lattice.a * turn)
    if tiling.design.group.fixed_angle:
        rotated = Lattice(rotated.a, complex(0, rotated.b.imag))
    other = tile(moved(tiling.design, lambda z: z * turn, lattice=rotated))
    for before, after in zip(tiling.tiles, other.tiles, strict=True):
        outline = before.outline
        image = replace(outline, start=outline.start * turn, control=outline.control * turn, end=outline.end * turn)
        assert_same(image, after.outline, size(tiling.design))


@FEW
@given(design=strategies.designs("plain", "grid", "points", "several", group="p2"), skew=st.integers(-4, 4))
def test_another_basis(design: dict[str, Any], skew: int) -> None:
    """The same lattice given by a skew cell gives the same tiles."""
    tiling = tile(design)
    lattice = tiling.design.lattice
    other = tile(tampered(tiling.design, lattice=Lattice(lattice.a, lattice.b + skew * lattice.a)))
    for before, after in zip(tiling.tiles, other.tiles, strict=True):
        assert_same(before.outline, after.outline, size(other.design))


# --- ordinary Voronoi diagrams ------------------------------------------------------------------------------


def voronoi_cell(points: Sequence[complex], seed: complex) -> Complexes:
    """The corners of the cell of the point nearest to `seed` in scipy's Voronoi diagram, counter-clockwise."""
    from scipy.spatial import Voronoi

    z = np.array(points)
    diagram = Voronoi(np.stack([z.real, z.imag], axis=1))
    home = int(np.abs(z - seed).argmin())
    corners = diagram.vertices[diagram.regions[diagram.point_region[home]]] @ [1, 1j]
    return np.asarray(corners[np.argsort(np.angle(corners - z[home]))])


@pytest.mark.parametrize(
    "cell", [(60, 60, 90), (60, 60, 60), (60, 40, 75), (60, 90, 117), (60, 200, 40), (60, 30, 172)]
)
def test_a_point_in_p1_has_the_lattice_s_voronoi_cell(cell: tuple[float, float, float]) -> None:
    """A hexagon, or a rectangle: as scipy has it."""
    a, b, angle = cell
    tiling = tile(one("p1", {"point": [7.5, -3.25]}, a=a, b=b, angle=angle))
    lattice = tiling.design.lattice
    points = [7.5 - 3.25j + lattice.cartesian(i, j) for i in range(-14, 15) for j in range(-9, 10)]
    corners = voronoi_cell(points, 7.5 - 3.25j)
    outline = tiling.tiles[0].outline
    assert not outline.curved.any()
    for z in corners:
        assert np.abs(outline.start - z).min() < 1e-9
    for z in outline.start:
        assert np.abs(corners - z).min() < 1e-9
    assert tiling.tiles[0].area == pytest.approx(lattice.det, rel=1e-14)


@pytest.mark.parametrize("group", list(GROUPS))
def test_a_point_in_any_group(group: str) -> None:
    """A single point in general position: its cell among all its images."""
    dice = strategies.Dice(np.random.default_rng(8))
    canvas = strategies.canvas(dice, group)
    z = canvas.spot(dice, 0.8)
    tiling = tile(
        {"schema": 1, "group": group, "cell": canvas.cell, "site": [{"strokes": [{"point": strategies.xy(z)}]}]}
    )
    operations = GROUPS[group].operations
    images = [
        canvas.lattice.isometry(g.translated(i, j))(z) for g in operations for i in range(-4, 5) for j in range(-4, 5)
    ]
    corners = voronoi_cell(images, z)
    outline = tiling.tiles[0].outline
    assert not outline.curved.any()
    assert all(np.abs(outline.start - corner).min() < 1e-8 for corner in corners)
    assert all(np.abs(corners - corner).min() < 1e-8 for corner in outline.start)


# --- special cases ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("group", "place", "order"),
    [
        ("p2", [0, 0], 2),
        ("p2", [30, 0], 2),
        ("pm", [0, 7], 2),
        ("cm", [0, 7], 2),
        ("pmm", [30, 0], 4),
        ("pmg", [0, 0], 2),
        ("pmg", [15, 4], 2),
        ("pgg", [30, 0], 2),
        ("cmm", [0, 0], 4),
        ("cmm", [15, 15], 2),
        ("p4", [30, 30], 4),
        ("p4", [30, 0], 2),
        ("p4m", [0, 0], 8),
        ("p4m", [30, 0], 4),
        ("p4m", [7, 7], 2),
        ("p4g", [0, 0], 4),
        ("p4g", [30, 0], 4),
        ("p3", [0, 0], 3),
        ("p3", [30, 60 * math.sqrt(3) / 6], 3),
        ("p3m1", [0, 0], 6),
        ("p3m1", [30, 60 * math.sqrt(3) / 6], 6),
        ("p31m", [0, 0], 6),
        ("p31m", [30, 60 * math.sqrt(3) / 6], 3),
        ("p6", [0, 0], 6),
        ("p6", [30, 60 * math.sqrt(3) / 6], 3),
        ("p6", [30, 0], 2),
        ("p6m", [0, 0], 12),
        ("p6m", [30, 60 * math.sqrt(3) / 6], 6),
        ("p6m", [30, 0], 4),
        ("p6m", [9, 0], 2),
    ],
)
@pytest.mark.parametrize("shape", ["point", "circle"])
def test_special_positions(group: str, place: list[float], order: int, shape: str) -> None:
    """A point or a circle on a centre or a mirror has that many symmetries."""
    stroke = {"point": place} if shape == "point" else {"circle": place, "radius": 3}
    kind = GROUPS[group]
    cell = {} if kind.fixes_b else {"b": 60.0}
    if kind.fixed_angle is None:
        cell["angle"] = 90.0
    tiling = tile(one(group, stroke, **cell))
    (part,) = tiling.tiles
    assert len(part.symmetry) == order
    assert part.copies_per_cell == kind.order // order
    assert part.area == pytest.approx(tiling.design.lattice.det * order / kind.order, rel=1e-12)


@pytest.mark.parametrize(
    ("group", "place", "order"),
    [
        ("p2", [30, 30], 2),
        ("pmg", [30, 0], 2),
        ("pgg", [30, 0], 2),
        ("pmm", [30, 0], 4),
        ("cmm", [15, 15], 2),
        ("p4", [30, 30], 4),
        ("p4", [30, 0], 2),
        ("p4m", [30, 30], 8),
        ("p4g", [0, 0], 4),
        ("p3", [30, 60 * math.sqrt(3) / 6], 3),
        ("p31m", [0, 0], 6),
        ("p31m", [30, 60 * math.sqrt(3) / 6], 3),
        ("p6", [0, 0], 6),
        ("p6", [30, 60 * math.sqrt(3) / 6], 3),
        ("p6m", [0, 0], 12),
    ],
)
@pytest.mark.parametrize("count", [2, 3])
def test_sites_around_a_centre(group: str, place: list[float], order: int, count: int) -> None:
    """Their tiles meet in it, and share its bits, whether an operation leads from one to the next or none is needed."""
    cell = {} if GROUPS[group].fixes_b else {"b": 60.0}
    if GROUPS[group].fixed_angle is None:
        cell["angle"] = 90.0
    for turn in np.linspace(0.0, 1.0, 7)[1:-1]:
        # All in the domain of one copy, as far from the centre.
        offsets = 4 * np.exp(2j * np.pi / order * (turn + np.arange(count)) / count)
        sites = [{"strokes": [{"point": [place[0] + z.real, place[1] + z.imag]}]} for z in offsets]
        design = {"schema": 1, "group": group, "cell": {"a": 60.0, **cell}, "site": sites}
        tiling = Design.from_dict(design).tessellate()
        assert tiling.proof.passed
        for part in tiling.tiles:
            assert np.abs(part.outline.start - complex(*place)).min() < 1e-12


def test_a_hole() -> None:
    """A site inside a closed curve has its tile in a hole of the other's; the two share that ring."""
    design = one("p4", {"circle": [15, 15], "radius": 9})
    design["site"].append({"name": "core", "strokes": [{"segment": [[12, 14], [17, 16]]}]})
    ring, core = tile(design).tiles
    assert [area > 0 for area in ring.outline.ring_areas] == [True, False]
    assert [area > 0 for area in core.outline.ring_areas] == [True]
    assert -ring.outline.ring_areas[1] == pytest.approx(core.area, rel=1e-14)
    assert ring.area + core.area == pytest.approx(900.0, rel=1e-12)
    hole = slice(*ring.outline.ring_offsets[1:].tolist())
    outline = core.outline
    assert bits(ring.outline.start[hole], ring.outline.end[hole]) == bits(outline.end, outline.start)
    assert {neighbour.site for neighbour in outline.neighbours} == {"site1"}


def test_an_empty_closed_curve_has_no_hole() -> None:
    """What a closed curve encloses is its own."""
    (part,) = tile(one("p6", {"circle": [20, 8], "radius": 5})).tiles
    assert len(part.outline.ring_areas) == 1


def test_the_distance_of_a_far_site_does_not_matter() -> None:
    """A site thousands of cells away has the tile of the near one."""
    near = tile(one("p6", {"segment": [[8, 3], [23, 7]]}))
    shift = near.design.lattice.cartesian(3000, -4000)
    far = tile(one("p6", {"segment": [[8, 3], [23, 7]], "translate": strategies.xy(shift)}))
    image = near.tiles[0].outline.transformed(Isometry(1 + 0j, shift, False))
    assert_same(image, far.tiles[0].outline, 60.0)


@pytest.mark.parametrize(
    ("group", "stroke", "order"),
    [
        ("p3", {"circle": [30, 60 * math.sqrt(3) / 6], "radius": 3}, 3),
        ("p3m1", {"segment": [[7.5, 17.5 * math.sqrt(3)], [22.5, 12.5 * math.sqrt(3)]]}, 2),
        ("p6m", {"circle": [0, 0], "radius": 7}, 12),
    ],
)
def test_a_far_site_is_as_symmetric_as_the_near_one(group: str, stroke: dict[str, Any], order: int) -> None:
    """Where coordinates are thousands of times coarser than near the origin, and images are off by as much."""
    near = Design.from_dict(one(group, stroke)).tessellate()
    for i, j in ((-2886, 4692), (317, 12345), (700001, -299993)):
        shift = near.design.lattice.cartesian(i, j)
        far = Design.from_dict(one(group, {**stroke, "translate": strategies.xy(shift)})).tessellate()
        assert len(far.tiles[0].symmetry) == len(near.tiles[0].symmetry) == order
        image = near.tiles[0].outline.transformed(Isometry(1 + 0j, shift, False))
        np.testing.assert_allclose(far.tiles[0].outline.bounds, image.bounds, rtol=1e-14, atol=0)


# --- copies that touch --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("design", "operations", "place"),
    [
        (one("p1", {"segment": [[3, 4], [63, 4]]}, b=50.0, angle=80.0), {"x+1,y", "x-1,y"}, None),
        (one("p1", {"segment": [[0, 0], [60, 120]]}, b=60.0, angle=90.0), {"x+1,y+2", "x-1,y-2"}, None),
        (one("p2", {"segment": [[0, 0], [25, 4]]}, b=50.0, angle=80.0), {"-x,-y"}, 0j),
        (one("p2", {"segment": [[30, 0], [40, 14]]}, b=50.0, angle=90.0), {"-x+1,-y"}, 30 + 0j),
        (one("pm", {"segment": [[-4, 5], [4, 7]]}, b=50.0), {"-x,y"}, 6j),
        (one("pm", {"segment": [[-4, 5], [4, 5]]}, {"point": [9, 9]}, b=50.0), {"-x,y"}, None),
        (one("pm", {"segment": [[30, 9], [44, 5]]}, b=50.0), {"-x+1,y"}, 30 + 9j),
        (one("p4", {"segment": [[30, 30], [20, 11]]}), {"-x+1,-y+1", "-y+1,x", "y,-x+1"}, 30 + 30j),
        (one("p3", {"polyline": [[4, -2], [0, 0], [5, 8]]}), {"-y,x-y", "-x+y,-x"}, 0j),
        (one("p6m", {"circle": [14, 0], "radius": 16}), None, None),
    ],
)
def test_touching_copies_are_refused(
    design: dict[str, Any], operations: set[str] | None, place: complex | None
) -> None:
    """The error names sites, operation and place; brute force finds both copies there."""
    read = Design.from_dict(design)
    with pytest.raises(TouchingCopiesError) as caught:
        read.tessellate()
    error = caught.value
    assert (error.site, error.other) == ("site1", "site1")
    assert operations is None or str(error.operation) in operations
    assert place is None or error.place == pytest.approx(place, abs=1e-9)
    assert fuzz._refusal(read, error) == "refused"


def test_two_sites_that_touch_are_refused() -> None:
    """The error names both."""
    design = one("p2", {"segment": [[3, 4], [20, 9]]}, b=60.0, angle=90.0)
    design["site"] += [{"name": "far", "strokes": [{"point": [40, 50]}]}]
    design["site"] += [{"name": "pin", "strokes": [{"segment": [[63, 64], [70, 60]]}]}]
    with pytest.raises(TouchingCopiesError) as caught:
        Design.from_dict(design).tessellate()
    assert {caught.value.site, caught.value.other} == {"site1", "pin"}
    assert fuzz._refusal(Design.from_dict(design), caught.value) == "refused"


@pytest.mark.parametrize("gap", [1e-3, 1e-5, 1e-7, 1e-9, 1e-10])
@pytest.mark.parametrize("group", list(GROUPS))
def test_nearly_touching_copies_are_tiled(group: str, gap: float) -> None:
    """A stroke may end as near to a centre, a mirror or its own copy as one likes."""
    dice = strategies.Dice(np.random.default_rng(21))
    canvas = strategies.canvas(dice, group)
    first = canvas.corners()[0] + gap * canvas.size * cmath.rect(
        1.0, cmath.phase(canvas.centre() - canvas.corners()[0])
    )
    design = {"schema": 1, "group": group, "cell": canvas.cell}
    design["site"] = [{"strokes": [strategies.segment(first, canvas.centre())]}]
    assert fuzz.try_design(design, np.random.default_rng(2), points=50) == "tiled"


@pytest.mark.parametrize("group", ["p4g", "p31m"])
@pytest.mark.parametrize("seed", [0, 8])
def test_strokes_beside_a_mirror_are_tiled(group: str, seed: int) -> None:
    """Four copies meet on a mirror, of which two nearly touch: rounding makes an edge there that is none.

    The corner that it leaves behind lies on the two edges that are left, or these were off by as much.
    """
    assert tiled("beside a mirror", 12, seed=seed, group=group) > 3


@pytest.mark.parametrize("group", ["p3m1", "p6m", "p4m"])
def test_nearly_symmetric_sites_beside_mirrors_are_tiled(group: str) -> None:
    """Where what meets nearly touches in pairs, rounding makes long edges that the tile beyond does not have."""
    assert tiled("mirror twins", 16, seed=1, group=group) > 8


@pytest.mark.parametrize(
    "sites",
    [
        [
            [{"segment": [[-2.250347247861652, -3.8977157700841665], [-0.5995184591362301, -8.693747900792049]]}],
            [{"point": [3.302897348276513, 5.720786018525349]}],
        ],
        [
            [{"segment": [[-5.556507305516682, 2.665056702518272e-09], [-2.0020574138455163, 2.665056702518272e-09]]}],
            [{"segment": [[-13.682251819313725, 23.69835530839312], [-15.528743044996707, 22.63228310218877]]}],
        ],
        [
            [
                {"point": [-11.989617640934181, 20.76662691162449]},
                {"segment": [[13.480344969866357, 23.348642441571435], [8.54669483365831, 26.197086675798584]]},
                {"point": [-7.696646691509682, -13.330983083306428]},
            ]
        ],
    ],
    ids=["segment and point", "two segments", "one site"],
)
def test_strokes_that_all_but_touch_two_mirrors_are_tiled(sites: list[list[dict[str, Any]]]) -> None:
    """On a mirror that far from a stroke a vertex is known badly: put there, it is on the curve that crosses it.

    Along its tangent alone it would leave the curve, by the square of the way.
    """
    cell: dict[str, Any] = {"schema": 1, "group": "p31m", "cell": {"a": 60.0}}
    assert Design.from_dict(cell | {"site": [{"strokes": site} for site in sites]}).tessellate().proof.passed


@pytest.mark.slow
@pytest.mark.parametrize("kind", list(strategies.LATER))
def test_later_kinds_of_designs_are_tiled(kind: str) -> None:
    """Many of each kind."""
    assert tiled(kind, 100, seed=22) > 10


def tiled(kind: str, count: int, *, seed: int, group: str | None = None) -> int:
    """Tile so many designs of a kind, and give the number of those whose copies do not touch: all of them pass."""
    passed = 0
    for number in range(count):
        design = strategies.make_design(strategies.Dice(np.random.default_rng([seed, number])), kind, group)[1]
        try:
            passed += Design.from_dict(design).tessellate().proof.passed
        except TouchingCopiesError:
            continue
    return passed


# What the fuzz has found.
FOUND = {
    "two sites in p1": one("p1", {"point": [0, 0]}, b=60.0, angle=90.0)
    | {"site": [{"strokes": [{"point": [0, 0]}]}, {"strokes": [{"point": [24, 30]}]}]},
    "bite and island at a mirror": one(
        "pmg",
        *(
            {"point": p}
            for p in (
                [45.84567147554496, 18.375],
                [36.625, 20.84567147554496],
                [34.15432852445504, 11.625],
                [43.375, 9.154328524455039],
            )
        ),
        b=60.0,
    ),
    "crossing strokes on a grid": one(
        "cmm", {"segment": [[5, 20], [10, 20]]}, {"segment": [[5, 10], [10, 25]]}, b=60.0
    ),
    "a polyline that crosses itself": one(
        "pg", {"polyline": [[39, 28], [19, 8], [16, 13], [52, 15]], "closed": True}, b=60.0
    ),
    "strokes that overlap": one(
        "pmg",
        {"segment": [[10, 30], [10, 10]]},
        {"polyline": [[10, 15], [10, 35], [5, 35]], "closed": True},
        {"point": [10, 20]},
        b=60.0,
    ),
    "a point and a stroke": one("pgg", {"point": [0, 15]}, {"segment": [[15, 22.5], [7.5, 15]]}, b=60.0),
    "two points close together": one(
        "p4", {"point": [22.47240175417337, 13.949879640957256]}, {"point": [22.47240181417337, 13.949879640957256]}
    ),
    "close parallels": one(
        "p2",
        {"segment": [[38.7945744650632, 22.95344270281913], [41.83548481882486, 30.97646258249093]]},
        {"segment": [[38.79457366276121, 22.953443006910167], [41.83548401644264, 30.976462886612374]]},
        b=60.0,
        angle=60.0,
    ),
    "a segment beside a centre": one(
        "cmm", {"segment": [[12.754479401359138, 25.422749573159372], [17.245520611875396, 4.577250485362822]]}, b=60.0
    ),
    "a point across a mirror, beside the image of a stroke": one(
        "pm", {"segment": [[0.5, 10], [7, 19]]}, {"point": [-2.5, 14]}, b=60.0
    ),
    "the same where mirrors cross": one("p4m", {"segment": [[10, -0.5], [19, -7]]}, {"point": [14, 2.5]}),
    "the same, on a diagonal": one("p4m", {"segment": [[11.4, 11.3], [10.5, 3.2]]}, {"point": [9, 11]}),
    "six rays": one(
        "pm",
        *(
            {"segment": s}
            for s in (
                [[31.842082962162237, 31.559270635665712], [38.045308510308715, 34.22056595915442]],
                [[21.02935869978787, 39.642277132375995], [21.826222116747164, 46.345075704219845]],
                [[8.62290760349492, 34.31968648539859], [3.216545472307738, 38.36118973375374]],
                [[7.02918076957633, 20.914089341710888], [0.8259552214298536, 18.252794018222183]],
                [[17.841905031950684, 12.8310828450006], [17.045041614991383, 6.12828427315675]],
                [[30.248356128243646, 18.153673491978005], [35.65471825943083, 14.112170243622858]],
            )
        ),
        b=60.0,
    ),
}
TOUCHING = {
    "an end on a two-fold centre, beside another stroke": one(
        "pmg",
        {"segment": [[30, 30], [34.42269517762415, 45.22972850747943]]},
        {"segment": [[30.006, 30], [25.58330482237585, 14.770271492520571]]},
        b=60.0,
    ),
    "the same, nearer": one(
        "pgg",
        {"segment": [[30, 30], [38.51799877322752, 23.253770160646955]]},
        {"segment": [[30.0000006, 30], [21.482001826772482, 36.74622983935305]]},
        b=60.0,
    ),
    "a stroke across a mirror, among others": one(
        "pmg",
        {"segment": [[14, 41], [18, 41]]},
        {"segment": [[8, 48], [8, 51]]},
        {"segment": [[2, 44], [-1, 46]]},
        b=63.0,
    ),
    "strokes across their copies, drawn twice a little apart": one(
        "p2",
        {"polyline": [[27.16, 5.104], [18.583, 47.355], [37.837, 37.249], [30.49, 11.197]]},
        {
            "polyline": [
                [27.159999568768043, 5.103997372063203],
                [18.583000183006103, 47.355001115243134],
                [37.83699985961783, 37.24899914450804],
                [30.49000025656659, 11.197001563522297],
            ]
        },
        b=60.0,
        angle=90.0,
    ),
}


@pytest.mark.parametrize("name", list(FOUND))
def test_found_by_the_fuzz(name: str) -> None:
    """Designs that an earlier engine got wrong."""
    assert fuzz.try_design(FOUND[name], np.random.default_rng(1), points=200) == "tiled"


def test_corners_where_many_tiles_meet() -> None:
    """Six tiles meet at each corner of a triangle of mirrors; rounding once put an edge of no length into one."""
    site = [
        {"segment": [[-17.95198925088043, 34.83030372794832], [-23.155423254707237, 41.944307491943704]]},
        {"segment": [[-25.399265008328186, 20.47210572432103], [-12.616836927199243, 27.362455405412902]]},
        {"segment": [[-15.771060085682361, 40.145667034318976], [-19.611552688244586, 34.27582755670948]]},
    ]
    outline = Design.from_dict(one("p3m1", *site)).tessellate().tiles[0].outline
    np.testing.assert_allclose(outline.lengths, [math.sqrt(1200)] * 3, rtol=1e-12)


def test_edges_on_a_mirror_stay_whole() -> None:
    """Far from two near points rounding put two arcs of no length where an edge turns from one to the other.

    Their vertices are as near to each other as where a tile touches itself, and the edge was cut there.
    """
    points = [{"point": [1.0, 3**0.5]}, {"point": [1.0055836291546125, 3**0.5]}]
    tiling = tile(one("p3m1", *points))
    assert tiling.proof.passed
    assert len(tiling.tiles[0].outline) == 3
    assert [len(ring) for ring in tiling.tessellation.quotient.boundaries[0]] == [3]


@pytest.mark.parametrize("group", ["pm", "pmg", "cm", "p4", "pgg"])
@pytest.mark.parametrize("exponent", range(3, 9))
def test_a_copy_that_nearly_touches_a_segment(group: str, exponent: int) -> None:
    """A vertex far away, where the thin tile between the two ends, lies on all the edges that meet there.

    Seen from the other side of the cell their distance was lost in rounding; thin parabolas made much of that.
    """
    origin = Operation.parse(
        {"pm": "-x,y", "pmg": "-x+1/2,y", "cm": "-x,y", "p4": "-y,x", "pgg": "-x+1/2,y+1/2"}[group]
    )
    lattice, cell = GROUPS[group].lattice(60.0, 60.0), {} if GROUPS[group].fixes_b else {"b": 60.0}
    for place in (1.57, 1.9321, 3.1):
        near = lattice.isometry(origin.inverse())(complex(place, 3.0 + 10.0**-exponent * (1 + place / 10)))
        tiling = tile(one(group, {"segment": [[1.5, 3.0], [3.3, 3.0]]}, {"point": [near.real, near.imag]}, **cell))
        assert tiling.proof.passed


@pytest.mark.parametrize(
    ("b", "x", "start", "end"),
    [
        (60000.0, -1e-6, 19928.0, 20295.0),
        (60000.0, -3.336114992300405e-07, 19928.07178402231, 20295.03986582269),
        (59590.149179908214, 4.8412453949445684e-05, 56777.0622285203, 57044.608164986115),
        (130103.71054781167, 2.6602355876784573e-06, 17854.349049326836, 28520.73595286381),
    ],
)
def test_a_stroke_along_a_mirror_of_a_thin_cell(b: float, x: float, start: float, end: float) -> None:
    """Its tile is the rectangle between two mirrors, cut halfway between the stroke and its next translates.

    Far away rounding cut one short side of it into more edges, of two copies in turn, than the other one.
    """
    outline = tile(one("pm", {"segment": [[x, start], [x, end]]}, b=b)).tiles[0].outline
    left, middle = min(0.0, math.copysign(30.0, x)), (start + end) / 2
    box = [left, middle - b / 2, left + 30, middle + b / 2]
    np.testing.assert_allclose(outline.bounds, box, rtol=0, atol=1e-12 * b)
    assert outline.area == pytest.approx(30 * b, rel=1e-12)


@pytest.mark.parametrize(
    "design",
    [
        one("p4g", {"segment": [[1.1182060441818324, 31.11820604372981], [3.1427003728869236, 33.1427003724349]]}),
        one(
            "pmg",
            {"segment": [[14.999997057775584, 112059.78169252604], [14.999997057775584, 123643.8869481488]]},
            b=245542.451896263,
        ),
    ],
)
def test_an_edge_that_is_longer_in_one_tile_than_beyond(design: dict[str, Any]) -> None:
    """Both are left out where the shorter one is, though rounding put their ends farther apart than that is long.

    How far it does depends on a gap between two copies beyond, of which the tile's own boundary does not tell.
    """
    assert tile(design).proof.passed


def test_an_edge_is_not_paired_with_what_is_far_from_its_image() -> None:
    """In a thin cell all is near on the scale of the longer side, and an edge on one mirror was moved to another."""
    strokes = [
        {"segment": [[30.024301838168142, 58887.17969928503], [36.81058345864872, 58889.542014834005]]},
        {"segment": [[-5.985836833616643e-06, 69140.19541987422], [-5.985836833616643e-06, 69153.04911567103]]},
    ]
    assert tile(one("cm", *strokes, b=103703.53796159272)).proof.passed


@pytest.mark.parametrize("name", list(TOUCHING))
def test_found_touching_by_the_fuzz(name: str) -> None:
    """Designs that an earlier engine should have refused."""
    assert fuzz.try_design(TOUCHING[name], np.random.default_rng(1)) == "refused"


def test_strokes_across_their_copies_are_refused_before_edges_are_paired(monkeypatch: pytest.MonkeyPatch) -> None:
    """What such tiles have for edges does not pair, and takes long not to."""
    monkeypatch.setattr(tessellation, "find_edges", None)
    with pytest.raises(TouchingCopiesError):
        Design.from_dict(TOUCHING["strokes across their copies, drawn twice a little apart"]).tessellate()


@pytest.mark.slow
def test_500_random_designs() -> None:
    """`make fuzz`, as everyone runs it."""
    call = [sys.executable, "-m", "helpers.fuzz", "500", "--seed", "20240229"]
    done = subprocess.run(call, cwd=Path(fuzz.__file__).parents[1], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "500 designs" in done.stdout

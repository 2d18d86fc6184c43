"""Gradients of tiles, judged by tiles of changed designs, and by what is known in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from helpers import strategies
from helpers.finite_differences import (
    KINK,
    Complexes,
    Floats,
    Step,
    along_normals,
    derivative,
    judged,
    points_of,
    shared_lengths,
    value_at,
)
from helpers.strategies import Dice, canvas, make_design
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import voronoi_tiles as vt

SHARE = 2e-5
"""The step of differences, in units, of cells of 60: a few digits above rounding, and smaller than what bends."""


def tessellated(table: dict[str, Any]) -> vt.Tiling | None:
    """The tiling of a random design, None where its copies touch."""
    try:
        return vt.Design.from_dict(table).tessellate()
    except (vt.TouchingCopiesError, vt.DesignError):
        return None


def sampled(tiling: vt.Tiling, rng: np.random.Generator, count: int = 20) -> list[tuple[Any, Floats]]:
    """Some points of each tile, off the ends of its edges: edges and parameters."""
    result = []
    for tile in tiling:
        long = np.flatnonzero(tile.outline.lengths > 0.1)
        arcs = rng.choice(long, min(count, len(long)), replace=False)
        result.append((arcs, rng.uniform(0.1, 0.9, len(arcs))))
    return result


def assert_right(table: dict[str, Any], step: Step, rng: np.random.Generator) -> tuple[float, float]:
    """Compare all that a gradient says of a step with differences: the shares of points and of measures judged."""
    tiling = vt.Design.from_dict(table).tessellate()
    gradient = tiling.shape_gradient([name for name, _ in step])
    change = np.array([amount for _, amount in step])
    samples = sampled(tiling, rng)
    points = [points_of(tile.outline, *sample) for tile, sample in zip(tiling, samples, strict=True)]

    def places(other: vt.Tiling) -> Floats:
        return np.concatenate([along_normals(tile.outline, *lines) for tile, lines in zip(other, points, strict=True)])

    def measures(other: vt.Tiling) -> Floats:
        return np.concatenate(
            [
                [tile.area, tile.perimeter, *shared_lengths(tile.outline, mine.outline)]
                for tile, mine in zip(other, tiling, strict=True)
            ]
        )

    moved = derivative(table, step, places, SHARE)
    grown = derivative(table, step, measures, SHARE)
    if moved is None or grown is None:
        return np.nan, np.nan
    velocities = [mine.velocities(*sample).velocity @ change for mine, sample in zip(gradient, samples, strict=True)]
    rates = [
        np.concatenate([[mine.area @ change, mine.perimeter @ change], mine.neighbour_lengths @ change])
        for mine in gradient
    ]
    return judged(np.concatenate(velocities), moved), judged(np.concatenate(rates), grown)


def names_of(tiling: vt.Tiling, rng: np.random.Generator, count: int) -> list[str]:
    """Some parameters of a design."""
    names = tiling.shape_gradient().parameters
    return [str(name) for name in rng.choice(names, min(count, len(names)), replace=False)]


@pytest.mark.parametrize("group", vt.GROUPS)
def test_outlines_areas_and_lengths_change_as_tiles_of_changed_designs_do(group: str) -> None:
    """In every group, for random strokes of all kinds, of one site and of several, and for the cell."""
    shares = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        _, table = make_design(Dice(rng), ("plain", "several", "dense", "scattered")[seed % 4], group)
        tiling = tessellated(table)
        if tiling is None or any(len(tile.symmetry) > 1 for tile in tiling):
            continue
        cell = "cell.a" if "b" not in table["cell"] else str(rng.choice(["cell.a", "cell.b"]))
        shares += [assert_right(table, [(name, 1.0)], rng) for name in (*names_of(tiling, rng, 1), cell)]
        if len(shares) >= 8:
            break
    found = np.array(shares)
    judgements = found[np.isfinite(found[:, 0])]
    assert len(judgements) >= 5
    assert judgements[:, 0].mean() > 0.95
    assert judgements[:, 1].mean() > 0.7  # a vertex of four tiles becomes an edge


@settings(max_examples=15, deadline=None, derandomize=True)
@given(table=strategies.designs("plain", "several", "points"), seed=st.integers(0, 99))
def test_a_step_of_all_numbers_is_the_sum_of_its_parts(table: dict[str, Any], seed: int) -> None:
    """Whatever is drawn, the rates of a step are those of its numbers times its amounts; points that meet stay one."""
    tiling = tessellated(table)
    assume(tiling is not None and all(len(tile.symmetry) == 1 for tile in tiling))
    assert tiling is not None
    rng = np.random.default_rng(seed)
    pushes: dict[tuple[float, float], Floats] = {}
    step = []
    for name in tiling.shape_gradient().parameters:
        point, axis = name[:-3], name[-3:]
        if axis in ("[0]", "[1]"):
            x, y = value_at(table, f"{point}[0]"), value_at(table, f"{point}[1]")
            push = pushes.setdefault((x, y), rng.normal(size=2) / 4.0)
            step.append((name, float(push[int(axis[1])])))
        else:
            step.append((name, float(rng.normal()) / 4.0))
    assert_right(table, step, rng)


# --- closed forms ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("group", vt.GROUPS)
def test_scale_moves_every_point_away_from_the_origin(group: str) -> None:
    """All points of all outlines by their own place, areas by twice, lengths by once themselves, to 12 digits."""
    design = vt.starter(group).replace(scale=1.5)
    tiling = design.tessellate()
    gradient = tiling.shape_gradient("scale")
    for tile, mine in zip(tiling, gradient, strict=True):
        points = mine.along(200)
        right = (points.place.conj() * points.normal).real / 1.5
        np.testing.assert_allclose(points.velocity[:, 0], right, rtol=0, atol=1e-11)
        assert mine.area[0] == pytest.approx(2 * tile.area / 1.5, rel=1e-12)
        assert mine.perimeter[0] == pytest.approx(tile.perimeter / 1.5, rel=1e-11)
        shared = shared_lengths(tile.outline, tile.outline)
        np.testing.assert_allclose(mine.neighbour_lengths[:, 0], shared / 1.5, rtol=0, atol=1e-11)


@pytest.mark.parametrize("group", vt.GROUPS)
def test_the_tiles_of_a_cell_stay_as_large_as_the_cell(group: str) -> None:
    """Whatever moves, the areas of the copies in a cell change by what the cell's area does, to rounding."""
    tiling = vt.starter(group).tessellate()
    gradient = tiling.shape_gradient()
    total = sum((mine.area * tile.copies_per_cell for mine, tile in zip(gradient, tiling, strict=True)), 0.0)
    lattice, cell = tiling.design.lattice, tiling.design.cell
    right = np.zeros(len(gradient.parameters))
    for k, name in enumerate(gradient.parameters):
        match name:
            case "cell.a":
                right[k] = lattice.det / cell["a"] * (2 if tiling.design.group.fixes_b else 1)
            case "cell.b":
                right[k] = lattice.det / cell["b"]
            case "cell.angle":
                right[k] = lattice.det / math.tan(math.radians(cell["angle"])) * math.pi / 180
    np.testing.assert_allclose(total, right, rtol=0, atol=1e-11)


def test_moving_a_site_moves_its_tile() -> None:
    """In p1 all copies go along: the velocity is the motion's part along the normal, vertices move as the site does."""
    table = {
        "schema": 1,
        "group": "p1",
        "cell": {"a": 60.0, "b": 50.0, "angle": 75.0},
        "site": [{"strokes": [{"bezier": [[2, 8], [16, 34], [30, -12], [46, 14]]}, {"circle": [9, 20], "radius": 3}]}],
    }
    tiling = vt.Design.from_dict(table).tessellate()
    gradient = tiling.shape_gradient(["site[0].translate", "site[0].strokes[0].translate", "site[0].strokes[1].circle"])
    mine = gradient[0]
    points = mine.along(300)
    whole = points.velocity[:, :2]
    np.testing.assert_allclose(whole, np.stack([points.normal.real, points.normal.imag], axis=1), rtol=0, atol=1e-12)
    np.testing.assert_allclose(points.velocity[:, 2:4] + points.velocity[:, 4:], whole, rtol=0, atol=1e-12)
    corners = np.abs(mine.vertices[:, 0] - 1.0) < 1e-6
    assert corners.sum() >= 6
    np.testing.assert_allclose(mine.vertices[corners][:, :2], [[1.0, 1j]] * int(corners.sum()), rtol=0, atol=1e-8)
    # Elsewhere edges go on without a corner: what is along the normal is right there, too.
    start = mine.velocities(np.arange(len(mine.outline)), np.zeros(len(mine.outline)))
    along = (start.normal.conj()[:, None] * mine.vertices).real
    np.testing.assert_allclose(along, start.velocity, rtol=0, atol=1e-8)
    np.testing.assert_allclose(mine.area[:2], 0.0, atol=1e-11)
    np.testing.assert_allclose(mine.neighbour_lengths[:, :2], 0.0, atol=1e-8)
    np.testing.assert_allclose(mine.perimeter[:2], 0.0, atol=1e-10)


def test_corners_move_as_those_of_changed_designs() -> None:
    """The corner where three tiles meet, and those where a tile's own strokes are equally far, in both coordinates."""
    table = {
        "schema": 1,
        "group": "p3",
        "cell": {"a": 60.0},
        "site": [{"strokes": [{"segment": [[4, 7], [20, 9]]}, {"segment": [[20, 9], [12, 24]]}]}],
    }
    tiling = vt.Design.from_dict(table).tessellate()
    step = [("cell.a", 0.3), ("site[0].strokes[0].segment[0][1]", 1.0)]
    mine = tiling.shape_gradient([name for name, _ in step])[0]
    outline = tiling[0].outline
    turns = np.angle((outline.control - outline.start) / np.roll(outline.end - outline.control, 1))
    corners = outline.start[np.abs(turns) > 0.05]
    assert len(corners) == 8

    def places(other: vt.Tiling) -> Floats:
        starts = other[0].outline.start
        nearest: Complexes = starts[np.abs(starts[:, None] - corners).argmin(axis=0)]
        return np.concatenate([nearest.real, nearest.imag])

    right = derivative(table, step, places, SHARE)
    assert right is not None
    found = mine.vertices[np.abs(turns) > 0.05] @ [amount for _, amount in step]
    assert judged(np.concatenate([found.real, found.imag]), right) == 1.0


# --- what can only move together ------------------------------------------------------------------------------------


def has_rotation(symmetries: list[vt.Isometry]) -> bool:
    """Whether there is a rotation among them."""
    return any(not symmetry.conj and abs(symmetry.a - 1) > 1e-9 for symmetry in symmetries)


def symmetric_design(
    group: str, seed: int, suits: Callable[[list[vt.Isometry]], bool]
) -> tuple[dict[str, Any], list[list[str]], list[vt.Isometry]] | None:
    """A site in a special position, with the names of the points of its strokes and the symmetries that made these."""
    rng = np.random.default_rng(seed)
    chance = Dice(rng)
    on = canvas(chance, group)
    centres = [
        on.lattice.cartesian(x, y)
        for x in strategies.SPECIAL
        for y in strategies.SPECIAL
        if suits(on.stabilizer(on.lattice.cartesian(x, y)))
    ]
    if not centres:
        return None
    centre = centres[int(rng.integers(len(centres)))]
    symmetries = on.stabilizer(centre)
    line = [centre + complex(*rng.uniform(0.05, 0.2, 2)) * on.size for _ in range(3)]
    strokes = [strategies.segment(*(symmetry(z) for z in line)) for symmetry in symmetries]
    table = {"schema": 1, "group": group, "cell": on.cell, "site": [{"strokes": strokes}]}
    names = [[f"site[0].strokes[{k}].polyline[{p}]" for p in range(3)] for k in range(len(symmetries))]
    return table, names, symmetries


@pytest.mark.parametrize("group", [name for name in vt.GROUPS if name not in ("p1", "pg")])
def test_images_of_a_stroke_move_together(group: str) -> None:
    """Where the group maps a site onto itself, a symmetric step is the sum of its parts, as in changed designs."""
    shares = []
    for seed in range(60):
        made = symmetric_design(group, seed, lambda symmetries: len(symmetries) > 1)
        if made is None or tessellated(made[0]) is None:
            continue
        table, names, symmetries = made
        rng = np.random.default_rng(seed)
        push = complex(*rng.normal(size=2))
        step: Step = []
        for stroke, symmetry in zip(names, symmetries, strict=True):
            image = symmetry.a * (push.conjugate() if symmetry.conj else push)
            step = [*step, (f"{stroke[1]}[0]", image.real), (f"{stroke[1]}[1]", image.imag)]
        shares.append(assert_right(table, step, rng))
        if len(shares) == 3:
            break
    assert len(shares) == 3
    assert np.nanmean(shares) > 0.8


@pytest.mark.parametrize("group", ["p2", "pgg", "cmm", "p4g", "p31m"])
def test_a_site_goes_with_its_centre_when_the_cell_changes(group: str) -> None:
    """The derivative by the cell is that of a design whose site has been moved to where its centre of rotation is."""
    checked = 0
    for seed in range(60):
        made = symmetric_design(group, seed, has_rotation)
        if made is None or tessellated(made[0]) is None:
            continue
        table, names, _ = made
        middle = np.mean([z[0] for stroke in table["site"][0]["strokes"] for z in stroke["polyline"]])
        # The centre is in fixed fractions of the cell, here half or a third of the side, whatever the strokes.
        step: Step = [("cell.a", 1.0)]
        lattice = vt.Design.from_dict(table).lattice
        centre = complex(middle, np.mean([z[1] for stroke in table["site"][0]["strokes"] for z in stroke["polyline"]]))
        x, y = lattice.fractional(centre)
        fixes = vt.GROUPS[group].fixes_b
        way = (x * lattice.a + (y * lattice.b if fixes else 0.0)) / table["cell"]["a"]
        for stroke in names:
            for point in stroke:
                step = [*step, (f"{point}[0]", way.real), (f"{point}[1]", way.imag)]
        rng = np.random.default_rng(seed)
        assert_right(table, step, rng)
        tiling = vt.Design.from_dict(table).tessellate()
        gradient = tiling.shape_gradient([name for name, _ in step])
        amounts = np.array([amount for _, amount in step])
        velocity = gradient[0].along(50).velocity
        np.testing.assert_allclose(velocity[:, 0], velocity @ amounts, rtol=0, atol=1e-9)
        checked += 1
        if checked == 2:
            break
    assert checked == 2


def test_strokes_that_meet_move_together() -> None:
    """Three strokes from one point: each has a third of what the point does, and so for a point drawn on an end."""
    strokes: list[dict[str, Any]] = [{"segment": [[12, 11], [20, 9]]}, {"segment": [[5, 6], [12, 11]]}]
    strokes += [{"polyline": [[12, 11], [10, 20], [17, 22]]}, {"point": [20, 9]}]
    table = {"schema": 1, "group": "p4", "cell": {"a": 60.0}, "site": [{"strokes": strokes}]}
    meeting = ["strokes[0].segment[0]", "strokes[1].segment[1]", "strokes[2].polyline[0]"]
    rng = np.random.default_rng(1)
    for names in (meeting, ["strokes[0].segment[1]", "strokes[3].point"]):
        step = [(f"site[0].{name}[{axis}]", (0.6, -0.8)[axis]) for name in names for axis in (0, 1)]
        shares = assert_right(table, step, rng)
        assert min(shares) > 0.9
        points = vt.Design.from_dict(table).tessellate().shape_gradient([name for name, _ in step])[0].along(400)
        at_node = np.abs(points.velocity).min(axis=1) > 1e-9
        velocity = points.velocity.reshape(400, len(names), 2)
        assert at_node.any()
        # Where the foot is the point itself all have one share; beside it the stroke under the foot has more.
        alike = np.ptp(velocity, axis=1).max(axis=1) < 1e-12
        assert alike[at_node].any()


def test_a_joint_on_a_straight_line_bends_it() -> None:
    """A joint that noding leaves out is a point of the design: the edge moves by parts, and integrals keep to them."""
    table = {
        "schema": 1,
        "group": "p2",
        "cell": {"a": 60.0, "b": 50.0, "angle": 80.0},
        "site": [{"strokes": [{"polyline": [[8, 8], [14, 11], [26, 17]]}, {"point": [10, 18]}]}],
    }
    design = vt.Design.from_dict(table)
    assert len(design.noded[0].segments) == 1
    gradient = design.tessellate().shape_gradient("site[0].strokes[0]")
    step = [("site[0].strokes[0].polyline[1][1]", 1.0)]

    def measures(other: vt.Tiling) -> Floats:
        return np.array([other[0].area, other[0].perimeter])

    # The other strokes are those of two segments: the tiling of one is not among what is compared.
    right = []
    for share in (1e-4, 5e-5):
        forth, back = (
            vt.Design.from_dict(
                {
                    **table,
                    "site": [{"strokes": [{"polyline": [[8, 8], [14, 11 + way], [26, 17]]}, {"point": [10, 18]}]}],
                }
            ).tessellate()
            for way in (share, -share)
        )
        right.append((measures(forth) - measures(back)) / (2 * share))
    k = gradient.parameters.index(step[0][0])
    found = np.array([gradient[0].area[k], gradient[0].perimeter[k]])
    np.testing.assert_allclose(found, 2 * right[1] - right[0], rtol=0, atol=1e-6)
    assert found[1] != pytest.approx(0.0, abs=1e-3)
    # A point on the edge over the joint moves, over the ends of the line it does not.
    velocity = gradient[0].along(400).velocity[:, k]
    assert np.abs(velocity).max() > 0.1
    assert (np.abs(velocity) < 1e-12).any()


# --- the oracle, and arguments --------------------------------------------------------------------------------------


def test_a_wrong_derivative_is_seen() -> None:
    """The oracle judges: a velocity, an area or a length that is off by a few millionths fails."""
    right = np.array([0.5, 2.0, np.nan])
    assert judged(right, right) == pytest.approx(2 / 3)
    for k in (0, 1):
        wrong = right.copy()
        wrong[k] += 5e-6
        with pytest.raises(AssertionError):
            judged(wrong, right)
    assert 0 < KINK < 1


def test_differences_see_that_an_edge_has_another_velocity() -> None:
    """With the strokes of another design the comparison fails."""
    table = {"schema": 1, "group": "p4", "cell": {"a": 60.0}, "site": [{"strokes": [{"segment": [[5, 3], [25, 11]]}]}]}
    other = {**table, "site": [{"strokes": [{"segment": [[5, 3], [25, 12]]}]}]}
    tiling = vt.Design.from_dict(table).tessellate()
    arcs, t = sampled(tiling, np.random.default_rng(0))[0]
    step = [("site[0].strokes[0].segment[1][1]", 1.0)]
    lines = points_of(tiling[0].outline, arcs, t)
    right = derivative(table, step, lambda it: along_normals(it[0].outline, *lines), SHARE)
    assert right is not None
    mine = tiling.shape_gradient([step[0][0]])[0].velocities(arcs, t).velocity[:, 0]
    assert judged(mine, right) == 1.0
    gradient = vt.Design.from_dict(other).tessellate().shape_gradient([step[0][0]])[0]
    with pytest.raises(AssertionError):
        judged(gradient.velocities(arcs, t).velocity[:, 0], right)


@pytest.fixture(scope="module")
def gradient() -> vt.ShapeGradient:
    """The gradient of two tiles."""
    return vt.starter("p4m").tessellate().shape_gradient()


def test_a_gradient_is_a_sequence_of_named_tiles(gradient: vt.ShapeGradient) -> None:
    """By number and by name, with as many values as parameters."""
    assert [tile.name for tile in gradient] == ["star", "leaf"]
    assert gradient[1] is gradient["leaf"]
    assert len(gradient) == 2
    assert len(gradient.parameters) == len(gradient.values) == len(gradient["leaf"].area)
    with pytest.raises(vt.UnknownNameError, match="there is no site"):
        gradient["tree"]
    with pytest.raises(IndexError):
        gradient[2]
    assert "2 tiles by 17 parameters" in repr(gradient)
    assert "'leaf'" in repr(gradient["leaf"])


def test_points_along_an_outline_are_spread_over_it(gradient: vt.ShapeGradient) -> None:
    """As many as are asked for, on their edges, by length, with outer normals."""
    mine = gradient["star"]
    points = mine.along(400)
    assert points.velocity.shape == (400, 17)
    assert (np.diff(points.arc) >= 0).all()
    counts = np.bincount(points.arc, minlength=len(mine.outline))
    share = mine.outline.lengths / mine.outline.perimeter * 400
    assert np.abs(counts - share).max() <= 1.0 + 1e-9
    place, normal = points_of(mine.outline, points.arc, points.t)
    np.testing.assert_allclose(points.place, place, rtol=0, atol=1e-12)
    np.testing.assert_allclose(points.normal, normal, rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("arc", "t", "said"),
    [
        ([99], [0.5], "`arc` must be from 0 to"),
        ([-1], [0.5], "`arc` must be from 0 to"),
        ([0.5], [0.5], "`arc` must be numbers of edges"),
        ([0], [1.5], "`t` must be from 0 to 1"),
        ([0], [np.nan], "`t` must be from 0 to 1"),
        ([0, 1], [0.1, 0.2, 0.3], "`arc` and `t` cannot be"),
        ([0], ["x"], "`arc` and `t` cannot be"),
        ([[0, 1]], 0.5, "`arc` must be numbers of edges"),
    ],
)
def test_points_on_no_edge_are_refused(gradient: vt.ShapeGradient, arc: Any, t: Any, said: str) -> None:
    """With the name of the argument."""
    with pytest.raises(vt.ArgumentError, match=said):
        gradient[0].velocities(arc, t)


def test_too_few_and_too_many_points_are_refused(gradient: vt.ShapeGradient) -> None:
    """None, and as many as do not fit into memory."""
    with pytest.raises(vt.ArgumentError, match="count"):
        gradient[0].along(0)
    with pytest.raises(vt.ArgumentError, match="count"):
        gradient[0].along(2.5)  # type: ignore[arg-type]
    with pytest.raises(vt.ArgumentError, match="are too many numbers"):
        gradient[0].along(10**8)
    assert gradient[0].velocities([], []).velocity.shape == (0, 17)


def test_a_step_makes_a_design(gradient: vt.ShapeGradient) -> None:
    """By all numbers or by names; another count, and names of nothing, are refused."""
    name = "site[1].strokes[0].bezier[0][1]"
    k = gradient.parameters.index(name)
    step = np.zeros(17)
    step[k] = 0.25
    design = gradient.stepped(step)
    assert design == gradient.stepped({name: 0.25})
    assert design.to_dict()["site"][1]["strokes"][0]["bezier"][0][1] == gradient.values[k] + 0.25
    assert gradient.stepped({}) == gradient.design
    for wrong, said in (([0.0], "has the shape"), ({"site[9]": 1.0}, "names 'site"), (["x"] * 17, "cannot be")):
        with pytest.raises(vt.ArgumentError, match=said):
            gradient.stepped(wrong)  # type: ignore[arg-type]
    with pytest.raises(vt.DesignError):
        gradient.stepped({"cell.a": -60.0})


def test_newton_makes_two_tiles_alike() -> None:
    """What gradients are for: a step of a stroke that makes two areas the same, found in a few steps."""
    site = [vt.Site([vt.segment(5 + 3j, 25 + 11j)], name="large"), vt.Site([vt.point(40 + 30j)], name="small")]
    design = vt.Design("p2", (60, 50, 80), site)
    for _ in range(6):
        tiling = design.tessellate()
        gap = tiling["large"].area - tiling["small"].area
        if abs(gap) < 1e-9:
            break
        gradient = tiling.shape_gradient("site[0].strokes[0].segment[1]")
        slope = gradient["large"].area - gradient["small"].area
        design = gradient.stepped(-gap * slope / (slope @ slope))
    assert abs(gap) < 1e-9

"""Outlines that are their own mirror images: their axes, the placements that keep them, and tiles that are as well."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
import shapely
from helpers.silhouettes import random_polygon
from hypothesis import given, settings
from hypothesis import strategies as st

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.escherization.covering import overlap_bound
from voronoi_tiles.escherization.goal_outline import GoalOutline
from voronoi_tiles.escherization.group_placement import GroupPlacement
from voronoi_tiles.escherization.mirror_axis import MirrorAxis, likeness, mirrored_outlines
from voronoi_tiles.escherization.mirror_placements import mirror_lines, mirror_rows

FREE = ("p1", "p2", "p3", "p4", "p6", "pg", "pgg")
HALF = np.array([0j, 3 + 6j, 12 + 14j, 22 + 10j, 30 + 18j, 44 + 15j, 40 + 6j, 52 + 4j, 55 + 0j])


LATTICES = [
    *((name, sides) for name in ("p1", "p2") for sides in (1.37j, 0.5 + 0.83j, 0.5 + 1.9j)),
    *((name, sides) for name in ("pg", "pgg") for sides in (1.37j, 1j)),
    *(("p4", 1j), ("p3", -0.5 + math.sqrt(0.75) * 1j), ("p6", -0.5 + math.sqrt(0.75) * 1j)),
]
"""Groups and b, where a is 1: all that have mirrors, as kinds."""


def moved(z: complex, unit: complex, shift: complex, conjugated: bool, *, apart: bool = False) -> complex:
    """A point, or a direction, moved by unit z + shift, or unit conj(z) + shift."""
    return unit * (z.conjugate() if conjugated else z) + (0.0 if apart else shift)


def taken(
    unit: complex, shift: complex, by: complex, along: complex, conjugated: bool, *, conj: bool = True
) -> tuple[complex, complex]:
    """What a motion makes of another one, unit conj(z) + shift, or unit z + shift: m o it o m^-1."""

    def image(z: complex) -> complex:
        back = (z - along) / by
        back = back.conjugate() if conjugated else back
        return moved(moved(back, unit, shift, conj), by, along, conjugated)

    return image(1 + 0j) - image(0j), image(0j)


class FloatGroup:
    """A group by its table's general positions and the lattice 1, b, in floating point."""

    def __init__(self, name: str, b: complex) -> None:
        self.b = b
        self.members: list[tuple[complex, complex, bool]] = []
        for operation in vt.GROUPS[name].operations:
            p, q, r, s = operation.linear
            shift = float(operation.translation[0]) + float(operation.translation[1]) * b
            unit, conj = p + r * b, p * s - q * r < 0
            assert abs(moved(b, unit, 0j, conj) - (q + s * b)) < 1e-9
            self.members.append((unit, shift, conj))

    def on_lattice(self, z: complex) -> bool:
        """Whether a vector is one of the lattice's."""
        j = z.imag / self.b.imag
        i = (z - j * self.b).real
        return abs(i - round(i)) + abs(j - round(j)) < 1e-6

    def same(self, unit: complex, shift: complex, other: complex, further: complex) -> bool:
        """Whether two reflections are one but for where in the lattice their line is."""
        if abs(unit - other) > 1e-6:
            return False
        steps = [i + j * self.b for i in range(-3, 4) for j in range(-3, 4)]
        return any(abs(shift + step - unit * step.conjugate() - further) < 1e-6 for step in steps)

    def keeps(self, unit: complex, shift: complex, *, conjugated: bool) -> bool:
        """Whether a motion takes the group to itself."""
        if not all(self.on_lattice(moved(side, unit, 0j, conjugated)) for side in (1 + 0j, self.b)):
            return False
        for own, along, conj in self.members:
            image, by = taken(own, along, unit, shift, conjugated, conj=conj)
            if not any(conj == c and abs(image - u) < 1e-6 and self.on_lattice(by - v) for u, v, c in self.members):
                return False
        return True

    def motions(self, grid: int, *, conjugated: bool) -> list[tuple[complex, complex]]:
        """All motions that take the group to itself, by shifts on a grid of the cell."""
        near = [i + j * self.b for i in range(-3, 4) for j in range(-3, 4)]
        units = [z for z in near if abs(abs(z) - 1.0) < 1e-9]  # where a may go to
        shifts = [(i + j * self.b) / grid for i in range(grid) for j in range(grid)]
        return [(u, s) for u in units for s in shifts if self.keeps(u, s, conjugated=conjugated)]


def beetle(turn: float = 0.0, place: complex = 0j, noise: float = 0.0, seed: int = 3) -> Complexes:
    """An outline that is its own mirror image about a line at an angle, but for noise of its corners."""
    corners = np.concatenate((HALF, HALF[-2:0:-1].conj()))
    shaken = np.random.default_rng(seed).normal(size=(len(corners), 2)) @ np.array([1, 1j]) * noise
    return np.asarray((corners + shaken) * cmath.exp(1j * turn) + place)


def polygon(points: Complexes) -> shapely.Polygon:
    """The polygon of these corners."""
    return shapely.Polygon(plane(points))


def apart(one: shapely.Polygon, axis: MirrorAxis) -> float:
    """How far an outline is from its mirror image about an axis, reflected by shapely's own affine map."""
    c, s, (x, y) = math.cos(2 * axis.angle), math.sin(2 * axis.angle), (axis.through.real, axis.through.imag)
    moved = [c, s, s, -c, x - c * x - s * y, y - s * x + c * y]
    return float(shapely.hausdorff_distance(one, shapely.affinity.affine_transform(one, moved)))


@settings(max_examples=20)
@given(st.integers(0, 63), st.integers(-100, 100))
def test_the_axis_is_found(tenths: int, along: int) -> None:
    """Wherever it lies, in whichever direction; the outline is mirrored exactly, and where it was."""
    turn, place = tenths / 10, along * (0.7 + 0.3j)
    (found,) = mirrored_outlines(GoalOutline.of(beetle(turn, place)))
    assert abs(math.sin(found.axis.angle - turn)) < 1e-4
    assert abs(found.axis.seen(np.array([place]))[0].imag) < 1e-3
    assert apart(found.silhouette.polygon, found.axis) < 1e-9
    assert shapely.hausdorff_distance(found.silhouette.polygon, polygon(beetle(turn, place))) < 0.05


def test_what_is_drawn_by_hand_is_made_symmetric() -> None:
    """Corners that are off by less than a hundredth of the size; what is off by a tenth is refused, and why is said."""
    by_hand = GoalOutline.of(beetle(0.4, noise=0.25))
    (found,) = mirrored_outlines(by_hand)
    assert apart(by_hand.polygon, found.axis) > 0.3
    assert apart(found.silhouette.polygon, found.axis) < 1e-9
    wrong = GoalOutline.of(beetle(0.4, noise=2.0))
    assert mirrored_outlines(wrong) == []
    assert likeness(wrong) < 0.95
    with pytest.raises(vt.ArgumentError, match=r"not its own mirror image.*0\.[89]"):
        vt.fit(beetle(0.4, noise=2.0), symmetric=True)


@pytest.mark.parametrize("right", [[25 - 30j, 1e-3 + 0j, 25 + 30j], [25 - 30j, 25 + 30j, 15 + 30j, 15 - 18j]])
def test_thin_outlines_are_fitted_where_a_stroke_is_left(right: list[complex]) -> None:
    """An hourglass and a horseshoe: drawn apart, copies of some placements leave nothing on the axis."""
    corners = np.array(right)
    outline = np.concatenate((corners, -corners[::-1].conj()))
    found = vt.fit(outline, symmetric=True, groups=["p1", "p2"], keep=4, strokes="outline")
    assert found
    assert all(each.symmetric for each in found)


def test_spikes_on_the_axis_are_valid_wherever_they_are_turned() -> None:
    """A rhomb with two of no width: neither crosses itself by what rounding adds."""
    right = np.array([-30j, 1e-6 - 29j, 20, 1e-6 + 29j, 30j])
    found = mirrored_outlines(GoalOutline.of(np.concatenate((right, -right[-2:0:-1].conj()))))
    assert len(found) == 2
    for each in found:
        assert all(GoalOutline(each.silhouette.unit.points * cmath.exp(1j * k)).polygon.is_valid for k in range(100))


@pytest.mark.parametrize(("rays", "kinds"), [(2, 2), (3, 1), (4, 2), (5, 1), (6, 2)])
def test_of_several_axes_each_kind_is_taken_once(rays: int, kinds: int) -> None:
    """Stars: those of an odd number of rays have axes of one kind alone, of which two do no harm."""
    angles = np.arange(2 * rays) * math.pi / rays + 0.3
    star = np.where(np.arange(2 * rays) % 2, 12.0, 30.0) * np.exp(1j * angles)
    found = mirrored_outlines(GoalOutline.of(star))
    between = {round((each.axis.angle - 0.3) / (math.pi / rays)) % 2 for each in found}
    assert len(found) >= kinds
    assert rays % 2 or len(between) == 2
    for each in found:
        assert apart(each.silhouette.polygon, each.axis) < 1e-9


def test_what_lies_beside_an_axis_has_no_half() -> None:
    """On either side, touching it from the right, or empty; what the axis cuts has one, from axis to axis."""
    axis = MirrorAxis(0j, 1 + 0j)
    for beside in (shapely.box(0, -2, 1, -1), shapely.box(0, 1, 1, 2), shapely.box(0, -1, 1, 0), shapely.Polygon()):
        assert axis.left_half(beside) is None
    half = axis.left_half(shapely.box(2, -1, 5, 3))
    assert half is not None
    assert sorted((half[0], half[-1]), key=abs) == [2, 5]
    assert set(half) == {2, 5, 2 + 3j, 5 + 3j}


def test_outlines_of_two_halves_that_hang_together_by_a_thread_are_placed() -> None:
    """A pair of spectacles: as what is drawn apart from the copies is one lens of it, no stroke is its own image."""
    lens = np.array([3 - 0.1j, 3 - 20j, 30 - 20j, 30 + 20j, 3 + 20j, 3 + 0.1j])
    outline = np.concatenate((lens, -lens.conj()[::-1])) * cmath.exp(0.3j)
    found = vt.fit(outline, groups=["p1", "p2"], keep=2, strokes="outline")
    assert len(found) == 2


def all_copies(placement: GroupPlacement, points: Complexes, reach: float) -> Complexes:
    """The points of all copies in a placement, near to the first one."""
    own = placement.laid(points, 0j)
    copies = np.concatenate([own, *[copy(own) for copy in placement.copies(4.0 * reach)]])
    return copies[np.abs(copies - placement.centre) < reach]


@pytest.mark.parametrize("name", FREE)
def test_mirrored_placements_have_copies_that_are_mirror_images_together(name: str) -> None:
    """Of points on both sides of an axis: the image of each about the placed axis is one of a copy; else not."""
    points = np.array([1.0, 0.3 + 0.4j, 0.3 - 0.4j, -0.5 + 0.7j, -0.5 - 0.7j]) * cmath.exp(0.8j)
    dice = np.random.default_rng(1)
    rows = mirror_rows(vt.GROUPS[name], 0.8, 1.0)
    assert len(rows) == len(mirror_lines(vt.GROUPS[name]))
    for among in rows:
        free = among.low + (among.high - among.low) * dice.random(len(among.low))
        placement = among.placement(free)
        axis = MirrorAxis(0j, cmath.exp(0.8j)).placed(placement)
        far = all_copies(placement, points, 4.0)
        near = far[np.abs(far - placement.centre) < 3.5]
        assert np.abs(axis.mirrored(near)[:, None] - far).min(axis=1).max() < 1e-9
        beside = MirrorAxis(placement.centre + 0.05j * axis.direction, axis.direction)
        assert np.abs(beside.mirrored(near)[:, None] - far).min(axis=1).max() > 0.01


def test_every_line_about_which_a_group_is_its_own_mirror_image_is_looked_at() -> None:
    """All reflections on a fine grid of a cell that take a group to itself, found in floating point from the tables.

    A motion that keeps the group takes each to one that is looked at, and one turns that end for end.
    """
    for name, sides in LATTICES:
        group = FloatGroup(name, sides)
        # A mirror moves by twice as much as its line: half of the grid. No glides.
        mirrors = [each for each in group.motions(6, conjugated=True) if abs(moved(each[1], *each, True)) < 1e-9]
        moves = [(*move, conj) for conj in (False, True) for move in group.motions(12, conjugated=conj)]
        looked_at = []
        for line in mirror_lines(vt.GROUPS[name]):
            skewed = vt.GROUPS[name].system != "oblique" or line.skew == sides.real
            if skewed and (sides == 1j or vt.GROUPS[name].system != "rectangular" or not line.diagonal):
                x, y = map(float, line.point)
                along = complex(line.direction[0] + line.direction[1] * sides)
                unit = along / along.conjugate()
                looked_at.append((unit, x + y * sides - unit * (x + y * sides).conjugate(), along))
        assert len(mirrors) >= len(looked_at) > 0
        for unit, shift, along in looked_at:
            assert group.keeps(unit, shift, conjugated=True)
            back = [move for move in moves if abs(moved(along, *move, apart=True) + along) < 1e-9]
            assert any(group.same(*taken(unit, shift, *move), unit, shift) for move in back)
        for unit, shift in mirrors:
            images = [taken(unit, shift, *move) for move in moves]
            assert any(group.same(*image, *each[:2]) for image in images for each in looked_at), (name, sides, unit)


def test_what_is_short_of_symmetric_is_not_said_to_be_as_much() -> None:
    """An overlap of 0.9597 is not 0.96."""
    likely = (GoalOutline.of(beetle(noise=float(noise))) for noise in np.arange(0.2, 0.4, 0.002))
    outline = next(each for each in likely if 0.955 < likeness(each) < 0.96)
    with pytest.raises(vt.ArgumentError, match=r"their overlap is 0\.95, less than 0\.96"):
        vt.fit(outline.polygon, symmetric=True)


def test_halves_that_hardly_meet_are_refused_by_that() -> None:
    """A heart that is slit along its axis, all but through."""
    right = np.array([12 - 14j, 26 + 2j, 26 + 16j, 14 + 24j, 4 + 20j, 1e-9 + 13j])
    outline = np.concatenate(([-26j], right, [-25.9j], -right[::-1].conj()))
    with pytest.raises(vt.ArgumentError, match="the outline's halves hardly meet on the axis"):
        vt.fit(outline, symmetric=True)


def test_groups_with_mirrors_are_left_to_those_without() -> None:
    """As the tiles that mirrors leave free are those of groups without them."""
    for name in set(vt.GROUPS) - set(FREE):
        assert mirror_lines(vt.GROUPS[name]) == ()
    assert all(mirror_lines(vt.GROUPS[name]) for name in FREE)
    with pytest.raises(vt.ArgumentError, match="`groups` has none whose tile"):
        vt.fit(beetle(), groups="cm", symmetric=True)


@pytest.mark.parametrize("strokes", ["few", "outline"])
def test_symmetric_tiles_are_their_own_mirror_images(strokes: str) -> None:
    """Up to the digits that corners are written with, of 44 mm to 1 um; and reach what is said of them."""
    outline = polygon(beetle(0.7, 20j))
    found = vt.fit(outline, symmetric=True, groups=["p1", "p2", "p3"], keep=3, strokes=strokes)  # type: ignore[arg-type]
    assert len(found) == 3
    for each in found:
        assert each.symmetric
        assert each._axis is not None
        tile = each.tiling[0].to_shapely(accuracy=1e-4)
        assert apart(tile, each._axis) < 2e-3
        assert each.overlap == pytest.approx(
            tile.intersection(each.outline).area / tile.union(each.outline).area, abs=1e-3
        )
        assert apart(shapely.affinity.translate(tile, 0.05, 0.02), each._axis) > 0.02


def test_no_symmetric_tile_overlaps_more_than_the_bound() -> None:
    """Which is that of the outline as it is given, not of the one that is its own mirror image."""
    found = vt.fit(beetle(0.4, noise=0.25, seed=4), symmetric=True, keep=3, groups=["p1", "p3"], strokes="outline")
    assert len(found) == 3
    assert all(each.bound - 2e-3 < each.overlap <= each.bound + 1e-5 for each in found)


def test_one_tile_at_least_is_symmetric_where_the_outline_is() -> None:
    """Among all; of outlines that are not none is."""
    found = vt.fit(beetle(1.0), keep=3, groups=["p1", "p4", "pgg"], strokes="outline")
    assert any(each.symmetric for each in found)
    assert [each.overlap for each in found] == sorted((each.overlap for each in found), reverse=True)
    assert not any(each.symmetric for each in vt.fit(random_polygon(2), keep=3, groups=["p1", "p2"], strokes="outline"))


def test_tiles_are_different_for_the_eye() -> None:
    """Of what is nearly its own mirror image: no two lie over each other by 0.98, as drawn or mirrored.

    But for one that is a mirror image, beside one that is not.
    """
    outline = beetle(0.4, noise=0.15)
    (near,) = mirrored_outlines(GoalOutline.of(outline))
    found = vt.fit(outline, keep=6, groups=["p1", "p2", "pgg"], strokes="outline")
    assert len(found) == 6
    tiles = [each.tile_as_drawn for each in found]
    for tile, each in zip(tiles, found, strict=True):
        assert tile.intersection(polygon(outline)).area / tile.union(polygon(outline)).area == pytest.approx(
            each.overlap, abs=2e-3
        )
    for k, tile in enumerate(tiles):
        for j in range(k):
            if found[k].symmetric == found[j].symmetric:
                corners = shapely.get_coordinates(tiles[j].exterior) @ np.array([1, 1j])
                for image in (corners, near.axis.mirrored(corners)):
                    common = tile.intersection(polygon(image)).area
                    assert common / tile.union(polygon(image)).area < 0.98, (found[k], found[j])


def test_the_bound_is_that_of_the_given_outline() -> None:
    """Not of the one that is its own mirror image, where both differ."""
    outline = GoalOutline.of(beetle(0.4, noise=0.25))
    (found,) = vt.fit(outline.polygon, keep=1, groups="p2", symmetric=True)
    assert found.bound == pytest.approx(overlap_bound(outline, found.placement), abs=1e-9)
    assert found.overlap <= found.bound + 1e-3


def test_what_copies_contest_is_decided_alike_on_both_sides() -> None:
    """The arms of a T, which lie on copies in p3, are both kept: else the best tile has 0.58 in common."""
    right = np.array([5 - 30j, 5 + 15j, 25 + 15j, 25 + 25j])
    found = vt.fit(np.concatenate((right, -right[::-1].conj())), groups=["p3", "p6"], symmetric=True, strokes="outline")
    assert found[0].group == "p3"
    assert found[0].overlap > 0.63
    for each in found:
        assert each._axis is not None
        # Some have corners that move 200 times as far as those of the stroke.
        assert apart(each.tiling[0].to_shapely(accuracy=1e-5), each._axis) < 1e-3

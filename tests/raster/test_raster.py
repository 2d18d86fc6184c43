"""Images against brute force: frames, copies, candidate lists, float64 and mesh images, distances at any point."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
import pytest
from helpers import brute, strategies
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from voronoi_tiles.base import kernels
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.designs.design import Design
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice
from voronoi_tiles.raster import block_lists as candidates
from voronoi_tiles.raster import cpu, hoff
from voronoi_tiles.raster import reference as judge
from voronoi_tiles.raster import scene as copies
from voronoi_tiles.raster.block_lists import BlockLists, find_candidates
from voronoi_tiles.raster.frame import BLOCK, PHASE, Frame, cell_frame, rectangle_frame
from voronoi_tiles.raster.gl import element_records
from voronoi_tiles.raster.reference import Judge, decode, encode
from voronoi_tiles.raster.renderer import LabelImage, Renderer
from voronoi_tiles.raster.scene import Pattern, Scene, distances, gather, merge_copies

Complexes = NDArray[np.complex128]
Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

SOME = settings(
    max_examples=40,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large],
)
GROUP = pytest.mark.parametrize("group", list(GROUPS))
KINDS = ("plain", "grid", "polygon", "special", "points", "several", "parallel", "far")


def pattern_of(design: dict[str, Any]) -> Pattern:
    """The sites of a design, whether their copies touch or not."""
    read = Design.from_dict(design)
    return Pattern(read.noded, read.group, read.lattice)


def named(pattern: Pattern, placement: int, i: int, j: int) -> tuple[str, Operation]:
    """The site's name and the operation of a copy."""
    row = pattern.placements[placement]
    return pattern.sites[row.site].name, row.operation.translated(i, j)


def one(group: str, *strokes: dict[str, Any], **cell: float) -> Pattern:
    """One site in a cell of 60."""
    return pattern_of({"schema": 1, "group": group, "cell": {"a": 60.0, **cell}, "site": [{"strokes": list(strokes)}]})


def random_patterns(seed: int, group: str | None, *kinds: str) -> Iterator[tuple[Pattern, np.random.Generator]]:
    """A pattern of each kind, and what chose it."""
    for number, kind in enumerate(kinds):
        rng = np.random.default_rng([seed, number])
        yield pattern_of(strategies.make_design(strategies.Dice(rng), kind, group)[1]), rng


def random_frame(pattern: Pattern, rng: np.random.Generator) -> Frame:
    """A frame of a cell or of a rectangle, at the origin or at the first site, large or small, of any shape."""
    centre = complex(pattern.sites[0].nodes.mean()) if rng.random() < 0.5 else 0j
    if rng.random() < 0.5:
        return cell_frame(pattern.lattice, int(rng.integers(1, 60)), centre=centre)
    width = 2 * math.sqrt(pattern.lattice.det) * 10 ** rng.uniform(-3, 0)
    height = width * 10 ** rng.uniform(-0.5, 0.5)
    region = (centre.real, centre.imag, centre.real + width, centre.imag + height)
    frame = rectangle_frame(region, int(rng.integers(1, 60)), int(rng.integers(1, 60)))
    return replace(frame, phase=(float(rng.random()), float(rng.random()))) if rng.random() < 0.5 else frame


LONG_SITE: dict[str, Any] = {"polyline": [[0, 0], [170, 31], [333, 64], [700, 128]]}
"""Twelve cells long, if it starts in a cell of 60."""


class Key(NamedTuple):
    """A copy's name: of all that coincide, the one whose operation comes first."""

    site: int
    matrix: tuple[int, int, int, int]
    x: Fraction
    y: Fraction


class Truth:
    """What brute force knows of a pattern: which copies there are, and how far they are from points."""

    def __init__(self, pattern: Pattern) -> None:
        lattice = pattern.lattice
        self.pattern = pattern
        elements = {site.name: site.elements for site in pattern.sites}
        self.plane = brute.Plane(pattern.group.name, lattice.a, lattice.b, elements)
        self.motions = brute.motions(pattern.group.name)
        self._number = {(motion.matrix, motion.shift): k for k, motion in enumerate(self.motions)}
        self._named: dict[int, tuple[Key, int, brute.Motion]] = {}
        self.symmetries = [self.plane.symmetries(site) for site in range(len(elements))]
        self._first = [
            [min(_product(motion, inner) for inner in found) for motion in self.motions] for found in self.symmetries
        ]

    def key(self, site: int, motion: brute.Motion) -> Key:
        """Name a copy."""
        x, y = motion.shift
        matrix, (u, v) = self._first[site][self._number[motion.matrix, (x % 1, y % 1)]]
        return Key(site, matrix, u + x // 1, v + y // 1)

    def read(self, copy: list[int]) -> tuple[Key, int, brute.Motion]:
        """Read the row of a copy (placement, i, j), a translate of what the pattern gives the name of."""
        k, i, j = copy
        if k not in self._named:
            name, operation = named(self.pattern, k, 0, 0)
            site, motion = self.plane.names.index(name), brute.read_operation(self.plane.group, str(operation))
            self._named[k] = self.key(site, motion), site, motion
        key, site, motion = self._named[k]
        return key._replace(x=key.x + i, y=key.y + j), site, motion.then(i, j)

    def distance(self, site: int, motion: brute.Motion, z: Complexes) -> Floats:
        """Measure from points to one copy."""
        return self.plane.distance(site, self.plane.pull(motion, z))

    def slack(self, z: Complexes) -> float:
        """The oracle's own rounding, in units."""
        return 8 * EPSILON * (self.pattern.scale + float(np.abs(z).max()))

    def around(self, z: Complexes, reach: float) -> list[list[tuple[float, Key]]]:
        """For each point all copies within `reach`, and maybe others: distances and names, nearest first."""
        plane = self.plane
        block = plane.around(z, [radius + reach for radius in plane.radii])
        home = np.empty(len(block.point), complex)
        for number, motion in enumerate(self.motions):
            chosen = block.motion == number
            home[chosen] = z[block.point[chosen]] - plane.push(motion, block.moved[chosen])
        i = np.round((home.real * plane.b.imag - home.imag * plane.b.real) / plane.det).astype(int)
        j = np.round((plane.a.real * home.imag - plane.a.imag * home.real) / plane.det).astype(int)
        assert np.abs(i * plane.a + j * plane.b - home).max() <= 1e-6 * plane.size
        found: list[dict[Key, float]] = [{} for _ in z]
        columns = (block.point, block.site, block.motion, i, j, block.distance)
        for k, site, number, m, n, distance in zip(*(column.tolist() for column in columns), strict=True):
            matrix, (x, y) = self._first[site][number]
            copy = Key(site, matrix, x + m, y + n)
            found[k][copy] = min(distance, found[k].get(copy, math.inf))
        return [sorted((distance, copy) for copy, distance in row.items()) for row in found]

    def assert_right(self, image: LabelImage, rng: np.random.Generator, count: int = 30) -> float:
        """Assert that samples of an image have the right labels and distances, within the error that it states.

        Gives the share of samples whose owner the error decides.
        """
        frame = image.frame
        assert image.first.shape == image.second.shape == image.d1.shape == image.d2.shape
        assert image.first.shape == (frame.height, frame.width)
        assert (image.first != image.second).all()
        assert (image.d1 <= image.d2 + (0.0 if image.provenance.method == "exact" else image.error(0.0))).all()
        named = [self.read(copy) for copy in image.copies.tolist()]
        assert len({key for key, _, _ in named}) == len(named), "two labels for one copy"

        i, j = rng.integers(0, frame.width, count), rng.integers(0, frame.height, count)
        i[:4], j[:4] = (0, frame.width - 1, 0, frame.width - 1), (0, 0, frame.height - 1, frame.height - 1)
        z = frame.points(i.astype(float), j.astype(float))
        labels = np.stack((image.first[j, i], image.second[j, i]))
        claimed = np.stack((image.d1[j, i], image.d2[j, i])).astype(float)
        own = np.empty((2, count))
        for label in np.unique(labels).tolist():
            layer, sample = np.nonzero(labels == label)
            _, site, motion = named[label]
            own[layer, sample] = self.distance(site, motion, z[sample])

        slack = self.slack(z)
        decided = 0
        # Copies at the distances of those named by the image: no two others can be nearer than both and be missed.
        for k, row in enumerate(self.around(z, float(own.max()) + slack)):
            (near, owner), (far, other) = row[:2]
            error_near, error_far = (float(image.error(d)) + slack for d in (near, far))
            assert abs(claimed[0, k] - near) <= error_near
            assert abs(claimed[1, k] - far) <= error_far
            keys = [named[label][0] for label in labels[:, k].tolist()]
            if far - near > 2 * error_far:
                decided += 1
                assert keys[0] == owner
            third = row[2][0] if len(row) > 2 else math.inf
            if third == math.inf or third - far > 2 * (float(image.error(third)) + slack):
                assert set(keys) == {owner, other}
            for true, least, allowed in ((own[0, k], near, error_near), (own[1, k], far, error_far)):
                assert true - float(image.error(true)) <= least + allowed + slack
        return decided / count


def _product(outer: brute.Motion, inner: brute.Motion) -> tuple[tuple[int, int, int, int], tuple[Fraction, Fraction]]:
    """The product of two motions: the inner one is applied first."""
    p, q, r, s = outer.matrix
    a, b, c, d = inner.matrix
    (x, y), (u, v) = inner.shift, outer.shift
    return (p * a + q * c, p * b + q * d, r * a + s * c, r * b + s * d), (p * x + q * y + u, r * x + s * y + v)


def two_nearest(label: NDArray[np.int32], distance: Floats) -> tuple[Floats, Ints]:
    """The distances of the two nearest copies, and their labels, from those of elements; equal labels together."""
    start = np.flatnonzero(np.append(True, label[1:] != label[:-1]))
    nearest = np.minimum.reduceat(distance, start)
    two = np.argsort(nearest, kind="stable")[:2]
    return nearest[two], label[start[two]].astype(np.intp)


def in_disc(rng: np.random.Generator, count: int) -> Complexes:
    """Random points of the unit disc."""
    return np.asarray(np.sqrt(rng.random(count)) * np.exp(2j * math.pi * rng.random(count)))


# --- frames -------------------------------------------------------------------------------------------------


def test_samples_lie_where_the_frame_says() -> None:
    """At origin + (column + i + phase) u + (row + j + phase) v, and `offsets` are from the origin."""
    rng = np.random.default_rng(1)
    for _ in range(40):
        origin, u, v = (complex(*rng.normal(size=2)) for _ in range(3))
        phase = float(rng.random()), float(rng.random())
        frame = Frame(1000 * origin, u, v, 640, 480, phase, int(rng.integers(2000)), int(rng.integers(2000)))
        i, j = rng.uniform(-1, 640, (2, 5))
        for k in range(5):
            x = Fraction(i[k]) + Fraction(phase[0]) + frame.column
            y = Fraction(j[k]) + Fraction(phase[1]) + frame.row
            exact = [x * Fraction(p) + y * Fraction(q) for p, q in ((u.real, v.real), (u.imag, v.imag))]
            offset, point = complex(frame.offsets(i, j)[k]), complex(frame.points(i[k], j[k]))
            assert offset == pytest.approx(complex(*map(float, exact)), rel=1e-14)
            assert point == pytest.approx(frame.origin + offset, rel=1e-15)
    grid = frame.points(np.arange(3.0), np.arange(4.0)[:, None])
    assert grid.shape == (4, 3)
    assert grid[3, 2] == frame.points(2.0, 3.0)
    assert complex(frame.steps(2.0, -3.0)) == pytest.approx(2 * u - 3 * v)


def test_a_window_has_the_samples_of_the_whole() -> None:
    """Bit for bit where windows are as large as the renderer makes them; windows of windows too."""
    frame = replace(cell_frame(Lattice(60 + 0j, 20 + 50j), 5000, centre=3 - 4j))
    i, j = np.arange(0.0, 2048, 7), np.arange(0.0, 800, 7)[:, None]
    for column, row in ((0, 0), (2048, 0), (0, 2048), (2048, 4096)):
        window = frame.window(column, row, 2048, 800)
        assert (window.width, window.height) == (2048, 800)
        assert (window.points(i, j) == frame.points(i + column, j + row)).all()
        inner = window.window(1024, 512, 64, 32)
        assert (inner.column, inner.row) == (column + 1024, row + 512)
        assert (inner.points(i[:9], j[:4]) == window.points(i[:9] + 1024, j[:4] + 512)).all()


def test_a_frame_s_disc_holds_its_samples_and_their_neighbours() -> None:
    """One sample more on every side lies within the radius about the middle, and the disc is no larger."""
    rng = np.random.default_rng(2)
    for _ in range(100):
        u, v = (complex(*rng.normal(size=2)) for _ in range(2))
        wide, high = rng.integers(1, 40, 2).tolist()
        frame = Frame(5j, u, v, wide, high, PHASE, 7, 9)
        corners = frame.offsets(np.array([-1.0, frame.width]), np.array([[-1.0], [frame.height]]))
        far = float(np.abs(corners - frame.middle).max())
        assert far <= frame.radius * (1 + 1e-12) <= far + 2 * (abs(u) + abs(v)) * (1 + 1e-9)
        assert frame.pixel == max(abs(u), abs(v))
        assert frame.area_per_sample == pytest.approx(abs((u.conjugate() * v).imag))


@pytest.mark.parametrize("samples", [1, 2, 37, 200])
@GROUP
def test_a_cell_frame_is_one_cell(group: str, samples: int) -> None:
    """Its sides are a reduced basis of the lattice, its samples about as far apart both ways, its centre as asked."""
    lattice = strategies.canvas(strategies.Dice(np.random.default_rng(samples)), group).lattice
    if group == "p1":
        lattice = Lattice(lattice.a, lattice.b + 7 * lattice.a)
    frame = cell_frame(lattice, samples, centre=100 - 20j)
    sides = frame.width * frame.u, frame.height * frame.v
    x = [(z.real * lattice.b.imag - z.imag * lattice.b.real) / lattice.det for z in sides]
    y = [(lattice.a.real * z.imag - lattice.a.imag * z.real) / lattice.det for z in sides]
    assert np.abs(np.array([x, y]) - np.round([x, y])).max() < 1e-9
    assert round(x[0]) * round(y[1]) - round(x[1]) * round(y[0]) == 1
    assert abs(sides[0] - sides[1]) >= max(map(abs, sides)) * (1 - 1e-9) <= abs(sides[0] + sides[1])
    assert frame.phase == PHASE
    assert frame.area_per_sample * frame.width * frame.height == pytest.approx(lattice.det)
    assert frame.origin + sum(sides) / 2 == pytest.approx(100 - 20j)
    if samples >= 37:
        assert frame.width * frame.height == pytest.approx(samples**2, rel=0.1)
        assert abs(frame.u) == pytest.approx(abs(frame.v), rel=0.1)


def test_a_rectangle_frame_is_a_picture() -> None:
    """The first row is at the top, samples are in the middle of their pixels."""
    frame = rectangle_frame((10.0, -3.0, 18.0, 3.0), 4, 6)
    assert complex(frame.points(0.0, 0.0)) == 11 + 2.5j
    assert complex(frame.points(3.0, 0.0)) == 17 + 2.5j
    assert complex(frame.points(3.0, 5.0)) == 17 - 2.5j
    assert frame.pixel == 2.0


@pytest.mark.parametrize(("width", "height"), [(0, 5), (5, 0), (-1, 5)])
def test_a_frame_without_samples_is_refused(width: int, height: int) -> None:
    """As a frame, as a window."""
    with pytest.raises(ValueError, match="is empty"):
        Frame(0j, 1 + 0j, 1j, width, height)
    with pytest.raises(ValueError, match="is empty"):
        Frame(0j, 1 + 0j, 1j, 9, 9).window(0, 0, width, height)


@pytest.mark.parametrize("region", [(0, 0, 0, 1), (0, 0, 1, 0), (1, 0, 0, 1), (0, 1, 1, 0), (0, math.nan, 1, 1)])
def test_an_empty_region_is_refused(region: tuple[float, float, float, float]) -> None:
    """No width, no height, the wrong way round, no number."""
    with pytest.raises(ValueError, match=r"the region .* is empty"):
        rectangle_frame(region, 8, 8)


# --- copies -------------------------------------------------------------------------------------------------


@GROUP
def test_copies_are_those_of_brute_force(group: str) -> None:
    """The same symmetries of each site, and one placement for each of the different copies in a cell."""
    for pattern, rng in random_patterns(3, group, *KINDS, "nearly special", "special", "polygon"):
        truth = Truth(pattern)
        for symmetry, expected in zip(pattern.symmetries, truth.symmetries, strict=True):
            assert symmetry[0].is_identity
            assert len(symmetry) == len(expected)
            assert {brute.read_operation(group, str(operation)) for operation in symmetry} == set(expected)
        found = [truth.read([k, 0, 0])[0] for k in range(len(pattern.placements))]
        different = {key._replace(x=key.x % 1, y=key.y % 1) for key in found}
        total = sum(len(truth.motions) // len(inner) for inner in truth.symmetries)
        assert len(different) == len(found) == total
        z = np.array([complex(*rng.normal(size=2)) * 60 for _ in range(5)])
        for k, placement in enumerate(pattern.placements):
            _, site, motion = truth.read([k, 0, 0])
            assert site == placement.site
            assert np.abs(placement.isometry(z) - truth.plane.push(motion, z)).max() <= 1e-11 * truth.plane.size


@GROUP
def test_every_operation_has_its_copy(group: str) -> None:
    """`locate` finds the copy under any operation of the group: a translate of its placement that is the same copy."""
    for pattern, rng in random_patterns(4, group, "plain", "special", "polygon", "far", "several"):
        truth = Truth(pattern)
        for site in range(len(pattern.sites)):
            for operation in pattern.group.operations:
                moved = operation.translated(*(int(n) for n in rng.integers(-4000, 4000, 2)))
                name, found = named(pattern, *pattern.locate(site, moved))
                assert name == pattern.sites[site].name
                wanted = truth.key(site, brute.read_operation(group, str(moved)))
                assert truth.key(site, brute.read_operation(group, str(found))) == wanted
                assert truth.read(list(pattern.locate(site, moved)))[0] == wanted
        for copy in ((0, 0, 0), (len(pattern.placements) - 1, -3, 8)):
            name, operation = named(pattern, *copy)
            site = [row.name for row in pattern.sites].index(name)
            assert pattern.locate(site, operation) == copy


@pytest.mark.parametrize("triplet", ["-x,-y", "x+1/2,y", "x,-y", "-y,x"])
def test_strangers_have_no_copy(triplet: str) -> None:
    """An operation of another group is refused."""
    pattern = one("p1", {"point": [5, 3]}, b=60.0, angle=90.0)
    with pytest.raises(KeyError, match="y"):
        pattern.locate(0, Operation.parse(triplet))


def test_strokes_decide_about_symmetry() -> None:
    """A square's corners have all its symmetries; two of its sides, or one diagonal more, have fewer."""
    corners = [[25, 25], [35, 25], [35, 35], [25, 35]]
    sides = [{"segment": [corners[k], corners[(k + 1) % 4]]} for k in range(4)]
    diagonal = {"segment": [corners[0], corners[2]]}
    for strokes, order in (
        ([{"point": corner} for corner in corners], 8),
        (sides, 8),
        (sides[::2], 4),
        ([*sides, diagonal], 4),
        (sides[:1], 2),
        ([*sides[::2], {"point": [30, 30]}, diagonal], 2),
        ([{"point": corner} for corner in corners[:3]], 2),
        ([*sides, {"point": [30, 28]}], 2),
        ([{"point": [29, 28]}, *sides], 1),
    ):
        (symmetry,) = one("p4m", *strokes).symmetries
        assert len(symmetry) == order


@GROUP
def test_no_copy_is_missed(group: str) -> None:
    """Anywhere in a disc the two nearest copies are in its scene, as near as brute force finds them."""
    patterns = list(random_patterns(5, group, "plain", "points", "special", "several", "far"))
    if not GROUPS[group].fixes_b:
        patterns += random_patterns(6, group, "skew")
    for pattern, rng in patterns:
        truth, size = Truth(pattern), math.sqrt(pattern.lattice.det)
        home = complex(pattern.sites[0].nodes.mean())
        for radius in (1e-3 * size, size * float(rng.uniform(0.1, 2.0))):
            origin, middle = home + 3 * size * in_disc(rng, 1)[0], complex(2 * size * in_disc(rng, 1)[0])
            scene = gather(pattern, origin, middle, radius)
            assert_in_order(scene)
            away = middle + radius * in_disc(rng, 6)
            z = origin + away
            slack = truth.slack(z) + 16 * EPSILON * pattern.scale
            found = [two_nearest(scene.label, distances(p, scene.middle, scene.half)) for p in away.tolist()]
            rows = truth.around(z, max(float(near[1]) for near, _ in found) + slack)
            for (near, labels), row in zip(found, rows, strict=True):
                assert near == pytest.approx([row[0][0], row[1][0]], rel=0, abs=slack)
                for label, (distance, key) in zip(labels.tolist(), row, strict=False):
                    if all(abs(distance - other) > 2 * slack for other, name in row if name != key):
                        assert truth.read(scene.copies[label].tolist())[0] == key


def assert_in_order(scene: Scene) -> None:
    """Assert that elements of one copy are neighbours, that labels ascend, and that no copy has two."""
    steps = np.diff(scene.label)
    assert scene.label[0] == 0
    assert ((steps == 0) | (steps == 1)).all()
    assert scene.label[-1] == len(scene.copies) - 1
    rows = [tuple(row) for row in scene.copies.tolist()]
    assert rows == sorted(set(rows))
    assert len(scene) == len(scene.middle) == len(scene.half) == len(scene.label)


@pytest.mark.parametrize(
    "pattern",
    [
        one("p1", LONG_SITE, b=50.0, angle=77.0),
        one("p2", {"circle": [15, 12], "radius": 9}, b=50.0, angle=77.0),
        one("p4g", {"bspline": [[2, 3], [9, 9], [20, 1], [14, 14], [25, 4]]}, {"point": [28, 1]}),
        one("p31m", {"circle": [60020, 10.5], "radius": 8}, {"segment": [[60025, 9], [60020, 10]]}),
    ],
    ids=["long", "circle", "curve", "far"],
)
def test_a_few_elements_give_a_bound(pattern: Pattern) -> None:
    """Distances to some elements are upper bounds, and with them far fewer copies are looked at than lie about."""
    rng = np.random.default_rng(7)
    truth = Truth(pattern)
    home = complex(pattern.sites[0].nodes.mean())
    most = 5
    some = gather(pattern, home, 1 + 2j, 3.0, most=most)
    assert len(np.unique(np.round(some.half, 9))) <= 12 * most
    scene = gather(pattern, home, 1 + 2j, 3.0)
    away = 1 + 2j + 3 * in_disc(rng, 20)
    rows = truth.around(home + away, 60.0)
    for p, row in zip(away.tolist(), rows, strict=True):
        bound, _ = two_nearest(some.label, distances(p, some.middle, some.half))
        near, _ = two_nearest(scene.label, distances(p, scene.middle, scene.half))
        assert near == pytest.approx(
            [row[0][0], row[1][0]], rel=0, abs=truth.slack(home + away) + 16 * EPSILON * pattern.scale
        )
        assert (bound >= near).all()


def test_few_elements_of_a_fine_curve_are_gathered() -> None:
    """About a small disc on a curve of hundreds of elements only the near ones are taken."""
    pattern = pattern_of(
        {
            "schema": 1,
            "group": "p2",
            "cell": {"a": 60.0, "b": 50.0, "angle": 77.0},
            "site": [{"tolerance": 1e-5, "strokes": [{"circle": [15, 12], "radius": 9}]}],
        }
    )
    count = len(pattern.sites[0].elements)
    assert count > 1000
    assert len(gather(pattern, 24 + 12j, 0j, 0.1)) < 1.5 * count
    assert len(gather(pattern, 24 + 12j, 0j, 0.1, most=10)) < 200


def test_too_many_elements_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before they are made, and with the way out."""
    monkeypatch.setattr(copies, "_ELEMENTS_MAX", 1000)
    pattern = one("p6", {"segment": [[8, 3], [23, 7]]})
    gather(pattern, 0j, 0j, 10.0)
    with pytest.raises(DesignError, match=r"about [\d.e+]+ copies of elements lie about the image, more than 1,000"):
        gather(pattern, 0j, 0j, 1000.0)


def test_scenes_are_united() -> None:
    """The common table has each copy once, and every old label its row."""
    tables = [np.array([[0, 1, 2], [1, -5, 0], [3, 0, 0]]), np.array([[1, -5, 0], [0, 7, 7]]), np.array([[3, 0, 0]])]
    table, relabel = merge_copies(tables)
    assert len(table) == 4
    for rows, names in zip(tables, relabel, strict=True):
        assert (table[names] == rows).all()


# --- candidate lists ----------------------------------------------------------------------------------------


def lists_of(pattern: Pattern, frame: Frame, looseness: float = 0.0, spare: float = 1e-3) -> BlockLists:
    """The lists of a frame's blocks."""
    scene = gather(pattern, frame.origin, frame.middle, frame.radius)
    return find_candidates(scene, frame, looseness=looseness, spare=spare)


def list_of(lists: BlockLists, block: int) -> Ints:
    """The elements of one block."""
    runs = slice(lists.run_start[block], lists.run_start[block + 1])
    first, last = lists.element_start[runs.start], lists.element_start[runs.stop]
    element: Ints = lists.element[first:last].astype(np.intp)
    size = np.diff(lists.element_start)[runs]
    assert (lists.scene.label[element] == np.repeat(lists.run_label[runs], size)).all()
    assert (np.diff(lists.run_label[runs]) > 0).all()
    assert (size > 0).all()
    assert runs.stop - runs.start >= 2
    return element


@pytest.mark.parametrize("looseness", [0.0, hoff.cone_error(8), hoff.cone_error(4)])
@GROUP
def test_candidate_lists_lose_nothing(group: str, looseness: float) -> None:
    """In a block's disc the two nearest copies and their nearest elements are in its list.

    Loose lists: whatever wrong distances, by that factor, are given to the elements.
    """
    kinds = ("long", "plain", "points") if looseness else ("long", "grid", "several", "special", "plain")
    for pattern, rng in random_patterns(8, group, *kinds):
        frame = random_frame(pattern, rng)
        frame = replace(frame, width=frame.width + 40, height=frame.height + 40, u=frame.u / 2, v=frame.v / 2)
        lists = lists_of(pattern, frame, looseness)
        scene = lists.scene
        assert len(lists) == lists.columns * -(-frame.height // BLOCK)
        assert lists.columns == -(-frame.width // BLOCK)
        for block in rng.integers(0, len(lists), 4).tolist():
            kept = list_of(lists, block)
            row, column = divmod(block, lists.columns)
            middle = frame.offsets((column + 0.5) * BLOCK, (row + 0.5) * BLOCK)
            assert lists.centre[block] == middle
            corners = frame.offsets(np.array([0.0, BLOCK]) + column * BLOCK, np.array([[0.0], [BLOCK]]) + row * BLOCK)
            assert np.abs(corners - middle).max() <= lists.radius * (1 + 1e-9)
            for p in (middle + lists.radius * in_disc(rng, 5)).tolist():
                if abs(p - frame.middle) > frame.radius:
                    continue  # beyond the image: of the last blocks only a part lies in it
                distance = distances(p, scene.middle, scene.half)
                distance *= 1 + looseness * rng.choice((-1.0, 1.0), len(scene))
                near, labels = two_nearest(scene.label, distance)
                again, same = two_nearest(scene.label[kept], distance[kept])
                assert (near == again).all()
                assert (labels == same).all()


def test_lists_of_neighbouring_blocks_are_told_apart() -> None:
    """One block's last copy is the next one's first: at the end of every row of blocks, and of the quadtree's."""
    sites = [{"strokes": [{"point": [x, 0]}]} for x in (60, 30, 0)]
    cell = {"a": 300.0, "b": 300.0, "angle": 90.0}
    pattern = pattern_of({"schema": 1, "group": "p1", "cell": cell, "site": sites})
    frame = rectangle_frame((8.0, -18.0, 44.0, 18.0), 256, 256)
    lists = lists_of(pattern, frame)
    last, first = lists.run_label[lists.run_start[1:-1] - 1], lists.run_label[lists.run_start[1:-1]]
    assert (np.flatnonzero(last == first) + 1).tolist() == list(range(16, 256, 16))
    for block in range(len(lists)):
        assert len(list_of(lists, block)) < 4
    image = Renderer("cpu").render(pattern, frame)
    Truth(pattern).assert_right(image, np.random.default_rng(17), 200)


def test_candidate_lists_are_short() -> None:
    """Most elements of a fine curve are far from most blocks."""
    pattern = one("p4", {"circle": [16, 13], "radius": 10})
    lists = lists_of(pattern, cell_frame(pattern.lattice, 512))
    assert len(pattern.sites[0].elements) > 60
    assert len(lists.element) < 0.05 * len(lists) * len(lists.scene)


def test_lists_are_short_far_from_rows_of_copies() -> None:
    """A thousand units from copies that stand one unit apart hundreds are as near as the nearest, to half a block.

    All but a few are farther everywhere in the block than the nearest two; none of these is lost.
    """
    pattern = one("p1", {"segment": [[0.2, 0.2], [0.6, 0.7]]}, a=2000.0, b=1.0, angle=90.0)
    rng = np.random.default_rng(5)
    frame = Frame(1000 - 40j, 0.1 + 0j, 0.1j, 400, 400)
    lists = lists_of(pattern, frame)
    nearest = np.abs(lists.centre[:, None] - lists.scene.middle).min(axis=1)
    assert nearest.min() > 900
    assert len(lists.run_label) < 16 * len(lists)
    assert len(lists.scene.copies) > 100
    for block in rng.integers(0, len(lists), 40).tolist():
        kept = list_of(lists, block)
        for p in (lists.centre[block] + lists.radius * in_disc(rng, 10)).tolist():
            distance = distances(p, lists.scene.middle, lists.scene.half)
            near, labels = two_nearest(lists.scene.label, distance)
            again, same = two_nearest(lists.scene.label[kept], distance[kept])
            assert (near == again).all()
            assert (labels == same).all()
            third = np.flatnonzero(distance <= near[1] + 1e-3 * lists.radius)
            assert np.isin(third, kept).all()
    everything = lists_of(pattern, frame, spare=math.inf)
    assert len(everything.run_label) > 100 * len(lists)


def test_lists_in_portions_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """However little is handled at once; one root block or many."""
    pattern = one("pgg", {"bspline": [[2, 3], [9, 9], [20, 1], [14, 14], [25, 4]]}, b=50.0)
    frame = replace(cell_frame(pattern.lattice, 200), height=90)
    scene = gather(pattern, frame.origin, frame.middle, frame.radius)
    whole = find_candidates(scene, frame)
    monkeypatch.setattr(candidates, "_PORTION", 300)
    parts = find_candidates(scene, frame)
    assert (whole.element == parts.element).all()
    assert (whole.element_start == parts.element_start).all()
    assert (whole.run_start == parts.run_start).all()
    monkeypatch.setattr(candidates, "_ROOTS", 1000)
    flat = find_candidates(scene, frame)
    assert (flat.centre == whole.centre).all()
    images = [cpu.render(lists, frame) for lists in (whole, flat)]
    assert all((one == other).all() for one, other in zip(*images, strict=True))


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("looseness", [0.0, hoff.cone_error(4)])
@GROUP
def test_the_kernel_makes_the_same_lists(group: str, looseness: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every array has the same bits, with the compiled kernel and with numpy; the lists are no empty ones."""
    patterns = random_patterns(12, group, "plain", "grid", "points", "special", "several", "near")
    for (pattern, rng), spare in zip(patterns, 3 * (1e-3, math.inf), strict=True):
        frame = random_frame(pattern, rng)
        frame = replace(frame, width=frame.width + 60, height=frame.height + 60, u=frame.u / 3, v=frame.v / 3)
        both = []
        for variable in ("", "numpy"):
            monkeypatch.setenv("VORONOI_TILES_KERNELS", variable)
            assert (kernels.library() is None) == bool(variable)
            both.append(lists_of(pattern, frame, looseness, spare))
        for name in ("centre", "run_start", "run_label", "element_start", "element"):
            one, other = (getattr(lists, name) for lists in both)
            assert one.dtype == other.dtype
            assert one.tobytes() == other.tobytes(), name
        assert len(both[0].element) >= 2 * len(both[0])


def test_copies_that_are_far_from_a_block_are_left_out_at_once() -> None:
    """Of a wide picture the first lists hold what lies about their blocks; nothing is lost that `_keep` would keep."""
    pattern = one("p4", {"circle": [16, 13], "radius": 10}, {"point": [40, 41]})
    frame = rectangle_frame((-500.0, -500.0, 500.0, 500.0), 800, 800)
    scene = gather(pattern, frame.origin, frame.middle, frame.radius)
    grid = candidates._grid(frame, 4)
    near = candidates._near(scene, grid, 1.0)
    assert (near.last - near.first).sum() < 0.5 * len(scene) * len(grid.centre)
    first, element = scene.copy_start, np.arange(len(scene), dtype=np.int32)
    everything = candidates._Lists(
        np.array([0, len(first)]), scene.label[first], first, np.append(first[1:], len(scene)), element
    )
    parent, margins = np.arange(len(grid.centre)), candidates._Margins(1.0, 1e-3)
    some = candidates._kept(scene, near, parent, grid, margins)
    whole = candidates._kept(scene, everything, np.zeros_like(parent), grid, margins)
    for name in candidates._Lists._fields:
        assert (getattr(some, name) == getattr(whole, name)).all()


@pytest.mark.parametrize("kind", ["plain", "grid", "several", "long", "wild", "skew"])
def test_records_keep_the_distances_of_their_block(kind: str) -> None:
    """Elements are cut to what is nearest somewhere in the block's disc: no distance changes but by rounding."""
    for pattern, rng in random_patterns(9, "p2", kind, kind, kind):
        frame = random_frame(pattern, rng)
        lists = lists_of(pattern, frame)
        record = element_records(lists, frame)
        assert record.dtype == np.float32
        size = np.diff(lists.element_start)
        block = np.repeat(np.repeat(np.arange(len(lists)), np.diff(lists.run_start)), size)
        away = lists.radius * in_disc(rng, len(block))
        scene, element = lists.scene, lists.element
        whole = distances(lists.centre[block] + away, scene.middle[element], scene.half[element])
        x, y, u, v = record.astype(float).T
        cut = distances(away / frame.pixel, x + 1j * y, u + 1j * v) * frame.pixel
        assert (np.abs(cut - whole) <= 4 * 2.0**-24 * (whole + 2 * lists.radius) + pattern.rounding(frame)).all()
        assert np.abs(u + 1j * v).max() * frame.pixel <= 1.01 * lists.radius


# --- images -------------------------------------------------------------------------------------------------


@GROUP
def test_images_of_every_group(group: str) -> None:
    """Owner, nearest other copy and both distances, for all kinds of sites: as brute force has them."""
    renderer = Renderer("cpu")
    shares = []
    for pattern, rng in random_patterns(10, group, *KINDS, "nearly special", "near"):
        image = renderer.render(pattern, random_frame(pattern, rng))
        shares.append(Truth(pattern).assert_right(image, rng, 20))
        assert image.d1.dtype == np.float64
        assert float(image.error(image.d1.max())) == pattern.rounding(image.frame)
    assert np.mean(shares) > 0.5


@SOME
@given(design=strategies.designs(), seed=st.integers(0, 99))
def test_images_of_random_designs(design: dict[str, Any], seed: int) -> None:
    """The same for whatever Hypothesis thinks of."""
    pattern, rng = pattern_of(design), np.random.default_rng(seed)
    image = Renderer("cpu").render(pattern, random_frame(pattern, rng))
    Truth(pattern).assert_right(image, rng, 12)


@pytest.mark.parametrize(
    "pattern",
    [
        one("p1", LONG_SITE, b=50.0, angle=77.0),
        one("p1", {"point": [7, 9]}, b=50.0, angle=77.0),
        one("p1", {"segment": [[1, 2], [1500, 613]]}, b=50.0, angle=77.0),
        one("p2", {"segment": [[4, 5], [4.2, 400]]}, b=900.0, angle=3.0),
        one("p3", {"segment": [[300005, 2], [300014, 9]]}),
        one("p6m", {"point": [0, 0]}),
        one("p4m", {"point": [30, 30]}, {"point": [30, 20]}),
        one("cmm", {"segment": [[-20, 0], [20, 0]]}, b=30.0),
        one("pm", {"segment": [[9, 0], [12, 3e4]]}, b=4e4),
    ],
    ids=["12 cells long", "point", "25 cells long", "flat cell", "far", "centre", "centres", "mirrors", "slim cell"],
)
@pytest.mark.parametrize("shape", [(1, 1), (1, 40), (33, 17)])
def test_images_of_any_shape(pattern: Pattern, shape: tuple[int, int]) -> None:
    """A single sample, one column, odd sides; over a part of a cell and over several cells."""
    rng = np.random.default_rng(shape)
    truth = Truth(pattern)
    home = complex(pattern.sites[0].nodes.mean())
    extent = math.sqrt(pattern.lattice.det)
    for size in (0.01 * extent, 1.7 * extent):
        region = (home.real, home.imag, home.real + size, home.imag + 0.8 * size)
        image = Renderer("cpu").render(pattern, rectangle_frame(region, *shape))
        truth.assert_right(image, rng, 8)


def corrupt(image: LabelImage, what: str) -> LabelImage:
    """An image with one thing wrong everywhere."""
    match what:
        case "owner":
            return replace(image, first=image.second, second=image.first)
        case "other":
            table = np.append(image.copies, image.copies[:1] + np.array([0, 4, 0]), axis=0)
            return replace(image, second=np.full_like(image.second, len(table) - 1), copies=table)
        case "two names":
            table = np.append(image.copies, image.copies[:1], axis=0)
            return replace(image, copies=table)
        case "d1":
            return replace(image, d1=image.d1 * (1 - 1e-12))
        case "d2":
            return replace(image, d2=image.d2 * (1 + 1e-12))
        case _:
            return replace(image, frame=replace(image.frame, phase=(0.5, 0.5)))


@pytest.mark.parametrize("what", ["owner", "other", "two names", "d1", "d2", "phase"])
def test_the_oracle_sees_wrong_images(what: str) -> None:
    """What it accepts it no longer accepts with one thing wrong."""
    pattern = one("p31m", {"segment": [[20, 7], [22, 3]]})
    image = Renderer("cpu").render(pattern, cell_frame(pattern.lattice, 40))
    truth = Truth(pattern)
    truth.assert_right(image, np.random.default_rng(1))
    with pytest.raises(AssertionError):
        truth.assert_right(corrupt(image, what), np.random.default_rng(1))


@GROUP
def test_an_image_of_a_cell_is_periodic(group: str) -> None:
    """One width or height further on lie the same copies, moved by a lattice vector, equally far."""
    for pattern, _ in random_patterns(11, group, "special", "several"):
        frame = cell_frame(pattern.lattice, 20, centre=complex(pattern.sites[0].nodes.mean()))
        image = Renderer("cpu").render(pattern, frame)
        for column, row in ((frame.width, 0), (-2 * frame.width, 3 * frame.height)):
            beyond = Renderer("cpu").render(pattern, frame.window(column, row, frame.width, frame.height))
            shift = column * frame.u + row * frame.v
            x, y = pattern.lattice.fractional(np.array([shift]))
            rounding = 2 * (pattern.rounding(frame) + pattern.rounding(beyond.frame))
            assert np.abs(beyond.d1 - image.d1).max() <= rounding
            assert np.abs(beyond.d2 - image.d2).max() <= rounding
            decided = image.d2 - image.d1 > 2 * rounding
            moved = image.copies[image.first] + np.array([0, round(float(x[0])), round(float(y[0]))])
            assert (beyond.copies[beyond.first] == moved)[decided].all()


def test_the_error_of_a_frame_far_from_the_origin() -> None:
    """A rectangle a hundred thousand cells further on has the same distances, within what the images state."""
    pattern = one("p4", {"segment": [[5.1, 3.2], [25.3, 11.7]]})
    near, far = (
        Renderer("cpu").render(pattern, rectangle_frame((shift, shift, shift + 64, shift + 64), 64, 64))
        for shift in (0.0, 6e6)
    )
    for here, there in ((near.d1, far.d1), (near.d2, far.d2)):
        assert (np.abs(here - there) <= near.error(here) + far.error(there)).all()


def test_few_runs_at_once_give_the_same_image(monkeypatch: pytest.MonkeyPatch) -> None:
    """How the work is cut into parts does not show."""
    pattern = one("p6", {"segment": [[8, 3], [23, 7]]}, {"point": [20, 3]})
    frame = cell_frame(pattern.lattice, 75)
    lists = lists_of(pattern, frame)
    whole: list[NDArray[Any]] = list(cpu.render(lists, frame))
    for runs in (1, 7, 10**6):
        monkeypatch.setattr(cpu, "_RUNS", runs)
        parts: list[NDArray[Any]] = list(cpu.render(lists, frame))
        assert all(np.array_equal(part, same) for part, same in zip(parts, whole, strict=True))


# --- meshes -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sides", [4, 8, 128])
@pytest.mark.parametrize("group", ["p1", "pgg", "p4m", "p31m", "p6"])
def test_meshes_are_as_wrong_as_they_say(group: str, sides: int) -> None:
    """Cones and tents in float64: distances within the stated error, labels right where that decides."""
    renderer = Renderer("cpu", method="hoff", sides=sides)
    for pattern, rng in random_patterns(12, group, "points", "several", "far"):
        frame = random_frame(pattern, rng)
        image, exact = renderer.render(pattern, frame), Renderer("cpu").render(pattern, frame)
        Truth(pattern).assert_right(image, rng, 8)
        for mesh, true in ((image.d1, exact.d1), (image.d2, exact.d2)):
            assert (np.abs(mesh - true) <= image.error(true)).all()
        decided = exact.d2 - exact.d1 > 2 * image.error(exact.d2)
        assert (image.copies[image.first] == exact.copies[exact.first])[decided].all()


@pytest.mark.parametrize("sides", [4, 8, 128])
def test_the_mesh_error_is_reached(sides: int) -> None:
    """Both too high and too low, between and on the edges of a point's cone."""
    pattern = one("p1", {"point": [7, 9]}, b=60.0, angle=90.0)
    frame = cell_frame(pattern.lattice, 200)
    image = Renderer("cpu", method="hoff", sides=sides).render(pattern, frame)
    exact = Renderer("cpu").render(pattern, frame)
    share = (image.d1 - exact.d1) / image.error(exact.d1)
    assert 0.95 < share.max() <= 1.0
    assert -1.0 <= share.min() < -0.95
    assert hoff.cone_error(sides) == pytest.approx((math.pi / (2 * sides)) ** 2, rel=0.12)


def test_coarse_meshes_differ_visibly() -> None:
    """Cones of four sides give other owners than distances do."""
    pattern = one("p6", {"point": [22, 3]}, {"point": [18, 9]})
    frame = cell_frame(pattern.lattice, 100)
    coarse, fine = (Renderer("cpu", method="hoff", sides=sides).render(pattern, frame) for sides in (4, 128))
    exact = Renderer("cpu").render(pattern, frame)
    assert 0.02 < (coarse.first != exact.first).mean() < 0.4
    assert (fine.first != exact.first).mean() < 0.003
    assert coarse.provenance.method == "hoff, cones of 4 sides"
    assert exact.provenance.method == "exact"


def test_heights_are_those_of_planes() -> None:
    """Beside an element the distance; beyond its ends planes through the cone's edges, which the axis is one of."""
    sides, turn = 8, 2 * math.pi / 8
    across = np.linspace(-5.0, 5.0, 11)
    assert (hoff.heights(np.zeros(11), across, sides) == np.abs(across)).all()
    low = 2 * math.cos(turn / 2) / (1 + math.cos(turn / 2))
    for edge in np.arange(-2, 3) * turn:
        x, y = np.array([3 * math.cos(edge) + 1e-15]), np.array([3 * math.sin(edge)])
        assert hoff.heights(x, y, sides) == pytest.approx(3 * low, rel=1e-12)
        middle = edge + turn / 2
        if middle < math.pi / 2:
            x, y = np.array([3 * math.cos(middle)]), np.array([3 * math.sin(middle)])
            assert hoff.heights(x, y, sides) == pytest.approx(3 * low / math.cos(turn / 2), rel=1e-12)
            # Between two edges the height is linear.
            p, q = (np.exp(1j * angle) for angle in (edge, edge + turn))
            z = 0.3 * p + 0.5 * q
            assert hoff.heights(np.array([z.real]), np.array([z.imag]), sides) == pytest.approx(0.8 * low, rel=1e-12)


# --- distances at any point, and crossings ------------------------------------------------------------------


def judge_of(pattern: Pattern, frame: Frame) -> Judge:
    """The judge of one window."""
    return Judge(pattern, frame, lists_of(pattern, frame))


def test_codes_are_numbers_of_copies() -> None:
    """One to one, for translations of either sign; ascending as rows do."""
    rng = np.random.default_rng(13)
    rows = np.stack((rng.integers(0, 48, 500), *rng.integers(-500_000, 500_000, (2, 500))), axis=1).astype(np.intp)
    codes = encode(rows)
    assert (codes >= 0).all()
    assert (decode(codes) == rows).all()
    assert (rows[np.argsort(codes)] == rows[np.lexsort(rows.T[::-1])]).all()
    assert (decode(encode(rows.reshape(5, 100, 3))) == rows.reshape(5, 100, 3)).all()
    assert int(encode(np.array((2, 0, -1)))) + 3 == int(encode(np.array((2, 0, 2))))


@pytest.mark.parametrize("copy", [(0, 1 << 23, 0), (0, 0, -(1 << 23)), (1 << 14, 0, 0)])
def test_copies_too_far_for_a_code_are_refused(copy: tuple[int, int, int]) -> None:
    """Rather than taken for others; the last ones that are not too far have codes."""
    edge = np.array([[k - (k > 0) + (k < 0) for k in copy]])
    assert (decode(encode(edge)) == edge).all()
    with pytest.raises(DesignError, match="nearer to the origin"):
        encode(np.array([[0, 0, 0], copy]))


@GROUP
def test_distances_at_any_point(group: str) -> None:
    """Copies near a point are the nearest two, at their true distance, and maybe others, which are no nearer."""
    for pattern, rng in random_patterns(14, group, "plain", "special", "several", "far"):
        truth, frame = Truth(pattern), random_frame(pattern, rng)
        window = frame.window(7, 5, frame.width, frame.height)
        x, y = rng.uniform(-0.5, frame.width + 0.5, 15), rng.uniform(-0.5, frame.height + 0.5, 15)
        near = judge_of(pattern, window).near(x, y)
        z = window.points(x, y)
        slack = truth.slack(z) + pattern.rounding(window)
        found: list[dict[Key, float]] = [{} for _ in x]
        columns = (near.point.tolist(), decode(near.copy).tolist(), near.distance.tolist())
        for k, copy, distance in zip(*columns, strict=True):
            key, site, motion = truth.read(copy)
            assert key not in found[k]
            found[k][key] = distance
            assert distance >= float(truth.distance(site, motion, z[[k]])[0]) - slack
        assert (np.diff(near.point) >= 0).all()
        reach = max(sorted(row.values())[1] for row in found) + slack
        for mine, row in zip(found, truth.around(z, reach), strict=True):
            assert sorted(mine.values())[:2] == pytest.approx([row[0][0], row[1][0]], rel=0, abs=slack)
            for distance, key in row:
                assert key in mine or distance >= row[1][0] - slack
            for distance, key in row[:2]:
                assert key not in mine or mine[key] == pytest.approx(distance, rel=0, abs=slack)


class Steps(NamedTuple):
    """Steps between samples of different owners that are decided: places, direction, both owners' codes."""

    column: Ints
    row: Ints
    down: NDArray[np.bool_]
    before: NDArray[np.int64]
    after: NDArray[np.int64]


def steps_of(image: LabelImage) -> Steps:
    """The steps of an image where the owner changes."""
    codes = encode(image.copies)[image.first]
    sure = image.d2 - image.d1 > 4 * image.pattern.rounding(image.frame)
    parts = []
    for down in (False, True):
        ends = (slice(None, -1), slice(None)) if down else (slice(None), slice(None, -1))
        beyond = (slice(1, None), slice(None)) if down else (slice(None), slice(1, None))
        row, column = np.nonzero((codes[ends] != codes[beyond]) & sure[ends] & sure[beyond])
        before, after = codes[ends][row, column], codes[beyond][row, column]
        parts.append((column, row, np.full(len(row), down), before, after))
    return Steps(*(np.concatenate(column) for column in zip(*parts, strict=True)))


@GROUP
def test_crossings_are_equidistant_and_nothing_is_nearer(group: str) -> None:
    """On each step from owner to owner, in their order, by brute force; where the slope is what the distances do."""
    through = 0
    for number, (pattern, rng) in enumerate(random_patterns(15, group, "several", "plain", "special", "grid", "far")):
        home = complex(pattern.sites[0].nodes.mean())
        frame = cell_frame(pattern.lattice, (6, 9, 17, 30, 40)[number], centre=home)
        truth, image = Truth(pattern), Renderer("cpu").render(pattern, frame)
        steps = steps_of(image)
        chosen = rng.permutation(len(steps.column))[:30]
        steps = Steps._make(column[chosen] for column in steps)
        if not len(chosen):
            continue
        found = judge_of(pattern, frame).certify(*steps)
        z = frame.origin + found.place
        start = frame.points(steps.column.astype(float), steps.row.astype(float))[found.step]
        along = (z - start) / np.where(steps.down, frame.v, frame.u)[found.step]
        assert np.abs(along.imag).max() <= 1e-6
        assert along.real.min() >= -1e-6
        assert along.real.max() <= 1 + 1e-6
        order = np.lexsort((along.real, found.step))
        step, before, after = found.step[order], found.before[order], found.after[order]
        fresh = np.append(True, step[1:] != step[:-1])
        assert (step[fresh] == np.arange(len(chosen))).all()
        assert (before[fresh] == steps.before).all()
        assert (after[np.append(fresh[1:], True)] == steps.after).all()
        assert (before[1:] == after[:-1])[~fresh[1:]].all()
        assert (before != after).all()
        through += len(step) - len(chosen)

        slack = truth.slack(z) + 4 * pattern.rounding(frame)
        away = 1e-5 * frame.pixel
        probes = z[:, None] + away * np.array([0, 1, -1, 1j, -1j])
        sides = np.empty((2, *probes.shape))
        for side, codes in enumerate((found.before, found.after)):
            for code in np.unique(codes):
                chosen = codes == code
                _, site, motion = truth.read(decode(code).tolist())
                sides[side, chosen] = truth.distance(site, motion, probes[chosen].ravel()).reshape(-1, 5)
        assert np.abs(sides[0, :, 0] - sides[1, :, 0]).max() <= slack
        alone = np.ones(len(z), bool)
        for k, row in enumerate(truth.around(z, float(sides[:, :, 0].max()) + slack)):
            assert row[0][0] >= sides[:, k, 0].max() - slack
            alone[k] = len(row) < 3 or row[2][0] > sides[:, k, 0].max() + slack
        difference = sides[0] - sides[1]
        slope = np.hypot(difference[:, 1] - difference[:, 2], difference[:, 3] - difference[:, 4]) / (2 * away)
        smooth = np.abs(difference[:, 1:].sum(axis=1)) / away <= 1e-3 + 8 * slack / away
        assert smooth.mean() > 0.8
        # Where a third copy is as near the edge may end: never is the slope greater for that.
        assert not (found.alone & ~alone).any()
        assert np.abs(slope - found.slope)[smooth & alone].max() <= 1e-3 + 8 * slack / away
        assert (found.slope - slope)[smooth].max() <= 1e-3 + 8 * slack / away
    assert through > 0


@pytest.mark.parametrize("exponent", [-5, -6, -7])
def test_crossings_between_copies_that_are_nearly_the_same(exponent: int) -> None:
    """The difference of their distances is flat on either side of an edge, and jumps within a tiny part of a step."""
    start, end, twist = 4.164680333 + 6.872547183j, 1.680917062 + 15.674852476j, 10.0**exponent
    strokes = [
        {"segment": [[z.real, z.imag], [w.real, w.imag]]} for z, w in ((start, end), (-twist - start, -twist - end))
    ]
    pattern = one("pgg", *strokes, b=60.0)
    truth, rng = Truth(pattern), np.random.default_rng(-exponent)
    for _ in range(8):
        frame = cell_frame(pattern.lattice, 96, centre=complex(*rng.uniform(0, 60, 2)))
        steps = steps_of(Renderer("cpu").render(pattern, frame))
        found = judge_of(pattern, frame).certify(*steps)
        sides = np.empty((2, len(found.place)))
        for side, codes in enumerate((found.before, found.after)):
            for code in np.unique(codes):
                _, site, motion = truth.read(decode(code).tolist())
                sides[side, codes == code] = truth.distance(site, motion, frame.origin + found.place[codes == code])
        assert np.abs(sides[0] - sides[1]).max() <= truth.slack(frame.origin + found.place) + pattern.rounding(frame)


def test_nothing_asked_nothing_answered() -> None:
    """No points, no steps."""
    pattern = one("p2", {"point": [7, 9]}, b=60.0, angle=90.0)
    asked = judge_of(pattern, cell_frame(pattern.lattice, 20))
    none = np.zeros(0)
    assert [len(column) for column in asked.near(none, none)] == [0, 0, 0]
    ints, codes = none.astype(np.intp), none.astype(np.int64)
    assert [len(column) for column in asked.certify(ints, ints, none.astype(bool), codes, codes)] == [0] * 6


def test_judging_in_portions_is_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """However little is handled at once."""
    pattern = one("p4g", {"segment": [[2, 3], [9, 9]]}, {"point": [20, 3]})
    frame = cell_frame(pattern.lattice, 20)
    asked, steps = judge_of(pattern, frame), steps_of(Renderer("cpu").render(pattern, frame))
    x, y = np.random.default_rng(16).uniform(0, 20, (2, 50))
    near, crossings = asked.near(x, y), asked.certify(*steps)
    monkeypatch.setattr(judge, "_PORTION", 50)
    for whole, parts in ((near, asked.near(x, y)), (crossings, asked.certify(*steps))):
        orders = [np.lexsort((found[1], found[0])) for found in (whole, parts)]
        for one_column, other in zip(whole, parts, strict=True):
            assert (one_column[orders[0]] == other[orders[1]]).all()

"""Crossings of lines, arcs and quadratic curves, against chords of dense samples and closed forms."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
import shapely

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.paths.intersections import candidate_pairs, crossings, point_at, split, tangent_at
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths
from voronoi_tiles.paths.segments import Circles, boxes

DENSE = 2001
"""Points on each piece where an oracle takes chords."""


def single(start: Complexes, end: Complexes, control: Complexes, kind: npt.ArrayLike) -> Paths:
    """Open paths of one piece each."""
    n = len(start)
    kinds = np.broadcast_to(np.asarray(kind, np.uint8), n).copy()
    controls = np.stack((np.where(kinds == LINE, 0, control), np.zeros(n)), axis=1)
    return Paths(start, end, controls, kinds, np.arange(n + 1), np.zeros(n, np.bool_))


def one(start: complex, end: complex, control: complex = 0j, kind: int = LINE) -> Paths:
    """One piece."""
    return single(np.array([start]), np.array([end]), np.array([control]), kind)


def somewhere(rng: np.random.Generator, n: int) -> Complexes:
    """Random points of a square."""
    return np.asarray(rng.uniform(-1, 1, n) + 1j * rng.uniform(-1, 1, n))


def random_pieces(rng: np.random.Generator, n: int, kinds: list[int], *, scale: float = 1, shift: complex = 0) -> Paths:
    """Random pieces; arcs from almost straight ones to almost whole circles."""
    start, end, free = (somewhere(rng, n) * scale + shift for _ in range(3))
    kind = rng.choice(kinds, n).astype(np.uint8)
    bulge = np.tan(rng.uniform(-1.4, 1.4, n) * rng.choice([1e-9, 1e-4, 0.1, 1], n))
    middle = (start + end) / 2 - 0.5j * bulge * (end - start)
    return single(start, end, np.where(kind == ARC, middle, free), kind)


def samples(paths: Paths, count: int = DENSE) -> Complexes:
    """Points on each piece by textbook formulas, circles by three points; shape (n, count)."""
    t = np.linspace(0, 1, count)
    a, b, c = paths.start[:, None], paths.control[:, :1], paths.end[:, None]
    rows = np.where(paths.kind[:, None] == QUAD, a * (1 - t) ** 2 + 2 * b * t * (1 - t) + c * t**2, a + (c - a) * t)
    for k in np.flatnonzero(paths.kind == ARC):
        u, v = paths.control[k, 0] - a[k, 0], c[k, 0] - a[k, 0]
        cross = 2 * (u * v.conjugate()).imag
        if abs(cross) < 1e-7 * abs(v) ** 2:
            continue
        centre = a[k, 0] + 1j * (abs(v) ** 2 * u - abs(u) ** 2 * v) / cross * -1
        first, last = np.angle((paths.control[k, 0] - centre) / (a[k, 0] - centre)), 0.0
        last = 2 * first
        rows[k] = centre + (a[k, 0] - centre) * np.exp(1j * last * t)
    return rows


def chords(rows: Complexes) -> npt.NDArray[np.object_]:
    """Polylines through the points of each row."""
    return np.asarray(shapely.linestrings(np.stack((rows.real, rows.imag), axis=-1)))


@pytest.mark.parametrize("kinds", [([LINE], [LINE]), ([LINE, ARC], [LINE, ARC]), ([QUAD], [LINE]), ([QUAD], [ARC])])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_crossings_are_those_of_dense_chords(kinds: tuple[list[int], list[int]], seed: int) -> None:
    """As many crossings as polylines have, at the same places."""
    rng = np.random.default_rng(seed)
    n = 400
    first, second = random_pieces(rng, n, kinds[0]), random_pieces(rng, n, kinds[1])
    every = np.arange(n)
    found = crossings(first, every, second, every)
    met = shapely.intersection(chords(samples(first)), chords(samples(second)))
    expected = [shapely.get_coordinates(geometry) @ [1, 1j] for geometry in met]
    assert not len(found.overlaps)
    assert len(found.pair) > n / 8
    for k in range(n):
        ours = found.point[found.pair == k]
        assert len(ours) == len(expected[k])
        if len(ours):
            assert np.abs(ours[:, None] - expected[k]).min(axis=0).max() < 1e-4


@pytest.mark.parametrize("shift", [0, 600 + 300j])
def test_points_lie_on_both_pieces(shift: complex) -> None:
    """The point is where both parameters say, to a few ulps of the coordinates."""
    rng = np.random.default_rng(11)
    n = 4000
    first = random_pieces(rng, n, [LINE, QUAD, ARC], shift=shift)
    second = random_pieces(rng, n, [LINE, ARC], shift=shift)
    every = np.arange(n)
    found = crossings(first, every, second, every)
    ulp = np.spacing(abs(shift) + 1)
    assert np.abs(point_at(first, found.pair, found.t) - found.point).max() < 16 * ulp
    assert np.abs(point_at(second, found.pair, found.u) - found.point).max() < 64 * ulp
    assert ((found.t >= 0) & (found.t <= 1) & (found.u >= 0) & (found.u <= 1)).all()
    assert (np.diff(found.pair) >= 0).all()


def test_a_wrong_crossing_is_seen() -> None:
    """The oracle of the points fails where a parameter is off by a millionth."""
    first, second = one(0, 2 + 2j), one(2j, 2 + 0j, 1 - 0.3j, ARC)
    found = crossings(first, np.array([0]), second, np.array([0]))
    assert abs(point_at(first, found.pair, found.t) - found.point)[0] < 1e-15
    assert abs(point_at(first, found.pair, found.t + 1e-6) - found.point)[0] > 1e-7


def meeting(first: Paths, second: Paths) -> tuple[Floats, Floats, Ints]:
    """Where two pieces meet, and whether they overlap."""
    found = crossings(first, np.array([0]), second, np.array([0]))
    return found.t, found.u, found.overlaps


@pytest.mark.parametrize("turn", [1, 1j, np.exp(0.3j), np.exp(2j)])
def test_ends_count(turn: complex) -> None:
    """Pieces that meet at ends, or with an end inside the other, meet once, at the end's own parameter."""
    a, b, c = 0.1 * turn, (0.7 + 0.2j) * turn, (0.3 + 0.9j) * turn
    t, u, _ = meeting(one(a, b), one(b, c))
    assert (t.tolist(), u.tolist()) == ([1], [0])
    t, u, _ = meeting(one(a, b), one(c, (a + b) / 2))
    assert t == pytest.approx([0.5])
    assert u.tolist() == [1]
    t, u, overlaps = meeting(one(a, b), one(b, 2 * b - a))
    assert (t.tolist(), u.tolist(), overlaps.tolist()) == ([1], [0], [])
    half, rest = one(1 * turn, -1 * turn, 1j * turn, ARC), one(-1 * turn, 1 * turn, -1j * turn, ARC)
    t, u, overlaps = meeting(half, rest)
    assert overlaps.tolist() == []
    assert (t.tolist(), u.tolist()) == ([0, 1], [1, 0])


@pytest.mark.parametrize("turn", [1, np.exp(0.3j)])
def test_tangential_contacts_are_points(turn: complex) -> None:
    """Circles, lines and parabolas that touch give the point once or twice."""
    circle = one(turn * 1, turn * -1, turn * 1j, ARC)
    for other in (one(turn * (-2 + 1j), turn * (2 + 1j)), one(turn * (1 + 2j), turn * (-1 + 2j), turn * 1j, ARC)):
        t, u, overlaps = meeting(circle, other)
        assert 1 <= len(t) <= 2
        assert t == pytest.approx(0.5, abs=1e-7)
        assert u == pytest.approx(0.5, abs=1e-7)
        assert not len(overlaps)
    bowl = one(turn * (-1 + 2j), turn * (1 + 2j), turn * 0j, QUAD)
    t, u, _ = meeting(bowl, one(turn * (-1 + 1j), turn * (1 + 1j)))
    assert 1 <= len(t) <= 2
    assert t == pytest.approx(0.5, abs=1e-7)
    t, u, _ = meeting(bowl, one(turn * 1, turn * -1, turn * 1j, ARC))
    assert t == pytest.approx(0.5, abs=1e-6)
    assert 1 <= len(t) <= 2


def test_near_misses_are_none() -> None:
    """A gap of a millionth of a millionth is a gap."""
    circle = one(1, -1, 1j, ARC)
    t, _, _ = meeting(circle, one(-2 + (1 + 1e-12) * 1j, 2 + (1 + 1e-12) * 1j))
    assert not len(t)
    t, _, _ = meeting(one(0, 1), one(1 + 1e-12, 2 + 1j))
    assert not len(t)


@pytest.mark.parametrize("turn", [1, np.exp(0.3j)])
def test_overlaps_are_reported(turn: complex) -> None:
    """Lines on one line, arcs on one circle: no points, but the pair; parallel ones are nothing."""
    at = turn * np.exp(1j * np.linspace(0, 3, 7))
    arc, shifted = one(at[0], at[4], at[2], ARC), one(at[2], at[6], at[4], ARC)
    apart = one(at[5], at[6], turn * np.exp(2.75j), ARC)
    for first, second in (
        (one(0, turn), one(0.5 * turn, 2 * turn)),
        (one(0, turn), one(turn, 0)),
        (arc, shifted),
        (arc, arc),
    ):
        t, _, overlaps = meeting(first, second)
        assert overlaps.tolist() == [0]
        assert not len(t)
    for first, second in ((arc, apart), (one(0, turn), one(0.1j * turn, turn + 0.1j * turn))):
        t, _, overlaps = meeting(first, second)
        assert not len(t)
        assert not len(overlaps)


def test_other_kinds_are_refused() -> None:
    """Cubic curves, and quadratic ones on the second side, are no input."""
    line, quad, cubic = one(0, 1), one(0, 1, 1j, QUAD), one(0, 1, 1j, CUBIC)
    for first, second in ((cubic, line), (line, quad), (line, cubic)):
        with pytest.raises(ValueError, match="only lines"):
            crossings(first, np.array([0]), second, np.array([0]))
    for function in (point_at, tangent_at):
        with pytest.raises(ValueError, match="cubic"):
            function(cubic, np.array([0]), np.array([0.5]))
    none = np.zeros(0, np.intp)
    assert not len(crossings(line, none, line, none).pair)


def test_points_and_directions() -> None:
    """Points are those of the textbook, directions those of short chords; the ends have the paths' bits."""
    rng = np.random.default_rng(5)
    n = 500
    paths = random_pieces(rng, n, [LINE, QUAD, ARC])
    every, rows = np.arange(n), samples(paths, 5)
    for k in range(5):
        assert np.abs(point_at(paths, every, np.full(n, k / 4)) - rows[:, k]).max() < 1e-7
    assert (point_at(paths, every, np.zeros(n)) == paths.start).all()
    assert (point_at(paths, every, np.ones(n)) == paths.end).all()
    t = rng.uniform(0.01, 0.99, n)
    chord = point_at(paths, every, t + 1e-6) - point_at(paths, every, t - 1e-6)
    assert np.abs(chord / np.abs(chord) - tangent_at(paths, every, t)).max() < 1e-8


def test_parts_are_parts() -> None:
    """A part runs where the piece does, and takes the ends that it is given."""
    rng = np.random.default_rng(6)
    n = 500
    paths = random_pieces(rng, n, [LINE, QUAD, ARC])
    every = np.arange(n)
    t0, t1 = np.sort(rng.uniform(0, 1, (2, n)), axis=0)
    w = rng.uniform(0, 1, n)
    part = split(paths, every, t0, t1)
    assert np.abs(point_at(part, every, w) - point_at(paths, every, t0 + (t1 - t0) * w)).max() < 1e-13
    given = split(paths, every, t0, t1, part.end, part.start)
    assert (given.start == part.end).all()
    assert (given.end == part.start).all()


def test_boxes_are_the_smallest() -> None:
    """Boxes hold all samples, and no side is farther out than the samples' spacing lets it be."""
    paths = random_pieces(np.random.default_rng(7), 500, [LINE, QUAD, ARC])
    rows = samples(paths)
    low_x, low_y, high_x, high_y = boxes(paths).T
    for low, high, values in ((low_x, high_x, rows.real), (low_y, high_y, rows.imag)):
        assert (low <= values.min(axis=1) + 1e-7).all()
        assert (high >= values.max(axis=1) - 1e-7).all()
        assert np.abs(low - values.min(axis=1)).max() < 1e-4
        assert np.abs(high - values.max(axis=1)).max() < 1e-4


@pytest.mark.parametrize("margin", [0, 0.1])
def test_candidates_are_all_pairs_of_near_boxes(margin: float) -> None:
    """The pairs are those that comparing all boxes with all gives."""
    rng = np.random.default_rng(8)
    first, second = (random_pieces(rng, 60, [LINE, QUAD, ARC], scale=0.2, shift=somewhere(rng, 1)[0]) for _ in range(2))
    i, j = candidate_pairs(first, second, margin)
    a, b = boxes(first)[:, None], boxes(second)[None]
    near = (a[..., :2] - margin <= b[..., 2:]).all(axis=-1) & (a[..., 2:] + margin >= b[..., :2]).all(axis=-1)
    assert np.array_equal(np.stack((i, j), axis=1), np.argwhere(near))
    assert all(len(found) == 0 for found in candidate_pairs(first, Paths.empty()))


def test_distances_are_those_of_dense_chords() -> None:
    """The distance of a point from an arc or line is that from its samples, the centre's included."""
    rng = np.random.default_rng(9)
    paths = random_pieces(rng, 300, [LINE, ARC])
    points = somewhere(rng, 300) * 2
    ours = Circles.of(paths, np.arange(300)).distance(points)
    assert np.abs(ours - np.abs(samples(paths) - points[:, None]).min(axis=1)).max() < 2e-3
    half = Circles.of(one(1, -1, 1j, ARC), np.array([0]))
    assert half.distance(np.array([0j]))[0] == pytest.approx(1, abs=1e-15)
    assert half.distance(np.array([-0.5j]))[0] == pytest.approx(np.hypot(1, 0.5), abs=1e-15)


@pytest.mark.parametrize("radius", [0.3, 0.02, 1e-3, 1e-4])
@pytest.mark.parametrize("at", [0.07, 0.31, 0.5, 0.83])
def test_a_tiny_arc_across_a_long_parabola(radius: float, at: float) -> None:
    """A circle that is small beside the curve, as a kerf's corners are, still finds it: half an arc crosses once."""
    p, q, r = 0j, 60 + 80j, 120 + 0j
    place = (1 - at) ** 2 * p + 2 * at * (1 - at) * q + at**2 * r
    along = (1 - at) * (q - p) + at * (r - q)
    along /= abs(along)
    curve = Paths(
        np.array([p]),
        np.array([r]),
        np.array([[q, 0]]),
        np.array([QUAD], np.uint8),
        np.array([0, 1]),
        np.zeros(1, bool),
    )
    # Half a circle about the place, from one side of the curve to the other.
    start, middle, end = place - 1j * radius * along, place + radius * along, place + 1j * radius * along
    arc = Paths(
        np.array([start]),
        np.array([end]),
        np.array([[middle, 0]]),
        np.array([ARC], np.uint8),
        np.array([0, 1]),
        np.zeros(1, bool),
    )
    met = crossings(curve, np.array([0]), arc, np.array([0]))
    assert len(met.point) == 1
    assert abs(abs(met.point[0] - place) - radius) < 1e-12

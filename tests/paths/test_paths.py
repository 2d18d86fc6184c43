"""Paths as arrays: what their methods give, against dense samples and quadrature."""

from __future__ import annotations

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from helpers.sheets import check_joints, circle, points_on
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.base.arrays import Complexes, Floats, ranges
from voronoi_tiles.base.maps import from_matrix, move
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

SETTINGS = settings(max_examples=100, deadline=None, derandomize=True)
T = np.linspace(0, 1, 501)


@st.composite
def drawings(draw: st.DrawFn) -> Paths:
    """Paths of all kinds of pieces, open and closed, on a grid of eighths: pieces in line, flat and round ones."""
    point = st.builds(complex, st.integers(-40, 40), st.integers(-40, 40)).map(lambda z: z / 8)
    parts = []
    for _ in range(draw(st.integers(1, 4))):
        corners = draw(st.lists(point, min_size=3, max_size=6, unique=True))
        path = Paths.polylines([corners], closed=draw(st.booleans()))
        count = len(path.start)
        kind = np.array(
            draw(st.lists(st.sampled_from([LINE, QUAD, CUBIC, ARC]), min_size=count, max_size=count)), np.uint8
        )
        free = np.array([[draw(point), draw(point)] for _ in range(count)])
        bulge = np.array([draw(st.sampled_from([-1.7, -1.0, -0.3, -1e-4, 1e-5, 0.2, 1.0, 2.5])) for _ in range(count)])
        middle = (path.start + path.end) / 2 - 0.5j * bulge * (path.end - path.start)
        control = np.zeros((count, 2), np.complex128)
        control[:, 0] = np.where(kind == ARC, middle, np.where(kind == LINE, 0, free[:, 0]))
        control[:, 1] = np.where(kind == CUBIC, free[:, 1], 0)
        parts.append(Paths(path.start, path.end, control, kind, path.offsets, path.closed))
    return Paths.concatenate(parts)


def samples(paths: Paths) -> list[Complexes]:
    """Dense points of every piece; what is nearly straight by its bend alone."""
    return [points_on(paths, k, T) for k in range(len(paths.start))]


def assert_same(one: Paths, other: Paths) -> None:
    """Assert that all arrays have the same bits."""
    for name in ("start", "end", "control", "kind", "offsets", "closed"):
        assert getattr(one, name).tolist() == getattr(other, name).tolist(), name
        assert getattr(one, name).dtype == getattr(other, name).dtype, name


@SETTINGS
@given(drawings())
def test_reversed(paths: Paths) -> None:
    """The same points backwards; twice is the same; only those with a flag."""
    back = paths.reversed()
    check_joints(back)
    assert_same(back.reversed(), paths)
    assert_same(paths.reversed(np.ones(len(paths), np.bool_)), back)
    assert_same(paths.reversed(np.zeros(len(paths), np.bool_)), paths)
    for k in range(len(paths)):
        first, stop = int(paths.offsets[k]), int(paths.offsets[k + 1])
        for j in range(first, stop):
            mirrored = first + stop - 1 - j
            assert np.abs(points_on(back, j, T)[::-1] - points_on(paths, mirrored, T)).max() < 1e-9
    flags = np.arange(len(paths)) % 2 == 0
    mixed = paths.reversed(flags)
    for k in range(len(paths)):
        assert_same(mixed.take(np.array([k])), (back if flags[k] else paths).take(np.array([k])))


@SETTINGS
@given(drawings(), st.floats(-3, 3), st.floats(0.1, 5), st.booleans())
def test_moved(paths: Paths, angle: float, scale: float, conj: bool) -> None:
    """The image of every point; lengths are scaled, and turns keep their sense or lose it."""
    factor, shift = complex(scale * np.exp(1j * angle)), 3 - 2j
    image = paths.moved(factor, shift, conj=conj)
    check_joints(image)
    for before, after in zip(samples(paths), samples(image), strict=True):
        assert np.abs(factor * (before.conj() if conj else before) + shift - after).max() < 1e-8
    assert image.lengths == pytest.approx(paths.lengths * scale, rel=1e-7)
    assert image.bulges() == pytest.approx(paths.bulges() * (-1 if conj else 1), rel=1e-9, abs=1e-12)
    assert (image.control[image.kind == LINE] == 0).all()
    assert (image.control[image.kind != CUBIC, 1] == 0).all()


@SETTINGS
@given(drawings(), st.tuples(*[st.floats(-3, 3)] * 6))
def test_mapped(paths: Paths, parts: tuple[float, ...]) -> None:
    """The image of every point of what is no circular arc under an affine map, joined where it was."""
    a, b, c, d, e, f = parts
    paths = paths.take(np.flatnonzero(np.bincount(paths.owner, paths.kind == ARC, len(paths)) == 0))
    image = paths.mapped(from_matrix(*parts))
    check_joints(image)
    for before, after in zip(samples(paths), samples(image), strict=True):
        x, y = before.real, before.imag
        assert np.abs((a * x + c * y + e) + 1j * (b * x + d * y + f) - after).max(initial=0.0) < 1e-8
    assert (image.control[image.kind == LINE] == 0).all()
    assert (image.control[image.kind != CUBIC, 1] == 0).all()


@SETTINGS
@given(drawings())
def test_shifted(paths: Paths) -> None:
    """Every path is moved by its own vector; the lengths of the paths stay."""
    vectors = np.arange(len(paths), dtype=np.complex128) * (1 - 2j)
    image = paths.shifted(vectors[paths.owner])
    check_joints(image)
    for k, vector in enumerate(vectors.tolist()):
        alone = paths.take(np.array([k]))
        assert_same(image.take(np.array([k])), alone.moved(1.0, vector))
        assert image.path_lengths[k] == pytest.approx(alone.lengths.sum(), rel=1e-7, abs=1e-9)


@SETTINGS
@given(drawings())
def test_bounds_against_samples(paths: Paths) -> None:
    """No sample is outside, and some are near each side."""
    points = np.concatenate(samples(paths))
    left, bottom, right, top = paths.bounds
    found = (points.real.min(), points.imag.min(), points.real.max(), points.imag.max())
    slack = 1e-9
    assert left <= found[0] + slack
    assert bottom <= found[1] + slack
    assert right >= found[2] - slack
    assert top >= found[3] - slack
    assert (left, bottom, right, top) == pytest.approx(found, abs=1e-2)


@SETTINGS
@given(drawings())
def test_lengths_against_chords(paths: Paths) -> None:
    """Of 40,000 chords: too short by some 1e-9 of the length, at cusps and where a curve runs back on itself too."""
    fine = np.linspace(0, 1, 40_001)
    for k in range(len(paths.start)):
        chords = float(np.abs(np.diff(points_on(paths, k, fine))).sum())
        assert paths.lengths[k] == pytest.approx(chords, rel=1e-7)


def test_lengths_of_cubic_curves_in_closed_form() -> None:
    """One that is a line run through evenly, one that runs out and back, two parabolas, one with a cusp."""
    start = np.array([0, 0, -1 + 1j])
    control = np.array([[1, 2], [4, 0], [-1 / 3 - 1j / 3, 1 / 3 - 1j / 3]])
    end = np.array([3, 0, 1 + 1j])
    # The second: 12 t (1 - t)^2, up to t = 1/3 and back; the third: (t, t^2) for -1 <= t <= 1, a parabola.
    paths = Paths(start, end, control, np.full(3, CUBIC, np.uint8), np.arange(4), np.zeros(3, np.bool_))
    parabola = np.sqrt(5) + np.arcsinh(2) / 2
    assert paths.lengths == pytest.approx([3, 2 * 12 * (1 / 3) * (4 / 9), parabola], rel=1e-10)
    cusp = Paths.polylines([[-1 + 1j, 1 + 1j]])
    # (t^3, t^2) for -1 <= t <= 1: its length is 2 (13^(3/2) - 8) / 27.
    cusp = replace(cusp, control=np.array([[1 - 1j / 3, -1 - 1j / 3]]), kind=np.array([CUBIC], np.uint8))
    assert cusp.lengths[0] == pytest.approx(2 * (13**1.5 - 8) / 27, rel=1e-10)


def test_lengths_of_circles() -> None:
    """In closed form, whichever way round, in however many parts."""
    for parts in (2, 3, 7):
        for hole in (False, True):
            ring = circle(2 + 1j, 3, hole=hole, parts=parts, turn=0.4)
            assert ring.lengths.sum() == pytest.approx(6 * np.pi, rel=1e-14)
            assert ring.bounds == pytest.approx((-1, -2, 5, 4), abs=1e-12)
            centre, radius, begin, turn = ring.circles(np.arange(parts))
            assert np.abs(centre - (2 + 1j)).max() < 1e-13
            assert radius == pytest.approx(np.full(parts, 3.0), rel=1e-13)
            assert turn.sum() == pytest.approx(-2 * np.pi if hole else 2 * np.pi, rel=1e-13)
            assert np.abs(centre + radius * np.exp(1j * begin) - ring.start).max() < 1e-13


@pytest.mark.parametrize("turn", [-6.0, -np.pi, -1.0, -1e-6, 1e-6, 0.5, np.pi, 5.0])
def test_arcs_by_their_angle(turn: float) -> None:
    """Bulge, radius and turn of arcs from nearly straight ones to nearly whole circles."""
    at = np.exp(1j * np.array([0.3, 0.3 + turn / 2, 0.3 + turn])) * 4
    arc = replace(Paths.polylines([at[[0, 2]]]), control=np.array([[at[1], 0]]), kind=np.array([ARC], np.uint8))
    # The middle is rounded, by some 1e-16 of its place.
    error = 1e-12 + 1e-9 / abs(turn)
    assert arc.bulges()[0] == pytest.approx(np.tan(turn / 4), rel=error)
    radius, angle = arc.arc_radius_and_turn(np.zeros(1, np.intp))
    assert radius[0] == pytest.approx(4, rel=error)
    assert angle[0] == pytest.approx(turn, rel=error)
    assert arc.lengths[0] == pytest.approx(4 * abs(turn), rel=1e-9)


@SETTINGS
@given(drawings(), st.data())
def test_take_and_concatenate(paths: Paths, data: st.DataObject) -> None:
    """Any paths in any order, some of them twice; one after another they are the whole again."""
    assert_same(Paths.concatenate([paths.take(np.array([k])) for k in range(len(paths))]), paths)
    chosen = data.draw(st.lists(st.integers(0, len(paths) - 1), max_size=5))
    taken = paths.take(np.array(chosen, np.intp))
    assert len(taken) == len(chosen)
    for place, k in enumerate(chosen):
        assert_same(taken.take(np.array([place])), paths.take(np.array([k])))
    assert taken.owner.tolist() == np.repeat(np.arange(len(chosen)), paths.counts[chosen]).tolist()


def test_empty_paths() -> None:
    """Nothing is a drawing too; only it has no bounds."""
    none = Paths.empty()
    for same in (
        Paths.concatenate([]),
        Paths.polylines([]),
        none.reversed(),
        none.moved(2, 1j),
        none.take(np.zeros(0, np.intp)),
    ):
        assert_same(same, none)
    assert not len(none)
    assert not len(none.lengths)
    with pytest.raises(ValueError, match="no bounds"):
        _ = none.bounds


def test_polylines() -> None:
    """Open ones have a piece less; closed ones come back."""
    corners = [0j, 1 + 0j, 1 + 2j]
    both = Paths.concatenate([Paths.polylines([corners, corners[:2]]), Paths.polylines([corners], closed=True)])
    check_joints(both)
    assert both.counts.tolist() == [2, 1, 3]
    assert both.closed.tolist() == [False, False, True]
    assert both.lengths.tolist() == [1, 2, 1, 1, 2, np.sqrt(5)]


@SETTINGS
@given(st.lists(st.tuples(st.integers(-5, 50), st.integers(0, 6))))
def test_ranges(rows: list[tuple[int, int]]) -> None:
    """As Python's own."""
    first, counts = np.array(rows, np.intp).reshape(-1, 2).T
    assert ranges(first, counts).tolist() == [k for a, n in rows for k in range(a, a + n)]


def test_a_moved_point_has_the_same_bits_wherever_it_stands() -> None:
    """In arrays of any length and at any place of them."""
    rng = np.random.default_rng(3)
    points = rng.standard_normal(1000) + 1j * rng.standard_normal(1000)
    factor, shift = complex(np.exp(0.7j)), 0.1 + 0.3j
    whole = move(points, factor, shift)
    alone: Floats = np.array([move(points[k : k + 1], factor, shift)[0] for k in range(1000)])
    assert (whole == alone).all()
    assert (whole[::-1] == move(points[::-1], factor, shift)).all()


def test_the_oracle_of_joints_sees_a_bit() -> None:
    """One ulp off is not joined."""
    ring = Paths.polylines([[0j, 1 + 0j, 1j]], closed=True)
    check_joints(ring)
    for k in range(3):
        start = ring.start.copy()
        start[k] = complex(np.nextafter(start[k].real, 9), start[k].imag)
        with pytest.raises(AssertionError):
            check_joints(replace(ring, start=start))


def test_an_arc_may_be_flat() -> None:
    """The middle of its chord is on it: as long as the chord, and no warning."""
    flat = Paths(
        np.array([0j]),
        np.array([4 + 3j]),
        np.array([[2 + 1.5j, 0]]),
        np.array([ARC], np.uint8),
        np.array([0, 1]),
        np.zeros(1, bool),
    )
    assert flat.lengths.tolist() == [5.0]
    radius, turn = flat.arc_radius_and_turn(np.array([0]))
    assert radius[0] == np.inf
    assert turn[0] == 0.0


@pytest.mark.parametrize("turn", [1e-9, 1e-3, 0.1, 0.39, 0.41, 1.0, 3.0, 3.14159, 4.5, 6.0])
@pytest.mark.parametrize("side", [1, -1])
def test_the_area_of_a_segment_of_a_disc(turn: float, side: int) -> None:
    """Between an arc and its chord, flat or nearly a whole circle, with all digits."""
    with mpmath.workdps(40):
        t = mpmath.mpf(turn)
        wanted = side * (t - mpmath.sin(t)) / 2
        a, b, middle = (mpmath.expj(side * part) for part in (0, t, t / 2))
        # About the middle of the chord and in chords, so that the flattest one keeps its digits in float64.
        size = abs(b - a)
        start, end, through = (complex((z - (a + b) / 2) / size) for z in (a, b, middle))
        area = float(wanted / size**2)
    ends, kinds = np.array([start, end]), np.array([ARC, LINE], np.uint8)
    both = Paths(ends, ends[::-1], np.array([[through, 0], [0, 0]]), kinds, np.array([0, 2]), np.ones(1, bool))
    assert ring_areas(both)[0] == pytest.approx(area, rel=1e-9 if turn < 1e-6 else 1e-13)

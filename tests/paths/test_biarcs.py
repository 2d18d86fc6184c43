"""Curves replaced by biarcs, chords and other curves: within the accuracy, the fewest, the same both ways."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from helpers.curves import Points, arc, assert_joined, chain, distance, runs_of, same, smooth_side
from hypothesis import example, given, settings
from hypothesis import strategies as st

from voronoi_tiles.paths.biarc_bounds import fit
from voronoi_tiles.paths.biarcs import to_arcs
from voronoi_tiles.paths.conversion import COUNT_MAX, to_cubics, to_lines
from voronoi_tiles.paths.paths import CUBIC, LINE, Paths
from voronoi_tiles.paths.segmentation import longest_stretches
from voronoi_tiles.paths.stretch_parts import cut

Conversion = Callable[..., Paths]

PARABOLA: Points = (0j, 60 + 80j, 120 + 0j)
ALL = (to_arcs, to_lines, to_cubics)


def assert_within(old: Paths, new: Paths, accuracy: float) -> None:
    """New paths are as the contract says: joined, between the same ends, arcs of at most half a turn, near enough."""
    assert_joined(new)
    assert distance(old, new, accuracy / 2) <= accuracy * 1.01
    assert np.all(np.abs(new.bulges()) <= 1 + 1e-9)


@pytest.mark.parametrize("accuracy", [0.05, 0.01, 0.005, 0.0005])
def test_a_parabola_is_followed(accuracy: float) -> None:
    """The example of the makers' notes: within the accuracy, and with far fewer pieces than chords."""
    old = chain(PARABOLA)
    new = to_arcs(old, accuracy=accuracy)
    assert_within(old, new, accuracy)
    assert new.start[0] == 0
    assert new.end[-1] == 120
    assert 2 * len(new.kind) < len(to_lines(old, accuracy=accuracy).kind)


def test_the_figures_of_the_makers_notes_are_beaten() -> None:
    """A 120 mm parabola at 0.01 mm was measured elsewhere with 73 chords and 24 arcs of biarcs."""
    assert len(to_lines(chain(PARABOLA), accuracy=0.01).kind) <= 73
    assert len(to_arcs(chain(PARABOLA), accuracy=0.01).kind) <= 14


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(("size", "accuracy"), [(2.0, 0.005), (0.05, 0.01), (10.0, 0.05)])
def test_sides_of_tiles_are_followed(seed: int, size: float, accuracy: float) -> None:
    """Runs of many pieces, with curvature that jumps, from tiny to long."""
    old = smooth_side(seed, 12, size)
    new = to_arcs(old, accuracy=accuracy)
    assert_within(old, new, accuracy)
    assert (new.start[0], new.end[-1]) == (old.start[0], old.end[-1])


def test_the_oracle_sees_a_broken_result() -> None:
    """One middle of an arc moved by three times the accuracy, or one piece left out, does not pass."""
    old = chain(PARABOLA)
    new = to_arcs(old, accuracy=0.01)
    control = new.control.copy()
    control[4, 0] += 0.03j
    with pytest.raises(AssertionError):
        assert_within(old, replace(new, control=control), 0.01)
    short = replace(new, **{name: getattr(new, name)[:-1] for name in ("start", "end", "control", "kind")})
    with pytest.raises(AssertionError):
        assert_within(old, replace(short, offsets=np.array([0, len(short.kind)])), 0.01)


def feasible(points: np.ndarray, tangents: np.ndarray, accuracy: float) -> bool:
    """Whether some biarc is near enough to these points of a curve: joints on a fine grid, distances from the circles.

    The classic construction with two control points; distances are taken from whole circles, hence rather too small.
    """
    p0, p1, t0, t1 = points[0], points[-1], tangents[0], tangents[-1]

    def dot(u: complex, v: complex) -> float:
        return float((np.conj(u) * v).real)

    v = p1 - p0
    d1 = np.linspace(0.05, 0.95, 121) * abs(v)
    below = dot(v, t1) - d1 * (dot(t0, t1) - 1)
    d2 = (abs(v) ** 2 / 2 - d1 * dot(v, t0)) / np.where(below == 0, np.inf, below)
    joint = (d2 * (p0 + d1 * t0) + d1 * (p1 - d2 * t1)) / (d1 + d2)
    off = []
    for p, t in ((p0, t0), (p1, t1)):
        chord = joint - p
        curvature = 2 * (np.conj(t) * chord).imag / np.abs(chord) ** 2
        d = points[:, None] - p
        implicit = curvature * np.abs(d) ** 2 / 2 - (np.conj(1j * t) * d).real
        off.append(2 * np.abs(implicit) / (1 + np.sqrt(np.maximum(1 + 2 * curvature * implicit, 0))))
    worst = np.where(d2 > 0, np.max(np.minimum(*off), axis=0), np.inf)
    return bool(worst.min() <= accuracy)


@pytest.mark.parametrize(
    ("curve", "accuracy"),
    [(PARABOLA, 0.3), (PARABOLA, 0.05), ((0j, 10 + 40j, 90 + 0j), 0.05), ((0j, 30 + 1j, 50 + 20j), 0.002)],
)
def test_the_count_is_the_least(curve: Points, accuracy: float) -> None:
    """No choice of breaks on a grid of 60 does with fewer biarcs than the greedy one: dynamic programming over all."""
    grid, fine = 60, 8
    t = np.linspace(0, 1, grid * fine + 1)
    p0, p1, p2 = curve
    points = p0 * (1 - t) ** 2 + 2 * p1 * t * (1 - t) + p2 * t**2
    tangents = (p1 - p0) * (1 - t) + (p2 - p1) * t
    tangents /= np.abs(tangents)
    least = [0.0] + [math.inf] * grid
    for end in range(1, grid + 1):
        for begin in range(end - 1, -1, -1):
            stretch = slice(begin * fine, end * fine + 1)
            if least[begin] + 1 < least[end] and feasible(points[stretch], tangents[stretch], accuracy):
                least[end] = least[begin] + 1
    runs = runs_of(chain(curve))
    greedy = len(longest_stretches(runs.total, accuracy, lambda *stretch: fit(runs, *stretch).best, 3).run)
    assert least[-1] - 1 <= greedy <= least[-1]
    assert greedy > 1


@settings(max_examples=20, deadline=None)
@example(seed=81590, count=3, accuracy=0.005, angle=2.0, scale=0.01)  # 5 pieces from one end, 8 from the other
@example(seed=617728, count=7, accuracy=0.05, angle=3.3224661489224676, scale=25.4)  # as many biarcs, but not pieces
@given(
    seed=st.integers(0, 10**6),
    count=st.integers(1, 8),
    accuracy=st.sampled_from([0.05, 0.005, 0.0005]),
    angle=st.floats(0, 6.3),
    scale=st.sampled_from([0.01, 1.0, 25.4]),
)
def test_isometries_scaling_and_reversal(seed: int, count: int, accuracy: float, angle: float, scale: float) -> None:
    """The same bits backwards; as near, and as many pieces but for a rounded search, turned, scaled and mirrored."""
    old = smooth_side(seed, count, 2.0)
    new = to_arcs(old, accuracy=accuracy)
    assert same(to_arcs(old.reversed(), accuracy=accuracy), new.reversed())
    factor = scale * complex(math.cos(angle), math.sin(angle))
    image = old.moved(factor, 3 - 2j, conj=True)
    moved = to_arcs(image, accuracy=accuracy * scale)
    assert distance(image, moved, accuracy * scale) <= accuracy * scale * 1.15
    assert abs(len(moved.kind) - len(new.kind)) <= 2 + len(new.kind) // 10


def test_a_run_does_not_depend_on_what_stands_beside_it() -> None:
    """Converted together or alone, forwards or backwards, paths have the same bits."""
    sides = [smooth_side(seed, 3 + seed % 7, 1.0) for seed in range(23)]
    for convert in ALL:
        alone = Paths.concatenate([convert(side, accuracy=0.003) for side in sides])
        together = Paths.concatenate(sides)
        assert same(convert(together, accuracy=0.003), alone)
        assert same(convert(together.reversed(), accuracy=0.003), alone.reversed())


def test_lines_and_corners_stay() -> None:
    """Lines and arcs keep their bits and their places, and corners are exactly those of the input."""
    corner = 7.1 + 3.3j
    old = chain((0j, 4 + 4j, corner), (corner, 9 + 3j), (9 + 3j, 12 + 3j, 14 + 6j), (14 + 6j, 10 + 20j, 3 + 8j))
    new = to_arcs(old, accuracy=0.001)
    assert_within(old, new, 0.001)
    at = int(np.flatnonzero(new.start == corner)[0])
    assert (new.kind[at], new.end[at]) == (LINE, 9 + 3j)
    assert 14 + 6j in new.start.tolist()
    given_arc = arc(0j, 1 + 1j, 2.5 + 0.3j)
    assert same(to_arcs(given_arc, accuracy=0.001), given_arc)


def test_biarcs_are_smooth() -> None:
    """Within a run, consecutive arcs meet with one tangent, but where one arc stands for two."""
    new = to_arcs(chain((0j, 10 + 40j, 90 + 0j)), accuracy=1e-4)
    circle = new.circles(np.arange(len(new.kind)))
    turn, begin = circle[3], circle[2]
    leaving = begin + np.sign(turn) * np.pi / 2
    kinks = np.abs(np.angle(np.exp(1j * (leaving[1:] - (leaving + turn)[:-1]))))
    assert np.count_nonzero(kinks > 1e-6) <= 4
    assert kinks.max() < 1e-3


def test_closed_paths() -> None:
    """A closed chain without corner stays closed where it began; one begun within a run begins at a corner."""
    ring = []
    for k in range(8):
        a, b = (10 * np.exp(2j * np.pi * (k + j) / 8) for j in (0, 1))
        ring.append((a, (a + b) / 2 / math.cos(math.pi / 8) ** 2, b))
    ring = [(a, c, ring[(k + 1) % 8][0]) for k, (a, c, _) in enumerate(ring)]
    old = chain(*ring, closed=True)
    new = to_arcs(old, accuracy=0.02)
    assert_within(old, new, 0.02)
    assert new.start[0] == old.start[0]
    drop = chain((10j, 10 + 10j, 10 + 0j), (10 + 0j, 10 - 10j, 0j), (0j, 10j), closed=True)
    rolled = chain((10 + 0j, 10 - 10j, 0j), (0j, 10j), (10j, 10 + 10j, 10 + 0j), closed=True)
    new = to_arcs(rolled, accuracy=0.01)
    assert_within(rolled, new, 0.01)
    assert new.start[0] == 0
    assert len(new.kind) == len(to_arcs(drop, accuracy=0.01).kind)


DEGENERATE = {
    "cusp": chain((0j, 10 + 10j, 0 + 10j, 10 + 0j)),
    "near cusp": chain((0j, 10 + 10.001j, 0 + 10j, 10 + 0j)),
    "loop": chain((0j, 20 + 10j, -10 + 10j, 10 + 0j)),
    "closed loop": chain((0j, 20 + 10j, -20 + 10j, 0j)),
    "hairpin": chain((0j, 10 + 1e-7j, 1 + 0j)),
    "folded": chain((0j, 10 + 0j, 1 + 0j)),
    "there and back": chain((0j, 10 + 0j, 0j)),
    "straight": chain((0j, 3 + 3j, 10 + 10j)),
    "nearly straight": chain((0j, 5 + 1e-12j, 10 + 0j)),
    "first leg 0": chain((0j, 0j, 5 + 5j, 10 + 0j)),
    "last leg 0": chain((0j, 5 + 5j, 10 + 0j, 10 + 0j)),
    "both legs 0": chain((0j, 0j, 10 + 0j, 10 + 0j)),
    "quad leg 0": chain((0j, 0j, 10 + 1j)),
    "leg of rounding": chain((0j, -1e-17 + 1e-17j, 10 + 1j)),
    "below the accuracy": chain((0j, 1e-5 + 1e-5j, 2e-5 + 0j)),
    "tiny piece between": chain(
        (0j, 5 + 5j, 10 + 5j), (10 + 5j, 10 + 1e-9 + 5j, 10 + 2e-9 + 5j), (10 + 2e-9 + 5j, 20 + 5j, 20 + 0j)
    ),
    "far away": chain((1e6 + 0j, 1e6 + 60 + 80j, 1e6 + 120 + 0j)),
}  # fmt: skip


@pytest.mark.parametrize("turns", [1, 1.5, 2.25, 3])
@pytest.mark.parametrize("radius", [0.001, 0.01, 0.03, 1.0])
def test_windings_are_not_cut_short(turns: float, radius: float) -> None:
    """Curves that run round more than once, tight or wide against the accuracy, are covered all the way."""
    count = round(turns * 12)
    points = radius * np.exp(2j * np.pi * np.arange(count + 1) / 12) + 0.3 * radius * np.arange(count + 1) / count
    steps = points[1:] - points[:-1]
    normal = 1j * np.exp(2j * np.pi * np.arange(count + 1) / 12)
    along = (steps / normal[1:]).imag / (normal[:-1] / normal[1:]).imag
    old = chain(
        *zip(points[:-1].tolist(), (points[:-1] + along * normal[:-1]).tolist(), points[1:].tolist(), strict=True)
    )
    for accuracy in (0.02, 0.002):
        assert_within(old, to_arcs(old, accuracy=accuracy), min(accuracy, radius * 4))


@pytest.mark.parametrize("accuracy", [0.05, 0.002])
@pytest.mark.parametrize("name", DEGENERATE)
def test_degenerate_curves(name: str, accuracy: float) -> None:
    """Cusps, loops, hairpins, straight and tiny curves are followed too, with the same bits backwards."""
    old = DEGENERATE[name]
    new = to_arcs(old, accuracy=accuracy)
    assert_within(old, new, accuracy)
    assert len(new.kind) < 80
    assert same(to_arcs(old.reversed(), accuracy=accuracy), new.reversed())


@pytest.mark.usefixtures("compiled")
def test_kernels_have_the_bits_of_numpy(monkeypatch: pytest.MonkeyPatch) -> None:
    """The parts of stretches and all bounds: short and long ones, across joints, of curves that are hard to follow."""
    rng = np.random.default_rng(7)
    for old in [*(smooth_side(seed, 1 + seed % 6, 2.0) for seed in range(12)), *DEGENERATE.values()]:
        runs = runs_of(old)
        if len(runs.begin) > 1:
            runs.x[3] = rng.normal(size=len(runs.begin))  # cubic curves as well
        run = np.zeros(40, np.intp)
        low, high = np.sort(rng.uniform(0.0, runs.total[0], (2, len(run))), axis=0)
        low[:8], high[4:12] = 0.0, runs.total[0]
        joints = len(runs.begin) - 1
        low[12 : 12 + joints], high[12 : 12 + joints] = runs.begin[:-1], runs.begin[1:]
        found = []
        for chosen in ("", "numpy"):
            monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
            fields = [*cut(runs, run, low, high), fit(runs, run, low, high)]
            found.append([array.tobytes() for arrays in fields for array in arrays])
        assert found[0] == found[1]


def test_no_length_and_no_pieces() -> None:
    """Curves of length 0 vanish beside others, and become one line alone; empty paths stay."""
    point = chain((1j, 1j, 1j), (1j, 1j, 1j, 1j))
    assert to_arcs(point, accuracy=0.1).kind.tolist() == [LINE]
    beside = to_arcs(chain((0j, 5 + 5j, 10 + 0j), (10 + 0j,) * 3), accuracy=0.01)
    assert same(beside, to_arcs(chain((0j, 5 + 5j, 10 + 0j)), accuracy=0.01))
    hollow = Paths.concatenate([point, replace(Paths.empty(), offsets=np.zeros(2, np.intp), closed=np.array([False]))])
    for convert in (to_arcs, to_lines, to_cubics):
        nothing = convert(Paths.empty(), accuracy=0.1)
        assert (len(nothing), len(nothing.start), len(nothing.end)) == (0, 0, 0)
        assert convert(hollow, accuracy=0.1).counts[1] == 0


@pytest.mark.parametrize("convert", ALL)
@pytest.mark.parametrize("accuracy", [0.0, -1.0, math.nan, math.inf, 1e-300])
def test_accuracies_that_make_no_sense(convert: Conversion, accuracy: float) -> None:
    """Not positive, not finite, or below the coordinates' resolution."""
    with pytest.raises(ValueError, match="accuracy"):
        convert(chain(PARABOLA), accuracy=accuracy)


CURVES = {
    "quad": chain(PARABOLA),
    "cubic": chain((0j, 3 + 9j, 12 - 5j, 10 + 0j)),
    "arc": arc(0j, 5 + 3j, 10 + 0j),
    "half turn": arc(0j, 5 - 5j, 10 + 0j),
    "most of a turn": arc(0j, 0.5 + 9j, 1 + 0j),
    "flat arc": arc(0j, 5 + 1e-9j, 10 + 0j),
    "arc without sagitta": arc(0j, 5 + 0j, 10 + 0j),
    "line": chain((0j, 7 + 1j)),
}


@pytest.mark.parametrize("accuracy", [0.05, 0.002])
@pytest.mark.parametrize("convert", [to_lines, to_cubics])
@pytest.mark.parametrize("name", CURVES)
def test_conversions_are_within_the_accuracy(name: str, convert: Conversion, accuracy: float) -> None:
    """Every kind to every other one, with the same bits backwards."""
    old = CURVES[name]
    new = convert(old, accuracy=accuracy)
    assert_joined(new)
    assert distance(old, new, accuracy / 2) <= accuracy * 1.01
    assert same(convert(old.reversed(), accuracy=accuracy), new.reversed())
    assert (new.start[0], new.end[-1]) == (old.start[0], old.end[-1])
    if name == "line":
        assert same(new, old)


@pytest.mark.parametrize("convert", [to_lines, to_cubics])
def test_conversions_of_arcs_use_no_more_than_needed(convert: Conversion) -> None:
    """With one piece fewer the error of equal parts would exceed the accuracy: the whole scales with the radius."""
    old = arc(0j, 5 - 5j, 10 + 0j)
    for accuracy in (0.1, 0.01, 0.001):
        count = len(convert(old, accuracy=accuracy).kind)
        error = distance(old, convert(old, accuracy=accuracy), accuracy / 4)
        coarse = accuracy
        while len(convert(old, accuracy=coarse).kind) == count and count > 1:
            coarse *= 1.02
        fewer = distance(old, convert(old, accuracy=coarse), accuracy / 4)
        assert error <= accuracy * 1.001
        assert count == 1 or fewer > accuracy


def test_a_quad_as_a_cubic_is_the_same_curve() -> None:
    """Degree elevation is exact: both have the same points at the same parameters."""
    new = to_cubics(chain(PARABOLA), accuracy=0.01)
    assert new.kind.tolist() == [CUBIC]
    t = np.linspace(0, 1, 9)
    (p0, p1, p2), (c0, c1) = PARABOLA, new.control[0]
    quad = p0 * (1 - t) ** 2 + 2 * p1 * t * (1 - t) + p2 * t**2
    cubic = p0 * (1 - t) ** 3 + 3 * c0 * t * (1 - t) ** 2 + 3 * c1 * t * t * (1 - t) + p2 * t**3
    np.testing.assert_allclose(cubic, quad, atol=1e-13)


def test_too_many_chords_are_refused() -> None:
    """An accuracy that would fill the memory is an error before it does."""
    with pytest.raises(ValueError, match=f"{COUNT_MAX}"):
        to_lines(Paths.concatenate([chain(PARABOLA)] * 100), accuracy=1e-9)

"""Curves replaced by the fewest cubic ones: bounded, smooth, the same wherever a run lies, symmetric where it is."""

from __future__ import annotations

import cmath
import sys
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers.curves import arc, assert_joined, chain, distance, runs_of, same, smooth_side
from helpers.examples import EXAMPLES, tiling
from hypothesis import example, given, settings
from hypothesis import strategies as st

# At the end: tests/ has modules of these names too.
sys.path.append(str(Path(__file__).parents[2] / "bench"))

import cubics

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.paths.biarc_bounds import BiarcFit, fit
from voronoi_tiles.paths.biarcs import to_arcs
from voronoi_tiles.paths.cubic_bounds import FittedCubics, bounds
from voronoi_tiles.paths.cubic_fit import CubicFit, PlacedStretches, fit_cubics
from voronoi_tiles.paths.fewest_cubics import to_fewest_cubics
from voronoi_tiles.paths.paths import CUBIC, LINE, QUAD, Paths
from voronoi_tiles.paths.smooth_runs import SmoothRuns
from voronoi_tiles.paths.stretch_parts import cut

ACCURACY = 0.005
CORNER = 0.1

FEW = ("p1-leaf", "p4-hook")
"""Examples of the quick tests: smooth, and with corners and long lines."""


def exact_edges(name: str) -> Paths:
    """The exact edges of an example's tiles, one of each orbit; millimetres."""
    made = tiling(name)
    return made.tessellation.quotient.paths().moved(made.design.unit_mm, 0j)


def fitted(paths: Paths, accuracy: float = ACCURACY) -> Paths:
    """The fewest cubic curves, with the corners and the short lines of fabrication."""
    return to_fewest_cubics(paths, accuracy=accuracy, corner=CORNER, absorbed=400 * accuracy)


def directions(paths: Paths) -> tuple[Complexes, Complexes]:
    """The unit directions in which segments leave their starts, and arrive at their ends."""
    points = np.column_stack((paths.start, paths.control, paths.end))
    rows = {LINE: [0, 3], QUAD: [0, 1, 3], CUBIC: [0, 1, 2, 3]}
    legs = [np.diff(points[k, rows[int(kind)]]) for k, kind in enumerate(paths.kind)]
    legs = [leg[np.abs(leg) > 1e-9] for leg in legs]
    first, last = np.array([leg[0] for leg in legs]), np.array([leg[-1] for leg in legs])
    return first / np.abs(first), last / np.abs(last)


def corners(paths: Paths, angle: float) -> Complexes:
    """The joints of the first path, with its ends, at which the direction changes by more than an angle."""
    leaving, arriving = directions(paths)
    turn = np.abs(np.angle(leaving[1:] / arriving[:-1]))
    return np.concatenate((paths.start[:1], paths.start[1:][turn > angle], paths.end[-1:]))


def assert_smooth(paths: Paths, at: Complexes) -> None:
    """Directions go on continuously but at some points."""
    leaving, arriving = directions(paths)
    turn = np.abs(np.angle(leaving[1:] / arriving[:-1]))
    assert np.all((turn <= 1e-9) | np.isin(paths.start[1:], at))


few_examples = pytest.mark.parametrize(
    "name",
    [name if name in FEW else pytest.param(name, marks=pytest.mark.slow) for name in EXAMPLES],
)


@few_examples
def test_the_edges_of_tiles_are_followed(name: str) -> None:
    """Within the accuracy both ways, by dense samples; smooth but for the corners, which stay bit for bit."""
    old = exact_edges(name)
    counts = [0, 0]
    for k in range(len(old)):
        edge = old.take(np.array([k]))
        new = fitted(edge)
        assert_joined(new)
        assert distance(edge, new, 0.02) <= ACCURACY * 1.001
        there = corners(edge, CORNER)
        lines = edge.kind == LINE
        assert set(there.tolist()) <= {*new.start.tolist(), *new.end.tolist()}
        assert_smooth(new, np.concatenate((there, edge.start[lines], edge.end[lines])))
        counts[0] += len(edge.start)
        counts[1] += len(new.start)
    assert counts[1] <= max(20, counts[0] / 2)


@pytest.mark.parametrize(("seed", "size", "accuracy"), [(0, 2.0, 0.02), (1, 0.05, 0.01), (2, 10.0, 0.05)])
def test_smooth_sides_are_followed(seed: int, size: float, accuracy: float) -> None:
    """Runs of many pieces, with curvature that jumps, from tiny to long; with fewer curves than pieces."""
    old = smooth_side(seed, 12, size)
    new = to_fewest_cubics(old, accuracy=accuracy)
    assert_joined(new)
    assert distance(old, new, accuracy / 2) <= accuracy * 1.001
    assert (new.start[0], new.end[-1]) == (old.start[0], old.end[-1])
    assert_smooth(new, np.zeros(0, np.complex128))
    assert len(new.kind) < 12


@given(
    seed=st.integers(0, 10**6),
    near=st.floats(0.05, 2.0),
    far=st.floats(0.05, 2.0),
    low=st.floats(0.0, 0.6),
    length=st.floats(0.05, 0.4),
)
@settings(max_examples=20, deadline=None)
def test_a_bound_is_a_bound(seed: int, near: float, far: float, low: float, length: float) -> None:
    """However bad a curve is: no farther from its stretch than the bound says, by dense samples, both ways."""
    side = smooth_side(seed, 6, 1.0)
    runs = runs_of(side)
    total = float(runs.total[0])
    parts, ends = cut(runs, np.zeros(1, np.intp), np.array([low * total]), np.array([(low + length) * total]))
    third = length * total / 3
    control = (
        complex(ends.ax[0], ends.ay[0]) * near * third,
        complex(ends.x[0], ends.y[0]) - far * third * complex(ends.bx[0], ends.by[0]),
    )
    points = np.array([0j, *control, complex(ends.x[0], ends.y[0])])[:, None]
    curve = FittedCubics(points.real.copy(), points.imag.copy())
    share = np.arange(len(parts.stretch)) / len(parts.stretch)
    bound = float(bounds(parts, curve, share)[0])
    stretch = chain(*map(tuple, (parts.x + 1j * parts.y).T.tolist()))
    real = distance(stretch, chain(tuple(points[:, 0].tolist())), total / 2000)
    assert real <= bound + total * 1e-6


def test_a_bound_sees_a_curve_that_does_not_follow() -> None:
    """A control point that is moved aside, and a stretch whose second half is missing."""
    runs = runs_of(chain((0j, 3 + 4j, 6 + 0j)))
    parts, _ = cut(runs, np.zeros(1, np.intp), np.zeros(1), runs.total)
    share = np.arange(len(parts.stretch)) / len(parts.stretch)
    points = np.array([0j, 2 + 8j / 3, 4 + 8j / 3, 6 + 0j])
    for moved, least in ((0j, 0.0), (0.1j, 0.02), (-1.0 - 1.0j, 0.2)):
        bent = (points + np.array([0, moved, 0, 0]))[:, None]
        bound = float(bounds(parts, FittedCubics(bent.real.copy(), bent.imag.copy()), share)[0])
        assert least <= bound <= abs(moved) / 2 + 1e-12


@settings(max_examples=6, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    count=st.integers(1, 4),
    angle=st.floats(0, 6.3),
    accuracy=st.sampled_from([0.05, 0.005]),
)
def test_images_have_the_images_of_one_fit(seed: int, count: int, angle: float, accuracy: float) -> None:
    """Backwards the same bits; turned, mirrored and shifted beside it the same curve, to rounding."""
    side = smooth_side(seed, count, 2.0)
    turn = cmath.rect(1.0, angle)
    image = side.moved(turn, 30 - 20j, conj=True)
    together = to_fewest_cubics(Paths.concatenate([side, side.reversed(), image, image.reversed()]), accuracy=accuracy)
    first, back, there, and_back = (together.take(np.array([k])) for k in range(4))
    assert same(first, back.reversed())
    assert same(there, and_back.reversed())
    moved = first.moved(turn, 30 - 20j, conj=True)
    assert there.kind.tolist() == moved.kind.tolist()
    for name in ("start", "end", "control"):
        assert np.abs(getattr(there, name) - getattr(moved, name)).max() <= 1e-12 * 60
    assert same(
        to_fewest_cubics(side.reversed(), accuracy=accuracy), to_fewest_cubics(side, accuracy=accuracy).reversed()
    )


@settings(max_examples=8, deadline=None)
@example(seed=510509, count=4, mirror=True, accuracy=0.0005)  # the curve in the middle is even
@given(
    seed=st.integers(0, 10**6),
    count=st.integers(1, 3),
    mirror=st.booleans(),
    accuracy=st.sampled_from([0.01, 0.002]),
)
def test_what_is_its_own_image_stays_so(seed: int, count: int, mirror: bool, accuracy: float) -> None:
    """A run that a half turn or a mirror maps onto itself backwards is replaced by one that it maps so too."""
    half = smooth_side(seed, count, 2.0)
    end, along = half.end[-1], directions(half)[1][-1]
    # About the end; the mirror stands across the run there.
    factor = -along * along if mirror else -1 + 0j
    shift = end - factor * (end.conjugate() if mirror else end)
    other = half.moved(factor, shift, conj=mirror).reversed()
    other.start[0] = end
    whole = Paths.concatenate([half, other])
    whole = replace(whole, offsets=np.array([0, len(whole.start)]), closed=np.zeros(1, np.bool_))
    new = to_fewest_cubics(whole, accuracy=accuracy)
    assert distance(whole, new, 0.005) <= accuracy * 1.001 + 1e-6
    image = new.moved(factor, shift, conj=mirror).reversed()
    for name in ("start", "end", "control"):
        assert np.abs(getattr(image, name) - getattr(new, name)).max() <= 1e-12 * 60
    assert_smooth(new, np.zeros(0, np.complex128))


def test_arcs_are_followed() -> None:
    """Half a circle of 10 mm, for which cubic curves over equal angles would do in as many."""
    middle = arc(5 + 0j, 5j, -5 + 0j)
    for accuracy, most in ((0.01, 2), (0.0005, 3), (1e-5, 5)):
        new = to_fewest_cubics(middle, accuracy=accuracy)
        assert set(new.kind.tolist()) == {CUBIC}
        assert len(new.kind) <= most
        assert distance(middle, new, 0.001) <= accuracy * 1.001 + 1e-7


def test_a_loop_that_is_one_curve_stays() -> None:
    """It ends where it begins, and is no line of length 0."""
    loop = Paths(
        np.array([5 + 3j]),
        np.array([5 + 3j]),
        np.array([[15 + 10j, -4 + 14j]]),
        np.array([CUBIC], np.uint8),
        np.array([0, 1]),
        np.zeros(1, np.bool_),
    )
    fitted = to_fewest_cubics(loop, accuracy=0.005)
    assert fitted.kind.tolist() == [CUBIC] * len(fitted.kind)
    assert fitted.lengths.sum() == pytest.approx(loop.lengths.sum(), rel=1e-3)


def test_what_is_straight_is_a_line() -> None:
    """Short lines beside curves may become parts of them; alone they are lines."""
    lines = chain((0j, 0.5 + 0j), (0.5 + 0j, 0.5 + 0.7j))
    assert same(fitted(lines), lines)
    bent = chain((0j, 1 + 0j), (1 + 0j, 2 + 0j, 3 + 1j), (3 + 1j, 4 + 2j))
    assert fitted(bent).kind.tolist() == [CUBIC, CUBIC]
    assert to_fewest_cubics(bent, accuracy=ACCURACY).kind.tolist() == [LINE, CUBIC, LINE]


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5])
@few_examples
def test_there_are_no_more_than_exact_pieces(name: str, accuracy: float) -> None:
    """However fine the accuracy: where cubic curves would be more, the pieces themselves are taken."""
    old = exact_edges(name)
    new = fitted(old, accuracy)
    assert_joined(new)
    assert np.all(new.counts <= old.counts)
    for k in range(len(old)):
        edge, other = old.take(np.array([k])), new.take(np.array([k]))
        assert distance(edge, other, 0.01) <= accuracy * 1.001 + 4e-6


def test_rounded_corners_keep_their_ends() -> None:
    """Arcs of their radius that turn by more than a corner: beside them runs are as they would be alone."""
    turn = 0.3
    side = smooth_side(4, 6, 2.0)
    centre = side.end[-1] + 0.075j * directions(side)[1][-1]
    spin = cmath.rect(1.0, turn)
    end, middle = (centre + (side.end[-1] - centre) * spin**part for part in (1.0, 0.5))
    after = side.moved(spin, end - side.start[0] * spin)
    pull = directions(side)[1][-1] * spin / directions(after)[0][0]
    after = after.moved(pull, end - end * pull)
    after.start[0] = end
    corner = arc(complex(side.end[-1]), complex(middle), complex(end))
    whole = Paths.concatenate([side, corner, after])
    whole = replace(whole, offsets=np.array([0, len(whole.start)]), closed=np.zeros(1, np.bool_))
    alone = [to_fewest_cubics(part, accuracy=ACCURACY, corner=CORNER) for part in (side, corner, after)]
    kept = to_fewest_cubics(whole, accuracy=ACCURACY, corner=CORNER, rounded=(0.2, 0.075))
    assert {side.end[-1], end} <= set(kept.start.tolist())
    assert len(kept.kind) == sum(len(part.kind) for part in alone)
    assert distance(whole, kept, 0.01) <= ACCURACY * 1.001
    for other in ((), (0.2,)):
        assert end not in to_fewest_cubics(whole, accuracy=ACCURACY, corner=CORNER, rounded=other).start.tolist()


def test_small_joints_are_rounded_within_the_accuracy() -> None:
    """Five degrees, between curves that came in pieces: smooth, and yet no point is farther than the accuracy."""
    first, second = (0j, 5 + 1j, 10 + 0j), (0j, 5 + 1j, 10 + 1j)
    leaving = (first[2] - first[1]) / second[1] * cmath.rect(1.0, np.deg2rad(5.0))
    leaving /= abs(leaving)
    second = first[2], first[2] + second[1] * leaving, first[2] + second[2] * leaving
    whole = chain(first, second)
    for accuracy in (0.02, 0.005, 0.0005):
        pieces = chain(*(piece for curve in (first, second) for piece in in_pieces(curve, 8)))
        new = to_fewest_cubics(pieces, accuracy=accuracy, corner=CORNER)
        assert len(new.kind) < 16
        assert_smooth(new, np.zeros(0, np.complex128))
        assert accuracy / 100 < distance(whole, new, 0.001) <= accuracy * 1.001
    assert second[0] in to_fewest_cubics(pieces, accuracy=0.005, corner=0.08).start.tolist()
    # A joint of two curves stays where rounding it takes three.
    assert to_fewest_cubics(whole, accuracy=0.0005, corner=CORNER).start.tolist() == pytest.approx(whole.start.tolist())


def in_pieces(curve: tuple[complex, ...], count: int) -> list[tuple[complex, ...]]:
    """A quadratic curve cut into pieces of equal steps."""
    a, b, c = curve

    def polar(u: float, v: float) -> complex:
        """The polar form."""
        return a * (1 - u) * (1 - v) + b * (u * (1 - v) + v * (1 - u)) + c * u * v

    t = [k / count for k in range(count + 1)]
    return [(polar(u, u), polar(u, v), polar(v, v)) for u, v in pairwise(t)]


@pytest.mark.usefixtures("compiled")
def test_the_kernel_has_the_bits_of_numpy(monkeypatch: pytest.MonkeyPatch) -> None:
    """Good fits and bad ones, long and short, even or not, with tangents of the run's own and of windows."""
    rng = np.random.default_rng(11)
    for seed in range(10):
        runs = runs_of(smooth_side(seed, 1 + seed % 6, 2.0))
        total = float(runs.total[0])
        low, high = np.sort(rng.uniform(0.0, total, (2, 12)), axis=0)
        low[:3], high[2:5] = 0.0, total
        window = np.minimum(np.where(np.arange(12) % 2, total / 20, 0.0), np.minimum(low, total - high))
        stretches = PlacedStretches(np.zeros(12, np.intp), low, high, window, window, rng.random(12) < 0.3)
        found = []
        for chosen in ("", "numpy"):
            monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
            fit = fit_cubics(runs, stretches)
            found.append([array.tobytes() for array in (*fit.curves, fit.bound)])
        assert found[0] == found[1]


def test_last_bits_move_no_break(monkeypatch: pytest.MonkeyPatch) -> None:
    """Errors that are a little off, more than processors differ, and any for straight stretches: the same bits."""
    sides = []
    for seed in range(4):
        side = smooth_side(seed, 6, 2.0)
        end, along = complex(side.end[-1]), complex(directions(side)[1][-1])
        straight = [(end + k * along, end + (k + 0.5) * along, end + (k + 1) * along) for k in range(4)]
        sides.append(chain(*zip(side.start, side.control[:, 0], side.end, strict=True), *straight))
    old = Paths.concatenate(sides)
    convert = partial(to_fewest_cubics, accuracy=ACCURACY), partial(to_arcs, accuracy=ACCURACY)
    plain = [one(old) for one in convert]
    rng = np.random.default_rng(3)

    def shaken(bound: Floats) -> Floats:
        """Errors, changed by some hundred millionths of themselves, and of the accuracy."""
        return bound * (1 + rng.uniform(-1e-8, 1e-8, bound.shape)) + ACCURACY * rng.uniform(0, 1e-9, bound.shape)

    def shaken_fits(runs: SmoothRuns, stretches: PlacedStretches) -> CubicFit:
        """Cubic curves as they are."""
        found = fit_cubics(runs, stretches)
        return found._replace(bound=shaken(found.bound))

    def shaken_arcs(*stretches: Any) -> BiarcFit:
        """Arcs as they are."""
        found = fit(*stretches)
        return found._replace(line=shaken(found.line), arc=shaken(found.arc), biarc=shaken(found.biarc))

    monkeypatch.setattr("voronoi_tiles.paths.fewest_cubics.fit_cubics", shaken_fits)
    monkeypatch.setattr("voronoi_tiles.paths.biarcs.fit", shaken_arcs)
    for one, there in zip(convert, plain, strict=True):
        assert same(one(old), there)


@few_examples
def test_there_are_no_more_than_a_tenth_above_those_of_kurbo(name: str) -> None:
    """At the same accuracy, run by run: fit_to_bezpath, which looks at samples."""
    ours, theirs = 0, 0
    edges = exact_edges(name)
    for k in range(len(edges)):
        for run in cubics.smooth_runs(edges.take(np.array([k])), ACCURACY):
            ours += len(fitted(run).kind)
            theirs += len(cubics.kurbo_fit(run, ACCURACY).kind)
    assert 0 < ours <= 1.1 * theirs

"""Short segments: what goes, what stays, how far it moves anything, and that it is the same from wherever one looks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import shapely
from hypothesis import given as drawn
from hypothesis import settings
from hypothesis import strategies as st

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.offset import offset
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.paths.short_segments import straightened, without_short_segments


def ring(*points: complex) -> Paths:
    """A closed path of lines."""
    return Paths.polylines([np.array(points)], closed=True)


def nodes(paths: Paths) -> list[complex]:
    """The nodes of paths in the order of their coordinates."""
    return sorted(paths.start.tolist(), key=lambda z: (round(z.real, 9), round(z.imag, 9)))


def started_at(paths: Paths, first: int) -> Paths:
    """The same closed path, begun at another node."""
    return replace(
        paths, **{name: np.roll(getattr(paths, name), -first, axis=0) for name in ("start", "end", "control", "kind")}
    )


def dense(paths: Paths) -> shapely.LinearRing:
    """A ring as points close to each other, and chords between them."""
    points = to_lines(paths, accuracy=1e-5).start
    ring = shapely.segmentize(shapely.LinearRing(np.column_stack((points.real, points.imag))), 0.05)
    shapely.prepare(ring)
    return ring


def rough(seed: int, *, arcs: bool) -> Paths:
    """A ring round 0 of long and short segments, several short ones in a row among them."""
    random = np.random.default_rng(seed)
    angles = np.sort(
        np.concatenate([random.random(12), *(random.random(1) + 1e-4 * random.random(3) for _ in range(4))])
    )
    points: Complexes = 10 * np.exp(2j * np.pi * angles)
    lines = ring(*points.tolist())
    if not arcs:
        return lines
    chord = lines.end - lines.start
    control = np.column_stack(((lines.start + lines.end) / 2 - 0.1j * chord, 0 * chord))
    return replace(lines, control=control, kind=np.full(len(points), ARC, np.uint8))


def test_what_it_joined_meets_in_its_middle() -> None:
    """A short line at the corner of a square, and two in a row at another."""
    found = without_short_segments(ring(0, 9, 9 + 0.2j, 9 + 9j, 8.9 + 9.1j, 8.8 + 9j, 9j), 0.3, 0.3)
    assert found.start.tolist() == pytest.approx([0, 9 + 0.1j, 8.9 + 9j, 9j], abs=1e-12)
    assert (found.end == np.roll(found.start, -1)).all()


def test_a_row_that_is_long_together_stays() -> None:
    """Four tenths in a row are no speck."""
    points = [0, 9, 9 + 0.1j, 9 + 0.2j, 9 + 0.3j, 9 + 0.4j, 9 + 9j, 9j]
    assert without_short_segments(ring(*points), 0.3, 0.3).start.tolist() == points
    assert len(without_short_segments(ring(*points), 0.5, 0.5).start) == 4


def test_a_ring_keeps_two_segments() -> None:
    """One of short segments alone stays, and one of a single long arc with a short line; others beside it do not."""
    tiny, plain = ring(0, 0.1, 0.1j), ring(0, 9, 9 + 0.1j, 9j)
    lens = replace(
        ring(5, 5 + 0.1j), kind=np.array([LINE, ARC], np.uint8), control=np.array([[0, 0], [-3, 0]], complex)
    )
    found = without_short_segments(Paths.concatenate([tiny, plain, lens]), 0.3, 0.3)
    assert found.counts.tolist() == [3, 3, 2]
    assert (found.take(np.array([0])).start == tiny.start).all()
    assert (found.take(np.array([2])).control == lens.control).all()


def apart(one: Paths, two: Paths) -> float:
    """How far two rings are from each other, measured both ways on chords."""
    lines = dense(one), dense(two)
    found = [shapely.distance(line, shapely.points(other.coords)) for line, other in (lines, lines[::-1])]
    return float(max(distances.max() for distances in found))


def grown(seed: int) -> Paths:
    """The offset by 1 of a ring of lines and arcs whose corners turn by up to a third: many short arcs of radius 1."""
    random = np.random.default_rng(seed)
    angles = 2 * np.pi * (np.arange(24) + random.uniform(-0.2, 0.2, 24)) / 24
    points = random.uniform(9.9, 10.1, 24) * np.exp(1j * angles)
    chord = np.roll(points, -1) - points
    bulges = np.where(random.random(24) < 0.5, random.uniform(-0.05, 0.1, 24), 0.0)
    control = np.column_stack(((points + np.roll(points, -1)) / 2 - 0.5j * bulges * chord, 0 * chord))
    kind = np.where(bulges == 0, LINE, ARC).astype(np.uint8)
    region = replace(ring(*points.tolist()), kind=kind, control=np.where((kind == ARC)[:, None], control, 0))
    return offset(region, 1.0).paths


def beside_tiny_ones(seed: int) -> Paths:
    """A ring round 0 of six long lines; at its corners, a tiny line and a short one, on either side of each other."""
    random = np.random.default_rng(seed)
    corners = 10 * np.exp(1j * np.pi / 3 * (np.arange(6) + random.uniform(-0.2, 0.2, 6)))
    points = []
    for k, corner in enumerate(corners.tolist()):
        ahead = corners[(k + 1) % 6] - corner
        way = 1j * corner / 10
        sizes = random.permutation([0.0008, random.uniform(0.003, 0.009)]) * (ahead.conjugate() * way).real / abs(ahead)
        points += [corner, corner + sizes[0] * way, corner + sizes.sum() * way * np.exp(0.05j)]
    return ring(*points)


RINGS: dict[str, tuple[Callable[[int], Paths], float, float]] = {
    "lines": (partial(rough, arcs=False), 0.005, 0.005),
    "arcs": (partial(rough, arcs=True), 0.005, 0.005),
    "arcs about corners": (grown, 0.4, 0.004),
    "lines beside tiny ones": (beside_tiny_ones, 0.01, 0.001),
}
"""What makes a ring of a seed, and which segments are left out: their length, the deviation."""


@pytest.mark.parametrize("rings", RINGS)
@pytest.mark.parametrize("seed", range(8))
def test_start_and_direction_do_not_matter(seed: int, rings: str) -> None:
    """The same nodes from every start, run through backwards, and in the mirror."""
    make, length, deviation = RINGS[rings]
    given = make(seed)
    wanted = nodes(without_short_segments(given, length, deviation))
    assert len(wanted) < len(given.start)
    for first in range(len(given.start)):
        turned = started_at(given, first)
        assert nodes(without_short_segments(turned, length, deviation)) == pytest.approx(wanted, abs=1e-12)
        assert nodes(without_short_segments(turned.reversed(), length, deviation)) == pytest.approx(wanted, abs=1e-12)
    mirrored = without_short_segments(given.moved(1.0, 0j, conj=True), length, deviation)
    assert nodes(mirrored.moved(1.0, 0j, conj=True)) == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize("rings", RINGS)
@pytest.mark.parametrize("seed", range(8))
def test_nothing_moves_by_more_than_the_deviation(seed: int, rings: str) -> None:
    """Both ways, measured on chords."""
    make, length, deviation = RINGS[rings]
    given = make(seed)
    moved = apart(given, without_short_segments(given, length, deviation))
    assert moved <= deviation
    assert moved > 0.05 * deviation, "nothing was left out: it tests nothing"


@settings(max_examples=30, deadline=None)
@drawn(st.integers(0, 2**32 - 1), st.floats(0.05, 0.5), st.floats(1e-3, 0.02))
def test_all_goes_that_may(seed: int, length: float, deviation: float) -> None:
    """Of arcs about corners, beside longer edges, those go whose tips are near enough, and no others."""
    given = grown(seed)
    left = without_short_segments(given, length, deviation)
    assert apart(given, left) <= deviation + 2e-5
    radius, turn = given.arc_radius_and_turn(np.arange(len(given.start)))
    short = given.lengths < max(length, deviation)
    alone = short & ~np.roll(short, 1) & ~np.roll(short, -1)
    corner = alone & (np.abs(radius - 1) < 1e-9) & (given.kind == ARC)
    # Edges are flatter than a third: over half of 0.5, they leave their tangents by 0.02 at most.
    surely = corner & (1 / np.cos(turn / 2) - 1 + np.tan(turn / 2) ** 2 / 3 <= deviation)
    never = (1 / np.cos(turn / 2) - 1 > deviation) & (given.lengths > deviation) | (given.lengths > length)
    middles = set(np.round(left.control[left.kind == ARC, 0], 9).tolist())
    found = np.array([complex(z) in middles for z in np.round(given.control[:, 0], 9)])
    assert not found[surely].any()
    assert found[never & corner].all()


def test_a_short_arc_about_a_corner_gives_way_to_its_tip() -> None:
    """Two lines of a square go on to where they meet; the deviation is that of the tip, as the formula has it."""
    radius, turn = 0.5, 0.2
    reach, off = radius * np.tan(turn / 2), radius * (1 / np.cos(turn / 2) - 1)
    tip, ahead = 10 + 0j, np.exp(1j * turn)
    given = ring(0, tip - reach, tip + reach * ahead, tip + 9 * ahead, 9j)
    given.kind[1], given.control[1, 0] = ARC, tip + off * 1j * np.exp(0.5j * turn)
    assert given.arc_radius_and_turn(np.array([1]))[0] == pytest.approx([radius])
    assert without_short_segments(given, 0.11, 1.01 * off).start.tolist() == pytest.approx(
        [0, tip, tip + 9 * ahead, 9j], abs=1e-12
    )
    for stays in (without_short_segments(given, 0.11, 0.99 * off), without_short_segments(given, 0.09, 1.01 * off)):
        assert stays is given or len(stays.start) == 5


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("turn", [0.02, 0.05])
def test_a_short_segment_beside_a_tiny_one_goes_to_a_tip(turn: float, *, backwards: bool) -> None:
    """When the tiny one has gone to its middle, all that is left is one beside longer ones."""
    points = [10, *(10 + np.cumsum(np.array([0.0007, 0.007, 9]) * np.exp(1j * turn * np.arange(1, 4)))), 9j]
    given = ring(0, *points)
    if backwards:
        given = given.reversed(np.array([True]))
    found = without_short_segments(given, 0.01, 0.001)
    assert len(found.start) == 4
    assert apart(given, found) <= 0.001
    assert len(without_short_segments(given, 0.01, 0.0008 * turn).start) == 6


@pytest.mark.parametrize("off", [0.0, 1e-9, -1e-9])
@pytest.mark.parametrize("backwards", [False, True])
def test_a_short_segment_that_goes_straight_on_goes(off: float, *, backwards: bool) -> None:
    """From one of what it joins it need not turn at all: rounding does not decide whether it goes."""
    given = ring(0, 10, 10.1 + 0.1j * off, 20 + 0.99j, 10 + 9j)
    if backwards:
        given = given.reversed(np.array([True]))
    assert len(without_short_segments(given, 0.2, 0.01).start) == 4


@pytest.mark.parametrize("bulge", [-0.02, 0.06])
def test_an_arc_that_is_no_corners_stays(bulge: float) -> None:
    """One that bulges to the other side, and one that bulges out over the tip."""
    given = ring(0, 10, 10.1 + 0.01j, 20 + 2.01j, 10 + 9j)
    assert len(without_short_segments(given, 0.2, 0.01).start) == 4
    given.kind[1], given.control[1, 0] = ARC, 10.05 + 0.005j - 0.5j * bulge * (0.1 + 0.01j)
    assert len(without_short_segments(given, 0.2, 0.01).start) == 5


@pytest.mark.parametrize(("half", "left"), [(1.9, 3), (2.1, 4)])
def test_arcs_that_turn_far_are_not_led_to_tips(half: float, left: int) -> None:
    """There an arc that keeps its middle and is led on may leave its circle by more than at its end."""
    angles = np.array([0, half, 2 * half])
    begin, over, end = 5 * np.exp(1j * angles)
    ahead = 1j * np.exp(2j * half)
    tip = end + 0.5 * np.tan(0.05) * ahead
    corner = tip + 0.5 * np.tan(0.05) * ahead * np.exp(0.1j)
    given = ring(begin, end, corner, corner + 3 * ahead * np.exp(0.1j))
    given.kind[:2] = ARC
    given.control[:2, 0] = over, tip + 0.5 * (1 / np.cos(0.05) - 1) * 1j * ahead * np.exp(0.05j)
    assert len(without_short_segments(given, 0.06, 0.002).start) == left


def test_a_segment_of_no_length_goes() -> None:
    """Wherever it stands, without a warning: it has no direction."""
    for points in ([0, 9, 9, 9 + 9j], [0, 4, 4, 9, 9 + 9j], [0, 4, 4, 4, 9, 9 + 9j]):
        found = without_short_segments(ring(*points), 0.3, 0.1).start.tolist()
        assert found == sorted({complex(z) for z in points}, key=lambda z: (z.real, z.imag))


def test_open_paths_are_refused() -> None:
    """Their ends belong to others."""
    with pytest.raises(ValueError, match="closed"):
        without_short_segments(Paths.polylines([np.array([0, 1, 2])]), 0.1, 0.1)


def test_flat_arcs_are_lines() -> None:
    """Those that leave their chord by the tolerance at most, and those between one point."""
    paths = replace(
        ring(0, 2, 2, 4 + 4j),
        control=np.array([[1 - 0.01j, 0], [2, 0], [3 + 2.1j, 0], [0, 0]], complex),
        kind=np.array([ARC, ARC, ARC, LINE], np.uint8),
    )
    assert straightened(paths, 0.02).kind.tolist() == [LINE, LINE, ARC, LINE]
    assert (straightened(paths, 0.02).control[:2] == 0).all()
    assert straightened(paths, 0.005).kind.tolist() == [ARC, LINE, ARC, LINE]

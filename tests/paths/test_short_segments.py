"""Short segments: what goes, what stays, and that it is the same from wherever a ring is looked at."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.paths.conversion import to_lines
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
    found = without_short_segments(ring(0, 9, 9 + 0.2j, 9 + 9j, 8.9 + 9.1j, 8.8 + 9j, 9j), 0.3)
    assert found.start.tolist() == pytest.approx([0, 9 + 0.1j, 8.9 + 9j, 9j], abs=1e-12)
    assert (found.end == np.roll(found.start, -1)).all()


def test_a_row_that_is_long_together_stays() -> None:
    """Four tenths in a row are no speck."""
    points = [0, 9, 9 + 0.1j, 9 + 0.2j, 9 + 0.3j, 9 + 0.4j, 9 + 9j, 9j]
    assert without_short_segments(ring(*points), 0.3).start.tolist() == points
    assert len(without_short_segments(ring(*points), 0.5).start) == 4


def test_a_ring_keeps_two_segments() -> None:
    """One of short segments alone stays, and one of a single long arc with a short line; others beside it do not."""
    tiny, plain = ring(0, 0.1, 0.1j), ring(0, 9, 9 + 0.1j, 9j)
    lens = replace(
        ring(5, 5 + 0.1j), kind=np.array([LINE, ARC], np.uint8), control=np.array([[0, 0], [-3, 0]], complex)
    )
    found = without_short_segments(Paths.concatenate([tiny, plain, lens]), 0.3)
    assert found.counts.tolist() == [3, 3, 2]
    assert (found.take(np.array([0])).start == tiny.start).all()
    assert (found.take(np.array([2])).control == lens.control).all()


@pytest.mark.parametrize("arcs", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_start_and_direction_do_not_matter(seed: int, arcs: bool) -> None:
    """The same nodes from every start, run through backwards, and in the mirror."""
    given = rough(seed, arcs=arcs)
    wanted = nodes(without_short_segments(given, 0.005))
    assert len(wanted) < len(given.start)
    for first in range(len(given.start)):
        turned = started_at(given, first)
        assert nodes(without_short_segments(turned, 0.005)) == pytest.approx(wanted, abs=1e-12)
        assert nodes(without_short_segments(turned.reversed(), 0.005)) == pytest.approx(wanted, abs=1e-12)
    mirrored = without_short_segments(given.moved(1.0, 0j, conj=True), 0.005)
    assert nodes(mirrored.moved(1.0, 0j, conj=True)) == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize("arcs", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_nothing_moves_by_more_than_the_size(seed: int, arcs: bool) -> None:
    """Both ways, measured on chords."""
    given, size = rough(seed, arcs=arcs), 0.005
    one, two = (dense(paths) for paths in (given, without_short_segments(given, size)))
    apart = [shapely.distance(line, shapely.points(line_of.coords)) for line, line_of in ((one, two), (two, one))]
    assert max(found.max() for found in apart) <= size
    assert max(found.max() for found in apart) > 0.05 * size, "nothing was left out: it tests nothing"


def test_open_paths_are_refused() -> None:
    """Their ends belong to others."""
    with pytest.raises(ValueError, match="closed"):
        without_short_segments(Paths.polylines([np.array([0, 1, 2])]), 0.1)


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

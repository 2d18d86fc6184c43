"""What repeats in a drawing is judged once: the report is that of every path judged on its own."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.formats.svg.reader import svg_drawing
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths
from voronoi_tiles.preflight import PreflightReport, judge
from voronoi_tiles.preflight.chords import chords_of, counts_of
from voronoi_tiles.preflight.surroundings import path_boxes, surroundings

PAGE = 'xmlns="http://www.w3.org/2000/svg" width="900mm" height="900mm" viewBox="0 0 900 900" fill="none" stroke="red"'


def drawn(lines: list[list[complex]], end: str = "Z") -> str:
    """An SVG file of a path through each line's points, with six digits, each with its own name."""
    data = ["M" + "L".join(f"{z.real:.6f} {z.imag:.6f}" for z in line) for line in lines]
    body = "".join(f"<path id='{k}' d='{one}{end if k % 3 else 'Z'}'/>" for k, one in enumerate(data))
    return f"<svg {PAGE}>{body}</svg>"


def corners(generator: np.random.Generator) -> list[complex]:
    """The corners of a star-shaped polygon about the origin."""
    count = int(generator.integers(5, 9))
    angles = (np.arange(count) + generator.uniform(0.1, 0.6, count)) * 2 * np.pi / count
    return list((generator.uniform(2.0, 5.0, count) * np.exp(1j * angles)).tolist())


def lattice(shapes: list[list[complex]], across: complex, up: complex, size: int) -> list[list[complex]]:
    """Three shapes in every cell of a lattice, the third of them the first one again."""
    places = [complex(40, 40) + i * across + j * up for i in range(size) for j in range(size)]
    steps = (0j, (across + up) / 2, across / 2)
    return [
        [z + at + step for z in shape] for at in places for shape, step in zip([*shapes, shapes[0]], steps, strict=True)
    ]


def digest(report: PreflightReport) -> list[tuple[object, ...]]:
    """The findings in an order that does not depend on how they were found."""
    return sorted(
        (one.kind, one.severity, tuple(sorted(one.sources)), *(round(x, 1) for x in one.place or ()), one.value or 0.0)
        for one in report.findings
    )


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 10**9), st.sampled_from(["Z", "", "l0.3 0.1"]))
def test_what_repeats_is_judged_as_what_does_not(seed: int, end: str) -> None:
    """Outlines on a lattice, near each other or across, some of them open: the same findings either way."""
    generator = np.random.default_rng(seed)
    across, up = complex(generator.uniform(12, 18), generator.uniform(-1, 1)), 1j * generator.uniform(8, 14)
    drawing = svg_drawing(
        drawn(lattice([corners(generator), corners(generator)], across, up, 8), end).encode(), "t.svg"
    )
    one = judge(drawing, "t.svg")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("voronoi_tiles.preflight.surroundings.PATHS_MIN", 50)
        paths = Paths.concatenate([shape.paths for shape in drawing.shapes])
        assert surroundings(paths, 2.0, 5e-6) is not None
        other = judge(drawing, "t.svg")
    for a, b in zip(digest(one), digest(other), strict=True):
        assert a[:3] == b[:3]
        assert a[3:] == pytest.approx(b[3:], abs=0.11)


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (2, 0, 1, 3), (3, 1, 0, 2)])
@pytest.mark.parametrize("by_cell", [True, False])
def test_what_more_than_two_paths_bound_is_found_wherever_it_repeats(order: tuple[int, ...], by_cell: bool) -> None:
    """Strips of four lines, whose ends are too far apart to be near to each other, with all of their lines."""
    strip = [[0j, 11 + 0j], [0.4j, 11 + 0.4j], [0j, 0.4j], [11 + 0j, 11 + 0.4j]]
    places = [complex(40 + 12 * i, 40 + 9 * j) for i in range(9) for j in range(9)]
    lines = [[z + at for z in strip[k]] for at in places for k in order]
    if not by_cell:
        lines = [[z + at for z in strip[k]] for k in order for at in places]
    lines += [[40 + 39.8j, 60 + 39.5j], [100 + 100j, 100 + 70j]]  # other surroundings for some of them
    data = ["M" + "L".join(f"{z.real:.6f} {z.imag:.6f}" for z in line) for line in lines]
    body = "".join(f"<path id='{k}' d='{one}'/>" for k, one in enumerate(data))
    drawing = svg_drawing(f"<svg {PAGE}>{body}</svg>".encode(), "t.svg")
    repeated = judge(drawing, "t.svg")
    with pytest.MonkeyPatch.context() as patch:
        assert surroundings(Paths.concatenate([shape.paths for shape in drawing.shapes]), 2.0, 5e-6) is not None
        patch.setattr("voronoi_tiles.preflight.surroundings.PATHS_MIN", 10**6)
        single = judge(drawing, "t.svg")
    slivers = [[one for one in digest(report) if one[0] == "sliver"] for report in (repeated, single)]
    assert len(slivers[1]) > 70
    assert [one[:3] for one in slivers[0]] == [one[:3] for one in slivers[1]]


def test_a_lattice_is_judged_by_a_few_of_its_paths() -> None:
    """Of a sheet of equal tiles one of each surroundings is judged, of tiles that differ all."""
    generator = np.random.default_rng(5)
    lines = lattice([corners(generator), corners(generator)], 13 + 1j, 12j, 12)
    paths = Paths.concatenate([shape.paths for shape in svg_drawing(drawn(lines).encode(), "t").shapes])
    found = surroundings(paths, 2.0, 5e-6)
    assert found is not None
    assert len(found.first) < 60
    assert len(found.judged) < 150
    begin = paths.start[paths.offsets[:-1]]
    for path in found.first.tolist():
        near = found.near[found.offsets[path] : found.offsets[path + 1]].tolist()
        for image, *others in found.images(path, *near):
            there = begin[others] - begin[image] if others else np.zeros(0)
            assert np.abs(there - (begin[near] - begin[path])).max(initial=0.0) < 1e-5
    odd = [[z + complex(40 + 12 * i, 40 + 11 * j) for z in corners(generator)] for i in range(20) for j in range(20)]
    paths = Paths.concatenate([shape.paths for shape in svg_drawing(drawn(odd).encode(), "t").shapes])
    assert surroundings(paths, 2.0, 5e-6) is None


def test_a_moved_corner_is_another_path() -> None:
    """A tile that differs in one point by a hundredth of the tolerance is judged on its own, with its neighbours."""
    generator = np.random.default_rng(6)
    lines = lattice([corners(generator), corners(generator)], 13 + 1j, 12j, 12)
    lines[200][1] += 5e-5
    paths = Paths.concatenate([shape.paths for shape in svg_drawing(drawn(lines).encode(), "t").shapes])
    found = surroundings(paths, 2.0, 5e-6)
    assert found is not None
    alone = np.bincount(found.kind) == 1
    assert alone[found.kind[200]]
    assert all(alone[found.kind[path]] for path in found.near[found.offsets[200] : found.offsets[201]])


@given(
    st.lists(st.complex_numbers(max_magnitude=100), min_size=4, max_size=4), st.sampled_from([LINE, QUAD, CUBIC, ARC])
)
def test_boxes_hold_their_paths(points: list[complex], kind: int) -> None:
    """Lines, curves, and arcs of up to nearly a whole circle."""
    start, first, second, end = points
    if kind == ARC:
        turn = 3.1 * np.exp(1j * np.angle(second or 1.0))
        end = first + (start - first) * np.exp(2j * abs(turn))
        middle = first + (start - first) * np.exp(1j * abs(turn))
        first, second = middle, 0j
    control = np.array([[0, 0], [first, 0], [first, second], [first, 0]][kind : kind + 1], np.complex128)
    one = Paths(
        np.array([start]), np.array([end]), control, np.array([kind], np.uint8), np.array([0, 1]), np.zeros(1, np.bool_)
    )
    low, high = path_boxes(one)
    chords = chords_of(one, counts_of(one, 0.01), 0.01)
    for z in (*chords.start, *chords.end):
        assert low[0].real - 1e-9 <= z.real <= high[0].real + 1e-9
        assert low[0].imag - 1e-9 <= z.imag <= high[0].imag + 1e-9

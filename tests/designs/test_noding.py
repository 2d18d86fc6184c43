"""Noding: against exact arithmetic on a grid, shapely, and invariances."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.tolerance import NODE_MERGE
from voronoi_tiles.designs.site import NodedSite, build_site

Complexes = NDArray[np.complex128]

grid = st.builds(complex, st.integers(0, 6), st.integers(0, 6))
# A grid so fine that hardly anything lies on it, yet no two segments pass each other within rounding.
fine = st.builds(lambda x, y: complex(x, y) / 2**16, *[st.integers(-(2**16), 2**16)] * 2)
grid_lines = st.lists(st.lists(grid, min_size=1, max_size=4), min_size=1, max_size=8)


def site_of(*lines: list[complex]) -> NodedSite:
    """A site of polylines given as lists; repeated neighbouring points are taken out."""
    cleaned = [[z for k, z in enumerate(line) if k == 0 or z != line[k - 1]] for line in lines]
    return build_site("bird", [np.array(line, dtype=complex) for line in cleaned])


def point_to_segment(p: complex, a: complex, b: complex) -> float:
    """The distance of a point to a segment."""
    w = b - a
    t = ((p - a) * w.conjugate()).real / abs(w) ** 2
    return abs(p - (a + min(1.0, max(0.0, t)) * w))


def side(a: complex, b: complex, c: complex) -> int:
    """On which side of the line from a to b the point c is: 1, 0 or -1, exactly."""
    ax, ay, bx, by, cx, cy = (Fraction(x) for z in (a, b, c) for x in (z.real, z.imag))
    turn = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (turn > 0) - (turn < 0)


def faults(site: NodedSite) -> list[str]:
    """What is wrong with a site by brute force over all pairs: the oracle of this module."""
    found = []
    near = NODE_MERGE * max(site.extent, 1e-300) * 0.999
    z = site.nodes.tolist()
    segments = [tuple(segment) for segment in site.segments.tolist()]
    found += ["near nodes" for p, q in combinations(z, 2) if abs(p - q) <= near]
    found += ["zero length" for i, j in segments if i == j]
    if len({frozenset(segment) for segment in segments}) < len(segments):
        found.append("a segment twice")
    for i, j in segments:
        found += [
            "a node on a segment"
            for k, p in enumerate(z)
            if k not in (i, j) and point_to_segment(p, z[i], z[j]) <= near
        ]
    for (i, j), (k, m) in combinations(segments, 2):
        if {i, j} & {k, m}:
            continue
        a, b, c, d = z[i], z[j], z[k], z[m]
        apart = (
            max(a.real, b.real) < min(c.real, d.real)
            or max(c.real, d.real) < min(a.real, b.real)
            or max(a.imag, b.imag) < min(c.imag, d.imag)
            or max(c.imag, d.imag) < min(a.imag, b.imag)
        )
        if not apart and side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0:
            found.append("a crossing")
    return found


def as_shapely(lines: list[list[complex]]) -> shapely.Geometry:
    """The strokes as shapely draws them, noded by GEOS."""
    parts = [
        shapely.Point(line[0].real, line[0].imag)
        if len(set(line)) == 1
        else shapely.LineString([(z.real, z.imag) for z in line])
        for line in lines
    ]
    return shapely.union_all(parts)


def site_shapely(site: NodedSite) -> shapely.Geometry:
    """The elements of a site in shapely."""
    return as_shapely([[complex(x0, y0), complex(x1, y1)] for x0, y0, x1, y1 in site.elements.tolist()])


@settings(deadline=None, max_examples=150)
@given(grid_lines)
def test_noding_on_a_grid(lines: list[list[complex]]) -> None:
    """Collinear, overlapping, T-shaped, crossing, repeated: segments meet only at nodes, the drawing stays."""
    site = site_of(*lines)
    assert not faults(site)
    drawn, noded = as_shapely(lines), site_shapely(site)
    assert noded.length == pytest.approx(drawn.length, rel=1e-12, abs=1e-12)
    assert shapely.hausdorff_distance(drawn, noded) < 1e-12
    # Every point of every stroke is a node or on a segment.
    for z in {z for line in lines for z in line}:
        assert noded.distance(shapely.Point(z.real, z.imag)) < 1e-13 * 6


@settings(deadline=None)
@given(
    st.lists(
        st.tuples(fine, fine).filter(lambda s: s[0] != s[1]),
        min_size=2,
        max_size=12,
    )
)
def test_noding_of_free_segments(segments: list[tuple[complex, complex]]) -> None:
    """The same for coordinates off the grid."""
    lines = [list(segment) for segment in segments]
    site = site_of(*lines)
    assert not faults(site)
    assert site_shapely(site).length == pytest.approx(as_shapely(lines).length, rel=1e-11)


def test_the_oracle_sees_faults() -> None:
    """Each kind of fault, made by hand, is found."""
    nodes = np.array([0, 2, 1 + 1j, 1 - 1j, 1, 1e-14], dtype=complex)

    def broken(*segments: tuple[int, int]) -> list[str]:
        used = sorted({k for segment in segments for k in segment})
        index = {k: n for n, k in enumerate(used)}
        return faults(NodedSite("bird", nodes[used], np.array([[index[i], index[j]] for i, j in segments])))

    assert "a crossing" in broken((0, 1), (2, 3))
    assert "a node on a segment" in broken((0, 1), (4, 2))
    assert "a segment twice" in broken((0, 1), (1, 0))
    assert "near nodes" in broken((0, 1), (5, 2))
    assert not broken((0, 1), (1, 2))


@settings(deadline=None)
@given(st.integers(0, 10**6), st.floats(-1.0, 1.0), st.sampled_from([1e-9, 1.0, 1e9]))
def test_bundles_through_one_point(seed: int, angle: float, size: float) -> None:
    """Many segments through one point, whose pairwise crossings round differently, get one node there."""
    rng = np.random.default_rng(seed)
    turns = np.exp(1j * (angle + np.arange(7) * np.pi / 7))
    lengths = size * rng.uniform(0.5, 2.0, (7, 2))
    centre = size * complex(rng.uniform(), rng.uniform())
    lines = [
        np.array([centre - a * u, centre + b * u], dtype=complex) for u, (a, b) in zip(turns, lengths, strict=True)
    ]
    site = build_site("star", lines)
    assert not faults(site)
    assert len(site.segments) == 14
    assert len(site.nodes) == 15


@pytest.mark.parametrize("gap", [1e-12, 1e-9, 1e-3])
def test_near_misses_stay_apart(gap: float) -> None:
    """Strokes that nearly touch are not joined: T, parallel, and end to end."""
    assert len(site_of([0, 1], [0.5 + gap * 1j, 0.5 + 1j]).segments) == 2
    assert len(site_of([0, 1], [gap * 1j, 1 + gap * 1j]).segments) == 2
    assert len(site_of([0, 1], [1 + gap, 2 + 1j]).nodes) == 4


def test_roundings_are_joined() -> None:
    """What differs by an ulp is one: a T whose foot was computed, and ends that were computed twice."""
    foot = (0.1 + 0.2) + 1j * (0.1 + 0.2) / 3.0
    site = site_of([0, 3 + 1j], [foot, 0.5 + 2j])
    assert len(site.segments) == 3
    twice = site_of([0, 0.1 + 0.2], [0.3, 1 + 1j])
    assert len(twice.nodes) == 3


def test_straight_joints_go_and_corners_stay() -> None:
    """1,000 points computed on a line are one segment; a bend of 1e-12 is a bend."""
    line = np.asarray(3 + 1j + np.linspace(0.0, 1.0, 1000) * (7 - 2j), dtype=np.complex128)
    assert len(build_site("line", [line]).segments) == 1
    assert len(site_of([0, 0.5 + 1e-12j, 1]).segments) == 2
    square = site_of([0, 0.5, 1, 1 + 1j, 0.5 + 1j, 1j, 0])
    assert len(square.segments) == 4
    assert not faults(square)


def test_curves_are_left_alone() -> None:
    """A polyline without contacts keeps its points, in order and to the bit."""
    t = np.linspace(0.0, 6.0, 3000)
    spiral = (1.0 + t) * np.exp(3j * t)
    site = build_site("spiral", [spiral])
    assert site.nodes.tolist() == spiral.tolist()
    assert site.segments.tolist() == [[k, k + 1] for k in range(2999)]


@given(grid_lines, st.sampled_from([2.0**40, 2.0**-40]), st.builds(complex, st.integers(-9, 9), st.integers(-9, 9)))
@settings(deadline=None, max_examples=50)
def test_scaled_and_moved_strokes_node_alike(lines: list[list[complex]], size: float, shift: complex) -> None:
    """The same drawing in other units, and elsewhere, has the same number of nodes and segments."""
    plain = site_of(*lines)
    scaled = site_of(*([size * z for z in line] for line in lines))
    assert scaled.segments.tolist() == plain.segments.tolist()
    assert (scaled.nodes / size).tolist() == plain.nodes.tolist()
    moved = site_of(*([z + shift for z in line] for line in lines))
    assert (len(moved.nodes), len(moved.segments)) == (len(plain.nodes), len(plain.segments))


def test_far_from_the_origin() -> None:
    """A cross at 1e9 has its node within an ulp of the coordinates, and no more nodes than at the origin."""
    far = 1e9 + 1e9j
    site = site_of([far, far + 1 + 1j], [far + 1, far + 1j], [far + 0.25 + 0.25j, far + 2])
    assert len(site.segments) == 8
    assert np.abs(site.nodes - (far + 0.5 + 0.5j)).min() < 3e-7
    with pytest.raises(DesignError, match="rounding of their coordinates"):
        site_of([1e12 + 0j, 1e12 + 1e-4 + 0j, 1e12 + 1e-4j])


def test_many_overlaps_are_refused() -> None:
    """A scribble of 3,000 segments across the whole sheet would be 10 million crossings."""
    rng = np.random.default_rng(5)
    ends = rng.normal(size=(3000, 2)) + 1j * rng.normal(size=(3000, 2))
    with pytest.raises(DesignError, match="too often"):
        build_site("scribble", list(ends))

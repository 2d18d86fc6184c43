"""Lines drawn twice are found, however they are rounded; curves that only touch are not taken for that."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.formats.svg.reader import svg_drawing
from voronoi_tiles.preflight import Finding, Limits, judge
from voronoi_tiles.preflight.coincidence import same_part

PAGE = 'xmlns="http://www.w3.org/2000/svg" width="2000mm" height="2000mm" viewBox="0 0 2000 2000"'
MIDDLE = 1000 + 1000j

Writer = Callable[[complex], str]


def found(*data: str) -> list[Finding]:
    """The errors and warnings where lines meet, on a drawing of these paths."""
    body = "".join(f"<path d='{one}'/>" for one in data)
    drawing = svg_drawing(f"<svg {PAGE} fill='none' stroke='red'>{body}</svg>".encode(), "t.svg")
    report = judge(drawing, "t.svg", limits=Limits(neck=0, feature=0))
    return [one for one in report.findings if one.kind in {"duplicate", "crossing", "touch"}]


def writer(turn: float, digits: int) -> Writer:
    """How a point is written: turned about the origin, and moved to the middle of the page."""
    return lambda z: (
        f" {(z * cmath.rect(1, turn) + MIDDLE).real:.{digits}f} {(z * cmath.rect(1, turn) + MIDDLE).imag:.{digits}f}"
    )


def circle_arcs(radius: float, begin: float, write: Writer) -> str:
    """A circle above the origin (below for radii < 0), of three arcs that begin at an angle."""
    size = abs(radius)
    points = [1j * radius + size * cmath.rect(1, begin + k * 2 * math.pi / 3) for k in range(4)]
    return f"M{write(points[0])}" + "".join(f"A{size} {size} 0 0 1{write(z)}" for z in points[1:]) + "Z"


def circle_cubics(radius: float, begin: float, write: Writer, count: int = 10) -> str:
    """The same of cubic curves, nearly."""
    size, step = abs(radius), 2 * math.pi / count
    handle = 4 / 3 * math.tan(step / 4)
    nodes = [size * cmath.rect(1, begin + k * step) for k in range(count + 1)]
    centre = 1j * radius
    data = f"M{write(centre + nodes[0])}"
    for p, q in pairwise(nodes):
        data += f"C{write(centre + p * (1 + 1j * handle))}{write(centre + q * (1 - 1j * handle))}{write(centre + q)}"
    return data + "Z"


def parabola(radius: float, begin: float, write: Writer) -> str:
    """An arch whose apex, at the origin, has this radius: a closed path of a quadratic curve and two lines."""
    reach = 2 * abs(radius) + begin
    height = reach**2 / (2 * radius)
    return f"M{write(-reach + 1j * height)}Q{write(-1j * height)}{write(reach + 1j * height)}L{write(3j * height)}Z"


def wave(radius: float, begin: float, write: Writer) -> str:
    """Two cubic curves that are joined smoothly at the origin, with this radius there.

    So long that what they have in common with curves of another curvature is less than half of them, which would count.
    """
    a, b = 2 + begin, 3 + begin / 2
    rise = [3 / 2 * length**2 / radius * 1j for length in (a, b)]
    left = f"C{write(-2 * a + rise[0])}{write(-a + 0j)}{write(0j)}"
    right = f"C{write(b + 0j)}{write(2 * b + rise[1])}{write(4 * b + 3 * rise[1])}"
    return f"M{write(-4 * a + 3 * rise[0])}{left}{right}"


def line(_: float, begin: float, write: Writer) -> str:
    """A straight line through the origin."""
    return f"M{write(-30 - begin + 0j)}L{write(35 + begin + 0j)}"


CURVES = {"arcs": circle_arcs, "cubics": circle_cubics, "parabola": parabola, "wave": wave, "line": line}


@settings(max_examples=60, deadline=None)
@given(
    st.tuples(st.sampled_from(sorted(CURVES)), st.sampled_from(sorted(CURVES))).filter(
        lambda kinds: kinds[0] != "line" or kinds[1] != "line"
    ),
    st.tuples(st.floats(1, 150), st.floats(1, 150)),
    st.booleans(),
    st.tuples(st.floats(0, 6), st.floats(0, 6)),
    st.floats(0, 6.3),
    st.sampled_from([4, 6, 9]),
)
def test_curves_that_touch_are_not_cut_twice(
    kinds: tuple[str, str],
    radii: tuple[float, float],
    inside: bool,
    begins: tuple[float, float],
    turn: float,
    digits: int,
) -> None:
    """Circles, arches, waves and lines that touch from outside or inside, wherever they are divided into pieces."""
    one, other = radii[0], radii[1] if inside else -radii[1]
    curvatures = [0.0 if kind == "line" else 1 / r for kind, r in zip(kinds, (one, other), strict=True)]
    # What differs by less is as good as the same curve for the least length that counts as cut twice, and may be said.
    if abs(curvatures[0] - curvatures[1]) < max(0.0045, 0.1 * max(map(abs, curvatures))):
        return
    write = writer(turn, digits)
    meetings = found(*(CURVES[kind](r, b, write) for kind, r, b in zip(kinds, (one, other), begins, strict=True)))
    assert "duplicate" not in {meeting.kind for meeting in meetings}
    if not inside and "wave" not in kinds:
        assert [meeting.kind for meeting in meetings] == ["touch"]
        assert abs(complex(*meetings[0].place or (0, 0)) - MIDDLE) < 1.0


@pytest.mark.parametrize(
    "data",
    [
        ("M50 20A15 15 0 0 1 50 50A15 15 0 0 0 50 80", "M80 50A30 30 0 0 1 20 50A30 30 0 0 1 80 50Z"),
        ("M50 100A50 50 0 0 1 150 100", "M50 100A20 20 0 0 1 90 100", "M90 100A30 30 0 0 1 150 100", "M50 100H150"),
        ("M50 100A50 50 0 0 1 150 100A30 30 0 0 0 90 100A20 20 0 0 0 50 100Z",),
        ("M10 10L110 10.4L10 10.8Z",),
        ("M20 100H200", "M100 100C120 100 140 100 160 130"),
        ("M10 10H100", "M10 10L100 11"),
    ],
)
def test_lines_that_end_where_they_touch_are_joined(data: tuple[str, ...]) -> None:
    """Yin and yang, the arbelos in three lines and in one, sharp corners, a curve that leaves a line: nothing."""
    assert found(*data) == []


def outline(generator: np.random.Generator) -> tuple[list[complex], list[str]]:
    """A closed outline of lines, arcs and cubic curves: its corners, and how one goes to each from the one before."""
    count = int(generator.integers(3, 7))
    corners = [
        generator.uniform(15, 30) * cmath.rect(1, 2 * math.pi * (k + generator.uniform(-0.2, 0.2)) / count)
        for k in range(count)
    ]
    ways = []
    for k in range(count):
        a, b = corners[k - 1], corners[k]
        kind = generator.integers(3)
        bend = (b - a) * generator.uniform(0.1, 0.3) * -1j
        ways.append(
            ("L", "A", "C")[kind]
            + (
                f"{abs(b - a) * generator.uniform(0.7, 2)}"
                if kind == 1
                else f"|{a + (b - a) / 3 + bend}|{a + (b - a) / 1.5 + bend}"
            )
        )
    return corners, ways


def part(corners: list[complex], ways: list[str], write: Writer, which: list[int]) -> str:
    """Some consecutive edges of an outline."""
    data = f"M{write(corners[which[0] - 1])}"
    for k in which:
        way = ways[k]
        if way[0] == "A":
            data += f"A{way[1:]} {way[1:]} 0 0 1{write(corners[k])}"
        elif way[0] == "C":
            data += "C" + "".join(write(complex(z)) for z in way[2:].split("|")) + write(corners[k])
        else:
            data += f"L{write(corners[k])}"
    return data


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**9), st.sampled_from([3, 4, 6]), st.booleans())
def test_a_line_that_is_drawn_again_is_found(seed: int, digits: int, whole: bool) -> None:
    """An outline, or one edge of it as that of a neighbour, again with fewer digits or a thousandth beside itself."""
    generator = np.random.default_rng(seed)
    corners, ways = outline(generator)
    turn = generator.uniform(0, 6.3)
    first = part(corners, ways, writer(turn, 9), list(range(len(corners)))) + "Z"
    which = list(range(len(corners))) if whole else [int(generator.integers(len(corners)))]
    shift = 1e-3 * cmath.rect(1, generator.uniform(0, 6.3)) if generator.integers(2) else 0j
    again = part([z + shift for z in corners], ways, writer(turn, digits), which)
    # A neighbour lies beyond the edge.
    far = 60 * (corners[which[0] - 1] + corners[which[-1]]) / abs(corners[which[0] - 1] + corners[which[-1]])
    again += "Z" if whole else f"L{writer(turn, digits)(far)}Z"
    length = sum(one.value or 0.0 for one in found(first, again) if one.kind == "duplicate")
    chords = sum(abs(corners[k] - corners[k - 1]) for k in which)
    assert 0.95 * chords <= length <= 1.7 * chords + 1.0


@settings(max_examples=15, deadline=None)
@given(st.floats(0.5, 40), st.floats(0, 6), st.floats(0, 6), st.floats(0, 6.3), st.sampled_from([3, 6]))
def test_a_circle_as_arcs_and_as_cubics_is_one(
    radius: float, one: float, other: float, turn: float, digits: int
) -> None:
    """The same circle from two programs, of different curves from different beginnings: once, along all of it."""
    write = writer(turn, digits)
    meetings = found(circle_arcs(radius, one, write), circle_cubics(radius, other, writer(turn, 6), 5))
    assert {meeting.kind for meeting in meetings} == {"duplicate"}
    assert sum(meeting.value or 0.0 for meeting in meetings) == pytest.approx(2 * math.pi * radius, rel=0.02)


def test_what_curves_of_another_curvature_have_in_common_is_no_part() -> None:
    """Powers up to the fourth are explained by their parting; what is the same line beside that is found, nearly."""
    steps = np.linspace(-1, 1, 65)
    powers = np.stack([0.005 * np.abs(steps) ** p for p in (1, 2, 3, 4)])
    assert (same_part(powers, np.full(4, 2.0), 0.005) < 0.02).all()
    flat = np.stack([0.005 * np.maximum(np.abs(steps) * 2 - 1, 0.0) ** p for p in (2, 3)])
    assert (np.abs(same_part(flat, np.full(2, 2.0), 0.005) - 0.8) < 0.2).all()
    rounded = np.random.default_rng(2).uniform(-7e-4, 7e-4, (20, 65)) + 0.005 * np.maximum(steps * 4 - 3, 0.0) ** 2
    assert (same_part(rounded, np.full(20, 2.0), 0.005) > 0.3).all()

"""Ends of lines: short of the line that they should meet, past it, or beside another one."""

from __future__ import annotations

import cmath
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.formats.svg.reader import svg_drawing
from voronoi_tiles.preflight import Finding, judge

PAGE = 'xmlns="http://www.w3.org/2000/svg" width="400mm" height="400mm" viewBox="0 0 400 400"'


def found(*lines: list[complex], turn: float = 0.0) -> list[Finding]:
    """The findings on lines through points, turned about the middle of the page."""
    body = ""
    for line in lines:
        placed = [(z - 50 - 30j) * cmath.rect(1, turn) + 200 * (1 + 1j) for z in line]
        body += "<path d='M" + "L".join(f"{z.real:.6f} {z.imag:.6f}" for z in placed) + "'/>"
    return list(judge(svg_drawing(f"<svg {PAGE} fill='none' stroke='red'>{body}</svg>".encode(), "t"), "t").findings)


@settings(max_examples=30, deadline=None)
@given(
    st.floats(0.01, 0.45),
    st.booleans(),
    st.floats(-0.4, 0.4),
    st.floats(0, 6.3),
    st.booleans(),
    st.sampled_from(["own", "line", "closed"]),
)
def test_an_end_past_a_line_is_no_gap_and_one_short_of_it_is(
    far: float, past: bool, slant: float, turn: float, start: bool, what: str
) -> None:
    """The contour is closed where its end runs past its beginning or another line, and open where it falls short."""
    direction = cmath.rect(1, slant) * -1j
    end = 20 + 10j + (1 if past else -1) * far * direction / direction.imag * -1
    before = 20 + 10j - 25 * direction
    tail = [before, end]
    if what == "own":
        lines = [[0 + 10j, 60 + 10j, 60 + 40j, *tail]]
        lines[0][0] = 19.6 + 10j if start and past else 20 + 10j
    else:
        lines = [[10 + 10j, 60 + 10j, 60 - 20j, 10 - 20j, 10 + (10j if what == "closed" else 9.4j)], tail]
    if start:
        lines = [line[::-1] for line in lines]
    kinds = {one.kind for one in found(*lines, turn=turn)}
    assert ("gap" in kinds) == (not past)
    assert ("overshoot" in kinds) == past
    assert "crossing" not in kinds


def test_what_a_line_meets_before_closes_no_gap() -> None:
    """A line that joins a contour just before its end is not what that end should have met."""
    contour = [20 + 10j, 60 + 10j, 60 + 40j, 20 + 40j, 20 + 10.2j]
    assert "gap" in {one.kind for one in found(contour, [20 + 10.7j, 60 + 30j])}
    assert "gap" in {one.kind for one in found(contour, [10 + 10.7j, 40 + 10.7j])}


def test_a_line_that_crosses_far_from_its_end_crosses() -> None:
    """Two millimetres past are no overshoot: the lines cross, and the ends are loose."""
    kinds = [one.kind for one in found([10 + 10j, 60 + 10j], [30 + 40j, 30 + 8j])]
    assert sorted(kinds) == ["crossing", "loose end", "loose end", "loose end", "loose end"]


@pytest.mark.parametrize("angle", [0.1, 0.15, 0.2, 0.4, 1.5])
@pytest.mark.parametrize("met", ["M 100 200 H 300", "M 180 200 A 20 20 0 0 0 220 200 A 20 20 0 0 0 180 200"])
def test_an_end_that_hardly_passes_a_line_does_not_cross_it(met: str, angle: float) -> None:
    """However flat it meets it: within the tolerance it ends at the line, up to a gap it is past it."""
    straight, normal = "H" in met, 1j if "H" in met else cmath.rect(1, 0.7)
    place = 200 + 200j + (0 if straight else 20 * normal)
    way = -normal * cmath.rect(1, math.pi / 2 - angle)
    for past in (0.004, 0.009, 0.014, 0.018, 0.021, 0.025, 0.03, 0.04, 0.06, 0.1, 0.2, 0.4):
        begin, end = place - 9 * way, place + past * way
        path = f"M {begin.real:.9f} {begin.imag:.9f} L {end.real:.9f} {end.imag:.9f}"
        document = f"<svg {PAGE} fill='none' stroke='red'><path d='{met}'/><path d='{path}'/></svg>"
        kinds = {one.kind for one in judge(svg_drawing(document.encode(), "t"), "t").findings}
        off = abs((end - place).imag) if straight else 20 - abs(end - 200 - 200j)
        assert "crossing" not in kinds, past
        if abs(off - 0.005) > 0.001:  # an arc is judged by its chords
            assert ("overshoot" in kinds) == (off > 0.005), past


@settings(max_examples=15, deadline=None)
@given(st.floats(0.016, 0.45), st.floats(0, 6.3), st.floats(0, 5), st.floats(-5, 5), st.booleans())
def test_lines_side_by_side_have_no_gaps(apart: float, turn: float, begin: float, end: float, backwards: bool) -> None:
    """Two lines beside each other: their ends are loose, and how narrow it is between them is said."""
    other = [10 + begin + (10 + apart) * 1j, 90 + end + (10 + apart) * 1j]
    findings = found([10 + 10j, 90 + 10j], other[::-1] if backwards else other, turn=turn)
    assert sorted(one.kind for one in findings) == ["loose end"] * 4 + ["neck"]
    assert findings[-1].value == pytest.approx(apart, abs=1e-3)


def test_an_end_beside_a_line_still_has_to_meet_another() -> None:
    """Two lines a third of a millimetre apart that both end short of a third one: two gaps."""
    findings = found([10 + 10j, 59.6 + 10j], [10 + 10.3j, 59.6 + 10.3j], [60 + 0j, 60 + 30j])
    assert sorted(one.kind for one in findings if one.severity == "error") == ["gap", "gap"]
    # Ends that pass each other by little are no lines side by side.
    assert "gap" in {one.kind for one in found([10 + 10j, 50 + 10j], [49.9 + 10.02j, 90 + 10.02j])}

"""SVG path data: every command, the strict grammar, arcs on their ellipses, and svgelements as a second reader.

Designs and drawings have one reader; what it draws is seen here as a design's cubic pieces.
"""

from __future__ import annotations

import math
import random
import re
from unittest import mock

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Affine
from voronoi_tiles.designs.strokes import ARC_SHARE, path_pieces
from voronoi_tiles.formats.pen import PathPen, Pen
from voronoi_tiles.formats.shapes import CURVE_ACCURACY, SEGMENTS_MAX, DrawingError
from voronoi_tiles.formats.svg import pathdata
from voronoi_tiles.formats.svg.pathdata import draw_path
from voronoi_tiles.paths.ellipses import EllipticalArc
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

Complexes = NDArray[np.complex128]


def line(start: complex, end: complex) -> list[complex]:
    """The piece of a straight line."""
    return [start, start, end, end]


def quadratic(start: complex, control: complex, end: complex) -> list[complex]:
    """The piece of a quadratic curve, raised."""
    return [start, start + 2 / 3 * (control - start), end + 2 / 3 * (control - end), end]


@pytest.mark.parametrize(
    ("data", "pieces"),
    [
        ("M1 2L3 4", [line(1 + 2j, 3 + 4j)]),
        ("m1 2l3 4", [line(1 + 2j, 4 + 6j)]),
        ("M1,2 3,4 5,6", [line(1 + 2j, 3 + 4j), line(3 + 4j, 5 + 6j)]),
        ("m1,2 3,4 5,6", [line(1 + 2j, 4 + 6j), line(4 + 6j, 9 + 12j)]),
        ("M1 2H5V7h-1v-2", [line(1 + 2j, 5 + 2j), line(5 + 2j, 5 + 7j), line(5 + 7j, 4 + 7j), line(4 + 7j, 4 + 5j)]),
        ("M0 0H1 2 3", [line(0, 1), line(1, 2), line(2, 3)]),
        ("M0 0 1 0 1 1z", [line(0, 1), line(1, 1 + 1j), line(1 + 1j, 0)]),
        ("M0 0h1v1zl2 2", [line(0, 1), line(1, 1 + 1j), line(1 + 1j, 0), line(0, 2 + 2j)]),
        ("M1 1h1zm2 0h1", [line(1 + 1j, 2 + 1j), line(2 + 1j, 1 + 1j), line(3 + 1j, 4 + 1j)]),
        ("M0 0C1 2 3 4 5 6", [[0, 1 + 2j, 3 + 4j, 5 + 6j]]),
        ("M1 0c1 2 3 4 5 6S9 9 8 7", [[1, 2 + 2j, 4 + 4j, 6 + 6j], [6 + 6j, 8 + 8j, 9 + 9j, 8 + 7j]]),
        ("M0 0C1 2 3 4 5 6s1 1 2 0", [[0, 1 + 2j, 3 + 4j, 5 + 6j], [5 + 6j, 7 + 8j, 6 + 7j, 7 + 6j]]),
        ("M0 0S1 2 3 4", [[0, 0, 1 + 2j, 3 + 4j]]),
        ("M0 0Q3 3 6 0", [quadratic(0, 3 + 3j, 6)]),
        ("M0 0q3 3 6 0t6 0 6 0", [quadratic(0, 3 + 3j, 6), quadratic(6, 9 - 3j, 12), quadratic(12, 15 + 3j, 18)]),
        ("M0 0C0 3 6 3 6 0T12 0", [[0, 3j, 6 + 3j, 6], quadratic(6, 6, 12)]),
        ("M0 0Q3 3 6 0S9 1 12 0", [quadratic(0, 3 + 3j, 6), [6, 6, 9 + 1j, 12]]),
        ("M0 0A0 5 0 0 1 3 4", [line(0, 3 + 4j)]),
        ("M.5.5-1-1", [line(0.5 + 0.5j, -1 - 1j)]),
        ("M1e1-1E-1+2.5.5", [line(10 - 0.1j, 2.5 + 0.5j)]),
        ("\n M\t1.\r0 ,\f2 , 3 ", [line(1, 2 + 3j)]),
        ("M0 0L0 0L1 0", [line(0, 1)]),
    ],
)
def test_commands(data: str, pieces: list[list[complex]]) -> None:
    """Every command by its definition, with repetition, compact numbers, and reflection only after its own kind."""
    assert np.abs(path_pieces(data, 0.01) - np.array(pieces)).max() < 1e-14


@pytest.mark.parametrize(
    ("data", "position", "expected"),
    [
        (",", 1, "M or m"),
        ("  5", 3, "M or m"),
        ("L 1 1", 1, "M or m"),
        ("1 1", 1, "M or m"),
        ("M 1", 4, "a number"),
        ("M 1 1 L 2", 10, "a number"),
        ("M 1 1 C 1 2 3 4 5", 18, "a number"),
        ("M 1 1 L 2 3 X 4 5", 13, "a command"),
        ("M 1 1 L 2 3, L 4 5", 12, "a command"),
        ("M 1 1 L 2 3,", 12, "a command"),
        ("M 1 1 L, 2 3", 8, "a number"),
        ("M 1,,1 L 2 3", 5, "a number"),
        ("M 1 1 Z 2 3", 9, "a command"),
        ("M 1 1 A 3 3 0 2 1 5 5", 15, "a flag"),
        ("M 1 1 A 3 3 0 1 -1 5 5", 17, "a flag"),
        ("M 1 1 L 1e 3", 10, "a number for L"),
        ("M 1 1 L nan 3", 9, "a number"),
        ("M 1 1 L 0x10 3", 10, "a number for L"),
        ("M 1 1 L 2;3", 10, "a number"),
        ("M 1 1 L 2 3 é", 13, "a command"),
        ("M1 1L2,,3", 8, "a number for L"),
        ("M 1 1 L 1_0 3", 10, "a number for L"),
        ("M 1 1 L \u0661 3", 9, "a number for L"),
        ("M 1 1 L 2\u00a03", 10, "a number for L"),
        ("M 1 1 C 1 2 3 4 5 6 7", 22, "a number for C"),
        ("M 1 1 H 1 V", 12, "a number for V"),
        ("M 1 1 A 3 3 300 1 5 5", 19, "a flag 0 or 1 for A"),
        ("M 1 1 " + "L 2 3 " * 200 + "L 2", 1210, "a number for L"),
        ("M 1 1 " + "L 2 3 " * 200 + "L 2 3 4", 1214, "a number for L"),
        ("M 1 1 " + "L 2 3 " * 200 + "Z 4", 1209, "a command"),
        ("5 M 1 1 " + "L 2 3 " * 200, 1, "M or m"),
    ],
)
def test_broken_data_is_named_by_its_place(data: str, position: int, expected: str) -> None:
    """Nothing is skipped in silence: the message says what was expected at which character."""
    with pytest.raises(DesignError, match="broken SVG path data") as caught:
        path_pieces(data, 0.01)
    found = f"found {data[position - 1]!r}" if position <= len(data) else "where the data end"
    assert expected in caught.value.message
    assert f"at character {position}, {found}" in caught.value.message
    with pytest.raises(DrawingError) as drawing:
        draw_path(Pen(), data)
    assert drawing.value.message == caught.value.message


def place_of(error: DrawingError) -> int:
    """The character that a message names."""
    found = re.search(r"at character (\d+)", error.message)
    assert found
    return int(found[1])


def error_of(data: str) -> DrawingError | None:
    """The error of path data, None where they are right."""
    try:
        draw_path(PathPen(0.1), data)
    except DrawingError as error:
        return error
    return None


GRAMMAR = st.text("MmLlHhVvCcSsQqTtAaZz0123456789+-.,eE \n", max_size=40)


@given(GRAMMAR)
def test_the_character_named_is_the_first_that_does_not_fit(data: str) -> None:
    """Up to it the data can be gone on with: they are right, or end too early; with it they can not."""
    data = "M1 1" + data
    error = error_of(data)
    if error is None:
        assert pathdata._first_error(data, "").message.endswith(f"at character {len(data) + 1}, where the data end")
        return
    place = place_of(error)
    if "beyond" in error.message or place > len(data):
        return
    before = error_of(data[: place - 1])
    assert before is None or place_of(before) == place
    named = error_of(data[:place])
    assert named is not None
    assert place_of(named) == place


PLAIN = st.lists(
    st.one_of(
        st.builds("M{} {}".format, *[st.integers(-9, 9)] * 2),
        st.builds("L {} {} {} {} ".format, *[st.floats(-9, 9)] * 4),
        st.builds("Q{} {}\n{} {}".format, *[st.floats(-1e3, 1e3)] * 4),
        st.builds("C {} {} {} {} {} {}".format, *[st.integers(-9, 9)] * 6),
        st.sampled_from(["M 1 2 3 4", "Z", "z ", "M", "L 1", "5", "L1-1", "Z 1", "L 1e13 0", "L 1e400 0"]),
    ),
    max_size=12,
).map(" ".join)


@given(PLAIN)
@example("5 M0 0 L 1")  # a number before the first command, and one too few after it
def test_data_drawn_at_once_are_the_same(data: str) -> None:
    """The short way for long data draws the same bits as command by command, or leaves them alone."""
    pens = PathPen(0.1), PathPen(0.1)
    if not pathdata._drawn_at_once(pens[0], data):
        assert not len(pens[0].curves().kind)
        return
    with mock.patch.object(pathdata, "_LONG", math.inf):  # command by command
        draw_path(pens[1], data)
    first, second = ([np.asarray(column).tobytes() for column in pen.curves()] for pen in pens)
    assert first == second


def test_most_plain_data_are_drawn_at_once() -> None:
    """The test before tests something: data of absolute commands go that way."""
    assert pathdata._drawn_at_once(PathPen(0.1), "M 1 2 L 3 4 5 6 Q 1 2 3 4 C 1 2 3 4 5 6 Z L 1 1 M 1 1 z")
    assert not pathdata._drawn_at_once(PathPen(0.1), "M 1 2 l 3 4")


@pytest.mark.parametrize("data", ["", " ", "M 1 1", "M 1 1 Z", "M 1 1 L 1 1", "M 1 1 A 3 3 0 0 0 1 1", "M 0 0 m 1 1"])
def test_paths_that_draw_nothing_are_refused(data: str) -> None:
    """No piece, or only pieces of zero length."""
    with pytest.raises(DesignError, match="draws nothing"):
        path_pieces(data, 0.01)


def test_absurd_numbers_are_refused() -> None:
    """Infinite exponents and huge coordinates do not reach the geometry."""
    for data in ("M 0 0 L 1e999 0", "M 0 0 L 1e13 0"):
        with pytest.raises(DesignError, match="beyond 1e\\+12"):
            path_pieces(data, 0.01)


@given(GRAMMAR)
def test_only_design_errors_come_out(data: str) -> None:
    """Whatever the text, there are finite pieces or a DesignError."""
    try:
        pieces = path_pieces("M" + data, 0.01)
    except DesignError:
        return
    assert pieces.shape[1] == 4
    assert np.isfinite(pieces).all()


# --- arcs -------------------------------------------------------------------------------------------------------


def sampled(pieces: Complexes, count: int = 101) -> Complexes:
    """Points along all pieces."""
    t = np.linspace(0.0, 1.0, count)
    s = 1.0 - t
    weights = np.stack([s**3, 3 * s * s * t, 3 * s * t * t, t**3])
    return np.asarray((pieces @ weights).ravel())


@pytest.mark.parametrize("accuracy", [0.1, 1e-3, 1e-6])
@pytest.mark.parametrize("large", [0, 1])
@pytest.mark.parametrize("sweep", [0, 1])
def test_circular_arcs_in_closed_form(accuracy: float, large: int, sweep: int) -> None:
    """An arc of radius 5 over a chord of 6 has its centre 4 beside the chord's middle."""
    pieces = path_pieces(f"M-3 0A5 5 0 {large} {sweep} 3 0", accuracy)
    assert pieces[0, 0] == -3
    assert pieces[-1, 3] == 3
    # Counterclockwise (sweep 1, y up) the short way round runs below: its centre is above.
    centre = 4j if sweep != large else -4j
    z = sampled(pieces)
    assert np.abs(np.abs(z - centre) - 5.0).max() <= ARC_SHARE * accuracy + 1e-14
    turn = np.angle((z[1:] - centre) / (z[:-1] - centre))
    assert (turn >= -1e-9).all() if sweep else (turn <= 1e-9).all()
    angle = 2.0 * math.asin(0.6)
    assert abs(turn.sum()) == pytest.approx(2.0 * math.pi - angle if large else angle, rel=1e-9)


@given(
    st.floats(0.1, 50.0),
    st.floats(0.1, 50.0),
    st.floats(-400.0, 400.0),
    st.booleans(),
    st.booleans(),
    st.builds(complex, st.floats(-20.0, 20.0), st.floats(-20.0, 20.0)).filter(lambda z: abs(z) > 1e-3),
)
def test_elliptical_arcs(rx: float, ry: float, degrees: float, large: bool, sweep: bool, end: complex) -> None:
    """In the frame where the ellipse is a circle, the arc has one radius, the asked direction and the asked length."""
    flags = f"{int(large)} {int(sweep)}"
    pieces = path_pieces(f"M0 0A{rx!r} {ry!r} {degrees!r} {flags} {end.real!r} {end.imag!r}", 1e-6)
    assert (pieces[1:, 0] == pieces[:-1, 3]).all()
    assert pieces[-1, 3] == end
    z = sampled(pieces) * np.exp(-1j * math.radians(degrees))
    w = z.real / rx + 1j * z.imag / ry
    chord = abs(w[-1] - w[0])
    radius = max(1.0, chord / 2.0)
    height = math.sqrt(max(0.0, radius**2 - chord**2 / 4.0))
    side = 1j if large != sweep else -1j
    centre = (w[0] + w[-1]) / 2.0 + side * height * (w[-1] - w[0]) / chord
    # A radius near half the chord leaves the centre uncertain by the root of the rounding.
    assert np.abs(np.abs(w - centre) - radius).max() < 1e-6
    turn = np.angle((w[1:] - centre) / (w[:-1] - centre)).sum()
    assert turn > 0.0 if sweep else turn < 0.0
    assert (abs(turn) > math.pi - 1e-5) if large else (abs(turn) < math.pi + 1e-5)


def exact_centre(arc: tuple[float, float, float, bool, bool, complex]) -> tuple[mpmath.mpc, mpmath.mpf]:
    """The centre on the unit circle's plane, and the radius there, of an arc from 0, in 50 digits by SVG's formulas."""
    rx, ry, degrees, large, sweep, end = arc
    turn = mpmath.expjpi(-mpmath.mpf(degrees) / 180)
    half = mpmath.mpc(end) / 2 * turn
    half = mpmath.mpc(half.real / rx, half.imag / ry)
    square = abs(half) ** 2
    beside = mpmath.mpc(0, mpmath.sqrt(max(mpmath.mpf(0), 1 / square - 1)))
    return half + half * (beside if large != sweep else -beside), mpmath.sqrt(max(mpmath.mpf(1), square))


@settings(deadline=None)
@given(
    st.tuples(
        st.floats(0.01, 1e4),
        st.floats(0.01, 1e4),
        st.floats(-400.0, 400.0),
        st.booleans(),
        st.booleans(),
        st.builds(complex, st.floats(-20.0, 20.0), st.floats(-20.0, 20.0)).filter(lambda z: abs(z) > 1e-3),
    )
)
def test_points_of_arcs_in_fifty_digits(arc: tuple[float, float, float, bool, bool, complex]) -> None:
    """Points and tangents are those of the exact ellipse, as near as the chord lets it be known."""
    rx, ry, degrees, large, sweep, end = arc
    found = EllipticalArc.between(0j, end, (rx, ry), degrees, large, sweep)
    assert found is not None
    with mpmath.workdps(50):
        turn = mpmath.expjpi(-mpmath.mpf(degrees) / 180)
        centre, radius = exact_centre(arc)
        half_chord = abs(centre) if radius == 1 else radius
        assert mpmath.almosteq(half_chord, radius, 1e-40)
        chord = mpmath.mpc(end) * turn
        sine = abs(mpmath.mpc(chord.real / rx, chord.imag / ry)) / 2
        # Rounding of the chord goes into the angle by the tangent of half of it, and into lengths by the ellipse.
        doubt = 32 * mpmath.mpf(2) ** -53 / mpmath.sqrt(min(1, max(abs(1 - sine**2), mpmath.mpf(2) ** -50)))
        doubt *= max(rx, ry) / min(rx, ry)
        for share in (-1.0, -0.6, 0.0, 0.3, 1.0):
            s = share * found.half
            z = mpmath.mpc(found.point(s)) * turn
            w = mpmath.mpc(z.real / rx, z.imag / ry) - centre
            assert abs(abs(w) - radius) <= doubt * radius
            t = mpmath.mpc(found.tangent(s)) * turn
            t = mpmath.mpc(t.real / rx, t.imag / ry)
            assert abs(t - w * mpmath.mpc(0, 1 if sweep else -1)) <= doubt * radius


def test_arcs_about_a_centre() -> None:
    """A turned ellipse and a whole circle: ends, middles and the sense of the turn, in closed form."""
    ellipse = Affine(3 + 0j, 1 + 0j, 7j)  # x 4, y 2; the shift is none of an ellipse's
    quarter = EllipticalArc.about(5 + 0j, 1 + 2j, ellipse, 0.0, math.pi / 2)  # about 1
    assert abs(quarter.point(0.0) - (1 + 4 * math.sqrt(0.5) + 2j * math.sqrt(0.5))) < 1e-15
    assert abs(quarter.tangent(-math.pi / 4) - 2j) < 1e-15
    back = EllipticalArc.about(1 + 2j, 5 + 0j, ellipse, math.pi / 2, -math.pi / 2)
    assert abs(back.point(0.0) - quarter.point(0.0)) < 1e-15
    assert abs(back.tangent(math.pi / 4) + 2j) < 1e-15
    whole = EllipticalArc.about(5 + 0j, 5 + 0j, Affine(2 + 0j, 0j, 0j), 0.0, math.tau)  # about 3
    points = [whole.point(share * math.pi) for share in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    assert np.abs(np.array(points) - [5, 3 + 2j, 1, 3 - 2j, 5]).max() < 1e-15
    assert abs(whole.ellipse.largest - 2.0) < 1e-15


def test_a_circle_that_is_all_but_closed_is_drawn() -> None:
    """Programs write circles as arcs whose ends all but meet; that is no line."""
    pieces = path_pieces("M0 0A5 5 0 1 1 1e-13 0", 1e-3)
    z = sampled(pieces)
    assert np.abs(np.abs(z + 5j) - 5.0).max() < 1e-5
    assert z.imag.min() == pytest.approx(-10.0)


def test_radii_that_are_too_small_grow() -> None:
    """A half circle over the chord, as SVG asks; negative radii count as positive."""
    for data in ("M-3 0A1 1 0 0 1 3 0", "M-3 0A-1-1 0 0 1 3 0", "M-3 0A3 3 0 1 1 3 0"):
        z = sampled(path_pieces(data, 1e-9))
        assert np.abs(np.abs(z) - 3.0).max() < 1e-11
        assert z.imag.min() == pytest.approx(-3.0)


def test_huge_radii_do_not_cancel() -> None:
    """A radius of 1e11 over a chord of 2: a sagitta of 5e-12, not noise."""
    z = sampled(path_pieces("M-1 0A1e11 1e11 0 0 1 1 0", 1e-9))
    assert np.abs(z.imag).max() == pytest.approx(5e-12, rel=1e-3)
    assert (np.diff(z.real) >= 0.0).all()


def test_compact_flags() -> None:
    """Flags need no separator, not even before the next number."""
    compact = path_pieces("M0 0a25,25 -30 0150-25", 0.01)
    spaced = path_pieces("M 0 0 a 25 25 -30 0 1 50 -25", 0.01)
    assert compact.tolist() == spaced.tolist()


# --- a drawing's pen -----------------------------------------------------------------------------------------------


def drawn(data: str, to_page: Affine = Affine(1 + 0j, 0j, 0j)) -> Paths:  # noqa: B008 - it is immutable
    """The paths of path data on a page."""
    pen = Pen()
    pen.begin(to_page)
    draw_path(pen, data)
    return pen.shapes()[0][0]


def test_paths_of_a_drawing() -> None:
    """Each curve keeps its kind, each path its ends; what has no length is left out, with paths of nothing else."""
    paths = drawn("M1 1M0 0L0 0L5 0Q6 1 5 2C4 3 3 3 2 2A1 1 0 0 1 0 2zl0-1M9 9zM3 3C3 3 3 3 3 3Q3 3 3 3z")
    assert paths.kind.tolist() == [LINE, QUAD, CUBIC, ARC, LINE, LINE]
    assert paths.offsets.tolist() == [0, 5, 6]
    assert paths.closed.tolist() == [True, False]
    assert paths.start.tolist() == [0, 5, 5 + 2j, 2 + 2j, 2j, 0]
    assert paths.end.tolist() == [5, 5 + 2j, 2 + 2j, 2j, 0, -1j]
    assert paths.control[:3].tolist() == [[0, 0], [6 + 1j, 0], [4 + 3j, 3 + 3j]]
    assert paths.control[3, 0] == pytest.approx(1 + 1j if paths.control[3, 0].imag < 2 else 1 + 3j, abs=1e-15)
    assert not paths.control[4:].any()


@pytest.mark.parametrize("data", ["M0 0L1 0L1 1L{0} 0z", "M0 0L1 0L1 1L{0} 0L{0} 0z", "M0 0L1 0Q1 1 {0} 0z"])
def test_paths_that_miss_their_beginning_by_rounding_end_there(data: str) -> None:
    """No line of a picometre closes a path, on a page of any scale; one that is longer than the accuracy stays."""
    for scale in (1.0, 1e3):
        near, far = (drawn(data.format(gap * CURVE_ACCURACY / scale), Affine(scale + 0j, 0j, 0j)) for gap in (0.9, 1.1))
        assert len(near.kind) == 3 - data.count("Q")
        assert len(far.kind) == len(near.kind) + 1
        assert near.end[-1] == near.start[0] == far.end[-1] == 0


def test_a_line_there_and_back_is_kept() -> None:
    """A path is not closed by making a line that goes nowhere of its only one."""
    paths = drawn("M0 0L1e-5 0z")
    assert paths.start.tolist() == [0, 1e-5]
    assert paths.end.tolist() == [1e-5, 0]


def test_too_many_curves_are_refused() -> None:
    """One more than there may be, whichever way they are drawn; moves are none."""
    pen = PathPen(0.1)
    line = "L1 0 0 0 " * (SEGMENTS_MAX // 8)
    draw_path(pen, "M0 0 M0 0 M0 0" + line * 4)
    for data in ("M0 0L1 1", "m0 0l1 1"):
        with pytest.raises(DrawingError, match="more than 2,000,000 lines and curves"):
            draw_path(pen, data)


# --- a second reader ----------------------------------------------------------------------------------------------


def random_path(rng: random.Random) -> str:
    """Path data without what svgelements reads otherwise: T after cubics, S after quadratics, arcs of no radius."""

    def n() -> str:
        return f"{rng.uniform(-9, 9):.3f}"

    parts = [f"M{n()} {n()}"]
    smooth = ""
    for _ in range(rng.randint(1, 8)):
        letter = rng.choice("MLHVCSQTAZ")
        if (letter == "S" and smooth == "q") or (letter == "T" and smooth == "c"):
            letter = "L"
        smooth = {"C": "c", "S": "c", "Q": "q", "T": "q"}.get(letter, "")
        count = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 0, "Z": 0}[letter]
        arguments = " ".join(n() for _ in range(count))
        if letter == "A":
            radii = f"{rng.uniform(1, 9):.2f} {rng.uniform(1, 9):.2f}"
            arguments = f"{radii} {n()} {rng.randint(0, 1)} {rng.randint(0, 1)} {n()} {n()}"
        parts.append(rng.choice([letter, letter.lower()]) + arguments)
    return " ".join(parts)


def draws_a_dot(data: str) -> bool:
    """Whether a subpath that is moved to, as svgelements sees it, has segments and none of a length."""
    import svgelements

    for subpath in svgelements.Path(data).as_subpaths():
        drawn = [segment for segment in subpath if not isinstance(segment, svgelements.Move)]
        begun = len(drawn) < len(subpath)  # one that goes on after a Z is no dot: the Z was drawn
        if begun and drawn and all(segment.start == segment.end and segment.length() < 1e-9 for segment in drawn):
            return True
    return False


@settings(deadline=None)
@given(st.randoms(use_true_random=False))
def test_svgelements_reads_the_same(rng: random.Random) -> None:
    """An independent reader draws the same pieces (arcs compared by their ends and middles)."""
    import svgelements

    data = random_path(rng)
    wanted: list[tuple[complex, ...]] = []
    for segment in svgelements.Path(data):
        if isinstance(segment, svgelements.Move) or (segment.start == segment.end and segment.length() < 1e-9):
            continue
        places = (segment.start, segment.point(0.5), segment.end)
        wanted.append(tuple(complex(place[0], place[1]) for place in places))
    if not wanted or draws_a_dot(data):
        with pytest.raises(DesignError, match="draws nothing" if not wanted else "goes nowhere"):
            path_pieces(data, 1e-3)
        return
    pieces = path_pieces(data, 1e-3)
    z = sampled(pieces, 201)
    for start, middle, end in wanted:
        for point in (start, middle, end):
            assert np.abs(z - point).min() < 0.2  # half the distance of two samples of the longest piece
        assert np.abs(pieces[:, 0] - start).min() < 1e-9
        assert np.abs(pieces[:, 3] - end).min() < 1e-9

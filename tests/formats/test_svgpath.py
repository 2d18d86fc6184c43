"""SVG path data: every command, the strict grammar, arcs on their ellipses, and svgelements as a second reader."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.svgpath import ARC_SHARE, path_pieces

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
        ("", 1, "M or m"),
        ("  ", 3, "M or m"),
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
    ],
)
def test_broken_data_is_named_by_its_place(data: str, position: int, expected: str) -> None:
    """Nothing is skipped in silence: the message says what was expected at which character."""
    with pytest.raises(DesignError, match="broken SVG path data") as caught:
        path_pieces(data, 0.01)
    assert expected in caught.value.message
    assert f"at character {position}" in caught.value.message


@pytest.mark.parametrize("data", ["M 1 1", "M 1 1 Z", "M 1 1 L 1 1", "M 1 1 A 3 3 0 0 0 1 1", "M 0 0 m 1 1"])
def test_paths_that_draw_nothing_are_refused(data: str) -> None:
    """No piece, or only pieces of zero length."""
    with pytest.raises(DesignError, match="draws nothing"):
        path_pieces(data, 0.01)


def test_absurd_numbers_are_refused() -> None:
    """Infinite exponents and huge coordinates do not reach the geometry."""
    for data in ("M 0 0 L 1e999 0", "M 0 0 L 1e13 0"):
        with pytest.raises(DesignError, match="beyond 1e\\+12"):
            path_pieces(data, 0.01)


@given(st.text("MmLlHhVvCcSsQqTtAaZz0123456789+-.,eE \n", max_size=40))
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
    try:
        pieces = path_pieces(data, 1e-3)
    except DesignError:
        assert not wanted
        return
    z = sampled(pieces, 201)
    for start, middle, end in wanted:
        for point in (start, middle, end):
            assert np.abs(z - point).min() < 0.2  # half the distance of two samples of the longest piece
        assert np.abs(pieces[:, 0] - start).min() < 1e-9
        assert np.abs(pieces[:, 3] - end).min() < 1e-9

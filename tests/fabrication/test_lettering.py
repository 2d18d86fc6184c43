"""Single-stroke lettering: the glyphs of the font, their size and place, and the room for a label in a tile."""

from __future__ import annotations

import string
from functools import cache

import numpy as np
import pytest
from HersheyFonts import HersheyFonts
from hypothesis import given
from hypothesis import strategies as st

from voronoi_tiles.fabrication.lettering import (
    fitting_height,
    label_position,
    lettering,
    place_labels,
    printable,
    text_width,
)
from voronoi_tiles.paths.paths import LINE, Paths

ASCII = "".join(map(chr, range(32, 127)))
TEXTS = st.text(st.sampled_from(ASCII), max_size=12)
HEIGHTS = st.floats(0.1, 50)
POINTS = st.builds(complex, st.floats(-500, 500), st.floats(-500, 500))


def polylines(paths: Paths) -> list[list[complex]]:
    """The corners of each path; fails where a piece does not begin where the one before ends."""
    found = []
    for first, stop in zip(paths.offsets[:-1], paths.offsets[1:], strict=True):
        assert np.array_equal(paths.start[first + 1 : stop], paths.end[first : stop - 1])
        found.append([*paths.start[first:stop].tolist(), complex(paths.end[stop - 1])])
    return found


@cache
def library(font: str) -> HersheyFonts:
    """The library with one of its fonts."""
    return HersheyFonts(load_default_font=font)


def library_strokes(text: str, height: float, font: str = "futural") -> list[list[complex]]:
    """The strokes by the library's own typesetting, its y turned, the base line at 0, the leftmost ink at 0."""
    scale = height / 21  # from the base line at 9 to the cap line at -12
    strokes = [[complex(x, 9 - y) for x, y in stroke] for stroke in library(font).strokes_for_text(text)]
    left = min((z.real for stroke in strokes for z in stroke), default=0.0)
    return [[scale * (z - left) for z in stroke] for stroke in strokes]


@given(TEXTS, HEIGHTS)
def test_the_strokes_are_those_of_the_library(text: str, height: float) -> None:
    """Every stroke, in its order, at its place: the library's own typesetting is the oracle."""
    ours = polylines(lettering(text, height=height))
    expected = library_strokes(text, height)
    assert [len(line) for line in ours] == [len(line) for line in expected]
    for line, other in zip(ours, expected, strict=True):
        assert line == pytest.approx(other, abs=1e-12 * height * (len(text) + 1))


def test_the_oracle_sees_another_text_height_and_font() -> None:
    """A comparison that cannot fail would prove nothing."""
    corners = [z for line in polylines(lettering("H2", height=3)) for z in line]
    for strokes in (library_strokes("H3", 3), library_strokes("H2", 3.001), library_strokes("H2", 3, "timesr")):
        other = [z for stroke in strokes for z in stroke]
        assert len(corners) != len(other) or corners != pytest.approx(other, abs=1e-12)


@pytest.mark.parametrize("letter", "EHIKLMNTVXZ")
def test_height_is_that_of_the_capitals(letter: str) -> None:
    """Straight capitals stand on the base line and are exactly as high as asked."""
    _, low, _, high = lettering(letter, height=7.0).bounds
    assert (low, high) == pytest.approx((0, 7), abs=1e-12)


def test_paths_are_open_lines() -> None:
    """Lettering consists of open paths of straight pieces, none without length."""
    paths = lettering(ASCII, height=2)
    assert not paths.closed.any()
    assert (paths.kind == LINE).all()
    assert not paths.control.any()
    assert (paths.lengths > 0).all()


@given(st.text(st.sampled_from(ASCII.strip()), min_size=1, max_size=8), HEIGHTS)
def test_alignment_is_by_the_ink(text: str, height: float) -> None:
    """The ink begins or has its middle at 0, and is as wide as text_width says."""
    width = text_width(text, height=height)
    ends = {"left": (0, width), "centre": (-width / 2, width / 2)}
    for align, expected in ends.items():
        x0, _, x1, _ = lettering(text, height=height, align=align).bounds  # type: ignore[arg-type]
        assert (x0, x1) == pytest.approx(expected, abs=1e-11 * height)


def test_vertical_middle_is_that_of_the_capitals() -> None:
    """Half of a capital lies above 0, and descenders do not count."""
    _, low, _, high = lettering("Hg", height=4, vertical="middle").bounds
    assert high == pytest.approx(2)
    assert low < -2.5


def test_spaces_have_no_ink() -> None:
    """A text without ink is no path and has no width; spaces inside a text take room."""
    for text in ("", " ", "   "):
        assert len(lettering(text, height=3)) == 0
        assert text_width(text, height=3) == 0
        assert fitting_height(text, 1.0, 3.0) == 3.0
    assert text_width("1 1", height=3) > text_width("11", height=3) + 1
    assert text_width(" 1 ", height=3) == text_width("1", height=3)


@given(st.lists(st.tuples(TEXTS, POINTS, HEIGHTS), max_size=8))
def test_labels_are_letterings_at_their_positions(labels: list[tuple[str, complex, float]]) -> None:
    """Many labels at once are each of them alone, moved to its position: same order, same pieces."""
    texts, points, heights = [t for t, _, _ in labels], [z for _, z, _ in labels], [h for _, _, h in labels]
    placed = place_labels(texts, np.array(points, np.complex128), height=np.array(heights))
    alone = [
        lettering(text, height=height, align="centre", vertical="middle").moved(1.0, point)
        for text, point, height in labels
    ]
    expected = Paths.concatenate(alone)
    assert np.array_equal(placed.offsets, expected.offsets)
    assert np.allclose(placed.start, expected.start, rtol=0, atol=1e-10)
    assert np.allclose(placed.end, expected.end, rtol=0, atol=1e-10)
    polylines(placed)


def test_a_label_has_one_shape_wherever_it_stands_in_the_list() -> None:
    """The same text at the same position has the same bits, first or last of a thousand others."""
    texts = ["1234", *(str(k) for k in range(1000)), "1234"]
    paths = place_labels(texts, np.full(len(texts), 12.3 + 45.6j), height=2.1)
    per = len(lettering("1234", height=1))
    first, last = paths.take(np.arange(per)), paths.take(np.arange(len(paths) - per, len(paths)))
    assert np.array_equal(first.start, last.start)
    assert np.array_equal(first.end, last.end)


def test_ten_thousand_labels() -> None:
    """A sheet's labels are those of their digits, none lost."""
    texts = [str(k) for k in range(10_000)]
    positions = np.arange(10_000, dtype=np.complex128) * (1 + 1j)
    paths = place_labels(texts, positions, height=2)
    strokes = {digit: len(lettering(digit, height=1)) for digit in string.digits}
    assert len(paths) == sum(strokes[digit] for text in texts for digit in text)


@pytest.mark.parametrize("character", ["é", "猫", "\n", "\x7f", "\x00", "\ud800", "°"])
def test_a_character_that_is_missing_is_named(character: str) -> None:
    """The message names the character by its code, and printable() makes the text one that can be set."""
    with pytest.raises(ValueError, match=f"U\\+{ord(character):04X}"):
        lettering(f"ab{character}c", height=1)
    with pytest.raises(ValueError, match=f"U\\+{ord(character):04X}"):
        place_labels(["12", f"3{character}"], np.zeros(2, np.complex128), height=1)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (ASCII, ASCII),
        ("Vögel \u2013 Größe", "Vogel - Grosse"),
        ("Łódź\u2019s \u201c\u00d72\u201d", 'Lodz\'s "x2"'),
        ("猫 1", "? 1"),
        ("a\tb\u00a0c\nd", "a b c d"),
        ("\x00\x7f\u200d", "???"),
        ("e\u0301", "e"),
        ("ﬁ²", "fi2"),
        ("", ""),
    ],
)
def test_printable(text: str, expected: str) -> None:
    """Accents go, likenesses stand for what has one, and the rest is a question mark."""
    assert printable(text) == expected


@given(st.text(st.characters(), max_size=20))
def test_printable_gives_what_can_be_set(text: str) -> None:
    """Any text becomes one that the font has, and one that it has stays."""
    shown = printable(text)
    lettering(shown, height=1)
    assert printable(shown) == shown
    assert all(character in string.printable for character in shown)


@pytest.mark.parametrize("height", [0, -1, float("nan"), float("inf")])
def test_heights_that_are_none(height: float) -> None:
    """Letters have a height."""
    with pytest.raises(ValueError, match="height of letters"):
        lettering("1", height=height)
    with pytest.raises(ValueError, match="height of letters"):
        place_labels(["1", "2"], np.zeros(2, np.complex128), height=np.array([1, height]))
    with pytest.raises(ValueError, match="height of letters"):
        text_width("1", height=height)
    with pytest.raises(ValueError, match="height of letters"):
        fitting_height("1", 2, height)


def test_what_does_not_belong_together() -> None:
    """Texts, positions and heights are as many."""
    with pytest.raises(ValueError, match="2 texts have 1 positions"):
        place_labels(["1", "2"], np.zeros(1, np.complex128), height=1)
    with pytest.raises(ValueError, match="2 texts have 3 heights"):
        place_labels(["1", "2"], np.zeros(2, np.complex128), height=np.ones(3))


def clearance(rings: list[np.ndarray], point: complex) -> float:
    """The distance of a point to the nearest side of the rings: projection on each, in plain Python."""
    best = float("inf")
    for ring in rings:
        for a, b in zip(ring.tolist(), np.roll(ring, -1).tolist(), strict=True):
            t = ((point - a) * (b - a).conjugate()).real / abs(b - a) ** 2
            best = min(best, abs(point - a - min(max(t, 0), 1) * (b - a)))
    return best


def winding(rings: list[np.ndarray], point: complex) -> int:
    """How often the rings run around a point."""
    turns = sum(np.angle((np.roll(ring, -1) - point) / (ring - point)).sum() for ring in rings)
    return round(float(turns) / (2 * np.pi))


SHAPES = {
    "rectangle": [np.array([0, 30, 30 + 10j, 10j])],
    "l": [np.array([0, 20, 20 + 4j, 6 + 4j, 6 + 20j, 20j])],
    "holed": [np.array([0, 30, 30 + 20j, 20j]), np.array([3 + 3j, 3 + 17j, 17 + 17j, 17 + 3j])],
    "thin": [np.array([0, 100, 100 + 0.2j, 50 + 0.05j, 0.2j])],
    "far": [1e6 + 1e6j + np.array([0, 8, 4 + 6j])],
}


@pytest.mark.parametrize("name", SHAPES)
def test_the_label_has_the_most_room(name: str) -> None:
    """The pole lies inside, its distance is true, and no point of a fine grid lies deeper but by the tolerance."""
    rings = SHAPES[name]
    pole, radius = label_position(rings)
    assert winding(rings, pole) == 1
    assert radius == pytest.approx(clearance(rings, pole), rel=1e-9)
    outer = rings[0]
    extent = max(np.ptp(outer.real), np.ptp(outer.imag))
    x = np.linspace(outer.real.min(), outer.real.max(), 62)[1:-1]
    y = np.linspace(outer.imag.min(), outer.imag.max(), 62)[1:-1]
    inside = [z for z in (x[:, None] + 1j * y).ravel().tolist() if winding(rings, z) == 1]
    assert len(inside) > 400
    assert max(clearance(rings, z) for z in inside) <= radius + extent / 1000


def test_the_radius_of_known_shapes() -> None:
    """A square's circle touches all sides; a hole takes its room away."""
    pole, radius = label_position([np.array([0, 10, 10 + 10j, 10j])])
    assert radius == pytest.approx(5, abs=0.01)
    assert pole == pytest.approx(5 + 5j, abs=0.02)
    pole, radius = label_position(SHAPES["holed"])
    assert radius == pytest.approx(6.5, abs=0.4)
    assert pole.real > 17


@pytest.mark.parametrize(
    "rings",
    [
        [],
        [np.array([0, 1 + 1j])],
        [np.array([0, 1, 2 + 0j])],
        [np.array([0, 2 + 2j, 2, 2j])],
        [np.array([0, 4, 4j]), np.array([9, 9 + 1j, 10])],
        [np.array([0, complex("nan"), 4j])],
    ],
)
def test_rings_that_bound_no_tile(rings: list[np.ndarray]) -> None:
    """Too few points, no area, crossings, holes outside, and NaN are refused."""
    with pytest.raises(ValueError, match=r"rings"):
        label_position(rings)


@given(st.text(st.sampled_from(ASCII), min_size=1, max_size=6), st.floats(0.01, 50), st.floats(0.1, 20))
def test_the_fitting_height_stays_in_the_circle(text: str, radius: float, wanted: float) -> None:
    """All ink lies in the circle, and touches it or has the wanted height."""
    height = fitting_height(text, radius, wanted)
    assert 0 < height <= wanted
    ink = [z for line in polylines(place_labels([text], np.zeros(1, np.complex128), height=height)) for z in line]
    reach = max(map(abs, ink), default=0.0)
    assert reach <= radius * (1 + 1e-12) or not ink
    assert height == wanted or reach == pytest.approx(radius)


def test_no_room_no_letters() -> None:
    """A radius of 0 leaves no height, a negative one is refused."""
    assert fitting_height("12", 0.0, 3.0) == 0.0
    with pytest.raises(ValueError, match="radius"):
        fitting_height("12", -1.0, 3.0)

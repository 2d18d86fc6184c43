"""G-code of others: what is understood of it, and what is said of the rest."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest

from voronoi_tiles.formats.gcode import reader
from voronoi_tiles.formats.reading import DrawingError, drawing_of, read_drawing

START = "G21\nG90\nM4 S500\nG0 X10 Y10\n"


def read(text: str) -> list[list[complex]]:
    """The corners of each path that is burnt, in order."""
    paths = [shape.paths for shape in drawing_of(text.encode(), "part.gcode").shapes]
    return [
        [*part.start[a:b].tolist(), part.end[b - 1].item()]
        for part in paths
        for a, b in zip(part.offsets[:-1].tolist(), part.offsets[1:].tolist(), strict=True)
    ]


@pytest.mark.parametrize(
    "text",
    [
        f"{START}G1 X20 F300\nX20 Y20\n",
        f"{START}g1x20f300 (a comment (twice)\nN30 G1 Y 2 0 ; another\nG0 X0 Y0\nM5\n",
        f"\ufeff{START}N9999999 G1 X20 F1000000 S1000000\r\nN10000000 Y20\r\n",
        "%\nG21 G91\nG0 X10 Y10\nM3\nG1 X10 F300 S1.5\nG1 Y10.\nM2\nwhatever\n",
        f"{START}G1 X20 F300\nG1 X20\nG1 Y20\nG1 S0 Y30\n",
        f"{START}G1 X20 F300\nG1 Y20\nM5\nG1 X50\n",
    ],
)
def test_the_same_lines(text: str) -> None:
    """Modal words, relative moves, spaces, comments; what is not burnt is not drawn."""
    assert read(text) == [[10 + 10j, 20 + 10j, 20 + 20j]]


def test_inches() -> None:
    """One is 25.4 mm."""
    (path,) = read("G20\nM4 S5 F9\nG0 X1 Y0\nG1 X2 Y1\n")
    assert path == pytest.approx([25.4, 50.8 + 25.4j])


def test_feeds_and_powers_are_layers() -> None:
    """Where no comment names any."""
    drawing = drawing_of(f"{START}G1 X20 F300\nG1 X30 S800\nG0 X0\nG1 X5\n".encode(), "part.nc")
    assert [(shape.layer, len(shape.paths)) for shape in drawing.shapes] == [("F300 S500", 1), ("F300 S800", 2)]


@pytest.mark.parametrize(
    ("word", "end", "turn"),
    [
        ("G2", "X15 Y15", -0.5),
        ("G2", "X15 Y5", -1.5),
        ("G2", "X10 Y10", -2.0),
        ("G3", "X15 Y5", 0.5),
        ("G3", "X15 Y15", 1.5),
        ("G3", "X10 Y10", 2.0),
    ],
)
def test_arcs_turn_the_right_way(word: str, end: str, turn: float) -> None:
    """Quarters, three quarters, and whole circles, in half turns to the left."""
    (shape,) = drawing_of(f"{START}{word} {end} I5 J0 F300\n".encode(), "part.nc").shapes
    _, radius, _, turns = shape.paths.circles(np.arange(len(shape.paths.start)))
    assert radius == pytest.approx(5.0)
    assert turns.sum() == pytest.approx(turn * np.pi)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("G1 X5 Y", 1, "'G1 X5 Y': Y is no word"),
        ("G1 X1e5", 1, "e5 is"),
        ("hello", 1, "hello is no word"),
        ("G21\nG5 X1", 2, "G5 is not understood"),
        ("G28", 1, "G28 is not understood"),
        ("G90.1", 1, "G90.1 is not understood"),
        ("M6", 1, "M6 is not understood"),
        ("G0 Z5", 1, "Z5 is not understood: a laser's moves are in the plane"),
        ("G0 X5 X6", 1, "X stands twice"),
        ("G0 G1 X5", 1, "G1 is a second move in a line"),
        ("G0 X5\nM3 M5", 2, "M5 is a second state of the laser in a line"),
        ("M4 S100 M4", 1, "M4 is a second state"),
        ("G90 G21 G91", 1, "G91 is a second way to count"),
        ("G20 G21", 1, "G21 is a second unit"),
        ("G54 G55", 1, "G55 is a second origin"),
        ("G0 X1234567", 1, "this goes beyond 999,999 mm"),
        ("G20\nG0 X40000", 2, "this goes beyond 999,999 mm"),
        ("G91\nG0 X600000\nG0 X600000", 3, "this goes beyond 999,999 mm"),
        ("X5", 1, "no line says how"),
        (f"{START}G1 X5", 5, "no line says how fast"),
        ("M4 S5 F5\nG1 X5 Y5", 2, "from a place that no line says"),
        (f"{START}G2 X5 R5 F5", 5, "R5 is not understood: arcs are read by their centres"),
        (f"{START}G2 X5 F5", 5, "an arc without a centre"),
        (f"{START}G2 X20 Y10 I4 F5", 5, "begins 4 mm from its centre, and ends 6 mm from it"),
        (f"{START}G1 X5 F5\nG20", 6, "G20 changes the unit"),
        (f"{START}G55", 5, "G55 changes the origin"),
    ],
)
def test_what_is_not_understood(text: str, line: int, message: str) -> None:
    """The file, the line and the word."""
    with pytest.raises(DrawingError) as caught:
        drawing_of(text.encode(), "part.nc")
    assert str(caught.value).startswith(f"part.nc, line {line}: ")
    assert message in str(caught.value)
    assert caught.value.remedy


def test_files_are_known_by_suffix_and_content(tmp_path: Path) -> None:
    """.gcode, .nc and what begins like it; a file has no elements."""
    file = tmp_path / "part.txt"
    file.write_text(f"; made by hand\n{START}G1 X20 F300\n")
    assert read_drawing(file).format == "gcode"
    file.write_text(START.lower())
    assert read_drawing(file).format == "gcode"
    with pytest.raises(DrawingError, match="has no element 'a'"):
        read_drawing(file, element="a")
    file = tmp_path / "part.NC"
    file.write_text("\n\n")
    assert read_drawing(file).shapes == ()


def test_files_without_end_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """By their size, by their lines, and at once where a line goes on and on."""
    monkeypatch.setattr(reader, "LINES_MAX", 4000)
    for data, message in ((b"\n" * 4001, "more than 4,000 lines"), (b";" * (2**26 + 1), "larger than 64 MiB")):
        with pytest.raises(DrawingError, match=message):
            drawing_of(data, "part.nc")
    for word in (b"X1", b"G1", b"1"):
        with pytest.raises(DrawingError, match="more than 1,000 characters"):
            drawing_of(b"G1" + word * 2**20, "part.nc")
    with pytest.raises(DrawingError, match="X stands twice"):
        drawing_of(b"G1" + b"X1" * 400, "part.nc")


def test_rubbish_ends_in_one_error() -> None:
    """Whatever bytes there are, in files of ours as well."""
    dice = random.Random(15)  # noqa: S311 - random input, not secrets
    good = f"{START}G1 X20 F300\nG2 X30 Y10 I5 J0\nG3 X20 Y0 I-5 J-5\nM5 S0\n".encode()
    for _ in range(300):
        data = bytearray(good)
        for _ in range(dice.randrange(1, 6)):
            data[dice.randrange(len(data))] = dice.choice(b"GMXYIJFSR.-0123456789 ;(\n\x00\xff")
        try:
            drawing = drawing_of(bytes(data), "part.gcode")
        except DrawingError as error:
            assert "\n" not in str(error)  # noqa: PT017 - any of both may happen
        else:
            assert all(np.isfinite(shape.paths.start).all() for shape in drawing.shapes)

"""Reading anybody's DXF: what the file states and nothing else, mended where that can be done, and said."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from helpers.dxf_text import LINE, Tags, file_of, read, written
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.formats.reading import DrawingError, ReadDrawing, read_drawing
from voronoi_tiles.preflight import judge

ARC: Tags = [(0, "ARC"), (8, "0"), (10, 1.0), (20, 2.0), (40, 1.0), (50, 10.0), (51, 80.0)]
POLYLINE: Tags = [
    *[(0, "POLYLINE"), (8, "0"), (66, 1), (70, 1)],
    *[tag for x, y in ((0.0, 0.0), (3.0, 0.0), (3.0, 2.0)) for tag in ((0, "VERTEX"), (8, "0"), (10, x), (20, y))],
    (0, "SEQEND"),
]
LWPOLYLINE: Tags = [
    *[(0, "LWPOLYLINE"), (100, "AcDbEntity"), (8, "0"), (62, 1), (100, "AcDbPolyline"), (90, 3), (70, 1)],
    *[(10, 0.0), (20, 0.0), (42, 0.5), (10, 3.0), (20, 0.0), (10, 3.0), (20, 2.0)],
]
SPLINE: Tags = [
    *[(0, "SPLINE"), (100, "AcDbEntity"), (8, "0"), (100, "AcDbSpline"), (70, 8), (71, 2), (72, 6), (73, 3)],
    *[(40, 0.0)] * 3,
    *[(40, 1.0)] * 3,
    *[(10, 0.0), (20, 0.0), (10, 1.0), (20, 2.0), (10, 2.0), (20, 0.0)],
]
ENTITIES = (LINE, ARC, POLYLINE, LWPOLYLINE, SPLINE)


def same(one: ReadDrawing, other: ReadDrawing) -> bool:
    """Whether two drawings have the same shapes, to the bit."""
    return len(one.shapes) == len(other.shapes) and all(
        (a.layer, a.stroke) == (b.layer, b.stroke)
        and np.array_equal(a.paths.start, b.paths.start)
        and np.array_equal(a.paths.control, b.paths.control)
        and np.array_equal(a.paths.closed, b.paths.closed)
        for a, b in zip(one.shapes, other.shapes, strict=True)
    )


# --- units ------------------------------------------------------------------------------------------------------

METRES = [
    *("0.0254", "0.3048", "1609.344", "0.001", "0.01", "1", "1000", "0.0000000254", "0.0000254", "0.9144"),
    *("1e-10", "1e-9", "1e-6", "0.1", "10", "100", "1e9", "149597870700", "9460730472580800", "30856775814913672.8"),
    *("1200/3937", "100/3937", "3600/3937", "6336000/3937"),
]
"""By $INSUNITS, from 1 on: BIPM's and NIST's definitions, in metres."""


@settings(max_examples=60, deadline=None)
@given(st.integers(1, len(METRES)), st.floats(0.1, 9.0), st.sampled_from([None, 0, 1]), st.sampled_from([None, 2, 4]))
def test_a_declared_unit_is_exact_whatever_else_the_header_says(
    code: int, size: float, measurement: int | None, lunits: int | None
) -> None:
    """Every unit that exists; where its millimetres are beyond all measure, the size is refused and not the unit."""
    header: Tags = [(9, "$INSUNITS"), (70, code)]
    header += [] if measurement is None else [(9, "$MEASUREMENT"), (70, measurement)]
    header += [] if lunits is None else [(9, "$LUNITS"), (70, lunits)]
    wanted = float(1000 * Fraction(METRES[code - 1]) * Fraction(size))
    line = [*LINE[:4], (11, size), (21, 0.0)]
    if wanted > COORDINATE_MAX:
        with pytest.raises(DrawingError, match="a coordinate is beyond"):
            read(file_of(line, header=header))
        return
    drawing = read(file_of(line, header=header))
    assert drawing.unit_known
    assert drawing.unit
    assert not drawing.unit_guess
    assert drawing.shapes[0].paths.end[0].real == pytest.approx(wanted, rel=1e-15 if code != 20 else 1e-9)


@pytest.mark.parametrize(
    ("header", "inches", "said"),
    [
        (None, False, "the file declares no unit; millimetres were taken"),
        ([], False, "the file declares no unit; millimetres were taken"),
        ([("$INSUNITS", 0)], False, "the file declares no unit; millimetres were taken"),
        ([("$MEASUREMENT", 1)], False, "the file declares no unit; millimetres were taken"),
        ([("$MEASUREMENT", 0)], True, "inches were taken, as $MEASUREMENT says English units"),
        ([("$INSUNITS", 0), ("$MEASUREMENT", 0)], False, "millimetres were taken, though $MEASUREMENT says English"),
        ([("$LUNITS", 4)], True, "inches were taken, as $LUNITS shows feet and inches"),
        ([("$INSUNITS", 0), ("$LUNITS", 3), ("$MEASUREMENT", 1)], True, "as $LUNITS shows feet and inches"),
        ([("$INSUNITS", 77)], False, "$INSUNITS 77 is no unit; millimetres were taken"),
        ([("$INSUNITS", "x")], False, "the file declares no unit; millimetres were taken"),
    ],
)
def test_a_unit_that_is_not_declared_is_guessed_and_said(
    header: list[tuple[str, Any]] | None, inches: bool, said: str
) -> None:
    """A library's default is no statement of the file: without a header ezdxf says metres."""
    tags = None if header is None else [tag for name, value in header for tag in ((9, name), (70, value))]
    if header and header[0][1] == "x":
        with pytest.raises(DrawingError, match="broken DXF"):
            read(file_of(LINE, header=tags))
        return
    drawing = read(file_of(LINE, header=tags))
    assert (drawing.unit, drawing.unit_known) == ("", False)
    assert said in drawing.unit_guess
    assert drawing.shapes[0].paths.bounds == pytest.approx((0, 0, 3, 2) if not inches else (0, 0, 76.2, 50.8))
    (finding,) = [finding for finding in judge(drawing, "t.dxf").findings if finding.kind == "unit"]
    assert finding.message == drawing.unit_guess


# --- mended files -----------------------------------------------------------------------------------------------


def without_markers(text: str) -> str:
    """The text without the markers of subclasses."""
    lines = text.splitlines()
    pairs = zip(lines[::2], lines[1::2], strict=True)
    return "".join(f"{code}\n{value}\n" for code, value in pairs if code.strip() != "100")


DAMAGE: dict[str, tuple[Callable[[str], str | bytes], str]] = {
    "byte order mark": (lambda text: b"\xef\xbb\xbf" + text.encode(), "byte order mark"),
    "utf-16": (lambda text: text.encode("utf-16"), "UTF-16"),
    "blank lines": (lambda text: "\n  \n" + text, "empty lines"),
    "no EOF": (lambda text: text.removesuffix("  0\nEOF\n"), "no EOF"),
    "no ENDSEC": (lambda text: text.replace("  0\nENDSEC\n", ""), "no ENDSEC"),
    "cut off": (lambda text: text.removesuffix("  0\nENDSEC\n  0\nEOF\n"), "no EOF"),
    "no markers": (without_markers, "no subclass markers"),
    "no SEQEND": (lambda text: text.replace("  0\nSEQEND\n", ""), "no SEQEND"),
    "no section": (lambda text: text.replace("  0\nSECTION\n  2\nENTITIES\n", ""), "outside of all sections"),
    "handle": (lambda text: text.replace("LINE\n  8\n", "LINE\n  5\nnone\n  8\n", 1), "ezdxf's recovery"),
    "order": (
        lambda text: text.replace("  20\n", " 20\n").replace(" 20\n0.0\n 11\n3.0\n", " 11\n3.0\n 20\n0.0\n"),
        "recovery",
    ),
    "two sections": (
        lambda text: text.replace("  0\nARC", "  0\nENDSEC\n  0\nSECTION\n  2\nENTITIES\n  0\nARC"),
        "a second section",
    ),
}
"""What programs leave out or do otherwise: how, and the words of the remark."""

HARMLESS: dict[str, Callable[[str], str | bytes]] = {
    "Windows": lambda text: text.replace("\n", "\r\n"),
    "Mac": lambda text: text.replace("\n", "\r"),
    "twice": lambda text: text.replace("\n", "\r\r\n"),
    "comments": lambda text: text.replace("  0\nARC", "999\na comment\n  0\nARC"),
    "lower case": lambda text: text.replace("\nLINE\n", "\nline\n"),
    "behind the end": lambda text: text + "\x1a",
    "wide codes": lambda text: text.replace("\n 10\n", "\n      10\n"),
}
"""What is not said, because nothing is lost by it."""


@pytest.mark.parametrize("header", [None, [(9, "$ACADVER"), (1, "AC1015"), (9, "$INSUNITS"), (70, 4)]])
@pytest.mark.parametrize("name", [*DAMAGE, *HARMLESS])
def test_a_damaged_file_reads_as_the_sound_one(name: str, header: Tags | None) -> None:
    """The same shapes to the bit, with a remark that preflight shows; the sound file has none."""
    text = file_of(*ENTITIES, header=header)
    sound = read(text)
    assert len(sound.shapes) == len(ENTITIES)
    assert sound.remarks == ()
    damage, words = DAMAGE.get(name, (HARMLESS.get(name), ""))
    assert damage is not None
    damaged = damage(text)
    assert damaged not in (text, text.encode())
    drawing = read(damaged)
    assert same(drawing, sound)
    assert any(words in remark for remark in drawing.remarks) == bool(words)
    shown = [finding.message for finding in judge(drawing, "t.dxf").findings if finding.kind == "reading"]
    assert shown == list(drawing.remarks)


@settings(max_examples=20, deadline=None)
@given(st.data())
def test_damages_together(data: Any) -> None:
    """What can be mended tag by tag, in any file of the entities, with what is harmless."""
    entities = data.draw(st.lists(st.sampled_from(ENTITIES), min_size=1, max_size=6))
    text = file_of(*entities)
    sound = read(text)
    damage, _ = DAMAGE[data.draw(st.sampled_from(["no EOF", "no ENDSEC", "cut off", "no markers", "no SEQEND"]))]
    harmless = HARMLESS[data.draw(st.sampled_from(list(HARMLESS)))]
    damaged: Any = damage(text)
    assert same(read(harmless(damaged)), sound)


def test_a_file_that_is_cut_off_anywhere_says_so() -> None:
    """Cut after any line: refused, or read with a remark that some may be missing."""
    lines = file_of(LINE, POLYLINE, LWPOLYLINE, header=[(9, "$INSUNITS"), (70, 4)]).splitlines(keepends=True)
    for count in range(1, len(lines) - 1):
        try:
            drawing = read("".join(lines[:count]))
        except DrawingError as error:
            assert error.remedy  # noqa: PT017 - what is not raised is judged below
        else:
            assert any("no EOF" in remark for remark in drawing.remarks)


@pytest.mark.parametrize("version", ["R12", "R2000", "R2010"])
def test_binary_files_are_read_as_text_is(version: str, tmp_path: Path) -> None:
    """The same shapes, and as bounded."""
    document = ezdxf.new(version, units=1)
    document.modelspace().add_line((0, 0), (1, 2))
    document.modelspace().add_circle((1, 2), 3)
    document.saveas(tmp_path / "text.dxf")
    document.saveas(tmp_path / "binary.dxf", fmt="bin")
    assert (tmp_path / "binary.dxf").read_bytes().startswith(b"AutoCAD Binary DXF")
    text, binary = (read_drawing(tmp_path / f"{name}.dxf") for name in ("text", "binary"))
    assert same(text, binary)
    assert binary.unit_known == text.unit_known
    data = (tmp_path / "binary.dxf").read_bytes()
    for size in range(25, len(data), 997):
        try:
            assert any("no EOF" in remark for remark in read(data[:size]).remarks)
        except DrawingError as error:
            assert str(error).startswith("t.dxf")  # noqa: PT017 - what is not raised is judged above


def test_many_entities_of_a_binary_file_are_refused(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """As those of a text are, before they are parsed."""
    document = ezdxf.new("R2000")
    document.saveas(tmp_path / "t.dxf", fmt="bin")
    monkeypatch.setattr("voronoi_tiles.formats.dxf.loading.ELEMENTS_MAX", 10)
    with pytest.raises(DrawingError, match="more than 10 entities"):
        read_drawing(tmp_path / "t.dxf")


@pytest.mark.parametrize("entity", ENTITIES[:2] + ENTITIES[3:], ids=lambda tags: str(tags[0][1]))
def test_what_an_entity_needs_and_has_not_is_never_made_up(entity: Tags) -> None:
    """Without any one of its tags: the same shape, or none of it and a count by its name; the rest is read."""
    whole = read(file_of(entity, LINE))
    for place in range(1, len(entity)):
        code = entity[place][0]
        if code in {8, 62, 70, 72, 73, 90, 100}:
            continue
        drawing = read(file_of([*entity[:place], *entity[place + 1 :]], LINE))
        if code == 42:  # a bulge may be missing: the side is straight
            continue
        assert same(drawing, read(file_of(LINE))), code
        assert [name.split()[0] for name in drawing.ignored] == [entity[0][1]]
    assert not whole.ignored


def test_what_is_not_drawn_is_counted_however_broken_it_is() -> None:
    """By name, also what ezdxf cannot take apart; what lies on hidden layers is hidden."""
    names = ["HATCH", "3DFACE", "SOLID", "TRACE", "POINT", "LEADER", "DIMENSION", "MLINE", "HELIX", "REGION", "IMAGE"]
    names += ["MTEXT", "TEXT", "WIPEOUT", "RAY", "XLINE", "ACAD_TABLE", "VIEWPORT", "SUN", "NOBODY_KNOWS"]
    drawing = read(file_of(LINE, *([(0, name), (8, "0"), (10, 1.0)] for name in names)))
    assert drawing.ignored == dict.fromkeys(sorted(names), 1)
    assert len(drawing.shapes) == 1
    document = ezdxf.new("R2000")
    document.layers.add("OFF").off()
    block = document.blocks.new("B")
    for space, layer in ((document.modelspace(), "OFF"), (block, "OFF"), (block, "0")):
        space.add_hatch(dxfattribs={"layer": layer}).paths.add_polyline_path([(0, 0), (1, 0), (1, 1)])
    document.modelspace().add_blockref("B", (0, 0))
    assert read(written(document)).ignored == {"HATCH": 1, "hidden": 2}


def test_names_of_layers_are_read_in_the_files_encoding() -> None:
    """Of a code page, of Unicode by its mark, and of R2007, which is Unicode."""
    line: Tags = [LINE[0], (8, "Gravur \u00e4\u20ac"), *LINE[2:]]
    for data in (
        file_of(line).encode("cp1252"),
        b"\xef\xbb\xbf" + file_of(line).encode(),
        file_of(line).encode("utf-16"),
        file_of(line, header=[(9, "$ACADVER"), (1, "AC1021")]).encode(),
    ):
        assert read(data).shapes[0].layer == "Gravur \u00e4\u20ac"


def test_a_drawing_on_a_page_for_plotting_alone_is_named() -> None:
    """Nothing is drawn, and it is said where all is; with something in model space nothing is said."""
    paper = [*LINE[:2], (67, 1), *LINE[2:]]
    (remark,) = read(file_of(paper)).remarks
    assert remark == "all lies in paper space, which is not read: 1 object"
    assert read(file_of(paper, LINE)).remarks == ()

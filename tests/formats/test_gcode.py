"""G-code: what GRBL makes of it, what other readers make of it, and that it comes back as it was drawn."""

from __future__ import annotations

import io
import json
import re
import warnings
from dataclasses import replace
from typing import Any, Literal

import numpy as np
import pytest
from gcodeparser import parse_gcode_lines
from helpers import cad
from helpers.grbl import Grbl, GrblError
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles import Design, Job
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.formats.burns import Burn, rates_of
from voronoi_tiles.formats.gcode.writer import RADIUS_MAX_MM, ROUNDING_MM, write_gcode
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.formats.reading import drawing_of
from voronoi_tiles.formats.recipe import recipe_of
from voronoi_tiles.paths.paths import ARC, LINE, QUAD, Paths

ACCURACY = 0.005
BURNS = {"engrave": Burn(3000, 150, 1000), "score": Burn(1500.5, 300, 1000), "cut": Burn(300, 800, 1000)}


def burnt(drawing: Drawing) -> Drawing:
    """The drawing with feeds and powers."""
    return replace(drawing, layers=tuple(replace(layer, burn=BURNS[layer.work]) for layer in drawing.layers))


def written(drawing: Drawing) -> bytes:
    """Write a drawing."""
    file = io.BytesIO()
    write_gcode(drawing, file)
    return file.getvalue()


def of_paths(paths: Paths) -> Drawing:
    """A drawing of cuts."""
    return burnt(Drawing(100.0, 100.0, (Layer.of_paths("cut", "cut", "#000000", 0.1, paths),)))


def arc(start: complex, middle: complex, end: complex) -> Paths:
    """One arc, by three points."""
    return Paths(
        np.array([start]), np.array([end]), np.array([[middle, 0j]]), np.full(1, ARC, np.uint8), np.array([0, 1]),
        np.zeros(1, np.bool_),
    )  # fmt: skip


# --- what is drawn ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", [LINE, ARC])
def test_grbl_burns_what_is_drawn(kind: int) -> None:
    """Every path in its order with its feed and power, within the rounding; nothing else burns, and G0 has no power."""
    drawing = burnt(cad.drawing(kind))
    grbl = Grbl().run(written(drawing))
    at = 0
    for layer in drawing.layers:
        for points in cad.sampled(layer.paths, 512):
            beam = grbl.beams[at]
            assert (beam.feed, beam.power) == (BURNS[layer.work].feed, BURNS[layer.work].power)
            # The simulator's chords are 2e-4 mm off, ours a little; single precision adds less.
            assert cad.deviation([np.array(beam.points)], [points]) < ROUNDING_MM + 5e-4
            assert abs(beam.points[0] - points[0]) < 1e-4
            assert abs(beam.points[-1] - points[-1]) < 1e-4
            at += 1
    assert at == len(grbl.beams)
    assert {power for _, _, power in grbl.travel} == {0.0}
    assert not grbl.on
    assert (grbl.moves[2] + grbl.moves[3] > 0) == (kind == ARC)


@pytest.mark.parametrize("kind", [LINE, ARC])
def test_our_reader_gives_it_back(kind: int) -> None:
    """Layers, paths, kinds and closed flags in their order, and the curves."""
    drawing = burnt(cad.drawing(kind))
    read = drawing_of(written(drawing), "part.nc")
    assert (read.format, read.unit, read.unit_known) == ("gcode", "mm", True)
    assert [shape.layer for shape in read.shapes] == [layer.name for layer in drawing.layers]
    for shape, layer in zip(read.shapes, drawing.layers, strict=True):
        assert shape.paths.kind.tolist() == layer.paths.kind.tolist()
        assert shape.paths.offsets.tolist() == layer.paths.offsets.tolist()
        ends = layer.paths.start[layer.paths.offsets[:-1]] == layer.paths.end[layer.paths.offsets[1:] - 1]
        assert shape.paths.closed.tolist() == ends.tolist()
        assert cad.deviation(cad.sampled(shape.paths), cad.sampled(layer.paths)) < ROUNDING_MM


POINT = st.builds(complex, st.floats(-400, 400), st.floats(-400, 400))


@settings(max_examples=30, deadline=None)
@given(POINT, st.floats(1e-5, 400), st.floats(0, 6.3), st.floats(-6.2, 6.2), st.floats(-1, 1))
def test_any_arc_arrives(start: complex, radius: float, begin: float, turn: float, flat: float) -> None:
    """From grains to nearly whole circles: no refusal, no full turn, no half one, and within the rounding."""
    turn = turn if abs(turn) > 1e-9 else 1e-3
    radius *= 1 + 1e3 * max(flat, 0.0) * (abs(turn) < 1e-2)
    centre = start - radius * np.exp(1j * begin)
    middle, end = (centre + radius * np.exp(1j * (begin + turn * share)) for share in (0.5, 1))
    if start in {middle, end}:
        return
    paths = arc(start, middle, end)
    grbl = Grbl().run(written(of_paths(paths)))
    assert all(abs(angle) < np.deg2rad(175) for angle in grbl.turns)
    if not grbl.beams:
        assert abs(end - start) < 3e-4
        return
    (beam,) = grbl.beams
    wanted = cad.sampled(paths, 1000)
    chord = radius * (turn / 1000) ** 2 / 8
    size = np.abs(wanted[0]).max() + min(radius, RADIUS_MAX_MM)
    limit = ROUNDING_MM + 2e-4 + chord + 4 * np.finfo(np.float32).eps * size
    assert cad.deviation([np.array(beam.points)], wanted) < limit


@pytest.mark.parametrize("angle", [90, 169.9, 170.1, 180, 270, 359.9])
def test_arcs_are_less_than_half_circles(angle: float) -> None:
    """As few as their angle takes."""
    start, middle, end = (50 + 50j + 20 * np.exp(1j * np.deg2rad(angle * share)) for share in (0, 0.5, 1))
    grbl = Grbl().run(written(of_paths(arc(start, middle, end))))
    assert np.rad2deg(sum(grbl.turns)) == pytest.approx(angle, abs=1e-3)
    assert len(grbl.turns) == np.ceil(angle / 170)
    assert grbl.moves == {0: 1, 1: 0, 2: 0, 3: len(grbl.turns)}


def test_a_large_circle_is_straight() -> None:
    """Chords of it, as many as it takes."""
    start, middle, end = (1e6j + 1e6 * np.exp(1j * (a - np.pi / 2)) for a in (0, 5e-5, 1e-4))
    data = written(of_paths(arc(start, middle, end)))
    grbl = Grbl().run(data)
    assert not grbl.turns
    assert 1 < grbl.moves[1] < 5
    # A grain of an arc is no full circle.
    assert Grbl().run(written(of_paths(arc(0j, 5e-6 + 5e-6j, 1e-5 + 0j)))).moves == {0: 0, 1: 0, 2: 0, 3: 0}


def test_no_grain_of_an_arc_is_a_full_circle() -> None:
    """Rounded to the grid, ends of short arcs may change places: GRBL and others would run round the whole circle."""
    dice = np.random.default_rng(7)
    radius = 10 ** dice.uniform(-2, 2.9, 1000)
    turn = np.sign(dice.normal(size=1000)) * np.minimum(10 ** dice.uniform(-5, -3, 1000) / radius, 3.0)
    begin = np.exp(2j * np.pi * dice.random(1000))
    start, middle, end = (50 + 50j + radius * begin * (np.exp(1j * turn * share) - 1) for share in (0, 0.5, 1))
    grains = [arc(*places) for places in zip(start.tolist(), middle.tolist(), end.tolist(), strict=True)]
    grbl = Grbl().run(written(of_paths(Paths.concatenate(grains))))
    assert len(grbl.beams) > 100
    assert max(abs(np.diff(beam.points)).sum() for beam in grbl.beams) < 2e-3


def test_what_is_below_the_grid_is_left_out() -> None:
    """No move goes nowhere, and what remains hangs together."""
    wave = np.cumsum(np.random.default_rng(3).normal(0, 4e-5, (400, 2)) @ [1, 1j], dtype=np.complex128) + 5 + 5j
    grbl = Grbl().run(written(of_paths(Paths.polylines([wave, [1 + 1j, 1.00001 + 1j]]))))
    (beam,) = grbl.beams
    assert 10 < len(beam.points) < 400
    assert all(a != b for a, b in zip(beam.points, beam.points[1:], strict=False))
    assert cad.deviation([np.array(beam.points)], [wave]) < 1e-4


# --- the text ---------------------------------------------------------------------------------------------------

NUMBER = r"-?(?:[1-9]\d*|0)(?:\.\d{0,3}[1-9])?"
LINES = re.compile(
    rf"; [ -~]*|G21|G90|G17|G94|M4 S0|M5 S0|G0 X{NUMBER} Y{NUMBER} S0"
    rf"|G(?:1|[23](?= .*I)) X{NUMBER} Y{NUMBER}(?: I{NUMBER} J{NUMBER})?(?: F{NUMBER} S{NUMBER})?"
)


def test_every_line_is_plain() -> None:
    """A G word on every line, X and Y on every move, four decimals, no exponent, no bare point."""
    lines = written(burnt(cad.drawing(ARC))).decode("ascii").splitlines()
    assert [line for line in lines if not LINES.fullmatch(line)] == []
    assert lines[-1] == "M5 S0"
    burning = [line for line in lines if line[0] != ";"]
    assert burning[:6] == ["G21", "G90", "G17", "G94", "M4 S0", "G0 X85 Y60 S0"]


@settings(max_examples=20, deadline=None)
@given(st.text(), st.text(min_size=1))
def test_no_text_commands_the_machine(title: str, name: str) -> None:
    """Whatever stands in names and designs, comments are passed over; the recipe comes back."""
    layer = Layer.of_paths(name, "cut", "#000000", 0.1, cad.ring(LINE))
    recipe = {"design": json.dumps({"name": title}), "job": "{}"}
    data = written(burnt(Drawing(9, 9, (layer,), title, recipe)))
    assert len(Grbl().run(data).beams) == 1
    assert recipe_of(data) == {"title": title, **recipe}


def test_what_cannot_be_written() -> None:
    """No feed, fills, and curves."""
    drawing = of_paths(cad.ring(LINE))
    for layer, message in (
        (replace(drawing.layers[0], burn=None), "needs feed and power"),
        (replace(drawing.layers[0], filled=True), "is filled"),
        (replace(drawing.layers[0], paths=cad.ring(QUAD)), "has other curves"),
    ):
        file = io.BytesIO()
        with pytest.raises(ValueError, match=message):
            write_gcode(replace(drawing, layers=(drawing.layers[0], layer)), file)
        assert not file.getvalue()


def test_the_simulator_sees_wrong_files() -> None:
    """Arcs whose radii differ, missing feeds, unknown words, commands in comments."""
    for text in ("G1 X5 Y5\n", "G2 X1 Y0 I5 J5 F3\n", "G5 X1\n", "G1 X Y5 F5\n", "G1 X5 X6 F5\n"):
        with pytest.raises(GrblError):
            Grbl().run(text.encode())
    for text in ("; wait!\n", f"; {'x' * 80}\n", "X5 Y5\n"):
        with pytest.raises(AssertionError):
            Grbl().run(text.encode())


# --- whole sheets, and others' readers --------------------------------------------------------------------------

# An example of every group.
EXAMPLES = {
    re.match("[a-z0-9]+", path.stem)[0]: path.stem  # type: ignore[index]
    for path in sorted(cad.EXAMPLES.glob("p*-*.toml")) + sorted(cad.EXAMPLES.glob("c*-*.toml"))
}

QUICK = ("p2", "p31m", "pm")


def pygcode_reads(text: str) -> list[Complexes]:
    """What pygcode's machine burns: its arcs as its own chords of them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of its own making
        from pygcode import GCodeArcMove, GCodeLinearMove, GCodeRapidMove, Line, Machine
        from pygcode.transform import ArcLinearizeMid, linearize_arc

    machine = Machine()
    paths: list[list[complex]] = []
    for line in text.splitlines():
        for code in Line(line).block.gcodes:
            before = machine.pos
            here = complex(before.X, before.Y)
            points = []
            if isinstance(code, GCodeArcMove):
                parts = linearize_arc(code, before, method_class=ArcLinearizeMid, max_error=1e-3, decimal_places=6)
                points = [complex(part.X, part.Y) for part in parts]
            elif isinstance(code, GCodeLinearMove):
                points = [complex(code.X, code.Y)]
            elif isinstance(code, GCodeRapidMove):
                paths.append([])
            if points:
                paths[-1] += points if paths[-1] else [here, *points]
            machine.process_gcodes(code)
    return [np.array(path) for path in paths]


def gcodeparser_reads(text: str) -> list[list[tuple[float, ...]]]:
    """The words of gcodeparser's moves, a list for each path."""
    paths: list[list[tuple[float, ...]]] = []
    for line in parse_gcode_lines(text):
        letter, number = line.command
        assert letter in "GM"
        if letter == "G" and number == 0:
            paths.append([])
        if letter == "G" and number is not None and number < 4:
            paths[-1].append(tuple(float(line.params[word]) for word in "XY"))
    return paths


def path_ends(paths: Paths) -> list[tuple[complex, complex]]:
    """Where each path begins and ends."""
    return list(zip(paths.start[paths.offsets[:-1]].tolist(), paths.end[paths.offsets[1:] - 1].tolist(), strict=True))


@pytest.mark.parametrize(
    "group",
    [group if group in QUICK else pytest.param(group, marks=pytest.mark.slow) for group in sorted(EXAMPLES)],
)
def test_the_examples_arrive_in_all_readers(group: str) -> None:
    """The contours are those of the exact drawing within the accuracy, in the order of the cut plan."""
    assert len(EXAMPLES) == 17
    curves: Literal["arc", "polyline"] = "arc" if sorted(EXAMPLES).index(group) % 2 else "polyline"
    tiling = Design.load(cad.EXAMPLES / f"{EXAMPLES[group]}.toml").tessellate()
    job = Job(sheet=(44, 36), fit="clip", curves=curves, feed=300, power=800)
    product = tiling.make(job, "gcode")
    file = io.BytesIO()
    product.write(file)
    text = file.getvalue().decode("ascii")
    plan = [one for layer in product.drawing.layers for one in path_ends(layer.paths)]
    layers = tiling.make(replace(job, curves=None), "svg").drawing.layers
    exact = [curve for layer in layers for curve in cad.sampled(layer.paths, 200)]

    beams = [np.array(beam.points) for beam in Grbl().run(file.getvalue()).beams]
    ours = [shape.paths for shape in drawing_of(file.getvalue(), "sheet.gcode").shapes]
    theirs = pygcode_reads(text)
    for found, slack in (
        (beams, 2e-4),
        ([curve for paths in ours for curve in cad.sampled(paths)], 1e-5),
        (theirs, 1e-3),
    ):
        assert len(found) == len(plan)
        for curve, (first, last) in zip(found, plan, strict=True):
            assert abs(curve[0] - first) < 1e-4
            assert abs(curve[-1] - last) < 1e-4
        assert cad.deviation(found, exact) < ACCURACY + slack + 5e-5
    words = gcodeparser_reads(text)
    assert [[complex(*place) for place in path] for path in words] == [
        [complex(*map(float, place)) for place in re.findall(r"X(\S+) Y(\S+)", path)]
        for path in text.split("G0 ")[1:]
    ]  # fmt: skip
    assert [complex(*path[0]) for path in words] == pytest.approx([first for first, _ in plan], abs=1e-4)
    assert curves == "arc" or "G2" not in text.replace("G21", "")


@pytest.mark.parametrize("rate", [300, 300.0, "300", " 3e2 ", np.float32(300), np.int64(300), {"cut": np.float64(300)}])
def test_rates_are_numbers_of_any_kind(rate: Any) -> None:
    """Python's, numpy's, texts, and those of each work."""
    (read,) = rates_of(Job(feed=rate).feed).items() - {("inner", 300.0)}
    assert read == ("cut", 300.0)


@pytest.mark.parametrize(
    "rate", [True, -(10**400), {}, {"cut": None}, [300], b"300", np.nan, "1e7", "cut=1,cut=2", "fold=3"]
)
def test_other_rates_are_refused(rate: Any) -> None:
    """With what to give."""
    with pytest.raises(JobError, match=r"`power` .* cannot be.* Give a number for cuts, 300"):
        Job(power=rate)


def test_nothing_is_written_without_feed_and_power() -> None:
    """Without feed or power, or one for each work, one message says what to give."""
    tiling = Design.load(cad.EXAMPLES / "p4-hook.toml").tessellate()
    with pytest.raises(ValueError, match=r"needs `feed` and `power` of cut\. Give `feed='cut=300'` in mm/min and"):
        tiling.make(Job(), "gcode")
    with pytest.raises(ValueError, match=r"needs `feed` and `power` of engrave\. Give `feed='engrave=3000'`"):
        tiling.make(Job(feed=300, power={"cut": 800}, labels="number"), "gcode")
    with pytest.raises(ValueError, match="`power` of 1001 for cut is more than the machine's 1000"):
        tiling.make(Job(feed=300, power=1001), "gcode")
    for curves in ("exact", "cubic", "spline"):
        with pytest.raises(JobError, match=f"no `curves='{curves}'`"):
            tiling.make(Job(feed=300, power=800, curves=curves), "gcode")
    with pytest.raises(JobError, match=r"Give 0\.0006 mm or more"):
        tiling.make(Job(feed=300, power=800, accuracy=5e-4), "gcode")

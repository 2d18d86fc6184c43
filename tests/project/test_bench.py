"""The benches: they run at their smallest size, and their checks can fail."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import NamedTuple

import mpmath
import numpy as np
import pytest

# At the end: tests/ has a module `sheets` too.
sys.path.append(str(Path(__file__).parents[2] / "bench"))

import accuracy
import against
import boost
import cgal
import chromium
import drawings
import engine
import exact
import gpu
import peer
import report
import targets
from compiled import MissingError

from voronoi_tiles import Design
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.formats.reading import read_drawing
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.raster.gl import GlError
from voronoi_tiles.vector.outline import Outline

SEGMENTS = 5


class Problem(NamedTuple):
    """A design with its true plane."""

    drawing: accuracy.Drawing
    outline: Outline
    plane: exact.Plane
    number: dict[Operation, int]


@pytest.fixture(scope="module")
def problem() -> Problem:
    """A curve of a few segments in p4."""
    drawing, record = accuracy.draw(GROUPS["p4"], "curve", SEGMENTS, np.random.default_rng(7))
    copies = accuracy.surroundings(drawing, record)
    plane = exact.exact_images(drawing.site, drawing.lattice, drawing.group, copies)
    return Problem(drawing, record.outline, plane, {copy: k for k, copy in enumerate(copies)})


def run_boost(plane: exact.Plane, outline: Outline) -> tuple[exact.Plane, peer.Reading]:
    """Run Boost.Polygon on the copies that share an edge with the tile."""
    return accuracy._run_boost(plane, plane.nodes[: len(outline.neighbours) + 1])


def row_of(score: accuracy.Score) -> accuracy.Row:
    """A row of the engine alone."""
    return accuracy.Row("p4", "curve", SEGMENTS, 1, (score, None, None))


# --- 50 digits -----------------------------------------------------------------------------------------------


def two_segments() -> exact.Plane:
    """A segment from 0 to 1, and its copy from 2i to 1 + 2.5i, which is none: the arithmetic does not care."""
    site = NodedSite("s", np.array([0, 1], dtype=complex), np.array([[0, 1]]))
    return exact.as_given(site, np.array([[0, 1], [2j, 1 + 2.5j]]), 1.0)


def test_vertex_in_closed_form() -> None:
    """Above the end of a segment the vertex with a line has a closed form."""
    # On x = 1 the line y = 2 + x/2 is (2.5 - y) 2 / sqrt 5 away, the segment y.
    vertex = exact.true_vertices(two_segments(), frozenset({1, 2, 5}), 1 + 1.18j)[0]
    share = 2 / mpmath.sqrt(5)
    assert abs(vertex.point - mpmath.mpc(1, mpmath.mpf("2.5") * share / (1 + share))) < mpmath.mpf(10) ** -45
    assert vertex.label == {1, 2, 5}


def test_no_vertex_where_another_element_is_nearer() -> None:
    """The two points 0 and 1 and the upper line have such a point, but the segment between them is nearer to it."""
    plane = two_segments()
    z = exact.solve(plane, frozenset({0, 1, 5}), 0.5 + 1j)
    assert z is not None
    assert z.real == 0.5
    assert exact.true_vertices(plane, frozenset({0, 1, 5}), complex(z)) == []


def test_images_have_fifty_digits(problem: Problem) -> None:
    """Six times a sixth of a turn is nothing: to 1e-48 in the exact plane, which doubles cannot give."""
    group = GROUPS["p6"]
    site = problem.drawing.site
    lattice = group.lattice(60.0)
    sixth = next(o for o in group.operations if lattice.isometry(o).a == complex(0.5, np.sqrt(3) / 2))
    plane = exact.exact_images(site, lattice, group, [group.operations[0], sixth])
    first, turned = plane.node(0, 0), plane.node(1, 0)
    assert abs((turned / first) ** 6 - 1) < mpmath.mpf(10) ** -48
    assert abs((mpmath.mpc(complex(plane.nodes[1, 0])) / first) ** 6 - 1) > mpmath.mpf(10) ** -20


# --- accuracy ------------------------------------------------------------------------------------------------


def test_engine_is_measured(problem: Problem) -> None:
    """Every vertex of a good outline is found, and is as near as doubles go."""
    _, outline, plane, number = problem
    score, true = accuracy.score_engine(plane, outline, number)
    assert len(true) == len(outline) == len(score.errors)
    assert max(score.errors) < 1e-14
    assert max(score.edges) < 1e-14
    assert not accuracy.failures([row_of(score)])


def test_moved_vertex_is_seen(problem: Problem) -> None:
    """A vertex that is a millionth off is measured as such, and the verdict is that the limit is broken."""
    _, outline, plane, number = problem
    start, end = outline.start.copy(), outline.end.copy()
    start[3] += 6e-5
    end[2] = start[3]
    score, _ = accuracy.score_engine(plane, replace(outline, start=start, end=end), number)
    assert max(score.errors) == pytest.approx(1e-6, rel=1e-6)
    assert max(score.edges) > 1e-8
    assert accuracy.failures([row_of(score)])


def test_boost_is_measured(problem: Problem) -> None:
    """Boost.Polygon has every vertex; its rounded input is what it is off by."""
    _, outline, plane, number = problem
    _, true = accuracy.score_engine(plane, outline, number)
    given, reading = run_boost(plane, outline)
    score, more = accuracy.score_peer(plane, given, true, reading)
    assert (score.missing, score.merged, score.extra, score.untrue, more) == (0, 0, 0, 0, [])
    assert max(score.own) < 1e-14 < max(score.errors) < 1e-5


def test_vertices_that_one_side_lacks_are_counted(problem: Problem) -> None:
    """What the peer lacks is missing; what the true list lacks is found through the peer."""
    _, outline, plane, number = problem
    _, true = accuracy.score_engine(plane, outline, number)
    given, reading = run_boost(plane, outline)
    score, more = accuracy.score_peer(plane, given, true[1:], reading)
    assert score.extra == 1
    assert [vertex.label for vertex in more] == [true[0].label]
    less = peer.Reading(reading.cells[: len(reading.cells) // 2], reading.owner)
    assert accuracy.score_peer(plane, given, true, less)[0].missing > 0


# --- speed ---------------------------------------------------------------------------------------------------


def test_comparison_runs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """The smallest curves, with Boost.Polygon; the tables have a row for each."""
    monkeypatch.setattr(engine, "has_cgal", lambda: False)
    timings = engine.compare("p4", (1, 3), 3, 3)
    engine.print_ratios(timings)
    engine.print_times(timings)
    rows = [line for line in capsys.readouterr().out.splitlines() if "| p4 |" in line]
    assert len(rows) == 4
    assert all(len(timing.engine) == len(timing.blocks[0].boost) == 3 for timing in timings)
    assert [len(timing.blocks) for timing in timings] == [2, 2]


def test_wrong_area_stops_the_comparison(monkeypatch: pytest.MonkeyPatch) -> None:
    """A peer with another tile is not timed."""
    area = peer.tile_area
    monkeypatch.setattr(peer, "tile_area", lambda *given: 1.00001 * area(*given))
    with pytest.raises(AssertionError, match="area is off"):
        engine.compare("p4", (1,), 1, 3)


@pytest.mark.slow
def test_cgal_gives_the_same_tile(monkeypatch: pytest.MonkeyPatch) -> None:
    """CGAL's area is the engine's, where it is installed; VORONOI_TILES_REQUIRE_CGAL=1 makes its absence an error."""
    try:
        cgal.version()
    except MissingError as error:
        if os.environ.get("VORONOI_TILES_REQUIRE_CGAL") == "1":
            raise
        pytest.skip(str(error))
    monkeypatch.setattr(cgal, "FLAGS", ("-std=c++17", "-O0", "-frounding-math"))  # compiles in a third of the time
    case = engine.case_of("p6", 3)
    record = case.solve()
    nodes = peer.block_nodes(case.site, case.lattice, peer.neighbours(record))
    _, reading = cgal.run_cgal(case.site, nodes)
    segments = peer.block_segments(case.site, nodes)
    assert peer.tile_area(reading, segments) == pytest.approx(record.outline.area, rel=1e-12)
    given = exact.as_given(case.site, nodes, 60.0)
    found = accuracy.outline_vertices(given, reading)
    gaps = np.abs(record.outline.start[:, None] - np.array([z for z, _ in found])).min(axis=1)
    assert gaps.max() < 1e-12


def test_missing_cgal_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a compiler the reason is given, in the tables too."""
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr(cgal, "version", cgal.version.__wrapped__)
    assert "g++ is missing" in cgal.described()
    assert not engine.has_cgal()


# --- beside an older commit ------------------------------------------------------------------------------------


class Fake(against.Checkout):
    """A checkout that is not installed: it writes a document for each design, with its own text in one of them."""

    def python(self, *arguments: str) -> bytes:
        """The names of two groups."""
        assert arguments[0] == "-c"
        return b"p1 p4\n"

    def command(self, *arguments: str) -> float:
        """A starter, or the outline documents."""
        target = Path(arguments[-1])
        if arguments[0] == "new":
            target.write_text(f"group = {arguments[1]}")
        else:
            for design in map(Path, arguments[1 : arguments.index("--format")]):
                text = self.environment.name if design.stem == "fish" else "same"
                (target / f"{design.stem}.json").write_text(text)
        return 0.5


def test_documents_that_differ_are_named(tmp_path: Path) -> None:
    """Of the examples, the paper's and the starters, the one that differs; none where all are the same."""
    for name in ("examples/fish.toml", "examples/hook.toml", "examples/paper/line.toml"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    old, new = Fake(tmp_path, Path("old")), Fake(tmp_path, Path("new"))
    (tmp_path / "files").mkdir()
    assert against.differing(old, new, tmp_path / "files") == (5, ["fish.json"])
    (tmp_path / "again").mkdir()
    (tmp_path / "examples/fish.toml").unlink()
    assert against.differing(old, new, tmp_path / "again") == (4, [])


def test_the_older_commit_is_timed_in_turns() -> None:
    """Each gets its rounds, first one and then the other first, and the medians are told apart."""
    order = []

    class Timed(Fake):
        def cost(self, task: against.Task) -> float:
            assert task.name == "a"
            order.append(self.environment.name)
            return float(len(order)) if self.environment.name == "old" else 0.25

    old, new = Timed(Path(), Path("old")), Timed(Path(), Path("new"))
    assert against.timed(against.Task("a", ()), old, new, 3) == (3.0, 0.25)
    assert order == ["new", "old", "old", "new", "new", "old"]


# --- what was asked ----------------------------------------------------------------------------------------------


@pytest.fixture
def compiled_boost(monkeypatch: pytest.MonkeyPatch) -> None:
    """Boost.Polygon, compiled in a hurry, or the reason why a test is left out; an error as in CGAL's test."""
    try:
        boost.version()
    except MissingError as error:
        if os.environ.get("VORONOI_TILES_REQUIRE_CGAL") == "1":
            raise
        pytest.skip(str(error))
    monkeypatch.setattr(boost, "FLAGS", ("-std=c++17", "-O0"))


@pytest.mark.slow
@pytest.mark.usefixtures("compiled_boost")
def test_boost_itself_gives_what_it_gives_through_pyvoronoi() -> None:
    """The same cells with the same edges, as often timed as asked; a tile of another area is seen."""
    case = engine.case_of("p4", 3)
    segments = peer.block_segments(case.site, peer.block_nodes(case.site, case.lattice, peer.neighbours(case.solve())))
    seconds, reading = boost.run_boost(segments, 3, runs=4)
    _, other = peer.run_peer(segments, 3)
    assert len(seconds) == 4
    assert reading.owner == [(number, min(category, 3)) for number, category in other.owner]
    assert [(cell, len(edges)) for cell, edges in reading.cells] == [(cell, len(edges)) for cell, edges in other.cells]
    area = peer.tile_area(reading, segments)
    assert area == pytest.approx(case.solve().outline.area, rel=targets.AGREEMENT)
    assert peer.tile_area(boost.run_boost(segments[:5], 3)[1], segments[:5]) != pytest.approx(area, rel=1e-3)
    with pytest.raises(ValueError, match="32 bits"):
        boost.run_boost(segments, 3, scale=1e12)


def test_missing_boost_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a compiler the reason is given."""
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr(boost, "version", boost.version.__wrapped__)
    assert "g++ is missing" in boost.described()


def test_qhull_gives_the_same_tiles() -> None:
    """Another area of one of them stops the comparison."""
    design = Design.from_dict(targets.points(5))
    areas = [tile.outline.area for tile in design.tessellate()]
    assert targets.run_qhull(design, areas).median > 0
    with pytest.raises(AssertionError):
        targets.run_qhull(design, [*areas[:4], 1.00001 * areas[4]])


@pytest.mark.slow
def test_a_checkout_is_timed_in_a_process(tmp_path: Path) -> None:
    """The tile of a case, the raster's lists, and a whole command; with variables that are there for it alone."""
    here = against.Checkout(tmp_path, Path(sys.prefix))
    for what in ("tile", "lists"):
        problem = targets.Problem("a", what, targets.curve(1))
        figure = targets.run_checkout(problem, here, tmp_path, {})
        assert 0 < figure.median < 5
        assert figure.megabytes > 20
    script = "import os; assert os.environ['TIMED'] == 'so'"
    command = targets.Problem("b", "command", {}, ("python", "-c", script))
    assert targets.run_checkout(command, here, tmp_path, {"TIMED": "so"}).median > 0
    assert "TIMED" not in os.environ


def test_what_is_slow_runs_once() -> None:
    """The others run in every round, first one and then the other first."""
    order = []

    def runner(name: str, seconds: float) -> targets.Figure:
        order.append(name)
        return targets.Figure([seconds], len(order))

    found = targets.in_turns({"a": lambda: runner("a", 1.0), "b": lambda: runner("b", 9.0)}, 3)
    assert order == ["b", "a", "a", "a"]
    assert found == {"a": targets.Figure([1.0, 1.0, 1.0], 4), "b": targets.Figure([9.0], 1)}


def test_targets_are_judged(capsys: pytest.CaptureFixture[str]) -> None:
    """Each is of cases and columns that there are; it is met on one side of its figure alone, and said so."""
    names = {problem.name: {targets.NEW, targets.NUMPY, targets.OLD, *problem.peers} for problem in targets.problems()}
    for target in targets.targets():
        assert target.over[1] in names[target.over[0]]
        assert target.under[1] in names[target.under[0]]
        least, most = target.least, target.most
        assert target.met(least or most)
        assert not target.met(0.99 * least if least else 1.01 * most)
    row = {targets.NEW: targets.Figure([1.0, 2.0, 9.0], 50.0), targets.OLD: targets.Figure([12.0], 49.0)}
    targets.print_tables({"1 segment": row, "20,000 segments": row})
    printed = capsys.readouterr().out
    assert "| yes | 6 | >= 5 | 1 segment, time | old / this |" in printed
    assert "| **no** | 1.02 | <= 1 | 20,000 segments, memory | this / old |" in printed
    assert "| 1 segment | 2000 (1e+03 to 9e+03); 50 | 1.2e+04; 49 |" in printed


# --- a GPU -------------------------------------------------------------------------------------------------------

GPU = report.REPORT.with_name("gpu.sh")


def test_software_is_no_gpu(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """It is refused by its name, unless it is allowed, and so is a machine without OpenGL."""

    class Software:
        name, is_software = "llvmpipe, OpenGL 4.5", True

    class Absent:
        def __init__(self) -> None:
            raise GlError("libEGL.so not loaded")

    monkeypatch.setattr(gpu, "Device", Software)
    assert gpu.find_device(allow_software=True).name == Software.name
    for kind, said in ((Software, "no GPU: llvmpipe"), (Absent, "no OpenGL: libEGL")):
        monkeypatch.setattr(gpu, "Device", kind)
        with pytest.raises(SystemExit) as caught:
            gpu.find_device(allow_software=False)
        assert caught.value.code == gpu.NO_GPU
        assert capsys.readouterr().err.startswith(said)


@pytest.mark.skipif(os.name != "posix", reason="it is a script of the shell")
def test_the_list_of_wheels_has_all_that_the_tests_need(tmp_path: Path) -> None:
    """And without a folder of them there is a message, and no more."""
    listed = subprocess.run([GPU, "--list"], capture_output=True, text=True, check=True).stdout
    project = tomllib.loads((GPU.parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for name in ("pip", *project["dependencies"], *project["optional-dependencies"]["test"]):
        assert f"'{name}'" in listed
    for arguments in ([], [tmp_path], ["--unknown"]):
        done = subprocess.run([GPU, *arguments], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)


# --- the report ----------------------------------------------------------------------------------------------


def test_tables_go_between_their_marks(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Only what stands between the marks changes, and what is printed is printed too."""
    target = tmp_path / "README.md"
    target.write_text("a\n<!-- x -->\nold\n<!-- end of x -->\nb\n<!-- y -->\n")
    monkeypatch.setattr(report, "REPORT", target)
    with report.published("x", write=True):
        print("new")  # noqa: T201 - what is printed is what is tested
    assert target.read_text() == "a\n<!-- x -->\n\nnew\n\n<!-- end of x -->\nb\n<!-- y -->\n"
    assert capsys.readouterr().out == "new\n"
    with pytest.raises(ValueError, match="no marks"):
        report.publish("y", "text")


@pytest.mark.parametrize(("code", "goes_on"), [(0, True), (targets.MISSED, True), (1, False), (2, False), (137, False)])
def test_make_goes_on_where_targets_are_missed(code: int, tmp_path: Path, *, goes_on: bool) -> None:
    """All benches run where something that was asked is not reached; a crash, or a killed script, ends `make bench`."""
    python = tmp_path / "bin" / "python"
    python.parent.mkdir()
    python.write_text(f'#!/bin/sh\necho "$1" >> {tmp_path}/ran\ntest "$1" != bench/targets.py || exit {code}\n')
    python.chmod(0o755)
    make = ["/usr/bin/env", "make", "bench", f"VENV={tmp_path}", "INSTALLED_DEV="]
    done = subprocess.run(make, cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False)
    assert (done.returncode == 0) == goes_on, done.stderr
    ran = (tmp_path / "ran").read_text().split()
    assert ran[0] == "bench/targets.py"
    assert (len(ran) > 5) == goes_on


@pytest.mark.parametrize("reached", [True, False])
def test_targets_tell_what_is_missed_from_a_crash(monkeypatch: pytest.MonkeyPatch, *, reached: bool) -> None:
    """By the code that the script exits with: a crash is Python's 1."""
    monkeypatch.setattr(sys, "argv", ["targets.py"])
    monkeypatch.setattr(targets, "compare", lambda *_: reached)
    with pytest.raises(SystemExit) as exit_:
        targets.main()
    assert exit_.value.code == (0 if reached else targets.MISSED)
    assert targets.MISSED not in (0, 1, 2)


def test_report_has_all_marks() -> None:
    """Every script has its place in the report."""
    text = report.REPORT.read_text(encoding="utf-8")
    names = "targets", "engine", "accuracy", "raster", "sheets", "against", "preflight", "chromium"
    for name in (*names, "escherization", "given back", "sweeps"):
        assert text.count(f"<!-- {name} -->") == text.count(f"<!-- end of {name} -->") == 1


def test_the_comparison_with_chromium_sees_what_differs() -> None:
    """Curves that lie elsewhere or go on, and other colours; a dot between two of Chromium's points is none."""
    line = np.linspace(0.0, 10.0, 2000) + 0j
    points = np.column_stack((np.linspace(0.0, 10.0, 250), np.zeros(250)))
    assert chromium.apart([line, np.array([3.0, 3.01]) + 1j], points) < 1e-12
    assert chromium.apart([line + 0.02j], points) > chromium.NEAR
    assert chromium.apart([line, line + 1j], points) == float("inf")
    assert chromium.alike("#ff0000", [254, 0, 1])
    assert chromium.alike(None, None)
    assert not chromium.alike("#ff0000", [253, 0, 0])
    assert not chromium.alike(None, [0, 0, 0])


def test_drawings_made_at_random_are_read(tmp_path: Path) -> None:
    """None is refused, and most draw something."""
    generator = Random(3)  # noqa: S311 - random drawings, not secrets
    shapes = 0
    for _ in range(20):
        file = tmp_path / "made.svg"
        file.write_text(drawings.any_drawing(generator), encoding="utf-8")
        shapes += len(read_drawing(file).shapes)
    assert shapes > 60


def test_without_chromium_the_comparison_says_so(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It names what is missing, and fails where that is required."""
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    monkeypatch.setattr(sys, "argv", ["chromium.py"])
    for required, code in (("0", False), ("1", True)):
        monkeypatch.setenv("VORONOI_TILES_REQUIRE_CHROMIUM", required)
        with pytest.raises(SystemExit) as caught:
            chromium.main()
        assert caught.value.code == code
        assert capsys.readouterr().err.startswith("chromium, npm")

"""Preflight: planted defects are found at their places, clean drawings give nothing."""

from __future__ import annotations

import json
import math
import random
import tracemalloc
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
import shapely
from click.testing import CliRunner
from helpers.dxf_text import read, written
from helpers.examples import each_example, tiling

from voronoi_tiles import Design, Job
from voronoi_tiles.base.errors import ArgumentError, DesignError
from voronoi_tiles.cli.preflight import preflight as command
from voronoi_tiles.formats.recipe import job_of, tab_width
from voronoi_tiles.formats.svg.reader import svg_drawing
from voronoi_tiles.paths.paths import ARC, CUBIC, QUAD, Paths
from voronoi_tiles.preflight import Finding, Limits, PreflightReport, chord_search, judge, preflight, report_text
from voronoi_tiles.preflight.annotated import marked_svg
from voronoi_tiles.preflight.chords import CHORDS_MAX, chords_of, counts_of

NS = 'xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
PAGE = 'width="200mm" height="100mm" viewBox="0 0 200 100"'

SERIOUS = {"error", "warning"}


def judged(body: str, page: str = PAGE, limits: Limits | None = None, layers: tuple[str, ...] = ()) -> PreflightReport:
    """Judge a drawing with this body."""
    text = f'<svg {NS} {page} fill="none" stroke="#ff0000">{body}</svg>'
    return judge(svg_drawing(text.encode(), "t.svg"), "t.svg", limits=limits or Limits(), layers=layers)


def serious(report: PreflightReport) -> list[Finding]:
    """The errors and warnings."""
    return [finding for finding in report.findings if finding.severity in SERIOUS]


# What is planted, and what is to be found: kind, place as Inkscape shows it, size.
PLANTED: dict[str, tuple[str, list[tuple[str, Any, Any]]]] = {
    "nearly closed": ("<path d='M10 10H30V30H10V10.2'/>", [("gap", (10, 10.1), 0.2)]),
    "open": ("<path d='M40 10H60V30H40V20'/>", [("open", (40, 10), 10)]),
    "slit": ("<path d='M10 60H30'/>", [("loose end", (10, 60), None), ("loose end", (30, 60), None)]),
    "short of a line": (
        "<path d='M10 10H50V50H10Z'/><path d='M10 30H49.7'/>",
        [("gap", (49.85, 30), 0.3)],
    ),
    "edge twice": ("<path d='M70 10H90V30H70Z'/><path d='M90 15V40H100V15Z'/>", [("duplicate", (90, 22.5), 15)]),
    "arc twice, reversed and in part": (
        "<path d='M40 60A20 20 0 0 1 80 60ZM74.14213562 45.85786438A20 20 0 0 0 45.85786438 45.85786438Z'/>",
        [("duplicate", (60, 40), 10 * math.pi)],
    ),
    "curve twice": (
        "<path d='M10 10Q30 40 50 10Z'/><path d='M10 10C23.33333333 30 36.66666667 30 50 10V5H10Z'/>",
        [("duplicate", (30, 25), None)],
    ),
    "spike": ("<path d='M10 10h10v10h5h-5v5h-10z'/>", [("duplicate", (22.5, 20), 5)]),
    "whole contour twice": (
        "<circle cx='30' cy='30' r='9'/><circle cx='30' cy='30' r='9.003'/>",
        [("duplicate", None, 18 * math.pi)],
    ),
    "two circles": (
        "<circle cx='120' cy='20' r='8'/><circle cx='130' cy='20' r='8'/>",
        [("crossing", (125, 20 - math.sqrt(39)), None), ("crossing", (125, 20 + math.sqrt(39)), None)],
    ),
    "bow tie": ("<path d='M150 10L170 30V10L150 30Z'/>", [("crossing", (160, 20), None)]),
    "crossing at a node of one": (
        "<path d='M10 10H30V30H10Z'/><path d='M40 10L30 20L20 40H40Z'/>",
        [("crossing", (30, 20), None), ("crossing", (25, 30), None)],
    ),
    "open lines": (
        "<path d='M10 10L30 30'/><path d='M10 30L30 10'/>",
        [("crossing", (20, 20), None)] + [("loose end", (x, y), None) for x in (10, 30) for y in (10, 30)],
    ),
    "touching": (
        "<path d='M10 10H30V30H10Z'/><path d='M30 20L40 15V25Z'/>",
        [("touch", (30, 20), None)],
    ),
    "neck": (
        "<path d='M10 50H30V60H20.6V62H30V72H10V62H20V60H10Z'/>",
        [("neck", None, 0.6)],
    ),
    "neck of curves": (
        "<path d='M10 10H50V40H10ZM28 20a5 5 0 1 1 -10 0 5 5 0 1 1 10 0M38.7 20a5 5 0 1 1-10 0 5 5 0 1 1 10 0'/>",
        [("neck", (28.35, 20), 0.7)],
    ),
    "feature": ("<circle cx='50' cy='60' r='.3'/>", [("feature", (50, 60), 0.6)]),
    "short": (
        "<path d='M100 60h20v20h-.005h-.005h-.005v-.005v-.005h-20z'/>",
        [("short", (120 - x, 80 - y), 0.005) for x, y in ((0, 0), (0.005, 0), (0.01, 0), (0.015, 0), (0.015, 0.005))],
    ),
    "outside": ("<path d='M190 10h20v10z'/>", [("outside", None, 10)]),
    "text": ("<path d='M1 1h5v5z'/><text>a</text>", [("unsupported", None, 1)]),
    "clones": ("<path id='a' d='M1 1h5v5z'/><use href='#a' x='20'/>", [("clones", None, 1)]),
    "nothing": ("", [("empty", None, None)]),
}


def test_a_single_clone_is_no_plural() -> None:
    """One is counted as one, two as two."""
    once = "<path id='a' d='M1 1h5v5z'/><use href='#a' x='20'/>"
    twice = f"{once}<use href='#a' x='40'/>"
    for body, words in ((once, "1 clone: it is judged"), (twice, "2 clones: they are judged")):
        assert [finding.message for finding in judged(body).findings if finding.message.startswith(words)]


@pytest.mark.parametrize("name", PLANTED)
def test_planted_defects_are_found_at_their_place(name: str) -> None:
    """Nothing is missed, misplaced or invented."""
    body, expected = PLANTED[name]
    found = serious(judged(body))
    assert sorted(finding.kind for finding in found) == sorted(kind for kind, _, _ in expected)
    for kind, place, value in expected:
        near = [
            finding
            for finding in found
            if finding.kind == kind
            and (place is None or (finding.place is not None and math.dist(finding.place, place) < 0.05))
            and (value is None or (finding.value is not None and finding.value == pytest.approx(value, abs=0.02)))
        ]
        assert near, (kind, place, value, found)


@pytest.mark.parametrize(
    "body",
    [
        "<path d='M10 10H50V40H10Z'/><circle cx='30' cy='25' r='9'/>",
        "<path d='M10 10C30 0 40 50 60 20S90 50 99 10V60H10Z'/>",
        "<rect x='10' y='10' width='50' height='30' rx='4'/><ellipse cx='100' cy='40' rx='20' ry='9'/>",
        # Every edge once: lines that end on others, in a node or inside of them.
        "<path d='M10 10H50V50H10V10'/><path d='M10 30H50'/><path d='M30 10V30'/><path d='M30 30V50'/>",
        # Two trails that share a node, and one that passes it twice.
        "<path d='M10 10L30 30L50 10'/><path d='M10 50L30 30L50 50'/><path d='M10 10V50'/><path d='M50 10V50'/>",
        # A closed contour whose end lies on its beginning, without Z.
        "<path d='M10 10H50V40H10V10'/>",
    ],
)
def test_clean_drawings_give_nothing(body: str) -> None:
    """No finding at all, whichever way round and wherever the paths begin."""
    report = judged(body)
    assert serious(report) == []
    assert report.passed


def test_lines_that_are_short_altogether_are_warnings() -> None:
    """A curve taken apart into lines of their own, as CAD programs do: the machine stutters all the same."""
    body = "".join(f"<path d='M{100 + k * 0.008:.3f} 50h.008'/>" for k in range(30))
    assert [one.severity for one in judged(body).findings if one.kind == "short"] == ["warning"] * 30


@pytest.mark.parametrize("data", ["h-.005h-20z", "h-.005h-.005h-.005h-20z", "h-20v-.005v-.004z"])
def test_few_short_segments_are_remarks(data: str) -> None:
    """A machine does not stutter at one; they are named all the same, and what helps in files of our own."""
    report = judged(f"<path d='M100 60h20v20{data}'/>")
    short = [finding for finding in report.findings if finding.kind == "short"]
    assert serious(report) == []
    assert len(short) == data.count(".00")
    assert "`curves='arc'` and a larger `accuracy`" in short[0].remedy
    # Round the beginning of a closed path as well.
    around = judged("<path d='M100 60h.0078125h.0078125v20h-20v-20h19.96875h.0078125h.0078125z'/>")
    assert [finding.kind for finding in serious(around)] == ["short"] * 4


def blob(generator: np.random.Generator, centre: complex, radius: float) -> str:
    """A smooth closed contour of cubics about a centre: a star-shaped curve."""
    count = int(generator.integers(5, 12))
    angles = np.arange(count) * 2 * np.pi / count + generator.uniform(0, 6)
    points = centre + radius * generator.uniform(0.8, 1.0, count) * np.exp(1j * angles)
    tangents = (np.roll(points, -1) - np.roll(points, 1)) / 6
    data = f"M{points[0].real} {points[0].imag}"
    for k in range(count):
        q, dq = points[(k + 1) % count], tangents[(k + 1) % count]
        p = points[k] + tangents[k]
        data += f"C{p.real} {p.imag} {(q - dq).real} {(q - dq).imag} {q.real} {q.imag}"
    return f"<path d='{data}Z'/>"


@pytest.mark.parametrize("seed", range(8))
def test_random_blobs(seed: int) -> None:
    """Blobs apart give nothing; one drawn twice, one moved onto its neighbour and one opened are found there."""
    generator = np.random.default_rng(seed)
    centres = [complex(12 + 20 * i, 12 + 20 * j) for i in range(9) for j in range(4)]
    blobs = [blob(generator, centre, 7.0) for centre in centres]
    assert serious(judged("".join(blobs))) == []
    twice, moved = generator.choice(len(blobs), 2, replace=False)
    found = serious(judged("".join([*blobs, blobs[twice]])))
    assert [finding.kind for finding in found] == ["duplicate"]
    assert abs(complex(*found[0].place or (0, 0)) - centres[twice]) < 8
    across = [*blobs, f"<g transform='translate(3 2)'>{blobs[moved]}</g>"]
    found = serious(judged("".join(across), limits=Limits(neck=0)))
    crossings = [finding for finding in found if finding.kind == "crossing"]
    assert crossings
    assert len(crossings) % 2 == 0, "closed curves cross an even number of times"
    assert all(abs(complex(*finding.place or (0, 0)) - centres[moved]) < 12 for finding in crossings)


def test_findings_do_not_depend_on_the_position() -> None:
    """A drawing that is turned and moved has the same defects, elsewhere."""
    body = "".join(PLANTED[name][0] for name in ("bow tie", "edge twice", "neck", "two circles"))
    kinds = sorted(finding.kind for finding in judged(body).findings)
    for turn in (17, 90, 200):
        moved = judged(f"<g transform='translate(400 400) rotate({turn})'>{body}</g>", PAGE.replace("200", "900"))
        assert sorted(f.kind for f in moved.findings if f.kind != "outside") == kinds


@each_example
def test_our_own_files_pass(name: str, tmp_path: Path) -> None:
    """Every example's tiles are closed contours with nothing to say against them but that they are fine."""
    path = tmp_path / "tile.svg"
    tiles = tiling(name)
    tiles.export(path)
    report = preflight(path)
    if len(tiles.tiles) > 1:  # tiles of several sites are drawn where they are, side by side
        names = [tile.site.name for tile in tiles.tiles]
        shared = sorted(
            other["length"]
            for number, tile in enumerate(tiles.figures()["tiles"])
            for other in tile["neighbours"]
            if other["operation"] == "x,y" and other["site"] in names[number + 1 :]
        )
        twice = sorted(finding.value or 0.0 for finding in report.findings if finding.kind == "duplicate")
        assert twice == pytest.approx(shared, rel=1e-3)
        assert report.passed == (not shared)
        return
    assert report.passed
    assert {finding.kind for finding in report.findings} <= {"neck", "narrow waste", "corner", "short"}
    assert [use.layer for use in report.layers] == ["cut"]


def test_tiles_without_gap_are_cut_twice() -> None:
    """Neighbours that share an edge have it twice, as long as it is; drawn once there is nothing."""
    squares = "".join(f"<path d='M{10 + 20 * i} {10 + 20 * j}h20v20h-20z'/>" for i in range(3) for j in range(2))
    found = judged(squares).findings
    assert {finding.kind for finding in found} == {"duplicate"}
    assert len(found) == 7
    assert all(finding.value == pytest.approx(20) for finding in found)
    once = "".join(f"<path d='M{10 + 20 * i} 10V50'/>" for i in range(4))
    once += "".join(f"<path d='M{10 + 20 * i} {10 + 20 * j}h20'/>" for i in range(3) for j in range(3))
    assert judged(once).passed


def test_layers() -> None:
    """What is named as engraved is not cut; --layer and colours choose."""
    body = (
        "<g inkscape:groupmode='layer' inkscape:label='Engrave'>"
        "<path stroke='#0000ff' d='M150 10L170 30V10L150 30Z'/></g>"
        "<g inkscape:groupmode='layer' inkscape:label='outer'><path d='M10 10h5v5z'/></g>"
    )
    report = judged(body)
    assert report.passed
    assert [(use.layer, use.colour, use.cut) for use in report.layers] == [
        ("Engrave", "#0000ff", False), ("outer", "#ff0000", True),
    ]  # fmt: skip
    assert not judged(body, layers=("Engrave",)).passed
    assert not judged(body, layers=("#0000ff",)).passed
    with pytest.raises(DesignError, match="no layer or colour 'inner'"):
        judged(body, layers=("inner",))


def test_units_and_extents() -> None:
    """A page without a unit is a warning, and so are pixels; DXF has its y up."""
    for unit, kinds in (("", ["unit"]), ("px", ["unit"]), ("mm", [])):
        size = f'width="200{unit}" height="100{unit}"'
        assert [f.kind for f in judged("<path d='M1 1h50v50z'/>", size).findings] == kinds
    document = ezdxf.new("R2000", units=0)
    document.modelspace().add_lwpolyline([(0, 10), (20, 30), (20, 10), (0, 30)], close=True)
    report = judge(read(written(document)), "t.dxf")
    assert {finding.kind: finding.place for finding in report.findings} == {"unit": None, "crossing": (10, 20)}
    assert report.extents == (0, 10, 20, 30)


def test_document_and_text() -> None:
    """The document holds what JSON can hold, the text names every kind and place."""
    report = judged("".join(body for body, _ in PLANTED.values()))
    document = json.loads(report.json())
    assert document["passed"] is False
    assert len(document["findings"]) == len(report.findings)
    text = report_text(report)
    for finding in report.findings:
        assert finding.kind in text
    text = report_text(judged(PLANTED["bow tie"][0]))
    assert "(160.000, 20.000) a line crosses itself" in text


def test_many_places_are_counted() -> None:
    """At most twenty places of a kind in the text, with the number of all."""
    ties = "".join(f"<path d='M{5 * k} 10l3 3v-3l-3 3z'/>" for k in range(30))
    text = report_text(judged(ties))
    assert "crossing: 30 found" in text
    assert text.count("a line crosses itself") == 20
    assert "and 10 more" in text


def test_the_marked_picture_shows_every_place() -> None:
    """A ring at each finding's place, and a drawing that is where it was."""
    report = judged("".join(body for body, _ in PLANTED.values()) + "<path d='M3 80A9 9 0 0 1 21 80Q12 99 3 80'/>")
    root = ET.fromstring(marked_svg(report))
    circles = root.iter("{http://www.w3.org/2000/svg}circle")
    rings = np.array([complex(float(ring.get("cx", "")), float(ring.get("cy", ""))) for ring in circles])
    places = np.array([complex(*finding.place) for finding in report.findings if finding.place is not None])
    assert len(rings) == len(places)
    off = np.abs(rings[:, None] - places)
    assert max(off.min(axis=0).max(), off.min(axis=1).max()) < 1e-3
    again = svg_drawing(marked_svg(report).encode(), "marked.svg")
    grey = [shape for shape in again.shapes if shape.stroke == "#808080"]
    scale = [shape.paths.bounds[2] - shape.paths.bounds[0] for shape in grey]
    expected = [s.paths.bounds[2] - s.paths.bounds[0] for s in report.drawing.shapes]
    assert scale == pytest.approx(expected, abs=1e-3)


def test_a_thousand_tiles() -> None:
    """14,000 pieces, and nothing to say of them."""
    generator = np.random.default_rng(3)
    body = "".join(blob(generator, complex(12 + 20 * i, 12 + 20 * j), 7.0) for i in range(40) for j in range(40))
    report = judged(body, 'width="900mm" height="900mm" viewBox="0 0 900 900"')
    assert report.pieces > 10_000
    assert serious(report) == []


def test_random_garbage_never_fails() -> None:
    """Random lines, degenerate and overlapping, on a grid: a report, whatever it says."""
    generator = random.Random(4)  # noqa: S311 - random input, not secrets
    for _ in range(60):
        body = ""
        for _ in range(generator.randint(1, 8)):
            points = " ".join(f"{generator.randint(0, 3)} {generator.randint(0, 3)}" for _ in range(6))
            body += f"<path d='M{points}{generator.choice(('', 'Z', 'Q1 1 2 2', 'A2 2 0 0 1 3 3Z'))}'/>"
        report = judged(body)
        json.loads(report.json())
        marked_svg(report)


def test_command_line(tmp_path: Path) -> None:
    """Exit codes 0, 1 and 2; JSON; the picture."""
    good, bad, broken = (tmp_path / name for name in ("good.svg", "bad.svg", "broken.svg"))
    good.write_text(f"<svg {NS} {PAGE} stroke='red'><path d='M1 1h9v9z'/></svg>")
    bad.write_text(f"<svg {NS} {PAGE} stroke='red'>{PLANTED['bow tie'][0]}</svg>")
    broken.write_text(f"<svg {NS} {PAGE}><path d='M1 1")
    run = CliRunner().invoke
    assert run(command, [str(good)]).exit_code == 0
    result = run(command, [str(bad), "--json", "-o", str(tmp_path / "marked.svg")])
    assert result.exit_code == 1
    assert json.loads(result.stdout)["findings"][0]["kind"] == "crossing"
    assert (tmp_path / "marked.svg").read_text().startswith("<?xml")
    result = run(command, [str(broken), "-o", str(tmp_path / "none.svg")])
    assert result.exit_code == 2
    assert not (tmp_path / "none.svg").exists()
    for options in (
        ["--neck", "1 furlong"],
        ["--feature", "-1mm"],
        ["--tolerance", "0"],
        ["--layer", "x"],
        ["-o", "x.png"],
    ):
        assert run(command, [str(good), *options]).exit_code == 2
    assert run(command, [str(good), "-o", str(good)]).exit_code == 2


def test_tabs_are_no_gaps(tmp_path: Path) -> None:
    """Bridges of the width that is named, or that a file of our own names, are remarks; others are still gaps."""
    sides = "<path d='M10.2 10H30'/><path d='M30 10.4V30'/><path d='M30 30H10V10.4'/>"
    gaps = judged(sides)
    assert not gaps.passed
    assert any("`tabs=0.4`" in finding.remedy for finding in gaps.findings)
    tabbed = judged(sides, limits=Limits(tabs=0.4))
    kinds = {finding.kind: finding.severity for finding in tabbed.findings}
    assert kinds["tab"] == "info"
    assert [finding.value for finding in tabbed.findings if finding.kind == "tab"] == [pytest.approx(0.4)]
    assert not tabbed.passed  # the other gap is not as wide
    design = Path(__file__).parents[2] / "examples" / "p4-key.toml"
    for form in ("svg", "dxf"):
        target = tmp_path / f"sheet.{form}"
        job = Job(sheet=(300.0, 200.0), margin=5.0, kerf=0.15, tabs=0.25)
        Design.load(design).tessellate().export(target, job=job)
        report = preflight(target)
        assert report.passed
        assert {finding.kind for finding in report.findings if finding.severity != "info"} <= {"short"}
        assert not preflight(target, limits=Limits(tabs=0.3)).passed


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b'<vt:recipe job="{&quot;tabs&quot;: &quot;wide&quot;}" />',
        b'<vt:recipe job="{broken" />',
        b'<vt:recipe job="[1, 2]" />',
        b'999\nrecipe {"job": 3}\n',
        b"999\nrecipe " + b"[" * 100_000,
    ],
)
def test_a_broken_recipe_is_none(data: bytes) -> None:
    """It only says what is meant: a file is judged without it."""
    assert tab_width(job_of(data)) == 0.0


TANGLE = "".join(f"<path d='M{k} 0 {20 - k} 20'/>" for k in range(20))


@pytest.mark.parametrize(
    ("limit", "body", "limits", "message"),
    [
        ("contacts.FOUND_MAX", TANGLE, Limits(), r"^t\.svg: its lines cross .* in more than 2,000,000 places\. Remove"),
        ("contacts.FOUND_MAX", "<path d='M1 1h1v1z'/>" * 8, Limits(), r"lie on each other in more than"),
        ("chord_search.CANDIDATES_MAX", TANGLE, Limits(gap=0.0), r"so densely that more than 50 pairs of them"),
        (
            "chord_search.CANDIDATES_MAX",
            "<path d='M1 1h1'/>" * 20,
            Limits(),
            r"so densely that more than 50 pairs of them",
        ),
        ("necks.FOUND_MAX", "<path d='M1 1h1v1zm9 0h1v1z'/>" + TANGLE, Limits(neck=30.0), r"`neck=0`\.$"),
        ("necks._WAYS_MAX", "<path d='M0 0H9V3H5.1V3.2H9V7H0V3.2H4.9V3H0Z'/>", Limits(neck=8.0), r"`neck=0`\.$"),
    ],
)
def test_dense_drawings_are_refused(
    limit: str, body: str, limits: Limits, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Too many pairs to compare, or too many that meet, are one message; within the limits there is a report."""
    path = tmp_path / "t.svg"
    path.write_text(f"<svg {NS} {PAGE} fill='none' stroke='#ff0000'>{body}</svg>")
    monkeypatch.chdir(tmp_path)
    assert preflight("t.svg", limits=limits).pieces > 0
    monkeypatch.setattr(f"voronoi_tiles.preflight.{limit}", 5 if "FOUND" in limit else 50)
    if limit == "necks._WAYS_MAX":
        monkeypatch.setattr(f"voronoi_tiles.preflight.{limit}", 3)
    with pytest.raises(DesignError, match=message) as caught:
        preflight("t.svg", limits=limits)
    assert caught.value.exit_code == 2


def test_curves_that_take_too_many_chords_are_refused() -> None:
    """Before these are made: 20,000 circles of a kilometre would have 80 million."""
    body = '<circle r="1000000"/>' * 20_000
    drawing = svg_drawing(f"<svg {NS} {PAGE} fill='none' stroke='#ff0000'>{body}</svg>".encode(), "t.svg")
    tracemalloc.start()
    try:
        with pytest.raises(DesignError, match=r"take 80,000,000 chords at a tolerance of 0\.05 mm"):
            judge(drawing, "t.svg", limits=Limits(tolerance=0.05))
        assert tracemalloc.get_traced_memory()[1] < 600e6  # one array of them is 1.3e9
    finally:
        tracemalloc.stop()


def test_chords_of_hostile_curves() -> None:
    """Arcs without a sagitta, and of one point; curves of a million kilometres."""
    far = 1e12
    start, end = np.array([0, 1, 0, 0, 0j]), np.array([2, 1, far, far, far * 1j])
    control = np.array([[1, 0], [1, 0], [far * 1j, 0], [far * 1j, -far], [far, 0]])
    kind = np.array([ARC, ARC, QUAD, CUBIC, ARC], np.uint8)
    paths = Paths(start, end, control, kind, np.arange(6), np.zeros(5, np.bool_))
    counts = counts_of(paths, 0.01)
    assert counts.tolist() == [1, 1, CHORDS_MAX, CHORDS_MAX, CHORDS_MAX]
    chords = chords_of(paths, counts, 0.01)
    assert np.isfinite(chords.start).all()
    assert (chords.start[chords.first[:-1]] == start).all()
    assert (chords.end[chords.first[1:] - 1] == end).all()
    assert chords.ring.tolist() == [False, True, False, False, False]


def test_the_search_misses_no_pair(monkeypatch: pytest.MonkeyPatch) -> None:
    """In small portions, slices and ways as in large ones: all pairs within the reach, by shapely's distances."""
    generator = np.random.default_rng(8)
    body = "".join(
        f"<path d='M{x} {y}l{u} {v}l{v} {u}'/>"
        for (x, y), (u, v) in zip(
            generator.uniform(10, 90, (60, 2)), generator.normal(0, 6, (60, 2)).round(1), strict=True
        )
    )
    drawing = svg_drawing(f"<svg {NS} {PAGE} stroke='red'>{body}</svg>".encode(), "t.svg")
    paths = Paths.concatenate([shape.paths for shape in drawing.shapes])
    chords = chords_of(paths, counts_of(paths, 0.01), 0.01)
    segments = [
        shapely.LineString([(p.real, p.imag), (q.real, q.imag)]) for p, q in zip(chords.start, chords.end, strict=True)
    ]
    count = len(segments)
    for reach in (0.005, 1.0, 10.0):
        near = {
            (i, j)
            for i in range(count)
            for j in range(i + 1, count)
            if segments[i].distance(segments[j]) <= reach and not (chords.path[i] == chords.path[j] and j == i + 1)
        }
        whole = [pair for one, two in chord_search.pairs(chords, reach) for pair in zip(one, two, strict=True)]
        monkeypatch.setattr(chord_search, "_PORTION", 7)
        monkeypatch.setattr(chord_search, "_SLICE", 3)
        found = [pair for one, two in chord_search.pairs(chords, reach) for pair in zip(one, two, strict=True)]
        monkeypatch.undo()
        assert near
        assert near <= set(found)
        assert len(set(found)) == len(found)
        assert set(found) == set(whole)
        assert len(found) < count * (count - 1) // 2


def test_portions_change_no_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is found does not depend on how much is looked at at once."""
    body = "".join(body for body, _ in PLANTED.values())
    expected = judged(body).findings
    for name, value in (("chord_search._PORTION", 5), ("chord_search._SLICE", 2), ("necks._WAYS", 3)):
        monkeypatch.setattr(f"voronoi_tiles.preflight.{name}", value)
    assert judged(body).findings == expected


@pytest.mark.parametrize("transform", ["", "translate(1e9 1e9)", "scale(1e-9)"])
def test_pieces_of_no_length_warn_of_nothing(transform: str) -> None:
    """Lines and curves so small that their squares or quotients are no numbers: numpy's warnings are errors here."""
    tiny = (
        "L1e-310 5e-324L3e-162 0L10 0A1e-310 1e-310 0 0 1 3 3Q1e-310 5e-324 5e-324 0C0 0 1e-310 0 5e-324 0L5 5L5 10",
        "L20 10L20 10.001L20 10L0 0L1 10.001Q1e-310 5e-324 5e-324 0",
        "L0 1L3e-162 1L10 0L5e-324 0Q1e-310 5e-324 5e-324 0",
    )
    for data in tiny:
        judged(f"<g transform='{transform}'><path d='M0 0{data}Z'/><path d='M0 0{data}'/></g>")


def test_the_commands_messages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One finding is one; where memory ends it is the drawing that is too large."""
    path = tmp_path / "t.svg"
    path.write_text(f"<svg {NS} {PAGE} fill='none' stroke='red'>{PLANTED['bow tie'][0]}</svg>")
    result = CliRunner().invoke(command, [str(path)])
    assert "t.svg: 1 finding would spoil the cut." in result.stderr
    assert "1 error, 0 warnings, 0 remarks: this would spoil the cut." in result.stdout
    path.write_text(f"<svg {NS} {PAGE} fill='none' stroke='red'>{PLANTED['two circles'][0]}</svg>")
    assert "t.svg: 2 findings would spoil the cut." in CliRunner().invoke(command, [str(path)]).stderr

    def full(*_arguments: object, **_options: object) -> PreflightReport:
        raise MemoryError

    monkeypatch.setattr("voronoi_tiles.preflight.preflight", full)
    result = CliRunner().invoke(command, [str(path)])
    assert result.exit_code == 2
    assert "not enough memory for this drawing. Split it" in result.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        {"limits": 3},
        {"limits": None},
        {"limits": {"tolerance": 1}},
        {"layers": 3},
        {"layers": None},
        {"layers": [3]},
        {"layers": [["cut"]]},
        {"layers": b"cut"},
    ],
    ids=str,
)
def test_arguments_that_cannot_be_are_named(arguments: dict[str, Any], tmp_path: Path) -> None:
    """Limits that are none, and layers that are no names: one ArgumentError, before anything is read."""
    (name,) = arguments
    drawing = svg_drawing(f"<svg {NS} {PAGE} stroke='red'><path d='M0 0h1'/></svg>".encode(), "t.svg")
    with pytest.raises(ArgumentError, match=f"`{name}`"):
        preflight(tmp_path / "none.svg", **arguments)
    with pytest.raises(ArgumentError, match=f"`{name}`"):
        judge(drawing, "t.svg", **arguments)

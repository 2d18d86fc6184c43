"""Sheets, reports, coupons, templates and preflight from the command line: files, messages, exit codes, bytes."""

from __future__ import annotations

import io
import json
import re
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from helpers.cutting import RINGS, SQUARES
from helpers.outlines import CommandLine

from voronoi_tiles import Design, Job
from voronoi_tiles.cli import main as cli
from voronoi_tiles.designs.starters import starter_text
from voronoi_tiles.formats.reading import read_drawing
from voronoi_tiles.formats.recipe import recipe_of
from voronoi_tiles.preflight import preflight

EXAMPLES = Path(__file__).parents[2] / "examples"
WAVE = str(EXAMPLES / "pg-wave.toml")
BOMB = '<?xml version="1.0"?><!DOCTYPE s [<!ENTITY a "aaaaaaaaaa">'
BOMB += "".join(
    f'<!ENTITY {b} "{"&" + a + ";" * 1}{("&" + a + ";") * 9}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True)
)
BOMB += ']><svg xmlns="http://www.w3.org/2000/svg">&i;</svg>'


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in, with two designs."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "squares.toml").write_text(SQUARES)
    (tmp_path / "rings.toml").write_text(RINGS)
    return tmp_path


@dataclass(frozen=True)
class Result:
    """What a run of the command line gave."""

    exit_code: int
    stdout: str
    stderr: str


Call = Callable[..., Result]


@pytest.fixture
def call(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Call:
    """Run the command line in this process, with all that its entry point does about errors."""

    def run(*arguments: object, stdin: str = "") -> Result:
        monkeypatch.setattr(sys, "argv", ["voronoi-tiles", *map(str, arguments)])
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(stdin.encode())))
        code = cli._run()
        output = capfd.readouterr()
        return Result(code, output.out, output.err)

    return run


def check_refused(result: Result, folder: Path, before: set[Path], message: str, code: int = 2) -> None:
    """One clear message with a remedy, the exit code, and nothing written."""
    assert result.exit_code == code, result.stderr
    assert message in result.stderr
    assert result.stderr.startswith("Error: ")
    assert result.stderr.count("\n") == 1
    assert result.stderr.rstrip().endswith((".", "--help'."))
    assert result.stdout == ""
    assert set(folder.rglob("*")) == before


def test_what_files_of_colours_have_in_common_is_said_once(here: Path, call: Call) -> None:
    """The sheet that was found; and of each colour how many sheets it takes, before the first of them."""
    options = ["--pieces", "20", "--colours", "2", "--pack", "--stock", "70x50mm"]
    result = call("export", "squares.toml", "-o", "k.svg", *options)
    assert result.exit_code == 0, result.stderr
    lines = result.stderr.splitlines()
    assert sum(line.startswith("sheet ") for line in lines) == 1
    assert [line.split(",")[0] for line in lines if line.startswith("colour ")] == [
        "colour 1: 10 pieces on 2 sheets",
        "colour 2: 10 pieces on 2 sheets",
    ]
    assert [path.name for path in sorted(here.glob("k-*.svg"))] == [
        f"k-colour{colour}-{sheet}.svg" for colour in (1, 2) for sheet in (1, 2)
    ]


@pytest.mark.parametrize("option", [("--scale", "2"), ("--tile-width", "30mm"), ("--tile-height", "30mm")])
def test_a_size_and_a_number_of_pieces_on_a_sheet_are_two_sizes(
    here: Path, call: Call, option: tuple[str, str]
) -> None:
    """The number alone would decide; where the sheet is what is looked for, both go together."""
    before = set(here.rglob("*"))
    number = ("--pieces", "4", *option)
    refused = call("export", "squares.toml", "-o", "a.svg", "--sheet", "90x90mm", *number)
    check_refused(refused, here, before, f"until so many fill the sheet. Leave out {option[0]}, or --pieces")
    assert call("export", "squares.toml", "-o", "a.svg", *number).exit_code == 0


@pytest.mark.parametrize("form", ["svg", "dxf", "pdf", "lbrn2"])
def test_every_format_the_same_bytes_twice(here: Path, call: Call, form: str, voronoi_tiles: CommandLine) -> None:
    """In two processes; the suffix says what it is."""
    options = ["--sheet", "140x90mm", "--margin", "8mm", "--kerf", "0.2", "--labels", "number", "--colours", "layers"]
    first = call("export", "squares.toml", "-o", f"a.{form}", *options, "--bar", "--marks")
    assert first.exit_code == 0, first.stderr
    assert first.stderr.startswith(f"wrote a.{form}: 15 pieces, ")
    second = voronoi_tiles("export", "squares.toml", "-o", f"b.{form}", *options, "--bar", "--marks", cwd=here)
    assert second.returncode == 0, second.stderr
    assert (here / f"a.{form}").read_bytes() == (here / f"b.{form}").read_bytes()


def test_all_options_of_a_job_reach_it(here: Path, call: Call) -> None:
    """They are in the file's recipe, lengths in millimetres."""
    result = call(
        *("export", "squares.toml", "-o", "a.svg", "--sheet", "20x15cm", "--margin", "0.5in", "--fit", "clip"),
        *("--rotate", "30", "--offset", "3mm,-1cm", "--edges", "pieces", "--gap", "2", "--kerf", "0.15mm"),
        *("--fillet", "0.5mm", "--tabs", "0.3mm", "--accuracy", "0.01mm", "--curves", "arc", "--preset", "lightburn"),
        *("--labels", "site", "--label-height", "2mm", "--marks", "--bar", "--colors", "layers", "--art", "none"),
        *("--feed", "300,score=9", "--power", "800"),
    )
    assert result.exit_code == 0, result.stderr
    text = (here / "a.svg").read_text()
    recipe = json.loads(text.split('job="')[1].split('"')[0].replace("&quot;", '"'))
    assert recipe == {
        "sheet": [200.0, 150.0],
        "margin": 12.7,
        "fit": "clip",
        "rotate": 30.0,
        "offset": [3.0, -10.0],
        "edges": "pieces",
        "gap": 2.0,
        "kerf": 0.15,
        "fillet": 0.5,
        "tabs": 0.3,
        "accuracy": 0.01,
        "curves": "arc",
        "preset": "lightburn",
        "feed": "300,score=9",
        "power": "800",
        "labels": "site",
        "label_height": 2.0,
        "marks": True,
        "bar": True,
        "colours": "layers",
        "art": "none",
    }
    assert "<text" not in text


def test_standard_input_and_output(here: Path, call: Call) -> None:
    """The same bytes as into a file."""
    assert call("export", "squares.toml", "-o", "a.svg", "--sheet", "90x90").exit_code == 0
    result = call("export", "-", "-o", "-", "--sheet", "90x90", stdin=SQUARES)
    assert result.exit_code == 0
    text = (here / "a.svg").read_text()
    assert result.stdout == text.replace("squares (p1)", "design (p1)")
    assert result.stderr == ""
    dxf = call("export", "-", "-o", "-", "--format", "dxf", "--kerf", "0.2", stdin=SQUARES)
    assert dxf.exit_code == 0
    assert "LWPOLYLINE" in dxf.stdout


def test_a_file_for_each_colour(here: Path, call: Call) -> None:
    """Named by the colour; none is written when one cannot be made."""
    result = call("export", "squares.toml", "-o", "w.svg", "--sheet", "90x90", "--colours", "files", "--fit", "frame")
    assert result.exit_code == 0, result.stderr
    names = sorted(path.name for path in here.glob("w-*.svg"))
    assert names == ["w-1.svg", "w-2.svg", "w-frame.svg"]
    wrote = [line.split(":")[0] for line in result.stderr.splitlines() if line.startswith("wrote")]
    assert wrote == [f"wrote {name}" for name in names]
    pieces = [len(read_drawing(here / name).shapes) for name in names]
    assert sorted(pieces[:2]) == [8, 8]
    before = set(here.rglob("*"))
    result = call("export", "squares.toml", "-o", "-", "--sheet", "90x90", "--colours", "files")
    check_refused(result, here, before, "several files need a name")
    result = call(
        "export", WAVE, "-o", "v.svg", "--sheet", "200x200", "--colours", "files", "--tabs", "60", "--gap", "1"
    )
    check_refused(result, here, before, "tabs of 60 mm leave nothing")


def test_a_folder_of_sheets(here: Path, call: Call) -> None:
    """Several designs with one job; what fails leaves the others."""
    result = call("export", "squares.toml", "rings.toml", "-o", "out", "--format", "dxf", "--kerf", "13mm")
    assert result.exit_code == 2
    assert sorted(path.name for path in (here / "out").iterdir()) == ["squares.dxf"]
    assert "rings.toml: --kerf 13mm is too much" in result.stderr


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--sheet", "15x15"], "no whole tile fits on the sheet"),
        (["--sheet", "15x15mm", "--fit", "frame"], "no whole tile fits on the sheet"),
        (["--sheet", "-15x15"], "15"),
        (["--sheet", "0x15"], "--sheet"),
        (["--sheet", "15"], "--sheet"),
        (["--sheet", "15xx15"], "--sheet"),
        (["--sheet", "600x300ly"], "ly"),
        (["--sheet", "1e300x1e300"], "sheet"),
        (["--sheet", "nanx5"], "--sheet"),
        (["--sheet", "missing.svg"], "missing.svg"),
        (["--sheet", "90x90", "--margin", "45"], "leaves nothing"),
        (["--kerf", "0.2furlong"], "furlong"),
        (["--kerf=-0.2"], "negative"),
        (["--kerf", "0.2", "--edges", "once"], "--kerf needs --edges pieces"),
        (["--fillet", "1", "--edges", "once"], "--fillet needs --edges pieces"),
        (["--colours", "files", "--edges", "once"], "--colours needs --edges pieces"),
        (["--fillet", "11"], "too much"),
        (["--fit", "clip"], "about a sheet"),
        (["--marks"], "about a sheet"),
        (["--sheet", "90x90", "--fit", "frame", "--kerf", "0.2"], "no room"),
        (["--sheet", "90x90", "--edges", "pieces", "--tabs", "0.3"], "lie on each other"),
        (["--tabs", "30"], "leave nothing to cut"),
        (["--preset", "laserjet"], "laserjet"),
        (["--preset", "none.toml"], "none.toml"),
        (["--curves", "nurbs"], "nurbs"),
        (["--accuracy", "0"], "--accuracy 0 mm cannot be"),
        (["--accuracy", "5m"], "5m"),
        (["--offset", "3"], "3"),
        (["--offset", "1,2,3"], "1,2,3"),
        (["--label-height", "0mm"], "--label-height 0 mm cannot be"),
        (["--sheet", "90x90", "--bar"], "no room"),
        (["--format", "dxf"], "contradict"),
    ],
)
def test_bad_input(here: Path, call: Call, options: list[str], message: str) -> None:
    """Each one message, exit 2, nothing written; from `report` too."""
    before = set(here.rglob("*"))
    check_refused(call("export", "squares.toml", "-o", "a.svg", *options), here, before, message)
    if options[0] != "--format":
        check_refused(call("report", "squares.toml", *options), here, before, message)


@pytest.mark.parametrize("preset_form", [("glowforge", "dxf"), ("redcut", "lbrn2"), ("cnc", "pdf"), ("cnc", "gcode")])
def test_presets_refuse_what_they_do_not_read(here: Path, call: Call, preset_form: tuple[str, str]) -> None:
    """The message names the format to use instead."""
    preset, form = preset_form
    before = set(here.rglob("*"))
    result = call("export", "squares.toml", "-o", f"a.{form}", "--preset", preset)
    check_refused(result, here, before, f"{preset} does not read {form}")


def test_json_and_a_job_contradict_each_other(here: Path, call: Call) -> None:
    """A document holds exact tiles."""
    before = set(here.rglob("*"))
    check_refused(call("export", "squares.toml", "-o", "a.json", "--kerf", "1"), here, before, "JSON document")
    check_refused(call("export", "squares.toml", "-o", "a.json", "--colours", "files"), here, before, "JSON document")


HOSTILE = {
    "bomb": BOMB,
    "external": '<!DOCTYPE s [<!ENTITY x SYSTEM "file:///etc/passwd">]><svg xmlns="http://www.w3.org/2000/svg">&x;</svg>',
    "truncated": '<svg xmlns="http://www.w3.org/2000/svg"><path d="M 0 0 H 90 V 90',
    "nested": '<svg xmlns="http://www.w3.org/2000/svg">' + "<g>" * 100_000 + "</g>" * 100_000 + "</svg>",
    "negative": '<svg xmlns="http://www.w3.org/2000/svg" width="-5mm" height="5mm"><rect width="-1" height="2"/></svg>',
    "binary": "\0\1\2",
    "empty": "",
}


@pytest.mark.parametrize("kind", sorted(HOSTILE))
def test_hostile_drawings(here: Path, call: Call, kind: str) -> None:
    """As a sheet, as art, and for preflight: one message, nothing written, in little time."""
    (here / "bad.svg").write_text(HOSTILE[kind])
    (here / "art.toml").write_text(SQUARES.replace("[[site]]", '[[site]]\nart = "bad.svg"'))
    before = set(here.rglob("*"))
    result = call("export", "squares.toml", "-o", "a.svg", "--sheet", "bad.svg")
    check_refused(result, here, before, "bad.svg")
    if kind != "negative":
        check_refused(call("export", "art.toml", "-o", "a.svg"), here, before, "bad.svg")
        check_refused(call("preflight", "bad.svg"), here, before, "bad.svg")


@pytest.mark.usefixtures("here")
def test_report(call: Call) -> None:
    """As a table and as JSON; speeds are the caller's; it takes what export takes."""
    text = call("report", "squares.toml", "--sheet", "90x90", "--kerf", "0.2")
    assert text.exit_code == 0, text.stderr
    assert "pierces" in text.stdout
    figures = json.loads(call("report", "squares.toml", "--sheet", "90x90", "--json").stdout)
    assert figures["pieces"]["count"] == 16
    assert figures["cut"]["length"] == pytest.approx(2 * 5 * 80)
    slow = json.loads(call("report", "squares.toml", "--sheet", "90x90", "--json", "--cut-speed", "1").stdout)
    assert slow["time"] - figures["time"] == pytest.approx(800 * 0.9)
    late = json.loads(call("report", "squares.toml", "--sheet", "90x90", "--json", "--pierce-time", "2").stdout)
    assert late["time"] - figures["time"] == pytest.approx(1.7 * figures["cut"]["pierces"])
    files = json.loads(call("report", "squares.toml", "--sheet", "90x90", "--colours", "files", "--json").stdout)
    assert files["colours"] == 2
    assert call("report", "squares.toml", "--cut-speed", "0").exit_code == 2


def test_gcode_says_how_it_burns_or_is_not_written(here: Path, call: Call) -> None:
    """By options or by a preset; two suffixes; a preflight finds nothing in it, and its recipe is the job's."""
    before = set(here.rglob("*"))
    sheet = ("--sheet", "90x90mm", "--kerf", "0.2")
    refused = call("export", "squares.toml", "-o", "a.gcode", *sheet)
    check_refused(refused, here, before, "needs --feed and --power of cut. Give --feed cut=300 in mm/min and --power")
    for wrong in ("fast", "cut=0", "cut=1,cut=2", "engraved=3", "300,", "nan"):
        refused = call("export", "squares.toml", "-o", "a.nc", *sheet, "--feed", wrong, "--power", "800")
        check_refused(refused, here, before, f"--feed '{wrong}' cannot be")
    (here / "wood.toml").write_text("feed = { cut = 300, engrave = 3000 }\npower = { cut = 8000, engrave = 99 }\n")
    refused = call("export", "squares.toml", "-o", "a.nc", *sheet, "--preset", "wood.toml")
    assert "--power of 8000 for cut is more than the machine's 1000" in refused.stderr
    with (here / "wood.toml").open("a") as preset:
        preset.write("power_max = 10000\n")
    made = call("export", "squares.toml", "-o", "a.nc", *sheet, "--preset", "wood.toml", "--labels", "number")
    assert made.exit_code == 0, made.stderr
    text = (here / "a.nc").read_text(encoding="ascii")
    assert set(re.findall("F.*", text.split("M4 S0")[1])) == {"F300 S8000", "F3000 S99"}
    assert call("preflight", "a.nc").exit_code == 0
    result = call("export", "squares.toml", "-o", "-", "--format", "gcode", *sheet, "--feed", "600", "--power", "5")
    assert set(re.findall("F.*", result.stdout.split("M4 S0")[1])) == {"F600 S5"}
    assert json.loads(recipe_of(result.stdout.encode())["job"])["feed"] == "600"


def test_coupon_and_template(here: Path, call: Call) -> None:
    """Files in all formats, and what to write into the design."""
    burn = ("--feed", "cut=300,engrave=3000", "--power", "cut=800,engrave=150")
    for form in ("svg", "dxf", "pdf", "lbrn2", "gcode"):
        result = call("coupon", "-o", f"c.{form}", "--thickness", "3mm", "--preset", "lightburn", *burn)
        assert (result.exit_code, result.stderr) == (0, f"wrote c.{form}\n")
    result = call("template", "rings.toml", "-o", "page.svg", "--site", "island")
    assert result.exit_code == 0
    assert 'for [[site]] "island": art = { file = "page.svg", translate = [' in result.stderr
    layers = {shape.layer for shape in read_drawing(here / "page.svg").shapes}
    assert layers == {"guide"}
    before = set(here.rglob("*"))
    check_refused(call("template", "rings.toml", "-o", "p.svg", "--site", "x"), here, before, 'no site "x"')
    check_refused(call("template", "rings.toml", "-o", "p.dxf"), here, before, ".svg")
    check_refused(call("coupon", "-o", "k.svg", "--thickness", "0mm"), here, before, "0 mm")
    check_refused(call("coupon", "-o", "k.svg", "--thickness", "3mm", "--kerfs", "9:1:1"), here, before, "is empty")
    check_refused(call("coupon", "-o", "k.stl", "--thickness", "3mm"), here, before, "suffix")
    refused = call("coupon", "-o", "k.dxf", "--thickness", "3mm", "--preset", "glowforge")
    check_refused(refused, here, before, "does not read dxf")


@pytest.mark.parametrize("form", ["svg", "dxf"])
def test_preflight_of_our_own_files(here: Path, call: Call, form: str) -> None:
    """Pieces with a kerf pass; the same line twice is found, with exit 1, and shown on a marked page."""
    assert call("export", "squares.toml", "-o", f"good.{form}", "--sheet", "90x90", "--kerf", "0.2").exit_code == 0
    good = call("preflight", f"good.{form}")
    assert good.exit_code == 0, good.stdout
    twice = call("export", "squares.toml", "-o", f"bad.{form}", "--sheet", "90x90", "--edges", "pieces")
    assert twice.exit_code == 0
    bad = call("preflight", f"bad.{form}", "-o", "marked.svg")
    assert bad.exit_code == 1
    assert (here / "marked.svg").exists()


def test_broken_oracle_of_refusals(here: Path, call: Call) -> None:
    """The check of the tests above sees a job that is done."""
    before: set[Any] = set(here.rglob("*"))
    with pytest.raises(AssertionError):
        check_refused(call("export", "squares.toml", "-o", "a.svg", "--kerf", "0.2"), here, before, "kerf")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--sheet", "1e5x1e5"), "11,111,111 tiles"),
        (("--sheet", "1e-9x1e-9"), "0.1 to 100,000 mm"),
        (("--sheet", "far.svg", "--fit", "clip"), "far.svg are 200 x 200 mm, from (1e+09"),
        (("--sheet", "dot.svg", "--fit", "clip"), "0.1 to 100,000 mm"),
        (("--label-height", "0.1mm"), "0.5 to 1,000 mm"),
        (("--sheet", "20x20", "--fit", "clip", "--kerf", "8"), "no tile fits on the sheet"),
    ],
)
def test_sheets_beyond_all_measure(
    voronoi_tiles: CommandLine, tmp_path: Path, arguments: tuple[str, ...], words: str
) -> None:
    """They are refused at once, whatever they would take."""
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100"><path d="'
    (tmp_path / "far.svg").write_text(f'{head}M1e9 1e9h200v200h-200Z"/></svg>')
    (tmp_path / "dot.svg").write_text(f'{head}M1 1h1e-9v1e-9h-1e-9Z"/></svg>')
    done = voronoi_tiles("export", str(EXAMPLES / "p4-hook.toml"), "-o", "o.svg", *arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert words in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not (tmp_path / "o.svg").exists()


def test_what_a_job_reads_is_not_overwritten(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """The sheet's drawing, the preset, the art: each stays, and so does the last of several files that is a folder."""
    (tmp_path / "sheet.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="200mm" viewBox="0 0 200 200">'
        '<path d="M5 5h190v190h-190Z"/></svg>'
    )
    (tmp_path / "mine.toml").write_text('extends = "lightburn"\n')
    for name in ("swallow.toml", "swallow.svg"):
        shutil.copy(EXAMPLES / "art" / name, tmp_path)
    (tmp_path / "w-2.svg").mkdir()
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}
    for arguments in (
        ("-o", "sheet.svg", "--sheet", "sheet.svg"),
        ("-o", "mine.toml", "--format", "svg", "--preset", "mine.toml"),
        ("-o", "swallow.svg", "--sheet", "200x200"),
        ("-o", "w.svg", "--sheet", "200x200", "--colours", "files"),
    ):
        done = voronoi_tiles("export", "swallow.toml", *arguments, cwd=tmp_path)
        assert done.returncode == 2, done.stderr
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()} == before


@pytest.mark.parametrize("group", ["pm", "pmm", "pmg", "cmm", "p4m", "p6m"])
@pytest.mark.parametrize("fit", ["whole", "clip", "frame"])
def test_mirrors_along_the_border_are_cut_once(tmp_path: Path, group: str, fit: str) -> None:
    """Where tiles lie along the edge of the sheet, the preflight finds nothing that is cut twice."""
    target = tmp_path / "sheet.svg"
    tiling = Design.loads(starter_text(group)).tessellate()
    tiling.export(target, job=Job(sheet=(150.0, 110.0), fit=fit, edges="once", offset=0j))  # type: ignore[arg-type]
    assert preflight(target).passed


def test_what_is_no_path_in_art_is_named(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """Texts are not engraved; the export says so."""
    art = (EXAMPLES / "art" / "swallow.svg").read_text().replace("</svg>", "<text>swallow</text></svg>")
    (tmp_path / "swallow.svg").write_text(art)
    shutil.copy(EXAMPLES / "art" / "swallow.toml", tmp_path)
    done = voronoi_tiles("export", "swallow.toml", "-o", "o.svg", "--sheet", "200x200", cwd=tmp_path)
    assert done.returncode == 0
    assert "text (1)" in done.stderr


@pytest.mark.parametrize("value", ["nan", "inf", "0", "1e9"])
def test_speeds_are_numbers(voronoi_tiles: CommandLine, tmp_path: Path, value: str) -> None:
    """The report's JSON has no room for others."""
    done = voronoi_tiles("report", str(EXAMPLES / "p4-hook.toml"), "--cut-speed", value, cwd=tmp_path)
    assert done.returncode == 2
    assert not done.stdout

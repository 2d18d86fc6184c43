"""The commands of the raster stage through their real entry point: check, render, export --check."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from helpers.outlines import CommandLine
from helpers.png import chunks_of, decoded
from test_cli import SEGMENT, TOUCHING, complaint

VT = "{urn:voronoi-tiles:recipe}"
FIGURES = ["labels", "coverage", "area", "crossings", "neighbours", "edges", "equidistance"]

BREAK_THE_OUTLINE = """
import sys
import voronoi_tiles.tiling as tiling
from voronoi_tiles.cli.main import run
sound = tiling.tessellate
def broken(design):
    result = sound(design)
    outline = result.tiles[0].outline
    for points in (outline.start, outline.end):
        points.setflags(write=True)  # nobody else can break an outline
    outline.start[0] += 1e-3
    outline.end[-1] += 1e-3
    return result
tiling.tessellate = broken
sys.argv[1:] = {arguments!r}
run()
"""


@pytest.fixture
def design(tmp_path: Path) -> Path:
    """One segment in p4."""
    path = tmp_path / "bird.toml"
    path.write_text(SEGMENT)
    return path


def with_a_broken_outline(arguments: list[str], cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run a command whose tiles have one vertex a micrometre off."""
    call = [sys.executable, "-c", BREAK_THE_OUTLINE.format(arguments=arguments)]
    return subprocess.run(call, capture_output=True, text=True, check=False, cwd=cwd)


def test_check_prints_every_figure_with_its_limit(voronoi_tiles: CommandLine, design: Path) -> None:
    """The table names the renderer, the device and the precision; the exit code is 0."""
    result = voronoi_tiles("check", design, "--renderer", "cpu", "--size", 128)
    assert (result.returncode, result.stderr) == (0, "")
    for word in (*FIGURES, "128 x 128 samples", "exact on cpu", "numpy", "float64", "limit", "accuracy", "open joints"):
        assert word in result.stdout
    assert "FAILED" not in result.stdout


def test_check_json(voronoi_tiles: CommandLine, design: Path) -> None:
    """For programs: every figure with what was checked, what was wrong, and the limit."""
    result = voronoi_tiles("check", design, "--json", "--renderer", "cpu", "--size", 100, "--method", "hoff")
    assert (result.returncode, result.stderr) == (0, "")
    document = json.loads(result.stdout)
    assert document["design"] == "bird"
    assert all(row["passed"] for row in document["proof"])
    check = document["check"]
    assert check["passed"]
    assert check["samples"] == [100, 100]
    assert (check["renderer"], check["precision"]) == ("cpu", "float64")
    assert check["method"].startswith("hoff")
    assert [row["name"] for row in check["figures"]] == FIGURES
    assert all(row["checked"] > 0 and row["wrong"] == 0 for row in check["figures"])


def test_check_draws_a_white_picture(voronoi_tiles: CommandLine, design: Path, tmp_path: Path) -> None:
    """Where the two agree there is nothing to see."""
    picture = tmp_path / "diff.png"
    assert voronoi_tiles("check", design, "-o", picture, "--renderer", "cpu", "--size", 64).returncode == 0
    assert (decoded(picture.read_bytes()) == 255).all()


def test_a_failed_check_is_exit_code_1(design: Path, tmp_path: Path) -> None:
    """The report is printed all the same, with the places; the message names the figures, the picture shows them."""
    call = ["check", design.name, "--renderer", "cpu", "--size", "64", "-o", "diff.png"]
    result = with_a_broken_outline(call, tmp_path)
    assert result.returncode == 1
    assert "FAILED" in result.stdout
    assert "wrong at (" in result.stdout
    wrote, line = result.stderr.splitlines()
    assert wrote == "wrote diff.png"
    assert line.startswith("Error: bird.toml: the outlines failed the cross-check: ")
    assert "equidistance" in line
    assert (decoded((tmp_path / "diff.png").read_bytes()) != 255).any()


def test_export_check_writes_the_evidence(voronoi_tiles: CommandLine, design: Path, tmp_path: Path) -> None:
    """What was proved and checked is in the file; without --check it is not, and nothing else differs."""
    checked, plain = tmp_path / "checked.svg", tmp_path / "plain.svg"
    result = voronoi_tiles("export", design, "-o", checked, "--check", "--renderer", "cpu")
    assert (result.returncode, result.stderr) == (0, f"wrote {checked}\n")
    assert voronoi_tiles("export", design, "-o", plain).returncode == 0
    root = ET.parse(checked).getroot()
    evidence = root.find(f".//{VT}evidence")
    assert evidence is not None
    document = json.loads(evidence.text or "")
    check = document["check"]
    assert [figure["name"] for figure in check["figures"]] == FIGURES
    assert {figure["passed"] for figure in (*document["proof"], *check["figures"])} == {True}
    assert (check["renderer"], check["samples"]) == ("cpu", [1024, 1024])
    (metadata,) = [part for part in root.iter() if evidence in list(part)]
    metadata.remove(evidence)
    assert [part.attrib for part in root.iter()] == [part.attrib for part in ET.parse(plain).getroot().iter()]


def test_export_check_json(voronoi_tiles: CommandLine, design: Path, tmp_path: Path) -> None:
    """The outline document keeps its keys and gains one."""
    checked = tmp_path / "checked.json"
    assert voronoi_tiles("export", design, "-o", checked, "--check", "--renderer", "cpu").returncode == 0
    document = json.loads(checked.read_text())
    assert list(document) == ["schema", "units", "group", "cell", "tiles", "evidence"]
    assert document["evidence"]["check"]["passed"] is True


def test_export_check_writes_nothing_that_fails(design: Path, tmp_path: Path) -> None:
    """Exit code 1, one message, and the old file as it was."""
    (tmp_path / "bird.svg").write_text("old")
    result = with_a_broken_outline(["export", design.name, "-o", "bird.svg", "--check", "--renderer", "cpu"], tmp_path)
    assert "failed the cross-check" in complaint(result, code=1)
    assert (tmp_path / "bird.svg").read_text() == "old"


def test_render(voronoi_tiles: CommandLine, design: Path, tmp_path: Path) -> None:
    """A picture of the asked size, and one line that says who rendered it."""
    picture = tmp_path / "bird.png"
    call = ["render", design, "-o", picture, "--size", "120x80", "--region", "-30,0,30,40", "--overlay", "symmetry"]
    result = voronoi_tiles(*call, "--overlay", "cell", "--overlay", "outline", "--renderer", "cpu")
    assert (result.returncode, result.stdout) == (0, "")
    assert result.stderr.startswith(f"wrote {picture}: exact on cpu (numpy), float64")
    assert decoded(picture.read_bytes()).shape == (80, 120, 3)
    texts = [body for kind, body in chunks_of(picture.read_bytes()) if kind == b"tEXt"]
    assert any(b"exact on cpu" in body for body in texts)


def test_render_to_standard_output(command: str, design: Path) -> None:
    """`-` is standard output, and the same design gives the same bytes."""
    call = [command, "render", str(design), "-o", "-", "--size", "50", "--renderer", "cpu"]
    one, two = (subprocess.run(call, capture_output=True, check=True) for _ in range(2))
    assert one.stderr == b""
    assert one.stdout == two.stdout
    assert decoded(one.stdout).shape == (50, 50, 3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["check"], "Missing argument"),
        (["check", "bird.toml", "--size", "8"], "--size"),
        (["check", "bird.toml", "--size", "1000000"], "--size"),
        (["check", "bird.toml", "--renderer", "tea"], "tea"),
        (["check", "bird.toml", "--device", "-1"], "--device"),
        (["check", "bird.toml", "-o", "diff.svg"], ".png"),
        (["check", "bird.toml", "-o", "-"], "FILE.png"),
        (["check", "bird.toml", "-o", ""], "is empty"),
        (["check", "bird.toml", "-o", "missing/diff.png", "--size", "32"], "cannot write"),
        (["check", "touching.toml"], "touches"),
        (["check", "missing.toml"], "missing.toml"),
        (["render", "bird.toml"], "Missing option '-o'"),
        (["render", "bird.toml", "-o", "bird.jpg"], ".png"),
        (["render", "bird.toml", "-o", "x.png", "--size", "big"], "no size"),
        (["render", "bird.toml", "-o", "x.png", "--size", "0"], "pixels"),
        (["render", "bird.toml", "-o", "x.png", "--size", "1x2x3"], "no size"),
        (["render", "bird.toml", "-o", "x.png", "--size", "9999999999999999999"], "no size"),
        (["render", "bird.toml", "-o", "x.png", "--region", "0,0,60"], "no rectangle"),
        (["render", "bird.toml", "-o", "x.png", "--region", "0,0,-60,60"], "is empty"),
        (["render", "bird.toml", "-o", "x.png", "--region", "0,0,nan,60"], "not finite"),
        (["render", "bird.toml", "-o", "x.png", "--region", "0,0,1e8,1e8"], "copies of elements"),
        (["render", "bird.toml", "-o", "x.png", "--overlay", "tea"], "tea"),
        (["render", "bird.toml", "-o", "missing/x.png"], "cannot write"),
        (["export", "bird.toml", "-o", "x.svg", "--renderer", "cpu"], "add --check"),
    ],
)
def test_wrong_usage(
    arguments: list[str], message: str, voronoi_tiles: CommandLine, design: Path, tmp_path: Path
) -> None:
    """One clear message, exit code 2, and nothing written."""
    (design.parent / "touching.toml").write_text(TOUCHING)
    renderer = [] if "--renderer" in arguments or len(arguments) == 1 else ["--renderer", "cpu"]
    result = voronoi_tiles(*arguments, *renderer, cwd=tmp_path)
    assert message in complaint(result)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bird.toml", "touching.toml"]


def test_touching_copies_are_drawn(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """The picture is there, with the place marked; the message says where, and the exit code 1 that it is no tiling."""
    (tmp_path / "bird.toml").write_text(TOUCHING)
    call = ["render", "bird.toml", "-o", "x.png", "--size", "60", "--overlay", "outline", "--renderer", "cpu"]
    result = voronoi_tiles(*call, cwd=tmp_path)
    assert (result.returncode, result.stdout) == (1, "")
    wrote, message = result.stderr.splitlines()
    assert wrote.startswith("wrote x.png: exact on cpu")
    assert message.startswith('Error: bird.toml: site "bird" touches its own copy under -y,x at (-3, 5).')
    assert decoded((tmp_path / "x.png").read_bytes()).shape == (60, 60, 3)
    piped = voronoi_tiles(
        "render", "-", "-o", "y.png", "-q", "--size", "60", "--renderer", "cpu", cwd=tmp_path, stdin=TOUCHING
    )
    assert complaint(piped, code=1).startswith('Error: standard input: site "bird" touches')


def test_opengl_can_be_insisted_on(voronoi_tiles: CommandLine, design: Path, tmp_path: Path) -> None:
    """A device that is not there: auto takes the processor and says why, gl is exit code 1."""
    picture = tmp_path / "x.png"
    call = ["render", design, "-o", picture, "--size", 40, "--device", 99]
    result = voronoi_tiles(*call)
    assert result.returncode == 0
    notice, wrote = result.stderr.splitlines()
    assert notice.startswith("OpenGL not available (")
    assert "Using the CPU renderer." in notice
    assert "exact on cpu" in wrote
    picture.unlink()
    assert "OpenGL failed" in complaint(voronoi_tiles(*call, "--renderer", "gl"), code=1)
    assert not picture.exists()


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.usefixtures("heard_signals")
@pytest.mark.parametrize(("signal_number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_an_interrupted_picture_leaves_nothing_behind(
    signal_number: signal.Signals, code: int, command: str, design: Path, tmp_path: Path
) -> None:
    """Neither the picture nor the temporary file beside it."""
    call = [command, "render", str(design), "-o", str(tmp_path / "x.png"), "--size", "20000", "--renderer", "cpu"]
    process = subprocess.Popen(call, stderr=subprocess.PIPE, text=True)
    begun = time.monotonic()
    while time.monotonic() - begun < 60 and len(list(tmp_path.iterdir())) < 2:
        time.sleep(0.05)
    assert len(list(tmp_path.iterdir())) == 2
    process.send_signal(signal_number)
    process.communicate(timeout=60)
    assert process.returncode == code
    assert [path.name for path in tmp_path.iterdir()] == ["bird.toml"]


def test_the_import_of_the_package_loads_no_opengl() -> None:
    """Neither do the commands that need no picture."""
    script = (
        "import sys, voronoi_tiles.tiling, voronoi_tiles.cli.main; "
        "assert not {'moderngl', 'scipy.ndimage'} & {*sys.modules}"
    )
    subprocess.run([sys.executable, "-c", script], check=True)

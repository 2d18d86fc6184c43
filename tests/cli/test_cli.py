"""The command line through its real entry point: results, exit codes, messages, and no traceback whatever happens."""

from __future__ import annotations

import json
import os
import platform
import shutil
import signal
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
import svgelements
from helpers.outlines import CommandLine

from voronoi_tiles import __version__
from voronoi_tiles.base import kernels
from voronoi_tiles.designs.starters import GROUP_NAMES, starter_text

SEGMENT = """\
schema = 1
group = "p4"
[cell]
a = 60.0
[[site]]
name = "bird"
strokes = [{ segment = [[5, 3], [25, 11]] }]
"""
TOUCHING = SEGMENT.replace("[25, 11]", "[-3, 5]")


@pytest.fixture
def design(tmp_path: Path) -> Path:
    """One segment in p4."""
    path = tmp_path / "bird.toml"
    path.write_text(SEGMENT)
    return path


def complaint(result: subprocess.CompletedProcess[str], code: int = 2) -> str:
    """The one message of a run that must have failed, with nothing on standard output and no traceback."""
    assert result.returncode == code, result.stderr
    assert "Traceback" not in result.stderr
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert line.startswith("Error: ")
    return line


def test_version(voronoi_tiles: CommandLine) -> None:
    """The version is the package's."""
    result = voronoi_tiles("--version")
    assert (result.returncode, result.stdout) == (0, f"voronoi-tiles, version {__version__}\n")


@pytest.mark.parametrize("arguments", [["--version", "--verbose"], ["--verbose", "--version"]])
def test_version_says_what_it_runs_on(voronoi_tiles: CommandLine, arguments: list[str]) -> None:
    """The kernels in use, Python and the libraries, for reports of problems."""
    result = voronoi_tiles(*arguments)
    first, used, *others = result.stdout.splitlines()
    assert (result.returncode, first) == (0, f"voronoi-tiles, version {__version__}")
    assert used == f"kernels: {kernels.in_use()}"
    assert others[0].startswith(f"Python {platform.python_version()} on ")
    assert {f"numpy {version('numpy')}", f"shapely {version('shapely')}"} < {*others}
    assert not any(line.startswith("pytest") for line in others)
    assert len(others) == len({*others})


def test_verbose_goes_with_version(voronoi_tiles: CommandLine) -> None:
    """Elsewhere it would be taken and do nothing."""
    assert "--verbose goes with --version" in complaint(voronoi_tiles("--verbose", "new", "p4"))


def test_the_module_runs_too(command: str) -> None:
    """`python -m voronoi_tiles` is the same command."""
    assert Path(command).exists()
    result = subprocess.run(
        [sys.executable, "-m", "voronoi_tiles", "--version"], capture_output=True, text=True, check=True
    )
    assert __version__ in result.stdout


def test_without_a_command_the_help_is_shown(voronoi_tiles: CommandLine) -> None:
    """Help on standard error, and the exit code of a usage error."""
    result = voronoi_tiles()
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr.startswith("Usage: voronoi-tiles")
    for name in ("export", "info", "new", "completion"):
        assert name in result.stderr


@pytest.mark.parametrize("arguments", [["--version"], ["--help"], ["new", "p4"], ["export", "--help"]])
def test_quick_commands_import_nothing_heavy(arguments: list[str]) -> None:
    """What --version and --help need is click alone: the start-up has a budget."""
    script = (
        "import sys\nfrom voronoi_tiles.cli.main import run\n"
        f"sys.argv[1:] = {arguments!r}\n"
        "try:\n    run()\nexcept SystemExit as exit:\n    assert not exit.code\n"
        "heavy = {'numpy', 'scipy', 'shapely', 'svgwrite', 'svgelements', 'rich', 'asyncio'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, capture_output=True)


# --- export ---


def test_export_svg(voronoi_tiles: CommandLine, design: Path, tmp_path: Path) -> None:
    """The suffix names the format; the message goes to standard error."""
    out = tmp_path / "bird.svg"
    result = voronoi_tiles("export", design, "-o", out)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", f"wrote {out}\n")
    root = ET.parse(out).getroot()
    assert len(list(root.iter("{http://www.w3.org/2000/svg}path"))) == 1
    recipe = root.find(".//{urn:voronoi-tiles:recipe}recipe")
    assert recipe is not None
    assert recipe.get("version") == __version__
    assert json.loads(recipe.text or "")["group"] == "p4"


def test_export_json(voronoi_tiles: CommandLine, design: Path, tmp_path: Path) -> None:
    """The outline document: a quarter of the cell for each of four copies."""
    out = tmp_path / "bird.json"
    assert voronoi_tiles("export", design, "-o", out, "--quiet").stderr == ""
    document = json.loads(out.read_text())
    (tile,) = document["tiles"]
    assert tile["site"] == "bird"
    assert tile["area"] == pytest.approx(900.0, rel=1e-12)
    assert tile["copies_per_cell"] == 4


def test_export_twice_gives_the_same_bytes(voronoi_tiles: CommandLine, design: Path, tmp_path: Path) -> None:
    """Byte-reproducible, in another process and another folder."""
    (tmp_path / "other").mkdir()
    for name in ("bird.svg", "bird.json"):
        assert voronoi_tiles("export", design, "-o", tmp_path / name).returncode == 0
        assert voronoi_tiles("export", "bird.toml", "-o", f"other/{name}", cwd=tmp_path).returncode == 0
        assert (tmp_path / name).read_bytes() == (tmp_path / "other" / name).read_bytes()


def test_standard_input_and_output(voronoi_tiles: CommandLine) -> None:
    """A design comes in, a file goes out; the format is SVG unless named."""
    svg = voronoi_tiles("export", "-", "-o", "-", stdin=SEGMENT)
    assert (svg.returncode, svg.stderr) == (0, "")
    assert svg.stdout.startswith("<?xml")
    text = voronoi_tiles("export", "-", "-o", "-", "--format", "json", stdin=SEGMENT)
    assert json.loads(text.stdout)["schema"] == 1


def test_several_designs_go_into_a_folder(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """The folder is made; the names are the designs'."""
    for name in ("a", "b"):
        (tmp_path / f"{name}.toml").write_text(SEGMENT)
    result = voronoi_tiles("export", "a.toml", "b.toml", "-o", "out/deep", "--format", "json", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert sorted(path.name for path in (tmp_path / "out" / "deep").iterdir()) == ["a.json", "b.json"]


def test_the_good_ones_are_written_and_the_bad_ones_named(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """One bad design does not cost the others."""
    designs = {"a": SEGMENT, "bad": "schema = 1\n", "touching": TOUCHING, "z": SEGMENT}
    for name, text in designs.items():
        (tmp_path / f"{name}.toml").write_text(text)
    result = voronoi_tiles("export", *(f"{name}.toml" for name in designs), "missing.toml", "-o", "out", cwd=tmp_path)
    assert result.returncode == 2
    errors = [line for line in result.stderr.splitlines() if line.startswith("Error")]
    assert [name in line for name, line in zip(("bad", "touching", "missing"), errors, strict=True)] == [True] * 3
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a.svg", "z.svg"]


def test_a_failed_proof_is_exit_code_1_and_no_file(tmp_path: Path) -> None:
    """The command line takes the exit code from the error, and writes nothing."""
    (tmp_path / "a.toml").write_text(SEGMENT)
    (tmp_path / "a.svg").write_text("old")
    script = (
        "import sys, voronoi_tiles.tiling as tiling\n"
        "from voronoi_tiles.cli.main import run\n"
        "from voronoi_tiles.base.errors import ProofError\n"
        "def fail(design):\n    raise ProofError('the area is wrong')\n"
        "tiling.tessellate = fail\n"
        "sys.argv[1:] = ['export', 'a.toml', '-o', 'a.svg']\n"
        "run()\n"
    )
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert complaint(result, code=1) == "Error: a.toml: the area is wrong."
    assert (tmp_path / "a.svg").read_text() == "old"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "Missing argument"),
        (["bird.toml"], "Missing option '-o'"),
        (["bird.toml", "-o", "out.dxf9"], ".pdf or .lbrn2 or .gcode, or --format."),
        (["bird.toml", "-o", "out.svg", "--format", "json"], "contradict each other"),
        (["", "-o", "out.svg"], "the name of the design is empty"),
        (["bird.toml", "-o", "out"], ".svg or .json"),
        (["bird.toml", "-o", "out.svg", "--format", "png"], "png"),
        (["bird.toml", "bird.toml", "-o", "out"], "Two designs would be written to bird.svg"),
        (["bird.toml", "b.toml", "-o", "out.svg"], "need a folder"),
        (["bird.toml", "b.toml", "-o", "b.toml"], "need a folder"),
        (["bird.toml", "b.toml", "-o", "-"], "need a folder"),
        (["-", "-", "-o", "out"], "once"),
        (["bird.toml", "-o", "bird.toml", "--format", "svg"], "would be overwritten"),
        (["b.json", "-o", ".", "--format", "json"], "would be overwritten"),
        (["missing.toml", "-o", "out.svg"], "missing.toml"),
        ([".", "-o", "out.svg"], "."),
        (["bird.toml", "-o", "missing/out.svg"], "cannot write"),
        (["bird.toml", "-o", "b.toml/out.svg"], "cannot write"),
        (["bird.toml", "-o", "/proc/out.svg"], "cannot write"),
        (["bird.toml", "-o", "", "--format", "svg"], "is empty"),
        (["bird.toml", "-o", "/dev/full", "--format", "svg"], "No space left on device"),
        (["bird.toml", "b.toml", "--colour"], "--colour"),
    ],
)
def test_wrong_usage(
    arguments: list[str], message: str, voronoi_tiles: CommandLine, design: Path, tmp_path: Path
) -> None:
    """One message that says what is wrong; nothing is written, nothing is changed."""
    (tmp_path / "b.toml").write_text(SEGMENT)
    (tmp_path / "b.json").write_text("{}")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert message in complaint(voronoi_tiles("export", *arguments, cwd=tmp_path))
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    assert design.exists()


BAD_DESIGNS = {
    "empty": ("", "schema"),
    "not toml": ("group = = 3", "line 1"),
    "binary": ("\x00\x01\x02", ""),
    "schema": (SEGMENT.replace("schema = 1", "schema = 2"), "schema"),
    "group": (SEGMENT.replace('"p4"', '"p5"'), "p5"),
    "key": (SEGMENT.replace("name", "nmae"), "nmae"),
    "type": (SEGMENT.replace("60.0", '"60"'), "cell.a"),
    "boolean": (SEGMENT.replace("60.0", "true"), "cell.a"),
    "nan": (SEGMENT.replace("25,", "nan,"), "site[0].strokes[0].segment"),
    "infinite": (SEGMENT.replace("25,", "inf,"), "site[0].strokes[0].segment"),
    "zero cell": (SEGMENT.replace("60.0", "0.0"), "cell.a"),
    "negative cell": (SEGMENT.replace("60.0", "-1.0"), "cell.a"),
    "absurd": (SEGMENT.replace("60.0", "1e308"), "cell.a"),
    "angle": (SEGMENT.replace("[[site]]", "angle = 75.0\n[[site]]"), "angle"),
    "no strokes": (SEGMENT.replace("{ segment = [[5, 3], [25, 11]] }", ""), "strokes"),
    "zero length": (SEGMENT.replace("[25, 11]", "[5, 3]"), "site[0].strokes[0].segment"),
    "touching": (TOUCHING, "bird"),
}


@pytest.mark.parametrize("case", BAD_DESIGNS)
def test_bad_designs(case: str, voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """Exit code 2, one message with the file and the key, and an existing file untouched."""
    text, key = BAD_DESIGNS[case]
    (tmp_path / "bird.toml").write_text(text)
    (tmp_path / "out.svg").write_text("old")
    message = complaint(voronoi_tiles("export", "bird.toml", "-o", "out.svg", cwd=tmp_path))
    assert "bird.toml" in message
    assert key in message
    assert "bug" not in message
    assert (tmp_path / "out.svg").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bird.toml", "out.svg"]


def script(body: str, *arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run the command line after a preparation that stands for a hostile world."""
    code = f"import sys\n{body}\nfrom voronoi_tiles.cli.main import run\nsys.argv[1:] = {list(arguments)!r}\nrun()\n"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=cwd)


BATCH = ("a.toml", "bad.toml", "z.toml")


@pytest.mark.parametrize(
    ("failure", "code", "message"),
    [
        ("MemoryError()", 2, "Error: bad.toml: there is not enough memory for this design. Allow larger tolerances"),
        ("RuntimeError('odd')", 70, "Error: bad.toml: RuntimeError: odd. This is a bug"),
    ],
)
def test_no_failure_loses_the_batch(failure: str, code: int, message: str, tmp_path: Path) -> None:
    """Neither a lack of memory nor a bug in one design costs the others; it is named."""
    for name in BATCH:
        (tmp_path / name).write_text(SEGMENT)
    body = (
        "import voronoi_tiles.tiling as tiling\nreal = tiling.tessellate\n"
        f"def fail(design):\n    if design.name == 'bad':\n        raise {failure}\n    return real(design)\n"
        "tiling.tessellate = fail\n"
    )
    result = script(body, "export", *BATCH, "-o", "out", "-q", cwd=tmp_path)
    assert result.returncode == code
    (line,) = result.stderr.splitlines()
    assert line.startswith(message)
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a.svg", "z.svg"]
    assert complaint(script(body, "info", "bad.toml", cwd=tmp_path), code).startswith(message)


def test_an_unreadable_file_does_not_lose_the_batch(tmp_path: Path) -> None:
    """Nor does a folder that may be written and not read: nothing is tested before the program runs."""
    for name in BATCH:
        (tmp_path / name).write_text(SEGMENT)
    (tmp_path / "out").mkdir()
    body = (
        "import builtins, os\nos.access = lambda *_, **__: False\nreal = builtins.open\n"
        "def refuse(name, *a, **k):\n"
        "    if name == 'bad.toml':\n        raise PermissionError(13, 'Permission denied')\n"
        "    return real(name, *a, **k)\n"
        "builtins.open = refuse\n"
    )
    result = script(body, "export", *BATCH, "-o", "out", "-q", cwd=tmp_path)
    assert result.returncode == 2
    (line,) = result.stderr.splitlines()
    assert line.startswith("Error: bad.toml: cannot read the design: Permission denied. Check")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a.svg", "z.svg"]


@pytest.mark.parametrize("name", ["a", "t", "bird", "copies"])
def test_the_file_is_named_once(name: str, voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """Also where its name is a word of the message."""
    (tmp_path / name).write_text(TOUCHING)
    message = complaint(voronoi_tiles("export", name, "-o", "out.svg", cwd=tmp_path))
    assert message.startswith(f'Error: {name}: site "bird" touches')
    (tmp_path / name).write_text("schema = 2")
    assert complaint(voronoi_tiles("info", name, cwd=tmp_path)).startswith(f"Error: {name}, schema: ")
    (tmp_path / name).write_text(SEGMENT)
    message = complaint(voronoi_tiles("export", name, "-o", "none/out.svg", cwd=tmp_path))
    assert message.startswith(f"Error: {name}: cannot write none/out.svg: No such file or directory. Make its folder")


def test_names_that_are_no_text(voronoi_tiles: CommandLine, command: str, tmp_path: Path) -> None:
    """Control characters and bytes that are not UTF-8 are escaped, in messages and in tables."""
    odd = "a\n\x1b[31m.toml"
    (tmp_path / odd).write_text("schema = 2")
    assert complaint(voronoi_tiles("info", odd, cwd=tmp_path)).startswith(r"Error: a\n\x1b[31m.toml, schema: ")
    name = b"\xffb\n.toml"
    Path(os.fsdecode(os.fsencode(tmp_path) + b"/" + name)).write_text(SEGMENT)
    for arguments, stream in (((b"info", name), "stdout"), ((b"export", name, b"-o", b"."), "stderr")):
        result = subprocess.run(
            [os.fsencode(command), *arguments], capture_output=True, text=True, check=False, cwd=tmp_path
        )
        assert result.returncode == 0, result.stderr
        assert r"\xffb\n" in getattr(result, stream)
    asked = [os.fsencode(command), b"info", b"--json", name]
    assert json.loads(subprocess.run(asked, capture_output=True, check=True, cwd=tmp_path).stdout)["group"] == "p4"


def test_messages_end_with_a_full_stop(voronoi_tiles: CommandLine, design: Path, tmp_path: Path) -> None:
    """Ours and click's alike, with what to do."""
    for arguments in (
        ("export", design),
        ("export", design, "--colour"),
        ("export", design, "-o", "none/a.svg"),
        ("export", design, "-o", "a.png"),
        ("info", "none.toml"),
        ("new", "p4", "-o", design),
        ("new", "p4", "-o", ""),
        ("completion",),
        ("completion", "tcsh"),
        ("infos",),
    ):
        assert complaint(voronoi_tiles(*arguments, cwd=tmp_path)).endswith((".", "--help'."))
    assert "cannot write '': the name is empty" in complaint(voronoi_tiles("new", "p4", "-o", ""))


POSIX = pytest.mark.skipif(sys.platform == "win32", reason="a POSIX shell")


def shell(line: str, command: str, cwd: Path, interpreter: str = "sh") -> subprocess.CompletedProcess[str]:
    """Run a line of shell in which $0 is the command."""
    return subprocess.run(
        [interpreter, "-c", line, command], capture_output=True, text=True, check=False, cwd=cwd, timeout=60
    )


@POSIX
@pytest.mark.parametrize(
    "line",
    ["export bird.toml -o -", "info bird.toml", "info --json bird.toml", "--help", "--version", "new p4", "new --help"],
)
def test_a_closed_standard_output(line: str, command: str, design: Path) -> None:
    """One message, exit code 2."""
    message = complaint(shell(f'"$0" {line} >&-', command, design.parent))
    assert "cannot write standard output: it is closed. " in message


@POSIX
def test_files_are_written_with_all_streams_closed(command: str, design: Path) -> None:
    """Standard output, or all three: what goes to a file is not concerned."""
    assert shell('"$0" export bird.toml -o a.svg >&-', command, design.parent).returncode == 0
    assert shell('"$0" export bird.toml -o b.svg <&- >&- 2>&-', command, design.parent).returncode == 0
    assert (design.parent / "a.svg").read_bytes() == (design.parent / "b.svg").read_bytes()


@POSIX
def test_a_closed_standard_input(command: str, tmp_path: Path) -> None:
    """One message, exit code 2."""
    message = complaint(shell('"$0" export - -o o.svg <&-', command, tmp_path))
    assert message.startswith("Error: standard input: cannot read the design: it is closed. ")


@POSIX
def test_a_closed_standard_error(command: str, tmp_path: Path) -> None:
    """The exit code is all that is left."""
    assert shell('"$0" info none.toml 2>&-', command, tmp_path).returncode == 2


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="open descriptors have no names")
def test_pipes_by_their_names(command: str, design: Path) -> None:
    """/dev/stdout and >(command) are written as they are; so is a file that standard output is appended to."""
    folder = design.parent
    expected = shell('"$0" export bird.toml -o -', command, folder).stdout
    line = '"$0" export bird.toml -o /dev/stdout --format svg'
    result = shell(f"{line} | cat", command, folder)
    assert (result.stdout, result.stderr) == (expected, "wrote /dev/stdout\n")
    shell(f"echo first >log; {line} >>log", command, folder)
    assert (folder / "log").read_text() == f"first\n{expected}"
    if shutil.which("bash"):
        line = '"$0" export bird.toml -q --format svg -o >(cat)'
        result = shell(f"{line} | cat", command, folder, "bash")
        assert (result.stdout, result.stderr) == (expected, "")
    assert shell('"$0" new p4 -o /dev/stdout | cat', command, folder).stdout == starter_text("p4")


def test_standard_input_is_named_in_messages(voronoi_tiles: CommandLine) -> None:
    """Where there is no file, the message says so."""
    assert "standard input" in complaint(voronoi_tiles("export", "-", "-o", "-", stdin="schema = 3"))
    assert "standard input" in complaint(voronoi_tiles("info", "-", stdin=TOUCHING))


# --- info ---


def test_info_prints_a_table(voronoi_tiles: CommandLine, design: Path) -> None:
    """Group, cell, tile, neighbours, proof, for people."""
    result = voronoi_tiles("info", design)
    assert (result.returncode, result.stderr) == (0, "")
    for word in ("p4", "bird", "900", "area", "perimeter", "parabolas", "curved", "Neighbours", "Proof", "ok"):
        assert word in result.stdout
    assert "\x1b" not in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 110


def test_info_json(voronoi_tiles: CommandLine, design: Path) -> None:
    """The same figures, for programs; they add up."""
    figures = json.loads(voronoi_tiles("info", design, "--json").stdout)
    assert (figures["group"], figures["order"], figures["cell"]["area"]) == ("p4", 4, 3600.0)
    (tile,) = figures["tiles"]
    assert tile["area"] == pytest.approx(900.0, rel=1e-12)
    assert tile["symmetry"] == ["x,y"]
    drawn = ET.fromstring(voronoi_tiles("export", design, "-o", "-").stdout).find(".//{*}path")
    assert drawn is not None
    left, top, right, bottom = svgelements.Path(drawn.get("d")).bbox()
    assert (tile["width"], tile["height"]) == pytest.approx((right - left, bottom - top), abs=1e-9)
    assert 0 < tile["curved_share"] < 1
    assert sum(other["edges"] for other in tile["neighbours"]) == sum(tile["edges"].values())
    assert sum(other["length"] for other in tile["neighbours"]) == pytest.approx(tile["perimeter"], rel=1e-12)
    assert figures["proof"]
    assert all(row["passed"] for row in figures["proof"])


def test_info_of_an_odd_name(voronoi_tiles: CommandLine) -> None:
    """A name is not markup."""
    result = voronoi_tiles("info", "-", stdin=SEGMENT.replace('"bird"', '"[red]b[/]"'))
    assert "[red]b[/]" in result.stdout


# --- new ---


@pytest.mark.parametrize("group", GROUP_NAMES)
def test_new_and_export(group: str, voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """A starter design exports as it is, by the command that its first lines show."""
    result = voronoi_tiles("new", group, "-o", f"{group}.toml", cwd=tmp_path)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    assert voronoi_tiles("new", "p4", "-o", "bird.toml", cwd=tmp_path).returncode == 0
    assert "export bird.toml -o bird.svg" in (tmp_path / "bird.toml").read_text()
    assert voronoi_tiles("new", group).stdout == (tmp_path / f"{group}.toml").read_text() == starter_text(group)
    shown = starter_text(group).splitlines()[1].split("voronoi-tiles ")[1].split()
    assert voronoi_tiles(*shown, cwd=tmp_path).returncode == 0
    assert (tmp_path / f"{group}.svg").exists()


def test_new_refuses(voronoi_tiles: CommandLine, design: Path) -> None:
    """An unknown group, with those that there are; and to overwrite a design."""
    assert "p31m" in complaint(voronoi_tiles("new", "p5"))
    assert "exists already" in complaint(voronoi_tiles("new", "p4", "-o", design))
    assert design.read_text() == SEGMENT


# --- the world around ---


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion(shell: str, voronoi_tiles: CommandLine) -> None:
    """The scripts name the command."""
    result = voronoi_tiles("completion", shell)
    assert result.returncode == 0
    assert "_VORONOI_TILES_COMPLETE" in result.stdout
    assert "voronoi-tiles" in result.stdout


def test_completion_knows_commands_and_groups(command: str) -> None:
    """What the shell asks for while one types."""
    for words, expected in (("voronoi-tiles ex", "export"), ("voronoi-tiles new p31", "p31m")):
        asked = {"_VORONOI_TILES_COMPLETE": "bash_complete", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
        result = subprocess.run([command], env={**os.environ, **asked}, capture_output=True, text=True, check=False)
        assert f"plain,{expected}" in result.stdout


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a Linux device")
@pytest.mark.parametrize("arguments", [["--help"], ["new", "p4"], ["info", "{}"], ["export", "{}", "-o", "-"]])
def test_a_full_standard_output(arguments: list[str], command: str, design: Path) -> None:
    """One message, exit code 2."""
    with Path("/dev/full").open("w") as full:
        result = subprocess.run(
            [command, *(word.format(design) for word in arguments)],
            stdout=full, stderr=subprocess.PIPE, text=True, check=False,
        )  # fmt: skip
    assert result.returncode == 2
    (line,) = result.stderr.splitlines()
    assert "No space left on device" in line


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_a_reader_that_goes_away_ends_us_silently(command: str) -> None:
    """As with other commands in a pipe."""
    process = subprocess.Popen([command, "new", "p4"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    assert process.stderr.read() == b""
    assert process.wait() == -signal.SIGPIPE
    process.stderr.close()


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.usefixtures("heard_signals")
def test_an_interruption(command: str, tmp_path: Path) -> None:
    """Ctrl-C gives one word and the exit code that shells expect."""
    fifo = tmp_path / "design.toml"
    os.mkfifo(fifo)
    process = subprocess.Popen([command, "export", fifo, "-o", tmp_path / "a.svg"], stderr=subprocess.PIPE, text=True)
    with fifo.open("w"):  # opens when the command has opened its end: it waits for the design now
        time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        _, message = process.communicate(timeout=30)
    assert process.returncode == 130
    assert message.split() == ["Interrupted."]
    assert [path.name for path in tmp_path.iterdir()] == ["design.toml"]


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.parametrize("ignored", [signal.SIGINT, signal.SIGHUP])
def test_what_is_started_to_ignore_a_signal_does(ignored: signal.Signals, command: str, tmp_path: Path) -> None:
    """Under nohup, or in the background of a script, a command goes on where it would be ended else."""
    fifo = tmp_path / "design.toml"
    os.mkfifo(fifo)
    call = [f'trap \'\' {ignored.value}; exec "$0" "$@"', command, "info", str(fifo)]
    process = subprocess.Popen(["/bin/sh", "-c", *call], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    with fifo.open("w") as design:
        process.send_signal(ignored)
        design.write(SEGMENT)
    printed, message = process.communicate(timeout=60)
    assert (process.returncode, message) == (0, "")
    assert "bird" in printed


def test_a_bug_is_one_message_too(tmp_path: Path) -> None:
    """What nobody foresaw is no traceback either, unless it is asked for."""
    script = (
        "import sys, voronoi_tiles.designs.starters as starters\n"
        "from voronoi_tiles.cli.main import run\n"
        "starters.starter_text = lambda group: 1 / 0\n"
        "sys.argv[1:] = ['new', 'p4']\n"
        "run()\n"
    )
    call = [sys.executable, "-c", script]
    result = subprocess.run(call, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert "bug" in complaint(result, code=70)
    debug = {**os.environ, "VORONOI_TILES_DEBUG": "1"}
    assert "Traceback" in subprocess.run(call, capture_output=True, text=True, check=False, env=debug).stderr


def test_a_name_with_backquotes_stays_a_name(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """Arguments in messages become options, but not what looks like one in the name of a file."""
    (tmp_path / "`kerf`.toml").write_text("schema = 1\n")
    said = complaint(voronoi_tiles("info", "`kerf`.toml", cwd=tmp_path))
    assert said.startswith("Error: `kerf`.toml, group: ")

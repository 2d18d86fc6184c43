"""`voronoi-tiles inkscape`: entries that are written, looked after and removed; launchers that start this Python."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from helpers.inkscape_drawings import OBJECTS, PAGES, run
from helpers.outlines import CommandLine

from voronoi_tiles.inkscape import found_inkscape
from voronoi_tiles.inkscape.installation import own_files
from voronoi_tiles.inkscape.launcher import environment

FILES = {name for entry in ("tiles", "sheet", "strokes", "open") for name in (f"{entry}.inx", f"run_{entry}.py")}

DRAWING = PAGES[0].svg(OBJECTS["cubics"].element)
WORDS = ("--id=cubics", "--group=p1", "--cell=numbers", "--side_a=120")


def script(path: Path, text: str) -> Path:
    """A program."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)
    return path


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A machine without any Inkscape, and the home of somebody who has installed none."""
    for name in ("INKSCAPE_PROFILE_DIR", "XDG_CONFIG_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setattr(found_inkscape, "FLATPAK_HOMES", (str(tmp_path / "flatpak"),))
    monkeypatch.setattr(found_inkscape, "SNAP_HOMES", (str(tmp_path / "snap"),))
    (tmp_path / "home").mkdir()
    return tmp_path / "home"


def test_entries_are_installed_looked_after_and_removed(tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """What is there is said; exit code 1 where something is wrong; nothing is left."""
    there = ("--into", tmp_path / "extensions")
    folder = tmp_path / "extensions" / "voronoi-tiles"
    done = voronoi_tiles("inkscape", "status", *there)
    assert (done.returncode, done.stdout) == (
        1,
        f'Not installed in {there[1]}. Run "voronoi-tiles inkscape install".\n',
    )
    done = voronoi_tiles("inkscape", "install", *there)
    assert done.returncode == 0
    *written, last = done.stderr.splitlines()
    assert written == [f"wrote {folder / path.name}" for path in map(Path, written)]
    assert last.startswith("Start Inkscape anew")
    assert {path.name for path in folder.iterdir()} == FILES == {Path(line).name for line in written}
    done = voronoi_tiles("inkscape", "status", *there)
    assert (done.returncode, done.stdout) == (0, f"Installed in {folder}, for this Python.\n")
    (folder / "mine.txt").write_text("keep", encoding="utf-8")
    done = voronoi_tiles("inkscape", "remove", *there)
    assert (done.returncode, len(done.stderr.splitlines())) == (0, len(FILES))
    assert [path.name for path in folder.iterdir()] == ["mine.txt"]
    done = voronoi_tiles("inkscape", "remove", *there)
    assert (done.returncode, done.stderr) == (0, f"nothing of voronoi-tiles is in {there[1]}\n")


def test_what_is_broken_is_named_and_mended(tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """A file that is gone, one that was changed, another Python; and what a version before has left."""
    there, folder = ("--into", tmp_path), tmp_path / "voronoi-tiles"
    voronoi_tiles("inkscape", "install", *there)
    (folder / "sheet.inx").unlink()
    for name, data in own_files("/gone/python", {}).items():
        if name == "run_open.py":
            (folder / name).write_bytes(data)
    old = folder / "old.inx"
    old.write_bytes((folder / "tiles.inx").read_bytes())
    (folder / "tiles.inx").write_bytes((folder / "tiles.inx").read_bytes().replace(b"p4g", b"p4h"))
    done = voronoi_tiles("inkscape", "status", *there)
    assert done.returncode == 1
    assert done.stdout.splitlines() == [
        "sheet.inx is missing.",
        f"run_open.py starts /gone/python, which is not there; this is {sys.executable}.",
        "tiles.inx is not as this version writes it.",
        'Run "voronoi-tiles inkscape install" once more.',
    ]
    voronoi_tiles("inkscape", "install", *there)
    assert not old.exists()
    assert voronoi_tiles("inkscape", "status", *there).returncode == 0


@pytest.mark.parametrize("kind", ["foreign", "no folder", "read only"])
def test_nothing_is_written_where_not_all_can_be(kind: str, tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """Somebody else's file of our name, a file in the place of the folder, a file that may not be replaced."""
    folder = tmp_path / "voronoi-tiles"
    if kind == "no folder":
        folder.write_text("", encoding="utf-8")
    else:
        folder.mkdir()
        (folder / "run_open.py").write_text("print()", encoding="utf-8")
        if kind == "read only":
            (folder / "run_open.py").unlink()
            (folder / "run_open.py").symlink_to("/dev/full/none")
    before = sorted(folder.iterdir()) if folder.is_dir() else []
    done = voronoi_tiles("inkscape", "install", "--into", tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("Error: ")
    assert done.stderr.count("\n") == 1
    assert (sorted(folder.iterdir()) if folder.is_dir() else []) == before


def test_inkscape_is_asked_where_its_folder_is(home: Path, voronoi_tiles: CommandLine) -> None:
    """Its answer counts, and its version is said."""
    script(
        home.parent / "bin" / "inkscape",
        f'case "$1" in --user-data-directory) echo {home}/else where;; --version) echo Inkscape 9.9;; *) exit 3;; esac',
    )
    assert found_inkscape.found_inkscape().extensions == home / "else where" / "extensions"
    changes = {name: os.environ[name] for name in ("PATH", "HOME")}
    assert voronoi_tiles("inkscape", "install", environment=changes).returncode == 0
    assert (home / "else where" / "extensions" / "voronoi-tiles" / "tiles.inx").exists()
    done = voronoi_tiles("inkscape", "status", environment=changes)
    assert done.stdout.startswith("Inkscape 9.9\nInstalled in ")


def test_a_folder_that_an_appimage_has_left_is_found(home: Path) -> None:
    """Without a program: the usual one, or the one that the environment names."""
    usual = home / ".config" / "inkscape"
    usual.mkdir(parents=True)
    assert found_inkscape.found_inkscape() == (None, usual / "extensions")


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        ("none", "no Inkscape is found. Install it (sudo apt install inkscape). Or name its folder of extensions"),
        ("snap", "the Inkscape of Snap runs in a sandbox, in which it cannot start the Python that has voronoi-tiles."),
        ("flatpak", "the Inkscape of Flatpak runs in a sandbox, in which it cannot start the Python"),
    ],
)
def test_sandboxes_are_explained(kind: str, message: str, home: Path, voronoi_tiles: CommandLine) -> None:
    """Snap's and Flatpak's cannot start us: it says so, and what can be done."""
    if kind == "snap":
        snap = script(home.parent / "usr" / "snap", "exit 1")
        (home.parent / "bin").mkdir()
        (home.parent / "bin" / "inkscape").symlink_to(snap)
    if kind == "flatpak":
        (home.parent / "flatpak" / found_inkscape.FLATPAK).mkdir(parents=True)
    with pytest.raises(ValueError, match=r"Inkscape") as refused:
        found_inkscape.found_inkscape()
    assert str(refused.value).startswith(message)
    if kind != "flatpak":
        changes = {name: os.environ[name] for name in ("PATH", "HOME")}
        done = voronoi_tiles("inkscape", "install", environment=changes)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1)
        assert "--into DIR" in done.stderr


@pytest.mark.parametrize(
    ("folder", "name"),
    [(".var/app/org.inkscape.Inkscape/config/inkscape", "Flatpak"), ("snap/inkscape/10/.config/inkscape", "Snap")],
)
def test_a_script_that_starts_one_in_a_sandbox_is_seen_through(
    folder: str, name: str, home: Path, voronoi_tiles: CommandLine
) -> None:
    """By the folder that it says; where that is named all the same it is written to, and what will be is said."""
    script(home.parent / "bin" / "inkscape", f"echo {home}/{folder}")
    with pytest.raises(ValueError, match=rf"^the Inkscape of {name} runs in a sandbox"):
        found_inkscape.found_inkscape()
    done = voronoi_tiles("inkscape", "install", "--into", home / folder / "extensions")
    assert done.returncode == 0
    assert f"is that of the Inkscape of {name}, which cannot use this" in done.stderr.splitlines()[0]


def started(
    folder: Path, kind: str, *words: str, variables: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[bytes]:
    """Start a launcher as Inkscape does: in its folder, by a Python of its own."""
    call = [sys.executable, f"run_{kind}.py", *words]
    leaked = {**os.environ, **(variables or {})}
    return subprocess.run(call, capture_output=True, check=False, cwd=folder, env=leaked, timeout=60)


def installed(folder: Path, python: str = sys.executable, libraries: Mapping[str, str] | None = None) -> Path:
    """The files of ours in a folder."""
    for name, data in own_files(python, libraries or {}).items():
        (folder / name).write_bytes(data)
    return folder


def test_a_launcher_is_not_misled_by_what_inkscape_leaks(tmp_path: Path) -> None:
    """Modules of our names on PYTHONPATH, another home of Python, startup files: the drawing comes all the same."""
    trap = tmp_path / "trap"
    for name in ("numpy", "voronoi_tiles", "click", "usercustomize"):
        (trap / name).mkdir(parents=True)
        (trap / name / "__init__.py").write_text("raise SystemExit('trapped')", encoding="utf-8")
    file = tmp_path / "drawing.svg"
    expected = run(DRAWING, *WORDS, folder=tmp_path)
    leaks = {
        "PYTHONPATH": str(trap),
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTHONIOENCODING": "latin-1",
        "PYTHONWARNINGS": "error",
    }
    done = started(installed(tmp_path), "tiles", *WORDS, str(file), variables=leaks)
    assert (done.returncode, done.stderr, done.stdout) == (0, b"", expected)


def test_libraries_are_those_of_the_installation() -> None:
    """What an AppImage or a bundle sets for itself is dropped; what we were installed with is set."""
    found = {"PYTHONHOME": "/a", "PYTHONPATH": "/b", "LD_LIBRARY_PATH": "/c", "DYLD_LIBRARY_PATH": "/d", "HOME": "/e"}
    assert environment(found) == {"HOME": "/e"}
    text = own_files("/p", {"LD_LIBRARY_PATH": "/mine"})["run_tiles.py"].decode()
    assert "\nLIBRARIES = {'LD_LIBRARY_PATH': '/mine'}" in text


@pytest.mark.parametrize("kind", ["no python", "no package"])
def test_a_broken_installation_says_what_to_run(kind: str, tmp_path: Path) -> None:
    """The Python has gone, or voronoi-tiles with its environment: a sentence, nothing on standard output."""
    python = tmp_path / "python"
    if kind == "no package":
        # A Python that has none of the installed packages: the same without its site.
        script(python, f'exec {sys.executable} -S "$@"')
    done = started(installed(tmp_path, str(python)), "tiles", *WORDS, "a.svg")
    assert done.returncode != 0
    assert done.stdout == b""
    message = done.stderr.decode()
    assert "Traceback" not in message
    assert message.count("\n") == 1
    assert 'Run "voronoi-tiles inkscape install" once more' in message
    if kind == "no python":
        done = started(tmp_path, "tiles", *WORDS, "a.svg", variables={"FLATPAK_ID": "org.inkscape.Inkscape"})
        assert "This Inkscape runs in a sandbox" in done.stderr.decode()


def test_errors_are_sentences(tmp_path: Path) -> None:
    """On standard error, with the exit codes of the command line; standard output stays empty, and so the drawing."""
    folder = installed(tmp_path)
    (tmp_path / "a.svg").write_bytes(DRAWING)
    cases = {
        ("tiles", "a.svg"): (2, "nothing is selected. Select the strokes"),
        ("tiles", "--id=cubics", "--line_width=wide", "a.svg"): (
            2,
            "\"line width\" 'wide' cannot be. Give a number of millimetres",
        ),
        ("tiles", "--id=cubics", "none.svg"): (2, "none.svg: cannot be read: No such file or directory."),
        ("tiles",): (2, "this is for Inkscape to call, with one drawing. See its menu Extensions."),
        ("open", "a.svg"): (2, "a.svg: is a drawing, not a design."),
        ("strokes", "a.svg"): (2, "the drawing does not say which design it was made from. Open a file that"),
    }
    for (kind, *words), (code, text) in cases.items():
        done = started(folder, kind, *words)
        assert (done.returncode, done.stdout) == (code, b"")
        assert done.stderr.decode().startswith(text)
        assert done.stderr.count(b"\n") == 1

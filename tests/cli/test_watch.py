"""The command `watch`: files follow their design, errors are said, and Ctrl-C ends it."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from helpers.outlines import CommandLine
from test_cli import SEGMENT, TOUCHING, complaint

import voronoi_tiles as vt
from voronoi_tiles.designs.named_files import named_files

FACE = '<svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm" viewBox="0 0 9 9"><path d="M1 1 8 {}"/></svg>'


class Watching:
    """A running command with what it has said so far."""

    def __init__(self, command: str, *arguments: str, cwd: Path, ignored: bool = False) -> None:
        self.said = cwd / "said.txt"
        call = [command, "watch", *arguments, "--size", "40", "--renderer", "cpu"]
        if ignored:  # as a shell without job control starts what runs in the background
            call = ["/bin/sh", "-c", 'trap "" INT; exec "$0" "$@"', *call]
        with self.said.open("w") as said:
            self.process = subprocess.Popen(call, stderr=said, cwd=cwd)
        self.seen = 0

    def until(self, reached: Callable[[], bool]) -> None:
        """Wait for something, for three minutes at most: the machine may be busy."""
        end = time.monotonic() + 180
        while not reached():
            assert self.process.poll() is None, self.said.read_text()
            assert time.monotonic() < end, self.said.read_text()
            time.sleep(0.05)

    def next(self, word: str) -> str:
        """The next line that holds a word, when it is said."""
        found: list[str] = []

        def reached() -> bool:
            lines = self.said.read_text().splitlines(keepends=True)
            for k in range(self.seen, len(lines)):
                if word in lines[k] and lines[k].endswith("\n"):
                    self.seen = k + 1
                    found.append(lines[k])
                    return True
            return False

        self.until(reached)
        return found[0]

    def end(self, number: signal.Signals) -> int:
        """Send a signal, and give the exit code."""
        self.process.send_signal(number)
        return self.process.wait(timeout=180)


@pytest.fixture
def watching(command: str, tmp_path: Path) -> Iterator[Callable[..., Watching]]:
    """Start the command in a folder; it is ended in any case."""
    started: list[Watching] = []

    def start(*arguments: str, ignored: bool = False) -> Watching:
        started.append(Watching(command, *arguments, cwd=tmp_path, ignored=ignored))
        return started[-1]

    yield start
    for run in started:
        run.process.kill()
        run.process.wait()


def replaced(path: Path, text: str) -> None:
    """Save as editors do: by renaming a file that is whole."""
    new = path.with_suffix(".new")
    new.write_text(text)
    new.replace(path)


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.usefixtures("heard_signals")
def test_files_follow_the_design(watching: Callable[..., Watching], tmp_path: Path) -> None:
    """From the first version to the last: saved, broken, mended, touching, with art that changes; then Ctrl-C."""
    design, tile, picture = (tmp_path / name for name in ("bird.toml", "bird.svg", "bird.png"))
    design.write_text(SEGMENT)
    run = watching("bird.toml")
    assert run.next("wrote").split(" ", 1)[1].startswith("wrote bird.png, bird.svg in ")
    assert tile.read_text() == vt.Design.load(design).tessellate().svg()
    first = picture.read_bytes()
    replaced(design, SEGMENT.replace("[25, 11]", "[22, 14]"))
    run.next("wrote")
    saved = vt.Design.load(design).tessellate().svg()
    assert tile.read_text() == saved
    assert picture.read_bytes() != first
    design.write_text(SEGMENT.replace("segment", "segmet"))
    assert "Error: bird.toml, site[0]" in run.next("segmet")
    assert tile.read_text() == saved
    design.write_text(TOUCHING)
    assert "wrote bird.png in " in run.next("wrote")
    assert "touches its own copy" in run.next("Error")
    assert b"touches its own copy" in picture.read_bytes()
    assert tile.read_text() == saved
    face = tmp_path / "face.svg"
    face.write_text(FACE.format(3))
    design.write_text(SEGMENT.replace("name", 'art = "face.svg"\nname'))
    run.next("wrote")
    assert tile.read_text() != saved
    saved = tile.read_text()
    replaced(face, FACE.format(5))
    run.next("wrote")
    assert tile.read_text() != saved
    assert run.end(signal.SIGINT) == 0
    said = run.said.read_text()
    assert said.splitlines()[-1] == "no longer watching bird.toml"
    assert len([line for line in said.splitlines() if "Error" in line]) == 2
    assert "Traceback" not in said
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".png", ".svg", ".svg", ".toml", ".txt"]


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.usefixtures("heard_signals")
def test_a_background_job_is_ended_by_its_own_signal(watching: Callable[..., Watching], tmp_path: Path) -> None:
    """Where Ctrl-C is for others SIGTERM ends it. It writes what it is told to, and takes the options of a job."""
    (tmp_path / "bird.toml").write_text(SEGMENT)
    (tmp_path / "mine.dxf").write_text("old")
    run = watching("bird.toml", "-o", "mine.dxf", "--sheet", "200x150mm", "--kerf", "0.1mm", ignored=True)
    assert "wrote mine.dxf (" in run.next("wrote")
    assert (tmp_path / "mine.dxf").stat().st_size > 10_000
    run.process.send_signal(signal.SIGINT)
    (tmp_path / "bird.toml").write_text(SEGMENT.replace("[25, 11]", "[22, 14]"))
    run.next("wrote")
    assert run.end(signal.SIGTERM) == 143
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bird.toml", "mine.dxf", "said.txt"]


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.usefixtures("heard_signals")
def test_a_summary_names_options(watching: Callable[..., Watching], tmp_path: Path) -> None:
    """A smaller gap is named as on the command line, not as an argument of Python."""
    (tmp_path / "bird.toml").write_text(vt.starter_text("p4"))
    sheet = ("--sheet", "300x200mm", "--margin", "6mm", "--kerf", "0.15mm")
    run = watching("bird.toml", "-o", "bird.svg", *sheet)
    assert "; with --gap 0.5mm 50 tiles would fit)" in run.next("wrote")
    assert run.end(signal.SIGINT) == 0


def test_files_of_others_are_not_written_over(voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """Neither drawings nor what another program has made of ours, unless they are named; the message says how."""
    (tmp_path / "bird.toml").write_text(SEGMENT)
    tiling = vt.Design.load(tmp_path / "bird.toml").tessellate()
    for name, text in (
        ("bird.svg", FACE.format(3)),
        ("bird.svg", tiling.svg().replace("<svg ", '<svg xmlns:sodipodi="urn:x" sodipodi:docname="a" ')),
        ("bird.png", "no picture"),
    ):
        (tmp_path / name).write_text(text)
        message = complaint(voronoi_tiles("watch", "bird.toml", cwd=tmp_path))
        assert f"{name} is there already" in message
        assert "-o bird-tile.png -o bird-tile.svg" in message
        assert (tmp_path / name).read_text() == text
        (tmp_path / name).unlink()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["-"], "Only a file can be watched"),
        (["none.toml"], "no file 'none.toml'"),
        ([""], "no file ''"),
        (["leaf.svg"], "leaf.svg: is a drawing, not a design. Make a design of it: voronoi-tiles new p4"),
        (["bird.toml", "-o", "-"], "cannot be written again and again"),
        (["bird.toml", "-o", "bird.gif"], "suffix .png or .svg"),
        (["bird.json", "-o", "bird.json"], "would be overwritten"),
    ],
)
def test_what_cannot_be_watched(arguments: list[str], message: str, voronoi_tiles: CommandLine, tmp_path: Path) -> None:
    """One message, exit code 2, and nothing written."""
    for name in ("bird.toml", "bird.json"):
        (tmp_path / name).write_text(SEGMENT)
    (tmp_path / "leaf.svg").write_text(FACE.format(3))
    assert message in complaint(voronoi_tiles("watch", *arguments, cwd=tmp_path))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bird.json", "bird.toml", "leaf.svg"]


def test_files_that_a_design_names(tmp_path: Path) -> None:
    """Art, drawings as strokes and whatever else is called a file, also in a design that cannot be used."""
    design = tmp_path / "a.toml"
    design.write_text(
        'group = "p5"\n[[site]]\nart = "one.svg"\nstrokes = [{ file = "two.dxf", id = "x" }, { path = "M 1 1 2 2" }]\n'
        '[[site]]\nart = { file = "/three.svg" }\nstrokes = [{ file = "two.dxf" }]\n'
    )
    assert named_files(str(design)) == (str(tmp_path / "one.svg"), str(tmp_path / "two.dxf"), "/three.svg")
    design.write_text("group = ")
    with pytest.raises(vt.DesignError):
        named_files(str(design))

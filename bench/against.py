"""This checkout beside an older commit: what each costs, and whether both give the same outlines to the bit.

Each is installed in an environment of its own, as a user has it. Every task is one process, and both checkouts take
turns, so that a busy machine slows both. What counts is processor time, user and system, of the whole process; of the
engine and the proof within it, without the imports. The designs are those of the old commit.

    python bench/against.py                        against 1e5cef8: ten minutes
    python bench/against.py COMMIT --rounds 9      also: --write, the table into bench/README.md
    python bench/against.py --keep FOLDER          leaves the environments there, and takes those that it finds
"""

from __future__ import annotations

import argparse
import io
import shutil
import statistics
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np
from engine import CURVES, process_cost
from report import machine, published, table

Result = TypeVar("Result")
ROOT = Path(__file__).parents[1]
SHEETS, SEGMENTS = ("p4-hook", "pgg-crane", "p6m-flower", "cm-moth", "p3-puzzle"), (24, 100, 1000)
SHEET, KERF = ("--sheet", "600x300mm", "--margin", "5mm"), ("--kerf", "0.15mm")

WITHIN = """
import statistics, sys, time
from voronoi_tiles import Design
from voronoi_tiles.vector.proof import prove
from voronoi_tiles.vector.tessellation import tessellate

design = Design.load(sys.argv[2])
sites = getattr(design, "noded", None) or design.sites  # its name in the old commit
found = tessellate(sites, design.group, design.lattice)
runs = []
while len(runs) < 5 or sum(runs) < 0.5:
    begun = time.process_time()
    if sys.argv[1] == "engine":
        tessellate(sites, design.group, design.lattice)
    else:
        prove(design.group, design.lattice, found)
    runs.append(time.process_time() - begun)
print(statistics.median(runs))
"""


class Checkout(NamedTuple):
    """A version of the program: its source, and the environment that it is installed in."""

    source: Path
    environment: Path

    def install(self) -> None:
        """Install the source, and its dependencies where they are not there yet."""
        if not self.environment.exists():
            subprocess.run([sys.executable, "-m", "venv", str(self.environment)], check=True)  # noqa: S603 our own
        self.python("-m", "pip", "install", "--quiet", "--disable-pip-version-check", str(self.source))

    def python(self, *arguments: str) -> bytes:
        """What the environment's Python prints."""
        command = [str(self.environment / "bin" / "python"), *arguments]
        return subprocess.run(command, cwd=self.environment, check=True, stdout=subprocess.PIPE).stdout  # noqa: S603

    def cost(self, task: Task) -> float:
        """The processor seconds of a task."""
        if task.within:
            return float(self.python("-c", WITHIN, *task.arguments))
        return self.command(*task.arguments)

    def command(self, *arguments: str) -> float:
        """Run the command line: its processor seconds."""
        return process_cost([str(self.environment / "bin" / "voronoi-tiles"), *arguments], 1)


class Task(NamedTuple):
    """What is timed: the arguments of the command line, or where `within`, those of the script WITHIN."""

    name: str
    arguments: tuple[str, ...]
    within: bool = False


def git(*arguments: str) -> bytes:
    """What git prints about this checkout."""
    command = ["git", "-C", str(ROOT), *arguments]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout  # noqa: S603 our own


def checkouts(commit: str, folder: Path) -> tuple[Checkout, Checkout]:
    """The commit, and this working tree with all that is not committed yet, both installed in a folder."""
    names = git("ls-files", "-z", "--cached", "--others", "--exclude-standard").decode()
    old, new = (Checkout(folder / f"{name}-source", folder / name) for name in ("old", "new"))
    for checkout in (old, new):
        shutil.rmtree(checkout.source, ignore_errors=True)
    with tarfile.open(fileobj=io.BytesIO(git("archive", commit))) as tar:
        tar.extractall(old.source, filter="data")
    for name in filter(None, names.split("\0")):
        if (ROOT / name).is_file():  # one that is deleted is listed too
            target = new.source / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, target)
    old.install()
    new.install()
    return old, new


def curve(segments: int) -> str:
    """A design: the curve of p4 cut into so many segments."""
    cell, controls = CURVES["p4"]
    t = np.linspace(0.0, 1.0, segments + 1)[:, None]
    weights = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3
    points = sum(weight * np.array(point) for weight, point in zip(weights, controls, strict=True))
    site = f"[[site]]\nstrokes = [{{ polyline = {points.tolist()} }}]\n"
    return f'schema = 1\ngroup = "p4"\n[cell]\na = {cell["a"]!r}\n{site}'


def tasks(examples: Path, folder: Path) -> list[Task]:
    """All that is timed; files go to a folder."""
    svg, png, hook = str(folder / "x.svg"), str(folder / "x.png"), str(examples / "p4-hook.toml")
    found = [
        Task(f"{words}: {name}", ("export", str(examples / f"{name}.toml"), *SHEET, *kerf, "-o", svg))
        for words, kerf in (("export", ()), ("kerf", KERF))
        for name in SHEETS
    ]
    for what in ("engine", "proof"):
        for segments in SEGMENTS:
            path = folder / f"{segments}.toml"
            path.write_text(curve(segments), encoding="utf-8")
            found.append(Task(f"{what}: {segments:,} segments", (what, str(path)), within=True))
    found.append(Task("render: 800 pixels", ("render", hook, "--size", "800", "--renderer", "cpu", "-o", png)))
    found.append(Task("check: 512 samples", ("check", hook, "--size", "512", "--renderer", "cpu")))
    return found


def in_turns(
    old: Checkout, new: Checkout, rounds: int, measure: Callable[[Checkout], Result]
) -> tuple[list[Result], list[Result]]:
    """What is measured of the old checkout and of the new one, which take turns at being first."""
    runs: dict[Checkout, list[Result]] = {old: [], new: []}
    for number in range(rounds):
        for checkout in (old, new) if number % 2 else (new, old):
            runs[checkout].append(measure(checkout))
    return runs[old], runs[new]


def timed(task: Task, old: Checkout, new: Checkout, rounds: int) -> tuple[float, float]:
    """The medians of the old checkout and of the new one."""
    before, after = in_turns(old, new, rounds, lambda checkout: checkout.cost(task))
    return statistics.median(before), statistics.median(after)


def differing(old: Checkout, new: Checkout, folder: Path) -> tuple[int, list[str]]:
    """How many designs there are, and those of which the outline documents differ in any byte."""
    designs = [path for name in ("examples", "examples/paper") for path in sorted((old.source / name).glob("*.toml"))]
    for name in old.python("-c", "import voronoi_tiles as vt; print(*vt.GROUPS)").decode().split():
        designs.append(folder / f"starter-{name}.toml")
        old.command("new", name, "-o", str(designs[-1]))
    documents = {}
    for checkout in (old, new):
        target = folder / checkout.environment.name
        target.mkdir()
        checkout.command("export", *map(str, designs), "--format", "json", "-o", str(target))
        documents[checkout] = {path.name: path.read_bytes() for path in target.iterdir()}
    ours, theirs = documents[new], documents[old]
    return len(designs), sorted(name for name in {*ours, *theirs} if ours.get(name) != theirs.get(name))


def compare(commit: str, rounds: int, keep: Path) -> bool:
    """Print the table, and whether the documents are the same; that too is the answer."""
    old, new = checkouts(commit, keep)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print(f"{machine()}\n\nAgainst {commit}: CPU seconds, the medians of {rounds} processes each.")
        table("Ratio = this checkout / the commit:", "ratio", "this", commit, "task")
        ratios = {}
        for task in tasks(old.source / "examples", folder):
            before, after = timed(task, old, new, rounds)
            ratios[task.name] = after / before
            print(f"| {after / before:.2f} | {after:.4f} | {before:.4f} | {task.name} |", flush=True)
        count, changed = differing(old, new, folder)
    kerf = statistics.median(ratio for name, ratio in ratios.items() if name.startswith("kerf"))
    print(f"\nSheets with kerf: the median ratio is {kerf:.2f}.")
    print(f"Outline documents: of {count} designs {len(changed)} differ{': ' if changed else '.'}{' '.join(changed)}")
    return not changed


def run(name: str, about: str | None, rounds: int, compare: Callable[[str, int, Path], Result]) -> Result:
    """Compare as the command line says; `name` is that of the marks in README.md, `rounds` the default of --rounds."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commit", nargs="?", default="1e5cef8")
    parser.add_argument("--rounds", type=int, default=rounds)
    parser.add_argument("--keep", type=Path, metavar="FOLDER")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, published(name, write=options.write):
        return compare(options.commit, options.rounds, (options.keep or Path(folder)).resolve())


def main() -> None:
    """Compare; exit with 1 where outlines differ."""
    sys.exit(0 if run("against", __doc__, 5, compare) else 1)


if __name__ == "__main__":
    main()

"""Sweeps of single-curve designs: two workers beside one, one beside a plain loop, a kill, and Dask.

A sweep is of one Bézier curve in p4 whose points are drawn at random. Every run is a process of its own, with all that
it starts; processor time is that of all of them. Each writes its tables, and keeps no designs. The plain loop makes,
proves and measures the same designs one after the other, and writes nothing. The killed run has its table from a run
that was killed and one that went on; that on Dask has a scheduler and two workers as processes of their own.

    python bench/sweeps.py                    the comparison
    python bench/sweeps.py --designs 1000     of fewer designs
    python bench/sweeps.py --write            also: the table into bench/README.md
"""

from __future__ import annotations

import argparse
import json
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, NamedTuple

from processes import usage_of
from report import machine, published, table

DESIGNS: Final = 10_000
PROGRAM: Final = Path(sys.executable).with_name("voronoi-tiles")
KILLED: Final = 0.4
"""How much of the designs is there when a run is killed; a share."""

LOOP: Final = """
import sys
from voronoi_tiles.sweeps.design_figures import design_figures
from voronoi_tiles.sweeps.sweep import Sweep
import voronoi_tiles as vt
sweep, rows = Sweep.load(sys.argv[1]), []
for number in range(len(sweep)):
    try:
        rows.append(design_figures(sweep.variant(number).tessellate(), None))
    except vt.VoronoiTilesError as error:
        rows.append(str(error))
"""


class Run(NamedTuple):
    """What a run took: seconds by the clock, and of processors."""

    wall: float
    processor: float


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--designs", type=int, default=DESIGNS, help=f"how many (default: {DESIGNS:,})")
    parser.add_argument("--write", action="store_true", help="put the table into bench/README.md")
    options = parser.parse_args()
    with published("sweeps", write=options.write), tempfile.TemporaryDirectory() as folder:
        print(machine())
        compare(Path(folder), options.designs)


def compare(folder: Path, designs: int) -> None:
    """Run all, and print what they took."""
    sweep = folder / "sweep.toml"
    sweep.write_text(text(designs), encoding="utf-8")
    table(f"{designs:,} designs", "run", "wall, s", "processor, s", "designs/s", "table")

    def row(name: str, run: Run, same: str = "") -> None:
        figures = f"{run.wall:.1f} | {run.processor:.1f} | {designs / run.wall:.0f}"
        print(f"| {name} | {figures} | {same} |", flush=True)

    def beside(name: str) -> str:
        return "the same" if table_of(folder / name) == table_of(folder / "one") else "ANOTHER"

    loop = timed([sys.executable, "-c", LOOP, str(sweep)])
    row("plain loop", loop)
    one = timed(command(sweep, folder / "one", "--workers", "1"))
    row("one worker", one, "that of the others")
    two = timed(command(sweep, folder / "two", "--workers", "2"))
    row("two workers", two, beside("two"))
    killed(sweep, folder / "killed", designs)
    again = timed(command(sweep, folder / "killed", "--workers", "2"))
    row(f"two, killed at {KILLED:.0%}, and again", again, beside("killed"))
    before = processor_of_children()
    with cluster() as address:
        dask = timed(command(sweep, folder / "dask", "--scheduler", address))
    dask = Run(dask.wall, processor_of_children() - before)
    row("Dask, two workers", dask, beside("dask"))
    local = timed(command(sweep, folder / "local", "--scheduler", "local", "--workers", "2"))
    row("Dask's own cluster of two", local, beside("local"))
    print(f"\nTwo workers do {one.wall / two.wall:.2f} times what one does in the same time, and take ", end="")
    print(f"{two.processor / one.processor:.2f} times its processor time: ", end="")
    print(f"{2 * one.processor / two.processor:.2f} times as much where each has a processor to itself.")
    print(f"One takes {one.processor / loop.processor:.2f} times the processor time of the plain loop.")


def text(designs: int) -> str:
    """The sweep."""
    points = [[6, 9], [22, 5], [27, 17], [13, 25]]
    design = {
        "schema": 1,
        "group": "p4",
        "cell": {"a": 60},
        "site": [{"tolerance": 0.05, "strokes": [{"bezier": points}]}],
    }
    vary = {"site[0].strokes[0]": {"deviation": 5}}
    return json.dumps({"design": design, "vary": vary, "count": designs, "seed": 1, "keep": 0})


def command(sweep: Path, folder: Path, *options: str) -> list[str]:
    """The command for a sweep."""
    return [str(PROGRAM), "sweep", str(sweep), "-o", str(folder), *options]


def table_of(folder: Path) -> bytes:
    """The table of a sweep."""
    return (folder / "table.csv").read_bytes()


def timed(words: list[str]) -> Run:
    """Run a command to its end: what it took, with all that it started."""
    begun = time.perf_counter()
    usage = usage_of(words)
    return Run(time.perf_counter() - begun, usage.ru_utime + usage.ru_stime)


def processor_of_children() -> float:
    """The processor time of all processes that were started here, and have ended; seconds."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def killed(sweep: Path, folder: Path, designs: int) -> None:
    """Begin a sweep, and kill it when a part of its rows is there."""
    words = command(sweep, folder, "--workers", "2")
    with subprocess.Popen(words, stderr=subprocess.DEVNULL) as process:  # noqa: S603 - our own
        while rows_in(folder / "rows") < KILLED * designs:
            if process.poll() is not None:
                sys.exit("the run that was to be killed has ended")
            time.sleep(0.05)
        process.send_signal(signal.SIGKILL)


def rows_in(folder: Path) -> int:
    """How many rows are there, by the names of their files."""
    ends = (path.stem.partition("-") for path in folder.glob("[0-9]*.json"))
    return sum(int(last) - int(first) + 1 for first, _, last in ends)


@contextmanager
def cluster() -> Iterator[str]:
    """A scheduler of Dask's and two workers, as processes of their own: the scheduler's address."""
    dask = str(Path(sys.executable).with_name("dask"))
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "scheduler.json"
        quiet: Any = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": place}
        started = [
            subprocess.Popen(  # noqa: S603 - of our environment
                [dask, "scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)], **quiet
            )
        ]
        try:
            while not file.exists():
                time.sleep(0.1)
            address = json.loads(file.read_text(encoding="utf-8"))["address"]
            started += [
                subprocess.Popen(  # noqa: S603 - same
                    [dask, "worker", address, "--nthreads", "1", "--no-dashboard", "--no-nanny"], **quiet
                )
                for _ in range(2)
            ]
            yield address
        finally:
            for process in started:
                process.kill()  # workers that are asked to end may wait for a scheduler that has ended
            for process in started:
                process.wait()


if __name__ == "__main__":
    main()

"""How fast the engine is, beside Boost.Polygon, and what a whole process costs. Run it with `make bench`.

Timed of the engine: `tessellate`, from sites whose strokes are flattened and noded to the outlines, without the proof
and without files. Timed of the peer: see peer.py. All take turns, so that a busy machine slows all; the ratios are
those of the fastest runs. Every size is checked: the areas must agree to 1e-6.

Boost.Polygon gets two blocks of copies. *Fewest copies* is the smallest block that gives the same tile, of which no
copy can be left out; to know it one must know the tile. *Whole cells* is the smallest square block of whole cells about
the site's own (3 x 3, 5 x 5, ...) that gives the same tile: what one can take without knowing it.
"""

from __future__ import annotations

import argparse
import datetime as dt
import gc
import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from voronoi_tiles import Design, __version__
from voronoi_tiles.site import Site, build_site
from voronoi_tiles.vector.proof import prove
from voronoi_tiles.vector.tessellation import TileRecord, tessellate
from voronoi_tiles.wallpaper import Lattice, Operation, WallpaperGroup

try:
    import peer
except ImportError as error:
    if error.name != "pyvoronoi":
        raise
    peer = None

# Of each group a cell in millimetres and a cubic curve in it, without a loop.
CURVES: dict[str, tuple[dict[str, float], list[list[float]]]] = {
    "p1": ({"a": 50.0, "b": 46.0, "angle": 70.0}, [[22, 42], [39, 33], [32, 3], [23, 1]]),
    "p4": ({"a": 60.0}, [[6, 9], [30, 2], [30, 20], [13, 25]]),
    "p6": ({"a": 60.0}, [[9, 4], [21, 2], [26, 9], [16, 17]]),
}
SIZES = (1, 3, 10, 24, 100, 300, 1000, 3000, 10000, 20000)
AGREEMENT = 1e-6
# Larger diagrams are not built again and again to find the smallest block: that of a smaller one is tried first.
SEARCHED = 300
# The peer gets no larger problem than this.
MOST_SEGMENTS = 200_000


class Case(NamedTuple):
    """One problem: a curve of so many segments under a group."""

    site: Site
    group: WallpaperGroup
    lattice: Lattice

    def solve(self) -> TileRecord:
        """Run the engine."""
        return tessellate([self.site], self.group, self.lattice)[0]


def design_of(group: str, tolerance: float = 0.01) -> Design:
    """Make the design of a group's curve."""
    cell, curve = CURVES[group]
    site = {"name": "curve", "tolerance": tolerance, "strokes": [{"bezier": curve}]}
    return Design.from_dict({"schema": 1, "group": group, "cell": cell, "site": [site]})


def case_of(group: str, segments: int) -> Case:
    """Cut a group's curve into equal steps of its parameter."""
    design = design_of(group)
    p = [complex(*point) for point in CURVES[group][1]]
    t = np.linspace(0.0, 1.0, segments + 1)
    points = (1 - t) ** 3 * p[0] + 3 * t * (1 - t) ** 2 * p[1] + 3 * t**2 * (1 - t) * p[2] + t**3 * p[3]
    site = build_site("curve", [points])
    assert len(site.segments) == segments
    return Case(site, design.group, design.lattice)


def stopwatch(action: Callable[[], object]) -> float:
    """Give the seconds that an action takes."""
    begin = time.perf_counter()
    action()
    return time.perf_counter() - begin


def repetitions(seconds: float, most: int) -> int:
    """Say how often to repeat what takes so long: two seconds in all, but three times at least."""
    return max(3, min(most, int(2.0 / max(seconds, 1e-9))))


# The peer and its block of copies


def neighbours(record: TileRecord) -> list[Operation]:
    """List the copies beyond the edges of a tile, those with the longest common edges first."""
    outline = record.outline
    lengths = np.bincount(outline.neighbour, np.abs(outline.end - outline.start), len(outline.neighbours))
    return [outline.neighbours[k].operation for k in np.argsort(-lengths)]


def block_error(case: Case, copies: Sequence[Operation], area: float) -> float:
    """Give the relative error of the tile's area that the peer finds with these copies."""
    segments = peer.block_segments(case.site, case.lattice, copies)
    _, reading = peer.run_peer(segments, len(case.site.segments))
    error = abs(peer.tile_area(reading, segments) - area) / area
    return error if error == error else float("inf")  # noqa: PLR0124 NaN: an unbounded cell


def smallest_block(case: Case, record: TileRecord, known: Sequence[Operation] | None) -> list[Operation]:
    """Find copies with which the peer gives the same tile, and of which none can be left out.

    The copies beyond the tile's edges come first, with rings of further ones until the area is right; then those that
    do not matter leave, the least important first.
    """
    area = record.outline.area
    if known is not None and len(case.site.segments) > SEARCHED and block_error(case, known, area) <= AGREEMENT:
        return list(known)
    first = neighbours(record)
    block = list(first)
    for _ in range(3):
        if block_error(case, block, area) <= AGREEMENT:
            break
        block += [q for p in list(block) for n in first if not (q := p @ n).is_identity and q not in block]
    else:
        raise AssertionError(f"the peer's area is off by {block_error(case, block, area):.2g}")
    for copy in reversed(list(block)):
        rest = [other for other in block if other != copy]
        if block_error(case, rest, area) <= AGREEMENT:
            block = rest
    return block


def block_of_cells(case: Case, record: TileRecord, known: Sequence[Operation] | None) -> list[Operation]:
    """Find the smallest square of whole cells with which the peer gives the same tile; all its copies but the site."""
    area = record.outline.area
    if known is not None and len(case.site.segments) > SEARCHED and block_error(case, known, area) <= AGREEMENT:
        return list(known)
    for reach in range(1, 5):
        steps = range(-reach, reach + 1)
        block = [
            copy
            for operation in case.group.operations
            for i in steps
            for j in steps
            if not (copy := operation.translated(i, j)).is_identity
        ]
        if block_error(case, block, area) <= AGREEMENT:
            return block
    raise AssertionError("no block of cells gives the tile")


# The tables


def compare(group: str, sizes: Sequence[int], peer_limit: int, most: int) -> dict[int, float]:
    """Print the rows of one group; give the engine's best time for each size."""
    best: dict[int, float] = {}
    known: list[list[Operation] | None] = [None, None]
    for size in sizes:
        case = case_of(group, size)
        record = case.solve()
        blocks: list[list[Operation]] = []
        for number, find in enumerate((smallest_block, block_of_cells)):
            block = known[number]
            copies = len(block) + 1 if block is not None else 0
            if peer is not None and size * max(1, copies) <= MOST_SEGMENTS and size <= peer_limit:
                known[number] = find(case, record, block)
                blocks.append(known[number])
        inputs = [peer.block_segments(case.site, case.lattice, block) for block in blocks]
        actions: list[Callable[[], float]] = [lambda case=case: stopwatch(case.solve)]
        actions += [lambda given=given, size=size: peer.run_peer(given, size)[0] for given in inputs]
        times = [[action()] for action in actions]
        gc.collect()
        gc.disable()
        for _ in range(repetitions(sum(taken[0] for taken in times), most) - 1):
            for action, taken in zip(actions, times, strict=True):
                taken.append(action())
        gc.enable()
        best[size] = min(times[0])
        print(_row(size, group, times, [len(block) + 1 for block in blocks]), flush=True)
    return best


def _row(size: int, group: str, times: Sequence[Sequence[float]], copies: Sequence[int]) -> str:
    """Write a row: ratios, group, segments, runs, the engine's times, then for each block copies and times."""
    engine, *others = times
    ratios = [f"{min(other) / min(engine):.1f}" for other in others]
    cells = [*ratios, *["-"] * (2 - len(ratios)), group, str(size), str(len(engine)), *_two(engine)]
    for number in range(2):
        cells += [str(copies[number]), *_two(others[number])] if number < len(others) else ["-", "-", "-"]
    return "| " + " | ".join(cells) + " |"


def _two(times: Sequence[float]) -> list[str]:
    """Write the least and the median of times in milliseconds."""
    return [f"{min(times) * 1e3:.2f}", f"{statistics.median(times) * 1e3:.2f}"]


def table(title: str, *heads: str) -> None:
    """Print the head of a table."""
    print(f"\n{title}\n\n| {' | '.join(heads)} |\n|{'---:|' * len(heads)}")


def print_growth(best: dict[str, dict[int, float]]) -> None:
    """Print the exponent of the growth from 100 segments on: the slope of a line through the logarithms."""
    table(
        "Growth of the engine's time with the number of segments, fitted to the fastest runs:",
        "group",
        "from",
        "to",
        "exponent",
    )
    for group, times in best.items():
        sizes = [size for size in times if size >= 100]
        if len(sizes) > 1:
            slope = np.polyfit(np.log(sizes), np.log([times[size] for size in sizes]), 1)[0]
            print(f"| {group} | {min(sizes)} | {max(sizes)} | {slope:.3f} |")


def print_stages(group: str, most: int) -> None:
    """Print what the stages of the pipeline cost for one curve at several tolerances."""
    table(
        f"The stages, for one cubic curve in {group} (milliseconds, fastest run):",
        "tolerance mm",
        "segments",
        "flatten, node",
        "tessellate",
        "prove",
    )
    for tolerance in (1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-6):
        design = design_of(group, tolerance)
        record = tessellate(design.sites, design.group, design.lattice)
        stages: list[Callable[[], object]] = [
            lambda tolerance=tolerance: design_of(group, tolerance),
            lambda design=design: tessellate(design.sites, design.group, design.lattice),
            lambda design=design, record=record: prove(design.group, design.lattice, record),
        ]
        times = [min(stopwatch(stage) for _ in range(min(most, 5))) * 1e3 for stage in stages]
        print(f"| {tolerance:g} | {len(design.sites[0].segments)} | " + " | ".join(f"{t:.2f}" for t in times) + " |")


def process_cost(command: Sequence[str], runs: int) -> float:
    """Give the median processor time, user and system, of a command's runs."""
    seconds = []
    for _ in range(runs):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)  # noqa: S603 our own
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        assert process.stderr is not None
        message = process.stderr.read().decode()
        process.stderr.close()
        if process.returncode:
            raise SystemExit(f"{' '.join(command)} failed: {message}")
        seconds.append(usage.ru_utime + usage.ru_stime)
    return statistics.median(seconds)


def print_processes(runs: int) -> None:
    """Print what whole processes cost."""
    script = Path(sys.executable).with_name("voronoi-tiles")
    program = [str(script)] if script.exists() else [sys.executable, "-m", "voronoi_tiles"]
    table(f"Whole processes (median of {runs}, user and system time):", "CPU s", "command")
    with tempfile.TemporaryDirectory() as folder:
        design = Path(folder, "one.toml")
        design.write_text(
            'schema = 1\ngroup = "p4"\n[cell]\na = 60\n[[site]]\nstrokes = [{ segment = [[59, 27], [39, 39]] }]\n',
            encoding="utf-8",
        )
        for arguments in (
            ["--version"],
            ["export", str(design), "-o", str(Path(folder, "one.svg"))],
            ["export", str(design), "-o", str(Path(folder, "one.json"))],
        ):
            seconds = process_cost([*program, *arguments], runs)
            shown = " ".join(Path(argument).name for argument in arguments)
            print(f"| {seconds:.3f} | voronoi-tiles {shown} |")


def print_memory(size: int) -> None:
    """Print the largest memory of a process that tessellates a curve of so many segments."""
    table(f"Peak memory of a process with {size} segments in one site (MB):", "group", "before the engine", "at most")
    for group in CURVES:
        command = [sys.executable, __file__, "--memory-of", group, str(size)]
        finished = subprocess.run(command, capture_output=True, text=True, check=True)  # noqa: S603 this very file
        result: dict[str, float] = json.loads(finished.stdout)
        print(f"| {group} | {result['before']:.0f} | {result['peak']:.0f} |")


def report_memory(group: str, size: int) -> None:
    """In a process of its own: print the largest memory before and after the engine ran."""
    case = case_of(group, size)
    before = peak_memory()
    case.solve()
    print(json.dumps({"before": before, "peak": peak_memory()}))


def peak_memory() -> float:
    """Give the largest memory of this process so far, in MB.

    Linux counts in getrusage's figure what the parent process held when it started this one; /proc does not.
    """
    status = Path("/proc/self/status")
    if status.exists():
        lines = status.read_text(encoding="utf-8").splitlines()
        return next(int(line.split()[1]) / 1024.0 for line in lines if line.startswith("VmHWM"))
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def machine() -> str:
    """Describe the machine and the versions."""
    model = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        lines = cpuinfo.read_text(encoding="utf-8").splitlines()
        model = next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), model)
    today = dt.datetime.now(tz=dt.UTC).date().isoformat()
    return (
        f"{today}, {model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; Python {platform.python_version()}, "
        f"numpy {np.__version__}, voronoi_tiles {__version__}"
    )


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--largest", type=int, default=SIZES[-1], help="the largest number of segments")
    parser.add_argument("--peer-limit", type=int, default=SIZES[-1], help="no peer beyond so many segments")
    parser.add_argument("--repeat", type=int, default=30, help="repetitions at most")
    parser.add_argument("--memory-of", nargs=2, metavar=("GROUP", "SIZE"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.memory_of:
        report_memory(options.memory_of[0], int(options.memory_of[1]))
        return
    print(machine())
    if peer is None:
        print("\nThe peer is missing: install pyvoronoi (the extra `test`) to compare with Boost.Polygon.")
    table(
        "Engine and Boost.Polygon (milliseconds); ratio = Boost.Polygon's fastest run / the engine's fastest run:",
        "ratio, fewest copies",
        "ratio, whole cells",
        "group",
        "segments",
        "runs",
        "engine min",
        "median",
        "fewest copies",
        "min",
        "median",
        "whole cells: copies",
        "min",
        "median",
    )
    sizes = [size for size in SIZES if size <= options.largest]
    best = {group: compare(group, sizes, options.peer_limit, options.repeat) for group in CURVES}
    print_growth(best)
    print_memory(sizes[-1])
    print_stages("p4", options.repeat)
    print_processes(10)


if __name__ == "__main__":
    main()

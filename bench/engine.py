"""How fast the engine is, beside Boost.Polygon and CGAL, and what a whole process costs. Run it with `make bench`.

Timed of the engine: `tessellate`, from sites whose strokes are flattened and noded to the outlines, without the proof
and without files. Timed of the peers: see peer.py and cgal.cpp. All take turns, so that a busy machine slows all; the
ratios are those of the fastest runs. Every size is checked: the areas must agree to 1e-6.

The peers get two blocks of copies. *Fewest copies* is the smallest block that gives the same tile, of which no
copy can be left out; to know it one must know the tile. *Whole cells* is the smallest square block of whole cells about
the site's own (3 x 3, 5 x 5, ...) that gives the same tile: what one can take without knowing it.
"""

from __future__ import annotations

import argparse
import gc
import json
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from compiled import MissingError
from numpy.typing import NDArray
from processes import usage_of
from report import machine, published, table

from voronoi_tiles import Design
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.site import NodedSite, build_site
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.vector.proof import prove
from voronoi_tiles.vector.tessellation import TileRecord, tessellate

try:
    import cgal
    import peer
except ImportError as error:
    if error.name != "pyvoronoi":
        raise
    HAS_PEERS = False
else:
    HAS_PEERS = True

# Of each group a cell in millimetres and a cubic curve in it, without a loop.
CURVES: dict[str, tuple[dict[str, float], list[list[float]]]] = {
    "p1": ({"a": 50.0, "b": 46.0, "angle": 70.0}, [[22, 42], [39, 33], [32, 3], [23, 1]]),
    "p4": ({"a": 60.0}, [[6, 9], [30, 2], [30, 20], [13, 25]]),
    "p6": ({"a": 60.0}, [[9, 4], [21, 2], [26, 9], [16, 17]]),
}
SIZES = (1, 3, 10, 24, 100, 300, 1000, 3000, 10000, 20000)
# The peers get no larger problem than this.
MOST_SEGMENTS = 200_000
# CGAL gets no larger one after a run of so many seconds.
LONGEST_RUN = 2.0

Complexes = NDArray[np.complex128]


class Case(NamedTuple):
    """One problem: a curve of so many segments under a group."""

    site: NodedSite
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
    """The processor seconds that an action takes."""
    begin = time.process_time()
    action()
    return time.process_time() - begin


def repetitions(seconds: float, most: int) -> int:
    """Say how often to repeat what takes so long: two seconds in all, but three times at least."""
    return max(3, min(most, int(2.0 / max(seconds, 1e-9))))


# The engine and its peers


class Block(NamedTuple):
    """A block of copies, the site included, and the seconds of the peers' runs: none where one was left out."""

    copies: int
    boost: list[float]
    cgal: list[float]


class Timing(NamedTuple):
    """The seconds of the engine's runs, and the blocks: fewest copies, whole cells."""

    group: str
    segments: int
    engine: list[float]
    blocks: list[Block]


class Peers:
    """The peers of one group: what they got last, and how long it took."""

    def __init__(self, limit: int) -> None:
        """Allow them no more than so many segments in the site."""
        self.limit = limit if HAS_PEERS else 0
        self.known: list[list[Operation] | None] = [None, None]
        self.slow = [False, False]

    def actions(
        self, case: Case, record: TileRecord
    ) -> list[tuple[int, Callable[[], float], Callable[[], float] | None]]:
        """For each block the number of copies and the runs of Boost.Polygon and of CGAL."""
        size = len(case.site.segments)
        found: list[tuple[int, Callable[[], float], Callable[[], float] | None]] = []
        for number, find in enumerate((peer.smallest_block, peer.block_of_cells) if self.limit else ()):
            last = self.known[number]
            if size > self.limit or size * (len(last) + 1 if last is not None else 1) > MOST_SEGMENTS:
                continue
            copies = self.known[number] = find(case, record, last)
            nodes = peer.block_nodes(case.site, case.lattice, copies)
            given = peer.block_segments(case.site, nodes)
            boost = partial(lambda given: peer.run_peer(given, size)[0], given)
            other = (
                None if self.slow[number] or not has_cgal() else partial(self._run_cgal, number, case, record, nodes)
            )
            found.append((len(nodes), boost, other))
        return found

    def _run_cgal(self, number: int, case: Case, record: TileRecord, nodes: Complexes) -> float:
        """Run CGAL, check the area, and see whether it is too slow for a larger problem."""
        seconds, reading = cgal.run_cgal(case.site, nodes)
        area = peer.tile_area(reading, peer.block_segments(case.site, nodes))
        assert abs(area / record.outline.area - 1) <= peer.AGREEMENT
        self.slow[number] |= seconds > LONGEST_RUN
        return seconds


def has_cgal() -> bool:
    """Whether CGAL can be used here."""
    try:
        return HAS_PEERS and bool(cgal.version())
    except MissingError:
        return False


def compare(group: str, sizes: Sequence[int], peer_limit: int, most: int) -> list[Timing]:
    """Time the engine and its peers for one group."""
    peers, timings = Peers(peer_limit), []
    for size in sizes:
        case = case_of(group, size)
        offered = peers.actions(case, case.solve())
        actions: list[Callable[[], float]] = [partial(stopwatch, case.solve)]
        actions += [run for _, *runs in offered for run in runs if run is not None]
        times = [[action()] for action in actions]
        gc.collect()
        gc.disable()
        for _ in range(repetitions(sum(taken[0] for taken in times), most) - 1):
            for action, taken in zip(actions, times, strict=True):
                taken.append(action())
        gc.enable()
        engine, *others = times
        rest = iter(others)
        blocks = [Block(copies, next(rest), next(rest) if other is not None else []) for copies, _, other in offered]
        timings.append(Timing(group, size, engine, blocks))
        print(f"{group}, {size} segments: {min(engine) * 1e3:.2f} ms", file=sys.stderr)
    return timings


# The tables


def print_ratios(timings: Sequence[Timing]) -> None:
    """Print who is faster, and by how much."""
    heads = ["fastest, fewest copies", "Boost.Polygon", "CGAL", "fastest, whole cells", "Boost.Polygon", "CGAL"]
    title = "Ratio = the peer's fastest run / the engine's fastest run; below 1 the engine loses:"
    table(title, *heads, "group", "segments")
    for timing in timings:
        cells = []
        for number in range(2):
            block = timing.blocks[number] if number < len(timing.blocks) else Block(0, [], [])
            runs = {"engine": timing.engine, "Boost.Polygon": block.boost, "CGAL": block.cgal}
            taken = {who: min(times) for who, times in runs.items() if times}
            ratios = [
                f"{taken[who] / taken['engine']:.2f}" if who in taken else "-" for who in ("Boost.Polygon", "CGAL")
            ]
            cells += [min(taken, key=taken.__getitem__) if len(taken) > 1 else "-", *ratios]
        print(f"| {' | '.join([*cells, timing.group, str(timing.segments)])} |")


def print_times(timings: Sequence[Timing]) -> None:
    """Print the times."""
    heads = ["group", "segments", "runs", "engine min", "median"]
    for name in ("fewest copies", "whole cells: copies"):
        heads += [name, "Boost.Polygon min", "median", "CGAL min", "median"]
    table("The times (milliseconds):", *heads)
    for timing in timings:
        cells = [timing.group, str(timing.segments), str(len(timing.engine)), *_two(timing.engine)]
        for block in timing.blocks:
            cells += [str(block.copies), *_two(block.boost), *_two(block.cgal)]
        cells += ["-"] * (len(heads) - len(cells))
        print(f"| {' | '.join(cells)} |")


def _two(times: Sequence[float]) -> list[str]:
    """Write the least and the median of times in milliseconds; dashes where there are none."""
    if not times:
        return ["-", "-"]
    return [f"{min(times) * 1e3:.2f}", f"{statistics.median(times) * 1e3:.2f}"]


def print_growth(timings: Sequence[Timing]) -> None:
    """Print the exponent of the growth from 100 segments on: the slope of a line through the logarithms."""
    table(
        "Growth of the engine's time with the number of segments, fitted to the fastest runs:",
        "group",
        "from",
        "to",
        "exponent",
    )
    for group in CURVES:
        best = {timing.segments: min(timing.engine) for timing in timings if timing.group == group}
        sizes = [size for size in best if size >= 100]
        if len(sizes) > 1:
            slope = np.polyfit(np.log(sizes), np.log([best[size] for size in sizes]), 1)[0]
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
        record = tessellate(design.noded, design.group, design.lattice)
        stages: list[Callable[[], object]] = [
            partial(design_of, group, tolerance),
            partial(tessellate, design.noded, design.group, design.lattice),
            partial(prove, design.group, design.lattice, record),
        ]
        times = [min(stopwatch(stage) for _ in range(min(most, 5))) * 1e3 for stage in stages]
        print(f"| {tolerance:g} | {len(design.noded[0].segments)} | " + " | ".join(f"{t:.2f}" for t in times) + " |")


def process_cost(command: Sequence[str], runs: int) -> float:
    """The median processor time, user and system, of a command's runs."""
    used = [usage_of(command) for _ in range(runs)]
    return statistics.median(usage.ru_utime + usage.ru_stime for usage in used)


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
    """The largest memory of this process so far, in MB.

    Linux counts in getrusage's figure what the parent process held when it started this one; /proc does not.
    """
    status = Path("/proc/self/status")
    if status.exists():
        lines = status.read_text(encoding="utf-8").splitlines()
        return next(int(line.split()[1]) / 1024.0 for line in lines if line.startswith("VmHWM"))
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--largest", type=int, default=SIZES[-1], help="the largest number of segments")
    parser.add_argument("--peer-limit", type=int, default=SIZES[-1], help="no peer beyond so many segments")
    parser.add_argument("--repeat", type=int, default=30, help="repetitions at most")
    parser.add_argument("--write", action="store_true", help="put the tables into bench/README.md")
    parser.add_argument("--memory-of", nargs=2, metavar=("GROUP", "SIZE"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.memory_of:
        report_memory(options.memory_of[0], int(options.memory_of[1]))
        return
    with published("engine", write=options.write):
        print_all(options.largest, options.peer_limit, options.repeat)


def print_all(largest: int, peer_limit: int, most: int) -> None:
    """Print the tables."""
    print(f"{machine()}; {cgal.described() if HAS_PEERS else 'without CGAL'}")
    if not HAS_PEERS:
        print("\nThe peers are missing: install pyvoronoi (the extra `test`) to compare with Boost.Polygon and CGAL.")
    sizes = [size for size in SIZES if size <= largest]
    timings = [timing for group in CURVES for timing in compare(group, sizes, peer_limit, most)]
    print_ratios(timings)
    print_times(timings)
    print_growth(timings)
    print_memory(sizes[-1])
    print_stages("p4", most)
    print_processes(10)


if __name__ == "__main__":
    main()

"""What was asked of the engine, sheets, the command line and the raster stage, and whether it is reached, in one run.

Side by side are this working tree, the same with numpy alone (`--numpy`: VORONOI_TILES_KERNELS=numpy), an older commit,
each installed in an environment of its own, and peers: Boost.Polygon itself (boost.cpp) and through pyvoronoi, on the
fewest copies that give the same tile, and qhull through scipy, on 3 x 3 cells. All take turns, so that a busy machine
slows all. What counts is processor time, the medians; the engine and the proof together, as `Design.tessellate` runs
them. Of each peer the area of the tile is checked.

    python bench/targets.py --numpy                against 1e5cef8: ten minutes
    python bench/targets.py --only 24 export       the cases whose names have one of these words
    python bench/targets.py COMMIT --rounds 9      also: --write, the tables into bench/README.md
    python bench/targets.py --keep FOLDER          leaves the environments there, and takes those that it finds
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import boost
import numpy as np
from against import Checkout, checkouts
from compiled import MissingError
from engine import CURVES, HAS_PEERS, Case
from numpy.typing import NDArray
from processes import usage_of
from report import machine, published, table

from voronoi_tiles import Design

if HAS_PEERS:
    import peer

NEW, NUMPY, OLD = "this", "numpy alone", "old"
BOOST, PYVORONOI, QHULL = "Boost.Polygon", "through pyvoronoi", "qhull"
COLUMNS = (NEW, NUMPY, OLD, BOOST, PYVORONOI, QHULL)

SLOW = 5.0
"""What takes longer is run once; processor seconds."""

AGREEMENT = 1e-6
"""How well the areas of a tile have to agree, relative to it."""

MISSED = 3
"""What the script exits with where it has measured everything, and not all that was asked is reached."""

WITHIN = """
import json, sys, time
from pathlib import Path
from voronoi_tiles import Design

design = Design.load(sys.argv[2])
if sys.argv[1] == "lists":
    from voronoi_tiles.raster.frame import cell_frame
    try:
        from voronoi_tiles.raster.block_lists import find_candidates
        from voronoi_tiles.raster.scene import Pattern, gather
    except ImportError:  # their names in the old commit
        from voronoi_tiles.raster.candidates import find_candidates
        from voronoi_tiles.raster.copies import Pattern, gather
    pattern = Pattern(getattr(design, "noded", None) or design.sites, design.group, design.lattice)
    frame = cell_frame(pattern.lattice, 2048)
    scene = gather(pattern, frame.origin, frame.middle, frame.radius)
    action = lambda: find_candidates(scene, frame)
elif sys.argv[1] == "kerf":
    from voronoi_tiles import Job

    job = Job(sheet="600x300mm", margin=5, kerf=0.15)
    # Anew each time: a tessellation keeps what jobs have made of it.
    action = lambda: design.tessellate().export(Path(sys.argv[2]).with_suffix(".svg"), job=job)
else:
    action = design.tessellate

def run():
    begun = time.process_time()
    action()
    return time.process_time() - begun

runs = [run()]
if runs[0] < float(sys.argv[3]):
    runs = [run()]  # the first one imported what it needed
    while len(runs) < 5 or sum(runs) < 0.5 and len(runs) < 500:
        runs.append(run())
status = Path("/proc/self/status")
peak = next((float(row.split()[1]) / 1024 for row in status.read_text().splitlines() if row.startswith("VmHWM")), 0.0)
print(json.dumps({"seconds": runs, "megabytes": peak}))
"""


class Problem(NamedTuple):
    """A case: what is timed, `tile`, `lists` or a sheet with `kerf` within a process, or `command`, a whole one.

    That has these arguments: DESIGN stands for the file of the design, PICTURE and SVG for files to write. The older
    commit is left out where it would take minutes.
    """

    name: str
    what: str
    design: Mapping[str, Any]
    arguments: tuple[str, ...] = ()
    peers: tuple[str, ...] = ()
    old: bool = True


class Target(NamedTuple):
    """A ratio of two measured figures, each of a case and a column, and what it must be at least, or at most."""

    over: tuple[str, str]
    under: tuple[str, str]
    least: float = 0.0
    most: float = float("inf")
    of: str = "time"

    def met(self, ratio: float) -> bool:
        """Whether a ratio is what was asked."""
        return self.least <= ratio <= self.most

    def asked(self) -> str:
        """What was asked, as a text."""
        return f">= {self.least:g}" if self.least else f"<= {self.most:g}"


class Figure(NamedTuple):
    """The processor seconds of a case's runs in a column, and its process's memory at the peak (MB, 0: unknown)."""

    seconds: list[float]
    megabytes: float

    @property
    def median(self) -> float:
        """The median of the seconds."""
        return statistics.median(self.seconds)


# The cases


def document(group: str, cell: Mapping[str, float], strokes: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """A design; each of the strokes is a site of its own."""
    sites = [{"name": f"site{number}", "strokes": [stroke]} for number, stroke in enumerate(strokes)]
    return {"schema": 1, "group": group, "cell": dict(cell), "site": sites}


def curve(segments: int) -> dict[str, Any]:
    """The curve of p4 in so many segments."""
    cell, controls = CURVES["p4"]
    t = np.linspace(0.0, 1.0, segments + 1)[:, None]
    weights = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3
    points = sum(weight * np.array(point) for weight, point in zip(weights, controls, strict=True))
    return document("p4", cell, [{"polyline": np.asarray(points).tolist()}])


def points(count: int) -> dict[str, Any]:
    """So many points in p4, each a site."""
    places = np.random.default_rng(1).uniform(0.0, 60.0, (count, 2)).round(6).tolist()
    return document("p4", {"a": 60.0}, [{"point": place} for place in places])


def zigzag(strokes: int) -> dict[str, Any]:
    """So many strokes of 40 mm, side by side: what is near to one of them is near to hundreds."""
    places = [[5.0 + 50.0 * k / strokes, 50.0 if k % 2 else 10.0] for k in range(strokes + 1)]
    return document("p1", {"a": 60.0, "b": 60.0, "angle": 90.0}, [{"polyline": places}])


def problems() -> list[Problem]:
    """All cases."""
    thin = document("p1", {"a": 6000.0, "b": 1.0, "angle": 90.0}, [{"segment": [[0.2, 0.2], [0.6, 0.7]]}])
    both = (BOOST, PYVORONOI)
    return [
        Problem("1 segment", "tile", curve(1), peers=both),
        Problem("24 segments", "tile", curve(24), peers=both),
        Problem("1,000 segments", "tile", curve(1000), peers=both),
        Problem("20,000 segments", "tile", curve(20_000), peers=both),
        Problem("zigzag of 1,000", "tile", zigzag(1000), peers=both),
        Problem("100 points", "tile", points(100), peers=(QHULL,)),
        Problem("300 points", "tile", points(300), peers=(QHULL,), old=False),
        Problem("import numpy", "command", {}, ("python", "-c", "import numpy")),
        Problem("export", "command", curve(24), ("voronoi-tiles", "export", "DESIGN", "-o", "SVG")),
        Problem("check", "command", curve(24), ("voronoi-tiles", "check", "DESIGN", "--renderer", "cpu")),
        Problem(
            "picture of 6,000 x 1",
            "command",
            thin,
            ("voronoi-tiles", "render", "DESIGN", "--renderer", "cpu", "-o", "PICTURE"),
        ),
        Problem("raster lists", "lists", curve(1000)),
        Problem("kerf of a sheet", "kerf", curve(24)),
    ]


def targets() -> list[Target]:
    """All that was asked."""
    found = []
    for name, whole, alone, other, ratio in (
        ("100 points", 300, 60, QHULL, 0.5),
        ("24 segments", 8, 2, BOOST, 1),
        ("1,000 segments", 20, 3, BOOST, 2),
        ("20,000 segments", 40, 6, BOOST, 2),
        ("zigzag of 1,000", 40, 8, BOOST, 1),
    ):
        found += [
            Target((name, OLD), (name, NEW), whole),
            Target((name, OLD), (name, NUMPY), alone),
            Target((name, other), (name, NEW), ratio),
        ]
    return [
        *found,
        Target(("300 points", NEW), ("100 points", NEW), most=3.5),
        Target(("20,000 segments", NEW), ("20,000 segments", OLD), most=1.0, of="memory"),
        Target(("1 segment", OLD), ("1 segment", NEW), 5),
        Target(("export", NEW), ("import numpy", NEW), most=2.2),
        Target(("check", NEW), ("import numpy", NEW), most=3.5),
        Target(("picture of 6,000 x 1", OLD), ("picture of 6,000 x 1", NEW), 10),
        Target(("raster lists", OLD), ("raster lists", NEW), 10),
        Target(("kerf of a sheet", NEW), ("kerf of a sheet", OLD), most=0.25),
    ]


# The runs


def run_checkout(problem: Problem, checkout: Checkout, folder: Path, variables: Mapping[str, str]) -> Figure:
    """Run a case with a checkout, in a process that has these variables of the environment too."""
    path = folder / f"{problem.name}.json"
    path.write_text(json.dumps(problem.design), encoding="utf-8")
    scripts = checkout.environment / "bin"
    with _environment(variables):
        if problem.what == "command":
            names = {"DESIGN": path, "SVG": folder / "x.svg", "PICTURE": folder / "x.png"}
            program, *arguments = (str(names.get(word, word)) for word in problem.arguments)
            usage = usage_of([str(scripts / program), *arguments])
            return Figure([usage.ru_utime + usage.ru_stime], 0.0)
        found = json.loads(checkout.python("-c", WITHIN, problem.what, str(path), str(SLOW)))
    return Figure([statistics.median(found["seconds"])], found["megabytes"])


class _environment:  # noqa: N801 - used as a function
    """Variables of the environment while a block runs."""

    def __init__(self, variables: Mapping[str, str]) -> None:
        self._variables, self._before = variables, dict(os.environ)

    def __enter__(self) -> None:
        os.environ.update(self._variables)

    def __exit__(self, *_: object) -> None:
        os.environ.clear()
        os.environ.update(self._before)


def peers_of(problem: Problem, known: dict[str, Any]) -> dict[str, Callable[[], Figure]]:
    """The peers of a case that are here, each of which gives the same tile; `known` are the blocks of smaller ones."""
    if not problem.peers:
        return {}
    design = Design.from_dict(problem.design)
    tiling = design.tessellate()
    if QHULL in problem.peers:
        return {QHULL: partial(run_qhull, design, [tile.outline.area for tile in tiling])}
    if not HAS_PEERS:
        return {}
    case, (record,) = Case(design.noded[0], design.group, design.lattice), [tile._record for tile in tiling]  # noqa: SLF001
    copies = peer.smallest_block(case, record, known.get(design.group.name))
    if problem.name.endswith("segments"):
        known[design.group.name] = copies
    segments = peer.block_segments(case.site, peer.block_nodes(case.site, case.lattice, copies))
    size = len(case.site.segments)
    found: dict[str, Callable[[], Figure]] = {PYVORONOI: lambda: Figure([peer.run_peer(segments, size)[0]], 0.0)}
    try:
        _, reading = boost.run_boost(segments, size)
    except MissingError:
        return found
    assert abs(peer.tile_area(reading, segments) / record.outline.area - 1) <= AGREEMENT
    runs = max(1, min(200, 5_000 // size))
    found[BOOST] = lambda: Figure([statistics.median(boost.run_boost(segments, size, runs)[0])], 0.0)
    return found


def run_qhull(design: Design, areas: Sequence[float]) -> Figure:
    """Scipy's Voronoi diagram of points in 3 x 3 cells; the cells in the middle must have these areas."""
    from scipy.spatial import Voronoi

    own = np.array([site.nodes[0] for site in design.noded])
    a, b = design.lattice.a, design.lattice.b
    cell: list[NDArray[np.complex128]] = []
    for operation in design.group.operations:  # the identity first
        images = design.lattice.isometry(operation)(own)
        x, y = design.lattice.fractional(images)
        cell.append(images - np.floor(x) * a - np.floor(y) * b)
    assert (cell[0] == own).all(), "the points lie in the cell"
    places = np.concatenate([np.concatenate(cell) + i * a + j * b for i, j in product((0, -1, 1), repeat=2)])
    plane = np.stack((places.real, places.imag), axis=1)
    runs: list[float] = []
    while len(runs) < 5:
        begun = time.process_time()
        diagram = Voronoi(plane)
        runs.append(time.process_time() - begun)
    for number, area in enumerate(areas):
        corners = diagram.vertices[diagram.regions[diagram.point_region[number]]] @ [1, 1j]
        corners = corners[np.argsort(np.angle(corners - own[number]))] - own[number]
        twice = float((corners.conj() * np.roll(corners, -1)).imag.sum())
        assert abs(twice / 2 / area - 1) <= AGREEMENT
    return Figure([statistics.median(runs)], 0.0)


def in_turns(runners: Mapping[str, Callable[[], Figure]], rounds: int) -> dict[str, Figure]:
    """Run all, one after the other, so many times; what is slow once."""
    found: dict[str, Figure] = {}
    for number in range(rounds):
        for name, run in list(runners.items())[:: 1 if number % 2 else -1]:
            before = found.get(name)
            if before is not None and before.median > SLOW:
                continue
            figure = run()
            seconds = figure.seconds if before is None else before.seconds + figure.seconds
            found[name] = Figure(seconds, max(figure.megabytes, 0.0 if before is None else before.megabytes))
    return found


# The tables


def verdicts(figures: Mapping[str, Mapping[str, Figure]]) -> list[tuple[Target, float]]:
    """The targets of which both figures are there, with their ratios."""
    found = []
    for target in targets():
        over, under = (figures.get(case, {}).get(column) for case, column in (target.over, target.under))
        if over is not None and under is not None:
            memory = target.of == "memory"
            ratio = over.megabytes / under.megabytes if memory else over.median / under.median
            found.append((target, ratio))
    return found


def print_tables(figures: Mapping[str, Mapping[str, Figure]]) -> None:
    """Print the ratios with what was asked, and the figures that they are of."""
    table("What was asked, and what is reached:", "reached", "ratio", "asked", "of", "what")
    for target, ratio in verdicts(figures):
        (case, column), (other, reference) = target.over, target.under
        names = f"{column} / {reference}" if case == other else f"{case} / {other}"
        reached = "yes" if target.met(ratio) else "**no**"
        print(f"| {reached} | {ratio:.3g} | {target.asked()} | {case}, {target.of} | {names} |")
    columns = [name for name in COLUMNS if any(name in row for row in figures.values())]
    table("Processor time, medians and the range of all runs (ms); memory at its peak (MB):", "case", *columns)
    for case, row in figures.items():
        print(f"| {' | '.join([case, *(_cell(row.get(name)) for name in columns)])} |")


def _cell(figure: Figure | None) -> str:
    """Write a figure."""
    if figure is None:
        return "-"
    low, middle, high = (1000 * value for value in (min(figure.seconds), figure.median, max(figure.seconds)))
    spread = f" ({low:.3g} to {high:.3g})" if len(figure.seconds) > 1 else ""
    return f"{middle:.4g}{spread}" + (f"; {figure.megabytes:.0f}" if figure.megabytes else "")


def compare(options: argparse.Namespace, keep: Path) -> bool:
    """Measure, and print the tables; whether all that was asked is reached."""
    old, new = checkouts(options.commit, keep)
    print(f"{machine()}; {boost.described() if HAS_PEERS else 'without Boost.Polygon: pyvoronoi is missing'}")
    print(f"\nThis working tree against {options.commit} ({OLD}), {options.rounds} rounds in turns, 1 of what is slow.")
    figures: dict[str, dict[str, Figure]] = {}
    known: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as name:
        for problem in problems():
            if options.only and not any(word in problem.name for word in options.only):
                continue
            run = partial(run_checkout, problem, folder=Path(name))
            runners: dict[str, Callable[[], Figure]] = {NEW: partial(run, new, variables={})}
            if options.numpy and problem.name != "import numpy":
                runners[NUMPY] = partial(run, new, variables={"VORONOI_TILES_KERNELS": "numpy"})
            if problem.old:
                runners[OLD] = partial(run, old, variables={})
            runners |= peers_of(problem, known)
            figures[problem.name] = in_turns(runners, options.rounds)
            told = ", ".join(f"{who} {1000 * figure.median:.3g}" for who, figure in figures[problem.name].items())
            print(f"{problem.name}: {told} ms", file=sys.stderr)
    print_tables(figures)
    return all(target.met(ratio) for target, ratio in verdicts(figures))


def main() -> None:
    """Compare; exit with MISSED where something that was asked is not reached."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commit", nargs="?", default="1e5cef8")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--numpy", action="store_true", help="measure without the kernels too")
    parser.add_argument("--only", nargs="+", metavar="WORD", help="the cases whose names have one of these words")
    parser.add_argument("--keep", type=Path, metavar="FOLDER")
    parser.add_argument("--write", action="store_true", help="put the tables into bench/README.md")
    options = parser.parse_args()
    if options.write and options.only:
        parser.error("--write needs all cases: leave --only out")
    with tempfile.TemporaryDirectory() as folder, published("targets", write=options.write):
        reached = compare(options, (options.keep or Path(folder)).resolve())
    sys.exit(0 if reached else MISSED)


if __name__ == "__main__":
    main()

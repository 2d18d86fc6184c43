"""Random designs through the whole pipeline: `make fuzz N=10000`, or in tests/ `python -m helpers.fuzz 10000 --jobs 2`.

Each design is either tiled, with the proof, the cross-check and a spot check by brute force passed, or refused because
copies touch, which shapely confirms at the place that the message names. All else is a failure: exit status 1, and the
design is printed. Design k of a seed is the same whatever the number of designs. Every fifth of a run is of a kind that
came later; those are numbered from LATER on.
"""
# ruff: noqa: T201 - its result is what it prints

from __future__ import annotations

import argparse
import json
import multiprocessing
import signal
import sys
import time
import traceback
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from helpers import brute, strategies
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.site import NodedSite

LATER = 10**9
"""The number of the first design of the kinds that came later."""

TOUCHING = 1e-11
"""Copies nearer than this, relative to the cell, may be refused: ten times the accuracy that is promised."""

SECONDS = 300
"""How long one design may take."""


@dataclass(frozen=True)
class Outcome:
    """What became of a design: "tiled", "refused", or what went wrong."""

    number: int
    kind: str
    result: str
    seconds: float


def design_of(seed: int, number: int) -> tuple[str, dict[str, Any]]:
    """The kind of a design and the design."""
    return strategies.make_design(strategies.Dice(np.random.default_rng([seed, number])), later=number >= LATER)


def try_design(design: dict[str, Any], rng: np.random.Generator, points: int = 6) -> str:
    """Tile a design and check the result: "tiled", "refused", or what went wrong."""
    # As the design file has it, not the numbers that the generator holds.
    text = json.dumps(design)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            read = Design.loads(text, format="json")
            tiling = read.tessellate()
            document = tiling.document()
            check = tiling.check(samples=96, renderer="cpu")
    except TouchingCopiesError as error:
        return _refusal(read, error)
    except Exception as error:  # noqa: BLE001 - whatever comes out is a finding
        frame = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__}: {error} ({frame.name}, line {frame.lineno})"
    if not check.passed:
        return f"the cross-check fails: {', '.join(check.failures)}"
    plane = brute.Plane.of(document)
    # Far from the origin the coordinates are no finer than the gap in question.
    touching = contact(plane, 1e-15 * plane.size) if plane.slack < 2 * brute.LIMIT * plane.size else ""
    if touching:
        return f"tiled, though copies touch: {touching}"
    found = brute.complaints(document, rng, points=points, edges=points)
    return "; ".join(found[:3]) or "tiled"


def _refusal(read: Design, error: TouchingCopiesError) -> str:
    """Confirm that copies touch where the error says so."""
    sites: dict[str, NodedSite] = {site.name: site for site in read.noded}
    elements = {name: site.elements for name, site in sites.items()}
    plane = brute.Plane(read.group.name, read.lattice.a, read.lattice.b, elements)
    here, there = plane.names.index(error.site), plane.names.index(error.other)
    motion = brute.read_operation(plane.group, str(error.operation))
    if here == there and motion in plane.symmetries(here):
        return f"refused, but {error.operation} maps the site onto itself"
    gap = shapely.distance(geometry(plane, here), geometry(plane, there, motion))
    place = np.array([error.place])
    away = max(plane.distance(here, place)[0], plane.distance(there, plane.pull(motion, place))[0])
    if max(gap, away) <= max(plane.slack, TOUCHING * 1.01 * plane.size):
        return "refused"
    return f"refused, but the copies are {gap / plane.size:.3g} of the cell apart, the place {away / plane.size:.3g}"


def geometry(plane: brute.Plane, site: int, motion: brute.Motion | None = None) -> shapely.Geometry:
    """A copy of a site for shapely."""
    ends = np.stack([plane.starts[site], plane.ends[site]], axis=1)
    moved = plane.push(motion, ends) if motion else ends
    return shapely.multilinestrings(shapely.linestrings(np.stack([moved.real, moved.imag], axis=-1)))


def contact(plane: brute.Plane, limit: float) -> str:
    """Name two copies that are no farther apart than `limit`; nothing where there are none."""
    p, q = plane.reduced
    det = abs((np.conj(p) * q).imag)
    for here, centre in enumerate(plane.centres):
        for there in range(here, len(plane.names)):
            same = plane.symmetries(here) if here == there else []
            reach = plane.radii[here] + plane.radii[there] + limit
            for motion in brute.motions(plane.group):
                away = centre - complex(plane.push(motion, np.array([plane.centres[there]]))[0])
                x = (away.real * plane.b.imag - away.imag * plane.b.real) / plane.det
                y = (plane.a.real * away.imag - plane.a.imag * away.real) / plane.det
                m, n = (int(reach * abs(v) / det + 1.5) for v in (plane.b, plane.a))
                for i, j in np.ndindex(2 * m + 1, 2 * n + 1):
                    copy = motion.then(round(x) + i - m, round(y) + j - n)
                    centred = plane.push(copy, np.array([plane.centres[there]]))[0]
                    if abs(centred - centre) > reach or copy in same:
                        continue
                    gap = float(shapely.distance(geometry(plane, here), geometry(plane, there, copy)))
                    if gap <= limit:
                        return f"{plane.names[here]} and {plane.names[there]} under {copy}, {gap} apart"
    return ""


def _alarm(*_: object) -> None:
    raise TimeoutError(f"took more than {SECONDS} s")


def run_one(task: tuple[int, int]) -> Outcome:
    """Make and try one design."""
    seed, number = task
    start = time.perf_counter()
    kind, design = design_of(seed, number)
    signal.signal(signal.SIGALRM, _alarm)
    signal.alarm(SECONDS)
    try:
        result = try_design(design, np.random.default_rng([seed, number, 1]))
    except Exception as error:  # noqa: BLE001 - the oracle's own trouble is a finding too
        result = f"in the check: {type(error).__name__}: {error}"
    finally:
        signal.alarm(0)
    return Outcome(number, kind, result, time.perf_counter() - start)


def run_many(seed: int, numbers: Sequence[int], jobs: int) -> Iterator[Outcome]:
    """Try many designs in so many processes."""
    tasks = ((seed, number) for number in numbers)
    if jobs == 1:
        yield from map(run_one, tasks)
        return
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        yield from pool.imap_unordered(run_one, tasks, chunksize=16)


def table(outcomes: list[Outcome]) -> str:
    """Sum up by kind."""
    rows = [f"{'kind':<16}{'designs':>9}{'tiled':>9}{'refused':>9}{'failed':>9}{'median':>10}{'longest':>10}"]
    for kind in [*strategies.KINDS, *strategies.LATER, "all"]:
        chosen = [o for o in outcomes if kind in (o.kind, "all")]
        if chosen:
            tiled, refused = (sum(o.result == result for o in chosen) for result in ("tiled", "refused"))
            times = np.array([o.seconds for o in chosen]) * 1e3
            counts = f"{len(chosen):>9}{tiled:>9}{refused:>9}{len(chosen) - tiled - refused:>9}"
            rows.append(f"{kind:<16}{counts}{np.median(times):>7.0f} ms{times.max():>7.0f} ms")
    return "\n".join(rows)


def main(arguments: list[str] | None = None) -> int:
    """Run the script; 1 if any design failed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("count", type=int, nargs="?", default=500, help="how many designs (500)")
    parser.add_argument("--seed", type=int, default=1, help="another seed, other designs (1)")
    parser.add_argument("--first", type=int, default=0, help="how many designs to pass over (0)")
    parser.add_argument("--only", type=int, help="print this one design and try it")
    parser.add_argument("--jobs", type=int, default=multiprocessing.cpu_count(), help="processes (all cores)")
    options = parser.parse_args(arguments)
    last = options.first + options.count
    # One in five is of a later kind.
    numbers = [LATER + k // 5 if k % 5 == 4 else k - k // 5 for k in range(options.first, last)]
    if options.only is not None:
        numbers = [options.only]
        options.jobs = 1
        print(json.dumps(design_of(options.seed, options.only)[1], indent=1))
    outcomes: list[Outcome] = []
    start = time.perf_counter()
    for outcome in run_many(options.seed, numbers, options.jobs):
        outcomes.append(outcome)
        if outcome.result not in {"tiled", "refused"}:
            text = json.dumps(design_of(options.seed, outcome.number)[1])
            print(f"design {outcome.number} ({outcome.kind}): {outcome.result}")
            print(f"    (cd tests && python -m helpers.fuzz --seed {options.seed} --only {outcome.number})")
            print(f"    {text if len(text) < 2000 else text[:2000] + ' ...'}", flush=True)
        if sys.stderr.isatty():
            print(f"\r{len(outcomes)}/{len(numbers)}", end="", file=sys.stderr)
    seconds = time.perf_counter() - start
    print(table(outcomes))
    print(f"{len(outcomes)} designs in {seconds:.0f} s, {len(outcomes) / seconds:.0f} per second, seed {options.seed}")
    return int(any(outcome.result not in {"tiled", "refused"} for outcome in outcomes))


if __name__ == "__main__":
    sys.exit(main())

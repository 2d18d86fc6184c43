"""How many cubic Bezier curves replace the edges of the examples' tiles, beside kurbo's `fit_to_bezpath` (kurbopy).

Both get the smooth runs between corners and long lines of one edge of each orbit, with the same accuracy. How far the
curves are is measured by dense samples of both; ours are bounded, kurbo's looked at. Times are processor time.

    python bench/cubics.py                          at 0.005 mm
    python bench/cubics.py --accuracy 0.02 --write  also: the table into bench/README.md
"""

from __future__ import annotations

import argparse
import time
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import kurbopy
import numpy as np
import shapely
from report import machine, published, table

from voronoi_tiles import Design
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.fabrication.arc_fitting import ABSORBED, JOINT, edge_arcs
from voronoi_tiles.paths.fewest_cubics import to_fewest_cubics
from voronoi_tiles.paths.paths import CUBIC, LINE, QUAD, Paths

EXAMPLES: Final = Path(__file__).parents[1] / "examples"
SAMPLES: Final = 30


class Run:
    """Lines and quadratic curves that join smoothly, as kurbo wants a curve: points and derivatives from 0 to 1."""

    def __init__(self, run: Paths) -> None:
        self.run = run
        self.places = np.append(0.0, np.cumsum(run.lengths)) / run.lengths.sum()

    def _at(self, t: float, sign: float) -> tuple[complex, complex]:
        """The point and the derivative at a parameter, as it is reached from one side."""
        after = np.searchsorted(self.places, t, "right") if sign >= 0 else np.searchsorted(self.places, t, "left")
        k = int(np.clip(after - 1, 0, len(self.run.start) - 1))
        width = self.places[k + 1] - self.places[k]
        u = (t - self.places[k]) / width
        a, c = self.run.start[k], self.run.end[k]
        b = self.run.control[k, 0] if self.run.kind[k] == QUAD else (a + c) / 2
        return a * (1 - u) ** 2 + 2 * b * u * (1 - u) + c * u * u, 2 * ((b - a) * (1 - u) + (c - b) * u) / width

    def sample_pt_tangent(self, t: float, sign: float) -> tuple[kurbopy.Point, kurbopy.Vec2]:
        """A point and the tangent there."""
        point, along = self._at(t, sign)
        return kurbopy.Point(point.real, point.imag), kurbopy.Vec2(along.real, along.imag)

    def sample_pt_deriv(self, t: float) -> tuple[kurbopy.Point, kurbopy.Vec2]:
        """A point and the derivative there."""
        return self.sample_pt_tangent(t, 1.0)

    def break_cusp(self, start: float, end: float) -> None:
        """Where a corner is: nowhere."""


def kurbo_fit(run: Paths, accuracy: float) -> Paths:
    """The cubic curves that kurbo puts in the place of a run."""
    fitted = kurbopy.fit_to_bezpath(Run(run), accuracy)
    # Each segment is a curve of its kind.
    points = [[complex(p.x, p.y) for p in (s.p0, s.p1, s.p2, s.p3)] for s in fitted.segments()]
    control = np.array(points)
    count = len(control)
    return _open(control[:, 0], control[:, 3], control[:, 1:3], np.full(count, CUBIC, np.uint8))


def exact_edges(name: str) -> list[Paths]:
    """The exact edges of an example's tiles, one of each orbit; millimetres."""
    made = Design.load(EXAMPLES / f"{name}.toml").tessellate()
    edges = made.tessellation.quotient.paths().moved(made.design.unit_mm, 0j)
    return [edges.take(np.array([k])) for k in range(len(edges))]


def smooth_runs(path: Paths, accuracy: float) -> list[Paths]:
    """A path cut at its corners and beside its long lines, without these."""
    first = np.where(path.kind == QUAD, path.control[:, 0] - path.start, path.end - path.start)
    last = np.where(path.kind == QUAD, path.end - path.control[:, 0], path.end - path.start)
    turn = np.abs(np.angle(first[1:] / last[:-1]))
    long = (path.kind == LINE) & (path.lengths >= ABSORBED * accuracy)
    breaks = [0, *(np.flatnonzero((turn > JOINT) | long[1:] | long[:-1]) + 1).tolist(), len(path.start)]
    return [
        _open(path.start[a:b], path.end[a:b], path.control[a:b], path.kind[a:b])
        for a, b in pairwise(breaks)
        if not long[a]
    ]


def _open(start: Complexes, end: Complexes, control: Complexes, kind: Any) -> Paths:
    """One open path."""
    return Paths(start, end, control, kind, np.array([0, len(start)]), np.zeros(1, np.bool_))


def farthest(one: Paths, other: Paths) -> float:
    """The largest distance of samples of either path from the chords between those of the other; about the real one."""
    p, q = _samples(one), _samples(other)
    return max(_off(p, q), _off(q, p))


def _off(points: Complexes, line: Complexes) -> float:
    """The largest distance of points from the chords between others."""
    xy = shapely.points(points.real, points.imag)
    ends = np.column_stack((line.real, line.imag))
    tree = shapely.STRtree(shapely.linestrings(np.stack((ends[:-1], ends[1:]), axis=1)))
    return float(tree.query_nearest(xy, all_matches=False, return_distance=True)[1].max())


def _samples(path: Paths) -> Complexes:
    """Dense points of a path."""
    t = np.linspace(0.0, 1.0, max(SAMPLES, 20_000 // len(path.start)))[:, None]
    s = 1 - t
    a, (b, c), d = path.start, path.control.T, path.end
    b, c = (
        np.where(path.kind == CUBIC, b, a + (np.where(path.kind == QUAD, b, (a + d) / 2) - a) * (2 / 3)),
        np.where(path.kind == CUBIC, c, d + (np.where(path.kind == QUAD, b, (a + d) / 2) - d) * (2 / 3)),
    )
    return np.asarray((a * s**3 + 3 * b * s * s * t + 3 * c * s * t * t + d * t**3).T.ravel())


def compare(accuracy: float) -> None:
    """Print the table."""
    print(f"{machine()}\n\nAccuracy {accuracy:g} mm.")
    heads = "ratio", "ours", "kurbo", "exact", "arcs", "ours, mm", "kurbo, mm", "ours, ms", "kurbo, ms", "example"
    table("Ratio = our cubic curves / kurbo's, of smooth runs; how far each is:", *heads)
    totals = np.zeros(4, int)
    for name in sorted(path.stem for path in EXAMPLES.glob("*.toml")):
        runs = [run for edge in exact_edges(name) for run in smooth_runs(edge, accuracy)]
        before = time.process_time()
        ours = [to_fewest_cubics(run, accuracy=accuracy, corner=JOINT, absorbed=ABSORBED * accuracy) for run in runs]
        between = time.process_time()
        theirs = [kurbo_fit(run, accuracy) for run in runs]
        after = time.process_time()
        arcs = edge_arcs(Paths.concatenate(runs), accuracy=accuracy, absorbed=ABSORBED * accuracy)
        counts = [sum(len(path.kind) for path in paths) for paths in (ours, theirs, runs)] + [len(arcs.kind)]
        far = [max(farthest(run, path) for run, path in zip(runs, paths, strict=True)) for paths in (ours, theirs)]
        totals += counts
        print(
            f"| {counts[0] / counts[1]:.2f} | {' | '.join(map(str, counts))} | {far[0]:.4f} | {far[1]:.4f} | "
            f"{1e3 * (between - before):.0f} | {1e3 * (after - between):.0f} | {name} |",
            flush=True,
        )
    print(f"| {totals[0] / totals[1]:.2f} | {' | '.join(map(str, totals))} | | | | | all |")


def main() -> None:
    """Compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--accuracy", type=float, default=0.005, help="millimetres")
    parser.add_argument("--write", action="store_true", help="put the table into README.md")
    arguments = parser.parse_args()
    with published("cubics", write=arguments.write):
        compare(arguments.accuracy)


if __name__ == "__main__":
    main()

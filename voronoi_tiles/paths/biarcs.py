"""Bezier curves replaced by lines and circular arcs within an accuracy: the fewest biarcs along smooth runs."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints
from voronoi_tiles.paths.biarc_bounds import fit
from voronoi_tiles.paths.conversion import usable
from voronoi_tiles.paths.curved_runs import CORNER, Drawn, RunCurves, replace_runs, stretch_ends
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.paths.segmentation import even_stretches, longest_stretches
from voronoi_tiles.paths.smooth_runs import SmoothRuns

FLAT: Final = 1e-9
"""An arc whose sagitta is below this is a line; relative to the accuracy."""


def to_arcs(paths: Paths, *, accuracy: float, corner: float = CORNER, absorbed: float = 0.0) -> Paths:
    """Replace every QUAD and CUBIC by LINEs and ARCs within `accuracy`, by the fewest biarcs; all else stays as it is.

    The Hausdorff distance between old and new curves is at most `accuracy` (in the paths' unit) both ways; it is
    bounded, not sampled. A path is cut at its corners, where tangents differ by more than `corner` (radians), and into
    runs of curved segments that join smoothly, whose end points stay; LINEs shorter than `absorbed` count as curved.
    Along a run, one biarc after the other takes the longest stretch that it follows within the accuracy: two arcs of
    at most half a turn, tangent to the curve at both ends. Where one arc or one line between the same ends does, it
    stands instead. Then the breaks between the biarcs are moved, at the same count, to spread the error evenly.
    Neighbouring segments share their points bit for bit, and a run gives the same bits, reversed, when it is run
    through backwards, and whatever else is in `paths`.

    Taking the longest stretch first gives the fewest, if a part of a feasible stretch is feasible: by induction the
    k-th break then lies no earlier than that of any other choice. Biarcs have this property where the curve's
    curvature is monotone (their error grows with the stretch at either end), and nearly so elsewhere; a longest
    stretch is found to about 0.4 percent. Where the assumption fails, the accuracy still holds, but the count may be
    above the least; runs are covered from either end, and what takes fewer segments is kept. What no biarc can
    follow, cusps above all, is bridged by lines within the accuracy.

    A closed path that began within a run begins at the end of that run instead; one that is all one run is cut where
    it began. Curved segments of length 0 vanish, unless a path has nothing else: then one line of length 0 stays.

    Raises ValueError where the accuracy is not positive and finite, or finer than the coordinates' resolution.

    Source: Meek, Walton, Approximating smooth planar curves by arc splines, J. Comput. Appl. Math. 59 (1995).
    """
    bound = usable(paths, accuracy)
    return replace_runs(paths, corner, absorbed, partial(_draw, bound=bound, flat=FLAT * accuracy))


def _draw(runs: SmoothRuns, curves: RunCurves, bound: float, flat: float) -> Drawn:
    """Draw a line, an arc or a biarc for each stretch of runs, whichever is the simplest within the bound."""

    def error_of(run: Ints, low: Floats, high: Floats) -> Floats:
        """The bounds of the best fits."""
        return fit(runs, run, low, high).best

    longest = longest_stretches(runs.total, bound, error_of, 3)
    stretches = even_stretches(runs.total, longest, bound, error_of, 3)
    run = stretches.run
    shape = fit(runs, *stretches)
    assert np.all(shape.best <= bound)
    straight = shape.line <= bound
    double = ~straight & (shape.arc > bound)
    start, end = stretch_ends(runs, curves, stretches)
    joint = start + shape.joint_x + 1j * shape.joint_y
    row = np.repeat(np.arange(len(run)), 1 + double)
    second = np.append(False, row[1:] == row[:-1])
    turn = np.where(double[row], np.where(second, shape.turn2[row], shape.turn1[row]), shape.turn[row])
    p = np.where(second, joint[row], start[row])
    q = np.where(double[row] & ~second, joint[row], end[row])
    bulge = np.tan(np.where(straight[row], 0.0, turn) / 4) / 2
    middle = np.empty(len(row), np.complex128)
    middle.real = (p.real + q.real) / 2 + bulge * (q.imag - p.imag)
    middle.imag = (p.imag + q.imag) / 2 - bulge * (q.real - p.real)
    round_ = np.abs(bulge) * np.abs(q - p) > flat
    control = np.zeros((len(row), 2), np.complex128)
    control[:, 0] = np.where(round_, middle, 0)
    return Drawn(run[row], p, q, control, np.where(round_, np.uint8(ARC), np.uint8(LINE)))

"""Curves replaced by the fewest cubic Bezier curves within an accuracy, along smooth runs."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints
from voronoi_tiles.paths.conversion import to_cubics, usable
from voronoi_tiles.paths.cubic_fit import fit_cubics
from voronoi_tiles.paths.curved_runs import CORNER, Drawn, RunCurves, replace_runs, stretch_ends
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, Paths
from voronoi_tiles.paths.segmentation import even_stretches, longest_stretches
from voronoi_tiles.paths.smooth_runs import SmoothRuns

_ROUND: Final = 0.01
"""How far the cubic curves that circular arcs are seen as may be from these; relative to the accuracy."""

_FLAT: Final = 1e-9
"""A curve whose control points are nearer than this to the line between its ends is a line; relative to the
accuracy."""


def to_fewest_cubics(paths: Paths, *, accuracy: float, corner: float = CORNER, absorbed: float = 0.0) -> Paths:
    """Replace every QUAD, CUBIC and ARC by CUBICs within `accuracy`, by the fewest; all else stays as it is.

    The Hausdorff distance between old and new curves is at most `accuracy` (in the paths' unit) both ways; it is
    bounded, not sampled. Paths are cut and runs replaced as in `to_arcs`, which has the words: corners are where
    tangents differ by more than `corner` (radians), and stay; LINEs shorter than `absorbed` count as curved. Along a
    run, one curve after the other takes the longest stretch that it follows within the accuracy, with the run's
    tangents at both ends: so all curves of a run join with continuous tangents. Then the breaks are moved, at the same
    count, to spread the error evenly. What is straight is a LINE.

    Raises ValueError where the accuracy is not positive and finite, or finer than the coordinates' resolution.
    """
    bound = usable(paths, accuracy)
    if (paths.kind == ARC).any():
        paths = to_cubics(paths, accuracy=_ROUND * accuracy)
        bound -= _ROUND * accuracy
    return replace_runs(paths, corner, absorbed, partial(_draw, bound=bound, flat=_FLAT * accuracy))


def _draw(runs: SmoothRuns, curves: RunCurves, bound: float, flat: float) -> Drawn:
    """Draw a cubic curve for each stretch of runs."""

    def error_of(run: Ints, low: Floats, high: Floats) -> Floats:
        """The bounds of the fits."""
        return fit_cubics(runs, run, low, high).bound

    longest = longest_stretches(runs, bound, error_of, 6)
    stretches = even_stretches(runs, longest, bound, error_of, 6)
    fit = fit_cubics(runs, *stretches)
    assert np.all(fit.bound <= bound)
    start, end = stretch_ends(runs, curves, stretches)
    x, y = fit.curves
    control = np.empty((len(start), 2), np.complex128)
    control.real = start.real[:, None] + x[1:3].T
    control.imag = start.imag[:, None] + y[1:3].T
    chord = np.hypot(x[3], y[3])
    across = np.max(np.abs(x[1:3] * y[3] - y[1:3] * x[3]), axis=0)
    straight = across <= flat * chord
    control[straight] = 0
    return Drawn(stretches.run, start, end, control, np.where(straight, np.uint8(LINE), np.uint8(CUBIC)))

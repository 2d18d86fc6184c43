"""Curves in the place of the exact edges of a period, the same ones wherever symmetry maps an edge.

What replaces an edge (arcs for a machine that knows no parabolas) has to be the same for every image of it: then copies
of a tile stay congruent, a symmetric tile stays symmetric, and what lies between two tiles stays one line.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from voronoi_tiles.paths.paths import LINE, Paths
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.complex.quotient import Quotient
from voronoi_tiles.vector.motions import Action, Motion


def approximated(period: Period, quotient: Quotient, fit: Callable[[Paths], Paths]) -> Period:
    """Replace all edges by images of what `fit` gives for the one that stands for each orbit.

    `fit` replaces every path by another one from the same start to the same end. Of an edge that a motion maps onto
    itself backwards it gets one half. It is not asked about edges that are one straight line, as all on mirrors are.
    The period stands in the design's own frame.
    """
    action = quotient.representatives.action
    exact = quotient.paths()
    originals = [exact.take(np.array([k])) for k in range(len(exact))]
    straight = [edge.kind.tolist() == [LINE] for edge in originals]
    reversals = [edge.reversal for edge in quotient.edges]
    asked = [
        edge if reversal is None else _first_half(edge)
        for edge, line, reversal in zip(originals, straight, reversals, strict=True)
        if not line
    ]
    fitted = fit(Paths.concatenate(asked)) if asked else Paths.empty()
    answers = iter(range(len(fitted)))
    whole = []
    for edge, line, reversal in zip(originals, straight, reversals, strict=True):
        answer = edge if line else fitted.take(np.array([next(answers)]))
        whole.append(answer if line or reversal is None else _doubled(answer, edge, action, reversal))
    images = [
        _moved(whole[k], action, motion) for k, motion in zip(period.orbit.tolist(), period.edge_motion, strict=True)
    ]
    return replace(period, edges=Paths.concatenate(images))


def _moved(path: Paths, action: Action, motion: Motion) -> Paths:
    """Return the image of a path."""
    unit, conj = action.linear[motion[:4]]
    return path.moved(unit, complex(action.cartesian(motion[4] / 2, motion[5] / 2)), conj=conj)


def _first_half(path: Paths) -> Paths:
    """Return the first half of a path of lines and quadratic curves that is its own image backwards."""
    count = len(path.start)
    half, odd = divmod(count, 2)
    kept = half + odd
    start, end, control = path.start[:kept].copy(), path.end[:kept].copy(), path.control[:kept].copy()
    if odd:
        a, b, c = start[half], control[half, 0], end[half]
        if path.kind[half] > 0:
            control[half, 0] = (a + b) / 2
            end[half] = (a + 2 * b + c) / 4
        else:
            end[half] = (a + c) / 2
    return replace(path, start=start, end=end, control=control, kind=path.kind[:kept], offsets=np.array([0, kept]))


def _doubled(half: Paths, original: Paths, action: Action, reversal: Motion) -> Paths:
    """Return a half followed by its image."""
    other = _moved(half, action, reversal).reversed()
    other.start[0] = half.end[-1]
    other.end[-1] = original.end[-1]
    both = Paths.concatenate([half, other])
    return replace(both, offsets=np.array([0, len(both.start)]), closed=half.closed)

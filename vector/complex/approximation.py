"""Curves in the place of the exact edges of a period, the same ones wherever symmetry maps an edge.

What replaces an edge (arcs for a machine that knows no parabolas) has to be the same for every image of it: then copies
of a tile stay congruent, a symmetric tile stays symmetric, and what lies between two tiles stays one line.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from voronoi_tiles.paths.paths import LINE, Paths
from voronoi_tiles.paths.symmetric_halves import doubled, first_half, moved
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.complex.quotient import Quotient


def approximated(period: Period, quotient: Quotient, fit: Callable[[Paths], Paths]) -> Period:
    """A period whose edges are images of what `fit` gives for the one that stands for each orbit.

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
        edge if reversal is None else first_half(edge)
        for edge, line, reversal in zip(originals, straight, reversals, strict=True)
        if not line
    ]
    fitted = fit(Paths.concatenate(asked)) if asked else Paths.empty()
    answers = iter(range(len(fitted)))
    whole = []
    for edge, line, reversal in zip(originals, straight, reversals, strict=True):
        answer = edge if line else fitted.take(np.array([next(answers)]))
        whole.append(
            answer if line or reversal is None else doubled(answer, action.isometry(reversal), complex(edge.end[-1]))
        )
    images = [
        moved(whole[k], action.isometry(motion))
        for k, motion in zip(period.orbit.tolist(), period.edge_motion, strict=True)
    ]
    return replace(period, edges=Paths.concatenate(images))

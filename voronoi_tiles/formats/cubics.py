"""Every segment of a path as a line or a cubic Bezier curve, for file formats that know no other curve."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.formats.page import Layer
from voronoi_tiles.paths.conversion import to_cubics
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, Paths

CUBIC_ACCURACY_MM: Final = 1e-6
"""How far a cubic curve may be from a circular arc that it stands for; millimetres: what files hold anyway."""

_BLOCK: Final = 1 << 16  # segments that a writer holds as text at a time


def cubic_blocks(layer: Layer) -> Iterator[tuple[Paths, Ints]]:
    """The items of a layer in blocks of bounded size, as lines and cubic curves.

    Gives the paths of a block, and where its items begin and end among them (intp, items + 1). Circular arcs are
    replaced within CUBIC_ACCURACY_MM.
    """
    segments, count = layer.paths.offsets[layer.items], len(layer.items) - 1
    first = 0
    while first < count:
        fitting = int(np.searchsorted(segments, segments[first] + _BLOCK, side="right")) - 1
        stop = max(min(fitting, count), first + 1)
        chosen = np.arange(layer.items[first], layer.items[stop])
        yield (
            to_cubics(layer.paths.take(chosen), accuracy=CUBIC_ACCURACY_MM),
            layer.items[first : stop + 1] - layer.items[first],
        )
        first = stop


def all_cubic(paths: Paths) -> Paths:
    """The same paths with CUBIC in the place of LINE and QUAD, exactly. Raises ValueError for ARC."""
    if (paths.kind == ARC).any():
        raise ValueError("an arc is no cubic curve")
    raised = to_cubics(paths, accuracy=1.0)  # exact, without arcs
    straight = np.flatnonzero(raised.kind == LINE)
    begin, stop = raised.start[straight], raised.end[straight]
    kind, control = raised.kind.copy(), raised.control.copy()
    control[straight] = np.stack((begin + (stop - begin) / 3, stop + (begin - stop) / 3), axis=1)
    kind[straight] = CUBIC
    return replace(raised, kind=kind, control=control)

"""Tiles on the axes of matplotlib, which is there for those who have it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, assert_never

import numpy as np

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.base.errors import MissingLibraryError
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.vector.arcs import LineArc, ParabolaArc
from voronoi_tiles.vector.outline import Outline


def axes_of(axes: Any) -> Any:
    """The axes to draw on, those of the current figure where there are none given, with one scale both ways.

    Raises MissingLibraryError where matplotlib is not installed.
    """
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise MissingLibraryError(
            "plots are drawn by matplotlib, which is not installed", remedy="Install it: pip install matplotlib."
        ) from error
    axes = plt.gca() if axes is None else axes
    axes.set_aspect("equal")
    return axes


def plot_copies(
    axes: Any, tiles: Mapping[str, tuple[Outline, Complexes]], copies: Iterable[tuple[str, Outline]]
) -> Any:
    """Draw tiles by their names, with the ends of their sites' elements, over copies of them, in a colour each.

    `axes` are as in `axes_of`, and given back.
    """
    axes = axes_of(axes)
    colours = dict(zip(tiles, palette(len(tiles)) / 255, strict=True))
    beyond = list(copies)
    plot_tiles(axes, [(outline, None) for _, outline in beyond], [colours[name] for name, _ in beyond])
    plot_tiles(axes, tiles.values(), colours.values())
    return axes


def plot_tiles(axes: Any, tiles: Iterable[tuple[Outline, Complexes | None]], colours: Iterable[Any]) -> None:
    """Draw outlines, filled with a colour each, and the ends of their sites' elements (k, 2), where they are given.

    A parabola's arc is exactly one curve of matplotlib's. Coordinates are the design's, y up.
    """
    from matplotlib.collections import LineCollection
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    for (outline, ends), colour in zip(tiles, colours, strict=False):
        points: list[complex] = []
        codes: list[int] = []
        for ring in outline.rings:
            points.append(ring[0].start)
            codes.append(Path.MOVETO)
            for arc in ring:
                match arc:
                    case LineArc(_, end):
                        points.append(end)
                        codes.append(Path.LINETO)
                    case ParabolaArc(_, control, end):
                        points += [control, end]
                        codes += [Path.CURVE3] * 2
                    case _:
                        assert_never(arc)
            points.append(ring[0].start)
            codes.append(Path.CLOSEPOLY)
        axes.add_patch(
            PathPatch(
                Path(plane(np.array(points)), codes),
                facecolor=colour,
                edgecolor="black",
                linewidth=0.8,
            )
        )
        if ends is not None:
            axes.add_collection(LineCollection(plane(ends), colors="#b03020", linewidths=1.5, capstyle="round"))
    axes.autoscale_view()

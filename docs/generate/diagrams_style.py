"""How the drawings of the documentation look, and how they are written: the same bytes for the same numbers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

mpl.use("svg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Curve

from voronoi_tiles import Outline

Complexes = NDArray[np.complex128]

PICTURES = Path(__file__).parents[1] / "pictures"

INK = "#1d2733"
GREY = "#8a949e"
PALE = "#e9ecef"
LINE = "#1c6dd0"
PARABOLA = "#d9480f"
TILE = "#fdf0d5"
FIELDS = ("#f6c667", "#8fbfe0", "#f2a28c", "#a8d5a2", "#c9b1e0", "#f7dd8f", "#9ad1cb", "#e8b4cf")

_SETTINGS = {
    "svg.hashsalt": "voronoi_tiles",
    "svg.fonttype": "path",
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}


@contextmanager
def drawing(name: str, size: tuple[float, float], columns: int = 1, **options: Any) -> Iterator[tuple[Figure, Any]]:
    """A figure of `size` inches and its axes, which is written as docs/pictures/NAME, SVG or PNG by its suffix."""
    with mpl.rc_context(_SETTINGS):
        figure, axes = plt.subplots(1, columns, figsize=size, layout="constrained", **options)
        try:
            yield figure, axes
            PICTURES.mkdir(exist_ok=True)
            target = PICTURES / name
            # No date and no version: the same drawing is the same file.
            figure.savefig(target, metadata={"Date": None, "Creator": None} if target.suffix == ".svg" else {}, dpi=150)
            if target.suffix == ".svg":
                _shorten(target)
        finally:
            plt.close(figure)
    print(f"{target.relative_to(PICTURES.parents[1])}: {target.stat().st_size:,} bytes")


def _shorten(file: Path) -> None:
    """Round a drawing's coordinates to hundredths of a point, which no screen shows."""
    import re

    text = file.read_text(encoding="utf-8")
    text = re.sub(r"-?\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}".rstrip("0").rstrip("."), text)
    file.write_text("\n".join(line.rstrip() for line in text.splitlines()) + "\n", encoding="utf-8")


def bare(axes: Axes, points: Complexes, margin: float = 0.0) -> None:
    """Show the plane about some points, both axes in one scale and without frame."""
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(points.real.min() - margin, points.real.max() + margin)
    axes.set_ylim(points.imag.min() - margin, points.imag.max() + margin)


def curve_of(outline: Outline) -> Curve:
    """The rings of an outline as one exact path: lines and quadratic Bezier curves."""
    vertices: list[complex] = []
    codes: list[np.uint8] = []
    for first, last in zip(outline.ring_offsets[:-1], outline.ring_offsets[1:], strict=True):
        vertices.append(outline.start[first])
        codes.append(Curve.MOVETO)
        for k in range(first, last):
            if outline.curved[k]:
                vertices += [outline.control[k], outline.end[k]]
                codes += [Curve.CURVE3, Curve.CURVE3]
            else:
                vertices.append(outline.end[k])
                codes.append(Curve.LINETO)
        vertices.append(outline.start[first])
        codes.append(Curve.CLOSEPOLY)
    return Curve(_xy(np.array(vertices)), codes)


def fill(axes: Axes, outline: Outline, **style: Any) -> None:
    """Draw a tile as one area."""
    axes.add_patch(PathPatch(curve_of(outline), **{"lw": 0.7, "ec": "white", "joinstyle": "round", **style}))


def edges(axes: Axes, outline: Outline, width: float = 1.6) -> None:
    """Draw an outline's edges: lines in one colour, parabolas in another."""
    for curved, colour in ((False, LINE), (True, PARABOLA)):
        vertices: list[complex] = []
        codes: list[np.uint8] = []
        for k in np.flatnonzero(outline.curved == curved).tolist():
            vertices += [outline.start[k], outline.control[k], outline.end[k]]
            codes += [Curve.MOVETO, Curve.CURVE3, Curve.CURVE3]
        if vertices:
            path = Curve(_xy(np.array(vertices)), codes)
            axes.add_patch(PathPatch(path, fc="none", ec=colour, lw=width, capstyle="round", zorder=4))


def strokes(
    axes: Axes, elements: NDArray[np.float64], colour: str = INK, width: float = 1.6, size: float = 3.0
) -> None:
    """Draw a site: its segments, and a dot for every isolated point; elements of shape (n, 4)."""
    point = (elements[:, :2] == elements[:, 2:]).all(axis=1)
    lines = elements[~point]
    for run in _runs(lines):
        axes.plot(run[:, 0], run[:, 1], color=colour, lw=width, solid_capstyle="round", zorder=5)
    axes.plot(elements[point, 0], elements[point, 1], "o", color=colour, ms=size, mec="none", zorder=5)


def _runs(lines: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Segments as polylines, where one begins at the end of the one before."""
    breaks = np.flatnonzero((lines[1:, :2] != lines[:-1, 2:]).any(axis=1)) + 1
    return [np.concatenate([run[:1, :2], run[:, 2:]]) for run in np.split(lines, breaks) if len(run)]


def _xy(points: Complexes) -> NDArray[np.float64]:
    return np.stack([points.real, points.imag], axis=1)

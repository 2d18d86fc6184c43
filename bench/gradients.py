"""Gradients of a tile, beside differences of two tiles for each number of the design.

The design is a closed polyline in p4. A gradient is the velocities of 400 points of the outline by all coordinates, and
the derivatives of area and perimeter. Differences are those of two tiles a step of 1e-5 apart, for 20 of the
coordinates, and their time is taken times as many as there are. Times are processor time, tiles with their proof.

    python bench/gradients.py                 the comparison
    python bench/gradients.py --write         also: the table into bench/README.md
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Final, TypeVar

import numpy as np
from report import machine, published, table

import voronoi_tiles as vt

T = TypeVar("T")

SEGMENTS: Final = (24, 200, 1000)
POINTS: Final = 400
JUDGED: Final = 20
"""How many coordinates are changed in turn; a count."""

STEP: Final = 1e-5
RUNS: Final = 5


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="put the table into bench/README.md")
    with published("gradients", write=parser.parse_args().write):
        print(machine())
        heads = ("segments", "numbers", "tile", "gradient", "differences", "ratio", "perimeters apart")
        table("Milliseconds, and the largest difference of the perimeter's derivatives:", *heads)
        row(8)  # what is imported at the first is not counted
        for segments in SEGMENTS:
            print(row(segments), flush=True)


def curve(segments: int) -> vt.Design:
    """A closed polyline of so many segments."""
    angle = np.arange(segments) * (2 * np.pi / segments)
    radius = 9 + 2 * np.sin(3 * angle) + 1.5 * np.sin(7 * angle + 1)
    return vt.Design("p4", 60, vt.Site(vt.polyline(15 + 14j + radius * np.exp(1j * angle), closed=True)))


def row(segments: int) -> str:
    """The row of a design."""
    design = curve(segments)
    tiling, tile_ms = timed(design.tessellate)

    def whole() -> vt.ShapeGradient:
        gradient = tiling.shape_gradient()
        for tile in gradient:
            _ = tile.along(POINTS), tile.area, tile.perimeter
        return gradient

    gradient, gradient_ms = timed(whole)
    count = len(gradient.parameters)
    chosen = np.linspace(0, count - 1, min(JUDGED, count)).astype(int)
    begun = time.process_time()
    apart = 0.0
    for k in chosen.tolist():
        name = gradient.parameters[k]
        forth, back = (gradient.stepped({name: step}).tessellate()[0].perimeter for step in (STEP, -STEP))
        apart = max(apart, abs((forth - back) / (2 * STEP) - float(gradient[0].perimeter[k])))
    differences_ms = (time.process_time() - begun) * 1e3 * count / len(chosen)
    figures = f"{tile_ms:.1f} | {gradient_ms:.1f} | {differences_ms:.0f} | {differences_ms / gradient_ms:.0f}"
    return f"| {segments} | {count} | {figures} | {apart:.0e} |"


def timed(run: Callable[[], T]) -> tuple[T, float]:
    """A result, and the least of the times that it took; milliseconds."""
    least = np.inf
    for _ in range(RUNS):
        begun = time.process_time()
        result = run()
        least = min(least, time.process_time() - begun)
    return result, least * 1e3


if __name__ == "__main__":
    main()

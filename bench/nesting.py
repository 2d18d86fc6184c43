"""How many pieces a sheet holds: as the tessellation lies, pulled apart, and nested.

Each example on a sheet of 300 x 200 mm, margin 5 mm, kerf 0.15 mm, so that contours keep 1 mm. Use is the share of the
sheet that is pieces. "bound" is how many there could be: pieces grown by half the gap lie in the sheet grown by as much
and do not overlap, so their areas fit; "auto" is `layout="auto"`, in seconds of processor time; "nested" searches on;
"spyrrow alone" is given the same polygons and as many seconds.

    python bench/nesting.py                             all examples
    python bench/nesting.py cmm-scroll pgg-crane        some of them
    python bench/nesting.py --effort 60 --write         the table into bench/README.md
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from statistics import median

import numpy as np
from report import machine, published, table

from voronoi_tiles import Design, Job, Tiling
from voronoi_tiles.fabrication.nest_search import NestPlaces, most_pieces
from voronoi_tiles.fabrication.nested_sheets import Nesting
from voronoi_tiles.fabrication.product import Product, _Plan

EXAMPLES = Path(__file__).parents[1] / "examples"
SHEET = (300.0, 200.0)
MARGIN, KERF, GAP = 5.0, 0.15, 1.0
"""Millimetres; the gap is what contours with this kerf keep."""


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="examples; all without any")
    parser.add_argument("--effort", type=float, default=30.0, help="seconds for each search")
    parser.add_argument("--write", action="store_true", help="put the table into bench/README.md")
    options = parser.parse_args()
    names = options.names or sorted(path.stem for path in EXAMPLES.glob("*.toml"))
    with published("nesting", write=options.write):
        tables(names, options.effort)


def tables(names: list[str], effort: float) -> None:
    """Print a row for each example, and the median of the gain in use."""
    print(f"{machine()}; {effort:g} s a search")
    heads = ("example", "gain", "bound", "tessellated", "use", "auto", "use", "CPU", "nested", "use", "seconds")
    table("Pieces on a sheet of 300 x 200 mm:", *heads, "spyrrow alone")
    gains, bounds, times = [], [], []
    for name in names:
        tiling = Design.load(EXAMPLES / f"{name}.toml").tessellate()
        as_it_lies, _ = made(tiling, "tessellated", effort)
        row = [str(as_it_lies.pieces.count), use(as_it_lies)]
        begun = time.process_time()
        product, _ = made(tiling, "auto", effort)
        times.append(time.process_time() - begun)
        row += [str(product.pieces.count), use(product), f"{times[-1]:.2f}"]
        product, seconds = made(tiling, "nested", effort)
        row += [str(product.pieces.count), use(product), f"{seconds:.0f}", str(searched(tiling, effort))]
        most = bound(tiling)
        gains.append(product.pieces.tile_area / as_it_lies.pieces.tile_area)
        bounds.append(most / as_it_lies.pieces.count)
        print(f"| {' | '.join([name, f'{gains[-1]:.2f}', f'{most:.1f}', *row])} |", flush=True)
    print(f"\nMedian gain: {median(gains):.2f}; by the bound no more than {median(bounds):.2f}.")
    print(f"Processor time of `auto`: median {median(times):.2f} s, at most {max(times):.2f} s.")


def use(product: Product) -> str:
    """The share of the sheet that is pieces, as a text."""
    return f"{product.pieces.tile_area / (SHEET[0] * SHEET[1]):.1%}"


def bound(tiling: Tiling) -> float:
    """More than how many pieces no sheet holds: where a cell has several tiles, by the mean of their areas."""
    grown = [tile.outline.to_shapely(accuracy=0.01).buffer((KERF + GAP) / 2).area for tile in tiling]
    copies = [tile.copies_per_cell for tile in tiling]
    mean = float(np.average(grown, weights=copies))
    return (SHEET[0] - 2 * MARGIN + GAP) * (SHEET[1] - 2 * MARGIN + GAP) / mean


def searched(tiling: Tiling, effort: float) -> int:
    """How many pieces spyrrow lays by itself."""
    job = Job(sheet=SHEET, margin=MARGIN, kerf=KERF)
    layout = _Plan.of(tiling.design, tiling.tessellation, job, "svg").layout
    nesting = Nesting.of(layout, job)
    none = NestPlaces(np.zeros(0, np.intp), np.zeros(0), np.zeros(0, np.complex128))
    return len(most_pieces([kind.item for kind in nesting.kinds], nesting.room, none, effort, 0).item)


def made(tiling: Tiling, layout: str, effort: float) -> tuple[Product, float]:
    """What a job makes, and in how many seconds."""
    begun = time.perf_counter()
    product = tiling.make(Job(sheet=SHEET, margin=MARGIN, kerf=KERF, layout=layout, effort=effort))
    return product, time.perf_counter() - begun


if __name__ == "__main__":
    main()

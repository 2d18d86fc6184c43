"""How fast sheets are written, and how time and memory grow with the number of tiles.

Every row is one run of the command line in a process of its own, from the design file to the file on the disk: the
tessellation, its proof, the sheet. The design is a curve of 24 segments in p1; the sheet is 600 x 300 mm, the cell gets
smaller. "peer" is what the usual library takes to write the same file: svgwrite with one element for every path, ezdxf
with one add_lwpolyline for every path, timed alone, from arrays that are there already.

    python bench/sheets.py                      100, 1,000 and 10,000 tiles
    python bench/sheets.py --write              the same, into bench/README.md
    python bench/sheets.py --tiles 300 3000
"""

from __future__ import annotations

import argparse
import io
import sys
import tempfile
import time
from pathlib import Path

from processes import usage_of
from report import machine, published

from voronoi_tiles import Design, Job
from voronoi_tiles.fabrication.product import Product

SHEET = (600.0, 300.0)
SEGMENTS = 24
CURVE = ((0.1, 0.1), (0.3, 0.75), (0.55, -0.2), (0.85, 0.55))
"""The control points of a cubic curve, in sides of the cell."""

JOBS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("svg", "once", ("--fit", "clip")),
    ("svg", "pieces", ("--fit", "clip", "--edges", "pieces")),
    ("svg", "pieces, kerf", ("--kerf", "0.1mm", "--gap", "0.3mm")),
    ("dxf", "once", ("--fit", "clip")),
    ("dxf", "pieces", ("--fit", "clip", "--edges", "pieces")),
    ("pdf", "once", ("--fit", "clip")),
    ("lbrn2", "once", ("--fit", "clip")),
)


def design_text(tiles: int) -> str:
    """A design of which so many tiles cover the sheet."""
    side = (SHEET[0] * SHEET[1] / tiles) ** 0.5
    points = []
    for k in range(SEGMENTS + 1):
        t = k / SEGMENTS
        weights = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
        point = [sum(w * p[axis] for w, p in zip(weights, CURVE, strict=True)) for axis in (0, 1)]
        points.append([round(side * part, 9) for part in point])
    return (
        f'schema = 1\ngroup = "p1"\n[cell]\na = {side!r}\nb = {side!r}\nangle = 80.0\n'
        f"[[site]]\nstrokes = [{{ polyline = {points} }}]\n"
    )


def run(arguments: list[str]) -> tuple[float, float]:
    """Run the command line: seconds, and megabytes at its peak."""
    begun = time.perf_counter()
    usage = usage_of([sys.executable, "-m", "voronoi_tiles", *arguments])
    return time.perf_counter() - begun, usage.ru_maxrss / 1000


def fastest(arguments: list[str], runs: int) -> tuple[float, float]:
    """The fastest of some runs, and the memory of the largest."""
    rows = [run(arguments) for _ in range(runs)]
    return min(row[0] for row in rows), max(row[1] for row in rows)


def svg_peer(product: Product) -> float:
    """Seconds that svgwrite takes for the same paths."""
    from svgwrite import Drawing

    from voronoi_tiles.formats.svg.path_text import path_texts

    layer = product.drawing.layers[-1]
    texts = [data.decode() for data in path_texts(layer.paths, layer.items, product.drawing.height)]
    begun = time.perf_counter()
    drawing = Drawing(size=("600mm", "300mm"), viewBox="0 0 600 300", debug=False)
    group = drawing.add(drawing.g(fill="none", stroke="#000000", stroke_width=0.025))
    for text in texts:
        group.add(drawing.path(d=text))
    drawing.write(io.StringIO())
    return time.perf_counter() - begun


def dxf_peer(product: Product, target: Path) -> float:
    """Seconds that ezdxf takes for the same polylines."""
    import ezdxf

    paths = product.drawing.layers[-1].paths
    x, y, bulge = paths.start.real.tolist(), paths.start.imag.tolist(), paths.bulges().tolist()
    offsets, closed = paths.offsets.tolist(), paths.closed.tolist()
    begun = time.perf_counter()
    document = ezdxf.new("R2000", units=ezdxf.units.MM)
    space = document.modelspace()
    for k in range(len(paths)):
        a, b = offsets[k], offsets[k + 1]
        points = list(zip(x[a:b], y[a:b], bulge[a:b], strict=True))
        if not closed[k]:
            points.append((float(paths.end[b - 1].real), float(paths.end[b - 1].imag), 0.0))
        space.add_lwpolyline(points, format="xyb", close=closed[k])
    document.saveas(target)
    return time.perf_counter() - begun


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tiles", type=int, nargs="+", default=[100, 1000, 10_000])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--write", action="store_true", help="put the table into bench/README.md")
    options = parser.parse_args()
    with published("sheets", write=options.write):
        tables(options.tiles, options.runs)


def tables(sizes: list[int], runs: int) -> None:
    """Print the table for sheets of so many tiles, each row the fastest of some runs."""
    print(f"{machine()}\n")
    print("| file | edges | tiles | seconds | MB | file, MB | peer, seconds |")
    print("|---|---|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        seconds, memory = fastest(["--version"], runs)
        rows = [("(the command alone)", "", "", f"{seconds:.2f}", f"{memory:.0f}", "")]
        designs = {tiles: Path(folder, f"c{tiles}.toml") for tiles in sizes}
        for tiles, design in designs.items():
            design.write_text(design_text(tiles))
            for form, edges, arguments in JOBS:
                target = Path(folder, f"sheet.{form}")
                command = ["export", str(design), "-o", str(target), "--sheet", "600x300mm", *arguments]
                seconds, memory = fastest(command, runs)
                size = target.stat().st_size / 1e6
                rows.append((form, edges, f"{tiles:,}", f"{seconds:.2f}", f"{memory:.0f}", f"{size:.1f}"))
                if form in {"svg", "dxf"} and edges == "once":
                    seconds, memory = fastest(["preflight", str(target)], 1)
                    rows.append((f"preflight {form}", edges, f"{tiles:,}", f"{seconds:.2f}", f"{memory:.0f}", ""))
        # The peers come last: what this process takes in memory would count as its children's.
        for form, edges, count, *figures in rows:
            other = peer(form, edges, designs[int(count.replace(",", ""))], Path(folder)) if count else ""
            print(f"| {' | '.join((form, edges, count, *figures, other))} |", flush=True)


def peer(form: str, edges: str, design: Path, folder: Path) -> str:
    """What the usual library takes for the same file, as a text."""
    if form not in {"svg", "dxf"} or edges != "once":
        return ""
    product = Design.load(design).tessellate().make(Job(sheet=SHEET, fit="clip"), form)
    return f"{svg_peer(product) if form == 'svg' else dxf_peer(product, folder / 'peer.dxf'):.2f}"


if __name__ == "__main__":
    main()

"""What a step of dragging costs in Blender, without the proof and with it: the extension's goal is 30 ms.

A site of 24 segments in the group p4, a field of 3 x 3 cells. Processor time, medians, of the handler and the timer's
function, which no window has to call; then of the evaluation that Blender does for its views.

    python bench/dragging.py             Blender by `make blender-programs`, or VORONOI_TILES_BLENDER
    python bench/dragging.py --write     the table into bench/README.md as well
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
from pathlib import Path

from report import machine, published, table

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from helpers.blender import make_extension


def main() -> None:
    """Measure, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found, _ = make_extension(Path(folder), Path(folder)).run("speed")
    with published("blender", write=given.write):
        print(f"\n{machine()}; Blender {found['blender']}, kernels: {found['kernels']}")
        heads = ("", "median, ms", "longest, ms")
        table(f"24 segments, {found['arcs']} edges, {found['copies']} copies", *heads)
        for name, key in (
            ("handler and timer, without the proof", "updates"),
            ("evaluation by Blender", "views"),
            ("the pause: proved, and laid anew", "proofs"),
        ):
            print(f"| {name} | {1000 * statistics.median(found[key]):.1f} | {1000 * max(found[key]):.1f} |")


if __name__ == "__main__":
    main()

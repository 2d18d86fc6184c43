"""What a step of dragging costs in Blender, without the proof and with it: the extension's goal is 30 ms.

A site of 24 segments in the group p4, in fields of 3 x 3 cells and more. Processor time, medians: of the timer's
function, which no window has to call; of the evaluation that Blender does for its views, twice a step, after the hand's
change and after ours, the handler in it; and of what is done in a pause.

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

CELLS = ("3", "20", "35")
"""How many cells the fields have along each side."""


def main() -> None:
    """Measure, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found, _ = make_extension(Path(folder), Path(folder)).run("speed", *CELLS)
    with published("blender", write=given.write):
        print(f"\n{machine()}; Blender {found['blender']}, kernels: {found['kernels']}")
        heads = ("copies", "tiles, without the proof, ms", "longest", "evaluation by Blender, ms", "the pause, ms")
        table(f"24 segments, {found['arcs']} edges; medians", *heads)
        for field in found["fields"]:
            own, views, proofs = (1000 * statistics.median(field[key]) for key in ("updates", "views", "proofs"))
            longest = 1000 * max(field["updates"])
            print(f"| {field['copies']:,} | {own:.1f} | {longest:.1f} | {views:.1f} | {proofs:.1f} |")


if __name__ == "__main__":
    main()

"""Tiles given back: exact tiles of random curves, turned and moved, are outlines, and `fit` finds what they are of.

The tiles are those of tests/helpers/silhouettes.py, in the seven groups without mirrors in turn, of one piece. Every
group is looked in, and the best design is taken. Times are processor time, of one process.

    python bench/given_back.py                 100 tiles, about a quarter of an hour
    python bench/given_back.py 14              so many
    python bench/given_back.py --write         also: the table into bench/README.md
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from pathlib import Path
from typing import Final

from report import machine, published, table

import voronoi_tiles as vt

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from helpers.silhouettes import lost, random_tiling

GROUPS: Final = ("p1", "p2", "p3", "p4", "p6", "pg", "pgg")
ENOUGH: Final = 0.995
"""The overlap from which on a tile counts as given back."""


def main() -> None:
    """Fit the tiles and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", nargs="?", type=int, default=100, help="how many tiles")
    parser.add_argument("--write", action="store_true", help="put the table into bench/README.md")
    given = parser.parse_args()
    with published("given back", write=given.write):
        print(machine())
        report(given.count)


def report(count: int) -> None:
    """Print a row for each group, and what was given back in all."""
    overlaps: dict[str, list[float]] = {group: [] for group in GROUPS}
    same: dict[str, int] = dict.fromkeys(GROUPS, 0)
    seconds: list[float] = []
    for seed in range(count):
        group = GROUPS[seed % len(GROUPS)]
        outline = lost(random_tiling(seed, group), seed)
        begin = time.process_time()
        (best,) = vt.fit(outline, keep=1, strokes="outline")
        seconds.append(time.process_time() - begin)
        overlaps[group].append(best.overlap)
        same[group] += best.group == group
        print(f"{seed:3} {group:4} {best.group:4} {best.overlap:.4f} {seconds[-1]:5.1f} s", file=sys.stderr, flush=True)
    table("Tiles given back", "tiles of", "tiles", f"overlap >= {ENOUGH}", "least overlap", "found in that group")
    for group, found in overlaps.items():
        if found:
            enough = sum(each >= ENOUGH for each in found)
            print(f"| {group} | {len(found)} | {enough} | {min(found):.4f} | {same[group]} |")
    every = [each for found in overlaps.values() for each in found]
    enough = sum(each >= ENOUGH for each in every)
    print(f"\n{enough} of {len(every)} are given back, their median {statistics.median(every):.4f};")
    print(f"seconds of processor time: median {statistics.median(seconds):.1f}, at most {max(seconds):.1f}.")


if __name__ == "__main__":
    main()

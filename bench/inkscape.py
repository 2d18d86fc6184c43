"""What a call of Inkscape's costs: from the start of its Python to the changed drawing, for a stroke of 24 segments.

    python bench/inkscape.py [CALLS]

Wall and processor time of whole processes, medians; beside them the command line on the same strokes, and a Python
that imports numpy alone. A fitted cell is found anew by every call, a rectangle's is not.
"""

from __future__ import annotations

import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from voronoi_tiles.inkscape.installation import own_files

SEGMENTS = 24

PYTHON = "/usr/bin/python3" if Path("/usr/bin/python3").exists() else sys.executable
"""What Inkscape starts: the distribution's."""


def drawing() -> tuple[str, str]:
    """A drawing of a polyline, and the same as a design."""
    t = np.linspace(0.0, 1.0, SEGMENTS + 1)
    points = np.column_stack((12 + 30 * t, 20 + 9 * np.sin(5 * t)))
    text = " ".join(f"{x:.17g},{y:.17g}" for x, y in points.tolist())
    style = 'style="fill:none;stroke:#000"'
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">'
        f'<polyline id="p" {style} points="{text}"/></svg>'
    )
    site = {"strokes": [{"polyline": [[x, 100 - y] for x, y in points.tolist()]}]}
    return svg, json.dumps({"schema": 1, "group": "p4", "cell": {"a": 90}, "site": [site]})


def median_times(words: list[str], calls: int) -> tuple[float, float]:
    """The medians of wall and processor time of a process; seconds."""
    wall, used = [], []
    for _ in range(calls):
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        subprocess.run(words, check=True, capture_output=True)  # noqa: S603 - our own launchers
        wall.append(time.perf_counter() - begin)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return statistics.median(wall), statistics.median(used)


def main() -> None:
    """Measure, and print a table."""
    calls = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    svg, design = drawing()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, data in own_files(sys.executable, {}).items():
            Path(name).write_bytes(data)
        Path("p.svg").write_text(svg, encoding="utf-8")
        Path("p.json").write_text(design, encoding="utf-8")
        numbers = ["--cell=numbers", "--side_a=90"]
        rows = {
            "Tiles from Selection": [PYTHON, "run_tiles.py", "--id=p", *numbers, "p.svg"],
            "with a cell that is fitted, p4": [PYTHON, "run_tiles.py", "--id=p", "p.svg"],
            "with a cell that is fitted, p2": [PYTHON, "run_tiles.py", "--id=p", "--group=p2", "p.svg"],
            "Sheet from Selection": [PYTHON, "run_sheet.py", "--id=p", *numbers, "p.svg"],
            "Open a design": [PYTHON, "run_open.py", "p.json"],
            "voronoi-tiles export p.json": [sys.executable, "-m", "voronoi_tiles", "export", "p.json", "-o", "o.svg"],
            "import numpy": [sys.executable, "-c", "import numpy"],
        }
        print("| call | wall, s | processor, s |\n|---|---|---|")
        for name, words in rows.items():
            wall, used = median_times(words, calls)
            print(f"| {name} | {wall:.2f} | {used:.2f} |", flush=True)


if __name__ == "__main__":
    main()

"""What a tile needs: numpy, and nothing else."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
import importlib.abc
import sys


class NumpyAlone(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        # What was installed for other purposes is as if it were not there.
        if name.partition(".")[0] in OTHERS:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)


OTHERS = {
    "click", "coloraide", "cssselect2", "ezdxf", "HersheyFonts", "matplotlib", "moderngl", "PIL", "rich", "scipy",
    "shapely", "svgwrite", "tinycss2",
}
sys.meta_path.insert(0, NumpyAlone())

import voronoi_tiles as vt

curve = {"bezier": [[6, 9], [30, 2], [30, 20], [13, 25]]}
SITES = [
    ("p4", {"a": 60}, [[curve]]),
    ("p6m", {"a": 90}, [[{"point": [0, 0]}], [{"circle": [30, 9], "radius": 5}]]),
    ("p1", {"a": 50, "b": 9, "angle": 40}, [[{"segment": [[1, 2], [30, 3]]}], [{"point": [20, 6]}]]),
]
for group, cell, sites in SITES:
    design = {"schema": 1, "group": group, "cell": cell, "site": [{"strokes": strokes} for strokes in sites]}
    tiling = vt.Design.from_dict(design).tessellate()
    assert tiling.proof.passed
    for tile in tiling.tiles:
        assert tile.outline.area > 0
    assert tiling.json().startswith("{")
print("proved")
"""


def test_a_proved_tile_needs_numpy_alone() -> None:
    """The package is imported, tiles of some designs are proved, and their outline document is written."""
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert done.stdout == "proved\n"

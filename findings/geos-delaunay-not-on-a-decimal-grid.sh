#!/usr/bin/env bash
# GEOS 3.14.1, through shapely 2.2.0: the Delaunay triangulation of points on a decimal grid is none.
#
# Seen with shapely 2.2.0 (GEOS 3.14.1) on 2026-11-29: 16 points that are whole multiples of 0.37 in both coordinates. In
# a Delaunay triangulation two points are joined wherever the disc over them as a diameter holds no other point; every
# nearest pair and every edge of the shortest tree is such a pair. delaunay_triangles() joins others in the place of one
# of them, without an error or a warning, while the same points divided by 0.37 are right, as scipy's (Qhull's) are both
# times. What is computed from the edges, a shortest tree or nearest neighbours, comes out too long.
# Points that come from a drawing lie on such grids: millimetres with two decimals, pixels of 25.4 / 96 mm.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check shapely==2.2.0 numpy==2.4.6 scipy==1.17.1
"$folder/venv/bin/python" - <<'PYTHON'
import sys
from itertools import combinations

import numpy as np
import scipy
import shapely
from scipy.spatial import Delaunay

WHOLE = [(-47, -8), (-44, -5), (-43, -6), (-34, -1), (-27, 3), (-24, -8), (-22, 1), (-20, -3), (-3, 4), (0, -2), (5, 6),
         (13, 5), (16, 2), (17, -3), (31, 7), (45, 0)]


def of_geos(points):
    """The pairs that GEOS joins, by their numbers."""
    lines = shapely.get_parts(shapely.delaunay_triangles(shapely.multipoints(points), only_edges=True))
    ends = shapely.get_coordinates(lines).reshape(-1, 2, 2)
    return {tuple(sorted(int(np.abs(points - end).sum(axis=1).argmin()) for end in pair)) for pair in ends}


def of_qhull(points):
    """The pairs that Qhull joins."""
    return {tuple(sorted(map(int, pair))) for row in Delaunay(points).simplices for pair in combinations(row, 2)}


def needed():
    """The pairs whose disc holds no other point, in whole numbers: exact."""
    found = set()
    for (i, p), (j, q) in combinations(enumerate(WHOLE), 2):
        # An angle of more than 90 degrees at r says that r lies in the disc over p and q.
        if not any((p[0] - r[0]) * (q[0] - r[0]) + (p[1] - r[1]) * (q[1] - r[1]) <= 0 for r in WHOLE if r not in (p, q)):
            found.add((i, j))
    return found


print("shapely", shapely.__version__, "GEOS", shapely.geos_version_string, "scipy", scipy.__version__)
missing = {}
for step in (1.0, 0.37):
    points = np.array(WHOLE) * step
    missing[step] = needed() - of_geos(points)
    print(f"step {step}: GEOS lacks {sorted(missing[step])}, Qhull lacks {sorted(needed() - of_qhull(points))}")
    if needed() - of_qhull(points):
        sys.exit("changed: Qhull lacks an edge as well")
print("expected: none is lacking, whatever the step")
if missing[1.0] or not missing[0.37]:
    sys.exit("changed: GEOS joins what it did not")
PYTHON

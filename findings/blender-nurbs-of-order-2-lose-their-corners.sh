#!/usr/bin/env bash
# Blender 4.2.23 (LTS) cuts the corners of NURBS curves of order 2, which are polylines; 5.0.1 does not.
#
# Expected: a curve of order 2 through points is the lines between them, at any resolution: its mesh has every corner, as
# that of a spline of the type POLY has, and as 5.0 makes it.
# Seen: 4.2 samples the parameter evenly from end to end, and no sample falls on an inner knot. Of five points, steps 1 to
# 2 long, the corners are missed by up to 0.36 at a resolution of 3 and by 0.085 at 12, the default; 200 still leaves
# 0.005. The same file is another shape in 5.0, where samples stand at the knots and every corner is met.
# Whoever reads such splines for cutting takes the control points of order 2 themselves, or evaluates by knots: a mesh of
# 4.2 is not what the control points say. voronoi_tiles reads control points, never Blender's meshes.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/corners.py" <<'PYTHON'
import sys
from math import hypot

import bpy

CORNERS = [(0, 0), (1, 0), (1, 2), (3, 2), (3, 0.5)]


def missed(kind, resolution):
    """How far the vertices of a curve's mesh are from each of its corners."""
    curve = bpy.data.curves.new("drawn", "CURVE")
    curve.resolution_u = resolution
    spline = curve.splines.new(kind)
    spline.points.add(len(CORNERS) - 1)
    for point, (x, y) in zip(spline.points, CORNERS):
        point.co = (x, y, 0, 1)
    spline.order_u = 2
    spline.use_endpoint_u = True
    drawn = bpy.data.objects.new("drawn", curve)
    bpy.context.scene.collection.objects.link(drawn)
    mesh = drawn.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    seen = [tuple(vertex.co)[:2] for vertex in mesh.vertices]
    return [min(hypot(a - x, b - y) for a, b in seen) for x, y in CORNERS]


print("Blender", bpy.app.version_string)
assert max(missed("POLY", 12)) < 1e-6
found = {resolution: missed("NURBS", resolution) for resolution in (3, 12, 200)}
for resolution, distances in found.items():
    print(f"  NURBS of order 2, resolution {resolution:3}: corners are missed by", [round(one, 4) for one in distances])
if sys.argv[1] == "cut":
    assert max(found[3]) > 0.3 and max(found[12]) > 0.08 and max(found[200]) > 0.003, "corners are met now"
else:
    assert max(map(max, found.values())) < 1e-6, "corners are missed now"
PYTHON
for version in 4.2.23:cut 5.0.1:met; do
    python3.11 -m venv "$folder/${version%:*}"
    "$folder/${version%:*}/bin/pip" install --quiet --disable-pip-version-check "bpy==${version%:*}" numpy==1.26.4
    "$folder/${version%:*}/bin/python" "$folder/corners.py" "${version#*:}"
done
echo "as described"
